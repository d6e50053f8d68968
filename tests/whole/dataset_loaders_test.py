"""A small dataset in every layout, read by the rules of the loaders it is for: dataset_loaders_test.py ECHOCINE

With a second argument, a folder, the dataset is made or found there and kept."""

import csv
import gzip
import json
import os
import struct
import subprocess
import sys
import tarfile
import tempfile
import unittest

try:
    import cv2
    import h5py
    import nibabel
    import numpy
    import pandas
except ImportError as missing:
    print(f"SKIPPED: {missing}: needs python3-h5py, python3-nibabel, python3-opencv and python3-pandas ("
          ".ci/test-packages.txt)")
    sys.exit(77)

SPEC = """name = "loaders"
hearts = 3
views = ["a2c", "a4c"]
layouts = ["native", "echonet", "camus", "nnunet", "pointodyssey", "myotracker", "webdataset"]
shard_mb = 3
truth = ["contours", "function", "labels", "tracks"]
track_count = 60
keyframes = 12
resolution_mm = 0.3
[split]
train = 34
val = 33
test = 33
[heart]
hr = 60
edv = { uniform = [90, 150] }
ef = { uniform = [0.4, 0.65] }
[offset]
rotate_deg = { uniform = [-1, 1] }
[subject]
age = { whole = [30, 80] }
sex = { choice = ["F", "M"] }
[scene.probe]
lines = 48
samples = 128
[scene.acquisition]
frame_rate_hz = 32
[scene.signal]
look = "scanner"
quality = { choice = ["good", "medium", "poor"] }
"""
DISCS = 20
CAMUS_OF_PAPILLARY = 13  # its label among all structures; it counts as cavity in CAMUS's


def iou(a, b):
    return (a & b).sum() / (a | b).sum()


def inside(outline):
    """Pixels of 112 x 112 whose centres lie in a polygon or on its edge, as skimage.draw.polygon has them."""
    y, x = numpy.mgrid[0:112, 0:112]
    within, edge = numpy.zeros((2, 112, 112), bool)
    for (x0, y0), (x1, y1) in zip(outline, numpy.roll(outline, -1, axis=0)):
        across = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
        edge |= ((numpy.abs(across) < 1e-9) & (x >= min(x0, x1)) & (x <= max(x0, x1)) & (y >= min(y0, y1)) &
                 (y <= max(y0, y1)))
        if y0 != y1:
            within ^= ((y0 <= y) != (y1 <= y)) & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return within | edge


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Loaders(unittest.TestCase):
    folder, hearts = None, 3

    @classmethod
    def setUpClass(cls):
        cls.loops = {row["id"]: row for row in rows_of(cls.path("loops.csv"))}

    @classmethod
    def path(cls, *parts):
        return os.path.join(cls.folder, *parts)

    def truth(self, loop):
        return numpy.load(self.path("native", loop, "truth.npz"), allow_pickle=False)


class Native(Loaders):
    """The tables, and the program's own arrays."""

    def test_every_loop_is_in_the_table(self):
        self.assertEqual(len(self.loops), 2 * self.hearts)
        self.assertEqual({row["split"] for row in self.loops.values()}, {"train", "val", "test"})
        self.assertEqual(len(rows_of(self.path("failed.csv"))), 0)
        with open(self.path("loops.csv"), newline="") as file:
            columns = next(csv.reader(file))
        self.assertEqual(len(columns), len(set(columns)))
        self.assertLessEqual({"offset.rotate_deg", "view_offset.rotation_deg"}, set(columns))

    def test_native_arrays_agree_with_the_table(self):
        for name, row in self.loops.items():
            with self.truth(name) as truth:
                frames = int(row["frames"])
                side = int(row["width"])
                self.assertEqual(truth["labels"].shape, (frames, side, side))
                self.assertEqual(truth["labels"].dtype, numpy.uint8)
                volumes = truth["lv_volume_ml"]
                self.assertAlmostEqual(volumes[int(row["ed_frame"])], float(row["edv_ml"]), 3)
                self.assertAlmostEqual(volumes[int(row["es_frame"])], float(row["esv_ml"]), 3)


    def test_contours_state_where_the_picture_shows_the_border(self):
        for name, row in self.loops.items():
            with self.truth(name) as truth:
                for role in ("lv_cavity", "lv_wall", "la"):
                    visible = truth[f"contour_{role}_visible"]
                    self.assertEqual((visible.dtype, visible.shape), (numpy.uint8, truth[f"contour_{role}"].shape[:1]))
                    self.assertEqual(set(numpy.unique(visible)), {0, 1})
                points, visible = truth["contour_lv_cavity"], truth["contour_lv_cavity_visible"]
                starts = truth["contour_lv_cavity_starts"]
                for instant in ("ed", "es"):
                    lengths = numpy.zeros(2)  # all, visible
                    for k in numpy.flatnonzero(starts[:, 0] == int(row[f"{instant}_frame"])):
                        piece = slice(starts[k, 1], starts[k + 1, 1] if k + 1 < len(starts) else None)
                        edges = numpy.hypot(*(points[piece] - numpy.roll(points[piece], 1, axis=0)).T)
                        both = visible[piece] + numpy.roll(visible[piece], 1).astype(float)
                        lengths += edges.sum(), (edges * both).sum() / 2
                    self.assertAlmostEqual(lengths[1] / lengths[0], float(row[f"border_visible_{instant}"]), 4)
                self.assertAlmostEqual(truth["track_visible"].mean(), float(row["tracks_visible"]), 9)

    def test_all_png_files_are_8_bit_grey(self):
        count = 0
        for root, _, names in os.walk(self.folder):
            for name in names:
                if name.endswith(".png"):
                    with open(os.path.join(root, name), "rb") as file:
                        header = file.read(29)
                    self.assertEqual(header[12:16], b"IHDR")
                    self.assertEqual(tuple(header[24:26]), (8, 0), name)  # bits, colour type (W3C, PNG, 11.2.2)
                    count += 1
        self.assertGreater(count, 4 * 2 * self.hearts)

    def test_the_card_has_the_decorrelation_of_muscle(self):
        with open(self.path("README.md")) as file:
            card = file.read()
        for heading in ("## Distributions", "## Decorrelation of muscle", "## Comparison with real loops", "## Limits", "## Citation", "| tracks_visible |"):
            self.assertIn(heading, card)
        rows = [line.split("|") for line in card.split("out of plane, mm |\n")[1].split("\n\n")[0].splitlines()[1:]]
        medians = [float(row[4]) for row in rows]
        self.assertEqual((float(rows[0][1]), medians[0]), (0, 1))
        self.assertLess(medians[3], medians[1])
        self.assertTrue(os.path.exists(self.path("figures/decorrelation.svg")))


class Echonet(Loaders):
    """echonet/datasets/echo.py: a list, traced frames, and videos whose headers say how long they are."""

    def test_list(self):
        with open(self.path("echonet/FileList.csv")) as file:
            self.assertEqual(file.readline(), "FileName,EF,ESV,EDV,FrameHeight,FrameWidth,FPS,NumberOfFrames,Split,"
                             "EFTracing,ESVTracing,EDVTracing,EFExact,ESVExact,EDVExact\n")
        table = pandas.read_csv(self.path("echonet/FileList.csv"))
        self.assertEqual(len(table), len(self.loops))
        self.assertEqual(set(table["Split"]), {"TRAIN", "VAL", "TEST"})
        for _, row in table.iterrows():
            self.assertEqual(os.path.splitext(row["FileName"])[1], "")
            self.assertEqual((row["FrameHeight"], row["FrameWidth"]), (112, 112))
            self.assertAlmostEqual(row["EF"], 100 * (1 - row["ESV"] / row["EDV"]), 2)
            of_table = self.loops[row["FileName"]]
            self.assertEqual(row["Split"], of_table["split"].upper())
            self.assertEqual(row["NumberOfFrames"], int(of_table["frames"]))
            self.assertEqual(row["FPS"], 32)
            for kind, key in (("Exact", ""), ("Tracing", "_single_plane")):
                self.assertAlmostEqual(row["EF" + kind], float(of_table[f"ef{key}_percent"]), 3)
                self.assertAlmostEqual(row["EDV" + kind], float(of_table[f"edv{key}_ml"]), 3)
                self.assertAlmostEqual(row["ESV" + kind], float(of_table[f"esv{key}_ml"]), 3)
            for name in ("EF", "ESV", "EDV"):
                self.assertEqual(row[name], row[name + "Tracing"])

    def test_tracings_give_the_listed_ejection_fraction(self):
        """Discs between neighbouring chords, as wide as their mean square: lengths cancel but for the two axes."""
        table = pandas.read_csv(self.path("echonet/FileList.csv")).set_index("FileName")
        away = []
        for name, frames in self.traced().items():
            volumes = []
            for rows in frames.values():  # end-systole first
                axis, chords = numpy.array(rows[0]), numpy.array(rows[1:])
                squared = ((chords[:, 2:] - chords[:, :2]) ** 2).sum(axis=1)
                length = numpy.hypot(*(axis[2:] - axis[:2]))
                volumes.append(length * (squared[:-1] + squared[1:]).sum() / 2)
            away.append(100 * (1 - volumes[0] / volumes[1]) - table.loc[os.path.splitext(name)[0], "EF"])
        print(f"echonet: EF of the tracings minus the listed one: {min(away):.2f} to {max(away):.2f} points")
        self.assertLess(max(abs(a) for a in away), 1.0)

    def test_the_crop_is_in_the_loop(self):
        for name in self.loops:
            with open(self.path("native", name, "loop.json")) as file:
                loop = json.load(file)
            side = loop["width"]
            crop = loop["echonet"]["crop"]
            self.assertAlmostEqual(crop["x_px"], 0.02 * side)
            self.assertAlmostEqual(crop["y_px"], 0.02 * side)
            self.assertAlmostEqual(crop["side_px"], 0.96 * side)

    def test_videos(self):
        for name, row in self.loops.items():
            video = cv2.VideoCapture(self.path("echonet/Videos", name + ".avi"))
            frames = int(video.get(cv2.CAP_PROP_FRAME_COUNT))
            self.assertEqual(frames, int(row["frames"]))
            self.assertEqual(video.get(cv2.CAP_PROP_FPS), 32)
            self.assertEqual((video.get(cv2.CAP_PROP_FRAME_WIDTH), video.get(cv2.CAP_PROP_FRAME_HEIGHT)), (112, 112))
            for _ in range(frames):
                there, frame = video.read()
                self.assertTrue(there)
                self.assertEqual(frame.shape, (112, 112, 3))
            self.assertGreater(frame.max(), 60)
            self.assertLess(frame[:10, :10].max(), 10)  # outside of the sector

    def traced(self):
        """Frames in the file's order, as the loader groups them: name -> {frame: rows}."""
        with open(self.path("echonet/VolumeTracings.csv")) as file:
            self.assertEqual(file.readline(), "FileName,X1,Y1,X2,Y2,Frame\n")
            traced = {}
            for line in file:
                name, x1, y1, x2, y2, frame = line.rstrip("\n").split(",")
                of_frame = traced.setdefault(name, {}).setdefault(int(frame), [])
                of_frame.append([float(x1), float(y1), float(x2), float(y2)])
        return traced

    def test_tracings_rebuild_the_masks(self):
        """The loader's polygon against the exact labels at the small picture's pixel centres.

        Rounded to whole pixels, as the loader does, a small ventricle loses some; the tracing itself does not."""
        traced = self.traced()
        self.assertEqual(set(traced), {name + ".avi" for name in self.loops})
        exact_ious, rounded_ious = [], []
        for name, row in self.loops.items():
            small, large = traced[name + ".avi"].items()  # end-systole first, end-diastole last
            self.assertEqual((small[0], large[0]), (int(row["es_frame"]), int(row["ed_frame"])))
            with self.truth(name) as truth:
                labels = truth["labels"]
            side = labels.shape[1]
            margin = 0.02 * side
            centres = (margin + (numpy.arange(112) + 0.5) * (side - 2 * margin) / 112).astype(int)
            for frame, rows in (small, large):
                rows = numpy.array(rows)
                self.assertEqual(rows.shape, (21, 4))
                self.assertLess(rows[0, 1], rows[0, 3])  # the long axis, from the apex down to the base
                outline = numpy.concatenate((rows[1:, :2], rows[1:, 2:][::-1]))
                exact = labels[frame][numpy.ix_(centres, centres)] == 1
                exact_ious.append(iou(inside(outline), exact))
                rounded_ious.append(iou(inside(numpy.rint(outline)), exact))
        print(f"echonet: IoU of tracings: least {min(exact_ious):.3f}, mean {numpy.mean(exact_ious):.3f}; rounded to "
              f"pixels: least {min(rounded_ious):.3f}, mean {numpy.mean(rounded_ious):.3f}")
        self.assertGreaterEqual(min(exact_ious), 0.94)
        self.assertGreaterEqual(numpy.mean(rounded_ious), 0.94)
        self.assertGreaterEqual(min(rounded_ious), 0.90)


def disc_volume(masks, spacing_mm):
    """Simpson's rule in two planes from their masks: 1 is the cavity, 3 the atrium. Millilitres.

    The base is the middle of where the two meet, the apex the cavity's farthest pixel from it."""
    lengths, widths = [], []
    for mask in masks:
        cavity, atrium = mask == 1, mask == 3
        near = cv2.dilate(atrium.astype(numpy.uint8), numpy.ones((9, 9), numpy.uint8)) == 1
        places = numpy.argwhere(cavity).astype(float)  # (row, column)
        base = numpy.argwhere(cavity & near).mean(axis=0)
        away = numpy.linalg.norm(places - base, axis=1)
        apex = places[away >= 0.995 * away.max()].mean(axis=0)
        axis = base - apex
        axis /= numpy.linalg.norm(axis)
        along = (places - apex) @ axis
        middle = numpy.abs((places - apex) @ numpy.array([-axis[1], axis[0]])) < 1.5
        start, end = along[middle].min() - 0.5, along[middle].max() + 0.5
        disc = numpy.floor((along - start) / (end - start) * DISCS).astype(int)
        counts = numpy.bincount(disc[(disc >= 0) & (disc < DISCS)], minlength=DISCS)
        lengths.append((end - start) * spacing_mm)
        widths.append(counts * spacing_mm**2 / (lengths[-1] / DISCS))  # the mean width of each disc
    height = max(lengths) / DISCS
    return float(numpy.pi / 4 * height * (widths[0] * widths[1]).sum() / 1000)


class Camus(Loaders):
    """CAMUS's NIfTI release, as nibabel and the readers of its cfg files take it."""

    KINDS = ("ED", "ED_gt", "ES", "ES_gt", "half_sequence", "half_sequence_gt")

    def patients(self):
        for number in range(1, self.hearts + 1):
            for word, view in (("2CH", "a2c"), ("4CH", "a4c")):
                patient = f"patient{number:04}"
                folder = self.path("camus/database_nifti", patient)
                yield folder, f"{patient}_{word}_", word, self.loops[f"ec{number:06}_{view}"]

    def test_files(self):
        for folder, start, word, _ in self.patients():
            for kind in self.KINDS:
                self.assertTrue(os.path.exists(os.path.join(folder, start + kind + ".nii.gz")))
        for split, file in (("train", "training"), ("val", "validation"), ("test", "testing")):
            with open(self.path(f"camus/database_split/subgroup_{file}.txt")) as lines:
                expected = sorted({int(r["heart"]) for r in self.loops.values() if r["split"] == split})
                self.assertEqual(lines.read(), "".join(f"patient{n:04}\n" for n in expected))

    def test_header_bytes(self):
        for folder, start, _, row in self.patients():
            with open(os.path.join(folder, start + "half_sequence.nii.gz"), "rb") as file:
                packed = file.read()
            self.assertEqual(packed[3:8], b"\0" * 5)  # no name, and no time
            raw = gzip.decompress(packed)
            side = int(row["width"])
            frames = int(row["es_frame"]) - int(row["ed_frame"]) + 1
            self.assertEqual(len(raw), 352 + side * side * frames)
            self.assertEqual(struct.unpack_from("<i", raw, 0)[0], 348)
            self.assertEqual(raw[38:39], b"r")
            self.assertEqual(struct.unpack_from("<8h", raw, 40), (3, side, side, frames, 1, 1, 1, 1))
            self.assertEqual(struct.unpack_from("<2h", raw, 70), (2, 8))
            self.assertEqual(struct.unpack_from("<3f", raw, 108), (352, 1, 0))
            self.assertEqual(raw[123], 10)
            self.assertEqual(struct.unpack_from("<2h", raw, 252), (1, 1))
            self.assertEqual(raw[344:352], b"n+1\0\0\0\0\0")
            with open(os.path.join(folder, start + "ED.nii.gz"), "rb") as file:
                raw = gzip.decompress(file.read())
            self.assertEqual(struct.unpack_from("<8h", raw, 40), (2, side, side, 1, 1, 1, 1, 1))

    def test_nibabel(self):
        for folder, start, _, row in self.patients():
            images = {kind: nibabel.load(os.path.join(folder, start + kind + ".nii.gz")) for kind in self.KINDS}
            mm = float(row["mm_per_pixel"])
            self.assertLessEqual(mm, 0.31)
            sequence = images["half_sequence"]
            numpy.testing.assert_allclose(sequence.header.get_zooms(), (mm, mm, 1 / 32), rtol=1e-6)
            numpy.testing.assert_allclose(numpy.diag(sequence.affine)[:2], (mm, mm), rtol=1e-6)
            data = {kind: numpy.asarray(image.dataobj) for kind, image in images.items()}
            self.assertTrue(all(d.dtype == numpy.uint8 for d in data.values()))
            self.assertEqual(data["half_sequence"].shape, data["half_sequence_gt"].shape)
            for kind, place in (("ED", 0), ("ES", -1)):
                for gt in ("", "_gt"):
                    self.assertTrue((data[kind + gt] == data["half_sequence" + gt][:, :, place]).all())
            for t in range(data["half_sequence_gt"].shape[2]):
                self.assertEqual(set(numpy.unique(data["half_sequence_gt"][:, :, t])), {0, 1, 2, 3})
            # One cavity without holes; x runs first, y downwards from the probe.
            cavity = (data["ED_gt"].T == 1).astype(numpy.uint8)
            self.assertEqual(cv2.connectedComponents(cavity, connectivity=4)[0], 2)
            outside = cv2.copyMakeBorder(1 - cavity, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=1)
            self.assertEqual(cv2.connectedComponents(outside, connectivity=4)[0], 2)
            atrium = numpy.argwhere(data["ED_gt"].T == 3)[:, 0]
            self.assertLess(numpy.argwhere(cavity)[:, 0].mean(), atrium.mean())

    def test_info(self):
        keys = ["ED", "ES", "NbFrame", "Sex", "Age", "ImageQuality", "EF", "FrameRate"]
        for folder, _, word, row in self.patients():
            with open(os.path.join(folder, f"Info_{word}.cfg"), newline="") as file:
                text = file.read()
            self.assertTrue(text.endswith("\n"))
            pairs = [line.split(": ") for line in text[:-1].split("\n")]
            self.assertTrue(all(len(pair) == 2 for pair in pairs))
            self.assertEqual([key for key, _ in pairs], keys)
            info = dict(pairs)
            frames = str(int(row["es_frame"]) - int(row["ed_frame"]) + 1)
            self.assertEqual((info["ED"], info["ES"], info["NbFrame"]), ("1", frames, frames))
            self.assertIn(info["Sex"], ("F", "M"))
            self.assertEqual(int(info["Age"]), int(row["subject.age"]))
            self.assertIn(info["ImageQuality"], ("Good", "Medium", "Poor"))
            self.assertEqual(int(info["EF"]), round(float(row["camus.ef_views_percent"])))
            self.assertEqual(float(info["FrameRate"]), 32)

    def test_masks_give_back_biplane_volumes(self):
        """Of the two planes that are shown. Those of the heart's own planes, biplane_ml, are other ones."""
        away, own = [], []
        for kind in ("ED", "ES"):
            for number in range(1, self.hearts + 1):
                patient = f"patient{number:04}"
                masks = []
                for word in ("2CH", "4CH"):
                    file = self.path("camus/database_nifti", patient, f"{patient}_{word}_{kind}_gt.nii.gz")
                    image = nibabel.load(file)
                    masks.append(numpy.asarray(image.dataobj).T)
                volume = disc_volume(masks, float(image.header.get_zooms()[0]))
                row = self.loops[f"ec{number:06}_a4c"]
                away.append(abs(volume / float(row[f"camus.{kind.lower()}v_views_ml"]) - 1))
                own.append(volume / float(row[f"{kind.lower()}v_biplane_ml"]) - 1)
        print(f"camus: volumes of masks are at most {100 * max(away):.2f} % from those of the exact outlines, and "
              f"{100 * min(own):.1f} to {100 * max(own):.1f} % from those of the heart's own planes")
        self.assertLessEqual(max(away), 0.02)


class Nnunet(Loaders):
    """nnunetv2's verify_dataset_integrity: files by the list's words, labels consecutive, one geometry a case."""

    def test_dataset(self):
        root = self.path("nnunet/nnUNet_raw/Dataset501_EchoCine")
        with open(os.path.join(root, "dataset.json")) as file:
            dataset = json.load(file)
        self.assertEqual(dataset["channel_names"], {"0": "US"})
        self.assertEqual(dataset["file_ending"], ".png")
        self.assertEqual(sorted(dataset["labels"].values()), list(range(len(dataset["labels"]))))
        self.assertEqual(dataset["labels"]["background"], 0)
        for part in ("Tr", "Ts"):
            images = sorted(os.listdir(os.path.join(root, "images" + part)))
            labels = sorted(os.listdir(os.path.join(root, "labels" + part)))
            cases = [name[:-len("_0000.png")] for name in images]
            self.assertEqual(images, [case + "_0000.png" for case in cases])
            self.assertEqual(labels, [case + ".png" for case in cases])
            if part == "Tr":
                self.assertEqual(dataset["numTraining"], len(cases))
                training = set(cases)
            for case in cases:
                image = cv2.imread(os.path.join(root, "images" + part, case + "_0000.png"), cv2.IMREAD_UNCHANGED)
                label = cv2.imread(os.path.join(root, "labels" + part, case + ".png"), cv2.IMREAD_UNCHANGED)
                self.assertEqual((image.dtype, image.ndim, label.ndim), (numpy.uint8, 2, 2))
                self.assertEqual(image.shape, label.shape)
                self.assertTrue(set(numpy.unique(label)) <= set(dataset["labels"].values()))
                loop, frame = case.rsplit("_f", 1)
                with self.truth(loop) as truth:
                    self.assertTrue((truth["labels"][int(frame)] == label).all())
        with open(self.path("nnunet/nnUNet_preprocessed/Dataset501_EchoCine/splits_final.json")) as file:
            folds = json.load(file)
        self.assertEqual(len(folds), min(5, len({case[:8] for case in training})))
        for fold in folds:
            self.assertTrue(fold["train"] and fold["val"])
            self.assertEqual(set(fold["train"]) | set(fold["val"]), training)
            hearts = [{case[:8] for case in fold[side]} for side in ("train", "val")]
            self.assertFalse(hearts[0] & hearts[1])


class NnunetOfAllStructures(unittest.TestCase):
    def test_labels(self):
        """The same numbers in all views; reduced to CAMUS's they are those without the option."""
        with tempfile.TemporaryDirectory() as temporary:
            names = ("camus", "all")
            made = {}
            for name in names:
                text = SPEC.replace("hearts = 3", "hearts = 1").replace("resolution_mm = 0.3", "picture_px = 224")
                text = text.replace(text[text.index("layouts"):text.index("track_count")],
                                    'layouts = ["native", "nnunet"]\ntruth = ["labels"]\n')
                made[name] = make(PROGRAM, os.path.join(temporary, name),
                                  text + f"[nnunet]\nstructures = \"{name}\"\n")
            root = "nnunet/nnUNet_raw/Dataset501_EchoCine"
            with open(os.path.join(made["all"], root, "dataset.json")) as file:
                labels = json.load(file)["labels"]
            self.assertEqual(list(labels.values()), list(range(len(labels))))
            self.assertEqual(list(labels)[:4], ["background", "lv_cavity", "lv_myocardium", "la_cavity"])
            self.assertEqual(labels["papillary_muscle"], CAMUS_OF_PAPILLARY)
            part = next(p for p in ("labelsTr", "labelsTs") if os.path.exists(os.path.join(made["all"], root, p)))
            seen = {}
            for case in os.listdir(os.path.join(made["all"], root, part)):
                both = [cv2.imread(os.path.join(made[name], root, part, case), cv2.IMREAD_UNCHANGED) for name in names]
                reduced = numpy.where(both[1] == CAMUS_OF_PAPILLARY, 1, numpy.where(both[1] <= 3, both[1], 0))
                self.assertTrue((reduced == both[0]).all())
                seen.setdefault(case.split("_")[1], set()).update(numpy.unique(both[1]))
            print(f"nnunet: {len(set.union(*seen.values()))} of {len(labels)} labels in two views")
            for view in ("a2c", "a4c"):
                self.assertLessEqual({labels[n] for n in ("lv_cavity", "lv_myocardium", "la_cavity", "la_wall")}, seen[view])
            self.assertLessEqual({labels[n] for n in ("rv_cavity", "rv_wall", "ra_cavity")}, seen["a4c"])
            for loop in os.listdir(os.path.join(made["all"], "native")):
                arrays = [numpy.load(os.path.join(made[name], "native", loop, "truth.npz"))["labels"] for name in names]
                self.assertTrue((arrays[0] == arrays[1]).all())


class PointOdyssey(Loaders):
    """datasets/pointodysseydataset.py, and the later releases' names."""

    def test_sequences(self):
        for name, row in self.loops.items():
            folder = self.path("pointodyssey", row["split"], name)
            frames, side = int(row["frames"]), int(row["width"])
            pictures = sorted(os.listdir(os.path.join(folder, "rgbs")))
            self.assertEqual(pictures, [f"rgb_{i:05}.jpg" for i in range(frames)])
            picture = cv2.imread(os.path.join(folder, "rgbs", pictures[0]), cv2.IMREAD_UNCHANGED)
            self.assertEqual(picture.shape, (side, side, 3))
            masks = sorted(os.listdir(os.path.join(folder, "masks")))
            self.assertEqual(masks, [f"mask_{i:05}.png" for i in range(frames)])
            with self.truth(name) as truth:
                for mask, labels in zip(masks, truth["labels"]):
                    there = cv2.imread(os.path.join(folder, "masks", mask), cv2.IMREAD_UNCHANGED)
                    self.assertTrue((there == labels).all())
                exact = truth["track_px"]
                for file in ("annotations.npz", "anno.npz"):
                    with numpy.load(os.path.join(folder, file), allow_pickle=False) as notes:
                        count = exact.shape[1]
                        self.assertEqual(notes["trajs_2d"].shape, (frames, count, 2))
                        self.assertEqual(notes["trajs_2d"].dtype, numpy.float32)
                        self.assertEqual(notes["trajs_3d"].shape, (frames, count, 3))
                        for key in ("visibilities", "visibs", "valids"):
                            self.assertEqual(notes[key].shape, (frames, count), key)
                            self.assertTrue(set(numpy.unique(notes[key])) <= {0, 1}, key)
                        self.assertTrue((notes["visibilities"] == truth["track_visible"]).all())
                        # Pixel centres are whole numbers here.
                        numpy.testing.assert_allclose(notes["trajs_2d"], exact - 0.5, atol=1e-3)


class MyoTracker(Loaders):
    """myotracker/datasets.py, class HUNT4RVDataset: one file a folder, points as (row, column) shares."""

    def test_exams(self):
        for name, row in self.loops.items():
            folder = self.path("myotracker", row["split"], name)
            self.assertEqual(len(os.listdir(folder)), 1)
            frames, side = int(row["frames"]), int(row["width"])
            self.assertGreaterEqual(frames, 30)
            with h5py.File(os.path.join(folder, name + ".h5"), "r") as file, self.truth(name) as truth:
                self.assertEqual(set(file), {"frames", "meshes"})
                pictures, points = file["frames"], file["meshes"]
                self.assertEqual((pictures.shape, pictures.dtype), ((frames, side, side), numpy.uint8))
                self.assertEqual((points.shape, points.dtype), (truth["track_px"].shape, numpy.float32))
                numpy.testing.assert_allclose(points[:][:, :, ::-1] * side, truth["track_px"] - 0.5, atol=1e-2)
            video = cv2.VideoCapture(self.path("native", name, "cine.avi"))
            there, first = video.read()
            self.assertTrue(there)
            with h5py.File(os.path.join(folder, name + ".h5"), "r") as file:
                away = numpy.abs(first[:, :, 0].astype(int) - file["frames"][0])
            self.assertLess(away.mean(), 3)  # the same picture, but for the video's compression


class WebDataset(Loaders):
    """Samples are adjacent members that share their name up to the first dot."""

    def test_shards(self):
        found = []
        for split in ("train", "val", "test"):
            folder = self.path("webdataset", split)
            names = sorted(os.listdir(folder))
            self.assertEqual(names, [f"shard-{i:06}.tar" for i in range(len(names))])
            for name in names:
                path = os.path.join(folder, name)
                self.assertEqual(os.path.getsize(path) % 10240, 0)
                with tarfile.open(path, "r:", format=tarfile.USTAR_FORMAT) as shard:
                    members = shard.getmembers()
                    self.assertEqual([m.name for m in members], sorted(m.name for m in members))
                    for m in members:
                        self.assertTrue(m.isreg())
                        self.assertEqual((m.mtime, m.uid, m.gid, m.mode, m.uname, m.gname), (0, 0, 0, 0o644, "", ""))
                        loop, ending = m.name.split(".", 1)
                        found.append((split, loop, ending))
                        native = {"avi": "cine.avi", "json": "loop.json", "truth.npz": "truth.npz"}[ending]
                        with open(self.path("native", loop, native), "rb") as file:
                            self.assertEqual(shard.extractfile(m).read(), file.read())
                subprocess.run(["tar", "tf", path], check=True, capture_output=True)
        expected = [(row["split"], name, ending) for name, row in self.loops.items()
                    for ending in ("avi", "json", "truth.npz")]
        expected.sort(key=lambda member: ("train", "val", "test").index(member[0]))
        self.assertEqual(found, expected)  # the table's order in each split


def make(program, folder, text=SPEC):
    spec = os.path.join(folder, "loaders.toml")
    made = os.path.join(folder, "made")
    os.makedirs(folder, exist_ok=True)
    with open(spec, "w") as file:
        file.write(text)
    subprocess.run([program, "dataset", spec, "-o", made, "--quiet"], check=True)
    return made


def tested(folder, hearts):
    Loaders.folder, Loaders.hearts = folder, hearts
    return unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful()


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as temporary:
        first = make(PROGRAM, sys.argv[2] if len(sys.argv) > 2 else temporary)
        passed = tested(first, 3)
        print("joined with another dataset:", flush=True)
        second = make(PROGRAM, os.path.join(temporary, "second"), SPEC.replace("hearts = 3", "hearts = 1\nseed = 5"))
        joined = os.path.join(temporary, "joined")
        subprocess.run([PROGRAM, "dataset", "--join", first, second, "-o", joined, "--quiet"], check=True)
        del NnunetOfAllStructures  # is not of this folder
        sys.exit(0 if tested(joined, 4) and passed else 1)
