"""Scores the tracks of a method against the exact ones of a dataset.

    score_tracks.py DATASET RESULTS [--split test] [--centre whole] [--json scores.json]

DATASET is a folder of `echocine dataset` with the layout "native" and truth = ["tracks"], whole or joined.
RESULTS has one file per loop, ID.npz, made by the method:

    tracks   (T, N, 2) float   x and y of every tracked point in every frame, in pixels of native/ID/cine.avi. Points and
                               frames are in the order of track_px in native/ID/truth.npz. NaN where a point is lost.
    visible  (T, N) bool       optional: whether the method takes the point for visible
    labels   (T, H, W) uint8   optional: label 1 is the cavity of the left ventricle

The method is given the points of frame 0, so frame 0 is not scored. By default the centre of the first pixel is at
(0.5, 0.5), as in truth.npz. With --centre whole it is at (0, 0), as in the layouts pointodyssey and myotracker.

Needs Python 3.8 and NumPy. Exit code 2, with one line, if a file has another shape."""

import argparse
import csv
import json
import math
import sys
from pathlib import Path

import numpy as np

LAYERS = ("endocardium", "middle", "epicardium")
AWAY_MM = (0.0, 1.0, 2.0, 4.0, 8.0, math.inf)  # edges of the bins of the distance from the imaging plane
WITHIN_PX = (1, 2, 4, 8, 16)  # of a picture of 256 x 256, as for TAP-Vid
SIDE_PX = 256
GROUPS = 24  # of endocardial points along the outline


class Refused(Exception):
    pass


class Outline:
    """The open outline of the cavity: groups of endocardial points in the order of their angle about the cavity in frame 0, from
    one end of the mitral ring to the other. The same points are averaged in every frame."""

    def __init__(self, first_px, layers):
        points = np.flatnonzero(layers == 0)
        around = first_px[points] - first_px[points].mean(axis=0)
        angles = np.arctan2(around[:, 1], around[:, 0])
        order = np.argsort(angles)
        gaps = np.diff(angles[order], append=angles[order[0]] + 2 * math.pi)
        order = np.roll(order, -1 - int(np.argmax(gaps)))  # the largest gap is the mitral orifice
        self.groups = np.array_split(points[order], max(3, min(GROUPS, len(points) // 2)))

    def at(self, px):
        """(G, 2) of points (N, 2); None if a group has lost all its points."""
        means = []
        for group in self.groups:
            there = px[group][np.isfinite(px[group]).all(axis=1)]
            if len(there) == 0:
                return None
            means.append(there.mean(axis=0))
        return np.array(means)


def area_of(outline):
    x, y = outline.T
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def volume_of(outline, mm):
    """Area-length rule, V = 8 A^2 / (3 pi L): A is the area in the plane, L the distance from the middle of the base to the
    farthest point. mL."""
    base = 0.5 * (outline[0] + outline[-1])
    length = np.hypot(*(outline - base).T).max()
    return 8 * (area_of(outline) * mm**2) ** 2 / (3 * math.pi * length * mm) / 1000


def length_of(outline):
    return np.hypot(*np.diff(outline, axis=0).T).sum()


def inside(outline, shape):
    """Pixels whose centres lie in the polygon, by the parity of crossings."""
    y, x = np.mgrid[0:shape[0], 0:shape[1]] + 0.5
    within = np.zeros(shape, bool)
    for (x0, y0), (x1, y1) in zip(outline, np.roll(outline, -1, axis=0)):
        if y0 != y1:
            within ^= ((y0 <= y) != (y1 <= y)) & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return within


def dice(a, b):
    both = np.count_nonzero(a) + np.count_nonzero(b)
    return 2 * np.count_nonzero(a & b) / both if both else 1.0


def heart_of(outlines, mm):
    """EF and longitudinal strain at end-systole, per cent, of the outlines at end-diastole and end-systole."""
    ed, es = outlines
    return 100 * (1 - volume_of(es, mm) / volume_of(ed, mm)), 100 * (length_of(es) / length_of(ed) - 1)


def read_result(path, truth, shape, centre):
    with np.load(path, allow_pickle=False) as arrays:
        result = {name: arrays[name] for name in ("tracks", "visible", "labels") if name in arrays}
    wanted = {"tracks": truth["track_px"].shape, "visible": truth["track_px"].shape[:2],
              "labels": (len(truth["track_px"]), *shape)}
    if "tracks" not in result:
        raise Refused(f"{path}: has no array tracks, accepted: tracks {wanted['tracks']}")
    for name, array in result.items():
        if array.shape != wanted[name]:
            raise Refused(f"{path}: {name} is {array.shape}, accepted: {wanted[name]}")
    tracks = result["tracks"].astype(np.float64) + (0.5 if centre == "whole" else 0.0)
    result["tracks"] = np.where(np.isfinite(tracks).all(axis=2, keepdims=True), tracks, np.nan)
    return result


def score_loop(row, truth, result):
    """Numbers of one loop, and the errors of its points for the tables."""
    mm, shape = float(row["mm_per_pixel"]), (int(row["height"]), int(row["width"]))
    exact, found = truth["track_px"].astype(np.float64), result["tracks"]
    error_px = np.hypot(*np.moveaxis(found - exact, 2, 0))[1:]
    shown, lost = truth["track_visible"][1:] > 0, np.isnan(error_px)
    scores = {"id": row["id"], "lost_percent": 100 * lost.mean()}
    if not lost.all():
        scores["mean_mm"] = mm * np.nanmean(error_px)
        scores["median_mm"] = mm * np.nanmedian(error_px)
    if shown.any():
        small = np.where(lost, np.inf, error_px * SIDE_PX / max(shape))[shown]
        for px in WITHIN_PX:
            scores[f"within_{px}_px_percent"] = 100 * np.mean(small < px)
        scores["within_percent"] = np.mean([scores[f"within_{px}_px_percent"] for px in WITHIN_PX])
    if "visible" in result:
        scores["visibility_accuracy_percent"] = 100 * np.mean((result["visible"][1:] > 0) == shown)
    instants = [int(row["ed_frame"]), int(row["es_frame"])]
    outline = Outline(exact[0], truth["track_layer"])
    own = [outline.at(found[f]) for f in instants]
    true = [outline.at(exact[f]) for f in instants]
    for name, a, b in zip(("ed", "es"), own, true):
        if a is not None:
            scores[f"dice_{name}"] = dice(inside(a, shape), inside(b, shape))
    if all(o is not None for o in own):
        (ef, gls), (true_ef, true_gls) = heart_of(own, mm), heart_of(true, mm)
        scores.update(ef_percent=ef, ef_error=ef - true_ef, ef_minus_exact=ef - float(row["ef_percent"]),
                      gls_percent=gls, gls_error=gls - true_gls)
    if "labels" in result and "labels" in truth:
        for name, f in zip(("ed", "es"), instants):
            scores[f"labels_dice_{name}"] = dice(result["labels"][f] == 1, truth["labels"][f] == 1)
    away_mm = np.abs(truth["track_out_of_plane_mm"][1:])
    return scores, {"error_mm": mm * error_px, "away_mm": away_mm, "layer": truth["track_layer"],
                    "segment": truth["track_segment"]}


class Table:
    """Errors of points by a property: mean, count and lost share of each class."""

    def __init__(self):
        self.sums = {}

    def add(self, name, error_mm):
        total, count, lost = self.sums.get(name, (0.0, 0, 0))
        there = np.isfinite(error_mm)
        self.sums[name] = (total + error_mm[there].sum(), count + int(there.sum()), lost + int((~there).sum()))

    def rows(self):
        return {name: {"mean_mm": total / count if count else None, "points": count, "lost_percent": 100 * lost / (count + lost)}
                for name, (total, count, lost) in self.sums.items() if count + lost}


def add_points(points, tables):
    for k, name in enumerate(LAYERS):
        tables["by_layer"].add(name, points["error_mm"][:, points["layer"] == k])
    for segment in range(1, 18):
        tables["by_segment"].add(str(segment), points["error_mm"][:, points["segment"] == segment])
    for low, high in zip(AWAY_MM, AWAY_MM[1:]):
        chosen = (points["away_mm"] >= low) & (points["away_mm"] < high)
        name = f"{low:g} to {high:g} mm" if high < math.inf else f"{low:g} mm and more"
        tables["by_out_of_plane"].add(name, points["error_mm"][chosen])


def score(dataset, results, split=None, centre="half"):
    """All scores as a dict: means over loops, tables over points, and the loops. Raises Refused."""
    if not (dataset / "loops.csv").exists():
        raise Refused(f"{dataset}: has no loops.csv, accepted: a finished dataset")
    with open(dataset / "loops.csv", newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if split is None or row["split"] == split]
    tables = {"by_layer": Table(), "by_segment": Table(), "by_out_of_plane": Table()}
    loops, missing = [], []
    for row in rows:
        path = results / (row["id"] + ".npz")
        if not path.exists():
            missing.append(row["id"])
            continue
        native = dataset / "native" / row["id"] / "truth.npz"
        if not native.exists():
            raise Refused(f"{native}: is missing, accepted: a dataset with the layout native")
        with np.load(native, allow_pickle=False) as arrays:
            truth = dict(arrays)
        if "track_px" not in truth:
            raise Refused(f"{native}: has no tracks, accepted: a dataset with truth = [\"tracks\"]")
        result = read_result(path, truth, (int(row["height"]), int(row["width"])), centre)
        scores, points = score_loop(row, truth, result)
        loops.append(scores)
        add_points(points, tables)
    if not loops:
        raise Refused(f"{results}: has no result of a loop of {dataset}, accepted: files such as ec000001_a4c.npz")
    names = dict.fromkeys(name for loop in loops for name in loop if name != "id")
    means = {}
    for name in names:
        values = np.array([loop[name] for loop in loops if name in loop], float)
        means[name] = {"mean": values.mean(), "mean_absolute": np.abs(values).mean(), "loops": len(values)}
    return {"loops": len(loops), "missing_loops": missing, "means": means,
            **{name: table.rows() for name, table in tables.items()}, "by_loop": loops}


def print_scores(scores):
    print(f"{scores['loops']} loops, {len(scores['missing_loops'])} without a result")
    for name, mean in scores["means"].items():
        print(f"{name:28} {mean['mean']:10.4f}   |.| {mean['mean_absolute']:10.4f}   {mean['loops']} loops")
    for name in ("by_layer", "by_segment", "by_out_of_plane"):
        print(name)
        for key, row in scores[name].items():
            error = "-" if row["mean_mm"] is None else f"{row['mean_mm']:.4f}"
            print(f"    {key:16} {error:>10} mm   {row['points']} points, {row['lost_percent']:.1f} % lost")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=Path)
    parser.add_argument("results", type=Path)
    parser.add_argument("--split", choices=("train", "val", "test"), help="score these loops only")
    parser.add_argument("--centre", choices=("half", "whole"), default="half", help="coordinates of the first pixel's centre")
    parser.add_argument("--json", type=Path, help="write all scores to this file")
    options = parser.parse_args()
    try:
        scores = score(options.dataset, options.results, options.split, options.centre)
    except (Refused, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    print_scores(scores)
    if options.json:
        options.json.write_text(json.dumps(scores, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
