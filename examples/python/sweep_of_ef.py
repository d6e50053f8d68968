"""A sweep: the same heart at several ejection fractions."""

import numpy as np

import echocine

for ef in (0.25, 0.45, 0.65):
    scene = echocine.heart(ef=ef, keyframes=6, look="paper")
    scene.update({"probe.lines": 32, "probe.samples": 96, "output.width": 160, "output.height": 120, "acquisition.frame_rate_hz": 20})
    volume_ml = echocine.render(scene).volumes["lv_cavity"]
    print(f"dialled {ef:.2f}, measured {1 - np.min(volume_ml) / np.max(volume_ml):.3f}")
