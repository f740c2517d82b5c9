"""The component in Home Assistant's own test harness."""

import json
import pathlib
import random
import sys
from datetime import timedelta

import pytest

pytest.importorskip("pytest_homeassistant_custom_component", reason="needs Home Assistant's test harness, of Python 3.12 or later")
sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
import custom_components  # noqa: E402

custom_components.__path__ = [str(pathlib.Path(__file__).parents[1] / "custom_components")]  # the harness has its own

from homeassistant.const import STATE_UNAVAILABLE, STATE_UNKNOWN  # noqa: E402
from homeassistant.data_entry_flow import FlowResultType  # noqa: E402
from homeassistant.util import dt  # noqa: E402
from pytest_homeassistant_custom_component.common import MockConfigEntry, async_fire_time_changed  # noqa: E402

HALL, DESK = "binary_sensor.hall", "binary_sensor.desk"
pytestmark = pytest.mark.usefixtures("enable_custom_integrations")


def table(draw, rows, columns):
    values = [[draw.uniform(0.05, 1) for _ in range(columns)] for _ in range(rows)]
    return [value / sum(row) for row in values for value in row]


@pytest.fixture
def counter(hass, tmp_path):
    """Nobody moves a sensor, one person mostly one, two mostly both."""
    hass.config.config_dir = str(tmp_path)
    draw, stay = random.Random(1), 0.9
    moves = [stay if i == j else (1 - stay) / 2 for i in range(3) for j in range(3)]
    told = {"pirsim_counter": 2, "step_s": 30.0, "sensors": 2, "counts": 3, "modes": 1, "sensor_names": [HALL, "desk"],
            "rooms": [{"room": 1, "first": table(draw, 1, 3), "moves": moves, "versions": [{
                "liveliness": 1.0, "weight": 1.0, "emissions": [0.98, 0.01, 0.01, 0.2, 0.7, 0.1, 0.05, 0.15, 0.8]}]}]}
    (tmp_path / "counter.json").write_text(json.dumps(told))
    return told


async def entry_of(hass, freezer):
    freezer.move_to("2026-03-02 08:00:00+00:00")
    entry = MockConfigEntry(domain="pirsim", title="Office", data={
        "counter": "counter.json", "off_at": 0.9, "sensors": {HALL: HALL, "desk": DESK}})
    entry.add_to_hass(hass)
    assert await hass.config_entries.async_setup(entry.entry_id)
    await hass.async_block_till_done()
    return entry


async def wait(hass, freezer, seconds):
    for _ in range(seconds // 15):
        freezer.tick(timedelta(seconds=15))
        async_fire_time_changed(hass, dt.utcnow())
        await hass.async_block_till_done()


def told(hass):
    return [hass.states.get(entity).state for entity in
            ("sensor.office_people", "sensor.office_nobody_there", "binary_sensor.office_occupancy")]


async def test_the_flow_asks_for_a_counter_and_its_sensors(hass, counter, tmp_path):
    hass.states.async_set(HALL, "off")
    flow = await hass.config_entries.flow.async_init("pirsim", context={"source": "user"})
    given = {"name": "Office", "counter": "nowhere.json", "off_at": 0.8}
    flow = await hass.config_entries.flow.async_configure(flow["flow_id"], given)
    assert flow["errors"] == {"counter": "no_file"}
    (tmp_path / "other.json").write_text("{}")
    flow = await hass.config_entries.flow.async_configure(flow["flow_id"], {**given, "counter": "other.json"})
    assert flow["errors"] == {"counter": "no_counter"}
    flow = await hass.config_entries.flow.async_configure(flow["flow_id"], {**given, "counter": "counter.json"})
    assert flow["step_id"] == "sensors" and [str(key) for key in flow["data_schema"].schema] == [HALL, "desk"]
    flow = await hass.config_entries.flow.async_configure(flow["flow_id"], {HALL: HALL, "desk": HALL})
    assert flow["errors"] == {"base": "twice"}
    flow = await hass.config_entries.flow.async_configure(flow["flow_id"], {HALL: HALL, "desk": DESK})
    assert flow["type"] is FlowResultType.CREATE_ENTRY and flow["title"] == "Office"
    assert flow["data"] == {"counter": "counter.json", "off_at": 0.8, "sensors": {HALL: HALL, "desk": DESK}}


async def test_people_are_counted_and_occupancy_follows_motion_at_once(hass, counter, freezer):
    hass.states.async_set(HALL, "off")
    hass.states.async_set(DESK, "off")
    await entry_of(hass, freezer)
    assert told(hass) == [STATE_UNKNOWN] * 3
    await wait(hass, freezer, 300)
    assert told(hass)[0] == "0" and told(hass)[2] == "off"
    hass.states.async_set(HALL, "on")
    hass.states.async_set(DESK, "on")
    await hass.async_block_till_done()
    assert told(hass)[2] == "on"
    await wait(hass, freezer, 120)
    assert told(hass)[0] == "2" and float(told(hass)[1]) < 5
    hass.states.async_set(HALL, "off")
    hass.states.async_set(DESK, "off")
    await wait(hass, freezer, 600)
    assert told(hass)[0] == "0" and told(hass)[2] == "off"
    assert hass.states.get("binary_sensor.office_unlike_the_simulated_rooms").state == "off"


async def test_unavailable_sensors_are_unknown_and_a_restart_begins_anew(hass, counter, freezer):
    hass.states.async_set(HALL, "on")
    entry = await entry_of(hass, freezer)
    await wait(hass, freezer, 60)
    assert told(hass)[0] in ("1", "2")  # one sensor is enough
    hass.states.async_set(HALL, STATE_UNAVAILABLE)
    await wait(hass, freezer, 600)
    assert told(hass) == [STATE_UNKNOWN] * 3
    hass.states.async_set(DESK, "off")
    await wait(hass, freezer, 60)
    assert told(hass)[0] != STATE_UNKNOWN
    assert await hass.config_entries.async_reload(entry.entry_id)
    await hass.async_block_till_done()
    assert told(hass)[0] == STATE_UNKNOWN
    assert await hass.config_entries.async_unload(entry.entry_id)
    assert hass.states.get("sensor.office_people").state == STATE_UNAVAILABLE


async def test_a_counter_that_is_gone_or_is_for_other_sensors_is_told(hass, counter, freezer, tmp_path):
    (tmp_path / "counter.json").write_text(json.dumps({**counter, "sensor_names": ["a", "b"]}))
    entry = MockConfigEntry(domain="pirsim", data={"counter": "counter.json", "off_at": 0.9, "sensors": {HALL: HALL, "desk": DESK}})
    entry.add_to_hass(hass)
    assert not await hass.config_entries.async_setup(entry.entry_id)
    assert "other sensors: a, b" in entry.reason
    (tmp_path / "counter.json").unlink()
    assert not await hass.config_entries.async_reload(entry.entry_id)
    assert "counter.json" in entry.reason
