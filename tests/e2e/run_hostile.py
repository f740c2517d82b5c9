#!/usr/bin/env python3
"""Inputs made to exhaust memory, stack or time, or to be slightly impossible: each is refused, or warned of, by name,
with little memory and no crash. Files too large to keep are made here.

Usage: run_hostile.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import json
import os
import subprocess

from program import DATA, PIRSIM, Case, main

MOST_BYTES = 1_500_000_000


class Hostile(Case):
    def setUp(self):
        super().setUp()
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

    def pirsim(self, *args, code, scene=None, script=None, sensors=None, command="check",
               most_s=60.0, most_bytes=MOST_BYTES):
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
            self.assertLess(used.ru_maxrss * 1024, most_bytes)
            self.assertLess(used.ru_utime + used.ru_stime, most_s)
        return told

    def refused_at_once(self, *args, code=3, **inputs):
        """What is too long is counted before anything is made of it."""
        return self.pirsim(*args, code=code, most_s=1.0, most_bytes=150_000_000, **inputs)

    # --------------------------------------------------------------------------------------------------------- empty
    def test_whatever_may_be_empty_is_drawn_or_refused_with_a_message(self):
        data = lambda *parts: DATA.joinpath(*parts)
        preview = ("-o", "p.png", "--width", 16, "--height", 16)
        maps = ("0", "sensing", "split", "target", "schedule", "household", "for_each", "trials", "draw_by", "occupancy")
        cases = (
            (("preview", "--scene", data("rooms", "meeting_room.gltf"), "--script", data("studies", "studyA.yaml"), *preview),
             ("trials", "trials.for_each", "trials.for_each.seat", "people", "people.0.actions", "sensing", "effects")),
            (("preview", "--scene", data("rooms", "open_office.gltf"), "--script", data("studies", "office_week.yaml"), *preview),
             ("schedule", "schedule.staff", "schedule.staff.0.seats", "schedule.meetings", "schedule.entrances", "pets")),
            (("preview", "--scene", data("rooms", "flat.gltf"), "--script", data("studies", "flat_week.yaml"), *preview),
             ("schedule.household", "schedule.household.residents", "schedule.household.residents.0", "pets")),
            (("preview", "--scene", data("rooms", "open_hall.gltf"), "--script", data("studies", "density.yaml"), *preview),
             ("people", "occupancy", "occupancy.counts", "occupancy.seats", "occupancy.entrances")),
            (("dataset", data("recipes", "tiny.yaml"), "-o", "ds", "--shard", "9/9"),
             ("rooms", "rooms.0", "rooms.0.sensors", "rooms.0.desks", "rooms.0.scenes", "schedule", "schedule.staff",
              "rooms.1.schedule.meetings.durations_min", "rooms.1.schedule.meetings.probabilities", "effects", "effects.0",
              "split", "exports", "draw_by", "sensing")),
            (("room", "-o", "r.gltf"), ("sensors", "desks", "seats", "doors", "width_m")),
            (("room", "--home", "-o", "h.gltf"), ("layout", "mount", "model", "sensors_at", "residents", "rooms")),
            (("dataset", data("recipes", "homes.yaml"), "-o", "dh", "--shard", "9/9"),
             ("rooms.0.household", "rooms.0.household.age_years", "rooms.0.sensors_at", "rooms.0.mount", "rooms.0.layout",
              "rooms.0.model", "rooms.0.rooms", "rooms.0.residents")),
            (("room", "--home", "--plan", data("plans", "my_flat.yaml"), "-o", "f.gltf"),
             ("rooms", "doors", "rooms.0.furniture", "rooms.0.sensors", "rooms.0.furniture.0", "rooms.0.sensors.0", "doors.0",
              "rooms.0.x_m")),
            (("coverage", "--scene", data("rooms", "meeting_room.gltf"), "--script", data("studies", "studyB.yaml"), "-o", "c",
              "--set", "spacing_m=3", "--set", "duration_s=1"),
             ("without", "target", "target.x_shapes", "sensing")))
        for command, keys in cases:
            for key in keys:
                value = "{}" if key.split(".")[-1] in maps else "[]"
                with self.subTest(command=command[0], key=key, value=value):
                    result = subprocess.run([PIRSIM, *map(str, command), "--set", f"{key}={value}"], cwd=self.folder,
                                            capture_output=True, text=True, check=False)
                    self.assertIn(result.returncode, (0, 2, 3, 5), result.stderr[-500:])
                    if result.returncode:
                        self.assertIn("error: ", result.stderr)

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

    def test_areas_without_end(self):
        def scene(n, corners):
            floor = {"extras": {"pirsim": {"type": "floor", "polygon_xz_m": [[0, 0], [900, 0], [900, -9], [0, -9]]}}}
            areas = [{"extras": {"pirsim": {"type": "area", "id": f"a{i}", "polygon_xz_m": corners(i)}}} for i in range(n)]
            return self.write("areas.gltf", {"asset": {"version": "2.0"}, "nodes": [floor, *areas],
                                             "scenes": [{"nodes": list(range(n + 1))}]})
        def square(i):
            x = 0.1 * i
            return [[x, 0], [x + 0.1, 0], [x + 0.1, -9], [x, -9]]
        told = self.pirsim(scene=scene(5_000, square), code=3)
        self.assertEqual(told.count("the scene has more than 1000 areas"), 1, told)
        told = self.pirsim(scene=scene(900, lambda i: [[0, 0], [900, 0], [900, -9], [0, -9]]), code=3)
        self.assertIn("area 'a1' overlaps area 'a0' by 8100.00 m2", told)
        comb = [[0.02 * k, -(k % 2)] for k in range(9_000)] + [[180, -9], [0, -9]]
        self.assertIn("the outline of areas has more than 10000 corners",
                      self.pirsim(scene=scene(2, lambda i: comb), code=3))

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
    def test_tables_of_people(self):
        counted = self.write("s.yaml", "pirsim_script: 1\noccupancy: {counts: c.csv}\n")
        for name, table, message, code in (
                ("rows", "".join(f"{i},1\n" for i in range(1_200_000)), "more than 1000000 readings", 3),
                ("bytes", "0,1\n" * 5_000_000, "larger than 16 MB", 3),
                ("faults", "".join(f"{i},-1\n" for i in range(300_000)), "299999 more like this", 3),
                ("backwards", "".join(f"{-i},1\n" for i in range(300_000)), "299998 more like this", 3),
                ("crowd", "0,0\n60,1000\n", "1000 people, but meeting_room.gltf holds", 5),
                ("times", "1e300,1\n", "expected", 3)):
            with self.subTest(name):
                self.write("c.csv", "time_s,people\n" + table)
                self.assertIn(message, self.pirsim(script=counted, code=code))
        tracked = self.write("t.yaml", "pirsim_script: 1\noccupancy: {positions: p.csv}\n")
        for name, table, message in (
                ("points", "".join(f"{i},a,0,0\n" for i in range(200_000)), "more than 100000 points"),
                ("nowhere", "0,a,1e300,0\n", "expected metres"), ("nan", "0,a,nan,0\n", "expected a number")):
            with self.subTest(name):
                self.write("p.csv", "t,id,x,z\n" + table)
                self.assertIn(message, self.pirsim(script=tracked, code=3))

    def test_a_year_of_counts_a_minute_with_hundreds_of_comings_a_day(self):
        rows = [f"2026-{1 + day // 28:02}-{1 + day % 28:02}T{minute // 60:02}:{minute % 60:02},"
                f"{0 if minute < 480 else (minute * minute + day) % 7}\n" for day in range(336) for minute in range(1440)]
        self.write("c.csv", "time,people\n" + "".join(rows))
        year = self.write("s.yaml", "pirsim_script: 1\nreplicates: 336\n"
                          "occupancy: {counts: c.csv, from: '07:00', to: '19:00'}\n")
        self.pirsim(script=year, code=0, most_s=20.0)

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

    def test_limits_count_the_product(self):
        """docs/formats/inputs.md; each also as aliases, which make much of little."""
        def script(**keys):
            return self.write("s.yaml", json.dumps({"pirsim_script": 1, **keys}))
        def aliases(n, item):
            return f"[&x {item}" + ", *x" * (n - 1) + "]"
        values = "[" + ", ".join(map(str, range(20_000))) + "]"
        person = "{id: p, actions: " + aliases(2_000, "{wait_s: 1}") + "}"
        product = self.write("p.yaml", "pirsim_script: 1\ntrials: {for_each: {a: " + values + "}, id: '${a}'}\n"
                                       "people: [" + person + "]\n")
        self.assertIn("20000 trials of 4003 values each are more than 1000000", self.refused_at_once(script=product))
        held = "{at: 10:00, duration_min: 60, people: 4}"
        for n, text in (("aliases", aliases(10_000, held)), ("lines", "".join(f"\n    - {held}" for _ in range(10_000)))):
            with self.subTest("held", n=n):
                path = self.write("h.yaml", "pirsim_script: 1\nschedule:\n  meetings:\n   held: " + text + "\n")
                self.assertIn("held: more than 100 entries", self.refused_at_once(script=path))
        walk = [{"walk": {"to_xz_m": [[0, 0]] * 100_001}}]
        everybody = {"people": [{"id": "p", "actions": [{"wait_s": 1}]}]}
        for name, keys in (("effects", {**everybody, "effects": ["missed_triggers"] * 20_000}),
                           ("people", {"people": [{"id": f"p{i}"} for i in range(10_001)]}),
                           ("trials", {"trials": [{"id": str(i)} for i in range(20_001)]}),
                           ("actions", {"people": [{"id": "p", "actions": ["rise"] * 100_001}]}),
                           ("to_xz_m", {"people": [{"id": "p", "actions": walk}]}),
                           ("staff", {"schedule": {"staff": [{"count": 1}] * 5_000}}),
                           ("seats", {"schedule": {"staff": [{"seats": ["S1"] * 5_000}]}}),
                           ("durations_min", {"schedule": {"meetings": {"durations_min": [60] * 5_000}}}),
                           ("phases", {**everybody, "summary": {"phases": ["working"] * 5_000}})):
            with self.subTest(name):
                self.assertRegex(self.refused_at_once(script=script(**keys)), rf"{name}: more than \d+ entries")

    def marked_scene(self, n, mark, **node):
        """n nodes of one mark on a floor, or n floors in rows."""
        side = int(n ** 0.5) + 1
        def floor(i):
            x, z = 2 * (i % side), 2 * (i // side)
            return {"type": "floor", "polygon_xz_m": [[x, z], [x + 1.9, z], [x + 1.9, z + 1.9], [x, z + 1.9]]}
        marks = [floor(i) if mark == "floor" else {"type": mark, "id": f"m{i}"} for i in range(n)]
        if mark == "sensor":
            for one in marks:
                one["model"] = "EKMC1604111"
        nodes = [{"name": f"n{i}", "extras": {"pirsim": one}, **node} for i, one in enumerate(marks)]
        if mark != "floor":
            nodes.append({"name": "floor", "extras": {"pirsim": floor(0)}})
        return self.write("m.gltf", {"asset": {"version": "2.0"}, "scenes": [{"nodes": list(range(len(nodes)))}],
                                     "nodes": nodes})

    def test_marks_of_a_scene_are_counted_first(self):
        for mark, n, most in (("floor", 3_000, 1_000), ("sensor", 20_000, 2_000), ("entrance", 20_000, 1_000),
                              ("seat", 20_000, 5_000)):
            with self.subTest(mark):
                told = self.refused_at_once(scene=self.marked_scene(n, mark))
                self.assertIn(f"the scene has more than {most} {mark}s", told)

    def test_places_of_many_marks_are_found_in_one_pass(self):
        """Each was found by reading the text from its beginning: as many seconds as thousands of marks, squared."""
        scene = self.marked_scene(2_000, "sensor", translation=[1, 2, 1])
        script = self.write("l.yaml", {"pirsim_script": 1, "duration_s": 5, "sensing": {"response": "zones"}})
        told = self.pirsim(scene=scene, script=script, code=0, most_s=5.0)
        self.assertNotIn("error", told)
        last = self.write("m.gltf", scene.read_text().replace('"m1999", "model"', '"m1999", "mdel"'))
        column = last.read_text().index('"mdel"') + 1
        self.assertIn(f"m.gltf:1:{column}: error:", self.pirsim(scene=last, code=3, most_s=5.0))

    def test_rays_and_ways_are_counted_as_products(self):
        told = self.refused_at_once("--set", "sensing.response=analog", "--set", "sensing.analog_rays_per_zone=10000",
                                    code=3)
        self.assertRegex(told, r"its \d+ sensors have \d+ rays, more than 2000000")
        hall = self.marked_scene(1, "floor")
        hall.write_text(hall.read_text().replace("1.9", "300"))
        people = [{"id": f"p{i}", "stature_m": 1.5 + i * 1e-4, "actions": [{"appear": {"at_xz_m": [1, 1]}}]}
                  for i in range(200)]
        told = self.refused_at_once(scene=hall, script=self.write("w.yaml", {"pirsim_script": 1, "people": people}),
                                    code=5)
        self.assertIn("people of 200 sizes", told)

    def test_a_crowd_that_waits_outside_costs_little(self):
        people = [{"id": f"p{i}", "actions": [{"enter": "door"}, {"wait_s": 100}]} for i in range(10_000)]
        script = self.write("crowd.yaml", {"pirsim_script": 1, "duration_s": 5, "people": people})
        self.pirsim("-o", self.folder / "rows.csv", command="run", script=script, code=0, most_s=8.0)

    # ---------------------------------------------------------------------------------------------- measured tables
    def test_measured_tables_without_end(self):
        endless = self.folder / "endless.csv"
        with open(endless, "wb") as file:
            file.truncate(10_000_000_000)  # one line of 10 GB, most of it never on the disk
        for name, content, message in (("endless.csv", None, "larger than 16 MB"),
                                       ("wide.csv", "," * 15_000_000, "more than 10000 fields"),
                                       ("line.csv", "x" * 15_000_000, "required"),
                                       ("ragged.csv", "trial,sensor,real\n" + "a\n" * 2_000_000, "1999999 more like this"),
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
    main()
