"""The page of `live` through the real server: live_page_test.py ECHOCINE SOURCE_FOLDER"""

import base64
import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import browser

# The canvas and the decoded PNG have the same greys.
DIFFERENCE = """
const [png, done] = arguments;
const image = new Image();
image.onload = () => {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: image.naturalWidth, height: image.naturalHeight });
  canvas.getContext("2d").drawImage(image, 0, 0);
  const read = (c) => c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
  const a = read(canvas), b = read(document.getElementById("picture"));
  if (a.length !== b.length) return done(-1);
  let different = 0;
  for (let i = 0; i < a.length; ++i) different += a[i] !== b[i];
  done(different);
};
image.src = "data:image/png;base64," + png;
"""


def small_scene(source, folder):
    """The shipped heart with fewer lines and samples, in the look that needs no speckle."""
    with open(os.path.join(source, "examples/beating_heart/scene.toml"), encoding="utf-8") as file:
        text = file.read()
    text = text.replace("../../data", os.path.join(source, "data"))
    for key, value in (("lines", "96"), ("samples", "256"), ("frame_rate_hz", "8"), ("look", '"paper"')):
        text = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
    path = os.path.join(folder, "scene.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + "\n[output]\npng = true\nexr = false\n")
    return path


class LivePageTest(unittest.TestCase):
    program = None
    source = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="echocine_live_")
        cls.scene = small_scene(cls.source, cls.folder.name)
        cls.server = subprocess.Popen([cls.program, "live", cls.scene, "--no-browser", "--quiet"], stdout=subprocess.PIPE, text=True)
        cls.link = cls.server.stdout.readline().strip()
        cls.chromium = browser.Browser().__enter__()
        cls.driver = cls.chromium.driver
        cls.driver.execute_cdp_cmd("Network.emulateNetworkConditions", {
            "offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1})

    @classmethod
    def tearDownClass(cls):
        cls.chromium.__exit__()
        cls.server.send_signal(signal.SIGINT)
        assert cls.server.wait(browser.PATIENCE_S) == 0
        cls.server.stdout.close()
        cls.folder.cleanup()

    def setUp(self):
        self.driver.get("about:blank")
        self.driver.get_log("browser")
        self.driver.get_log("performance")
        self.open(1280)

    def open(self, width):
        self.driver.set_window_size(width, 900)
        self.driver.get(self.link)
        self.wait_for_rest()

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, condition, what):
        browser.WebDriverWait(self.driver, browser.PATIENCE_S, 0.02).until(lambda _: condition(), what)

    def wait_for_rest(self):
        self.wait(lambda: self.js("const s = page.parts.live; return s.shown?.effort === 'still' && s.shown.version === s.version"),
                  "no complete picture comes")

    def freeze(self, frame=0):
        self.js("if (page.parts.live.playing) document.querySelector('button[aria-label=Freeze]').click()")
        self.js("page.parts.live.frame = arguments[0]", frame)
        self.wait(lambda: self.js("return page.parts.live.shown.frame") == frame, f"frame {frame} does not come")
        self.wait_for_rest()

    def press(self, *keys):
        self.js("document.activeElement.blur()")
        self.driver.find_element(browser.By.TAG_NAME, "body").send_keys(*keys)

    def test_a_moved_probe_shows_what_render_writes_for_its_scene(self):
        self.freeze()
        before = self.js("return page.parts.live.version")
        self.press(browser.Keys.ARROW_RIGHT, browser.Keys.ARROW_UP, "q", "d", "r")
        self.wait(lambda: self.js("return page.parts.live.version") >= before + 5, "the keys do not move the probe")
        self.wait_for_rest()
        self.js("document.getElementById('save-name').value = 'moved.toml'; document.getElementById('replace').checked = true")
        self.driver.find_element(browser.By.XPATH, "//button[text()='Save scene']").click()
        self.wait(lambda: "Saved" in self.js("return document.getElementById('saved').textContent"), "the scene is not saved")
        loop = os.path.join(self.folder.name, "loop")
        subprocess.run([self.program, "render", os.path.join(self.folder.name, "moved.toml"), "-o", loop, "--quiet", "--overwrite",
                        "--frames", "3:4"], check=True)
        self.freeze(3)
        with open(os.path.join(loop, "png/frame_0003.png"), "rb") as file:
            png = base64.b64encode(file.read()).decode()
        self.assertEqual(self.driver.execute_async_script(DIFFERENCE, png), 0)
        self.js("page.parts.live.frame = 5")
        self.wait(lambda: self.js("return page.parts.live.shown.frame") == 5, "frame 5 does not come")
        self.assertGreater(self.driver.execute_async_script(DIFFERENCE, png), 0, "another frame looks the same")

    def test_a_drag_in_the_echo_tilts_and_shows_pictures_on_its_way(self):
        self.js("window.efforts = []; new MutationObserver(() => efforts.push(document.getElementById('picture').dataset.effort))"
                ".observe(document.getElementById('picture'), { attributes: true, attributeFilter: ['data-version'] })")
        picture = self.driver.find_element(browser.By.ID, "picture")
        drag = browser.ActionChains(self.driver).move_to_element(picture).click_and_hold()
        for _ in range(12):
            drag.move_by_offset(6, 3).pause(0.03)
        drag.perform()
        self.wait(lambda: "moving" in self.js("return efforts"), "no picture comes while the probe moves")
        browser.ActionChains(self.driver).release().perform()
        self.wait_for_rest()
        self.assertIn("rock", self.js("return document.querySelector('label[for=pose-rock]').textContent"))
        self.assertNotEqual(float(self.js("return document.getElementById('pose-rock').value")), 0)

    def test_numbers_set_the_pose_that_they_show(self):
        wanted = {"x": 3, "y": -2, "z": 4, "rotate": 25, "tilt": -10, "rock": 5}
        for name, value in wanted.items():
            self.js("const e = document.getElementById(arguments[0]); e.value = arguments[1]; e.dispatchEvent(new Event('change'))",
                    f"pose-{name}", value)
        shown = self.js("return probePose.offsets(page.parts.live.pose, page.parts.live.reference)")
        for name, value in wanted.items():
            self.assertAlmostEqual(shown[name], value, 9)
        axes = self.js("const p = page.parts.live.pose; return [p.lateral, p.elevation, p.depth]")
        for i in range(3):
            for j in range(3):
                self.assertAlmostEqual(sum(a * b for a, b in zip(axes[i], axes[j])), float(i == j), 12)

    def test_a_standard_view_by_its_number(self):
        self.press("2")
        self.wait(lambda: self.js("return page.parts.live.reference_name") == self.js("return page.data.views[1].key"), "no view comes")
        self.wait_for_rest()
        self.assertIn("0.0 mm and 0.0°", self.js("return document.getElementById('off').textContent"))

    def test_a_refused_value_is_reported_at_its_dial(self):
        self.js("const e = document.querySelector('[id$=\"probe.depth_mm\"]'); e.value = -5; e.dispatchEvent(new Event('change'))")
        self.wait(lambda: "depth_mm" in self.js("return document.getElementById('refusal').textContent"), "nothing is refused")
        self.assertTrue(self.js("return !document.querySelector('[id$=\"probe.depth_mm\"]').closest('.dial').querySelector('.bad').hidden"))
        self.js("const e = document.querySelector('[id$=\"probe.depth_mm\"]'); e.value = 120; e.dispatchEvent(new Event('change'))")
        self.wait_for_rest()
        self.assertEqual(self.js("return document.getElementById('refusal').textContent"), "")

    def set(self, name, value):
        self.js("const e = document.getElementById(arguments[0]); e.value = arguments[1]; e.dispatchEvent(new Event('change'))", name, value)

    def test_a_dial_makes_another_heart_and_a_refused_one_is_reported_there(self):
        self.freeze()
        volume = "return page.parts.live.shown.volumes_ml.lv_cavity"
        self.assertAlmostEqual(self.js(volume), 120, delta=1.5)
        self.set("heart-edv", 160)
        self.wait(lambda: "took" in self.js("return document.getElementById('heart-words').textContent"), "no heart comes")
        self.wait_for_rest()
        self.assertAlmostEqual(self.js(volume), 160, delta=2)
        # The probe has moved with the skin: the view is the same, on another heart.
        self.assertIn("0.0 mm and 0.0°", self.js("return document.getElementById('off').textContent"))
        self.assertNotEqual(self.js("return page.parts.live.pose.origin_mm"), self.js("return page.parts.live.own_start.origin_mm"))
        # A slower beat has more frames, another ECG, and the picture follows.
        frames, lead = self.js("return [page.parts.live.frames, page.parts.live.loop.ecg]")
        self.set("heart-hr", 40)
        self.wait(lambda: self.js("return page.parts.live.loop.ecg") != lead, "the ECG stays")
        self.wait_for_rest()
        self.assertGreater(self.js("return page.parts.live.shown.frames"), frames)
        self.assertEqual(int(self.js("return document.querySelector('input[aria-label=Frame]').max")), self.js("return page.parts.live.frames") - 1)
        self.set("heart-hr", 500)
        self.wait(lambda: "30 to 200" in self.js("return document.getElementById('heart-hr').closest('.dial').textContent"), "nothing is refused")
        self.set("heart-ef", 0.99)
        self.wait(lambda: not self.js("return document.getElementById('heart-ef').closest('.dial').querySelector('.bad').hidden"), "nothing is refused")
        self.assertIn("0.05 to 0.85", self.js("return document.getElementById('heart-ef').closest('.dial').textContent"))
        # Other pages' hearts take the place of this one: it is made again.
        host, token = self.link.split("/")[2], self.link.split("=")[1]
        for ef in (0.3, 0.4, 0.5):
            connection = http.client.HTTPConnection(host, timeout=browser.PATIENCE_S)
            connection.request("POST", "/heart", json.dumps({"dials": {"ef": ef}}), {"Content-Type": "application/json", "Echocine-Token": token})
            self.assertEqual(connection.getresponse().status, 200)
            connection.close()
        self.press(browser.Keys.ARROW_LEFT)
        self.wait_for_rest()
        self.assertAlmostEqual(self.js(volume), 160, delta=2)

    def test_marks_and_true_contours_lie_over_the_picture(self):
        self.freeze()
        self.assertFalse(self.js("const c = document.getElementById('over'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some(x => x)"))
        self.driver.find_element(browser.By.ID, "truth-contours").click()
        self.wait(lambda: self.js("const c = document.getElementById('over'); return c.getContext('2d')"
                                  ".getImageData(0, 0, c.width, c.height).data.some(x => x)"), "no contours come")
        self.driver.find_element(browser.By.XPATH, "//button[text()='Measure mm']").click()
        picture = self.driver.find_element(browser.By.ID, "picture")
        pose = self.js("return page.parts.live.version")
        picture.send_keys(browser.Keys.ARROW_LEFT, browser.Keys.ENTER, browser.Keys.ARROW_DOWN, browser.Keys.ARROW_DOWN, browser.Keys.ENTER)
        (x0, y0), (x1, y1) = self.js("return page.parts.live.mm")
        self.assertEqual((x1 - x0, y1 - y0), (0, 24))
        self.assertEqual(self.js("return page.parts.live.version"), pose, "the probe has moved")
        # Simpson's rule of a circle of radius 20 mm with the base at one end of a diameter.
        made = self.js("const points = Array.from({ length: 720 }, (_, i) => [20 * Math.cos(i / 719.5 * 2 * Math.PI), 20 * Math.sin(i / 719.5 * 2 * Math.PI)]);"
                       "return LiveOver.discs(points)")
        self.assertAlmostEqual(made["volume_ml"], 33.510, delta=0.05)
        self.assertAlmostEqual(made["area_mm2"], 1256.6, delta=0.5)
        self.assertAlmostEqual(made["length_mm"], 40, delta=0.01)

    def test_says_nothing_to_the_console_asks_its_server_only_and_names_its_controls(self):
        self.press(browser.Keys.ARROW_LEFT)
        self.wait_for_rest()
        said = [e for e in self.driver.get_log("browser") if "GL Driver Message (OpenGL, Performance" not in e["message"]]
        self.assertEqual(said, [])
        asked = self.js("return performance.getEntriesByType('resource').map(e => new URL(e.name).host)")
        self.assertEqual(set(asked) - {self.link.split("/")[2]}, set())
        self.assertEqual(self.js("""return Array.from(document.querySelectorAll("button, input, select, canvas:not([aria-hidden])"))
            .filter((e) => !(e.ariaLabel || e.labels?.length || e.textContent.trim())).map((e) => e.outerHTML)"""), [])
        self.assertEqual(self.js("""return Array.from(document.querySelectorAll("button, input, select"))
            .filter((e) => e.tabIndex < 0).map((e) => e.outerHTML)"""), [])

    def test_fits_a_phone_and_a_desk(self):
        for width in (1280, 500):
            self.open(width)
            inner, content = self.js("return [innerWidth, document.documentElement.scrollWidth]")
            self.assertLessEqual(content, inner)
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})
        try:
            self.driver.get(self.link)
            self.wait_for_rest()
            self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), 390)
        finally:
            self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_other_requests_are_refused_and_the_page_goes_on(self):
        host, token = self.link.split("/")[2], self.link.split("=")[1]
        good = {"Content-Type": "application/json", "Echocine-Token": token}

        def status(method, path, body=None, **headers):
            connection = http.client.HTTPConnection(host, timeout=browser.PATIENCE_S)
            connection.request(method, path, body, {k.replace("_", "-"): v for k, v in headers.items()})
            answer = connection.getresponse()
            lines = answer.read().decode().splitlines()
            connection.close()
            return answer.status, len(lines)

        self.assertEqual(status("GET", "/"), (403, 1))
        self.assertEqual(status("GET", f"/?token={token}", Host="echocine.example"), (403, 1))
        self.assertEqual(status("GET", f"/?token={token}", Origin="http://elsewhere.example"), (403, 1))
        self.assertEqual(status("GET", f"/passwd?token={token}"), (404, 1))
        self.assertEqual(status("DELETE", f"/?token={token}"), (405, 1))
        self.assertEqual(status("POST", "/picture", "{}", **{**good, "Echocine-Token": "0" * 32}), (403, 1))
        self.assertEqual(status("POST", "/picture", "{}", **{**good, "Content-Type": "text/plain"}), (415, 1))
        self.assertEqual(status("POST", "/picture", "{", **good), (400, 1))
        self.assertEqual(status("POST", "/picture", '{"keys": {"probe.depth": 1}}', **good), (422, 1))
        self.assertEqual(status("POST", "/picture", "", **{**good, "Content-Length": str(10**9)}), (413, 1))
        self.assertEqual(status("POST", "/picture", "x" * 10**7, **good), (413, 1))
        name, port = host.split(":")
        idle = [socket.create_connection((name, int(port))) for _ in range(100)]  # over the bound
        idle[0].sendall(b"GET / HT")
        for one in idle:
            one.close()
        self.press(browser.Keys.ARROW_LEFT)
        self.wait_for_rest()


if __name__ == "__main__":
    if not (browser.webdriver and browser.CHROMIUM and browser.DRIVER):
        print("SKIPPED: needs chromium, chromium-driver and python3-selenium (.ci/test-packages.txt)")
        sys.exit(browser.SKIPPED)
    LivePageTest.program, LivePageTest.source = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromTestCase(LivePageTest))
    sys.exit(0 if result.wasSuccessful() and result.testsRun else 1)
