"""Loops: rendered into memory or into a folder, and folders read back."""

from __future__ import annotations

import json
import operator
import os
import struct
import zlib
from pathlib import Path
from types import TracebackType
from typing import Any, Dict, List, Optional, Sequence, Tuple, Type, Union

import numpy as np
from numpy.typing import NDArray

from . import _echocine
from ._errors import JobError, SceneError, flag, thread_count
from ._progress import Progress, report_to
from ._scene import Scene
from ._verify import RenderFiles, is_sealed

_TRUTH = ("all", "labels", "contours", "tracks", "function", "displacement", "velocity", "velocity_beam")
_SIDES = ("lateral", "axial", "elevation")


class Loop:
    """A cine loop with its truth, as arrays: T frames, (depth, line) in beam space, (H, W) in pictures.

    Of `render` without a folder everything lies in memory, and arrays are views of it that keep it alive. Of `open`,
    or of `render` into a folder, arrays are read from the files when they are first asked for.
    What the scene did not ask for raises a ValueError that says how to ask. Times are in s, volumes in mL.
    Files are compared with the digests of the manifest before they are read: a JobError names one that is not as it was written.
    """

    def __init__(self, scene: Optional[Scene], native: Optional[_echocine.LoopArrays] = None, folder: Optional[Path] = None,
                 verify: bool = True, frames: Optional[Tuple[int, int]] = None) -> None:
        self._scene, self._native, self._folder = scene, native, folder
        self._frames = frames  # of the scene's loop; None: all
        self._closed = False
        self._kept: Dict[Any, Any] = {}
        if folder is not None:
            self._manifest = _manifest(folder, verify)
            self._files = RenderFiles(folder, self._manifest, verify)

    # Where things come from.

    def _source(self) -> Optional[_echocine.LoopArrays]:
        if self._closed:
            raise ValueError("loop: is closed, accepted: an open loop; arrays taken before stay valid")
        return self._native

    def _once(self, name: Any, make: Any) -> Any:
        self._source()
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    def _named(self, name: str, remedy: str) -> Any:
        native = self._source()
        assert native is not None
        found = self._once("arrays", lambda: native.arrays).get(name)
        if found is None:
            raise ValueError(f"{name}: the scene does not request it, accepted: {remedy}")
        return found

    def _truth_file(self, name: str, remedy: str) -> Path:
        assert self._folder is not None
        path = self._folder / "truth" / name
        if not path.exists():
            raise ValueError(f"{path}: is absent, accepted: {remedy}")
        return self._files.checked(f"truth/{name}")

    def _read_channel(self, name: str) -> NDArray[Any]:
        """(T, depth, line), any scale of half floats undone."""
        assert self._folder is not None
        m = self._manifest
        listed = m["scene"]["output"]["channels"]
        if name not in listed or not m["scene"]["output"]["exr"]:
            raise ValueError(f"{name}: is not in {self._folder / 'intensity'}, accepted: {', '.join(listed)}")
        probe = m["scene"]["probe"]
        for f in m["frames"]:
            self._files.checked(f"intensity/frame_{f['index']:04d}.exr")
        planes = [_echocine.read_exr(self._folder / "intensity", f["index"], name, m["scene_sha256"], probe["lines"],
                                     probe["samples"]) for f in m["frames"]]
        return np.stack(planes)

    # Arrays.

    def channel(self, name: str) -> NDArray[Any]:
        """(T, depth, line) float32 (uint32 of "medium.id" and "structure.id") of one of output.channels, such as "Y"."""
        native = self._source()
        if native is None:
            read: NDArray[Any] = self._once(("channel", name), lambda: self._read_channel(name))
            return read
        planes = self._once("channels", lambda: native.channels)
        if name not in planes:
            known = "".join(f"{plane}, " for plane in planes) + ("or " if planes else "")
            raise ValueError(f"{name}: the scene does not request it, accepted: {known}output.channels with \"{name}\" and "
                             "output.exr = true")
        plane: NDArray[Any] = planes[name]
        return plane

    @property
    def intensities(self) -> NDArray[np.float32]:
        """(T, depth, line) float32: received intensities, relative to the transmitted; the channel "Y"."""
        return self.channel("Y")

    @property
    def greys(self) -> NDArray[np.float32]:
        """(T, depth, line) float32: log-compressed, 0 black to 1 white. Of a folder: its channel "display.Y"."""
        if self._source() is None:
            return self.channel("display.Y")
        greys: NDArray[np.float32] = self._named("greys", "output.cine = true")
        return greys

    @property
    def images(self) -> NDArray[np.uint8]:
        """(T, H, W) uint8 pixels: the pictures. In memory without ECG and depth ticks; of a folder as its cine.avi plays."""
        if self._source() is None:
            assert self._folder is not None
            cine = self._folder / "cine.avi"
            if not cine.exists():
                raise ValueError(f"{cine}: is absent, accepted: a loop of a scene with output.cine = true")
            images: NDArray[np.uint8] = self._once("images", lambda: _echocine.read_video(self._files.checked("cine.avi")))
            return images
        images = self._named("images", "output.cine = true")
        return images

    @property
    def labels(self) -> NDArray[np.uint8]:
        """(T, H, W) uint8: the structure at each of the picture's pixels; 0 background. `label_names` has the numbers."""
        if self._source() is None:
            self._truth_file("labels.json", "truth=\"labels\"")
            assert self._folder is not None
            files = [f"truth/labels_{f['index']:04d}.png" for f in self._manifest["frames"]]
            labels: NDArray[np.uint8] = self._once("labels", lambda: np.stack([_png(self._files.checked(file)) for file in files]))
            return labels
        labels = self._named("labels", "truth=\"labels\"")
        return labels

    @property
    def label_names(self) -> Dict[int, str]:
        """What the numbers of `labels` are: number -> structure, or role where truth.labels names roles; 0 is left out."""
        if self._source() is None:
            file = self._truth_file("labels.json", "truth=\"labels\"")
            table = self._once("label_names", lambda: json.loads(file.read_text(encoding="utf-8"))["labels"])
            return {int(number): str(name) for number, name in table.items()}
        self._named("labels", "truth=\"labels\"")
        assert self._scene is not None
        given: Dict[str, int] = self._scene["truth.labels"] or {}
        if given:
            return {number: name for name, number in sorted(given.items(), key=lambda entry: entry[1])}
        return dict(enumerate((e["name"] for e in self._scene._native.structures if not e["membrane"]), 1))

    def _motion(self, kind: str) -> NDArray[np.float32]:
        if self._source() is None:
            planes: NDArray[np.float32] = self._once(
                kind, lambda: np.stack([self.channel(f"{kind}.{side}") for side in _SIDES], axis=1))
            return planes
        planes = self._named(kind, f"truth=\"{kind}\"")
        return planes

    @property
    def displacement(self) -> NDArray[np.float32]:
        """(T, 3, depth, line) float32, mm since the first frame: lateral, axial, elevation; NaN where nothing is known."""
        return self._motion("displacement")

    @property
    def velocity(self) -> NDArray[np.float32]:
        """(T, 3, depth, line) float32, mm/s: lateral, axial, elevation; NaN where nothing is known to move."""
        return self._motion("velocity")

    @property
    def velocity_beam(self) -> NDArray[np.float32]:
        """(T, depth, line) float32, m/s along the scan line, positive towards the probe; NaN where nothing is known to move."""
        if self._source() is None:
            read: NDArray[np.float32] = self._once("velocity_beam", lambda: self.channel("velocity.beam"))
            return read
        planes: NDArray[np.float32] = self._named("velocity_beam", "truth=\"velocity_beam\"")
        return planes

    @property
    def tracks(self) -> NDArray[np.float32]:
        """(T, N, 3) float32, mm: material points, lateral, elevation and depth from the probe's apex."""
        if self._source() is None:
            file = self._truth_file("tracks.npz", "truth=\"tracks\"")
            tracks: NDArray[np.float32] = self._once("tracks", lambda: _npz(file, "places_mm"))
            return tracks
        tracks = self._named("tracks", "truth=\"tracks\"")
        return tracks

    @property
    def strain(self) -> NDArray[np.float64]:
        """(T, 17, 3) float64: longitudinal, radial, circumferential, parts of the first frame's lengths, by segment."""
        native = self._source()
        if native is None:
            strain: NDArray[np.float64] = self._once("strain", self._read_strain)
            return strain
        found: Optional[NDArray[np.float64]] = self._once("strain", lambda: native.strain)
        if found is None:
            raise ValueError("strain: the scene does not request it, accepted: truth=\"function\"")
        return found

    def _function(self) -> Any:
        file = self._truth_file("function.json", "truth=\"function\"")
        return self._once("function", lambda: json.loads(file.read_text()))

    def _read_strain(self) -> NDArray[np.float64]:
        kinds = ("longitudinal", "radial", "circumferential")
        rows = [[[np.nan if s[k] is None else s[k] for k in kinds] for s in f["segments"]] for f in self._function()["frames"]]
        return np.array(rows, dtype=np.float64)

    # Curves.

    @property
    def times_s(self) -> NDArray[np.float64]:
        """(T,) float64, s from the loop's start."""
        return self._per_frame("time_s", "times_s")

    @property
    def phases(self) -> NDArray[np.float64]:
        """(T,) float64: phase of the beat, from 0 up to, without, 1; 0 at end-diastole."""
        return self._per_frame("phase", "phases")

    def _per_frame(self, key: str, name: str) -> NDArray[np.float64]:
        native = self._source()
        values: NDArray[np.float64] = self._once(
            name, lambda: np.array([f[key] for f in self._manifest["frames"]]) if native is None else getattr(native, name))
        return values

    @property
    def volumes(self) -> Dict[str, NDArray[np.float64]]:
        """Volumes of closed structures: name -> (T,) float64, mL."""
        native = self._source()
        if native is not None:
            volumes: Dict[str, NDArray[np.float64]] = self._once("volumes", lambda: native.volumes)
            return volumes
        frames = self._manifest["frames"]
        names = frames[0]["volumes_ml"] if frames else {}
        return {name: np.array([f["volumes_ml"][name] for f in frames]) for name in names}

    @property
    def curves(self) -> Dict[str, NDArray[np.float64]]:
        """How the left ventricle works: name with unit -> (T,) float64; empty without truth="function"."""
        native = self._source()
        if native is not None:
            curves: Dict[str, NDArray[np.float64]] = self._once("curves", lambda: native.curves)
            return curves
        found = self._manifest.get("curves") or {}
        return {name: np.array(values, dtype=np.float64) for name, values in found.items()}

    @property
    def contours(self) -> List[List[Dict[str, Any]]]:
        """Per frame a list of dicts: structure, closed, points_mm (n, 2) float64, lateral and depth from the apex, and visible (n,)
        bool, whether the picture shows the border at the point; None without a picture."""
        native = self._source()
        if native is not None:
            listed: List[List[Dict[str, Any]]] = self._once("contours", lambda: native.contours)
            if not listed:
                raise ValueError("contours: the scene does not request it, accepted: truth=\"contours\"")
            return listed
        read = []
        for f in self._manifest["frames"]:
            entries = json.loads(self._truth_file(f"contours_{f['index']:04d}.json", "truth=\"contours\"").read_text())["contours"]
            read.append([{"structure": e["structure"], "closed": e["closed"], "points_mm": np.array(e["points_mm"]),
                          "visible": np.array(e["visible"], bool) if "visible" in e else None} for e in entries])
        return read

    @property
    def reference_intensity(self) -> float:
        """White of the log compression, relative to the transmitted intensity."""
        native = self._source()
        return float(self._manifest["reference_intensity"]) if native is None else native.reference_intensity

    @property
    def scene(self) -> Optional[Scene]:
        """The scene it was rendered from; None of a folder that was opened."""
        return self._scene

    @property
    def folder(self) -> Optional[Path]:
        """Its folder; None in memory."""
        return self._folder

    @property
    def manifest(self) -> Dict[str, Any]:
        """manifest.json of its folder."""
        self._source()
        if self._folder is None:
            raise ValueError("manifest: the loop is in memory, accepted: a loop in a folder")
        manifest: Dict[str, Any] = self._manifest
        return manifest

    def __len__(self) -> int:
        return len(self.times_s)

    def close(self) -> None:
        """Lets go of memory; arrays that were taken stay valid. Anything asked for later is a ValueError."""
        self._closed, self._native, self._kept = True, None, {}

    def __enter__(self) -> "Loop":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._closed:
            return "<echocine.Loop, closed>"
        where = f"in {self._folder}" if self._folder is not None else "in memory"
        return f"<echocine.Loop of {len(self)} frames {where}>"

    def _repr_html_(self) -> str:
        from ._notebook import loop_html
        return loop_html(self)


def _manifest(folder: Path, verify: bool) -> Dict[str, Any]:
    file = folder / "manifest.json"
    try:
        text = file.read_bytes()
        manifest: Dict[str, Any] = json.loads(text.decode("utf-8"))
        for key in ("scene", "frames", "scene_sha256"):
            manifest[key]
    except OSError as error:
        raise SceneError(f"{file}: cannot be read ({error.strerror}), accepted: the folder of a finished render") from None
    except (ValueError, KeyError, TypeError):
        raise SceneError(f"{file}: is damaged, accepted: the folder of a finished render") from None
    if verify and not is_sealed(text):
        raise JobError(f"{file}: is not as it was written, or of an earlier version: render it again, or open with verify=False")
    return manifest


def _npz(file: Path, name: str) -> Any:
    with np.load(file) as arrays:
        return arrays[name]


def _png(file: Path) -> NDArray[np.uint8]:
    """Values of an 8-bit PNG of greys, or with a palette, as earlier label pictures had."""
    data = file.read_bytes()
    try:
        at, header, packed = 8, b"", b""
        while at < len(data):
            size, kind = struct.unpack_from(">I4s", data, at)
            if kind == b"IHDR":
                header = data[at + 8:at + 8 + size]
            elif kind == b"IDAT":
                packed += data[at + 8:at + 8 + size]
            at += 12 + size
        width, height, depth, colour = struct.unpack(">IIBB", header[:10])
        if depth != 8 or colour not in (0, 3):
            raise ValueError("is not 8-bit")
        rows = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(height, width + 1)
        return _unfiltered(rows)
    except (struct.error, zlib.error, ValueError) as error:
        raise JobError(f"{file}: is no label picture: {error}") from None


def _unfiltered(rows: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """PNG filters 0 to 4 (ISO/IEC 15948, 9.2) of one byte a pixel, undone."""
    out = np.zeros((len(rows), rows.shape[1] - 1), dtype=np.uint8)
    above = np.zeros(rows.shape[1] - 1, dtype=np.uint8)
    for y, row in enumerate(rows):
        kind, line = int(row[0]), row[1:]
        if kind == 0:
            out[y] = line
        elif kind == 1:
            out[y] = np.cumsum(line, dtype=np.uint8)
        elif kind == 2:
            out[y] = line + above
        else:
            out[y] = _left_dependent(kind, line.tolist(), above.tolist())
        above = out[y]
    return out


def _left_dependent(kind: int, line: List[int], above: List[int]) -> List[int]:
    left = corner = 0
    result = []
    for value, up in zip(line, above):
        if kind == 3:
            guess = (left + up) // 2
        else:
            p = left + up - corner
            near = (abs(p - left), abs(p - up), abs(p - corner))
            guess = (left, up, corner)[near.index(min(near))]
        left, corner = (value + guess) & 255, up
        result.append(left)
    return result


def _asking_for(scene: Scene, truth: Union[None, str, Sequence[str]]) -> Scene:
    """A copy that asks for truth too."""
    kinds = [truth] if isinstance(truth, str) else list(truth or ())
    for kind in kinds:
        if kind not in _TRUTH:
            raise SceneError(f"truth: \"{kind}\" is not a kind of truth, accepted: {', '.join(_TRUTH)}")
    asked = scene.copy()  # later changes of the scene are not those of the loop
    if not kinds:
        return asked
    changes: Dict[str, Any] = {}
    files = [k for k in kinds if k not in ("displacement", "velocity", "velocity_beam")]
    if files:
        was = scene["truth.write"] or []
        changes["truth.write"] = sorted({*([was] if isinstance(was, str) else was), *files})
    planes = [f"{k}.{side}" for k in ("displacement", "velocity") if k in kinds for side in _SIDES]
    if "velocity_beam" in kinds:
        planes.append("velocity.beam")
    if planes and not scene["output.exr"]:
        raise SceneError("truth: displacement and velocity are channels, accepted: with output.exr = true")
    if planes:
        changes["output.channels"] = [*scene["output.channels"], *planes]
    asked.update(changes)
    return asked


def render(scene: Scene, folder: Union[None, str, "os.PathLike[str]"] = None, *, frames: Optional[Tuple[int, int]] = None,
           truth: Union[None, str, Sequence[str]] = None, threads: int = 0, resume: bool = False, overwrite: bool = False,
           progress: Progress = None) -> Loop:
    """Renders a scene's loop.

    Args:
        scene: what is rendered; it is not changed.
        folder: where files go, as of the command ``echocine render``; None: into memory.
        frames: (A, B): only frames A up to, without, B, from 0.
        truth: besides what the scene asks for: "all", "labels", "contours", "tracks", "function", "displacement",
            "velocity", "velocity_beam", or several of them.
        threads: 0: one per core. The values do not depend on it.
        resume: keep a folder's frames that are whole and of this very scene.
        overwrite: replace the loop of another scene in the folder.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.

    Raises SceneError (the scene cannot be rendered) and JobError (the work failed); KeyboardInterrupt stops the work.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: is {type(scene).__name__}, accepted: an echocine.Scene")
    thread_count(threads)
    if frames is not None:
        try:
            first, end = (operator.index(frame) for frame in frames)
        except (TypeError, ValueError):
            raise ValueError(f"frames: is {frames!r}, accepted: two whole numbers, such as (0, 10)") from None
        frames = (first, end)
    asked = _asking_for(scene, truth)
    if folder is None:
        return Loop(asked, _echocine.render_in_memory(asked._native, frames, threads, report_to(progress)), frames=frames)
    path = Path(folder)
    _echocine.render_to_folder(asked._native, path, frames, threads, flag("resume", resume), flag("overwrite", overwrite), report_to(progress))
    return Loop(asked, folder=path)


def open(folder: Union[str, "os.PathLike[str]"], *, verify: bool = True) -> Loop:
    """A render's folder as a loop; files are read when they are asked for.

    Args:
        folder: of a finished render.
        verify: compare each file with its digest in the manifest before it is read; False for speed.

    Raises SceneError where there is no finished render; what is read raises JobError where a file is not as it was written.
    """
    return Loop(None, folder=Path(folder), verify=verify)
