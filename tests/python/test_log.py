"""Logs of real sensors as arrays: what the command line writes, masked, in pandas, and refused as there."""

import csv
import io
import warnings

import numpy as np
import pytest

import pirsim

WIDE = """time,A,B,count
2025-10-26 02:00:00,0,0,0
2025-10-26 02:00:30,1,,1
2025-10-26 02:01:00,1,1,2
2025-10-26 02:01:30,0,1,
"""
EVENTS = """entity_id,state,last_changed
binary_sensor.a,off,2025-10-26T00:59:00Z
binary_sensor.a,on,2025-10-26T01:00:10Z
binary_sensor.a,off,2025-10-26T01:00:20Z
binary_sensor.a,on,2025-10-26T01:01:10Z
"""


@pytest.fixture
def wide(tmp_path):
    file = tmp_path / "wide.csv"
    file.write_text(WIDE)
    return file


def test_arrays_and_what_is_unknown(wide):
    log = pirsim.read_log(wide)
    assert log.sensors == ("A", "B")
    assert log.motion.tolist() == [[0, 0], [1, 2], [1, 1], [0, 1]] and log.motion.dtype == np.uint8
    assert log.people.tolist() == [0, 1, 2, -1]
    assert log.time[1] == np.datetime64("2025-10-26T02:00:30") and log.utc is None
    assert log.time_s.tolist() == [30, 60, 90, 120]
    assert log.masked.mean(axis=0).tolist() == pytest.approx([1 / 2, 2 / 3])
    assert log.interval_s == 30 and log.window_s == 30
    assert not log.motion.flags.writeable and not log.time.flags.writeable
    assert "4 windows of 30 s" in repr(log)


def test_rows_are_those_of_the_command_line(wide, tmp_path, command):
    command("log", wide, "-q", "--step", 60, "-o", tmp_path / "rows.csv")
    told = list(csv.DictReader(io.StringIO((tmp_path / "rows.csv").read_text())))
    log = pirsim.read_log(str(wide), window_s=60)
    assert [row["time"] for row in told] == [str(time)[:19] for time in log.time]
    text = {0: "0", 1: "1", 2: ""}
    assert [[row["A"], row["B"]] for row in told] == [[text[bit] for bit in row] for row in log.motion.tolist()]
    assert [row["people"] for row in told] == ["" if n < 0 else str(n) for n in log.people.tolist()]


def test_a_map_as_dict_and_summer_time(tmp_path):
    file = tmp_path / "events.csv"
    file.write_text(EVENTS)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        log = pirsim.read_log(file, {"time_zone": "Europe/Berlin", "sensors": {"PIR1": "binary_sensor.a"}}, window_s=60)
    assert log.sensors == ("PIR1",)
    assert log.motion[:, 0].tolist() == [0, 1, 1]
    assert log.utc.tolist() == [np.datetime64(f"2025-10-26T01:0{i}:00").astype("datetime64[us]").item() for i in range(3)]
    assert [str(time)[11:16] for time in log.time] == ["02:00", "02:01", "02:02"]  # an hour after 02:00 of summer time
    assert log.facts[0].pulses.n == 1 and log.facts[0].pulses.floor == 10
    assert 'time_zone: "Europe/Berlin"' in log.map


def test_what_a_log_tells(tmp_path):
    rng = np.random.default_rng(1)
    at, lines = 0.0, []
    for _ in range(2000):
        for sensor, after in (("A", 0.0), ("B", 2.0)):
            lines += [(at + after, sensor, "on"), (at + after + 3.0 + rng.exponential(1.0) * (rng.random() < 0.5), sensor, "off")]
        at += 60.0 + rng.exponential(60.0)
    file = tmp_path / "log.csv"
    file.write_text("time,sensor,state\n" + "".join(f"{t:.3f},{sensor},{state}\n" for t, sensor, state in sorted(lines)))
    log = pirsim.read_log(file, window_s=60)
    a = log.facts[0]
    assert a.pulses.floor == pytest.approx(3.0, abs=0.01) and a.pulses.floor_share > 0.5
    assert a.hold_s == 3.0
    assert a.pulses.n == pytest.approx(2000, abs=2) and a.pauses.floor > 50
    pair, = log.pairs
    assert (pair.a, pair.b) == ("A", "B") and pair.phi > 0.5
    assert pair.b_after_a_s == pytest.approx(2.0, abs=0.01) and pair.has_leader
    assert log.is_elapsed and log.time_s[0] == 60


def test_several_files(tmp_path):
    parts = [tmp_path / "1.csv", tmp_path / "2.csv"]
    parts[0].write_text("time_s,A\n1,0\n2,1\n")
    parts[1].write_text("time_s,A\n3,1\n4,0\n")
    assert pirsim.read_log(parts, window_s=1).motion[:, 0].tolist() == [0, 1, 1, 0]


def test_refusals_and_remarks(wide, tmp_path):
    with pytest.raises(pirsim.FileError):
        pirsim.read_log(tmp_path / "none.csv")
    with pytest.raises(pirsim.InputError, match="no column 'C'"):
        pirsim.read_log(wide, {"sensors": ["C"]})
    with pytest.raises(pirsim.InputError, match="senors"):
        pirsim.read_log(wide, {"senors": ["A"]})
    with pytest.raises(pirsim.UsageError, match="a window lasts"):
        pirsim.read_log(wide, window_s=0)
    wide.write_text(WIDE.replace("02:01:00,1,1", "02:00:30,1,1"))
    with pytest.warns(pirsim.InputWarning, match="a second reading has the same time"):
        pirsim.read_log(wide, {"rows": "readings"})


@pytest.mark.parametrize(("text", "told"), [
    ("time,motion\n" + "".join(f"{30 * i},{i % 4}\n" for i in range(1, 200)), "'2' is no state of 'motion'"),
    ("id,start,end,room\n" + "".join(f"{i},{90 * i},{90 * i + 9},{'ab'[i % 2]}\n" for i in range(30)), "'id' is another one in each row"),
    ("time,A\n" + "".join(f"2097-03-02 07:{i:02d}:00,{i // 5 % 2}\n" for i in range(60)), "later than tomorrow")])
def test_a_log_that_isn_t_plausible_is_refused_as_by_the_commands(tmp_path, text, told):
    file = tmp_path / "log.csv"
    file.write_text(text)
    with pytest.raises(pirsim.InputError, match=told):
        pirsim.read_log(file)


def test_pandas(wide):
    pandas = pytest.importorskip("pandas")
    frame = pirsim.read_log(wide).to_pandas()
    assert frame.columns.tolist() == ["time_s", "time", "people", "A", "B"]
    assert frame["B"].isna().tolist() == [False, True, False, False]
    assert frame["people"].sum() == 3 and frame["A"].mean() == 0.5
    assert frame["time"].iloc[0] == pandas.Timestamp("2025-10-26 02:00:00")
