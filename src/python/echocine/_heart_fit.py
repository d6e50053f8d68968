"""A beating heart from echo loops."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _echocine
from ._errors import flag, texts, thread_count
from ._fit import _cache_folder, _dashed, _number, _underscored
from ._jobs import PathLike
from ._progress import Progress, report_to
from ._scene import Scene, heart

# SD of a normal distribution's central 90 %.
_NINETY = 1.645


class Interval(NamedTuple):
    """A value and its 90 % interval."""

    value: float
    low: float
    high: float


class HeartFit:
    """A heart fitted to echo loops.

    Attributes:
        result: "ef", "edv_ml", "esv_ml" and "gls" (global longitudinal strain, negative) -> Interval. None where the loops
            do not determine it: then `refusal` has the reason, or a loop has no length scale.
        dials: dial -> value of the found heart, searched and fixed ones.
        intervals: searched dial -> Interval. Without a length scale only dials that are ratios.
        rivals: other hearts, each a dict: "ef", "cost_above" (J above the best), and "dials" with a length scale.
        hints: why the result is uncertain and what would help, one line each.
        refusal: why there is no result; empty with one.
        stopped: the fit was stopped: the best heart until then.
        curves: "phase", and the volume of the left ventricle with its interval, (50,) float64: "lv_ml", "low_ml" and
            "high_ml"; without a length scale "lv_per_edv", "low" and "high". The same of the strain: "gls", "gls_low",
            "gls_high". Empty without a result.
        views: dict of each loop: its fit, plane and beat, as in fit.json.
        details: all of it, as in fit.json.
    """

    def __init__(self, details: Dict[str, Any], curves: str, dials: Mapping[str, float]) -> None:
        self.details = details
        numbers: Dict[str, Any] = details["result"]
        self.result: Dict[str, Optional[Interval]] = {
            key: None if numbers[key] is None else Interval(**numbers[key]) for key in ("ef", "edv_ml", "esv_ml", "gls")}
        self.dials: Dict[str, float] = _underscored(dials)
        self.intervals: Dict[str, Interval] = {
            dial["dial"].replace("-", "_"): Interval(dial["value"], dial["value"] - _NINETY * dial["sd"],
                                                     dial["value"] + _NINETY * dial["sd"]) for dial in details["dials"]}
        self.rivals: List[Dict[str, Any]] = details["rivals"]
        self.hints: List[str] = details["hints"]
        self.refusal: str = details["refusal"] or ""
        self.stopped: bool = details["stopped"]
        self.views: List[Dict[str, Any]] = details["views"]
        rows = list(csv.DictReader(io.StringIO(curves)))
        self.curves: Dict[str, NDArray[np.float64]] = {
            key: np.array([float(row[key]) for row in rows]) for key in (rows[0] if rows else ())}

    @property
    def scene(self) -> Scene:
        """The found heart as a scene in the first loop's view."""
        given: Dict[str, Any] = {"view": self.views[0]["view"], **self.dials}
        return heart(**given)

    def __repr__(self) -> str:
        if self.refusal:
            return f"<echocine.HeartFit: no result: {self.refusal}>"
        texts = [f"{key} {number.value:.3g} ({number.low:.3g} to {number.high:.3g})"
                 for key, number in self.result.items() if number is not None]
        return f"<echocine.HeartFit: {', '.join(texts)}>"


Loops = Union[Mapping[str, PathLike], Sequence[PathLike]]
Sides = Union[None, Mapping[str, Mapping[str, Any]], Sequence[Mapping[str, Any]]]


def fit(loops: Loops, folder: Optional[PathLike] = None, *, side: Sides = None,
        searched: Optional[Sequence[str]] = None, tilt_deg: float = 12, starts: int = 12, descents: int = 2, own_look: Optional[bool] = None, own_loops: bool = True,
        resamples: int = 0, cache: Union[bool, PathLike] = True, resume: bool = False, threads: int = 0, progress: Progress = None, **dials: float) -> HeartFit:
    """Fits a beating heart to one to three echo loops, as ``echocine fit`` does.

    Args:
        loops: view -> a loop that ``compare`` reads, such as ``{"a4c": "a4c.dcm"}``.
            Or a list of them: their views are ranked, 36 s of one core each, and refused if they are unclear.
        folder: for fit.json, fit.html, curves.csv and heart/ (meshes and scene); None: no files.
        side: view -> what is known better than the file tells, as for `compare`: mm_per_pixel, fps, ed_frame, ...
            For a list of loops, a list.
        searched: dials that are searched, of ef, edv, wall_thickness, sphericity, mapse, conicity, apical_motion,
            rv_ratio (right over left ventricle's volume), bow_lateral, bow_anterior, ellipticity, ellipticity_45,
            apical_thickness, lateral_thickness, anterior_thickness and la_volume;
            None: the first five, with two loops the first six, with three all but the last, or the first eight without own_look.
            Other dials have the values given, or their defaults.
        tilt_deg: limit of tilt and rotation of each plane, either way, 0 (none) to 20.
        starts: hearts that are compared first.
        descents: searches, from the best of them.
        own_look: measures in rendered loops of the found heart where its edges and which grey levels are seen, and polishes the fit with them.
            Takes five times as long. None: with two or three loops, or one with a persistence of 0.4 or more.
        own_loops: fits the found heart's own rendered loops too, for regions and the error of such a fit.
        resamples: fits again without each of so many blocks of the beat, 4 to 10: intervals include their spread; 0: none.
        cache: keeps computed hearts in the user's cache folder and reads them there; a path: in this folder; False: does neither.
        resume: continues a stopped fit in the folder.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.
        dials: fixed dials, such as ``hr=72``; they are not searched.

    Raises SceneError for loops, views or dials that cannot be used. A heart that the loops do not determine is no error:
    `HeartFit.refusal` has the reason. Ctrl-C raises KeyboardInterrupt; the folder then has the best heart so far.
    """
    given = _given(loops, side)
    fixed = _dashed(dials)
    keys = None if searched is None else [str(name).replace("_", "-") for name in texts("searched", searched)]
    text, curves, found = _echocine.fit(given, None if folder is None else Path(folder), fixed, keys, tilt_deg, starts, descents,
                                        own_look, flag("own_loops", own_loops), resamples, _cache_folder(cache), flag("resume", resume), thread_count(threads), report_to(progress))
    return HeartFit(json.loads(text), curves, found)


def _given(loops: Loops, side: Sides) -> List[Tuple[Optional[str], Path, Dict[str, Any]]]:
    if isinstance(loops, Mapping):
        if not isinstance(side, (Mapping, type(None))):
            raise ValueError(f"side: is {type(side).__name__}, accepted: view -> options of its loop")
        for view in side or {}:
            if view not in loops:
                raise ValueError(f"side: {view!r} has no loop, accepted: {', '.join(map(str, loops))}")
        return [(str(view), Path(file), _options(view, (side or {}).get(view, {}))) for view, file in loops.items()]
    if isinstance(loops, (str, bytes, Path)) or not isinstance(loops, Sequence):
        raise ValueError(f"loops: is {type(loops).__name__}, accepted: view -> file, such as {{\"a4c\": \"a4c.dcm\"}}, or a list of files")
    sides = [{}] * len(loops) if side is None else side
    if isinstance(sides, Mapping) or not isinstance(sides, Sequence) or len(sides) != len(loops):
        raise ValueError(f"side: is not a list of {len(loops)}, one for each loop, as loops have no views")
    return [(None, Path(file), _options(number, options)) for number, (file, options) in enumerate(zip(loops, sides))]


def _options(loop: Any, options: Any) -> Dict[str, Any]:
    if not isinstance(options, Mapping):
        raise ValueError(f"side: {loop} is {options!r}, accepted: options such as {{\"mm_per_pixel\": 0.21}}")
    return dict(options)
