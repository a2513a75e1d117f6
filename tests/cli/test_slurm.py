# SPDX-License-Identifier: GPL-3.0-or-later
"""Shards on a real Slurm: one that is started here, on the loopback interface, and stopped again."""
import os
import secrets
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

import h5py
import pytest
from support.program import PROGRAM, TOP, finished, leapmap
from test_shards import same_datasets

CLUSTER = TOP / "sweeps" / "cluster"
DAEMONS = ("munged", "slurmctld", "slurmd")
SPEC = """
[scene]
friction = "coulomb"
restitution = 0.3
mu_static = { from = 0.05, to = 1.2, count = 20 }
[design]
slope = { from = "2 deg", to = "45 deg", count = 900 }
mass_ratio = { from = 0.2, to = 12, count = 60, scale = "log" }
[numerics]
audit = 0.15
"""

# its twins are those of test_shards, one of which starts shards by GNU parallel
pytestmark = pytest.mark.slow


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def daemon(name):
    return shutil.which(name) or shutil.which(name, path="/usr/sbin")


def running(folder):
    """The daemons that were started with files of this folder, as process ids."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
        except (OSError, ValueError):
            continue
        if entry.name.isdigit() and any(str(folder).encode() in word for word in words) and Path(
                words[0].decode()).name.split(":")[0] in (*DAEMONS, "slurmstepd"):
            found.append(int(entry.name))
    return found


class Slurm:
    """A cluster of one node with two processors."""

    def __init__(self, folder):
        self.folder = folder
        for name in ("state", "spool", "munge", "log"):
            (folder / name).mkdir(mode=0o755)
        key = folder / "munge" / "key"
        key.write_bytes(secrets.token_bytes(1024))
        key.chmod(0o400)
        self.socket = folder / "munge" / "socket"
        host = socket.gethostname().split(".")[0]
        self.configuration = folder / "slurm.conf"
        self.configuration.write_text(f"""ClusterName=leapmap
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={self.socket},cred_expire=10
CredType=cred/munge
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/log/slurmctld
SlurmdLogFile={folder}/log/slurmd
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SlurmdParameters=config_overrides
ReturnToService=2
JobRequeue=1
KillWait=5
MinJobAge=600
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 Boards=1 SocketsPerBoard=1 CoresPerSocket=2 ThreadsPerCore=1 \
State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
""")
        self.environment = {
            **os.environ, "SLURM_CONF": str(self.configuration), "LEAPMAP": PROGRAM,
            "LEAPMAP_SCRATCH": str(folder / "scratch")
        }
        self.started = []

    def start(self):
        """Returns why it cannot be, or None."""
        munge = self.folder / "munge"
        commands = ([
            daemon("munged"), "--foreground", "--force", f"--socket={self.socket}",
            f"--key-file={munge / 'key'}", f"--pid-file={munge / 'pid'}", f"--log-file={munge / 'log'}",
            f"--seed-file={munge / 'seed'}"
        ], [daemon("slurmctld"), "-D", "-f",
            self.configuration], [daemon("slurmd"), "-D", "-f", self.configuration])
        for command in commands:
            log = (self.folder / "log" / Path(command[0]).name).with_suffix(".out").open("w")
            self.started.append(
                subprocess.Popen([str(word) for word in command], stdout=log, stderr=log,
                                 env=self.environment))
            time.sleep(0.5)
            if self.started[-1].poll() is not None:
                return f"{Path(command[0]).name} does not start: {Path(log.name).read_text()[-300:]}"
        end = time.monotonic() + 30
        while time.monotonic() < end:
            if "idle" in self.run("sinfo", "--noheader", "--format=%T").stdout:
                return None
            time.sleep(0.3)
        return f"the node does not come up: {self.run('sinfo').stdout}"

    def run(self, *command):
        return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=60,
                              env=self.environment, cwd=self.folder)

    def states(self, job):
        """The state of each task of an array, {number: state}."""
        told = self.run("scontrol", "show", "job", job, "--oneliner").stdout
        states = {}
        for line in told.splitlines():
            words = dict(word.split("=", 1) for word in line.split() if "=" in word)
            if words.get("ArrayTaskId", "").isdigit():
                states[int(words["ArrayTaskId"])] = words["JobState"]
            elif "ArrayTaskId" not in words:
                states[0] = words.get("JobState")
        return states

    def wait(self, question, seconds=120):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if answer := question():
                return answer
            time.sleep(0.1)
        raise AssertionError(
            self.run("squeue").stdout + "".join(p.read_text() for p in self.folder.glob("slurm-*.out")))

    def stop(self):
        self.run("scancel", "--user=root")
        for process in reversed(self.started):
            process.terminate()
        for process in self.started:
            try:
                process.wait(5)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait(20)
        for process in running(self.folder):
            os.kill(process, signal.SIGKILL)


@pytest.fixture
def slurm(tmp_path):
    missing = [name for name in DAEMONS if not daemon(name)]
    if missing or os.geteuid() != 0:
        pytest.skip(
            f"no Slurm can be started here: {', '.join(missing) + ' missing' if missing else 'not root'}")
    cluster = Slurm(tmp_path)
    try:
        if why := cluster.start():
            pytest.skip(f"no Slurm can be started here: {why}")
        yield cluster
    finally:
        cluster.stop()
        assert not running(tmp_path), "a daemon is left"


def sweeping(folder, shard):
    """The leapmap that works on a shard, as a process id."""
    for entry in Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
        except (OSError, ValueError):
            continue
        if entry.name.isdigit() and words[0].decode() == PROGRAM and f"{shard}/8".encode() in words and any(
                str(folder).encode() in word for word in words):
            return int(entry.name)
    return None


def has_committed(slurm, shard):
    """Whether the task that works on a shard keeps tiles whatever happens to it."""
    for part in (slurm.folder / "scratch").glob(f"*/map.{shard}-of-8.h5.part"):
        try:
            with h5py.File(part, locking=False) as file:
                return file.attrs["tiles_done"] > 0
        except (OSError, KeyError, RuntimeError):  # in the middle of a commit
            pass
    return False


def test_an_array_of_eight_with_a_task_killed_and_one_cancelled_joins_to_the_map_of_one_sweep(
        slurm, tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    map_path = tmp_path / "maps" / "map.h5"
    submitted = slurm.run("sh", CLUSTER / "submit.sh", 8, tmp_path / "spec.toml", map_path,
                          "--cpus-per-task=1")
    assert submitted.returncode == 0, submitted.stderr
    array, join = submitted.stdout.split()[1], submitted.stdout.split()[7].rstrip(";")
    # One is killed with its work half done, another is cancelled, which tells it to stop.
    victim = slurm.wait(lambda: has_committed(slurm, 1) and sweeping(tmp_path, 1))
    os.kill(victim, signal.SIGKILL)
    slurm.wait(lambda: has_committed(slurm, 2))
    # tries again and again until it has ended
    told = subprocess.Popen(["scancel", "--batch", "--signal=TERM", f"{array}_2"], env=slurm.environment)
    slurm.wait(lambda: has_committed(slurm, 3))
    slurm.run("scancel", f"{array}_3")
    told.wait(60)
    ended = {"COMPLETED", "FAILED", "CANCELLED", "NODE_FAIL"}
    slurm.wait(lambda: set(slurm.states(array).values()) <= ended and len(slurm.states(array)) == 8, 300)
    # The first joining says which are missing, in the words of an array.
    slurm.wait(lambda: slurm.states(join).get(0) in ended)
    said = next(p for p in tmp_path.glob(f"slurm-{join}.out")).read_text()
    assert "3 of its 8 shards" in said and "--array=1-3" in said, said
    assert not map_path.exists()
    # One is requeued by hand; the others run again as an array, and go on with what is left of them.
    assert slurm.run("scontrol", "requeue", f"{array}_1").returncode == 0
    again = subprocess.run([
        "sh",
        str(CLUSTER / "submit.sh"), "8",
        str(tmp_path / "spec.toml"),
        str(map_path), "--cpus-per-task=1"
    ], capture_output=True, text=True, env={**slurm.environment, "AGAIN": "2-3"}, cwd=tmp_path, timeout=60)
    assert again.returncode == 0, again.stderr
    second = again.stdout.split()[1]
    slurm.wait(
        lambda: slurm.states(array).get(1) in {"COMPLETED", "FAILED"} and set(slurm.states(second).values())
        == {"COMPLETED"}, 300)
    assert slurm.states(array)[1] == "COMPLETED"
    for job, shard in ((array, 1), (second, 2), (second, 3)):
        assert "designs were complete" in (tmp_path / f"slurm-{job}_{shard}.out").read_text()
    if not map_path.exists():  # the second joining may have come before the requeued task
        done = leapmap("join", map_path)
        assert done.returncode == 0, done.stderr
    one = finished(PROGRAM, "sweep", tmp_path / "spec.toml", "-o", tmp_path / "one.h5", "--quiet")
    assert one.returncode == 0
    same_datasets(tmp_path / "one.h5", map_path)
    assert not list((tmp_path / "scratch").iterdir()), "nothing is left on the node"
