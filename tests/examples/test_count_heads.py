"""The counter of blobs of examples/count_heads. Usage: test_count_heads.py FOLDER_OF_THE_EXAMPLE"""
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
from count_heads import blobs  # noqa: E402


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


if __name__ == "__main__":
    unittest.main()
