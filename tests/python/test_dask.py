"""Shards on a cluster of processes against one process: the same bytes, whoever is lost."""

import os
import pathlib
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


def test_a_dataset_has_the_files_of_one_process(client, command, program, data, tmp_path):
    recipe = data / "recipes" / "tiny.yaml"
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
