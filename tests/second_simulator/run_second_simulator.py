#!/usr/bin/env python3
"""pirsim's rows against those of the second simulator, bit for bit. Usage: PIRSIM DATA_DIRECTORY. Needs numpy."""
import csv
import datetime
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

DEBIANS = "/usr/bin/python3"  # which has Debian's numpy
if importlib.util.find_spec("numpy") is None:
    if sys.executable != DEBIANS and os.access(DEBIANS, os.X_OK):
        os.execv(DEBIANS, [DEBIANS, *sys.argv])
    print("numpy (python3-numpy) is missing")
    sys.exit(77)

import numpy as np

import challenge
import faults
import own_rooms
import second_simulator as second
from long_runs import covered_in_blocks

PIRSIM = DATA = None
SCRIPT = """pirsim_script: 1
name: One seat
seed: 5
replicates: 1
sensing: {tick_rate_hz: 50, window_s: 1, rays_per_zone: 5, change_per: cluster, response: zones}
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
RECIPE = """pirsim_recipe: 1
name: Short mornings
rooms:
  - {count: 3, width_m: 5, depth_m: 4, seats: 2,
     sensors: [{mount: corner, count: 2, height_m: [2.2, 2.4], tilt_deg: [15, 45],
                model: [EKMC1603111]}]}
days: 2
schedule: {from: "08:50", to: "08:58", arrival: {mean: "08:52", sd_min: 1}, staff: [{count: 2}]}
effects: [{false_triggers: {rate_per_s: 0.5}}]
split: {validation_rooms: 0, test_rooms: 0, test_days: 0}
"""


class SecondSimulator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "study.yaml").write_text(SCRIPT)
            scene = DATA / "rooms/meeting_room.gltf"
            study = second.study_of(scene, folder / "study.yaml", [])
            subprocess.run([PIRSIM, *study, "-q", "-o", folder / "rows.csv", "--zones", folder / "zones.csv"], check=True)
            rows, cls.zones = (list(csv.DictReader((folder / name).read_text().splitlines()))
                               for name in ("rows.csv", "zones.csv"))
            [cls.recorded] = second.runs_of(PIRSIM, study)
        cls.motion = cls.recorded.motion
        cls.room = second.Gltf(scene)
        cls.plain = second.Measurement(cls.room, DATA / "sensors", faults.FAULTS["nothing"](None), 1)
        cls.plain.bits([cls.recorded], 0)
        cls.rays, cls.active = cls.plain.rays, cls.plain.shares[0] > 0
        cls.bits = np.array([[int(row[sensor]) for sensor in cls.rays.sensors] for row in rows], bool)

    def windows(self, rays, active):
        return second.windows_of(second.sharp(rays, active), 50)

    def test_every_row_is_the_same(self):
        self.assertGreater(self.bits.sum(), 20)
        self.assertLess(self.bits.mean(), 0.8)
        np.testing.assert_array_equal(self.windows(self.rays, self.active), self.bits)

    @staticmethod
    def clusters_of(zones, rays, shape):
        """(ticks, clusters) By pirsim's table of zones, each cluster of as many."""
        active = np.zeros(shape, bool)
        for number, sensor in enumerate(rays.sensors):
            first, n = rays.sensor_of_cluster.index(number), rays.sensor_of_cluster.count(number)
            for row in (row for row in zones if row["sensor"] == sensor):
                active[int(row["tick"]), first:][:n] = (np.array(list(row["zones"])) == "1").reshape(n, -1).any(1)
        return active

    def test_every_cluster_is_the_same_at_every_tick(self):
        """Poses are exported in single precision, so a ray that grazes a limb within a micrometre may differ."""
        expected = self.clusters_of(self.zones, self.rays, self.active.shape)
        self.assertGreater(expected.sum(), 1000)
        self.assertLessEqual((expected != self.active).sum(), 1e-5 * expected.size)

    def test_every_cluster_of_a_dome_is_the_same_at_every_tick(self):
        """As few clusters differ as with lenses of facets; a dome five degrees narrower isn't the same."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            scene = json.loads((DATA / "rooms/meeting_room.gltf").read_text())
            for node in scene["nodes"]:
                if second.mark(node).get("type") == "sensor":
                    second.mark(node)["model"] = "HC-SR501"
            (folder / "room.gltf").write_text(json.dumps(scene))
            (folder / "study.yaml").write_text(SCRIPT)
            study = second.study_of(folder / "room.gltf", folder / "study.yaml", [])
            subprocess.run([PIRSIM, *study, "-q", "-o", folder / "rows.csv", "--zones", folder / "zones.csv"], check=True)
            zones = list(csv.DictReader((folder / "zones.csv").read_text().splitlines()))
            narrow = (DATA / "sensors/HC-SR501.yaml").read_text().replace("wide_deg: 110", "wide_deg: 105")
            (folder / "HC-SR501.yaml").write_text(narrow)
            for sensors, is_same in ((DATA / "sensors", True), (folder, False)):
                rays = second.Rays(second.Gltf(folder / "room.gltf"), sensors)
                active = second.covered_shares(rays, self.motion) > 0
                expected = self.clusters_of(zones, rays, active.shape)
                self.assertGreater(expected.sum(), 1000)
                self.assertEqual((expected != active).sum() <= 1e-5 * expected.size, is_same)

    def test_blocks_of_ticks_decide_as_single_ticks_do(self):
        [(ticks, seen)] = covered_in_blocks(self.rays, self.motion)
        expected = np.concatenate([part for _, part in second.covered_rays(self.rays, self.motion)])
        self.assertEqual(ticks, slice(1, len(self.motion.times)))
        np.testing.assert_array_equal(seen, expected)

    def test_a_sensor_that_is_turned_by_three_degrees_is_noticed(self):
        turned = second.Rays(self.room, DATA / "sensors", mount=lambda _, world: world @ faults.rotation([0, 1, 0], 3.0))
        different = (self.windows(turned, second.covered_shares(turned, self.motion)) != self.bits).sum()
        self.assertGreater(different, 10)

    def bits_with(self, name, seed=1):
        """Rows of the recorded run. What the rays hit is traced once for all faults that come later."""
        fault = faults.FAULTS[name](np.random.default_rng([seed, 0]))
        return second.Measurement(self.room, DATA / "sensors", fault, seed, self.plain).bits([self.recorded], 0)

    def test_nothing_hidden_changes_no_bit(self):
        np.testing.assert_array_equal(self.bits_with("nothing"), self.bits)

    def test_every_fault_behind_the_optics_changes_some_bits_and_the_same_ones_again(self):
        """But for one that comes from run to run."""
        names = [name for name, make in faults.FAULTS.items() if make(np.random.default_rng(1)).is_behind_the_optics()]
        self.assertGreaterEqual(len(names), 15)
        over_the_session = {name for name, make in faults.FAULTS.items() if make(np.random.default_rng(1)).in_run}
        of_several_runs = {name for name, make in faults.FAULTS.items()
                           if make(np.random.default_rng(1)).file is not faults.same}
        for name in sorted(set(names) - over_the_session - of_several_runs - {"nothing", "fading_battery"}):
            with self.subTest(name):
                changed = max((self.bits_with(name, seed) != self.bits).sum() for seed in (1, 2))
                self.assertGreater(changed, 0)
                np.testing.assert_array_equal(self.bits_with(name), self.bits_with(name))

    def test_faults_before_and_in_the_optics_change_some_bits(self):
        for name in ("tipped", "half_blind", "blurred_by_area", "fan_heater"):
            with self.subTest(name):
                self.assertGreater((self.bits_with(name) != self.bits).sum(), 0)

    def test_faults_of_the_electronics_do_what_they_are_called(self):
        held = self.bits_with("monostable")
        self.assertTrue((held | ~self.bits).all(), "a pulse that is held is never lost")
        self.assertGreater(held.sum(), self.bits.sum())
        for column in self.bits_with("lock_out").T:
            self.assertGreaterEqual(np.diff(np.flatnonzero(column)).min(initial=2), 2)
        self.assertEqual(self.bits_with("broken_sensor").any(0).sum(), self.bits.any(0).sum() - 1)
        self.assertTrue((self.bits | ~self.bits_with("dazzled")).all(), "who is dazzled sees nothing more")

    def file_with(self, name, n_runs=4, seed=1):
        """[(rows, sensors)] of so many times the recorded run, from which a column each is left out, so that they
        differ."""
        fault = faults.FAULTS[name](np.random.default_rng([seed, 0]))
        return fault.file(self.several(n_runs), np.random.default_rng(seed))

    def several(self, n_runs):
        return [np.roll(self.bits, 3 * number, axis=0) & (np.arange(5) != number % 5) for number in range(n_runs)]

    def test_faults_of_the_file_do_what_they_are_called(self):
        plain, all_of = self.several(4), np.concatenate
        self.assertTrue((all_of(self.file_with("nothing")) == all_of(plain)).all())
        columns = all_of(self.file_with("twin_columns")).T
        self.assertEqual(sum((one == other).all() for i, one in enumerate(columns) for other in columns[:i]), 1)
        self.assertEqual(sum(run[::5].all(0).sum() for run in self.file_with("heartbeat")), 4)
        changed = [(one != other).any() for one, other in zip(self.file_with("trial_copied"), plain)]
        self.assertEqual(sum(changed), 1)
        self.assertLess(all_of(self.file_with("gap_of_zeros")).sum(), all_of(plain).sum())
        text = self.file_with("sorted_as_text")[0]
        np.testing.assert_array_equal(text[:3], plain[0][[0, 9, 10]])
        np.testing.assert_array_equal(self.file_with("other_order")[1], plain[0])

    def test_a_session_changes_in_the_order_of_its_runs(self):
        """The same run three times."""
        three = [self.recorded] * 3
        for name in ("longer_hold", "growing_noise"):
            fault = faults.FAULTS[name](np.random.default_rng([1, 0]))
            first, _, last = second.Measurement(self.room, DATA / "sensors", fault, 1, self.plain_three()).all_bits(three)
            with self.subTest(name):
                np.testing.assert_array_equal(first, self.bits)
                self.assertTrue((last | ~self.bits).all())
                self.assertGreater(last.sum(), self.bits.sum())
        ranges = [faults.FAULTS["warming_room"](np.random.default_rng(1)).in_run(done).range_scale for done in (0, 0.5, 1)]
        self.assertEqual(ranges[0], 1)
        self.assertTrue(1 > ranges[1] > ranges[2] > 0.3)

    def plain_three(self):
        plain = second.Measurement(self.room, DATA / "sensors", faults.FAULTS["nothing"](None), 1, self.plain)
        plain.shares = {number: self.plain.shares[0] for number in range(3)}
        return plain

    def test_what_strikes_all_sensors_strikes_them_at_once(self):
        added = self.bits_with("mains_pulse") & ~self.bits
        self.assertTrue((self.bits_with("mains_pulse")[added.any(1)]).all())
        lost = self.bits & ~self.bits_with("jammed_radio")
        self.assertFalse(self.bits_with("jammed_radio")[lost.any(1)].any())

    def test_the_program_writes_the_rows_of_a_fault(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "study.yaml").write_text(SCRIPT)
            subprocess.run([sys.executable, second.__file__, PIRSIM, "--scene", DATA / "rooms/meeting_room.gltf", "--script",
                            folder / "study.yaml", "--fault", "half_blind", "--seed", "3", "-o", folder / "measured.csv"],
                           check=True)
            rows = list(csv.DictReader((folder / "measured.csv").read_text().splitlines()))
        written = np.array([[int(row[sensor]) for sensor in self.rays.sensors] for row in rows], bool)
        np.testing.assert_array_equal(written, self.bits_with("half_blind", 3))
        self.assertGreater((written != self.bits).sum(), 0)

    def test_what_is_moved_keeps_its_shape(self):
        swings = faults.FAULTS["swings_on_the_chair"](np.random.default_rng(1)).people
        most = 0.0
        for seed in range(5):  # it swings half of the time
            swung = swings([self.recorded], 0, self.room, np.random.default_rng(seed))
            self.check_shape(swung)
            most = max(most, np.abs(swung.solids[1][1] - self.recorded.motion.solids[1][1]).max())
        self.assertGreater(most, 0.001)

    def check_shape(self, swung):
        for (_, before, _, _), (_, after, _, _) in zip(self.recorded.motion.solids, swung.solids):
            pelvis = self.recorded.motion.solids[0][1]
            np.testing.assert_allclose(np.linalg.norm(after - pelvis, axis=1), np.linalg.norm(before - pelvis, axis=1),
                                       atol=1e-9)

    def test_scores_say_how_a_verdict_compares_with_what_was_hidden(self):
        told = lambda verdict, *effects: {"verdict": verdict, "effects": list(effects)}
        self.assertEqual(challenge.score(("a",), told("named", "a")), "right")
        self.assertEqual(challenge.score(("a",), told("named", "b")), "misnamed")
        self.assertEqual(challenge.score(("a",), told("several", "b", "a")), "right")
        self.assertEqual(challenge.score(("a",), told("one-of", "a", "b")), "in the set")
        self.assertEqual(challenge.score(("a",), told("one-of", "c", "b")), "not in the set")
        self.assertEqual(challenge.score((), told("named", "b")), "misnamed")
        self.assertEqual(challenge.score((), told("none-in-catalogue")), "unknown")
        self.assertEqual(challenge.score(("a",), told("none-in-catalogue")), "unknown")
        self.assertEqual(challenge.score(("a",), told("no-disagreement")), "nothing seen")
        faulty = told("faulty-data") | {"data_findings": [{"kind": "equal_columns"}]}
        self.assertEqual(challenge.score((), faulty, ("equal_columns",)), "told")
        self.assertEqual(challenge.score((), faulty, ("beats",)), "other fault of the file")
        self.assertEqual(challenge.score(("a",), faulty), "file accused")
        self.assertEqual(challenge.score((), told("none-in-catalogue"), ("beats",)), "unknown")


class OwnRooms(unittest.TestCase):
    """Mornings of people of natural style, lenses with square zones."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        folder = pathlib.Path(cls.folder.name)
        (folder / "recipe.yaml").write_text(RECIPE)
        for name, *more in (("plain", "--plain", "--rooms", "1", "--days", "1"), ("faulty",)):
            subprocess.run([sys.executable, own_rooms.__file__, PIRSIM, folder / "recipe.yaml", "-o", folder / name, *more],
                           check=True, stdout=subprocess.DEVNULL)
        cls.plain, cls.faulty = folder / "plain", folder / "faulty"

    def test_sensors_without_faults_say_what_pirsims_zones_say(self):
        """Each second, and in the file each reading."""
        room = own_rooms.Room(PIRSIM, self.plain / "dataset", "room_0001", own_rooms.AsWired.plain)
        [day] = room.days
        with unittest.mock.patch.object(own_rooms, "PART_S", 100):  # five parts
            outputs = day.outputs(room.rays, room.fault, np.random.default_rng(1))
        expected = np.array([[int(row[sensor]) for sensor in room.rays.sensors] for row in day.rows], bool)
        self.assertEqual(expected.shape, (480, 2))
        self.assertGreater(expected.sum(0).min(), 5)
        np.testing.assert_array_equal(second.windows_of(outputs, own_rooms.RATE_HZ), expected)
        _, *readings = (line.split(",") for line in (self.plain / "room_0001/days/day_01.csv").read_text().splitlines())
        self.assertEqual([reading[:2] for reading in readings[:2]], [["2026/03/02", "08:50:30"], ["2026/03/02", "08:51:00"]])
        np.testing.assert_array_equal(np.array([reading[2:4] for reading in readings], int),
                                      expected.reshape(16, 30, 2).any(1))
        self.assertEqual([int(reading[4]) for reading in readings], [int(row["people"]) for row in day.rows[29::30]])
        log = (self.plain / "room_0001/log.csv").read_text().splitlines()
        np.testing.assert_array_equal(self.held(log[1:], self.home_assistants, room.rays.sensors), outputs)

    def test_each_form_of_a_log_tells_of_the_first_day_what_its_readings_tell(self):
        """Events, held from one to the next."""
        forms = {}
        for number in (1, 2, 3):
            folder = self.faulty / f"room_{number:04}"
            truth, log = json.loads((folder / "truth.json").read_text()), (folder / "log.csv").read_text().splitlines()
            forms[truth["log"]] = log
            _, *readings = (line.split(",") for line in (folder / "days/day_01.csv").read_text().splitlines())
            told = np.array([reading[2:4] for reading in readings], int)
            with self.subTest(truth["log"]):
                np.testing.assert_array_equal(self.readings_of(truth["log"], log, truth["sensors"]), told)
                self.assertGreater(told.sum(), 0)
        self.assertEqual(set(forms), {"home_assistant", "casas", "wide"})
        self.assertNotIn("Count", forms["wide"][0])

    def readings_of(self, form, log, sensors):
        if form == "wide":
            return np.array([line.split(",")[2:] for line in log[1:]], int)
        if form == "casas":
            return second.windows_of(self.held(log, self.casas_, sensors), 300).astype(int)
        return second.windows_of(self.held(log[1:], self.home_assistants, sensors), 300).astype(int)

    @staticmethod
    def casas_(line):
        date, clock, sensor, state = line.split()
        return sensor, state == "ON", datetime.datetime.fromisoformat(f"{date} {clock}")

    @staticmethod
    def home_assistants(line):
        entity, state, stamp = line.split(",")
        utc = datetime.datetime.fromisoformat(stamp[:-1])
        return entity[len("binary_sensor."):-len("_motion")].upper(), state == "on", utc + datetime.timedelta(hours=1)

    @staticmethod
    def held(lines, parsed, sensors):
        """(ticks, sensors) From tick 1 on: each state, from its moment to the next."""
        on = np.zeros((480 * own_rooms.RATE_HZ, len(sensors)), bool)
        for sensor, state, when in map(parsed, lines):
            tick = round((when - datetime.datetime(2026, 3, 2, 8, 50)).total_seconds() * own_rooms.RATE_HZ)
            on[max(tick - 1, 0):, sensors.index(sensor)] = state
        return on

    def test_every_room_has_faults_of_its_own_and_the_same_ones_again(self):
        truths = [(self.faulty / f"room_{number:04}/truth.json").read_text() for number in (1, 2, 3)]
        self.assertEqual(len({json.loads(truth)["hold_s"] for truth in truths}), 3)
        self.assertFalse(any(effect for effect in (self.faulty / "dataset/effects.csv").read_text().splitlines()[1:]))
        drawn = own_rooms.AsWired.drawn(np.random.default_rng([1, 4, 0]), 2)
        self.assertEqual(drawn.hold_s, json.loads(truths[0])["hold_s"])


if __name__ == "__main__":
    PIRSIM, DATA = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main(verbosity=2)
