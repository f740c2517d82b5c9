"""Counters compute what docs/formats/counter.md says, by every path of a short chain and by the page's own program."""

import concurrent.futures
import itertools
import json
import math
import os
import re

import numpy as np
import pytest

import pirsim
from pirsim import counting

SHAPES = [(1, 2, 1), (2, 3, 2), (3, 2, 2), (4, 2, 3)]  # sensors, counts, modes


def random_counter(shape, seed=0, n_rooms=3):
    """The second room at two livelinesses."""
    n_sensors, n_counts, modes = shape
    rng, n = np.random.default_rng([seed, *shape]), n_counts * modes
    weights = rng.dirichlet(np.ones(n_rooms + 1)).tolist()

    def version(liveliness):
        return {"liveliness": liveliness, "weight": weights.pop(),
                "emissions": rng.dirichlet(np.ones(n_sensors + 1), n).ravel().tolist()}

    rooms = [{"room": r + 1, "first": rng.dirichlet(np.ones(n)).tolist(),
              "moves": rng.dirichlet(np.ones(n), n).ravel().tolist(),
              "versions": [version(liveliness) for liveliness in ((0.5, 2.0) if r == 1 else (1.0,))]}
             for r in range(n_rooms)]
    return {"pirsim_counter": 2, "step_s": 30.0, "modes": modes, "sensors": n_sensors, "counts": n_counts,
            "rooms": rooms, "expected_error": [0.25, 0.5],
            "figures_off": {name: [0.5, 1.0] for name in ("occupied_h", "arrival_min", "departure_min", "most",
                                                          "hour_nobody", "hour_mean", "hour_most")}}


def models_of(saved):
    """(room, version) of each model."""
    return [(room, version) for room in saved["rooms"] for version in room["versions"]]


def random_bits(n, n_sensors, seed=0, unknown=0.2):
    rng = np.random.default_rng([seed, n, n_sensors])
    bits = (rng.random((n, n_sensors)) < 0.4).astype(np.uint8)
    bits[rng.random(bits.shape) < unknown] = 2
    bits[0] %= 2  # from there on a number is told
    return bits


@pytest.fixture
def load(tmp_path):
    def loaded(saved):
        file = tmp_path / "counter.json"
        file.write_text(saved if isinstance(saved, str) else json.dumps(saved))
        return counting.load(file)

    return loaded


def likelihood_of(emission, bits):
    """Of a state. A symbol's sensors are any of its size, all sets alike: those that agree with the known bits."""
    total = 0.0
    for active, probability in enumerate(emission):
        sets = list(itertools.combinations(range(len(bits)), active))
        agree = sum(all(bit == 2 or bit == (sensor in one) for sensor, bit in enumerate(bits)) for one in sets)
        total += probability * agree / len(sets)
    return total


def by_all_paths(saved, bits):
    """Smoothed and, of the last reading, forward probabilities: each is a share of all paths through the states."""
    n, modes = saved["counts"] * saved["modes"], saved["modes"]
    smoothed, last = np.zeros((len(bits), saved["counts"])), np.zeros(saved["counts"])
    for room, version in models_of(saved):
        emissions, moves = np.reshape(version["emissions"], (n, -1)), np.reshape(room["moves"], (n, n))
        seen = np.array([[likelihood_of(row, reading) for row in emissions] for reading in bits])
        own = np.zeros_like(smoothed)
        for path in itertools.product(range(n), repeat=len(bits)):
            p = room["first"][path[0]] * math.prod(moves[a, b] for a, b in zip(path, path[1:]))
            p *= math.prod(seen[i, state] for i, state in enumerate(path))
            for i, state in enumerate(path):
                own[i, state // modes] += p
        own /= own.sum(axis=1, keepdims=True)
        smoothed += version["weight"] * own
        last += version["weight"] * own[-1]
    return smoothed, last


@pytest.mark.parametrize("shape", SHAPES)
def test_every_path_of_a_short_chain(shape, load):
    saved = random_counter(shape)
    bits = random_bits(4, shape[0])
    bits[1] = 2  # nothing is known
    counter = load(saved)
    smoothed = counter.estimate(bits).probabilities
    forward = counter.estimate(bits, smoothed=False).probabilities
    np.testing.assert_allclose(smoothed, by_all_paths(saved, bits)[0], rtol=0, atol=1e-12)
    for i in range(len(bits)):
        np.testing.assert_allclose(forward[i], by_all_paths(saved, bits[:i + 1])[1], rtol=0, atol=1e-12)
    assert np.abs(smoothed - forward)[:-1].max() > 1e-3  # they are not the same thing


@pytest.fixture(scope="module")
def page_count(source):
    page = (source / "docs" / "formats" / "counter.md").read_text(encoding="utf-8")
    names = {}
    exec(re.search(r"```python\n(.*?)```", page, re.DOTALL)[1], names)
    return names["count"]


@pytest.mark.parametrize("shape", SHAPES)
def test_the_pages_program_counts_the_same(shape, load, page_count):
    saved, bits = random_counter(shape, seed=1), random_bits(700, shape[0])
    counter = load(saved)
    for smoothed in (True, False):
        estimates = counter.estimate(bits, smoothed=smoothed)
        expected = page_count(saved, bits, smoothed)
        np.testing.assert_allclose(estimates.probabilities, expected, rtol=0, atol=1e-12)
        assert estimates.people.tolist() == [next(n for n in range(shape[1]) if row[:n + 1].sum() >= 0.5 - 1e-9)
                                             for row in expected]
    other = random_counter(shape, seed=2)  # the comparison tells counters apart
    assert np.abs(counter.estimate(bits).probabilities - page_count(other, bits)).max() > 1e-3


@pytest.mark.parametrize("shape", SHAPES)
def test_live_counts_are_forward_counts(shape, load):
    counter, bits = load(random_counter(shape)), random_bits(60, shape[0])
    live = counter.live()
    assert live.people is None
    forward = counter.estimate(bits, smoothed=False)
    for i, reading in enumerate(bits):
        np.testing.assert_allclose(live.next(reading), forward.probabilities[i], rtol=0, atol=1e-12)
        assert live.people == forward.people[i]
    with pytest.raises(pirsim.UsageError, match=f"expected {shape[0]} bits"):
        live.next([0] * (shape[0] + 1))


def test_what_is_saved_is_read_back(load, tmp_path):
    saved = random_counter((2, 3, 2))
    counter = load(saved)
    counter.save(tmp_path / "again.json")
    assert json.loads((tmp_path / "again.json").read_text()) == saved
    assert (counter.step_s, counter.modes, counter.n_sensors, counter.n_counts) == (30.0, 2, 2, 3)
    assert counter.expected_error == (0.25, 0.5) and len(counter.rooms) == 4
    for room, (own, version) in zip(counter.rooms, models_of(saved)):
        assert (room.number, room.weight, room.liveliness) == (own["room"], version["weight"], version["liveliness"])
        assert room.first.tolist() == own["first"] and room.emissions.ravel().tolist() == version["emissions"]
        assert room.moves.ravel().tolist() == own["moves"]
    assert counter.weights.tolist() == [room.weight for room in counter.rooms]
    live = counter.live()  # outlives who made it
    del counter
    assert live.next([1, 0]).sum() == pytest.approx(1.0)


def changed(**changes):
    return {**random_counter((2, 3, 2)), **changes}


def changed_room(**changes):
    saved = random_counter((2, 3, 2))
    saved["rooms"][0].update(changes)
    return saved


def changed_version(**changes):
    saved = random_counter((2, 3, 2))
    saved["rooms"][0]["versions"][0].update(changes)
    return saved


def without(key):
    return {name: value for name, value in random_counter((2, 3, 2)).items() if name != key}


HOSTILE = [
    ("not JSON", "isn't a counter: "), ("", "isn't a counter: "), ("[]", "expected an object"),
    ("[" * 100_000, "isn't a counter"), ("7", "expected an object"),
    (changed(pirsim_counter=3), "this pirsim reads versions 1 and 2"), (changed(model="forest"), "by another model"),
    (changed(pirsim_counter=1), "'moves' is missing"), (without("rooms"), "'rooms' is missing"),
    (changed(sensors=3), "emissions: expected 24 values, got 18"), (changed(counts=4), "first: expected 8 values, got 6"),
    (changed(modes=1), "first: expected 3 values, got 6"),
    (changed(modes=2.5), "modes: expected a whole number"), (changed(counts=10**30), "counts: expected a whole number"),
    (changed(sensors=0), "sensors: expected a whole number"), (changed(modes="two"), "modes: expected a whole number"),
    (changed(step_s=0), "step_s: expected a number above 0"), (changed(step_s="30"), "isn't a counter as it should be"),
    (changed_room(moves="none"), "moves: expected a list"), (changed_room(moves=[True] * 36), "moves[0]: expected a number"),
    (changed_room(moves=[0.2] * 36), "doesn't add up to 1"), (changed_room(moves=[2.0, -1.0, 0, 0, 0, 0] * 6), "moves[0]: expected a number from 0 to 1"),
    (changed(rooms=[]), "weights don't add up to 1"), (changed(rooms=[5]), "rooms[0]: expected an object"),
    (changed_version(weight=-0.5), "weight: expected a number from 0"), (changed_version(weight=0.9), "weights don't add up to 1"),
    (changed_room(first=[0.5] * 6), "doesn't add up to 1"), (changed_version(emissions=[1.0, 0.0, 0.0] * 6), "emissions[1]: expected a number from 1e-100"),
    (changed_version(emissions=[1.0, 5e-324, 0.0] * 6), "emissions[1]: expected a number from 1e-100"), (changed(sensor_names=["a"]), "sensor_names: expected 2 values, got 1"),
    (changed(sensor_names=["a", "a"]), "'a' stands here twice"), (changed(sensor_names=[1, 2]), "isn't a counter as it should be"),
    (changed(holds_s=[-1, None]), "holds_s[0]: expected a number from 0"), (changed(holds_s=[1.0]), "holds_s: expected 2 values, got 1"),
    (changed(expected_error=3), "isn't a counter as it should be"),
    (json.dumps(changed()).replace("30.0", "NaN"), "isn't a counter"),
    (json.dumps(changed()).replace("30.0", "1e999"), "isn't a counter"),
]


@pytest.mark.parametrize("saved, why", HOSTILE, ids=range(len(HOSTILE)))
def test_a_file_that_is_no_counter_is_refused_in_a_line(saved, why, load):
    with pytest.raises(pirsim.InputError, match=re.escape(why)) as refused:
        load(saved)
    assert len(str(refused.value).splitlines()) == 1 and "counter.json: error: " in str(refused.value)


def test_a_counter_comes_through_a_pipe_and_an_endless_file_ends(tmp_path):
    saved = json.dumps(random_counter((2, 3, 2)))
    os.mkfifo(tmp_path / "pipe")
    with concurrent.futures.ThreadPoolExecutor() as pool:
        pool.submit((tmp_path / "pipe").write_text, saved)
        assert counting.load(tmp_path / "pipe").rooms[0].first.tolist() == json.loads(saved)["rooms"][0]["first"]
    with pytest.raises(pirsim.InputError, match="larger than 200 MB"):
        counting.load("/dev/zero")


def test_files_that_cant_be_read(tmp_path):
    with pytest.raises(pirsim.FileError):
        counting.load(tmp_path / "nowhere.json")
    (tmp_path / "bytes.json").write_bytes(bytes(range(128, 256)))
    with pytest.raises(pirsim.InputError):
        counting.load(tmp_path / "bytes.json")


@pytest.mark.parametrize("bits", [[[0, 3]], [[0, -1]], [[0, 0.5]], np.zeros((2, 2, 2)), [["on", "off"]], [[]]])
def test_what_is_no_bit_is_refused(bits, load):
    with pytest.raises(ValueError):
        load(random_counter((2, 3, 2))).estimate(bits)


def test_bits_in_any_form(load):
    counter, bits = load(random_counter((2, 3, 2))), random_bits(50, 2)
    expected = counter.estimate(bits).probabilities
    as_floats = np.where(bits == 2, np.nan, bits.astype(float))
    masked = np.ma.masked_array(bits == 1, bits == 2)
    for given in (as_floats, masked, np.ma.masked_array(bits, bits == 2, fill_value=1), bits.astype(int), np.asfortranarray(bits), bits.tolist()):
        assert np.array_equal(counter.estimate(given).probabilities, expected)
    assert counter.estimate(np.empty((0, 2))).people.shape == (0,)
    with pytest.raises(pirsim.InputError, match="for 2 sensors, and the log has 3"):
        counter.estimate(random_bits(5, 3))
    one = load(random_counter((1, 2, 1)))
    assert np.array_equal(one.estimate([0, 1, 1]).probabilities, one.estimate([[0], [1], [1]]).probabilities)
    assert one.estimate([0, 1, 1]).time.tolist() == [30.0, 60.0, 90.0]


def test_masked_bits_are_unknown_live_and_masked_people_in_training(load):
    counter, bits = load(random_counter((2, 3, 2))), random_bits(20, 2)
    live, masked = counter.live(), counter.live()
    for reading in bits:
        assert np.array_equal(masked.next(np.ma.masked_array(reading == 1, reading == 2)), live.next(reading))
    people = np.array([0, 1, 1, 0] * 5)
    hidden = people == 1
    hidden[:4] = False
    days = [counting.Day(1, bits, np.ma.masked_array(people, hidden)), counting.Day(1, bits, np.where(hidden, -1, people))]
    moves = [counting.train([day]).rooms[0].moves for day in days]
    assert np.array_equal(*moves) and not np.array_equal(moves[0], counting.train([days[0]._replace(people=people)]).rooms[0].moves)


def test_nobody_is_counted_where_nothing_has_been_known_for_five_minutes(load, tmp_path):
    counter, bits = load(random_counter((2, 3, 2))), random_bits(100, 2, unknown=0.0)
    bits[20:60] = 2
    bits[60:, 1] = 2  # one sensor is enough
    for smoothed, told in ((True, [*range(30), *range(50, 100)]), (False, [*range(30), *range(60, 100)])):
        estimates = counter.estimate(bits, smoothed)
        assert np.flatnonzero(estimates.people >= 0).tolist() == told
        assert np.array_equal(np.isnan(estimates.probabilities).any(axis=1), estimates.people == -1)
        assert np.array_equal(np.isnan(estimates.mean), estimates.people == -1)
        assert f"{100 - len(told)} unknown" in repr(estimates)
    live = counter.live()
    assert [live.next(reading)[0] >= 0 for reading in bits] == [i in told for i in range(100)]
    assert live.people is not None
    estimates.write_csv(tmp_path / "counts.csv")
    assert (tmp_path / "counts.csv").read_text().splitlines()[41] == "1230,,,,,,,"
    pytest.importorskip("pandas")
    assert estimates.to_pandas()["people"].isna().sum() == 30


def test_a_counter_remembers_its_sensors_holds_and_step(load, tmp_path):
    saved = {**random_counter((2, 3, 2)), "sensor_names": ["left", "right"], "holds_s": [10.0, None]}
    counter = load(saved)
    assert (counter.sensors, counter.holds_s) == (("left", "right"), (10.0, None))
    assert load(random_counter((2, 3, 2))).sensors is None
    counter.save(tmp_path / "again.json")
    assert json.loads((tmp_path / "again.json").read_text()) == saved
    write_log(tmp_path / "log.csv")
    counter.estimate(tmp_path / "log.csv", map={"sensors": {"left": "right", "right": "left"}})
    with pytest.raises(pirsim.InputError, match=r"2 sensors \(left, right\), and the log has 2: PIR1, PIR2"):
        counter.estimate(tmp_path / "log.csv", map={"sensors": {"PIR1": "right", "PIR2": "left"}})
    lines = (tmp_path / "log.csv").read_text().splitlines()
    (tmp_path / "slow.csv").write_text("\n".join([lines[0], *lines[1::10]]) + "\n")
    with pytest.raises(ValueError, match="a reading every 300 s and the counter one every 30 s"):
        counter.estimate(tmp_path / "slow.csv")
    events = ["time,sensor,state"]  # each pulse lasts 90 s at one, 2 s at the other
    for minute in range(0, 60, 2):
        for sensor, second, length in (("left", 0, 90), ("right", 20, 2)):
            for s, state in ((second, "on"), (second + length, "off")):
                events.append(f"2026-03-02T08:{minute + s // 60:02d}:{s % 60:02d},{sensor},{state}")
    (tmp_path / "events.csv").write_text("\n".join([events[0], *sorted(events[1:])]) + "\n")
    with pytest.warns(pirsim.errors.InputWarning, match="'left' holds motion for 90.0 s in this log, and for 10.0 s"):
        counter.estimate(tmp_path / "events.csv")


def write_log(file, n=240, seed=3):
    """A spreadsheet's: local times, a reading every half minute, some empty."""
    rng = np.random.default_rng(seed)
    begin = np.datetime64("2026-03-02T08:00:00")
    lines = ["time,left,right"]
    for i in range(n):
        bits = ["" if rng.random() < 0.05 else str(int(rng.random() < 0.3 * (60 < i < 200))) for _ in range(2)]
        lines.append(f"{begin + np.timedelta64(30 * (i + 1), 's')},{bits[0]},{bits[1]}")
    file.write_text("\n".join(lines) + "\n")


def test_logs_in_any_form(load, tmp_path):
    counter = load(random_counter((2, 3, 2)))
    write_log(tmp_path / "log.csv")
    expected = counter.estimate(tmp_path / "log.csv")
    log = pirsim.read_log(tmp_path / "log.csv")
    assert (log.motion == 2).any() and np.array_equal(expected.time, log.time)
    for given in (log, log.motion, str(tmp_path / "log.csv"), [tmp_path / "log.csv"]):
        assert np.array_equal(counter.estimate(given).probabilities, expected.probabilities)
    swapped = {"sensors": {"PIR1": "right", "PIR2": "left"}}
    assert np.array_equal(counter.estimate(tmp_path / "log.csv", map=swapped).probabilities, expected.probabilities)
    left = {"sensors": {"PIR1": "left"}}
    with pytest.raises(pirsim.InputError, match="for 2 sensors, and the log has 1"):
        counter.estimate(tmp_path / "log.csv", map=left)
    with pytest.raises(ValueError, match="windows of 60 s and the counter readings of 30 s"):
        counter.estimate(pirsim.read_log(tmp_path / "log.csv", window_s=60))
    with pytest.raises(TypeError, match="the log is no file"):
        counter.estimate(log, map=left)
    with pytest.raises(pirsim.FileError):
        counter.estimate(tmp_path / "nowhere.csv")


@pytest.mark.parametrize("forward", [[], ["--forward"]])
def test_a_log_is_counted_as_on_the_command_line(forward, load, command, tmp_path):
    pytest.importorskip("pandas")
    counter = load(random_counter((2, 3, 2)))
    write_log(tmp_path / "log.csv")
    printed = command("count", tmp_path / "counter.json", "--log", tmp_path / "log.csv", "-q", *forward)
    tables = {name: tmp_path / f"{name}.csv" for name in ("days", "hours")}
    command("count", tmp_path / "counter.json", "--log", tmp_path / "log.csv", "-q", *forward,
            "--by-day", tables["days"], "--by-hour", tables["hours"])
    estimates = counter.estimate(tmp_path / "log.csv", smoothed=not forward)
    estimates.write_csv(tmp_path / "counts.csv")
    assert (tmp_path / "counts.csv").read_bytes().decode() == printed and printed.count("\n") == 241
    rows = [line.split(",") for line in printed.splitlines()]
    frame = estimates.to_pandas()
    assert list(frame.columns) == rows[0] == ["time", "people", "mean", "least", "most", "p0", "p1", "p2"]
    assert frame[["least", "most"]].to_numpy().tolist() == [[int(end) for end in row[3:5]] for row in rows[1:]]
    assert (frame["least"] <= frame["people"]).all() and (frame["people"] <= frame["most"]).all()
    for name, figures in (("days", estimates.days), ("hours", estimates.hours)):
        lines = [line.split(",") for line in tables[name].read_text().splitlines()]
        assert lines[0] == list(figures) and len(lines) > 1
        for i, cells in enumerate(zip(*lines[1:])):
            column = figures[lines[0][i]]
            told = [cell == "" if column.dtype.kind == "f" and np.isnan(value) else
                    cell == value if column.dtype.kind == "U" else abs(float(cell) - value) < 0.000501
                    for cell, value in zip(cells, column)]
            assert all(told), lines[0][i]
        assert np.isnan(figures["most_off"]).all() if forward else np.nanmin(figures["most_off"]) > 0
    assert [str(time.astype("datetime64[s]")) for time in estimates.time] == [row[0] for row in rows[1:]]
    assert frame["people"].tolist() == [int(row[1]) for row in rows[1:]]
    np.testing.assert_allclose(frame[["mean"]].to_numpy()[:, 0], [float(row[2]) for row in rows[1:]], atol=0.00501)
    np.testing.assert_allclose(frame[["p0", "p1", "p2"]].to_numpy(), [[float(p) for p in row[5:]] for row in rows[1:]],
                               atol=0.000501)
