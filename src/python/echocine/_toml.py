"""TOML from plain Python values, for the one reader of scenes."""

from __future__ import annotations

import json
import math
from typing import Any, Mapping, Sequence

import numpy as np

_BARE = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")


def _quoted(text: str) -> str:
    # TOML knows JSON's escapes but for DEL, which both accept only escaped in TOML.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(name: str) -> str:
    return name if name and set(name) <= _BARE else _quoted(name)


def _number(value: float) -> str:
    if math.isfinite(value):
        return repr(value)
    return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"


def plain(value: Any, key: str) -> Any:
    """The value as TOML has it: NumPy's numbers and arrays become Python's. Else a TypeError names the key."""
    if isinstance(value, (np.generic, np.ndarray)):  # first: np.float64 is a float whose repr() names its type
        return plain(value.tolist(), key)
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Mapping):
        return {str(k): plain(v, f"{key}.{k}") for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v, key) for v in value]
    if hasattr(value, "__fspath__"):
        return str(value)
    raise TypeError(f"{key}: is {type(value).__name__}, accepted: a number, a text, a truth value, or a list or dict of these")


def _inline(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_inline(v)}" for k, v in value.items()) + " }" if value else "{}"
    return "[" + ", ".join(_inline(v) for v in value) + "]"


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def section_of(path: Sequence[str], table: Mapping[str, Any]) -> str:
    """One table under its header; nothing where it is empty."""
    lines = ["", f"[{'.'.join(_key(k) for k in path)}]"] + [f"{_key(k)} = {_inline(v)}" for k, v in table.items()]
    return "\n".join(lines) + "\n" if table else ""


def text_of(scene: Mapping[str, Any]) -> str:
    """A scene's TOML: plain keys, then tables, then lists of tables."""
    lines = [f"{_key(k)} = {_inline(v)}" for k, v in scene.items() if not isinstance(v, dict) and not _is_tables(v)]
    for name, table in scene.items():
        if not isinstance(table, dict):
            continue
        if name == "media":
            for medium, keys in table.items():
                lines += ["", f"[media.{_key(medium)}]"] if isinstance(keys, dict) else []
                lines += [f"{_key(k)} = {_inline(v)}" for k, v in keys.items()] if isinstance(keys, dict) else [
                    "", "[media]", f"{_key(medium)} = {_inline(keys)}"]
            continue
        lines += ["", f"[{_key(name)}]"]
        lines += [f"{_key(k)} = {_inline(v)}" for k, v in table.items()]
    for name, tables in scene.items():
        for entry in tables if _is_tables(tables) else []:
            lines += ["", f"[[{_key(name)}]]"]
            lines += [f"{_key(k)} = {_inline(v)}" for k, v in entry.items()]
    return "\n".join(lines) + "\n"
