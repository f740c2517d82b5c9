#!/usr/bin/env python3
"""`pirsim log`: forms through pipes and encodings, Home Assistant's database as Python's sqlite3 writes it, summer time
against Python's zoneinfo, what is refused by name and line, and a year of ten sensors in little memory.

Usage: run_log.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import csv
import datetime
import gzip
import heapq
import io
import os
import pathlib
import random
import re
import shutil
import sqlite3
import subprocess
import zoneinfo

from program import DATA, PIRSIM, Case, main, run

UTC = datetime.timezone.utc

WIDE = "time,A,B\n2025-04-06T18:00:01,0,0\n2025-04-06T18:00:02,1,\n2025-04-06T18:00:03,1,1\n2025-04-06T18:00:04,0,1\n"
ROWS = ("time_s,time,A,B\n1,2025-04-06T18:00:01,0,0\n2,2025-04-06T18:00:02,1,\n3,2025-04-06T18:00:03,1,1\n"
        "4,2025-04-06T18:00:04,0,1\n")


class LogCase(Case):
    def rows(self, *args, **kwargs):
        """Of the log, as text."""
        out = self.folder / "rows.csv"
        run("log", *args, "-q", "-o", out, **kwargs)
        return out.read_text()


class Inputs(LogCase):
    def test_encodings_and_compression(self):
        for encoded in (WIDE.encode(), b"\xef\xbb\xbf" + WIDE.encode(), WIDE.encode("utf-16"), WIDE.encode("utf-16-le"),
                        WIDE.encode("utf-16-be"), "\ufeff".encode("utf-16-be") + WIDE.encode("utf-16-be"),
                        WIDE.replace("\n", "\r\n").encode(), gzip.compress(WIDE.encode("utf-16")), gzip.compress(WIDE.encode())):
            self.assertEqual(self.rows(self.write("log", encoded), "--step", 1), ROWS)

    def test_standard_input_and_pipes(self):
        self.assertEqual(self.rows("-", "--step", 1, input=WIDE), ROWS)
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        with subprocess.Popen(["sh", "-c", f"cat '{self.write('log', WIDE)}' > '{pipe}'"]):
            self.assertEqual(self.rows(pipe, "--step", 1), ROWS)
        with open(self.write("log", WIDE), "rb") as redirected:  # where it stands, and not from its begin
            self.assertEqual(self.rows("-", "--step", 1, stdin=redirected), ROWS)
        costs = self.folder / "costs.csv"
        run("control", "--log", "-", "--delay", 1, "-q", "-o", costs, input=WIDE)
        through = costs.read_text()
        run("control", "--log", self.write("log", WIDE), "--delay", 1, "-q", "-o", costs)
        self.assertEqual(costs.read_text(), through)
        self.assertIn("standard input can be read once", run("log", "-", "-", input=WIDE, code=2)[1])
        self.assertIn("can't both be standard input", run("log", "-", "--map", "-", input=WIDE, code=2)[1])
        self.assertIn("the log is empty", run("log", "-", input="", code=3)[1])

    def test_the_map_that_is_printed_reads_the_log_again(self):
        log = self.write("log.csv", WIDE.replace("time,A,B", '"when, exactly",S\\1,"S ""2"""'))
        printed = run("log", log, "--print-map")[0]
        self.assertTrue(printed.startswith("pirsim_log: 1\n"))
        again = self.write("map.yaml", printed)
        self.assertEqual(run("log", log, "--map", again, "--print-map")[0], printed)
        self.assertEqual(self.rows(log, "--map", again), self.rows(log))

    def test_names_of_the_scene_and_a_count_by_a_map(self):
        log = self.write("log.csv", "t;left;right;n\n10;0;1;0\n20;1;1;2\n30;0;0;3\n")
        chosen = self.write("map.yaml", "pirsim_log: 1\nsensors: {PIR2: right, PIR1: left}\npeople: n\n")
        self.assertEqual(self.rows(log, "--map", chosen, "--step", 10),
                         "time_s,people,PIR2,PIR1\n10,0,1,0\n20,2,1,1\n30,3,0,0\n")
        for text, told in (("sensors: {P: lefd}", "there is no column 'lefd' (did you mean 'left'?)"),
                           ("people: m", "there is no column 'm'"), ("time: [t, n, left, right]", "map.yaml:2:7: error: time: expected a column"),
                           ("sensor: {A: left}", "map.yaml:2:9: error"), ("senors: [left]", "did you mean 'sensors'?"),
                           ("time_zone: Europe/Berlim", "did you mean 'Europe/Berlin'?"), ("form: tall", "map.yaml:2:7"),
                           ("interval_s: -1", "interval_s"), ("sensors: {A: left, B: left}", "map.yaml:2:23: error: sensors: 'left' is named twice")):
            bad = self.write("map.yaml", f"pirsim_log: 1\n{text}\n")
            self.assertIn(told, run("log", log, "--map", bad, "-q", code=3)[1])

    def test_rows_of_a_run_come_back(self):
        rows = self.folder / "run.csv"
        study = ("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml")
        run(*study, "--set", "replicates=1", "-o", rows, "-q")
        lines = rows.read_text().splitlines()
        first = [line for line in lines[1:] if line.split(",")[1] == lines[1].split(",")[1]]
        log = self.write("one.csv", "\n".join([lines[0], *first]) + "\n")
        got = list(csv.reader(io.StringIO(self.rows(log, "--step", 1))))
        self.assertEqual(got[0], ["time_s", "people", *lines[0].split(",")[5:]])
        self.assertEqual([row[1:] for row in got[1:]], [line.split(",")[4:] for line in first])
        self.assertIn("another run begins here", run("log", rows, code=3)[1])


class Time(LogCase):
    def test_summer_time_is_as_python_s_zoneinfo_has_it(self):
        draw = random.Random(5)
        for name, days in (("Europe/Berlin", ("2025-03-29", "2025-10-25")), ("America/New_York", ("2024-03-09", "2024-11-02")),
                           ("Australia/Lord_Howe", ("2025-04-05", "2025-10-04")), ("Asia/Kolkata", ("2025-06-01",)),
                           ("Africa/Cairo", ("2024-04-25", "2024-10-31"))):
            zone = zoneinfo.ZoneInfo(name)
            for day in days:
                begin = datetime.datetime.fromisoformat(day).replace(tzinfo=zone).astimezone(UTC)
                moments = [begin] + sorted(begin + datetime.timedelta(seconds=draw.randrange(60, 3 * 86400)) for _ in range(200))
                text = "entity_id,state,last_changed\n" + "".join(
                    f"binary_sensor.a,{'on' if i % 2 else 'off'},{moment:%Y-%m-%dT%H:%M:%S}.000Z\n" for i, moment in enumerate(moments))
                chosen = self.write("map.yaml", f"pirsim_log: 1\ntime_zone: {name}\n")
                rows = list(csv.DictReader(io.StringIO(self.rows(self.write("log.csv", text), "--map", chosen, "--step", 300))))
                for i, row in enumerate(rows):
                    end = begin + datetime.timedelta(seconds=300 * (i + 1))
                    self.assertEqual(row["time"], end.astimezone(zone).strftime("%Y-%m-%dT%H:%M:%S"))
                    begun = [k for k, moment in enumerate(moments) if moment < end]
                    on = any(k % 2 and (k + 1 == len(moments) or moments[k + 1] > end - datetime.timedelta(seconds=300)) for k in begun)
                    if i + 1 < len(rows):
                        self.assertEqual(row["binary_sensor.a"], "1" if on else "0", (name, day, i))

    def test_local_times_of_a_zone_as_zoneinfo_has_them(self):
        zone = zoneinfo.ZoneInfo("Europe/Berlin")
        begin = datetime.datetime(2025, 10, 25, 22, tzinfo=UTC)
        readings = [begin + datetime.timedelta(minutes=10 * (i + 1)) for i in range(150)]
        text = "time,A\n" + "".join(f"{moment.astimezone(zone):%Y-%m-%d %H:%M},{int(i % 7 == 0)}\n" for i, moment in enumerate(readings))
        chosen = self.write("map.yaml", "pirsim_log: 1\ntime_zone: Europe/Berlin\n")
        log = self.write("log.csv", text)
        rows = list(csv.DictReader(io.StringIO(self.rows(log, "--map", chosen, "--step", 600))))
        self.assertEqual([row["A"] for row in rows], [str(int(i % 7 == 0)) for i in range(150)])
        self.assertEqual([row["time"] for row in rows], [f"{moment.astimezone(zone):%Y-%m-%dT%H:%M:%S}" for moment in readings])
        told = run("log", log, "--map", chosen)[1]
        self.assertRegex(told, r"log.csv:13: warning: clocks were put back .*; 11 more like this")
        self.assertIn("clocks were put back", run("log", log, code=3)[1])


# What is refused: content, what is told, with its place.
REFUSED = {
    "nothing": (b"", "log:1:1: error: the log is empty"),
    "blank lines": (b"\n\n ,\n", "log:1:1: error: the log is empty"),
    "names alone": (b"time,A\n", "log:1:1: error: there are names of columns, but no row"),
    "binary": (b"\x00\x01\x02\x03\x04", "log:1:1: error: a NUL character"),
    "a zero byte": (b"time,A\n1,0\n2,\x001\n", "log:3:3: error: a NUL character"),
    "not UTF-8": (b"time,A\n1,0\n2,\xff\n", "log:3:3: error: not UTF-8: byte 0xFF"),
    "UTF-32": ("time,A\n".encode("utf-32"), "UTF-32 isn't read"),
    "a workbook": (b"PK\x03\x04abcdefghijkl", "a workbook or another archive"),
    "JSON": (b'[{"entity_id": "a"}]', "log:1:1: error: no column holds times"),
    "JSON without objects": (b'[[1, 2], [3]]', "log:1:1: error: expected a table, got JSON without a list of objects"),
    "JSON of lines": (b'{"occupancy":true}\n', "log:1:1: error: no column holds times"),
    "another program's text": (b"[13:05:10] something moved\n", "log:1:1: error: expected a table, got lines of a text"),
    "an openHAB log without a change": (b"2024-01-31 18:00:00.000 [INFO ] [openhab.event.ThingAddedEvent] - Thing 'a'\n",
                                        "none of the lines of openHAB's log tells that a sensor changed"),
    "an interval that ends before it begins": (b"start,end,sensor\n0,5,A\n9,7,A\n", "log:3:3: error: it ends at '7', before it begins at '9'"),
    "a page": (b"<html>", "got XML or a page"),
    "two columns of one name": (b"time,A,A\n1,0,0\n", "log:1:1: error: column 'A' appears twice"),
    "too few fields": (b"time_s,A\n1,0\n2\n3,1\n4\n", "log:3:1: error: expected 2 fields, got 1\n"),
    "too many fields": (b"time,A\n1,0\n2,0,1\n", "log:3:1: error: expected 2 fields, got 3"),
    "mixed separators": (b"time;A\n1;0\n2,1\n", "log:3:1: error: expected 2 fields, got 1"),
    "mixed forms": (b"time_s,A\n1,0\n2,1\nentity_id,state,last_changed\n", "log:4:1: error: expected 2 fields, got 3"),
    "an open quote": (b'time,A\n1,0\n"2,1\n', "log:3:1: error: a quote that isn't closed"),
    "no time": (b"a,b,c\nx,y,z\n", "log:1:1: error: no column holds times"),
    "a time that can't be read": (b"time,A\n2025-04-06 18:00:00,0\nyesterday,1\n2025-04-06 18:00:02,0\n",
                                  "log:3:1: error: 'yesterday' is no time that can be read"),
    "a day that isn't": (b"time,A\n2025-02-27 18:00:00,0\n2025-02-28 18:00:00,0\n2025-02-29 18:00:00,1\n", "log:4:1: error: '2025-02-29"),
    "mixed times": (b"time,A\n2025-04-06 18:00:00,0\n1743962401,1\n", "log:3:1: error: '1743962401' is another kind of time"),
    "an unset clock": (b"time,A\n1970-01-01T00:00:05,0\n1970-01-01T00:00:06,1\n", "log:2: error: '1970-01-01T00:00:05' is in the year 1970"),
    "a far year": (b"time,A\n9999-12-31T00:00:00,0\n9999-12-31T00:00:01,1\n", "in the year 9999"),
    "a number that is no time": (b"time,A\n1e300,0\n1e301,1\n", "log:2:1: error: 1e+300 is too large"),
    "a date that may be two": (b"Date,Time,A\n01/02/2017,10:00:00,0\n01/02/2017,10:00:30,1\n", "{pirsim_log: 1, dates: month_first}"),
    "duplicates and steps back": (b"time,A\n1,0\n1,0\n2,1\n2,0\n3,0\n4,0\n", "log:3:1: error: 2 of 6 rows would be left out; of this one a second reading has the same time"),
    "two forms": (b"time,A\n0,0\n100,1\n200,0\n", "{pirsim_log: 1, rows: readings}, or {pirsim_log: 1, rows: changes}"),
    "one reading": (b"time,A\n5,1\n", "one reading alone"),
    "no sensor": (b"time,T\n1,21.5\n2,21.6\n", "T ('21.5')"),
    "no sensor among events": (b"time,sensor,state\n1,A,open\n2,A,closed\n", "'closed' and 'open' in 'state' may be states"),
    "an invisible name": (b"time,\x1b[31mA\n1,0\n2,1\n", "contains the control character U+001B"),
    "an invisible sensor": (b"time,sensor,state\n1,A\x1b,on\n2,A\x1b,off\n", "U+001B"),
    "an endless line": (b"time,A\n" + b"1" * 3_000_000, "log:2:1: error: a line longer than 1 MB"),
    "many columns": (b"time" + b",".join(b"c%d" % i for i in range(20_000)) + b"\n1\n", "more than 10000 fields"),
    "damaged gzip": (gzip.compress(WIDE.encode())[:-12], "is cut short"),
}

# What is read, and told: content, rows of windows of 1 s, remarks.
TOLD = {
    "a duplicate": ("time,A\n1,0\n1,0\n2,1\n3,0\n", "0,1,0",
                    ["log:3: warning: a second reading has the same time: the row is left out"]),
    "a step back": ("time,A\n1,0\n2,1\n3,1\n2,0\n4,0\n5,0\n", "0,1,1,0,0", ["log:5: warning: the times step back here"]),
    "states that nobody knows": ("time,A_pir\n1,0\n2,broken\n3,unavailable\n4,1\n5,1\n", "0,,,1,1",
                                 ["log:3: warning: 'broken' is no state of 'A_pir': it counts as unknown"]),
    "a sensor that never changes": ("time,A,B\n1,0,1\n2,1,1\n3,0,1\n", "0,1,0", ["sensor 'B' is never off"]),
    "events out of order": ("time,sensor,state\n1,A,off\n5,A,on\n3,A,on\n4,A,off\n4,A,off\n6,A,off\n", "0,0,1,0,1,",
                            ["log:4: warning: the times of 'A' step back here", "log:6: warning: an event of 'A' stands here a second time"]),
    "two labels of an activity": ("2026-03-03 07:00:00 A ON x begin\n2026-03-03 07:00:00 A ON y end\n2026-03-03 07:00:02 A OFF\n", "1,1,", []),
    "a lost reading": ("time,A\n1,0\n2,1\n3,0\n4,0\n6,0\n7,1\n", "0,1,0,0,,0,1", []),
}


# What binary sensors say, (second, entity, state): a removed entity has no state, and "unavailable" isn't off.
HOME = [(0, "binary_sensor.hall_motion", "off"), (0, "binary_sensor.desk_motion", "unavailable"), (0, "sensor.hall", "21.5"),
        (2, "binary_sensor.hall_motion", "on"), (3, "binary_sensor.desk_motion", "off"), (5, "binary_sensor.hall_motion", "off"),
        (6, "binary_sensor.desk_motion", "on"), (7, "sensor.hall", "21.6"), (8, "binary_sensor.desk_motion", ""),
        (9, "binary_sensor.hall_motion", "on"), (10, "binary_sensor.hall_motion", "off")]
HOME_ROWS = {"hall": "0011100001.", "desk": "...00011..."}
START = datetime.datetime(2026, 3, 2, 7, tzinfo=UTC)


class Database(LogCase):
    def make(self, version, old=lambda second: False, name="home-assistant_v2.db", runs=()):
        """A database of that schema; `old(second)`: rows that weren't brought to it yet."""
        path = self.folder / name
        path.unlink(missing_ok=True)
        base = sqlite3.connect(path)
        base.execute("PRAGMA journal_mode=WAL")
        base.execute("CREATE TABLE schema_changes (change_id INTEGER PRIMARY KEY, schema_version INTEGER)")
        base.execute("INSERT INTO schema_changes (schema_version) VALUES (?)", (version,))
        base.execute("CREATE TABLE recorder_runs (run_id INTEGER PRIMARY KEY, start DATETIME, end DATETIME)")
        columns = ["entity_id TEXT", "state TEXT", "last_changed DATETIME", "last_updated DATETIME"]
        columns += ["last_changed_ts FLOAT", "last_updated_ts FLOAT"] if version >= 31 else []
        columns += ["metadata_id INTEGER"] if version >= 38 else []
        base.execute(f"CREATE TABLE states (state_id INTEGER PRIMARY KEY, {', '.join(columns)})")
        base.execute("CREATE TABLE states_meta (metadata_id INTEGER PRIMARY KEY, entity_id TEXT)") if version >= 38 else None
        entities = sorted({entity for _, entity, _ in HOME})
        if version >= 38:
            base.executemany("INSERT INTO states_meta VALUES (?, ?)", enumerate(entities))
        text = lambda second: (START + datetime.timedelta(seconds=second)).strftime("%Y-%m-%d %H:%M:%S.%f")
        changed = {}
        for second, entity, state in sorted([*HOME, (4, "binary_sensor.hall_motion", "on")]):  # whose attributes change
            is_attribute = changed.get(entity, (0, ""))[1] == state
            changed[entity] = changed[entity] if is_attribute else (second, state)
            row = {"state": state}
            if version < 31 or old(second):
                row |= {"last_updated": text(second), "last_changed": text(changed[entity][0])}
            else:
                row |= {"last_updated_ts": START.timestamp() + second}
                row |= {"last_changed_ts": START.timestamp() + changed[entity][0]} if is_attribute else {}
            row |= {"metadata_id": entities.index(entity)} if version >= 38 and not old(second) else {"entity_id": entity}
            base.execute(f"INSERT INTO states ({', '.join(row)}) VALUES ({', '.join('?' * len(row))})", list(row.values()))
        base.executemany("INSERT INTO recorder_runs (start, end) VALUES (?, ?)",
                         [(text(start), None if end is None else text(end)) for start, end in runs])
        base.commit()
        return path, base

    def motion(self, *args, **kwargs):
        rows = list(csv.DictReader(io.StringIO(self.rows(*args, "--step", 1, **kwargs))))
        return {name: "".join(row[f"binary_sensor.{name}_motion"] or "." for row in rows) for name in HOME_ROWS}, rows[0]["time"]

    def test_every_schema_and_half_of_one(self):
        for version, old in ((25, lambda s: False), (31, lambda s: False), (35, lambda s: s > 4), (38, lambda s: False),
                             (48, lambda s: s < 6), (48, lambda s: s % 2)):
            with self.subTest(version):
                path, base = self.make(version, old)
                base.close()
                before = path.read_bytes()
                self.assertEqual(self.motion(path), (HOME_ROWS, "2026-03-02T07:00:01"))
                self.assertEqual((path.read_bytes(), [one.name for one in self.folder.iterdir() if one.name.startswith("home")]),
                                 (before, [path.name]))
        told = run("log", path)[0]
        self.assertIn("events of Home Assistant's database, 2 sensors, no counts; 2026-03-02T07:00:00 to 2026-03-02T07:00:10 (10 s), 9 rows", told)
        (self.folder / "map.yaml").write_text(run("log", path, "--print-map")[0])
        self.assertEqual(self.motion(path, "--map", self.folder / "map.yaml")[0], HOME_ROWS)

    def test_while_home_assistant_is_running_and_in_a_copy_that_can_t_be_written_to(self):
        path, base = self.make(48)  # what was written last stands in the -wal file
        self.assertEqual(self.motion(path)[0], HOME_ROWS)
        base.close()
        only = self.folder / "read only"
        only.mkdir()
        copy = pathlib.Path(shutil.copy(path, only / "50 % copy?#.db"))
        copy.chmod(0o444)
        only.chmod(0o555)
        self.addCleanup(only.chmod, 0o755)
        self.assertEqual(self.motion(copy)[0], HOME_ROWS)

    def test_nothing_is_known_while_home_assistant_wasn_t_running(self):
        path, base = self.make(48, runs=[(-100, -50), (0, 5.5), (8.5, None)])
        base.close()
        self.assertEqual(self.motion(path)[0], {"hall": "00111....1.", "desk": "...00.11..."})

    def test_after_a_crash_nothing_is_known_from_the_last_state_on(self):
        for version, end in ((25, None), (48, 8.5)):  # which Home Assistant writes when it begins again
            with self.subTest(version):
                path, base = self.make(version, runs=[(0, end), (8.5, None)])
                base.execute("ALTER TABLE recorder_runs ADD COLUMN closed_incorrect BOOLEAN")
                base.execute("UPDATE recorder_runs SET closed_incorrect = 1 WHERE run_id = 1")
                base.commit()
                base.close()
                rows = self.motion(path)[0]
                self.assertEqual({name: row[8] for name, row in rows.items()}, {"hall": ".", "desk": "."})
                self.assertEqual(rows["hall"][:5], HOME_ROWS["hall"][:5])

    def test_other_databases_and_other_ways(self):
        path, base = self.make(48)
        base.close()
        with open(path) as stream:
            self.assertIn("got a database (SQLite)", run("log", "-", stdin=stream, code=3)[1])
        other = sqlite3.connect(self.folder / "other.sqlite")
        other.execute("CREATE TABLE frames (x REAL)")
        other.commit()
        other.close()
        self.assertIn("a database (SQLite) that isn't Home Assistant's: it has no table of states",
                      run("log", self.folder / "other.sqlite", code=3)[1])
        endless = sqlite3.connect(self.folder / "endless.db")
        endless.execute("CREATE VIEW states AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
                        "SELECT i AS state_id, 'binary_sensor.a' AS entity_id, 'on' AS state, i AS last_updated_ts FROM n")
        endless.commit()
        endless.close()
        self.assertIn("has views", run("log", self.folder / "endless.db", code=3)[1])  # and ends
        self.assertIn("expected a text, got a database (SQLite)", run("control", path, "--delay", 5, code=3)[1])
        self.assertIn("expected a text, got a database (SQLite)", run("log", path, "--map", path, code=3)[1])
        (self.folder / "cut.db").write_bytes(path.read_bytes()[:6000])
        self.assertIn("can't be read", run("log", self.folder / "cut.db", code=4)[1])


class Odd(LogCase):
    def test_what_can_t_be_read_is_refused_by_name_and_line(self):
        for kind, (content, told) in REFUSED.items():
            log = self.write("log", content)
            with self.subTest(kind):
                self.assertIn(told, run("log", log, code=3)[1])
        self.assertIn("no such file", run("log", self.folder / "none", code=4)[1])
        self.assertIn("is a directory", run("log", self.folder, code=4)[1])
        self.assertIn("FILE is missing", run("log", code=2)[1])

    def test_oddities_are_told_a_kind_once(self):
        for kind, (content, rows, remarks) in TOLD.items():
            log = self.write("log", content)
            with self.subTest(kind):
                told = run("log", log)[1]
                self.assertEqual(told.count("warning"), len(remarks), told)
                for remark in remarks:
                    self.assertIn(remark, told)
                got = list(csv.reader(io.StringIO(self.rows(log, "--step", 1))))
                first = got[0].index("A") if "A" in got[0] else 1
                self.assertEqual(",".join(row[first] for row in got[1:]), rows)

    def test_options_that_don_t_fit(self):
        log = self.write("log.csv", WIDE)
        for args, told in ((("--step", 0), "a window lasts"), (("--step", 1e9), "a window lasts"), (("--from", "noon"), "from: 'noon' is no time"),
                           (("--from", "2025-04-06T19:00"), "nothing of the log is between"), (("--from", "30"), "from: '30' is no time"),
                           (("--from", "2025-04-06T18:00:03", "--to", "2025-04-06T18:00:02"), "expected a time after from"),
                           (("-o", log), "it would be overwritten"), (("--report", "page.txt"), ".html")):
            output = () if args[0] in ("-o", "--report") else ("-o", self.folder / "rows.csv")
            self.assertIn(told, run("log", log, *args, *output, code=2)[1])
        page = self.folder / "log.html"
        run("log", log, self.write("next.csv", WIDE.replace("04-06", "04-07")), "-q", "--report", page)
        self.assertIn("log and 1 more", re.search("<title>(.*?)</title>", page.read_text())[1])
        self.assertEqual(self.rows(log, "--step", 1, "--from", "2025-04-06T18:00:01", "--to", "2025-04-06T18:00:03"),
                         ROWS.splitlines()[0] + "\n1,2025-04-06T18:00:02,1,\n2,2025-04-06T18:00:03,1,1\n")


class Long(LogCase):
    def test_a_million_events_in_little_memory_and_time(self):
        def events(sensor):
            draw, at = random.Random(sensor), datetime.datetime(2024, 1, 1)
            for _ in range(50_000):
                at += datetime.timedelta(seconds=round(60 + draw.expovariate(1 / 500), 3))
                yield at, f"M{sensor:03} ON"
                yield at + datetime.timedelta(seconds=2), f"M{sensor:03} OFF"

        log = self.folder / "log.txt"
        with log.open("w") as out:  # one after the other: a child's memory counts what its parent had
            out.writelines(f"{at.isoformat(' ', 'microseconds')} {what}\n" for at, what in heapq.merge(*map(events, range(10))))
        process = subprocess.Popen([PIRSIM, "log", log, "-q", "-o", self.folder / "rows.csv", "--report", self.folder / "year.html"])
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        if "PIRSIM_SANITIZED" not in os.environ:
            self.assertLess(used.ru_maxrss, 150_000)  # kB; the file has 40 MB
            self.assertLess(used.ru_utime, 60.0)
        self.assertLess((self.folder / "year.html").stat().st_size, 3_000_000)
        on = sum(row.count("1") for row in re.findall(r",([01,]+)$", (self.folder / "rows.csv").read_text(), re.M))
        self.assertGreater(on, 490_000)


if __name__ == "__main__":
    main()
