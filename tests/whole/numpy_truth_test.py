"""NumPy reads the truth of a piece of the shipped loop: numpy_truth_test.py ECHOCINE SOURCE_FOLDER"""

import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
except ImportError as missing:
    print(f"SKIPPED: {missing}: needs python3-numpy (.ci/test-packages.txt)")
    sys.exit(77)

FRAMES = 3


class Truth(unittest.TestCase):
    folder = None

    def file(self, name):
        return os.path.join(self.folder, "truth", name)

    def json(self, name):
        with open(self.file(name)) as file:
            return json.load(file)

    def test_tracks(self):
        with numpy.load(self.file("tracks.npz"), allow_pickle=False) as tracks:
            self.assertEqual(set(tracks.files), {"places_mm", "places_px", "out_of_plane_mm", "visible",
                                                 "layer", "segment", "time_s"})
            count = tracks["layer"].shape[0]
            shapes = {"places_mm": (FRAMES, count, 3), "places_px": (FRAMES, count, 2),
                      "out_of_plane_mm": (FRAMES, count), "visible": (FRAMES, count), "layer": (count,),
                      "segment": (count,), "time_s": (FRAMES,)}
            for name, shape in shapes.items():
                self.assertEqual(tracks[name].shape, shape, name)
                self.assertTrue(tracks[name].flags.c_contiguous, name)
            places = tracks["places_mm"]
            self.assertTrue(numpy.isfinite(places).all())
            self.assertTrue((tracks["out_of_plane_mm"] == places[:, :, 1]).all())
            with open(os.path.join(self.folder, "manifest.json")) as file:
                manifest = json.load(file)
            affine = numpy.array(manifest["picture"]["px_from_mm"])
            expected = places[:, :, [0, 2]] @ affine[:, :2].T + affine[:, 2]
            numpy.testing.assert_allclose(tracks["places_px"], expected, atol=2e-3)
            self.assertTrue(set(numpy.unique(tracks["segment"])) <= set(range(1, 18)))

    def test_function(self):
        function = self.json("function.json")
        self.assertEqual(len(function["frames"]), FRAMES)
        strain = numpy.array([[s["longitudinal"] for s in f["segments"]] for f in function["frames"]], dtype=float)
        self.assertEqual(strain.shape, (FRAMES, 17))
        self.assertEqual(function["view"]["label"], "a4c")
        self.assertEqual(set(function["valves"]), {"mitral_closes", "aortic_opens", "aortic_closes", "mitral_opens"})
        for frame in function["frames"]:
            self.assertEqual(len(frame["mitral_ring"]["hinges"]), 2)

    def test_contours_are_closed_polygons(self):
        for k in range(FRAMES):
            contours = self.json(f"contours_{k:04}.json")["contours"]
            cavity = [c for c in contours if c["role"] == "lv_cavity"]
            self.assertTrue(cavity and all(c["closed"] for c in cavity))
            x, z = numpy.array(cavity[0]["in_sector_mm"]).T
            area = 0.5 * abs(numpy.dot(x, numpy.roll(z, 1)) - numpy.dot(z, numpy.roll(x, 1)))
            self.assertGreater(area, 1000)

    def test_labels_are_grey_pictures_of_8_bits(self):
        for k in range(FRAMES):
            with open(self.file(f"labels_{k:04}.png"), "rb") as file:
                head = file.read(26)
            self.assertEqual(struct.unpack(">IIBB", head[16:26]), (800, 600, 8, 0))
        labels = self.json("labels.json")
        self.assertIn("lv_cavity", labels["labels"].values())


if __name__ == "__main__":
    program, source = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        Truth.folder = os.path.join(folder, "loop")
        heart = os.path.join(folder, "heart")
        subprocess.run([program, "heart", "--look", "paper", "-o", heart, "--quiet"], check=True)
        scene = os.path.join(heart, "scene.toml")
        subprocess.run([program, "render", scene, "-o", Truth.folder, "--truth", "all", "--frames", f"0:{FRAMES}",
                        "--quiet"], check=True)
        unittest.main(argv=sys.argv[:1])
