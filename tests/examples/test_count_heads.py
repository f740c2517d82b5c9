"""The counter of blobs of examples/count_heads. Usage: test_count_heads.py FOLDER_OF_THE_EXAMPLE"""
import pathlib
import sys
import unittest
from unittest import mock

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
import pandas  # noqa: E402
from count_door import counted, errors  # noqa: E402
from count_heads import blobs, public_frames  # noqa: E402


class Blobs(unittest.TestCase):
    def frame(self, *squares):
        frame = np.zeros((24, 32))
        for y, x, size in squares:
            frame[y:y + size, x:x + size] = 5.0
        return frame

    def test_blobs_apart_count_one_each_and_large_ones_more(self):
        for squares, people in (([], 0), ([(2, 2, 4)], 1), ([(2, 2, 4), (14, 20, 4)], 2), ([(2, 2, 6)], 2)):
            self.assertEqual(blobs(self.frame(*squares), 2.5, 16), people, squares)

    def test_a_warm_pixel_and_a_dead_one_are_nobody(self):
        frame = self.frame((5, 5, 1))
        frame[10, 10] = np.nan
        self.assertEqual(blobs(frame, 2.5, 16), 0)

    def test_public_frames_are_read_and_counted(self):
        table = pandas.DataFrame({"data": [21.0 + self.frame((2, 2, 4), (14, 20, 4)), 24.0 + self.frame()],
                                  "points": [[[3.5, 3.5], [21.5, 15.5]], []]})
        with mock.patch("pandas.read_hdf", return_value=table):  # without the library that it needs
            frames, people = public_frames("made.h5")
        self.assertEqual([blobs(frame, 2.5, 16) for frame in frames], people.tolist())


class Door(unittest.TestCase):
    def test_passes_are_told_by_the_order_of_edges_and_errors_apart(self):
        outer, inner = np.array([[0, 1, 1, 0, 0], [0, 0, 1, 1, 0]])
        self.assertEqual((counted(outer, inner), counted(inner, outer), counted(outer, outer)), ([1], [-1], []))
        for told, true, expected in (([], [1], (1, 0, 0, -1)), ([1], [], (0, 1, 0, 1)), ([-1], [1], (0, 0, 1, -2)),
                                     ([1, -1], [1, 1], (0, 0, 1, -2)), ([1, -1], [1], (0, 1, 0, -1))):
            self.assertEqual(errors(told, true), expected)


if __name__ == "__main__":
    unittest.main()
