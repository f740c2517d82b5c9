"""Arrays and frames hold what the command line writes, value by value."""

import csv
import io

import numpy as np
import pytest

import pirsim

SCHEDULE = """
pirsim_script: 1
seed: 3
replicates: 2
schedule:
  first_day: 2026-03-02
  from: 08:00
  to: 08:20
  staff: [{role: staff, count: 3}]
  arrival: {mean: 08:06, sd_min: 3}
"""


def rows_of(text):
    header, *rows = csv.reader(io.StringIO(text))
    return header, rows


def as_text(value):
    if isinstance(value, (float, np.floating)):
        return np.format_float_positional(value, trim="-")
    if isinstance(value, np.datetime64):
        return str(value.astype("datetime64[s]"))
    return str(value)


def columns_of(result):
    """As texts, from the arrays alone."""
    run, second = np.nonzero(result.valid)
    columns = {"replicate": result.replicate[run], "trial": result.trial[run], "time_s": result.time[second],
               "phase": result.phase[run, second], "people": result.people[run, second]}
    if result.clock is not None:
        columns["time"] = result.clock[run, second]
    for i, area in enumerate(result.areas):
        columns["people_" + area] = result.people_of_areas[run, second, i]
    for i, door in enumerate(result.doors):
        columns["door_" + door] = result.door_open[run, second, i]
    for i, sensor in enumerate(result.sensors):
        columns[sensor] = result.bits[run, second, i]
    return {name: [as_text(value) for value in column] for name, column in columns.items()}


def assert_same(columns, header, rows):
    assert sorted(columns) == sorted(header)
    assert len(rows) > 0
    for i, name in enumerate(header):
        assert columns[name] == [row[i] for row in rows], name


@pytest.fixture(scope="module")
def cases(tmp_path_factory, data):
    schedule = tmp_path_factory.mktemp("scripts") / "schedule.yaml"
    schedule.write_text(SCHEDULE)
    rooms, studies = data / "rooms", data / "studies"
    return {
        "study A": (rooms / "meeting_room.gltf", studies / "studyA.yaml", {"replicates": 2}),
        "several people, runs of different length": (
            rooms / "open_office.gltf", studies / "office.yaml",
            {"replicates": 2, "effects": [{"false_triggers": {"rate_per_s": 0.01}}]}),
        "other windows": (rooms / "meeting_room.gltf", studies / "studyA.yaml",
                          {"replicates": 1, "sensing.window_s": 0.5, "people.0.stature_m": 1.6}),
        "analog": (rooms / "meeting_room.gltf", studies / "studyA.yaml",
                   {"replicates": 1, "sensing.response": "analog", "trials.for_each.seat": ["S1"]}),
        "days": (rooms / "open_office.gltf", schedule, {}),
        "areas": (rooms / "two_rooms.gltf", studies / "two_rooms.yaml", {"sensing.response": "zones"}),
        "home": (rooms / "flat.gltf", studies / "flat_week.yaml",
                 {"replicates": 1, "sensing.response": "zones", "sensing.tick_rate_hz": 2}),
    }


CASES = ["study A", "several people, runs of different length", "other windows", "analog", "days", "areas", "home"]


def options(changes):
    return [part for change in pirsim._inputs.as_overrides(changes) for part in ("--set", change)]


@pytest.mark.parametrize("case", CASES)
def test_arrays_equal_the_command_lines_rows(case, cases, command):
    scene, script, changes = cases[case]
    header, rows = rows_of(command("--scene", scene, "--script", script, "-q", *options(changes)))
    result = pirsim.run(pirsim.compile(scene, script, set=changes))
    assert_same(columns_of(result), header, rows)


def test_frames_equal_the_command_lines_rows(cases, command):
    pytest.importorskip("pandas"), pytest.importorskip("polars"), pytest.importorskip("xarray")
    for case in ("several people, runs of different length", "days", "areas"):
        scene, script, changes = cases[case]
        header, rows = rows_of(command("--scene", scene, "--script", script, "-q", *options(changes)))
        result = pirsim.run(pirsim.compile(scene, script, set=changes))
        pandas = result.to_pandas()
        assert list(pandas.columns) == header
        assert_same({name: [as_text(v) for v in pandas[name].to_numpy()] for name in header}, header, rows)
        polars = result.to_polars()
        assert polars.columns == header
        assert_same({name: [as_text(v) for v in polars[name].to_numpy()] for name in header}, header, rows)
        xarray = result.to_xarray()
        areas = {"area": len(result.areas)} if result.areas else {}
        assert dict(xarray.sizes) == dict(zip(("run", "time", "sensor"), result.bits.shape)) | areas
        assert xarray["people"].isel(run=1).sum() == result.people[1].sum()


def test_zones_occupants_and_signals_equal_the_command_lines(data, room, study_a, command, tmp_path):
    changes = {"replicates": 1, "trials.for_each.seat": ["S3", "S8"], "people.0.actions.3.work.duration_s": 20}
    inputs = ("--scene", room, "--script", study_a, "-q", *options(changes))
    command(*inputs, "-o", tmp_path / "rows.csv", "--zones", tmp_path / "zones.csv", "--occupants",
            tmp_path / "occupants.csv")
    model = pirsim.compile(room, study_a, set=changes)
    result = pirsim.run(model, zones=True, occupants=True)
    header, rows = rows_of((tmp_path / "zones.csv").read_text())
    sensor_of_zone = np.zeros(result.zones[0].shape[1], dtype=int)
    sensor_of_zone[model.rays.zone] = model.rays.sensor
    for row in rows:
        _, trial, tick, sensor, zones = row
        active = result.zones[model.trials.index(trial)][int(tick) - 1]
        assert "".join(map(str, active[sensor_of_zone == result.sensors.index(sensor)])) == zones
    assert len(rows) == sum(len(zones) for zones in result.zones) * len(result.sensors)
    header, rows = rows_of((tmp_path / "occupants.csv").read_text())
    mine = result.occupants
    assert [float(row[header.index("time_s")]) for row in rows] == mine["time_s"].tolist()
    for name in ("person", "activity", "seat"):
        assert [row[header.index(name)] for row in rows] == mine[name].tolist()
    assert [float(row[header.index("x_m")]) for row in rows] == pytest.approx(mine["x_m"], abs=1e-3)

    analog = {**changes, "sensing.response": "analog"}
    inputs = ("--scene", room, "--script", study_a, "-q", *options(analog))
    command(*inputs, "-o", tmp_path / "rows.csv", "--trace", tmp_path / "trace.csv")
    signals = pirsim.run(pirsim.compile(room, study_a, set=analog), signals=True).signals
    header, rows = rows_of((tmp_path / "trace.csv").read_text())
    assert len(rows) == len(signals["tick"]) > 1000
    assert [row[header.index("part")] for row in rows] == signals["part"].tolist()
    assert [float(row[header.index("signal_v")]) for row in rows] == pytest.approx(signals["signal_v"], abs=1e-5)
    assert [row[header.index("output")] == "1" for row in rows] == signals["output"].tolist()


def test_areas_count_the_people_in_them(data, cases):
    scene, script, changes = cases["areas"]
    model = pirsim.compile(scene, script, set=changes)
    result = pirsim.run(model, occupants=True)
    assert model.areas == result.areas == ("living_room", "bedroom")
    assert np.array_equal(result.people_of_areas.sum(axis=2), result.people)
    there = result.occupants
    for area in result.areas:
        assert result.people_in(area).sum() == (there["area"] == area).sum() > 0
    with pytest.raises(KeyError, match="did you mean 'bedroom'"):
        result.people_in("bedrom")
    assert np.array_equal(pirsim.trace(model, runs=[0]).emit().people_of_areas[0], result.people_of_areas[0])

    made = pirsim.read_scene(scene)
    assert [area.id for area in made.areas] == ["living_room", "bedroom"] and "2 areas" in repr(made)
    made.areas[1] = pirsim.Area("den", pirsim.Floor.rectangle(6, -4, 8, 0))
    made.sensors[0].area = "den"
    other = pirsim.run(pirsim.compile(made, script, set=changes))
    assert other.areas == ("living_room", "den", "elsewhere")
    assert np.array_equal(other.people_of_areas.sum(axis=2), result.people)
    made.sensors[0].area = "dn"
    with pytest.raises(pirsim.InputError, match=r"there is no area 'dn' \(did you mean 'den'"):
        pirsim.compile(made, script)
    plain = pirsim.run(pirsim.compile(*cases["days"][:2]), [0], occupants=True)
    assert plain.areas == () and plain.people_of_areas.shape[2] == 0 and "area" not in plain.occupants


def test_any_runs_in_any_order_are_the_studys(room, study_a):
    model = pirsim.compile(room, study_a, set={"replicates": 3})
    whole = pirsim.run(model)
    assert whole.run.tolist() == list(range(30))
    assert whole.trial[:10].tolist() == list(model.trials)
    for runs in (range(4, 9), [7, 3, 22], model.runs_of("S8"), 5, np.array([1, 2])):
        part = pirsim.run(model, runs, threads=1)
        asked = np.atleast_1d(runs)
        assert part.run.tolist() == asked.tolist()
        assert part.replicate.tolist() == whole.replicate[asked].tolist()
        seconds = part.bits.shape[1]
        assert np.array_equal(part.bits, whole.bits[asked, :seconds])
        assert not whole.valid[asked, seconds:].any()
    assert set(pirsim.run(model, model.runs_of("S8")).trial) == {"S8"}
    empty = pirsim.run(model, [])
    assert empty.bits.shape == (0, 0, 5)


def test_shapes_types_and_counts(room, study_a):
    model = pirsim.compile(room, study_a, set={"replicates": 1})
    result = pirsim.run(model)
    runs, seconds, sensors = result.bits.shape
    assert (runs, sensors) == (10, 5)
    assert (result.bits.dtype, result.people.dtype, result.valid.dtype) == (np.uint8, np.uint16, np.bool_)
    assert result.people.shape == result.valid.shape == result.phase.shape == (runs, seconds)
    assert result.time.tolist() == [i + 1.0 for i in range(seconds)]
    for array in (result.bits, result.people, result.valid, result.time, result.phase, result.phase_code, result.run,
                  result.replicate, result.trial):
        assert not array.flags.writeable
        with pytest.raises(ValueError):
            array[0] = 0
    assert not result.bits[~result.valid].any() and not result.people[~result.valid].any()
    assert (result.phase[~result.valid] == "").all()
    working = result.motion_windows(["working"])
    assert working.shape == (runs, sensors)
    for run in range(runs):
        assert working[run].tolist() == result.bits[run][result.phase[run] == "working"].sum(axis=0).tolist()
    assert (result.motion_windows() >= working).all()
    with pytest.warns(UserWarning, match="no row of these runs has a phase 'workin'.*did you mean 'working'"):
        assert not result.motion_windows(["workin"]).any()
    assert model.sensors.position_m.shape == (5, 3) and model.sensors.names == result.sensors
    assert np.allclose(np.linalg.norm(model.seats.forward, axis=1), 1)
    assert model.rays.origin.shape == model.rays.direction.shape == (len(model.rays.range_m), 3)
