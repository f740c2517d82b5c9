#!/usr/bin/env python3
"""Long work says what it does, how far it is and how long it will take; and what would get larger than anybody expects
is told before it is made. Each piece of work here would last for minutes; it is watched until it has told, then ended.

Usage: run_long_work.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import json
import os
import pty
import re
import select
import signal
import subprocess
import time

from program import DATA, PIRSIM, Case, main

LEFT = r"\d+ (s|min|h \d+ min) left"


class LongWork(Case):
    def setUp(self):
        super().setUp()
        self.room = ["--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml"]
        self.office = ["--scene", DATA / "rooms" / "open_office.gltf", "--script", DATA / "studies" / "office_week.yaml"]

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def told(self, pattern, *args, terminal=True, seconds=120.0, stops=None):
        """What standard error says up to the pattern. `stops`: the exit code with which SIGTERM ends it then."""
        ours, theirs = pty.openpty() if terminal else os.pipe()
        process = subprocess.Popen([PIRSIM, *args], stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        text, ends = "", time.monotonic() + seconds
        try:
            while time.monotonic() < ends and not re.search(pattern, text):
                if not select.select([ours], [], [], 0.5)[0]:
                    continue
                try:
                    more = os.read(ours, 65536)
                except OSError:  # the terminal is closed
                    break
                if not more:
                    break
                text += more.decode()
            if stops is not None:
                process.send_signal(signal.SIGTERM)
                self.assertEqual(process.wait(timeout=seconds), stops)
        finally:
            process.kill()
            process.wait()
            os.close(ours)
        self.assertRegex(text, pattern)
        return text

    def test_many_runs(self):
        for terminal in (True, False):
            with self.subTest(terminal=terminal):
                self.told(rf"simulating: \d+ of 1000000 runs, .*{LEFT}", "run", *self.room, "--replicates", "100000",
                          "-o", self.folder / "rows.csv", terminal=terminal)

    def test_one_run_tells_before_it_ends(self):
        script = self.write("long.yaml", {"pirsim_script": 1, "duration_s": 1e6, "people": [
            {"id": "p", "style": "natural", "actions": [{"enter": "door"}, {"sit": "S1"}, {"work": {"duration_s": 1e6}}]}]})
        study = ["--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script]
        told = rf"\d+ of 1000000 s simulated, {LEFT}"
        self.told("simulating: " + told, "run", *study, "-o", self.folder / "rows.csv")
        self.told("simulating: " + told.replace("1000000", "900000"), "view", *study, "--from", "899900",
                  "--to", "900000", "-o", self.folder / "p.html", stops=75)
        self.told("simulating up to that moment: " + told.replace("1000000", "900000"), "preview", *study,
                  "--time", "900000", "-o", self.folder / "p.png")
        self.told("simulating and filming: " + told, "export", *study, "--large", "-o", self.folder / "p.glb", stops=75)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.startswith("p.")], [])

    def test_a_recipe_of_many_rooms(self):
        recipe = self.write("recipe.yaml", "pirsim_recipe: 1\nrooms: [{count: 100000}]\ndays: 10\n")
        self.told(rf"drawing and checking all rooms before the first day: \d+ of 100000 rooms, {LEFT}", "dataset", recipe,
                  "-o", self.folder / "D", stops=75)

    def test_surveys(self):
        self.told(rf"moving a target over the floor: \d+ of \d+ rows of squares, {LEFT}", "coverage",
                  "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyB.yaml",
                  "--set", "spacing_m=0.01", "-o", self.folder / "maps", stops=75)
        self.told(rf"scoring sets of sensors: \d+ of \d+ sets, {LEFT}", "placements",
                  "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "placements.yaml",
                  "--set", "search.evaluations=100000", stops=75)

    def test_a_search_by_seats_tells_all_sets(self):
        told = self.told(r"\x1b\[K\r\x1b\[K", "placements", "--scene", DATA / "rooms" / "meeting_room.gltf", "--script",
                         DATA / "studies" / "placements.yaml", "--set", "by=seats", "--set", "search.evaluations=60")
        counts = [(int(done), int(all_)) for done, all_ in re.findall(r"(\d+) of (\d+) sets", told)]
        self.assertTrue(counts)
        self.assertTrue(all(done <= all_ for done, all_ in counts), counts)
        self.assertNotRegex(told, r"-\d|\d{6}")

    def test_a_reference_table_is_estimated(self):
        rows = self.folder / "rows.csv"
        subprocess.run([PIRSIM, "run", "-q", *self.room, "--replicates", "1", "-o", rows], check=True)
        self.told(rf"reference table: \d+ of \d+ realizations, {LEFT}", "reconcile", *self.room, "--measured", rows,
                  "-o", self.folder / "found", stops=75)

    def test_quiet_is_quiet(self):
        process = subprocess.Popen([PIRSIM, "run", "-q", *self.room, "--replicates", "100000", "-o",
                                    self.folder / "rows.csv"], stderr=subprocess.PIPE)
        with self.assertRaises(subprocess.TimeoutExpired):
            process.wait(timeout=6)
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.communicate()[1], b"")

    def refused(self, message, *args):
        result = subprocess.run([PIRSIM, *args], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertRegex(result.stderr, message)
        return result.stderr

    def test_films_of_days_are_refused_by_their_size(self):
        for command, what in (("export", "the film"), ("view", "the page")):
            file = self.folder / ("day.glb" if command == "export" else "day.html")
            part = [] if command == "export" else ["--from", "00:00", "--to", "24:00"]
            with self.subTest(command):
                told = self.refused(rf"{what} would have about \d.* [GM]B \(86400 s, 9 people, 10 keys a second\)", command,
                                    *self.office, *part, "-o", file)
                self.assertIn("--large", told)
                self.assertFalse(file.exists())

    def test_the_expected_size_is_that_of_the_file(self):
        """Half an hour, of which a tenth of the keys is written."""
        file = self.folder / "half_hour.glb"
        half_hour = [*self.office, "--set", "schedule.from=09:00", "--set", "schedule.to=09:30", "--beams", "none"]
        told = self.refused(r"about (\d+) MB", "export", *half_hour, "--keys-per-s", "40", "-o", file)
        expected = float(re.search(r"about (\d+) MB", told)[1]) / 10
        subprocess.run([PIRSIM, "export", "-q", *half_hour, "--keys-per-s", "4", "-o", file], check=True, timeout=300)
        self.assertLess(abs(file.stat().st_size / 1e6 / expected - 1.0), 0.1)

    def test_what_is_recorded_at_every_tick_must_fit_into_memory(self):
        self.refused(r"--zones: a run of trial '1' would take about \d.* GB of memory", "run", *self.office,
                     "--set", "sensing.tick_rate_hz=5000", "--zones", self.folder / "z.csv", "-o", self.folder / "rows.csv")
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    main()
