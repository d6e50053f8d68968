"""Scenes: what is imaged, by what probe, into which outputs."""

from __future__ import annotations

import copy
import difflib
import hashlib
import os
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, Optional, Set, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _echocine, _meshes, _toml
from ._errors import SceneError, flag, thread_count
from ._progress import Progress, report_to

if TYPE_CHECKING:
    from ._live import LivePage, PathLike

# Full keys of the reader's table: "probe.depth_mm", "structure.priority".
_KEYS = frozenset(row[0] for row in _echocine.scene_keys())
_PLAIN = frozenset(key for key in _KEYS if "." not in key)


class Table:
    """One table of a scene, such as ``scene.probe``: keys are attributes, with the scene file's names and units.

    A value that is set goes through the scene's reader at once; None goes back to the default.
    """

    __slots__ = ("_scene", "_path")
    _scene: "Scene"
    _path: str

    def __init__(self, scene: "Scene", path: str) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_path", path)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("__"):
            raise AttributeError(key)
        try:
            return self._scene[f"{self._path}.{key}"]
        except SceneError as error:
            raise AttributeError(str(error)) from None

    def __setattr__(self, key: str, value: Any) -> None:
        self._scene[f"{self._path}.{key}"] = value

    def __delattr__(self, key: str) -> None:
        del self._scene[f"{self._path}.{key}"]

    def keys(self) -> List[str]:
        """Every key that the table can have here."""
        start = self._path + "."
        return [k[len(start):] for k in self._scene.keys() if k.startswith(start)]

    def __dir__(self) -> List[str]:
        return self.keys()

    def __repr__(self) -> str:
        return "\n".join(f"{k} = {self._scene[f'{self._path}.{k}']!r}" for k in self.keys())


class Scene:
    """What is imaged, by what probe, into which outputs.

    Args:
        source: a scene file's path, a scene's TOML text (with a line break), or a dict of its tables.
            In a dict a structure's ``keyframes`` may be arrays: ``(points [K, V, 3], faces [F, 3])`` in
            ``motion.mesh_unit``, or a mesh of meshio, pyvista or trimesh, or a list of those, one per keyframe.
        folder: what paths of a text or dict are relative to; the current folder if left out.

    Keys have the scene file's names and units: ``scene["probe.depth_mm"]``, ``scene.probe.depth_mm``, of structures
    ``scene["structure.lv_wall.medium"]``. What is not given reads as its default. Setting a key reads the scene anew:
    a SceneError names the key and leaves the scene as it was.
    """

    __slots__ = ("_text", "_file", "_changed", "_keys", "_meshes", "_native", "_version")

    def __init__(self, source: Union[str, "os.PathLike[str]", Mapping[str, Any]], folder: Union[str, "os.PathLike[str]"] = ".") -> None:
        self._changed = False
        self._keys: Optional[Dict[str, Any]] = None
        self._meshes: Optional[_echocine.Meshes] = None
        self._version = 0
        if isinstance(source, Mapping):
            self._file = str(Path(folder) / "scene")
            self._changed = True
            self._keys = self._with_meshes(dict(source))
            self._text = _toml.text_of(self._keys)
        elif isinstance(source, str) and "\n" in source:
            self._file = str(Path(folder) / "scene")
            self._text = source
        elif isinstance(source, (str, os.PathLike)):
            self._file = os.fspath(source)
            self._text = self._file_text(self._file)
        else:
            raise TypeError(f"source: is {type(source).__name__}, accepted: a path, TOML text or a dict")
        self._native = self._read(self._text, self._meshes)

    @staticmethod
    def _file_text(file: str) -> str:
        try:
            return Path(file).read_text(encoding="utf-8")
        except OSError as error:
            raise SceneError(f"{file}: cannot be read: {error.strerror}") from None
        except UnicodeDecodeError as error:
            raise SceneError(f"{file}: is not UTF-8 text: byte {error.start}") from None

    @classmethod
    def _of(cls, text: str, file: str, meshes: Optional[_echocine.Meshes], changed: bool = False) -> "Scene":
        scene = cls.__new__(cls)
        scene._text, scene._file, scene._meshes, scene._changed = text, file, meshes, changed
        scene._keys, scene._version = None, 0
        scene._native = scene._read(text, meshes)
        return scene

    def __reduce__(self) -> Tuple[Any, ...]:
        return _rebuild, (self._text, self._file, self._meshes, self._changed)

    def copy(self) -> "Scene":
        """A scene of its own that is equal; meshes in memory are shared and never changed."""
        return Scene._of(self._text, self._file, self._meshes.copy() if self._meshes else None, self._changed)

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> "Scene":
        return self.copy()

    def _read(self, text: str, meshes: Optional[_echocine.Meshes]) -> _echocine.Scene:
        try:
            return _echocine.Scene(text, self._file, meshes)
        except SceneError as error:
            raise (error.without_line() if self._changed else error) from None

    # Keys.

    def _document(self) -> Dict[str, Any]:
        if self._keys is None:
            self._keys = tomllib.loads(self._text)
        return self._keys

    def _structure(self, document: Dict[str, Any], name: str) -> Dict[str, Any]:
        for entry in document.get("structure", []):
            if entry.get("name") == name:
                found: Dict[str, Any] = entry
                return found
        names = [str(entry.get("name")) for entry in document.get("structure", [])]
        raise SceneError(f"structure.{name}: is not a structure, accepted: {', '.join(names)}")

    def _table(self, document: Dict[str, Any], key: str, make: bool) -> Tuple[Dict[str, Any], str]:
        """The dict that holds a key, and the key's last word."""
        parts = key.split(".")
        if parts[0] == "structure" and len(parts) >= 3:
            return self._structure(document, ".".join(parts[1:-1])), parts[-1]
        if parts[0] == "media":  # a medium's name may have dots
            names = (".".join(parts[1:n]) for n in range(len(parts) - 1, 1, -1))
            known = next((name for name in names if name in document.get("media", {})), None)
            if known is not None:
                parts = ["media", known, *parts[2 + known.count("."):]]
        table = document
        for part in parts[:-1]:
            if make and part not in table:
                table[part] = {}
            table = table.get(part, {})
            if not isinstance(table, dict):
                raise SceneError(f"{key}: is not a key of a scene")
        return table, parts[-1]

    def keys(self) -> List[str]:
        """Every key that this scene gives or could give."""
        found: Set[str] = set()
        document = self._document()
        for name, value in document.items():
            if name == "structure":
                found.update(f"structure.{e.get('name')}.{k}" for e in value for k in e)
            elif name == "media":
                found.update(f"media.{medium}.{k}" for medium, keys in value.items() for k in keys)
            elif isinstance(value, dict):
                found.update(f"{name}.{k}" for k in value)
            else:
                found.add(name)
        for key in self._native.absent:
            table, _, rest = key.partition(".")
            if key not in _KEYS:
                continue
            if table == "structure":
                found.update(f"structure.{e['name']}.{rest}" for e in self._native.structures)
            else:
                found.add(key)
        if "truth" not in document:  # which the reader then does not look into
            found.update(key for key in _KEYS if key.startswith("truth."))
        return sorted(found)

    def __getitem__(self, key: str) -> Any:
        document = self._document()
        table, last = self._table(document, key, make=False)
        if last in table and "." in key or key in _PLAIN and key in table:
            return copy.deepcopy(table[last])
        if key in self.keys():
            return self._default(key)
        nearest = difflib.get_close_matches(key, self.keys(), 1)
        hint = f"the nearest is {nearest[0]}" if nearest else "scene.keys() lists those that are"
        raise SceneError(f"{key}: is not a key of this scene, {hint}")

    def _default(self, key: str) -> Any:
        if key.startswith("structure."):
            name, _, last = key[len("structure."):].rpartition(".")
            if last == "role":
                return next(e["role"] for e in self._native.structures if e["name"] == name)
            return self._native.absent.get(f"structure.{last}")
        return self._native.absent.get(key)

    def __contains__(self, key: str) -> bool:
        return key in self.keys()

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __delitem__(self, key: str) -> None:
        self.update({key: None})

    def update(self, changes: Mapping[str, Any]) -> None:
        """Sets several keys at once, for those that are accepted only together. None: the default.

        Raises SceneError as the scene file's reader does; the scene is then as it was.
        """
        document = copy.deepcopy(self._document())
        meshes = self._meshes.copy() if self._meshes else None
        for key, value in changes.items():
            table, last = self._table(document, key, make=value is not None)
            if value is None:
                table.pop(last, None)
            elif key.startswith("structure.") and last == "keyframes" and _meshes.is_mesh(value):
                meshes = self._in_memory(meshes, key)
                table[last] = self._add_keyframes(meshes, table, key, value)
            else:
                table[last] = _toml.plain(value, key)
        text, was = _toml.text_of(document), self._changed
        self._changed = True
        try:
            native = self._read(text, meshes)
        except BaseException:
            self._changed = was
            raise
        self._keys, self._meshes, self._native, self._text = document, meshes, native, text
        self._version += 1

    # Meshes.

    def _in_memory(self, meshes: Optional[_echocine.Meshes], key: str) -> _echocine.Meshes:
        if meshes is None:
            raise SceneError(f"{key}: are arrays, but other keyframes of the scene are files, accepted: all in memory or all "
                             "in files")
        return meshes

    @staticmethod
    def _add_keyframes(meshes: _echocine.Meshes, entry: Dict[str, Any], key: str, value: Any) -> Any:
        """Puts them in and returns what the scene's text calls them."""
        stem = _mesh_stem(str(entry.get("name", "structure")))
        if isinstance(value, np.ndarray):  # other points for the same faces
            old = entry.get("keyframes")
            like = next((n for n in meshes.names() if _matches(n, old)), None)
            if like is None:
                raise ValueError(f"{key}: are points without faces, accepted: (points [K, V, 3], faces [F, 3])")
            points = _meshes.points_of(key, value)
            names = [f"{stem}_{k:03d}" for k in range(len(points))]
            fresh = [(n, like, p) for n, p in zip(names, points)]
            for new, old_name, frame in sorted(fresh, key=lambda f: f[0] == like):
                meshes.add_like(new, old_name, frame)
            return names
        keyframes = _meshes.keyframes_of(key, value)
        names = [f"{stem}_{k:03d}" for k in range(len(keyframes))]
        for new, (frame, faces) in zip(names, keyframes):
            meshes.add(new, frame, faces)
        return names

    def _with_meshes(self, source: Dict[str, Any]) -> Dict[str, Any]:
        given = source.get("structure", source.pop("structures", None)) or []
        entries = [given] if isinstance(given, Mapping) else list(given)
        document: Dict[str, Any] = {k: _toml.plain(v, k) for k, v in source.items() if k not in ("structure", "structures")}
        document["structure"] = []
        in_memory = [_meshes.is_mesh(e.get("keyframes")) for e in entries]
        if any(in_memory):
            self._meshes = _echocine.Meshes()
        for entry, is_array in zip(entries, in_memory):
            kept = {k: _toml.plain(v, f"structure.{k}") for k, v in entry.items() if not (is_array and k == "keyframes")}
            key = f"structure.{entry.get('name', '')}.keyframes"
            if is_array:
                assert self._meshes is not None
                kept["keyframes"] = self._add_keyframes(self._meshes, kept, key, entry["keyframes"])
            elif any(in_memory):
                self._in_memory(None, next(f"structure.{e.get('name', '')}.keyframes" for e, a in zip(entries, in_memory) if a))
            document["structure"].append(kept)
        return document

    def mesh(self, structure: str) -> Tuple[NDArray[np.float64], NDArray[np.uint32]]:
        """Keyframes of a structure: points (K, V, 3) in ``motion.mesh_unit`` and faces (F, 3), vertices from 0.

        Only of scenes whose meshes are in memory: hearts by their dials, and meshes given as arrays.
        """
        if self._meshes is None:
            raise SceneError(f"structure.{structure}.keyframes: are files, accepted: a scene with meshes in memory")
        for entry in self._native.structures:
            if entry["name"] == structure:
                views = [self._meshes.get(name) for name in entry["files"]]
                return np.stack([points for points, _ in views]), views[0][1]
        names = ", ".join(self.structures)
        raise SceneError(f"structure.{structure}: is not a structure, accepted: {names}")

    # Parts.

    @property
    def structures(self) -> Dict[str, Table]:
        """The structures' tables by name, in the scene's order."""
        return {e["name"]: Table(self, f"structure.{e['name']}") for e in self._native.structures}

    @property
    def probe(self) -> Table:
        """Where the probe stands and how it scans."""
        return Table(self, "probe")

    @property
    def acquisition(self) -> Table:
        """Heart rate, frame rate and length of the loop."""
        return Table(self, "acquisition")

    @property
    def motion(self) -> Table:
        """How keyframes become a beat."""
        return Table(self, "motion")

    @property
    def effects(self) -> Table:
        """Physical effects: "auto", "on" or "off"."""
        return Table(self, "effects")

    @property
    def speckle(self) -> Table:
        """Coherent echoes of scatterers."""
        return Table(self, "speckle")

    @property
    def trabeculae(self) -> Table:
        """Rough inner surfaces of the ventricles."""
        return Table(self, "trabeculae")

    @property
    def leaflets(self) -> Table:
        """Thickness of leaflets and cusps; chordae and fibrous rings."""
        return Table(self, "leaflets")

    @property
    def artefacts(self) -> Table:
        """What a scanner adds to the picture."""
        return Table(self, "artefacts")

    @property
    def signal(self) -> Table:
        """From received intensities to greys."""
        return Table(self, "signal")

    @property
    def accuracy(self) -> Table:
        """Rays per beam and the tracer."""
        return Table(self, "accuracy")

    @property
    def output(self) -> Table:
        """Channels, pictures and files."""
        return Table(self, "output")

    @property
    def truth(self) -> Table:
        """Which truth is made."""
        return Table(self, "truth")

    @property
    def text(self) -> str:
        """The scene as TOML, as its reader sees it."""
        return self._text

    @property
    def file(self) -> str:
        """The scene's file; its folder is what paths in it are relative to."""
        return self._file

    @property
    def warnings(self) -> List[str]:
        """Warnings about valid but unlikely input, a line each."""
        return self._native.warnings

    @property
    def frame_count(self) -> int:
        """Frames of the loop."""
        return self._native.frame_count

    def live(self, *, record: Optional[PathLike] = None, port: int = 0, threads: int = 0) -> "LivePage":
        """Serves the page of ``echocine live`` for this scene, on this machine; a notebook shows it.

        The page has the scene as it is now. Changes in the page do not change the scene: copy the pose, or save the scene there.
        The page of a `heart()` has its dials, and saves it with its meshes into the working folder. Other meshes in memory
        cannot be saved.

        Args:
            record: folder for a scene file of each pose at which the probe comes to rest; of meshes in memory only those
                of a `heart()`.
            port: of 127.0.0.1; 0: any free one.
            threads: at most; 0: one per core.

        Returns:
            A page with ``link``, served until ``close()``, until nothing refers to the page, or until the end of the program.

        Raises:
            SceneError: the scene cannot be shown.
            JobError: the port is taken.
        """
        from ._live import LivePage
        return LivePage(self._text, self._file, self._meshes, record, port, threads)

    def __repr__(self) -> str:
        probe = self._native.probe
        return (f"<echocine.Scene {self._file}: {len(self._native.structures)} structures, {probe['kind']} probe, "
                f"{probe['lines']} lines of {probe['samples']} samples, {self.frame_count} frames>")

    def _repr_html_(self) -> str:
        from ._notebook import scene_html
        return scene_html(self)


def _mesh_stem(structure: str) -> str:
    """The start of the names of a structure's meshes in memory, another one for each structure."""
    stem = "".join(c if c.isalnum() or c in "_-" else "_" for c in structure)
    return stem if stem == structure else f"{stem}~{hashlib.sha256(structure.encode()).hexdigest()[:8]}"


def _matches(name: str, patterns: Any) -> bool:
    import fnmatch
    listed = patterns if isinstance(patterns, list) else [patterns]
    words = [p.get("file", "") if isinstance(p, dict) else str(p) for p in listed]
    return any(fnmatch.fnmatchcase(name, word) for word in words)


def _rebuild(text: str, file: str, meshes: Optional[_echocine.Meshes], changed: bool) -> Scene:
    return Scene._of(text, file, meshes, changed)


def _number(name: str, value: Any) -> float:
    """A number of Python's or NumPy's; no text, no truth value."""
    try:
        if isinstance(value, (str, bytes, bool, np.bool_)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise SceneError(f"{name}: is {value!r}, accepted: a number") from None


def heart(view: str = "a4c", *, segments: Optional[Mapping[int, Any]] = None, keep_volumes: bool = False, keyframes: int = 24,
          look: str = "scanner", even: bool = False, threads: int = 0, progress: Progress = None, **dials: float) -> Scene:
    """A beating heart from its dials, as a scene with its meshes in memory.

    Args:
        view: where the probe is held, such as "a4c", "a2c", "plax".
        segments: wall motion of the 17 segments: number -> amplitude (1 healthy, 0 akinetic, below 0 dyskinetic), or
            (amplitude, delay in ms).
        keep_volumes: the ejection fraction stays as dialled, and healthy segments do the work of still ones.
        keyframes: keyframes a beat, 4 to 100.
        look: how its pictures look: "paper", "clean", or a scanner: "scanner", "smooth", "contrast", "sharp", "portable", "faint".
        even: keyframes evenly spaced, not by how much moves.
        threads: 0: one per core.
        progress: None, True, a function (done, total), or a bar as tqdm makes them.
        dials: by the names that `dials()` lists, such as ``ef=0.45`` or ``wall_thickness=12`` (mm).

    Raises SceneError for dials that no heart fulfils.
    """
    if not isinstance(view, str):
        raise SceneError(f'heart: view: is {view!r}, accepted: a name such as "a4c"')
    if not isinstance(segments or {}, Mapping):
        raise SceneError(f"heart: segments: is {segments!r}, accepted: amplitudes by number, such as {{7: 0}}")
    given = {name: _number(f"heart: {name}", value) for name, value in dials.items()}
    walls = {}
    for number, wall in (segments or {}).items():
        if isinstance(number, bool) or not isinstance(number, (int, np.integer)):
            raise SceneError(f"heart: segments: {number!r} is no segment, accepted: whole numbers, 1 to 17")
        parts = tuple(wall) if isinstance(wall, (tuple, list)) else (wall, 0.0)
        if len(parts) != 2:
            raise SceneError(f"heart: segment {number}: is {wall!r}, accepted: an amplitude, or (amplitude, delay in ms)")
        amplitude, delay_ms = (_number(f"heart: segment {number}", part) for part in parts)
        walls[int(number)] = (amplitude, delay_ms * 1e-3)
    if not isinstance(look, str):
        raise SceneError(f'heart: look: is {look!r}, accepted: a name such as "scanner"')
    text, meshes = _echocine.heart(view, given, walls, flag("keep_volumes", keep_volumes), keyframes, look, flag("even", even),
                                   thread_count(threads), report_to(progress))
    return Scene._of(text, "heart", meshes)


def dials() -> Dict[str, Dict[str, Any]]:
    """The dials of `heart`: name -> unit, least, most, default (None: follows the others), meaning."""
    words = ("unit", "least", "most", "default", "meaning")
    return {row[0].replace("-", "_"): dict(zip(words, row[1:])) for row in _echocine.dials()}


def scene_keys() -> Dict[str, Dict[str, str]]:
    """The keys of scenes: full name -> unit, accepted values, meaning. Those of media stand under ``media``."""
    words = ("unit", "accepted", "meaning")
    return {row[0]: dict(zip(words, row[1:])) for row in _echocine.scene_keys()}
