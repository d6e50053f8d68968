"""Ultrasound cine loops of a beating heart, ray-traced, as NumPy arrays.

    import echocine
    scene = echocine.heart(ef=0.45, view="a4c")
    scene.probe.lines = 128
    loop = echocine.render(scene, truth="labels")
    loop.images                     # (T, H, W) uint8
    loop.labels                     # (T, H, W) uint8; loop.label_names says which number is what
    loop.intensities                # (T, depth, line) float32
    loop.volumes["lv_cavity"]       # (T,) float64, mL
    loop.times_s                    # (T,) float64, s

Scenes have the keys of scene files; `Scene.keys()` lists them, `dials()` those of hearts. Another heart is another scene:
`heart(ef=0.3)`. `HeartFamily` changes dials in milliseconds, and `ModelDiscrepancy` compares its hearts with a real loop.
`fit` finds a heart from one to three echo loops. `Simulator` makes single frames, `mmode` a line over time, `doppler` velocities, `dataset` many loops, `open` reads a render's folder. Errors are SceneError (what was given cannot be used)
and JobError (the work failed).
"""

from ._echocine import Frame, __version__
from ._dataset import Dataset, DatasetLoop, dataset, join_datasets, preview_dataset
from ._errors import JobError, SceneError, SceneWarning
from ._fit import HeartFamily, HeartPrior, ModelDiscrepancy, ModelLoop, PoseFound
from ._heart_fit import HeartFit, Interval, fit
from ._jobs import Comparison, Exported, FrameDiscrepancy, Plan, compare, export, plan, study
from ._live import LivePage
from ._loop import Loop, open, render
from ._modes import Border, Doppler, MMode, Ring, Spectrum, doppler, mmode
from ._scene import Scene, Table, dials, heart, scene_keys
from ._simulator import Simulator

__all__ = ["Border", "Comparison", "Dataset", "DatasetLoop", "Doppler", "Exported", "Frame", "FrameDiscrepancy", "HeartFamily", "HeartFit", "HeartPrior", "Interval", "JobError", "LivePage", "Loop",
           "MMode", "ModelDiscrepancy", "ModelLoop", "Plan", "PoseFound", "Ring", "Scene", "SceneError", "SceneWarning", "Simulator", "Spectrum", "Table",
           "__version__", "compare", "dataset", "dials", "doppler", "export", "fit", "heart", "join_datasets", "mmode", "open", "plan",
           "preview_dataset", "render", "scene_keys", "study"]
