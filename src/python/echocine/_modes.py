"""M-mode and tissue Doppler, as the commands make them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _echocine
from ._errors import thread_count, whole_number
from ._progress import Progress, report_to
from ._scene import Scene

PathLike = Union[str, "os.PathLike[str]"]


def _scene(scene: Any) -> _echocine.Scene:
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: is {type(scene).__name__}, accepted: an echocine.Scene")
    return scene._native


class Border(NamedTuple):
    """A border of a structure on the line of an M-mode: column, structure, and path length from the face, mm."""

    column: int
    structure: str
    depth_mm: float


class Ring(NamedTuple):
    """Motion of a valve ring along the line towards the probe, since the first column.

    Attributes:
        exact_m: (T,) m, from the meshes.
        traced_m: m, from the picture, up to the closure of the aortic valve.
        exact_mm, traced_mm: the largest of each, mm.
        in_space_mm: largest motion of the ring along the ventricle's axis (MAPSE, TAPSE), mm.
    """

    exact_m: NDArray[np.float64]
    traced_m: NDArray[np.float64]
    exact_mm: float
    traced_mm: float
    in_space_mm: float


class MMode(NamedTuple):
    """One scan line over time.

    Attributes:
        line: the scan line, from 0.
        times_s, phases: (T,) s, and phases of the beat.
        intensities: (depth, T) float32, after time gain and beam average, relative to I_S.
        greys: (depth, T) float32, 0 black to 1 white.
        borders: crossings of the line and borders, by column, then by depth.
        ring: of a valve ring; else None.
    """

    line: int
    times_s: NDArray[np.float64]
    phases: NDArray[np.float64]
    intensities: NDArray[np.float32]
    greys: NDArray[np.float32]
    borders: List[Border]
    ring: Optional[Ring]


def mmode(scene: Scene, folder: Optional[PathLike] = None, *, angle_deg: Optional[float] = None, offset_mm: Optional[float] = None,
          through: Optional[str] = None, rate_hz: float = 500, rows: int = 480, threads: int = 0, progress: Progress = None) -> MMode:
    """Makes an M-mode, as ``echocine mmode`` does.

    Args:
        scene: what is scanned.
        folder: for mmode.exr, mmode.png, CSV and JSON; None: no files.
        angle_deg: of the line; offset_mm for linear probes; the nearest scan line is used. None: the central line.
        through: instead, a place of the heart: "mitral-tips", "mitral-lateral", "mitral-septal", "tricuspid-lateral" or
            "aortic-valve".
        rate_hz: lines a second.
        rows: height of the echoes in the picture, pixels.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.
    """
    rows = whole_number("rows", rows, 16, 8192)
    if (angle_deg is not None) + (offset_mm is not None) + (through is not None) > 1:
        raise ValueError("angle_deg, offset_mm, through: accepted: one of them")
    made: Dict[str, Any] = _echocine.mmode(_scene(scene), None if folder is None else Path(folder), angle_deg, offset_mm, through, rate_hz,
                                           rows, thread_count(threads), report_to(progress))
    times_s, phases = made["times"]
    return MMode(made["line"], times_s, phases, made["intensities"], made["greys"], [Border(*b) for b in made["borders"]],
                 Ring(*made["ring"]) if "ring" in made else None)


class Spectrum(NamedTuple):
    """Spectral tissue Doppler at a place.

    Attributes:
        times_s, phases: (T,) s, and phases of the beat.
        velocities_m_s: (N,) middles of the bins, m/s, positive towards the probe.
        power: (N, T) float32.
        mean_m_s, exact_m_s: (T,) m/s: measured, and from the meshes; NaN without tissue.
        peak_m_s, exact_peak_m_s: largest of each up to the closure of the aortic valve, 0 without a left ventricle.
    """

    times_s: NDArray[np.float64]
    phases: NDArray[np.float64]
    velocities_m_s: NDArray[np.float64]
    power: NDArray[np.float32]
    mean_m_s: NDArray[np.float64]
    exact_m_s: NDArray[np.float64]
    peak_m_s: float
    exact_peak_m_s: float


class Doppler(NamedTuple):
    """Tissue Doppler of a loop; planes are (T, depth, line) float32.

    Attributes:
        nyquist_m_s: largest velocity that is measured without aliasing.
        times_s, phases: (T,) s, and phases of the beat.
        velocity: m/s, positive towards the probe; NaN in blood and outside tissue.
        variance: m^2/s^2.
        power: relative to I_S.
        exact: m/s, from the meshes.
        bias_m_s, rms_m_s: of velocity against exact, modulo twice nyquist_m_s, weighted by power.
        aliased_share: of tissue that is faster than nyquist_m_s, 0 to 1.
        spectrum: at the requested place; else None.
    """

    nyquist_m_s: float
    times_s: NDArray[np.float64]
    phases: NDArray[np.float64]
    velocity: NDArray[np.float32]
    variance: NDArray[np.float32]
    power: NDArray[np.float32]
    exact: NDArray[np.float32]
    bias_m_s: float
    rms_m_s: float
    aliased_share: float
    spectrum: Optional[Spectrum]


def doppler(scene: Scene, folder: Optional[PathLike] = None, *, prf_hz: float = 1000, pulses: int = 4, gate_mm: float = 1,
            wall_filter: str = "none", depth_mm: Optional[float] = None, angle_deg: Optional[float] = None,
            offset_mm: Optional[float] = None, through: Optional[str] = None, volume_mm: Optional[float] = None, threads: int = 0,
            progress: Progress = None) -> Doppler:
    """Measures tissue velocities from pulses, as ``echocine doppler`` does.

    Args:
        scene: what is scanned.
        folder: for velocity/, doppler.gif and doppler.json; None: no files.
        prf_hz: pulses a second on each line.
        pulses: of a packet, 2 to 64, with a wall filter more than 2.
        gate_mm: length along the line over which a velocity averages.
        wall_filter: "none", "mean", "line" or "parabola": polynomial removed from each packet.
        depth_mm, angle_deg, offset_mm: place of a spectrum; offset_mm for linear probes.
        through: instead, a place of the heart, as for `mmode`.
        volume_mm: length of the spectrum's sample volume; None: 5 mm.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.
    """
    if through is not None and (depth_mm is not None or angle_deg is not None or offset_mm is not None):
        raise ValueError("through: accepted: without depth_mm, angle_deg and offset_mm")
    if depth_mm is None and (angle_deg is not None or offset_mm is not None):
        raise ValueError("depth_mm: is None, accepted: a depth with angle_deg or offset_mm")
    if volume_mm is not None and depth_mm is None and through is None:
        raise ValueError("volume_mm: needs a place of the spectrum, accepted: with depth_mm or through")
    made: Dict[str, Any] = _echocine.doppler(_scene(scene), None if folder is None else Path(folder), prf_hz, pulses, gate_mm, wall_filter,
                                             depth_mm, angle_deg, offset_mm, through, volume_mm, thread_count(threads), report_to(progress))
    spectrum = None
    if "spectrum" in made:
        (times_s, phases), power, mean, exact, peak, exact_peak = made["spectrum"]
        bins = power.shape[0]
        velocities = made["nyquist_m_s"] * (2 * (np.arange(bins) + 0.5) / bins - 1)
        spectrum = Spectrum(times_s, phases, velocities, power, mean, exact, peak, exact_peak)
    times_s, phases = made["times"]
    bias_m_s, rms_m_s, aliased_share = made["against_truth"]
    return Doppler(made["nyquist_m_s"], times_s, phases, made["velocity"], made["variance"], made["power"], made["exact"],
                   bias_m_s, rms_m_s, aliased_share, spectrum)
