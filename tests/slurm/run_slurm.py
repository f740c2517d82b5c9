#!/usr/bin/env python3
"""A campaign on a real Slurm, brought up on this machine from Debian's packages (slurm-wlm, munge).

Usage: run_slurm.py PIRSIM SOURCE_DIR. Submits an array by tools/slurm/submit, kills one task and cancels another,
submits what `pirsim merge --status` prints, lets the dependent job merge, and compares bytes with a single process. Exit code
77, a skip for CTest, where the packages or the rights (root) are missing.
"""
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo")
SHARDS = 6
REPLICATES = 240  # 2400 runs: a shard takes a second or more, so that it can be killed on its way

CONFIGURATION = """
ClusterName=pirsim_test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def skip(why):
    print(f"SKIPPED: {why}", file=sys.stderr)
    sys.exit(77)


def program(name):
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def wait_for(what, condition, seconds=120):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if condition():
            return
        time.sleep(0.1)
    raise AssertionError(f"waited {seconds} s in vain: {what}")


class Cluster:
    """munged, slurmctld and slurmd in a folder of their own."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, []
        for name in ("state", "spool"):
            (folder / name).mkdir()
        (folder / "munge.key").write_bytes(os.urandom(1024))
        (folder / "munge.key").chmod(0o600)
        self.configuration = folder / "slurm.conf"
        self.configuration.write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], folder=folder, controller_port=free_port(), node_port=free_port()))
        self.environment = {**os.environ, "SLURM_CONF": str(self.configuration)}
        # Nothing limits tasks here. Slurm 24 wants cgroups all the same, unless it is told; Slurm 22 refuses the word.
        if int(re.search(r"(\d+)\.", self.call("slurmd", "-V"))[1]) >= 24:
            (folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")

    def __enter__(self):
        try:
            self.bring_up()
        except BaseException:
            self.__exit__(*sys.exc_info())  # which isn't called for what was never entered
            raise
        return self

    def bring_up(self):
        self.start("munged", "--foreground", f"--key-file={self.folder}/munge.key",
                   f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munge.pid",
                   f"--log-file={self.folder}/munge.log", f"--seed-file={self.folder}/munge.seed", "--force")
        wait_for("munged's socket", (self.folder / "munge.socket").exists)
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        wait_for("an idle node", lambda: "idle" in self.call("sinfo", "-h", "-o", "%T", check=False))

    def __exit__(self, kind, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
        if kind is not None:
            for log in sorted(self.folder.glob("*.log")):
                print(f"--- {log.name}\n" + "\n".join(log.read_text(errors="replace").splitlines()[-25:]), file=sys.stderr)

    def start(self, name, *arguments):
        with open(self.folder / f"{name}.out.log", "wb") as log:
            self.daemons.append(subprocess.Popen([program(name), *arguments], env=self.environment, stdout=log,
                                                 stderr=subprocess.STDOUT))

    def call(self, name, *arguments, check=True):
        result = subprocess.run([program(name) or name, *map(str, arguments)], env=self.environment,
                                capture_output=True, text=True, timeout=60)
        assert result.returncode == 0 or not check, f"{name} {arguments}: {result.stderr}"
        return result.stdout

    def states(self, job):
        """State by task of a job that isn't over; a pending rest of the array counts as one."""
        text = self.call("squeue", "-h", "-r", "-j", job, "-o", "%i %T", check=False)
        return dict(line.split() for line in text.splitlines())

    def wait_until_over(self, job, seconds=240):
        wait_for(f"the end of job {job}", lambda: not self.states(job), seconds)


def main():
    pirsim, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    missing = [name for name in PROGRAMS if not program(name)]
    if missing:
        skip(f"not installed: {', '.join(missing)} (packages slurm-wlm and munge)")
    if os.geteuid() != 0:
        skip("only root can start slurmd")
    study = ["--scene", str(source / "data/rooms/meeting_room.gltf"), "--script",
             str(source / "data/studies/studyA.yaml"), "-q", "--replicates", str(REPLICATES)]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with Cluster(folder) as cluster:
            campaign(cluster, pirsim, source, folder, study)


def submit(cluster, pirsim, source, out, study, *options):
    told = cluster.call(source / "tools/slurm/submit", "-n", SHARDS, "-t", 3, "-o", out, "-p", pirsim, *options, "--",
                        *study)
    return re.search(r"shards (\S+): job (\d+)", told), re.search(r"merge to \S+: job (\d+)", told).group(1)


def campaign(cluster, pirsim, source, folder, study):
    out = folder / "out"
    array, merge = submit(cluster, pirsim, source, out, study)
    assert array.group(1) == f"1-{SHARDS}"
    job = array.group(2)

    def begun(task):
        journal = out / f"shard-{task:04}-of-{SHARDS:04}.csv.journal"
        return journal.exists() and journal.stat().st_size > 20000

    for task, signals in ((2, ("--full", "--signal=KILL")), (3, ())):  # kill -9, and a plain cancel: SIGTERM
        wait_for(f"task {task} at work", lambda task=task: begun(task))
        cluster.call("scancel", *signals, f"{job}_{task}")
    cluster.wait_until_over(job)
    cluster.wait_until_over(merge)  # its dependency can't be fulfilled any more
    assert not (out / "all.csv").exists()

    status = subprocess.run([pirsim, "merge", out, "--status"], capture_output=True, text=True, check=True)
    print(status.stderr, end="", file=sys.stderr)
    assert status.stdout == "2-3\n", status
    assert "shard-0002-of-0006: unfinished" in status.stderr
    runs_kept = (out / "shard-0002-of-0006.csv.journal").read_text().count("\n") - 2
    print(f"{runs_kept} whole runs of the killed task are gone on with", file=sys.stderr)

    array, merge = submit(cluster, pirsim, source, out, study, "-r")
    assert array.group(1) == "2-3", array
    cluster.wait_until_over(array.group(2))
    cluster.wait_until_over(merge)
    assert (out / "all.csv").exists(), "".join(log.read_text() for log in (out / "log").iterdir())
    single = subprocess.run([pirsim, *study], capture_output=True, check=True).stdout
    assert (out / "all.csv").read_bytes() == single, "the merged rows are not those of one process"
    print(f"{len(single)} bytes of {SHARDS} shards from Slurm are those of one process", file=sys.stderr)


if __name__ == "__main__":
    main()
