"""Rooms of a dataset weighed by how well each explains a log."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from .. import _core
from .._study import PathOr, as_path, as_threads
from ._hidden_markov import HiddenMarkovCounter, settings_of
from ._readings import LogLike, MapLike, readings_of

Interval = tuple[float, float]


class Statistic(NamedTuple):
    """A number that a day's motion tells without counts: the log's beside the rooms'."""

    name: str
    unit: str
    of_log: float
    of_rooms: Interval
    """5 to 95 % of all rooms."""
    of_weighty: Interval
    """The same by weight."""
    p: float
    """Share of rooms, and the log, that are at least as far from the middle."""
    advice: str
    """What the recipe would have to change for the log's value; empty if it is inside, or if nothing moves it."""


class ParameterRange(NamedTuple):
    """What the log determined of a parameter of the recipe."""

    name: str
    before: Interval
    """5 to 95 % of all rooms."""
    after: Interval
    """The same by weight."""
    mean_before: float
    mean_after: float
    narrowed: float
    """0: the log left it open; 1: it determined it."""


class WeighedRoom(NamedTuple):
    number: int
    weight: float
    log_likelihood: float
    error: float | None
    """Mean absolute error of a counter made from the other rooms by this one's log; None: nobody was there."""


@dataclass(frozen=True)
class Calibration:
    """A counter for the room of a log, and whether simulated rooms make such a log at all."""

    counter: HiddenMarkovCounter
    """Of all rooms, by their weight, with the error to expect."""
    verdict: str
    """like-these; none-like-it: no room makes such a log, and neither counts nor error can be relied on;
    too-little-told: too little happens in the log."""
    p: float
    """Of the verdict: share of rooms, and the log, that are as unlike the others."""
    finding: str
    """The verdict for a reader."""
    effective_rooms: float
    """That carry the weight."""
    mean_error: float
    """To expect, in people; `counter.expected_error` is its interval."""
    mean_error_alike: float
    """The same if all rooms weighed alike."""
    partial_days: list[str]
    """Dates that weren't compared, since a sensor is known for less than nine tenths of the recipe's hours."""
    rooms: list[WeighedRoom] = field(repr=False)
    statistics: list[Statistic] = field(repr=False)
    parameters: list[ParameterRange] = field(repr=False)


def calibrate(pool: PathOr, log: LogLike, *, step_s: float = 30.0, map: MapLike | None = None,
              threads: int = 0, **settings: Any) -> Calibration:
    """Weighs the rooms of a finished dataset by how well each explains a log, without anybody having counted. If the log
    has a count, rooms must explain that, too.

    pool: the dataset's folder, of at least ten rooms with as many sensors as the log; docs/howto/own_room.md tells what
    it should be made like (`pirsim calibrate` makes it by itself). log, map: as of HiddenMarkovCounter.estimate().
    step_s: seconds of a reading. settings: modes, shrinkage, iterations and weight_power. Raises InputError and FileError.
    """
    chosen = settings_of(step_s, **settings)
    readings = readings_of(log, step_s, map)
    parts = _core.calibrate(as_path(pool), readings.core, readings.traits, chosen, as_threads(threads))
    parts["counter"] = HiddenMarkovCounter._of(parts["counter"])
    parts["rooms"] = [WeighedRoom(*room) for room in parts["rooms"]]
    parts["statistics"] = [Statistic(*one) for one in parts["statistics"]]
    parts["parameters"] = [ParameterRange(*one) for one in parts["parameters"]]
    return Calibration(**parts)
