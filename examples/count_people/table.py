"""Trains every estimator on every training set, scores it on every test, and writes tables."""
import csv

import numpy as np
from estimators import ESTIMATORS, LEARNED
from readings import among, check_apart
from scores import NAMES, mean_difference, score


def trained(name, pieces):
    estimator = ESTIMATORS[name]()
    estimator.fit(pieces)
    return estimator


def estimates_of(estimator, pieces):
    """Units, true counts and estimates of the kept readings. The estimator sees whole stretches, without labels."""
    parts = [(p.stretch.units[p.keep], p.stretch.people[p.keep], estimator.estimate(p.stretch)[p.keep]) for p in pieces]
    return tuple(np.concatenate(column) for column in zip(*parts))


class Results:
    """Lines of results, and the tables that are made of them."""

    def __init__(self):
        self.lines = []
        self.errors = {}  # of every reading, with its unit

    def add(self, trained_on, estimator, tested_on, units, people, estimates):
        self.errors[trained_on, estimator, tested_on] = units, np.abs(people - estimates)
        for name, (value, low, high) in zip(NAMES, score(units, people, estimates)):
            self.lines.append({"trained_on": trained_on, "estimator": estimator, "tested_on": tested_on, "score": name,
                               "value": value, "low": low, "high": high, "units": len(set(units)),
                               "readings": len(people)})

    def value(self, trained_on, estimator, tested_on, name):
        keys = ("trained_on", "estimator", "tested_on", "score")
        return next(line["value"] for line in self.lines
                    if tuple(line[k] for k in keys) == (trained_on, estimator, tested_on, name))

    def write(self, path):
        with open(path, "w", newline="") as file:
            out = csv.DictWriter(file, list(self.lines[0]))
            out.writeheader()
            out.writerows({k: f"{v:.4f}" if isinstance(v, float) else v for k, v in line.items()} for line in self.lines)

    def markdown(self, name):
        tests = list(dict.fromkeys(line["tested_on"] for line in self.lines))
        cells = {}
        for line in self.lines:
            if line["score"] == name:
                text = f"{line['value']:.2f} ({line['low']:.2f}-{line['high']:.2f})"
                cells.setdefault((line["trained_on"], line["estimator"]), {})[line["tested_on"]] = text
        out = [f"| trained on | estimator | {' | '.join(tests)} |", "|---|---|" + "---|" * len(tests)]
        out += [f"| {on} | {est} | {' | '.join(row.get(t, '-') for t in tests)} |" for (on, est), row in cells.items()]
        return "\n".join(out)

    def differences(self, trained_on, tests):
        """How much greater the mean absolute error is than when trained on `trained_on`."""
        out = [f"| trained on | estimator | {' | '.join(tests)} |", "|---|---|" + "---|" * len(tests)]
        for row in dict.fromkeys(line["trained_on"] for line in self.lines if line["trained_on"] != trained_on):
            for name in LEARNED:
                cells = []
                for test in tests:
                    (units, error), (_, other) = self.errors[row, name, test], self.errors[trained_on, name, test]
                    cells.append("{:+.2f} ({:+.2f} to {:+.2f})".format(*mean_difference(units, error, other)))
                out.append(f"| {row} | {name} | {' | '.join(cells)} |")
        return "\n".join(out)


def simulated(results, trainings, tests, names=tuple(ESTIMATORS)):
    """Every training set on every test; tests: name to (pieces, whether the rooms must be others)."""
    for trained_on, train in trainings.items():
        for name in names:
            estimator = trained(name, train)
            for tested_on, (test, rooms) in tests.items():
                check_apart(train, test, rooms)
                results.add(trained_on, name, tested_on, *estimates_of(estimator, test))


def real_alone(results, stretches, tested_on):
    """Leaves out one unit after the other."""
    units = sorted(set(np.concatenate([s.units for s in stretches])))
    for name in ESTIMATORS:
        parts = []
        for unit in units:
            train, test = among(stretches, set(units) - {unit}), among(stretches, {unit})
            check_apart(train, test)
            parts.append(estimates_of(trained(name, train), test))
        results.add("real alone, one unit left out", name, tested_on, *(np.concatenate(c) for c in zip(*parts)))


def learning_curve(stretches, simulated_pieces, sizes, draws, seed=1):
    """Mean absolute error on the units that weren't drawn, by how many were trained on: lines of a table. With
    simulated pieces, real readings weigh as much as they do altogether."""
    units = sorted(set(np.concatenate([s.units for s in stretches])))
    n_simulated = sum(p.keep.sum() for p in simulated_pieces)
    lines = []
    for size in sizes:
        errors = {name: [] for name in LEARNED}
        rng = np.random.default_rng([seed, size])
        while min(map(len, errors.values())) < draws:
            chosen = set(rng.choice(units, size, replace=False))
            train, test = among(stretches, chosen), among(stretches, set(units) - chosen)
            check_apart(train, test)
            readings = sum(p.keep.sum() for p in train)
            if len(set(np.concatenate([p.stretch.people[p.keep] for p in train]))) < 2 and not simulated_pieces:
                continue  # of one class alone nothing can be learnt
            if simulated_pieces:
                train = [type(p)(p.stretch, p.keep, n_simulated / readings) for p in train] + simulated_pieces
            for name in LEARNED:
                _, people, estimates = estimates_of(trained(name, train), test)
                errors[name].append(np.abs(people - estimates).mean())
        for name in LEARNED:
            lines.append({"real units": size, "with simulated": bool(simulated_pieces), "estimator": name,
                          "error": np.mean(errors[name]), "low": np.min(errors[name]), "high": np.max(errors[name])})
    return lines


def equivalent(lines, estimator, error):
    """How many real units alone train as good a counter, between the points of its learning curve, as text."""
    curve = sorted((line["real units"], line["error"]) for line in lines
                   if line["estimator"] == estimator and not line["with simulated"])
    if error > curve[0][1]:
        return f"< {curve[0][0]}"
    for (fewer, worse), (more, better) in zip(curve, curve[1:]):
        if better <= error <= worse:
            return f"{fewer + (more - fewer) * (worse - error) / max(worse - better, 1e-9):.1f}"
    return f"> {curve[-1][0]}"


def motion_by_people(stretches):
    """P(motion in a reading | people), of each room the sensor that sees more and the one that sees less."""
    rooms = {}
    for stretch in stretches:
        rooms.setdefault(stretch.room, []).append(stretch)
    lines = []
    for room, own in rooms.items():
        people, motion = np.concatenate([s.people for s in own]), np.concatenate([s.motion for s in own])
        for n in range(people.max() + 1):
            seen = np.sort(motion[people == n].mean(axis=0)) if (people == n).any() else [np.nan]
            lines.append((room, n, seen[-1], seen[0], motion[people == n].any(axis=1).mean() if (people == n).any() else np.nan))
    return lines
