"""Coverage maps and walk tests are the command line's."""

import csv

import numpy as np
import pytest

import pirsim


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def test_a_coverage_map_equals_the_command_lines(room, data, command, tmp_path):
    script = data / "studies" / "studyB.yaml"
    command("coverage", "--scene", room, "--script", script, "--set", "spacing_m=0.4", "-q", "-o", tmp_path)
    told = []
    coverage = pirsim.coverage(room, script, set={"spacing_m": 0.4}, progress=lambda *done: told.append(done))
    rows = read(tmp_path / "coverage.csv")
    row, column = np.nonzero(coverage.on_floor)
    assert len(rows) == len(row) > 20
    assert [float(r["x_m"]) for r in rows] == pytest.approx(coverage.x[column], abs=1e-4)
    assert [float(r["z_m"]) for r in rows] == pytest.approx(coverage.z[row], abs=1e-4)
    for i, sensor in enumerate(coverage.sensors):
        assert [int(r[sensor]) for r in rows] == coverage.counts[row, column, i].tolist()
    assert told[-1] == (len(coverage.z), len(coverage.z))
    assert np.isnan(coverage.share[~coverage.on_floor]).all()
    assert (coverage.share[row, column] <= 1).all() and coverage.share[row, column].max() > 0
    assert coverage.extent == pytest.approx((coverage.x[0] - 0.2, coverage.x[-1] + 0.2, coverage.z[-1] + 0.2,
                                             coverage.z[0] - 0.2))
    same = pirsim.coverage(pirsim.read_scene(room), script, set={"spacing_m": 0.4}, threads=1)
    assert np.array_equal(same.counts, coverage.counts)


def test_a_walk_test_equals_the_command_lines(room, data, command, tmp_path):
    script = data / "studies" / "walk_test.yaml"
    command("walktest", "--scene", room, "--script", script, "--set", "spacing_m=1", "-q", "-o", tmp_path / "w.csv")
    test = pirsim.walk_test(room, script, set={"spacing_m": 1})
    rows = read(tmp_path / "w.csv")
    row, column = np.nonzero(test.on_floor)
    assert len(rows) == len(row) > 10
    for name, array in (("major_tries", test.major_made), ("major_noticed", test.major_noticed),
                        ("minor_tries", test.minor_made), ("minor_noticed", test.minor_noticed),
                        ("minor_deaf", test.minor_deaf)):
        assert [int(r[name]) for r in rows] == array[row, column].tolist()
    assert set(test.seats) == set(pirsim.compile(room, data / "studies" / "studyA.yaml").seats.names)


def test_an_arm_swings_in_place_of_a_sitters(room, data):
    cells = {"spacing_m": 0.8, "major_motion.path_m": 0.8}
    test = pirsim.walk_test(room, data / "studies" / "nema_wd7.yaml", set=cells)
    assert test.minor_made.max() == 8 and not test.seats  # two planes in four directions; an arm sits nowhere


def test_faults_of_a_survey_are_told(room, data):
    script = data / "studies" / "studyB.yaml"
    with pytest.raises(pirsim.InputError, match="piano"):
        pirsim.coverage(room, script, set={"without": ["piano"], "spacing_m": 0.4})
    with pytest.raises(pirsim.InputError, match="spacing_m"):
        pirsim.coverage(room, script, set={"spacing_m": -1})
    with pytest.raises(pirsim.InputError, match="this is a coverage study"):
        pirsim.walk_test(room, script)
