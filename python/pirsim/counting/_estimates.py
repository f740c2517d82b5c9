"""What a counter makes of a log."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._files import keep_inputs, write
from .._study import PathOr
from ._readings import Readings

if TYPE_CHECKING:
    import pandas


def middle_count(probabilities: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
    """[...] of [..., count]: the least count that as many people or fewer have at least even odds of. It makes the
    absolute error least. -1 where the probabilities are NaN."""
    middle = np.argmax(np.cumsum(probabilities, axis=-1) >= 0.5 - 1e-9, axis=-1)
    return np.where(np.isnan(probabilities[..., 0]), -1, middle)


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
    """Of the counter."""
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

    def to_pandas(self) -> pandas.DataFrame:
        """A row a reading, with the columns of write_csv(); what is unknown is missing."""
        import pandas as pd

        time = "time" if self.time.dtype.kind == "M" else "time_s"
        columns: dict[str, Any] = {time: self.time, "people": pd.arrays.IntegerArray(self.people.copy(), self.people < 0),
                                   "mean": self.mean}
        columns.update((f"p{n}", column) for n, column in enumerate(self.probabilities.T))
        return pd.DataFrame(columns)

    def write_csv(self, file: PathOr) -> None:
        """As `pirsim count` writes it: time of a reading's end, people, their mean, the probability of each count.
        Raises UsageError for the file of the log."""
        keep_inputs([("file", file)], [("log", one) for one in self._readings.files])
        write(file, _core.counts_csv(self._readings.core, np.ascontiguousarray(self.probabilities)))


def estimates_of(readings: Readings, probabilities: Any, expected_error: tuple[float, float] | None) -> Estimates:
    time = readings.end_us.view("datetime64[us]") if readings.has_clock else readings.end_us * 1e-6
    return Estimates(middle_count(probabilities), probabilities, time, expected_error, readings)
