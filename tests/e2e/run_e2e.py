#!/usr/bin/env python3
"""End-to-end tests of the real binary: exit codes, messages, bytes.

Usage: run_e2e.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import base64
import gzip
import json
import pathlib
import re
import subprocess

from program import DATA, PIRSIM, Case, made_folder, main, pirsim, rows, run

HERE = pathlib.Path(__file__).resolve().parent


def study(*args, scene="meeting_room.gltf", script="studyA.yaml", **kwargs):
    return pirsim("--scene", DATA / "rooms" / scene, "--script", DATA / "studies" / script, *args, **kwargs)


def study_files(script="studyA.yaml"):
    return "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / script


# What a command needs besides the option that is tried: a script of its kind, and what it can't be without.
COMMANDS = {(): ("studyA.yaml", "-o", "rows.csv"), ("run",): ("studyA.yaml", "-o", "rows.csv"),
            ("check",): ("studyA.yaml",), ("preview",): ("studyA.yaml",), ("export",): ("studyA.yaml",),
            ("view",): ("studyA.yaml",),
            ("coverage",): ("studyB.yaml",), ("walktest",): ("walk_test.yaml",), ("placements",): ("placements.yaml",),
            ("reconcile",): ("studyA.yaml", "--measured", "m.csv"), ("reconcile", "plan"): ("studyA.yaml",),
            ("reconcile", "selftest"): ("studyA.yaml",)}
OTHERS = {("data",): (),
          ("merge",): ("shards", "-o", "rows.csv", "--script", "other.yaml"), ("effects",): (), ("help",): (),
          ("log",): ("nowhere.csv",), ("calibrate",): ("recipe.yaml", "--log", "nowhere.csv", "-o", "out"),
          ("count",): ("counter.json", "--log", "nowhere.csv"), ("control",): ("--log", "nowhere.csv"),
          ("room",): ("-o", "room.gltf"), ("dataset",): ("recipe.yaml", "-o", "out")}
# Of runs without a script.
DAYS = "--staff", "--meetings", "--home", "--days", "--first-day", "--from", "--to", "--cleaning"
FLAT_VALUES = {"--rooms": "2", "--residents": "1", "--size": "60", "--layout": "hall", "--sensors-at": "doorway",
               "--mount": "ceiling", "--model": "EKMC1601111", "--plan": "my_flat.yaml"}
ROOM_VALUES = {"--set": "l_shaped=0.3", "--kind": "meeting", "--desks": "rows", "--width": "6", "--height": "3",
               "--depth": "5", **FLAT_VALUES}
VALUES = {"--set": "name=other", "--response": "zones", "--marks": "marks.yaml", "--sensors": ".", "--tracer": "direct", "--report": "page.html", "--by-day": "days.csv", "--advised": "advised.yaml", "--by-hour": "hours.csv", "--format": ".csv",
          "--summary": "sums.csv", "--zones": "zones.csv", "--trace": "trace.csv",
          "--occupants": "occupants.csv", "--casas": "log.txt", "--shard": "1/2", "--max-time": "5m",
          "--trial": "S1", "--beams": "all", "--labels": "seats", "--camera": "0,5,0", "--look-at": "1,0,1", "--width": "64",
          "--height": "64", "--measured": "m.csv", "--holdout": "0.3", "--table": "table", "--nuisance": "none",
          "--alpha": "0.05", "--effects": "dead_time", "--data": "sums", "--leave-out": "effects",
          "--script": "other.yaml", "--first-day": "2026-03-03", "--from": "09:00", "--to": "10:00",
          "--cleaning": "none", "--time-zone": "Europe/Berlin", "--light": "lit.csv"}
OUTPUTS = {"check": "marks.yaml", "preview": "room.png", "export": "run.glb", "view": "run.html", "coverage": "maps", "walktest": "points.csv",
           "placements": "better.gltf"}


# Each option that names an output, with one: what a command then says that it wrote, on standard error.
ROOM = "--scene", "meeting_room.gltf"
STUDY = *ROOM, "--script", "studyA.yaml", "--set", "trials.for_each.seat=[S8]", "--set", "begin=2026-03-02T08:00:00"
SHORT = *STUDY, "--replicates", 1
COARSE = "--set", "spacing_m=2", "--set", "duration_s=2"
WRITTEN = {("run",): ((*SHORT, "-o", "rows.csv", "--summary", "sums.md", "--report", "run.html", "--zones", "zones.csv",
                       "--occupants", "who.csv"),
                      "rows.csv sums.md run.html zones.csv who.csv"),
           ("check",): ((*ROOM, "--suggest", "-o", "marks.yaml"), "marks.yaml"),
           ("preview",): ((*STUDY, "--width", 64, "--height", 64, "-o", "room.png"), "room.png"),
           ("export",): ((*STUDY, "-o", "run.glb"), "run.glb"), ("view",): ((*STUDY, "--to", 5, "-o", "v.html"), "v.html"),
           ("coverage",): ((*ROOM, "--script", "studyB.yaml", *COARSE, "-o", "maps", "--report", "maps.html"),
                           "maps/coverage.csv maps.html"),
           ("walktest",): ((*ROOM, "--script", "walk_test.yaml", *COARSE[:2], "-o", "walk.csv", "--report", "walk.html"),
                           "walk.csv walk.html"),
           ("placements",): ((*ROOM, "--script", "placements.yaml", *COARSE, "--set", "search.evaluations=2",
                              "-o", "best.gltf", "--report", "sets.html"),
                             "best.gltf sets.html"),
           ("room",): (("-o", "room.gltf"), "room.gltf"),
           ("control",): (("rows.csv", "-o", "costs.csv", "--light", "lit.csv", "--report", "light.html"),
                          "costs.csv lit.csv light.html"),
           ("log",): (("log.csv", "-o", "log_rows.csv", "--report", "log.html"), "log_rows.csv log.html"),
           ("merge",): (("shards", "-o", "all.csv", *STUDY[2:], "--summary", "all.md"), "all.csv all.md")}
# Take minutes.
SLOW = {("reconcile",), ("reconcile", "plan"), ("reconcile", "selftest"), ("dataset",), ("calibrate",),
        ("count",), ()}


def options_of(command):
    """What the help offers: {"--seed": "N", "--resume": None}."""
    lines = pirsim(*command, "--help").stdout.splitlines()
    found = (re.match(r"  (?:-\w,)?(--[\w-]+)(?: (\S+))?(?:  |$)", line) for line in lines)
    return {match[1]: match[2] for match in found if match}


def value_of(command, option):
    if option == "--output":
        return OUTPUTS.get(command[0], "x")
    if command == ("effects",) and option == "--format":
        return "csv"
    if command == ("room",) and option in ROOM_VALUES:
        return ROOM_VALUES[option]
    return VALUES.get(option, "1")


def with_folder(option, words):
    """A shard's output is a folder, and not named as a file."""
    return [word.removesuffix(".csv") if option in ("--shard", "--format") else word for word in words]


class Options(Case):
    def test_the_tables_above_name_every_command(self):
        def below(command):
            text = pirsim(*command, "--help").stdout
            if "Subcommands:" not in text:
                return {command}
            names = re.findall(r"^  (\w+) ", text.split("Subcommands:")[1].split("Examples:")[0], re.M)
            return {command}.union(*(below((*command, name)) for name in names))
        self.assertEqual(below(()), {*COMMANDS, *OTHERS})

    def test_every_command_says_what_it_wrote_unless_it_is_to_be_quiet(self):
        makers = {command for command in {*COMMANDS, *OTHERS}
                  if "--output" in options_of(command)}
        self.assertEqual(makers, {*WRITTEN, *SLOW})
        self.write("log.csv", "time,a\n2026-03-02 08:00:00,1\n2026-03-02 08:00:10,0\n2026-03-02 08:01:00,1\n")
        pirsim(*SHORT, "--shard", "1/1", "-o", "shards", "-q", cwd=self.folder)
        for command, (args, files) in WRITTEN.items():
            told = pirsim(*command, *args, cwd=self.folder).stderr
            line = [line for line in told.splitlines() if line.startswith("wrote ")]
            self.assertEqual(len(line), 1, (command, told))
            for file in files.split():
                self.assertRegex(line[0], rf"(wrote |, ){re.escape(file)}(?=[:,]|$)", command)
                self.assertTrue((self.folder / file).exists(), file)
            (self.folder / "marks.yaml").unlink(missing_ok=True)  # is never overwritten
            self.assertNotIn("wrote", pirsim(*command, *args, "-q", cwd=self.folder).stderr, command)

    def test_no_command_offers_an_option_that_it_refuses(self):
        """The room is the last to be read and isn't there: who gets that far has taken option and script."""
        for command, (script, *rest) in COMMANDS.items():
            offered = options_of(command)
            self.assertIn("--scene", offered)
            for option, takes in offered.items():
                if option in ("--help", "--version", "--scene", "--script") or option in rest:
                    continue
                if option in ("--output", "--print-config") and "-o" in rest:
                    continue
                value = () if takes is None else (value_of(command, option),)
                if option == "--format":
                    value += "--shard", "1/2"
                if option == "--frame":
                    value += "--frames", "frames"
                if command == ("check",) and option in ("--floor", "--ignore", "--output"):
                    value += "--suggest",
                needed = with_folder(option, rest)
                study_of = "--script", DATA / "studies" / script
                if option in DAYS and command in ((), ("run",)):
                    study_of = () if option in ("--staff", "--home") else ("--staff", 2)
                result = pirsim(*command, "--scene", "nowhere.gltf", *study_of, *needed, option, *value, code=4,
                                cwd=self.folder)
                self.assertIn("nowhere.gltf", result.stderr, (command, option))
        for command, rest in OTHERS.items():
            for option, takes in options_of(command).items():
                if option == "--help" or option in rest or option == "--output":
                    continue
                value = () if takes is None else (value_of(command, option),)
                needed = (*rest, "--home") if option in FLAT_VALUES else rest[:1] if option == "--status" else rest
                result = subprocess.run([PIRSIM, *command, *needed, option, *value], capture_output=True, text=True,
                                        cwd=self.folder)
                self.assertNotEqual(result.returncode, 2, (command, option, result.stderr))

    def test_no_command_offers_an_option_that_would_do_nothing(self):
        for command, unused in ((("coverage",), ("--replicates", "--tracer", "--verbose")),
                                (("walktest",), ("--replicates", "--tracer")),
                                (("placements",), ("--replicates", "--tracer")), (("preview",), ("--replicates",)),
                                (("export",), ("--replicates",)), (("check",), ("--seed", "--threads")),
                                (("reconcile",), ("--seed", "--replicates", "--tracer")),
                                (("effects",), ("--scene", "--quiet"))):
            self.assertTrue(options_of(command).keys().isdisjoint(unused), command)
            for option in unused:
                self.assertIn(option, pirsim(*command, option, 1, code=2).stderr)
                self.assertIn(option, pirsim(option, *((1,) if option not in ("--quiet", "--verbose") else ()),
                                             *command, code=2).stderr)

    def test_the_seed_of_a_survey_can_be_overridden(self):
        def map_of(*args):
            pirsim("coverage", *study_files("studyB.yaml"), "-q", "--set", "spacing_m=0.5", "--set",
                   "effects=[{missed_triggers: {probability: 0.5}}]", *args, "-o", self.folder)
            return (self.folder / "coverage.csv").read_bytes()
        self.assertEqual(map_of("--seed", 5), map_of("--set", "seed=5"))
        self.assertNotEqual(map_of("--seed", 5), map_of("--seed", 6))

    def test_the_response_is_a_setting_like_others(self):
        for given in (study_files(), ("--scene", "room.gltf", "--staff", 1)):
            for word in ("zones", "analog"):
                config = pirsim("run", *given, "--print-config", "--response", word).stdout
                self.assertIn(f"response: {word}\n", config)
                self.assertEqual(config, pirsim("run", *given, "--print-config", "--set", f"sensing.response={word}").stdout)
        self.assertIn("error: --response: 'zone' isn't a response (did you mean 'zones'?)",
                      pirsim("check", *study_files(), "--response", "zone", code=2).stderr)

    def test_options_before_a_command_count_as_after_it(self):
        after = pirsim("check", *study_files(), "--replicates", 3).stdout
        self.assertIn("10 trials x 3 replicates", after)
        self.assertEqual(pirsim(*study_files(), "--replicates", 3, "check").stdout, after)
        scene, script = study_files()[:2], study_files()[2:]
        self.assertIn("--measured", pirsim(*scene, "reconcile", *script, "--measured", "x", "plan", code=2).stderr)
        refused = pirsim("-o", "room.png", "preview", *study_files(), code=2).stderr
        self.assertIn("--output must stand after 'preview'", refused)

    def test_words_of_an_earlier_version_do_the_same_and_are_not_in_the_help(self):
        self.write("log.csv", "time,a\n2026-03-02 08:00:00,1\n2026-03-02 08:00:10,0\n2026-03-02 08:01:00,1\n")
        pirsim(*SHORT, "--shard", "1/2", "-o", "shards", "-q", cwd=self.folder)
        day = *ROOM, "--staff", 1, "--days", 1, "--from", "08:00", "--to", "08:10"
        for old, now in ((("day", *day), ("run", *day)),
                         (("day", *day, "--print-script"), ("run", *day, "--print-config")),
                         (("status", "shards"), ("merge", "shards", "--status")),
                         (("home", "-o", "a.gltf"), ("room", "--home", "-o", "a.gltf")),
                         (("log", "log.csv", "--window", 5, "-o", "b.csv"), ("log", "log.csv", "--step", 5, "-o", "b.csv")),
                         (("reconcile", *ROOM, "--script", "studyA.yaml", "--measured", "a.gltf", "--out", "log.csv"),
                          ("reconcile", *ROOM, "--script", "studyA.yaml", "--measured", "a.gltf", "-o", "log.csv"))):
            code = 4 if old[0] == "reconcile" else 0
            with self.subTest(old=old):
                one, other = (pirsim(*words, cwd=self.folder, code=code) for words in (old, now))
                self.assertEqual((one.stdout, one.stderr), (other.stdout, other.stderr))
                text = pirsim(*now[:1], "--help").stdout + pirsim("--help").stdout
                for word in {*map(str, old)} - {*map(str, now)}:
                    self.assertNotRegex(text, rf"(\n  |,){word}[ ,]", word)
        self.assertNotIn("--tracer", pirsim("--help").stdout)
        self.assertEqual(pirsim("help", "home").stdout.splitlines()[2:], pirsim("help", "room").stdout.splitlines()[2:])

    def test_an_option_given_twice_is_said_to_be(self):
        for args in (("--seed", 1, "--seed", 2), ("--seed", 1, "run", "--seed", 2), ("run", "--seed", 1, "--seed", 2)):
            self.assertEqual(pirsim(*args, *study_files(), code=2).stderr, "error: --seed is given twice\n")
        twice = pirsim("reconcile", "plan", "--runs", 1, "--runs", 2, code=2).stderr
        self.assertEqual(twice, "error: --runs is given twice\n")
        study("--set", "seed=1", "--set", "replicates=2", "--print-config")

    def test_every_refusal_begins_as_one(self):
        for args in (("--seed", "x"), ("preview", "--labels", "chairs"), ("preview", "--width", 5), ("check", "--scene"),
                     ("merge",), ("reconcile", "plan", "--runs", "many")):
            refused = pirsim(*args, code=2).stderr
            self.assertTrue(refused.startswith("error: "), refused)

    def test_what_is_missing_is_told_with_the_command_s_own_help(self):
        for command in ((), ("run",), ("check",), ("reconcile", "plan")):
            self.assertEqual(pirsim(*command, code=2).stderr,
                             f"error: --scene FILE is missing; see {' '.join(('pirsim', *command))} --help\n")

    def test_quiet_and_verbose_exclude_each_other(self):
        for args in (("-q", "-v"), ("-v", "-q"), ("-q", "run", "-v"), ("run", "--verbose", "--quiet")):
            result = pirsim(*args, *study_files(), code=2)
            self.assertIn("--quiet and --verbose", result.stderr)
            self.assertEqual(result.stdout, "")

    def test_folders_that_are_not_there_are_named(self):
        for command in (("check", *study_files()), ("coverage", *study_files("studyB.yaml"))):
            refused = pirsim(*command, "--sensors", "/nonexistent", code=4).stderr
            self.assertIn("/nonexistent: error: --sensors", refused)
        for option in ("-o", "--summary", "--zones"):
            self.assertEqual(study(option, "/nonexistent/x.csv", code=4).stderr,
                             "/nonexistent/x.csv: error: can't write: there is no folder '/nonexistent'\n")
        file = self.write("file", "")
        self.assertIn(f"'{file}' isn't a folder", study("-o", file / "x.csv", code=4).stderr)


class Days(Case):
    OFFICE = "--scene", None, "--staff", 8, "--from", "09:00", "--to", "09:05", "--set", "sensing.tick_rate_hz=10", "-q"

    def day(self, *args, **kwargs):
        scene = DATA / "rooms" / "open_office.gltf"
        return pirsim("run", *(scene if arg is None else arg for arg in self.OFFICE), *args, **kwargs)

    def test_a_week_of_an_office_and_the_script_that_it_makes(self):
        week = self.day("--occupants", f"{self.folder}/who.csv", "--report", f"{self.folder}/week.html").stdout
        script = self.write("week.yaml", self.day("--print-config").stdout)
        self.assertEqual(study("-q", scene="open_office.gltf", script=script).stdout, week)
        table = rows(week)
        self.assertEqual(len(table), 5 * 300)
        self.assertEqual((table[0]["time"], table[-1]["time"]), ("2026-03-02T09:00:01", "2026-03-06T09:05:00"))
        self.assertGreater(max(int(row["people"]) for row in table), 3)
        who = rows((self.folder / "who.csv").read_text())
        inside = {}
        for row in who:
            key = row["replicate"], row["time_s"]
            inside[key] = inside.get(key, 0) + (row["where"] == "inside")
        for row in table:
            self.assertEqual(int(row["people"]), inside.get((row["replicate"], row["time_s"]), 0))
        self.assertIn("People in the room", (self.folder / "week.html").read_text())

    def test_days_are_blocks_of_an_array_and_go_on_where_they_stopped(self):
        whole = self.day("--threads", 1).stdout
        for i in (1, 2):
            self.day("--shard", f"{i}/2", "-o", f"{self.folder}/shards", "--threads", 2)
        pirsim("merge", f"{self.folder}/shards", "-o", f"{self.folder}/merged.csv", "-q")
        self.assertEqual((self.folder / "merged.csv").read_text(), whole)
        script = self.write("week.yaml", self.day("--print-config").stdout)
        for args in (("merge", f"{self.folder}/shards", "--script", script, "--summary", f"{self.folder}/merged.md"),
                     ("--scene", DATA / "rooms/open_office.gltf", "--script", script, "--summary",
                      f"{self.folder}/whole.md")):
            pirsim(*args, "-o", f"{self.folder}/again.csv", "-q")
        self.assertEqual(*((self.folder / f"{name}.md").read_text() for name in ("merged", "whole")))
        shard = self.folder / "shards/shard-0001-of-0002.csv"
        bytes_before = shard.read_bytes()
        self.assertIn("is one of the files of the shards", pirsim("merge", f"{self.folder}/shards", "-o", shard, code=2).stderr)
        self.assertEqual(shard.read_bytes(), bytes_before)
        self.day("-o", f"{self.folder}/days.csv", "--max-time", "0.001s", "--threads", 1, code=75)
        self.day("-o", f"{self.folder}/days.csv", "--resume")
        self.assertEqual((self.folder / "days.csv").read_text(), whole)
        refused = self.day("-o", f"{self.folder}/days.csv", "--resume", "--cleaning", "20:00", code=3).stderr
        self.assertIn("days.csv", refused)

    def test_a_day_of_meetings(self):
        held = "schedule.meetings.held=[{at: '10:00', duration_min: 5, people: 4}]"
        table = rows(pirsim("run", "--scene", DATA / "rooms" / "meeting_room.gltf", "--meetings", "--days", 1, "--from",
                            "09:55", "--to", "10:12", "--set", held, "-q").stdout)
        self.assertEqual(max(int(row["people"]) for row in table), 4)
        self.assertEqual({row["phase"] for row in table}, {"empty", "occupied", "meeting"})
        self.assertEqual(table[-1]["people"], "0")

    def test_the_shipped_days_in_short(self):
        def part(begin, end, **files):
            return rows(study("-q", "--set", f"schedule.from='{begin}'", "--set", f"schedule.to='{end}'", **files).stdout)
        week = part("10:00", "10:03", scene="open_office.gltf", script="office_week.yaml")
        self.assertEqual(len(week), 5 * 180)
        self.assertEqual({row["time"][:10] for row in week}, {f"2026-03-0{day}" for day in range(2, 7)})
        for day in range(1, 6):
            self.assertGreater(max(int(row["people"]) for row in week if row["replicate"] == str(day)), 1)
        meetings = part("09:20", "09:36", script="meeting_day.yaml")
        self.assertIn("meeting", {row["phase"] for row in meetings})
        self.assertEqual(meetings[-1]["phase"], "empty")

    def test_check_tells_what_a_schedule_holds(self):
        told = study("check", scene="open_office.gltf", script="office_week.yaml").stdout
        self.assertIn("schedule: 5 days from 2026-03-02 (5 working days)", told)
        self.assertRegex(told, r"manager_1 +seat S1 +first day \d\d:\d\d-\d\d:\d\d, mean of 5 days")
        self.assertRegex(told, r"at most [5-8] at once, first at 2026-03-0\dT")
        told = study("check", script="meeting_day.yaml").stdout
        self.assertRegex(told, r"2026-03-02T\d\d:\d\d-\d\d:\d\d, \d people")

    def test_what_a_room_can_not_hold_is_refused(self):
        room = "--scene", DATA / "rooms" / "open_office.gltf"
        self.assertIn("say who comes", pirsim("run", *room, "--days", 2, code=2).stderr)
        self.assertIn("--replicates excludes --days", pirsim(*room, "--staff", 1, "--days", 2, "--replicates", 2, code=2).stderr)
        self.assertIn("--script excludes --staff", pirsim(*room, "--staff", 1, "--script", "office_week.yaml", code=2).stderr)
        self.assertIn("more staff than the 9 seats", pirsim("run", *room, "--staff", 10, code=3).stderr)
        for option, value, told in (("--to", "25:00", "error: --to: expected a time of day"),
                                    ("--from", "09:00 #", "error: --from: '09:00 #' is not made of digits"),
                                    ("--cleaning", "nne", "error: --cleaning: 'nne' is not made of digits"),
                                    ("--first-day", "2026-13-01", "error: --first-day: '2026-13-01' is no date")):
            self.assertIn(told, pirsim("run", *room, "--staff", 2, option, value, code=2).stderr)


class Light(Case):
    @classmethod
    def setUpClass(cls):
        cls.two_rooms = made_folder(cls.addClassCleanup) / "rows.csv"
        study("-q", "--replicates", 1, "-o", cls.two_rooms, scene="two_rooms.gltf", script="two_rooms.yaml")

    def table(self, name):
        return rows((self.folder / name).read_text())

    def test_areas_have_lights_of_their_own_whose_times_add_up(self):
        told = pirsim("control", self.two_rooms, "--scene", DATA / "rooms" / "two_rooms.gltf", "--delay", 1, 5,
                      "-o", self.folder / "costs.csv", "--light", self.folder / "lit.csv", "--report",
                      self.folder / "light.html")
        self.assertIn("With a delay of 1 min, a light goes off on somebody", told.stdout)
        costs, lit, given = self.table("costs.csv"), self.table("lit.csv"), rows(self.two_rooms.read_text())
        self.assertEqual({row["light"] for row in costs}, {"living_room", "bedroom"})
        self.assertEqual(len(lit), len(given))
        for light in ("living_room", "bedroom"):
            before = 0.0
            for row in (row for row in costs if row["light"] == light):
                hours = {key: float(value) for key, value in row.items() if key.endswith("_h")}
                self.assertAlmostEqual(hours["lit_h"] - hours["lit_empty_h"] + hours["dark_h"], hours["occupied_h"], 5)
                self.assertGreaterEqual(hours["lit_h"], before)  # a longer delay is never less light
                before = hours["lit_h"]
            of_one = next(row for row in costs if row["light"] == light and row["delay_min"] == "1")
            self.assertAlmostEqual(sum(row["lit_" + light] == "1" for row in lit) / 3600, float(of_one["lit_h"]), 5)
            self.assertEqual([row["people_" + light] for row in lit], [row["people_" + light] for row in given])
        self.assertIn("living_room", (self.folder / "light.html").read_text())

    def test_a_rule_that_names_areas_alone_takes_the_sensors_that_watch_them(self):
        rule = self.write("rule.yaml", "pirsim_control: 1\nlights: [{area: living_room}, {area: bedroom}]\n")
        made_by = "--scene", DATA / "rooms" / "two_rooms.gltf"
        by_all, by_own, plain = (
            pirsim("control", self.two_rooms, *more, "-o", self.folder / "costs.csv").stderr + (self.folder / "costs.csv").read_text()
            for more in (("--rule", rule), ("--rule", rule, *made_by), made_by))
        self.assertEqual(by_own, plain)
        self.assertNotIn("warning", by_own)
        self.assertIn("rule.yaml:2:10: warning: light 'living_room': the sensors of all areas switch it", by_all)
        self.assertNotEqual(by_all.split("light,delay_min")[1], plain.split("light,delay_min")[1])
        page = self.folder / "light.html"
        pirsim("control", self.two_rooms, "--rule", rule, "-q", "-o", self.folder / "costs.csv", "--report", page)
        told = pirsim("control", self.two_rooms, "--rule", rule, "--advised", self.folder / "advised.yaml").stdout
        again = pirsim("control", self.two_rooms, "--rule", self.folder / "advised.yaml").stdout
        best = re.search(r"(?:best guess is |: )([\d.]+) min", told)[1]
        self.assertIn(f"With a delay of {best} min", again)
        self.assertIn(best, (self.folder / "advised.yaml").read_text())
        self.assertRegex(page.read_text(), "<footer>pirsim [^<]*, rows.csv, rule.yaml</footer>")

    def test_seats_that_no_sensor_notices_are_told(self):
        made_by = "--scene", DATA / "rooms" / "two_rooms.gltf", "--script", DATA / "studies" / "two_rooms.yaml"
        deaf = pirsim("control", self.two_rooms, *made_by)
        told = "light 'living_room': none of its sensors notices somebody at work in S1: who is alone there sits in the dark"
        seen = pirsim("check", *made_by).stdout
        self.assertEqual(told in deaf.stderr, "noticed in none" in seen, deaf.stderr + seen)
        self.assertNotIn("'bedroom'", deaf.stderr)
        self.assertNotIn("notices somebody", pirsim("control", self.two_rooms, *made_by[:2]).stderr)

    def test_a_dataset_and_a_log_have_days(self):
        for room in (1, 2):
            for day in (1, 2, 3):
                lines = [f"{room},{day},{30 * (i + 1)},2026-03-0{day}T10:{(30 * (i + 1)) // 60:02}:{30 * (i + 1) % 60:02},"
                         f"occupied,1,0,0,{int(i == 0)},{'' if room == 2 else 0}" for i in range(60)]
                self.write(f"set/rows/room_{room:04}/day_0{day}.csv",
                           "room,day,time_s,time,phase,people,arrivals,departures,PIR1,PIR2\n" + "\n".join(lines) + "\n")
        pirsim("control", self.folder / "set", "--delay", 10, "-q", "-o", self.folder / "costs.csv")
        ten = next(row for row in self.table("costs.csv") if row["delay_min"] == "10")
        self.assertEqual((ten["days"], ten["false_offs"]), ("6", "6"))
        self.assertAlmostEqual(float(ten["lit_h"]), 6 * 21 * 30 / 3600)
        self.assertEqual(ten["dark_share_low"], ten["dark_share_high"])  # all days are alike
        log = self.write("log.csv", "time,PIR\n" + "".join(f"2026-03-02T10:{i:02}:00,{int(i == 3)}\n" for i in range(30)))
        told = pirsim("control", "--log", log, "--delay", 5, "-o", self.folder / "log_costs.csv")
        self.assertIn("isn't known", told.stdout)
        self.assertIn("warning: the rows have no people", told.stderr)
        five = next(row for row in self.table("log_costs.csv") if row["delay_min"] == "5")
        self.assertAlmostEqual(float(five["lit_h"]), 6 / 60)
        self.assertEqual(five["dark_h"], "")

    def test_a_page_has_a_line_a_run_and_one_of_people_where_they_are_known(self):
        head = "replicate,trial,time_s,time,phase,people,PIR1\n"
        runs = [[f"{run},a,{60 * i},2026-03-02T08:{i:02}:00,x,{int(i > 15)},{int(run == 1)}\n" for i in range(1, 31)] for run in (1, 2)]
        both = self.write("both.csv", head + "".join(runs[0] + runs[1]))
        holed = self.write("holed.csv", head + "".join(runs[0]).replace("2026-03-02T08:07:00", ""))
        self.assertIn(":8:9: error: time: expected a local time", pirsim("control", holed, "--light", self.folder / "h.csv", "--report", self.folder / "h.html", code=3).stderr)
        self.assertFalse((self.folder / "h.csv").exists())
        log = self.write("log.csv", "time,PIR\n" + "".join(f"2026-03-02T10:{i:02}:00,{int(i == 3)}\n" for i in range(30)))
        pirsim("control", "--log", log, "--delay", 0, "--report", self.folder / "l.html")
        self.assertNotIn('"people":true', (self.folder / "l.html").read_text())  # a line of them, hatched or not
        pirsim("control", both, "--report", self.folder / "b.html")
        page = (self.folder / "b.html").read_text()
        self.assertEqual(page.count('"name":"2026-03-02, run '), 2)  # a line a run
        self.assertIn('{"name":"people","people":true,"runs":[0,240,-1,247,255,1,255,720,-1]}', page)

    def test_which_delay_to_take_is_told_by_default(self):
        lines = [f"{day},a,{60 * i},x,1,{int(i % 8 == 1)}\n" for day in range(1, 25) for i in range(1, 121)]
        weeks = self.write("weeks.csv", "replicate,trial,time_s,phase,people,PIR1\n" + "".join(lines))
        sentence = "light: 7 min: off on somebody less than once a week, 0 s of empty light a day; at 10 min not once, and 0 s."
        told = pirsim("control", weeks, "--report", self.folder / "light.html")
        self.assertIn(sentence, told.stdout)
        self.assertIn(sentence, (self.folder / "light.html").read_text())
        self.assertIn("too few to tell which delay goes off on somebody less than 0.5 times a week: 42 days without",
                      pirsim("control", weeks, "--at-most", 0.5).stdout)
        self.assertIn("--delay: 5 is given twice", pirsim("control", weeks, "--delay", 5, 1, 5, code=2).stderr)
        twice = self.write("twice.yaml", "pirsim_control: 1\nlights: [{sensors: [PIR1, PIR1], together: {sensors: 2}}]\n")
        self.assertIn("twice.yaml:2:27: error: light: sensors: 'PIR1' is named twice", pirsim("control", weeks, "--rule", twice, code=3).stderr)

    def test_what_are_no_rows_is_told_with_its_place(self):
        good = self.write("rows.csv", "replicate,trial,time_s,phase,people,PIR1\n1,a,1,x,0,1\n1,a,2,x,0,0\n")
        for name, text, told in (("log.csv", "time,PIR1\n2026-03-02T10:00:00,1\n", "log.csv:1:1: error: these aren't rows"),
                                 ("bad.csv", good.read_text() + "1,a,3,x,one,0\n", "bad.csv:4:9: error: people: expected a number of people, got 'one'"),
                                 ("cut.csv", good.read_text() + "1,a,3\n", "cut.csv:4:1: error: expected 6 fields, got 3"),
                                 ("empty.csv", "", "empty.csv:1:1: error: expected a line with column names")):
            result = pirsim("control", self.write(name, text), code=3)
            self.assertIn(told, result.stderr)
        other = self.write("other.csv", good.read_text().replace("PIR1", "PIR2"))
        self.assertIn("aren't those of", pirsim("control", good, other, code=3).stderr)
        self.assertIn("no dataset", pirsim("control", self.folder, code=3).stderr)
        self.assertIn("say which rows", pirsim("control", code=2).stderr)
        self.assertIn("say which rows", pirsim("control", good, "--log", good, code=2).stderr)


class Homes(Case):
    def day_of_two(self):
        flat = DATA / "rooms" / "flat.gltf"
        text = pirsim("run", "--scene", flat, "--home", 2, "--days", 2, "--print-config").stdout
        return flat, self.write("home.yaml", text + "sensing: {response: zones, tick_rate_hz: 5}\n")

    def test_check_tells_who_is_expected_and_what_has_no_place(self):
        flat, script = self.day_of_two()
        checked = pirsim("check", "--scene", flat, "--script", script)
        self.assertIn("household: 2 days from 2026-03-02 (2 working days)", checked.stdout)
        for person, bed in (("resident_1", "bed_left"), ("resident_2", "bed_right")):
            line = next(line for line in checked.stdout.splitlines() if line.split()[:1] == [person])
            self.assertIn(f"bed {bed}; up 0", line)
            hours = sum(float(hours) for hours in re.findall(r"\w+ ([\d.]+)(?:,|$)", line.split("day:")[1]))
            self.assertAlmostEqual(hours, 24, delta=0.06 * 11)  # told to a tenth of an hour
        self.assertNotIn("no place for", checked.stderr)
        room = json.loads(flat.read_text())
        for node in room["nodes"]:
            mark = node.get("extras", {}).get("pirsim", {})
            if mark.get("type") == "place":
                mark["for"] = [use for use in mark["for"] if use not in ("toilet", "cook")] or ["phone"]
        poor = self.write("poor.gltf", json.dumps(room))
        self.assertIn("home.yaml:7:3: warning: household: no place for toilet (`for: [toilet]` in its mark): residents do "
                      "that where they are (and 1 more: cooking)",
                      pirsim("check", "-q", "--scene", poor, "--script", script).stderr)

    def test_a_log_has_the_rows_changes_and_each_activity_begins_and_ends(self):
        flat, script = self.day_of_two()
        pirsim("--scene", flat, "--script", script, "--replicates", 1, "-q", "-o", self.folder / "rows.csv", "--casas",
               self.folder / "log.txt")
        rose = {}
        before = {}
        for row in rows((self.folder / "rows.csv").read_text()):
            if row["time_s"] == "1":
                before = {}
            for name in row:
                if name.startswith(("PIR_", "door_")):
                    rose[name] = rose.get(name, 0) + (row[name] == "1" and before.get(name, "0") == "0")
                    before[name] = row[name]
        lines = [line.split() for line in (self.folder / "log.txt").read_text().splitlines()]
        seen = {tuple(line[:4]) for line in lines}  # one with two labels stands twice
        for name, times in rose.items():
            self.assertEqual(sum(line[2] == name and line[3] in ("ON", "OPEN") for line in seen), times, name)
        open_now = set()
        for line in lines:
            if line[5:] == ["begin"]:
                self.assertNotIn(line[4], open_now)
                open_now.add(line[4])
            elif line[5:] == ["end"]:
                open_now.remove(line[4])
        self.assertEqual(open_now, set())
        self.assertEqual([line[:2] for line in lines], sorted(line[:2] for line in lines))
        self.assertIn("--casas: a log has a date", study("--casas", self.folder / "x.txt", code=2).stderr)


class OwnClock(Case):
    """The example of docs/formats/script.md: anna comes at 06:45 and goes at 08:15, in a run that begins at 06:00."""
    PAGE = HERE.parents[1] / "docs" / "formats" / "script.md"

    def setUp(self):
        super().setUp()
        example = next(block for block in re.findall(r"```yaml part of script\n(.*?)```", self.PAGE.read_text(), re.DOTALL)
                       if block.startswith("begin:"))
        self.assertEqual(example.count("\n"), 3)
        self.files = "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", self.write(
            "anna.yaml", "pirsim_script: 1\n" + example)

    def test_rows_have_the_time_and_people_keep_to_it(self):
        pirsim(*self.files, "-o", self.folder / "rows.csv", "--occupants", self.folder / "who.csv", "-q")
        table = rows((self.folder / "rows.csv").read_text())
        self.assertEqual(list(table[0])[:5], ["replicate", "trial", "time_s", "time", "phase"])
        self.assertEqual((table[0]["time"], table[0]["time_s"]), ("2026-03-02T06:00:01", "1"))
        seen = [row["time"] for row in table if row["phase"] != "outside"]
        self.assertEqual((seen[0], seen[-1][:16]), ("2026-03-02T06:45:01", "2026-03-02T08:15"))
        self.assertEqual(rows((self.folder / "who.csv").read_text())[0]["time"], "2026-03-02T06:45:01")
        resolved = json.loads((self.folder / "rows.csv.json").read_text())["resolved_script"]
        self.assertIn("begin: 2026-03-02T06:00", resolved)
        self.assertIn("at: 06:45", resolved)
        again = pirsim(*self.files[:3], self.write("again.yaml", resolved), "-q").stdout
        self.assertEqual(again, (self.folder / "rows.csv").read_text())
        later = rows(pirsim(*self.files, "--set", "begin=2026-03-02T06:40", "-q").stdout)
        self.assertEqual([row["time"] for row in later if row["phase"] != "outside"], seen)
        self.assertEqual(later[0]["time"], "2026-03-02T06:40:01")

    def test_check_and_the_resolved_script_tell_the_times(self):
        told = pirsim("check", *self.files).stdout
        self.assertIn("clock: every run begins at 2026-03-02T06:00:00\n  anna begins an action at 06:45, 08:15\n", told)
        self.assertIn("at: 08:15", pirsim(*self.files, "--print-config").stdout)

    def test_every_option_that_takes_a_moment_takes_what_rows_and_pages_show(self):
        small = "--width", 64, "--height", 64
        pictures = set()
        for moment in ("06:45:03", "2026-03-02T06:45:03", "6:45:03", 2703):
            told = pirsim("preview", *self.files, "-o", self.folder / "p.png", "--time", moment, *small).stderr
            self.assertIn("at 2026-03-02T06:45:03\n", told)
            pictures.add((self.folder / "p.png").read_bytes())
        self.assertEqual(len(pictures), 1)
        part = "--from", "06:44", "--to", "06:46"
        told = pirsim("view", *self.files, "-o", self.folder / "v.html", *part).stderr
        self.assertIn("2026-03-02T06:44:00 to 2026-03-02T06:46:00 of 2026-03-02T06:00:00 to 2026-03-02T08:15:", told)
        told = pirsim("export", *self.files, "-o", self.folder / "r.gltf", *part, "--beams", "none").stderr
        self.assertIn(", 120 s\n", told)
        keys = json.loads((self.folder / "r.gltf").read_text())
        times = keys["accessors"][keys["animations"][0]["samplers"][0]["input"]]
        self.assertEqual((times["min"], times["max"]), ([0], [120]))
        for command, option in (("preview", "--time"), ("view", "--from"), ("export", "--from")):
            refused = pirsim(command, *self.files, option, "05:00", code=2).stderr
            self.assertRegex(refused, rf"error: {option[2:]}: .*lasts from 2026-03-02T06:00:00 to 2026-03-02T08:15:")
            refused = pirsim(command, *self.files, option, "quarter past", code=2).stderr
            self.assertIn(f"error: {option}: expected seconds or H:MM:SS since the run began, or a time of day", refused)
        refused = pirsim("view", *self.files, "--from", "07:00", "--to", "06:30", code=2).stderr
        self.assertIn("error: to: the page would begin at 2026-03-02T07:00:00 and end at 2026-03-02T06:30:00", refused)

    def test_without_a_clock_times_of_day_are_refused_and_the_time_since_the_beginning_is_not(self):
        for command, option in (("preview", "--time"), ("view", "--from"), ("view", "--to"), ("export", "--to")):
            refused = pirsim(command, *study_files(), option, "19:00", code=2).stderr
            self.assertEqual(refused.splitlines()[-1], f"error: {option}: '19:00' is a time of day, and this study has no "
                             "clock: add `begin: 2026-03-02T00:00` to its script, or give seconds or H:MM:SS since the run "
                             "began")
        told = pirsim("preview", *study_files(), "-o", self.folder / "p.png", "--time", "0:00:20", "--width", 64, "--height",
                      64).stderr
        self.assertIn(" at 20 s\n", told)


class FailedRuns(Case):
    """Seats before a wall, scattered so far that some can't be reached: replicates 6 and 10 of S5."""
    FAILING = ("-q", "--threads", 1, "--replicates", 12, "--seed", 2, "--set", "trials.for_each.seat=[S5,S6]", "--set",
               "people.0.seat_scatter.position_sd_m=0.2", "--set", "people.0.actions.3.work.duration_s=2")

    def failing(self, *args, **kwargs):
        return study(*self.FAILING, *args, scene="meeting_room_alt1.gltf", **kwargs)

    def test_all_other_runs_have_rows_and_each_that_failed_is_told_with_person_and_place(self):
        told = self.failing("-o", self.folder / "rows.csv", "--summary", self.folder / "table.md", code=6).stderr
        self.assertIn("2 runs failed and have no rows", told)
        self.assertRegex(told, r"trial S5, replicate 6, second 0\.02: 'occupant' at \([\d., -]+\) m can.t reach ")
        table = rows((self.folder / "rows.csv").read_text())
        self.assertEqual(len({(row["replicate"], row["trial"]) for row in table}), 22)
        failed = json.loads((self.folder / "rows.csv.json").read_text())["people"]["failed_runs"]
        self.assertEqual([(run["trial"], run["replicate"]) for run in failed], [("S5", 6), ("S5", 10)])
        self.assertIn("'occupant' at (", failed[0]["message"])
        self.assertIn("Runs that failed and are left out: 2.", (self.folder / "table.md").read_text())

    def test_a_run_that_failed_is_told_by_the_clock_that_rows_have(self):
        told = self.failing("--set", "begin=2026-03-02T06:00", "-o", f"{self.folder}/rows.csv", code=6).stderr
        self.assertIn("trial S5, replicate 6, 2026-03-02T06:00:00: 'occupant' at (", told)
        failed = json.loads(pathlib.Path(self.folder, "rows.csv.json").read_text())["people"]["failed_runs"]
        self.assertEqual([run["time"] for run in failed], ["2026-03-02T06:00:00"] * 2)

    def test_strict_stops_at_the_first_keeps_what_is_finished_and_can_be_resumed(self):
        self.failing("-o", self.folder / "whole.csv", code=6)
        told = self.failing("-o", self.folder / "rows.csv", "--strict", code=5).stderr
        self.assertIn("trial S5, replicate 6", told)
        self.assertFalse((self.folder / "rows.csv").exists())
        self.failing("-o", self.folder / "rows.csv", "--resume", code=6)
        for ending in (".csv", ".csv.json"):
            self.assertEqual((self.folder / ("rows" + ending)).read_bytes(), (self.folder / ("whole" + ending)).read_bytes())

    def test_shards_note_their_own_and_merge_tells_of_all(self):
        self.failing("-o", self.folder / "whole.csv", code=6)
        for i in (1, 2):
            self.failing("-o", self.folder / "shards", "--shard", f"{i}/2", code=6)
        told = pirsim("merge", self.folder / "shards", "-o", self.folder / "merged.csv", code=6).stderr
        self.assertIn("2 runs failed and have no rows\n  trial S5, replicate 6, second 0.02: 'occupant' at ", told)
        self.assertEqual((self.folder / "merged.csv").read_bytes(), (self.folder / "whole.csv").read_bytes())


class Help(Case):
    def test_help_of_a_command_is_what_the_command_says_itself(self):
        for command in (*COMMANDS, *OTHERS):
            text = pirsim("help", *command).stdout
            self.assertEqual(text, pirsim(*command, "--help").stdout)
            examples = text.split("Examples:\n")[1].split("\n")
            self.assertTrue(examples[0].startswith(" ".join(("  pirsim", *command))), examples[0])

    def test_help_of_an_unknown_command_names_the_nearest(self):
        self.assertEqual(pirsim("help", "chekc", code=2).stderr,
                         "error: help: 'chekc' isn't a command (did you mean 'check'?)\n")
        self.assertEqual(pirsim("help", "reconcile", "pln", code=2).stderr,
                         "error: help: 'pln' isn't a command of 'reconcile' (did you mean 'plan'?)\n")

    def test_words_that_nothing_takes_are_named_with_the_nearest(self):
        for args, told in ((("covrage",), "'covrage' isn't a command of 'pirsim' (did you mean 'coverage'?)"),
                           (("reconcile", "pln"), "'pln' isn't a command of 'pirsim reconcile' (did you mean 'plan'?)"),
                           (("check", "room"), "'room' isn't an argument of 'pirsim check'"),
                           (("room.gltf", "study.yaml"), "'room.gltf' isn't a command of 'pirsim'; a room is given as "
                            "--scene room.gltf"),
                           (("study.yaml",), "'study.yaml' isn't a command of 'pirsim'; a study is given as "
                            "--script study.yaml"),
                           (("check", "study.yaml"), "'study.yaml' isn't an argument of 'pirsim check'; a study is given as "
                            "--script study.yaml"),
                           (("--sceen", "a"), "'--sceen' isn't an option of 'pirsim' (did you mean '--scene'?)"),
                           (("coverage", "--replicates", 3), "'--replicates' isn't an option of 'pirsim coverage'")):
            self.assertEqual(pirsim(*args, code=2).stderr, f"error: {told}\n")

    def test_values_that_are_no_numbers_are_named_with_their_option(self):
        for args, told in ((("preview", "--time", "10s"), "--time: expected seconds or H:MM:SS since the run "
                            "began, or a time of day as its rows have it (19:00), not '10s'"),
                           (("--threads", "-1"), "--threads: '-1' is not a whole number from 0"),
                           (("--seed", "abc"), "--seed: 'abc' is not a whole number"),
                           (("room", "--seed", "-1"), "--seed: '-1' is not a whole number from 0 to 2^64 - 1"),
                           (("room", "--seed", 2 ** 64), f"--seed: '{2 ** 64}' is not a whole number from 0 to 2^64 - 1")):
            self.assertEqual(pirsim(*args, code=2).stderr.splitlines()[0], f"error: {told}")

    def test_version_has_a_short_name(self):
        self.assertEqual(pirsim("-V").stdout, pirsim("--version").stdout)


class CommandLine(Case):
    def test_help_starts_a_user_off_and_version_names_embree(self):
        self.assertIn("--scene", pirsim("--help").stdout)
        self.assertIn("Embree", pirsim("--version").stdout)

    def test_missing_and_unknown_options_are_usage_errors(self):
        self.assertIn("--scene", pirsim("--script", "x.yaml", code=2).stderr)
        pirsim("--no-such-option", code=2)
        self.assertIn("did you mean", study("--tracer", "embre", code=2).stderr)

    def test_what_only_an_analysis_of_data_takes_is_refused_by_its_subcommands(self):
        for command in ("plan", "selftest"):
            text = pirsim("reconcile", command, "--help").stdout
            for option in ("--measured", "--holdout", "--max-effects"):
                self.assertNotIn(option, text)
                self.assertIn(option, pirsim("reconcile", command, option, "1", code=2).stderr)
                self.assertIn(option, pirsim("reconcile", option, "1", command, code=2).stderr)
            self.assertIn("--output", pirsim("reconcile", "-o", "folder", command, code=2).stderr)

    def test_no_output_replaces_an_input(self):
        reference = self.write("ref.csv", "trial,sensor,seconds\nS1,PIR1,20\n")
        script = self.write("s.yaml", (DATA / "studies/studyA.yaml").read_text().replace(
            "stefansson2021_table1.csv", "ref.csv"))
        patched = self.write("script_patched.yaml", script.read_text())
        measured = self.write("where.csv", "trial,sensor,seconds\nS1,PIR1,20\n")
        self.assertIn("ref.csv", script.read_text())
        room = "--scene", DATA / "rooms/meeting_room.gltf"
        tries = [((*room, "--script", script, "-o", reference), reference),
                 ((*room, "--script", script, "--summary", reference), reference),
                 (("reconcile", *room, "--script", patched, "--measured", reference, "-o", self.folder), patched),
                 (("reconcile", *room, "--script", script, "--measured", measured, "-o", self.folder), measured)]
        for args, kept in tries:
            before = kept.read_bytes()
            told = pirsim(*args, code=2).stderr
            self.assertEqual(told.count("error:"), 1, told)
            self.assertIn(kept.name, told)
            self.assertEqual(kept.read_bytes(), before)

    def test_what_can_not_be_compared_is_refused_before_any_work(self):
        script = self.write("s.yaml", "pirsim_script: 1\ntrials:\n  - {id: S1, people: [{id: a, actions: "
                       "[{enter: door}, {sit: S3}, {work: {duration_s: 30}}, {leave: door}]}]}\n")
        measured = self.write("m.csv", "trial,sensor,seconds\n" +
                         "".join(f"S1,PIR{i},{5000 if i == 1 else 3}\n" for i in range(1, 6)))
        call = ("reconcile", "--scene", DATA / "rooms/meeting_room.gltf", "--script", script, "--measured", measured,
                "-o", f"{self.folder}/found", "-q")
        for response in ("zones", "analog"):
            self.assertIn("has 5000 s with motion, but a run lasts at most",
                          pirsim(*call, "--response", response, code=3).stderr)
        self.assertIn("dual_polarity can't be looked for: it acts on sensors with response: zones",
                      pirsim(*call, "--effects", "dual_polarity", code=2).stderr)

    def test_outputs_of_like_names_do_not_meet(self):
        study("--replicates", 1, "-o", self.folder / "a.csv.gz", "--summary", self.folder / "a.csv", "-q")
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), ["a.csv", "a.csv.gz", "a.csv.gz.json"])

    def test_a_sensor_is_not_named_as_a_column(self):
        room = (DATA / "rooms/meeting_room.gltf").read_text()
        self.assertIn('"PIR1"', room)
        scene = self.write("room.gltf", room.replace('"PIR1"', '"time_s"'))
        told = pirsim("--scene", scene, "--script", DATA / "studies/studyA.yaml", "--sensors", DATA / "sensors",
                      code=3).stderr
        self.assertRegex(told, r"room.gltf:\d+:\d+: error: .*sensor id 'time_s' is the name of a column of rows")

    def test_a_ranking_that_can_not_be_written_is_an_error(self):
        if not pathlib.Path("/dev/full").exists():
            self.skipTest("no /dev/full")
        with open("/dev/full", "w") as full:
            result = subprocess.run([PIRSIM, "placements", *study_files("placements.yaml"), "--set", "spacing_m=1", "-q"],
                                    stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(result.returncode, 4, result.stderr)

    def test_a_file_that_is_not_there_is_an_io_error_that_names_it(self):
        result = pirsim("--scene", "nowhere.gltf", "--script", DATA / "studies" / "studyA.yaml", code=4)
        self.assertIn("nowhere.gltf", result.stderr)

    def test_overrides_are_checked_like_the_script(self):
        self.assertIn("--set", study("--set", "sensing.rays_per_zone=7", code=3).stderr)
        self.assertIn("did you mean", study("--set", "sensing.tick_rate=7", code=3).stderr)

    def test_print_config_reads_back_to_itself(self):
        first = study("--print-config").stdout
        path = self.write("resolved.yaml", first)
        second = pirsim("--scene", "unused", "--script", path, "--print-config").stdout
        self.assertEqual(first, second)


class Hostile(Case):
    def test_effects_are_listed_without_a_room_and_one_is_told_in_full(self):
        listed = [line.split()[0] for line in pirsim("effects").stdout.splitlines()]
        table = rows(pirsim("effects", "--format", "csv").stdout)
        self.assertEqual(listed, list(dict.fromkeys(row["effect"] for row in table)))
        self.assertGreater(len(listed), 20)
        self.assertIn(f"{len(listed)} imperfections", (HERE.parents[1] / "README.md").read_text())
        for effect in listed:
            self.assertIn("fingerprint:", pirsim("effects", effect).stdout)
        self.assertIn("did you mean 'dead_time'?", pirsim("effects", "dead_tyme", code=2).stderr)

    def test_effects_of_a_script_are_kept_as_written_and_unknown_ones_refused(self):
        effects = ("--set", "effects=[{sensor_yaw: {yaw_deg: 3, sensor: PIR2}}, dead_time: {dead_s: 2}]")
        text = study(*effects, "--print-config").stdout
        self.assertIn("yaw_deg: 3", text)
        path = self.write("resolved.yaml", text)
        self.assertEqual(pirsim("--scene", "none", "--script", path, "--print-config").stdout, text)
        refused = study("--set", "effects=[dead_tyme]", "--print-config", code=3).stderr
        self.assertIn("did you mean 'dead_time'?", refused)

    def test_every_hostile_script_is_refused_with_its_place(self):
        files = sorted((HERE / "hostile" / "scripts").glob("*.yaml"))
        self.assertGreaterEqual(len(files), 10)
        for file in files:
            with self.subTest(file.name):
                _, _, code, fragment = file.read_text().splitlines()[0].split(" ", 3)
                result = pirsim("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", file, code=int(code))
                self.assertEqual(result.stdout, "")
                self.assertIn(str(file), result.stderr)
                self.assertIn(fragment, result.stderr)

    def test_an_unwritable_output_is_an_io_error_and_leaves_nothing(self):
        target = self.folder / "no" / "such" / "folder.csv"
        self.assertIn("folder.csv", study("--replicates", 1, "-o", target, code=4).stderr)
        self.assertEqual(list(self.folder.iterdir()), [])


class MainJob(Case):
    @classmethod
    def setUpClass(cls):
        cls.text = study("--replicates", 2, "-q").stdout
        cls.rows = rows(cls.text)

    def test_stdout_is_pure_csv_in_the_order_of_replicates_and_trials(self):
        self.assertEqual(self.text.splitlines()[0], "replicate,trial,time_s,phase,people,PIR1,PIR2,PIR3,PIR4,PIR5")
        order = list(dict.fromkeys((row["replicate"], row["trial"]) for row in self.rows))
        self.assertEqual(order, [(str(r), f"S{s}") for r in (1, 2) for s in range(1, 11)])

    def test_every_trial_counts_180_s_of_work_and_begins_and_ends_outside(self):
        for replicate in "12":
            for seat in range(1, 11):
                trial = [r for r in self.rows if r["replicate"] == replicate and r["trial"] == f"S{seat}"]
                self.assertEqual(sum(r["phase"] == "working" for r in trial), 180)
                self.assertEqual([int(float(r["time_s"])) for r in trial], list(range(1, len(trial) + 1)))
                self.assertEqual(trial[-1]["people"], "0")
                self.assertTrue(all(r["people"] == "1" for r in trial if r["phase"] == "working"))

    def test_the_bytes_do_not_depend_on_the_number_of_threads(self):
        for threads in (1, 2, 7):
            self.assertEqual(study("--replicates", 2, "-q", "--threads", threads).stdout, self.text)

    def test_another_seed_gives_other_bits_but_the_same_walk(self):
        other = rows(study("--replicates", 1, "-q", "--seed", 5).stdout)
        mine = [r for r in self.rows if r["replicate"] == "1"]
        self.assertEqual([(r["time_s"], r["phase"]) for r in other], [(r["time_s"], r["phase"]) for r in mine])
        self.assertNotEqual(other, mine)

    def test_more_replicates_do_not_change_the_first_ones(self):
        one = study("--replicates", 1, "-q").stdout
        self.assertTrue(self.text.startswith(one))

    def test_the_reference_tracer_gives_the_same_bytes(self):
        args = ("--replicates", 1, "-q", "--set", "trials.for_each.seat=[S1, S6]", "--set", "sensing.tick_rate_hz=10")
        self.assertEqual(study(*args, "--tracer", "reference").stdout, study(*args).stdout)

    def test_tracers_agree_with_nested_zones_reflections_and_screens_too(self):
        effects = ("effects=[{soft_zone_edges: {sigma_deg: 1}}, {wall_reflection: {coefficient: 0.9, wall: wall left}},"
                   " missing_occluder]")
        args = ("--replicates", 1, "-q", "--set", "trials.for_each.seat=[S1, S6]", "--set", "sensing.tick_rate_hz=10",
                "--set", "people.0.actions.3.work.duration_s=30", "--set", effects)
        direct = study(*args).stdout
        self.assertEqual(study(*args, "--tracer", "reference").stdout, direct)
        self.assertEqual(study(*args, "--tracer", "embree").stdout, direct)
        self.assertNotEqual(study(*args[:-2]).stdout, direct)

    def test_files_and_manifest_agree_with_stdout_and_the_zones_with_the_bits(self):
        study("--replicates", 1, "-o", self.folder / "rows.csv", "--zones", self.folder / "zones.csv", "--summary",
              self.folder / "summary.csv", "--set", "trials.for_each.seat=[S3]")
        text = (self.folder / "rows.csv").read_text()
        manifest = json.loads((self.folder / "rows.csv.json").read_text())
        self.assertEqual(manifest["rows"], len(rows(text)))
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["rows.csv", "rows.csv.json", "summary.csv", "zones.csv"])
        self.assertEqual(self.bits_from_zones((self.folder / "zones.csv").read_text()),
                         [[row[f"PIR{i}"] for i in range(1, 6)] for row in rows(text)])

    @staticmethod
    def bits_from_zones(text, ticks_per_window=50, zones_per_cluster=4):
        """The sensors' bits computed anew from zone activity, as the paper's section 2.1 defines motion."""
        last, bits = {}, {}
        for row in rows(text):
            zones, sensor = row["zones"], row["sensor"]
            clusters = ["1" in zones[i:i + zones_per_cluster] for i in range(0, len(zones), zones_per_cluster)]
            window = (int(row["tick"]) - 1) // ticks_per_window
            changed = clusters != last.get(sensor, [False] * len(clusters))
            key = (window, sensor)
            bits[key] = "1" if changed or bits.get(key) == "1" else "0"
            last[sensor] = clusters
        windows = max(window for window, _ in bits) + 1
        return [[bits[w, f"PIR{i}"] for i in range(1, 6)] for w in range(windows)]


class Looking(Case):
    def test_check_reports_what_sensors_see_and_warns_of_a_blind_one(self):
        files = ("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml")
        result = pirsim("check", *files)
        self.assertIn("PIR5", result.stdout)
        self.assertNotIn("NOBODY", result.stderr)
        scene = json.loads((DATA / "rooms" / "meeting_room.gltf").read_text())
        node = next(n for n in scene["nodes"] if n.get("extras", {}).get("pirsim", {}).get("id") == "PIR3")
        node["rotation"] = [0, 1, 0, 0]  # looks into the wall behind it
        blind = self.write("blind.gltf", json.dumps(scene))
        result = pirsim("check", "--scene", blind, *files[2:], "--sensors", DATA / "sensors")
        self.assertIn("sensor 'PIR3' can see NOBODY", result.stderr)

    def test_a_page_has_the_thresholds_of_each_side(self):
        sensor = (DATA / "sensors" / "EKMC1604111.yaml").read_text()
        self.assertIn("negative_v: 0.45", sensor)
        self.write("sensors/EKMC1604111.yaml", sensor.replace("negative_v: 0.45", "negative_v: 0.25"))
        page = self.folder / "run.html"
        pirsim("view", *study_files(), "--sensors", self.folder / "sensors", "--set", "sensing.response=analog",
               "--to", 2, "-q", "-o", page)
        data = re.search('id="data">(.*?)</script>', page.read_text())[1]
        first = json.loads(gzip.decompress(base64.b64decode(data)))["sensors"][0]
        self.assertEqual((first["positive_v"], first["negative_v"]), (0.45, 0.25))

    def test_a_run_says_what_it_wrote_and_quiet_says_nothing(self):
        out = self.folder / "rows.csv"
        report = self.folder / "report.html"
        once = "--replicates", 1
        told = study(*once, "-o", out, "--report", report).stderr
        n_rows = len(out.read_text().splitlines()) - 1
        self.assertIn(f"wrote {out}: {n_rows} rows, {report}\n", told)
        self.assertNotIn("wrote", study(*once, "-o", out, "-q").stderr)
        self.assertNotIn("wrote", study(*once).stderr)
        self.assertIn("all runs are there", study(*once, "-o", out, "--resume").stderr)

    def test_preview_marks_what_it_is_asked_to(self):
        pictures = {}
        for marks in ("none", "seats", "doors", "sensors", "people", "scale", "key", "all"):
            out = self.folder / f"{marks}.png"
            pirsim("preview", *study_files(), "-o", out, "--labels", marks, "--width", 320, "--height", 180)
            pictures[marks] = out.read_bytes()
        self.assertEqual(len(set(pictures.values())), len(pictures))
        refused = pirsim("preview", *study_files(), "-o", out, "--labels", "chairs", code=2).stderr
        self.assertIn("seats", refused)

    def test_the_scale_has_its_label_only_where_all_of_its_bar_is_seen(self):
        """Behind a wall, and beyond the picture's edge, the label would stand beside nothing."""
        def drawn(marks, camera, look_at):
            out = self.folder / "p.png"
            pirsim("preview", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                   DATA / "studies" / "studyA.yaml", "-o", out, "--labels", marks, "--camera=" + camera,
                   "--look-at=" + look_at, "--width", 320, "--height", 180)
            return out.read_bytes()
        for camera, look_at in (("9,4,2", "3,1,-4"), ("4,3,-1", "6,0,-1")):
            self.assertEqual(drawn("scale", camera, look_at), drawn("none", camera, look_at))
        self.assertNotEqual(drawn("scale", "4,12,-4", "4,0,-4"), drawn("none", "4,12,-4", "4,0,-4"))

    def test_preview_writes_a_png_of_the_asked_size(self):
        out = self.folder / "p.png"
        pirsim("preview", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
               DATA / "studies" / "studyA.yaml", "-o", out, "--width", 160, "--height", 90, "--time", 20)
        header = out.read_bytes()[:24]
        self.assertEqual(header[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((int.from_bytes(header[16:20], "big"), int.from_bytes(header[20:24], "big")), (160, 90))

    def test_a_moment_after_the_end_of_the_run_is_refused_with_its_length(self):
        out = self.folder / "p.png"
        refused = pirsim("preview", *study_files(), "-o", out, "--time", 99999, code=2).stderr
        self.assertIn("time: 99999 s isn't in the run", refused)
        end = re.search(r"lasts from 0 to (\S+) s", refused)[1]
        self.assertFalse(out.exists())
        pirsim("preview", *study_files(), "-o", out, "--time", end, "--width", 64, "--height", 64)
        self.assertTrue(out.exists())

    def test_export_writes_thirteen_parts_with_their_primitives(self):
        out = self.folder / "run.gltf"
        pirsim("export", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
               DATA / "studies" / "studyA.yaml", "-o", out, "--trial", "S3")
        gltf = json.loads(out.read_text())
        parts = [n["extras"]["pirsim"] for n in gltf["nodes"]
                 if n.get("extras", {}).get("pirsim", {}).get("type") == "body_part"]
        kinds = sorted(part["primitive"] for part in parts)
        self.assertEqual(kinds, ["box"] * 3 + ["capsule"] * 9 + ["sphere"])


if __name__ == "__main__":
    main()
