"""Models of hearts against a real loop, for optimisers."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _echocine
from ._errors import thread_count
from ._jobs import PathLike, _scene
from ._progress import Progress, report_to
from ._scene import Scene


def _numbers(argument: str, given: Any) -> NDArray[np.float64]:
    try:
        return np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{argument}: is {type(given).__name__}, accepted: an array of numbers") from None


def _number(argument: str, given: Any) -> float:
    try:
        if isinstance(given, (str, bytes, bool, np.bool_)):
            raise TypeError
        return float(given)
    except (TypeError, ValueError):
        raise ValueError(f"{argument}: is {given!r}, accepted: a number") from None


def _pair(dial: str, given: Any) -> Tuple[str, float, float]:
    try:
        low, high = given
    except (TypeError, ValueError):
        raise ValueError(f"ranges: {dial} is {given!r}, accepted: (least, most)") from None
    return dial.replace("_", "-"), _number(f"ranges: {dial}", low), _number(f"ranges: {dial}", high)


def _dashed(dials: Mapping[str, Any]) -> Dict[str, float]:
    return {name.replace("_", "-"): _number(f"dials: {name}", value) for name, value in dials.items()}


def _underscored(dials: Mapping[str, float]) -> Dict[str, float]:
    return {key.replace("-", "_"): value for key, value in dials.items()}


def _cache_folder(cache: Union[bool, PathLike]) -> Optional[Path]:
    if isinstance(cache, bool):
        folder = Path(_echocine.heart_cache()) if cache else Path()
        return folder if folder != Path() else None
    return Path(cache)


class ModelLoop:
    """A beat of a model in its imaging plane, in 20 frames from end-diastole: tissues and their boundaries.

    Args:
        scene: the model: its meshes, probe and media. `HeartFamily.at` gives models of dials.
        focus: "left_ventricle" for D of a fit: other chambers count 0.3, and edges of blood are expected 0.6 mm farther inside. "all" for that of comparisons.
        threads: 0: one per core.

    Attributes:
        tissue: (20, across, along) uint8, the medium that fills most of a cell: its number in `tissues`.
        cells_mm: (across, along, 2) float32, centres of the cells: lateral and depth from the probe's apex, mm.
        tissues, structures: names by number.
        systole: end-systole as a fraction of the beat; 0: unknown.
    """

    def __init__(self, scene: Scene, *, focus: str = "all", threads: int = 0) -> None:
        self._native = _echocine.ModelLoop(_scene(scene), focus, thread_count(threads))

    @classmethod
    def _of(cls, native: _echocine.ModelLoop) -> "ModelLoop":
        made = cls.__new__(cls)
        made._native = native
        return made

    @property
    def tissue(self) -> NDArray[np.uint8]:
        """(20, across, along) uint8: the medium that fills most of a cell."""
        return self._native.tissue

    @property
    def cells_mm(self) -> NDArray[np.float32]:
        """(across, along, 2) float32: centres of the cells, lateral and depth from the probe's apex, mm."""
        return self._native.cells_mm

    @property
    def tissues(self) -> List[str]:
        """Media by number, the background first."""
        return self._native.tissues

    @property
    def structures(self) -> List[str]:
        """Structures by number."""
        return self._native.structures

    @property
    def systole(self) -> float:
        """End-systole as a fraction of the beat; 0: unknown."""
        return self._native.systole

    def boundary(self, frame: int) -> Tuple[NDArray[np.float32], NDArray[np.uint16]]:
        """Pieces of the visible boundaries of a frame, from 0: centres (N, 2) in mm, and the number of their structure (N,)."""
        return self._native.boundary(frame)


class HeartFamily:
    """Hearts of one view between computed ones: another heart takes milliseconds instead of a second.

    Up to three dials: hearts are computed at Chebyshev nodes of each dial. Between the nodes, surfaces are polynomials.
    Four to sixteen dials: one polynomial through the hearts of a fit, 23 to 125. An impossible one moves towards the centre of the ranges.

    Args:
        ranges: dial -> (least, most), up to sixteen. The order is that of `at`'s values.
        view: where the probe is held, such as "a4c".
        nodes: computed hearts per dial, 2 to 9, at most 125 hearts; None: 4, with three ranges 3, with more the hearts of a fit.
        tilt_deg: limit of tilt and rotation of the plane, either way, 0 to 20.
        cache: True: hearts of four dials or more are kept in the user's cache folder; a path: in this folder; False: nowhere.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.
        dials: fixed dials, such as ``hr=72``.

    Raises SceneError for dials that no heart fulfils.
    """

    def __init__(self, ranges: Mapping[str, Tuple[float, float]], view: str = "a4c", *, nodes: Optional[int] = None, tilt_deg: float = 0,
                 cache: Union[bool, PathLike] = True, threads: int = 0, progress: Progress = None, **dials: float) -> None:
        if not isinstance(ranges, Mapping):
            raise ValueError(f"ranges: is {type(ranges).__name__}, accepted: dial -> (least, most)")
        pairs = [_pair(str(dial), pair) for dial, pair in ranges.items()]
        self._native = _echocine.HeartFamily(pairs, view, _dashed(dials), nodes, tilt_deg, _cache_folder(cache), thread_count(threads), report_to(progress))

    @property
    def ranges(self) -> Dict[str, Tuple[float, float]]:
        """Dial -> (least, most), in the order of values."""
        return {key.replace("-", "_"): (low, high) for key, low, high in self._native.ranges}

    @property
    def nodes(self) -> int:
        """Computed hearts per dial; 0: those of a polynomial."""
        return self._native.nodes

    def at(self, values: ArrayLike, *, tilt_deg: float = 0, rotate_deg: float = 0, focus: str = "all", threads: int = 0) -> ModelLoop:
        """The heart at one value per range, (ranges,) float64. Angles are within the family's tilt_deg; focus: see `ModelLoop`. Thread-safe."""
        return ModelLoop._of(self._native.at(_numbers("values", values), tilt_deg, rotate_deg, focus, thread_count(threads)))


class HeartPrior:
    """The distribution of hearts before a loop is known: healthy hearts and hearts with an infarct, in equal parts.

    Attributes:
        mean, sd: of its dials, by name.
    """

    def __init__(self) -> None:
        self._native = _echocine.HeartPrior()

    def log_density(self, **dials: float) -> float:
        """ln p of Eq. 14 for a heart of these dials, up to a constant. Other dials have their defaults.

        ef, edv, wall_thickness, sphericity, mapse and conicity are distributed jointly. la_volume, apical_motion, rv_ratio,
        bows, ellipticities and ratios of thickness are independent and count where they are given. Raises SceneError for a dial out of its range.
        """
        return self._native.log_density(_dashed(dials))

    def draw(self, seed: int, number: int) -> Dict[str, float]:
        """The jointly distributed dials of one random heart. A dial may lie beyond its range."""
        return _underscored(self._native.draw(seed, number))

    @property
    def mean(self) -> Dict[str, float]:
        """By dial; of independent dials the median."""
        return _underscored(self._native.mean)

    @property
    def sd(self) -> Dict[str, float]:
        """By dial."""
        return _underscored(self._native.sd)


class PoseFound:
    """The pose of lowest D.

    Attributes:
        discrepancy: D, 0 equal, about 1 for a model that explains nothing.
        pose: (6,) float64: shift_x_mm, shift_z_mm, turn_deg, scale, lag (pictures), systole (0: the loop's).
        terms: region, boundary, motion and overlap.
        rivals: (R, 7) float64: other optima, poses with their D.
        confidence: 0 another place fits as well, 1 no other place fits; 0 without a search everywhere.
        at_limit: the pose is at the limit of its search.
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.discrepancy: float = found["discrepancy"]
        self.pose: NDArray[np.float64] = found["pose"]
        self.terms: Dict[str, float] = dict(zip(ModelDiscrepancy.TERMS, map(float, found["terms"])))
        self.rivals: NDArray[np.float64] = found["rivals"]
        self.confidence: float = found["confidence"]
        self.at_limit: bool = found["at_limit"]

    def __repr__(self) -> str:
        return f"<echocine.PoseFound: discrepancy {self.discrepancy:.4f}, confidence {self.confidence:.2f}>"


class ModelDiscrepancy:
    """The discrepancy D between a real loop and models: built once, called for each model and pose. Grey levels of models are not used.

    Args:
        real: a loop that ``compare`` reads, or a render's folder.
        first: a model of roughly the right heart and view. It gives the start of the beat where neither the file nor `side` has it.
        side: what is known better than the file tells, as for `compare`.
        weights: of the terms region, boundary and motion in D.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.

    Attributes:
        beat: start, length and end-systole of the real beat in frames, with their sources and confidences.
    """

    #: Columns of a pose.
    POSE = ("shift_x_mm", "shift_z_mm", "turn_deg", "scale", "lag", "systole")
    #: Terms of D and the overlap of model and sector.
    TERMS = ("region", "boundary", "motion", "overlap")

    def __init__(self, real: PathLike, first: ModelLoop, *, side: Optional[Mapping[str, Any]] = None,
                 weights: Sequence[float] = (0.5, 0.3, 0.2), threads: int = 0, progress: Progress = None) -> None:
        self._native = _echocine.ModelDiscrepancy(Path(real), _model("first", first), dict(side or {}),
                                                  list(_numbers("weights", weights).ravel()), thread_count(threads), report_to(progress))
        self.beat: Dict[str, Any] = self._native.beat

    def __call__(self, model: ModelLoop, poses: ArrayLike) -> Any:
        """D at poses, without a search: (P, 6) gives (P,) float64, (6,) a float. Thread-safe."""
        values = self._native.terms(_model("model", model), _numbers("poses", poses))[:, 0]
        return float(values[0]) if np.ndim(poses) == 1 else values

    def terms(self, model: ModelLoop, poses: ArrayLike) -> NDArray[np.float64]:
        """The terms at poses, (P, 4) float64 in the order of `TERMS`; of one pose (4,). Thread-safe."""
        values: NDArray[np.float64] = self._native.terms(_model("model", model), _numbers("poses", poses))
        return values[0, 1:] if np.ndim(poses) == 1 else values[:, 1:]

    def residuals(self, model: ModelLoop, pose: ArrayLike) -> NDArray[np.float64]:
        """D at one pose (6,) as residuals: the sum of their squares is 1 + D. Thread-safe.

        Their number is the same for all models of one family, so a least-squares optimiser can use them.
        """
        return self._native.residuals(_model("model", model), _numbers("pose", pose))

    def residual_columns(self, model_of: Callable[[NDArray[np.float64]], ModelLoop], values: ArrayLike, steps: ArrayLike,
                         pose: ArrayLike) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Residuals of ``model_of(values)`` at a pose, and their columns (residuals, values + 4).

        Columns are the derivatives by each value, then by shift_x_mm, shift_z_mm, turn_deg and scale: central differences of
        width 2 * step. Tissues of cells change in steps, so a step must move a boundary by about half a millimetre.

        Args:
            model_of: any shape model: values (V,) -> ModelLoop, all with the same structures, such as ``family.at``.
            values: (V,) float64.
            steps: (V,) float64, positive.
            pose: (6,) float64.
        """
        at, step, place = _numbers("values", values), _numbers("steps", steps), _numbers("pose", pose)
        if step.shape != at.shape or at.ndim != 1 or not np.all(step > 0):
            raise ValueError(f"steps: accepted: {at.size} positive numbers, one for each value")
        middle = model_of(at)
        columns: List[NDArray[np.float64]] = []
        for column, width in enumerate(step):
            move = np.zeros_like(at)
            move[column] = width
            columns.append((self.residuals(model_of(at + move), place) - self.residuals(model_of(at - move), place)) / (2 * width))
        for column, width in enumerate((0.5, 0.5, 0.5, 0.005)):
            move = np.zeros(6)
            move[column] = width
            columns.append((self.residuals(middle, place + move) - self.residuals(middle, place - move)) / (2 * width))
        return self.residuals(middle, place), np.stack(columns, axis=1)

    def search(self, model: ModelLoop, starts: Optional[ArrayLike] = None, *, threads: int = 0) -> PoseFound:
        """The pose of lowest D, searched everywhere and from `starts` (P, 6). Thread-safe."""
        return self._search(model, starts, True, threads)

    def refine(self, model: ModelLoop, starts: ArrayLike, *, threads: int = 0) -> PoseFound:
        """The pose of lowest D near `starts`, (P, 6) or (6,): for a model close to one of known pose. Thread-safe."""
        return self._search(model, starts, False, threads)

    def _search(self, model: ModelLoop, starts: Optional[ArrayLike], everywhere: bool, threads: int) -> PoseFound:
        from_poses = None if starts is None else _numbers("starts", starts)
        return PoseFound(self._native.search(_model("model", model), from_poses, everywhere, thread_count(threads)))


def _model(argument: str, model: Any) -> _echocine.ModelLoop:
    if not isinstance(model, ModelLoop):
        raise TypeError(f"{argument}: is {type(model).__name__}, accepted: an echocine.ModelLoop, as HeartFamily.at gives it")
    return model._native
