"""The component in Home Assistant's own test harness."""

import json
import pathlib
import random
import sys
import threading
import time
from datetime import timedelta

import pytest
from counters import doubting_counter, table

pytest.importorskip("pytest_homeassistant_custom_component", reason="needs Home Assistant's test harness, of Python 3.12 or later")
sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
import custom_components  # noqa: E402

custom_components.__path__ = [str(pathlib.Path(__file__).parents[1] / "custom_components")]  # the harness has its own

from homeassistant.const import STATE_UNAVAILABLE, STATE_UNKNOWN  # noqa: E402
from homeassistant.core import State  # noqa: E402
from homeassistant.data_entry_flow import FlowResultType  # noqa: E402
from homeassistant.util import dt  # noqa: E402
from pytest_homeassistant_custom_component.common import (  # noqa: E402
    MockConfigEntry, async_fire_time_changed, mock_restore_cache_with_extra_data)

HALL, DESK = "binary_sensor.hall", "binary_sensor.desk"
pytestmark = pytest.mark.usefixtures("enable_custom_integrations")


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


async def test_unavailable_sensors_are_unknown_and_a_reload_goes_on(hass, counter, freezer):
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
    assert told(hass)[0] == STATE_UNKNOWN  # until a reading has ended
    await wait(hass, freezer, 30)
    assert told(hass)[0] != STATE_UNKNOWN
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


def clock_steps(entry, freezer, seconds):
    live, ticks = entry.runtime_data.live, time.monotonic()
    freezer.tick(timedelta(seconds=seconds))
    aside = time.monotonic() - ticks
    live._monotonic = lambda: time.monotonic() - aside


async def away(hass, entry, freezer, seconds):
    assert await hass.config_entries.async_unload(entry.entry_id)
    freezer.tick(timedelta(seconds=seconds))
    assert await hass.config_entries.async_setup(entry.entry_id)
    await hass.async_block_till_done()


async def unavailable(hass, freezer, seconds):
    for sensor in (HALL, DESK):
        hass.states.async_set(sensor, STATE_UNAVAILABLE)
    await wait(hass, freezer, seconds)


@pytest.mark.parametrize("happens, seconds", [
    ("start", 0), *[("unavailable", 60 * minutes) for minutes in (10, 30, 120)], *[("away", s) for s in (2, 299, 600, 7200)],
    *[("step", s) for s in (10, 3600, 1e7, -10, -3600, -1e7)]])
async def test_a_silent_night_never_turns_occupancy_on(happens, seconds, hass, counter, freezer, tmp_path):
    (tmp_path / "counter.json").write_text(json.dumps(doubting_counter([HALL, "desk"])))
    for sensor in (HALL, DESK):
        hass.states.async_set(sensor, "off")
    entry = await entry_of(hass, freezer)
    if happens != "start":
        hass.states.async_set(HALL, "on")
        hass.states.async_set(HALL, "off")
        await wait(hass, freezer, 60)
        assert told(hass)[2] == "on"
    became = []
    hass.bus.async_listen("state_changed", lambda event: became.append((event.data["entity_id"], event.data["new_state"].state)))
    if happens == "unavailable":
        await unavailable(hass, freezer, seconds)
        assert told(hass)[2] == STATE_UNKNOWN
    elif happens == "away":
        await away(hass, entry, freezer, seconds)
    elif happens == "step":
        clock_steps(entry, freezer, seconds)
    for sensor in (HALL, DESK):
        hass.states.async_set(sensor, "off")
    for _ in range(360):  # 24 hours
        freezer.tick(timedelta(seconds=240))
        entry.runtime_data._tick(None)  # the harness' timers wait for a clock that stepped back
        await hass.async_block_till_done()
    occupancy = [state for entity, state in became if entity == "binary_sensor.office_occupancy"]
    was_on_before = happens == "away" and seconds < 300  # and goes on
    assert ("on" in occupancy) == was_on_before, occupancy
    assert became


@pytest.mark.parametrize("seconds", [3600, 30 * 86400, -3600])
async def test_a_step_of_the_clock_computes_nothing_and_makes_all_unknown(seconds, hass, counter, freezer, monkeypatch):
    hass.states.async_set(HALL, "off")
    hass.states.async_set(DESK, "on")
    entry = await entry_of(hass, freezer)
    await wait(hass, freezer, 300)
    assert told(hass)[2] == "on"
    n, step = [], type(entry.runtime_data.live.counter)._step
    monkeypatch.setattr(type(entry.runtime_data.live.counter), "_step", lambda *more: n.append(1) or step(*more))
    clock_steps(entry, freezer, seconds)
    entry.runtime_data._tick(None)
    await hass.async_block_till_done()
    assert not n and told(hass) == [STATE_UNKNOWN] * 3
    for _ in range(4):
        freezer.tick(timedelta(seconds=30))
        entry.runtime_data._tick(None)
    await hass.async_block_till_done()
    assert told(hass) == [STATE_UNKNOWN] * 3  # until they say something again
    hass.states.async_set(DESK, "off")
    hass.states.async_set(HALL, "on")
    await hass.async_block_till_done()
    assert told(hass)[2] == "on"


async def test_missed_readings_are_counted_beside_the_event_loop(hass, counter, freezer, monkeypatch):
    hass.states.async_set(HALL, "on")
    entry = await entry_of(hass, freezer)
    await wait(hass, freezer, 60)
    of_loop, step = threading.get_ident(), type(entry.runtime_data.live.counter)._step
    threads = []
    monkeypatch.setattr(type(entry.runtime_data.live.counter), "_step",
                        lambda *more: threads.append(threading.get_ident()) or step(*more))
    await away(hass, entry, freezer, 7200)
    assert len(threads) == 240 and of_loop not in threads


@pytest.mark.parametrize("state", [None, 1, [], {}, {"counter": "x"}, {"beliefs": [[float("nan")]]}])
async def test_a_saved_state_that_is_none_is_begun_anew(state, hass, counter, freezer, caplog):
    entity = "binary_sensor.office_occupancy"
    mock_restore_cache_with_extra_data(hass, [(State(entity, "on"), state)])
    hass.states.async_set(HALL, "off")
    hass.states.async_set(DESK, "off")
    await entry_of(hass, freezer)
    assert told(hass)[2] == STATE_UNKNOWN
    assert not state or "begins anew" in caplog.text
    await wait(hass, freezer, 300)
    assert told(hass)[0] == "0" and told(hass)[2] == "off"


@pytest.mark.parametrize("seed", range(3))
async def test_states_clocks_and_restarts_at_random(seed, hass, counter, freezer, tmp_path):
    (tmp_path / "counter.json").write_text(json.dumps(doubting_counter([HALL, "desk"])))
    draw = random.Random(seed)
    entry = await entry_of(hass, freezer)
    n_on = 0
    for _ in range(250):
        before, happens, sensor = told(hass)[2], draw.random(), draw.choice((HALL, DESK))
        live = entry.runtime_data.live
        may_turn_on = any(live.counter._states.values()) or bool(live.counter._moved)
        if happens < 0.2:
            hass.states.async_set(sensor, "on")
            may_turn_on = True
        elif happens < 0.45:
            hass.states.async_set(sensor, draw.choice(("off", STATE_UNKNOWN, STATE_UNAVAILABLE, "On", "1", "", "x" * 255)))
        elif happens < 0.5:
            hass.states.async_remove(sensor)
        elif happens < 0.85:
            for _ in range(draw.randrange(1, 20)):
                freezer.tick(timedelta(seconds=draw.choice((1, 30, 100, 290))))
                entry.runtime_data._tick(None)
        elif happens < 0.92:
            clock_steps(entry, freezer, draw.choice((-1, 1)) * 10 ** draw.uniform(-1, 6))
            entry.runtime_data._tick(None)
        else:
            await away(hass, entry, freezer, draw.choice((-1, 1, 1, 1)) * 10 ** draw.uniform(-1, 5))
            now = [hass.states.get(one) for one in (HALL, DESK)]
            may_turn_on = may_turn_on or any(one is not None and one.state == "on" for one in now)
        await hass.async_block_till_done()
        assert told(hass)[2] != "on" or before == "on" or may_turn_on, (seed, happens)
        n_on += told(hass)[2] == "on" != before
        if entry.runtime_data.live.counter.last is not None and told(hass)[1] not in (STATE_UNKNOWN, STATE_UNAVAILABLE):
            assert 0 <= float(told(hass)[1]) <= 100
    assert n_on > 5
