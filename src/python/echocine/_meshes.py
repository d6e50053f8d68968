"""Keyframe meshes from arrays, and from the objects of other libraries by their attributes."""

from __future__ import annotations

from typing import Any, List, Mapping, Tuple

import numpy as np
from numpy.typing import NDArray

Mesh = Tuple[NDArray[np.float64], NDArray[np.int64]]

_ACCEPTED = ("accepted: (points [K, V, 3], faces [F, 3]), a mesh with .points or .vertices and .cells or .faces, "
             "or a list of such meshes, one per keyframe")


def _given(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{value.shape}, {value.dtype}"
    return type(value).__name__


def _numbers(name: str, what: str, value: Any) -> NDArray[Any]:
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name}: {what}: is no array ({error}), {_ACCEPTED}") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: {what}: is {array.shape}, {array.dtype}, accepted: numbers")
    return array


def points_of(name: str, value: Any) -> NDArray[np.float64]:
    """(K, V, 3) from (K, V, 3) or (V, 3)."""
    points = _numbers(name, "points", value)
    if points.ndim == 2:
        points = points[np.newaxis]
    if points.ndim != 3 or points.shape[2] != 3 or 0 in points.shape:
        raise ValueError(f"{name}: points: is {np.shape(value)}, accepted: (K, V, 3) or, of what stands still, (V, 3)")
    return np.ascontiguousarray(points, dtype=np.float64)


def faces_of(name: str, value: Any) -> NDArray[np.int64]:
    """(F, 3), also from the flat list 3, a, b, c, 3, ... of VTK."""
    faces = _numbers(name, "faces", value)
    if faces.dtype.kind == "f":
        raise TypeError(f"{name}: faces: is {faces.shape}, {faces.dtype}, accepted: whole numbers (F, 3)")
    if faces.ndim == 1 and faces.size and faces.size % 4 == 0 and bool(np.all(faces[::4] == 3)):
        faces = faces.reshape(-1, 4)[:, 1:]
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.shape[0] == 0:
        raise ValueError(f"{name}: faces: is {faces.shape}, {faces.dtype}, accepted: (F, 3), triangles")
    return np.ascontiguousarray(faces, dtype=np.int64)


def _cells(name: str, cells: Any) -> Any:
    """Of meshio: blocks with .type and .data, or pairs."""
    blocks = []
    for block in cells:
        kind, data = (block.type, block.data) if hasattr(block, "data") else block
        if kind != "triangle":
            raise ValueError(f"{name}: faces: holds cells \"{kind}\", accepted: \"triangle\"")
        blocks.append(np.asarray(data))
    if not blocks:
        raise ValueError(f"{name}: faces: holds no cells, accepted: \"triangle\"")
    return np.concatenate(blocks)


def _one(name: str, mesh: Any) -> Tuple[Any, Any]:
    """Points and faces of one object, still as it has them."""
    if isinstance(mesh, Mapping):
        missing = [k for k in ("points", "faces") if k not in mesh]
        if missing:
            raise ValueError(f"{name}: has no \"{missing[0]}\", {_ACCEPTED}")
        return mesh["points"], mesh["faces"]
    if isinstance(mesh, tuple) and len(mesh) == 2:
        return mesh[0], mesh[1]
    points = getattr(mesh, "points", None)
    if points is None:
        points = getattr(mesh, "vertices", None)
    faces = getattr(mesh, "faces", None)
    if points is None or (faces is None and not hasattr(mesh, "cells")):
        raise TypeError(f"{name}: is {_given(mesh)}, {_ACCEPTED}")
    return points, faces if faces is not None else _cells(name, mesh.cells)


def keyframes_of(name: str, value: Any) -> List[Mesh]:
    """One mesh per keyframe, the same faces in all."""
    if isinstance(value, list):
        if not value:
            raise ValueError(f"{name}: is empty, {_ACCEPTED}")
        meshes = [keyframes_of(f"{name}: keyframe {k}", mesh) for k, mesh in enumerate(value)]
        for k, one in enumerate(meshes):
            if len(one) != 1:
                raise ValueError(f"{name}: keyframe {k}: points have three axes, accepted: (V, 3) in a list of meshes")
            if not np.array_equal(one[0][1], meshes[0][0][1]):
                raise ValueError(f"{name}: keyframe {k}: has other faces than keyframe 0, accepted: the same in all")
        return [one[0] for one in meshes]
    points, faces = _one(name, value)
    triangles = faces_of(name, faces)
    return [(frame, triangles) for frame in points_of(name, points)]


def is_mesh(value: Any) -> bool:
    """Is this a mesh and not a name of files?"""
    if isinstance(value, list):
        return bool(value) and is_mesh(value[0])
    if isinstance(value, Mapping):
        return "points" in value
    return isinstance(value, (tuple, np.ndarray)) or hasattr(value, "points") or hasattr(value, "vertices")
