"""How a long call tells how far it is."""

from __future__ import annotations

import sys
from typing import Any, Callable, Optional, Union

Report = Callable[[int, int, str], Any]
Progress = Union[None, bool, Callable[[int, int], Any], Any]


def _line(done: int, total: int, what: str) -> None:
    end = "\n" if total and done >= total else "\r"
    sys.stderr.write(f"{what} {done}/{total}" + end)
    sys.stderr.flush()


def report_to(progress: Progress) -> Optional[Report]:
    """None or False: nobody. True: a line on stderr. With update(): a bar as tqdm makes them. Else progress(done, total)."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _line
    if hasattr(progress, "update"):
        bar: Any = progress
        shown = [0]

        def update(done: int, total: int, what: str) -> None:
            if done < shown[0]:  # another pass begins
                shown[0] = 0
                if hasattr(bar, "reset"):
                    bar.reset(total)
            if total:
                bar.total = total
            bar.update(done - shown[0])
            shown[0] = done

        return update
    if not callable(progress):
        raise TypeError(f"progress: is {type(progress).__name__}, accepted: None, True, a function (done, total) "
                        "or a bar with update() as tqdm has it")
    call: Callable[[int, int], Any] = progress
    return lambda done, total, what: call(done, total)
