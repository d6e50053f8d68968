"""A first loop: a heart by its dials, its pictures and its volume curve."""

import echocine

scene = echocine.heart(ef=0.45, view="a4c", keyframes=6)
scene.update({"probe.lines": 48, "probe.samples": 128, "output.width": 240, "output.height": 180, "acquisition.frame_rate_hz": 10})
loop = echocine.render(scene)
volume_ml = loop.volumes["lv_cavity"]
print(loop.images.shape, f"{volume_ml.max():.0f} to {volume_ml.min():.0f} mL")
