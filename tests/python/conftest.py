"""Scenes that are small enough to be rendered in a moment."""

import os
import subprocess
import sys
import tempfile

import numpy as np
import pytest

import echocine

# Not the user's: hearts that fits compute are kept there.
_cache = tempfile.TemporaryDirectory()
os.environ["XDG_CACHE_HOME"] = _cache.name

SMALL = {"probe.lines": 24, "probe.samples": 64, "output.width": 120, "output.height": 90, "output.ecg": False,
         "output.depth_ticks": False, "output.codec": "ffv1", "output.report": False, "acquisition.frame_rate_hz": 10}


def ball(radius=20.0, centre=(0.0, 0.0, 60.0), levels=2):
    """Points (V, 3) and faces (F, 3) of a ball, facing outward."""
    points = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    faces = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(levels):
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        unique, index = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
        middle = len(points) + index.reshape(3, -1)
        points = np.concatenate([points, points[unique].mean(axis=1)])
        a, b, c = faces.T
        faces = np.concatenate([np.stack(f, axis=1) for f in ((a, middle[0], middle[2]), (b, middle[1], middle[0]),
                                                               (c, middle[2], middle[1]), tuple(middle))])
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    return points * radius + np.array(centre), faces


def ball_scene(**changes):
    points, faces = ball()
    beat = np.stack([points, (points - [0, 0, 60]) * 0.8 + [0, 0, 60]])
    document = {"probe": {"kind": "phased", "apex": [0, 0, 0], "axis": [0, 0, 1], "lateral": [1, 0, 0], "sector_deg": 80,
                          "depth_mm": 100, "frequency_mhz": 2.5, "lines": 24, "samples": 64},
                "acquisition": {"frame_rate_hz": 10.0},
                "output": {"width": 120, "height": 90, "ecg": False, "depth_ticks": False, "codec": "ffv1", "report": False},
                "structure": [{"name": "ball", "medium": "blood", "keyframes": (beat, faces)}]}
    scene = echocine.Scene(document)
    scene.update(changes)
    return scene


@pytest.fixture
def scene():
    return ball_scene()


@pytest.fixture(scope="session")
def recorded():
    made = echocine.heart(ef=0.5, keyframes=6, look="paper")
    made.update(SMALL)
    return made


@pytest.fixture
def heart(recorded):
    return recorded.copy()


@pytest.fixture(scope="session")
def program():
    return os.environ["ECHOCINE_PROGRAM"]


def run_python(text, **kwargs):
    return subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=120, **kwargs)
