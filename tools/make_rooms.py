#!/usr/bin/env python3
"""Writes the shipped rooms as glTF: data/rooms/{meeting_room,open_office,open_hall,two_rooms,flat,office_floor}.gltf.

The meeting room follows data/rooms/room_layouts.json; `--alternative N` (1-8, or `all`) writes
meeting_room_altN.gltf from one of the other layouts that the paper's data allow. The output depends on nothing but
this file and the layouts. Frame: glTF's, metres, +Y up; everything that faces somewhere faces its local -Z.
"""
import argparse
import base64
import json
import math
import pathlib
import struct

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Not given by the paper; assumed, in metres.
WALL = 0.1            # thickness, outside the room
DOOR_WIDTH, DOOR_HEIGHT = 0.9, 2.05
DOOR_FROM_CORNER = 0.115
CEILING_GAP = 0.01    # the sensors' openings lie at the room's height: the slab must not swallow their rays
TABLE_LEG = 0.06
TELEVISION = (1.23, 0.71, 0.06)  # 55 inch
TELEVISION_HEIGHT = 1.35         # of its centre


# -- transforms ---------------------------------------------------------------------------------------------------

def rounded(numbers):
    return [round(float(n), 6) + 0.0 for n in numbers]


def rotation(yaw_deg=0.0, tilt_down_deg=0.0):
    """Quaternion (x, y, z, w): turned left by the yaw, then the look tilted down by the tilt."""
    y, x = math.radians(yaw_deg) / 2, -math.radians(tilt_down_deg) / 2
    return [math.cos(y) * math.sin(x), math.sin(y) * math.cos(x), -math.sin(y) * math.sin(x), math.cos(y) * math.cos(x)]


def heading_deg(facing_xz):
    """Yaw that turns -Z to the given direction."""
    return math.degrees(math.atan2(-facing_xz[0], -facing_xz[1]))


# -- a glTF in the making -----------------------------------------------------------------------------------------

class Scene:
    def __init__(self, name):
        self.name, self.nodes, self.meshes, self.materials = name, [], [], []
        self.accessors, self.views, self.bytes = [], [], b""
        self.roots = []

    def _accessor(self, data, target, component, kind, count, **limits):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), "target": target})
        self.bytes += data
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": count,
                               "type": kind, **limits})
        return len(self.accessors) - 1

    def geometry(self, points, triangles):
        """Accessors of positions (float) and indices (8 or 16 bit)."""
        flat = [i for triangle in triangles for i in triangle]
        small = len(points) < 256
        single = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in points]  # the limits must be those stored
        low, high = ([f(p[k] for p in single) for k in range(3)] for f in (min, max))
        position = self._accessor(b"".join(struct.pack("<3f", *p) for p in points), 34962, 5126, "VEC3", len(points),
                                  min=low, max=high)
        index = self._accessor(struct.pack("<%d%s" % (len(flat), "B" if small else "H"), *flat), 34963,
                               5121 if small else 5123, "SCALAR", len(flat))
        return position, index

    def material(self, name, colour):
        self.materials.append({"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1],
                                                                      "metallicFactor": 0, "roughnessFactor": 0.9}})
        return len(self.materials) - 1

    def mesh(self, name, geometry, material):
        self.meshes.append({"name": name, "primitives": [{"attributes": {"POSITION": geometry[0]},
                                                          "indices": geometry[1], "material": material}]})
        return len(self.meshes) - 1

    def node(self, name, parent=None, at=None, turned=None, scale=None, mesh=None, mark=None):
        node = {"name": name}
        if mesh is not None:
            node["mesh"] = mesh
        for key, value in (("translation", at), ("rotation", turned), ("scale", scale)):
            if value is not None:
                node[key] = rounded(value)
        if mark:
            node["extras"] = {"pirsim": mark}
        self.nodes.append(node)
        index = len(self.nodes) - 1
        (self.roots if parent is None else self.nodes[parent].setdefault("children", [])).append(index)
        return index

    def box(self, name, parent, mesh, low, high):
        """A copy of the unit box between two corners."""
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        return self.node(name, parent, at=centre, scale=[b - a for a, b in zip(low, high)], mesh=mesh)

    def text(self):
        parts = {"asset": {"version": "2.0", "generator": "pirsim tools/make_rooms.py"},
                 "scene": 0, "scenes": [{"name": self.name, "nodes": self.roots}], "nodes": self.nodes}
        if self.meshes:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
            parts |= {"meshes": self.meshes, "materials": self.materials, "accessors": self.accessors,
                      "bufferViews": self.views, "buffers": [{"byteLength": len(self.bytes), "uri": uri}]}
        return dump(parts) + "\n"


def dump(value, depth=0):
    """JSON with an indent of one, and everything short on one line."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or len(line) + depth <= 100:
        return line
    pad = "\n" + " " * (depth + 1)
    if isinstance(value, dict):
        inner = ("," + pad).join(json.dumps(k) + ": " + dump(v, depth + 1) for k, v in value.items())
        return "{" + pad + inner + "\n" + " " * depth + "}"
    return "[" + pad + ("," + pad).join(dump(v, depth + 1) for v in value) + "\n" + " " * depth + "]"


def box_geometry(low=(-0.5, -0.5, -0.5), high=(0.5, 0.5, 0.5)):
    points = [[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)]
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]  # outward
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def joined(*parts):
    points, triangles = [], []
    for more, faces in parts:
        triangles += [tuple(i + len(points) for i in face) for face in faces]
        points += more
    return points, triangles


class Stock:
    """Materials, and the unit box in each of them, made when first asked for; all boxes share one set of numbers."""
    COLOURS = {"carpet": (0.45, 0.47, 0.5), "plaster": (0.9, 0.9, 0.88), "wood": (0.65, 0.48, 0.32),
               "screen": (0.08, 0.08, 0.1), "fabric": (0.35, 0.45, 0.55)}

    def __init__(self, scene):
        self.scene, self.materials, self.boxes = scene, {}, {}
        self.unit_box = scene.geometry(*box_geometry())

    def material(self, name):
        if name not in self.materials:
            self.materials[name] = self.scene.material(name, self.COLOURS[name])
        return self.materials[name]

    def box(self, name):
        if name not in self.boxes:
            self.boxes[name] = self.scene.mesh(name + " box", self.unit_box, self.material(name))
        return self.boxes[name]


def add_sensor(scene, parent, name, model, at, yaw_deg, tilt_down_deg):
    scene.node(name, parent, at=at, turned=rotation(yaw_deg, tilt_down_deg),
               mark={"type": "sensor", "id": name, "model": model})


def add_seat(scene, parent, name, at, yaw_deg):
    scene.node(name, parent, at=at, turned=rotation(yaw_deg), mark={"type": "seat", "id": name})


# -- the meeting room ---------------------------------------------------------------------------------------------

def meeting_room(layout, name):
    scene = Scene(name)
    stock = Stock(scene)
    width, depth, height = (layout["room"][k] for k in ("width_x_m", "depth_z_m", "height_y_m"))
    top = height + CEILING_GAP

    structure = scene.node("structure")
    floor = scene.geometry([(0, 0, 0), (width, 0, 0), (width, 0, -depth), (0, 0, -depth)], [(0, 1, 2), (0, 2, 3)])
    scene.node("floor", structure, mesh=scene.mesh("floor", floor, stock.material("carpet")), mark={"type": "floor"})
    plaster = stock.box("plaster")
    scene.box("ceiling", structure, plaster, (-WALL, top, -depth - WALL), (width + WALL, top + WALL, WALL))
    scene.box("wall left", structure, plaster, (-WALL, 0, -depth - WALL), (0, top, WALL))
    scene.box("wall right", structure, plaster, (width, 0, -depth - WALL), (width + WALL, top, WALL))
    scene.box("wall far", structure, plaster, (0, 0, -depth - WALL), (width, top, -depth))
    door_right = width - DOOR_FROM_CORNER
    door_left = door_right - DOOR_WIDTH
    scene.box("sensor wall left of the door", structure, plaster, (0, 0, 0), (door_left, top, WALL))
    scene.box("sensor wall right of the door", structure, plaster, (door_right, 0, 0), (width, top, WALL))
    scene.box("sensor wall above the door", structure, plaster, (door_left, DOOR_HEIGHT, 0), (door_right, top, WALL))
    scene.node("door", structure, at=[(door_left + door_right) / 2, 0, 0],
               mark={"type": "entrance", "id": "door", "width_m": DOOR_WIDTH, "outside_m": 1.5})

    table = layout["table"]
    add_table(scene, stock, table)
    furniture = scene.node("wall furniture")
    half = [TELEVISION[0] / 2, TELEVISION[1] / 2]
    scene.box("television", furniture, stock.box("screen"),
              (table["centre_x_m"] - half[0], TELEVISION_HEIGHT - half[1], -depth),
              (table["centre_x_m"] + half[0], TELEVISION_HEIGHT + half[1], -depth + TELEVISION[2]))

    sensors = scene.node("sensors")
    for s in layout["sensors"]:
        add_sensor(scene, sensors, s["id"], "EKMC1604111", s["position_m"], s["yaw_deg"], s["tilt_down_deg"])
    seats = scene.node("seats")
    hip = layout["body_fit"]["hip_z"]
    for s in layout["seats"]:
        add_seat(scene, seats, s["id"], [s["pelvis_x_m"], hip, s["pelvis_z_m"]], heading_deg(s["facing_xz"]))
    return scene


def add_table(scene, stock, table):
    x, z = table["size_x_m"] / 2, table["size_z_m"] / 2
    top, under = table["top_y_m"], table["top_y_m"] - table["thickness_m"]
    node = scene.node("table", at=[table["centre_x_m"], 0, table["centre_z_m"]])
    scene.box("table top", node, stock.box("wood"), (-x, under, -z), (x, top, z))
    for name, sx, sz in (("near left", -1, 1), ("near right", 1, 1), ("far left", -1, -1), ("far right", 1, -1)):
        outer, inner = (sx * x, sz * z), (sx * (x - TABLE_LEG), sz * (z - TABLE_LEG))
        scene.box("table leg " + name, node, stock.box("wood"),
                  (min(outer[0], inner[0]), 0, min(outer[1], inner[1])),
                  (max(outer[0], inner[0]), under, max(outer[1], inner[1])))


# -- the open office: invented, to differ from the meeting room in everything ----------------------------------------

def open_office():
    scene = Scene("open office")
    stock = Stock(scene)
    height = 3.0
    add_office_structure(scene, stock, height)

    desk = desk_mesh(scene, stock)
    island_a = scene.node("island A", at=[3.0, 0, -2.5])
    island_b = scene.node("island B", at=[9.4, 0, -2.5], turned=rotation(90))
    for island, first in ((island_a, 1), (island_b, 5)):
        add_island(scene, stock, island, desk, first)

    lounge = scene.node("lounge", at=[5.6, 0, -6.6], turned=rotation(30))
    scene.box("low table", lounge, stock.box("wood"), (-0.4, 0.35, -1.3), (0.4, 0.4, -0.7))
    add_seat(scene, lounge, "S9", [0, 0.45, 0], 0)

    ceiling = scene.node("ceiling sensors", at=[0, height - 0.01, 0])  # just below the slab
    for name, x, z, yaw in (("C1", 3.0, -2.5, 0), ("C2", 9.4, -2.5, 45), ("C3", 4.0, -6.2, 90)):
        # Looking straight down, the image's +Y points to the room's -Z, turned left by the yaw.
        add_sensor(scene, ceiling, name, "EKMC1601111", [x, 0, z], yaw, 90)
    add_sensor(scene, None, "W1", "EKMC1604111", [0.03, 2.3, -6.2], -90, 10)
    return scene


def desk_mesh(scene, stock):
    """One for all copies. A desk stands on its node, the user sits at +Z; a drawer unit on the right."""
    return scene.mesh("desk", scene.geometry(*joined(
        box_geometry((-0.79, 0.715, -0.39), (0.79, 0.74, 0.39)), box_geometry((-0.78, 0, -0.35), (-0.75, 0.715, 0.35)),
        box_geometry((0.36, 0.1, -0.35), (0.78, 0.715, 0.35)))), stock.material("wood"))


def add_office_structure(scene, stock, height):
    """12 x 8 m without the corner x > 8, z < -5; doors in the front and the right wall."""
    plaster = stock.box("plaster")
    structure = scene.node("structure")
    corners = [(0, 0), (12, 0), (12, -5), (8, -5), (8, -8), (0, -8)]  # counter-clockwise seen from above
    floor = scene.geometry([(x, 0, z) for x, z in corners], [(3, 4, 5), (3, 5, 0), (3, 0, 1), (3, 1, 2)])
    scene.node("floor", structure, mesh=scene.mesh("floor", floor, stock.material("carpet")), mark={"type": "floor"})
    door = 2.1
    for name, low, high in (
            ("ceiling", (-WALL, height, -8 - WALL), (12 + WALL, height + WALL, WALL)),
            ("front wall left of the door", (0, 0, 0), (1, height, WALL)),
            ("front wall right of the door", (2, 0, 0), (12, height, WALL)),
            ("front wall above the door", (1, door, 0), (2, height, WALL)),
            ("left wall", (-WALL, 0, -8 - WALL), (0, height, WALL)),
            ("back wall", (0, 0, -8 - WALL), (8 + WALL, height, -8)),
            ("core wall along x", (8 + WALL, 0, -5 - WALL), (12 + WALL, height, -5)),
            ("core wall along z", (8, 0, -8), (8 + WALL, height, -5)),
            ("right wall near the front", (12, 0, -0.3), (12 + WALL, height, WALL)),
            ("right wall near the core", (12, 0, -5), (12 + WALL, height, -1.3)),
            ("right wall above the door", (12, door, -1.3), (12 + WALL, height, -0.3)),
            ("pillar", (6.0, 0, -4.9), (6.4, height, -4.5))):
        scene.box(name, structure, plaster, low, high)
    for name, at, yaw in (("front door", [1.5, 0, 0], 0), ("side door", [12, 0, -0.8], 90)):
        scene.node(name + " door", structure, at=at, turned=rotation(yaw),
                   mark={"type": "entrance", "id": name.replace(" ", "_"), "width_m": 1.0, "outside_m": 1.5})


def add_island(scene, stock, island, desk, first_seat):
    """Two by two desks back to back, a partition screen between them."""
    scene.box("partition", island, stock.box("fabric"), (-1.6, 0.6, -0.02), (1.6, 1.25, 0.02))
    places = (("left", -0.8, 0.42, 0), ("right", 0.8, 0.42, 0), ("right", 0.8, -0.42, 180), ("left", -0.8, -0.42, 180))
    for k, (side, x, z, yaw) in enumerate(places):
        seat = "S%d" % (first_seat + k)
        place = scene.node("place " + seat, island, at=[x, 0, z], turned=rotation(yaw))
        # Drawers point to the aisle on both sides: the mirrored copy has a negative scale.
        mirrored = (side == "left") == (yaw == 0)
        scene.node("desk " + seat, place, mesh=desk, scale=[-1, 1, 1] if mirrored else None)
        scene.box("monitor " + seat, place, stock.box("screen"), (-0.3, 0.85, -0.25), (0.3, 1.2, -0.21))
        add_seat(scene, place, seat, [0, 0.53, 0.55], 0)


# -- the open hall: the paper's density experiment, section 2.1 -------------------------------------------------------

def open_hall():
    scene = Scene("open hall")
    scene.node("floor", mark={"type": "floor", "polygon_xz_m": [[-10, 0], [10, 0], [10, -30], [-10, -30]]})
    add_sensor(scene, None, "PIR1", "EKMC1604111", [0, 3, -3], 0, 20)
    return scene


# -- two rooms: invented, the least scene with areas ------------------------------------------------------------------

def two_rooms():
    """8 x 4 m with a wall across, in whose middle the two areas meet, and a gap of 0.9 m in the wall."""
    scene = Scene("two rooms")
    stock = Stock(scene)
    height, depth, middle = 2.5, 4.0, 4.5
    plaster = stock.box("plaster")
    structure = scene.node("structure")
    floor = scene.geometry([(0, 0, 0), (8, 0, 0), (8, 0, -depth), (0, 0, -depth)], [(0, 1, 2), (0, 2, 3)])
    scene.node("floor", structure, mesh=scene.mesh("floor", floor, stock.material("carpet")), mark={"type": "floor"})
    for name, low, high in (("living_room", 0, middle), ("bedroom", middle, 8)):
        corners = [[low, 0], [high, 0], [high, -depth], [low, -depth]]
        scene.node(name, structure, mark={"type": "area", "id": name, "polygon_xz_m": corners})
    for name, low, high in (
            ("ceiling", (-WALL, height, -depth - WALL), (8 + WALL, height + WALL, WALL)),
            ("front wall left of the door", (-WALL, 0, 0), (0.5, height, WALL)),
            ("front wall right of the door", (1.4, 0, 0), (8 + WALL, height, WALL)),
            ("front wall above the door", (0.5, DOOR_HEIGHT, 0), (1.4, height, WALL)),
            ("back wall", (-WALL, 0, -depth - WALL), (8 + WALL, height, -depth)),
            ("left wall", (-WALL, 0, -depth), (0, height, 0)), ("right wall", (8, 0, -depth), (8 + WALL, height, 0)),
            ("inner wall near the front", (middle - 0.05, 0, -1.5), (middle + 0.05, height, 0)),
            ("inner wall near the back", (middle - 0.05, 0, -depth), (middle + 0.05, height, -2.4)),
            ("inner wall above the gap", (middle - 0.05, DOOR_HEIGHT, -2.4), (middle + 0.05, height, -1.5))):
        scene.box(name, structure, plaster, low, high)
    scene.node("door", structure, at=[0.95, 0, 0],
               mark={"type": "entrance", "id": "door", "width_m": DOOR_WIDTH, "outside_m": 1.5})
    scene.box("table top", None, stock.box("wood"), (2.2, 0.71, -3.7), (3.4, 0.74, -2.9))
    add_seat(scene, None, "S1", [2.8, 0.53, -2.65], 0)
    add_sensor(scene, None, "PIR1", "EKMC1604111", [0.01, 2.2, -3.0], -90, 20)
    add_sensor(scene, None, "PIR2", "EKMC1604111", [7.99, 2.2, -3.0], 90, 20)
    return scene


# -- a flat: invented, for two who live there -------------------------------------------------------------------------

def add_place(scene, name, posture, uses, at, yaw_deg):
    mark = {"type": "place", "id": name, "posture": posture, "for": uses}
    scene.node(name, at=at, turned=rotation(yaw_deg), mark=mark)


def wall_along_x(z, low, high, gaps, height):
    """Boxes of an inner wall with doorways, each (from, to)."""
    near, far = z + WALL / 2, z - WALL / 2
    starts, ends = [low, *(b for _, b in gaps)], [*(a for a, _ in gaps), high]
    walls = [((a, 0, far), (b, height, near)) for a, b in zip(starts, ends)]
    return walls + [((a, DOOR_HEIGHT, far), (b, height, near)) for a, b in gaps]


def flat():
    """9 x 8 m: a corridor along the middle; living room and kitchen in front, bedroom, bath and study at the back."""
    scene = Scene("flat")
    stock = Stock(scene)
    height, width, depth, front, back = 2.5, 9.0, 8.0, 3.4, 4.6
    plaster, wood, fabric = stock.box("plaster"), stock.box("wood"), stock.box("fabric")
    structure = scene.node("structure")
    floor = scene.geometry([(0, 0, 0), (width, 0, 0), (width, 0, -depth), (0, 0, -depth)], [(0, 1, 2), (0, 2, 3)])
    scene.node("floor", structure, mesh=scene.mesh("floor", floor, stock.material("carpet")), mark={"type": "floor"})
    rooms = {"living_room": (0, 5.5, 0, front), "kitchen": (5.5, width, 0, front), "corridor": (0, width, front, back),
             "bedroom": (0, 4.0, back, depth), "bath": (4.0, 6.4, back, depth), "study": (6.4, width, back, depth)}
    for name, (x0, x1, z0, z1) in rooms.items():
        corners = [[x0, -z0], [x1, -z0], [x1, -z1], [x0, -z1]]
        scene.node(name, structure, mark={"type": "area", "id": name, "polygon_xz_m": corners})
    outer = [((-WALL, height, -depth - WALL), (width + WALL, height + WALL, WALL)),
             ((-WALL, 0, 0), (width + WALL, height, WALL)), ((-WALL, 0, -depth - WALL), (width + WALL, height, -depth)),
             ((width, 0, -depth), (width + WALL, height, 0)), ((-WALL, 0, -3.55), (0, height, 0)),
             ((-WALL, 0, -depth), (0, height, -4.45)), ((-WALL, DOOR_HEIGHT, -4.45), (0, height, -3.55))]
    inner = (wall_along_x(-front, 0, width, [(2.0, 2.9), (6.6, 7.5)], height)
             + wall_along_x(-back, 0, width, [(1.5, 2.4), (4.8, 5.7), (7.2, 8.1)], height)
             + [((x - WALL / 2, 0, -z1), (x + WALL / 2, height, -z0))
                for x, z0, z1 in ((5.5, 0, front), (4.0, back, depth), (6.4, back, depth))])
    for number, (low, high) in enumerate(outer + inner, 1):
        scene.box("wall %d" % number, structure, plaster, low, high)
    scene.node("door", structure, at=[0, 0, -4.0], turned=rotation(-90),
               mark={"type": "entrance", "id": "door", "width_m": DOOR_WIDTH, "outside_m": 1.5})
    # The bedroom's opens so wide that one passes between it and the bed, to the bed's far side.
    for name, at, yaw, hinge, state, wide in (("front", [0, 0, -4.0], -90, "left", "shut", {}),
                                              ("bath", [5.25, 0, -back], 0, "left", "habit", {}),
                                              ("bedroom", [1.95, 0, -back], 0, "right", "habit", {"open_deg": 140})):
        scene.node(name + " door", structure, at=at, turned=rotation(yaw),
                   mark={"type": "door", "id": name, "width_m": 0.88, "hinge": hinge, "state": state} | wide)
    for name, kind, low, high in (
            ("sofa", fabric, (1.2, 0, -0.9), (3.2, 0.42, -0.02)),
            ("sofa back", fabric, (1.2, 0.42, -0.22), (3.2, 0.85, -0.02)),
            ("television", stock.box("screen"), (1.4, 0.6, -3.33), (1.9, 1.1, -3.29)),
            ("dining table", wood, (3.7, 0.71, -2.2), (5.1, 0.74, -1.4)),
            ("counter", wood, (5.7, 0, -0.6), (8.98, 0.9, -0.02)),
            ("fridge", plaster, (8.3, 0, -3.3), (8.9, 1.8, -2.7)),
            ("bed", fabric, (0.05, 0, -7.2), (2.05, 0.5, -5.6)), ("wardrobe", wood, (2.9, 0, -7.98), (3.9, 2.1, -7.4)),
            ("toilet", plaster, (4.25, 0, -7.98), (4.65, 0.42, -7.3)),
            ("basin", plaster, (5.95, 0.7, -6.3), (6.33, 0.85, -5.7)),
            ("shower tray", plaster, (5.5, 0, -7.98), (6.33, 0.04, -7.15)),
            ("desk", wood, (6.9, 0.71, -7.95), (8.5, 0.74, -7.25)),
            ("shelf", wood, (8.65, 0, -6.6), (8.97, 2.0, -5.2))):
        scene.box(name, None, kind, low, high)
    for name, uses, at, yaw in (
            ("sofa_left", ["tv", "rest", "read"], [1.7, 0.51, -0.55], 0),
            ("sofa_right", ["tv", "rest", "read"], [2.7, 0.51, -0.55], 0),
            ("table_1", ["eat", "work", "play"], [4.05, 0.53, -1.15], 0),
            ("table_2", ["eat", "play"], [4.75, 0.53, -1.15], 0),
            ("table_3", ["eat", "play"], [4.05, 0.53, -2.45], 180),
            ("table_4", ["eat", "play"], [4.75, 0.53, -2.45], 180),
            ("wc", ["toilet"], [4.45, 0.51, -7.5], 180), ("desk_chair", ["work"], [7.7, 0.53, -6.95], 0)):
        add_place(scene, name, "sit", uses, at, yaw)
    for name, uses, at, yaw in (("stove", ["cook"], [6.6, 0, -0.95], 180),
                                ("sink", ["chores", "cook"], [7.8, 0, -0.95], 180),
                                ("washbasin", ["wash", "dress"], [5.6, 0, -6.0], -90),
                                ("shower", ["shower"], [5.1, 0, -7.0], 0)):
        add_place(scene, name, "stand", uses, at, yaw)
    for name, z in (("bed_left", -6.0), ("bed_right", -6.8)):
        add_place(scene, name, "lie", ["sleep"], [1.05, 0.5, z], -90)
    for name, at, yaw in (("PIR_living", [5.43, 2.2, -1.8], 90), ("PIR_kitchen", [8.98, 2.2, -1.7], 90),
                          ("PIR_corridor", [8.98, 2.2, -4.0], 90), ("PIR_bedroom", [3.93, 2.2, -6.3], 90),
                          ("PIR_bath", [5.2, 2.2, -7.98], 180), ("PIR_study", [6.47, 2.2, -6.0], -90)):
        add_sensor(scene, None, name, "EKMC1604111", at, yaw, 20)
    return scene


# -- a floor of an office: invented, for 24 with desks of their own ----------------------------------------------------

def office_floor():
    """40 x 15 m: two meeting rooms at the left end with a pantry between them, six islands of four desks to the right."""
    scene = Scene("office floor")
    stock = Stock(scene)
    height, width, depth, west = 2.8, 40.0, 15.0, 7.0
    plaster, wood = stock.box("plaster"), stock.box("wood")
    structure = scene.node("structure")
    floor = scene.geometry([(0, 0, 0), (width, 0, 0), (width, 0, -depth), (0, 0, -depth)], [(0, 1, 2), (0, 2, 3)])
    scene.node("floor", structure, mesh=scene.mesh("floor", floor, stock.material("carpet")), mark={"type": "floor"})
    areas = {"meeting_a": (0, west, 0, 6), "pantry": (0, west, 6, 9), "meeting_b": (0, west, 9, depth),
             "open_west": (west, 23.5, 0, depth), "open_east": (23.5, width, 0, depth)}
    for name, (x0, x1, z0, z1) in areas.items():
        corners = [[x0, -z0], [x1, -z0], [x1, -z1], [x0, -z1]]
        scene.node(name, structure, mark={"type": "area", "id": name, "polygon_xz_m": corners})
    door_a, door_b, entry = (4.4, 5.3), (9.7, 10.6), (22.9, 24.1)
    outer = [((-WALL, height, -depth - WALL), (width + WALL, height + WALL, WALL)),
             ((-WALL, 0, 0), (entry[0], height, WALL)), ((entry[1], 0, 0), (width + WALL, height, WALL)),
             ((entry[0], DOOR_HEIGHT, 0), (entry[1], height, WALL)),
             ((-WALL, 0, -depth - WALL), (width + WALL, height, -depth)), ((-WALL, 0, -depth), (0, height, 0)),
             ((width, 0, -8.1), (width + WALL, height, 0)), ((width, 0, -depth), (width + WALL, height, -9.1)),
             ((width, DOOR_HEIGHT, -9.1), (width + WALL, height, -8.1))]
    inner = wall_along_x(-6, 0, west, [], height) + wall_along_x(-9, 0, west, [], height)
    for (x0, x1, z0, z1) in ((west, west, 0, door_a[0]), (west, west, door_a[1], 6), (west, west, 9, door_b[0]),
                             (west, west, door_b[1], depth)):
        inner.append(((x0 - WALL / 2, 0, -z1), (x1 + WALL / 2, height, -z0)))
    for z0, z1 in (door_a, door_b):
        inner.append(((west - WALL / 2, DOOR_HEIGHT, -z1), (west + WALL / 2, height, -z0)))
    pillars = [((x - 0.2, 0, -7.7), (x + 0.2, height, -7.3)) for x in (16.6, 30.4)]
    for number, (low, high) in enumerate(outer + inner + pillars, 1):
        scene.box("wall %d" % number, structure, plaster, low, high)
    for name, at, yaw, wide in (("lifts", [23.5, 0, 0], 0, 1.2), ("stairs", [width, 0, -8.6], 90, 1.0)):
        scene.node(name, structure, at=at, turned=rotation(yaw),
                   mark={"type": "entrance", "id": name, "width_m": wide, "outside_m": 1.5})
    for name, (z0, z1), hinge in (("meeting_a_door", door_a, "left"), ("meeting_b_door", door_b, "right")):
        scene.node(name, structure, at=[west, 0, -(z0 + z1) / 2], turned=rotation(90),
                   mark={"type": "door", "id": name, "width_m": 0.88, "hinge": hinge, "state": "habit"})

    desk = desk_mesh(scene, stock)
    for number, (x, z) in enumerate([(x, z) for z in (-3.6, -11.4) for x in (12.0, 20.0, 30.0)]):
        island = scene.node("island %d" % (number + 1), at=[x, 0, z])
        add_island(scene, stock, island, desk, 1 + 4 * number)
    for name, z, seats in (("A", -3.0, 8), ("B", -12.0, 6)):
        length = 0.75 * seats / 2 + 0.2
        scene.box("table " + name, None, wood, (3.3 - length / 2, 0.71, z - 0.6), (3.3 + length / 2, 0.74, z + 0.6))
        scene.box("screen " + name, None, stock.box("screen"), (0.0, 0.9, z - 0.7), (0.06, 1.7, z + 0.7))
        for k in range(seats):
            side = 1 if k % 2 == 0 else -1
            x = 3.3 + 0.75 * (k // 2 - (seats / 2 - 1) / 2)
            add_place(scene, "%s%d" % (name, k + 1), "sit", ["meet"], [x, 0.53, z + side * 0.75], 0 if side > 0 else 180)
    scene.box("counter", None, wood, (0.0, 0, -8.9), (3.0, 0.9, -8.3))
    add_place(scene, "coffee", "stand", ["cook"], [1.5, 0, -7.95], 0)

    ceiling = scene.node("ceiling sensors", at=[0, height - 0.01, 0])
    places = [("C%d" % (k + 1), x, z) for k, (x, z) in enumerate(
        [(x, z) for z in (-3.75, -11.25) for x in (10.3, 16.9, 23.5, 30.1, 36.7)])]
    for name, x, z in [("MA", 3.5, -3.0), ("MB", 3.5, -12.0), *places]:
        add_sensor(scene, ceiling, name, "EKMC1601111", [x, 0, z], 0, 90)
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--alternative", metavar="N",
                        help="write only alternative layout N of the meeting room, or 'all'")
    parser.add_argument("--layouts", type=pathlib.Path, default=ROOT / "data/rooms/room_layouts.json")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "data/rooms", help="folder")
    arguments = parser.parse_args()
    layouts = json.loads(arguments.layouts.read_text())
    alternatives = layouts["alternatives"]

    if arguments.alternative is None:
        rooms = {"meeting_room": meeting_room(layouts["meeting_room"], "meeting room"),
                 "open_office": open_office(), "open_hall": open_hall(), "two_rooms": two_rooms(), "flat": flat(),
                 "office_floor": office_floor()}
    else:
        names = [str(n) for n in range(1, len(alternatives) + 1)]
        wanted = names if arguments.alternative == "all" else [arguments.alternative]
        if not set(wanted) <= set(names):
            parser.error("--alternative must be 1 to %d, or 'all'" % len(names))
        rooms = {"meeting_room_alt" + n: meeting_room(alternatives[int(n) - 1], "meeting room, alternative " + n)
                 for n in wanted}
    arguments.output.mkdir(parents=True, exist_ok=True)
    for name, scene in rooms.items():
        (arguments.output / (name + ".gltf")).write_text(scene.text())


if __name__ == "__main__":
    main()
