"""A dataset made by a real Slurm of this machine alone, a task of it killed and requeued: slurm_test.py ECHOCINE"""

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else "echocine"
SMALL_LOOPS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support", "small_loops.toml")
NEEDED = ["munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo"]
PATIENCE_S = 240  # an upper bound for waits on conditions
START_S = 60

SPEC_HEAD = """name = "slurm test"
hearts = 6
views = ["a4c"]
layouts = ["native", "echonet"]
"""

CONF = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmctldPort={ctld_port}
SlurmdPort={d_port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
JobRequeue=1
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(condition, what, patience_s=PATIENCE_S):
    end = time.monotonic() + patience_s
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(what)
        time.sleep(0.2)


class Cluster:
    """munged, slurmctld and slurmd of this user, in a folder of their own; use with `with`."""

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="echocine_slurm_")
        os.chmod(self.folder, 0o755)
        place = lambda name: os.path.join(self.folder, name)
        for name in ("state", "spool"):
            os.mkdir(place(name))
        with open(place("munge.key"), "wb") as key:
            key.write(os.urandom(1024))
        os.chmod(place("munge.key"), 0o600)
        with open(place("slurm.conf"), "w") as conf:
            conf.write(CONF.format(host=socket.gethostname().split(".")[0], folder=self.folder, cores=os.cpu_count(),
                                   ctld_port=free_port(), d_port=free_port()))
        self.environment = {**os.environ, "SLURM_CONF": place("slurm.conf")}
        self.daemons = []
        try:
            self.daemons.append(self.start(
                "munged", "--foreground", "--force", "--key-file=" + place("munge.key"), "--socket=" + place("munge.socket"),
                "--pid-file=" + place("munge.pid"), "--log-file=" + place("munge.log"), "--seed-file=" + place("munge.seed")))
            wait_for(lambda: os.path.exists(place("munge.socket")), "munge does not come up", START_S)
            self.daemons += [self.start("slurmctld", "-D", "-c", "-f", place("slurm.conf")),
                             self.start("slurmd", "-D", "-f", place("slurm.conf"))]
            wait_for(lambda: "idle" in self.run("sinfo", "-h", "-o", "%t"), "Slurm does not come up", START_S)
        except TimeoutError as error:  # a machine that lets no scheduler start
            self.__exit__()
            raise unittest.SkipTest(str(error)) from error
        return self

    def start(self, *command):
        return subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def run(self, *command, check=False):
        return subprocess.run(command, env=self.environment, check=check, capture_output=True, text=True).stdout

    def __exit__(self, *_):
        self.run("scancel", "--user=root")
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
        shutil.rmtree(self.folder, ignore_errors=True)


def files_of(folder):
    """Every file of a dataset but the book-keeping of its parts and jobs."""
    found = {}
    for root, _, names in os.walk(folder):
        for name in names:
            path = os.path.relpath(os.path.join(root, name), folder)
            if not path.startswith(("slurm/", "work/task")):
                with open(os.path.join(folder, path), "rb") as file:
                    found[path] = file.read()
    return found


class Slurm(unittest.TestCase):
    def test_an_array_with_a_task_killed_and_requeued_makes_the_same_bytes(self):
        with tempfile.TemporaryDirectory(prefix="echocine_slurm_data_") as folder, Cluster() as cluster:
            spec = os.path.join(folder, "spec.toml")
            with open(spec, "w") as file, open(SMALL_LOOPS) as rest:
                file.write(SPEC_HEAD + rest.read())
            whole, parts = os.path.join(folder, "whole"), os.path.join(folder, "parts")
            subprocess.run([PROGRAM, "dataset", spec, "-o", whole, "--quiet"], check=True)
            text = cluster.run(PROGRAM, "dataset", spec, "-o", parts, "--quiet", "--slurm", "--tasks", "2", "--cores", "1",
                               "--minutes", "5", check=True)
            array, merge = text.replace(",", "").split()[1::2]
            log = os.path.join(parts, "slurm", "array_1.log")
            wait_for(lambda: os.path.exists(log), "the first task")
            cluster.run("scontrol", "requeue", array + "_1")
            wait_for(lambda: "PENDING" in cluster.run("scontrol", "show", "job", array + "_1"), "the requeued task")
            cluster.run("scontrol", "update", f"jobid={array}_1", "StartTime=now")
            wait_for(lambda: not cluster.run("squeue", "-h", "-j", f"{array},{merge}").strip(), "the jobs' end")
            self.assertIn("Restarts=1", cluster.run("scontrol", "show", "job", array + "_1"))
            self.assertEqual(files_of(parts).keys(), files_of(whole).keys())
            self.assertEqual(files_of(parts), files_of(whole))


if __name__ == "__main__":
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing or os.geteuid() != 0:
        print("SKIPPED: needs root and Debian's slurm-wlm" + (f": {', '.join(missing)}" if missing else ""))
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
