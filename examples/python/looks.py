"""The same heart in the paper's picture and with the looks of scanners."""

import echocine

scene = echocine.heart(view="plax", keyframes=6)
scene.update({"probe.lines": 48, "probe.samples": 160, "output.width": 320, "output.height": 240})
for look in ("paper", "clean", "scanner", "smooth", "contrast", "sharp", "portable", "faint"):
    scene.signal.look = look
    image = echocine.Simulator(scene).frame(0.1).image
    print(f"{look:8} mean grey {image.mean():.1f}")
