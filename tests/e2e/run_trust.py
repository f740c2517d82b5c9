#!/usr/bin/env python3
"""tools/trust: what it measures, beside other ways to measure the same.

Usage: run_trust.py PIRSIM TOOLS_DIR [unittest arguments]. Needs python3 only.
"""
import csv
import importlib.machinery
import importlib.util
import io
import json
import math
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import unittest

PIRSIM = TOOL = trust = None


def load(file):
    loader = importlib.machinery.SourceFileLoader("trust", str(file))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("trust", loader))
    loader.exec_module(module)
    return module


class Trust(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def log(self, seed, moves=0.1):
        """Ten hours of readings every 30 s: people who come and go, motion now and then, some readings missing."""
        draw, people, gap = random.Random(seed), 0, 0
        file = self.folder / "day.csv"
        with open(file, "w", newline="") as stream:
            writer = csv.writer(stream)
            writer.writerow(["Date", "Time", "S6_PIR", "S7_PIR", "Room_Occupancy_Count"])
            for i in range(1200):
                people = draw.choice((0, 1, 2, 3)) if draw.random() < 0.03 else people
                gap = draw.choice((1, 3, 30)) if draw.random() < 0.01 else max(0, gap - 1)
                bits = [int(people > 0 and draw.random() < moves) for _ in range(2)]
                if not gap:
                    t = 8 * 3600 + 30 * i
                    writer.writerow(["2024-03-04", f"{t // 3600:02}:{t // 60 % 60:02}:{t % 60:02}", *bits, people])
        return file

    def test_lights_as_control_switches_them(self):
        for seed in range(3):
            file = self.log(seed)
            day = trust.readings(file)
            tallies = trust.office_tallies(day)
            subprocess.run([PIRSIM, "control", "--log", file, "-o", self.folder / "costs.csv", "-q"], check=True,
                           capture_output=True)
            costs = {int(r["delay_min"]): r for r in trust.table(self.folder / "costs.csv")}
            for delay in trust.DELAYS_MIN:
                self.assertEqual(sum(t["off", delay] for t in tallies), int(costs[delay]["false_offs"]))
                self.assertGreater(int(costs[3]["false_offs"]), 3)
                dark = trust.ratio(("dark", delay), "occupied")(tallies)
                self.assertAlmostEqual(dark, float(costs[delay]["dark_share"]), 4)
                self.assertEqual(sum(t["off", delay] for t in tallies),
                                 sum(t["off", delay, k] for t in tallies for k in trust.COUNTS))

    def test_silences_as_runs_of_letters(self):
        day = trust.readings(self.log(7))
        text = ""
        for (before, *_), (t, motion, people, _) in zip([day[0], *day], day):
            text += ("|" if t - before > 31 else "") + ("q" if people and not motion else "|")
        for minutes in trust.SILENCES_MIN:
            self.assertEqual(sum(t["silent", minutes] for t in trust.office_tallies(day)),
                             len(re.findall("q{%d,}" % (2 * minutes), text)))

    def test_runs_of_motion_as_runs_of_letters(self):
        day = trust.readings(self.log(8, moves=0.4))
        text = ""
        for (before, *_), (t, motion, people, _) in zip([day[0], *day], day):
            text += ("|" if t - before > 31 else "") + (str(people) if motion else "|")
        for people in trust.COUNTS:
            self.assertEqual(sum(t["runs", people] for t in trust.office_tallies(day)),
                             len(re.findall(f"{people}+", text)))

    def test_unevenness_of_a_rooms_sensors(self):
        day = [(30.0 * i, True, 1 + (i > 15), [i % 2 == 0, i % 8 == 0]) for i in range(20)]  # with one there 8 of 16, and 2
        self.assertEqual(trust.unevenness(trust.office_tallies(day)), 0.25)

    def test_power_law(self):
        """2,000 values of a cut law: the exponent within four standard errors, and one that is off by 0.3 isn't."""
        draw = random.Random(5)
        for exponent in (-0.2, 0.6, 1.5):
            values = []
            for _ in range(2000):  # inverse of the law's distribution between 5 and 300
                tail = 1 - draw.random() * (1 - (300 / 5) ** -exponent)
                values.append(5 * tail ** (-1 / exponent))
            found, error, n = trust.power_law(values + [1.0, 1000.0], 5, 300)
            self.assertEqual(n, 2000)
            self.assertLess(abs(found - exponent), 4 * error)
            self.assertGreater(abs(found - (exponent + 0.3)), 4 * error)

    def test_movements_of_a_film(self):
        """Two turns and nothing else, of somebody who neither breathes nor fidgets."""
        script, film = self.folder / "turns.yaml", self.folder / "film.gltf"
        script.write_text("pirsim_script: 1\npeople:\n"
                          "  - {id: ann, actions: [{appear: {at_xz_m: [0, -6]}}, {wait_s: 20}, \n"
                          "     {turn: {heading_deg: 90}}, {wait_s: 20}, {turn: {heading_deg: 0}}, {wait_s: 20}]}\n")
        subprocess.run([PIRSIM, "export", "--scene", "open_hall.gltf", "--script", script, "--keys-per-s",
                        str(trust.KEYS_PER_S), "-q", "-o", film], check=True, capture_output=True)
        spells = trust.movements(film)
        self.assertEqual(len(spells), 2)
        self.assertLess(abs(spells[0][0] - 20), 1)
        self.assertGreater(spells[1][0] - spells[0][1], 19)

    def test_a_bought_sensor_notices_who_walks_past_as_far_as_rated_and_not_twice_as_far(self):
        for model, metres in (("AM312", 5), ("SML001", 5), ("E1745", 5), ("SNZB-03", 6), ("RTCGQ11LM", 7)):
            nodes = [{"name": "floor", "extras": {"pirsim": {
                "type": "floor", "polygon_xz_m": [[-7, 1], [7, 1], [7, -18], [-7, -18]]}}},
                {"name": "sensor", "translation": [0, 1.2, 0],
                 "extras": {"pirsim": {"type": "sensor", "id": "PIR", "model": model}}}]
            scene = self.folder / "walk.gltf"
            scene.write_text(json.dumps({"asset": {"version": "2.0"}, "scene": 0, "nodes": nodes, "scenes": [{"nodes": [0, 1]}]}))

            def seen(far):
                script = self.folder / "walk.yaml"
                script.write_text("pirsim_script: 1\nreplicates: 10\npeople:\n  - {id: one, style: natural, actions: ["
                                  f"{{appear: {{at_xz_m: [-5, {-far}], heading_deg: -90}}}}, {{wait_s: 20}}, "
                                  f"{{walk: {{to_xz_m: [[5, {-far}]]}}, phase: across}}]}}\n")
                rows = subprocess.run([PIRSIM, "--scene", scene, "--script", script, "-q"], check=True, capture_output=True,
                                      text=True).stdout
                return len({r["replicate"] for r in csv.DictReader(io.StringIO(rows)) if r["phase"] == "across" and r["PIR"] == "1"})
            with self.subTest(model):
                self.assertGreaterEqual(seen(metres), 9)
                self.assertLessEqual(seen(2 * metres), 1)

    def test_sensors_are_fitted_to_the_installations_and_to_all_but_one(self):
        """Shipped medians and spread follow from what fits each installation; so do those with one left out."""
        bench = trust.Bench(PIRSIM, self.folder / "fit", [1], 1)

        def sensitivity(folder, name):
            numbers = re.search(r"^sensitivity: {median: ([\d.]+), installation_sd: ([\d.]+)", (folder / name).read_text(), re.M)
            return [float(x) for x in numbers.groups()]
        for left_out in (None, "office", "meetings"):
            folder = bench.data("HC-SR501.yaml").parent if left_out is None else bench.out / f"data_without_{left_out}/sensors"
            if left_out is not None:
                trust.without(bench, left_out)
            logs = {k: math.log(v) for k, v in {"bench": 1.1, "office": 3.1, "cube": 3.7, "meetings": 9.5, "house": 9.6}.items()
                    if k != left_out}
            modules = [logs[k] for k in ("bench", "office", "cube") if k in logs]
            with self.subTest(left_out):
                for name, fitted in (("HC-SR501.yaml", modules), ("EKMC1601111.yaml", list(logs.values()))):
                    median, spread = sensitivity(folder, name)
                    self.assertLess(abs(math.log(median) - statistics.mean(fitted)), 0.03)
                    self.assertLess(abs(spread - statistics.stdev(logs.values())), 0.05)
                self.assertEqual(sensitivity(folder, "SML001.yaml")[0], 0.7)

    def test_a_figure_comes_into_its_page(self):
        page = self.folder / "page.md"
        page.write_text("before\n<!-- trust: device /crossings/ -->\nold\n<!-- end of trust -->\nafter\n"
                        "<!-- trust: sleep -->\nkept\n<!-- end of trust -->\n")
        subprocess.run([sys.executable, TOOL, PIRSIM, self.folder / "out", "device", "--page", page], check=True,
                       capture_output=True)
        lines = page.read_text().split("\n")
        self.assertEqual([lines[0], lines[-3], len(lines)], ["before", "kept", 17])
        self.assertEqual(len([line for line in lines if "crossings at" in line]), 7)
        self.assertNotIn("old", lines)


if __name__ == "__main__":
    PIRSIM, tools = sys.argv[1], pathlib.Path(sys.argv[2])
    TOOL = tools / "trust"
    trust = load(TOOL)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
