"""Datasets made by a real Slurm of this machine alone, with tasks that stop in every way: slurm_test.py ECHOCINE

ECHOCINE_SLURM=1 adds the longer cases."""

import os
import shutil
import signal
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
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmdTimeout=9
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
JobRequeue=1
MpiDefault=none
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1,sched_min_interval=0
KillWait=1
PartitionName=all Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cores} RealMemory=4000 State=UNKNOWN\n"


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


def processes():
    """Process id -> arguments and environment of all processes that can be read."""
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/cmdline", "rb") as line, open(f"/proc/{entry}/environ", "rb") as environment:
                yield int(entry), line.read().decode(errors="replace").split("\0"), environment.read().decode(errors="replace").split("\0")
        except OSError:
            pass  # it has ended


def status_of(process, key):
    with open(f"/proc/{process}/status") as status:
        return next(line.split()[1] for line in status if line.startswith(key + ":"))


class Cluster:
    """munged, slurmctld and virtual nodes (slurmd) of this user, in a folder of their own; use with `with`."""

    def __init__(self, nodes=1):
        self.names = [f"node{number}" for number in range(1, nodes + 1)]
        self.cores = os.cpu_count() if nodes == 1 else 1

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="echocine_slurm_")
        os.chmod(self.folder, 0o755)
        place = lambda name: os.path.join(self.folder, name)
        for name in ["state"] + ["spool." + node for node in self.names]:
            os.mkdir(place(name))
        with open(place("munge.key"), "wb") as key:
            key.write(os.urandom(1024))
        os.chmod(place("munge.key"), 0o600)
        with open(place("slurm.conf"), "w") as conf:
            host = socket.gethostname().split(".")[0]
            for name in self.names:
                conf.write(NODE.format(name=name, host=host, port=free_port(), cores=self.cores))
            conf.write(CONF.format(host=host, folder=self.folder, ctld_port=free_port(), names=",".join(self.names)))
        self.environment = {**os.environ, "SLURM_CONF": place("slurm.conf")}
        self.daemons, self.nodes = [], {}
        try:
            self.daemons.append(self.start(
                "munged", "--foreground", "--force", "--key-file=" + place("munge.key"), "--socket=" + place("munge.socket"),
                "--pid-file=" + place("munge.pid"), "--log-file=" + place("munge.log"), "--seed-file=" + place("munge.seed")))
            wait_for(lambda: os.path.exists(place("munge.socket")), "munge does not come up", START_S)
            self.daemons.append(self.start("slurmctld", "-D", "-c", "-f", place("slurm.conf")))
            for name in self.names:
                self.nodes[name] = self.start("slurmd", "-D", "-N", name, "-f", place("slurm.conf"))
                self.daemons.append(self.nodes[name])
            wait_for(lambda: self.run("sinfo", "-h", "-N", "-o", "%t").split() == ["idle"] * len(self.names),
                     "Slurm does not come up", START_S)
        except TimeoutError as error:  # a machine that lets no scheduler start
            self.__exit__()
            raise unittest.SkipTest(str(error)) from error
        return self

    def start(self, *command):
        return subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def run(self, *command, check=False):
        return subprocess.run(command, env=self.environment, check=check, capture_output=True, text=True).stdout

    def lose(self, name):
        """Kills a node's daemon and all processes of its jobs, as a loss of power does."""
        self.nodes[name].kill()
        steps = set()
        for process, _, environment in processes():
            if "SLURMD_NODENAME=" + name in environment and "SLURM_CONF=" + self.environment["SLURM_CONF"] in environment:
                try:
                    parent = int(status_of(process, "PPid"))
                    if status_of(parent, "Name").startswith("slurmstepd"):
                        steps.add(parent)
                    os.kill(process, signal.SIGKILL)
                except (OSError, StopIteration):
                    pass
        for step in steps:
            try:
                os.kill(step, signal.SIGKILL)
            except OSError:
                pass

    def restart(self, name):
        self.nodes[name].wait(20)
        self.nodes[name] = self.start("slurmd", "-D", "-N", name, "-f", self.environment["SLURM_CONF"])
        self.daemons.append(self.nodes[name])
        wait_for(lambda: self.run("sinfo", "-h", "-n", name, "-o", "%t").split() == ["idle"], f"{name} does not come back", START_S)

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


class OnSlurm:
    """A cluster per class, a folder per test."""

    nodes, hearts = 1, 6

    @classmethod
    def setUpClass(cls):
        cls.cluster = cls.enterClassContext(Cluster(cls.nodes)) if hasattr(cls, "enterClassContext") else cls.entered(Cluster(cls.nodes))
        cls.run_in = cls.cluster.run

    @classmethod
    def entered(cls, context):  # before Python 3.11
        cls.addClassCleanup(context.__exit__, None, None, None)
        return context.__enter__()

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="echocine_slurm_data_")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.spec = os.path.join(self.folder, "spec.toml")
        with open(self.spec, "w") as file, open(SMALL_LOOPS) as rest:
            file.write(SPEC_HEAD.replace("hearts = 6", f"hearts = {self.hearts}") + rest.read())

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def whole(self):
        """The files of a run without Slurm."""
        if not os.path.exists(self.path("whole")):
            subprocess.run([PROGRAM, "dataset", self.spec, "-o", self.path("whole"), "--quiet"], check=True)
        return files_of(self.path("whole"))

    def submit(self, name, *more, tasks=2, minutes=5):
        """Array and merge of a submitted dataset."""
        text = self.run_in(PROGRAM, "dataset", self.spec, "-o", self.path(name), "--quiet", "--slurm", "--tasks", str(tasks),
                           "--cores", "1", "--minutes", str(minutes), *more, check=True)
        return text.replace(",", "").split()[1::2]

    def state(self, job):
        found = [word for word in self.run_in("scontrol", "show", "job", job).split() if word.startswith("JobState=")]
        return found[0][len("JobState="):] if found else ""

    def wait_for_end(self, *jobs):
        def ended(job):
            states = self.run_in("squeue", "-h", "-t", "all", "-r", "-o", "%T", "-j", job).split()
            return states and set(states) <= {"COMPLETED", "FAILED", "CANCELLED"}
        wait_for(lambda: all(ended(job) for job in jobs), "the jobs' end")

    def wait_for_log(self, name, array, task):
        wait_for(lambda: os.path.exists(self.path(name, "slurm", f"array_{array}_{task}.log")), "a task")

    def release(self, task):
        wait_for(lambda: "PENDING" in self.run_in("scontrol", "show", "job", task), "the requeued task")
        time.sleep(2)  # credentials are revoked by whole seconds; Slurm itself waits two minutes
        self.run_in("scontrol", "update", "jobid=" + task, "StartTime=now")

    def assert_merged(self, name, merge):
        logs = {}
        for file in sorted(os.listdir(self.path(name, "slurm"))):
            if file.endswith(".log"):
                with open(self.path(name, "slurm", file)) as log:
                    logs[file] = log.read()
        self.assertEqual((self.state(merge), logs[f"merge_{merge}.log"]), ("COMPLETED", ""), logs)
        made = files_of(self.path(name))
        self.assertEqual(made.keys(), self.whole().keys())
        self.assertEqual(made, self.whole())

    def program_of(self, name, task):
        """The process of a running task's program."""
        def found():
            return [process for process, arguments, _ in processes() if self.path(name) in arguments and task in arguments]
        wait_for(found, f"the program of task {task}")
        return found()[0]


class Slurm(OnSlurm, unittest.TestCase):
    def test_a_task_killed_and_requeued_makes_the_same_bytes(self):
        array, merge = self.submit("parts")
        self.wait_for_log("parts", array, 1)
        self.run_in("scontrol", "requeue", array + "_1")
        self.release(array + "_1")
        self.wait_for_end(array, merge)
        self.assertIn("Restarts=1", self.run_in("scontrol", "show", "job", array + "_1"))
        self.assert_merged("parts", merge)

    def test_a_task_near_its_time_limit_requeues_itself_whatever_the_folder_is_called(self):
        name = "50%a of it's %A"
        array, merge = self.submit(name)
        self.wait_for_log(name, array, 1)
        wait_for(lambda: os.path.exists(self.path(name, "work/task_1_of_2/lock")), "the first task's program")
        self.run_in("scancel", "--batch", "--signal=USR1", array + "_1")  # as Slurm does by --signal=B:USR1@60
        self.release(array + "_1")
        self.wait_for_end(array, merge)
        self.assertIn("Restarts=1", self.run_in("scontrol", "show", "job", array + "_1"))
        self.assert_merged(name, merge)

    @unittest.skipUnless(os.environ.get("ECHOCINE_SLURM"), "a longer test: set ECHOCINE_SLURM")
    def test_a_cancelled_task_is_missed_by_the_merge_and_made_by_the_next_array(self):
        array, merge = self.submit("parts")
        self.wait_for_log("parts", array, 1)
        self.run_in("scancel", array + "_1")
        self.wait_for_end(array, merge)
        with open(self.path("parts/slurm", f"merge_{merge}.log")) as log:
            self.assertIn("hearts are missing", log.read())
        self.assertEqual(self.state(merge), "FAILED")
        again, second_merge = self.submit("parts")
        self.wait_for_end(again, second_merge)
        self.assert_merged("parts", second_merge)

    @unittest.skipUnless(os.environ.get("ECHOCINE_SLURM"), "a longer test: set ECHOCINE_SLURM")
    def test_two_submissions_do_not_write_at_once(self):
        first, second = self.submit("parts"), self.submit("parts")
        self.wait_for_end(*first, *second)
        last, merge = self.submit("parts")
        self.wait_for_end(last, merge)
        self.assert_merged("parts", merge)

    def test_no_heart_at_all_is_a_failure(self):
        array, merge = self.submit("parts", "--sbatch", "--export=ALL,ECHOCINE_FAILING_HEARTS=1")
        self.wait_for_end(array, merge)
        self.assertEqual(self.state(merge), "FAILED")
        with open(self.path("parts/slurm", f"merge_{merge}.log")) as log:
            self.assertIn("all 6 hearts failed", log.read())
        status = self.run_in(PROGRAM, "dataset", "--status", self.path("parts"), check=True)
        self.assertIn("0 of 6 hearts finished, 6 failed, 0 missing", status)

    def test_the_array_is_cancelled_when_its_merge_is_refused(self):
        subprocess.run([PROGRAM, "dataset", self.spec, "-o", self.path("parts"), "--quiet", "--slurm", "--tasks", "2",
                        "--minutes", "5", "--no-submit"], check=True)
        with open(self.path("parts/slurm/merge.sh"), "w") as merge:
            merge.write("#!/bin/sh\n#SBATCH --partition=absent\n")
        refused = subprocess.run(["sh", self.path("parts/slurm/submit.sh")], env=self.cluster.environment,
                                 capture_output=True, text=True)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("its merge was refused", refused.stdout)
        self.wait_for_end(refused.stdout.split()[1].rstrip(","))


@unittest.skipUnless(os.environ.get("ECHOCINE_SLURM"), "longer tests: set ECHOCINE_SLURM")
class SlurmOfTwoNodes(OnSlurm, unittest.TestCase):
    nodes, hearts = 2, 40

    def setUp(self):
        super().setUp()
        self.whole()

    def nodes_of(self, array):
        return {word for job in (array + "_1", array + "_2") for word in self.run_in("scontrol", "show", "job", job).split()
                if word.startswith("BatchHost=")}

    def test_both_nodes_work_in_one_folder(self):
        array, merge = self.submit("parts")
        self.wait_for_end(array, merge)
        self.assertEqual(self.nodes_of(array), {"BatchHost=node1", "BatchHost=node2"})
        self.assert_merged("parts", merge)

    def test_tasks_of_a_lost_node_are_made_by_the_other(self):
        array, merge = self.submit("parts")
        for task in ("1/2", "2/2"):
            os.kill(self.program_of("parts", task), signal.SIGSTOP)  # in the midst of its work
        lost = next(task for task in (1, 2)
                    if "BatchHost=node2" in self.run_in("scontrol", "show", "job", f"{array}_{task}"))
        self.cluster.lose("node2")
        os.kill(self.program_of("parts", f"{3 - lost}/2"), signal.SIGCONT)
        self.release(f"{array}_{lost}")
        self.wait_for_end(array, merge)
        self.assertEqual(self.nodes_of(array), {"BatchHost=node1"})
        self.assertIn("Restarts=1", self.run_in("scontrol", "show", "job", f"{array}_{lost}"))
        self.assert_merged("parts", merge)
        self.cluster.restart("node2")


@unittest.skipUnless(os.environ.get("ECHOCINE_SLURM"), "longer tests: set ECHOCINE_SLURM")
class SlurmTimeLimit(OnSlurm, unittest.TestCase):
    hearts = 40

    def test_a_task_that_meets_its_time_limit_is_requeued_and_resumes(self):
        """Slurm itself sends USR1 a minute before the limit. The task's program is halted until then."""
        self.whole()
        array, merge = self.submit("parts", minutes=2)
        program = self.program_of("parts", "1/2")
        os.kill(program, signal.SIGSTOP)
        pending = lambda: int(status_of(program, "ShdPnd"), 16) | int(status_of(program, "SigPnd"), 16)
        wait_for(lambda: pending() & 1 << (signal.SIGTERM - 1), "USR1 and its SIGTERM")
        os.kill(program, signal.SIGCONT)
        self.release(array + "_1")
        self.wait_for_end(array, merge)
        self.assertIn("Restarts=1", self.run_in("scontrol", "show", "job", array + "_1"))
        self.assert_merged("parts", merge)


if __name__ == "__main__":
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing or os.geteuid() != 0:
        print("SKIPPED: needs root and Debian's slurm-wlm" + (f": {', '.join(missing)}" if missing else ""))
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
