"""Archives of a small shipped loop, read by the published rules: archive_test.py ECHOCINE SOURCE_FOLDER"""

import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"SKIPPED: {missing}: needs python3-h5py and python3-numpy (.ci/test-packages.txt)")
    sys.exit(77)

LINES, SAMPLES = 40, 96


def read_exr(path):
    """Planes of an uncompressed scan-line EXR of floats: {channel: (row, column)}."""
    with open(path, "rb") as file:
        data = file.read()
    at, header = 8, {}
    while data[at] != 0:
        end = data.index(0, at)
        name, at = data[at:end].decode(), end + 1
        at = data.index(0, at) + 1
        size = struct.unpack_from("<i", data, at)[0]
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    assert header["compression"] == b"\0"
    channels, chlist = [], header["channels"]
    while chlist[0] != 0:
        end = chlist.index(0)
        channels.append(chlist[:end].decode())
        chlist = chlist[end + 17:]
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    planes = {c: numpy.empty((height, width), "<f4") for c in channels}
    for y, start in enumerate(struct.unpack_from(f"<{height}Q", data, at)):
        row = numpy.frombuffer(data, "<f4", width * len(channels), start + 8)
        for i, c in enumerate(channels):
            planes[c][y] = row[i * width:(i + 1) * width]
    return planes


class Zarr:
    """A store by the zarr 2 specification: .zgroup, .zattrs, .zarray, chunks of zlib."""

    def __init__(self, folder):
        self.folder = folder
        self.attrs = self.json(".zattrs")
        assert self.json(".zgroup") == {"zarr_format": 2}

    def json(self, *path):
        with open(os.path.join(self.folder, *path)) as file:
            return json.load(file)

    def array(self, path):
        group = path.split("/")[0]
        assert self.json(group, ".zgroup") == {"zarr_format": 2}
        meta = self.json(path, ".zarray")
        assert meta["zarr_format"] == 2 and meta["order"] == "C" and meta["compressor"]["id"] == "zlib"
        shape, chunks = meta["shape"], meta["chunks"]
        out = numpy.full(shape, meta["fill_value"], meta["dtype"])
        grid = [range(math.ceil(s / c)) for s, c in zip(shape, chunks)]
        for index in numpy.ndindex(*[len(g) for g in grid]):
            file = os.path.join(self.folder, path, ".".join(str(i) for i in index))
            with open(file, "rb") as chunk:
                values = numpy.frombuffer(zlib.decompress(chunk.read()), meta["dtype"]).reshape(chunks)
            where = tuple(slice(i * c, (i + 1) * c) for i, c in zip(index, chunks))
            out[where] = values[tuple(slice(0, s) for s in out[where].shape)]
        return out


def grey_levels(display):
    """Rounded as the program does, in single precision: sums near a half round to it."""
    return numpy.floor(numpy.float32(255) * display.astype(numpy.float32) + numpy.float32(0.5))


class Archive(unittest.TestCase):
    folder = None

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def rendered(self):
        frames = sorted(os.listdir(self.path("render", "intensity")))
        planes = [read_exr(self.path("render", "intensity", name)) for name in frames if name.endswith(".exr")]
        return {c: numpy.stack([p[c] for p in planes]) for c in planes[0]}

    def test_echoxflow(self):
        with open(self.path("root", "croissant.json")) as file:
            catalogue = json.load(file)
        rows = {}
        for record_set in catalogue["recordSet"]:
            if record_set["@id"] == "recordings":
                rows = {row["recordings/recording_id"]: row for row in record_set["data"]}
        self.assertEqual(set(rows), {"a4c", "again"})
        row = rows["a4c"]
        self.assertEqual(row["recordings/exam_id"], "ec01")
        self.assertEqual(row["recordings/stitch_beat_count"], 1)
        store = Zarr(self.path("root", row["recordings/zarr_path"]))
        manifest = store.attrs["recording_manifest"]
        exr = self.rendered()
        for path in row["recordings/array_paths"]:
            data = store.array(path)
            if not path.startswith("data/"):
                continue
            name = path[5:]
            times = store.array("timestamps/" + name)
            self.assertEqual(times.size, data.shape[0], path)
            self.assertTrue(numpy.isfinite(times).all() and (numpy.diff(times) > 0).all())
            self.assertEqual(row["recordings/frame_counts_by_content_type"][name], data.shape[0])
            step = row["recordings/median_delta_time_by_content_type"][name]
            self.assertAlmostEqual(step, float(numpy.median(numpy.diff(times))), places=5)
            if data.dtype.kind == "f":
                self.assertTrue(numpy.isfinite(data).all(), path)
        bmode, doppler = store.array("data/2d_brightness_mode"), store.array("data/tissue_doppler")
        self.assertEqual(bmode.dtype, numpy.uint8)
        numpy.testing.assert_array_equal(bmode, grey_levels(exr["display.Y"]))
        numpy.testing.assert_array_equal(doppler, numpy.nan_to_num(exr["velocity.beam"], nan=0.0))
        self.assertGreater(numpy.abs(doppler).max(), 0.02)
        sectors = {s["semantic_id"]: s for s in manifest["sectors"]}
        self.assertEqual(set(sectors), {"bmode", "tissue_doppler"})
        limit = sectors["tissue_doppler"]["velocity_limit_mps"]
        self.assertGreater(limit, 0)
        self.assertLessEqual(numpy.abs(doppler).max(), limit)
        geometry = sectors["bmode"]["geometry"]
        self.assertEqual(geometry["grid_size"], [SAMPLES, LINES])
        spacing = (0.1658 - 0.002) / SAMPLES
        self.assertAlmostEqual(geometry["depth_start_m"], 0.002 + spacing / 2)
        self.assertAlmostEqual(geometry["depth_end_m"], 0.1658 - spacing / 2)
        self.assertAlmostEqual(geometry["angle_start_rad"], -math.radians(40))
        self.assertAlmostEqual(geometry["angle_end_rad"], math.radians(40))

    def test_contour_and_strain(self):
        store = Zarr(self.path("root", "ec01", "a4c.zarr"))
        contour, curve = store.array("data/4ch_contour"), store.array("data/4ch_curve")
        frames = store.array("data/2d_brightness_mode").shape[0]
        self.assertEqual(contour.shape, (frames, 65, 2))
        steps = numpy.linalg.norm(numpy.diff(contour, axis=1), axis=2)
        self.assertTrue((steps.max(axis=1) < 1.1 * steps.mean(axis=1)).all())
        with open(self.path("render", "truth", "function.json")) as file:
            function = json.load(file)["frames"]
        for t, frame in enumerate(function):
            hinges = numpy.array([h["mm"] for h in frame["mitral_ring"]["hinges"]], float)
            # The cavity's border is under 4 mm from the ring's hinges.
            self.assertLess(numpy.abs(1e3 * contour[t, [0, -1]] - hinges[:, [0, -1]]).max(), 4, t)
        self.assertLess(curve.min(), -10)
        self.assertAlmostEqual(float(curve[0]), 0, places=3)
        # The apex is nearest to the probe in this view, the ring farthest.
        self.assertTrue((contour[:, 32, 1] < contour[:, 0, 1]).all())

    def test_zea(self):
        exr = self.rendered()
        with h5py.File(self.path("loop.hdf5"), "r") as file:
            self.assertEqual(file.attrs["zea_version"], "0.1.0")
            self.assertEqual(file.attrs["probe_name"], "generic")
            data = file["tracks/track_0/data"]
            self.assertEqual(set(data), {"image", "tissue_doppler"})
            image, doppler = data["image"], data["tissue_doppler"]
            self.assertEqual(image["values"].dtype, numpy.uint8)
            self.assertEqual(doppler["values"].dtype, numpy.float32)
            numpy.testing.assert_array_equal(image["values"][()], grey_levels(exr["display.Y"]))
            numpy.testing.assert_array_equal(doppler["values"][()], exr["velocity.beam"])
            self.assertEqual(doppler["unit"].asstr()[()], "m/s")
            for group in (image, doppler):
                times = group["timestamps"][()]
                self.assertEqual(times.dtype, numpy.float32)
                numpy.testing.assert_allclose(times, numpy.arange(len(times)) / 8, atol=1e-6)
                self.assertEqual(float(group["start_time_offset"][()]), 0)
                places = group["coordinates"][()]
                self.assertEqual(places.shape, (SAMPLES, LINES, 3))
                self.assertTrue((places[..., 1] == 0).all())
                depth = 0.002 + (numpy.arange(SAMPLES) + 0.5) * (0.1658 - 0.002) / SAMPLES
                angle = numpy.radians(numpy.linspace(-40, 40, LINES))
                numpy.testing.assert_allclose(places[..., 0], depth[:, None] * numpy.sin(angle), atol=1e-7)
                numpy.testing.assert_allclose(places[..., 2], depth[:, None] * numpy.cos(angle), atol=1e-7)
            ecg = file["metadata/ecg"]
            self.assertEqual(ecg["samples"].dtype, numpy.float32)
            self.assertEqual(float(ecg["sampling_frequency"][()]), 500)
            self.assertAlmostEqual(float(ecg["start_time_offset"][()]), -0.1, places=6)
            samples = ecg["samples"][()]
            self.assertEqual(int(numpy.argmax(samples[:100])), 50)  # the R wave at the first frame
            # From 0.1 s before the loop to 0.1 s after the last frame's interval.
            self.assertAlmostEqual((len(samples) - 1) / 500 - 0.1, exr["display.Y"].shape[0] / 8 + 0.1, delta=0.002 + 1e-6)
            self.assertAlmostEqual(float(ecg["samples"][()].max()), 1, delta=0.05)
            self.assertEqual(file["metadata/subject/id"].asstr()[()], "ec01")
            strain = file["metadata/longitudinal_strain/samples"][()]
            self.assertEqual(strain.shape, (exr["display.Y"].shape[0],))

    def test_refusals(self):
        for options, words in ((["--exam", "a/b"], "--exam"), (["--recording", ".."], "--recording")):
            run = subprocess.run([PROGRAM, "archive", self.path("scene.toml"), "-o", self.path("bad"), "--layout", "echoxflow",
                                  "--quiet", *options], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2)
            self.assertIn(words, run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1)
            self.assertFalse(os.path.exists(self.path("bad")))

    def test_a_damaged_catalogue_is_refused_before_anything_changes(self):
        os.makedirs(self.path("damaged"))
        for text in ("[]", '{"recordSet": 3}', "{"):
            with open(self.path("damaged", "croissant.json"), "w") as file:
                file.write(text)
            run = subprocess.run([PROGRAM, "archive", self.path("scene.toml"), "-o", self.path("damaged"), "--layout", "echoxflow",
                                  "--quiet"], capture_output=True, text=True)
            self.assertEqual((run.returncode, run.stderr.count("\n")), (2, 1), run.stderr)
            self.assertIn("is not a catalogue of recordings", run.stderr)
            self.assertEqual(os.listdir(self.path("damaged")), ["croissant.json"])


if __name__ == "__main__":
    PROGRAM, ROOT = sys.argv.pop(1), sys.argv.pop(1)
    with tempfile.TemporaryDirectory() as folder:
        Archive.folder = folder
        with open(os.path.join(ROOT, "examples/beating_heart/scene.toml")) as file:
            scene = file.read()
        scene = scene.replace("../../data", os.path.join(ROOT, "data"))
        for key, value in (("lines", LINES), ("samples", SAMPLES), ("frame_rate_hz", 8)):
            scene = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", scene)
        scene += ('\n[output]\nwidth = 96\nheight = 80\nexr_compression = "none"\nchannels = ["display.Y", "velocity.beam"]\n'
                  '[truth]\nwrite = ["function"]\n')
        with open(os.path.join(folder, "scene.toml"), "w") as file:
            file.write(scene)
        scene_file, quiet = os.path.join(folder, "scene.toml"), ["--quiet"]
        subprocess.run([PROGRAM, "render", scene_file, "-o", os.path.join(folder, "render"), *quiet], check=True)
        for recording in (["--recording", "again"], [], []):
            subprocess.run([PROGRAM, "archive", scene_file, "-o", os.path.join(folder, "root"), "--layout", "echoxflow", "--exam",
                            "ec01", *recording, *quiet], check=True)
        subprocess.run([PROGRAM, "archive", scene_file, "-o", os.path.join(folder, "loop.hdf5"), "--layout", "zea", "--exam", "ec01",
                        *quiet], check=True)
        unittest.main(verbosity=1)
