"""Scores of estimates, with intervals from a bootstrap of whole days."""
import numpy as np

NAMES = ("mean absolute error", "within one", "balanced accuracy")


def tally(units, people, estimates, n_counts):
    """Sums of each unit: readings, absolute error, within one, then readings and hits of each count."""
    error = np.abs(estimates - people)
    hit = np.floor(estimates + 0.5) == people
    of_count = people[:, None] == np.arange(n_counts)
    each = np.column_stack([np.ones(len(people)), error, error <= 1.0, of_count, of_count & hit[:, None]])
    names, index = np.unique(units, return_inverse=True)
    sums = np.zeros((len(names), each.shape[1]))
    np.add.at(sums, index.ravel(), each)
    return sums


def scores_of(sums):
    """The three scores of sums [..., column]."""
    n_counts = (sums.shape[-1] - 3) // 2
    counts, hits = sums[..., 3:3 + n_counts], sums[..., 3 + n_counts:]
    recall = np.where(counts > 0, hits / np.maximum(counts, 1), np.nan)
    return np.stack([sums[..., 1] / sums[..., 0], sums[..., 2] / sums[..., 0], np.nanmean(recall, axis=-1)], axis=-1)


def drawn(sums, draws=1000, seed=1):
    """Sums over as many units, drawn with replacement: [draw, column]."""
    return np.random.default_rng(seed).multinomial(len(sums), np.full(len(sums), 1 / len(sums)), size=draws) @ sums


def score(units, people, estimates):
    """Scores, and the 2.5 and 97.5 % quantiles over resampled units: [3 scores, (value, low, high)]."""
    sums = tally(units, people, estimates, people.max() + 1)
    low, high = np.quantile(scores_of(drawn(sums)), [0.025, 0.975], axis=0)
    return np.column_stack([scores_of(sums.sum(axis=0)), low, high])


def mean_difference(units, error, other):
    """How much greater the mean of `error` is than that of `other`, with the interval over resampled units: two errors of
    each reading, so that hours that are hard for both counters cancel."""
    _, index = np.unique(units, return_inverse=True)
    sums = np.column_stack([np.bincount(index), np.bincount(index, error - other)])
    low, high = np.quantile(drawn(sums)[:, 1] / drawn(sums)[:, 0], [0.025, 0.975])
    return sums[:, 1].sum() / sums[:, 0].sum(), low, high
