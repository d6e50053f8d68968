"""M-mode and tissue Doppler as arrays."""

import json

import numpy as np
import pytest

import echocine
from conftest import ball


def plate_scene(amplitude_mm=4.0):
    """A ball of muscle in blood that moves to and fro along the depth."""
    points, faces = ball()
    phases = np.arange(12) / 12
    beat = np.stack([points + [0, 0, -amplitude_mm * np.sin(2 * np.pi * p)] for p in phases])
    return echocine.Scene({"background": "blood",
                           "probe": {"kind": "phased", "apex": [0, 0, 0], "axis": [0, 0, 1], "lateral": [1, 0, 0], "sector_deg": 20,
                                     "depth_mm": 100, "frequency_mhz": 2.5, "lines": 16, "samples": 256},
                           "acquisition": {"heart_rate_bpm": 60.0, "frame_rate_hz": 10.0}, "motion": {"interpolation": "fourier"},
                           "output": {"width": 120, "height": 90, "report": False},
                           "structure": [{"name": "ball", "medium": "myocardium", "keyframes": (beat, faces)}]})


def test_mmode_is_that_of_the_program(tmp_path):
    scene = plate_scene()
    mode = echocine.mmode(scene, tmp_path / "mode", rate_hz=20, angle_deg=2)
    again = echocine.mmode(scene, rate_hz=20, angle_deg=2, threads=1)
    assert mode.greys.shape == (256, 20) and mode.greys.dtype == np.float32
    assert np.array_equal(mode.greys, again.greys) and np.array_equal(mode.intensities, again.intensities)
    assert json.loads((tmp_path / "mode" / "mmode.json").read_text())["line"] == mode.line
    assert np.allclose(np.diff(mode.times_s), 0.05)
    near = [b.depth_mm for b in mode.borders if b.structure == "ball"][::2]
    assert np.ptp(near) > 7 and mode.ring is None
    with pytest.raises(ValueError, match="one of them"):
        echocine.mmode(scene, angle_deg=1, through="mitral-tips")
    with pytest.raises(echocine.SceneError, match="accepted: mitral-tips, "):
        echocine.mmode(scene, through="nowhere")
    with pytest.raises(echocine.SceneError, match="--offset"):
        echocine.mmode(scene, offset_mm=1)


def test_doppler_measures_the_exact_velocity(tmp_path):
    scene = plate_scene()
    made = echocine.doppler(scene, tmp_path / "doppler", depth_mm=60)
    assert made.velocity.shape == (10, 256, 16) == made.exact.shape
    assert np.array_equal(np.isnan(made.velocity), np.isnan(made.exact))
    assert made.nyquist_m_s == pytest.approx(1540 / 2.5e6 * 1000 / 4)
    assert abs(made.bias_m_s) < 0.02 * made.nyquist_m_s
    towards = 0.004 * 2 * np.pi * np.cos(2 * np.pi * made.phases)
    assert np.allclose(np.nanmean(made.exact, axis=(1, 2)), towards, atol=0.003)
    assert np.allclose(np.nanmedian(made.velocity, axis=(1, 2)), towards, atol=0.004)
    assert made.spectrum.power.shape == (made.spectrum.velocities_m_s.size, made.spectrum.times_s.size)
    assert np.nanmax(np.abs(made.spectrum.mean_m_s - made.spectrum.exact_m_s)[20:-20]) < 0.1 * made.nyquist_m_s
    summary = json.loads((tmp_path / "doppler" / "doppler.json").read_text())
    assert summary["against_truth"]["bias_m_s"] == made.bias_m_s
    memory = echocine.doppler(scene, threads=1)
    assert np.array_equal(memory.velocity, made.velocity, equal_nan=True) and memory.spectrum is None
    loop = echocine.render(scene, truth="velocity_beam")
    assert np.array_equal(loop.velocity_beam, made.exact, equal_nan=True)
    with pytest.raises(echocine.SceneError, match="--prf"):
        echocine.doppler(scene, prf_hz=1e6)
    with pytest.raises(ValueError, match="depth_mm"):
        echocine.doppler(scene, angle_deg=1)
    with pytest.raises(ValueError, match="volume_mm: needs a place"):
        echocine.doppler(scene, volume_mm=3)
