#!/usr/bin/env python3
"""Rows, faulty and whole, given to control and reconcile: all say the same of them, through files, pipes and
standard input.

Usage: run_rows.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import csv
import gzip
import os
import re
import subprocess

from program import DATA, PIRSIM, Case, main

HEADER = "replicate,trial,time_s,time,phase,people,PIR1,PIR2"


def row(i, bits="0,1", people="1"):
    return f"1,S1,{i},2026-03-02T08:00:{i:02},working,{people},{bits}"


def rows(n=20):
    return [row(i) for i in range(1, n + 1)]


def changed(at, line):
    lines = rows()
    lines[at - 1] = line
    return lines


def run(*args, **kwargs):
    return subprocess.run([PIRSIM, *map(str, args)], capture_output=True, text=True, timeout=120, **kwargs)


# name -> header, lines, how many are known
WHOLE = {
    "as pirsim writes them": (HEADER, rows(), 20),
    "with empty fields": (HEADER, changed(7, row(7, ",", "")), 19),
    "as pandas writes them": (HEADER, changed(7, row(7, "1.0,0.0", "1.0")), 20),
    "with a gap": (HEADER, rows()[:8] + rows()[13:], 15),
    "with a comment": ("# of a room\n" + HEADER, rows(), 20),
    "with empty lines and CRLF": (HEADER + "\r\n\r", [line + "\r" for line in rows()], 20),
}
# name -> header, lines, place and message
FAULTY = {
    "a doubled row": (HEADER, rows()[:9] + rows()[8:], "11:6: error: time_s doesn't grow: 9 after 9"),
    "shuffled rows": (HEADER, rows()[10:] + rows()[:10], "12:6: error: time_s doesn't grow: 1 after 20"),
    "another step": (HEADER, rows() + [row(21).replace(",21,", ",20.5,")],
        "22:6: error: rows are 1 s apart, and this one comes 0.5 s"),
    "longer rows further on": (HEADER, rows(12) + [row(i) for i in range(17, 60, 5)],
        "16:6: error: rows are 1 s apart at first and 5 s here"),
    "a run that comes again": (HEADER, rows() + [row(1).replace("1,S1", "2,S1"), row(21)],
        "23:1: error: this row is of a run whose rows have ended"),
    "a bit of 2": (HEADER, changed(7, row(7, "2,0")), "8:38: error: PIR1: expected 0 or 1, got '2'"),
    "a bit of -1": (HEADER, changed(7, row(7, "0,-1")), "8:40: error: PIR2: expected 0 or 1, got '-1'"),
    "half a bit": (HEADER, changed(7, row(7, "0.5,0")), "8:38: error: PIR1: expected 0 or 1, got '0.5'"),
    "a word": (HEADER, changed(7, row(7, "x,0")), "8:38: error: PIR1: expected 0 or 1, got 'x'"),
    "fewer people than none": (HEADER, changed(7, row(7, people="-2")),
        "8:36: error: people: expected a number of people, got '-2'"),
    "half a person": (HEADER, changed(7, row(7, people="0.5")),
        "8:36: error: people: expected a number of people, got '0.5'"),
    "no time": (HEADER, changed(7, row(7).replace(",7,", ",,")), "8:6: error: time_s: expected a number"),
    "a time that isn't local": (HEADER, changed(7, row(7).replace("2026-03-02T", "")),
        "8:8: error: time: expected a local time"),
    "a comment between": (HEADER, rows()[:9] + ["# " + line for line in rows()[9:]],
        "11:1: error: replicate: expected a whole number, got '# 1'"),
    "a row that is cut": (HEADER, rows() + ["1,S1,21"], "22:1: error: expected 8 fields, got 3"),
    "a misspelt column": (HEADER.replace("people", "peple"), rows(),
        "1:35: error: unknown column 'peple' (did you mean 'people'?)"),
    "a column twice": (HEADER.replace("PIR2", "PIR1"), rows(), "1:47: error: column 'PIR1' appears twice"),
    "other columns": ("second,PIR1", ["1,1"], "1:1: error: these aren't rows"),
    "nothing": ("", [], "1:1: error: expected a line with column names"),
}


class RowsCase(Case):
    def write(self, name, header, lines):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes("\n".join([header, *lines, ""]).encode() if header else b"")
        return path

    def costs(self, *args, delay=0, **kwargs):
        """Of `pirsim control`, at one delay, and what it told."""
        result = run("control", *args, "-o", self.folder / "costs.csv", **kwargs)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.folder / "costs.csv", newline="") as table:
            return next(line for line in csv.DictReader(table) if float(line["delay_min"]) == delay), result.stderr

    def control(self, file, **kwargs):
        """How many rows count; or the refusal."""
        result = run("control", file, "-o", self.folder / "costs.csv", **kwargs)
        if result.returncode == 3:
            return result.stderr
        return round(3600 * float(self.costs(file, **kwargs)[0]["hours"]))

    def reconcile(self, file, **kwargs):
        """The same of rows that are too few to compare, so that nothing is simulated."""
        result = run("reconcile", "--scene", DATA / "rooms/meeting_room.gltf", "--script", DATA / "studies/studyA.yaml",
                     "--measured", file, "-o", self.folder / "out", "-q", **kwargs)
        self.assertEqual(result.returncode, 3, result.stderr)
        few = re.search(r"too little data: (\d+) rows to compare", result.stderr)
        return int(few[1]) if few else result.stderr

    COMMANDS = ("control", "reconcile")


class Agreement(RowsCase):
    def test_every_command_counts_the_rows_that_are_known(self):
        for name, (header, lines, known) in WHOLE.items():
            for command in self.COMMANDS:
                with self.subTest(f"{command}: {name}"):
                    self.assertEqual(getattr(self, command)(self.write("rows.csv", header, lines)), known)

    def test_every_command_refuses_with_the_same_place(self):
        for name, (header, lines, told) in FAULTY.items():
            for command in self.COMMANDS:
                with self.subTest(f"{command}: {name}"):
                    refusal = getattr(self, command)(self.write("rows.csv", header, lines))
                    self.assertIn(f"rows.csv:{told}", str(refusal))

    def test_pipes_and_standard_input_are_read_once(self):
        text = "\n".join([HEADER, *rows(), ""])
        packed = self.folder / "rows.csv.gz"
        packed.write_bytes(gzip.compress(text.encode()))
        for command in self.COMMANDS:
            with self.subTest(command):
                self.assertEqual(getattr(self, command)(packed), 20)
                for i in range(1 if command == "reconcile" else 2):  # control() calls again for what it wrote
                    pipe = self.folder / f"{command}{i}"
                    os.mkfifo(pipe)
                pipe = self.folder / f"{command}0"
                with subprocess.Popen(["sh", "-c", f"cat > '{pipe}'"], stdin=subprocess.PIPE) as writer:
                    writer.stdin.write(text.encode())
                    writer.stdin.close()
                    if command == "control":
                        self.assertEqual(self.costs(pipe)[0]["hours"], "0.005556")
                    else:
                        self.assertEqual(self.reconcile(pipe), 20)
                self.assertEqual(getattr(self, command)("-", input=text), 20)


class Runs(RowsCase):
    def test_rows_of_a_log_are_rows(self):
        times = [f"2026-03-02T23:{minute}:00" for minute in range(50, 60)]
        times += [f"2026-03-03T00:{minute:02}:00" for minute in range(10)]
        log = self.write("log.csv", "time,PIR1,people",
                         [f"{time},{'' if i == 3 else int(i == 5)},{int(i > 2)}" for i, time in enumerate(times)])
        out = self.folder / "rows.csv"
        self.assertEqual(run("log", log, "--step", 60, "-o", out, "-q").returncode, 0)
        of_rows = self.costs(out, delay=2)[0]
        of_log = self.costs("--log", log, "--step", 60, delay=2)[0]
        self.assertEqual(of_rows, of_log)
        self.assertEqual(of_rows["days"], "2")
        self.assertNotEqual(of_rows["occupied_h"], "")

    def test_unknown_bits_are_not_motionless(self):
        lines = [row(i, "1,0" if i == 1 else ",0" if i > 10 else "0,0") for i in range(1, 21)]
        costs, _ = self.costs(self.write("rows.csv", HEADER, lines))
        self.assertEqual((costs["hours"], costs["dark_h"]), ("0.002778", "0.0025"))

    def test_each_file_is_a_run(self):
        one = self.write("one.csv", HEADER, [row(i, "0,1") for i in range(1, 21)])
        other = self.write("other.csv", HEADER, [row(i, "0,0") for i in range(1, 21)])
        for files in ((one, other), (other, one)):
            costs, _ = self.costs(*files, delay=5)
            self.assertEqual((costs["days"], costs["lit_share"]), ("2", "0.5"))

    def test_parts_of_a_log_are_given_once_and_in_order(self):
        parts = [self.write(f"{k}.csv", "time_s,time,PIR1",
                            [f"{i},2026-03-02T08:00:{i:02},{i % 2}" for i in range(1 + 20 * k, 21 + 20 * k)]) for k in (0, 1)]
        costs, _ = self.costs(*parts)
        self.assertEqual((costs["days"], costs["hours"]), ("1", "0.011111"))  # one date
        self.assertIn("give each part of a log once, in order of time", run("control", *reversed(parts)).stderr)
        link = self.folder / "link.csv"
        link.symlink_to(parts[0])
        twice = run("control", parts[0], link)
        self.assertEqual(twice.returncode, 2)
        self.assertIn("is given twice", twice.stderr)

    def test_a_gap_is_told_and_begins_anew(self):
        lines = [row(1), row(2, "0,0"), row(50, "0,0"), row(51, "0,0")]
        costs, told = self.costs(self.write("rows.csv", HEADER, lines), delay=1)
        self.assertIn("warning: 47 rows of 1 s are missing", told)
        self.assertEqual(costs["lit_share"], "1")
        costs, _ = self.costs(self.folder / "rows.csv", delay=0)
        self.assertEqual(costs["lit_share"], "0.25")

    def test_files_of_other_rows_are_refused(self):
        one = self.write("one.csv", HEADER, rows())
        slow = self.write("slow.csv", HEADER, [row(i) for i in range(2, 42, 2)])
        self.assertIn("its rows are 2 s apart, those of", run("control", one, slow).stderr)
        fewer = self.write("fewer.csv", "replicate,trial,time_s,PIR1,PIR2", ["1,S1,1,0,0"])
        self.assertIn("only one of it and", run("control", one, fewer).stderr)

    def test_a_home_without_the_light_of_a_rule_is_not_counted(self):
        header = "room,day,time_s,time,people,presence,arrivals,departures,people_hall,people_den,P_hall,P_den,P_away"
        for room in (1, 2, 3, 4):
            for day in (1, 2):
                has_den = room < 3
                lines = [f"{room},{day},{60 * i},2026-03-0{day}T08:{i:02}:00,1,1,0,0,1,{0 if has_den else ''},"
                         f"{'' if i == 9 else 1},{1 if has_den else ''}," for i in range(1, 60)]
                self.write(f"set/rows/room_{room}/day_{day}.csv", header, lines)
        rule = self.folder / "rule.yaml"
        rule.write_text("pirsim_control: 1\nlights:\n- {area: den, sensors: [P_den], delay_min: 1}\n"
                        "- {area: hall, sensors: [P_hall, P_away], delay_min: 1}\n")
        self.costs(self.folder / "set", "--rule", rule)
        with open(self.folder / "costs.csv", newline="") as table:
            lights = {line["light"]: line for line in csv.DictReader(table) if line["delay_min"] == "1"}
        self.assertEqual((lights["den"]["days"], lights["den"]["hours"]), ("4", "3.933333"))  # 59 rows a day
        self.assertEqual((lights["hall"]["days"], lights["hall"]["hours"]), ("8", "7.733333"))  # one of them unknown
        costs, _ = self.costs(self.folder / "set")  # by any sensor that there is
        self.assertEqual(costs["days"], "8")


class Occupancy(RowsCase):
    """Tables of people by moment are of one run, and comments end before their header."""

    def played(self, text):
        self.write("tracks.csv", text.splitlines()[0], text.splitlines()[1:])
        script = self.folder / "s.yaml"
        script.write_text("pirsim_script: 1\noccupancy: {positions: tracks.csv}\n")
        return run("run", "--scene", DATA / "rooms/open_hall.gltf", "--script", script, "-q")

    def test_positions_of_two_runs_are_refused(self):
        for column in ("replicate", "trial", "room", "day"):
            result = self.played(f"{column},time_s,person,x_m,z_m\n1,0,a,2,-2\n1,3,a,3,-2\n2,0,b,2,-3\n2,3,b,3,-3\n")
            self.assertEqual(result.returncode, 3)
            self.assertIn(f"tracks.csv:4:1: error: rows of more than one run: keep those of one {column}",
                          result.stderr)

    def test_a_person_may_be_called_by_a_number_sign(self):
        lines = self.played("# metres\nid,t,x,z\n#1,0,2,-2\n#1,3,2.5,-2\nb,0,4,-2\nb,3,4,-2.5\n").stdout.splitlines()
        self.assertEqual(lines[0].split(",")[4], "people")
        self.assertEqual([line.split(",")[4] for line in lines[1:]], ["2"] * 3)


if __name__ == "__main__":
    main()
