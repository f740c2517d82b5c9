"""Counters of scikit-learn on features of motion: logistic regression and boosted trees."""

from __future__ import annotations

import json
from typing import Any, Iterable, NoReturn

import numpy as np
import numpy.typing as npt

from .. import _core
from .._inputs import PathOr, as_number, write
from ..errors import ErrorCode, InputError, UsageError
from ..specs import Diagnostic
from ._readings import (MOST_PEOPLE, UNKNOWN, Day, Estimates, LogLike, MapLike, Motion, as_day, as_reading,
                        count_or_none, estimates_of, readings_of)

Array = npt.NDArray[np.float64]

# -- features: they look back only, and have the same number and meaning for any number of sensors -------------------

WINDOWS_S = (60.0, 300.0, 900.0)


def windows_of(step_s: float) -> tuple[int, ...]:
    """Readings in each window, at least one."""
    return tuple(max(1, round(window_s / step_s)) for window_s in WINDOWS_S)


def shares(motion: Motion, length: int) -> Array:
    """[reading, sensor] share of the last `length` readings with motion, of those that are known; NaN if none is."""
    def sums(values: npt.NDArray[np.bool_]) -> Array:
        totals = np.cumsum(np.vstack([np.zeros(values.shape[1]), values]), axis=0)
        end = np.arange(1, len(values) + 1)
        ended: Array = totals[end] - totals[np.maximum(end - length, 0)]
        return ended

    known = sums(motion != UNKNOWN)
    return np.divide(sums(motion == 1), known, out=np.full(known.shape, np.nan), where=known > 0)


def of_sensors(own: Array) -> list[Array]:
    """Mean, most and least of those that are known: [reading] each, NaN where none is."""
    known = ~np.isnan(own)
    n, none = known.sum(axis=1), ~known.any(axis=1)
    mean = np.divide(np.where(known, own, 0.0).sum(axis=1), n, out=np.full(len(own), np.nan), where=n > 0)
    most, least = np.where(known, own, -np.inf).max(axis=1), np.where(known, own, np.inf).min(axis=1)
    return [mean, np.where(none, np.nan, most), np.where(none, np.nan, least)]


def since_motion(motion: Motion, most: int) -> Array:
    """[reading] readings since the last one with motion of any sensor, at most `most`."""
    index = np.arange(len(motion))
    last = np.maximum.accumulate(np.where((motion == 1).any(axis=1), index, -most)) if len(motion) else index
    return np.minimum(index - last, most).astype(float)


def features(motion: Motion, windows: tuple[int, ...]) -> Array:
    """[reading, feature]: of each window the sensors' mean, most and least share, and the share of readings with motion
    of any; and the time since the last motion. Where nothing is known in a window the next longer one stands for it;
    NaN where nothing is known in the longest. Which sensor is which doesn't count: rooms don't agree on that."""
    known = (motion != UNKNOWN).any(axis=1)
    either = np.where(known, (motion == 1).any(axis=1), UNKNOWN).astype(np.uint8)[:, np.newaxis]
    groups = [np.column_stack([*of_sensors(shares(motion, length)), shares(either, length)[:, 0]]) for length in windows]
    for i in range(len(windows) - 2, -1, -1):
        groups[i] = np.where(np.isnan(groups[i]), groups[i + 1], groups[i])
    return np.column_stack([*groups, since_motion(motion, max(windows))])


# -- counters --------------------------------------------------------------------------------------------------------

class LearnedCounter:
    """Counts by features of the last fifteen minutes, with any number of sensors. It looks back only."""

    model: str
    expected_error = None

    def __init__(self, step_s: float, prior: Array) -> None:
        """prior: [count] share of each in what was learnt from."""
        self.step_s = step_s
        self.prior = prior

    @property
    def n_counts(self) -> int:
        """It counts 0, 1, ..., n_counts - 1 people."""
        return len(self.prior)

    def __repr__(self) -> str:
        return (f"<pirsim.counting.{type(self).__name__}: 0 to {self.n_counts - 1} people, a reading every "
                f"{self.step_s:g} s>")

    def _of_features(self, rows: Array) -> Array:
        raise NotImplementedError

    def _probabilities(self, motion: npt.NDArray[np.uint8]) -> Array:
        rows = features(motion, windows_of(self.step_s))
        known = (_core.told_readings(motion, self.step_s) == 1) & ~np.isnan(rows).any(axis=1)
        out = np.full((len(rows), self.n_counts), np.nan)
        if known.any():
            out[known] = self._of_features(rows[known])
        return out

    def estimate(self, log: LogLike, smoothed: bool = True, *, map: MapLike | None = None) -> Estimates:
        """How many people were there. Arguments as of HiddenMarkovCounter.estimate(); smoothed changes nothing, since
        these counters look back only."""
        readings = readings_of(log, self.step_s, map)
        return estimates_of(readings, self._probabilities(readings.motion), self.expected_error)

    def live(self) -> LearnedLiveCount:
        """Counts reading by reading, as they come: what estimate() gives."""
        return LearnedLiveCount(self)

    def save(self, file: PathOr) -> None:
        """Raises UsageError for trees."""
        raise NotImplementedError


class LearnedLiveCount:
    """Counts reading by reading: see live()."""

    def __init__(self, counter: LearnedCounter) -> None:
        self._counter = counter
        self._motion: npt.NDArray[np.uint8] | None = None
        self.people: int | None = None
        """The estimate for the last reading; None before the first, and where nobody knows."""

    def next(self, bits: npt.ArrayLike) -> Array:
        """[count] probabilities after one more reading, as of HiddenMarkovCounter's LiveCount."""
        row = as_reading(bits)
        motion = row if self._motion is None else np.vstack([self._motion, row])
        self._motion = motion[-max(windows_of(self._counter.step_s)) - 1:]
        probabilities: Array = self._counter._probabilities(self._motion)[-1]
        self.people = count_or_none(probabilities)
        return probabilities


class LogisticCounter(LearnedCounter):
    """Logistic regression: it needs scikit-learn to be trained, but not to count."""

    model = "logistic"

    def __init__(self, step_s: float, prior: Array, middle: Array, scale: Array, coefficients: Array,
                 intercepts: Array) -> None:
        """middle, scale: [feature]; coefficients: [count, feature]; intercepts: [count], -inf for a count that was never
        there."""
        super().__init__(step_s, prior)
        self.middle, self.scale, self.coefficients, self.intercepts = middle, scale, coefficients, intercepts

    def _of_features(self, rows: Array) -> Array:
        scores = (rows - self.middle) / self.scale @ self.coefficients.T + self.intercepts
        odds = np.exp(scores - scores.max(axis=1, keepdims=True))
        probabilities: Array = odds / odds.sum(axis=1, keepdims=True)
        return probabilities

    def save(self, file: PathOr) -> None:
        """As JSON that load() reads."""
        intercepts = [None if np.isinf(value) else value for value in self.intercepts.tolist()]
        keys = {"pirsim_counter": 1, "model": self.model, "step_s": self.step_s, "prior": self.prior.tolist(),
                "middle": self.middle.tolist(), "scale": self.scale.tolist(),
                "coefficients": self.coefficients.tolist(), "intercepts": intercepts}
        write(file, json.dumps(keys) + "\n")


class TreesCounter(LearnedCounter):
    """Boosted trees of scikit-learn."""

    model = "trees"

    def __init__(self, step_s: float, prior: Array, classifier: Any) -> None:
        super().__init__(step_s, prior)
        self._classifier = classifier

    def _of_features(self, rows: Array) -> Array:
        out = np.zeros((len(rows), self.n_counts))
        out[:, self._classifier.classes_] = self._classifier.predict_proba(rows)
        return out

    def save(self, file: PathOr) -> NoReturn:
        """Raises UsageError: scikit-learn has no format for trees that is safe to load."""
        raise UsageError(ErrorCode.USAGE, [Diagnostic(
            "error", "", 0, 0,
            "trees can't be saved, since scikit-learn has no format for them that is safe to load; train them anew, "
            "or take the model hidden_markov or logistic")])


# -- training --------------------------------------------------------------------------------------------------------

def _require_scikit_learn() -> None:
    try:
        import sklearn  # noqa: F401
    except ImportError:
        raise ImportError("logistic and trees are trained with scikit-learn, which isn't installed: "
                          "pip install 'pirsim[count]'") from None


def _learnt_from(days: Iterable[Day], step_s: float) -> tuple[Array, npt.NDArray[np.int32]]:
    """Features [reading, feature] and people [reading] of all readings that are known. Raises ValueError."""
    rows, people = [], []
    for day in map(as_day, days):
        own = features(day.motion, windows_of(step_s))
        known = ~np.isnan(own).any(axis=1) & (day.people >= 0)
        rows.append(own[known])
        people.append(day.people[known])
    if not rows or len(np.unique(np.concatenate(people))) < 2:
        raise ValueError("there is nothing to learn: readings with different numbers of people are needed")
    return np.concatenate(rows), np.concatenate(people)


def train_logistic(days: Iterable[Day], step_s: float, threads: int, *, C: float = 1.0, max_iter: int = 1000,
                   class_weight: Any = None) -> LogisticCounter:
    _require_scikit_learn()
    from sklearn.linear_model import LogisticRegression

    step_s = as_number(step_s, "step_s", 1e-3)
    rows, people = _learnt_from(days, step_s)
    middle, scale = rows.mean(axis=0), rows.std(axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    classifier = LogisticRegression(C=C, max_iter=max_iter, class_weight=class_weight)
    classifier.fit((rows - middle) / scale, people)
    own, intercept = classifier.coef_, classifier.intercept_
    if len(classifier.classes_) == 2:  # scikit-learn keeps the second class's score alone
        own, intercept = np.vstack([np.zeros_like(own), own]), np.concatenate([[0.0], intercept])
    prior = np.bincount(people) / len(people)
    coefficients, intercepts = np.zeros((len(prior), rows.shape[1])), np.full(len(prior), -np.inf)
    coefficients[classifier.classes_], intercepts[classifier.classes_] = own, intercept
    return LogisticCounter(step_s, prior, middle, scale, coefficients, intercepts)


def train_trees(days: Iterable[Day], step_s: float, threads: int, **settings: Any) -> TreesCounter:
    _require_scikit_learn()
    from sklearn.ensemble import HistGradientBoostingClassifier
    from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]  # scikit-learn brings it

    step_s = as_number(step_s, "step_s", 1e-3)
    rows, people = _learnt_from(days, step_s)
    usual = {"max_iter": 60, "max_leaf_nodes": 8, "min_samples_leaf": 50, "random_state": 1}
    with threadpool_limits(max(1, threads)):  # the trees are small: on a busy machine a second thread costs minutes
        classifier = HistGradientBoostingClassifier(**{**usual, **settings}).fit(rows, people)
    return TreesCounter(step_s, np.bincount(people) / len(people), classifier)


# -- a saved one -----------------------------------------------------------------------------------------------------

def _table(saved: dict[str, Any], key: str, shape: tuple[int, ...]) -> Array:
    values = np.array([-np.inf if value is None else value for value in saved[key]] if key == "intercepts"
                      else saved[key], dtype=float)
    if values.shape != shape:
        raise ValueError(f"{key} has the shape {list(values.shape)} where {list(shape)} is expected")
    if not np.isfinite(values).all() and key != "intercepts":
        raise ValueError(f"{key} has a value that isn't a number")
    return values


def _from_json(saved: dict[str, Any]) -> LogisticCounter:
    if saved["pirsim_counter"] != 1:
        raise ValueError("pirsim_counter: this pirsim reads version 1")
    step_s = as_number(saved["step_s"], "step_s", 1e-3)
    n_counts = len(saved["prior"])
    n_features = 4 * len(windows_of(step_s)) + 1
    if not 2 <= n_counts <= MOST_PEOPLE + 1:
        raise ValueError(f"prior: expected 2 to {MOST_PEOPLE + 1} probabilities")
    counter = LogisticCounter(step_s, _table(saved, "prior", (n_counts,)), _table(saved, "middle", (n_features,)),
                              _table(saved, "scale", (n_features,)),
                              _table(saved, "coefficients", (n_counts, n_features)),
                              _table(saved, "intercepts", (n_counts,)))
    if counter.prior.min() < 0.0 or abs(counter.prior.sum() - 1.0) > 1e-6:
        raise ValueError("prior: probabilities don't add up to 1")
    if counter.scale.min() <= 0.0 or not np.isfinite(counter.intercepts).any():
        raise ValueError("scale or intercepts are impossible")
    return counter


def parse_logistic(text: bytes, name: str) -> LogisticCounter | None:
    """None: the text holds none. Raises InputError for one that isn't as it should be."""
    try:
        saved = json.loads(text)
    except (ValueError, RecursionError):
        return None  # whoever reads the other counters tells what is wrong
    if not isinstance(saved, dict) or saved.get("model") != LogisticCounter.model:
        return None
    try:
        return _from_json(saved)
    except (KeyError, TypeError, ValueError) as fault:
        what = f"{fault} is missing" if isinstance(fault, KeyError) else str(fault)
        raise InputError(ErrorCode.INPUT, [Diagnostic(
            "error", name, 0, 0, f"isn't a logistic counter as it should be: {what}")]) from None
