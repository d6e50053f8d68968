"""What Python adds to the library, as ratios inside one run: python_calls.py BUILD_FOLDER.

Needs the module and scene_changes, both of the build.
"""

import concurrent.futures
import multiprocessing
import pathlib
import resource
import statistics
import subprocess
import sys
import time

BUILD = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release")
sys.path.insert(0, str(BUILD / "python"))

import echocine  # noqa: E402

ROUNDS, FRAMES, CHANGES = 9, 60, 8


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

    pool = concurrent.futures.ThreadPoolExecutor(2)  # threads that stay, as the processes do

    def threads():
        concurrent.futures.wait([pool.submit(frames, simulator, first) for first in (7, 21)])

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


def call_us():
    """Of a frame of eight triangles and four samples, new and into an earlier one: hardly more than the call itself."""
    points = [[20, 0, 60], [-20, 0, 60], [0, 20, 60], [0, -20, 60], [0, 0, 80], [0, 0, 40]]
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    probe = {"kind": "phased", "apex": [0, 0, 0], "axis": [0, 0, 1], "lateral": [1, 0, 0], "sector_deg": 80, "depth_mm": 100,
             "frequency_mhz": 2.5, "lines": 2, "samples": 2}
    simulator = echocine.Simulator(echocine.Scene({
        "probe": probe, "output": {"width": 16, "height": 16},
        "structure": [{"name": "body", "medium": "blood", "keyframes": ([points], faces)}]}))
    out = simulator.frame(0.1)
    return [1e6 * min(seconds(call) for _ in range(2000))
            for call in (lambda: simulator.frame(0.1), lambda: simulator.frame(0.1, out=out))]


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
    print("a frame of nearly nothing: new {:.0f} us, into an earlier one {:.0f} us".format(*call_us()))
    for look in ("paper", "scanner"):
        print("{}: two threads {:.2f} times one, two processes {:.2f} times".format(look, *two_at_once(look)))
