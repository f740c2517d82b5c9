"""Whether anybody is there, and whether the counter can be relied on."""

from __future__ import annotations

from homeassistant.components.binary_sensor import BinarySensorDeviceClass, BinarySensorEntity
from homeassistant.config_entries import ConfigEntry
from homeassistant.const import EntityCategory
from homeassistant.core import HomeAssistant
from homeassistant.helpers.entity_platform import AddEntitiesCallback

from .entity import RoomEntity


async def async_setup_entry(_hass: HomeAssistant, entry: ConfigEntry, add: AddEntitiesCallback) -> None:
    add([Occupied(entry, "occupancy"), Unlike(entry, "problem")])


class Occupied(RoomEntity, BinarySensorEntity):
    _attr_device_class = BinarySensorDeviceClass.OCCUPANCY

    @property
    def is_on(self) -> bool | None:
        return self._room.occupancy.is_on


class Unlike(RoomEntity, BinarySensorEntity):
    """Hardly a simulated room makes such a log as that which the counter comes from."""

    _attr_device_class = BinarySensorDeviceClass.PROBLEM
    _attr_entity_category = EntityCategory.DIAGNOSTIC

    @property
    def is_on(self) -> bool:
        return bool(self._room.counter.warning)
