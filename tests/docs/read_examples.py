#!/usr/bin/env python3
"""Lets pirsim read every example of a file on the pages of docs/formats and docs/howto. What is shown can be copied.

  ```yaml                    is a whole file: a script, a recipe, a sensor, placements, nuisance, marks, a map of a log
  ```json                    is a whole scene
  ```csv file=NAME           lies where the scripts after it look for it
  ```yaml part of script     is put into a script, or `part of sensor` into a sensor file
  ```yaml not read: REASON   can't be read

Marks of a scene in a line of `code`, {"type": ...} or {"pirsim": ...}, are put on a node or a material, and the actions
in the tables of script.md are done in the meeting room, or in the flat if they are at a place of it.

Usage: read_examples.py PIRSIM SOURCE_DIRECTORY [PAGE...]
"""
import base64
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from pages import blocks

SCRIPT = """pirsim_script: 1
people: [{id: p, actions: [{enter: door}, {wait_s: 1}]}]
"""
SENSOR = """id: FRAME
plane_m: 2.5
range_m: 5
layout: square
facets: [{x_m: 0, y_m: 0, zone_side_m: 0.3}]
"""
# What an action needs before it.
BEFORE = {"enter": (), "appear": (), "follow": (), "work": ("enter: door", "sit: S1"), "rise": ("enter: door", "sit: S1")}

PLACES = re.compile(r"\b(bed_left|sofa_left|stove)\b")


class Reader:
    """A folder as a user has it: rooms, measured data and a mesh body lie where the examples look for them."""

    def __init__(self, pirsim, source, top):
        self.pirsim, self.data, self.folder = pirsim, source / "data", top / "studies"
        for name in ("rooms", "measured", "sensors"):
            (top / name).symlink_to(self.data / name)
        (self.folder / "bodies").mkdir(parents=True)
        (self.folder / "sensors").mkdir()
        scene = json.loads((self.data / "rooms/meeting_room.gltf").read_text())
        [door] = [node for node in scene["nodes"] if marked(node).get("type") == "entrance"]
        front = json.loads(json.dumps(door))
        front["name"] = marked(front)["id"] = "front_door"
        scene["nodes"].append(front)
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
        self.room = self.write("room.gltf", json.dumps(scene))
        torso = triangle_scene([{"name": "torso", "mesh": 0}])
        self.write("bodies/anna.glb", json.dumps(torso))

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def run(self, *args):
        done = subprocess.run([self.pirsim, *map(str, args)], cwd=self.folder, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr

    def script(self, text):
        shipped = "flat.gltf" if PLACES.search(text) else "office_floor.gltf" if "{area: meeting_" in text else None
        room = self.data / "rooms" / shipped if shipped else self.room
        quicker = () if "sensing:" in text else ("--response", "zones")
        self.run("check", "-q", "--scene", room, "--script", self.write("study.yaml", text), *quicker)

    def scene(self, text):
        self.run("check", "-q", "--scene", self.write("scene.gltf", text), "--script", self.write("look.yaml", LOOK))

    def sensor(self, text):
        name = re.search(r"^id: (\S+)", text, re.M)[1]
        self.write(f"sensors/{name}.yaml", text)
        eye = {"extras": {"pirsim": {"type": "sensor", "id": "PIR1", "model": name}}, "translation": [1, 2.5, -1]}
        self.scene(json.dumps(triangle_scene([floor_node(), eye])))

    def placements(self, text):
        text = re.sub(r"\bscript: \w+\.yaml", "script: study.yaml", text)  # the page's script before it
        quicker = ("--set", "spacing_m=1", *(("--set", "search.evaluations=3") if "search:" in text else ()))
        self.run("placements", "-q", "--scene", self.room, "--script", self.write("placements.yaml", text), *quicker)

    def recipe(self, text):
        none_of_its_days = "--shard", "1/1000"
        self.run("dataset", "-q", self.write("recipe.yaml", text), "-o", f"dataset_{len(text)}", *none_of_its_days)

    def nuisance(self, text):
        (self.folder / "plan/report.json").mkdir(parents=True, exist_ok=True)  # after the nuisance, what ends the command
        done = subprocess.run([self.pirsim, "reconcile", "plan", "--scene", self.room, "--script",
                               self.write("study.yaml", SCRIPT), "--nuisance", self.write("nuisance.yaml", text), "-o", "plan"],
                              cwd=self.folder, capture_output=True, text=True, timeout=300)
        assert done.returncode == 4 and done.stderr == "plan/report.json: error: can't write: Is a directory\n", done.stderr

    def marks(self, text):
        names = ("front_glass", "Lamp_1", "Radiator.001")
        nodes = [{"name": name, "mesh": 0} for name in names] + [{"name": "Slab", "mesh": 0, "rotation": [0.5**0.5, 0, 0, 0.5**0.5]}]
        if "up: z" not in text:
            del nodes[-1]["rotation"]
        model = self.write("model.gltf", json.dumps(triangle_scene(nodes)))
        self.run("check", "-q", "--scene", model, "--marks", self.write("marks.yaml", text), "--script",
                 self.write("look.yaml", LOOK))

    def log_map(self, text):
        times = "".join(f"2026-03-02T08:{i // 2:02}:{i % 2 * 30:02},0,1,2\n" for i in range(20))
        self.write("log.csv", "timestamp,S6_PIR,S7_PIR,Room_Occupancy_Count\n" + times)
        self.run("log", "-q", "log.csv", "--map", self.write("map.yaml", text), "-o", "rows.csv")

    def rule(self, text):
        """Rows with all that the rule names."""
        listed = ", ".join(re.findall(r"sensors: \[(.*?)\]", text)) or "PIR1, PIR2"
        sensors = list(dict.fromkeys(re.findall(r"\w+", listed)))
        names = (["people_" + area for area in re.findall(r"area: (\w+)", text)] +
                 ["door_" + door for door in re.findall(r"door: (\w+)", text)] + sensors)
        rows = [["replicate", "trial", "time_s", "time", "phase", "people", *names]]
        rows += [["1", "1", str(i), f"2026-03-02T08:00:{i:02}", "occupied", "1", *("1" for _ in names)] for i in range(1, 5)]
        self.write("rows.csv", "".join(",".join(row) + "\n" for row in rows))
        self.run("control", "-q", "rows.csv", "--rule", self.write("rule.yaml", text))

    def plan(self, text):
        self.run("room", "-q", "--home", "--plan", self.write("plan.yaml", text), "-o", "flat.gltf")

    def whole(self, text):
        kinds = {"pirsim_script:": self.script, "pirsim_recipe:": self.recipe, "pirsim_nuisance:": self.nuisance,
                 "pirsim_placements:": self.placements, "pirsim_marks:": self.marks, "pirsim_log:": self.log_map,
                 "pirsim_control:": self.rule, "pirsim_plan:": self.plan, "id:": self.sensor}
        [kind] = [read for key, read in kinds.items() if text.startswith(key)]
        kind(text)

    def part(self, text, of):
        if of == "script":
            keys = re.findall(r"^(\w+):", text, re.M)
            frame = SCRIPT.splitlines(keepends=True)
            return self.script("".join(line for line in frame if line.split(":")[0] not in keys) + text)
        numbers = {*re.findall(r"(\w+): [-\d]", SENSOR + text), *re.findall(r"(pulse_signs):", text)}
        self.sensor(SENSOR + text + "sources:\n" + "".join(f'  {key}: "assumed: frame"\n' for key in sorted(numbers)))

    def inline(self, extras):
        return self.mark(extras) if "type" in extras else self.material(extras)

    def mark(self, mark):
        height_m = 0.53 if mark["type"] == "seat" else 0
        node = {"name": "marked", "mesh": 0, "translation": [0, height_m, -1], "extras": {"pirsim": mark}}
        nodes = [node] if mark["type"] == "floor" else [floor_node(), node]
        self.scene(json.dumps(triangle_scene(nodes)))

    def material(self, extras):
        scene = triangle_scene([floor_node(), {"mesh": 0}])
        scene["materials"] = [{"extras": extras}]
        scene["meshes"][0]["primitives"][0]["material"] = 0
        self.scene(json.dumps(scene))

    def action(self, text):
        plain = text.replace(", ...", "").replace("[x, z]", "[6.3, -0.6]")
        style = "natural" if "activity" in plain else "choreographed"
        steps = [*BEFORE.get(re.match(r"\w+", plain)[0], ("enter: door",)), plain]
        self.script("pirsim_script: 1\npeople:\n  - id: p\n    style: " + style + "\n    actions:\n" +
                    "".join(f"      - {step}\n" for step in steps))


LOOK = "pirsim_script: 1\npeople: []\n"


def marked(node):
    return node.get("extras", {}).get("pirsim", {})


def floor_node():
    return {"extras": {"pirsim": {"type": "floor", "polygon_xz_m": [[0, 0], [3, 0], [3, -3], [0, -3]]}}}


def triangle_scene(nodes):
    """One level triangle as mesh 0."""
    data = struct.pack("<9f", 0, 0, 0, 0.5, 0, 0, 0, 0, -0.5)
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "buffers": [{"byteLength": len(data),
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}


def examples(page, reader):
    """(line, function that reads the example) of each."""
    for block in blocks(page):
        if block.info.startswith("not read: "):
            continue
        if block.language == "csv" and block.info.startswith("file="):
            reader.write(block.info.removeprefix("file="), block.text)
        elif block.language == "json":
            yield block.line, lambda text=block.text: reader.scene(text)
        elif block.language == "yaml" and block.info.startswith("part of "):
            yield block.line, lambda block=block: reader.part(block.text, block.info.removeprefix("part of "))
        elif block.language == "yaml":
            yield block.line, lambda text=block.text: reader.whole(text)
    in_actions = False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), start=1):
        in_actions = line.startswith("|") and (in_actions or line.startswith("| action |"))
        cells = line.split("|")
        if in_actions and (shown := re.fullmatch(r" `([^`]*)` ", cells[1])):
            yield number, lambda text=shown[1]: reader.action(text)
        if page.name == "view.md":  # whose marks are those of a film that pirsim writes
            continue
        for text in re.findall(r"`[^`{]*(\{\"(?:type|pirsim)\"[^`]*\})`", line):
            yield number, lambda text=text: reader.inline(json.loads(text))


def main():
    pirsim, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    chosen = [pathlib.Path(page).resolve() for page in sys.argv[3:]]
    pages = chosen or [page for folder in ("formats", "howto") for page in sorted((source / "docs" / folder).glob("*.md"))]
    read, faults = 0, []
    for page in pages:
        with tempfile.TemporaryDirectory() as name:
            reader = Reader(pirsim, source, pathlib.Path(name))
            for line, read_it in examples(page, reader):
                read += 1
                try:
                    read_it()
                except (AssertionError, ValueError) as fault:
                    faults.append(f"{page.relative_to(source)}:{line}: this example isn't read:\n{fault}")
    print("\n".join(faults), file=sys.stderr)
    print(f"{read} examples of {len(pages)} pages, {len(faults)} faults")
    assert read > 25 or chosen, "where are the examples?"
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
