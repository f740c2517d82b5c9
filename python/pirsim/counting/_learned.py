"""Counters of scikit-learn on features of motion: logistic regression and boosted trees."""

from __future__ import annotations

import json
import os
from typing import Any, Iterable, NoReturn

import numpy as np
import numpy.typing as npt

from .. import _core
from .._files import write
from .._study import PathOr
from ..errors import ErrorCode, InputError, UsageError
from ..specs import Diagnostic
from ._estimates import Estimates, estimates_of, middle_count
from ._features import features, windows_of
from ._hidden_markov import as_number
from ._readings import MOST_PEOPLE, UNKNOWN, Day, LogLike, MapLike, as_day, as_reading, readings_of

Array = npt.NDArray[np.float64]


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
        people = int(middle_count(probabilities))
        self.people = people if people >= 0 else None
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
