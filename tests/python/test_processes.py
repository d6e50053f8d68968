"""Other processes: forks, pools, leaks."""

import multiprocessing

import numpy as np
import pytest

import echocine
from conftest import run_python

MAKE = """
import sys; sys.path.insert(0, {tests!r})
from conftest import ball_scene
import echocine, multiprocessing, os
"""


def prologue():
    import os
    return MAKE.format(tests=os.path.dirname(__file__))


def mean_grey(job):
    scene, time_s = job
    return float(echocine.Simulator(scene).frame(time_s).greys.mean())


def test_a_spawned_pool_gives_the_same(scene):
    simulator = echocine.Simulator(scene)
    times = simulator.times_s[:4]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        got = pool.map(mean_grey, [(scene, t) for t in times])
    assert got == [float(simulator.frame(t).greys.mean()) for t in times]


def test_a_forked_pool_that_uses_it_first_works():
    text = prologue() + """
from test_processes import mean_grey
scene = ball_scene()
with multiprocessing.get_context("fork").Pool(2) as pool:
    print(len(set(pool.map(mean_grey, [(scene, t) for t in (0.0, 0.1, 0.2)]))))
"""
    result = run_python(text)
    assert result.returncode == 0 and result.stdout.split() == ["3"], result.stderr


def test_fork_after_use_is_refused():
    text = prologue() + """
simulator = echocine.Simulator(ball_scene())
before = simulator.frame(0.1).greys.copy()
pid = os.fork()
if pid == 0:
    try:
        simulator.frame(0.1)
    except echocine.JobError as error:
        os._exit(7 if "spawn" in str(error) else 3)
    os._exit(4)
print(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), (simulator.frame(0.1).greys == before).all())
"""
    result = run_python(text)
    assert result.returncode == 0 and result.stdout.split() == ["7", "True"], result.stdout + result.stderr


def test_frames_leave_nothing_behind(scene):
    """Resident memory after many frames and loops is what it was after some."""
    simulator = echocine.Simulator(scene)

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * 4096

    def work(count):
        out = simulator.frame(0.0)
        for i in range(count):
            simulator.frame(0.1 * (i % 9)).greys
            simulator.frame(0.1, out=out)

    work(300)
    before = resident()
    work(600)
    # A frame is 25 kB: a leak of each would be 30 MB.
    assert resident() - before < 8 << 20


@pytest.mark.parametrize("work", ["simulator.frame(0.1)", "echocine.render(scene)"])
def test_daemon_threads_at_work_do_not_abort_the_end(work):
    """The interpreter ends while threads are in native work: quietly, and with the program's own exit code."""
    text = prologue() + f"""
import threading, time
scene = ball_scene()
simulator = echocine.Simulator(scene)
def repeat():
    while True:
        {work}
for _ in range(3):
    threading.Thread(target=repeat, daemon=True).start()
time.sleep(sys.argv[1])
sys.exit(5)
"""
    for delay in (0.0, 0.013, 0.05, 0.11):
        result = run_python(text.replace("sys.argv[1]", str(delay)))
        assert result.returncode == 5 and result.stderr == "", result.stderr
