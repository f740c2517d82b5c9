#!/usr/bin/env python3
"""An analysis of `pirsim reconcile` knows nothing but the data: neither the script's seed nor threads change a byte.

Usage: run_data_only.py PIRSIM DATA_DIRECTORY
"""
import csv
import json
import pathlib
import subprocess
import tempfile

from program import PIRSIM, Case, main

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
HIDDEN = "effects=[{sensor_tilt: {tilt_deg: 1}}, {false_triggers: {rate_per_s: 0.3}}]"
SMALLEST = 0.05  # of the budget


def call(*words, cwd):
    result = subprocess.run([str(PIRSIM), *map(str, words)], capture_output=True, text=True, cwd=cwd)
    assert result.returncode == 0, (words, result.returncode, result.stdout, result.stderr)
    return result.stdout


def study_in(folder, seed):
    folder.mkdir()
    (folder / "study.yaml").write_text(SCRIPT.replace("SEED", str(seed)))
    return folder


STUDY = "--scene", "meeting_room.gltf", "--script", "study.yaml"  # where it lies stands in the report


def measured(study, file, seed):
    """Rows of this room with something hidden, as somebody measures them: people aren't counted."""
    rows = list(csv.reader(call("run", *STUDY, "--seed", seed, "--set", HIDDEN, "-q", cwd=study).splitlines()))
    people = rows[0].index("people")
    file.write_text("".join(",".join(row[:people] + row[people + 1:]) + "\n" for row in rows))


def analyse(study, measured, out, *more):
    call("reconcile", *STUDY, "--measured", measured, "--budget", SMALLEST, "-o", out, "-q", *more, cwd=study)
    return json.loads((out / "report.json").read_text())


def files_below(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


class DataOnly(Case):
    def test_an_analysis_knows_the_data_only(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        study, other = study_in(folder / "a", seed=5), study_in(folder / "b", seed=123456789)
        measured(study, folder / "measured.csv", seed=7)
        report = analyse(study, folder / "measured.csv", folder / "out", "--threads", 1)
        self.assertLess(report["where"]["p"], 0.05)  # so that all of the analysis has run

        # Elsewhere, with another seed and two threads, every byte is the same: but for the seed of the patched script,
        # which is the study's own.
        (folder / "elsewhere").mkdir()
        data = (folder / "measured.csv").rename(folder / "elsewhere/measured.csv")
        analyse(other, data, folder / "again", "--threads", 2)
        self.assertEqual(files_below(folder / "out"), files_below(folder / "again"))
        self.assertIn(pathlib.Path("report.html"), files_below(folder / "out"))
        for name in files_below(folder / "out"):
            with_all, with_data = ((folder / out / name).read_bytes() for out in ("out", "again"))
            if name.name == "script_patched.yaml":
                with_data = with_data.replace(b"seed: 123456789", b"seed: 5")
            self.assertEqual(with_all, with_data, f"{name} depends on something but the data")

        # The twin that must differ: the same data with two sensors' columns exchanged.
        header, *rows = (line.split(",") for line in data.read_text().splitlines())
        one, two = header.index("PIR1"), header.index("PIR5")
        for row in rows:
            row[one], row[two] = row[two], row[one]
        (folder / "exchanged.csv").write_text("".join(",".join(row) + "\n" for row in [header, *rows]))
        changed = analyse(study, folder / "exchanged.csv", folder / "changed", "--table", folder / "out/table")
        self.assertNotEqual(changed["where"], report["where"])


if __name__ == "__main__":
    main()
