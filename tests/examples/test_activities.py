#!/usr/bin/env python3
"""The reader of logs with activities, and what a recogniser knows, by hand. Usage: test_activities.py EXAMPLE_DIR.

Needs numpy.
"""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
sys.dont_write_bytecode = True
from events import MEMORY_S, OTHER, PLACES, WINDOW, BadInput, Home, Stretch, features, read_log  # noqa: E402

AREAS = {"PIR_bath": "bath", "PIR_bedroom_2": "bedroom_2", "M003": "bedroom", "door_bath": "door_bath"}


def read(*lines):
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "day.txt"
        log.write_text("".join(line + "\n" for line in lines))
        return read_log(log, AREAS)


class Log(unittest.TestCase):
    def test_labels_hold_from_their_first_line_to_their_last(self):
        stretch = read("2026-03-06 06:00:00 PIR_bedroom_2 ON",
                       "2026-03-06 06:00:01 PIR_bedroom_2 OFF resident_1_sleeping begin",
                       "2026-03-06 07:00:00 PIR_bedroom_2 ON resident_1_sleeping end",
                       "2026-03-06 07:01:00 door_bath OPEN resident_1_toilet begin",
                       "2026-03-06 07:01:00 door_bath OPEN resident_1_toilet end",
                       "2026-03-07 00:00:30 PIR_bath ON resident_2_watching_tv begin")
        self.assertEqual(stretch.done, [{OTHER}, {"sleeping"}, {"toilet"}, {"watching_tv"}])
        self.assertEqual([PLACES[place] for place in stretch.places], ["bedroom", "bedroom", "door_bath", "bath"])
        np.testing.assert_array_equal(stretch.seconds, [21600, 25200, 25260, 86430])
        self.assertFalse(Home("two", [stretch]).is_of_one())

    def test_two_people_at_one_event(self):
        stretch = read("2026-03-06 06:00:00 PIR_bath ON resident_1_washing begin",
                       "2026-03-06 06:00:00 PIR_bath ON resident_2_toilet end", "2026-03-06 06:00:05 PIR_bath ON")
        self.assertEqual(stretch.done, [{"washing"}, {"washing"}])  # what ends was never seen to begin

    def test_as_real_homes_write_it(self):
        stretch = read("2010-11-04 00:03:50.209589 M003 ON Sleeping begin", "2010-11-04 00:04:00.5\tT001\t21.5",
                       "2010-11-04 00:05:00 M003 ON Sleeping end")
        self.assertEqual(stretch.done, [{"Sleeping"}, {"Sleeping"}])
        self.assertTrue(Home("one", [stretch]).is_of_one())

    def test_faults_name_their_line(self):
        good = "2026-03-06 06:00:00 PIR_bath ON"
        for bad in ("2026-03-06 noon PIR_bath ON", "2026-03-06 06:00:01 PIR_bath", "2026-03-06 06:00:01 PIR_bath MAYBE",
                    "2026-03-06 06:00:01 PIR_bath ON washing", "2026-03-06 06:00:01 PIR_bath ON begin"):
            with self.assertRaisesRegex(BadInput, r"day\.txt:2: "):
                read(good, bad)
        with self.assertRaisesRegex(BadInput, "no event"):
            read("2026-03-06 06:00:00 PIR_attic ON")


class Features(unittest.TestCase):
    def test_by_hand(self):
        stretch = Stretch(np.array([3.0, 5.0, 6.0]) * 3600, np.array([4, 1, 4]), [{OTHER}] * 3, set())
        hour, at, since, took, last, faded = np.split(features(stretch), np.cumsum([1, 9, 1, 1, 9]), axis=1)
        np.testing.assert_allclose(hour[:, 0], [23, 1, 2])
        np.testing.assert_array_equal(at.argmax(axis=1), [4, 1, 4])
        np.testing.assert_allclose(np.expm1(since[:, 0]), [0, 7200, 3600])
        np.testing.assert_allclose(np.expm1(took[:, 0]), [0, 7200, 10800])
        np.testing.assert_allclose(last[2, [4, 1]], [2, 1])
        np.testing.assert_allclose(faded[2, [4, 1]], [1 + np.exp(-10800 / MEMORY_S), np.exp(-3600 / MEMORY_S)])

    def test_windows_are_of_the_last_events_and_know_no_future(self):
        rng = np.random.default_rng(5)
        n = 3 * WINDOW
        stretch = Stretch(np.cumsum(rng.exponential(20, n)), rng.integers(0, len(PLACES), n), [{OTHER}] * n, set())
        known = features(stretch)
        np.testing.assert_allclose(known[:, 12:21].sum(axis=1), np.minimum(np.arange(n) + 1, WINDOW))
        half = Stretch(stretch.seconds[:40], stretch.places[:40], stretch.done[:40], set())
        np.testing.assert_allclose(features(half), known[:40])


if __name__ == "__main__":
    unittest.main()
