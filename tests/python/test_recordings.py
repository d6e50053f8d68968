"""Recordings in beam space, EchoXFlow and zea, compared and fitted from Python."""

import json
import multiprocessing
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest

import echocine

FIXED = {"hr": 72.0, "edv": 130.0, "wall_thickness": 9.0, "sphericity": 0.6, "mapse": 13.0, "conicity": 0.7, "apical_motion": 1.0, "rv_edv": 135.0}
PATHS = ("root/exam/loop.zarr", "loop.hdf5")


@pytest.fixture(scope="module")
def folder(program, tmp_path_factory):
    """A heart of EF 0.5: its render and both archives."""
    folder = tmp_path_factory.mktemp("recordings")
    heart = [program, "heart", "--ef", "0.5", "--hr", "72", "--edv", "130", "--wall-thickness", "9", "--sphericity", "0.6",
             "--mapse", "13", "--keyframes", "8", "--look", "paper", "-o", folder / "heart", "--quiet"]
    assert subprocess.run(heart).returncode == 0
    scene = echocine.Scene(folder / "heart" / "scene.toml")
    scene.update({"probe.lines": 96, "probe.samples": 192, "output.width": 320, "output.height": 240, "output.ecg": False,
                  "output.depth_ticks": False, "output.codec": "ffv1", "output.report": False,
                  "output.channels": ["display.Y"], "acquisition.frame_rate_hz": 24})
    (folder / "heart" / "small.toml").write_text(scene.text)
    echocine.render(scene, folder / "loop")
    for layout, output in (("echoxflow", "root"), ("zea", "loop.hdf5")):
        made = [program, "archive", folder / "heart" / "small.toml", "-o", folder / output, "--layout", layout, "--exam", "exam",
                "--quiet"] + (["--recording", "loop"] if layout == "echoxflow" else [])
        assert subprocess.run(made).returncode == 0
    return folder


def none_left():
    """No child process is left, ended or not."""
    with pytest.raises(ChildProcessError):
        os.waitpid(-1, os.WNOHANG)


@pytest.mark.parametrize("path", PATHS)
def test_an_archive_is_its_render(folder, path):
    result = echocine.compare(folder / "loop", folder / path)
    assert result.summary["discrepancy"] < 3e-5
    real = result.summary["real"]
    assert real["scale_source"] == "recording" and real["grey_source"] == "beam space"
    assert real["frame_rate_hz"] == pytest.approx(24, rel=1e-6)
    assert real["beat"]["anchor"] == "ECG of the recording"
    assert real["beat"]["frames"] == pytest.approx(24 * 60 / 72, abs=0.005)
    assert all(frame["discrepancy"] < 1e-4 for frame in result.frames)


@pytest.mark.parametrize("path", PATHS)
def test_the_program_has_the_same_numbers(folder, path, program, tmp_path):
    assert subprocess.run([program, "compare", folder / "loop", folder / path, "-o", tmp_path, "--quiet"]).returncode == 0
    assert json.loads((tmp_path / "summary.json").read_text()) == echocine.compare(folder / "loop", folder / path).summary


def test_a_heart_is_fitted_to_an_archive(folder, tmp_path):
    fit = echocine.fit({"a4c": folder / "loop.hdf5"}, tilt_deg=0, cache=tmp_path / "hearts", **FIXED)
    ef = fit.result["ef"]
    assert ef.value == pytest.approx(0.5, abs=0.03) and ef.low < ef.value < ef.high


def test_damaged_recordings_are_refused_in_one_line(folder, tmp_path):
    whole = (folder / "loop.hdf5").read_bytes()
    refused = 0
    for n in range(24):
        at = (n * 7919 + 13) % len(whole)
        (tmp_path / "bad.hdf5").write_bytes(whole[:at] if n % 2 else whole[:at] + bytes([whole[at] ^ 0x41]) + whole[at + 1:])
        try:
            echocine.compare(folder / "loop", tmp_path / "bad.hdf5")
        except echocine.SceneError as error:
            assert "\n" not in str(error) and "bad.hdf5" in str(error)
            refused += 1
    assert refused >= 12
    none_left()
    with pytest.raises(echocine.SceneError, match="catalogue of recordings"):
        echocine.compare(folder / "loop", folder / "root")


def _discrepancy(paths):
    return echocine.compare(*paths).summary["discrepancy"]


def test_processes_and_threads_read_recordings(folder):
    pairs = [(folder / "loop", folder / path) for path in PATHS]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert max(pool.map(_discrepancy, pairs)) < 3e-5
    with ThreadPoolExecutor(2) as pool:
        assert max(pool.map(_discrepancy, pairs)) < 3e-5
