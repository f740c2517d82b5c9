#!/usr/bin/env python3
"""The commands coverage, walktest and placements as a user calls them.

Usage: run_coverage.py PIRSIM DATA_DIRECTORY
"""
import functools
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time


def light(pirsim, data, folder):
    """Placements by false-offs: what the table tells of the best set is what a run of its scene and `control` tell."""
    def called(*words, code=0):
        result = subprocess.run([pirsim, *map(str, words)], capture_output=True, text=True)
        assert result.returncode == code, (words, result.returncode, result.stderr)
        return result

    (folder / "people.yaml").write_text("""
pirsim_script: 1
sensing: {tick_rate_hz: 10}
replicates: 2
people:
  - {id: one, style: natural, actions: [{enter: door}, {sit: S2}, {work: {duration_s: 900}}, {leave: door}]}
  - {id: two, style: natural, actions: [{enter: door, at_s: 60}, {sit: S9}, {work: {duration_s: 600}}, {leave: door}]}
""")
    study = folder / "light.yaml"
    study.write_text("""
pirsim_placements: 1
by: false_off
light: {script: people.yaml, delay_min: 1}
spacing_m: 1
duration_s: 2
target: {x_shapes: {}}
sets: [{id: as built}]
search:
  n_sensors: 2
  model: EKMC1601111
  evaluations: 6
  lines: [{from_m: [0.5, 2.6, -1.2], to_m: [6.5, 2.6, -1.2], tilt_deg: 90}]
""")
    scene = ("--scene", data / "rooms/meeting_room.gltf", "--script", study)
    told = called("placements", *scene, "-o", folder / "lit.gltf", "--report", folder / "lit.html", "--threads", 1).stdout
    assert told.startswith("ranked by how seldom light goes off on somebody (delay 1 min)"), told
    assert "6 places tried: " in told and "false-offs an occupied hour" in told, told
    assert told == called("placements", *scene, "--threads", 3).stdout, "threads change the ranking"
    ranks = [line.split() for line in told.splitlines() if re.match(r" +\d+ +\d", line)]
    assert len(ranks) == 3 and [float(r[1]) for r in ranks] == sorted(float(r[1]) for r in ranks), told
    page = (folder / "lit.html").read_text(encoding="utf-8")
    assert "Light, area by area" in page and "false-offs an occupied hour" in page

    rule = folder / "rule.yaml"
    rule.write_text("pirsim_control: 1\nlights: [{id: light, delay_min: 1, wave_s: 10}]\n")
    called("run", "--scene", folder / "lit.gltf", "--script", folder / "people.yaml", "-o", folder / "lit_rows.csv")
    called("control", folder / "lit_rows.csv", "--rule", rule, "-o", folder / "costs.csv")
    lines = [line.split(",") for line in (folder / "costs.csv").read_text().splitlines()]
    costs = next(dict(zip(lines[0], line)) for line in lines[1:] if float(line[1]) == 1.0)
    assert abs(float(costs["false_offs_an_hour"]) - float(ranks[0][1])) < 6e-4, (costs, ranks[0])
    assert abs(100 * float(costs["dark_share"]) - float(ranks[0][2])) < 6e-3, (costs, ranks[0])
    assert abs(float(costs["lit_empty_h"]) - float(ranks[0][3])) < 6e-3, (costs, ranks[0])

    fault = called("placements", *scene, "--set", "by=false_of", code=3).stderr
    assert "did you mean 'false_off'" in fault, fault
    fault = called("placements", *scene, "--set", "light.script=peopl.yaml", code=3).stderr
    assert "peopl.yaml" in fault, fault


def main():
    pirsim, data = sys.argv[1], pathlib.Path(sys.argv[2])
    scene = ["--scene", str(data / "rooms/meeting_room.gltf")]

    def call(command, script, *more, code=0):
        result = subprocess.run([pirsim, command, *scene, "--script", str(script), *map(str, more)], capture_output=True,
                                text=True)
        assert result.returncode == code, (command, more, result.returncode, result.stderr)
        return result

    study_b = data / "studies/studyB.yaml"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        coarse = ["--set", "spacing_m=0.06"]
        whole = call("coverage", study_b, *coarse, "-o", folder / "one", "--threads", 1)
        assert "not seen" in whole.stdout and "PIR5" in whole.stdout, whole.stdout
        assert "'without' says: table top, table leg near left" in whole.stderr, whole.stderr
        csv = (folder / "one/coverage.csv").read_bytes()
        assert csv.startswith(b"x_m,z_m,PIR1,PIR2,PIR3,PIR4,PIR5\n"), csv[:80]
        call("coverage", study_b, *coarse, "-o", folder / "four", "--threads", 4)
        assert (folder / "four/coverage.csv").read_bytes() == csv, "threads change the map"
        assert [file.name for file in (folder / "one").iterdir()] == ["coverage.csv"]

        # Stopped on its way, it says so and leaves no half a map.
        command = [pirsim, "coverage", *scene, "--script", str(study_b), "--threads", "1", "-o", str(folder / "cut")]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 60
        while time.monotonic() < until and not (folder / "cut").exists() and process.poll() is None:
            time.sleep(0.005)
        process.send_signal(signal.SIGTERM)
        told = process.communicate(timeout=60)[1]
        assert process.returncode == 75 and "stopped by SIGTERM" in told, (process.returncode, told)
        assert list((folder / "cut").iterdir()) == []

        # The page of the format names every key of `sensing`, and each is read.
        page = (data.parent / "docs/formats/coverage.md").read_text(encoding="utf-8")
        named = re.findall(r"`(\w+)`", re.search(r"\| `sensing` \|.*?\|(.*)\|", page)[1])
        changed = {"rays_per_zone": 1, "change_per": "beam", "response": "analog", "reader": "free_running",
                   "tick_rate_hz": 25, "window_s": 2, "units": "guaranteed", "ambient_c": 30,
                   "analog_rays_per_zone": 9}
        assert set(named) == set(changed), named

        @functools.cache
        def map_with(*more):
            call("coverage", study_b, "--set", "spacing_m=0.5", "--set", "duration_s=6", *more, "-o", folder / "key")
            return (folder / "key/coverage.csv").read_bytes()

        for key, value in changed.items():
            analog = ["--set", "sensing.response=analog"] if key in ("units", "ambient_c", "analog_rays_per_zone") else []
            assert map_with(*analog, "--set", f"sensing.{key}={value}") != map_with(*analog), f"sensing.{key} changes nothing"

        fault = call("coverage", study_b, "--set", "without=[tabel]", "-o", folder / "no", code=3)
        assert "tabel" in fault.stderr and "did you mean" in fault.stderr, fault.stderr
        call("coverage", study_b, "--set", "duration_s=0.3", "-o", folder / "no", code=3)
        call("coverage", data / "studies/studyA.yaml", "-o", folder / "no", code=3)
        call("coverage", study_b, *coarse, "-o", "/dev/null/no", code=4)

        small = ["--set", "spacing_m=1", "--set", "minor_motion.directions=1"]
        walk = data / "studies/walk_test.yaml"
        assert "points pass" in call("walktest", walk, *small, "-o", folder / "w1.csv", "--threads", 1).stdout
        call("walktest", walk, *small, "-o", folder / "w2.csv", "--threads", 4)
        assert (folder / "w1.csv").read_bytes() == (folder / "w2.csv").read_bytes()

        call("walktest", data / "studies/nema_wd7.yaml", "-o", folder / "n1.csv")
        points = (folder / "n1.csv").read_text().splitlines()[1:]
        xs = sorted({float(line.split(",")[0]) for line in points})
        assert all(abs(b - a - 0.9144) < 2e-4 for a, b in zip(xs, xs[1:])), xs

        sets = ["--set", "spacing_m=0.3", "--set", "search.evaluations=8"]
        ranking = call("placements", data / "studies/placements.yaml", *sets).stdout
        assert "as built" in ranking and "more than even spacing" in ranking, ranking
        assert ranking.startswith("ranked by seen area\n"), ranking
        call("placements", data / "studies/placements.yaml", "--set", "search.model=NOPE", code=3)

        by_seats = [data / "studies/placements.yaml", "--set", "by=seats", "--set", "spacing_m=0.5"]
        better = folder / "better.gltf"
        ranking = call("placements", *by_seats, "--set", "search.evaluations=4", "-o", better, "--report",
                       folder / "sets.html").stdout
        assert ranking.startswith("ranked by seats where somebody at work is noticed"), ranking
        assert "4 places tried: " in ranking, ranking
        noticed = [int(line.split()[4]) for line in ranking.splitlines() if re.match(r" +\d+ +\d", line)]
        assert len(noticed) == 5 and noticed == sorted(noticed, reverse=True), ranking
        assert "After: the best set" in (folder / "sets.html").read_text() or "No set does better" in (folder / "sets.html").read_text()
        again = subprocess.run([pirsim, "placements", "--scene", better, "--script", by_seats[0], *map(str, by_seats[1:]),
                                "--set", "sets=[{id: as built}]", "--set", "search.evaluations=4"],
                               capture_output=True, text=True, check=True).stdout
        as_built = next(line for line in again.splitlines() if "as built" in line)
        assert int(as_built.split()[4]) == noticed[0], again  # the best set, read back, is noticed in as many seats
        fault = call("placements", data / "studies/placements.yaml", "--set", "by=seat", code=3).stderr
        assert "did you mean 'seats'" in fault, fault
        fault = call("placements", *by_seats, "--set", "search.evaluations=1", code=3).stderr
        assert "2 sensors need as many places" in fault, fault
        light(pirsim, data, folder)
    print("coverage, walk test and placements: as described")


if __name__ == "__main__":
    main()
