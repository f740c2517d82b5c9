"""Counting people from motion: counters are learnt from simulated rooms, and count from logs of real sensors.

    from pirsim import counting
    counter = counting.train("dataset")           # a folder of `pirsim dataset`
    counter.save("counter.json")                  # what `pirsim count` reads, too
    estimates = counter.estimate("week.csv")
    estimates.people, estimates.probabilities     # [reading], [reading, count]

For the shell: python -m pirsim.counting --help. What a counter computes: docs/formats/counter.md.
"""

from __future__ import annotations

from typing import Any, Callable, Iterable, Union

from .. import _core
from .._inputs import PathOr, as_path
from ._hidden_markov import (Calibration, HiddenMarkovCounter, LiveCount, ParameterRange, Room, Statistic,
                             WeighedRoom, calibrate, train_hidden_markov)
from ._learned import (LearnedCounter, LearnedLiveCount, LogisticCounter, TreesCounter, parse_logistic,
                       train_logistic, train_trees)
from ._readings import Day, Estimates, read_dataset

__all__ = [
    "Calibration", "Counter", "Day", "Estimates", "HiddenMarkovCounter", "LearnedCounter", "LearnedLiveCount", "LiveCount",
    "LogisticCounter", "ParameterRange", "Room", "Statistic", "TreesCounter", "WeighedRoom", "calibrate", "load",
    "read_dataset", "train",
]

Counter = Union[HiddenMarkovCounter, LogisticCounter, TreesCounter]

_TRAINERS: dict[str, Callable[..., Counter]] = {
    "hidden_markov": train_hidden_markov, "logistic": train_logistic, "trees": train_trees}


def train(dataset: PathOr | Iterable[Day], step_s: float = 30.0, model: str = "hidden_markov", *, part: str = "train",
          sensors: int | None = None, threads: int = 0, **settings: Any) -> Counter:
    """Learns to count from simulated rooms.

    dataset: a folder of `pirsim dataset`, of which `part` is learnt from, or `Day`s of any origin with readings of
    `step_s` seconds. sensors: only rooms with so many. model and its settings:

    - hidden_markov: modes, shrinkage, iterations (docs/formats/counter.md); rooms must have equally many sensors.
    - logistic: C, max_iter, class_weight of scikit-learn's LogisticRegression.
    - trees: those of scikit-learn's HistGradientBoostingClassifier. Such a counter can't be saved.

    threads: 0 for all cores; changes no bit. Raises FileError, InputError, ValueError, TypeError for a setting that the
    model hasn't, and ImportError if scikit-learn is needed and missing.
    """
    if model not in _TRAINERS:
        raise ValueError(f"model: expected {', '.join(_TRAINERS)}, got {model!r}")
    if isinstance(dataset, Iterable) and not isinstance(dataset, (str, bytes)):
        days = list(dataset)
        if isinstance(dataset, Day) or not all(isinstance(day, Day) for day in days):
            raise TypeError("dataset: expected a folder, or a list of pirsim.counting.Day")
    else:
        days = read_dataset(dataset, part, step_s=step_s, threads=threads)
    if sensors is not None:
        days = [day for day in days if day.motion.shape[1] == sensors]
        if not days:
            raise ValueError(f"sensors: no room has {sensors}")
    return _TRAINERS[model](days, step_s, threads, **settings)


def load(file: PathOr) -> Counter:
    """A counter that save(), `pirsim calibrate` or another program wrote. Raises FileError and InputError."""
    name = as_path(file)
    saved = _core.read_counter_bytes(name)
    return parse_logistic(saved, name) or HiddenMarkovCounter._of(_core.parse_counter(saved, name))
