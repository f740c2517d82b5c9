"""Hidden Markov counters, trained from rooms, or calibrated: rooms weighed by how well each explains a log.

What they compute is the library's: docs/formats/counter.md tells it exactly.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Iterable, NamedTuple, NoReturn

import numpy as np
import numpy.typing as npt

from .. import _core
from .._inputs import PathOr, as_count, as_number, as_path, as_threads, warn_of
from ._readings import Day, Estimates, LogLike, MapLike, as_day, as_reading, count_or_none, estimates_of, readings_of


class Room(NamedTuple):
    """The model of one simulated room, at one liveliness. A state is a number of people in one mode, count * modes + mode; a symbol is how
    many sensors report motion."""

    number: int
    """In its dataset."""
    weight: float
    """How much it has to say; all add up to 1."""
    liveliness: float
    """Odds of a sensor's motion while somebody is there, times those in the room."""
    first: npt.NDArray[np.float64]
    """[state] probability at the first reading."""
    moves: npt.NDArray[np.float64]
    """[state, state] probability from one reading to the next, from row to column."""
    emissions: npt.NDArray[np.float64]
    """[state, symbol] probability of each symbol."""


class LiveCount:
    """Counts reading by reading: see live()."""

    __slots__ = ("_core", "_people")

    def __init__(self, core: Any) -> None:
        self._core = core
        self._people: int | None = None

    def next(self, bits: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """[count] probabilities after one more reading; NaN once nothing has been known for five minutes. bits: [sensor]
        0, 1, or 2, NaN or masked for unknown. Raises UsageError for another number of sensors."""
        probabilities: npt.NDArray[np.float64] = self._core.next(as_reading(bits)[0])
        self._people = count_or_none(probabilities)
        return probabilities

    @property
    def people(self) -> int | None:
        """The estimate for the last reading; None before the first, and where nobody knows."""
        return self._people


class HiddenMarkovCounter:
    """A mixture of hidden Markov models, one a simulated room. Immutable; load(), train() and calibrate() make one."""

    __slots__ = ("_handle",)
    _handle: _core.Counter
    model = "hidden_markov"

    def __init__(self) -> None:
        raise TypeError("pirsim.counting.train(), load() and calibrate() make a counter")

    @classmethod
    def _of(cls, core: _core.Counter) -> HiddenMarkovCounter:
        counter = object.__new__(cls)
        counter._handle = core
        return counter

    @property
    def step_s(self) -> float:
        """Seconds between readings."""
        return self._handle.step_s

    @property
    def modes(self) -> int:
        """Of each number of people, from quiet to busy."""
        return self._handle.modes

    @property
    def n_sensors(self) -> int:
        """That a log must have."""
        return self._handle.n_sensors

    @property
    def sensors(self) -> tuple[str, ...] | None:
        """Names in the log that it was calibrated by, which a log must have; None: any, as many."""
        return tuple(self._handle.sensors) or None

    @property
    def holds_s(self) -> tuple[float | None, ...] | None:
        """[sensor] seconds for which they held motion there; None: that log, or the counter's file, doesn't tell."""
        return tuple(self._handle.holds_s) or None

    @property
    def n_counts(self) -> int:
        """It counts 0, 1, ..., n_counts - 1 people."""
        return self._handle.n_counts

    @property
    def expected_error(self) -> tuple[float, float] | None:
        """Mean absolute error in people to expect, a 90 % interval; None if it wasn't calibrated by a log."""
        return self._handle.expected_error

    @property
    def weights(self) -> npt.NDArray[np.float64]:
        """[model] of each room at each liveliness."""
        return self._handle.weights

    @property
    def rooms(self) -> list[Room]:
        """The model of each room at each liveliness, room by room."""
        core = self._handle
        return [Room(int(number), float(weight), float(liveliness), first, moves, emissions)
                for number, weight, liveliness, first, moves, emissions in
                zip(core.rooms, core.weights, core.liveliness, core.first, core.moves, core.emissions)]

    def __repr__(self) -> str:
        weights = self.weights
        return (f"<pirsim.counting.HiddenMarkovCounter: 0 to {self.n_counts - 1} people in {self.modes} modes by "
                f"{self.n_sensors} sensors, a reading every {self.step_s:g} s; {len(weights)} rooms, the weight is that "
                f"of {1 / (weights ** 2).sum():.1f}>")

    def estimate(self, log: LogLike, smoothed: bool = True, *, map: MapLike | None = None) -> Estimates:
        """How many people were there.

        log: a file as `pirsim log` reads it, several that are parts of one, a pirsim.Log with windows of `step_s`, or an
        array [reading, sensor] of 0, 1, and 2, NaN or masked for unknown. smoothed: each reading by those after it as well;
        False: by those before it alone, as it could have been told then. map: what a file's columns mean, as of
        read_log(). Raises InputError for a log of other sensors, and ValueError if its readings are further apart than
        `step_s`; sensors that hold motion for another time are an InputWarning.
        """
        readings = readings_of(log, self.step_s, map)
        probabilities, remarks = _core.estimate(self._handle, readings.core, readings.traits, smoothed)
        warn_of(remarks)
        return (estimates_of(readings, probabilities, self.expected_error, self._handle.figures_off) if smoothed
                else estimates_of(readings, probabilities))

    def live(self) -> LiveCount:
        """Counts reading by reading, as they come: what estimate(..., smoothed=False) gives."""
        return LiveCount(_core.LiveCount(self._handle))

    def save(self, file: PathOr) -> None:
        """As JSON that load(), `pirsim count` and, by docs/formats/counter.md, any program can count with."""
        self._handle.write(as_path(file))

    def __reduce__(self) -> NoReturn:
        raise TypeError("a counter can't be pickled: save() it")


def settings_of(step_s: float, modes: int = 4, shrinkage: float = 60.0, iterations: int = 40,
                weight_power: float = 0.2) -> _core.CountingSettings:
    settings = _core.CountingSettings()
    settings.step_s = as_number(step_s, "step_s", 1e-3)
    settings.modes = as_count(modes, "modes", 1, 100)
    settings.shrinkage = as_number(shrinkage, "shrinkage", 0.0)
    settings.iterations = as_count(iterations, "iterations", 1, 10_000)
    settings.weight_power = as_number(weight_power, "weight_power", 0.0)
    return settings


def train_hidden_markov(days: Iterable[Day], step_s: float, threads: int, *, modes: int = 4, shrinkage: float = 60.0,
                        iterations: int = 40) -> HiddenMarkovCounter:
    settings = settings_of(step_s, modes, shrinkage, iterations)
    by_room = sorted(map(as_day, days), key=lambda day: day.room)  # stable: a room's days stay in order
    numbers = sorted({day.motion.shape[1] for day in by_room})
    if len(numbers) > 1:
        raise ValueError(f"the rooms have {', '.join(map(str, numbers[:-1]))} or {numbers[-1]} sensors, and a hidden "
                         f"Markov counter is for one number of them: say which, sensors={numbers[-1]}")
    return HiddenMarkovCounter._of(_core.train_counter([tuple(day) for day in by_room], settings, as_threads(threads)))


# -- calibration by a log --------------------------------------------------------------------------------------------

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
    about: str
    """motion, or schedule: the verdict doesn't rest on these."""
    share: float
    """Of what makes the log unlike the rooms, that goes without this one; 0 of the schedule's."""
    sign: str
    """Where it is unlike the rooms': what that is a sign of, or of the schedule's, what to do; empty elsewhere."""
    advice: str
    """What the recipe would have to change for the log's value; empty if it isn't unlike, or if nothing moves it."""


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
