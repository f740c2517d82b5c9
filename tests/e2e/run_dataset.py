#!/usr/bin/env python3
"""Rooms and datasets from the command line.

Usage: run_dataset.py PIRSIM DATA_DIR TOOLS_DIR [unittest arguments]. Needs python3 only.
"""
import filecmp
import gzip
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import time

from program import DATA, PIRSIM, Case, main, pirsim

TOOLS = pathlib.Path(sys.argv[3]).resolve()
SHORT = pathlib.Path(__file__).resolve().parents[1] / "support/short_recipe.yaml"


def differing(one, other):
    """Names of files that aren't the same in both folders."""
    names = {p.relative_to(root) for root in (one, other) for p in root.rglob("*") if p.is_file()}
    _, mismatch, errors = filecmp.cmpfiles(one, other, names, shallow=False)
    return mismatch + errors


class Room(Case):
    def test_a_room_is_drawn_checked_and_looked_at(self):
        pirsim("room", "--kind", "meeting", "--width", 6, "--depth", 4.6, "--seats", 6, "-o", self.folder / "a.gltf")
        pirsim("room", "--kind", "meeting", "--width", 6, "--depth", 4.6, "--seats", 6, "-o", self.folder / "b.gltf", "-q")
        self.assertEqual((self.folder / "a.gltf").read_bytes(), (self.folder / "b.gltf").read_bytes())
        script = self.folder / "day.yaml"
        script.write_text("pirsim_script: 1\npeople: [{id: a, actions: [{enter: door}, {sit: S6}, {work: {}}]}]\n")
        text = pirsim("check", "--scene", self.folder / "a.gltf", "--script", script, "--sensors", DATA / "sensors").stdout
        self.assertIn("6 seats", text)
        self.assertIn("floor 27.60 m2", text)
        pirsim("preview", "--scene", self.folder / "a.gltf", "--script", script, "--sensors", DATA / "sensors", "--width",
               160, "--height", 90, "-o", self.folder / "a.png")

    def test_faults_name_the_nearest(self):
        self.assertIn("did you mean 'office'", pirsim("room", "--kind", "ofice", "-o", "x.gltf", code=2).stderr)
        self.assertIn("did you mean 'seats'", pirsim("room", "--set", "seat=3", "-o", "x.gltf", code=2).stderr)
        self.assertIn("no place for", pirsim("room", "--width", 2, "--depth", 2, "--seats", 9, "-o", "x.gltf",
                                             code=5).stderr)


class Home(Case):
    def test_a_flat_is_drawn_checked_and_lived_in(self):
        keys = "--rooms", 2, "--residents", 2, "--sensors-at", "doorway", "--number", 4
        told = pirsim("room", "--home", *keys, "-o", self.folder / "a.gltf").stderr
        self.assertIn("for 2 residents, rooms living_room", told)
        self.assertIn("PIR_bath_door (AMN33111)", told)
        pirsim("room", "--home", *keys, "-o", self.folder / "b.gltf", "-q")
        self.assertEqual((self.folder / "a.gltf").read_bytes(), (self.folder / "b.gltf").read_bytes())
        home = "run", "--scene", self.folder / "a.gltf", "--home", 2, "--days", 1, "--sensors", DATA / "sensors"
        script = self.folder / "day.yaml"
        script.write_text(pirsim(*home, "--print-config").stdout)
        checked = pirsim("check", "--scene", self.folder / "a.gltf", "--script", script, "--sensors", DATA / "sensors")
        self.assertNotIn("warning", checked.stderr)
        self.assertIn("doors: front", checked.stdout)

    def test_faults_name_the_nearest(self):
        self.assertIn("did you mean 'corridor'", pirsim("room", "--home", "--layout", "coridor", "-o", "x.gltf", code=2).stderr)
        self.assertIn("did you mean 'residents'", pirsim("room", "--home", "--set", "resident=3", "-o", "x.gltf", code=2).stderr)
        self.assertIn("--rooms 5", pirsim("room", "--home", "--rooms", 5, "-o", "x.gltf", code=2).stderr)
        self.assertIn("none of 300 flats", pirsim("room", "--home", "--rooms", 1, "--size", 20, "--residents", 5, "-o", "x.gltf",
                                                  code=5).stderr)
        recipe = DATA / "recipes" / "homes.yaml"
        self.assertIn("isn't a home", pirsim("room", "--home", DATA / "recipes" / "tiny.yaml", "-o", "x.gltf", code=2).stderr)
        self.assertIn("--rooms requires --home", pirsim("room", "--rooms", 2, "-o", "x.gltf", code=2).stderr)
        self.assertIn("--home excludes --kind", pirsim("room", "--home", "--kind", "office", "-o", "x.gltf", code=2).stderr)
        # a recipe says itself what its rooms are
        files = [self.folder / name for name in ("a.gltf", "b.gltf")]
        pirsim("room", "--home", recipe, "-o", files[0], "-q")
        pirsim("room", recipe, "-o", files[1], "-q")
        self.assertEqual(files[0].read_bytes(), files[1].read_bytes())


class Dataset(Case):
    def test_more_people_than_seats_are_told_once(self):
        recipe = SHORT.read_text()
        self.assertIn("people: [1, 2]", recipe)
        file = self.folder / "many.yaml"
        for people, told in (("people: [1, 2]", 0), ("people: 7", 1)):
            file.write_text(recipe.replace("people: [1, 2]", people))
            said = pirsim("dataset", file, "-o", self.folder / people[-2:], "--shard", "1/2").stderr
            self.assertEqual(said.count("should have 7 at least, but has only "), told, said)

    def test_shards_make_what_one_process_makes(self):
        recipe = SHORT
        one, other = self.folder / "one", self.folder / "other"
        pirsim("dataset", recipe, "-o", one)
        self.assertIn("2 of 4", pirsim("dataset", recipe, "-o", other, "--shard", "2/2").stderr)
        self.assertIn("2 of 4", pirsim("dataset", recipe, "-o", other, "--finish", code=3).stderr)
        self.assertIn("--finish", pirsim("dataset", recipe, "-o", other, "--shard", "1/2").stderr)
        pirsim("dataset", recipe, "-o", other, "--finish")
        self.assertEqual(differing(one, other), [])
        pirsim("dataset", recipe, "-o", other, "--resume", "-q")
        self.assertEqual(differing(one, other), [])
        # Two machines without a common self.folder: what each of them made is copied into one.
        merged = self.folder / "merged"
        for shard in ("1/2", "2/2"):
            machine = self.folder / f"machine {shard[0]}"
            pirsim("dataset", recipe, "-o", machine, "--shard", shard, "-q")
            shutil.copytree(machine, merged, dirs_exist_ok=True)
        pirsim("dataset", recipe, "-o", merged, "--finish")
        self.assertEqual(differing(one, merged), [])

        check = subprocess.run([sys.executable, TOOLS / "validate_dataset", one], capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

        # A day can be run again from what lies there, and gives the same bits.
        rows = gzip.open(one / "rows/room_0002/day_01.csv.gz", "rt").read().splitlines()
        again = pirsim("--scene", one / "rooms/room_0002.gltf", "--script", one / "scripts/room_0002/day_01.yaml",
                       "--replicates", 1, "--sensors", DATA / "sensors").stdout.splitlines()
        bits = [line.split(",")[8:] for line in rows[1:]]
        self.assertEqual(bits, [line.split(",")[-len(bits[0]):] for line in again[1:]])
        self.assertEqual([line.split(",")[4] for line in rows[1:]], [line.split(",")[5] for line in again[1:]])

        pirsim("room", recipe, "--number", 2, "-o", self.folder / "second.gltf")
        self.assertEqual((self.folder / "second.gltf").read_bytes(),
                         (one / "rooms/room_0002.gltf").read_bytes())

        # Nor does preview need anything else.
        pirsim("preview", "--scene", one / "rooms/room_0001.gltf", "--script", one / "scripts/room_0001/day_01.yaml",
               "--time", 300, "--width", 160, "--height", 90, "--sensors", DATA / "sensors", "-o",
               self.folder / "morning.png")

        # What is missing is told, and made again as it was.
        lost = one / "rows/room_0002/day_01.csv.gz"
        bytes_before = lost.read_bytes()
        lost.unlink()
        check = subprocess.run([sys.executable, TOOLS / "validate_dataset", one], capture_output=True, text=True)
        self.assertEqual((check.returncode, check.stderr), (1, ""))
        self.assertIn(f"{lost} is missing: pirsim dataset RECIPE -o {one} --resume", check.stdout)
        pirsim("dataset", recipe, "-o", one, "--resume", "-q")
        self.assertEqual(lost.read_bytes(), bytes_before)

        # What is damaged is told.
        (one / "rooms.csv").write_text("room\n")
        check = subprocess.run([sys.executable, TOOLS / "validate_dataset", one], capture_output=True, text=True)
        self.assertEqual(check.returncode, 1)
        self.assertIn("rooms.csv", check.stdout)
        package = json.loads((one / "datapackage.json").read_text())
        self.assertIn("train", [resource["name"] for resource in package["resources"]])

    def made(self, folder):
        """A dataset whose days are made and that isn't described yet."""
        pirsim("dataset", SHORT, "-o", folder, "--shard", "1/1", "-q")

    def test_a_recipe_of_which_something_is_changed_is_another_one(self):
        recipe = SHORT
        out = self.folder / "out"
        pirsim("dataset", recipe, "-o", out, "--response", "zones", "--shard", "1/4", "-q")
        self.assertTrue((out / "recipe.yaml").read_text().endswith("\n# --set sensing.response=zones\n"))
        self.assertIn("response: zones", (out / "scripts/room_0001/day_01.yaml").read_text())
        self.assertIn("holds another dataset", pirsim("dataset", recipe, "-o", out, "--shard", "2/4", code=3).stderr)
        pirsim("dataset", recipe, "-o", out, "--set", "sensing.response=zones", "--shard", "2/4", "-q")

    def test_a_room_that_was_edited_is_refused(self):
        self.made(self.folder)
        file = self.folder / "rooms/room_0001.gltf"
        as_made, scene = file.read_bytes(), json.loads(file.read_text())
        sensor = next(n for n in scene["nodes"] if n.get("extras", {}).get("pirsim", {}).get("type") == "sensor")
        if "translation" in sensor:
            sensor["translation"][1] -= 0.5
        else:
            sensor["matrix"][13] -= 0.5
        # As long as before: sizes alone would tell nothing.
        file.write_text(json.dumps(scene, separators=(",", ":")).ljust(len(as_made)))
        self.assertEqual(file.stat().st_size, len(as_made))
        for how in ("--resume", "--finish"):
            told = pirsim("dataset", SHORT, "-o", self.folder, how, "-q", code=3).stderr
            self.assertIn("room_0001.gltf: error: ", told)
            self.assertIn("move it away", told)
        self.assertFalse((self.folder / "datapackage.json").exists())
        file.write_bytes(as_made)
        pirsim("dataset", SHORT, "-o", self.folder, "--finish", "-q")

    def test_an_altered_bit_of_rows_is_made_again(self):
        self.made(self.folder)
        file = self.folder / "rows/room_0002/day_02.csv.gz"
        as_made = file.read_bytes()
        altered = bytearray(as_made)
        altered[len(altered) // 2] ^= 1
        file.write_bytes(altered)
        told = pirsim("dataset", SHORT, "-o", self.folder, "--finish", "-q", code=3).stderr
        self.assertIn("day_02.csv.gz: error: isn't what was written", told)
        pirsim("dataset", SHORT, "-o", self.folder, "--resume", "-q")
        self.assertEqual(file.read_bytes(), as_made)

    def test_a_second_process_is_refused_in_words(self):
        for i in range(4):
            command = [PIRSIM, "dataset", SHORT, "-o", self.folder / str(i), "--shard",
                       "1/2", "--resume", "-q"]
            both = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(2)]
            ends = [(process.communicate(timeout=300)[1], process.returncode) for process in both]
            for told, code in ends:  # the second may have come when the first was done
                self.assertTrue((code, told) == (0, "") or (code == 4 and "another process is at work" in told),
                                (code, told))
            self.assertIn(0, [code for _, code in ends])
            self.assertEqual(list(self.folder.rglob("*.lock")) + list(self.folder.rglob("*writing*")), [])

    def test_a_signal_in_the_last_phase_is_one_of_any_phase(self):
        recipe = SHORT.read_text().replace("count: 1,", "count: 8,", 1)
        (self.folder / "many.yaml").write_text(recipe)
        command = [PIRSIM, "dataset", self.folder / "many.yaml", "-o", self.folder / "D", "-q"]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 200
        while not (self.folder / "D/pictures").exists() and process.poll() is None and time.monotonic() < until:
            time.sleep(0.002)
        process.send_signal(signal.SIGTERM)
        told = process.communicate(timeout=200)[1]
        self.assertEqual(process.returncode, 75, told)
        self.assertIn("continue with --finish", told)
        pirsim("dataset", self.folder / "many.yaml", "-o", self.folder / "D", "--finish", "-q")

    def test_the_shipped_recipes_are_read(self):
        for recipe in (DATA / "recipes").glob("*.yaml"):
            # An empty shard of many reads the recipe and all it names.
            pirsim("dataset", recipe, "-o", self.folder / recipe.stem, "--shard", "1/1000")

    def test_a_hostile_recipe_is_told_by_its_line(self):
        recipe = self.folder / "recipe.yaml"
        recipe.write_text("pirsim_recipe: 1\nrooms:\n  - {kind: ofice}\n")
        fault = pirsim("dataset", recipe, "-o", self.folder / "out", code=3).stderr
        self.assertIn("recipe.yaml:3:12: error:", fault)
        self.assertIn("office", fault)

    def test_a_recipe_that_can_not_be_followed_claims_no_folder(self):
        room = (DATA / "rooms/meeting_room.gltf").read_text()
        (self.folder / "room.gltf").write_text(room.replace("EKMC1604111", "EKMC1604119"))
        (self.folder / "recipe.yaml").write_text("pirsim_recipe: 1\nrooms:\n  - {scenes: [room.gltf]}\npeople: 2\n")
        fault = pirsim("dataset", self.folder / "recipe.yaml", "-o", self.folder / "out", code=3).stderr
        self.assertIn("did you mean 'EKMC1604111'?", fault)
        self.assertFalse((self.folder / "out").exists())
        short = SHORT.read_text()
        for change, code, told in (
                (("count: 1,", "count: 1, sensors: [{mount: corner, model: EKMC1601119}],"), 3, "did you mean"),
                (("seats: [1, 2]", "seats: 30"), 5, "none of"),
                (("effects:", "effects:\n  - {dead_sensor: {sensor: PIR9}, per: room}"), 3, "PIR9")):
            self.assertIn(change[0], short)
            (self.folder / "recipe.yaml").write_text(short.replace(*change, 1))
            self.assertIn(told, pirsim("dataset", self.folder / "recipe.yaml", "-o", self.folder / "out", code=code).stderr)
            self.assertFalse((self.folder / "out").exists(), change)

    def test_what_lies_in_a_folder_is_not_replaced(self):
        shutil.copy(SHORT, self.folder / "recipe.yaml")
        for mine in ("README.md", "rooms.csv"):
            (self.folder / mine).write_text("mine")
            told = pirsim("dataset", self.folder / "recipe.yaml", "-o", self.folder, "--shard", "1/4", code=3).stderr
            self.assertIn(f"{mine}: error: is there already, and of no dataset", told)
            self.assertEqual((self.folder / mine).read_text(), "mine")
            (self.folder / mine).unlink()
        pirsim("dataset", self.folder / "recipe.yaml", "-o", self.folder, "--shard", "1/4", "-q")  # beside its recipe
        room = self.folder / "rooms/room_0001.gltf"
        room.write_bytes(room.read_bytes() + b"\n")
        for more in ((), ("--resume",)):
            told = pirsim("dataset", self.folder / "recipe.yaml", "-o", self.folder, "--shard", "1/4", *more, code=3).stderr
            self.assertIn("room_0001.gltf: error: isn't what this recipe makes", told)


if __name__ == "__main__":
    main(first=4)
