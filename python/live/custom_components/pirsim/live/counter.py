"""Counts people from motion while they are in the room, by a counter of `pirsim calibrate`.

Pure Python, bit for bit what `pirsim count --forward` computes. What a counter is: docs/formats/counter.md of pirsim.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import sys
from dataclasses import dataclass
from typing import Any, Iterable, Mapping, Optional, Union

LONGEST_GUESS_S = 300.0
"""Once nothing has been known for longer, no count is given."""
LONGEST_GAP_S = 6 * 3600.0
"""After a longer one a counter begins anew: nothing of what it knew is left by then (assumed; 1 to 24 h)."""

_MOST_BYTES = 200_000_000

Time = float
"""Seconds since 1970, UTC."""
State = Optional[bool]
"""Of a sensor: it reports motion, or none; None: unknown."""


class ClockSteppedBack(ValueError):
    """The time is before that of the last update()."""


@dataclass(frozen=True)
class Estimate:
    """At the end of a reading."""

    time: Time
    people: int | None
    """The least number that as many or fewer have even odds of; None: nothing has been known for five minutes."""
    p_nobody: float | None
    probabilities: tuple[float, ...]
    """Of 0, 1, ... people; empty where no count is given."""
    known: bool
    """Something was known of a sensor in the reading."""
    moved: bool
    """One of them reported motion in it."""


@dataclass(frozen=True)
class _Model:
    weight: float
    first: list[float]
    moves_to: list[list[float]]  # [to][from]
    emissions: list[list[float]]  # [state][symbol]


def _choose(n: int, k: int) -> float:
    ways = 1.0
    for i in range(1, k + 1):  # in this order: a product of the same roundings as pirsim's
        ways *= (n - k + i) / i
    return 0.0 if k < 0 or k > n else ways


def _sum(values: Iterable[float]) -> float:
    total = 0.0
    for value in values:  # sum() corrects its roundings from Python 3.12 on
        total += value
    return total


# What a file may hold: the rules of src/logs/counter.cpp, whose verdict tests/test_refusals.py compares.

_FIGURES = ("occupied_h", "arrival_min", "departure_min", "most", "hour_nobody", "hour_mean", "hour_most")


def _number(value: Any, what: str, least: float = -sys.float_info.max, most: float = sys.float_info.max) -> float:
    """A finite number. Raises ValueError; so do all of these."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not least <= value <= most:
        raise ValueError(f"{what}: expected a number from {least:g} to {most:g}, got {value if is_number else type(value).__name__}")
    return float(value)


def _whole(value: Any, what: str, least: int, most: int) -> int:
    if not isinstance(value, int):
        raise ValueError(f"{what}: expected a whole number, got a {type(value).__name__}")
    return int(_number(value, what, least, most))


def _list(value: Any, what: str, length: int | None = None) -> list[Any]:
    if not isinstance(value, list) or length not in (None, len(value)):
        raise ValueError(f"{what}: expected a list{'' if length is None else f' of {length}'}")
    return value


def _member(told: Any, key: str) -> Any:
    if not isinstance(told, Mapping) or key not in told:
        raise ValueError(f"{key} is missing")
    return told[key]


def _text(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{what}: expected text")
    return value


def _probabilities(values: Any, what: str, rows: int, columns: int, least: float = 0.0) -> list[list[float]]:
    """Rows that add up to 1."""
    flat = [_number(value, what, least, 1) for value in _list(values, what, rows * columns)]
    table = [flat[i:i + columns] for i in range(0, len(flat), columns)]
    if any(abs(_sum(row) - 1) > 1e-6 for row in table):
        raise ValueError(f"{what}: probabilities don't add up to 1")
    return table


def _parsed(file: str | os.PathLike[str]) -> Any:
    """As pirsim reads JSON: without NaN, and a whole number that is too long for 64 bits is any other number."""
    with open(file, "rb") as opened:
        return json.loads(opened.read(_MOST_BYTES).decode(), parse_int=lambda text: (int if len(text) < 20 else float)(text))


def _models(told: Any) -> list[_Model]:
    version = _member(told, "pirsim_counter")
    if isinstance(version, bool) or version != 2 or "model" in told:
        raise ValueError("expected a counter of version 2, as pirsim calibrate writes it")
    _number(_member(told, "step_s"), "step_s", 1e-3, 86400)
    n = _whole(_member(told, "counts"), "counts", 2, 1000) * _whole(_member(told, "modes"), "modes", 1, 100)
    n_sensors = _whole(_member(told, "sensors"), "sensors", 1, 1000)
    models = []
    for room in _list(_member(told, "rooms"), "rooms"):
        _whole(_member(room, "room"), "room", 0, 10**9)
        [first] = _probabilities(_member(room, "first"), "first", 1, n)
        moves = [list(column) for column in zip(*_probabilities(_member(room, "moves"), "moves", n, n))]
        for version in _list(_member(room, "versions"), "versions"):
            _number(_member(version, "liveliness"), "liveliness", sys.float_info.min)
            models.append(_Model(_number(_member(version, "weight"), "weight", 0), first, moves,
                                 _probabilities(_member(version, "emissions"), "emissions", n, n_sensors + 1, 1e-100)))
    if not abs(_sum(model.weight for model in models) - 1) < 1e-6:
        raise ValueError("the rooms' weights don't add up to 1")
    pairs = [told["expected_error"]] if "expected_error" in told else []
    if "figures_off" in told:
        pairs += [_member(told["figures_off"], name) for name in _FIGURES]
    for pair in pairs:
        for value in _list(pair, "expected_error and figures_off", 2):
            _number(value, "expected_error and figures_off")
    _text(told.get("warning", ""), "warning")
    names = [_text(name, "sensor_names") for name in _list(told.get("sensor_names", [""] * n_sensors), "sensor_names", n_sensors)]
    if "sensor_names" in told and len(set(names)) < n_sensors:
        raise ValueError("sensor_names: one is there twice")
    for hold_s in _list(told.get("holds_s", [None] * n_sensors), "holds_s", n_sensors):
        _number(0 if hold_s is None else hold_s, "holds_s", 0)
    return models


class Counter:
    """Counts reading by reading. A reading is `step_s` seconds long and begins at a whole multiple of them since 1970.

    `update()` takes what sensors report from a moment on. A reading has motion if a sensor had it at any time in it, none
    if it was known throughout, and is unknown otherwise. A sensor is unknown until it reports. Not for several threads.
    """

    def __init__(self, counter: Union[str, os.PathLike[str], Mapping[str, Any]]) -> None:
        """counter: a file, or what is in it. Raises OSError, and ValueError for what isn't a counter."""
        name = "" if isinstance(counter, Mapping) else f"{os.fspath(counter)}: "
        try:
            told = dict(counter) if isinstance(counter, Mapping) else _parsed(counter)
            self._models = _models(told)
            text = json.dumps(told, allow_nan=False, ensure_ascii=False)
            self._digest = hashlib.sha256(text.encode()).hexdigest()[:16]
        except (ValueError, TypeError, RecursionError) as fault:
            raise ValueError(f"{name}isn't a counter of pirsim calibrate: {fault}") from fault
        self.step_s = float(told["step_s"])
        self.n_counts, self._modes = told["counts"], told["modes"]
        self.sensors: tuple[str, ...] = tuple(told.get("sensor_names") or
                                              (f"sensor_{i + 1}" for i in range(told["sensors"])))
        self.warning: str = told.get("warning", "")
        """Why its counts can't be relied on: hardly a room of its recipe makes such a log. Or no text."""
        self.reset()

    def reset(self) -> None:
        """Begins anew: nothing is known, and nothing was."""
        self._beliefs: list[list[float]] = []
        self._unknown_s = math.inf
        self._states: dict[str, State] = dict.fromkeys(self.sensors)
        self._since: dict[str, Time] = {}
        self._moved: set[str] = set()
        self._doubtful: set[str] = set(self.sensors)
        self._reading: int | None = None
        self._time: Time = -math.inf
        self._last: Estimate | None = None

    @property
    def last(self) -> Estimate | None:
        """Of the last reading that has ended."""
        return self._last

    @property
    def time(self) -> Time:
        """Of the last update(); minus infinity before the first."""
        return self._time

    @property
    def next_end(self) -> Time:
        """When the reading ends that is under way; minus infinity before the first update()."""
        return -math.inf if self._reading is None else (self._reading + 1) * self.step_s

    def update(self, time: Time, states: Mapping[str, State] | None = None) -> list[Estimate]:
        """From `time` on these sensors have these states, the others the ones that they had. Returns the readings that
        have ended since the last call. Raises ClockSteppedBack, ValueError for a time that is none, and KeyError for
        sensors that the counter hasn't."""
        _number(time, "time")
        if time < self._time:
            raise ClockSteppedBack(f"{self._time - time:.3f} s before the last update")
        if unknown := set(states or {}) - set(self.sensors):
            raise KeyError(f"no sensor is called {', '.join(sorted(unknown))}; there are {', '.join(self.sensors)}")
        reading = math.floor(time / self.step_s)
        is_lost = self._reading is not None and (reading - self._reading) * self.step_s > LONGEST_GAP_S
        if is_lost and not any(state is not None for state in self._states.values()):
            self.reset()
        if self._reading is None:
            self._begin(reading)
            if time > reading * self.step_s:
                self._doubtful.update(self.sensors)  # nothing is known of what was before
        ended = []
        while self._reading is not None and self._reading < reading:
            ended.append(self._end())
            self._begin(self._reading + 1)
        self._time = time
        for sensor, state in (states or {}).items():
            if state is self._states[sensor]:  # no change: at a reading's begin it would end what came before
                continue
            if time == reading * self.step_s and self._since.get(sensor) != time:  # what it was before isn't of this one
                self._doubtful.discard(sensor)
                self._moved.discard(sensor)
            self._states[sensor], self._since[sensor] = state, time
            if state is None:
                self._doubtful.add(sensor)
            elif state:
                self._moved.add(sensor)
        return ended

    def forget(self, time: Time) -> list[Estimate]:
        """From `time` on nothing is known of any sensor until it reports again: a connection was lost. As update()."""
        return self.update(time, dict.fromkeys(self.sensors))

    def state(self) -> dict[str, Any]:
        """What restore() takes, as JSON can hold it."""
        return {"counter": self._digest, "time": None if self._reading is None else self._time, "beliefs": self._beliefs,
                "unknown_s": None if math.isinf(self._unknown_s) else self._unknown_s}

    def restore(self, state: Any) -> None:
        """Goes on where state() was taken: since then nothing is known. Raises ValueError for what isn't a state of this
        counter, and is unchanged then."""
        if _member(state, "counter") != self._digest:
            raise ValueError("the state is that of another counter")
        time, unknown_s, n = _member(state, "time"), _member(state, "unknown_s"), self.n_counts * self._modes
        beliefs = [row for belief in _list(_member(state, "beliefs"), "beliefs")
                   for row in _probabilities(belief, "beliefs", 1, n)]
        if len(beliefs) not in (0, len(self._models)):
            raise ValueError("beliefs: there are more or fewer than models")
        time = None if time is None else _number(time, "time", 0, 1e11)
        unknown_s = math.inf if unknown_s is None else _number(unknown_s, "unknown_s", 0)
        self.reset()
        self._beliefs, self._unknown_s = beliefs, unknown_s
        if time is not None:
            self._time, self._reading = time, math.floor(time / self.step_s)

    def _begin(self, reading: int) -> None:
        self._reading = reading
        self._moved = {sensor for sensor, state in self._states.items() if state}
        self._doubtful = {sensor for sensor, state in self._states.items() if state is None}

    def _end(self) -> Estimate:
        assert self._reading is not None
        active = len(self._moved)
        known = len(self.sensors) - len(self._doubtful - self._moved)
        counts = self._step(known, active)
        self._unknown_s = 0.0 if known else self._unknown_s + self.step_s
        time = (self._reading + 1) * self.step_s
        if self._unknown_s > LONGEST_GUESS_S:
            self._last = Estimate(time, None, None, (), False, False)
        else:
            self._last = Estimate(time, _middle(counts), counts[0], tuple(counts), known > 0, active > 0)
        return self._last

    def _step(self, known: int, active: int) -> list[float]:
        """Beliefs after one more reading; [count]."""
        n, n_sensors = self.n_counts * self._modes, len(self.sensors)
        ways = [(every, _choose(every, active) * _choose(n_sensors - every, known - active) / _choose(n_sensors, known))
                for every in range(active, active + n_sensors - known + 1)]
        counts, after = [0.0] * self.n_counts, []
        for m, model in enumerate(self._models):
            before = self._beliefs[m] if self._beliefs else None
            belief = []
            for to in range(n):
                if before is None:
                    expected = model.first[to]
                else:
                    expected = 0.0
                    for p, move in zip(before, model.moves_to[to]):
                        expected += p * move
                row = model.emissions[to]
                belief.append(expected * (row[active] if known == n_sensors else
                                          _sum(row[every] * way for every, way in ways)))
            total = _sum(belief)
            belief = [p / total for p in belief]
            for state, p in enumerate(belief):
                counts[state // self._modes] += model.weight * p
            after.append(belief)
        self._beliefs = after
        return counts


def _middle(counts: list[float]) -> int:
    reached = 0.0
    for people, p in enumerate(counts[:-1]):
        reached += p
        if reached >= 0.5 - 1e-9:
            return people
    return len(counts) - 1


class Occupancy:
    """Somebody is there from a motion on, until P(nobody) reaches `off_at`: what `pirsim control --counter` weighs.

    Motion alone begins it. Once no count is given, it is unknown until there is motion or P(nobody) is at `off_at`."""

    def __init__(self, off_at: float = 0.9) -> None:
        """off_at: P(nobody), 0 to 1. Raises ValueError."""
        if not 0.0 < off_at <= 1.0:
            raise ValueError(f"off_at: expected a probability, up to 1, got {off_at:g}")
        self.off_at = off_at
        self.is_on: bool | None = None
        """None: unknown."""

    def update(self, estimate: Estimate) -> bool | None:
        """After one more reading."""
        if estimate.moved:
            self.is_on = True
        elif estimate.p_nobody is None:
            self.is_on = None
        elif estimate.p_nobody >= self.off_at:
            self.is_on = False
        return self.is_on

    def motion(self) -> bool:
        """Right now, before the reading has ended."""
        self.is_on = True
        return True
