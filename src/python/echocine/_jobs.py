"""Plans, studies and comparisons, as the commands make them."""

from __future__ import annotations

import csv
import io
import json
import os
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _echocine
from ._errors import SceneError, flag, texts, thread_count, whole_number
from ._loop import Loop, render
from ._progress import Progress, report_to
from ._scene import Scene

PathLike = Union[str, "os.PathLike[str]"]


def _scene(scene: Any) -> _echocine.Scene:
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: is {type(scene).__name__}, accepted: an echocine.Scene")
    return scene._native


class Plan:
    """What a loop needs, why, and what it takes.

    Attributes:
        effects: one dict per effect: name, on, reason, and time_share, its part of a frame's time, 0 to 1.
        seconds: estimated for the whole loop, s.
        memory_bytes: most memory while rendering, bytes.
        frames: of the loop.
        details: all of it, as ``echocine plan --json`` prints it.
    """

    def __init__(self, details: Dict[str, Any]) -> None:
        self.details = details
        self.effects: List[Dict[str, Any]] = details["effects"]
        self.seconds: float = details["seconds"]
        self.memory_bytes: float = details["memory_bytes"]
        self.frames: int = details["frames"]

    def _rows(self) -> List[List[str]]:
        rows = []
        for e in self.effects:
            share = f"{100 * e.get('time_share', 0):.0f} %" if e["on"] else ""
            rows.append([str(e["name"]), "on" if e["on"] else "off", share, str(e["reason"])])
        return rows

    def __repr__(self) -> str:
        lines = [f"{name:<24} {on:<4} {share:>5}  {why}" for name, on, share, why in self._rows()]
        lines.append(f"{self.seconds:.1f} s for {self.frames} frames, {self.memory_bytes * 1e-6:.0f} MB")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        from ._notebook import table_html
        caption = f"{self.seconds:.1f} s for {self.frames} frames, {self.memory_bytes * 1e-6:.0f} MB"
        return table_html(["effect", "", "time", "why"], self._rows(), caption)


def plan(scene: Scene, *, threads: int = 0, progress: Progress = None) -> Plan:
    """Which effects a scene's loop needs and why, and how long it takes, from rendering a few frames."""
    return Plan(json.loads(_echocine.plan(_scene(scene), thread_count(threads), report_to(progress))))


def study(scene: Scene, folder: Optional[PathLike] = None, *, frames: int = 4, repeats: int = 3, knobs: Sequence[str] = (),
          budget_s: Optional[float] = None, threads: int = 1, progress: Progress = None) -> Dict[str, Any]:
    """What each accuracy knob costs in ms and leaves in dB and mm, as ``echocine study`` measures it.

    Args:
        scene: what is measured.
        folder: for study.html, study.csv and study.json; None: no files.
        frames: frames that are compared and timed, 1 to 1000.
        repeats: rounds over all settings; times are medians over them.
        knobs: only these; all if left out.
        budget_s: begin nothing later than this many seconds after the start.
        threads: frames in the making at once while they are timed; 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.

    Returns study.json as a dict; "rows" has the measurements.
    """
    for name, value in (("frames", frames), ("repeats", repeats)):
        if not 1 <= value <= 1000:
            raise ValueError(f"{name}: is {value}, accepted: 1 to 1000")
    if budget_s is not None and not 1e-3 <= budget_s <= 1e9:
        raise ValueError(f"budget_s: is {budget_s}, accepted: 0.001 to 1e9")
    path = None if folder is None else Path(folder)
    result: Dict[str, Any] = json.loads(
        _echocine.study(_scene(scene), path, frames, repeats, texts("knobs", knobs), budget_s, thread_count(threads), report_to(progress)))
    return result


class Comparison:
    """A synthetic loop against a real one.

    Attributes:
        discrepancy: 0 equal, about 1 unrelated; the mean over the frames that count.
        summary: every estimate and mean, as in summary.json.
        frames: one dict per real frame, as in frames.csv, numbers as floats.
    """

    def __init__(self, summary: Dict[str, Any], frames: List[Dict[str, Any]]) -> None:
        self.summary, self.frames = summary, frames
        self.discrepancy: float = summary["discrepancy"]

    def __repr__(self) -> str:
        return f"<echocine.Comparison: discrepancy {self.discrepancy:.4f} over {len(self.frames)} frames>"


def _number(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text or None


def compare(synthetic: Union[Loop, PathLike], real: PathLike, folder: Optional[PathLike] = None, *,
            real_side: Optional[Mapping[str, Any]] = None, synthetic_side: Optional[Mapping[str, Any]] = None,
            align_space: bool = True, scene: Optional[PathLike] = None, tilt_deg: float = 0, monotone: bool = False,
            knots: Sequence[float] = (), knot_count: int = 8, band_mm: float = 4, contours: bool = False, threads: int = 0,
            progress: Progress = None) -> Comparison:
    """Compares a loop with an echo video, frame by frame, as ``echocine compare`` does.

    Args:
        synthetic: a loop, a render's folder, or a video. A loop in memory is rendered into a folder that is removed.
        real: AVI, MP4, GIF, DICOM, a folder of PNG or JPEG frames, EchoXFlow (.zarr), or zea (.hdf5).
        folder: for compare.html, frames.csv and pictures; None: no files.
        real_side, synthetic_side: what is known better than the files tell: fps (1/s), mm_per_pixel, pixel_aspect,
            heart_rate_bpm, sector, ed_frame, es_frame, r_waves_s, read_ecg (False: no ECG is read from the pictures),
            label (what pages and JSON call the loop; without it they name no file).
        align_space: shift, scale and turn one sector onto the other.
        scene: file of the scene of the render: metrics in bands around its boundaries.
        tilt_deg: by which the scene's plane may be tilted and rotated to where it fits best, either way, 0 to 20;
            ``summary["scene_fit"]["tilt"]`` tells it.
        monotone: the grey calibration is monotone.
        knots: synthetic grey levels of its knots, 0 to 255; without them, knot_count of them (2 to 64) are chosen.
        band_mm: full width of the bands around the scene's boundaries, 0.1 to 100.
        contours: draws the scene's contours into the pictures.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.
    """
    thread_count(threads)
    levels = [float(level) for level in knots]
    if len(levels) == 1 or any(not 0 <= level <= 255 for level in levels) or any(b <= a for a, b in zip(levels, levels[1:])):
        raise ValueError(f"knots: is {levels}, accepted: two or more ascending grey levels, 0 to 255")
    if not 0.1 <= band_mm <= 100:
        raise ValueError(f"band_mm: is {band_mm}, accepted: 0.1 to 100")
    if contours and scene is None:
        raise ValueError("contours: needs scene, accepted: the file of the scene of the render")
    if not Path(real).exists():
        raise SceneError(f"{real}: no such file")
    details = (flag("align_space", align_space), flag("monotone", monotone), flag("contours", contours), levels,
               whole_number("knot_count", knot_count, 2, 64), float(band_mm))

    def compared(source: Path, only_check: bool) -> Tuple[str, str]:
        return _echocine.compare(source, Path(real), None if folder is None else Path(folder), dict(real_side or {}),
                                 dict(synthetic_side or {}), details, None if scene is None else Path(scene), tilt_deg, threads,
                                 only_check, report_to(progress))

    with tempfile.TemporaryDirectory(prefix="echocine-") as spare:
        compared(Path(spare), True)  # before a loop is rendered
        summary, frames = compared(_as_files(synthetic, Path(spare) / "loop", threads), False)
    rows = [{k: _number(v) for k, v in row.items()} for row in csv.DictReader(io.StringIO(frames))]
    return Comparison(json.loads(summary), rows)


def _as_files(loop: Union[Loop, PathLike], spare: Path, threads: int) -> Path:
    if not isinstance(loop, Loop):
        return Path(loop)
    if loop.folder is not None:
        return loop.folder
    if loop.scene is None:
        raise ValueError("synthetic: the loop has no scene, accepted: a loop of render or a folder")
    lossless = loop.scene.copy()
    lossless.update({"output.codec": "ffv1", "output.exr": True, "output.report": False, "output.png": False, "output.dicom": False,
                     "output.channels": sorted({*lossless["output.channels"], "display.Y"})})
    render(lossless, spare, frames=loop._frames, threads=threads)
    return spare


class Exported(NamedTuple):
    """A file that `export` has written.

    Attributes:
        codec: "H.264", "MPEG-4 part 2", "GIF" or "WebP".
        width, height: pixels.
        frames: all repeats included.
        frame_rate_hz: of playback, 1/s.
    """

    codec: str
    width: int
    height: int
    frames: int
    frame_rate_hz: float


def export(loops: Union[Loop, PathLike, Sequence[Union[Loop, PathLike]]], output: PathLike, *, captions: Sequence[str] = (),
           columns: int = 0, width: int = 0, repeats: int = 1, speed: float = 1, fps: Optional[float] = None, tint: str = "none",
           threads: int = 0) -> Exported:
    """Writes loops as MP4, GIF or animated WebP, side by side, as ``echocine export`` does.

    Args:
        loops: one or several, up to 16: folders of renders, videos, DICOM files, or loops. A loop in memory is rendered into
            a folder that is removed. Videos and folders of unfinished renders show the sector only.
        output: .mp4, .gif or .webp; an existing file is replaced.
        captions: one per loop.
        columns: of the grid; 0: nearly square.
        width: of each loop, pixels; 0: that of the first one.
        repeats: number of times that an MP4 shows the loop, 1 to 100; GIF and WebP repeat without end.
        speed: of playback, 0.01 to 10.
        fps: frame rate of the loops, 1/s; None: that of each file.
        tint: colour of the grey levels: none, sepia or blue.
        threads: 0: one per core.
    """
    given = [loops] if isinstance(loops, (Loop, str, os.PathLike)) else list(loops)
    thread_count(threads)
    words = texts("captions", captions)

    def exported(files: List[Path], only_check: bool) -> Exported:
        return Exported(*_echocine.export_loops(files, Path(output), words, columns, width, repeats, speed, fps, tint, threads,
                                                only_check, None))

    with tempfile.TemporaryDirectory(prefix="echocine-") as spare:
        places = [Path(spare) / str(i) for i in range(len(given))]
        exported([place if isinstance(loop, Loop) else Path(loop) for loop, place in zip(given, places)], True)
        return exported([_as_files(loop, place, threads) for loop, place in zip(given, places)], False)


class FrameDiscrepancy:
    """One number for optimisers: how far a frame's greys are from a real frame. Built once from the real loop.
    `ModelDiscrepancy` compares a model instead, without its greys.

    Args:
        real: AVI, MP4, GIF, DICOM, a folder of frames, EchoXFlow (.zarr), or zea (.hdf5).
        scene: its probe says which lines and depths greys have.
        side: what is known better than the file tells, as for `compare`.
        tilt_deg: by which the scene's plane may be tilted and rotated to where it fits best, either way, 0 to 20.

    Attributes:
        tilt: None without tilt_deg; else tilt_deg, rotate_deg, their confidences, the model's discrepancy there and
            untilted, and probe_toml, the keys of the probe that frames are then to be made with.
    """

    def __init__(self, real: PathLike, scene: Scene, side: Optional[Mapping[str, Any]] = None, tilt_deg: float = 0) -> None:
        self._native = _echocine.FrameDiscrepancy(Path(real), _scene(scene), dict(side or {}), tilt_deg)
        self.tilt: Optional[Dict[str, Any]] = json.loads(self._native.tilt) if self._native.tilt else None

    def __call__(self, frame: int, greys: NDArray[np.float32]) -> float:
        """0 equal, about 1 unrelated, up to 2: greys (depth, line), 0 to 1, against a real frame, from 0. Thread-safe."""
        return self._native(frame, greys)

    @property
    def real_frames(self) -> int:
        """Frames of the real loop."""
        return self._native.real_frames

    @property
    def overlap(self) -> float:
        """Share of the sector that both show, 0 to 1."""
        return self._native.overlap
