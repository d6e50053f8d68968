"""The page of `view` for the shipped heart: view_page_test.py ECHOCINE SOURCE_FOLDER"""

import os
import subprocess
import sys

import browser

# The pixels that the canvas shows now, as their sum per channel.
PIXELS = """
    const space = page.parts.space;
    space.renderNow();
    const copy = document.createElement("canvas");
    copy.width = space.canvas.width; copy.height = space.canvas.height;
    const context = copy.getContext("2d");
    context.drawImage(space.canvas, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data, sum = [0, 0, 0, 0];
    for (let i = 0; i < data.length; ++i) sum[i % 4] += data[i];
    return sum;"""


class ViewPage(browser.PageTest):
    def pixels(self):
        return self.run_script(PIXELS)

    def test_draws_every_structure_that_is_ticked(self):
        before = self.pixels()
        self.assertGreater(before[3], 0)
        names = self.run_script("return page.data.view.structures.map((s) => s.name)")
        self.run_script("document.getElementById(`structure-${arguments[0]}`).click()", names.index("lv_wall"))
        self.assertNotEqual(self.pixels(), before)
        self.run_script("document.getElementById(`structure-${arguments[0]}`).click()", names.index("lv_wall"))
        self.assertEqual(self.pixels(), before)

    def test_legend_names_medium_role_and_extent(self):
        legend = self.run_script("return document.querySelector('.space-legend').innerText")
        for structure in self.run_script("return page.data.view.structures"):
            low, high = structure["world_box_mm"]
            extent = " × ".join(f"{h - l:.1f}" for l, h in zip(low, high))
            for words in (structure["name"], structure["medium"], structure["role"], extent):
                self.assertIn(words, legend)

    def test_meshes_move_with_the_player(self):
        place = "const s = page.parts.space.surfaces.find((s) => s.given.name === 'lv_cavity'); return Array.from(s.positions)"
        first = self.run_script(place)
        half = self.run_script("return page.parts.player.count") // 3
        self.run_script("page.parts.player.jump(arguments[0])", half)
        self.wait_for_frame(half)
        self.wait(lambda: self.run_script(place) != first, "the meshes stand still")
        self.run_script("page.parts.player.jump(0)")
        self.wait_for_frame(0)
        self.wait(lambda: self.run_script(place) == first, "the meshes do not come back")

    def test_keys_and_buttons_turn_and_zoom(self):
        eye = "const { x, y, z } = page.parts.space.camera.position; return [x, y, z]"
        far = "return page.parts.space.camera.position.distanceTo(page.parts.space.orbit.target)"
        start, distance = self.run_script(eye), self.run_script(far)
        canvas = self.driver.find_element(browser.By.CSS_SELECTOR, ".space-box canvas")
        frame = self.frame()
        canvas.send_keys(browser.Keys.ARROW_LEFT)
        self.assertNotEqual(self.run_script(eye), start)
        self.assertAlmostEqual(self.run_script(far), distance, places=3)
        canvas.send_keys("+")
        self.assertLess(self.run_script(far), 0.95 * distance)
        self.assertEqual(self.frame(), frame)  # the player left the arrow to the canvas
        canvas.send_keys("0")
        self.assertAlmostEqual(self.run_script(far), distance, places=3)

    def test_the_mouse_turns_and_a_click_tells_where(self):
        eye = "return page.parts.space.camera.position.toArray()"
        start = self.run_script(eye)
        canvas = self.driver.find_element(browser.By.CSS_SELECTOR, ".space-box canvas")
        browser.ActionChains(self.driver).click_and_hold(canvas).move_by_offset(60, 20).release().perform()
        self.assertNotEqual(self.run_script(eye), start)
        browser.ActionChains(self.driver).click(canvas).perform()
        self.assertIn("in the units of probe.apex", self.run_script("return page.parts.space.words.textContent"))

    def test_scene_coordinates_go_there_and_back(self):
        away = self.run_script("""
            const p = [12, -34, 56], q = page.parts.space.toScene(page.parts.space.fromScene(p));
            return Math.max(...p.map((x, i) => Math.abs(x - q[i])));""")
        self.assertLess(away, 1e-9)

    def test_contours_lie_on_the_picture(self):
        """The cut of the coarse meshes lies in the imaging plane, within the structure's own box."""
        for name in ("lv_cavity", "ra"):
            low, high, points = self.run_script("""
                const s = page.parts.space.surfaces.find((s) => s.given.name === arguments[0]);
                const n = 3 * s.contour.drawRange.count, p = Array.from(s.contour.attributes.position.array.slice(0, n));
                return [...s.given.probe_box_mm, p];""", name)
            self.assertGreater(len(points), 60)
            self.assertEqual(set(points[2::3]), {0})
            self.assertGreaterEqual(min(points[0::3]), low[0] - 0.01)
            self.assertLessEqual(max(points[0::3]), high[0] + 0.01)

    def test_without_webgl_a_line_says_so(self):
        self.driver.execute_cdp_cmd("Page.enable", {})
        hidden = self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "HTMLCanvasElement.prototype.getContext = ((get) => function (kind, ...rest) {"
                      " return kind.startsWith('webgl') ? null : get.call(this, kind, ...rest); })"
                      "(HTMLCanvasElement.prototype.getContext)"})
        try:
            self.browser.open(self.path)
            words = self.run_script("return document.getElementById('space').innerText")
            self.assertIn("has no WebGL", words)
            self.assertIn("lv_cavity", words)
            self.assertIn("lv_cavity", self.text("structures"))
            severe = [e for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
            self.assertEqual(severe, [])
        finally:
            self.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", hidden)


def make_page(folder):
    program, source = sys.argv[1:3]
    page = os.path.join(folder, "view.html")
    scene = os.path.join(source, "examples", "beating_heart", "scene.toml")
    subprocess.run([program, "view", scene, "-o", page, "--quiet", "--triangles", "6000", "--phases", "8"], check=True)
    return page


if __name__ == "__main__":
    browser.main(ViewPage, make_page)
