#!/usr/bin/env python3
"""Areas of the floor: rows that count their people, and all that names them.

Usage: run_areas.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import collections
import csv
import io
import json

from program import DATA, Case, main, pirsim, rows


def without_areas(nodes, _):
    for node in nodes.values():
        if node.get("extras", {}).get("pirsim", {}).get("type") == "area":
            del node["extras"]


class Areas(Case):
    def setUp(self):
        super().setUp()
        self.scene = DATA / "rooms" / "two_rooms.gltf"
        self.study = "--script", DATA / "studies" / "two_rooms.yaml", "--sensors", DATA / "sensors"

    def run_study(self, *args, scene=None, code=0):
        return pirsim("--scene", scene or self.scene, *self.study, *args, code=code)

    def edited_scene(self, change):
        scene = json.loads(self.scene.read_text())
        change({node["name"]: node for node in scene["nodes"]}, scene)
        path = self.folder / "scene.gltf"
        path.write_text(json.dumps(scene))
        return path

    def test_the_people_of_two_rooms_sum_to_all_and_are_where_the_occupants_are(self):
        occupants = self.folder / "occupants.csv"
        text = self.run_study("--occupants", occupants).stdout
        self.assertEqual(text.splitlines()[0],
                         "replicate,trial,time_s,phase,people,people_living_room,people_bedroom,PIR1,PIR2")
        places = collections.Counter()
        for row in rows(occupants.read_text()):
            if row["where"] == "outside":
                self.assertEqual(row["area"], "")
                continue
            # The two meet in the middle of the wall, at x = 4.5; where somebody is told to a millimetre.
            if abs(float(row["x_m"]) - 4.5) > 0.001:
                self.assertEqual(row["area"], "living_room" if float(row["x_m"]) < 4.5 else "bedroom")
            places[row["replicate"], row["time_s"], row["area"]] += 1
        there = collections.Counter()
        for row in rows(text):
            self.assertEqual(int(row["people_living_room"]) + int(row["people_bedroom"]), int(row["people"]))
            for area in ("living_room", "bedroom"):
                self.assertEqual(places[row["replicate"], row["time_s"], area], int(row["people_" + area]))
                there[area] += int(row["people_" + area])
        self.assertGreater(there["living_room"], 50)
        self.assertGreater(there["bedroom"], 50)

    def test_without_areas_the_rows_have_the_same_bytes_but_for_their_columns(self):
        plain = list(csv.reader(io.StringIO(self.run_study(scene=self.edited_scene(without_areas)).stdout)))
        self.assertEqual(plain[0], "replicate,trial,time_s,phase,people,PIR1,PIR2".split(","))
        self.assertEqual([row[:5] + row[7:] for row in csv.reader(io.StringIO(self.run_study().stdout))], plain)

    def test_a_marks_file_may_name_the_areas(self):
        marks = self.folder / "marks.yaml"
        marks.write_text("pirsim_marks: 1\nareas:\n"
                         "- {id: living_room, polygon_xz_m: [[0, 0], [4.5, 0], [4.5, -4], [0, -4]]}\n"
                         "- {id: bedroom, polygon_xz_m: [[4.5, 0], [8, 0], [8, -4], [4.5, -4]]}\n")
        beside = self.run_study("--marks", marks, scene=self.edited_scene(without_areas))
        self.assertEqual(beside.stdout, self.run_study().stdout)
        marks.write_text(marks.read_text().replace("id: bedroom", "id: living_room"))
        told = self.run_study("--marks", marks, scene=self.edited_scene(without_areas), code=3).stderr
        self.assertRegex(told, r"marks.yaml:4:\d+: error: .*area id 'living_room' is taken by")

    def test_people_on_the_rest_of_the_floor_are_elsewhere(self):
        def smaller(nodes, _):
            nodes["bedroom"]["extras"]["pirsim"]["polygon_xz_m"] = [[5.5, 0], [8, 0], [8, -4], [5.5, -4]]
        scene = self.edited_scene(smaller)
        found = rows(self.run_study(scene=scene).stdout)
        names = [name for name in found[0] if name.startswith("people_")]
        self.assertEqual(names, ["people_living_room", "people_bedroom", "people_elsewhere"])
        for row in found:
            self.assertEqual(sum(int(row[name]) for name in names), int(row["people"]))
        self.assertTrue(any(row["people_elsewhere"] != "0" for row in found))
        told = pirsim("check", "--scene", scene, *self.study).stdout
        self.assertIn("areas: living_room 18.00 m2, sensor PIR1\n       bedroom 10.00 m2, sensor PIR2\n", told)
        self.assertIn("4.00 m2 of the floor (12.5 %) in no area: people there are in people_elsewhere", told)

    def test_shards_and_their_summary_are_those_of_one_process(self):
        one, shards, merged = (self.folder / name for name in ("one.csv", "shards", "merged.csv"))
        self.run_study("-o", one, "--summary", self.folder / "one.md")
        for shard in ("2/2", "1/2"):
            self.run_study("--shard", shard, "-o", shards)
        pirsim("merge", shards, "-o", merged, "--summary", self.folder / "merged.md", *self.study[:2])
        self.assertEqual(merged.read_bytes(), one.read_bytes())
        summary = (self.folder / "one.md").read_text()
        self.assertEqual((self.folder / "merged.md").read_text(), summary)
        found = rows(one.read_text())
        for area in ("living_room", "bedroom"):
            sums = [int(row["people_" + area]) for row in found]
            share = 100 * sum(n > 0 for n in sums) / len(sums)
            name = area.replace("_", r"\_")
            self.assertIn(f"| {name} | {sum(sums) / 2:.1f} | {share:.1f} | {max(sums)} |", summary)

    def test_readers_of_rows_take_no_area_for_a_sensor(self):
        clocked = self.folder / "clocked.yaml"
        clocked.write_text(self.study[1].read_text().replace("replicates: 2", "replicates: 1\nbegin: 2026-03-02T08:00"))
        text = pirsim("--scene", self.scene, "--script", clocked, *self.study[2:]).stdout
        for name, cut in (("rows.csv", ()), ("log.csv", ("replicate", "trial", "time_s", "phase"))):
            table = [{key: value for key, value in row.items() if key not in cut} for row in rows(text)]
            with (self.folder / name).open("w") as file:
                writer = csv.DictWriter(file, table[0])
                writer.writeheader()
                writer.writerows(table)
            told = pirsim("log", self.folder / name, "--step", 1, "-o", self.folder / "read.csv")
            header = (self.folder / "read.csv").read_text().splitlines()[0]
            self.assertEqual(header, "time_s,time,people,PIR1,PIR2", told.stderr)

    def test_areas_are_told_in_reports_maps_and_walk_tests(self):
        report = self.folder / "report.html"
        self.run_study("--report", report, "-o", self.folder / "rows.csv")
        page = report.read_text()
        for words in ("minutes a run, of all people", "rows with motion", "living_room", "bedroom"):
            self.assertIn(words, page)
        coverage = self.folder / "coverage.yaml"
        coverage.write_text("pirsim_coverage: 1\nspacing_m: 0.5\nduration_s: 4\ntarget: {x_shapes: {}}\n")
        told = pirsim("coverage", "--scene", self.scene, "--script", coverage, *self.study[2:], "-o", self.folder / "maps")
        self.assertRegex(told.stdout, r"living_room \(PIR1\): [0-9.]+ %, [0-9.]+ %\n    bedroom \(PIR2\)")
        walk = self.folder / "walk.yaml"
        walk.write_text("pirsim_walk_test: 1\nspacing_m: 1\nmajor_motion: {directions: 2}\nminor_motion: {directions: 1}\n")
        told = pirsim("walktest", "--scene", self.scene, "--script", walk, *self.study[2:], "-o", self.folder / "w.csv")
        points = rows((self.folder / "w.csv").read_text())
        for area, inside in (("living_room (PIR1)", lambda x: x < 4.5), ("bedroom (PIR2)", lambda x: x >= 4.5)):
            tried = [row["major"] for row in points if inside(float(row["x_m"])) and row["major"] != "untried"]
            self.assertIn(f"{area}: walker {tried.count('pass')} of {len(tried)} points pass", told.stdout)

    def test_a_dataset_counts_the_areas_of_its_own_scenes(self):
        recipe, made = self.folder / "recipe.yaml", self.folder / "made"
        recipe.write_text(f"""pirsim_recipe: 1
name: areas
rooms:
  - {{scenes: ['{self.scene}']}}
  - {{count: 1, seats: 1, width_m: 4, depth_m: 4}}
days: 1
sensing: {{tick_rate_hz: 10, response: zones}}
schedule: {{from: "08:50", to: "09:00", arrival: {{mean: "08:52", sd_min: 1}}, staff: [{{count: 1}}]}}
split: {{validation_rooms: 0, test_rooms: 0, test_days: 0}}
rows: .csv
occupants: true
exports: [energyplus, uci864]
""")
        pirsim("dataset", recipe, "-o", made, "--sensors", DATA / "sensors")
        own, drawn = (rows((made / f"rows/room_000{n}/day_01.csv").read_text()) for n in (1, 2))
        for row in own:
            self.assertEqual(int(row["people_living_room"]) + int(row["people_bedroom"]), int(row["people"]))
        self.assertTrue(any(row["people_living_room"] != "0" for row in own))
        self.assertEqual({row["people_bedroom"] for row in drawn}, {""})
        inside = [row for row in rows((made / "occupants/room_0001/day_01.csv").read_text()) if row["where"] == "inside"]
        self.assertTrue(inside and all(row["area"] in ("living_room", "bedroom") for row in inside))
        self.assertEqual((made / "areas.csv").read_text(),
                         "room,area,floor_m2\n1,living_room,18\n1,bedroom,14\n")
        watched = {(row["room"], row["sensor"]): row["area"] for row in rows((made / "sensors.csv").read_text())}
        self.assertEqual(watched["1", "PIR2"], "bedroom")
        self.assertEqual(watched["2", "PIR1"], "")
        readings = rows((made / "exports/uci864/room_0001/day_01.csv").read_text())
        at_ends = [row for row in own if row["time"][-2:] in ("00", "30")]
        self.assertEqual([(one["Room_Occupancy_Count"], one["living_room_Occupancy_Count"]) for one in readings],
                         [(row["people"], row["people_living_room"]) for row in at_ends])
        self.assertNotIn("living_room_Occupancy_Count", (made / "exports/uci864/room_0002/day_01.csv").read_text())
        hours = rows((made / "exports/energyplus/presence.csv").read_text())
        self.assertGreater(float(hours[8]["room_0001_living_room_people"]), 0.0)
        package = json.loads((made / "datapackage.json").read_text())
        fields = next(one for one in package["resources"] if one["name"] == "train")["schema"]["fields"]
        self.assertEqual([one["name"] for one in fields], list(own[0]))
        self.assertEqual([one["type"] for one in fields if one["name"].startswith("people_")], ["integer", "integer"])


if __name__ == "__main__":
    main()
