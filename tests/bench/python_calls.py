"""What Python adds to the library, as ratios inside one run: python_calls.py BUILD_FOLDER.

Needs the module and scene_changes, both of the build.
"""

import multiprocessing
import pathlib
import resource
import statistics
import subprocess
import sys
import threading
import time

BUILD = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release")
sys.path.insert(0, str(BUILD / "python"))

import echocine  # noqa: E402

ROUNDS, FRAMES, CHANGES = 40, 12, 25


def cpu_s():
    use = resource.getrusage(resource.RUSAGE_SELF)
    return use.ru_utime + use.ru_stime


def simulator_of(look):
    scene = echocine.heart(keyframes=12, look=look)
    simulator = echocine.Simulator(scene)
    simulator.reference_intensity
    return simulator


def frames(simulator, first):
    times_s = simulator.times_s
    for i in range(FRAMES):
        simulator.frame(times_s[(first + i) % len(times_s)])


def seconds(work):
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def other_process(look, pipe):
    simulator = simulator_of(look)
    frames(simulator, 0)
    pipe.send(None)
    while pipe.recv():
        frames(simulator, 21)
        pipe.send(None)


def two_at_once(look):
    """Frames a second of two threads and of two processes, over those of one thread."""
    mine, its = multiprocessing.get_context("spawn").Pipe()
    process = multiprocessing.get_context("spawn").Process(target=other_process, args=(look, its))
    process.start()
    simulator = simulator_of(look)
    frames(simulator, 0)
    mine.recv()

    def threads():
        both = [threading.Thread(target=frames, args=(simulator, first)) for first in (7, 21)]
        for thread in both:
            thread.start()
        for thread in both:
            thread.join()

    def processes():
        mine.send(True)
        frames(simulator, 7)
        mine.recv()

    gains = []
    for _ in range(ROUNDS):
        before, two, apart, after = (seconds(work) for work in (lambda: frames(simulator, 7), threads, processes,
                                                                 lambda: frames(simulator, 7)))
        gains.append(((before + after) / two, (before + after) / apart))
    mine.send(False)
    process.join()
    return [statistics.median(column) for column in zip(*gains)]


def call_overhead_us():
    """Of one frame of a scene so small that it is nearly nothing else."""
    scene = echocine.heart(keyframes=4, look="paper")
    scene.update({"probe.lines": 2, "probe.samples": 2, "output.width": 16, "output.height": 16})
    simulator = echocine.Simulator(scene)
    out = simulator.frame(0.1)
    new = min(seconds(lambda: simulator.frame(0.1)) for _ in range(500))
    again = min(seconds(lambda: simulator.frame(0.1, out=out)) for _ in range(500))
    return 1e6 * new, 1e6 * again


def changing_frame(i):
    scene = echocine.heart(ef=0.40 + 0.002 * (i % 50), keyframes=12, look="paper")
    x, _, z = scene["probe.apex"]
    scene["probe.apex"] = [x, 0.1 * (i % 50), z]
    assert echocine.Simulator(scene).frame(0.1).greys.size


def changes():
    """CPU of a heart of new dials, a moved probe and a frame, over the same in C++."""
    ratios = []
    changing_frame(0)
    for _ in range(5):
        before = cpu_s()
        for i in range(CHANGES):
            changing_frame(i)
        ours_ms = 1e3 * (cpu_s() - before) / CHANGES
        floor_ms = float(subprocess.run([BUILD / "scene_changes", str(CHANGES)], check=True, capture_output=True).stdout)
        ratios.append((ours_ms / floor_ms, ours_ms, floor_ms))
    return sorted(ratios)[len(ratios) // 2]


if __name__ == "__main__":
    print("changing scene over C++: {:.2f} ({:.0f} and {:.0f} ms CPU a frame)".format(*changes()))
    print("whole call of a frame of 2 x 2 samples: new {:.0f} us, again {:.0f} us".format(*call_overhead_us()))
    for look in ("paper", "scanner"):
        print("{}: two threads {:.2f} times one, two processes {:.2f} times".format(look, *two_at_once(look)))
