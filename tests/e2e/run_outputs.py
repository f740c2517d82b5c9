#!/usr/bin/env python3
"""Nothing that was read is written over: every output of every command on every input and every other output. Commands,
inputs and outputs are those of the program's own help, so that no new one is left out.

Usage: run_outputs.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import itertools
import os
import pathlib
import re
import shutil
import subprocess

from program import DATA, PIRSIM, Case, main

BYTES = b"what a user wrote\n"
# What a command writes into its folder, of each option; test_folders_get_what_is_listed_here says whether it's true where it
# tries, run_own_room.py of calibrate.
REPORT = "where.csv", "candidates.csv", "script_patched.yaml", "report.html", "report.json", "trail.log", "table/table.journal"
DATASET = ("README.md", "datapackage.json", "provenance.txt", "rooms.csv", "sensors.csv", "days.csv", "effects.csv",
           "dataset.journal", "rooms/room_0001.gltf", "scripts/room_0001/day_01.yaml", "rows/room_0001/day_01.csv",
           "pictures/room_0001.png")
TABLE = "table.journal", "realizations_0001.bin", "injected/table.journal"
CONTENTS = {("coverage", "--output"): ("coverage.csv",), ("dataset", "--output"): DATASET,
            ("", "--frames"): ("A1_1_1.npy",), ("run", "--frames"): ("A1_1_1.npy",), ("day", "--frames"): ("A1_1_1.npy",),
            ("calibrate", "--output"): ("recipe.yaml", "weights.csv", "counter.json", "calibration.json",
                                        "calibration.html", "pool/rows/room_0001/day_01.csv"),
            ("reconcile", "--output"): REPORT, ("reconcile plan", "--output"): ("plan.csv", "plan.html", "plan.json", "table/table.journal"),
            ("reconcile selftest", "--output"): ("selftest.csv", "selftest.md", "selftest.html"),
            ("reconcile", "--table"): TABLE, ("reconcile plan", "--table"): TABLE, ("reconcile selftest", "--table"): TABLE}
SHARDS = "merge", "DIR"
WORDS = {("data", "name"), ("effects", "name"), ("help", "command")}  # arguments that name no file


def pirsim(*args, cwd=None, data=None):
    return subprocess.run([PIRSIM, *map(str, args)], capture_output=True, text=True, timeout=300, cwd=cwd, input=data)


def help_of(command):
    return pirsim(*command, "--help").stdout.split("\nExamples:")[0]


def commands(above=()):
    text = help_of(above)
    names = re.findall(r"^  (\w+) ", text.split("Subcommands:")[1], re.M) if "Subcommands:" in text else []
    return [above, *(below for name in names for below in commands((*above, name)))]


class Option:
    def __init__(self, command, group, line):
        self.command, self.group = " ".join(command), group
        match = re.match(r"  (?:-\w,)?([\w-]+)(?: ([A-Z][\w.,/=:]*))?", line)
        self.name, self.takes = match[1], match[2] or ""
        self.is_positional = not self.name.startswith("-")
        self.is_file = not self.is_positional and re.match(r"FILE|DIR|ROWS|TEXT|PATH", self.takes) is not None

    def words(self, value):
        return [str(value)] if self.is_positional else [self.name, str(value)]


def ordered(given, rest):
    """[(option, value), ...] among other words: an option of several files takes what follows it."""
    first = [word for option, value in given if option.is_positional for word in option.words(value)]
    return first + rest + [word for option, value in given if not option.is_positional for word in option.words(value)]


def needed(command, *given):
    """Words that the command asks for beside the given options, before it looks at any file."""
    words = []
    while True:
        told = pirsim(*command, *ordered([(option, "nowhere") for option in given], words)).stderr
        if flag := re.match(r"error: \S+ requires (--\S+)", told):
            words.append(flag[1])
            continue
        asked = re.match(r"error: (\S+) is required", told)
        if asked is None:
            return words
        words = [*words, asked[1], "nowhere"] if asked[1].startswith("-") else ["nowhere", *words]


def ending_of(command, output):
    """How the name of an output must end; empty: as one likes."""
    told = pirsim(*command, *needed(command, output), *output.words("out.xyz")).stderr
    found = re.search(r"must end in (\.\w+)", told)
    return found[1] if found else ""


def options(command):
    found = []
    for section in re.split(r"\n(?=\S.*:\n)", help_of(command)):
        group, _, lines = section.partition(":\n")
        if group != "Subcommands":
            # A description that has no room stands on the next line.
            for line in re.sub(r"\n {10,}", " ", lines).splitlines():
                if line.strip():
                    found.append(Option(command, group, line))
    return found


class Declared(Case):
    def test_every_option_that_names_a_file_is_declared_as_input_or_output(self):
        all_options = [option for command in commands() for option in options(command)]
        self.assertGreater(len(all_options), 200)
        for option in all_options:
            where = option.command, option.name
            if option.group == "Positionals":
                self.assertTrue(where in WORDS or re.search("COUNTER|RECIPE|DIR|files|rows", option.name), where)
            else:
                self.assertEqual(option.is_file, option.group in ("Inputs", "Outputs"), where)
            if option.group == "Outputs" and option.takes == "DIR":
                self.assertIn(where, CONTENTS)


class Values(Case):
    NUMBERS = {"N", "M", "DEG", "P", "M2", "X", "SECOND", "SECONDS", "TIMES", "MINUTES..."}

    def test_no_option_takes_an_empty_text_or_what_is_no_number_for_its_value(self):
        tried = 0
        for command in commands():
            for option in options(command):
                if (not option.takes and not option.is_positional) or option.command == "help":
                    continue
                rest = needed(command, *([option] if option.is_file or option.is_positional else []))
                for value in ("", *(("nan", "inf", "9" * 400) if option.takes in self.NUMBERS else ())):
                    done = pirsim(*command, *ordered([(option, value)], rest))
                    self.assertEqual(done.returncode, 2, (command, option.name, value, done.stderr))
                    told = r"(the input|-\w|%s)" % re.escape(option.name) if value else "an empty text stands behind"
                    self.assertRegex(done.stderr, "^error: " + told, (command, value))
                    tried += 1
        self.assertGreater(tried, 400)


class OutputsCase(Case):
    def refused(self, *args, code=2, told="one file|one folder|one of the files of|is read as an input"):
        before = self.contents()
        done = pirsim(*args, cwd=self.folder)
        self.assertEqual((done.returncode, self.contents()), (code, before), (args, done.stderr))
        self.assertRegex(done.stderr, told, args)

    def contents(self):
        return {str(file.relative_to(self.folder)): file.read_bytes() for file in self.folder.rglob("*") if file.is_file()}

    def write(self, name, content=BYTES):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return name


class Refused(OutputsCase):
    def places(self, command, output):
        """(words, file) of each file that the output writes."""
        if output.takes == "FILE":
            file = f"own{ending_of(command, output)}"
            return [(output.words(file), file)]
        return [(output.words("out"), f"out/{name}") for name in CONTENTS[" ".join(command), output.name]]

    def test_no_output_takes_the_place_of_an_input(self):
        tried = 0
        for command in commands():
            all_options = options(command)
            inputs = [option for option in all_options if option.group == "Inputs" and option.takes != "DIR" or
                      option.group == "Positionals" and (option.command, option.name) not in {*WORDS, SHARDS}]
            for output in (option for option in all_options if option.group == "Outputs"):
                for (words, file), given in itertools.product(self.places(command, output), inputs):
                    self.write(file)
                    rest = needed(command, given, output)
                    self.refused(*command, *ordered([(given, file)], rest), *words)
                    (self.folder / file).unlink()
                    tried += 1
        self.assertGreater(tried, 150)

    def test_no_two_outputs_take_one_place(self):
        tried = 0
        for command in commands():
            outputs = [option for option in options(command) if option.group == "Outputs"]
            for one, other in itertools.permutations(outputs, 2):
                if other.takes == "DIR":
                    continue
                ending = ending_of(command, other)
                for words, file in self.places(command, one):
                    (self.folder / file).parent.mkdir(exist_ok=True, parents=True)
                    told = "one file|one of the files of" if file.endswith(ending) else "must end in"
                    rest = needed(command, one, other)
                    self.refused(*command, *rest, *words, *other.words(file), told=told)
                    tried += 1
                    if not file.endswith(ending):
                        continue
                    for name, target in self.links_to(file, ending):
                        self.refused(*command, *rest, *words, *other.words(name))
                        (self.folder / name).unlink()
                        tried += 1
        self.assertGreater(tried, 180)

    def links_to(self, file, ending):
        """Links to what isn't there yet: to the file, and to another such link by a folder's."""
        link, far = self.folder / f"link{ending}", self.folder / f"far{ending}"
        link.symlink_to(file)
        yield link.name, file
        link.symlink_to(file)
        (self.folder / "here").unlink(missing_ok=True)
        (self.folder / "here").symlink_to(".")
        far.symlink_to(f"here/{link.name}")
        yield far.name, file
        link.unlink()

    def test_every_output_has_an_ending_that_is_known(self):
        tried = 0
        for command in commands():
            for option in options(command):
                if option.group != "Outputs" or option.takes != "FILE":
                    continue
                ending = ending_of(command, option)
                self.assertTrue(ending, (command, option.name))
                for name in ("out.xyz", "out", f"{ending}x", ending):
                    self.refused(*command, *needed(command, option), *option.words(name), told=r"must end in \.\w+")
                    tried += 1
        self.assertGreater(tried, 120)

    def test_a_file_is_the_same_by_all_its_names(self):
        self.write("log.csv")
        for n, name in enumerate(("./log.csv", "sub/../log.csv", str(self.folder / "log.csv"), "hard.csv", "soft.csv", "linked/log.csv")):
            (self.folder / "sub").mkdir(exist_ok=True)
            if n == 3:
                os.link(self.folder / "log.csv", self.folder / "hard.csv")
            if n == 4:
                (self.folder / "soft.csv").symlink_to("log.csv")
            if n == 5:
                (self.folder / "linked").symlink_to(".")
            self.refused("log", "log.csv", "-o", name)
            self.refused("log", name, "-o", "log.csv")
        self.write("pool.yaml")
        (self.folder / "made").mkdir()
        (self.folder / "made/recipe.yaml").symlink_to("../pool.yaml")
        self.refused("calibrate", "pool.yaml", "--log", "log.csv", "-o", "made")
        os.link(self.folder / "log.csv", self.folder / "made/weights.csv")
        self.refused("calibrate", "pool.yaml", "--log", "log.csv", "-o", "made")
        os.remove(self.folder / "made/recipe.yaml")
        self.refused("calibrate", "nowhere.yaml", "--log", "log.csv", "-o", "linked/made")

    def test_a_shard_s_folder_a_manifest_and_what_lies_beside_rows(self):
        study = "--scene", DATA / "rooms/meeting_room.gltf", "--script"
        for option, name in (("-o", "out/shard-0001-of-0002.csv"), ("--occupants", "out/shard-0002-of-0002.csv.json")):
            rows = ("-o", "rows") if option == "--occupants" else ()
            self.refused("run", *study, self.write(name), "--shard", "1/2", *rows, option, "out")
        for name in ("rows.csv.json", "rows.csv.partial", "rows.csv.journal"):
            self.refused("run", *study, self.write(name), "-o", "rows.csv")
        self.refused("run", *study, "nowhere.yaml", "-o", "a.csv", "--occupants", "a.csv.gz")  # one journal for both
        self.refused("merge", "nowhere", "--script", self.write("all.csv.json"), "-o", "all.csv")
        for option in ("-o", "--summary"):
            shards = self.folder / self.write("shards/shard-0001-of-0001.csv")
            rest = ("-o", "rows.csv") if option == "--summary" else ()
            self.refused("merge", shards.parent, option, shards, *rest)
            self.refused("merge", shards.parent, option, shards.with_name("shard-0002-of-0002.csv"), *rest)

    def test_what_reading_finds_is_kept_too(self):
        room = DATA / "rooms/meeting_room.gltf"
        script = "pirsim_script: 1\nname: x\nduration_s: 5\nreplicates: 1\npeople: []\ntrials: [{id: S1}]\n"
        self.write("measured.csv", (DATA / "measured/stefansson2021_table1.csv").read_bytes())
        self.write("study.yaml", script + "summary: {reference: measured.csv}\n")
        for option in ("-o", "--summary", "--zones"):
            self.refused("run", "--scene", room, "--script", "study.yaml", option, "measured.csv")
        shutil.copy(room, self.folder / "own.gltf")
        self.write("recipe.yaml", "pirsim_recipe: 1\ndays: 1\nrooms:\n- {scenes: [own.gltf], count: 1}\n")
        self.refused("room", "recipe.yaml", "-o", "own.gltf")
        self.write("data/rows/room_0001/day_01.csv", "replicate,trial,time_s,phase,people,PIR1\n1,x,1,a,0,0\n")
        for file in ("rows/room_0001/day_01.csv", "rooms.csv"):
            self.write(f"data/{file}", "replicate,trial,time_s,phase,people,PIR1\n1,x,1,a,0,0\n")
            self.refused("control", "data", "-o", f"data/{file}")
        os.link(self.folder / "data/rows/room_0001/day_01.csv", self.folder / "again.csv")
        self.refused("control", "data", "--light", "again.csv")

    def test_shipped_files_streams_and_devices_are_none_of_them(self):
        log = self.write("log.csv", "time,a\n2026-03-02 08:00:00,1\n2026-03-02 08:00:10,0\n2026-03-02 08:01:00,1\n")
        for words in (("-o", "/dev/stdout"), ("-o", "/dev/null", "--report", "/dev/null"), ("-o", "rows.csv")):
            done = pirsim("log", log, "-q", *words, cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
        study = "--scene", "meeting_room.gltf", "--script", "studyA.yaml"
        done = pirsim("export", *study, "-o", "meeting_room.gltf", "--keys-per-s", 1, "--beams", "none", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)  # the shipped room is no file here


class Places(Case):
    def test_files_where_folders_are_wanted_and_folders_where_files_are(self):
        for name in ("", ".csv", ".html", ".gltf", ".png", ".yaml", ".txt"):
            (self.folder / f"is_folder{name}").mkdir()
        (self.folder / "file").write_bytes(BYTES)
        for command in commands():
            for output in (option for option in options(command) if option.group == "Outputs"):
                file = f"is_folder{ending_of(command, output)}"
                for value in (file,) if output.takes == "FILE" else ("file", "file/below"):
                    done = pirsim(*command, *needed(command, output), *output.words(value), cwd=self.folder)
                    self.assertEqual(done.returncode, 4, (command, output.name, done.stderr))
                    self.assertIn("can't write: ", done.stderr)
        self.assertEqual((self.folder / "file").read_bytes(), BYTES)

    def test_links_to_nothing_and_a_data_folder_that_is_not_there(self):
        for name in ("meeting_room.gltf", "studyA.yaml"):
            (self.folder / name).symlink_to("nowhere")
            done = pirsim("check", "--scene", "meeting_room.gltf", "--script", "studyA.yaml", cwd=self.folder)
            self.assertEqual(done.returncode, 4)
            self.assertIn(f"{name}: error: is a link to a file that isn't there", done.stderr)
            os.remove(self.folder / name)
        done = subprocess.run([PIRSIM, "check", "--scene", "meeting_room.gltf"], capture_output=True, text=True,
                              cwd=self.folder, env={**os.environ, "PIRSIM_DATA_DIR": "nowhere"})
        self.assertEqual(done.returncode, 4)
        self.assertIn("nowhere: error: PIRSIM_DATA_DIR: there is no such folder", done.stderr)


class Contents(OutputsCase):
    """Whatever a command really puts into a folder is kept if it is an input of the next call."""

    def test_folders_get_what_is_listed_here(self):
        room, coarse = "meeting_room.gltf", ("--set", "spacing_m=2", "--set", "duration_s=2")
        study = "--scene", room, "--script", "studyA.yaml", "--set", "trials.for_each.seat=[S8]"
        shutil.copy(pathlib.Path(__file__).resolve().parents[1] / "support/short_recipe.yaml", self.folder)
        for folder, args, tries in (
                ("maps", ("coverage", "--scene", room, "--script", "studyB.yaml", *coarse, "-o"), ("--marks",)),
                ("shards", ("run", *study, "--shard", "1/1", "-o"), ("--marks",)),
                ("data", ("dataset", "short_recipe.yaml", "-o"), ())):
            done = pirsim(*args, folder, cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            files = [file for file in self.contents() if file.startswith(f"{folder}/")]
            self.assertTrue(files)
            for file in files:
                if folder == "data":  # its one input is the recipe, which may be the one that lies there
                    if file != "data/recipe.yaml":
                        self.refused("dataset", file, "-o", folder)
                else:
                    self.refused(*args, folder, *tries, file)


if __name__ == "__main__":
    main()
