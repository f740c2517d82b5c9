"""Datasets and reconcile give what the command line gives."""

import filecmp
import json

import pytest

import pirsim


def files_of(folder):
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


def test_a_dataset_equals_the_command_lines(recipe, data, command, tmp_path):
    command("dataset", recipe, "-o", tmp_path / "a", "-q")
    told = []
    pirsim.dataset(recipe, tmp_path / "b", progress=lambda *done: told.append(done))
    assert told[-1] == (4, 4)
    rows = [path for path in files_of(tmp_path / "a") if ".csv" in path.name]
    assert len(rows) >= 4 and files_of(tmp_path / "a") == files_of(tmp_path / "b")
    assert filecmp.cmpfiles(tmp_path / "a", tmp_path / "b", rows, shallow=False)[0] == rows
    package = json.loads((tmp_path / "b" / "datapackage.json").read_text())
    assert package["resources"]
    pirsim.dataset(recipe, tmp_path / "b", resume=True)  # nothing to do
    with pytest.raises(pirsim.InputError):
        pirsim.dataset(data / "recipes" / "tiny.yaml", tmp_path / "b")
    with pytest.raises(pirsim.InputError, match="holds another dataset"):
        pirsim.dataset(recipe, tmp_path / "b", set={"sensing.response": "zones"})


def test_rooms_of_a_recipe_are_scenes(recipe, tmp_path):
    room = pirsim.room(recipe, 2)
    assert room.seats and room.sensors and room == pirsim.room(recipe, 2) != pirsim.room(recipe, 1)
    with pytest.raises(IndexError, match="rooms 1 to 2"):
        pirsim.room(recipe, 3)
    script = pirsim.Script("visit", [pirsim.Trial("1", [pirsim.Person("a", [
        pirsim.Enter(entrance=room.entrances[0].id), pirsim.Sit(seat=room.seats[0].id),
        pirsim.Leave(entrance=room.entrances[0].id)])])])
    result = pirsim.run(pirsim.compile(room, script))
    assert result.bits.any() and result.people.max() == 1
    # Through a file, in single precision, the room is the same but for the last digits.
    pirsim.write_scene(room, tmp_path / "room.gltf")
    again = pirsim.run(pirsim.compile(tmp_path / "room.gltf", script))
    assert again.people.tolist() == result.people.tolist()


@pytest.mark.slow
def test_reconcile_equals_the_command_line(room, study_a, command, tmp_path):
    pytest.importorskip("pandas")
    changes = {"trials.for_each.seat": ["S3", "S8"], "replicates": 1}
    script = pirsim.read_script(study_a, set=changes)
    pirsim.write_script(script, tmp_path / "study.yaml")
    script.effects = [pirsim.Effect("missed_triggers", {"probability": 0.6})]
    script.seed = 7
    measured = pirsim.run(pirsim.compile(room, script))
    measured.to_pandas().to_csv(tmp_path / "measured.csv", index=False)
    command("reconcile", "--scene", room, "--script", tmp_path / "study.yaml", "--measured", tmp_path / "measured.csv",
            "--budget", "0.05", "--effects", "missed_triggers,dead_time", "--table", tmp_path / "table", "-q",
            "-o", tmp_path / "report")
    told = json.loads((tmp_path / "report" / "report.json").read_text())
    for data in (measured, tmp_path / "measured.csv"):
        found = pirsim.reconcile(room, tmp_path / "study.yaml", data, budget=0.05, table=tmp_path / "table",
                                 effects=["missed_triggers", "dead_time"], folder=tmp_path / "again")
        assert found.verdict == told["verdict"] and found.sentence in json.dumps(told, ensure_ascii=False)
        assert {cell.trial for cell in found.cells} == {"S3", "S8"} and len(found.cells) == 10
        assert {candidate.effect for candidate in found.candidates} == {"missed_triggers", "dead_time"}
        assert [effect.name for effect in found.patched.effects] == [fit.effect.name for fit in found.fits]
    assert (tmp_path / "again" / "candidates.csv").read_bytes() == (tmp_path / "report" / "candidates.csv").read_bytes()
    with pytest.raises(pirsim.Error, match="did you mean 'dead_time'"):
        pirsim.reconcile(room, study_a, measured, effects=["dead_tyme"])
