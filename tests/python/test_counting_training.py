"""Counters learn what their data were made with, from datasets and arrays, and are calibrated as on the command line."""

import collections
import csv
import gzip
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from test_counting import write_log

import pirsim
from pirsim import counting

COUNT_MOVES = np.array([[0.98, 0.02, 0.0], [0.02, 0.96, 0.02], [0.0, 0.03, 0.97]])
EMISSIONS = np.array([[0.95, 0.04, 0.01], [0.3, 0.5, 0.2], [0.9, 0.05, 0.05], [0.2, 0.3, 0.5], [0.7, 0.25, 0.05],
                      [0.05, 0.25, 0.7]])  # [count * 2 + mode, sensors with motion]


def state_moves(stays):
    """Between counts as above; a mode stays, and is drawn anew when the count changes."""
    same = np.kron(np.eye(3), np.array([[stays, 1 - stays], [1 - stays, stays]]))
    return np.kron(COUNT_MOVES, np.ones((2, 2))) * np.where(same > 0, same, 0.5)


def simulated(rng, room, n=1500):
    """A day of two sensors, of which a lone one is either."""
    moves, states = np.cumsum(state_moves(0.95), axis=1), np.zeros(n, int)
    for i in range(1, n):
        states[i] = np.searchsorted(moves[states[i - 1]], rng.random() * moves[states[i - 1], -1])
    symbols = (rng.random(n)[:, None] > np.cumsum(EMISSIONS, axis=1)[states, :2]).sum(axis=1)
    lone = rng.integers(2, size=n)
    bits = np.column_stack([(symbols == 2) | (symbols == 1) & (lone == sensor) for sensor in range(2)])
    return counting.Day(room, bits.astype(np.uint8), states // 2)


@pytest.fixture(scope="module")
def trainings():
    """Emissions [training, state, symbol] and moves [training, state, state]. The rooms are alike, and shrinkage makes
    one model of them."""
    counters = [counting.train([simulated(rng, room) for room in range(8)], modes=2, shrinkage=1e9, iterations=200)
                for rng in (np.random.default_rng([5, repeat]) for repeat in range(8))]
    return np.array([c.rooms[0].emissions for c in counters]), np.array([c.rooms[0].moves for c in counters])


def most_errors(estimates, truth):
    """How many standard errors the mean of the trainings is from the truth, where that is above 0. Standard errors are
    those of the trainings: 0.0005 (of rare moves) to 0.005."""
    standard = estimates.std(axis=0, ddof=1) / np.sqrt(len(estimates))
    assert standard.max() < 0.006
    possible = truth > 0
    return (np.abs(estimates.mean(axis=0) - truth)[possible] / standard[possible]).max()


def test_training_recovers_a_known_model(trainings):
    emissions, moves = trainings
    assert most_errors(emissions, EMISSIONS) < 5
    assert most_errors(moves, state_moves(0.95)) < 5
    assert moves[:, state_moves(0.95) == 0].max() < 1e-3  # two people at once come and go in none of them


def test_twins_of_that_model_arent_recovered(trainings):
    emissions, moves = trainings
    assert most_errors(moves, state_moves(0.93)) > 5
    assert most_errors(emissions, 0.97 * EMISSIONS + 0.03 * EMISSIONS[:, ::-1]) > 5
    rng = np.random.default_rng(7)
    shuffled = [day._replace(people=rng.permutation(day.people)) for day in (simulated(rng, room) for room in range(8))]
    wrong = counting.train(shuffled, modes=2, shrinkage=1e9, iterations=50)
    assert np.abs(wrong.rooms[0].emissions - EMISSIONS).max() > 0.1


def test_threads_and_the_order_of_rooms_change_no_bit():
    days = [simulated(np.random.default_rng(room), room, n=200) for room in range(5)]
    one = counting.train(days, threads=1)
    other = counting.train(days[::-1], threads=3)
    assert [room.number for room in other.rooms] == list(range(5))
    for a, b in zip(one.rooms, other.rooms):
        assert np.array_equal(a.emissions, b.emissions) and np.array_equal(a.first, b.first)
        assert np.array_equal(a.moves, b.moves)
    assert one.weights.tolist() == [0.2] * 5


def test_what_cant_be_learnt_from_is_refused():
    day = simulated(np.random.default_rng(1), 1, n=50)
    with pytest.raises(ValueError, match="hidden_markov, logistic, trees, got 'forest'"):
        counting.train([day], model="forest")
    for wrong in (day, [day.motion], [tuple(day)]):
        with pytest.raises(TypeError, match="a list of pirsim.counting.Day"):
            counting.train(wrong)
    with pytest.raises(TypeError, match="mode"):
        counting.train([day], mode=3)
    for setting, value in (("modes", 0), ("modes", 101), ("iterations", 0), ("shrinkage", -1), ("shrinkage", float("nan"))):
        with pytest.raises(ValueError, match=setting):
            counting.train([day], **{setting: value})
    with pytest.raises(ValueError, match="1 or 2 sensors"):
        counting.train([day, day._replace(room=2, motion=day.motion[:, :1])])
    assert counting.train([day, day._replace(room=2, motion=day.motion[:, :1])], sensors=1).n_sensors == 1
    with pytest.raises(ValueError, match="no room has 3"):
        counting.train([day], sensors=3)
    for people in (day.people[:-1], day.people + 0.5, day.people - 2, day.people + 1000, day.people > 0):
        with pytest.raises(ValueError, match="room 1: expected"):
            counting.train([day._replace(people=people)])
    with pytest.raises(pirsim.InputError, match="nobody is in any of the rooms"):
        counting.train([day._replace(people=day.people * 0)])
    with pytest.raises(pirsim.InputError, match="no room"):
        counting.train([])
    with pytest.raises(pirsim.FileError, match="no datapackage.json"):
        counting.train("nowhere")


# -- datasets --------------------------------------------------------------------------------------------------------

def rows_of(file):
    with gzip.open(file, "rt", newline="") as text:
        return list(csv.DictReader(text))


def test_a_datasets_days_are_its_rows_joined(dataset):
    package = json.loads((dataset / "datapackage.json").read_text())
    for part in ("train", "validation", "test_days", "test_rooms"):
        [resource] = [one for one in package["resources"] if one["name"] == part]
        days = counting.read_dataset(dataset, part)
        assert len(days) == len(resource["path"]) > 0
        for day, path in zip(days, resource["path"]):
            rows = rows_of(dataset / path)
            assert day.room == int(rows[0]["room"]) and len(day.people) == len(rows) // 30
            sensors = [name for name in rows[0] if re.fullmatch(r"PIR\d+", name) and rows[0][name]]
            for i in range(len(day.people)):
                own = rows[30 * i:30 * (i + 1)]
                assert day.motion[i].tolist() == [int(any(row[name] == "1" for row in own)) for name in sensors]
                assert day.people[i] == int(own[-1]["people"])
    with pytest.raises(pirsim.UsageError, match="got 'training'"):
        counting.read_dataset(dataset, "training")
    with pytest.raises(ValueError, match="whole number of the dataset's rows"):
        counting.read_dataset(dataset, step_s=2.5)


def shell(*arguments, code=0):
    done = subprocess.run([sys.executable, "-m", "pirsim.counting", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stderr


def test_the_shell_trains_and_counts_as_python_does(dataset, tmp_path):
    shell("train", dataset, "-o", tmp_path / "shell.json")
    counter = counting.train(dataset)
    counter.save(tmp_path / "python.json")
    assert (tmp_path / "shell.json").read_bytes() == (tmp_path / "python.json").read_bytes()
    write_log(tmp_path / "log.csv")
    shell("estimate", tmp_path / "shell.json", "--log", tmp_path / "log.csv", "--forward", "-o", tmp_path / "shell.csv")
    counter.estimate(tmp_path / "log.csv", smoothed=False).write_csv(tmp_path / "python.csv")
    assert (tmp_path / "shell.csv").read_bytes() == (tmp_path / "python.csv").read_bytes()
    assert "no datapackage.json" in shell("train", tmp_path, "-o", tmp_path / "none.json", code=4)
    assert "isn't a counter" in shell("estimate", tmp_path / "log.csv", "--log", tmp_path / "log.csv", "-o", "x", code=3)
    assert "sensors: no room has 7" in shell("train", dataset, "--sensors", "7", "-o", tmp_path / "none.json", code=2)
    assert not (tmp_path / "none.json").exists()


def test_the_shell_writes_over_nothing_that_it_reads(dataset, tmp_path):
    counting.train(dataset).save(tmp_path / "counter.json")
    write_log(tmp_path / "log.csv")
    (tmp_path / "map.yaml").write_text("pirsim_log: 1\n")
    (tmp_path / "link.csv").symlink_to("log.csv")
    (tmp_path / "hard.csv").hardlink_to(tmp_path / "log.csv")
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    for output in before:
        told = shell("estimate", tmp_path / "counter.json", "--log", tmp_path / "log.csv", "--map", tmp_path / "map.yaml",
                     "-o", output, code=2)
        assert f"and -o are one file: '{output}'" in told
    for log in (tmp_path / "link.csv", pirsim.read_log(tmp_path / "log.csv")):
        estimates = counting.load(tmp_path / "counter.json").estimate(log)
        for output in (tmp_path / "log.csv", tmp_path / "hard.csv"):
            with pytest.raises(pirsim.UsageError, match="log and file are one file"):
                estimates.write_csv(output)
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before
    for table in (dataset / "datapackage.json", dataset / "rooms.csv", next(dataset.glob("rows/*/*"))):
        content = table.read_bytes()
        assert "DATASET and -o are one file" in shell("train", dataset, "-o", table, code=2)
        assert table.read_bytes() == content
    for place in (tmp_path, tmp_path / "none" / "counter.json"):
        assert "can't write: " in shell("train", dataset, "-o", place, code=4)


def test_a_file_stays_if_the_new_one_cannot_be_written_whole(dataset, tmp_path, monkeypatch):
    file = tmp_path / "counts.csv"
    file.write_text("before")
    counter = counting.train(dataset)
    counts = counter.estimate(np.zeros((4, counter.n_sensors)))
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(OSError):
        counts.write_csv(file)
    assert [(one.name, one.read_text()) for one in tmp_path.iterdir()] == [("counts.csv", "before")]


POOL = """
pirsim_recipe: 1
name: Pool
seed: 5
rooms:
  - count: 12
    width_m: [3.5, 5]
    depth_m: 4
    seats: 2
    sensors: [{mount: corner, count: 2, height_m: 2.4, tilt_deg: [15, 55], model: EKMC1601111}]
people: [1, 2]
days: 1
sensing: {tick_rate_hz: 10, response: zones}
schedule: {first_day: "2026-03-02", from: "08:00", to: "09:00", staff: [{count: 2}], arrival: {mean: "08:15", sd_min: 10}}
exports: []
"""


def test_a_calibration_equals_the_command_lines(command, tmp_path):
    (tmp_path / "pool.yaml").write_text(POOL)
    write_log(tmp_path / "log.csv", n=120)  # all of it in the hours of the recipe
    made = tmp_path / "made"
    command("calibrate", tmp_path / "pool.yaml", "--log", tmp_path / "log.csv", "-q", "-o", made)
    found = counting.calibrate(made / "pool", tmp_path / "log.csv")
    found.counter.save(tmp_path / "counter.json")
    assert (tmp_path / "counter.json").read_bytes() == (made / "counter.json").read_bytes()
    told = json.loads((made / "calibration.json").read_text())
    assert (found.finding, found.p, found.effective_rooms) == (told["finding"], told["p"], told["effective_rooms"])
    assert list(found.counter.expected_error) == told["expected_error"]
    assert [one.name for one in found.parameters] == [one["name"] for one in told["parameters"]]
    assert [one.of_log for one in found.statistics] == [one["log"] for one in told["statistics"]]
    of_versions = collections.defaultdict(float)
    for model in found.counter.rooms:
        of_versions[model.number] += model.weight
    assert {room.number: room.weight for room in found.rooms} == pytest.approx(of_versions, rel=1e-12)
    # Weighed by a log's counts, too.
    lines = (tmp_path / "log.csv").read_text().splitlines()
    counted = [lines[0] + ",people", *(line + f",{int(i > 60)}" for i, line in enumerate(lines[1:]))]
    (tmp_path / "counted.csv").write_text("\n".join(counted) + "\n")
    command("calibrate", tmp_path / "pool.yaml", "--log", tmp_path / "counted.csv", "-q", "-o", made)
    labelled = counting.calibrate(made / "pool", tmp_path / "counted.csv").counter
    labelled.save(tmp_path / "counter.json")
    assert (tmp_path / "counter.json").read_bytes() == (made / "counter.json").read_bytes()
    assert labelled.weights.tolist() != found.counter.weights.tolist()
    # Presence is no count, and an array is a log, too.
    (tmp_path / "map.yaml").write_text("pirsim_log: 1\npeople: {column: people, means: presence}\n")
    for given in (counting.calibrate(made / "pool", tmp_path / "counted.csv", map=tmp_path / "map.yaml"),
                  counting.calibrate(made / "pool", pirsim.read_log(tmp_path / "log.csv")),
                  counting.calibrate(made / "pool", pirsim.read_log(tmp_path / "log.csv").motion)):
        assert np.array_equal(given.counter.weights, found.counter.weights)
    with pytest.raises(pirsim.InputError, match="the log has 3 sensors"):
        counting.calibrate(made / "pool", np.zeros((50, 3)))
