"""How loops, scenes and tables show themselves in a notebook: HTML that needs no network."""

from __future__ import annotations

import base64
import html
import itertools
import struct
import zlib
from typing import TYPE_CHECKING, Any, List, Sequence

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._loop import Loop
    from ._scene import Scene

# A cell stays of a size that notebooks bear: as many frames at most, and pictures as wide. Our choice.
_MOST_FRAMES, _MOST_WIDTH = 60, 480
_numbers = itertools.count()

_PLAYER = """<div id="{id}" class="echocine"><img alt="a loop of {count} frames" style="max-width:100%;image-rendering:auto"><br>
<button type="button">Pause</button> <input type="range" min="0" max="{last}" value="0" style="width:50%" aria-label="frame">
<span></span></div><script>(() => {{
const root = document.getElementById("{id}"), [image, , button, slider, text] = root.children;
const frames = [{frames}], times = [{times}];
let at = 0, playing = true;
const show = (k) => {{ at = k; image.src = frames[k]; slider.value = k; text.textContent = times[k].toFixed(3) + " s"; }};
button.onclick = () => {{ playing = !playing; button.textContent = playing ? "Pause" : "Play"; }};
slider.oninput = () => {{ playing = false; button.textContent = "Play"; show(+slider.value); }};
const tick = () => {{ if (!root.isConnected) return; if (playing) show((at + 1) % frames.length); setTimeout(tick, {step_ms}); }};
show(0); setTimeout(tick, {step_ms}); }})();</script>"""


def png(image: NDArray[np.uint8]) -> bytes:
    """A PNG of (H, W) greys or (H, W, 3) colours."""
    rows = np.ascontiguousarray(image).reshape(image.shape[0], -1)
    # Up-differences (filter 2) halve what flat pictures take.
    up = np.concatenate([rows[:1], rows[1:] - rows[:-1]])
    data = np.concatenate([np.full((len(up), 1), 2, np.uint8), up], axis=1).tobytes()

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2 if image.ndim == 3 else 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 6)) + chunk(b"IEND", b"")


def data_uri(image: NDArray[np.uint8]) -> str:
    """The same for the src of an img."""
    return "data:image/png;base64," + base64.b64encode(png(image)).decode()


def loop_html(loop: "Loop") -> str:
    """A player of the loop's pictures."""
    try:
        images, times = loop.images, loop.times_s
    except ValueError as error:
        return f"<p>{html.escape(repr(loop))}: {html.escape(str(error))}</p>"
    stride = -(-len(images) // _MOST_FRAMES)
    step = -(-images.shape[2] // _MOST_WIDTH)
    shown, shown_times = images[::stride, ::step, ::step], times[::stride]
    step_ms = 1e3 * float(shown_times[1] - shown_times[0]) if len(shown_times) > 1 else 1e3
    return _PLAYER.format(id=f"echocine-{next(_numbers)}-{id(loop):x}", count=len(images), last=len(shown) - 1,
                          frames=",".join(f'"{data_uri(image)}"' for image in shown),
                          times=",".join(f"{t:.4f}" for t in shown_times), step_ms=f"{step_ms:.1f}")


def table_html(head: Sequence[str], rows: Sequence[Sequence[Any]], caption: str) -> str:
    """A table."""
    top = "".join(f"<th>{html.escape(h)}</th>" for h in head)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(str(c))}</td>" for c in row) + "</tr>" for row in rows)
    return f"<table><caption>{html.escape(caption)}</caption><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def scene_html(scene: "Scene") -> str:
    """The sector over the structures where the imaging plane cuts their first keyframe, and the scene in numbers."""
    return f"<figure>{scene_svg(scene)}<figcaption>{html.escape(repr(scene))}</figcaption></figure>"


def _cut(points: NDArray[np.float64], faces: NDArray[Any], normal: NDArray[np.float64], origin: NDArray[np.float64]) -> NDArray[np.float64]:
    """Segments (n, 2, 3) where a plane meets triangles."""
    height = (points - origin) @ normal
    corners, levels = points[faces], height[faces]
    crossing = np.nonzero((levels.min(axis=1) < 0) & (levels.max(axis=1) >= 0))[0]
    segments: List[Any] = []
    for f in crossing:
        ends = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            la, lb = levels[f, a], levels[f, b]
            if (la < 0) != (lb < 0):
                ends.append(corners[f, a] + (corners[f, b] - corners[f, a]) * (la / (la - lb)))
        segments.append(ends)
    return np.array(segments, dtype=np.float64).reshape(-1, 2, 3)


def scene_svg(scene: "Scene") -> str:
    """The imaging plane: lateral to the right, depth downwards, in mm from the apex."""
    from ._errors import SceneError
    unit = {"mm": 1.0, "cm": 10.0, "m": 1000.0}[scene["motion.mesh_unit"]]
    deepest = scene["probe.depth_mm"]
    if deepest is None:  # of a standard view, by the heart
        return ""
    # Lines start at the probe's face, which for a curvilinear probe lies in front of the apex.
    face = "probe.face_radius_mm"
    depth = float(deepest) + float((scene[face] if face in scene else None) or 0)
    paths = []
    try:
        origin, axis = np.asarray(scene["probe.apex"], float), np.asarray(scene["probe.axis"], float)
        lateral = np.asarray(scene["probe.lateral"], float)
        axis = axis / np.linalg.norm(axis)
        lateral = lateral - (lateral @ axis) * axis
        lateral = lateral / np.linalg.norm(lateral)
        scale, offset = float(scene["motion.mesh_scale"]), np.asarray(scene["motion.mesh_offset_mm"] or 0.0, float) / unit
        for k, name in enumerate(scene.structures):
            points, faces = scene.mesh(name)
            cut = _cut(points[0] * scale + offset, faces, np.cross(axis, lateral), origin) - origin
            xy = np.stack([cut @ lateral, cut @ axis], axis=-1) * unit
            line = "".join(f"M{a[0]:.1f} {a[1]:.1f}L{b[0]:.1f} {b[1]:.1f}" for a, b in xy)
            paths.append(f'<path d="{line}" stroke="hsl({k * 137 % 360} 60% 45%)" stroke-width="0.8" fill="none">'
                         f"<title>{html.escape(name)}</title></path>")
    except (SceneError, TypeError, ValueError):
        pass  # keyframes in files, or a pose by anatomy: the sector alone
    kind = scene["probe.kind"]
    if kind == "radial":
        shape = f"M{-depth:.1f} 0A{depth:.1f} {depth:.1f} 0 0 0 {depth:.1f} 0A{depth:.1f} {depth:.1f} 0 0 0 {-depth:.1f} 0Z"
        half_width, top = depth, -depth
    elif kind == "linear":
        half_width, top = float(scene["probe.width_mm"]) / 2, 0.0
        shape = f"M{-half_width:.1f} 0L{-half_width:.1f} {depth:.1f}L{half_width:.1f} {depth:.1f}L{half_width:.1f} 0Z"
    else:
        half = np.deg2rad(float(scene["probe.sector_deg"] or 0.0) / 2)
        x, y = depth * np.sin(half), depth * np.cos(half)
        shape = f"M0 0L{-x:.1f} {y:.1f}A{depth:.1f} {depth:.1f} 0 0 0 {x:.1f} {y:.1f}Z"
        half_width, top = depth / 1.6, 0.0
    half_width = max(half_width + 5, depth / 1.6)
    sector = f'<path d="{shape}" fill="#8882" stroke="#888" stroke-width="0.5"/>'
    box = f"{-half_width:.1f} {top - 10:.1f} {2 * half_width:.1f} {depth - top + 20:.1f}"
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="360" height="360" viewBox="{box}" role="img" '
            f'aria-label="sector and structures">{sector}{"".join(paths)}</svg>')
