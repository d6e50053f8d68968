"""examples/datasets/score_tracks.py against tracks whose scores are known: score_tracks_test.py ECHOCINE SOURCE_DIR"""

import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
except ImportError as missing:
    print(f"SKIPPED: {missing}: needs python3-numpy")
    sys.exit(77)

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
SCRIPT = SOURCE / "examples/datasets/score_tracks.py"
SPEC = """name = "score"
hearts = 3
views = ["a4c"]
layouts = ["native"]
truth = ["labels", "tracks"]
track_count = 150
"""

spec = importlib.util.spec_from_file_location("score_tracks", SCRIPT)
score_tracks = importlib.util.module_from_spec(spec)
spec.loader.exec_module(score_tracks)


class ScoreTracks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.place = pathlib.Path(temporary.name)
        small = (SOURCE / "tests/support/small_loops.toml").read_text()
        (cls.place / "spec.toml").write_text(SPEC + small)
        cls.dataset = cls.place / "made"
        subprocess.run([PROGRAM, "dataset", cls.place / "spec.toml", "-o", cls.dataset, "--quiet"], check=True)
        cls.truth = {}
        for loop in sorted((cls.dataset / "native").iterdir()):
            with numpy.load(loop / "truth.npz") as arrays:
                cls.truth[loop.name] = dict(arrays)
        with open(cls.dataset / "loops.csv", newline="") as file:
            cls.rows = {row["id"]: row for row in score_tracks.csv.DictReader(file)}

    def results(self, name, change, **more):
        """A folder of results: tracks as `change` makes them of the exact ones of a loop."""
        folder = self.place / name
        folder.mkdir(exist_ok=True)
        for loop, truth in self.truth.items():
            arrays = {key: make(truth) for key, make in more.items()}
            numpy.savez(folder / (loop + ".npz"), tracks=change(truth["track_px"].astype(float), self.rows[loop]), **arrays)
        return folder

    def means(self, folder, **options):
        scores = score_tracks.score(self.dataset, folder, **options)
        return scores, {name: mean["mean"] for name, mean in scores["means"].items()}

    def test_exact_tracks_are_perfect(self):
        folder = self.results("exact", lambda px, row: px, labels=lambda t: t["labels"], visible=lambda t: t["track_visible"] > 0)
        scores, means = self.means(folder)
        self.assertEqual((scores["loops"], scores["missing_loops"]), (3, []))
        for name in ("mean_mm", "median_mm", "lost_percent", "ef_error", "gls_error"):
            self.assertAlmostEqual(means[name], 0, 9, name)
        for name in ("dice_ed", "dice_es", "labels_dice_ed", "labels_dice_es"):
            self.assertEqual(means[name], 1, name)
        for name in ("within_percent", "within_1_px_percent", "visibility_accuracy_percent"):
            self.assertEqual(means[name], 100, name)
        # The outline is that of the ventricle: its EF is near the exact one of the volumes, its mask near the labels.
        self.assertLess(scores["means"]["ef_minus_exact"]["mean_absolute"], 15)
        for loop, truth in self.truth.items():
            outline = score_tracks.Outline(truth["track_px"][0].astype(float), truth["track_layer"])
            mask = score_tracks.inside(outline.at(truth["track_px"][0].astype(float)), truth["labels"].shape[1:])
            self.assertGreater(score_tracks.dice(mask, truth["labels"][0] == 1), 0.85)

    def test_a_shift_is_its_length_everywhere(self):
        folder = self.results("shifted", lambda px, row: px + [3, 4])
        scores, means = self.means(folder)
        sizes = [float(row["mm_per_pixel"]) for row in self.rows.values()]
        mm = numpy.mean(sizes)
        self.assertAlmostEqual(means["mean_mm"], 5 * mm, 9)
        self.assertAlmostEqual(means["median_mm"], 5 * mm, 9)
        self.assertAlmostEqual(means["ef_error"], 0, 6)
        self.assertAlmostEqual(means["gls_error"], 0, 6)
        self.assertLess(means["dice_ed"], 0.95)
        side = 112
        for px in score_tracks.WITHIN_PX:
            self.assertEqual(means[f"within_{px}_px_percent"], 100 if 5 * 256 / side < px else 0)
        for table in ("by_layer", "by_segment", "by_out_of_plane"):
            for row in scores[table].values():
                if row["points"]:
                    self.assertGreaterEqual(row["mean_mm"], 5 * min(sizes) - 1e-9)
                    self.assertLessEqual(row["mean_mm"], 5 * max(sizes) + 1e-9)
        self.assertEqual(sum(row["points"] for row in scores["by_out_of_plane"].values()),
                         sum(t["track_px"][1:, :, 0].size for t in self.truth.values()))

    def test_the_centre_of_the_first_pixel(self):
        folder = self.results("whole", lambda px, row: px - 0.5)
        self.assertAlmostEqual(self.means(folder, centre="whole")[1]["mean_mm"], 0, 9)
        self.assertGreater(self.means(folder)[1]["mean_mm"], 0.1)

    def test_a_ventricle_that_is_larger_at_end_systole_has_less_ef_and_strain(self):
        """Scaled by s at end-systole, lengths grow by s and volumes of the area-length rule by its cube."""
        s = 1.1

        def scaled(px, row):
            px = px.copy()
            es = int(row["es_frame"])
            px[es] = 50 + s * (px[es] - 50)
            return px

        exact = {loop["id"]: loop for loop in self.means(self.results("exact", lambda px, row: px))[0]["by_loop"]}
        scores, _ = self.means(self.results("scaled", scaled))
        for loop in scores["by_loop"]:
            true = exact[loop["id"]]
            self.assertAlmostEqual(loop["ef_error"], (100 - true["ef_percent"]) * (1 - s**3), 6)
            self.assertAlmostEqual(loop["gls_error"], (100 + true["gls_percent"]) * (s - 1), 6)
            self.assertEqual(loop["dice_ed"], 1)
            self.assertLess(loop["dice_es"], 1)

    def test_lost_points_count_as_lost_and_not_as_errors(self):
        def every_fifth_lost(px, row):
            px = px.copy()
            px[:, ::5] = numpy.nan
            return px

        scores, means = self.means(self.results("lost", every_fifth_lost))
        self.assertAlmostEqual(means["lost_percent"], 20, 9)
        self.assertAlmostEqual(means["mean_mm"], 0, 9)
        self.assertLess(means["within_16_px_percent"], 90)
        self.assertGreater(means["within_16_px_percent"], 70)
        folder = self.results("all_lost", lambda px, row: numpy.full_like(px, numpy.nan))
        scores, means = self.means(folder)
        self.assertEqual((means["lost_percent"], means["within_16_px_percent"]), (100, 0))
        for name in ("mean_mm", "ef_error", "dice_ed"):
            self.assertNotIn(name, means)
        self.assertIsNone(scores["by_layer"]["middle"]["mean_mm"])
        (folder / "ec000002_a4c.npz").unlink()
        self.assertEqual(self.means(folder)[0]["missing_loops"], ["ec000002_a4c"])

    def test_the_command(self):
        folder = self.results("command", lambda px, row: px + [3, 4])
        output = self.place / "scores.json"
        ran = subprocess.run([sys.executable, SCRIPT, self.dataset, folder, "--split", "train", "--json", output],
                             capture_output=True, text=True)
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        self.assertIn("2 loops, 0 without a result", ran.stdout)
        self.assertEqual(json.loads(output.read_text())["loops"], 2)
        numpy.savez(folder / "ec000001_a4c.npz", tracks=numpy.zeros((3, 2, 2)))
        for arguments in ([self.dataset, folder], [self.dataset, self.place / "absent"], [self.place, folder]):
            ran = subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True)
            self.assertEqual(ran.returncode, 2)
            self.assertEqual(len(ran.stderr.splitlines()), 1, ran.stderr)
            self.assertIn("accepted", ran.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
