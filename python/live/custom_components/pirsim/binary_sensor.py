"""Whether anybody is there, and whether the counter can be relied on."""

from __future__ import annotations

from homeassistant.components.binary_sensor import BinarySensorDeviceClass, BinarySensorEntity
from homeassistant.config_entries import ConfigEntry
from homeassistant.const import EntityCategory
from homeassistant.core import HomeAssistant
from homeassistant.helpers.entity_platform import AddEntitiesCallback
from homeassistant.helpers.restore_state import RestoredExtraData, RestoreEntity

from .entity import RoomEntity


async def async_setup_entry(_hass: HomeAssistant, entry: ConfigEntry, add: AddEntitiesCallback) -> None:
    add([Occupied(entry, "occupancy"), Unlike(entry, "problem")])


class Occupied(RoomEntity, BinarySensorEntity, RestoreEntity):
    """It keeps what the room knew over restarts."""

    _attr_device_class = BinarySensorDeviceClass.OCCUPANCY

    async def async_added_to_hass(self) -> None:
        if (saved := await self.async_get_last_extra_data()) is not None:
            await self.hass.async_add_executor_job(self._room.restore, saved.as_dict())
        await super().async_added_to_hass()

    @property
    def extra_restore_state_data(self) -> RestoredExtraData:
        return RestoredExtraData(self._room.live.state())

    @property
    def is_on(self) -> bool | None:
        return self._room.live.occupancy.is_on


class Unlike(RoomEntity, BinarySensorEntity):
    """Hardly a simulated room makes such a log as that which the counter comes from."""

    _attr_device_class = BinarySensorDeviceClass.PROBLEM
    _attr_entity_category = EntityCategory.DIAGNOSTIC

    @property
    def is_on(self) -> bool:
        return bool(self._room.live.counter.warning)
