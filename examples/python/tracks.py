"""How far points of the wall move, frame by frame."""

import numpy as np

import echocine

scene = echocine.heart(keyframes=6, look="paper")
scene.update({"probe.lines": 32, "probe.samples": 96, "output.width": 160, "output.height": 120, "acquisition.frame_rate_hz": 10})
scene.update({"truth.write": ["tracks", "function"], "truth.tracks": 200})
loop = echocine.render(scene)
moved_mm = np.linalg.norm(loop.tracks - loop.tracks[0], axis=-1)
print(f"{loop.tracks.shape[1]} points, up to {moved_mm.max():.1f} mm")
print("longitudinal strain, %:", (100 * loop.curves["global_longitudinal_strain"]).round(1))
