"""The discrepancy inside an optimiser of SciPy: which gain did a loop have?"""

from pathlib import Path

from scipy.optimize import minimize_scalar  # type: ignore[import]

import echocine

scene = echocine.heart(keyframes=6, look="paper")
scene.update({"probe.lines": 48, "probe.samples": 128, "output.width": 320, "output.height": 240, "acquisition.frame_rate_hz": 5,
              "output.report": False, "output.channels": ["Y", "display.Y"]})
target = scene.copy()
target.signal.dynamic_range_db = 50
echocine.render(target, Path("target"))
distance = echocine.FrameDiscrepancy(Path("target"), scene)


def cost(range_db: float) -> float:
    scene.signal.dynamic_range_db = float(range_db)
    return distance(0, echocine.Simulator(scene).frame(0.0).greys)


found = minimize_scalar(cost, bounds=(35, 75), method="bounded", options={"maxiter": 15, "xatol": 0.3})
print(f"dynamic range {found.x:.1f} dB, discrepancy {found.fun:.4f}")
