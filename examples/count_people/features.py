"""Features of windowed motion. They look back only, and have the same number and meaning for any number of sensors."""
import numpy as np

WINDOWS = (2, 10, 30)  # readings: 1, 5 and 15 min


def shares(motion, length):
    """Share of the last `length` readings with motion, a column a sensor; of those that there are at the beginning."""
    sums = np.cumsum(np.vstack([np.zeros(motion.shape[1]), motion]), axis=0)
    end = np.arange(1, len(motion) + 1)
    start = np.maximum(end - length, 0)
    return (sums[end] - sums[start]) / (end - start)[:, None]


def since_motion(motion):
    """Readings since the last one with motion of any sensor, at most those of the longest window."""
    last, out = -max(WINDOWS), np.empty(len(motion))
    for t, seen in enumerate(motion.any(axis=1)):
        last = t if seen else last
        out[t] = min(t - last, max(WINDOWS))
    return out


def features(motion):
    """Of each window: the sensors' mean, most and least share, and the share of readings with motion of any; and the
    time since the last motion. Which sensor is which doesn't count, since rooms don't agree on that."""
    columns = []
    for length in WINDOWS:
        own = shares(motion, length)
        either = shares(motion.any(axis=1, keepdims=True), length)[:, 0]
        columns += [own.mean(axis=1), own.max(axis=1), own.min(axis=1), either]
    return np.column_stack([*columns, since_motion(motion)])
