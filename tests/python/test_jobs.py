"""Progress, stops, plans, studies and comparisons."""

import importlib
import json
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import echocine
from conftest import SMALL, ball_scene


def test_progress_by_a_function(scene):
    seen = []
    echocine.render(scene, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1][0] == seen[-1][1] == scene.frame_count


class Bar:
    """As tqdm has it."""

    def __init__(self):
        self.n, self.total = 0, None

    def update(self, n):
        self.n += n

    def reset(self, total=None):
        self.n = 0


def test_progress_by_a_bar(scene):
    bar = Bar()
    echocine.render(scene, progress=bar)
    assert bar.n == bar.total == scene.frame_count


def test_what_progress_raises_ends_the_job(scene):
    def refuse(done, total):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        echocine.render(scene, progress=refuse)
    with pytest.raises(TypeError, match="progress"):
        echocine.render(scene, progress=3)


def test_an_interrupt_stops_the_job(tmp_path):
    long = ball_scene(**{"acquisition.frame_rate_hz": 2000.0, "acquisition.beats": 20.0})
    begun = threading.Event()
    sent = []

    def interrupt():
        begun.wait(30)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            echocine.render(long, progress=lambda done, total: begun.set())
        assert time.monotonic() - sent[0] < 10  # a loop of 37,000 frames takes longer
    finally:
        begun.set()
        thread.join()


def test_plan(scene):
    plan = echocine.plan(scene)
    assert plan.frames == scene.frame_count and plan.seconds > 0 and plan.memory_bytes > 0
    assert {e["name"] for e in plan.effects} >= {"reflection", "attenuation"}
    assert "reflection" in repr(plan) and "<table>" in plan._repr_html_()
    assert plan.details["white"] and "apex" in plan.details["probe_toml"]


def test_a_tolerance_selects_the_same_settings_as_the_program(program, tmp_path):
    subprocess.run([program, "heart", "--keyframes", "4", "--look", "paper", "-o", tmp_path / "heart", "--quiet"], check=True)
    scene = echocine.Scene(tmp_path / "heart" / "scene.toml")
    scene.update(SMALL)
    scene["accuracy.tolerance_db"] = 6.0
    file = tmp_path / "heart" / "tolerant.toml"
    file.write_text(scene.text)
    echocine.render(scene, tmp_path / "loop")
    subprocess.run([program, "render", file, "-o", tmp_path / "program", "--quiet"], check=True)
    own, other = (json.loads((tmp_path / name / "manifest.json").read_text()) for name in ("loop", "program"))
    assert own["accuracy"]["tolerance_db"] == 6.0 and own["accuracy"]["setting"] == other["accuracy"]["setting"]
    assert own["scene_sha256"] == other["scene_sha256"]
    assert np.array_equal(echocine.render(scene).images, echocine.open(tmp_path / "program").images)


def test_threads_are_checked_everywhere(scene, tmp_path):
    for call in (lambda n: echocine.plan(scene, threads=n), lambda n: echocine.study(scene, threads=n),
                 lambda n: echocine.heart(threads=n), lambda n: echocine.mmode(scene, threads=n),
                 lambda n: echocine.doppler(scene, threads=n), lambda n: echocine.export(scene, tmp_path / "x.gif", threads=n),
                 lambda n: echocine.ModelLoop(scene, threads=n), lambda n: scene.live(threads=n)):
        for threads in (-1, 4097, 1.5, True):
            with pytest.raises(ValueError, match="threads: is .*, accepted: a whole number from 0 to 4096"):
                call(threads)


def test_study(scene, tmp_path):
    result = echocine.study(scene, tmp_path / "study", frames=1, repeats=1, knobs=["lines"])
    assert result["rows"] and (tmp_path / "study" / "study.html").exists()
    assert echocine.study(scene, frames=1, repeats=1, knobs=["lines"])["rows"]  # without files
    with pytest.raises(echocine.SceneError, match="\"linse\" is not a knob, accepted"):
        echocine.study(scene, knobs=["linse"])


def test_compare_and_discrepancy_with_itself(heart, tmp_path):
    heart.update({"output.channels": ["Y", "display.Y"], "output.width": 400, "output.height": 300, "probe.lines": 64,
                  "probe.samples": 128})
    loop = echocine.render(heart, tmp_path / "loop")
    itself = echocine.compare(loop, tmp_path / "loop" / "cine.avi", tmp_path / "comparison",
                              real_side={"fps": 10.0, "read_ecg": False}, align_space=False)
    assert itself.discrepancy < 0.2 and (tmp_path / "comparison" / "summary.json").exists()
    distance = echocine.FrameDiscrepancy(tmp_path / "loop", heart)
    assert distance.real_frames == len(loop)
    near, far = distance(0, loop.greys[0]), distance(0, loop.greys[len(loop) // 2])
    assert near < 0.05 < far
    with pytest.raises(ValueError, match="greys: is"):
        distance(0, loop.greys[0].T)
    with pytest.raises(IndexError, match="frame: is 99"):
        distance(99, loop.greys[0])
    with pytest.raises(ValueError, match="nan"):
        distance(0, np.full_like(loop.greys[0], np.nan))
    assert distance.tilt is None
    placed = heart.copy()  # by the anatomy: as the render placed it
    placed.update({"probe.apex": None, "probe.axis": None, "probe.lateral": None, "probe.view": "a4c"})
    assert echocine.FrameDiscrepancy(tmp_path / "loop", placed).overlap == pytest.approx(distance.overlap, abs=0.02)
    tilted = echocine.FrameDiscrepancy(tmp_path / "loop", heart, tilt_deg=2)
    assert abs(tilted.tilt["tilt_deg"]) <= 2 and tilted.tilt["discrepancy"] <= tilted.tilt["discrepancy_untilted"]
    assert tilted.tilt["probe_toml"].startswith("apex = ")
    with pytest.raises(ValueError, match="tilt_deg: is 30, accepted: 0 to 20"):
        echocine.compare(loop, tmp_path, tilt_deg=30)
    with pytest.raises(ValueError, match="sid: |not known, accepted"):
        echocine.compare(loop, tmp_path, real_side={"sid": 1})
    for side, words in (({"fps": "fifty"}, "fps: is 'fifty', accepted: a number"),
                        ({"r_waves_s": 0.3}, "r_waves_s: is 0.3, accepted: a list of numbers")):
        with pytest.raises(ValueError, match=words):
            echocine.compare(loop, tmp_path, real_side=side)


def test_warnings_are_python_warnings(recwarn):
    scene = ball_scene()
    for line in scene.warnings:
        assert isinstance(line, str)
    echocine.render(scene, frames=(0, 1))
    issued = [str(w.message) for w in recwarn.list if issubclass(w.category, echocine.SceneWarning)]
    assert all(line in issued for line in scene.warnings)


def outline_mm(scene):
    """The box of the ball in a scene's drawing: least and most of right and down."""
    path = scene._repr_html_().split('<path d="')[2].split('"')[0]
    points = np.array([pair.split() for pair in path.replace("L", "M").split("M")[1:]], float)
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


def test_notebook(scene):
    loop = echocine.render(scene, frames=(0, 3))
    player = loop._repr_html_()
    assert player.count("data:image/png;base64,") == 3 and "http" not in player
    assert scene._repr_html_().count("<path") == 2  # the sector and the ball
    moved = scene.copy()
    moved["motion.mesh_scale"] = 0.5
    moved["motion.mesh_offset_mm"] = [0.0, 0.0, 40.0]
    assert outline_mm(moved) == pytest.approx(0.5 * outline_mm(scene) + np.array([0, 40, 0, 40]), abs=0.2)
    linear = scene.copy()
    linear.update({"probe.kind": "linear", "probe.sector_deg": None, "probe.width_mm": 200.0})
    assert "M-100.0 0L-100.0 100.0" in linear._repr_html_() and 'viewBox="-105.0 -10.0 210.0 120.0"' in linear._repr_html_()
    placed = echocine.heart(keyframes=4)
    placed.update({"probe.apex": None, "probe.axis": None, "probe.lateral": None, "probe.depth_mm": None, "probe.view": "a4c"})
    assert "figcaption" in placed._repr_html_()


def test_loops_become_a_file_for_slides(scene, tmp_path):
    loop = echocine.render(scene)
    made = echocine.export([loop, loop], tmp_path / "pair.gif", captions=["first", "second"], width=80)
    assert made.codec == "GIF" and (tmp_path / "pair.gif").read_bytes()[:6] == b"GIF89a"
    assert made.width == 160 and 1 <= made.frames <= scene.frame_count
    assert echocine.export(loop, tmp_path / "one.mp4", repeats=2, tint="blue").frames == 2 * scene.frame_count
    with pytest.raises(echocine.SceneError, match="accepted: .mp4, .gif, .webp"):
        echocine.export(loop, tmp_path / "loop.mkv")
    with pytest.raises(echocine.SceneError, match="tint"):
        echocine.export(loop, tmp_path / "loop.mp4", tint="green")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["one.mp4", "pair.gif"]


def test_arguments_are_checked_before_a_loop_is_rendered(tmp_path, monkeypatch):
    loop = echocine.render(ball_scene())
    monkeypatch.setattr(importlib.import_module("echocine._jobs"), "render", lambda *a, **k: pytest.fail("rendered"))
    (tmp_path / "file").write_text("")
    (tmp_path / "real.avi").write_text("")
    for call, error, words in (
            (lambda: echocine.compare(loop, tmp_path / "none.avi"), echocine.SceneError, "none.avi: no such file"),
            (lambda: echocine.compare(loop, tmp_path / "real.avi", tmp_path / "file"), echocine.JobError, "is a file"),
            (lambda: echocine.compare(loop, tmp_path / "real.avi", real_side={"fbs": 1}), ValueError, "fbs"),
            (lambda: echocine.compare(loop, tmp_path / "real.avi", tilt_deg=30), ValueError, "tilt_deg"),
            (lambda: echocine.compare(loop, tmp_path / "real.avi", knots=[3]), ValueError, "knots"),
            (lambda: echocine.compare(loop, tmp_path / "real.avi", contours=True), ValueError, "contours"),
            (lambda: echocine.compare(loop, tmp_path / "real.avi", align_space=None), ValueError, "align_space"),
            (lambda: echocine.export(loop, tmp_path / "x.txt"), echocine.SceneError, "extension"),
            (lambda: echocine.export(loop, tmp_path / "x.gif", captions="A"), TypeError, "captions"),
            (lambda: echocine.export(loop, tmp_path / "none" / "x.gif"), echocine.JobError, "x.gif")):
        with pytest.raises(error, match=words):
            call()


def test_numbers_of_numpy_and_single_texts(scene):
    assert echocine.plan(scene, threads=np.int64(1)).frames == scene.frame_count
    with pytest.raises(ValueError, match="threads"):
        echocine.plan(scene, threads=np.bool_(True))
    with pytest.raises(TypeError, match="knobs: is one text"):
        echocine.study(scene, knobs="lines")
    for budget_s in (float("nan"), 0, -1):
        with pytest.raises(ValueError, match="budget_s"):
            echocine.study(scene, budget_s=budget_s)
    with pytest.raises(ValueError, match="dials: ef"):
        echocine.HeartPrior().log_density(ef="0.5")
