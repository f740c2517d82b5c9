"""People, and the probability that nobody is there."""

from __future__ import annotations

from homeassistant.components.sensor import SensorEntity, SensorStateClass
from homeassistant.config_entries import ConfigEntry
from homeassistant.const import PERCENTAGE
from homeassistant.core import HomeAssistant
from homeassistant.helpers.entity_platform import AddEntitiesCallback

from .entity import RoomEntity


async def async_setup_entry(_hass: HomeAssistant, entry: ConfigEntry, add: AddEntitiesCallback) -> None:
    add([People(entry, "people"), Nobody(entry, "nobody")])


class People(RoomEntity, SensorEntity):
    _attr_state_class = SensorStateClass.MEASUREMENT

    @property
    def native_value(self) -> int | None:
        last = self._room.live.counter.last
        return last.people if last else None


class Nobody(RoomEntity, SensorEntity):
    _attr_native_unit_of_measurement = PERCENTAGE
    _attr_suggested_display_precision = 0

    @property
    def native_value(self) -> float | None:
        last = self._room.live.counter.last
        return round(100 * last.p_nobody, 1) if last and last.p_nobody is not None else None
