#!/usr/bin/env python3
"""What comes in is read once, checked when it is read, and told clearly.

Usage: run_inputs.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 and bash; zstd for one test.
"""
import gzip
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import time

from program import DATA, PIRSIM, Case, main

SCRIPT = """pirsim_script: 1
name: a minute
people: [{id: a, actions: [{enter: door}, {sit: S6}, {work: {duration_s: 40}}]}]
"""
TARGET = "target: {x_shapes: {heights_m: [1.0], bar_length_m: 0.4, bar_width_m: 0.07}}\n"
COVERAGE = "pirsim_coverage: 1\nspacing_m: 1\nduration_s: 2\n" + TARGET
WALK_TEST = "pirsim_walk_test: 1\nspacing_m: 3\n"
PLACEMENTS = COVERAGE.replace("coverage", "placements")
NUISANCE = "pirsim_nuisance: 1\nbody_size: 0.01\n"
RECIPE = """pirsim_recipe: 1
rooms: [{count: 1, seats: 1, width_m: 4, depth_m: 4}]
days: 1
sensing: {tick_rate_hz: 10}
schedule: {from: "08:50", to: "08:52", staff: [{count: 1}]}
"""
LIMIT = 400_000_000  # bytes of memory for what is refused


def run(*args, code=0, data=None, cwd=None, memory=None):
    def bound():
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    result = subprocess.run([PIRSIM, *map(str, args)], input=data, capture_output=True, timeout=300, cwd=cwd,
                            preexec_fn=bound if memory and "PIRSIM_SANITIZED" not in os.environ else None)
    told = result.stderr.decode()
    assert result.returncode == code, f"{args}: exit code {result.returncode}, expected {code}\n{told[:2000]}"
    return result.stdout, told


def shell(line, cwd, code=0):
    """`line` by bash, which has process substitution; PIRSIM stands for the command."""
    result = subprocess.run(["bash", "-c", line], env={**os.environ, "PIRSIM": PIRSIM, "DATA": str(DATA)}, cwd=cwd,
                            capture_output=True, timeout=300)
    told = result.stderr.decode()
    assert result.returncode == code, f"{line}: exit code {result.returncode}, expected {code}\n{told[:2000]}"
    return result.stdout, told


def sha256(data):
    return hashlib.sha256(data).hexdigest()


class InputsCase(Case):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "room.gltf"
        run("room", "--kind", "meeting", "--width", 6, "--depth", 4.6, "--seats", 6, "-o", self.scene, "-q")
        self.script = self.write("study.yaml", SCRIPT)
        self.model = re.search(r'"model": *"(\w+)"', self.scene.read_text().replace("\\", ""))[1] + ".yaml"

    def study(self, *args, **options):
        return run("--scene", self.scene, "--script", self.script, *args, **options)

    def check(self, **options):
        return run("check", "--scene", self.scene, "--script", self.script, "-q", **options)

    def edited_scene(self, change, name="edited.gltf"):
        scene = json.loads(self.scene.read_text())
        change(scene)
        return self.write(name, json.dumps(scene))

    def measured(self, rows, code, *args, name="rows.csv", script=None, **options):
        """What `reconcile` says of measured rows: with 2, they were read, and the holdout is refused after them."""
        file = rows if isinstance(rows, pathlib.Path) else self.write(name, rows)
        return run("reconcile", "--scene", self.scene, "--script", script or self.script, "--measured", file,
                   "--holdout", "NOBODY", "-o", self.folder / "found", *args, code=code, **options)[1]


class ReadOnce(InputsCase):
    def test_pipes_and_standard_input_are_recorded_by_their_bytes(self):
        expected = self.study("-q")[0]
        hashes = [sha256(self.script.read_bytes()), sha256(self.scene.read_bytes())]
        lines = ("--scene room.gltf --script <(cat study.yaml)", "--scene <(cat room.gltf) --script study.yaml",
                 "--scene <(cat room.gltf) --script <(cat study.yaml)", "--scene room.gltf --script - < study.yaml",
                 "--scene - --script study.yaml < room.gltf", "--scene room.gltf --script - < <(cat study.yaml)")
        for i, line in enumerate(lines):
            rows = self.folder / f"rows{i}.csv"
            shell(f'"$PIRSIM" -o {rows} -q {line}', self.folder)
            self.assertEqual(rows.read_bytes(), expected, line)
            inputs = json.loads(pathlib.Path(f"{rows}.json").read_text())["inputs"]
            self.assertEqual([file["sha256"] for file in inputs][:2], hashes, line)
            for file in inputs:
                self.assertFalse(file["file"].isdigit(), "the number of a descriptor, another one in each call")
        # A pipe's number isn't part of what was read: the study goes on from the next.
        shell('"$PIRSIM" -o rows0.csv --resume --scene room.gltf --script <(cat study.yaml)', self.folder)

    def test_every_kind_of_input_is_read_from_a_pipe_as_from_a_file(self):
        """A second opening of a named pipe would wait for ever; there is one writer for each."""
        for name, text in (("c.yaml", COVERAGE), ("w.yaml", WALK_TEST), ("p.yaml", PLACEMENTS), ("n.yaml", NUISANCE),
                           ("r.yaml", RECIPE)):
            self.write(name, text)
        body = self.write("body.gltf", json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}]}))
        self.write("worn.yaml", SCRIPT.replace("id: a,", "id: a, body_mesh: body,"))
        (self.folder / "sensors").mkdir()
        room = "--scene room.gltf"
        commands = {
            "coverage {} -o map": ("c.yaml", room), "walktest {} -o out.csv": ("w.yaml", room),
            "placements {}": ("p.yaml", room), "check {}": ("study.yaml", room), "export {} -o o.glb": ("study.yaml", room),
            "preview {} --width 64 --height 48 -o o.png": ("study.yaml", room),
        }
        for command, (script, rest) in commands.items():
            def outcome(given):
                for made in ("out.csv", "o.glb", "o.png"):
                    (self.folder / made).unlink(missing_ok=True)
                shutil.rmtree(self.folder / "map", ignore_errors=True)
                out = shell(f'timeout 60 "$PIRSIM" {command.format(rest)} --script {given}', self.folder)[0]
                made = sorted([*self.folder.glob("o*.*"), *self.folder.glob("map/*.csv")])
                self.assertTrue(out or made, command)
                return out, [file.read_bytes() for file in made]
            self.assertEqual(outcome(f"<(cat {script})"), outcome(script), command)
            self.assertEqual(outcome(f"- < {script}"), outcome(script), command)
        shell('timeout 60 "$PIRSIM" room <(cat r.yaml) -o a.gltf; timeout 60 "$PIRSIM" room r.yaml -o b.gltf; cmp a.gltf b.gltf',
              self.folder)
        # What a scene or a script names: the file of a sensor, the mesh of a body.
        for named, file, line in (
                (f"sensors/{self.model}", DATA / "sensors" / self.model, "check --scene room.gltf --script study.yaml -q"),
                ("body", body, "check --scene room.gltf --script worn.yaml -q")):
            (self.folder / named).unlink(missing_ok=True)
            os.mkfifo(self.folder / named)
            told = subprocess.run(["bash", "-c", f'cat "{file}" > {named} & timeout 60 "$PIRSIM" {line}; echo $?; kill %1'],
                                  env={**os.environ, "PIRSIM": PIRSIM}, cwd=self.folder, capture_output=True, text=True)
            self.assertIn(told.stdout.split()[-1], ("0", "3"), told.stderr)
            self.assertNotIn("there is no file", told.stderr)
        self.assertIn("no node has a mesh", told.stderr)  # of the body: it was read

    def test_a_dataset_from_a_pipe_keeps_its_recipe(self):
        self.write("r.yaml", RECIPE)
        self.write("other.yaml", RECIPE.replace("days: 1", "days: 2"))
        shell('"$PIRSIM" dataset <(cat r.yaml) -o made -q', self.folder)
        self.assertEqual((self.folder / "made" / "recipe.yaml").read_text(), RECIPE)
        self.assertIn(sha256(RECIPE.encode()), (self.folder / "made" / "provenance.txt").read_text())
        told = shell('"$PIRSIM" dataset <(cat other.yaml) -o made --resume', self.folder, code=3)[1]
        self.assertIn("holds another dataset", told)
        shell('"$PIRSIM" dataset - -o made --resume < r.yaml', self.folder)

    def test_waiting_for_a_pipe_ends_at_the_first_signal(self):
        os.mkfifo(self.folder / "pipe")
        known = ("--scene", self.scene, "--script", self.script)
        for args in (("--scene", self.scene, "--script", "pipe", "-o", "rows.csv"), ("dataset", "pipe", "-o", "made"),
                     ("--scene", "pipe", "--script", self.script, "-o", "rows.csv"), ("room", "pipe", "-o", "a.gltf"),
                     ("coverage", "--scene", self.scene, "--script", "pipe", "-o", "c.csv"),
                     ("reconcile", *known, "--measured", "pipe")):
            for number in (signal.SIGTERM, signal.SIGINT):
                process = subprocess.Popen([PIRSIM, *map(str, args)], cwd=self.folder, stderr=subprocess.DEVNULL)
                time.sleep(0.3)
                self.assertIsNone(process.poll(), args)
                process.send_signal(number)
                self.assertIn(process.wait(timeout=20), (-number, 75), args)
        # Where signals are caught already, as while outputs are open, the wait ends too, as the exit codes say.
        os.mkfifo(self.folder / "table")
        study = self.write("compared.yaml", SCRIPT + "summary: {reference: table}\n")
        process = subprocess.Popen([PIRSIM, "--scene", self.scene, "--script", study, "--summary", "s.md"],
                                   cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
        time.sleep(1)
        process.send_signal(signal.SIGTERM)
        told = process.communicate(timeout=20)[1].decode()
        self.assertIn(process.returncode, (75, -signal.SIGTERM), told)
        self.assertFalse((self.folder / "s.md").exists())

    def test_a_scene_from_a_pipe_finds_its_buffers_from_the_working_folder(self):
        def outside(scene):
            header, data = scene["buffers"][0]["uri"].split(",", 1)
            import base64
            self.write("room.bin", base64.b64decode(data))
            scene["buffers"][0]["uri"] = "room.bin"
        self.edited_scene(outside)
        expected = self.study("-q")[0]
        rows, _ = shell('"$PIRSIM" --scene <(cat edited.gltf) --script study.yaml -q', self.folder)
        self.assertEqual(rows, expected)
        rows, _ = shell('"$PIRSIM" --scene - --script study.yaml -q < edited.gltf', self.folder)
        self.assertEqual(rows, expected)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        told = shell('"$PIRSIM" --scene <(cat ../edited.gltf) --script ../study.yaml', elsewhere, code=3)[1]
        self.assertIn("buffer file 'room.bin' can't be found", told)

    def test_two_inputs_are_not_one_stream(self):
        for args in (("--scene", "-", "--script", "-"), ("reconcile", "--scene", "a", "--script", "-", "--nuisance", "-")):
            self.assertIn("can't both be standard input", run(*args, code=2, data=b"")[1])

    def test_what_can_not_be_read_is_told_as_that(self):
        for args in (("--scene", "/proc/self/mem", "--script", self.script), ("--scene", self.scene, "--script", "/proc/self/mem"),
                     ("dataset", "/proc/self/mem", "-o", self.folder / "made")):
            self.assertIn("/proc/self/mem: error: can't be read: ", run(*args, code=4)[1])


class Characters(InputsCase):
    def test_what_is_not_utf8_is_refused_when_it_is_read(self):
        bad = b"pirsim_script: 1\nname: \"caf\xe9\"\n"
        place = "2:11: error: not UTF-8: byte 0xE9"
        self.assertIn("bad.yaml:" + place, run("check", "--scene", self.scene, "--script", self.write("bad.yaml", bad), code=3)[1])
        for kind, args in ((b"pirsim_recipe", ("dataset", "-o", self.folder / "made")), (b"pirsim_recipe", ("room", "-o", "x.gltf")),
                           (b"pirsim_coverage", ("coverage", "--scene", self.scene, "-o", "x.csv", "--script")),
                           (b"pirsim_walk_test", ("walktest", "--scene", self.scene, "-o", "x.csv", "--script")),
                           (b"pirsim_placements", ("placements", "--scene", self.scene, "--script"))):
            file = self.write("bad.yaml", bad.replace(b"pirsim_script", kind))
            self.assertIn("bad.yaml:" + place, run(*args, file, code=3)[1])
        self.assertFalse((self.folder / "made").exists())
        sensor = (DATA / "sensors" / self.model).read_bytes().replace(b"sources:", b"sources: # \xff", 1)
        self.write(f"sensors/{self.model}", sensor)
        self.assertRegex(self.check(code=3)[1], rf"sensors/{self.model}:\d+:12: error: not UTF-8: byte 0xFF")
        shutil.rmtree(self.folder / "sensors")
        scene = self.scene.read_bytes().replace(b'"name"', b'"name\xc3"', 1)
        self.assertRegex(run("check", "--scene", self.write("bad.gltf", scene), "--script", self.script, code=3)[1],
                         r"bad.gltf:\d+:\d+: error: not UTF-8: byte 0xC3")
        self.assertIn("rows.csv:2:3: error: not UTF-8", self.measured(b"trial,time_s,PIR1\n1,\xff,0\n", 3))
        told = run("check", "--scene", self.scene, "--script", self.script, "--set", b"name=\xff".decode(errors="surrogateescape"),
                   code=2)[1]
        self.assertIn("not UTF-8: byte 0xFF", told)

    def test_names_that_nobody_sees_for_what_they_are(self):
        for name, told in (("\\x07", "U+0007"), ("a\\u202eb", "U+202E"), ("a\\u0085b", "U+0085"), ("a\\nb", "U+000A"), ("\\0", "U+0000")):
            script = self.write("named.yaml", SCRIPT.replace("id: a", f'id: "{name}"'))
            self.assertRegex(run("check", "--scene", self.scene, "--script", script, code=3)[1], f"named.yaml:3:15: error: .*{re.escape(told)}")
            recipe = self.write("named.yaml", RECIPE + f'name: "{name}"\n')
            self.assertRegex(run("dataset", recipe, "-o", self.folder / "made", code=3)[1], f"named.yaml:6:7: error: .*{re.escape(told)}")
            self.assertIn(told, run("check", "--scene", self.scene, "--script", self.script, "--set", f'people.0.id="{name}"', code=3 if "n" in name else 2)[1])
        key = self.write("named.yaml", 'pirsim_script: 1\n"a\\x1bb": 1\n')
        self.assertRegex(run("check", "--scene", self.scene, "--script", key, code=3)[1], "named.yaml:2:1: error: .*U\\+001B")
        for name, told in (("\x07", "U+0007"), ("\u2066x", "U+2066"), ("a\nb", "U+000A"), ("\x00", "U+0000")):
            for collection in ("nodes", "meshes"):
                def rename(scene):
                    scene[collection][0]["name"] = name
                scene = self.edited_scene(rename)
                self.assertRegex(run("check", "--scene", scene, "--script", self.script, code=3)[1],
                                 rf"edited.gltf:\d+:\d+: error: /{collection}/0/name: .*{re.escape(told)}")
        self.assertIn("U+202E", self.measured("trial,time_s,PIR1\n1\u202e,1,0\n", 3))

    def test_utf16_with_its_mark_is_read(self):
        rows = "trial,time_s," + ",".join(self.sensors()) + "\n" + "".join(
            f"1,{t}," + ",".join("0" for _ in self.sensors()) + "\n" for t in range(1, 41))
        for encoding in ("utf-16-le", "utf-16-be"):
            encoded = "\ufeff".encode(encoding) + rows.encode(encoding)
            self.assertIn("NOBODY", self.measured(encoded, 2))
            script = self.write("utf16.yaml", "\ufeff".encode(encoding) + SCRIPT.encode(encoding))
            self.assertEqual(run("--scene", self.scene, "--script", script, "-q")[0], self.study("-q")[0])
            scene = self.write("utf16.gltf", "\ufeff".encode(encoding) + self.scene.read_text().encode(encoding))
            self.assertEqual(run("--scene", scene, "--script", self.script, "-q")[0], self.study("-q")[0])
            self.assertIn("half of a pair of surrogates", self.measured(encoded + "\ud800".encode(encoding, "surrogatepass"), 3))
            self.assertIn("is it UTF-16 without a byte order mark?", self.measured(rows.encode(encoding), 3))
        self.assertIn("UTF-32 isn't read", self.measured("\ufeff".encode("utf-32-le") + rows.encode("utf-32-le"), 3))

    def sensors(self):
        return [node["extras"]["pirsim"]["id"] for node in json.loads(self.scene.read_text())["nodes"]
                if node.get("extras", {}).get("pirsim", {}).get("type") == "sensor"]


class Measured(InputsCase):
    def rows(self, seconds=60):
        rows = self.study("-q")[0].decode().splitlines()
        return rows[:1] + rows[1:seconds + 1]

    def test_bits_as_tables_write_them_that_had_a_missing_value(self):
        header, *rows = self.rows()
        n_sensors = len(header.split(",")) - 5
        floats = [",".join(row.split(",")[:-n_sensors] + [bit + ".0" for bit in row.split(",")[-n_sensors:]]) for row in rows]
        self.assertIn("NOBODY", self.measured("\n".join([header, *floats]) + "\n", 2))

    def test_faults_of_one_kind_are_one_message_with_a_count(self):
        header, *rows = self.rows()
        told = self.measured("\n".join([header, *(row[:-1] + "x" for row in rows)]) + "\n", 3)
        self.assertIn(f"expected 0 or 1, got 'x'; {len(rows) - 1} more like this", told)
        self.assertEqual(told.count("error:"), 1)
        told = self.measured("\n".join([header, *(row + ",0" for row in rows)]) + "\n", 3)
        self.assertRegex(told, rf"rows.csv:2:1: error: expected \d+ fields, got \d+; {len(rows) - 1} more like this")
        self.assertEqual(told.count("error:"), 1)
        told = self.measured("\n".join([header, *("1,1,soon" + row[row.index(",", 4):] for row in rows)]) + "\n", 3)
        self.assertIn(f"time_s: expected a number, got 'soon'; {len(rows) - 1} more like this", told)
        self.assertEqual(told.count("error:"), 1)

    def test_own_compressed_rows_are_decompressed(self):
        header, *rows = self.rows()
        text = "\n".join([header, *rows]) + "\n"
        self.assertIn("NOBODY", self.measured(gzip.compress(text.encode()), 2, name="rows.csv.gz"))
        self.assertIn("NOBODY", self.measured(gzip.compress(text.encode()), 2, name="rows.csv"))
        for ending in (".csv.gz", ".csv.zst"):
            self.study("-o", self.folder / ("own" + ending), "-q")
            self.assertIn("NOBODY", self.measured(self.folder / ("own" + ending), 2))
        self.assertIn("rows.csv.gz: error: is cut short", self.measured(gzip.compress(text.encode())[:-20], 3, name="rows.csv.gz"))
        bomb = gzip.compress(b"0" * 300_000_000)
        self.assertIn("holds more than 16 MB, decompressed", self.measured(bomb, 3, memory=LIMIT))

    def test_own_rows_of_a_schedule_are_refused_since_nobody_knows_who_was_there(self):
        schedule = self.write("day.yaml", 'pirsim_script: 1\nschedule: {from: "09:00", to: "09:02", staff: [{count: 1}]}\n')
        rows = run("--scene", self.scene, "--script", schedule, "-q")[0]
        self.assertIn(b",time,", rows.splitlines()[0])
        self.assertIn("a schedule draws who is there", self.measured(rows, 3, script=schedule))

    def test_other_separators_are_named(self):
        text = "\n".join(self.rows()) + "\n"
        for separator in (";", "\t"):
            self.assertIn("columns must be separated by commas", self.measured(text.replace(",", separator), 3))

    def test_data_longer_than_a_simulated_run_are_refused_before_gaps_are_filled(self):
        sensors = ",".join(self.rows()[0].split(",")[5:])
        bits = ",".join("0" for _ in sensors.split(","))
        gaps = "time_s," + sensors + "\n" + "".join(f"{1 + 3599 * i},{bits}\n{2 + 3599 * i},{bits}\n{3 + 3599 * i},{bits}\n" for i in range(20_000))
        told = self.measured(gaps, 3, memory=LIMIT)
        self.assertIn("this run lasts 71976403 s; a simulated one lasts 10000000 s at most", told)
        runs = "replicate,time_s," + sensors + "\n" + "".join(
            f"{run},{1 + 3599 * i},{bits}\n{run},{2 + 3599 * i},{bits}\n{run},{3 + 3599 * i},{bits}\n"
            for run in range(1, 11) for i in range(2_000))
        self.assertIn("more than 10000000 rows, gaps included", self.measured(runs, 3, memory=LIMIT))

    def test_more_replicates_than_can_be_simulated_are_refused_at_once(self):
        sensors = ",".join(self.rows()[0].split(",")[5:])
        bits = ",".join("0" for _ in sensors.split(","))
        rows = "replicate,time_s," + sensors + "\n" + "".join(f"{run},1,{bits}\n" for run in range(1, 400_001))
        began = time.monotonic()
        told = self.measured(rows, 3)
        self.assertIn("rows.csv:10002:1: error: more than 10000 replicates of trial '1'", told)
        if "PIRSIM_SANITIZED" not in os.environ:
            self.assertLess(time.monotonic() - began, 15)


class Messages(InputsCase):
    def test_long_names_are_shortened_wherever_they_are_quoted(self):
        long = "n" * 5_000_000
        def rename(scene):
            scene["nodes"][0]["name"] = long
            scene["nodes"][0]["matrix"] = [0] * 16
        def remark(scene):
            scene["nodes"].append({"name": long, "extras": {"pirsim": {"type": "seat", "id": long}}})
            scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
        def require(scene):
            scene["extensionsRequired"] = [long]
        inputs = [("--scene", self.edited_scene(change, f"{i}.gltf"), "--script", self.script)
                  for i, change in enumerate((rename, remark, require))]
        for i, text in enumerate((SCRIPT.replace("S6", long), SCRIPT.replace("door", long), SCRIPT + f"? {long}\n: 1\n",
                                  SCRIPT + f"effects: [{long}]\n", SCRIPT + f"summary: {{phases: [{long}]}}\n",
                                  SCRIPT.replace("40}", long + "}"))):
            inputs.append(("--scene", self.scene, "--script", self.write(f"{i}.yaml", text)))
        for args in inputs:
            told = run("check", *args, code=5 if args[1].name == "1.gltf" else 3)[1]
            self.assertIn("nnn...", told)
            self.assertLess(len(told), 20_000)
        told = self.measured(f"trial,time_s,{long}\n1,1,1\n", 3)
        self.assertLess(len(told), 20_000)

    def test_a_nul_cuts_no_message_off(self):
        script = self.write("nul.yaml", SCRIPT.replace("id: a", 'id: "x\\0y"'))
        told = run("check", "--scene", self.scene, "--script", script, code=3)[1]
        self.assertIn("'x?y' contains the control character U+0000", told)
        told = self.measured(b"trial,time_s,PIR1\n1,1,\x00\n", 3)
        self.assertIn("rows.csv:2:5: error: a NUL character", told)

    def test_markdown_shows_names_as_they_are(self):
        name = "a <script>alert(1)</script> [b](c) `d` *e* | f"
        escaped = "a \\<script\\>alert(1)\\</script\\> \\[b\\](c) \\`d\\` \\*e\\* \\| f"
        self.script.write_text(SCRIPT.replace("a minute", json.dumps(name)))
        self.study("--summary", self.folder / "s.md", "-q", "-o", self.folder / "rows.csv")
        self.assertIn(f"# {escaped}: seconds with motion\n", (self.folder / "s.md").read_text())
        recipe = self.write("r.yaml", RECIPE + f"name: {json.dumps(name)}\n")
        run("dataset", recipe, "-o", self.folder / "made", "-q")
        self.assertTrue((self.folder / "made" / "README.md").read_text().startswith(f"# {escaped}\n"))

    def test_times_that_run_backwards_are_named(self):
        script = self.write("back.yaml", SCRIPT.replace("{sit: S6}", "{sit: S6, at_s: 30.5}").replace("{work: {", "{at_s: 20, work: {"))
        told = run("check", "--scene", self.scene, "--script", script, code=3)[1]
        self.assertRegex(told, r"back.yaml:3:\d+: error: .*starts at 20 s, .* starts at 30.5 s: time runs backwards")

    def test_a_faulty_sensor_file_keeps_its_place(self):
        sensor = (DATA / "sensors" / "EKMC1603111.yaml").read_text()
        self.write("sensors/OWN.yaml", sensor.replace("plane_m:", "plane_n:").replace("id: EKMC1603111", "id: OWN"))
        told = run("room", "--set", "sensors=[{mount: corner, model: OWN}]", "--sensors", self.folder / "sensors", "-o",
                   self.folder / "x.gltf", code=3)[1]
        self.assertRegex(told, r"sensors/OWN.yaml:\d+:\d+: error: .*plane_n")
        recipe = self.write("r.yaml", RECIPE.replace("depth_m: 4", "depth_m: 4, sensors: [{mount: corner, model: OWN}]"))
        told = run("dataset", recipe, "--sensors", self.folder / "sensors", "-o", self.folder / "made", code=3)[1]
        self.assertRegex(told, r"sensors/OWN.yaml:\d+:\d+: error: .*plane_n")

    def test_an_unknown_sensor_says_where_it_was_looked_for(self):
        mine = self.folder / "mine"
        mine.mkdir()
        def change(scene):
            next(n for n in scene["nodes"] if n.get("extras", {}).get("pirsim", {}).get("type") == "sensor")["extras"]["pirsim"]["model"] = "NOWHERE"
        told = run("check", "--scene", self.edited_scene(change), "--script", self.script, "--sensors", mine, code=3)[1]
        self.assertIn(f"looked for 'NOWHERE.yaml' in '{mine}', '{self.folder}/sensors'", told)
        for args in (("room", "--set", "sensors=[{mount: corner, model: NOWHERE}]", "-o", self.folder / "x.gltf"),
                     ("placements", "--scene", self.scene, "--script",
                      self.write("p.yaml", PLACEMENTS + "sets: [{id: a, sensors: [{model: NOWHERE, position_m: [0, 2, 0], yaw_deg: 0}]}]\n"))):
            self.assertIn(f"looked for 'NOWHERE.yaml' in '{mine}'", run(*args, "--sensors", mine, code=3)[1])

    def test_no_place_is_named_where_there_is_none(self):
        for args in (("room", "--width", 2, "--depth", 2, "--seats", 9, "-o", self.folder / "x.gltf"),
                     ("room", "--kind", "meeting", "--seats", 200, "--width", 3, "-o", self.folder / "x.gltf")):
            told = subprocess.run([PIRSIM, *map(str, args)], capture_output=True, text=True).stderr
            self.assertTrue(told.startswith("error: "), told)
        def no_door(scene):
            for node in scene["nodes"]:
                if node.get("extras", {}).get("pirsim", {}).get("type") == "entrance":
                    del node["extras"]
        scene = self.edited_scene(no_door)
        told = run("run", "--scene", scene, "--staff", 1, "--days", 1, "-q", code=3)[1]
        self.assertNotRegex(told, r"pirsim run:\d")
        self.assertIn("error: ", told)

    def test_words_of_json_are_told_whole(self):
        for text, told in (('{"asset": {"version": "2.0"}, type: 5}', "unexpected type"), ('{"a": nothing}', "unexpected nothing"),
                           ('{"a": True}', "unexpected True"), ('{"a": [1, falsch]}', "unexpected falsch")):
            scene = self.write("words.gltf", text)
            self.assertIn(told, run("check", "--scene", scene, "--script", self.script, code=3)[1])


if __name__ == "__main__":
    main()
