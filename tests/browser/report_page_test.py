"""report.html of a piece of the shipped heart's loop: report_page_test.py ECHOCINE SOURCE_FOLDER"""

import base64
import json
import os
import struct
import subprocess
import sys

import browser

FIRST, LAST = 10, 22  # of the loop's frames: numbers of frames are not their places on the page


def avi_frames(path):
    """The encoded frames of an AVI file: its "00dc" chunks."""
    data = open(path, "rb").read()
    at = data.index(b"movi") + 4
    frames = []
    while data[at:at + 4] == b"00dc":
        size = struct.unpack("<I", data[at + 4:at + 8])[0]
        frames.append(data[at + 8:at + 8 + size])
        at += 8 + size + size % 2
    return frames


class ReportPage(browser.PageTest):
    folder = None

    def setUp(self):
        super().setUp()
        with open(os.path.join(self.folder, "manifest.json")) as file:
            self.manifest = json.load(file)

    def test_frames_are_those_of_the_cine(self):
        cine = avi_frames(os.path.join(self.folder, "cine.avi"))
        self.assertEqual(len(cine), LAST - FIRST)
        page = self.run_script("return page.frames('cine').map((frame) => frame.text)")
        self.assertEqual([base64.b64decode(text) for text in page], cine)

    def test_player(self):
        self.check_player()

    def test_curves_move_the_player(self):
        self.check_curves_move_the_player([1])  # volumes; the ECG has points of its own

    def test_strain_moves_the_player(self):
        self.check_curves_move_the_player([2, 3])

    def test_truth_is_drawn_over_the_loop_when_ticked(self):
        pixels = """
            const canvas = document.querySelector("#player canvas");
            return Array.from(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data)
              .reduce((sum, v) => sum + v, 0)"""
        plain = self.run_script(pixels)
        for kind in ("labels", "contours", "tracks"):
            tick = f"document.getElementById('show-{kind}').click()"
            self.run_script(tick)
            self.wait(lambda: self.run_script(pixels) > plain + 1000, f"{kind} are not drawn")
            self.run_script(tick)
            self.wait(lambda: self.run_script(pixels) == plain, f"{kind} stay")

    def test_meshes_in_space_come_when_they_are_looked_at(self):
        self.assertFalse(self.run_script("return !!page.parts.space"))
        self.run_script("document.getElementById('space').scrollIntoView()")
        self.wait(lambda: self.run_script("return !!page.parts.space"), "no meshes come")
        self.run_script("page.parts.player.jump(5)")
        self.wait_for_frame(5)
        phase = self.manifest["frames"][5]["phase"]
        self.wait(lambda: self.run_script("return page.parts.space.phase") == phase, "they are of another frame")
        names = self.run_script("return page.data.view.structures.map((s) => s.name)")
        self.assertEqual(names, [s["name"] for s in self.manifest["scene"]["structures"]])

    def test_ecg_moves_the_player(self):
        for share in (0.25, 0.75):
            points = self.run_script("return page.parts.charts[0].getOption().series[0].data.length")
            i = int(share * points)
            time_s = self.run_script("return page.data.ecg.time_s[arguments[0]]", i)
            times = [f["time_s"] for f in self.manifest["frames"]]
            nearest = min(range(len(times)), key=lambda k: abs(times[k] - time_s))
            self.click_curve(0, 0, i)
            self.wait(lambda: abs(self.frame() - nearest) <= 1, "the ECG does not move the player")
            self.assert_shows(self.frame())

    def test_numbers_are_those_of_the_manifest(self):
        data, manifest = self.run_script("return page.data"), self.manifest
        frames = manifest["frames"]
        for key in ("index", "time_s", "phase", "beat"):
            self.assertEqual(data["frames"][key], [f[key] for f in frames])
        for name, volumes in data["frames"]["volumes_ml"].items():
            self.assertEqual(volumes, [f["volumes_ml"][name] for f in frames])
        self.assertEqual(set(data["frames"]["volumes_ml"]), set(frames[0]["volumes_ml"]))
        for key in ("plan", "warnings", "media", "reference_intensity"):
            self.assertEqual(data[key], manifest[key])
        measured = data["measured"]
        self.assertEqual(measured["timings_ms_per_frame"], manifest["timings_ms_per_frame"])
        self.assertEqual([{**e, "time_share": measured["time_shares"][e["name"]]} for e in data["effects"]],
                         manifest["effects"])
        self.assertEqual(data["probe"], manifest["scene"]["probe"])

    def test_numbers_can_be_read(self):
        for name in self.manifest["frames"][0]["volumes_ml"]:
            ml = [f["volumes_ml"][name] for f in self.manifest["frames"]]
            row = self.run_script("""
                const rows = document.querySelectorAll("#volume-table tbody tr");
                return Array.from(rows).find((r) => r.cells[0].textContent === arguments[0])
                  .innerText.split("\\t").map((text) => text.trim());""", name)
            largest, smallest = ml.index(max(ml)), ml.index(min(ml))
            self.assertAlmostEqual(float(row[1]), ml[0], delta=0.00501)
            self.assertAlmostEqual(float(row[2]), max(ml), delta=0.00501)
            self.assertEqual(int(row[3]), FIRST + largest)
            self.assertAlmostEqual(float(row[4]), min(ml), delta=0.00501)
            self.assertEqual(int(row[5]), FIRST + smallest)
        for effect in self.manifest["effects"]:
            self.assertIn(effect["reason"], self.text("effects"))
        for stage, ms in self.manifest["timings_ms_per_frame"].items():
            self.assertIn("wall clock" if stage == "wall" else stage.replace("_", " "), self.text("times"))
            self.assertIn(f"{ms:.2f}", self.text("times"))
        for name, medium in self.manifest["media"].items():
            self.assertIn(name, self.text("media"))
            self.assertIn(f"{medium['alpha_np_per_m']:.2f}", self.text("media"))
        for structure in self.manifest["scene"]["structures"]:
            self.assertIn(structure["name"], self.text("structures"))
        self.assertIn("2.5 MHz", self.text("probe"))

    def test_meshes_are_on_paper_though_nobody_scrolled_to_them(self):
        self.browser.open(self.path)
        self.assertTrue(self.run_script("return !page.parts.space"))
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        try:
            self.wait(lambda: self.run_script("return !!page.parts.space"), "no meshes are drawn for print")
        finally:
            self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})

    def test_a_row_follows_the_player(self):
        name = "lv_cavity"
        for k in (3, 7):
            self.run_script("page.parts.player.jump(arguments[0])", k)
            self.wait_for_frame(k)
            shown = self.run_script("""
                const rows = document.querySelectorAll("#volume-table tbody tr");
                return Array.from(rows).find((r) => r.cells[0].textContent === arguments[0]).cells[1].textContent""", name)
            self.assertAlmostEqual(float(shown), self.manifest["frames"][k]["volumes_ml"][name], delta=0.00501)


def make_page(folder):
    program, source = sys.argv[1:3]
    ReportPage.folder = os.path.join(folder, "loop")
    scene = os.path.join(source, "examples", "beating_heart", "scene.toml")
    subprocess.run([program, "render", scene, "-o", ReportPage.folder, "--frames", f"{FIRST}:{LAST}",
                    "--truth", "all", "--quiet"],
                   check=True)
    return os.path.join(ReportPage.folder, "report.html")


if __name__ == "__main__":
    browser.main(ReportPage, make_page)
