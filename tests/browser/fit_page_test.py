"""fit.html of a heart fitted to a small loop: fit_page_test.py ECHOCINE SOURCE_FOLDER"""

import json
import os
import subprocess
import sys

import browser

DIALS = "edv=130,wall-thickness=9,sphericity=0.6,mapse=13,conicity=0.7,apical-motion=1,rv-edv=135,hr=72"


class FitPage(browser.PageTest):
    def test_result_and_assumptions_are_those_of_the_file(self):
        with open(os.path.join(os.path.dirname(PAGE[0]), "fit.json")) as file:
            fit = json.load(file)
        ef = fit["result"]["ef"]
        self.assertIn(f"EF {ef['value']:.3f} ({ef['low']:.3f} to {ef['high']:.3f})", self.text("subtitle"))
        self.assertIn("EDV 130", self.text("subtitle"))
        for text in fit["assumptions"]:
            self.assertIn(text, self.text("assumptions"))
        self.assertEqual(self.run_script("return document.getElementById('refusal').hidden"), True)
        rows = self.run_script("return Array.from(document.querySelectorAll('#result tbody tr'), (row) => row.cells[0].textContent)")
        self.assertEqual(rows, ["ef"])

    def test_loop_disagreement_and_twin_play_in_step_with_the_heart(self):
        self.assertEqual(self.run_script("return page.parts.player.loops.length"), 3)
        self.assertEqual(self.run_script("return page.parts.player.count"), 20)
        self.assertEqual(self.run_script("return page.frames('a4c twin').length"), 20)
        self.run_script("page.parts.player.jump(8)")
        self.wait_for_frame(8)
        self.assertEqual(self.run_script("return page.parts.player.index"), 8)
        self.assertAlmostEqual(self.run_script("return page.parts.space.phase"), 8 / 20)

    def test_regions_of_the_file_are_listed(self):
        with open(os.path.join(os.path.dirname(PAGE[0]), "fit.json")) as file:
            regions = json.load(file)["views"][0]["regions"]
        self.assertIn("mid inferoseptal", [region.get("segment") for region in regions])
        rows = self.run_script("return Array.from(document.querySelectorAll('#regions tbody tr'), (row) => [row.cells[1].textContent, row.cells[5].textContent])")
        self.assertEqual(sorted(rows), sorted([region.get("segment", region.get("structure")), "differs" if region["significant"] else "" if region["visible"] else "hardly visible"] for region in regions))

    def test_the_band_holds_the_volume(self):
        low, width, value = self.run_script("""
            return page.parts.charts[0].getOption().series.map((s) => s.data.map((p) => p[1]));""")
        self.assertEqual(len(value), 50)
        for l, w, v in zip(low, width, value):
            self.assertTrue(l - 1e-6 <= v <= l + w + 1e-6, (l, v, w))


PAGE = []


def make_page(folder):
    program = sys.argv[1]
    run = lambda *arguments: subprocess.run([program, *arguments, "--quiet"], check=True)
    heart, loop, out = (os.path.join(folder, name) for name in ("heart", "loop", "out"))
    dials = [part for dial in DIALS.split(",") for part in ("--" + dial).split("=")]
    run("heart", "--ef", "0.5", *dials, "--keyframes", "8", "--look", "paper", "-o", heart)
    with open(os.path.join(heart, "scene.toml")) as file:
        text = file.read()
    for given, small in (("lines = 256", "lines = 96"), ("samples = 1024", "samples = 192"), ("frame_rate_hz = 50", "frame_rate_hz = 24")):
        assert given in text, given
        text = text.replace(given, small)
    with open(os.path.join(heart, "small.toml"), "w") as file:
        file.write(text)
    run("render", os.path.join(heart, "small.toml"), "-o", loop)
    run("fit", "--no-cache", "--view", f"a4c={loop}", "--tilt", "0", "--dials", DIALS, "-o", out)
    PAGE.append(os.path.join(out, "fit.html"))
    return PAGE[0]


if __name__ == "__main__":
    browser.main(FitPage, make_page)
