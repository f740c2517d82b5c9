#!/usr/bin/env python3
"""pirsim's rows against those of the second simulator, bit for bit. Usage: PIRSIM DATA_DIRECTORY. Needs numpy."""
import csv
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

DEBIANS = "/usr/bin/python3"  # which has Debian's numpy
if importlib.util.find_spec("numpy") is None:
    if sys.executable != DEBIANS and os.access(DEBIANS, os.X_OK):
        os.execv(DEBIANS, [DEBIANS, *sys.argv])
    print("numpy (python3-numpy) is missing")
    sys.exit(77)

import numpy as np

import second_simulator as second

PIRSIM = DATA = None
SCRIPT = """pirsim_script: 1
name: One seat
seed: 5
replicates: 1
sensing: {tick_rate_hz: 50, window_s: 1, rays_per_zone: 5, change_per: cluster}
trials:
  for_each: {seat: [S4]}
  id: ${seat}
people:
  - id: occupant
    stature_m: 1.86
    mass_kg: 80
    actions:
      - enter: door
      - sit: ${seat}
      - work: {duration_s: 24, arm_amplitude_m: 0.1, arm_period_s: 3, tilt_choices_deg: [-15, 0, 15], tilt_every_s: 6}
      - rise
"""


class SecondSimulator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "study.yaml").write_text(SCRIPT)
            scene = DATA / "rooms/meeting_room.gltf"
            study = ["--scene", scene, "--script", folder / "study.yaml", "-q"]
            subprocess.run([PIRSIM, *study, "-o", folder / "rows.csv", "--zones", folder / "zones.csv"], check=True)
            subprocess.run([PIRSIM, "export", *study, "--keys-per-s", "50", "--beams", "none", "-o",
                            folder / "run.gltf"], check=True)
            rows, cls.zones = (list(csv.DictReader((folder / name).read_text().splitlines()))
                               for name in ("rows.csv", "zones.csv"))
            cls.motion = second.Motion(second.Gltf(folder / "run.gltf"))
            cls.room = second.Gltf(scene)
        cls.rays = second.Rays(cls.room, DATA / "sensors")
        cls.active = second.active_clusters(cls.rays, cls.motion)
        cls.bits = np.array([[int(row[sensor]) for sensor in cls.rays.sensors] for row in rows], bool)

    def windows(self, rays, active):
        return second.windows_of(second.triggers_of(rays, active), 50)

    def test_every_row_is_the_same(self):
        self.assertGreater(self.bits.sum(), 20)
        self.assertLess(self.bits.mean(), 0.8)
        np.testing.assert_array_equal(self.windows(self.rays, self.active), self.bits)

    def test_every_cluster_is_the_same_at_every_tick(self):
        """Poses are exported in single precision, so a ray that grazes a limb within a micrometre may differ."""
        expected = np.zeros_like(self.active)
        first = {sensor: self.rays.sensor_of_cluster.index(i) for i, sensor in enumerate(self.rays.sensors)}
        for row in self.zones:
            zones = np.array(list(row["zones"])) == "1"
            clusters = zones.reshape(-1, 4).any(1)
            expected[int(row["tick"]), first[row["sensor"]]:][: len(clusters)] = clusters
        self.assertGreater(expected.sum(), 1000)
        self.assertLessEqual((expected != self.active).sum(), 1e-5 * expected.size)

    def test_a_sensor_that_is_turned_by_three_degrees_is_noticed(self):
        turned = second.Rays(self.room, DATA / "sensors", yaw_deg=3.0)
        different = (self.windows(turned, second.active_clusters(turned, self.motion)) != self.bits).sum()
        self.assertGreater(different, 10)

    def test_injected_faults_do_what_they_are_called(self):
        class Options:
            missed = dead_s = false_per_s = 0.0

        triggers = second.triggers_of(self.rays, self.active)
        random = lambda: np.random.default_rng(1)
        np.testing.assert_array_equal(second.inject(triggers, 50, 50, Options, random()), self.bits)
        missed, dead, false = type("M", (Options,), {"missed": 0.5}), type("D", (Options,), {"dead_s": 3.0}), type(
            "F", (Options,), {"false_per_s": 0.5})
        self.assertLess(second.inject(triggers, 50, 50, missed, random()).sum(), 0.8 * self.bits.sum())
        self.assertGreater(second.inject(triggers, 50, 50, false, random()).sum(), 1.2 * self.bits.sum())
        for column in second.inject(triggers, 50, 50, dead, random()).T:
            self.assertGreaterEqual(np.diff(np.flatnonzero(column)).min(initial=3), 2)


if __name__ == "__main__":
    PIRSIM, DATA = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main(verbosity=2)
