#!/usr/bin/env python3
"""The shipped rooms, studies, recipes and sensors are found by name, wherever pirsim stands.

Usage: run_shipped.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import os
import pathlib
import shutil
import subprocess

from program import DATA, PIRSIM, Case, main, run

KINDS = {"rooms": ".gltf", "plans": ".yaml", "studies": ".yaml", "recipes": ".yaml", "sensors": ".yaml",
         "measured": ".csv"}
SHORT = "--replicates", "1", "--set", "trials.for_each.seat=[S8]", "-q"


def pirsim(*args, code=0, cwd=None, program=None, data=""):
    result = subprocess.run([program or PIRSIM, *map(str, args)], capture_output=True, text=True, timeout=300, cwd=cwd,
                            env={**os.environ, "PIRSIM_DATA_DIR": str(data)})
    assert result.returncode == code, f"{args}: exit code {result.returncode}, expected {code}\n{result.stderr}"
    return result.stdout if code == 0 else result.stderr


def names_of(listing):
    """{"rooms": {"flat.gltf", ...}}, of what `pirsim data` prints."""
    names, kind = {}, None
    for line in filter(None, listing.splitlines()):
        if line.startswith("  "):
            names[kind].add(line.split()[0])
        else:
            kind = pathlib.Path(line).name
            names.setdefault(kind, set())
    return names


class Shipped(Case):
    def test_the_list_is_that_of_the_folders(self):
        there = {kind: {file.name for file in (DATA / kind).iterdir() if file.suffix == ending and
                        file.name != "ekmc1604111_zones.csv"} for kind, ending in KINDS.items()}
        self.assertEqual(names_of(pirsim("data", cwd=self.folder)), there)
        for kind, names in there.items():
            for name in names:
                path = pathlib.Path(pirsim("data", name, cwd=self.folder).strip())
                self.assertEqual(path.read_bytes(), (DATA / kind / name).read_bytes())
        self.assertIn("did you mean 'studyA.yaml'?", pirsim("data", "StudyA.yaml", code=2))

    def test_sensors_are_listed_with_their_products_and_found_by_them(self):
        listed = {line.split()[0]: line for line in pirsim("data").splitlines() if line.startswith("  ")}
        self.assertIn("long distance, 92 zones (Everything Presence One, Everything Presence Pro, EP1)",
                      listed["EKMC1603111.yaml"])
        for name, file in (("everything presence one", "EKMC1603111"), ("EP-1", "EKMC1603111"), ("hc-sr501", "HC-SR501"),
                           ("HC SR501", "HC-SR501"), ("philips hue motion sensor", "SML001"), ("AM312.yaml", "AM312")):
            self.assertEqual(pathlib.Path(pirsim("data", name).strip()).name, f"{file}.yaml")
        self.assertIn("did you mean 'Everything Presence Pro'?", pirsim("data", "everything presense pro", code=2))

    def test_a_name_gives_the_rows_of_the_file(self):
        by_name = pirsim("--scene", "meeting_room.gltf", "--script", "studyA.yaml", *SHORT, cwd=self.folder)
        self.assertEqual(by_name, pirsim("--scene", DATA / "rooms/meeting_room.gltf", "--script",
                                         DATA / "studies/studyA.yaml", *SHORT, cwd=self.folder))
        self.assertGreater(by_name.count("\n"), 180)  # a second each

    def test_a_folder_of_the_repository_that_is_not_here_is_told(self):
        told = pirsim("check", "--scene", "data/rooms/flat.gltf", code=4, cwd=self.folder)
        self.assertIn("data/rooms/flat.gltf: error: no such file; 'flat.gltf' without a folder is a shipped one", told)
        self.assertNotIn("shipped", pirsim("check", "--scene", "data/rooms/mine.gltf", code=4, cwd=self.folder))

    def test_every_command_that_reads_a_kind_takes_its_names(self):
        study = "--scene", "meeting_room.gltf", "--script", "studyA.yaml"
        for args in (("check", *study, "-q"), ("check", *study[:2], "--suggest"), ("run", *study, "--print-config"),
                     ("preview", *study, "-o", "a.png", "-q"),
                     ("view", *study, "--to", "5", "--coverage", "studyB.yaml", "-o", "run.html", "-q"),
                     ("coverage", *study[:3], "studyB.yaml", "--set", "spacing_m=1", "-o", "maps", "-q"),
                     ("walktest", *study[:3], "walk_test.yaml", "--set", "spacing_m=2", "-o", "walk.csv", "-q"),
                     ("room", "tiny.yaml", "-o", "room.gltf", "-q"),
                     ("run", *study, *SHORT, "-o", "rows.csv"), ("control", "rows.csv", *study, "-q")):
            pirsim(*args, cwd=self.folder)
        self.assertIn("--measured", pirsim("reconcile", *study, code=2))

    def test_a_file_that_is_there_wins(self):
        (self.folder / "meeting_room.gltf").write_text("{")
        told = pirsim("check", "--scene", "meeting_room.gltf", "--script", "studyA.yaml", code=3, cwd=self.folder)
        self.assertTrue(told.startswith("meeting_room.gltf:1:"), told)

    def test_a_folder_is_meant_as_it_is_given(self):
        told = pirsim("check", "--scene", "./meeting_room.gltf", "--script", "studyA.yaml", code=4, cwd=self.folder)
        self.assertEqual(told, "./meeting_room.gltf: error: no such file; 'meeting_room.gltf' without a folder is a "
                               "shipped one\n")

    def test_an_output_may_be_called_as_a_shipped_file_is(self):
        pirsim("export", "--scene", "meeting_room.gltf", "--script", "studyA.yaml", "-o", "meeting_room.gltf", "-q",
               cwd=self.folder)
        self.assertTrue((self.folder / "meeting_room.gltf").exists())

    def test_what_is_neither_is_told_with_the_nearest_name(self):
        for args, told in ((("check", "--scene", "meeting_rom.gltf", "--script", "studyA.yaml"),
                            "meeting_rom.gltf: error: no such file, nor one among the shipped rooms (did you mean "
                            "'meeting_room.gltf'?)\n"),
                           (("check", "--scene", "meeting_room.gltf", "--script", "studya.yaml"),
                            "studya.yaml: error: no such file, nor one among the shipped studies (did you mean "
                            "'studyA.yaml'?)\n"),
                           (("dataset", "tinny.yaml", "-o", "out"),
                            "tinny.yaml: error: no such file, nor one among the shipped recipes (did you mean "
                            "'tiny.yaml'?)\n")):
            self.assertEqual(pirsim(*args, code=4, cwd=self.folder), told)

    def test_a_folder_of_one_s_own_comes_first(self):
        own = self.folder / "own"
        (own / "studies").mkdir(parents=True)
        (own / "studies" / "studyA.yaml").write_text("pirsim_script: 2\n")
        (own / "studies" / "mine.yaml").write_text((DATA / "studies/studyB.yaml").read_text())
        listed = pirsim("data", data=own)
        self.assertEqual(names_of(listed)["studies"], names_of(pirsim("data"))["studies"] | {"mine.yaml"})
        self.assertEqual(pirsim("data", "studyA.yaml", data=own), f"{own}/studies/studyA.yaml\n")
        self.assertIn(f"{own}/studies/studyA.yaml:1:", pirsim("check", "--scene", "meeting_room.gltf", "--script",
                                                              "studyA.yaml", code=3, data=own))

    def test_a_copied_study_or_recipe_goes_on_working(self):
        """The room is the last to be read and isn't there: who misses it has found all else."""
        kinds = {"pirsim_script": ("check",), "pirsim_coverage": ("coverage",), "pirsim_walk_test": ("walktest",),
                 "pirsim_placements": ("placements",)}
        for study in sorted((DATA / "studies").iterdir()):
            copy = pathlib.Path(shutil.copy(study, self.folder / f"my_{study.name}"))
            command, = (args for key, args in kinds.items() if f"\n{key}: 1" in "\n" + copy.read_text())
            told = pirsim(*command, "--scene", "nowhere.gltf", "--script", copy, code=4, cwd=self.folder)
            self.assertEqual(told.splitlines()[-1].split(":")[0], "nowhere.gltf", (study, told))
            if "reference:" in copy.read_text():
                pirsim("--scene", "meeting_room.gltf", "--script", copy, *SHORT, "--summary", "sums.md", cwd=self.folder)
                self.assertIn("| S8 | real | 22 |", (self.folder / "sums.md").read_text())
        for kind, room in (("recipes", ["room"]), ("plans", ["room", "--home", "--plan"])):
            for file in sorted((DATA / kind).iterdir()):
                copy = shutil.copy(file, self.folder / f"my_{file.name}")
                self.assertIn("'x.txt' must end in", pirsim(*room, copy, "-o", "x.txt", code=2, cwd=self.folder))
                pirsim(*room, copy, "-o", "a.gltf", "-q", cwd=self.folder)

    def test_what_a_file_names_is_beside_it_or_shipped_and_has_its_place_in_messages(self):
        head = "pirsim_script: 1\nduration_s: 5\n"
        light = "pirsim_placements: 1\ntarget: {x_shapes: {}}\nsets: []\nby: false_off\nlight: {delay_min: 1, script: "
        recipe = "pirsim_recipe: 1\nrooms:\n  - scenes: ["
        run = "run", "--scene", "meeting_room.gltf", "--summary", "sums.md", "--script"
        placements = "placements", "--scene", "nowhere.gltf", "--script"
        room = "room", "-o", "room.gltf"
        (self.folder / "a_folder").mkdir()
        for args, text, name, place, fault, exit_code in (
                (run, head + "summary:\n  reference: {}\n", "stefansson2021_table1.csv", "4:14", "summary: reference", 4),
                (run, head + "occupancy: {{counts: {}}}\n", "stefansson2021_table1.csv", "3:21", "occupancy", 3),
                (run, head + "people: [{{id: a, body_mesh: {}}}]\n", "flat.gltf", "3:29", "body_mesh", 3),
                (placements, light.replace("{", "{{").replace("}", "}}") + "{}}}\n", "floor_week.yaml", "5:31",
                 "light: script", 3),
                (room, recipe + "{}]\n", "flat.gltf", "3:14", "scenes", 3)):
            file = self.folder / "named.yaml"
            for given, told in (("nowhere.x", f"there is no file '{self.folder}/nowhere.x'"),
                                ("a_folder", f"there is no file '{self.folder}/a_folder'"),
                                (f"../{name}", f"there is no file '{self.folder}/../{name}'; '{name}' without a folder "
                                               "is a shipped one"),
                                (name.replace(".", "a.", 1), f"(did you mean '{name}'?)")):
                file.write_text(text.format(given))
                refused = pirsim(*args, file, code=exit_code, cwd=self.folder)
                self.assertIn(f"{file}:{place}: error: {fault}: ", refused)
                self.assertIn(told, refused)
            file.write_text(text.format(name))
            result = subprocess.run([PIRSIM, *map(str, args), str(file)], capture_output=True, text=True,
                                    cwd=self.folder, env={**os.environ, "PIRSIM_DATA_DIR": ""})
            self.assertNotIn("no file", result.stderr)

    def test_an_installation_that_is_moved_finds_its_own(self):
        for program, data in (("usr/bin/pirsim", "usr/share/pirsim"), ("package/pirsim", "package/data")):
            (self.folder / program).parent.mkdir(parents=True)
            shutil.copy(PIRSIM, self.folder / program)
            alone = pirsim("data", code=4, program=self.folder / program)
            self.assertIn("the data that comes with pirsim isn't in '", alone)
            shutil.copytree(DATA, self.folder / data)
            self.assertEqual(pirsim("data", "flat.gltf", program=self.folder / program).strip(),
                             str(self.folder / data / "rooms/flat.gltf"))


if __name__ == "__main__":
    main()
