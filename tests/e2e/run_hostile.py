#!/usr/bin/env python3
"""Inputs made to exhaust memory, stack or time, or to be slightly impossible: each is refused, or warned of, by name,
with little memory and no crash. Files too large to keep are made here.

Usage: run_hostile.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PIRSIM = DATA = None
MOST_BYTES = 1_500_000_000


class Hostile(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.scene = DATA / "rooms" / "meeting_room.gltf"
        self.script = DATA / "studies" / "studyA.yaml"

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def edited_scene(self, change):
        scene = json.loads(self.scene.read_text())
        change({node.get("name", str(i)): node for i, node in enumerate(scene["nodes"])}, scene)
        return self.write("scene.gltf", scene)

    def edited_script(self, old, new):
        text = self.script.read_text()
        self.assertIn(old, text)
        return self.write("script.yaml", text.replace(old, new))

    def pirsim(self, *args, code, scene=None, script=None, sensors=None, command="check"):
        """Runs with an eye on time, memory and the amount of messages; returns what it said."""
        process = subprocess.Popen(
            [PIRSIM, command, "--scene", scene or self.scene, "--script", script or self.script, "--sensors",
             sensors or DATA / "sensors", *args], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        told = process.stderr.read(1_000_000).decode()
        process.stderr.close()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, code, told[:2000])
        self.assertLess(len(told), 100_000, "more than anybody reads")
        if "PIRSIM_SANITIZED" not in os.environ:
            self.assertLess(used.ru_maxrss * 1024, MOST_BYTES)
        return told

    # ---------------------------------------------------------------------------------------------------------- glTF
    def test_json_of_many_values_or_levels(self):
        empty = '{"asset":{"version":"2.0"},"nodes":[%s{}]}'
        self.assertIn("more than 4000000 values", self.pirsim(scene=self.write("a.gltf", empty % ("{}," * 5_000_000)),
                                                              code=3))
        self.assertIn("nested deeper than 100", self.pirsim(scene=self.write("b.gltf", empty % ("[" * 2_000_000)),
                                                            code=3))
        self.assertIn("no 'scenes'", self.pirsim(scene=self.write("c.gltf", empty % ("{}," * 400_000)), code=3))

    def test_a_chain_of_nodes_a_hundred_thousand_deep(self):
        n = 100_000
        nodes = [{"children": [i + 1]} for i in range(n)] + [{"name": "end", "mesh": 7}]
        scene = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": nodes}
        self.assertIn("out of range", self.pirsim(scene=self.write("deep.gltf", scene), code=3))
        del nodes[-1]["mesh"]
        self.assertIn("no floor", self.pirsim(scene=self.write("deep.gltf", scene), code=3))

    def test_markup_that_is_deep_json_in_a_text(self):
        def change(nodes, _):
            nodes["PIR1"]["extras"]["pirsim"] = '{"type":"sensor","id":' + "[" * 1_000_000 + "]" * 1_000_000 + "}"
        self.assertIn("nested deeper", self.pirsim(scene=self.edited_scene(change), code=3))

    def test_many_faults_are_told_in_brief(self):
        nodes = [{"extras": {"pirsim": {"type": "seat"}}} for _ in range(50_000)]
        scene = {"asset": {"version": "2.0"}, "nodes": nodes, "scenes": [{"nodes": list(range(50_000))}]}
        self.assertIn("seat without 'id'", self.pirsim(scene=self.write("faults.gltf", scene), code=3))

    def test_floors_without_end(self):
        def outline(points):
            def change(nodes, _):
                floor = next(node for node in nodes.values() if "floor" in json.dumps(node.get("extras", {})))
                floor.pop("mesh", None)
                floor["extras"]["pirsim"] = {"type": "floor", "polygon_xz_m": points}
            return self.edited_scene(change)
        comb = [[i, i % 2] for i in range(30_000)] + [[30_000, -5], [0, -5]]
        self.assertIn("more than 10000 corners", self.pirsim(scene=outline(comb), code=3))
        self.assertIn("too large to find ways on",
                      self.pirsim(scene=outline([[0, 0], [9e4, 0], [9e4, 9e4], [0, 9e4]]), code=5))
        self.assertIn("more than 100 km", self.pirsim(scene=outline([[0, 0], [1e300, 0], [0, 1e300]]), code=3))

    def test_buffers_stay_in_the_scenes_folder(self):
        secret = self.write("secret.bin", "x" * 10_000)
        inside = self.folder / "inside"
        inside.mkdir()
        os.symlink(secret, inside / "link.bin")
        os.symlink(self.folder, inside / "up")
        for uri in ("../secret.bin", "%2e%2e/secret.bin", "link.bin", "up/secret.bin", str(secret), "file://" + str(secret),
                    "http://localhost/x.bin", "./.././secret.bin", "/dev/zero", "..", ".", ""):
            scene = {"asset": {"version": "2.0"}, "nodes": [{}], "buffers": [{"uri": uri, "byteLength": 100}]}
            (inside / "scene.gltf").write_text(json.dumps(scene))
            with self.subTest(uri):
                told = self.pirsim(scene=inside / "scene.gltf", code=3)
                self.assertIn("buffer file", told)

    # ------------------------------------------------------------------------------------------------------ scripts
    def test_yaml_of_many_levels_aliases_bytes_or_faults(self):
        for name, text, message in (
                ("lists", "[" * 100_000 + "]" * 100_000, "nested more than 64"),
                ("maps", "{a: " * 100_000 + "}" * 100_000, "nested more than 64"), ("open", "[" * 1_000_000, "bracket"),
                ("items", "- " * 1_000_000, "nested more than 64"), ("keys", "? " * 1_000_000, ""),
                ("bytes", "a: b\n" * 5_000_000, "larger than 16 MB"),
                ("long", "pirsim_script: " + "1" * 10_000_000, "expected"),
                ("unknown", "pirsim_script: 1\n" + "".join(f"k{i}: 1\n" for i in range(300_000)), "unknown key"),
                ("anchors", "".join(f"a{i}: &x{i} {{b: c}}\n" for i in range(100_000)), "unknown key"),
                ("endless", "a: &a [*a]", "an alias that refers to itself")):
            with self.subTest(name):
                self.assertIn(message, self.pirsim(script=self.write("s.yaml", text), code=3))

    def test_more_trials_or_runs_than_can_be_counted(self):
        values = ", ".join(["S1"] * 200)
        script = self.edited_script("for_each:", f"for_each:\n    a: [{values}]\n    b: [{values}]")
        self.assertIn("more than 20000 combinations", self.pirsim(script=script, code=3))
        script = self.edited_script("for_each:", f"for_each:\n    a: [{', '.join(map(str, range(100)))}]")
        self.assertIn("4294967295 runs", self.pirsim("--replicates", "10000000", "--set", "trials.id=${seat}-${a}",
                                                     script=script, code=3))

    # ---------------------------------------------------------------------------------------------- measured tables
    def test_measured_tables_without_end(self):
        endless = self.folder / "endless.csv"
        with open(endless, "wb") as file:
            file.truncate(10_000_000_000)  # one line of 10 GB, most of it never on the disk
        for name, content, message in (("endless.csv", None, "larger than 16 MB"),
                                       ("wide.csv", "," * 15_000_000, "more than 10000 fields"),
                                       ("line.csv", "x" * 15_000_000, "required"),
                                       ("ragged.csv", "trial,sensor,real\n" + "a\n" * 2_000_000, "there are more like these"),
                                       ("quote.csv", 'trial,sensor,real\n"' + "x" * 10_000_000, "never closed")):
            with self.subTest(name):
                path = endless if content is None else self.write(name, content)
                told = self.pirsim("--summary", self.folder / "s.csv", "--set", f"summary.reference={path}",
                                   command="run", code=3)
                self.assertIn("missing" if name == "line.csv" else message, told)
                self.assertFalse((self.folder / "s.csv").exists())

    # ------------------------------------------------------------------------------------------- slightly impossible
    def test_a_sensor_inside_a_wall_is_named(self):
        def bury(nodes, scene):
            at = nodes["PIR3"]["translation"]
            corners = [[x, y, z] for x in (-.1, .1) for y in (-.1, .1) for z in (-.1, .1)]
            quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
            indices = [i for a, b, c, d in quads for i in (a, b, c, a, c, d)]
            self.add_mesh(scene, [[p + q for p, q in zip(at, corner)] for corner in corners], indices)
        told = self.pirsim(scene=self.edited_scene(bury), code=0)
        self.assertIn("sensor 'PIR3' can see NOBODY: all of its rays end within", told)
        self.assertNotIn("'PIR1'", told)

    @staticmethod
    def add_mesh(scene, positions, indices):
        import base64
        import struct
        data = b"".join(struct.pack("<3f", *p) for p in positions) + b"".join(struct.pack("<H", i) for i in indices)
        scene["buffers"].append({"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                                 base64.b64encode(data).decode()})
        first = len(scene["bufferViews"])
        buffer = len(scene["buffers"]) - 1
        scene["bufferViews"] += [{"buffer": buffer, "byteLength": 12 * len(positions)},
                                 {"buffer": buffer, "byteOffset": 12 * len(positions), "byteLength": 2 * len(indices)}]
        accessor = len(scene["accessors"])
        scene["accessors"] += [
            {"bufferView": first, "componentType": 5126, "count": len(positions), "type": "VEC3",
             "min": [min(p[i] for p in positions) for i in range(3)],
             "max": [max(p[i] for p in positions) for i in range(3)]},
            {"bufferView": first + 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"}]
        scene["meshes"].append({"name": "block", "primitives": [{"attributes": {"POSITION": accessor},
                                                                 "indices": accessor + 1}]})
        scene["nodes"].append({"name": "block", "mesh": len(scene["meshes"]) - 1})
        scene["scenes"][scene.get("scene", 0)]["nodes"].append(len(scene["nodes"]) - 1)

    def test_a_seat_outside_the_floor_is_named(self):
        def move(nodes, _):
            seat = next(node for node in nodes.values()
                        if node.get("extras", {}).get("pirsim", {}).get("id") == "S4")
            seat["translation"] = [30, seat["translation"][1], 30]
        told = self.pirsim(scene=self.edited_scene(move), code=5)
        self.assertIn("S4", told)

    def test_a_sensor_of_impossible_range_is_refused_at_its_line(self):
        text = (DATA / "sensors" / "EKMC1604111.yaml").read_text()
        (self.folder / "lenses").mkdir()
        for value in ("-12", "0", ".nan", ".inf", "1e9", "far"):
            (self.folder / "lenses" / "EKMC1604111.yaml").write_text(
                text.replace("lens_step: 1, range_m: 12}", f"lens_step: 1, range_m: {value}}}", 1))
            told = self.pirsim(sensors=self.folder / "lenses", code=3)
            before = text[:text.index("lens_step: 1, range_m: 12}") + len("lens_step: 1, range_m: ")]
            place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
            self.assertRegex(told, rf"EKMC1604111.yaml:{place}: error: .*range_m: expected a finite number")


if __name__ == "__main__":
    PIRSIM = pathlib.Path(sys.argv.pop(1)).resolve()
    DATA = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
