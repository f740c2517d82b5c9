"""Logistic and trees: features, scikit-learn's own answers, saved files."""

import builtins
import json
import pickle

import numpy as np
import pytest
from test_counting_training import simulated

import pirsim
from pirsim import counting
from pirsim.counting._learned import features

WINDOWS = (2, 10, 30)


def features_of_one(motion, i):
    """Of reading i, by the words: shares of what is known, longer windows where nothing is."""
    columns = []
    for length in reversed(WINDOWS):
        part = motion[max(0, i + 1 - length):i + 1]
        own = [np.mean(column[column != 2] == 1) for column in part.T if (column != 2).any()]
        either = [(row == 1).any() for row in part if (row != 2).any()]
        longer = columns[0] if columns else [np.nan] * 4
        columns.insert(0, [np.mean(own), max(own), min(own), np.mean(either)] if own else longer)
    since = next((k for k in range(30) if i - k >= 0 and (motion[i - k] == 1).any()), 30)
    return [*np.ravel(columns), since]


@pytest.mark.parametrize("unknown", [0.0, 0.3, 0.9, 0.99])
@pytest.mark.parametrize("n_sensors", [1, 2, 3])
def test_features_are_what_they_say(unknown, n_sensors):
    rng = np.random.default_rng(int(1000 * unknown) + n_sensors)
    motion = (rng.random((300, n_sensors)) < 0.1).astype(np.uint8)
    motion[rng.random(motion.shape) < unknown] = 2
    found = features(motion, WINDOWS)
    np.testing.assert_allclose(found, [features_of_one(motion, i) for i in range(300)], atol=1e-12)
    np.testing.assert_allclose(found, features(motion[:, ::-1], WINDOWS), atol=1e-12)
    assert np.array_equal(found[:200], features(motion[:200], WINDOWS), equal_nan=True)  # the future doesn't count
    assert np.isnan(found).any() or unknown < 0.99


@pytest.fixture(scope="module")
def days():
    return [simulated(np.random.default_rng([11, room]), room, n=600) for room in range(4)]


def test_logistic_is_scikit_learns(days, tmp_path):
    linear_model, pipeline = pytest.importorskip("sklearn.linear_model"), pytest.importorskip("sklearn.pipeline")
    from sklearn.preprocessing import StandardScaler
    theirs = pipeline.make_pipeline(StandardScaler(), linear_model.LogisticRegression(max_iter=1000))
    for most in (2, 1):  # three classes, and two
        chosen = [day._replace(people=np.minimum(day.people, most)) for day in days]
        theirs.fit(np.concatenate([features(day.motion, WINDOWS) for day in chosen]),
                   np.concatenate([day.people for day in chosen]))
        counter = counting.train(chosen, model="logistic")
        estimates = counter.estimate(days[0].motion)
        np.testing.assert_allclose(estimates.probabilities, theirs.predict_proba(features(days[0].motion, WINDOWS)),
                                   atol=1e-5)  # as far as its iterations go
        counter.save(tmp_path / "logistic.json")
        again = counting.load(tmp_path / "logistic.json")
        assert np.array_equal(again.estimate(days[0].motion).probabilities, estimates.probabilities)
    assert np.abs(estimates.people - days[0].people).mean() < np.abs(days[0].people - 1).mean()


def test_live_counts_and_unknown_readings(days):
    pytest.importorskip("sklearn")
    motion = days[0].motion[:45].copy()
    motion[10:35] = 2
    for model in ("logistic", "trees"):
        counter = counting.train(days, model=model)
        estimates, live = counter.estimate(motion), counter.live()
        for i, bits in enumerate(motion):
            np.testing.assert_allclose(live.next(bits), estimates.probabilities[i], atol=1e-12)
            assert live.people == (estimates.people[i] if estimates.people[i] >= 0 else None)
        # Ten readings are five minutes: from then on nobody knows.
        assert np.isnan(estimates.probabilities[20:35]).all() and (estimates.people[20:35] == -1).all()
        assert not np.isnan(estimates.probabilities[:20]).any() and not np.isnan(estimates.probabilities[35:]).any()
        assert np.array_equal(counter.estimate(np.where(motion == 2, np.nan, motion.astype(float))).people,
                              estimates.people)


def test_a_count_that_was_never_there_isnt_expected(days, tmp_path):
    pytest.importorskip("sklearn")
    chosen = [day._replace(people=np.where(day.people == 2, 3, day.people)) for day in days]
    for model in ("logistic", "trees"):
        counter = counting.train(chosen, model=model)
        probabilities = counter.estimate(days[0].motion).probabilities
        assert probabilities.shape[1] == 4 and not probabilities[:, 2].any() and probabilities[:, 3].any()
        np.testing.assert_allclose(probabilities.sum(axis=1), 1.0)
        if model == "logistic":
            counter.save(tmp_path / "counter.json")
            assert np.array_equal(counting.load(tmp_path / "counter.json").estimate(days[0].motion).probabilities,
                                  probabilities)
        else:
            with pytest.raises(pirsim.UsageError, match="trees can't be saved"):
                counter.save(tmp_path / "trees.json")


def test_a_faulty_file_is_refused_in_a_line(days, tmp_path):
    pytest.importorskip("sklearn")
    file = tmp_path / "logistic.json"
    counting.train(days, model="logistic").save(file)
    saved = json.loads(file.read_text())
    for changes, why in (({"pirsim_counter": 2}, "reads version 1"), ({"prior": [1.0]}, "2 to 1000"),
                         ({"prior": [0.5, 0.5, 0.5]}, "add up to 1"), ({"middle": [0.0]}, "middle has the shape"),
                         ({"scale": [0.0] * 13}, "scale"), ({"coefficients": "none"}, "logistic counter"),
                         ({"intercepts": [None] * 3}, "intercepts"), ({"step_s": -1}, "step_s"),
                         ({"middle": [float("nan")] * 13}, "isn't a number")):
        file.write_text(json.dumps({**saved, **changes}))
        with pytest.raises(pirsim.InputError, match=why) as refused:
            counting.load(file)
        assert len(str(refused.value).splitlines()) == 1 and "logistic.json: error: " in str(refused.value)
    del saved["scale"]
    file.write_text(json.dumps(saved))
    with pytest.raises(pirsim.InputError, match="'scale' is missing"):
        counting.load(file)


def test_the_command_line_says_whose_counter_it_is(days, command, tmp_path):
    pytest.importorskip("sklearn")
    counting.train(days, model="logistic").save(tmp_path / "logistic.json")
    (tmp_path / "log.csv").write_text("time,a,b\n2026-03-02T08:00:00,0,1\n2026-03-02T08:00:30,0,1\n")
    command("count", tmp_path / "logistic.json", "--log", tmp_path / "log.csv", code=3)


def test_trees_can_be_pickled(days):
    pytest.importorskip("sklearn")
    counter = counting.train(days, model="trees")
    again = pickle.loads(pickle.dumps(counter))
    assert np.array_equal(again.estimate(days[1].motion).probabilities, counter.estimate(days[1].motion).probabilities)


@pytest.fixture
def without_scikit_learn(monkeypatch):
    imported = builtins.__import__

    def without(name, *rest, **more):
        if name.split(".")[0] == "sklearn":
            raise ImportError(name)
        return imported(name, *rest, **more)

    return lambda: monkeypatch.setattr(builtins, "__import__", without)


def test_a_saved_logistic_counter_needs_no_scikit_learn(days, tmp_path, without_scikit_learn):
    pytest.importorskip("sklearn")
    counter = counting.train(days, model="logistic")
    counter.save(tmp_path / "logistic.json")
    without_scikit_learn()
    assert np.array_equal(counting.load(tmp_path / "logistic.json").estimate(days[1].motion).people,
                          counter.estimate(days[1].motion).people)


@pytest.mark.parametrize("model", ["logistic", "trees"])
def test_without_scikit_learn_its_extra_is_named(model, days, without_scikit_learn):
    without_scikit_learn()
    with pytest.raises(ImportError, match=r"pip install 'pirsim\[count\]'"):
        counting.train(days, model=model)
