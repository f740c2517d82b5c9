"""Every diagnostic arrives, with its file, line and column."""

import csv
import warnings

import pytest

import pirsim
from pirsim import ErrorCode

CLASSES = {ErrorCode.USAGE: pirsim.UsageError, ErrorCode.INPUT: pirsim.InputError, ErrorCode.IO: pirsim.FileError,
           ErrorCode.INFEASIBLE: pirsim.InfeasibleError}


def hostile_scripts(source):
    return sorted((source / "tests" / "e2e" / "hostile" / "scripts").glob("*.yaml"))


def refused(scene, script):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(pirsim.Error) as caught:
            pirsim.compile(scene, script)
    return caught.value


def test_every_hostile_script_is_refused_at_its_line(source, room):
    files = hostile_scripts(source)
    assert len(files) >= 10
    for file in files:
        _, _, code, fragment = file.read_text().splitlines()[0].split(" ", 3)
        error = refused(room, file)
        assert error.code == int(code) and type(error) is CLASSES[error.code], file.name
        assert fragment in str(error), file.name
        if fragment.startswith(":"):
            place = [int(part) for part in fragment.split(":")[1:3] if part.strip().isdigit()]
            found = [[d.line, d.column][:len(place)] for d in error.diagnostics]
            assert place in found, file.name
            assert all(d.file.endswith(file.name) for d in error.diagnostics)


def test_diagnostics_are_those_of_the_command_line(source, room, command, capfd):
    import os
    import subprocess

    for file in hostile_scripts(source):
        error = refused(room, file)
        told = subprocess.run([os.environ["PIRSIM"], "check", "--scene", str(room), "--script", str(file)],
                              capture_output=True, text=True).stderr
        for diagnostic in error.diagnostics:
            assert str(diagnostic) in told.splitlines(), file.name


def test_every_hostile_scene_is_refused_at_its_line(source, study_a):
    folder = source / "tests" / "e2e" / "hostile" / "scenes"
    with open(folder / "expected.tsv", newline="") as file:
        expected = list(csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE))
    assert len(expected) > 30
    for row in expected:
        error = refused(folder / row["file"], study_a)
        assert isinstance(error, pirsim.InputError) and row["message"] in str(error), row["file"]
        line, _, column = row["place"].partition(":")
        if line.isdigit():
            assert [int(line), int(column or 0)] in [[d.line, d.column] for d in error.diagnostics], row["file"]


def test_all_faults_of_a_file_come_at_once(tmp_path, room):
    script = tmp_path / "faults.yaml"
    script.write_text("pirsim_script: 1\nreplicates: -1\npeople:\n  - id: a\n    stature_m: tall\n    colour: red\n")
    error = refused(room, script)
    assert [(d.line, d.severity) for d in error.diagnostics] == [(2, "error"), (5, "error"), (6, "error")]
    assert isinstance(error, ValueError) and len(str(error).splitlines()) == 3


def test_overrides_and_files_that_are_not_there(room, study_a, tmp_path):
    with pytest.raises(pirsim.InputError, match="did you mean 'people'"):
        pirsim.compile(room, study_a, set={"peple.0.stature_m.x": 1})
    with pytest.raises(pirsim.FileError, match="nothing.yaml"):
        pirsim.compile(room, tmp_path / "nothing.yaml")
    with pytest.raises(pirsim.InputError, match="stature_m"):
        pirsim.compile(room, study_a, set={"people.0.stature_m": 17})


def test_effects_that_do_nothing_here_are_warned_of(room, study_a):
    with pytest.warns(pirsim.InputWarning, match="dual_polarity"):
        pirsim.compile(room, study_a, set={"sensing.response": "analog", "effects": ["dual_polarity"],
                                           "replicates": 1})


