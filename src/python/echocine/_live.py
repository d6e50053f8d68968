"""The live page of a scene."""

from __future__ import annotations

import atexit
import html
import os
import warnings
import weakref
from typing import Any, Optional, Union

from . import _echocine
from ._errors import SceneWarning, thread_count

PathLike = Union[str, "os.PathLike[str]"]


def _close(server: "weakref.ref[_echocine.LiveServer]") -> None:
    running = server()
    if running is not None:
        running.close()


class LivePage:
    """A page in which the probe moves, served on this machine; a notebook shows it.

    Attributes:
        link: of the page. It holds a token: whoever has it can use the page.
    """

    def __init__(self, text: str, file: str, meshes: Optional[_echocine.Meshes], record: Optional[PathLike], port: int, threads: int) -> None:
        if not 0 <= port <= 65535:
            raise ValueError(f"port: is {port}, accepted: 0 to 65535")
        self._server = _echocine.LiveServer(text, file, meshes, os.fspath(record) if record is not None else "", port, thread_count(threads))
        self.link: str = self._server.link
        for line in self._server.warnings:
            warnings.warn(line, SceneWarning, stacklevel=3)
        atexit.register(_close, weakref.ref(self._server))

    @property
    def running(self) -> bool:
        """Whether the page is served."""
        return self._server.running

    def close(self) -> None:
        """Ends the page."""
        self._server.close()

    def __enter__(self) -> "LivePage":
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<echocine.LivePage {self.link}>" if self.running else "<echocine.LivePage, closed>"

    def _repr_html_(self) -> str:
        if not self.running:
            return "<p>The live page is closed.</p>"
        link = html.escape(self.link, quote=True)
        return (f'<iframe src="{link}" title="EchoCine live" width="100%" height="900" style="border:0" allow="clipboard-write"></iframe>'
                f'<p><a href="{link}" target="_blank" rel="noreferrer">Open it in a page of its own</a></p>')
