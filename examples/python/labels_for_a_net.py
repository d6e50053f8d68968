"""Pictures and masks in pairs, as segmentation nets want them."""

import numpy as np

import echocine

scene = echocine.heart(view="a4c", keyframes=6)
scene.update({"probe.lines": 64, "probe.samples": 128, "output.width": 256, "output.height": 256, "output.ecg": False,
              "output.depth_ticks": False, "acquisition.frame_rate_hz": 5, "truth.labels": {"lv_cavity": 1, "lv_wall": 2, "la": 3}})
loop = echocine.render(scene, truth="labels")
np.savez_compressed("pairs.npz", images=loop.images, labels=loop.labels)
print({int(k): int(n) for k, n in zip(*np.unique(loop.labels, return_counts=True))})
