"""What counters learn and count from, readings of motion, half a minute each; and what they make of them."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from .. import _core
from .._inputs import PathOr, as_count, as_path, as_threads, keep_inputs, write
from .._logs import Log, read_log

if TYPE_CHECKING:
    import pandas

UNKNOWN = 2
"""In place of a bit."""
MOST_PEOPLE = 999
MOST_SENSORS = 1000

Motion = npt.NDArray[np.uint8]
LogLike = Union[PathOr, "list[PathOr]", Log, npt.ArrayLike]
"""A log's file, files that are parts of one log, what read_log() gave, or an array [reading, sensor] of 0, 1, and for
unknown 2, NaN, None or what is masked."""
MapLike = Union[PathOr, Mapping[str, Any]]
"""What a file's columns mean, as of read_log()."""


class Day(NamedTuple):
    """Readings of one room at equal steps, one after the other, with the people who were there."""

    room: int
    """Its number: a room's days are learnt from together."""
    motion: Motion
    """[reading, sensor] 1 if any motion is in the reading, 0 if none, 2 if that isn't known."""
    people: npt.NDArray[np.int32]
    """[reading] at its end; -1 where nobody counted."""


def _known_numbers(values: npt.ArrayLike, unknown: int) -> npt.NDArray[Any]:
    """As numbers, `unknown` in place of what is masked, NaN, None, pandas' NA or an empty text. Raises ValueError."""
    array = np.ma.asarray(values)
    known, data = ~np.ma.getmaskarray(array), np.asarray(array.data)
    if data.dtype.kind not in "buifOU":
        raise ValueError(f"expected numbers, got {data.dtype}")
    if data.dtype.kind in "OU":
        known &= np.array([str(one) not in ("", "None", "nan", "<NA>", "--") for one in data.ravel()],
                          dtype=bool).reshape(data.shape)
        data = data.astype(object)
        data[~known] = unknown
    if data.dtype.kind not in "bui":
        data = data.astype(float)  # raises ValueError for what isn't a number
        known &= ~np.isnan(data)
    return np.where(known, data, np.int64(unknown))


def as_motion(bits: npt.ArrayLike) -> Motion:
    """[reading, sensor]; a list of numbers is that of one sensor. Raises ValueError."""
    values = _known_numbers(bits, UNKNOWN)
    if values.ndim == 1:
        values = values[:, np.newaxis]
    if values.ndim != 2 or not 1 <= values.shape[1] <= MOST_SENSORS:
        raise ValueError(f"expected bits as an array [reading, sensor], got one of shape {list(values.shape)}")
    wrong = np.argwhere((values != 0) & (values != 1) & (values != UNKNOWN))
    if len(wrong):
        reading, sensor = wrong[0]
        raise ValueError(f"expected 0, 1, or 2 or NaN for unknown, got {values[reading, sensor]} in reading {reading} of "
                         f"sensor {sensor}")
    return np.ascontiguousarray(values, dtype=np.uint8)


def as_reading(bits: npt.ArrayLike) -> Motion:
    """[1, sensor] of one reading. Raises ValueError."""
    motion = as_motion(np.ma.atleast_2d(bits))
    if len(motion) != 1:
        raise ValueError(f"expected one reading, got {len(motion)}")
    return motion


def as_day(day: Day) -> Day:
    """With arrays as the module takes them. Raises ValueError."""
    motion, people = as_motion(day.motion), _known_numbers(day.people, -1)
    is_whole = np.asarray(day.people).dtype.kind != "b" and np.array_equal(people, np.floor(people))
    if people.shape != (len(motion),) or not is_whole:
        raise ValueError(f"room {day.room}: expected a whole number of people for each of {len(motion)} readings")
    if len(people) and not (-1 <= people.min() and people.max() <= MOST_PEOPLE):
        raise ValueError(f"room {day.room}: expected 0 to {MOST_PEOPLE} people, or -1 where nobody counted")
    return Day(as_count(day.room, "room", 0, 10**9), motion, np.ascontiguousarray(people, dtype=np.int32))


def read_dataset(folder: PathOr, part: str = "train", *, step_s: float = 30.0, threads: int = 0) -> list[Day]:
    """The days of one part of a finished dataset (train, validation, test_days or test_rooms), room by room, as
    readings of `step_s` seconds: any motion in them, and the people at their end. Raises FileError and InputError, and
    ValueError if a reading isn't a whole number of the dataset's rows."""
    days = []
    for room, row_s, motion, people in _core.read_room_days(as_path(folder), part, step_s, as_threads(threads)):
        if round(step_s / row_s) < 1 or abs(round(step_s / row_s) * row_s - step_s) > 1e-6:
            raise ValueError(f"step_s: a reading of {step_s:g} s isn't a whole number of the dataset's rows of {row_s:g} s")
        days.append(Day(room, motion, people))
    return days


class Readings(NamedTuple):
    """A log in readings of a counter's step."""

    core: _core.Readings
    motion: Motion
    end_us: npt.NDArray[np.int64]
    """[reading] local time, or since the log's zero."""
    has_clock: bool
    traits: _core.LogTraits
    """What a log tells of itself; of an array nothing."""
    files: tuple[PathOr, ...]
    """That the log was read from."""


def _is_files(log: Any) -> bool:
    return isinstance(log, (str, os.PathLike)) or (
        isinstance(log, (list, tuple)) and len(log) > 0 and all(isinstance(one, (str, os.PathLike)) for one in log))


def readings_of(log: LogLike, step_s: float, map: MapLike | None) -> Readings:
    """Of a log in any form. Raises ValueError for a Log with windows of another length, and for one whose readings are
    further apart."""
    traits = _core.LogTraits(0.0, [], [])
    if _is_files(log):
        log = read_log(log, map, window_s=step_s)  # type: ignore[arg-type]
    elif map is not None:
        raise TypeError("map tells what a file's columns mean; the log is no file")
    if not isinstance(log, Log):
        motion = as_motion(log)  # type: ignore[arg-type]
        end_us = np.round(np.arange(1, len(motion) + 1) * step_s * 1e6).astype(np.int64)
        names, people, has_clock = [f"PIR{k + 1}" for k in range(motion.shape[1])], None, False
    elif abs(log.window_s - step_s) > 1e-6:
        raise ValueError(f"the log has windows of {log.window_s:g} s and the counter readings of {step_s:g} s: "
                         f"read_log(..., window_s={step_s:g})")
    else:
        motion, end_us = as_motion(log.motion), log.time.astype("datetime64[us]").astype(np.int64)
        names, has_clock = list(log.sensors), not log.is_elapsed
        people = log.people if log.people_means == "count" else None
        if log.interval_s > step_s * (1 + 1e-6):
            raise ValueError(f"the log has a reading every {log.interval_s:g} s and the counter one every {step_s:g} s: "
                             "it can't tell what was between")
        traits = _core.LogTraits(log.interval_s, names, [one.hold_s for one in log.facts])
    return Readings(_core.readings(motion, people, names, step_s, end_us, has_clock), motion, end_us, has_clock,
                    traits, log._files if isinstance(log, Log) else ())


# -- estimates -------------------------------------------------------------------------------------------------------

def middle_count(probabilities: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
    """[...] of [..., count]: the least count that as many people or fewer have at least even odds of. It makes the
    absolute error least. -1 where the probabilities are NaN."""
    middle = np.argmax(np.cumsum(probabilities, axis=-1) >= 0.5 - 1e-9, axis=-1)
    return np.where(np.isnan(probabilities[..., 0]), -1, middle)


def count_or_none(probabilities: npt.NDArray[np.float64]) -> int | None:
    """The middle of one reading's distribution; None where nobody knows."""
    people = int(middle_count(probabilities))
    return people if people >= 0 else None


@dataclass(frozen=True, eq=False)
class Estimates:
    """How many people were there, reading by reading."""

    people: npt.NDArray[np.int64]
    """[reading] the middle of the distribution, which makes the absolute error least; -1 where nothing has been known
    for five minutes."""
    probabilities: npt.NDArray[np.float64]
    """[reading, count]; NaN there."""
    time: npt.NDArray[Any]
    """[reading] its end: local time (datetime64[us]), or seconds for a log that tells no time of day."""
    expected_error: tuple[float, float] | None
    """Of the counter; None of counts by what came before alone."""
    figures_off: dict[str, tuple[float, float]] | None = field(repr=False)
    """How far off `days` and `hours` are, on average, and in nine of ten cases at most; None: that isn't known."""
    _readings: Readings = field(repr=False)

    def __repr__(self) -> str:
        n, n_counts = self.probabilities.shape
        told = self.people[self.people >= 0]
        return (f"<pirsim.counting.Estimates: {n} readings, 0 to {n_counts - 1} people, "
                f"{told.mean() if len(told) else 0:.2f} on average"
                + (f", {n - len(told)} unknown>" if len(told) < n else ">"))

    @property
    def mean(self) -> npt.NDArray[np.float64]:
        """[reading] mean of the distribution, NaN where nobody knows."""
        return self.probabilities @ np.arange(self.probabilities.shape[1])

    @cached_property
    def band(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """[reading] the least and the most of the shortest run of counts that has nine tenths of the odds; -1 where
        nobody knows."""
        least, most = _core.bands(np.ascontiguousarray(self.probabilities))
        return least, most

    @property
    def days(self) -> dict[str, npt.NDArray[Any]]:
        """[day] the columns of `pirsim count --by-day`: hours with somebody, arrival, departure, most people, and how far
        off each is; texts, or numbers that are NaN where nothing is known. pandas.DataFrame() takes them."""
        return self._figures[0]

    @property
    def hours(self) -> dict[str, npt.NDArray[Any]]:
        """[hour of the day] the columns of `pirsim count --by-hour`: P(nobody), people, the most of them."""
        return self._figures[1]

    @cached_property
    def _figures(self) -> tuple[dict[str, npt.NDArray[Any]], ...]:
        tables = _core.figures(self._readings.core, np.ascontiguousarray(self.probabilities), self.figures_off)
        return tuple({name: np.array(cells) for name, cells in table.items()} for table in tables)

    def to_pandas(self) -> pandas.DataFrame:
        """A row a reading, with the columns of write_csv(); what is unknown is missing."""
        import pandas as pd

        time = "time" if self.time.dtype.kind == "M" else "time_s"
        columns: dict[str, Any] = {time: self.time, "people": pd.arrays.IntegerArray(self.people.copy(), self.people < 0),
                                   "mean": self.mean}
        for name, ends in zip(("least", "most"), self.band):
            columns[name] = pd.arrays.IntegerArray(ends.copy(), ends < 0)
        columns.update((f"p{n}", column) for n, column in enumerate(self.probabilities.T))
        return pd.DataFrame(columns)

    def write_csv(self, file: PathOr) -> None:
        """As `pirsim count` writes it: time of a reading's end, people, their mean, `band`, each count's probability.
        Raises UsageError for the file of the log."""
        keep_inputs([("file", file)], [("log", one) for one in self._readings.files])
        write(file, _core.counts_csv(self._readings.core, np.ascontiguousarray(self.probabilities)))


def estimates_of(readings: Readings, probabilities: Any, expected_error: tuple[float, float] | None = None,
                 figures_off: dict[str, tuple[float, float]] | None = None) -> Estimates:
    time = readings.end_us.view("datetime64[us]") if readings.has_clock else readings.end_us * 1e-6
    return Estimates(middle_count(probabilities), probabilities, time, expected_error, figures_off, readings)
