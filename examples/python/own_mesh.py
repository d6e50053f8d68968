"""A mesh of one's own: a ball that shrinks by a fifth and grows again."""

import numpy as np

import echocine

# Points by longitude and latitude, mm; faces turn counter-clockwise seen from outside.
around, rows = 24, 12
u = 2 * np.pi * np.arange(around) / around
v = np.pi * np.arange(1, rows) / rows
ring = np.stack([np.outer(np.sin(v), np.cos(u)), np.outer(np.sin(v), np.sin(u)), np.outer(np.cos(v), np.ones(around))], axis=-1)
points = np.concatenate([ring.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
north, south = len(points) - 2, len(points) - 1
faces = []
for i in range(around):
    j = (i + 1) % around
    faces.append((north, i, j))
    faces.append((south, (rows - 2) * around + j, (rows - 2) * around + i))
    for k in range(rows - 2):
        a, b, c, d = k * around + i, k * around + j, (k + 1) * around + i, (k + 1) * around + j
        faces += [(a, c, d), (a, d, b)]
beat = np.stack([points * radius + [0, 0, 60] for radius in (20.0, 18.0, 16.0, 18.0)])

scene = echocine.Scene({
    "probe": {"kind": "phased", "apex": [0, 0, 0], "axis": [0, 0, 1], "lateral": [1, 0, 0], "sector_deg": 80, "depth_mm": 110,
              "frequency_mhz": 2.5, "lines": 48, "samples": 128},
    "acquisition": {"frame_rate_hz": 10.0},
    "output": {"width": 240, "height": 180},
    "structure": [{"name": "ball", "medium": "blood", "keyframes": (beat, np.array(faces))}]})
loop = echocine.render(scene, truth="labels")
print(loop.labels.shape, loop.volumes["ball"].round(1))
