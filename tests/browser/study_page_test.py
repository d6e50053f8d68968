"""study.html of a small study of a steep wall: study_page_test.py ECHOCINE SOURCE_FOLDER"""

import json
import os
import subprocess
import sys

import browser


class StudyPage(browser.PageTest):
    folder = None

    def setUp(self):
        super().setUp()
        with open(os.path.join(self.folder, "study.json")) as file:
            self.study = json.load(file)

    def points(self):
        """Every point on the plot: [series, index, index of its row, x, y of the page]."""
        return self.run_script("""
            const chart = page.parts.charts[0];
            chart.getDom().scrollIntoView({ block: "center" });
            const box = chart.getDom().getBoundingClientRect();
            return chart.getOption().series.flatMap((series, s) => series.data.flatMap((point, i) => {
              if (!point.row) return [];
              const [x, y] = chart.convertToPixel({ seriesIndex: s }, point.value);
              // The chart's points are copies.
              const row = page.data.rows.findIndex((r) => ["sweep", "knob", "value"].every((key) => r[key] === point.row[key]));
              return [[s, i, row, Math.round(box.left + x), Math.round(box.top + y)]];
            }));""")

    def test_numbers_are_those_of_the_study(self):
        data = self.run_script("return page.data")
        self.assertEqual({key: data[key] for key in self.study}, self.study)

    def test_every_row_can_be_read(self):
        shown = self.run_script("""
            return Array.from(document.querySelectorAll("#table tbody tr"),
              (row) => Array.from(row.cells, (cell) => cell.textContent))""")
        self.assertEqual(len(shown), len(self.study["rows"]))
        for cells, row in zip(shown, self.study["rows"], strict=True):
            self.assertEqual(cells[0].removesuffix(" *"), row["value"])
            self.assertEqual(cells[0].endswith(" *"), row["timing"]["pareto"])
            self.assertAlmostEqual(float(cells[3]), row["timing"]["ms_per_frame"], delta=0.00501)
            self.assertAlmostEqual(float(cells[5]), row["errors"]["rms_db"], delta=0.000501)
            self.assertAlmostEqual(float(cells[7]), row["errors"]["ssim"], delta=0.0000501)

    def test_a_click_on_a_point_shows_its_pictures(self):
        points = self.points()
        rows = self.study["rows"]
        places = [(x, y) for *_, x, y in points]
        # Points that lie on one another cannot be told apart by a click.
        alone = [p for p in points if sum(abs(p[3] - x) < 20 and abs(p[4] - y) < 20 for x, y in places) == 1]
        self.assertTrue(alone)
        for _, _, row, x, y in alone:
            actions = browser.ActionChains(self.driver)
            actions.w3c_actions.pointer_action.move_to_location(x, y)
            actions.w3c_actions.pointer_action.click()
            actions.perform()
            images = self.run_script("return page.data.images[arguments[0]]", rows[row]["point"])
            self.wait(lambda: self.run_script("return document.getElementById('thumbnail').src") == images["thumbnail"],
                      f"row {row} is not shown")
            self.assertEqual(self.run_script("return document.getElementById('difference').src"), images["difference"])
            self.wait(lambda: self.run_script("return document.getElementById('thumbnail').naturalWidth > 0"),
                      "the thumbnail cannot be decoded")
            self.assertIn(rows[row]["value"], self.text("picked-title"))

    def test_every_measure_draws_every_row(self):
        count = len(self.run_script("return Array.from(document.getElementById('measure').options, (o) => o.value)"))
        for i in range(count):
            self.run_script("""
                const select = document.getElementById("measure");
                select.value = arguments[0];
                select.dispatchEvent(new Event("change"));""", str(i))
            drawn = {row for _, _, row, *_ in self.points()}
            self.assertEqual(drawn, set(range(len(self.study["rows"]))), f"measure {i}")

    def test_the_plot_alone_fills_a_window(self):
        self.driver.get("about:blank")
        self.driver.set_window_size(1200, 700)
        self.driver.get("file://" + os.path.abspath(self.path) + "#plot")
        self.wait(lambda: self.run_script("return page.parts.charts[0].getHeight()") < 560, "the plot keeps its height")
        shown = self.run_script("""
            return Array.from(document.querySelectorAll("section, footer"), (e) => [e.id, e.getClientRects().length])""")
        self.assertEqual([name for name, boxes in shown if boxes], ["plot"])
        box = self.run_script("""
            const box = page.parts.charts[0].getDom().getBoundingClientRect();
            return [box.width / innerWidth, box.height / innerHeight, box.bottom <= innerHeight];""")
        self.assertGreater(box[0], 0.9)
        self.assertGreater(box[1], 0.6)
        self.assertTrue(box[2])


def make_page(folder):
    program, source = sys.argv[1:3]
    StudyPage.folder = os.path.join(folder, "study")
    scene = os.path.join(source, "examples", "steep_wall", "scene.toml")
    subprocess.run([program, "study", scene, "-o", StudyPage.folder, "--quiet", "--frames", "1", "--repeats", "1",
                    "--knobs", "samples,lines"], check=True)
    return os.path.join(StudyPage.folder, "study.html")


if __name__ == "__main__":
    browser.main(StudyPage, make_page)
