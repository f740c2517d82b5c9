#!/usr/bin/env python3
"""Days that nobody scripted: the chapter of docs/howto/reconcile.md, word for word, finds the sensor that was made to report what isn't there; then
what is refused, and what is told of counts that differ.

Usage: run_days.py PIRSIM SOURCE_DIRECTORY
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

STUDY = ("--scene", "data/rooms/meeting_room.gltf", "--script", "day.yaml")


def chapter(source):
    """The commands between its fences."""
    text = (source / "docs/howto/reconcile.md").read_text(encoding="utf-8")
    section = text.split("\n## 8. If you have a log and counts", 1)[1]
    blocks = re.findall(r"```sh tested by tests/e2e/run_days.py\n(.*?)```", section, flags=re.DOTALL)
    assert len(blocks) == 2, blocks
    return "\n".join(blocks)


def reconcile(pirsim, folder, *args, code, out="refused"):
    result = subprocess.run([pirsim, "reconcile", *map(str, args), "-o", out], cwd=folder, capture_output=True,
                            text=True, timeout=600)
    assert result.returncode == code, f"{args}: {result.returncode}, expected {code}\n{result.stderr}"
    return result.stderr


def check_chapter(pirsim, source, folder):
    (folder / "data").symlink_to(source / "data")
    (folder / "bin").mkdir()
    (folder / "bin/pirsim").symlink_to(pirsim)
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    result = subprocess.run(["bash", "-euo", "pipefail", "-c", chapter(source)], cwd=folder, env=environment,
                            capture_output=True, text=True, timeout=1200)
    assert result.returncode == 0, result.stderr
    assert "Read as a log of 480 lines, a reading every 30 s" in result.stderr, result.stderr
    report = json.loads((folder / "result/report.json").read_text())
    assert report["sentence"] in result.stdout, result.stdout
    assert report["verdict"] in ("named", "one-of"), report["sentence"]
    assert "false_triggers" in report["effects"], report["sentence"]
    assert report["left_over"] is None, "days by their counts have no trials that follow each other"
    trials = {cell["trial"] for cell in report["where"]["cells"]}
    assert any(trial.startswith("2 people from") for trial in trials), trials


def check_refusals(pirsim, folder):
    schedule = (folder / "schedule.yaml")
    schedule.write_text("pirsim_script: 1\nsensing: {response: zones}\n"
                        "schedule: {first_day: 2026-03-02, staff: [{role: staff, count: 1}]}\n")
    told = reconcile(pirsim, folder, *STUDY[:2], "--script", schedule, "--measured", "log.csv", code=3)
    assert "occupancy: {counts: FILE}" in told, told
    told = reconcile(pirsim, folder, *STUDY, "--set", "sensing.window_s=1", "--measured", "log.csv", code=3)
    assert "window_s: 30" in told, told
    lines = (folder / "log.csv").read_text()
    (folder / "other.csv").write_text(lines.replace("PIR", "motion_"))
    told = reconcile(pirsim, folder, *STUDY, "--measured", "other.csv", code=3)
    assert "--map" in told and "motion_1" in told, told
    (folder / "late.csv").write_text(lines.replace("2026-03-02", "2026-04-02"))
    told = reconcile(pirsim, folder, *STUDY, "--measured", "late.csv", code=3)
    assert "nothing of the log lies in the script's runs" in told, told
    (folder / "map.yaml").write_text("pirsim_log: 1\nsensors: {PIR1: S6_PIR}\n")
    told = reconcile(pirsim, folder, *STUDY, "--measured", "real.csv", "--map", "map.yaml", code=2)
    assert "is no log" in told, told


def check_counts(pirsim, folder):
    """A column of people that isn't the script's is told before anything is simulated: the folder can't be written."""
    lines = (folder / "real.csv").read_text().splitlines()
    names = lines[0].split(",")
    at = names.index("people")
    rows = [line.split(",") for line in lines[1:]]
    for row in rows[:100]:
        row[at] = "7"
    (folder / "miscounted.csv").write_text("\n".join(",".join(row) for row in [names, *rows]) + "\n")
    nowhere = "/proc/refused"  # where nobody can make a folder
    told = reconcile(pirsim, folder, *STUDY, "--measured", "miscounted.csv", code=4, out=nowhere)
    assert re.search(r"count other people than the script in \d+ of \d+ windows, first 7 instead of 0", told), told
    told = reconcile(pirsim, folder, *STUDY, "--measured", "real.csv", code=4, out=nowhere)
    assert "count other people" not in told, told


def main():
    pirsim, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_chapter(pirsim, source, folder)
        check_refusals(pirsim, folder)
        check_counts(pirsim, folder)
    print("days: the chapter's commands, refusals, counts")
    return 0


sys.exit(main())
