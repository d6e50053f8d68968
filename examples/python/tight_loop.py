"""Many frames into the same memory, from two threads."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

import echocine

scene = echocine.heart(keyframes=6, look="paper")
scene.update({"probe.lines": 48, "probe.samples": 128, "output.width": 160, "output.height": 120})
simulator = echocine.Simulator(scene)


def brightest(times_s: np.ndarray) -> float:  # type: ignore[type-arg]
    greys = np.empty((128, 48), np.float32)
    best = 0.0
    for time_s in times_s:
        simulator.frame(float(time_s), out={"greys": greys})
        best = max(best, float(greys.mean()))
    return best


with ThreadPoolExecutor(2) as pool:
    print(max(pool.map(brightest, np.array_split(simulator.times_s[:20], 2))))
