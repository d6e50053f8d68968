"""compare.html of the shipped heart's loop against its own cine: compare_page_test.py ECHOCINE SOURCE_FOLDER"""

import csv
import json
import os
import subprocess
import sys

import browser

METRICS = ["rms", "mean_absolute", "psnr_db", "ncc", "ssim", "mutual_information_bits", "histogram_distance",
           "gradient_correlation"]


class ComparePage(browser.PageTest):
    folder = None

    def setUp(self):
        super().setUp()
        with open(os.path.join(self.folder, "summary.json")) as file:
            self.summary = json.load(file)
        with open(os.path.join(self.folder, "frames.csv")) as file:
            self.rows = list(csv.DictReader(file))

    def test_three_loops_play_in_step(self):
        self.assertEqual(self.run_script("return page.parts.player.loops.length"), 3)
        self.assertEqual(self.run_script("return page.parts.player.count"), len(self.rows))
        self.check_player()
        shown = self.run_script("return page.parts.player.loops.map((loop) => loop.canvas.dataset.frame)")
        self.assertEqual(len(set(shown)), 1)

    def test_curves_move_the_player(self):
        charts = self.run_script("return page.parts.charts.length")
        self.assertEqual(charts, 1 + len(METRICS) + 2)  # discrepancy, metrics, calibration, time
        last_metric = len(METRICS)
        self.check_curves_move_the_player([0, 1, last_metric, charts - 1])

    def test_curves_are_those_of_the_table(self):
        frames = self.run_script("return page.data.frames")
        number = lambda text: None if text in ("", "inf") else float(text)
        for key in METRICS:
            for group in ("before", "after"):
                for shown, row in zip(frames[group][key], self.rows, strict=True):
                    expected = number(row[f"{key}_{group}"])
                    if expected is None:
                        self.assertIsNone(shown)
                    else:  # the table has six digits
                        self.assertAlmostEqual(shown, expected, delta=1e-5 * max(1e-3, abs(expected)))
        for shown, row in zip(frames["discrepancy"], self.rows, strict=True):
            self.assertAlmostEqual(shown, float(row["discrepancy"]), delta=1e-5)

    def test_numbers_are_those_of_the_summary(self):
        self.assertEqual(self.run_script("return page.data.summary"), self.summary)

    def test_numbers_can_be_read(self):
        text = self.text("numbers")
        for group in ("before_calibration", "after_calibration"):
            for key in METRICS:
                value = self.summary[group][key]
                shown = "∞" if value is None else self.run_script("return page.number(arguments[0], 4)", value)
                self.assertIn(shown, text, f"{group} {key}")
        self.assertIn(f"{self.summary['discrepancy']:.4f}", self.text("subtitle"))
        for value in self.summary["calibration"]["real_grey"]:
            self.assertIn(f"{value:.1f}", self.text("calibration"))
        self.assertIn(self.summary["time"]["method"], self.text("time"))
        self.assertIn(f"{self.summary['space']['scale']:.4f}", self.text("space"))
        for side in ("real", "synthetic"):
            self.assertIn(self.summary[side]["label"], self.text("loops"))
            self.assertIn(f"{self.summary[side]['sector']['r_max_px']:.1f}", self.text("loops"))
        for note in self.summary["notes"]:
            self.assertIn(note, self.text("notes"))

    def test_every_frame_has_its_row_and_the_row_moves_the_player(self):
        self.driver.find_element(browser.By.CSS_SELECTOR, "#frames summary").click()
        count = "return document.querySelectorAll('#frames tbody tr').length"
        self.wait(lambda: self.run_script(count) == len(self.rows), "the rows do not come")
        self.run_script("document.querySelectorAll('#frames tbody tr button')[3].click()")
        self.assert_shows(3)

    def test_sectors_can_be_checked(self):
        sizes = self.run_script("""
            return Array.from(document.querySelectorAll("#sectors img")).map((i) => [i.naturalWidth, i.naturalHeight])""")
        self.assertEqual(sizes, [[self.summary[s]["width"], self.summary[s]["height"]] for s in ("real", "synthetic")])


def make_page(folder):
    program, source = sys.argv[1:3]
    loop = os.path.join(folder, "loop")
    ComparePage.folder = os.path.join(folder, "compared")
    heart = os.path.join(folder, "heart")
    subprocess.run([program, "heart", "--look", "paper", "-o", heart, "--quiet"], check=True)
    scene = os.path.join(heart, "scene.toml")
    subprocess.run([program, "render", scene, "-o", loop, "--quiet"], check=True)
    subprocess.run([program, "compare", loop, os.path.join(loop, "cine.avi"), "-o", ComparePage.folder, "--quiet",
                    "--fps", "50"], check=True)
    return os.path.join(ComparePage.folder, "compare.html")


if __name__ == "__main__":
    browser.main(ComparePage, make_page)
