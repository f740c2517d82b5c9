#!/usr/bin/env python3
"""The counter's parts against what they must be. Usage: test_count_people.py EXAMPLE_DIR. Needs numpy."""
import itertools
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
sys.dont_write_bytecode = True
from disagreement import RUN, SETTLING, steady_runs  # noqa: E402
from features import features, shares  # noqa: E402
from hidden_markov import forward_filter  # noqa: E402
from readings import BadInput, Stretch, among, check_apart, first_mornings, read_uci864, whole  # noqa: E402
from scores import mean_difference, score, scores_of, tally  # noqa: E402
from table import equivalent  # noqa: E402


def day(room, name, n=4):
    return Stretch(room, np.zeros((n, 2), bool), np.zeros(n, int), np.full(n, name))


class Leakage(unittest.TestCase):
    def test_days_and_rooms_apart(self):
        check_apart(whole([day("a", "a 1")]), whole([day("a", "a 2")]))
        check_apart(whole([day("a", "a 1")]), whole([day("b", "b 1")]), rooms=True)

    def test_twins_that_must_fail(self):
        with self.assertRaises(ValueError):
            check_apart(whole([day("a", "a 1"), day("a", "a 2")]), whole([day("a", "a 2")]))
        with self.assertRaises(ValueError):
            check_apart(whole([day("a", "a 1")]), whole([day("a", "a 2")]), rooms=True)

    def test_units_divide_the_readings(self):
        stretch = Stretch("a", np.zeros((6, 1), bool), np.arange(6), np.array(["x", "x", "y", "y", "z", "z"]))
        self.assertEqual(list(among([stretch], {"x", "z"})[0].keep), [True, True, False, False, True, True])

    def test_first_mornings_take_every_room_before_a_second_day(self):
        pieces = whole([day(room, f"{room} {d}") for room in "ab" for d in (1, 2, 3)])
        self.assertEqual([sorted(p.units())[0] for p in first_mornings(pieces, 3)], ["a 1", "a 2", "b 1"])
        self.assertEqual(len(first_mornings(pieces, 6)), 6)
        with self.assertRaises(ValueError):
            first_mornings(pieces, 7)


class Uci864(unittest.TestCase):
    HEADER = "Date,Time,S6_PIR,S7_PIR,Room_Occupancy_Count"

    def read(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "real.csv"
            path.write_text("\n".join([self.HEADER, *lines]) + "\n")
            return read_uci864(path)

    def test_as_published_and_as_a_spreadsheet_rewrites_it(self):
        published = self.read("2017/12/22,09:59:41,0,1,1", "2017/12/22,10:00:12,1,0,2")
        rewritten = self.read("2017-12-22,9:59:41,0,1,1", "2017-12-22,10:00:12,1,0,2")
        for (a, b) in zip(published, rewritten):
            np.testing.assert_array_equal(a.motion, [[False, True], [True, False]])
            np.testing.assert_array_equal(a.motion, b.motion)
            np.testing.assert_array_equal(a.people, b.people)
            self.assertEqual(list(a.units), list(b.units))
        self.assertEqual(len(published), len(rewritten))

    def test_faults_name_their_line(self):
        good = "2017/12/22,10:00:12,1,0,2"
        for bad, line in (("22 Dec,10:00:13,1,0,2", 3), ("2017/12/22,10:00,1,0,2", 3), ("2017/12/22,10:00:13,yes,0,2", 3),
                          ("2017/12/22,10:00:13,1,0,", 3), ("2017/12/22,10:00:11,1,0,2", 3), ("2017/12/22", 3)):
            with self.assertRaisesRegex(BadInput, rf"real\.csv:{line}: "):
                self.read(good, bad)
        with self.assertRaisesRegex(BadInput, "no readings"):
            self.read()
        with self.assertRaisesRegex(BadInput, "No such file"):
            read_uci864("nowhere.csv")


class Filter(unittest.TestCase):
    def test_all_paths_of_a_small_chain(self):
        rng = np.random.default_rng(3)
        prior, moves, seen = rng.dirichlet([1] * 3), rng.dirichlet([1] * 3, 3), rng.random((5, 3))
        found = forward_filter(prior, moves, seen)
        for end in range(5):
            mass = np.zeros(3)
            for path in itertools.product(range(3), repeat=end + 1):
                p = prior[path[0]] * seen[0, path[0]]
                for t in range(1, end + 1):
                    p *= moves[path[t - 1], path[t]] * seen[t, path[t]]
                mass[path[-1]] += p
            np.testing.assert_allclose(found[end], mass / mass.sum(), rtol=1e-12)


class Features(unittest.TestCase):
    def test_shares_of_a_toy_series(self):
        motion = np.array([[1, 0], [0, 0], [1, 1], [0, 1]], bool)
        np.testing.assert_allclose(shares(motion, 2), [[1, 0], [0.5, 0], [0.5, 0.5], [0.5, 1]])
        np.testing.assert_allclose(features(motion)[:, 12], [0, 1, 0, 0])
        np.testing.assert_allclose(features(motion)[3, :4], [0.75, 1, 0.5, 1])

    def test_order_of_sensors_and_the_future_do_not_count(self):
        motion = np.random.default_rng(4).random((50, 3)) < 0.3
        np.testing.assert_allclose(features(motion), features(motion[:, ::-1]))
        np.testing.assert_allclose(features(motion)[:20], features(motion[:20]))


class Scores(unittest.TestCase):
    def test_by_hand(self):
        units, people = np.array(["a", "a", "b", "b"]), np.array([0, 0, 1, 3])
        estimates = np.array([0.0, 1.0, 1.0, 1.0])
        np.testing.assert_allclose(scores_of(tally(units, people, estimates, 4).sum(axis=0)), [0.75, 0.75, 0.5])
        value, low, high = score(units, people, estimates)[0]
        np.testing.assert_allclose([value, low, high], [0.75, 0.5, 1.0])  # of the days alone: 0.5 and 1

    def test_what_a_unit_is_hard_for_cancels_in_a_difference(self):
        units, other = np.repeat(["a", "b", "c"], [1, 2, 3]), np.array([0.0, 1.0, 3.0, 9.0, 9.0, 9.0])
        np.testing.assert_allclose(mean_difference(units, other + 0.5, other), [0.5, 0.5, 0.5])
        value, low, high = mean_difference(units, other + np.array([1.0, 0, 0, 0, 0, 0]), other)
        np.testing.assert_allclose([value, low, high], [1 / 6, 0.0, 1.0])  # none of the unit that differs, nothing else


class Disagreement(unittest.TestCase):
    def test_steady_runs_keep_clear_of_changes(self):
        people = np.repeat([1, 2, 1], [2 * SETTLING + 2 * RUN + 3, 2 * SETTLING + RUN - 1, 2 * SETTLING + RUN])
        motion = np.arange(len(people))[:, None].repeat(2, axis=1)
        runs = steady_runs([Stretch("a", motion, people, np.full(len(people), "a 1"))])
        self.assertEqual([r[0, 0] for r in runs[1]], [SETTLING, SETTLING + RUN])
        self.assertEqual((len(runs[2]), len(runs[3])), (0, 0))
        self.assertTrue(all(len(r) == RUN for r in runs[1]))


class Equivalent(unittest.TestCase):
    def test_between_the_points_of_the_curve(self):
        lines = [{"real units": n, "with simulated": False, "estimator": "e", "error": e} for n, e in ((1, 0.9), (2, 0.5), (4, 0.3))]
        lines.append({"real units": 1, "with simulated": True, "estimator": "e", "error": 0.1})
        self.assertEqual([equivalent(lines, "e", error) for error in (1.0, 0.9, 0.7, 0.4, 0.3, 0.2)],
                         ["< 1", "1.0", "1.5", "3.0", "4.0", "> 4"])


if __name__ == "__main__":
    unittest.main()
