"""Features of motion. They look back only, and have the same number and meaning for any number of sensors."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._readings import UNKNOWN, Motion

WINDOWS_S = (60.0, 300.0, 900.0)
Array = npt.NDArray[np.float64]


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
