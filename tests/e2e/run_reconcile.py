#!/usr/bin/env python3
"""The worked example of docs/howto/reconcile.md, word for word but on a study of one seat and half a minute; then
`plan` and `selftest` on the same; and all three pages in a browser, if there is one. Then data whose clock is late, or
early, by three seconds.

Usage: run_reconcile.py PIRSIM SOURCE_DIRECTORY
"""
import csv
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from run_report_pages import check_page

SHORT = ["--set", "trials.for_each.seat=[S1]", "--set", "people.0.actions.3.work.duration_s=30"]


def example(source):
    """The commands between the fences below the heading."""
    text = (source / "docs/howto/reconcile.md").read_text(encoding="utf-8")
    section = text.split("## Try it on the shipped room", 1)[1]
    return re.search(r"```sh[^\n]*\n(.*?)```", section, flags=re.DOTALL).group(1)


def run_example(pirsim, source, folder):
    """On a short script in place of Study A and with the smallest table."""
    shutil.copytree(source / "data", folder / "data")
    config = subprocess.run([pirsim, "--scene", source / "data/rooms/meeting_room.gltf", "--script",
                             source / "data/studies/studyA.yaml", *SHORT, "--print-config"], capture_output=True, text=True,
                            check=True).stdout
    (folder / "data/studies/studyA.yaml").write_text(config)
    commands = re.sub(r"--budget [0-9.]+", "", example(source))
    commands = commands.replace("pirsim reconcile --scene", "pirsim reconcile --budget 0.05 --max-effects 1 --scene")
    assert "--budget 0.05" in commands, commands
    (folder / "bin").mkdir()
    (folder / "bin/pirsim").symlink_to(pathlib.Path(pirsim).resolve())
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}",
                   "PIRSIM_DATA_DIR": str(folder / "data")}  # whose Study A is the short one
    result = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=folder, env=environment, capture_output=True,
                            text=True)
    report = json.loads((folder / "found/report.json").read_text())
    if report["verdict"] in ("named", "several"):
        assert result.returncode == 0, result.stderr
    else:  # nothing to apply: so little data may not tell
        assert not (folder / "found/script_patched.yaml").exists()
    assert report["sentence"] in result.stdout, result.stdout
    assert report["where"]["p"] <= 1.0
    with open(folder / "found/candidates.csv", newline="") as table:
        reasons = {row["effect"]: row["reason"] for row in csv.DictReader(table)}
    known = subprocess.run([pirsim, "effects", "--format", "csv"], capture_output=True, text=True, check=True).stdout
    counts_only = {"people_miscounted"}  # which this script hasn't got
    assert set(reasons) == {row["effect"] for row in csv.DictReader(io.StringIO(known))} - counts_only, reasons
    assert reasons["thermal_contrast"].startswith("Judged as range_scale"), reasons["thermal_contrast"]
    return report


def stamped(rows, by_s):
    """CSV text of measured rows, each with the bits of the row so many seconds before; 0 where there is none."""
    lines = [line for line in rows.splitlines() if not line.startswith("#")]
    table = list(csv.DictReader(lines))
    sensors = [name for name in table[0] if name not in ("replicate", "trial", "time_s", "phase", "people")]
    at = {(row["replicate"], row["trial"], float(row["time_s"])): [row[s] for s in sensors] for row in table}
    text = ",".join(["replicate", "trial", "time_s", *sensors]) + "\n"
    for replicate, trial, time_s in at:
        bits = at.get((replicate, trial, time_s - by_s), ["0"] * len(sensors))
        text += ",".join([replicate, trial, f"{time_s:g}", *bits]) + "\n"
    return text


def check_clocks(pirsim, source, folder):
    """Late and early data are told apart, by about as much as they are off, and the patched script repairs them."""
    script = folder / "errand.yaml"
    script.write_text("pirsim_script: 1\nreplicates: 4\nsensing: {response: zones}\n"
                      "trials: {for_each: {k: [a, b]}, id: '${k}'}\npeople:\n  - id: p\n"
                      "    actions: [{enter: door}, {sit: S4}, {work: {duration_s: 30}}, rise, {leave: door}]\n")
    study = ["-q", "--scene", source / "data/rooms/meeting_room.gltf", "--script", script]
    rows = subprocess.run([pirsim, *study, "--seed", "99", "-o", "-"], capture_output=True, text=True, check=True).stdout
    for by_s in (3, -3):
        measured, out = folder / f"clock_{by_s}.csv", folder / f"clock_{by_s}"
        measured.write_text(stamped(rows, by_s))
        subprocess.run([pirsim, "reconcile", *study, "--measured", measured, "--effects", "clock_lag,trunk_tilt",
                        "--budget", "1", "-o", out], capture_output=True, text=True, check=True)
        report = json.loads((out / "report.json").read_text())
        assert report["verdict"] == "named" and report["effects"] == ["clock_lag"], report["sentence"]
        lag_s = float(re.search(r"lag_s: (\S+)", (out / "script_patched.yaml").read_text()).group(1))
        assert abs(lag_s - by_s) < 1.5, (by_s, report["sentence"])
        before, after = report["verification"]["before"], report["verification"]["after"]
        assert after["energy_score"] < 0.6 * before["energy_score"], report["verification"]
    check_faulty_file(pirsim, study, rows, folder)


def check_faulty_file(pirsim, study, rows, folder):
    """A column that holds another's rows is told first, whatever the comparison says, and nothing is patched. The table
    of the check of clocks serves."""
    header, *lines = stamped(rows, 0).splitlines()
    names = header.split(",")
    one, other = names.index("PIR1"), names.index("PIR2")
    table = [line.split(",") for line in lines]
    for row in table:
        row[other] = row[one]
    measured, out = folder / "twins.csv", folder / "twins"
    measured.write_text("\n".join([header, *(",".join(row) for row in table)]) + "\n")
    result = subprocess.run([pirsim, "reconcile", *study, "--measured", measured, "--effects", "clock_lag,trunk_tilt",
                             "--budget", "1", "--table", folder / "clock_-3/table", "--max-effects", "1", "-o", out],
                            capture_output=True, text=True, check=True)
    report = json.loads((out / "report.json").read_text())
    assert result.stdout.startswith("Look at the file first: PIR1 and PIR2 are equal in all"), result.stdout
    assert report["verdict"] == "faulty-data" and report["verdict_of_rows"] != "faulty-data", report["sentence"]
    [finding] = [finding for finding in report["data_findings"] if finding["impossible"]]
    assert finding["kind"] == "equal_columns" and finding["sensors"] == ["PIR1", "PIR2"], finding
    assert finding["chance"] < 1e-9 and finding["rows"] == len(table), finding
    assert "A look at the file" in (out / "report.html").read_text()
    assert "file: PIR1 and PIR2 are equal" in (out / "trail.log").read_text()
    assert not (out / "script_patched.yaml").exists()


def check_analog(pirsim, source, folder):
    """Sensors with the analog response, which nobody asked for since it is the default: what was hidden is named, its
    script comes nearer to the data, and what means nothing to such sensors isn't looked for."""
    script = folder / "analog.yaml"
    script.write_text("pirsim_script: 1\nreplicates: 2\n"
                      "trials: {for_each: {k: [S4, S8]}, id: '${k}'}\npeople:\n  - id: p\n"
                      "    actions: [{enter: door}, {sit: '${k}'}, {work: {duration_s: 40}}, rise, {leave: door}]\n")
    study = ["-q", "--scene", source / "data/rooms/meeting_room.gltf", "--script", script]
    measured, out = folder / "analog.csv", folder / "analog"
    subprocess.run([pirsim, *study, "--seed", "99", "--set", "effects=[{missed_triggers: {probability: 0.5}}]", "-o",
                    measured], check=True)
    subprocess.run([pirsim, "reconcile", *study, "--measured", measured, "--effects", "missed_triggers,range_scale",
                    "--budget", "0.2", "--max-effects", "1", "-o", out], capture_output=True, text=True, check=True)
    report = json.loads((out / "report.json").read_text())
    assert report["verdict"] == "named" and report["effects"] == ["missed_triggers"], report["sentence"]
    assert any("dual_polarity" in note for note in report["measured"]["notes"]), report["measured"]["notes"]
    before, after = report["verification"]["before"], report["verification"]["after"]
    assert after["energy_score"] < before["energy_score"], report["verification"]
    subprocess.run([pirsim, *study[:3], "--script", out / "script_patched.yaml", "-o", folder / "patched.csv"], check=True)


def main():
    pirsim, source = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_clocks(pirsim, source, folder)
        check_analog(pirsim, source, folder)
        report = run_example(pirsim, source, folder)
        study = ["-q", "--scene", folder / "data/rooms/meeting_room.gltf", "--script", folder / "data/studies/studyA.yaml"]

        def reconcile(command, *more):
            return subprocess.run([pirsim, "reconcile", command, *study, "--budget", "0.05", *more], cwd=folder,
                                  capture_output=True, text=True, check=True).stdout

        # Each into its own folder, where none is asked for.
        sentence = reconcile("plan", "--effects", "missed_triggers,false_triggers").strip()
        plan = json.loads((folder / "reconcile_plan/plan.json").read_text())
        assert plan["sentence"] == sentence and plan["hypotheses"] == ["nothing", "missed_triggers", "false_triggers"]
        designs = list(csv.DictReader((folder / "reconcile_plan/plan.csv").open()))
        assert [d["design"] for d in designs][:2] == ["as planned", "all again"], designs
        assert {"slow walk", "empty room"} <= {d["design"] for d in designs}, (designs, plan["notes"])
        assert abs(float(designs[0]["minutes"]) - 0.5) < 0.05, designs
        twice = subprocess.run([pirsim, "reconcile", "plan", *study, "--effects", "dead_time,dead_time"], capture_output=True,
                               text=True)
        assert twice.returncode == 2 and "dead_time twice" in twice.stderr, twice
        known = subprocess.run([pirsim, "reconcile", "plan", *study, "--effects", "dead_time", "--set",
                                "effects=[{dead_time: {}}]"], capture_output=True, text=True)
        assert known.returncode == 2 and "the script already has dead_time" in known.stderr, known
        # False triggers are counted best where nobody is; without anybody there is nothing to miss.
        for row in plan["confusion"]:
            assert abs(sum(row) - 1.0) < 1e-9, row

        reconcile("selftest", "--nulls", "5", "--injected", "1", "--table", folder / "found/table")
        self_test = folder / "reconcile_selftest"
        assert "| a name although nothing is hidden | " in (self_test / "selftest.md").read_text()
        assert not (folder / "reconcile").exists()
        assert (self_test / "selftest.html").stat().st_size > 400_000

        if chromium:
            fits = sum(p["unit"] is not None for fit in report["fits"] for p in fit["parameters"])
            differs = report["verdict"] != "no-disagreement"
            verified = report["verification"] is not None
            check_page(chromium, folder / "found/report.html", 2 + differs + fits + verified, folder)
            check_page(chromium, folder / "reconcile_plan/plan.html", 3, folder)
            charts = (self_test / "selftest.html").read_text().count("<figure>")
            assert charts >= 27 + 2, charts
            check_page(chromium, self_test / "selftest.html", charts, folder, widths=(1400,))
    print("reconcile: example, plan, self-test and their pages are whole")


if __name__ == "__main__":
    main()
