"""Whether files are still as they were written, by the digests that were noted of them."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, Dict, Mapping

from . import _echocine
from ._errors import JobError

_PIECE = 1 << 20


def is_sealed(manifest: bytes) -> bool:
    """Whether the last key of a render's manifest is the digest of the bytes before it."""
    before, key, after = manifest.rpartition(b",\n \"manifest_sha256\": ")
    return bool(key) and after == b"\"" + hashlib.sha256(before).hexdigest().encode() + b"\"\n}\n"


class RenderFiles:
    """Files of a render's folder, by the SHA-256 digests in its manifest. A file without one is passed as it is."""

    def __init__(self, folder: Path, manifest: Mapping[str, Any], verify: bool) -> None:
        self._folder = folder
        noted = manifest.get("files") if verify else None
        self._noted: Mapping[str, Any] = noted if isinstance(noted, dict) else {}

    def checked(self, name: str) -> Path:
        """The path of a file of the folder. Raises JobError where its bytes are not those that were written."""
        file = self._folder / name
        if name in self._noted and file.is_file() and _sha256(file) != self._noted[name]:
            raise JobError(f"{file}: is not as it was written: another byte, or cut short; render it again, or open with verify=False")
        return file


class HeartFiles:
    """Files of a dataset's folder, by the digests in its records under work/; a folder without records is passed as it is."""

    def __init__(self, folder: Path, verify: bool) -> None:
        self._folder, self._verify = folder, verify
        self._noted: Dict[int, Mapping[str, Any]] = {}

    def _of(self, heart: int) -> Mapping[str, Any]:
        if heart not in self._noted:
            record = self._folder / "work" / f"{heart // 1000:04d}" / f"{heart:07d}.json"
            files: Any = {}
            if record.is_file():
                try:
                    files = json.loads(record.read_text(encoding="utf-8"))["files"]
                except (ValueError, KeyError, TypeError):
                    raise JobError(f"{record}: is not as it was written: run the dataset's command again, or open with verify=False") from None
            self._noted[heart] = files if isinstance(files, dict) else {}
        return self._noted[heart]

    def checked(self, heart: Any, name: str) -> Path:
        """The path of a file of the folder. Raises JobError where its bytes are not those that were written."""
        file = self._folder / name
        if not self._verify or not isinstance(heart, int) or not file.is_file():
            return file
        noted = self._of(heart).get(name)
        if noted is not None and _echocine.file_digest(file) != (noted.get("bytes"), noted.get("digest")):
            raise JobError(f"{file}: is not as it was written: run the dataset's command again, or open with verify=False")
        return file


def _sha256(file: Path) -> str:
    digest = hashlib.sha256()
    with file.open("rb") as data:
        while piece := data.read(_PIECE):
            digest.update(piece)
    return digest.hexdigest()
