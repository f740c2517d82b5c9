"""A counter of `pirsim calibrate` in Home Assistant: how many people are there, and whether anybody is."""

from __future__ import annotations

import logging
import time
from datetime import timedelta
from typing import Any, Callable

from homeassistant.config_entries import ConfigEntry
from homeassistant.const import STATE_OFF, STATE_ON, Platform
from homeassistant.core import Event, HomeAssistant, State, callback
from homeassistant.exceptions import ConfigEntryError
from homeassistant.helpers.device_registry import DeviceInfo
from homeassistant.helpers.event import async_track_state_change_event, async_track_time_interval
from homeassistant.util import dt

from .live import Counter, LiveRoom

DOMAIN = "pirsim"
PLATFORMS = [Platform.BINARY_SENSOR, Platform.SENSOR]
CONF_COUNTER, CONF_SENSORS, CONF_OFF_AT = "counter", "sensors", "off_at"
_log = logging.getLogger(__name__)


def _motion(state: State | None) -> bool | None:
    return {STATE_ON: True, STATE_OFF: False}.get(state.state) if state is not None else None


class Room:
    """One counter, the entities that it hears, and those that listen to it."""

    def __init__(self, hass: HomeAssistant, entry: ConfigEntry, counter: Counter) -> None:
        self.live = LiveRoom(counter, entry.data[CONF_OFF_AT], clock=lambda: dt.utcnow().timestamp(),
                             monotonic=lambda: time.monotonic())
        self.device = DeviceInfo(identifiers={(DOMAIN, entry.entry_id)}, name=entry.title, manufacturer="pirsim")
        self._hass, self._listeners = hass, set[Callable[[], None]]()
        self._sensor_of = {entity: sensor for sensor, entity in entry.data[CONF_SENSORS].items()}

    @callback
    def start(self) -> list[Callable[[], None]]:
        """Begins to hear; what is returned ends that."""
        self._update({sensor: _motion(self._hass.states.get(entity)) for entity, sensor in self._sensor_of.items()})
        return [async_track_state_change_event(self._hass, list(self._sensor_of), self._changed),
                async_track_time_interval(self._hass, self._tick, timedelta(seconds=1))]

    def restore(self, state: Any) -> None:
        """Goes on from before a restart; counts the readings in between, so call it beside the event loop."""
        try:
            self.live.restore(state)
            self.live.update()
        except ValueError as fault:
            _log.warning("%s: begins anew: %s", self.device["name"], fault)

    @callback
    def listen(self, listener: Callable[[], None]) -> Callable[[], None]:
        self._listeners.add(listener)
        return lambda: self._listeners.discard(listener)

    @callback
    def _changed(self, event: Event[Any]) -> None:
        self._update({self._sensor_of[event.data["entity_id"]]: _motion(event.data["new_state"])})

    @callback
    def _tick(self, _now: Any) -> None:
        self._update()

    @callback
    def _update(self, states: dict[str, bool | None] | None = None) -> None:
        if self.live.update(states):
            for listener in list(self._listeners):
                listener()


async def async_setup_entry(hass: HomeAssistant, entry: ConfigEntry) -> bool:
    try:
        counter = await hass.async_add_executor_job(Counter, hass.config.path(entry.data[CONF_COUNTER]))
    except (OSError, ValueError) as fault:
        raise ConfigEntryError(f"{entry.data[CONF_COUNTER]}: {fault}") from fault
    if set(counter.sensors) != set(entry.data[CONF_SENSORS]):
        raise ConfigEntryError(f"the counter is now for other sensors: {', '.join(counter.sensors)}")
    entry.runtime_data = room = Room(hass, entry, counter)
    await hass.config_entries.async_forward_entry_setups(entry, PLATFORMS)
    for stop in room.start():
        entry.async_on_unload(stop)
    return True


async def async_unload_entry(hass: HomeAssistant, entry: ConfigEntry) -> bool:
    return await hass.config_entries.async_unload_platforms(entry, PLATFORMS)
