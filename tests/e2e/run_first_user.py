#!/usr/bin/env python3
"""What a new user meets: rooms and scripts with common mistakes, and what pirsim says of them.

Usage: run_first_user.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import copy
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

PIRSIM = DATA = None


def pirsim(*args, code=0, **kwargs):
    result = subprocess.run([PIRSIM, *map(str, args)], capture_output=True, text=True, timeout=300, **kwargs)
    assert result.returncode == code, f"{args}: exit code {result.returncode}, expected {code}\n{result.stderr}"
    return result


def study(*args, script="studyA.yaml", **kwargs):
    return pirsim("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / script, *args, **kwargs)


def study_of(command, *args, code):
    return pirsim(command, "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml",
                  *args, code=code).stderr


ONE_RUN = "--replicates", 1, "--set", "trials.for_each.seat=[S1]", "-q"


class Room:
    """The shipped meeting room, to be spoiled."""

    def __init__(self):
        self.gltf = json.loads((DATA / "rooms" / "meeting_room.gltf").read_text())

    def marked(self, kind, name=None):
        for node in self.gltf["nodes"]:
            mark = node.get("extras", {}).get("pirsim", {})
            if mark.get("type") == kind and name in (None, mark.get("id")):
                return node
        raise KeyError(kind)

    def check(self, folder, code=0, line=True):
        file = pathlib.Path(folder) / "room.gltf"
        file.write_text(json.dumps(self.gltf, indent=1))
        told = pirsim("check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml", code=code).stderr
        for issue in told.splitlines():
            if "warning: node" in issue or "error: node" in issue:
                assert issue.startswith(f"{file}:"), issue
        return told


def turned(rotation):
    """Half a turn about +Y more."""
    x, y, z, w = rotation
    return [z, w, -x, -y]


class Doubts(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.room = Room()

    def test_shipped_rooms_and_generated_ones_raise_none(self):
        for file in sorted((DATA / "rooms").glob("*.gltf")):
            script = "office.yaml" if file.stem == "open_office" else "studyA.yaml"
            if file.stem == "open_hall":
                script = "density.yaml"
            told = pirsim("check", "--scene", file, "--script", DATA / "studies" / script).stderr
            self.assertNotIn("warning: node", told, file.name)
        for seed in range(1, 6):
            file = f"{self.folder.name}/made.gltf"
            pirsim("room", "-o", file, "--seed", seed)
            told = pirsim("day", "--scene", file, "--staff", 1, "--from", "09:00", "--to", "09:01", "--days", 1).stderr
            self.assertNotIn("warning: node", told, seed)

    def test_an_entrance_turned_round(self):
        door = self.room.marked("entrance")
        name = door["name"]
        door["rotation"] = turned(door.get("rotation", [0, 0, 0, 1]))
        told = self.room.check(self.folder.name)
        self.assertIn(f"warning: node '{name}': entrance", told)
        self.assertIn("is turned round", told)

    def test_a_seat_that_faces_away_from_its_table(self):
        seat = self.room.marked("seat", "S1")
        seat["rotation"] = turned(seat.get("rotation", [0, 0, 0, 1]))
        file = pathlib.Path(self.folder.name) / "room.gltf"
        file.write_text(json.dumps(self.room.gltf))
        told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                              capture_output=True, text=True).stderr
        self.assertIn("seat 'S1' faces away from '", told)
        self.assertNotIn("seat 'S2'", told)

    def test_a_seat_inside_a_desk(self):
        seat = self.room.marked("seat", "S1")
        x, y, z = seat["translation"]
        rx, ry, rz, rw = seat.get("rotation", [0, 0, 0, 1])
        ahead = (-2 * (rx * rz + rw * ry), -(1 - 2 * (rx * rx + ry * ry)))  # -Z of the seat, on the floor
        seat["translation"] = [x + 0.5 * ahead[0], y, z + 0.5 * ahead[1]]
        file = pathlib.Path(self.folder.name) / "room.gltf"
        file.write_text(json.dumps(self.room.gltf))
        told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                              capture_output=True, text=True).stderr
        self.assertRegex(told, r"room.gltf:\d+:\d+: warning: node '[^']*': seat 'S1' is inside of '")

    def test_a_desk_a_thousand_times_too_large(self):
        desk = next(n for n in self.room.gltf["nodes"] if "table" in n["name"] and "mesh" in n)
        desk["scale"] = [1000, 1000, 1000]
        file = pathlib.Path(self.folder.name) / "room.gltf"
        file.write_text(json.dumps(self.room.gltf))
        told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                              capture_output=True, text=True).stderr
        self.assertRegex(told, rf"warning: node '{desk['name']}': its mesh spans \d+ m x \d+ m .*: millimetres\?")

    def test_a_floor_in_millimetres_and_one_that_stands_upright(self):
        floor = self.room.marked("floor")
        floor["extras"]["pirsim"] = {"type": "floor", "polygon_xz_m": [[0, 0], [8002, 0], [8002, 6002], [0, 6002]]}
        told = self.room.check(self.folder.name, code=5)
        self.assertIn("the floor spans 8002 m x 6002 m: millimetres?", told)
        self.assertRegex(told, r"room\.gltf: error: the floor and its entrances span 80")
        self.assertIn("too large to find ways on (glTF's unit is the metre)", told)
        self.assertNotIn("are they", told)
        floor["extras"]["pirsim"]["polygon_xz_m"] = [[0, 0], [8, 0], [8, 6], [0, 6]]
        floor["rotation"] = [0.70710678, 0, 0, 0.70710678]
        self.assertIn("stands upright, as in files that are Z-up", self.room.check(self.folder.name, code=3))
        self.room = Room()
        self.room.marked("seat")["rotation"] = [0.70710678, 0, 0, 0.70710678]
        self.assertIn("it lies: is the file Z-up?", self.room.check(self.folder.name, code=3))

    def test_a_seat_outside_works_but_is_told(self):
        """Nobody notices that in the rows: the sitter works there, and `people` is 0."""
        door, seat = self.room.marked("entrance"), self.room.marked("seat", "S1")
        x, y, z, w = door.get("rotation", [0, 0, 0, 1])
        behind = (2 * (x * z + w * y), 1 - 2 * (x * x + y * y))  # +Z of the door, on the floor
        place = door["translation"]
        seat["translation"] = [place[0] + 1.2 * behind[0], seat["translation"][1], place[2] + 1.2 * behind[1]]
        told = self.room.check(self.folder.name)
        self.assertRegex(told, r"room.gltf:\d+:\d+: warning: node '[^']*': seat 'S1' lies off the floor")
        seat["translation"][0] += 50.0
        told = self.room.check(self.folder.name, code=5)
        self.assertRegex(told, r"error: seat 'S1' of room.gltf can't be reached by '[^']*' from .*: it lies off the floor")

    def test_two_seats_at_one_place(self):
        first, second = self.room.marked("seat", "S1"), self.room.marked("seat", "S2")
        second["translation"] = [c + d for c, d in zip(first["translation"], (0.05, 0, 0))]
        second["rotation"] = first.get("rotation", [0, 0, 0, 1])
        self.assertIn("seat 'S2' is 0.05 m from seat 'S1'", self.room.check(self.folder.name))

    def test_an_entrance_that_is_not_at_the_edge_of_the_floor(self):
        door = self.room.marked("entrance")
        name, (x, y, z) = door["name"], door["translation"]
        qx, qy, qz, qw = door.get("rotation", [0, 0, 0, 1])
        ahead = (-2 * (qx * qz + qw * qy), -(1 - 2 * (qx * qx + qy * qy)))
        right = (1 - 2 * (qy * qy + qz * qz), 2 * (qx * qz - qw * qy))
        for place, words in (((x, y + 1, z), "isn't on the floor, but 1.00 m above it"),
                             ((x + 1.5 * ahead[0], y, z + 1.5 * ahead[1]), r"isn't at the floor's edge, but \d\.\d\d m inside"),
                             ((x - 0.5 * ahead[0], y, z - 0.5 * ahead[1]), " outside of it"),
                             ((x - 0.5 * right[0], y, z - 0.5 * right[1]), "' stands in 0.")):
            door["translation"] = list(place)
            file = pathlib.Path(self.folder.name) / "room.gltf"
            file.write_text(json.dumps(self.room.gltf, indent=1))
            told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                                  capture_output=True, text=True).stderr
            self.assertRegex(told, rf"room.gltf:\d+:\d+: warning: node '{name}': entrance '[^']*'.*{words}")

    def test_an_entrance_that_nobody_gets_in_by_is_told_once(self):
        door = self.room.marked("entrance")
        x, y, z, w = door.get("rotation", [0, 0, 0, 1])
        right = (1 - 2 * (y * y + z * z), 0, 2 * (x * z - w * y))
        door["translation"] = [c - 1.5 * d for c, d in zip(door["translation"], right)]  # into the wall beside it
        told = self.room.check(self.folder.name, code=5)
        self.assertEqual(told.count("error:"), 1, told)
        self.assertRegex(told, r"room.gltf: error: nobody gets from entrance '[^']*' to the floor")

    def test_a_seat_that_nobody_can_sit_on_is_named(self):
        seat = self.room.marked("seat", "S2")
        seat["translation"][1] = 0.0
        told = self.room.check(self.folder.name, code=5)
        self.assertIn("room.gltf: error: seat 'S2': ", told)
        self.assertIn("pelvis point is 0.00 m above the floor", told)


class BareRoom(unittest.TestCase):
    """A floor that is a polygon of the markup, without any mesh."""

    SCRIPT = "pirsim_script: 1\npeople: [{id: one, actions: [{enter: door}, {wait_s: 5}, {leave: door}]}]\n"

    def write(self, width):
        def node(mark, **place):
            return {**place, "extras": {"pirsim": mark}}
        nodes = [node({"type": "floor", "polygon_xz_m": [[0, 0], [width, 0], [width, -3], [0, -3]]}),
                 node({"type": "entrance", "id": "door"}, translation=[1, 0, 0]),
                 node({"type": "sensor", "id": "PIR1", "model": "EKMC1604111"}, translation=[2, 2.5, 0],
                      rotation=[-0.173648, 0, 0, 0.984808])]
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        (path / "study.yaml").write_text(self.SCRIPT)
        (path / "room.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, "scene": 0, "nodes": nodes,
                                                    "scenes": [{"nodes": list(range(len(nodes)))}]}))
        return path

    def files(self, path):
        return "--scene", path / "room.gltf", "--script", path / "study.yaml"

    def test_a_room_without_walls_is_told(self):
        told = "no ray of any sensor ends at the room"
        self.assertIn(told, pirsim("check", *self.files(self.write(4))).stderr)
        self.assertNotIn(told, pirsim("check", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                                      DATA / "studies" / "studyA.yaml").stderr)

    def test_that_no_ray_ends_at_its_floor_is_told(self):
        told = "no ray ends at the floor: it has no mesh that occludes"
        self.assertIn(told, pirsim("check", *self.files(self.write(4))).stdout)
        self.assertNotIn(told, pirsim("check", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                                      DATA / "studies" / "studyA.yaml").stdout)

    def test_its_floor_is_drawn(self):
        pictures = []
        for width in (4, 5):
            path = self.write(width)
            pirsim("preview", *self.files(path), "--marks", "none", "--beams", "none", "--time", 0, "--camera", "2,9,-1.5",
                   "--look-at", "2,0,-1.6", "-q", "-o", path / "room.png")
            pictures.append((path / "room.png").read_bytes())
        self.assertNotEqual(*pictures)


class Sensors(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.room = Room()

    def test_one_that_hangs_outside(self):
        sensor = self.room.marked("sensor", "PIR1")
        sensor["translation"][0] += 70.0
        told = self.room.check(self.folder)
        self.assertRegex(told, r"sensor 'PIR1' can see NOBODY: it hangs outside of the room, [67]\d\.\d m from the floor")
        self.assertNotIn("look at a wall", told)

    def test_placements_tell_of_unknown_models_and_of_sensors_that_see_nothing(self):
        placements = self.folder / "placements.yaml"
        placements.write_text("""pirsim_placements: 1
spacing_m: 1
duration_s: 2
target: {x_shapes: {}}
sets:
  - id: far
    sensors:
      - {model: EKMC1604111, position_m: [79.5, 2.5, -3]}
      - {model: EKMC1604111, position_m: [4, 2.6, -3], tilt_deg: 90}
""")
        scene = "--scene", DATA / "rooms" / "meeting_room.gltf"
        told = pirsim("placements", *scene, "--script", placements).stderr
        self.assertRegex(told, r"placements.yaml:8:9: warning: set 'far': sensor 'PIR1' sees the target nowhere: it hangs "
                               r"outside of the room, 7\d\.\d m from the floor's edge")
        self.assertNotIn("PIR2", told)
        placements.write_text(placements.read_text().replace("EKMC1604111", "EKMC160411", 1))
        self.assertIn("placements.yaml:8:17: error: no sensor model 'EKMC160411' (did you mean 'EKMC1604111'?)",
                      pirsim("placements", *scene, "--script", placements, code=3).stderr)

    def own_model(self, change):
        text = change((DATA / "sensors" / "EKMC1604111.yaml").read_text())
        (self.folder / "sensors").mkdir(exist_ok=True)
        (self.folder / "sensors" / "MINE.yaml").write_text(text)
        self.room.marked("sensor", "PIR1")["extras"]["pirsim"]["model"] = "MINE"

    def test_a_model_whose_id_is_not_its_files_name(self):
        self.own_model(lambda text: text.replace("id: EKMC1604111", "id: MINE2"))
        self.assertRegex(self.room.check(self.folder),
                         r"MINE\.yaml:\d+:5: warning: id 'MINE2' isn't the file's name: scenes name this model 'MINE'")

    def test_a_misspelt_range_is_one_fault(self):
        self.own_model(lambda text: text.replace("id: EKMC1604111", "id: MINE\nrangem: 12").replace(", range_m: 12", ""))
        told = self.room.check(self.folder, code=3)
        self.assertIn("unknown key 'rangem' (did you mean 'range_m'?)", told)
        self.assertEqual(told.count("error:"), 1, told)


class Words(unittest.TestCase):
    """What is asked for and can't be had is told with what there is, in the words that the user typed."""

    def test_unknown_names_come_with_the_nearest_or_the_list(self):
        self.assertIn("sensor 'motion' is not in the scene; there are PIR1, PIR2",
                      study_of("preview", "--beams", "motion", "-o", "x.png", code=2))
        self.assertIn("rule: 'swept' is not known here; there are ",
                      study("--set", "effects=[{soft_zone_edges: {rule: swept}}]", code=3).stderr)
        self.assertIn("(did you mean 'soft_zone_edges'?)", pirsim("effects", "softzone", code=2).stderr)
        self.assertIn("entrance 'window' is not in meeting_room.gltf; there are door",
                      study("--set", "people.0.actions.0.enter=window", code=3).stderr)

    def test_options_are_blamed_by_their_own_names(self):
        for args in (("--replicates", 0), ("--seed", -1)):
            told = study(*args, code=2).stderr
            self.assertIn(str(args[0]), told)
            self.assertNotIn("--set", told)
        told = pirsim("room", "--seats", "many", "-o", "x.gltf", code=2).stderr
        self.assertIn("--seats many: error: ", told)
        self.assertNotIn("--set", told)
        self.assertIn("--set seats=many: error: ", pirsim("room", "--set", "seats=many", "-o", "x.gltf", code=2).stderr)

    def test_a_folder_of_shards_is_not_named_as_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("x.csv", "x.csv.gz", "x.csv.zst"):
                told = study("--shard", "1/2", "-o", name, code=2, cwd=folder).stderr
                self.assertIn(f"-o '{name}' is named as a file", told)
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])

    def test_days_off_alone_are_told(self):
        day = "day", "--scene", DATA / "rooms" / "meeting_room.gltf", "--meetings", "--from", "09:00", "--to", "09:01"
        for first, days, told in (("2026-03-07", 1, True), ("2026-03-07", 2, True), ("2026-03-07", 3, False),
                                  ("2026-03-06", 1, False)):
            said = pirsim(*day, "--first-day", first, "--days", days).stderr
            self.assertEqual("nobody comes on Saturdays and Sundays" in said, told, (first, days, said))

    def test_measured_columns(self):
        files = "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml"

        def told(text):
            return pirsim("reconcile", *files, "--measured", "-", code=3, input=text).stderr
        one = told("seat,sensor,secs\nS1,PIR1,10\n")
        self.assertIn("'seconds' is missing (did you mean 'secs'?)", one)
        self.assertEqual(one.count("error:"), 1, one)
        self.assertIn("unknown column 'temperature'; there are ", told("seat,time_s,PIR1,temperature\nS1,1,0,20\n"))
        self.assertIn(" PIR1, PIR2, PIR3, PIR4, PIR5", told("seat,time_s,PIR1,temperature\nS1,1,0,20\n"))


class Marks(unittest.TestCase):
    def told(self, change, code=3):
        room = Room()
        node = room.marked("seat", "S1")
        change(room.gltf, node)
        with tempfile.TemporaryDirectory() as folder:
            return room.check(folder, code=code)

    def test_a_mark_of_another_name(self):
        def shout(_, node):
            node["extras"] = {"PIRSIM": node["extras"]["pirsim"]}
        self.assertIn("'PIRSIM' is not read as a mark: its name is 'pirsim'", self.told(shout))

        def slip(_, node):
            node["extras"] = {"pirism": node["extras"]["pirsim"]}
        self.assertIn("'pirism' is not read as a mark: its name is 'pirsim'", self.told(slip))

    def test_keys_without_their_mark(self):
        def flat(_, node):
            node["extras"] = node["extras"]["pirsim"]
        told = self.told(flat)
        self.assertIn("'type' is not read here: a mark's keys must be in extras.pirsim", told)

        def foreign(_, node):
            node["extras"]["type"] = "chair"
        self.assertNotIn("warning", self.told(foreign, code=0))

    def test_a_mark_beside_extras(self):
        def beside(_, node):
            node["pirsim"] = node.pop("extras")["pirsim"]
        self.assertIn("it must be in the node's 'extras'", self.told(beside))

    def test_single_quotes(self):
        def python(_, node):
            node["extras"]["pirsim"] = str(node["extras"]["pirsim"])
        self.assertIn("JSON's quotes are double", self.told(python))

    def test_a_mark_on_mesh_data(self):
        def on_mesh(gltf, node):
            gltf["meshes"][0].setdefault("extras", {})["pirsim"] = copy.deepcopy(node["extras"]["pirsim"])
        told = self.told(on_mesh, code=0)
        self.assertIn("'pirsim' counts on nodes only; here, on mesh", told)
        self.assertIn("put it on the object's node", told)


class Scripts(unittest.TestCase):
    def test_unknown_actions_and_effects_get_the_nearest_name_or_the_list(self):
        def told(*args):
            return study(*args, "--print-config", code=3).stderr
        self.assertIn("'wurk' isn't an action (did you mean 'work'?)", told("--set", "people.0.actions.2={wurk: 3}"))
        self.assertIn("'dance' isn't an action; known are wait_s, wait, appear, enter, walk",
                      told("--set", "people.0.actions.2={dance: 3}"))
        self.assertIn("'stand' isn't an action; known are", told("--set", "people.0.actions.2=stand"))
        self.assertIn("'sit' needs a value: `sit: ...`", told("--set", "people.0.actions.2=sit"))
        self.assertIn("'zzzzz' is not an effect; known are ", told("--set", "effects=[zzzzz]"))
        self.assertIn("false_triggers has no parameter 'prob'; known are ",
                      told("--set", "effects=[{false_triggers: {prob: 1}}]"))

    def test_phases_that_no_run_has_are_told_with_their_line(self):
        def told(phases, *more):
            return study("--print-config", "--set", f"summary.phases={phases}", *more, code=3).stderr
        self.assertIn("summary.phases: no run has a phase 'workin' (did you mean 'working'?)", told("[workin]"))
        self.assertIn("no run has a phase 'meeting'; there are outside, rising, ", told("[working, meeting]"))
        self.assertIn("no run has a phase 'working'", told("[working]", "--set", "people.0.actions.3.phase=desk"))
        study("--print-config", "--set", "summary.phases=[desk]", "--set", "people.0.actions.3.phase=desk")
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "trials.yaml"
            person = "people: [{id: a, actions: [{enter: door}, {wait_s: 1%s}, {leave: door}]}]"
            script.write_text("pirsim_script: 1\nsummary:\n  phases: [%s]\ntrials:\n  - {id: A, " + person % "" + "}\n"
                              "  - {id: B, " + person % ", phase: reading" + "}\n")
            lines = script.read_text()
            for phase, code in (("reading", 0), ("readin", 3)):  # of one trial of two
                script.write_text(lines % phase)
                told_of = pirsim("--print-config", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script,
                                 code=code).stderr
                self.assertEqual("trials.yaml:3:12: error: summary.phases: no run has a phase 'readin'" in told_of,
                                 code == 3, told_of)

    def test_files_at_the_wrong_option_or_command(self):
        scene, script = DATA / "rooms" / "meeting_room.gltf", DATA / "studies" / "studyA.yaml"
        walk = DATA / "studies" / "walk_test.yaml"
        for args, file, words in ((("check", "--scene", script, "--script", scene), scene, "a glTF scene: `--scene`"),
                                  (("check", "--scene", script, "--script", script), script, ", but a script: `"),
                                  (("run", "--scene", scene, "--script", walk), walk, "a walk test: `pirsim walktest"),
                                  (("walktest", "--scene", scene, "--script", script), script, "a script: `--script`")):
            told = pirsim(*args, code=3).stderr
            self.assertEqual(told.count("error:"), 1, told)
            self.assertTrue(told.startswith(f"{file}:"), told)
            self.assertIn(words, told)

    def test_names_with_marks_of_markdown_or_html_stay_text_in_the_summary(self):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "trial.yaml"
            given = study(*ONE_RUN, "--print-config").stdout
            script.write_text(given.replace("id: S1", 'id: "<b>x|y</b>"', 1))
            self.assertIn("<b>", script.read_text())
            pirsim("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script, "-q", "--set",
                   "summary={}", "--summary", f"{folder}/sums.md")
            text = (pathlib.Path(folder) / "sums.md").read_text()
            self.assertIn(r"| \<b\>x\|y\</b\> |", text)


class People(unittest.TestCase):
    SCRIPT = """pirsim_script: 1
people:
  - {id: first, actions: [{enter: door}, {sit: S1}, {work: {duration_s: 60}}, {leave: door}]}
  - {id: second, actions: [{enter: door, at_s: 20}, {sit: S1}, {wait_s: 1}, {leave: door}]}
"""

    def test_who_waits_outside_for_a_seat_is_counted(self):
        with tempfile.TemporaryDirectory() as folder:
            script, rows = pathlib.Path(folder) / "two.yaml", pathlib.Path(folder) / "rows.csv"
            counted = {}
            for seat in ("S1", "S2"):
                script.write_text(self.SCRIPT.replace("{enter: door, at_s: 20}, {sit: S1}",
                                                      f"{{enter: door, at_s: 20}}, {{sit: {seat}}}"))
                told = pirsim("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script, "-o", rows).stderr
                people = json.loads(pathlib.Path(f"{rows}.json").read_text()).get("people", {})
                counted[seat] = people.get("waits_outside", 0), "waited outside" in told
            self.assertEqual(counted, {"S1": (1, True), "S2": (0, False)})


class Streams(unittest.TestCase):
    def test_scene_and_script_from_standard_input_and_rows_to_standard_output(self):
        scene, script = DATA / "rooms" / "meeting_room.gltf", DATA / "studies" / "studyA.yaml"
        expected = study(*ONE_RUN).stdout
        for given, files in ((script, ("--scene", scene, "--script", "-")), (scene, ("--scene", "-", "--script", script))):
            piped = pirsim(*files, *ONE_RUN, "-o", "-", input=given.read_text()).stdout
            self.assertEqual(piped, expected)
            with tempfile.TemporaryDirectory() as folder:
                rows = pathlib.Path(folder) / "rows.csv"
                pirsim(*files, *ONE_RUN, "-o", rows, input=given.read_text())
                self.assertEqual(rows.read_text(), expected)
                direct = pathlib.Path(folder) / "direct.csv"
                study(*ONE_RUN, "-o", direct)

                def hashes(path):
                    inputs = json.loads(pathlib.Path(f"{path}.json").read_text())["inputs"]
                    return sorted(value for entry in inputs for value in
                                  (entry.values() if isinstance(entry, dict) else [entry]) if len(str(value)) == 64)
                self.assertEqual(hashes(rows), hashes(direct))
                self.assertGreater(len(hashes(rows)), 1)
            with open(given, encoding="utf-8") as stream:
                self.assertEqual(pirsim(*files, *ONE_RUN, stdin=stream).stdout, expected)

    def test_a_binary_scene_from_standard_input(self):
        with tempfile.TemporaryDirectory() as folder:
            room = pathlib.Path(folder) / "room.glb"
            pirsim("room", "-o", room, "--seed", 2)
            day = "--staff", 1, "--days", 1, "--from", "09:00", "--to", "09:01", "-q"
            piped = subprocess.run([PIRSIM, "day", "--scene", "-", *map(str, day)], input=room.read_bytes(),
                                   capture_output=True)
            self.assertEqual(piped.returncode, 0, piped.stderr)
            self.assertEqual(piped.stdout.decode(), pirsim("day", "--scene", room, *day).stdout)

    def test_measured_rows_from_standard_input(self):
        """A faulty line tells that they were read; an analysis would take minutes."""
        rows = "trial,time_s,PIR1,PIR2,PIR3,PIR4,PIR5\nS1,1,0,0,0,0,7\n"
        study_files = "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml"
        self.assertIn("stdin:2:", pirsim("reconcile", *study_files, "--measured", "-", code=3, input=rows).stderr)

    def test_two_inputs_can_not_be_one_stream(self):
        self.assertIn("can't be the same file or stream", pirsim("reconcile", "--scene", "room.gltf", "--script", "-",
                                                                 "--measured", "-", code=2, input="").stderr)
        self.assertIn("can't both be standard input", pirsim("--scene", "-", "--script", "-", code=2, input="").stderr)


class Outputs(unittest.TestCase):
    def test_surveys_say_where_they_write(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = "--scene", DATA / "rooms" / "meeting_room.gltf"
            told = pirsim("coverage", *scene, "--script", DATA / "studies" / "studyB.yaml", "--set", "spacing_m=1",
                          cwd=folder).stderr
            self.assertIn("wrote coverage/coverage.csv", told)
            told = pirsim("walktest", *scene, "--script", DATA / "studies" / "walk_test.yaml", "--set", "spacing_m=2",
                          cwd=folder).stderr
            self.assertIn("wrote walk_test.csv", told)
            self.assertTrue((pathlib.Path(folder) / "walk_test.csv").exists())
        self.assertIn("(default: coverage)", pirsim("coverage", "--help").stdout)
        self.assertIn("(default: walk_test.csv)", pirsim("walktest", "--help").stdout)

    def test_a_report_speaks_of_shaded_windows_where_there_are_any(self):
        with tempfile.TemporaryDirectory() as folder:
            for change, shaded in (((), True), (("--set", "summary.phases=[]"), False)):
                page = pathlib.Path(folder) / "page.html"
                study(*ONE_RUN, *change, "-o", f"{folder}/rows.csv", "--report", page)
                self.assertEqual("counted windows are shaded" in page.read_text(), shaded)

    def test_zones_tell_early_how_much_they_will_write(self):
        with tempfile.TemporaryDirectory() as folder:
            zones = pathlib.Path(folder) / "zones.csv"
            once = "--set", "trials.for_each.seat=[S1]", "--zones", zones, "-o", f"{folder}/rows.csv"
            self.assertNotIn("GB", study(*once, "--replicates", 1).stderr)
            a_run = zones.stat().st_size
            n = 1 + 2 * 10**8 // a_run
            process = subprocess.Popen([PIRSIM, "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                                        DATA / "studies" / "studyA.yaml", *map(str, once), "--replicates", str(n)],
                                       stderr=subprocess.PIPE, text=True)
            line = next(line for line in process.stderr if "--zones" in line)
            process.kill()
            process.communicate()
            self.assertIn(f"the first of {n} runs", line)
            self.assertIn("about 0.2", line)

    def test_a_stack_of_64_kilobytes_is_enough(self):
        def small_stack():
            resource.setrlimit(resource.RLIMIT_STACK, (64 * 1024, 64 * 1024))
        self.assertEqual(study(*ONE_RUN, preexec_fn=small_stack).stdout, study(*ONE_RUN).stdout)


if __name__ == "__main__":
    PIRSIM = pathlib.Path(sys.argv.pop(1)).resolve()
    DATA = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
