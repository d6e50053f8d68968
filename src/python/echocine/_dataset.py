"""Datasets: many loops with truth from a spec, made and read back."""

from __future__ import annotations

import csv
import json
import os
import warnings
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _echocine, _toml
from ._errors import SceneError, SceneWarning, thread_count, whole_number
from ._progress import Progress, report_to
from ._verify import HeartFiles

PathLike = Union[str, "os.PathLike[str]"]
Spec = Union[str, "os.PathLike[str]", Mapping[str, Any]]

_DISTRIBUTIONS = {"uniform", "whole", "normal", "choice"}


def _value(text: str) -> Any:
    """A cell as what it is: a number, a truth value, a text, or None where it is empty."""
    if text in ("", "true", "false"):
        return {"": None, "true": True, "false": False}[text]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def _rows(file: Path) -> List[Dict[str, Any]]:
    with open(file, newline="", encoding="utf-8") as text:
        return [{k: _value(v) for k, v in row.items()} for row in csv.DictReader(text)]


class DatasetLoop:
    """One loop of a dataset: its row of the table at once, its files when they are asked for.

    Arrays are those of the layout "native"; without it `images` are the small ones of "echonet", and truth is
    refused with a ValueError. T frames, (H, W) pixels, places in pixels, times in s, volumes in mL.

    Attributes:
        id: its name in all layouts.
        row: its row of loops.csv: split, view, ed_frame, es_frame, edv_ml, ef_percent and every number drawn.
    """

    def __init__(self, folder: Path, row: Dict[str, Any], files: HeartFiles) -> None:
        self._folder, self._files = folder, files
        self.row = row
        self.id = str(row["id"])
        self._kept: Dict[str, Any] = {}

    def _once(self, name: str, make: Any) -> Any:
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    def _file(self, name: str) -> Path:
        file = self._folder / "native" / self.id / name
        if not file.exists():
            raise ValueError(f"{name}: {self.id} has none, accepted: a dataset with the layout \"native\"")
        return self._files.checked(self.row.get("heart"), f"native/{self.id}/{name}")

    @property
    def images(self) -> NDArray[np.uint8]:
        """(T, H, W) uint8: the pictures, without ECG and depth ticks."""
        def read() -> NDArray[np.uint8]:
            small = self._folder / "echonet" / "Videos" / f"{self.id}.avi"
            native = self._folder / "native" / self.id / "cine.avi"
            if small.exists() and not native.exists():
                return _echocine.read_video(self._files.checked(self.row.get("heart"), f"echonet/Videos/{self.id}.avi"))
            return _echocine.read_video(self._file("cine.avi"))

        images: NDArray[np.uint8] = self._once("images", read)
        return images

    @property
    def truth(self) -> Dict[str, NDArray[Any]]:
        """Every array of truth.npz by name.

        time_s, phase, lv_volume_ml, ecg (T,) float32; labels (T, H, W) uint8; of each role contour_ROLE (P, 2) float32,
        pixels, contour_ROLE_starts (C, 2) int32, the frame and the first point of each contour, and contour_ROLE_visible (P,)
        uint8, 1 where the picture shows the border; track_px (T, N, 2) float32,
        track_out_of_plane_mm (T, N) float32, track_visible (T, N) uint8, track_layer and track_segment (N,) uint8.
        """
        def read() -> Dict[str, NDArray[Any]]:
            with np.load(self._file("truth.npz")) as arrays:
                return dict(arrays)

        truth: Dict[str, NDArray[Any]] = self._once("truth", read)
        return truth

    def _array(self, name: str, remedy: str) -> NDArray[Any]:
        if name not in self.truth:
            raise ValueError(f"{name}: the spec does not ask for it, accepted: {remedy}")
        return self.truth[name]

    @property
    def labels(self) -> NDArray[np.uint8]:
        """(T, H, W) uint8: 0 background, 1 lv_cavity, 2 lv_wall, 3 la."""
        return self._array("labels", "truth = [\"labels\"]")

    @property
    def tracks(self) -> NDArray[np.float32]:
        """(T, N, 2) float32, pixels: material points of the wall."""
        return self._array("track_px", "truth = [\"tracks\"]")

    @property
    def times_s(self) -> NDArray[np.float32]:
        """(T,) float32, s from the loop's start."""
        return self._array("time_s", "the layout \"native\"")

    @property
    def volume_ml(self) -> NDArray[np.float32]:
        """(T,) float32, mL: the left ventricle's cavity, exact, of the mesh."""
        return self._array("lv_volume_ml", "the layout \"native\"")

    @property
    def details(self) -> Dict[str, Any]:
        """loop.json: numbers, what was drawn, the left ventricle's function, and the scene in SI."""
        details: Dict[str, Any] = self._once("details", lambda: json.loads(self._file("loop.json").read_text(encoding="utf-8")))
        return details

    def __repr__(self) -> str:
        return f"<echocine.DatasetLoop {self.id}: {self.row['frames']} frames, EF {self.row['ef_percent']:.0f} %, {self.row['split']}>"


class Dataset:
    """A dataset's folder, as `dataset` or the command ``echocine dataset`` makes it. Loops are read when they are asked for.

        data = echocine.Dataset("my_data")
        data.table["ef_percent"]            # (N,) float64, one entry a loop
        for loop in data.split("train"):
            loop.images, loop.labels        # (T, H, W) uint8

    ``data[3]`` and ``data["ec000004_a4c"]`` are single loops.

    Args:
        folder: of the dataset. Parts of it that wait for the others have no tables yet: they have no loops.
        verify: compare each file with its digest in the heart's record before it is read; a JobError names one that is not as it
            was written. False for speed.

    Attributes:
        folder: its path.
        made: what the call of `dataset` that returned it made or kept: loops, bytes, kept (hearts already finished),
            impossible (draws), failed (hearts); of `join_datasets`: hearts, loops, failed. Empty of a folder that was opened.
    """

    def __init__(self, folder: PathLike, *, verify: bool = True) -> None:
        self.folder = Path(folder)
        self._files = HeartFiles(self.folder, verify)
        self.made: Dict[str, int] = {}
        self._rows: Optional[List[Dict[str, Any]]] = None
        if not self.folder.is_dir():
            raise SceneError(f"{self.folder}: is no folder, accepted: the folder of a dataset")

    def _table_file(self, name: str) -> Path:
        file = self.folder / name
        if not file.exists():
            raise ValueError(f"{file}: is not there, accepted: a dataset whose parts are merged (dataset(..., merge=True))")
        return file

    @property
    def rows(self) -> List[Dict[str, Any]]:
        """loops.csv: a dict per loop, column -> number, text, or None where the cell is empty. Units stand in the columns' names."""
        if self._rows is None:
            self._rows = _rows(self._table_file("loops.csv"))
        return self._rows

    @property
    def table(self) -> Dict[str, NDArray[Any]]:
        """loops.csv by column: name -> (N,) float64 where it holds numbers (NaN: empty), else (N,) texts."""
        names = list(self.rows[0]) if self.rows else []
        return {name: _column([row[name] for row in self.rows]) for name in names}

    @property
    def impossible(self) -> List[Dict[str, Any]]:
        """Draws that no heart fulfilled: heart, attempt, reason."""
        return _rows(self._table_file("impossible.csv"))

    @property
    def failed(self) -> List[Dict[str, Any]]:
        """Hearts that could not be made: heart, seed, reason."""
        return _rows(self._table_file("failed.csv"))

    @property
    def details(self) -> Dict[str, Any]:
        """dataset.json: name, licence, counts, and distributions with their sources."""
        details: Dict[str, Any] = json.loads(self._table_file("dataset.json").read_text(encoding="utf-8"))
        return details

    def split(self, name: str) -> List[DatasetLoop]:
        """The loops of "train", "val" or "test", in their order."""
        if name not in ("train", "val", "test"):
            raise ValueError(f"name: is {name!r}, accepted: \"train\", \"val\" or \"test\"")
        return [loop for loop in self if loop.row["split"] == name]

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, loop: Union[int, str]) -> DatasetLoop:
        if not isinstance(loop, str):
            return DatasetLoop(self.folder, self.rows[loop], self._files)
        for row in self.rows:
            if row["id"] == loop:
                return DatasetLoop(self.folder, row, self._files)
        raise KeyError(f"{loop}: is no loop of {self.folder}")

    def __iter__(self) -> Iterator[DatasetLoop]:
        return (DatasetLoop(self.folder, row, self._files) for row in self.rows)

    def __repr__(self) -> str:
        if not (self.folder / "loops.csv").exists():
            return f"<echocine.Dataset in {self.folder}, not merged>"
        return f"<echocine.Dataset of {len(self)} loops in {self.folder}>"

    def _repr_html_(self) -> str:
        from ._notebook import table_html
        if not (self.folder / "loops.csv").exists():
            return table_html([], [], repr(self)[1:-1])
        shown = ("id", "split", "population", "view", "frames", "edv_ml", "esv_ml", "ef_percent")
        cells = [[f"{r[k]:.1f}" if isinstance(r[k], float) else str(r[k]) for k in shown] for r in self.rows[:10]]
        return table_html(list(shown), cells, f"{len(self)} loops in {self.folder}, the first {len(cells)}")


def _column(values: List[Any]) -> NDArray[Any]:
    if all(v is None or isinstance(v, (bool, int, float)) for v in values):
        return np.array([np.nan if v is None else v for v in values], dtype=np.float64)
    return np.array(["" if v is None else str(v) for v in values])


def _dials(table: Dict[str, Any]) -> Dict[str, Any]:
    """With the names that specs have for what `dials()` lists."""
    return {k.replace("_", "-"): v for k, v in table.items()}


def _sections(tables: Mapping[str, Any], path: Tuple[str, ...] = ()) -> str:
    """As spec files are written, so that the same spec has the same digest: every table has its header, but distributions."""
    def apart(value: Any) -> bool:
        return isinstance(value, dict) and not _DISTRIBUTIONS & set(value)

    own = {k: v for k, v in tables.items() if not apart(v)}
    text = _toml.section_of(path, own) if path else _toml.text_of(own)
    return text + "".join(_sections(v, (*path, k)) for k, v in tables.items() if apart(v))


def _spec(spec: Spec) -> Tuple[Optional[str], Path]:
    """Its text, or None where it is a file's, and what errors call it."""
    if isinstance(spec, Mapping):
        tables = {str(k): _toml.plain(v, str(k)) for k, v in spec.items()}
        if isinstance(tables.get("heart"), dict):
            tables["heart"] = _dials(tables["heart"])
        if isinstance(tables.get("population"), dict):
            tables["population"] = {k: _dials(v) if isinstance(v, dict) else v for k, v in tables["population"].items()}
        return _sections(tables), Path("dataset")
    if isinstance(spec, str) and "\n" in spec:
        return spec, Path("dataset")
    if isinstance(spec, (str, os.PathLike)):
        return None, Path(spec)
    raise TypeError(f"spec: is {type(spec).__name__}, accepted: a path, TOML text or a dict")


def _pixel_mm(loop: PathLike, mm: Any) -> float:
    if isinstance(mm, (bool, np.bool_)) or not isinstance(mm, (int, float, np.number)) or not 0.01 <= mm <= 10:
        raise ValueError(f"real: {loop} has {mm!r}, accepted: 0.01 to 10 mm per pixel")
    return float(mm)


def dataset(spec: Spec, folder: PathLike, *, task: Optional[Tuple[int, int]] = None, merge: bool = False, fast: bool = False,
            real: Optional[Mapping[PathLike, float]] = None, threads: int = 0, progress: Progress = None) -> Dataset:
    """Makes many loops with truth, drawn from a spec, as ``echocine dataset`` does.

    The same call again goes on where one was stopped: hearts that are finished are kept. A draw depends on no thread, task
    or order, so the files are the same bytes however they are made.

        data = echocine.dataset({"hearts": 10, "views": ["a4c"], "heart": {"ef": {"uniform": [0.3, 0.7]}}}, "my_data")
        data.table["ef_percent"], data[0].images

    Args:
        spec: a spec file's path, its TOML text (with a line break), or a dict of its tables. Required are ``hearts``, how
            many, and ``views``, such as ["a4c", "a2c"]. ``layouts``: "native", "echonet", "camus", "nnunet",
            "pointodyssey", "myotracker", "dicom", "webdataset"; ``truth``: "labels", "contours", "function", "tracks". ``heart`` has dials as `dials()` lists
            them, ``scene`` tables of a scene's keys. Where a number may stand, a distribution may:
            {"uniform": [0.4, 0.7]}, {"whole": [50, 90]}, {"normal": [0.6, 0.05], "within": [0.5, 0.7]},
            {"choice": ["good", "poor"], "weights": [0.7, 0.3]}.
        folder: of the dataset.
        task: (k, n): only the k-th of n parts, from 1. Tables wait for the merge.
        merge: make nothing: prove that all parts are there, byte by byte, and write tables and lists.
        fast: with merge, prove files by their sizes alone.
        real: with merge, real loops and their mm per pixel: {"real.avi": 0.31, ...}, two or more. The card and ``details["real_loops"]``
            state how well a linear classifier distinguishes the dataset from them.
        threads: 0: one per core.
        progress: None, True, a function (done, total) that counts hearts, or a bar as tqdm makes them.

    Raises SceneError (the spec, or a folder of another spec) and JobError (files cannot be written, hearts are missing).
    """
    thread_count(threads)
    if real is not None and not merge:
        raise ValueError("real: is given without merge, accepted: with merge=True")
    loops = [(Path(loop), _pixel_mm(loop, mm)) for loop, mm in (real or {}).items()]
    if task is not None:
        if merge:
            raise ValueError("merge: is True and a task is given, accepted: one of them")
        if not isinstance(task, (tuple, list)) or len(task) != 2:
            raise ValueError(f"task: is {task!r}, accepted: (k, n), the k-th of n parts, from 1")
        whole_number("task: n", task[1], 1, 2**31 - 1)
        whole_number("task: k", task[0], 1, task[1])
    text, file = _spec(spec)
    path = Path(folder)
    made: Dict[str, int] = {}
    try:
        if not merge:
            part = (1, 1) if task is None else (task[0], task[1])
            made = _echocine.make_dataset(text, file, path, part, threads, report_to(progress))
        if task is None:
            merged = _echocine.merge_dataset(text, file, path, fast or not merge, threads, loops)
            made = made or merged
    except SceneError as error:
        raise (error.without_line() if isinstance(spec, Mapping) else error) from None
    found = Dataset(path)
    found.made = made
    return found


def join_datasets(parts: Sequence[PathLike], folder: PathLike, *, name: Optional[str] = None, progress: Progress = None) -> Dataset:
    """Joins finished datasets of different specs or seeds in a new folder, as ``echocine dataset --join`` does.

        both = echocine.join_datasets(["healthy", "infarcts"], "both", name="healthy and infarcts")
        both.table["joined.part"]           # 1 or 2

    Hearts of the first part keep their numbers, those of the next part follow. Splits are kept; the parts are not changed.
    The same call resumes an interrupted join. A SceneWarning names the layouts that not all parts have: they are left out.

    Args:
        parts: two or more folders of finished datasets of this program version.
        folder: of the joined dataset: new, empty, or of an interrupted join of the same parts.
        name: of the joined dataset, one line; None: the names of the parts, joined by " + ".
        progress: None, True, a function (done, total) that counts hearts, or a bar as tqdm makes them.

    Raises SceneError before anything is written (parts that share a heart, have no common layout, another kind of EF or of
    nnU-Net labels, or missing hearts) and JobError (a damaged file, a folder that cannot be written, a stop).
    """
    if isinstance(parts, (str, bytes, os.PathLike)):
        raise TypeError("parts: is one path, accepted: a list of two or more folders")
    path = Path(folder)
    made, left_out = _echocine.join_datasets([Path(part) for part in parts], path, name, report_to(progress))
    if left_out:
        warnings.warn(f"left out, because not all parts have them: {', '.join(left_out)}", SceneWarning, stacklevel=2)
    joined = Dataset(path)
    joined.made = made
    return joined


def preview_dataset(spec: Spec, page: PathLike, hearts: int = 16, *, threads: int = 0, progress: Progress = None) -> Dict[str, float]:
    """A look at a dataset before it is made: a page, and a contact sheet (PNG) of the same name beside it.

    Args:
        spec: as of `dataset`.
        page: file that ends in .html.
        hearts: shown at end-diastole and end-systole, 1 to 1000.
        threads: 0: one per core.
        progress: None, True, a function (done, total) that counts hearts, or a bar as tqdm makes them.

    Returns what the whole dataset takes by its first heart: seconds (s, on these threads) and bytes; and of the page hearts,
    and impossible, the draws before them that no heart fulfilled.
    """
    whole_number("hearts", hearts, 1, 1000)
    thread_count(threads)
    path = Path(page)
    if path.suffix != ".html":
        raise SceneError(f"page: is \"{path}\", accepted: a name that ends in .html")
    text, file = _spec(spec)
    try:
        numbers: Dict[str, float] = _echocine.preview_dataset(text, file, path, hearts, threads, report_to(progress))
    except SceneError as error:
        raise (error.without_line() if isinstance(spec, Mapping) else error) from None
    return numbers
