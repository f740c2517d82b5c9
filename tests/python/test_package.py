"""Types, stubs, documentation and examples are in step with the module."""

import ast
import importlib.util
import inspect
import os
import pathlib
import runpy
import subprocess
import sys

import pytest

import pirsim
from pirsim import _core

FOLDER = pathlib.Path(pirsim.__file__).parent


def names_of_stub(body):
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name, node
        elif isinstance(node, ast.AnnAssign):
            yield node.target.id, node


def test_the_stub_is_in_step_with_the_module():
    assert (FOLDER / "py.typed").exists()
    stub = dict(names_of_stub(ast.parse((FOLDER / "_core.pyi").read_text()).body))
    public = {name for name in vars(_core) if not name.startswith("_")}
    assert {name for name in stub if not name.startswith("_")} == public
    for name in public:
        thing = getattr(_core, name)
        if inspect.isclass(thing):
            members = {member for member, _ in names_of_stub(stub[name].body)}
            assert {member for member in vars(thing) if not member.startswith("_")} <= members
        elif callable(thing):
            assert ast.get_docstring(stub[name]) == thing.__doc__.split("\n\n", 1)[-1].strip(), name


def test_everything_public_says_what_it_is():
    for name in pirsim.__all__:
        thing = getattr(pirsim, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert thing.__doc__ and not thing.__doc__.startswith(f"{thing.__name__}("), name


def test_version_and_data():
    assert pirsim.__version__.count(".") == 2
    assert (pathlib.Path(pirsim.data_directory) / "sensors" / "EKMC1604111.yaml").is_file()


def test_shipped_files_are_found_by_name(data, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = pirsim.compile("meeting_room.gltf", "studyA.yaml")
    assert model.scene.seats == pirsim.read_scene(data / "rooms/meeting_room.gltf").seats
    assert pirsim.read_script("studyA.yaml").name == model.script.name
    assert pirsim.coverage("meeting_room.gltf", "studyB.yaml", set={"spacing_m": 1}).sensors == model.sensors.names
    assert pirsim.sensor_model("EKMC1604111.yaml") == pirsim.sensor_model("EKMC1604111")
    assert pirsim.room("tiny.yaml", 1).sensors
    with pytest.raises(pirsim.FileError, match="shipped rooms .did you mean 'meeting_room.gltf'"):
        pirsim.compile("meeting_rom.gltf", "studyA.yaml")
    (tmp_path / "studyA.yaml").write_text("pirsim_script: 2")
    with pytest.raises(pirsim.InputError, match="^studyA.yaml:1:"):  # a file that is there wins
        pirsim.read_script("studyA.yaml")


def test_the_command_is_the_program_in_the_package():
    done = subprocess.run([sys.executable, "-m", "pirsim", "data", "studyA.yaml"], capture_output=True, text=True)
    assert done.returncode == 0 and pathlib.Path(done.stdout.strip()).name == "studyA.yaml", done.stderr
    assert subprocess.run([sys.executable, "-m", "pirsim", "help", "nothing"], capture_output=True).returncode == 2


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy isn't installed")
def test_types_are_right(source, tmp_path):
    program = tmp_path / "typed.py"
    program.write_text("""\
import numpy as np
import numpy.typing as npt
import pirsim

model: pirsim.Model = pirsim.compile("room.gltf", "study.yaml", set={"seed": 1})
result: pirsim.Result = pirsim.run(model, range(3), progress=print)
bits: npt.NDArray[np.uint8] = result.bits
script: pirsim.Script = pirsim.read_script("study.yaml")
script.trials[0].people[0].actions.append(pirsim.Walk(points=[(1.0, 2.0)]))
script.trials[0].people[0].stature_m = "tall"  # the only fault
""")
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"),
                           str(program)], capture_output=True, text=True,
                          env={**os.environ, "MYPYPATH": str(FOLDER.parent)})
    faults = [line for line in done.stdout.splitlines() if "error:" in line and "typed.py" in line]
    assert len(faults) == 1 and "typed.py:10:" in faults[0], done.stdout


@pytest.mark.parametrize("example", ["study_a", "coverage_map"])
def test_examples_draw_what_they_say(example, source, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [example, "quick"])
    names = runpy.run_path(str(source / "examples" / f"{example}.py"), run_name="__main__")
    pictures = list(tmp_path.glob("*.png"))
    if example == "study_a":  # the study that agrees with the measurement: 1297 s against 958 s with exact seats
        assert 1130 < names["seconds"].mean(axis=0).sum() < 1460
    assert len(pictures) == 1 and pictures[0].stat().st_size > 10_000


@pytest.mark.slow
@pytest.mark.parametrize("notebook, says", [("room_to_counter", "mean absolute error"),
                                            ("measurements_to_verdict", "seconds with motion")])
def test_notebooks_run(notebook, says, source, capsys, monkeypatch):
    monkeypatch.setattr(sys, "argv", [notebook, "quick"])
    path = source / "docs" / "notebooks" / f"{notebook}.py"
    names = runpy.run_path(str(path), run_name="__main__")
    assert says in capsys.readouterr().out
    if notebook == "room_to_counter":  # what it shows is worth showing
        assert names["desk_sensors"] < 0.75 * names["mean_error"]
