"""A render's folder, as the command writes it, read back into arrays."""

import echocine

scene = echocine.heart(keyframes=6, look="paper")
scene.update({"probe.lines": 32, "probe.samples": 96, "output.width": 160, "output.height": 120, "acquisition.frame_rate_hz": 5,
              "output.channels": ["Y", "attenuation.A"]})
echocine.render(scene, "loop", truth=["labels", "function"])

loop = echocine.open("loop")
print(loop.channel("attenuation.A").shape, loop.labels.max(), loop.strain.shape, list(loop.manifest)[:3])
