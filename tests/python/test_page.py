"""What the page for Python users (docs/howto/python.md) shows does what it says: its blocks run, in order, as a reader
types them."""

import re
import shutil
import warnings

import pytest

import pirsim

# What would take minutes, and what is run instead.
QUICKER = {
    "range(1000)": "range(2)",
    "runs=range(100)": "runs=range(4)",
    'folder="report", table="table")': 'folder="report", table="table", budget=0.05, effects=["missed_triggers"])',
    '"spacing_m": 0.1': '"spacing_m": 0.5',
    '"walk_test.yaml")': '"walk_test.yaml", set={"spacing_m": 1.0})',
    '/studies/studyA.yaml")\n': '/studies/studyA.yaml", set={"replicates": 3})\n',
    '/studies/studyB.yaml")\n': '/studies/studyB.yaml", set={"spacing_m": 0.5})\n',
}


def blocks_of(source):
    text = (source / "docs" / "howto" / "python.md").read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


@pytest.fixture
def folder(data, room, study_a, tmp_path, monkeypatch):
    """With the files that the page speaks of: a user's room and studies, and measurements of the study."""
    pytest.importorskip("matplotlib").use("Agg")
    for library in ("pandas", "polars", "xarray"):
        pytest.importorskip(library)
    (tmp_path / "data").symlink_to(data)
    small = pirsim.read_script(study_a, set={"replicates": 1, "trials.for_each.seat": ["S3", "S8"]})
    pirsim.write_script(small, tmp_path / "study.yaml")
    shutil.copy(data / "recipes" / "tiny.yaml", tmp_path / "recipe.yaml")
    for file in (room, data / "studies" / "studyB.yaml", data / "studies" / "walk_test.yaml"):
        shutil.copy(file, tmp_path / ("room.gltf" if file == room else file.name))
    shutil.copytree(data / "sensors", tmp_path / "sensors")
    small.effects = [pirsim.Effect("missed_triggers", {"probability": 0.6})]
    small.seed = 7
    measured = pirsim.run(pirsim.compile(room, small))
    measured.to_pandas().to_csv(tmp_path / "measured.csv", index=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_pages_blocks_run_as_they_stand(source, folder):
    names = {}
    left = dict(QUICKER)
    for block in blocks_of(source):
        for written, quicker in QUICKER.items():
            if written in block:
                left.pop(written, None)
                block = block.replace(written, quicker)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pirsim.InputWarning)
            exec(compile(block, "docs/howto/python.md", "exec"), names)
    assert not left, "the page no longer says this"
    for picture in ("study_a.png", "coverage.png"):
        assert (folder / picture).stat().st_size > 10_000


def test_pictures_take_ten_lines(source):
    drawn = [block for block in blocks_of(source) if "savefig" in block]
    assert len(drawn) == 2
    for block in drawn:
        assert 0 < len([line for line in block.splitlines() if line.strip()]) <= 10
