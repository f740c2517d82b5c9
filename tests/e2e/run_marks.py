#!/usr/bin/env python3
"""Models that are left as they are: marks beside them, proposals of such, and files made to break either.

Usage: run_marks.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import base64
import hashlib
import json
import pathlib
import re
import struct

from box_scene import CORNERS, SIDES
from program import Case, main, run

# 8 m x 6 m: a room of 5 m, and two behind gaps of 0.9 m and 0.8 m; a door of 1 m leads in from the left.
FLAT = [("Slab", (-0.2, -0.2, -0.2), (8.2, 0, 6.2)), ("Ceiling", (-0.2, 2.5, -0.2), (8.2, 2.7, 6.2)),
        ("W1", (-0.2, 0, -0.2), (8.2, 2.5, 0)), ("W2", (-0.2, 0, 6), (8.2, 2.5, 6.2)), ("W3", (8, 0, 0), (8.2, 2.5, 6)),
        ("W4", (-0.2, 0, 0), (0, 2.5, 2.5)), ("W5", (-0.2, 0, 3.5), (0, 2.5, 6)), ("I1", (5, 0, 0), (5.1, 2.5, 0.55)),
        ("I2", (5, 0, 1.45), (5.1, 2.5, 6)), ("I3", (5.1, 0, 3), (6.6, 2.5, 3.1)), ("I4", (7.4, 0, 3), (8, 2.5, 3.1)),
        ("Door bath's", (6.6, 0, 3.02), (7.4, 2.0, 3.08))]
MARKS = """pirsim_marks: 1
ignore: ["Door*"]
nodes: {W3: {type: surface, temperature_c: 30}}
floors: [{polygon_xz_m: [[0, 0], [8, 0], [8, 6], [0, 6]]}]
sensors: [{id: PIR1, model: EKMC1604111, position_m: [4.9, 2.3, 5.9], yaw_deg: 45, tilt_deg: 20}]
entrances: [{id: door, position_m: [0, 0, 3], direction: [1, 0, 0]}]
"""
WALK = """pirsim_script: 1
people: [{id: a, actions: [{enter: door}, {walk: {to_xz_m: [[4, 5], [6, 1.5], [7, 5]]}}, {wait_s: 2}, {leave: door}]}]
"""


def model(boxes, unit=1.0):
    """A .gltf of boxes without a mark; unit: metres."""
    points = struct.pack("<24f", *(value for corner in CORNERS for value in corner))
    sides = struct.pack("<36H", *(index for a, b, c, d in SIDES for index in (a, b, c, a, c, d)))
    nodes = [{"name": name, "mesh": 0, "translation": [v / unit for v in low],
              "scale": [(h - l) / unit for l, h in zip(low, high)]} for name, low, high in boxes]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "buffers": [{"byteLength": 168, "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(points + sides).decode()}]})


class MarksCase(Case):
    def setUp(self):
        super().setUp()
        self.flat = self.write("flat.gltf", model(FLAT))
        self.walk = self.write("walk.yaml", WALK)

    def run_pirsim(self, *args, **options):
        return run(*args, cwd=self.folder, **options)


class Marks(MarksCase):
    def test_a_run_has_the_marks_among_its_inputs_from_a_file_or_a_pipe(self):
        marks = self.write("marks.yaml", MARKS)
        scene = ("--scene", self.flat, "--script", self.walk, "-q")
        self.run_pirsim(*scene, "--marks", marks, "-o", "rows.csv")
        inputs = {pathlib.Path(file["file"]).name: file["sha256"]
                  for file in json.loads((self.folder / "rows.csv.json").read_text())["inputs"]}
        self.assertEqual(inputs["marks.yaml"], hashlib.sha256(MARKS.encode()).hexdigest())
        rows = (self.folder / "rows.csv").read_text()
        self.assertGreater(sum(int(line.split(",")[-1]) for line in rows.splitlines()[1:]), 3)
        for text in (MARKS, "\ufeff" + MARKS):  # with a byte order mark, too
            self.assertEqual(self.run_pirsim(*scene, "--marks", "-", input=text)[0], rows)
        # Other marks are another study: nothing is resumed.
        marks.write_text(MARKS.replace("yaw_deg: 45", "yaw_deg: 40"))
        self.run_pirsim(*scene, "--marks", marks, "-o", "rows.csv", "--resume", code=3)
        self.write("x.csv", MARKS)
        self.assertIn("--marks and -o are one file", self.run_pirsim(*scene, "--marks", "x.csv", "-o", "x.csv", code=2)[1])

    def test_a_recipe_has_scenes_with_marks(self):
        self.write("marks.yaml", MARKS + "seats:\n- {id: S1, position_m: [2, 0.53, 3]}\n- {id: S2, position_m: [3, 0.53, 3]}\n")
        self.write("recipe.yaml", "pirsim_recipe: 1\ndays: 1\nrooms:\n- {scenes: [{scene: flat.gltf, marks: marks.yaml}], count: 3}\n")
        self.run_pirsim("dataset", "recipe.yaml", "-o", "made", "-q", "--set", "days=1")
        provenance = (self.folder / "made" / "provenance.txt").read_text()
        self.assertIn("marks.yaml " + hashlib.sha256((self.folder / "marks.yaml").read_bytes()).hexdigest(), provenance)
        told = self.run_pirsim("dataset", self.write("bad.yaml", "pirsim_recipe: 1\nrooms:\n- scenes: [{scene: flat.gltf, mark: a}]\n"),
                               "-o", "no", code=3)[1]
        self.assertIn("bad.yaml:3:31: error: scenes: unknown key 'mark' (did you mean 'marks'?)", told)

    def test_a_model_in_the_coordinates_of_a_map_is_the_model_at_the_origin_byte_for_byte(self):
        there = [451234.5, 120.0, -5412345.7]
        site = json.loads(model(FLAT))
        site["nodes"].append({"name": "site", "translation": there, "children": site["scenes"][0]["nodes"]})
        site["nodes"].append({"name": "root", "children": [len(site["nodes"]) - 1]})
        site["scenes"][0]["nodes"] = [len(site["nodes"]) - 1]
        far = self.write("far.gltf", json.dumps(site))
        near_marks = self.write("near.yaml", MARKS)
        far_marks = self.write("far.yaml", MARKS + f"origin_m: {there}\n")
        rows = [self.run_pirsim("--scene", scene, "--marks", marks, "--script", self.walk, "-q")[0]
                for scene, marks in ((self.flat, near_marks), (far, far_marks))]
        self.assertEqual(rows[0], rows[1])
        # The message's origin, and the proposal's, bring it here, too.
        told = self.run_pirsim("check", "--scene", far, code=3)[1]
        self.assertIn("node 'Slab': it lies more than 100000 m from the origin", told)
        self.assertNotIn("'root'", told)
        advised = re.search(r"`(origin_m: .*?)`", told).group(1)
        proposed = re.search(r"^origin_m: .*?\]", self.run_pirsim("check", "--scene", far, "--suggest")[0], re.M).group()
        for origin in (advised, proposed):
            sensor = "sensors: [{id: P, model: EKMC1604111, position_m: [1, 2, 1]}]\nfloors: [{polygon_xz_m: [[0, 0], [5, 0], [5, 6], [0, 6]]}]\n"
            self.run_pirsim("check", "--scene", far, "--marks", self.write("o.yaml", f"pirsim_marks: 1\n{origin}\n{sensor}"))

    def test_a_model_without_a_floor_takes_the_one_that_its_message_shows(self):
        heap = self.write("heap.gltf", model([("post", (0, 0, 0), (0.2, 2.5, 0.2)), ("other", (3, 0, 3), (3.2, 2.5, 3.2))]))
        told = self.run_pirsim("check", "--scene", heap, "--suggest", code=3)[1]
        self.assertNotIn("--ignore", told)
        head, floors = re.search(r"`(pirsim_marks: 1)` and `(floors: .*?)`", told).groups()
        for corner in ("[0, 0]", "[4, 0]", "[4, 4]"):
            floors = floors.replace("[x, z]", corner, 1)
        self.run_pirsim("check", "--scene", heap, "--marks", self.write("drawn.yaml", f"{head}\n{floors}\n"))

    def test_the_proposed_sensor_sees_somebody(self):
        for offset in (0, 30):
            moved = [(name, *(tuple(v + d for v, d in zip(p, (offset, 0, -offset))) for p in ends)) for name, *ends in FLAT]
            scene = self.write("moved.gltf", model(moved))
            marks = self.run_pirsim("check", "--scene", scene, "--suggest")[0]
            head, tail = marks.split("# sensors:\n# - ")
            told = "".join(self.run_pirsim("check", "--scene", scene, "--marks", self.write("m.yaml", f"{head}sensors:\n- {tail}")))
            self.assertIn("PIR1", told)
            self.assertNotIn("NOBODY", told)

    def test_files_made_to_break_are_refused_by_name(self):
        for name, text, message in (
                ("empty", "", "'pirsim_marks' is missing"), ("list", "- a\n", "marks: expected a map"), ("word", "marks", "marks: expected a map"),
                ("cyclic", "pirsim_marks: 1\nnodes: &a {W1: *a}\n", "an alias that refers to itself"),
                ("deep", "pirsim_marks: 1\nnodes: " + "{a: " * 10_000, "nested more than 64"),
                ("version", "pirsim_marks: 2\n", "format version 2 isn't known"),
                ("script", WALK, "this is a script"), ("binary", b"glTF\x02\0\0\0", "this is a glTF scene"),
                ("bytes", b"pirsim_marks: 1\nignore: [\xff]\n", "marks.yaml:2:10: error: not UTF-8"),
                ("twice", MARKS + "floors: []\n", "key 'floors' appears twice (first in line 4)"),
                ("number", "pirsim_marks: 1\nignore: [{a: b}]\n", "ignore: expected a text"),
                ("nan", MARKS.replace("[4.9, 2.3, 5.9]", "[nan, 2.3, 5.9]"), "position_m: expected"),
                ("far", MARKS.replace("[4.9, 2.3, 5.9]", "[1e9, 2.3, 5.9]"), "position_m: expected"),
                ("overlap", MARKS.replace("floors: [", "floors: [{polygon_xz_m: [[1, 1], [2, 1], [2, 2]]}, "), "overlaps the floor"),
                ("singular", MARKS + "scale: 1e-300\n", "scale: expected"),
                ("patterns", "pirsim_marks: 1\nignore: [" + ", ".join(f"'*a{i}*'" for i in range(4000)) + "]\n", "there are more like these")):
            with self.subTest(name):
                marks = self.write("marks.yaml", text)
                self.assertIn(message, self.run_pirsim("check", "--scene", self.flat, "--script", self.walk, "--marks", marks, code=3)[1])

    def test_a_pattern_of_many_stars_takes_no_time(self):
        long = self.write("long.gltf", model([("a" * 200 + str(i), (0, 0, 0), (1, 1, 1)) for i in range(300)]))
        marks = self.write("marks.yaml", "pirsim_marks: 1\nignore: [\"" + "a*" * 90 + "b\"]\n")
        self.assertIn("no node of the scene", self.run_pirsim("check", "--scene", long, "--script", self.walk, "--marks", marks, code=3)[1])

    def test_labels_of_a_preview_are_not_taken_for_marks(self):
        told = self.run_pirsim("preview", "--scene", self.flat, "--script", self.walk, "--marks", "seats,doors", code=2)[1]
        self.assertIn("--labels seats,doors", told)


class Suggestions(MarksCase):
    def suggest(self, scene, *args, code=0):
        return self.run_pirsim("check", "--scene", scene, "--suggest", *args, code=code)

    def test_what_is_proposed_for_a_flat_loads_and_is_walked_in(self):
        for unit, word in ((1.0, "m"), (0.001, "mm"), (0.0254, "in")):
            flat = self.write("flat.gltf", model(FLAT, unit))
            text = self.suggest(flat)[0]
            self.assertEqual(text, self.suggest(flat)[0], "the same model, the same proposal")
            self.assertIn(f"\nunit: {word}", text)
            self.assertEqual(len(re.findall(r"^(?:# )?- {id: area_\d", text, re.M)), 3)
            self.assertEqual(text.count("# An opening between"), 2)
            self.assertIn("- 'Door bath''s'", text)
            marks = self.write("own.yaml", text + MARKS[MARKS.index("sensors:"):MARKS.index("entrances:")])
            script = self.write("in.yaml", WALK.replace("door", "entrance_1"))
            rows = self.run_pirsim("--scene", flat, "--marks", marks, "--script", script, "-q")[0].splitlines()
            self.assertIn("PIR1", rows[0])
            self.assertEqual(max(int(row.split(",")[4]) for row in rows[1:]), 1)
            self.run_pirsim("check", "--scene", flat, "--marks", marks, "--script", script, "-q")

    def test_a_file_that_is_there_is_kept(self):
        self.assertIn("wrote own.yaml", self.suggest(self.flat, "-o", "own.yaml")[1])
        self.assertIn("is there already", self.suggest(self.flat, "-o", "own.yaml", code=2)[1])
        self.assertIn("must end in .yaml or .yml", self.suggest(self.flat, "-o", "own.txt", code=2)[1])
        self.assertIn("one file", self.suggest(self.write("model.yaml", model(FLAT)), "-o", "model.yaml", code=2)[1])

    def test_a_marked_model_is_looked_at_without_a_script(self):
        self.assertIn("wrote own.yaml", self.suggest(self.flat, "-o", "own.yaml")[1])
        self.assertIn("no script: 1 trial", self.run_pirsim("check", "--scene", self.flat, "--marks", "own.yaml")[0])
        self.run_pirsim("preview", "--scene", self.flat, "--marks", "own.yaml", "--width", 64, "--height", 48, "-o", "own.png")

    def test_options_that_go_together(self):
        self.assertIn("it doesn't go with --marks", self.suggest(self.flat, "--marks", "m.yaml", code=2)[1])
        for option in (("--floor", 1), ("-o", "m.yaml")):
            self.assertIn("goes with --suggest", self.run_pirsim("check", "--scene", self.flat, "--script", self.walk, *option, code=2)[1])
        self.assertIn("--script FILE is missing", self.run_pirsim("view", "--scene", self.flat, code=2)[1])
        self.assertIn("at a height of 1.20 m nothing", self.suggest(self.flat, "--floor", 1.2, code=3)[1])

    def test_models_of_nothing_of_a_point_or_a_world(self):
        empty = json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}]})
        self.assertIn("no meshes", self.suggest(self.write("m.gltf", empty), code=3)[1])
        self.assertIn("like a floor", self.suggest(self.write("m.gltf", model([("p", (0, 0, 0), (0.01, 5, 0.01))])), code=3)[1])
        world = [("ground", (-9e4, -1, -9e4), (9e4, 0, 9e4)), *FLAT]
        self.suggest(self.write("m.gltf", model(world)))


if __name__ == "__main__":
    main()
