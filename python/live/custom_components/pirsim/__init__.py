"""A counter of `pirsim calibrate` in Home Assistant: how many people are there, and whether anybody is."""

from __future__ import annotations

from datetime import timedelta
from typing import Any, Callable

from homeassistant.config_entries import ConfigEntry
from homeassistant.const import STATE_OFF, STATE_ON, Platform
from homeassistant.core import Event, HomeAssistant, State, callback
from homeassistant.exceptions import ConfigEntryError
from homeassistant.helpers.device_registry import DeviceInfo
from homeassistant.helpers.event import async_track_state_change_event, async_track_time_interval
from homeassistant.util import dt

from .live import ClockSteppedBack, Counter, Occupancy

DOMAIN = "pirsim"
PLATFORMS = [Platform.BINARY_SENSOR, Platform.SENSOR]
CONF_COUNTER, CONF_SENSORS, CONF_OFF_AT = "counter", "sensors", "off_at"


def _motion(state: State | None) -> bool | None:
    return {STATE_ON: True, STATE_OFF: False}.get(state.state) if state is not None else None


class Room:
    """One counter, the entities that it hears, and those that listen to it."""

    def __init__(self, hass: HomeAssistant, entry: ConfigEntry, counter: Counter) -> None:
        self.counter, self.occupancy = counter, Occupancy(entry.data[CONF_OFF_AT])
        self.device = DeviceInfo(identifiers={(DOMAIN, entry.entry_id)}, name=entry.title, manufacturer="pirsim")
        self._hass, self._listeners = hass, set[Callable[[], None]]()
        self._sensor_of = {entity: sensor for sensor, entity in entry.data[CONF_SENSORS].items()}

    @callback
    def start(self) -> list[Callable[[], None]]:
        """Begins to hear; what is returned ends that."""
        self._update({sensor: _motion(self._hass.states.get(entity)) for entity, sensor in self._sensor_of.items()})
        return [async_track_state_change_event(self._hass, list(self._sensor_of), self._changed),
                async_track_time_interval(self._hass, self._tick, timedelta(seconds=min(1.0, self.counter.step_s)))]

    @callback
    def listen(self, listener: Callable[[], None]) -> Callable[[], None]:
        self._listeners.add(listener)
        return lambda: self._listeners.discard(listener)

    @callback
    def _changed(self, event: Event[Any]) -> None:
        sensor, state = self._sensor_of[event.data["entity_id"]], _motion(event.data["new_state"])
        self._update({sensor: state})
        if state and not self.occupancy.is_on:
            self.occupancy.motion()
            self._tell()

    @callback
    def _tick(self, _now: Any) -> None:
        if dt.utcnow().timestamp() >= self.counter.next_end:
            self._update({})

    @callback
    def _update(self, states: dict[str, bool | None]) -> None:
        now = dt.utcnow().timestamp()
        try:
            ended = self.counter.update(now, states)
        except ClockSteppedBack:
            if self.counter.time - now > self.counter.step_s:
                self.counter.reset()
                now_known = {sensor: _motion(self._hass.states.get(entity)) for entity, sensor in self._sensor_of.items()}
                ended = self.counter.update(now, {**now_known, **states})
            else:
                ended = self.counter.update(self.counter.time, states)
        for estimate in ended:
            self.occupancy.update(estimate)
        if ended:
            self._tell()

    @callback
    def _tell(self) -> None:
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
