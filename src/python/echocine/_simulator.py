"""One frame at a time."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Union, overload

import numpy as np
from numpy.typing import NDArray

from . import _echocine
from ._echocine import Frame
from ._errors import SceneError
from ._scene import Scene, _number


class Simulator:
    """Makes frames of a scene: reads its meshes and plans the loop once.

    Any number of threads may ask at the same time; the interpreter's lock is free meanwhile.
    """

    __slots__ = ("_scene", "_native", "_version")

    def __init__(self, scene: Scene) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: is {type(scene).__name__}, accepted: an echocine.Scene")
        self._scene, self._version = scene, scene._version
        self._native = _echocine.Simulator(scene._native)

    @overload
    def frame(self, time_s: float) -> Frame: ...

    @overload
    def frame(self, time_s: float, out: Frame) -> Frame: ...

    @overload
    def frame(self, time_s: float, out: Mapping[str, NDArray[Any]]) -> Mapping[str, NDArray[Any]]: ...

    def frame(self, time_s: float, out: Optional[Union[Frame, Mapping[str, NDArray[Any]]]] = None) -> Any:
        """The frame at an instant of the loop, s from 0 to its end. The same bytes as `render` gives that instant.

        Args:
            time_s: instant, s.
            out: an earlier frame of this simulator, which is filled again in its own memory, or arrays by name:
                "intensities", "greys" (depth, line) float32, "image", "labels" (H, W) uint8.

        Returns a new Frame, or `out`.
        """
        if self._scene._version != self._version:
            raise SceneError("scene: was changed after this Simulator was made, accepted: a new Simulator(scene), or a scene "
                             "that stays as it is, Simulator(scene.copy())")
        try:
            instant_s = _number("time_s", time_s)
        except SceneError as error:
            raise TypeError(str(error)) from None
        if out is None:
            return self._native.frame(instant_s)
        if isinstance(out, Frame):
            self._native.fill_frame(instant_s, out)
        elif isinstance(out, Mapping):
            self._native.fill_arrays(instant_s, dict(out))
        else:
            raise TypeError(f"out: is {type(out).__name__}, accepted: a Frame, or a dict of arrays by name")
        return out

    def contours(self, frame: Frame) -> List[Dict[str, Any]]:
        """A frame's contours: dicts of structure, closed, points_mm (n, 2) float64, lateral and depth from the apex, and visible (n,)
        bool, whether the picture shows the border at the point; None without a picture."""
        return self._native.contours(frame)

    @property
    def times_s(self) -> NDArray[np.float64]:
        """(T,) float64: instants of the loop's frames, s."""
        return self._native.times_s

    @property
    def scene(self) -> Scene:
        """The scene that frames are made of."""
        return self._scene

    @property
    def plan(self) -> str:
        """One line: tracer, effects that are on, effects that are off."""
        return self._native.plan

    @property
    def reference_intensity(self) -> float:
        """White of the log compression, relative to the transmitted intensity; traced at the first call."""
        return self._native.reference_intensity

    def __repr__(self) -> str:
        return f"<echocine.Simulator of {self._scene!r}: {self.plan}>"
