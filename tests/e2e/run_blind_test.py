#!/usr/bin/env python3
"""A whole blind challenge, sealed, analysed and opened, and proof that the analysis knows nothing but the data.

Usage: run_blind_test.py PIRSIM DATA_DIRECTORY
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PIRSIM = DATA = None
SCRIPT = """pirsim_script: 1
name: Two seats
seed: SEED
replicates: 1
sensing: {tick_rate_hz: 10, window_s: 1, rays_per_zone: 1, change_per: cluster, response: zones}
trials:
  for_each: {seat: [S1, S8]}
  id: ${seat}
people:
  - id: occupant
    stature_m: 1.86
    mass_kg: 80
    walking_speed_m_s: 3.0
    actions:
      - enter: door
      - sit: ${seat}
      - work: {duration_s: 16, arm_amplitude_m: 0.1, arm_period_s: 3, tilt_choices_deg: [-15, 0, 15], tilt_every_s: 8}
effects:
  - sensor_tilt: {tilt_deg: 1}  # known already: neither hidden nor looked for
"""
SMALLEST = 0.05  # of the budget


def call(*words, code=0):
    result = subprocess.run([str(PIRSIM), *map(str, words)], capture_output=True, text=True)
    assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
    return result.stdout


def study_in(folder, seed):
    folder.mkdir()
    (folder / "study.yaml").write_text(SCRIPT.replace("SEED", str(seed)))
    return ["--scene", DATA / "rooms/meeting_room.gltf", "--script", folder / "study.yaml"]


def seal(study, folder, secret_seed, kind="one"):
    call("reconcile", "seal", *study, "--hide", kind, "--secret-seed", secret_seed, "-o", folder / "public",
         "--answer", folder / "answer.json", "-q")
    return json.loads((folder / "answer.json").read_text())


def analyse(study, measured, out, *more):
    call("reconcile", *study, "--measured", measured, "--budget", SMALLEST, "-o", out, "-q", *more)
    return json.loads((out / "report.json").read_text())


def open_answer(folder, report):
    return call("reconcile", "open", "--answer", folder / "answer.json", "--commitment",
                folder / "public/commitment.sha256", "--report", report)


def family_of():
    rows = csv.DictReader(call("effects", "--format", "csv").splitlines())
    return {row["effect"]: row["family"] for row in rows}


def expected_mark(hidden, verdict, named):
    """By docs/formats/reconcile.md, for effects of the catalogue; written without a look at pirsim's own."""
    families = family_of()
    if not named:
        return "none"
    if verdict == "one-of" and hidden & named:
        return "one-of"
    if verdict != "one-of" and hidden == named:
        return "exact"
    if verdict != "one-of" and named < hidden:
        return "part"
    return "family" if {families[e] for e in hidden} == {families[e] for e in named} else "wrong"


def files_below(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


class BlindTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def test_a_challenge_is_sealed_analysed_and_opened_and_the_analysis_knows_the_data_only(self):
        study = study_in(self.folder / "a", seed=5)
        answer = seal(study, self.folder, secret_seed=7)
        data = self.folder / "public/measured.csv"
        report = analyse(study, data, self.folder / "out", "--threads", 1)
        hidden = {effect["name"] for effect in answer["effects"]}
        mark = open_answer(self.folder, self.folder / "out/report.json").split(":")[0]
        self.assertEqual(mark, expected_mark(hidden, report["verdict"], set(report["effects"])))

        # Where there is no answer, no hash, no other seed to be had, every byte is the same: but for the seed of the
        # patched script, which is the study's own.
        other = study_in(self.folder / "b", seed=123456789)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        data.rename(elsewhere / "measured.csv")
        (self.folder / "answer.json").rename(self.folder / "a" / "gone")
        (self.folder / "a/gone").write_text("")
        (self.folder / "public/commitment.sha256").unlink()
        analyse(other, elsewhere / "measured.csv", self.folder / "again", "--threads", 2)
        self.assertEqual(files_below(self.folder / "out"), files_below(self.folder / "again"))
        self.assertIn(pathlib.Path("report.html"), files_below(self.folder / "out"))
        for name in files_below(self.folder / "out"):
            with_all, with_data = ((self.folder / out / name).read_bytes() for out in ("out", "again"))
            if name.name == "script_patched.yaml":
                with_data = with_data.replace(b"seed: 123456789", b"seed: 5")
            self.assertEqual(with_all, with_data, f"{name} depends on something but the data")

        # The twin that must differ: the same data with two sensors' columns exchanged.
        header, *rows = (line.split(",") for line in (elsewhere / "measured.csv").read_text().splitlines())
        one, two = header.index("PIR1"), header.index("PIR5")
        for row in rows:
            row[one], row[two] = row[two], row[one]
        (elsewhere / "exchanged.csv").write_text("".join(",".join(row) + "\n" for row in [header, *rows]))
        changed = analyse(study, elsewhere / "exchanged.csv", self.folder / "changed", "--table", self.folder / "out/table")
        self.assertNotEqual(changed["where"], report["where"])

    def test_every_mark_is_what_its_definition_says(self):
        """All pairs of one hidden effect and a report that names another effect, the same, two, or none."""
        study = study_in(self.folder / "a", seed=5)
        answer = seal(study, self.folder, secret_seed=7)
        digest = json.loads((self.folder / "answer.json").read_text())["measured_sha256"]
        hidden = {effect["name"] for effect in answer["effects"]}
        families = family_of()
        own_family = next(iter({families[e] for e in hidden}))
        others = sorted(set(families) - hidden)
        seen = set()
        judged = [("named", {e}) for e in sorted(families)] + [("one-of", {others[0], e}) for e in sorted(families)]
        judged += [("several", {a, b}) for a in sorted(hidden) for b in others[:3]] + [("none-in-catalogue", set())]
        siblings = {e for e in others if families[e] == own_family}
        judged += [("one-of", siblings), ("several", siblings)]
        for verdict, named in judged:
            with self.subTest(verdict=verdict, named=named):
                report = self.folder / "report.json"
                report.write_text(json.dumps({"pirsim_reconcile_report": 1, "verdict": verdict,
                                              "effects": sorted(named), "measured": {"sha256": digest}}))
                mark = open_answer(self.folder, report).split(":")[0]
                self.assertEqual(mark, expected_mark(hidden, verdict, named))
                seen.add(mark)
        self.assertTrue(siblings, "the hidden effect is alone in its family: choose another secret seed")
        self.assertEqual(seen, {"exact", "family", "one-of", "wrong", "none"})


if __name__ == "__main__":
    PIRSIM, DATA = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
    unittest.main(verbosity=2)
