"""Estimators of the number of people. `fit(pieces)`, then `estimate(stretch)`: a number a reading."""
import numpy as np
from features import features, shares
from hidden_markov import count_transitions, forward_filter


def labels(pieces):
    return np.concatenate([p.stretch.people[p.keep] for p in pieces])


def weights(pieces):
    return np.concatenate([np.full(p.keep.sum(), p.weight) for p in pieces])


def median_of(posterior, counts):
    """The least count that as many people or fewer have at least even odds of: it minimises the absolute error."""
    return counts[np.argmax(np.cumsum(posterior, axis=1) >= 0.5 - 1e-9, axis=1)]


class Mean:
    """The mean of the training data, whatever the sensors say."""

    def fit(self, pieces):
        self.mean = np.average(labels(pieces), weights=weights(pieces))

    def estimate(self, stretch):
        return np.full(len(stretch.people), self.mean)


class LastReading:
    """The median count for what the last reading says: no sensor, some of them, all."""

    @staticmethod
    def levels(motion):
        return motion.any(axis=1).astype(int) + motion.all(axis=1)

    def fit(self, pieces):
        level = np.concatenate([self.levels(p.stretch.motion)[p.keep] for p in pieces])
        people, weight = labels(pieces), weights(pieces)
        counts = np.arange(people.max() + 1)
        mass = np.zeros((3, len(counts)))
        np.add.at(mass, (level, people), weight)
        overall = mass.sum(axis=0) * 1e-9  # of levels that never occurred
        self.medians = median_of((mass + overall) / (mass + overall).sum(axis=1, keepdims=True), counts)

    def estimate(self, stretch):
        return self.medians[self.levels(stretch.motion)].astype(float)


class AnyOn:
    """Nobody, unless a sensor saw motion in the last five minutes; then the mean of occupied readings."""

    def fit(self, pieces):
        people, weight = labels(pieces), weights(pieces)
        self.mean = np.average(people[people > 0], weights=weight[people > 0])

    def estimate(self, stretch):
        return np.where(shares(stretch.motion, 10).any(axis=1), self.mean, 0.0)


class Learned:
    """A classifier of scikit-learn on the features; the estimate is the median of its distribution."""

    def __init__(self, classifier, weight_name):
        self.classifier, self.weight_name = classifier, weight_name

    def fit(self, pieces):
        rows = np.concatenate([features(p.stretch.motion)[p.keep] for p in pieces])
        self.classifier.fit(rows, labels(pieces), **{self.weight_name: weights(pieces)})

    def estimate(self, stretch):
        posterior = self.classifier.predict_proba(features(stretch.motion))
        return median_of(posterior, self.classifier.classes_).astype(float)


def logistic():
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    return Learned(make_pipeline(StandardScaler(), LogisticRegression(max_iter=1000)),
                   "logisticregression__sample_weight")


def boosted_trees():
    from sklearn.ensemble import HistGradientBoostingClassifier
    return Learned(HistGradientBoostingClassifier(max_iter=60, max_leaf_nodes=8, min_samples_leaf=50, random_state=1),
                   "sample_weight")


class HiddenMarkov:
    """Count as hidden state, with transitions from labels. What is seen is the sensors' mean share of readings with
    motion in five minutes, in six levels. Each reading takes part in ten such windows, so each counts a tenth."""

    WINDOW = 10
    EDGES = (1e-9, 0.1, 0.25, 0.45, 0.7)

    def levels(self, motion):
        return np.searchsorted(self.EDGES, shares(motion, self.WINDOW).mean(axis=1))

    def fit(self, pieces):
        n = labels(pieces).max() + 1
        moves, seen, self.prior = np.full((n, n), 0.1), np.ones((n, len(self.EDGES) + 1)), np.ones(n)
        for p in pieces:
            people = p.stretch.people
            moves += p.weight * count_transitions(people, p.keep, n)
            np.add.at(seen, (people[p.keep], self.levels(p.stretch.motion)[p.keep]), p.weight)
            self.prior += p.weight * np.bincount(people[p.keep], minlength=n)
        self.transition = moves / moves.sum(axis=1, keepdims=True)
        self.emission = (seen / seen.sum(axis=1, keepdims=True)) ** (1.0 / self.WINDOW)
        self.prior /= self.prior.sum()

    def estimate(self, stretch):
        posterior = forward_filter(self.prior, self.transition, self.emission[:, self.levels(stretch.motion)].T)
        return median_of(posterior, np.arange(len(self.prior))).astype(float)


ESTIMATORS = {"mean": Mean, "last reading": LastReading, "any on": AnyOn, "logistic": logistic,
              "boosted trees": boosted_trees, "hidden Markov": HiddenMarkov}
LEARNED = ("logistic", "boosted trees", "hidden Markov")
