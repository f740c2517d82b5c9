"""Counts people from motion while they are in the room, by a counter of `pirsim calibrate`.

Pure Python, bit for bit what `pirsim count --forward` computes. What a counter is: docs/formats/counter.md of pirsim.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Any, Iterable, Mapping, Optional, Union

LONGEST_GUESS_S = 300.0
"""Once nothing has been known for longer, no count is told."""
LONGEST_GAP_S = 6 * 3600.0
"""After a longer one a counter begins anew: nothing of what it knew is left by then (assumed; 1 to 24 h)."""

Time = float
"""Seconds since 1970, UTC."""
State = Optional[bool]
"""Of a sensor: it reports motion, or none; None: unknown."""


class ClockSteppedBack(ValueError):
    """The time is before what the counter was told last."""


@dataclass(frozen=True)
class Estimate:
    """At the end of a reading."""

    time: Time
    people: int | None
    """The least number that as many or fewer have even odds of; None: nothing has been known for five minutes."""
    p_nobody: float | None
    probabilities: tuple[float, ...]
    """Of 0, 1, ... people; empty where none is told."""
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


def _split(values: list[float], n: int) -> list[list[float]]:
    if not values or len(values) % n:
        raise ValueError("a table has another size than its counts ask for")
    return [values[i:i + n] for i in range(0, len(values), n)]


def _models(told: Mapping[str, Any]) -> list[_Model]:
    if told.get("pirsim_counter") != 2 or "model" in told:
        raise ValueError("expected a counter of version 2, as pirsim calibrate writes it")
    n, n_symbols = told["counts"] * told["modes"], told["sensors"] + 1
    models = []
    for room in told["rooms"]:
        moves = _split(room["moves"], n)
        for version in room["versions"]:
            model = _Model(version["weight"], room["first"], [list(column) for column in zip(*moves)],
                           _split(version["emissions"], n_symbols))
            if not len(model.first) == len(moves) == len(model.emissions) == n:
                raise ValueError("a table has another size than its counts ask for")
            models.append(model)
    if not models or abs(_sum(model.weight for model in models) - 1) > 1e-6:
        raise ValueError("the rooms' weights don't add up to 1")
    return models


class Counter:
    """Counts reading by reading. A reading is `step_s` seconds long and begins at a whole multiple of them since 1970.

    `update()` tells what sensors say from a moment on; a reading has motion if a sensor had it at any time in it, none
    if it was known throughout, and is unknown else. Until a sensor is told of, it is unknown. Not for several threads.
    """

    def __init__(self, counter: Union[str, os.PathLike[str], Mapping[str, Any]]) -> None:
        """counter: a file, or what is in it. Raises OSError, and ValueError for what isn't a counter."""
        name = "" if isinstance(counter, Mapping) else f"{os.fspath(counter)}: "
        try:
            if not isinstance(counter, Mapping):
                with open(counter, encoding="utf-8") as file:
                    counter = json.load(file)
            self._models = _models(counter)
        except (ValueError, KeyError, TypeError, AttributeError) as fault:
            raise ValueError(f"{name}isn't a counter of pirsim calibrate: {fault}") from fault
        self.step_s = float(counter["step_s"])
        self.n_counts, self._modes, n_sensors = counter["counts"], counter["modes"], counter["sensors"]
        self.sensors: tuple[str, ...] = tuple(counter.get("sensor_names") or
                                              (f"sensor_{i + 1}" for i in range(n_sensors)))
        self.warning: str = counter.get("warning", "")
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
        have ended since the last call. Raises ClockSteppedBack, and KeyError for sensors that the counter hasn't."""
        if time < self._time:
            raise ClockSteppedBack(f"{self._time - time:.3f} s before what was told last")
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
        """From `time` on nothing is known of any sensor until it is told of again: a connection was lost. As update()."""
        return self.update(time, dict.fromkeys(self.sensors))

    def state(self) -> dict[str, Any]:
        """What restore() takes, as JSON can hold it."""
        return {"time": self._time, "reading": self._reading, "beliefs": self._beliefs,
                "unknown_s": None if math.isinf(self._unknown_s) else self._unknown_s, "models": len(self._models)}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Goes on where state() was taken: since then nothing is known. Raises ValueError for one of another counter."""
        n = self.n_counts * self._modes
        beliefs = [[float(p) for p in belief] for belief in state["beliefs"]]
        if state["models"] != len(self._models) or any(len(belief) != n for belief in beliefs) or (
                beliefs and len(beliefs) != len(self._models)):
            raise ValueError("the state is that of another counter")
        self.reset()
        self._beliefs, self._reading = beliefs, state["reading"]
        self._time = -math.inf if self._reading is None else state["time"]
        self._unknown_s = math.inf if state["unknown_s"] is None else state["unknown_s"]

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
    """Somebody is there from a motion on, until P(nobody) reaches `off_at`: what `pirsim control --counter` weighs."""

    def __init__(self, off_at: float = 0.9) -> None:
        """off_at: P(nobody), 0 to 1. Raises ValueError."""
        if not 0.0 < off_at <= 1.0:
            raise ValueError(f"off_at: expected a probability, up to 1, got {off_at:g}")
        self.off_at = off_at
        self.is_on: bool | None = None
        """None: not known yet."""

    def update(self, estimate: Estimate) -> bool | None:
        """After one more reading."""
        if estimate.moved:
            self.is_on = True
        elif estimate.p_nobody is None:
            self.is_on = None
        elif self.is_on is None or self.is_on:
            self.is_on = estimate.p_nobody < self.off_at
        return self.is_on

    def motion(self) -> bool:
        """Right now, before the reading has ended."""
        self.is_on = True
        return True
