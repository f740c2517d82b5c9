"""The Python of the pages runs as it stands there, on the files that it names, with fewer runs where many take long."""

import datetime
import random
import re
import shutil
import warnings

import pytest

import pirsim

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)
FILES_OF_MY_ROOM = re.compile(r"^```\w+ file=(\S+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
# What would take minutes on the page on Python, and what is run instead.
QUICKER = {
    "range(1000)": "range(2)",
    "runs=range(100)": "runs=range(4)",
    'folder="report", table="table")': 'folder="report", table="table", budget=0.05, effects=["missed_triggers"])',
    '"spacing_m": 0.1': '"spacing_m": 0.5',
    '"placements.yaml")': '"placements.yaml", set={"search.evaluations": 2, "spacing_m": 1.0})',
    '"walk_test.yaml")': '"walk_test.yaml", set={"spacing_m": 1.0})',
    "set=scatter)": 'set={**scatter, "replicates": 3})',
    '"meeting_room.gltf", "studyB.yaml")': '"meeting_room.gltf", "studyB.yaml", set={"spacing_m": 0.5})',
}


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


def write_week(file):
    """A log of two sensors: some hours of motion with pauses between them."""
    begin, rng = datetime.datetime(2026, 3, 2, 8), random.Random(1)
    lines = ["time,left,right"]
    for i in range(1, 1000):
        lines.append(f"{(begin + datetime.timedelta(seconds=30 * i)).isoformat()},{int(rng.random() < 0.3)},"
                     f"{int(rng.random() < 0.2)}")
    file.write_text("\n".join(lines) + "\n")


def test_those_of_the_page_on_python(source, data, room, study_a, recipe, folder):
    """In order, with the files that the page speaks of, and with measurements in which an effect is hidden."""
    pytest.importorskip("matplotlib").use("Agg")
    for library in ("pandas", "polars", "xarray"):
        pytest.importorskip(library)
    for file in (room, data / "studies/studyB.yaml", data / "studies/walk_test.yaml", data / "studies/placements.yaml"):
        shutil.copy(file, {room.name: "room.gltf"}.get(file.name, file.name))
    (folder / "recipe.yaml").write_text(recipe.read_text().replace("count: 1,", "count: 2,", 1))
    write_week(folder / "week.csv")
    script = pirsim.read_script(study_a, set={"replicates": 1, "trials.for_each.seat": ["S3", "S8"],
                                           "people.0.actions.3.work.duration_s": 60})
    pirsim.write_script(script, "study.yaml")
    script.effects = [pirsim.Effect("missed_triggers", {"probability": 0.6})]
    script.seed = 7
    pirsim.run(pirsim.compile("room.gltf", script)).to_pandas().to_csv("measured.csv", index=False)
    names, left = {}, set(QUICKER)
    for block in blocks_of(source / "docs/howto/python.md"):
        for written, quicker in QUICKER.items():
            if written in block:
                left.discard(written)
                block = block.replace(written, quicker)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pirsim.InputWarning)
            exec(compile(block, "docs/howto/python.md", "exec"), names)
    assert not left, "the page no longer says this"
    assert names["coverage"].share.shape[2] == 5 and names["test"].major_made.sum() > 0
    assert names["found"].sentence and (folder / "report/report.html").exists()
    assert names["log"].motion.any() and len(names["estimates"].people) == 999
    assert (folder / "counter.json").exists() and (folder / "counts.csv").exists()
    for picture in ("study_a.png", "coverage.png"):
        assert (folder / picture).stat().st_size > 10_000


def test_the_pictures_of_the_page_on_python_take_ten_lines(source):
    drawn = [block for block in blocks_of(source / "docs/howto/python.md") if "savefig" in block]
    assert len(drawn) == 2
    for block in drawn:
        assert 0 < len([line for line in block.splitlines() if line.strip()]) <= 10


def test_the_room_with_walls_of_the_page_on_python(source):
    """A study of it runs, and rays end at it: `check` warns of the same room without walls."""
    [block] = [block for block in blocks_of(source / "docs/howto/python.md") if "Mesh.box" in block]
    names = {"pirsim": pirsim}
    exec(block, names)
    assert names["result"].bits.any() and not names["result"].faults
    scene, script = names["scene"], names["script"]
    assert not pirsim.check(scene, script).warnings
    scene.meshes = []
    assert "walls" in pirsim.check(scene, script).warnings[0].text


def test_those_of_the_page_on_datasets(source, dataset, folder):
    pytest.importorskip("pandas")
    (folder / "small_offices").symlink_to(dataset)
    names = {}
    for block in blocks_of(source / "docs/howto/dataset.md"):
        exec(block, names)
    assert len(names["train"]) > 1000 and names["train"]["people"].max() >= 1
