"""Counting live: beside pirsim's own counter, bit for bit, through restarts, gaps and steps of the clock."""

import csv
import json
import math
import os
import random
import subprocess
from datetime import datetime, timezone

import pytest
from counters import STEP_S, T0, random_counter

from pirsim_live import ClockSteppedBack, Counter, Occupancy

np = pytest.importorskip("numpy")
counting = pytest.importorskip("pirsim.counting")

@pytest.fixture
def made(tmp_path):
    def write(draw, **shape):
        told = random_counter(draw, **shape)
        (tmp_path / "counter.json").write_text(json.dumps(told))
        return tmp_path / "counter.json"
    return write


def random_events(draw, sensors, seconds, unknown=0.05):
    """(time, sensor, state) in order of time: every sensor now and then, some at the same moment, some at a reading's
    begin."""
    events = []
    for sensor in sensors:
        at = draw.uniform(0, 100)
        while at < seconds:
            state = None if draw.random() < unknown else draw.random() < 0.5
            events.append((T0 + (STEP_S * round(at / STEP_S) if draw.random() < 0.2 else round(at, 3)), sensor, state))
            at += draw.expovariate(1 / 200)
    return sorted(events, key=lambda event: event[0])


def bits_of(events, sensors, n):
    """[reading, sensor], said anew: by what each stretch of a state touches."""
    bits = np.full((n, len(sensors)), 0, dtype=np.uint8)
    for k, sensor in enumerate(sensors):
        own = [(T0, None)]
        for at, name, state in events:
            if name == sensor and state is not own[-1][1]:  # said again: no change
                own.append((at, state))
        ends = [at for at, _ in own[1:]] + [T0 + n * STEP_S]
        rank = [0] * n
        for (begin, state), end in zip(own, ends):
            if begin == T0 and state is None and end == T0:
                continue
            first = int((begin - T0) // STEP_S)
            last = first if end == begin else math.ceil((end - T0) / STEP_S) - 1
            for i in range(first, min(last, n - 1) + 1):
                rank[i] = max(rank[i], 2 if state else 0 if state is False else 1)
        bits[:, k] = [(0, 2, 1)[one] for one in rank]
    return bits


def same(estimates, expected):
    assert len(estimates) == len(expected)
    for estimate, row in zip(estimates, expected):
        told = list(estimate.probabilities) or [math.nan] * expected.shape[1]
        assert np.array_equal(told, row, equal_nan=True), estimate


@pytest.mark.parametrize("seed", range(5))
def test_counts_are_those_of_pirsim_bit_for_bit(seed, made):
    draw = random.Random(seed)
    file = made(draw, sensors=1 + seed % 4)
    counter, hours = Counter(file), 8
    events = random_events(draw, counter.sensors, 3600 * hours)
    live = counter.update(T0)
    for at, sensor, state in events:
        live += counter.update(at, {sensor: state})
        if draw.random() < 0.3:  # told twice, or looked at in between
            live += counter.update(at, {sensor: state}) + counter.update(at)
    live += counter.update(T0 + 3600 * hours)
    bits = bits_of(events, counter.sensors, 120 * hours)
    assert {0, 1, 2} <= set(bits.ravel())
    expected = counting.load(file).estimate(bits, smoothed=False)
    same(live, expected.probabilities)
    assert [-1 if one.people is None else one.people for one in live] == expected.people.tolist()
    assert [one.time for one in live] == [T0 + STEP_S * (i + 1) for i in range(120 * hours)]
    assert [one.known for one in live] == [bool((row != 2).any()) for row in bits] or any(one.people is None for one in live)
    bits[17, 0] = 1 - (bits[17, 0] == 1)  # the twin
    assert not np.array_equal(counting.load(file).estimate(bits, smoothed=False).probabilities[20], live[20].probabilities)


@pytest.mark.parametrize("seed", range(8))
def test_changes_at_a_readings_very_edge_are_those_of_the_command(seed, tmp_path):
    """Several at one moment, at the first and last one too, as `pirsim count --forward` reads them from a log of events."""
    if "PIRSIM" not in os.environ:
        pytest.skip("PIRSIM names the command")
    draw = random.Random(seed)
    told = random_counter(draw, sensors=1 + seed % 3)
    names = told["sensor_names"] = [f"sensor_{i + 1}" for i in range(told["sensors"])]
    (tmp_path / "counter.json").write_text(json.dumps(told))
    events = [(T0, name, draw.random() < 0.5) for name in names]
    for name in names:
        at = 0.0
        while at < 3600:
            moment = STEP_S * round(at / STEP_S) if draw.random() < 0.6 else round(at, 1)
            events += [(T0 + moment, name, draw.random() < 0.5) for _ in range(draw.choice((1, 1, 2, 3)))]
            at += draw.expovariate(1 / 60)
    events.sort(key=lambda event: event[0])
    rows = [f"{datetime.fromtimestamp(at, timezone.utc):%Y-%m-%dT%H:%M:%S.%f}Z,{name},{'on' if state else 'off'}"
            for at, name, state in events]
    (tmp_path / "log.csv").write_text("\n".join(["time,sensor,state", *rows]) + "\n")
    done = subprocess.run([os.environ["PIRSIM"], "count", tmp_path / "counter.json", "--log", tmp_path / "log.csv",
                           "--forward", "-q"], capture_output=True, text=True, check=True)
    counter, live = Counter(tmp_path / "counter.json"), []
    for at, name, state in events:
        live += counter.update(at, {name: state})
    live += counter.forget(events[-1][0] + 1e-6) + counter.update(events[-1][0] + STEP_S)  # a log ends behind its last event
    expected = [[row[f"p{n}"] for n in range(3)] for row in csv.DictReader(done.stdout.splitlines())]
    assert len(expected) > 100 and [[f"{p:.3f}" for p in one.probabilities] for one in live[:len(expected)]] == expected


def test_a_restart_is_a_gap_of_what_nobody_knows(made):
    draw = random.Random(7)
    file = made(draw)
    bits = np.array([[draw.randrange(2) for _ in range(3)] for _ in range(80)], dtype=np.uint8)
    bits[30:37] = 2
    live, counter = [], Counter(file)
    for i, row in enumerate(bits):
        if i == 30:
            saved = json.loads(json.dumps(counter.state()))
            counter = Counter(file)
            counter.restore(saved)
        states = {name: bool(bit) for name, bit in zip(counter.sensors, row)} if row[0] != 2 else {}
        live += counter.update(T0 + STEP_S * i, states)
    live += counter.update(T0 + STEP_S * 80)
    bits[29] = 2  # it was under way
    same(live, counting.load(file).estimate(bits, smoothed=False).probabilities)
    for other in (random_counter(draw, counts=4), random_counter(draw)):  # the second one is of the same shape
        with pytest.raises(ValueError, match="another counter"):
            Counter(other).restore(saved)


def test_nothing_is_told_once_nothing_has_been_known_for_five_minutes(made):
    counter = Counter(made(random.Random(1)))
    counter.update(T0, dict.fromkeys(counter.sensors, False))
    told = counter.forget(T0 + 60) + counter.update(T0 + 60 + 1800)
    assert [one.people is not None for one in told] == [True] * 12 + [False] * 50
    assert counter.last.p_nobody is None and counter.last.probabilities == ()
    assert counter.update(T0 + 60 + 1830, {counter.sensors[0]: True})[-1].people is None
    assert counter.update(T0 + 60 + 1860)[-1].people is not None
    long = counter.forget(T0 + 2000) and counter.update(T0 + 86400)
    assert long == [] and counter.next_end == T0 + 86400 + STEP_S  # begins anew


def test_steps_back_and_strangers_are_refused_and_change_nothing(made):
    file = made(random.Random(2))
    counter = Counter(file)
    counter.update(T0 + 5, {"sensor_1": True})
    before = counter.state()
    with pytest.raises(ClockSteppedBack, match="2.000 s before"):
        counter.update(T0 + 3, {"sensor_1": False})
    with pytest.raises(KeyError, match="no sensor is called hall; there are sensor_1"):
        counter.update(T0 + 7, {"hall": True})
    assert counter.state() == before and counter.last is None
    for wrong in ({}, {"pirsim_counter": 1}, {"pirsim_counter": 2, "counts": 2, "modes": 1, "sensors": 1, "rooms": []},
                  {**random_counter(random.Random(3)), "counts": 5}, {**random_counter(random.Random(3)), "model": "logistic"}):
        with pytest.raises(ValueError):
            Counter(wrong)


def test_occupancy_begins_with_motion_and_ends_when_nobody_is_probably_there():
    from pirsim_live.counter import Estimate

    def estimate(p_nobody, moved=False):
        return Estimate(0.0, None if p_nobody is None else 0, p_nobody, (), p_nobody is not None, moved)
    occupancy = Occupancy(0.9)
    told = [occupancy.update(estimate(*one)) for one in
            ((0.5,), (0.95,), (0.5,), (0.2, True), (0.89,), (0.9,), (0.3,), (None,), (0.3,), (0.95,), (0.1, True), (None,), (0.1,))]
    assert told == [None, False, False, True, True, False, False, None, None, False, True, None, None]
    assert occupancy.motion() and occupancy.is_on
