"""The Python of the pages runs as it stands there, on the files that it names, with fewer runs where many take long."""

import re
import shutil

import pytest

import pirsim

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)
FILES_OF_MY_ROOM = re.compile(r"^```\w+ file=(\S+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
SMALLER = {"range(1000)": "range(3)",
           'table="table")': 'table="table", budget=0.05, effects=["missed_triggers", "dead_time"])'}


def blocks_of(page):
    if not page.exists():
        pytest.skip(f"{page.name} isn't here")
    found = BLOCK.findall(page.read_text(encoding="utf-8"))
    assert found
    return found


@pytest.fixture
def folder(source, data, tmp_path, monkeypatch):
    """With the room and the study of docs/howto/my_room.md, 200 runs of it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").symlink_to(data)
    for name, text in FILES_OF_MY_ROOM.findall((source / "docs/howto/my_room.md").read_text(encoding="utf-8")):
        (tmp_path / name).write_text(text.replace("replicates: 3", "replicates: 200"))
    return tmp_path


def test_the_readmes(source, folder):
    pytest.importorskip("pandas")
    names = {}
    for block in blocks_of(source / "README.md"):
        exec(block, names)
    assert names["result"].bits.shape[0] == 200 and names["result"].bits.any()


def test_those_of_the_page_on_python(source, data, room, folder):
    pytest.importorskip("pandas")
    shutil.copy(room, "room.gltf")
    for name in ("studyB.yaml", "walk_test.yaml"):
        shutil.copy(data / "studies" / name, name)
    shutil.copy(data / "recipes" / "tiny.yaml", "recipe.yaml")
    short = {"replicates": 1, "people.0.actions.2.work.duration_s": 30}
    script = pirsim.read_script("study.yaml", set=short)
    pirsim.write_script(script, "study.yaml")
    script.seed = 7
    pirsim.run(pirsim.compile("room.gltf", script)).to_pandas().to_csv("measured.csv", index=False)
    names, tried = {}, set()
    for block in blocks_of(source / "docs/howto/python.md"):
        for shown, smaller in SMALLER.items():
            if shown in block:
                tried.add(shown)
                block = block.replace(shown, smaller)
        exec(block, names)
    assert tried == set(SMALLER)
    assert names["coverage"].share.shape[2] == 5 and names["test"].major_made.sum() > 0
    assert names["found"].sentence and (folder / "report/report.html").exists()


def test_the_room_with_walls_of_the_page_on_rooms(source, folder):
    """It can be read, a study of it runs, and every ray ends: a lack of walls would be a warning."""
    names = {}
    for block in blocks_of(source / "docs/howto/my_room.md"):
        exec(block, names)
    result = pirsim.run(pirsim.compile("walled.gltf", "study.yaml", set={"replicates": 2}))
    assert result.bits.any() and not result.faults


def test_those_of_the_page_on_datasets(source, data, folder):
    pytest.importorskip("pandas")
    pirsim.dataset(data / "recipes" / "tiny.yaml", "small_offices")
    names = {}
    for block in blocks_of(source / "docs/howto/dataset.md"):
        exec(block, names)
    assert len(names["train"]) > 1000 and names["train"]["people"].max() >= 1
