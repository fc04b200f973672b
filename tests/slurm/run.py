"""A sweep through Slurm: an array of 8 tasks on a cluster that consists of this machine, started by the test.

    run.py MYOWAVE WORK

munged, slurmctld and slurmd run from WORK with a configuration of their own, on free ports, and end with the
test. One task is killed (SIGKILL) in the middle of its work and requeued; the table has to be whole and that of
a sweep without Slurm. Exits 77 where Slurm cannot run.
"""

import csv
import getpass
import io
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TASKS = 8
KILLED = 3  # the task that is killed
RUNS = 16  # two a task
WAIT_S = 240  # for any action of Slurm; long, for busy machines

SWEEP = """
[scene.grid]
n = 61
[scene.time]
t_end = 900
[scene.initial]
type = "broken_front"
[scene.output]
every = 300.0

[[axis]]
key = "excitation.mu1"
min = 0.1
max = 0.13
num = 4

[[axis]]
key = "initial.offset"
values = [[0, 0], [0, 4], [0, 8], [0, 12]]
"""


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def wait_until(what, condition):
    end = time.monotonic() + WAIT_S
    while not (result := condition()):
        if time.monotonic() > end:
            raise SystemExit(f"{WAIT_S} s, and still not: {what}")
        time.sleep(0.05)
    return result


class Cluster:
    """One node, this machine."""

    PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo")

    def __init__(self, work, sockets):
        path = os.environ["PATH"] + ":/usr/sbin:/sbin"
        self.programs = {name: shutil.which(name, path=path) for name in self.PROGRAMS}
        if missing := [name for name, where in self.programs.items() if where is None]:
            skip(f"no {', '.join(missing)} (Debian: slurm-wlm, munge)")
        self.work, self.socket = work, sockets / "munge"
        self.node = socket.gethostname().split(".")[0]
        self.environment = os.environ | {"SLURM_CONF": str(work / "slurm.conf")}
        self.daemons = []

    def configure(self):
        user, (control, node) = getpass.getuser(), free_ports(2)
        cpus = os.cpu_count()
        for folder in ("state", "spool"):
            (self.work / folder).mkdir()
        # Requeued jobs wait until their old credential expires; cred_expire shortens the default of 120 s.
        (self.work / "slurm.conf").write_text(f"""
ClusterName=myowave_test
SlurmctldHost={self.node}(127.0.0.1)
SlurmctldPort={control}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={self.socket},cred_expire=5
CredType=cred/munge
StateSaveLocation={self.work}/state
SlurmdSpoolDir={self.work}/spool
SlurmctldPidFile={self.work}/slurmctld.pid
SlurmdPidFile={self.work}/slurmd.pid
SlurmctldLogFile={self.work}/slurmctld.log
SlurmdLogFile={self.work}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SchedulerParameters=sched_interval=2,batch_sched_delay=1
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
NodeName={self.node} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={self.node} Default=YES MaxTime=INFINITE State=UP
""")
        key = self.work / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)

    def start(self, name, *options):
        log = open(self.work / f"{name}.out", "wb")
        self.daemons.append(subprocess.Popen([self.programs[name], *options], env=self.environment, stdout=log,
                                             stderr=log, stdin=subprocess.DEVNULL))

    def __enter__(self):
        self.configure()
        # --force: of the folders' owners and modes it only warns then.
        self.start("munged", "--foreground", "--force", f"--socket={self.socket}",
                   f"--key-file={self.work}/munge.key", f"--pid-file={self.socket}.pid",
                   f"--log-file={self.work}/munged.log", f"--seed-file={self.work}/munge.seed")
        wait_until("munged listens", lambda: self.socket.exists() or self.ended())
        self.start("slurmctld", "-D", "-i")
        self.start("slurmd", "-D", "-N", self.node)
        wait_until("the node is up", lambda: self.ended() or self.state_of_node() == "idle")
        if self.ended():
            reason = self.logs()
            self.stop()
            skip(f"Slurm does not run here:\n{reason}")
        return self

    def __exit__(self, kind, error, trace):
        if kind is not None:
            print(self.logs())
        self.stop()

    def ended(self):
        return any(daemon.poll() is not None for daemon in self.daemons)

    def stop(self):
        if len(self.daemons) == 3:
            subprocess.run([shutil.which("scancel"), f"--user={getpass.getuser()}"], env=self.environment, check=False,
                           capture_output=True, timeout=30)
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def logs(self):
        parts = []
        for log in sorted(self.work.glob("*.out")) + sorted(self.work.glob("*.log")):
            lines = log.read_text(errors="replace").splitlines()[-12:]
            parts.append("\n".join([f"-- {log.name}", *lines]))
        return "\n".join(parts)

    def command(self, name, *options):
        return subprocess.run([self.programs[name], *options], env=self.environment, check=True, text=True,
                              capture_output=True, timeout=60).stdout

    def state_of_node(self):
        result = subprocess.run([self.programs["sinfo"], "--noheader", "--format=%t"], env=self.environment, text=True,
                                capture_output=True, check=False)
        return result.stdout.strip()

    def job_states(self, job):
        """By array task."""
        records = self.command("scontrol", "show", "job", "--oneliner", job).splitlines()
        found = {}
        for record in records:
            task = re.search(r"ArrayTaskId=(\S+)", record).group(1)
            found[task] = re.search(r"JobState=(\S+)", record).group(1)
        return found


def run_array(cluster, script, folder):
    """Submits the script; kills and requeues one of its tasks; returns when all have ended."""
    job = re.search(r"Submitted batch job (\d+)", cluster.command("sbatch", str(script))).group(1)
    shard = f"shard_{KILLED}_of_{TASKS}"
    records, lock = folder / "records" / f"{shard}.jsonl", folder / "locks" / f"{shard}.lock"
    # In the middle of its work: some runs are done, some are not.
    wait_until("a record of the task that is to be killed", lambda: records.exists() and records.stat().st_size > 0)
    process = int(re.search(r"process (\d+)", lock.read_text()).group(1))
    os.kill(process, signal.SIGKILL)
    ended = wait_until("the killed task has ended",
                       lambda: {cluster.job_states(job).get(str(KILLED))} & {"FAILED", "COMPLETED"})
    left_by_kill = records.read_bytes()
    assert ended == {"FAILED"} and left_by_kill.count(b"\n") == 1, "the kill came too late to show anything"
    cluster.command("scontrol", "requeue", f"{job}_{KILLED}")

    def all_completed():
        states = cluster.job_states(job)
        return len(states) == TASKS and set(states.values()) == {"COMPLETED"} and states

    wait_until("all tasks are completed", all_completed)
    print(f"job {job}: task {KILLED} was killed after 1 of its {RUNS // TASKS} runs and requeued")
    whole = left_by_kill[:left_by_kill.rfind(b"\n") + 1]
    assert records.read_bytes().startswith(whole), "a record that was there before the kill is lost"


def table(myowave, folder):
    """Rows, without the columns of times."""
    result = subprocess.run([myowave, "sweep", "table", str(folder), "--csv"], check=True, text=True, capture_output=True)
    assert result.stderr == "", result.stderr
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    return [{name: cell for name, cell in row.items() if not name.startswith(("wall", "cell_steps"))} for row in rows]


def main(myowave, work):
    work = Path(work)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    file = work / "small.toml"
    file.write_text(SWEEP)
    subprocess.run([myowave, "sweep", str(file), "--out", str(work / "local"), "--quiet"], check=True)
    # Names of sockets are short.
    with tempfile.TemporaryDirectory(prefix="myowave_slurm_") as sockets:
        with Cluster(work, Path(sockets)) as cluster:
            told = subprocess.run([myowave, "sweep", str(file), "--out", str(work / "slurm"), "--slurm", "--tasks",
                                   str(TASKS), "--cpus", "1", "--time", "00:30:00"], check=True, text=True,
                                  capture_output=True).stdout
            script = Path(re.search(r"sbatch (\S+)", told).group(1))
            run_array(cluster, script, work / "slurm")
    local, through_slurm = table(myowave, work / "local"), table(myowave, work / "slurm")
    assert len(local) == RUNS, len(local)
    for expected, row in zip(local, through_slurm, strict=True):
        assert row == expected, f"{row}\n{expected}"
    print(f"{len(local)} rows, equal to those of a sweep without Slurm")


if __name__ == "__main__":
    main(*sys.argv[1:])
