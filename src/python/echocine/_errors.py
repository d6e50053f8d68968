"""What can go wrong, as exceptions."""

from __future__ import annotations

import operator
import re
from typing import Any, List, Optional

import numpy as np

_PLACE = re.compile(r"(?P<file>[^\n]+?):(?P<line>\d+): (?:(?P<key>[A-Za-z_][\w.\-]*): )?")
_KEY = re.compile(r"(?P<key>[a-z_]+\.[\w.\-]*): ")


class SceneError(ValueError):
    """A scene, a mesh or an argument cannot be used.

    The message says what is wrong and what is accepted.

    Attributes:
        file: the scene's file, or None.
        line: its line, from 1, or None where the scene was changed since it was read.
        key: the scene's key, such as "probe.lines", or None.
    """

    def __init__(self, message: str) -> None:
        self.file: Optional[str] = None
        self.line: Optional[int] = None
        self.key: Optional[str] = None
        if place := _PLACE.match(message):
            self.file, self.line = place["file"], int(place["line"])
            self.key = place["key"]
        elif key := _KEY.match(message):
            self.key = key["key"]
        super().__init__(message)

    def without_line(self) -> "SceneError":
        """The same of a text that is no file's any more: a line of it would mislead."""
        place = _PLACE.match(str(self))
        if place is None:
            return self
        key = f"{place['key']}: " if place["key"] else ""
        error = SceneError(f"{place['file']}: {key}{str(self)[place.end():]}")
        error.file, error.key = self.file, self.key
        return error


class JobError(RuntimeError):
    """The work itself failed: a full disk, a folder that cannot be written, a stop."""


class SceneWarning(UserWarning):
    """A scene says what is accepted but hardly meant."""


def whole_number(name: str, value: Any, least: int, most: int) -> int:
    """Python's or NumPy's; no truth value."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or isinstance(value, (bool, np.bool_)) or not least <= number <= most:
        raise ValueError(f"{name}: is {value!r}, accepted: a whole number from {least} to {most}")
    return number


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name}: is {value!r}, accepted: True or False")
    return bool(value)


def texts(name: str, value: Any) -> List[str]:
    if isinstance(value, (str, bytes)):
        raise TypeError(f"{name}: is one text, accepted: a list of texts")
    return list(value)


def thread_count(threads: Any) -> int:
    """0 (one per core) to 4096, as of the commands."""
    return whole_number("threads", threads, 0, 4096)
