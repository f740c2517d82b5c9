"""Scenes of boxes with marks, for tests that need a room which no shipped file has."""
import base64
import json
import math
import struct

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def turned(yaw_deg, tilt_deg=0):
    """yaw 0 looks along -Z, positive turns left; tilt looks down."""
    yaw, tilt = math.radians(yaw_deg) / 2, -math.radians(tilt_deg) / 2
    return [math.cos(yaw) * math.sin(tilt), math.sin(yaw) * math.cos(tilt), -math.sin(yaw) * math.sin(tilt),
            math.cos(yaw) * math.cos(tilt)]


def write_scene(path, size, boxes, marks):
    """A floor from (0, 0, 0) to (size[0], 0, -size[1]); boxes: (name, lower, upper), of metres; marks: (at, rotation, what
    extras say)."""
    points = [value for corner in CORNERS for value in corner]
    sides = [index for a, b, c, d in SIDES for index in (a, b, c, a, c, d)]
    sheet = [0, 0, 0, size[0], 0, 0, size[0], 0, -size[1], 0, 0, -size[1]]
    parts = [struct.pack("<24f", *points), struct.pack("<36H", *sides), struct.pack("<12f", *sheet),
             struct.pack("<6H", 0, 1, 2, 0, 2, 3)]
    counts = [(5126, 8, "VEC3", [0, 0, 0], [1, 1, 1]), (5123, 36, "SCALAR", None, None),
              (5126, 4, "VEC3", [0, 0, -size[1]], [size[0], 0, 0]), (5123, 6, "SCALAR", None, None)]
    views, accessors, at = [], [], 0
    for part, (kind, count, shape, least, most) in zip(parts, counts):
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
        accessors.append({"bufferView": len(views) - 1, "componentType": kind, "count": count, "type": shape,
                          **({"min": least, "max": most} if least else {})})
        at += len(part)
    nodes = [{"name": "floor", "mesh": 1, "extras": {"pirsim": {"type": "floor"}}}]
    for name, lower, upper in boxes:
        nodes.append({"name": name, "mesh": 0, "translation": list(lower),
                      "scale": [high - low for low, high in zip(lower, upper)]})
    for place, rotation, extras in marks:
        nodes.append({"name": extras.get("id", extras["type"]), "translation": list(place), "rotation": rotation,
                      "extras": {"pirsim": extras}})
    blob = base64.b64encode(b"".join(parts)).decode()
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]},
                   {"primitives": [{"attributes": {"POSITION": 2}, "indices": 3}]}],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": at, "uri": "data:application/octet-stream;base64," + blob}]}), encoding="utf-8")


def write_long_office(path):
    """40 m by 12 m: a corridor of a wall with three doors, offices behind it, and desks in rows of four."""
    boxes = [("wall front", (-0.1, 0, 0), (36, 2.8, 0.1)), ("wall front right", (37, 0, 0), (40.1, 2.8, 0.1)),
             ("wall back", (-0.1, 0, -12.1), (40.1, 2.8, -12)), ("wall left", (-0.1, 0, -12), (0, 2.8, 0)),
             ("wall right", (40, 0, -12), (40.1, 2.8, 0)), ("inner wall", (20, 0, -12), (20.12, 2.8, -3)),
             ("inner wall of the corridor", (20, 0, -3.12), (30, 2.8, -3)),
             ("inner wall of the office", (30, 0, -12), (30.12, 2.8, -3))]
    marks = [((36.5, 0, 0), turned(0), {"type": "entrance", "id": "door", "width_m": 1.0})]
    for i in range(6):
        marks.append(((3 + 7 * i, 2.7, -6), turned(0, 90), {"type": "sensor", "id": f"C{i + 1}", "model": "EKMC1601111"}))
    number = 0
    for row in range(3):
        for column in range(8):
            number += 1
            x, z = 1.5 + 1.4 * column + (1.6 if column > 3 else 0), -2.4 - 3.2 * row
            boxes.append((f"desk {number}", (x - 0.6, 0.7, z - 1.0), (x + 0.6, 0.74, z - 0.3)))
            marks.append(((x, 0.53, z), turned(0), {"type": "seat", "id": f"D{number}"}))
    write_scene(path, (40, 12), boxes, marks)
