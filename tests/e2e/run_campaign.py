#!/usr/bin/env python3
"""Shards, resuming, merging, and what happens when calls fail, with the real binary.

Usage: run_campaign.py PIRSIM DATA_DIR FAILING_CALLS_LIBRARY [unittest arguments]. Needs python3 only.
PIRSIM_KILLS=200 in the environment kills so often (default 6).
"""
import contextlib
import errno
import gzip
import hashlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from program import DATA, PIRSIM, Case, made_folder, main

LIBRARY = pathlib.Path(sys.argv[3]).resolve()


def arguments(*args, replicates=4):
    return [str(PIRSIM), "--scene", str(DATA / "rooms" / "meeting_room.gltf"), "--script",
            str(DATA / "studies" / "studyA.yaml"), "-q", "--replicates", str(replicates), *map(str, args)]


def call(command, code=0, text=True, **kwargs):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=text, timeout=300, **kwargs)
    assert result.returncode == code, f"{command}: exit code {result.returncode}, expected {code}\n{result.stderr}"
    return result


def study(*args, code=0, replicates=4, **kwargs):
    return call(arguments(*args, replicates=replicates), code, **kwargs)


def names(folder):
    return sorted(path.name for path in pathlib.Path(folder).iterdir())


@contextlib.contextmanager
def scratch():
    with tempfile.TemporaryDirectory() as folder:
        yield pathlib.Path(folder)


class Shards(Case):
    @classmethod
    def setUpClass(cls):
        folder = made_folder(cls.addClassCleanup)
        study("-o", folder / "one.csv")
        cls.bytes = (folder / "one.csv").read_bytes()
        cls.manifest = json.loads((folder / "one.csv.json").read_text())
        assert study(text=False).stdout == cls.bytes, "a file's rows are not those of standard output"
        cls.shards = folder / "shards"
        for i in range(1, 6):
            study("--shard", f"{i}/5", "-o", cls.shards, "--threads", 1 + i % 2)

    @contextlib.contextmanager
    def copy(self):
        with scratch() as folder:
            yield pathlib.Path(shutil.copytree(self.shards, folder / "shards"))

    def merged(self, folder, **kwargs):
        return call([PIRSIM, "merge", folder, "-o", folder.parent / "all.csv"], **kwargs)

    def test_merged_shards_are_what_one_process_writes_with_the_same_manifest(self):
        for count, ending in ((1, ".csv"), (3, ".csv.gz"), (7, ".csv.zst"), (45, ".csv")):
            with self.subTest(count=count, ending=ending), scratch() as folder:
                for i in random.Random(count).sample(range(1, count + 1), count):
                    study("--shard", f"{i}/{count}", "-o", folder / "out", "--format", ending)
                self.assertEqual(len(names(folder / "out")), 2 * count)
                self.assertIn(f"shard-0001-of-{count:04}{ending}", names(folder / "out"))
                self.merged(folder / "out")
                self.assertEqual((folder / "all.csv").read_bytes(), self.bytes)
                self.assertEqual(json.loads((folder / "all.csv.json").read_text()), self.manifest)

    def test_a_merged_summary_is_the_one_that_a_single_process_writes(self):
        script = DATA / "studies" / "studyA.yaml"
        for ending in (".csv", ".md"):
            study("--summary", self.folder / f"one{ending}")
            call([PIRSIM, "merge", self.shards, "-o", self.folder / "all.csv.gz", "--summary", self.folder / f"all{ending}",
                  "--script", script])
            self.assertEqual((self.folder / f"all{ending}").read_text(), (self.folder / f"one{ending}").read_text())
        before = names(self.folder)
        merge = [PIRSIM, "merge", self.shards, "-o", self.folder / "b.csv", "--summary", self.folder / "b.md"]
        self.assertIn("--script", call(merge, 2).stderr)
        self.assertIn("isn't the script of these", call([*merge, "--script", DATA / "studies/office.yaml"], 3).stderr)
        self.assertIn("isn't the script of these",
                      call([*merge, "--script", script, "--set", "sensing.rays_per_zone=9"], 3).stderr)
        self.assertIn("are one file", call([*merge[:-1], self.folder / "b.csv", "--script", script], 2).stderr)
        self.assertEqual(names(self.folder), before)

    def test_compressed_files_are_read_by_the_usual_tools(self):
        for ending in ("gz", "zst"):
            study("-o", self.folder / f"a.csv.{ending}")
            study("-o", self.folder / f"b.csv.{ending}")
            self.assertEqual((self.folder / f"a.csv.{ending}").read_bytes(), (self.folder / f"b.csv.{ending}").read_bytes())
        self.assertEqual(gzip.decompress((self.folder / "a.csv.gz").read_bytes()), self.bytes)
        if shutil.which("zstd"):
            self.assertEqual(call(["zstd", "-dc", self.folder / "a.csv.zst"], text=False).stdout, self.bytes)

    def test_the_manifest_names_every_input_with_its_hash(self):
        inputs = {entry["file"]: entry["sha256"] for entry in self.manifest["inputs"]}
        self.assertEqual(set(inputs), {"studyA.yaml", "meeting_room.gltf", "EKMC1604111.yaml"})
        for file in (DATA / "studies" / "studyA.yaml", DATA / "rooms" / "meeting_room.gltf",
                     DATA / "sensors" / "EKMC1604111.yaml", self.shards.parent / "one.csv"):
            told = inputs.get(file.name, self.manifest["sha256"])
            self.assertEqual(call(["sha256sum", file]).stdout.split()[0], told)
        self.assertEqual((self.manifest["runs"], self.manifest["rows"]), (40, self.bytes.count(b"\n") - 1))
        self.assertEqual(self.manifest["bytes"], len(self.bytes))

    def test_status_prints_what_to_submit_again(self):
        with self.copy() as folder:
            self.assertEqual(call([PIRSIM, "merge", "--status", folder]).stdout, "")
            (folder / "shard-0002-of-0005.csv.json").unlink()
            with open(folder / "shard-0003-of-0005.csv", "ab") as file:
                file.write(b"x")
            for file in folder.glob("shard-0005*"):
                file.unlink()
            result = call([PIRSIM, "merge", "--status", folder])
            self.assertEqual(result.stdout, "2-3,5\n")
            for line in ("shard-0002-of-0005: unfinished", "shard-0003-of-0005: broken: longer than",
                         "shard-0005-of-0005: missing", "2 of 5 shards are done; run the others by their command with --shard N/5 --resume"):
                self.assertIn(line, result.stderr)
            fault = self.merged(folder, code=3).stderr
            for word in ("shard-0002", "unfinished", "shard-0005", "missing; run it by its command with --shard 5/5 --resume"):
                self.assertIn(word, fault)
            self.assertEqual(names(folder.parent), ["shards"])
            for task in (2, 3, 5):  # what a job array of these numbers would do
                study("--shard", "auto/5", "-o", folder, "--resume",
                      env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)})
            self.merged(folder)
            self.assertEqual((folder.parent / "all.csv").read_bytes(), self.bytes)

    def test_merge_refuses_what_does_not_belong_together(self):
        def replaced(name, old, new):
            def change(folder):
                path = folder / name
                path.write_text(path.read_text().replace(old, new))
            return change

        def other_seed(folder):
            study("--shard", "2/5", "-o", folder, "--seed", 5)

        def copied(folder):
            shutil.copy(folder / "shard-0001-of-0005.csv", folder / "shard-0002-of-0005.csv")
            shutil.copy(folder / "shard-0001-of-0005.csv.json", folder / "shard-0002-of-0005.csv.json")

        def twice(folder):
            study("--shard", "2/5", "-o", folder, "--format", ".csv.gz")

        def swapped_data(folder):
            shutil.copy(folder / "shard-0001-of-0005.csv", folder / "shard-0002-of-0005.csv")

        def other_count(folder):
            (folder / "shard-0001-of-0006.csv").write_text("")

        cases = {
            "other seed": (other_seed, "its inputs differ from those of shard-0001-of-0005.csv: seed (5, not 2021)"),
            "copied": (copied, "its manifest is that of another shard"),
            "twice": (twice, "is there more than once"),
            "swapped": (swapped_data, "its content differs from what its manifest says"),
            "altered bit": (replaced("shard-0004-of-0005.csv", "seated,1,0,0", "seated,1,1,0"), "differs from what its manifest"),
            "other count": (other_count, "holds shards of 5 and of 6"),
            "damaged manifest": (replaced("shard-0003-of-0005.csv.json", "}", ""), "is no manifest of pirsim"),
            "other build": (replaced("shard-0003-of-0005.csv.json", '"compiler": "', '"compiler": "x'), "compiler (x"),
            "other input": (replaced("shard-0003-of-0005.csv.json", '"sha256": "3d8', '"sha256": "3d9'), "content of"),
            "same data": (replaced("shard-0003-of-0005.csv.json", self.hash_of(3), self.hash_of(2)), "holds the rows of"),
        }
        for name, (change, message) in cases.items():
            with self.subTest(name), self.copy() as folder:
                change(folder)
                before = {path.name: path.read_bytes() for path in folder.iterdir()}
                if before == {path.name: path.read_bytes() for path in self.shards.iterdir()}:
                    self.skipTest("nothing to alter here")
                self.assertIn(message, self.merged(folder, code=3).stderr)
                self.assertEqual(names(folder.parent), ["shards"])

    def hash_of(self, shard):
        return json.loads((self.shards / f"shard-000{shard}-of-0005.csv.json").read_text())["sha256"]

    def test_a_part_of_an_array_is_not_taken_for_a_whole_one(self):
        array = {"SLURM_ARRAY_TASK_ID": "3", "SLURM_ARRAY_TASK_MIN": "3", "SLURM_ARRAY_TASK_MAX": "4",
                 "SLURM_ARRAY_TASK_STEP": "1", "SLURM_ARRAY_TASK_COUNT": "2"}
        with self.copy() as folder:
            fault = study("--shard", "auto", "-o", folder, env={**os.environ, **array}, code=2).stderr
        self.assertIn("this is shard 1 of 2", fault)
        self.assertIn("use --shard auto/5", fault)


class Frames(Case):
    """Frames of thermal arrays are files of their own, a run each: cut, stopped and resumed with the rows."""

    def test_shards_threads_and_a_kill_change_no_frame(self):
        room = self.folder / "room.gltf"
        text = (DATA / "rooms" / "meeting_room.gltf").read_text()
        room.write_text(text.replace("EKMC1604111", "AMG8833", 1))

        def command(name, *args, ending=".csv"):
            return list(map(str, [PIRSIM, "--scene", room, "--script", DATA / "studies" / "studyA.yaml", "--replicates", 2,
                                  "-q", "--frames", self.folder / name, "-o", self.folder / f"{name}_rows{ending}", *args]))

        def frames(name):
            return {path.name: path.read_bytes() for path in (self.folder / name).iterdir()}

        call(command("one", "--threads", 1))
        whole = frames("one")
        self.assertEqual((len(whole), len(set(whole.values()))), (2 * 10, 2 * 10))  # each has noise of its own
        call(command("four", "--threads", 4))
        self.assertEqual(frames("four"), whole)
        for i in (3, 1, 2):
            call(command("shards", "--shard", f"{i}/3", ending=""))
        self.assertEqual(frames("shards"), whole)
        process = subprocess.Popen(command("killed", "--threads", 1))
        while process.poll() is None and not list(self.folder.glob("killed/*_2.npy")):
            time.sleep(0.001)
        process.kill()
        self.assertEqual(process.wait(), -signal.SIGKILL)
        self.assertLess(len(list(self.folder.glob("killed/*.npy"))), len(whole))
        call(command("killed", "--threads", 1, "--resume"))
        self.assertEqual(frames("killed"), whole)


class Occupants(Case):
    """Who is where is cut, stopped and joined as rows are."""

    @classmethod
    def setUpClass(cls):
        folder = made_folder(cls.addClassCleanup)
        study("-o", "/dev/null", "--occupants", folder / "plain.csv")
        study("-o", folder / "rows.csv", "--occupants", folder / "who.csv")
        cls.rows, cls.bytes = ((folder / name).read_bytes() for name in ("rows.csv", "who.csv"))
        cls.manifest = json.loads((folder / "who.csv.json").read_text())
        assert (folder / "plain.csv").read_bytes() == cls.bytes, "a file that can be resumed holds other bytes"
        assert names(folder) == ["plain.csv", "rows.csv", "rows.csv.json", "who.csv", "who.csv.json"], names(folder)

    def assert_whole(self, folder):
        self.assertEqual((folder / "rows.csv").read_bytes(), self.rows)
        self.assertEqual((folder / "who.csv").read_bytes(), self.bytes)
        self.assertEqual(names(folder), ["rows.csv", "rows.csv.json", "who.csv", "who.csv.json"])

    def test_merged_shards_are_what_one_process_writes_with_the_same_manifest(self):
        self.assertEqual((self.manifest["table"], self.manifest["rows"]), ("occupants", self.bytes.count(b"\n") - 1))
        for i in (2, 3, 1):
            study("--shard", f"{i}/3", "-o", self.folder / "out", "--occupants", self.folder / "who", "--threads", i)
        for name, expected in (("out", self.rows), ("who", self.bytes)):
            self.assertEqual(call([PIRSIM, "merge", "--status", self.folder / name]).stdout, "")
            call([PIRSIM, "merge", self.folder / name, "-o", self.folder / f"{name}.csv"])
            self.assertEqual((self.folder / f"{name}.csv").read_bytes(), expected)
        self.assertEqual(json.loads((self.folder / "who.csv.json").read_text()), self.manifest)
        study("--shard", "2/3", "-o", self.folder / "out", "--resume")
        shutil.copytree(self.folder / "out", self.folder / "mixed")
        for path in (self.folder / "who").glob("shard-0002*"):
            shutil.copy(path, self.folder / "mixed")
        merge = [PIRSIM, "merge", self.folder / "mixed", "-o", self.folder / "m.csv"]
        self.assertIn("columns are not those", call(merge, 3).stderr)

    def test_both_tables_are_resumed_however_far_each_got(self):
        files = ("-o", "rows.csv", "--occupants", "who.csv", "--resume")
        for _ in range(2):
            study(*files, "--max-time", "0.001s", "--threads", 1, code=75, cwd=self.folder)
        self.assertEqual(names(self.folder), [f"{table}.csv.{part}" for table in ("rows", "who")
                                         for part in ("journal", "partial")])
        journal = self.folder / "who.csv.journal"  # as if the process had been killed between the two
        journal.write_text("".join(journal.read_text().splitlines(keepends=True)[:-1]))
        study(*files, cwd=self.folder)
        self.assert_whole(self.folder)
        for path in self.folder.glob("who.csv*"):
            path.unlink()
        study(*files, cwd=self.folder)  # all rows are there
        self.assert_whole(self.folder)

    def test_one_table_is_not_taken_for_the_other(self):
        study("-o", "rows.csv", "--occupants", "who.csv", cwd=self.folder)
        told = study("-o", "who.csv", "--occupants", "rows.csv", "--resume", code=3, cwd=self.folder).stderr
        self.assertIn("table (occupants, not rows)", told)
        self.assert_whole(self.folder)
        for args, message in ((("-o", "a", "--occupants", "a"), "are one folder"),
                              (("-o", "a", "--occupants", "w.csv"), "--occupants 'w.csv' is named as a file")):
            self.assertIn(message, study("--shard", "1/2", *args, code=2, cwd=self.folder).stderr)
        self.assertIn("not a regular file", study("-o", "a.csv", "--occupants", "/dev/null", "--resume", code=2,
                                                  cwd=self.folder).stderr)
        self.assert_whole(self.folder)

    def test_nothing_is_left_where_rows_can_not_be_resumed(self):
        process = subprocess.Popen(arguments("--occupants", self.folder / "who.csv", replicates=1000),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        self.assertIn("stopped by SIGINT", process.communicate(timeout=60)[1])
        self.assertEqual((process.returncode, names(self.folder)), (75, []))


class Stopping(Case):
    REPLICATES = 40

    @classmethod
    def setUpClass(cls):
        begun = time.monotonic()
        cls.bytes = study(text=False, replicates=cls.REPLICATES).stdout
        cls.seconds = time.monotonic() - begun

    def interrupted(self, file, kind, after, *args):
        """Starts, sends the signal after so many seconds, returns the process's exit code."""
        process = subprocess.Popen(arguments("-o", file, "--resume", *args, replicates=self.REPLICATES),
                                   stderr=subprocess.PIPE, text=True)
        time.sleep(after)
        process.send_signal(kind)
        _, self.told = process.communicate(timeout=120)
        return process.returncode

    def test_a_signal_stops_at_the_end_of_a_run_and_resuming_gives_the_bytes(self):
        for kind in (signal.SIGTERM, signal.SIGINT):
            with scratch() as folder:
                file, stops = folder / "rows.csv", 0
                for attempt in range(40):
                    code = self.interrupted(file, kind, self.seconds * (0.1 + 0.02 * attempt))
                    if code == 0 or stops == 3:
                        break
                    if code == -kind:
                        continue  # before pirsim listened
                    self.assertEqual(code, 75, self.told)
                    self.assertIn(f"stopped by {kind.name}", self.told)
                    self.assertEqual(names(folder), ["rows.csv.journal", "rows.csv.partial"])
                    partial = (folder / "rows.csv.partial").read_bytes()
                    self.assertTrue(self.bytes.startswith(partial) and partial.endswith(b"\n"))
                    stops += 1
                study("-o", file, "--resume", replicates=self.REPLICATES)
                self.assertGreaterEqual(stops, 1)
                self.assertEqual(file.read_bytes(), self.bytes)
                self.assertEqual(names(folder), ["rows.csv", "rows.csv.json"])

    def test_max_time_stops_with_progress_and_is_resumable(self):
        for _ in range(3):
            result = study("-o", self.folder / "rows.csv", "--resume", "--max-time", "0.001s", code=75,
                           replicates=self.REPLICATES)
            self.assertIn("stopped by --max-time", result.stderr)
        self.assertGreaterEqual(len((self.folder / "rows.csv.journal").read_text().splitlines()), 1 + 1 + 3)
        study("-o", self.folder / "rows.csv", "--resume", "--max-time", "1h", replicates=self.REPLICATES)
        self.assertEqual((self.folder / "rows.csv").read_bytes(), self.bytes)
        before = (self.folder / "rows.csv").stat().st_mtime_ns
        study("-o", self.folder / "rows.csv", "--resume", replicates=self.REPLICATES)
        self.assertEqual((self.folder / "rows.csv").stat().st_mtime_ns, before)

    def stopped(self, folder):
        """Rows that --max-time stopped after a few runs, and their journal."""
        study("-o", folder / "rows.csv", "--resume", "--max-time", "0.001s", "--threads", 1, code=75)
        return folder / "rows.csv", folder / "rows.csv.journal"

    @staticmethod
    def sealed(texts):
        """A journal of these lines whose every digest is right."""
        last, lines = "", []
        for text in texts:
            last = hashlib.sha256((last + text).encode()).hexdigest()[:16]
            lines.append(f"{text} #{last}\n")
        return "".join(lines)

    def test_no_altered_bit_of_a_journal_loses_or_doubles_a_run(self):
        reference = study(text=False).stdout
        rows, journal = self.stopped(self.folder)
        whole, partial = journal.read_text(), rows.with_name("rows.csv.partial").read_bytes()
        *before, last = whole.splitlines(keepends=True)
        next_run = int(last.split()[0])
        self.assertGreater(next_run, 0)
        for changed in (last.replace(f"{next_run} ", f"{next_run + 1} ", 1),
                        last.replace(f"{next_run} ", f"{next_run - 1} ", 1),
                        last.replace(f"{next_run} ", "999999 ", 1),
                        last.replace(f"{next_run} ", "-1 ", 1), last[:-2] + "x\n", ""):
            with self.subTest(changed):
                journal.write_text("".join(before) + changed)
                rows.with_name("rows.csv.partial").write_bytes(partial)
                study("-o", rows, "--resume")
                self.assertEqual(rows.read_bytes(), reference)
                self.assertEqual(json.loads((self.folder / "rows.csv.json").read_text())["rows"],
                                 reference.count(b"\n") - 1)
                for path in self.folder.iterdir():
                    path.unlink()

    def test_a_journal_that_names_what_the_study_does_not_have_is_refused(self):
        rows, journal = self.stopped(self.folder)
        texts = [line.rsplit(" #", 1)[0] for line in journal.read_text().splitlines()]
        made, *marks = texts
        last = marks[-1].split()
        self.assertEqual(self.sealed(texts), journal.read_text())
        other_runs = made.replace('"runs":40', '"runs":39')
        self.assertNotEqual(other_runs, made)
        cases = {
            "names run 999999": [made, *marks, " ".join(["999999", *last[1:]])],
            "isn't what a journal says of a run": [made, *marks, " ".join(["-1", *last[1:]])],
            f"where run {int(last[0]) + 1} of 0 to 40 would follow": [*texts, marks[-1]],  # doubled
            "runs (0 to 39, not 0 to 40)": [other_runs, *marks],
            "runs that the study doesn't have": [made.replace('"runs":40', '"runs":41'), *marks],
            "is no manifest of pirsim": [made.replace('"runs":40', '"runs":-1'), *marks],
            "shard (2/5, not none)": [made.replace('"first_run"', '"shard":{"index":2,"count":5},"first_run"'), *marks],
        }
        for message, lines in cases.items():
            with self.subTest(message):
                journal.write_text(self.sealed(lines))
                before = {path.name: path.read_bytes() for path in self.folder.iterdir()}
                told = study("-o", rows, "--resume", code=3).stderr
                self.assertIn(message, told)
                self.assertIn("rows.csv.journal", told)
                self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, before)
        study("-o", rows)  # as the message says
        self.assertEqual(names(self.folder), ["rows.csv", "rows.csv.json"])

    def test_a_finished_file_whose_manifest_counts_other_rows_is_made_anew(self):
        study("-o", self.folder / "rows.csv")
        manifest, bytes_before = self.folder / "rows.csv.json", (self.folder / "rows.csv").read_bytes()
        text = manifest.read_text()
        n_rows = json.loads(text)["rows"]
        manifest.write_text(text.replace(f'"rows": {n_rows}', f'"rows": {n_rows + 1}'))
        study("-o", self.folder / "rows.csv", "--resume")
        self.assertEqual(manifest.read_text(), text)
        self.assertEqual((self.folder / "rows.csv").read_bytes(), bytes_before)

    def test_a_signal_leaves_no_partial_file_of_what_cannot_be_resumed(self):
        process = subprocess.Popen(
            arguments("--zones", self.folder / "z.csv", "--summary", self.folder / "s.md", replicates=self.REPLICATES),
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        until = time.monotonic() + 60
        while not list(self.folder.glob("z.csv.writing-*")) and time.monotonic() < until:
            time.sleep(0.002)
        time.sleep(0.05)
        process.terminate()
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 75)
        self.assertEqual(names(self.folder), [])

    def test_killed_at_random_moments_and_resumed_the_bytes_are_right(self):
        kills, wanted, moments = 0, int(os.environ.get("PIRSIM_KILLS", 6)), random.Random(1)
        while kills < wanted:
            for ending in (".csv", ".csv.zst"):
                file = self.folder / ("rows" + ending)
                while not file.with_name(file.name + ".json").exists() and kills < wanted:
                    code = self.interrupted(file, signal.SIGKILL, moments.uniform(0.0, 0.6 * self.seconds))
                    kills += code == -signal.SIGKILL
                study("-o", file, "--resume", replicates=self.REPLICATES)
                study("-o", self.folder / "plain.csv", replicates=self.REPLICATES) if not kills else None
                text = call(["zstd", "-dc", file], text=False).stdout if ending == ".csv.zst" and shutil.which(
                    "zstd") else file.read_bytes() if ending == ".csv" else None
                if text is not None:
                    self.assertEqual(text, self.bytes)
                manifest = json.loads(file.with_name(file.name + ".json").read_text())
                self.assertEqual(manifest["bytes"], len(self.bytes))
                for path in self.folder.iterdir():
                    path.unlink()
        print(f"killed {kills} times", file=sys.stderr)


class Links(Case):
    """Whoever may write into the folder must not make pirsim write elsewhere."""

    def test_no_file_at_work_follows_a_link(self):
        mine = self.folder / "mine.txt"
        mine.write_text("mine")
        out = self.folder / "out"
        out.mkdir()
        for name in ("rows.csv.writing", "rows.csv.json.writing", "s.md.writing", "r.html.writing"):
            (out / name).symlink_to(mine)
        study("-o", out / "rows.csv", "--summary", out / "s.md", "--report", out / "r.html", replicates=1)
        self.assertEqual(mine.read_text(), "mine")
        for name in ("b.csv.partial", "b.csv.journal"):
            for link in (lambda: (out / name).symlink_to(mine), lambda: (out / name).hardlink_to(mine)):
                link()
                for more in ((), ("--resume",)):
                    told = study("-o", out / "b.csv", *more, code=4, replicates=1).stderr
                    self.assertIn(f"{name}: error: can't be written: it ", told)
                    self.assertIn("link", told)
                self.assertEqual(mine.read_text(), "mine")
                (out / name).unlink()
        self.assertEqual([name for name in names(out) if "b.csv" in name], [])

    def test_two_processes_that_write_one_file_do_not_meet(self):
        both = [subprocess.Popen(arguments("--summary", self.folder / "s.md", replicates=1), stdout=subprocess.DEVNULL)
                for _ in range(2)]
        self.assertEqual([process.wait(timeout=120) for process in both], [0, 0])
        self.assertEqual(names(self.folder), ["s.md"])


class Refusals(Case):
    def test_what_is_refused_leaves_nothing_behind(self):
        missing = self.folder / "none"
        for args, code, told in (
                (("--trace", self.folder / "t.csv"), 2, "--trace: no sensor has an analog response"),
                (("--trace", self.folder / "t.csv", "--zones", self.folder / "z.csv", "--summary", self.folder / "s.md"), 2,
                 "--trace"),
                (("--summary", missing / "s.md"), 4, "no folder"), (("--zones", missing / "z.csv"), 4, "no folder"),
                (("--report", missing / "r.html"), 4, "no folder"),
                (("--occupants", missing / "o.csv"), 4, "no folder")):
            with self.subTest(args):
                self.assertIn(told, study("-o", self.folder / "rows.csv", *args, code=code, replicates=1).stderr)
                self.assertEqual(names(self.folder), [])


class FailingCalls(Case):
    """Every call in turn, until none is left that could fail."""

    @staticmethod
    def environment(call_name, at, reason, **more):
        sanitizers = {"ASAN_OPTIONS": "verify_asan_link_order=0:detect_leaks=0"}
        return {**os.environ, **sanitizers, "LD_PRELOAD": str(LIBRARY), "PIRSIM_FAIL_CALL": call_name,
                "PIRSIM_FAIL_AT": str(at), "PIRSIM_FAIL_ERRNO": str(int(reason)), **more}

    def each_failure(self, call_name, reason, *args, most=10000, step=lambda n: n + 1):
        """Yields the folder and what was told, for every n for which the n-th call decides the outcome."""
        n, failures = 1, 0
        while n < most:
            with scratch() as folder:
                result = subprocess.run(arguments(*[str(arg).format(folder) for arg in args], replicates=1),
                                        capture_output=True, text=True, timeout=300,
                                        env=self.environment(call_name, n, reason))
                if result.returncode == 0:
                    self.assertGreater(failures, 0, "the library of failing calls had no effect")
                    return
                yield folder, result
                failures += 1
            n = step(n)
        self.fail("there is no end of calls")

    def test_a_full_disk_at_any_write_is_told_once_and_the_rest_is_resumed(self):
        reference = study(text=False, replicates=1).stdout
        for ending in (".csv", ".csv.gz"):
            for folder, result in self.each_failure("write", errno.ENOSPC, "-o", "{}/rows" + ending):
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertIn("No space left on device", result.stderr)
                self.assertIn("rows", result.stderr)
                self.assertLessEqual(set(names(folder)), {"rows.csv.partial", "rows.csv.journal", "rows" + ending})
                study("-o", folder / ("rows" + ending), "--resume", replicates=1)
                data = (folder / ("rows" + ending)).read_bytes()
                self.assertEqual(gzip.decompress(data) if ending == ".csv.gz" else data, reference)
                self.assertEqual(names(folder), ["rows" + ending, f"rows{ending}.json"])

    def test_a_full_disk_at_any_write_of_the_other_outputs_leaves_none_of_them(self):
        step = lambda n: n + 1 + n // 3  # zones are many writes
        for folder, result in self.each_failure("write", errno.ENOSPC, "--zones", "{}/z.csv", "--summary", "{}/s.md",
                                                "--report", "{}/r.html", step=step):
            self.assertEqual(result.returncode, 4, result.stderr)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
            self.assertFalse([name for name in names(folder) if name.endswith(".partial")])

    def test_a_read_only_folder_and_failing_renames_are_told_once(self):
        for call_name, reason, words in (("open", errno.EROFS, "Read-only file system"),
                                         ("rename", errno.EACCES, "Permission denied"),
                                         ("truncate", errno.EIO, "Input/output error")):
            for folder, result in self.each_failure(call_name, reason, "-o", "{}/rows.csv"):
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertIn(words, result.stderr)
                study("-o", folder / "rows.csv", "--resume", replicates=1)
                self.assertEqual(names(folder), ["rows.csv", "rows.csv.json"])

    def test_memory_that_runs_out_while_loading_is_told(self):
        if "PIRSIM_SANITIZED" in os.environ:
            self.skipTest("the sanitizers have an allocator of their own")
        outcomes = set()
        for once in ({"PIRSIM_FAIL_ONCE": "1"}, {}):
            for n in sorted({round(1.6 ** i) for i in range(0, 30, 2)}):
                result = subprocess.run(arguments(replicates=1), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                        text=True, timeout=300, env=self.environment("malloc", n, 0, **once))
                with self.subTest(n=n, **once):
                    self.assertIn(result.returncode, (0, 4, 70), result.stderr)
                    if result.returncode != 0:  # 4: a stream can't get its buffer, the file "can't be read"
                        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                        self.assertIn("out of memory" if result.returncode == 70 else "can't be read", result.stderr)
                outcomes.add(result.returncode)
        self.assertIn(70, outcomes)

    def test_memory_that_is_short_ends_with_a_message(self):
        if "PIRSIM_SANITIZED" in os.environ:
            self.skipTest("the sanitizers need much address space")
        big = self.folder / "big.gltf"
        big.write_text('{"asset":{"version":"2.0"},"nodes":[' + "{}," * 2_000_000 + "{}]}")
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (600_000_000, 600_000_000))
        result = subprocess.run([str(PIRSIM), "--scene", str(big), "--script", str(DATA / "studies/studyA.yaml")],
                                capture_output=True, text=True, preexec_fn=limit, timeout=120)
        self.assertIn(result.returncode, (3, 70), result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)

    def test_a_closed_pipe_ends_quietly_on_standard_output_and_is_told_of_a_named_one(self):
        process = subprocess.Popen(arguments(replicates=20), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.readline()
        process.stdout.close()
        self.assertEqual(process.stderr.read(), b"")
        process.stderr.close()
        self.assertEqual(process.wait(timeout=120), -signal.SIGPIPE)
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        process = subprocess.Popen(arguments("-o", pipe, "--summary", self.folder / "s.md", replicates=20),
                                   stderr=subprocess.PIPE, text=True)
        with open(pipe, "rb") as reader:
            reader.readline()
        _, told = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 4)
        self.assertIn("Broken pipe", told)
        self.assertEqual(len(told.strip().splitlines()), 1)
        self.assertEqual(names(self.folder), ["pipe"])

    def test_full_devices_are_told(self):
        for args in (("-o", "/dev/full"), ("--zones", "/dev/full")):
            self.assertIn("No space left", study(*args, code=4, replicates=1).stderr)
        with open("/dev/full", "wb") as full:
            result = subprocess.run(arguments(replicates=1), stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(result.returncode, 4)
        self.assertIn("standard output can't be written", result.stderr)


class PlainMachine(Case):
    """tools/run_shards, for real."""

    def test_shards_of_which_one_dies_are_gone_on_with_and_merged(self):
        with scratch() as folder:
            study("-o", folder / "one.csv")
            mortal = folder / "mortal"  # the third shard is killed once it has begun
            mortal.write_text(f"""#!/bin/sh
if [ "$1" = --scene ] && [ -z "${{*##* 3/5 *}}" ] && [ ! -e {folder}/died ]; then
  touch {folder}/died
  kill -9 $$
fi
exec {PIRSIM} "$@"
""")
            mortal.chmod(0o755)
            run_shards = [DATA.parent / "tools" / "run_shards", "-n", 5, "-j", 2, "-o", folder / "out", "-p", mortal,
                          "--", *arguments()[1:]]
            first = call(run_shards, 75)
            self.assertIn("shards 3 are left", first.stderr)
            self.assertNotIn("all.csv", names(folder / "out"))
            call(run_shards)
            self.assertEqual((folder / "out/all.csv").read_bytes(), (folder / "one.csv").read_bytes())
            call(run_shards)  # nothing is left to do
            self.assertEqual((folder / "out/all.csv").read_bytes(), (folder / "one.csv").read_bytes())

    def test_the_users_own_words_are_left_alone(self):
        script = self.folder / "a {} b" / "study {}.yaml"
        script.parent.mkdir()
        shutil.copy(DATA / "studies/studyA.yaml", script)
        call([DATA.parent / "tools" / "run_shards", "-n", 2, "-j", 2, "-o", self.folder / "out {}", "-p", PIRSIM, "--",
              "--scene", DATA / "rooms/meeting_room.gltf", "--script", script, "--replicates", 1])
        self.assertIn("all.csv", names(self.folder / "out {}"))

    def test_no_shard_is_begun_after_one_that_was_refused(self):
        script = self.folder / "study.yaml"
        script.write_text("pirsim_script: 1\npeopel: []\n")
        scene = DATA / "rooms/meeting_room.gltf"
        for code, files in ((3, ("--scene", scene, "--script", script)), (2, ("--scene", scene, "--scirpt", script)),
                            (4, ("--scene", scene, "--script", self.folder / "missing.yaml"))):
            told = call([DATA.parent / "tools" / "run_shards", "-n", 50, "-j", 1, "-o", self.folder / "out", "-p", PIRSIM,
                         "--", *files], code).stderr
            self.assertEqual(told.count("error:"), 1, told)
            self.assertIn("tools/run_shards: shard 1 was refused", told)

    def test_what_is_missing_is_told(self):
        tool = DATA.parent / "tools" / "run_shards"
        for words, message in ((("-o", "x", "--", "--scene"), "-n N"), (("-n", 0, "-o", "x", "--", "y"), "-n N"),
                               (("-n", 2, "--", "y"), "-o DIR"), (("-n", 2, "-o", "x"), "after --")):
            self.assertIn(message, call([tool, *words], 2).stderr)


class LongEnds(Case):
    """Phases after the last run obey signals too."""

    def test_a_signal_while_rows_are_compressed_stops_and_loses_nothing(self):
        with scratch() as folder:
            (folder / "wait.yaml").write_text("""pirsim_script: 1
name: A long wait
sensing: {tick_rate_hz: 1, rays_per_zone: 1}
people: [{id: one, stature_m: 1.8, mass_kg: 80, actions: [{enter: door}, {wait_s: 1000000}, {wait_s: 1000000}]}]
""")
            command = list(map(str, [PIRSIM, "--scene", DATA / "rooms/meeting_room.gltf", "--script",
                                     folder / "wait.yaml", "-q", "-o", folder / "rows.csv.gz", "--resume"]))
            process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
            until = time.monotonic() + 200
            while not list(folder.glob("rows.csv.gz.writing*")) and process.poll() is None and time.monotonic() < until:
                time.sleep(0.005)
            process.send_signal(signal.SIGTERM)
            told = process.communicate(timeout=200)[1]
            self.assertEqual(process.returncode, 75, told)
            self.assertIn("--resume continues", told)
            self.assertEqual(names(folder), ["rows.csv.journal", "rows.csv.partial", "wait.yaml"])
            n_lines = (folder / "rows.csv.partial").read_bytes().count(b"\n")
            call(command)
            with gzip.open(folder / "rows.csv.gz") as rows:
                self.assertEqual(sum(1 for _ in rows), n_lines)
            self.assertEqual(n_lines, 1 + json.loads((folder / "rows.csv.gz.json").read_text())["rows"])


class Memory(Case):
    def peak_mb(self, command):
        process = subprocess.Popen(list(map(str, command)), stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status  # is waited for
        self.assertEqual(status, 0)
        return usage.ru_maxrss / 1024

    def test_merging_twenty_times_as_much_takes_no_more_memory(self):
        if "PIRSIM_SANITIZED" in os.environ:
            self.skipTest("the sanitizers keep what was freed")
        with scratch() as folder:
            (folder / "wait.yaml").write_text("""pirsim_script: 1
name: A long wait
sensing: {tick_rate_hz: 1, rays_per_zone: 1}
people: [{id: one, stature_m: 1.8, mass_kg: 80, actions: [{enter: door}, {wait_s: 100000}]}]
""")
            peaks = []
            for runs in (1, 20):
                base = [PIRSIM, "--scene", DATA / "rooms/meeting_room.gltf", "--script", folder / "wait.yaml", "-q",
                        "--replicates", 2 * runs]
                for i in (1, 2):
                    call([*base, "--shard", f"{i}/2", "-o", folder / f"of_{runs}"])
                peaks.append(self.peak_mb([PIRSIM, "merge", folder / f"of_{runs}", "-o", folder / f"{runs}.csv"]))
                self.assertGreater((folder / f"{runs}.csv").stat().st_size, 5e6 * runs)
            self.assertLess(peaks[1], peaks[0] + 4)

    def test_a_hundred_times_as_many_runs_take_no_more_memory(self):
        if "PIRSIM_SANITIZED" in os.environ:
            self.skipTest("the sanitizers keep what was freed")
        with scratch() as folder:
            (folder / "short.yaml").write_text("""pirsim_script: 1
name: A look into the room
sensing: {tick_rate_hz: 1, rays_per_zone: 1}
people: [{id: one, stature_m: 1.8, mass_kg: 80, actions: [{enter: door}, {wait_s: 1}]}]
""")
            peaks = [self.peak_mb([PIRSIM, "--scene", DATA / "rooms/meeting_room.gltf", "--script", folder / "short.yaml",
                                   "-q", "--replicates", runs, "-o", folder / f"{runs}.csv",
                                   "--summary", folder / f"{runs}_summary.csv"]) for runs in (2000, 200000)]
            # Forty bytes a run, as a summary that keeps every run's counts takes, would be 8 MB more.
            self.assertLess(peaks[1], peaks[0] + 2)


class Options(Case):
    def test_wrong_names_of_outputs_are_usage_errors_before_any_work(self):
        for args, message in (
                (("--summary", self.folder / "t.txt"), "must end in .csv or .md"),
                (("-o", self.folder / "rows.txt"), "must end in .csv, .csv.gz or .csv.zst"),
                (("-o", self.folder / "rows"), "must end in"),
                (("--report", self.folder / "r.htm"), "must end in .html"),
                (("--zones", self.folder / "z"), "must end in"),
                (("-o", self.folder / "a.csv", "--summary", self.folder / "." / "a.csv"), "-o and --summary are one file"),
                (("--zones", self.folder / "a.csv", "--summary", self.folder / "a.csv"), "--summary and --zones are one file"),
                (("-o", self.folder / "a.csv", "--summary", self.folder / "a.csv.json"), "must end in .csv or .md"),
                (("--shard", "1/2"), "--shard needs -o DIR"),
                (("--resume",), "--resume needs -o FILE"),
                (("--max-time", "5m"), "--max-time needs -o FILE"),
                (("--max-time", "5x", "-o", self.folder / "a.csv"), "--max-time"),
                (("--resume", "-o", "/dev/null"), "not a regular file"),
                (("--resume", "-o", self.folder / "a.csv", "--summary", self.folder / "s.md"), "need all runs at once"),
                (("--shard", "1/2", "-o", self.folder, "--format", ".txt"), "--format"),
                (("--shard", "auto", "-o", self.folder), "none of these variables is set")):
            with self.subTest(args):
                environment = {k: v for k, v in os.environ.items() if not k.startswith(("SLURM", "SGE", "PBS"))}
                self.assertIn(message, study(*args, code=2, env=environment).stderr)
        self.assertEqual(names(self.folder), [])

    def test_an_output_that_is_an_input_is_refused(self):
        script = shutil.copy(DATA / "studies" / "studyA.yaml", self.folder / "study.csv")
        result = call([PIRSIM, "--scene", DATA / "rooms" / "meeting_room.gltf", "--script", script, "-o", script], 2)
        self.assertIn("--script and -o are one file", result.stderr)
        self.assertEqual((self.folder / "study.csv").read_bytes(), (DATA / "studies" / "studyA.yaml").read_bytes())

    def test_a_camera_with_two_numbers_does_not_swallow_the_next_option(self):
        files = ("--scene", DATA / "rooms" / "meeting_room.gltf", "--script", DATA / "studies" / "studyA.yaml")
        for given in ("1,2", "1,2,", "1,2,3,4", "1;2;3", "a,b,c", ""):
            result = call([PIRSIM, "preview", *files, "--camera", given, "--look-at", "0,1,0"], 2)
            self.assertIn("--camera", result.stderr)

    def test_a_summary_as_a_document_has_a_title(self):
        study("--summary", self.folder / "s.md", replicates=1)
        self.assertEqual((self.folder / "s.md").read_text()[:9], "# Study A")


if __name__ == "__main__":
    main(first=4)
