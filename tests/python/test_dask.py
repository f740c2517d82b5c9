"""Shards on a cluster of processes against one process: the same bytes, whoever is lost."""

import os
import pathlib
import shutil
import signal

import pytest

import pirsim
import pirsim.dask
from pirsim.specs import InputFile

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def client():
    with distributed.LocalCluster(n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            yield client


@pytest.fixture
def program():
    return [os.environ["PIRSIM"]]


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_study_has_the_bytes_of_one_process_though_a_worker_is_killed(client, command, program, room, study_a, tmp_path):
    command("--scene", room, "--script", study_a, "--replicates", 20, "-o", tmp_path / "one.csv", "-q")
    workers = set(client.run(os.getpid).values())
    seen = []

    def kill_one(there, shards):
        if not seen:
            os.kill(min(workers), signal.SIGKILL)
        seen.append((there, shards))

    pirsim.dask.run_study(client, room, study_a, tmp_path / "many.csv", shards=24, arguments=["--replicates", "20"],
                          command=program, progress=kill_one)
    assert (tmp_path / "many.csv").read_bytes() == (tmp_path / "one.csv").read_bytes()
    assert seen == [(n, 24) for n in range(1, 25)]
    client.wait_for_workers(3)
    assert min(workers) not in client.run(os.getpid).values()

    # What is there isn't simulated again, what lacks is.
    (tmp_path / "many.csv.shards" / "shard-0007-of-0024.csv.json").unlink()
    seen.clear(), seen.append("nobody is killed")
    pirsim.dask.run_study(client, room, study_a, tmp_path / "many.csv", shards=24, arguments=["--replicates", "20"],
                          command=program, progress=lambda *told: seen.append(told))
    assert seen[1:] == [(24, 24)]
    assert (tmp_path / "many.csv").read_bytes() == (tmp_path / "one.csv").read_bytes()


def test_rows_of_another_study_are_refused_and_never_returned(client, program, room, study_a, tmp_path):
    script, rows = tmp_path / "study.yaml", tmp_path / "rows.csv"
    script.write_text(study_a.read_text())

    def run(*arguments, shards=2):
        pirsim.dask.run_study(client, room, script, rows, shards=shards, arguments=["--replicates", "1", *arguments],
                              command=program)

    run()
    before = files_of(tmp_path)
    for arguments in (["--set", "sensing.rays_per_zone=9"], ["--seed", "5"], ["--response", "analog"]):
        with pytest.raises(pirsim.InputError, match="can't be resumed because its inputs differ"):
            run(*arguments)
    with pytest.raises(pirsim.UsageError, match="holds shards of 2"):
        run(shards=3)
    script.write_text(study_a.read_text() + "# edited\n")
    with pytest.raises(pirsim.InputError, match="content of study.yaml"):
        run()
    script.write_text(study_a.read_text())
    assert files_of(tmp_path) == before
    # One shard of elsewhere among those of this study.
    other = tmp_path / "rows.csv.shards" / "shard-0002-of-0002.csv.json"
    other.write_text(other.read_text().replace("\"seed\": 2021", "\"seed\": 7"))
    assert other.read_bytes() != before["rows.csv.shards/shard-0002-of-0002.csv.json"]
    with pytest.raises(pirsim.InputError, match="isn't made from what"):
        run()
    with pytest.raises(pirsim.UsageError, match="are one file"):
        pirsim.dask.run_study(client, room, script, script, shards=2, command=program)
    assert script.read_text() == study_a.read_text()


def test_a_folder_of_another_dataset_is_refused(client, program, recipe, data, tmp_path):
    recipe = shutil.copy(recipe, tmp_path / "recipe.yaml")

    def run(folder):
        pirsim.dask.run_dataset(client, recipe, tmp_path / folder, shards=2, sensors=[data / "sensors"], command=program)

    run("made")
    recipe.write_text(recipe.read_text().replace("seed: ", "seed: 9"))
    (tmp_path / "users").mkdir()
    (tmp_path / "users" / "README.md").write_text("mine")
    before = files_of(tmp_path)
    with pytest.raises(pirsim.InputError, match="holds another dataset"):
        run("made")
    with pytest.raises(pirsim.InputError, match="of no dataset"):
        run("users")
    assert files_of(tmp_path) == before


def test_a_dataset_has_the_files_of_one_process(client, command, program, recipe, data, tmp_path):
    command("dataset", recipe, "-o", tmp_path / "one", "--sensors", data / "sensors", "-q")
    pirsim.dask.run_dataset(client, recipe, tmp_path / "many", shards=4, sensors=[data / "sensors"],
                            command=program)
    assert files_of(tmp_path / "many") == files_of(tmp_path / "one")


def test_a_worker_refuses_other_files_and_other_builds(command, program, room, study_a):
    def work(files=(), build=f"{pirsim.__version__} ({pirsim.git_revision})", arguments=()):
        return pirsim.dask._Work(tuple(arguments), tuple(files), 2, tuple(program), build)

    with pytest.raises(pirsim.InputError, match="studyA.yaml: error: this worker's file isn't the client's"):
        pirsim.dask._shard(work([InputFile(str(study_a), 64 * "0")]), 1)
    with pytest.raises(pirsim.FileError, match="this worker has no such file"):
        pirsim.dask._shard(work([InputFile("nowhere.yaml", 64 * "0")]), 1)
    with pytest.raises(pirsim.UsageError, match="the client 0.0"):
        pirsim.dask._shard(work(build="0.0 (none)"), 1)
    with pytest.raises(pirsim.InputError) as refused:
        pirsim.dask._shard(work(arguments=["--scene", str(room), "--script", str(study_a), "--set", "sed=1"]), 1)
    assert "unknown key 'sed'" in str(refused.value)
    assert [(one.severity, one.file) for one in refused.value.diagnostics] == [("error", "--set sed=1")]


def test_a_fault_of_the_study_ends_the_work(client, command, program, room, tmp_path):
    script = pathlib.Path(tmp_path / "s.yaml")
    script.write_text("pirsim_script: 1\nname: x\npeople: [{id: p, actions: [{enter: door}, {sit: S99}]}]\n")
    with pytest.raises(pirsim.Error, match="S99"):
        pirsim.dask.run_study(client, room, script, tmp_path / "rows.csv", shards=3, command=program)
    assert not (tmp_path / "rows.csv").exists()
