"""Asks for the counter's file, then which entity is which of its sensors."""

from __future__ import annotations

from typing import Any

import voluptuous as vol
from homeassistant.config_entries import ConfigFlow, ConfigFlowResult
from homeassistant.helpers import selector

from . import CONF_COUNTER, CONF_OFF_AT, CONF_SENSORS, DOMAIN
from .live import Counter

_OFF_AT = selector.NumberSelector(selector.NumberSelectorConfig(min=0.5, max=0.99, step=0.01))
_FILE = vol.Schema({vol.Required("name", default="Room"): str, vol.Required(CONF_COUNTER, default="counter.json"): str,
                    vol.Required(CONF_OFF_AT, default=0.9): _OFF_AT})
_ENTITY = selector.EntitySelector(selector.EntitySelectorConfig(domain="binary_sensor"))


class PirsimConfigFlow(ConfigFlow, domain=DOMAIN):
    VERSION = 1

    def __init__(self) -> None:
        self._given: dict[str, Any] = {}
        self._sensors: tuple[str, ...] = ()

    async def async_step_user(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        errors = {}
        if user_input is not None:
            try:
                counter = await self.hass.async_add_executor_job(Counter, self.hass.config.path(user_input[CONF_COUNTER]))
                self._given, self._sensors = user_input, counter.sensors
                return await self.async_step_sensors()
            except OSError:
                errors[CONF_COUNTER] = "no_file"
            except ValueError:
                errors[CONF_COUNTER] = "no_counter"
        return self.async_show_form(step_id="user", errors=errors,
                                    data_schema=self.add_suggested_values_to_schema(_FILE, user_input or {}))

    async def async_step_sensors(self, user_input: dict[str, Any] | None = None) -> ConfigFlowResult:
        errors = {}
        if user_input is not None:
            if len(set(user_input.values())) == len(self._sensors):
                data = {CONF_COUNTER: self._given[CONF_COUNTER], CONF_OFF_AT: self._given[CONF_OFF_AT], CONF_SENSORS: user_input}
                return self.async_create_entry(title=self._given["name"], data=data)
            errors["base"] = "twice"
        suggested = {sensor: sensor for sensor in self._sensors if self.hass.states.get(sensor)}
        schema = vol.Schema({vol.Required(sensor): _ENTITY for sensor in self._sensors})
        return self.async_show_form(step_id="sensors", errors=errors,
                                    data_schema=self.add_suggested_values_to_schema(schema, user_input or suggested))
