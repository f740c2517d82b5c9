#!/usr/bin/env python3
"""What a new user meets: rooms and scripts with common mistakes, and what pirsim says of them.

Usage: run_first_user.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import base64
import copy
import json
import pathlib
import re
import resource
import struct
import subprocess

from program import DATA, PIRSIM, Case, main, pirsim


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
        file = folder / "room.gltf"
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


class Doubts(Case):
    def setUp(self):
        super().setUp()
        self.room = Room()

    def test_shipped_rooms_and_generated_ones_raise_none(self):
        for file in sorted((DATA / "rooms").glob("*.gltf")):
            own = {"open_office": "office.yaml", "open_hall": "density.yaml", "two_rooms": "two_rooms.yaml",
                   "flat": "flat_week.yaml", "office_floor": "floor_week.yaml"}
            script = own.get(file.stem, "studyA.yaml")
            told = pirsim("check", "--scene", file, "--script", DATA / "studies" / script).stderr
            self.assertNotIn("warning: node", told, file.name)
        for seed in range(1, 6):
            file = f"{self.folder}/made.gltf"
            pirsim("room", "-o", file, "--seed", seed)
            told = pirsim("run", "--scene", file, "--staff", 1, "--from", "09:00", "--to", "09:01", "--days", 1).stderr
            self.assertNotIn("warning: node", told, seed)

    def test_an_entrance_turned_round(self):
        door = self.room.marked("entrance")
        name = door["name"]
        door["rotation"] = turned(door.get("rotation", [0, 0, 0, 1]))
        told = self.room.check(self.folder)
        self.assertIn(f"warning: node '{name}': entrance", told)
        self.assertIn("is turned round", told)

    def test_a_seat_that_faces_away_from_its_table(self):
        seat = self.room.marked("seat", "S1")
        seat["rotation"] = turned(seat.get("rotation", [0, 0, 0, 1]))
        file = self.folder / "room.gltf"
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
        file = self.folder / "room.gltf"
        file.write_text(json.dumps(self.room.gltf))
        told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                              capture_output=True, text=True).stderr
        self.assertRegex(told, r"room.gltf:\d+:\d+: warning: node '[^']*': seat 'S1' is inside of '")

    def test_a_desk_a_thousand_times_too_large(self):
        desk = next(n for n in self.room.gltf["nodes"] if "table" in n["name"] and "mesh" in n)
        desk["scale"] = [1000, 1000, 1000]
        file = self.folder / "room.gltf"
        file.write_text(json.dumps(self.room.gltf))
        told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                              capture_output=True, text=True).stderr
        self.assertRegex(told, rf"warning: node '{desk['name']}': its mesh spans \d+ m x \d+ m .*: millimetres\?")

    def test_a_floor_in_millimetres_and_one_that_stands_upright(self):
        floor = self.room.marked("floor")
        floor["extras"]["pirsim"] = {"type": "floor", "polygon_xz_m": [[0, 0], [8002, 0], [8002, 6002], [0, 6002]]}
        told = self.room.check(self.folder, code=5)
        self.assertIn("the floor spans 8002 m x 6002 m: millimetres?", told)
        self.assertRegex(told, r"room\.gltf: error: the floor and its entrances span 80")
        self.assertIn("too large to find ways on (glTF's unit is the metre)", told)
        self.assertNotIn("are they", told)
        floor["extras"]["pirsim"]["polygon_xz_m"] = [[0, 0], [8, 0], [8, 6], [0, 6]]
        floor["rotation"] = [0.70710678, 0, 0, 0.70710678]
        self.assertIn("stands upright, as in files that are Z-up", self.room.check(self.folder, code=3))
        self.room = Room()
        self.room.marked("seat")["rotation"] = [0.70710678, 0, 0, 0.70710678]
        self.assertIn("it lies: is the file Z-up?", self.room.check(self.folder, code=3))

    def test_a_seat_outside_works_but_is_told(self):
        """Nobody notices that in the rows: the sitter works there, and `people` is 0."""
        door, seat = self.room.marked("entrance"), self.room.marked("seat", "S1")
        x, y, z, w = door.get("rotation", [0, 0, 0, 1])
        behind = (2 * (x * z + w * y), 1 - 2 * (x * x + y * y))  # +Z of the door, on the floor
        place = door["translation"]
        seat["translation"] = [place[0] + 1.2 * behind[0], seat["translation"][1], place[2] + 1.2 * behind[1]]
        told = self.room.check(self.folder)
        self.assertRegex(told, r"room.gltf:\d+:\d+: warning: node '[^']*': seat 'S1' lies off the floor")
        seat["translation"][0] += 50.0
        told = self.room.check(self.folder, code=5)
        self.assertRegex(told, r"error: seat 'S1' of room.gltf can't be reached by '[^']*' from .*: it lies off the floor")

    def test_two_seats_at_one_place(self):
        first, second = self.room.marked("seat", "S1"), self.room.marked("seat", "S2")
        second["translation"] = [c + d for c, d in zip(first["translation"], (0.05, 0, 0))]
        second["rotation"] = first.get("rotation", [0, 0, 0, 1])
        self.assertIn("seat 'S2' is 0.05 m from seat 'S1'", self.room.check(self.folder))

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
            file = self.folder / "room.gltf"
            file.write_text(json.dumps(self.room.gltf, indent=1))
            told = subprocess.run([PIRSIM, "check", "--scene", file, "--script", DATA / "studies" / "studyA.yaml"],
                                  capture_output=True, text=True).stderr
            self.assertRegex(told, rf"room.gltf:\d+:\d+: warning: node '{name}': entrance '[^']*'.*{words}")

    def test_an_entrance_that_nobody_gets_in_by_is_told_once(self):
        door = self.room.marked("entrance")
        x, y, z, w = door.get("rotation", [0, 0, 0, 1])
        right = (1 - 2 * (y * y + z * z), 0, 2 * (x * z - w * y))
        door["translation"] = [c - 1.5 * d for c, d in zip(door["translation"], right)]  # into the wall beside it
        told = self.room.check(self.folder, code=5)
        self.assertEqual(told.count("error:"), 1, told)
        self.assertRegex(told, r"room.gltf: error: nobody gets from entrance '[^']*' to the floor")

    def test_a_seat_that_nobody_can_sit_on_is_named(self):
        seat = self.room.marked("seat", "S2")
        seat["translation"][1] = 0.0
        told = self.room.check(self.folder, code=5)
        self.assertEqual(told.count("error:"), 1, told)
        self.assertIn("error: seat 'S2' of room.gltf: the seat at ", told)
        self.assertRegex(told, r"pelvis point is 0\.00 m above the floor, can't be sat on by a person of 1\.86 m, who can sit "
                               r"from 0\.\d\d m to 0\.\d\d m\n")


def marked(node):
    return node.get("extras", {}).get("pirsim", {})


class OwnRoom:
    """A room of boxes, open at the front, with one sensor in a corner; everything is a node of its own."""

    MODEL = "EKMC1604111"

    def __init__(self, width=5, depth=4, walls=True):
        self.gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "accessors": [], "bufferViews": [], "buffers": []}
        self.mark({"type": "floor", "polygon_xz_m": [[0, 0], [width, 0], [width, -depth], [0, -depth]]}, name="floor")
        self.mark({"type": "sensor", "id": "PIR", "model": self.MODEL}, name="eye", translation=[width - 0.05, 2.2, -0.05],
                  rotation=[-0.16043, 0.37687, 0.066452, 0.909844])
        if walls:
            self.box("slab", (0, -0.1, -depth), (width, 0, 0))
            self.box("wall back", (0, 0, -depth - 0.1), (width, 2.5, -depth))
            self.box("wall left", (-0.1, 0, -depth), (0, 2.5, 0))
            self.box("wall right", (width, 0, -depth), (width + 0.1, 2.5, 0))

    def node(self, name, **more):
        self.gltf["nodes"].append({"name": name, **more})
        self.gltf["scenes"][0]["nodes"].append(len(self.gltf["nodes"]) - 1)
        return self.gltf["nodes"][-1]

    def mark(self, mark, name=None, **more):
        return self.node(name or mark["id"], extras={"pirsim": mark}, **more)

    def seat(self, name, x, z, y=0.53, faces_back=False):
        return self.mark({"type": "seat", "id": name}, translation=[x, y, z],
                         rotation=[0, 1, 0, 0] if faces_back else [0, 0, 0, 1])

    def box(self, name, low, high, mode=4, **more):
        corners = [(high if k >> axis & 1 else low)[axis] for k in range(8) for axis in range(3)]
        quads = (0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)
        indices = [i for a, b, c, d in quads for i in (a, b, c, a, c, d)]
        data = struct.pack("<24f36H", *corners, *indices)
        buffers = self.gltf["buffers"]
        buffers.append({"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                        base64.b64encode(data).decode()})
        views, accessors = self.gltf["bufferViews"], self.gltf["accessors"]
        views += [{"buffer": len(buffers) - 1, "byteOffset": begin, "byteLength": size} for begin, size in ((0, 96), (96, 72))]
        accessors += [{"bufferView": len(views) - 2, "componentType": 5126, "count": 8, "type": "VEC3"},
                      {"bufferView": len(views) - 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]
        self.gltf["meshes"].append({"name": name, "primitives": [
            {"attributes": {"POSITION": len(accessors) - 2}, "indices": len(accessors) - 1, "mode": mode}]})
        return self.node(name, mesh=len(self.gltf["meshes"]) - 1, **more)

    def scaled(self, factor):
        """All below one node."""
        below = self.gltf["scenes"][0]["nodes"]
        self.gltf["nodes"].append({"name": "units", "scale": [factor] * 3, "children": below})
        self.gltf["scenes"][0]["nodes"] = [len(self.gltf["nodes"]) - 1]
        return self


class OwnRooms(Case):
    def files(self, room, actions="", rest=""):
        (self.folder / "room.gltf").write_text(json.dumps(room.gltf, indent=1))
        people = f"people:\n  - {{id: p, actions: [{actions}]}}\n" if actions else ""
        (self.folder / "study.yaml").write_text("pirsim_script: 1\n" + people + rest)
        return "--scene", self.folder / "room.gltf", "--script", self.folder / "study.yaml"

    def told(self, room, actions="", rest="", code=0, command=("check",)):
        return pirsim(*command, *self.files(room, actions, rest), code=code).stderr

    def rows(self, room, actions):
        return pirsim(*self.files(room, actions), "-q").stdout

    def the_error(self, room, actions="", rest=""):
        """The run is refused before it begins, with one message."""
        told = self.told(room, actions, rest, code=5, command=())
        self.assertEqual(told.count("error:"), 1, told)
        self.assertEqual(told, "".join(line + "\n" for line in self.told(room, actions, rest, code=5).splitlines()))
        return told


class HiddenNodes(OwnRooms):
    CROSS = "{appear: {at_xz_m: [1, -0.8]}}, {walk: {to_xz_m: [[1.5, -1.2], [0.6, -2.2], [1.6, -1.6]]}}"
    SCREEN = "screen", (2.2, 0, -2.6), (2.3, 2, -0.6)
    INVISIBLE = {"extensions": {"KHR_node_visibility": {"visible": False}}}

    def hidden(self, **how):
        room = OwnRoom()
        room.box(*self.SCREEN, **how)
        return room

    def test_what_is_hidden_is_not_there(self):
        without = self.rows(OwnRoom(), self.CROSS)
        self.assertNotEqual(self.rows(self.hidden(), self.CROSS), without)
        for how in (self.INVISIBLE, {"scale": [0, 0, 0]}, {"matrix": [0] * 15 + [1]}):
            self.assertEqual(self.rows(self.hidden(**how), self.CROSS), without, how)
            self.assertIn("warning: node 'screen' is hidden and left out\n", self.told(self.hidden(**how), self.CROSS))
        shown = {"extensions": {"KHR_node_visibility": {"visible": True}}}
        self.assertEqual(self.rows(self.hidden(**shown), self.CROSS), self.rows(self.hidden(), self.CROSS))

    def test_what_is_below_it_is_hidden_with_it(self):
        for how in (self.INVISIBLE, {"scale": [0, 0, 0]}):
            room = self.hidden()
            screen = room.gltf["scenes"][0]["nodes"].pop()
            room.gltf["nodes"].append({"name": "middle", "children": [screen]})
            room.node("group", children=[len(room.gltf["nodes"]) - 1], **how)
            self.assertEqual(self.rows(room, self.CROSS), self.rows(OwnRoom(), self.CROSS))
            self.assertIn("warning: node 'group' is hidden and left out, with all that is below it\n",
                          self.told(room, self.CROSS))

    def test_a_hidden_mark_counts_no_more_than_a_hidden_mesh_and_is_named(self):
        room = OwnRoom()
        room.mark({"type": "sensor", "id": "PIR2", "model": OwnRoom.MODEL}, translation=[1, 2, 0], **self.INVISIBLE)
        room.seat("S1", 2, -2)["scale"] = [0, 0, 0]
        told = self.told(room, self.CROSS)
        self.assertIn("node 'PIR2' is hidden and left out: sensor 'PIR2' (and 1 more: seat 'S1')", told)
        self.assertTrue(self.rows(room, self.CROSS).startswith("replicate,trial,time_s,phase,people,PIR\n"))
        floor = OwnRoom()
        floor.gltf["nodes"][0].update(self.INVISIBLE)
        self.assertIn("the scene has no floor area: node 'floor', a floor, is hidden and left out",
                      self.told(floor, self.CROSS, code=3))

    def test_many_are_told_in_one_line_and_not_at_all_where_that_is_meant(self):
        room = OwnRoom()
        for k in range(100):
            room.box(f"old {k}", (1, 0, -3), (2, 1, -2), **self.INVISIBLE)
        told = self.told(room, self.CROSS)
        self.assertEqual(told.count("warning:"), 1, told)
        self.assertIn("node 'old 0' is hidden and left out (and 99 more: node 'old 1', node 'old 2', node 'old 3', ...)", told)
        for node in room.gltf["nodes"][-100:]:
            node["extras"] = {"pirsim": {"type": "ignore"}}
        self.assertEqual(self.told(room, self.CROSS), "")

    def test_the_extension_may_be_required_and_has_to_be_a_flag(self):
        room = self.hidden(**copy.deepcopy(self.INVISIBLE))
        room.gltf["extensionsRequired"] = ["KHR_node_visibility"]
        self.assertIn("is hidden and left out", self.told(room, self.CROSS))
        room.gltf["nodes"][-1]["extensions"]["KHR_node_visibility"]["visible"] = "no"
        self.assertIn("'visible' must be true or false", self.told(room, self.CROSS, code=3))

    def test_a_flattened_node_is_refused_and_not_hidden(self):
        self.assertIn("a scale of zero along one axis makes it flat",
                      self.told(self.hidden(scale=[1, 0, 1]), self.CROSS, code=3))

    def test_an_exported_run_is_a_scene_without_the_people_who_have_yet_to_come(self):
        exported = self.folder / "run.gltf"
        room = OwnRoom(walls=False)
        room.mark({"type": "entrance", "id": "door"}, translation=[2, 0, 0])
        pirsim("export", *self.files(room, "{enter: door, at_s: 2}, {wait_s: 1}, {leave: door}"), "--beams", "none", "-o", exported, "-q")
        scene = json.loads(exported.read_text())
        scene["nodes"].append(room.gltf["nodes"][0])
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
        (self.folder / "again.gltf").write_text(json.dumps(scene))
        told = pirsim("check", "--scene", self.folder / "again.gltf", *self.files(room, self.CROSS)[2:]).stderr
        self.assertIn("node 'p' is hidden and left out, with all that is below it", told)


class ComingIntoBeing(OwnRooms):
    """People can be only where they could have walked to."""

    def room(self, low=(1, 0, -3), high=(3, 2.2, -1)):
        room = OwnRoom()
        room.box("cupboard", low, high)
        return room

    def boards(self):
        """A cupboard that is hollow: four boards, a person has room between them."""
        room = OwnRoom()
        for name, low, high in (("left", (1, 0, -3), (1.05, 2.2, -1)), ("right", (2.95, 0, -3), (3, 2.2, -1)),
                                ("back", (1, 0, -3), (3, 2.2, -2.95)), ("door", (1, 0, -1.05), (3, 2.2, -1))):
            room.box(name, low, high)
        return room

    APPEAR = "{appear: {at_xz_m: [2, -2]}}, {wait_s: 3}"

    def test_nobody_appears_in_a_closed_cupboard(self):
        for room in (self.room(), self.room(high=(3, 1.5, -1)), self.boards()):
            self.assertRegex(self.the_error(room, self.APPEAR), r"study.yaml:3:\d+: error: 'p' can't appear at \(2.00, -2.00\): ")
        self.rows(OwnRoom(), self.APPEAR)

    def test_nor_where_others_walk_to_in_vain(self):
        walk = "{appear: {at_xz_m: [0.5, -0.6]}}, {walk: {to_xz_m: [[2, -2]]}}"
        self.assertIn("point (2.00, -2.00) can't be reached by 'p'", self.the_error(self.boards(), walk))

    def test_not_even_at_the_rim_of_something_solid(self):
        table = self.room((2, 0, -3), (3, 0.75, -2))
        for x in (2.05, 1.95):
            self.assertIn("can't appear", self.the_error(table, f"{{appear: {{at_xz_m: [{x}, -2.5]}}}}, {{wait_s: 1}}"))
        walk = "{appear: {at_xz_m: [1, -1]}}, {walk: {to_xz_m: [[2.05, -2.5]]}}"
        self.assertIn("it is inside of '", self.the_error(table, walk))
        self.rows(table, "{appear: {at_xz_m: [1.8, -2.5]}}, {wait_s: 1}")

    def test_nor_later_in_the_run(self):
        room = self.room()
        room.mark({"type": "entrance", "id": "door"}, translation=[4, 0, 0])
        self.assertIn("can't appear", self.the_error(room, "{enter: door}, {leave: door}, " + self.APPEAR))

    def test_nor_through_a_door_that_is_in_a_cupboard(self):
        room = self.room((1, 0, -1), (3, 2.2, 0))
        room.mark({"type": "entrance", "id": "door"}, translation=[2, 0, 0])
        for actions in ("{enter: door}, {wait_s: 2}", "{enter: door}"):
            self.assertIn("nobody gets from entrance 'door' to the floor", self.the_error(room, actions))
        day = "schedule: {staff: [{role: staff, count: 1}], from: '09:00', to: '09:01'}\n"
        room.seat("S1", 4, -3)
        self.assertIn("nobody gets from entrance 'door' to the floor", self.the_error(room, rest=day))
        room.mark({"type": "entrance", "id": "other"}, translation=[4.3, 0, 0])
        self.assertIn("nobody gets from entrance 'door' to the floor", self.the_error(room, rest=day))
        self.told(room, rest=day.replace("from:", "entrances: [other], from:"))

    def test_nor_by_an_effect(self):
        actions = "{appear: {at_xz_m: [0.5, -0.6]}}, {wait_s: 3}"
        place = "{place: given, x_m: 2, z_m: -2}"
        self.assertIn("error: 'second person' can't appear at (2.00, -2.00)",
                      self.the_error(self.boards(), actions, f"effects: [second_person: {place}]\n"))

    def test_an_effect_finds_a_place_where_people_get_to(self):
        """The place farthest from the seat is in the cupboard, and in the pillar."""
        pillar = OwnRoom()
        pillar.box("pillar", (0.05, 0, -3.95), (2, 2.5, -2))
        for room, (x_low, x_high, z_low, z_high) in ((self.boards(), (1, 3, -3, -1)), (pillar, (0.05, 2, -3.95, -2))):
            room.seat("S1", 4.2, -3)
            room.mark({"type": "entrance", "id": "door"}, translation=[4, 0, 0])
            for effect in ("second_person", "second_person: {moves: wanders}"):
                told = self.folder / "occupants.csv"
                pirsim(*self.files(room, "{enter: door}, {wait_s: 20}", f"effects: [{effect}]\n"), "-q", "--occupants", told)
                for row in told.read_text().splitlines()[1:]:
                    x, z = map(float, row.split(",")[-2:])
                    self.assertFalse(x_low < x < x_high and z_low < z < z_high, (effect, row))

    def test_a_room_without_a_door_is_no_cupboard(self):
        """It may be the only one, or one of several that people can't leave."""
        self.rows(OwnRoom(width=1.5, depth=1.5), "{appear: {at_xz_m: [0.7, -0.7]}}, {wait_s: 1}")
        two = OwnRoom(width=9)
        two.box("wall between", (4, 0, -4), (4.1, 2.5, 0))
        for x in (2, 6):
            self.rows(two, f"{{appear: {{at_xz_m: [{x}, -2]}}}}, {{wait_s: 1}}")


class Unreachable(OwnRooms):
    def test_only_the_first_place_that_can_not_be_reached_is_told(self):
        room = OwnRoom()
        room.box("wall between", (2.5, 0, -4), (2.6, 2.5, 0))
        room.seat("S1", 1, -2)
        room.seat("S2", 4, -2)
        for actions, first in (("{walk: {to_xz_m: [[4, -2], [1, -3], [4, -3]]}}, {walk: {to_xz_m: [[1, -1]]}}, {sit: S1}, "
                                "{work: {}}, rise", "point (4.00, -2.00)"),
                               ("{sit: S2}, {work: {}}, rise, {walk: {to_xz_m: [[1, -1]]}}, {sit: S1}", "seat 'S2'")):
            self.assertIn(f"error: {first}", self.the_error(room, "{appear: {at_xz_m: [1, -1]}}, " + actions))

    def test_who_comes_in_anew_is_judged_anew(self):
        room = OwnRoom()
        room.box("wall between", (2.5, 0, -4), (2.6, 2.5, 0))
        room.mark({"type": "entrance", "id": "door"}, translation=[1, 0, 0])
        again = ", ".join(f"{{enter: door}}, {{walk: {{to_xz_m: [[4, {z}]]}}}}, {{leave: door}}" for z in (-2, -3))
        self.assertEqual(self.told(room, again, code=5).count("can't be reached"), 2)


class Sofas(OwnRooms):
    SIT = "{appear: {at_xz_m: [0.6, -1]}}, {sit: SOFA}, {work: {duration_s: 3}}"

    def sofa(self, behind_edge_m, back=False):
        room = OwnRoom(width=4)
        room.box("sofa base", (1, 0, -3.95), (3, 0.42, -3.05))
        if back:
            room.box("sofa back", (1, 0.42, -3.95), (3, 0.85, -3.7))
        room.seat("SOFA", 2, -3.05 - behind_edge_m, faces_back=True)
        return room

    def test_the_true_reason_and_a_remedy_that_works(self):
        for behind_m in (0.30, 0.33, 0.45, 0.60):  # from 0.41 m on with the hips nearer to the edge than the point
            self.rows(self.sofa(behind_m, back=True), self.SIT)
        for behind_m in (0.75, 0.85):
            told = self.the_error(self.sofa(behind_m), self.SIT)
            self.assertIn(f"its point lies {behind_m:.2f} m behind the edge of 'sofa base'", told)
            self.assertIn("farther than anybody sits from an edge", told)
            self.assertNotIn("within a metre", told)
            forward_m = float(re.search(r"move the point (\S+) m forward", told).group(1))
            self.rows(self.sofa(behind_m - forward_m), self.SIT)

    def test_the_back_of_a_seat_is_no_table(self):
        self.assertEqual(self.told(self.sofa(0.28, back=True), self.SIT), "")
        toilet = OwnRoom(width=4)  # nothing is below the sitter
        toilet.box("cistern", (1.8, 0, -3.95), (2.2, 0.8, -3.7))
        toilet.seat("SOFA", 2, -3.4, faces_back=True)
        self.assertEqual(self.told(toilet, self.SIT), "")

    def test_a_table_behind_is_in_doubt_with_a_chair_and_without(self):
        for chair in (False, True):
            room = OwnRoom(width=4)
            room.box("desk", (1, 0.7, -3.9), (3, 0.74, -3.1))
            if chair:
                room.box("chair", (1.8, 0, -2.95), (2.2, 0.42, -2.65))
            room.seat("SOFA", 2, -2.85, faces_back=True)
            self.assertIn("seat 'SOFA' faces away from 'desk'", self.told(room, self.SIT))


class ManyOfAKind(OwnRooms):
    WALK = "{appear: {at_xz_m: [0.5, -0.5]}}, {walk: {to_xz_m: [[0.5, -1]]}}"

    def seats(self, n):
        room = OwnRoom(width=2 * n)
        room.box("bench", (0, 0.7, -3.9), (2 * n, 0.74, -3.1))
        for k in range(n):
            room.seat(f"S{k}", 2 * k + 1, -2.85, faces_back=True)
        return room

    def test_a_hundred_warnings_of_one_kind_are_one(self):
        room = OwnRoom()
        for k in range(100):
            room.box(f"cable {k}", (1, 0, -3), (2, 1, -2), mode=1)
        told = self.told(room, self.WALK)
        self.assertEqual(told.count("warning:"), 1, told)
        self.assertIn("mesh 'cable 0': points and lines don't occlude; left out (and 99 more: mesh 'cable 1', mesh 'cable 2', "
                      "mesh 'cable 3', ...)", told)
        told = self.told(self.seats(4), self.WALK)
        self.assertEqual(told.count("warning:"), 1, told)
        self.assertIn("seat 'S0' faces away from 'bench': sitters look along the node's -Z (and 3 more: seat 'S1', seat 'S2', "
                      "seat 'S3')", told)

    def test_sets_of_placements_are_told_together(self):
        sets = "".join(f"  - {{id: far {k}, sensors: [{{model: {OwnRoom.MODEL}, position_m: [99, 2.5, -3]}}]}}\n" for k in range(50))
        placements = self.folder / "placements.yaml"
        placements.write_text("pirsim_placements: 1\nspacing_m: 1\nduration_s: 2\ntarget: {x_shapes: {}}\nsets:\n" + sets)
        told = pirsim("placements", "-q", *self.files(OwnRoom())[:2], "--script", placements).stderr
        self.assertEqual(told, "")
        told = pirsim("placements", *self.files(OwnRoom())[:2], "--script", placements).stderr
        self.assertEqual(told.count("warning: set"), 1, told)
        self.assertIn("(and 49 more: set 'far 1': sensor 'PIR1', ", told)

    def test_a_single_one_is_told_as_it_is(self):
        self.assertTrue(self.told(self.seats(1), self.WALK).endswith("sitters look along the node's -Z\n"))

    def test_what_is_marked_as_meant_is_not_told(self):
        room = self.seats(3)
        for node in room.gltf["nodes"]:
            if node["name"] in ("S0", "S1"):
                node["extras"]["pirsim"]["as_meant"] = True
        told = self.told(room, self.WALK)
        self.assertIn("seat 'S2' faces away", told)
        self.assertNotIn("more", told)
        lines = OwnRoom()
        lines.box("cable", (1, 0, -3), (2, 1, -2), mode=1, extras={"pirsim": {"type": "surface", "as_meant": True}})
        self.assertEqual(self.told(lines, self.WALK), "")
        lines.gltf["nodes"][-1]["extras"]["pirsim"]["as_meant"] = "yes"
        self.assertIn("'as_meant' must be true or false", self.told(lines, self.WALK, code=3))

    def test_blind_sensors_are_told_together_after_the_report(self):
        room = OwnRoom()
        for k in range(9):
            room.mark({"type": "sensor", "id": f"B{k}", "model": OwnRoom.MODEL}, translation=[-2, 2, -2])
        result = subprocess.run([PIRSIM, "check", *map(str, self.files(room, self.WALK))], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)
        last = result.stdout.splitlines()[-1]
        self.assertIn("warning: sensor 'B0' can see NOBODY: ", last)
        self.assertIn("(and 8 more: sensor 'B1', sensor 'B2', sensor 'B3', ...)", last)
        self.assertEqual(len(re.findall(r"^  B\d .* sees NOBODY$", result.stdout, re.M)), 9)


class Units(OwnRooms):
    WALK = "{appear: {at_xz_m: [2, -2]}}, {wait_s: 1}"

    def test_the_unit_that_makes_a_plausible_room_is_named_in_one_warning(self):
        for unit, metres in (("inches", 0.0254), ("centimetres", 0.01), ("millimetres", 0.001), ("feet", 0.3048)):
            room = OwnRoom()
            if unit == "feet":  # a hall may be as large: it is the seats that can't be so high
                room.seat("S1", 2, -2)
            files = self.files(room.scaled(1 / metres), f"{{appear: {{at_xz_m: [{2 / metres}, {-2 / metres}]}}}}, {{wait_s: 1}}")
            told = subprocess.run([PIRSIM, "check", *map(str, files)], capture_output=True, text=True).stderr
            self.assertIn(f": {unit}? In {unit} the floor spans 5.0 m x 4.0 m and the room is 2.5 m high; glTF's unit is the "
                          "metre", told)
            self.assertEqual(told.count("warning:"), 1, told)

    def test_halls_and_single_giants_are_not_in_another_unit(self):
        hall = OwnRoom(width=120, depth=60)
        hall.box("roof", (0, 25, -60), (120, 25.2, 0))
        self.assertNotIn("unit", self.told(hall, self.WALK))
        giant = OwnRoom()
        giant.box("tower", (2, 0, -3), (3, 800, -2))
        told = self.told(giant, "{appear: {at_xz_m: [1, -2]}}, {wait_s: 1}")
        self.assertIn("node 'tower': its mesh spans", told)
        self.assertNotIn("the floor spans 5.0", told)
        far = OwnRoom(width=400, depth=3)
        self.assertIn("the floor spans 400 m x 3 m", self.told(far, self.WALK))
        far.gltf["nodes"][0]["extras"]["pirsim"]["as_meant"] = True
        self.assertNotIn("the floor spans", self.told(far, self.WALK))


class BareRoom(Case):
    """A floor that is a polygon of the markup, without any mesh."""

    SCRIPT = "pirsim_script: 1\npeople: [{id: one, actions: [{enter: door}, {wait_s: 5}, {leave: door}]}]\n"

    def room(self, width):
        def node(mark, **place):
            return {**place, "extras": {"pirsim": mark}}
        nodes = [node({"type": "floor", "polygon_xz_m": [[0, 0], [width, 0], [width, -3], [0, -3]]}),
                 node({"type": "entrance", "id": "door"}, translation=[1, 0, 0]),
                 node({"type": "sensor", "id": "PIR1", "model": "EKMC1604111"}, translation=[2, 2.5, 0],
                      rotation=[-0.173648, 0, 0, 0.984808])]
        return ("--scene", self.write("room.gltf", json.dumps({"asset": {"version": "2.0"}, "scene": 0, "nodes": nodes,
                                                               "scenes": [{"nodes": list(range(len(nodes)))}]})),
                "--script", self.write("study.yaml", self.SCRIPT))

    def test_a_room_without_walls_is_told(self):
        told = "no ray of any sensor ends at the room"
        self.assertIn(told, pirsim("check", *self.room(4)).stderr)
        self.assertNotIn(told, pirsim("check", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                                      DATA / "studies" / "studyA.yaml").stderr)

    def test_that_no_ray_ends_at_its_floor_is_told(self):
        told = "no ray ends at the floor: it has no mesh that occludes"
        self.assertIn(told, pirsim("check", *self.room(4)).stdout)
        self.assertNotIn(told, pirsim("check", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                                      DATA / "studies" / "studyA.yaml").stdout)

    def test_its_floor_is_drawn(self):
        pictures = []
        for width in (4, 5):
            pirsim("preview", *self.room(width), "--labels", "none", "--beams", "none", "--time", 0, "--camera", "2,9,-1.5",
                   "--look-at", "2,0,-1.6", "-q", "-o", self.folder / "room.png")
            pictures.append((self.folder / "room.png").read_bytes())
        self.assertNotEqual(*pictures)


class OneMistake(Case):
    """Of a misspelt key or a word for a number only that is told, and not what follows from it."""

    def mistakes(self, text):
        """(what, text) with each key misspelt in turn, and with each whole number made a word."""
        text = re.sub(r"(?m)\s+#.*$|^#.*$", "", text)
        for match in re.finditer(r"(?m)(?<=[{,\s-])[a-z]\w*(?=: |:$)", text):
            if not text[:match.start()].endswith('"'):
                yield match[0], text[:match.end()] + "zq" + text[match.end():]
        for match in re.finditer(r"(?m)(?<=: )\d+(?=[\s,}])", text):
            yield match[0], text[:match.start()] + "word" + text[match.end():]

    def count(self, text, files, name, but=()):
        for what, wrong in self.mistakes(text):
            if what not in but:
                self.write(name, wrong)
                told = subprocess.run([PIRSIM, "check", "-q", *map(str, files)], capture_output=True, text=True,
                                      timeout=60).stderr
                self.assertEqual(told.count("error:"), 1, f"{what}: {told}")

    def test_in_a_script(self):
        room = DATA / "rooms" / "meeting_room.gltf"
        for name in ("studyA", "meeting_day"):  # a variable is told wherever it isn't defined
            self.count((DATA / "studies" / f"{name}.yaml").read_text(),
                       ("--scene", room, "--script", self.folder / "s.yaml"), "s.yaml", ("trials", "for_each", "seat"))

    def test_in_a_sensor_file(self):
        room = Room()
        for node in room.gltf["nodes"]:
            if marked(node).get("type") == "sensor":
                marked(node)["model"] = "MINE"
        files = ("--scene", self.write("room.gltf", json.dumps(room.gltf)), "--script", DATA / "studies" / "look.yaml")
        head = "id: MINE\nplane_m: 2\nrange_m: 4\n"
        sources = "".join(f"  {key}: 'assumed: a'\n" for key in ("plane_m", "range_m", "x_m", "y_m", "zone_side_m", "lens_step"))
        self.count(head + "layout: square\nfacets:\n  - {x_m: 1, y_m: 2, zone_side_m: 1, lens_step: 1}\n  - {x_m: 3, y_m: 2, "
                   "zone_side_m: 1, lens_step: 1}\nsources:\n" + sources, files, "sensors/MINE.yaml", ("facets", "layout"))
        sources = "".join(f"  {key}: 'assumed: a'\n" for key in ("plane_m", "range_m", "corners_m"))
        self.count(head + "clusters:\n  - zones:\n    - corners_m: [[0, 0], [1, 0], [1, 1], [0, 1]]\nsources:\n" + sources,
                   files, "sensors/MINE.yaml", ("clusters",))


class Sensors(Case):
    def setUp(self):
        super().setUp()
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
        self.assertIn("placements.yaml:8:17: error: sensor model 'EKMC160411' is not known (did you mean 'EKMC1604111'?)",
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


class Words(Case):
    """What is asked for and can't be had is told with what there is, in the words that the user typed."""

    def test_unknown_names_come_with_the_nearest_or_the_list(self):
        self.assertIn("sensor 'motion' is not in the scene; there are PIR1, PIR2",
                      study_of("preview", "--beams", "motion", "-o", "x.png", code=2))
        self.assertIn("rule: 'brushed' is not known here; there are ",
                      study("--set", "effects=[{soft_zone_edges: {rule: brushed}}]", code=3).stderr)
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
        for name in ("x.csv", "x.csv.gz", "x.csv.zst"):
            told = study("--shard", "1/2", "-o", name, code=2, cwd=self.folder).stderr
            self.assertIn(f"-o '{name}' is named as a file", told)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_days_off_alone_are_told(self):
        day = "run", "--scene", DATA / "rooms" / "meeting_room.gltf", "--meetings", "--from", "09:00", "--to", "09:01"
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


class Marks(Case):
    def told(self, change, code=3):
        room = Room()
        node = room.marked("seat", "S1")
        change(room.gltf, node)
        return room.check(self.folder, code=code)

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


class Scripts(Case):
    def test_unknown_actions_and_effects_get_the_nearest_name_or_the_list(self):
        def told(*args):
            return study(*args, "--print-config", code=3).stderr
        self.assertIn("'wurk' isn't an action (did you mean 'work'?)", told("--set", "people.0.actions.2={wurk: 3}"))
        self.assertIn("'dance' isn't an action; known are wait_s, wait, appear, enter, walk",
                      told("--set", "people.0.actions.2={dance: 3}"))
        self.assertIn("'juggle' isn't an action; known are", told("--set", "people.0.actions.2=juggle"))
        self.assertIn("'sit' needs a value: `sit: ...`", told("--set", "people.0.actions.2=sit"))
        self.assertIn("'zzzzz' is not an effect; known are ", told("--set", "effects=[zzzzz]"))
        self.assertIn("false_triggers has no parameter 'prob'; known are ",
                      told("--set", "effects=[{false_triggers: {prob: 1}}]"))

    def test_phases_that_no_run_has_are_told_with_their_line(self):
        def told(phases, *more):
            return study("--print-config", "--set", f"summary.phases={phases}", *more, code=3).stderr
        self.assertIn("summary.phases: no run has a phase 'workin' (did you mean 'working'?)", told("[workin]"))
        self.assertIn("no run has a phase 'meeting'; there are getting_up, lying, ", told("[working, meeting]"))
        self.assertIn("no run has a phase 'working'", told("[working]", "--set", "people.0.actions.3.phase=desk"))
        study("--print-config", "--set", "summary.phases=[desk]", "--set", "people.0.actions.3.phase=desk")
        script = self.folder / "trials.yaml"
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
        script = self.folder / "trial.yaml"
        given = study(*ONE_RUN, "--print-config").stdout
        script.write_text(given.replace("id: S1", 'id: "<b>x|y</b>"', 1))
        self.assertIn("<b>", script.read_text())
        pirsim("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script, "-q", "--set",
               "summary={}", "--summary", f"{self.folder}/sums.md")
        text = (self.folder / "sums.md").read_text()
        self.assertIn(r"| \<b\>x\|y\</b\> |", text)


class People(Case):
    SCRIPT = """pirsim_script: 1
people:
  - {id: first, actions: [{enter: door}, {sit: S1}, {work: {duration_s: 60}}, {leave: door}]}
  - {id: second, actions: [{enter: door, at_s: 20}, {sit: S1}, {wait_s: 1}, {leave: door}]}
"""

    def test_who_waits_outside_for_a_seat_is_counted(self):
        script, rows = self.folder / "two.yaml", self.folder / "rows.csv"
        counted = {}
        for seat in ("S1", "S2"):
            script.write_text(self.SCRIPT.replace("{enter: door, at_s: 20}, {sit: S1}",
                                                  f"{{enter: door, at_s: 20}}, {{sit: {seat}}}"))
            told = pirsim("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script, "-o", rows).stderr
            people = json.loads(pathlib.Path(f"{rows}.json").read_text()).get("people", {})
            counted[seat] = people.get("waits_outside", 0), "waited outside" in told
        self.assertEqual(counted, {"S1": (1, True), "S2": (0, False)})

    def test_a_merged_summary_tells_who_waited_as_that_of_the_whole_does(self):
        script = "--script", self.write("two.yaml", self.SCRIPT)
        room = "--scene", DATA / "rooms" / "meeting_room.gltf"
        whole, merged = self.folder / "whole.md", self.folder / "merged.md"
        pirsim(*room, *script, "-q", "-o", self.folder / "rows.csv", "--summary", whole)
        pirsim(*room, *script, "-q", "-o", self.folder / "shards", "--shard", "1/1")
        pirsim("merge", self.folder / "shards", *script, "-q", "-o", self.folder / "all.csv", "--summary", merged)
        self.assertIn("outside", whole.read_text())
        self.assertEqual(merged.read_text(), whole.read_text())


class Streams(Case):
    def test_scene_and_script_from_standard_input_and_rows_to_standard_output(self):
        scene, script = DATA / "rooms" / "meeting_room.gltf", DATA / "studies" / "studyA.yaml"
        expected = study(*ONE_RUN).stdout
        for given, files in ((script, ("--scene", scene, "--script", "-")), (scene, ("--scene", "-", "--script", script))):
            piped = pirsim(*files, *ONE_RUN, "-o", "-", input=given.read_text()).stdout
            self.assertEqual(piped, expected)
            rows = self.folder / "rows.csv"
            pirsim(*files, *ONE_RUN, "-o", rows, input=given.read_text())
            self.assertEqual(rows.read_text(), expected)
            direct = self.folder / "direct.csv"
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
        room = self.folder / "room.glb"
        pirsim("room", "-o", room, "--seed", 2)
        day = "--staff", 1, "--days", 1, "--from", "09:00", "--to", "09:01", "-q"
        piped = subprocess.run([PIRSIM, "run", "--scene", "-", *map(str, day)], input=room.read_bytes(),
                               capture_output=True)
        self.assertEqual(piped.returncode, 0, piped.stderr)
        self.assertEqual(piped.stdout.decode(), pirsim("run", "--scene", room, *day).stdout)

    def test_measured_rows_from_standard_input(self):
        """A faulty line tells that they were read; an analysis would take minutes."""
        rows = "trial,time_s,PIR1,PIR2,PIR3,PIR4,PIR5\nS1,1,0,0,0,0,7\n"
        study_files = "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml"
        self.assertIn("stdin:2:", pirsim("reconcile", *study_files, "--measured", "-", code=3, input=rows).stderr)

    def test_two_inputs_can_not_be_one_stream(self):
        self.assertIn("--script and --measured can't both be standard input",
                      pirsim("reconcile", "--scene", "room.gltf", "--script", "-", "--measured", "-", code=2, input="").stderr)
        self.assertIn("can't both be standard input", pirsim("--scene", "-", "--script", "-", code=2, input="").stderr)


class Outputs(Case):
    def test_surveys_say_where_they_write(self):
        scene = "--scene", DATA / "rooms" / "meeting_room.gltf"
        told = pirsim("coverage", *scene, "--script", DATA / "studies" / "studyB.yaml", "--set", "spacing_m=1",
                      cwd=self.folder).stderr
        self.assertIn("wrote coverage/coverage.csv", told)
        told = pirsim("walktest", *scene, "--script", DATA / "studies" / "walk_test.yaml", "--set", "spacing_m=2",
                      cwd=self.folder).stderr
        self.assertIn("wrote walk_test.csv", told)
        self.assertTrue((self.folder / "walk_test.csv").exists())
        self.assertIn("(default: coverage)", pirsim("coverage", "--help").stdout)
        self.assertIn("(default: walk_test.csv)", pirsim("walktest", "--help").stdout)

    def test_a_report_speaks_of_shaded_windows_where_there_are_any(self):
        for change, shaded in (((), True), (("--set", "summary.phases=[]"), False)):
            page = self.folder / "page.html"
            study(*ONE_RUN, *change, "-o", f"{self.folder}/rows.csv", "--report", page)
            self.assertEqual("counted windows are shaded" in page.read_text(), shaded)

    def test_zones_tell_early_how_much_they_will_write(self):
        zones = self.folder / "zones.csv"
        once = "--set", "trials.for_each.seat=[S1]", "--zones", zones, "-o", f"{self.folder}/rows.csv"
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
    main()
