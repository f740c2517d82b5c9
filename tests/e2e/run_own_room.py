#!/usr/bin/env python3
"""`pirsim calibrate` and `pirsim count`: the same bytes in one go, in shards and resumed; the hold is read off the log;
what is refused; counts against the log's own.

Usage: run_own_room.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import csv
import datetime
import functools
import json
import re
import shutil
import subprocess
import unittest

from program import DATA, PIRSIM, made_folder, main, run

MADE = ("weights.csv", "counter.json", "calibration.json", "calibration.html", "recipe.yaml")


def at(minute):
    return f"2026-03-02T{7 + minute // 60:02d}:{minute % 60:02d}:00"


# Logs that no motion sensors write: what each command says of them.
IMPLAUSIBLE = {
    "a count": ("time,a_motion\n" + "".join(f"{at(i)},{i % 4}\n" for i in range(1, 200)), "'2' is no state of 'a_motion'"),
    "a name a row": ("id,start,end,room\n" + "".join(f"{i},{at(9 * i)},{at(9 * i + 4)},{'ab'[i % 2]}\n" for i in range(30)),
                     "'id' is another one in each row"),
    "two sensors of a name": ("time,node,child,state\n" + "".join(
        f"{at(4 * i + k)},7,{k},{i % 2}\n" for i in range(60) for k in (0, 1)), "names a sensor that goes on while it is on"),
    "an hour twice": ("time,a_motion\n" + "".join(f"{at(i if i < 180 else i - 60)},{i // 5 % 2}\n" for i in range(1, 400)),
                      "stand in it a second time"),
    "the year after next": ("time,a_motion\n" + "".join(f"2097-{at(i)[5:]},{i // 5 % 2}\n" for i in range(1, 200)), "later than tomorrow"),
}


def table(path):
    return csv.DictReader(path.read_text().splitlines())


class OwnRoom(unittest.TestCase):
    """One pool serves all tests: ten rooms of an hour, and two days of another room as a log."""

    @classmethod
    def setUpClass(cls):
        cls.folder = made_folder(cls.addClassCleanup)
        small = (DATA / "recipes" / "own_room_small.yaml").read_text()
        for shipped, quicker in (("count: 12", "count: 10"), ("09:30", "09:00"), ("rate_hz: 10}", "rate_hz: 10, response: zones}")):
            assert shipped in small, shipped
            small = small.replace(shipped, quicker)
        cls.recipe = cls.write("recipe.yaml", small)
        cls.exports = cls.folder / "unseen" / "exports"
        run("dataset", cls.recipe, "-o", cls.folder / "unseen", "-q", "--set", "rooms.0.count=1", "--set", "days=2",
            "--set", "seed=99", "--set", "exports=[casas, uci864]")
        cls.labelled = sorted((cls.exports / "uci864").rglob("*.csv"))
        cls.log = []
        for number, file in enumerate(cls.labelled):
            lines = file.read_text().splitlines()
            cls.log.append(cls.write(f"log_{number}.csv", "".join(line.rpartition(",")[0] + "\n" for line in lines)))
        cls.made = cls.folder / "made"
        cls.told, _ = cls.calibrate(cls.made)

    @classmethod
    def write(cls, name, text):
        (cls.folder / name).write_text(text)
        return cls.folder / name

    @classmethod
    def calibrate(cls, out, *more, log=None, recipe=None, code=0):
        return run("calibrate", recipe or cls.recipe, "--log", *(log or cls.log), "-o", out, *more, code=code)

    @classmethod
    def with_pool(cls, name):
        """A folder that has the rooms' days already, for another log of the same holds."""
        return shutil.copytree(cls.made, cls.folder / name)

    @classmethod
    @functools.cache
    def held(cls):
        """Of a log whose pulses last 12 s each: folder, events, what is told."""
        events = ["time,sensor,state"]
        for minute in range(60):
            for sensor, second in (("a", 0), ("b", 20)):
                for s, state in ((second, "on"), (second + 12, "off")):
                    events.append(f"2026-03-02T08:{minute:02d}:{s:02d},{sensor},{state}")
        folder = cls.folder / "held"
        return folder, events, cls.calibrate(folder, log=[cls.write("twelve.csv", "\n".join(events) + "\n")])[1]

    def same(self, folder):
        for name in MADE:
            self.assertEqual((folder / name).read_bytes(), (self.made / name).read_bytes(), name)

    def test_shards_threads_and_a_resumed_one_make_the_same_bytes(self):
        shards = self.folder / "shards"
        self.calibrate(shards, "--shard", "1/3", "--threads", "1", "-q")
        self.assertFalse((shards / "counter.json").exists())
        self.calibrate(shards, "--shard", "2/3", "-q")
        _, told = self.calibrate(shards, "--finish", "-q", code=3)
        self.assertIn("4 of 10 room-days aren't there yet", told)
        self.calibrate(shards, "--shard", "3/3", "-q")
        self.calibrate(shards, "--finish", "-q", "--threads", "1")
        self.same(shards)
        gone = next((shards / "pool" / "rows").rglob("*.csv.gz"))
        gone.unlink()
        self.calibrate(shards, "-q")
        self.same(shards)

    def test_the_folder_has_what_outputs_are_checked_for(self):
        self.assertEqual({file.name for file in self.made.iterdir()},
                         {"recipe.yaml", "weights.csv", "counter.json", "calibration.json", "calibration.html", "pool"})

    def test_no_command_gets_a_log_that_isn_t_plausible_and_each_names_what_it_reads(self):
        log, out = self.folder / "implausible.csv", self.folder / "nothing"
        study = "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml"
        calls = {"log": (log,), "control": ("--log", log, "--delay", "5"), "count": (self.made / "counter.json", "--log", log),
                 "calibrate": (self.recipe, "--log", log, "-o", out), "reconcile": (*study, "--measured", log)}
        commands = re.findall(r"^  (\w+) ", run("--help")[0].split("Subcommands:")[1].split("Examples:")[0], re.M)
        offer = {name for name in commands if re.search(r"--(log|measured) ", run(name, "--help")[0])}
        self.assertEqual(offer | {"log"}, set(calls))
        for kind, (text, told) in IMPLAUSIBLE.items():
            log.write_text(text)
            for command, words in calls.items():
                with self.subTest(kind=kind, command=command):
                    self.assertIn(told, run(command, *words, code=3)[1])
        log.write_text("time,a_motion,heating,temperature\n" + "".join(f"{at(i)},{i // 7 % 2},{i // 9 % 2},21.5\n" for i in range(1, 200)))
        for command in ("control", "count", "calibrate"):  # two of them want another number of sensors, and say so then
            told = subprocess.run([PIRSIM, command, *calls[command]], capture_output=True, encoding="utf-8").stderr
            self.assertIn("1 sensor, no counts: a_motion; not read: heating, temperature\n", told, command)
        self.assertIn("Not read: heating, temperature.", run("log", log)[0])

    def test_the_verdict_is_told_and_weights_add_up(self):
        numbers = json.loads((self.made / "calibration.json").read_text())
        self.assertIn(numbers["finding"], self.told)
        weights = [float(row["weight"]) for row in table(self.made / "weights.csv")]
        self.assertEqual(len(weights), 10)
        self.assertAlmostEqual(sum(weights), 1.0)
        self.assertAlmostEqual(1 / sum(w * w for w in weights), numbers["effective_rooms"])

    def test_the_weighted_recipe_makes_a_dataset_of_weighty_rooms(self):
        out = self.folder / "weighted"
        run("dataset", self.made / "recipe.yaml", "-o", out, "-q", "--set", "draw_by.count=2")
        rooms = {path.read_bytes() for path in (self.made / "pool" / "rooms").iterdir()}
        for path in (out / "rooms").iterdir():
            self.assertIn(path.read_bytes(), rooms)
        first = next((out / "rows").rglob("*.csv.gz")).read_bytes()
        self.assertNotIn(first, [path.read_bytes() for path in (self.made / "pool" / "rows").rglob("*.csv.gz")])

    def test_the_hold_of_an_event_log_is_that_of_the_rooms(self):
        held, _, told = self.held()
        self.assertIn("hold motion for 12.0 s", told)
        holds = {row["value"] for row in table(held / "pool" / "effects.csv")
                 if row["parameter"] == "hold_s"}
        self.assertEqual(holds, {"12"})

    def test_a_recipe_comes_through_a_pipe_and_another_log_finds_the_same_rooms(self):
        piped = self.folder / "piped"
        words = [PIRSIM, "calibrate", "-", "--log", self.log[0], "-o", piped, "-q", "--hold", "3"]
        subprocess.run(words, input=self.recipe.read_bytes(), check=True, timeout=600)
        rows = {path: path.stat().st_mtime_ns for path in (piped / "pool" / "rows").rglob("*.csv.gz")}
        words[4] = self.log[1]
        subprocess.run(words, input=self.recipe.read_bytes(), check=True, timeout=600)
        self.assertEqual(rows, {path: path.stat().st_mtime_ns for path in rows})
        self.assertIn("hold_s: 3", (piped / "recipe.yaml").read_text())

    def test_days_that_are_not_compared_are_told_before_the_work(self):
        lines = self.log[0].read_text().splitlines(keepends=True)
        late = self.write("late.csv", lines[0] + "".join(lines[len(lines) // 2:]))
        made = self.with_pool("late")
        told = self.calibrate(made, log=[late])[1]
        self.assertRegex(told, r"of the log are compared none of 1 day, .*no verdict(.|\n)*wrote .*datapackage.json")
        numbers = json.loads((made / "calibration.json").read_text())
        self.assertEqual((numbers["days"], numbers["verdict"]), (0, "too-little-told"))
        self.assertEqual(numbers["partial_days"], [datetime.date.fromisoformat(lines[1][:10].replace("/", "-")).isoformat()])

    def test_a_day_with_an_outage_is_not_compared(self):
        events = ["time,sensor,state"]
        for day in (2, 3):
            for sensor in "AB":
                events.append(f"2026-03-0{day}T07:59:00,{sensor},off")
                events += [f"2026-03-0{day}T08:{minute:02d}:00,{sensor},{'on' if minute % 2 else 'off'}"
                           for minute in range(60) if day == 2 or minute < 20 or minute > 30]
        events += [f"2026-03-03T08:20:00,{sensor},unavailable" for sensor in "AB"]
        log = self.write("outage.csv", "\n".join([events[0], *sorted(events[1:])]) + "\n")
        made = self.folder / "outage"
        told = self.calibrate(made, log=[log])[1]
        self.assertIn("1 of 2 days, from 8:00 to 9:00: on 2026-03-03 a sensor is known for less than nine tenths", told)
        self.assertEqual(json.loads((made / "calibration.json").read_text())["partial_days"], ["2026-03-03"])

    def test_the_rows_of_a_log_are_counted_as_the_log_is(self):
        """Also of readings that come a little more slowly than the usual window, so that another counter's step is theirs."""
        start = datetime.datetime(2026, 3, 2, 8)
        lines = [f"{(start + datetime.timedelta(seconds=30.6 * i)).isoformat(timespec='milliseconds')},{i // 7 % 2},{i % 11 // 10}"
                 for i in range(170)]
        log = self.write("slow.csv", "time,A,B\n" + "\n".join(lines) + "\n")
        made, rows = self.folder / "slow", self.folder / "slow_rows.csv"
        self.calibrate(made, log=[log], code=0)
        self.assertEqual(json.loads((made / "counter.json").read_text())["step_s"], 31)
        run("log", log, "-o", rows, "-q")
        counts = [run("count", made / "counter.json", "--log", one, "-q")[0] for one in (log, rows)]
        self.assertEqual(*counts)

    def test_counts_are_told_beside_the_logs_own_and_make_a_page(self):
        out, page = self.folder / "counts.csv", self.folder / "counts.html"
        _, told = run("count", self.made / "counter.json", "--log", *self.labelled, "-o", out, "--report", page)
        counts = {row["time"]: row for row in table(out)}
        self.assertRegex(told, r"Somebody is there for [0-9.]+ h; the number is told with 80 % or more for [0-9.]+ h of them")
        self.assertIn('"low":', page.read_text())  # of the range drawn behind the counts
        errors = []
        for file in self.labelled:
            for row in table(file):
                time = row["Date"].replace("/", "-") + "T" + row["Time"]
                errors.append(abs(int(counts[time]["people"]) - int(row["Room_Occupancy_Count"])))
        self.assertIn(f"wrong by {sum(errors) / len(errors):.2f} people on average, over {len(errors)} readings", told)
        told = [row for row in counts.values() if row["people"]]
        self.assertLess(len(told), len(counts))  # of the night between the days nothing is known
        for row in told:
            p = [float(value) for name, value in row.items() if name[0] == "p" and name[1:].isdigit()]
            self.assertAlmostEqual(sum(p), 1.0, delta=0.0005 * len(p) + 1e-9)
            self.assertAlmostEqual(sum(n * q for n, q in enumerate(p)), float(row["mean"]), delta=0.02)
        self.assertIn("How many people were there?", page.read_text())

    def test_through_a_gap_nobody_is_counted_and_another_hold_is_told(self):
        made, events, _ = self.held()
        self.assertEqual(json.loads((made / "counter.json").read_text())["holds_s"], [12, 12])
        later = [events[0]]
        for line in events[1:]:
            time, sensor, state = line.split(",")
            if not "T08:20" <= time[10:16] < "T08:40":
                later.append(line.replace(":12,a,off", ":19,a,off"))
        later += [f"2026-03-02T08:20:00,{sensor},unavailable" for sensor in "ab"]
        later = self.write("later.csv", "\n".join([later[0], *sorted(later[1:])]) + "\n")
        rows, told = run("count", made / "counter.json", "--log", later)
        self.assertRegex(told, r"warning: 'a' holds motion for 19.0 s in this log, and for 12.0 s")
        self.assertNotIn("'b' holds", told)
        self.assertRegex(told, r"For 0.2 h nothing is known, and no number is told")
        unknown = [row["time"][11:] for row in csv.DictReader(rows.splitlines()) if row["people"] == ""]
        # Twenty minutes less five on either side, of readings of half a minute that are told at their end.
        self.assertEqual((unknown[0], unknown[-1], len(unknown)), ("08:25:30", "08:35:00", 20))
        for row in csv.DictReader(rows.splitlines()):
            self.assertEqual(len({cell == "" for name, cell in row.items() if name != "time"}), 1)

    def test_counting_doesnt_look_at_the_logs_own_counts(self):
        with_counts, _ = run("count", self.made / "counter.json", "--log", *self.labelled, "-q")
        without, _ = run("count", self.made / "counter.json", "--log", *self.log, "-q")
        self.assertEqual(with_counts, without)

    def test_light_by_a_counter_is_the_truth_where_people_are_counted_and_an_interval_where_not(self):
        counter = ("--counter", self.made / "counter.json")
        out = [self.folder / name for name in ("truth.csv", "held.csv", "told.csv", "lit.csv")]
        run("control", "--log", *self.labelled, "--step", 30, "-o", out[0], "-q")
        run("control", "--log", *self.labelled, *counter, "-o", out[1], "-q")
        page = self.folder / "light.html"
        said, _ = run("control", "--log", *self.log, *counter, "-o", out[2], "--light", out[3], "--report", page)
        self.assertIn("Off at P(nobody) of", said)
        self.assertIn("Nobody counted the people of these rows", page.read_text())
        truth, held, told = (list(table(file)) for file in out[:3])
        delays = [row for row in told if row["delay_min"]]
        self.assertEqual([row["nobody"] for row in told[len(delays):]], ["0.5", "0.7", "0.8", "0.9", "0.95", "0.98", "0.99"])
        uncertain = 0
        for so, known, expected in zip(truth, held, delays, strict=False):
            for name in ("false_offs", "dark_h", "lit_empty_h", "lit_h", "switched_on_a_day"):
                self.assertAlmostEqual(float(so[name]), float(known[name]), 5, (so["delay_min"], name))
            self.assertEqual(so["lit_h"], expected["lit_h"])
            uncertain += float(expected["empty_share_high"]) > float(expected["empty_share_low"])
        self.assertGreater(uncertain, 50)
        people = [row["people_light"] for row in table(out[3])]
        counts = [row["people"] for row in csv.DictReader(run("count", counter[1], "--log", *self.log, "-q")[0].splitlines())]
        self.assertEqual(people, counts)
        head, *rows = self.log[0].read_text().splitlines()
        date, time, *bits = rows[-1].split(",")
        last = datetime.datetime.fromisoformat(f"{date} {time}".replace("/", "-"))
        quiet = [f"{last + datetime.timedelta(seconds=30 * i):%Y/%m/%d,%H:%M:%S}" + ",0" * len(bits) for i in range(1, 241)]
        log = self.write("left.csv", "\n".join([head, *rows, *quiet]) + "\n")  # everybody goes home
        run("control", "--log", log, *counter, "-o", out[2], "-q")
        told = list(table(out[2]))[len(delays):]
        self.assertLess(float(told[0]["lit_h"]), float(told[-1]["lit_h"]) - 0.1)
        forward = csv.DictReader(run("count", counter[1], "--log", log, "--forward", "-q")[0].splitlines())
        nobody = [float(row["p0"] or 1.0) for row in forward]
        run("log", log, "--step", 30, "-o", self.folder / "log_rows.csv", "-q")
        bits = [list(row.values())[2:] for row in table(self.folder / "log_rows.csv")]
        for row in told:
            lit, rows = False, 0
            for reading, p in zip(bits, nobody, strict=True):
                lit = "1" in reading or (lit and p < float(row["nobody"]))
                rows += lit and "" not in reading
            self.assertAlmostEqual(float(row["lit_h"]), rows / 120, delta=1 / 60, msg=row["nobody"])  # p0 is rounded
        for wrong, why in ((("--log", *self.log, *counter, "--step", 1), "--step"),
                           ((out[0], *counter), "it counts the people of a --log")):
            self.assertIn(why, run("control", *wrong, code=2)[1])

    def test_what_cant_be_calibrated_or_counted_is_refused_in_words(self):
        three = self.write("three.csv", "time,A,B,C\n2026-03-02T08:00:30,0,1,0\n2026-03-02T08:01:00,1,0,0\n"
                                        "2026-03-02T08:01:30,1,1,1\n")
        out = self.folder / "refused"
        for words, log, more, code in (
                ("the log has 3 sensors, and no room has as many", [three], (), 3),
                ("no such file", [self.folder / "nowhere.csv"], (), 4),
                ("a calibration needs 10 rooms at least, better 60; it has 4", self.log, ("--set", "rooms.0.count=4"), 3),
                ("nothing shorter can be told apart", self.log, ("--step", "10"), 2)):
            _, told = self.calibrate(out, "-q", *more, log=log, code=code)
            self.assertIn(words, told)
            subprocess.run(["rm", "-rf", out], check=True)
        _, told = run("count", self.made / "counter.json", "--log", three, code=3)
        names = json.loads((self.made / "counter.json").read_text())["sensor_names"]
        self.assertIn(f"the counter is for 2 sensors ({', '.join(names)}), and the log has 3: A, B, C", told)
        lines = self.log[0].read_text().splitlines(keepends=True)
        slow = self.write("every_300_s.csv", lines[0] + "".join(lines[10::10]))
        _, told = run("count", self.made / "counter.json", "--log", slow, code=3)
        self.assertIn("the log has a reading every 300 s, and the counter counts by readings of 30 s", told)
        two = self.write("two.csv", "time,A,B\n" + "".join(f"2026-03-02T08:{i // 2:02d}:{i % 2 * 30:02d},{i % 3 // 2},0\n"
                                                          for i in range(40)))
        _, told = run("count", self.made / "counter.json", "--log", two, code=3)
        self.assertIn("has 2: A, B; a map (--map)", told)
        named = self.write("named.yaml", f"pirsim_log: 1\nsensors: {{{names[1]}: A, {names[0]}: B}}\n")
        run("count", self.made / "counter.json", "--log", two, "--map", named)
        counter = json.loads((self.made / "counter.json").read_text())
        del counter["sensor_names"], counter["holds_s"]  # as of older files
        _, told = run("count", self.write("older.json", json.dumps(counter)), "--log", two)
        self.assertIn("it doesn't tell which sensors it is for: the log's are taken for them (A, B)", told)
        for text in ("", "{}", "[1]", '{"pirsim_counter": 2}', (self.made / "counter.json").read_text()[:-50]):
            _, told = run("count", self.write("spoilt.json", text), "--log", self.log[0], code=3)
            self.assertIn("isn't a counter", told)

    def test_a_log_in_utc_asks_for_the_zone(self):
        names = ",".join(json.loads((self.made / "counter.json").read_text())["sensor_names"])
        log = self.write("utc.csv", f"time,{names}\n" + "".join(
            f"2026-03-02T07:{i // 2:02d}:{i % 2 * 30:02d}Z,{i % 3 == 0:d},{i % 5 == 0:d}\n" for i in range(120)))
        _, told = run("count", self.made / "counter.json", "--log", log)
        self.assertIn("--time-zone", told)
        out, told = run("count", self.made / "counter.json", "--log", log, "--time-zone", "Europe/Berlin")
        self.assertNotIn("--time-zone", told)
        self.assertTrue(out.splitlines()[1].startswith("2026-03-02T08:00"), out.splitlines()[1])


if __name__ == "__main__":
    main()
