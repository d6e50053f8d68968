"""A page in a headless Chromium without network, and what every page must keep to."""

import json
import os
import shutil
import sys
import tempfile
import unittest

SKIPPED = 77  # what ctest takes for a test that could not run

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    webdriver = None

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
PATIENCE_S = 60  # an upper bound for waits on conditions; a loaded machine is slow
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"]  # WebGL without a graphics card

# Largest difference of a grey between the canvas and frame k decoded by other means, an <img>.
DIFFERENCE = """
const [loop, k, done] = arguments;
const canvas = page.parts.player.loops[loop].canvas;
const { type, text } = page.parts.player.loops[loop].store.images[k];
const image = new Image();
image.onload = () => {
  const other = document.createElement("canvas");
  other.width = image.naturalWidth;
  other.height = image.naturalHeight;
  const context = other.getContext("2d");
  context.drawImage(image, 0, 0);
  if (other.width !== canvas.width || other.height !== canvas.height) return done(256);
  const read = (c) => c.getImageData(0, 0, other.width, other.height).data;
  const a = read(context), b = read(canvas.getContext("2d"));
  let most = 0;
  for (let i = 0; i < a.length; ++i) most = Math.max(most, Math.abs(a[i] - b[i]));
  done(most);
};
image.src = `data:${type};base64,${text}`;
"""

# Names at the head of a row whose line ends within a word.
BROKEN_WORDS = """
const broken = [];
for (const head of document.querySelectorAll("tbody th"))
  for (const node of head.childNodes) {
    if (node.nodeType !== Node.TEXT_NODE) continue;
    for (const word of node.data.matchAll(/\\S+/g)) {
      const range = document.createRange();
      range.setStart(node, word.index);
      range.setEnd(node, word.index + word[0].length);
      const tops = new Set(Array.from(range.getClientRects(), (r) => Math.round(r.top)));
      if (tops.size > 1 && !word[0].includes("-")) broken.push(word[0]);
    }
  }
return broken;
"""


def brightness(colour):
    """Relative luminance of #rgb or #rrggbb, as WCAG 2.1 has it."""
    digits = colour.lstrip("#")
    if len(digits) == 3:
        digits = "".join(2 * d for d in digits)
    linear = [(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4)
              for c in (int(digits[i:i + 2], 16) / 255 for i in (0, 2, 4))]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


class Browser:
    """One Chromium for all tests of a file; use with `with`."""

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix="echocine_browser_")
        options = Options()
        options.binary_location = CHROMIUM
        for flag in FLAGS + [f"--user-data-dir={self.profile}"]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        self.driver.set_script_timeout(PATIENCE_S)
        self.driver.execute_cdp_cmd("Network.enable", {})
        self.driver.execute_cdp_cmd("Network.emulateNetworkConditions", {
            "offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})
        return self

    def __exit__(self, *_):
        self.driver.quit()
        shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, path, width=1400):
        self.driver.set_window_size(width, 900)
        self.driver.get("file://" + os.path.abspath(path))


class PageTest(unittest.TestCase):
    """Tests of a page: `browser` and `path` are set by main()."""

    browser = None
    path = None

    def setUp(self):
        self.driver = self.browser.driver
        self.driver.get("about:blank")
        for log in ("browser", "performance"):
            self.driver.get_log(log)  # what came before is not this test's
        self.browser.open(self.path)
        if self.run_script("return page.parts.player ? page.parts.player.count : 0"):
            self.wait_for_frame(0)

    def run_script(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, condition, what):
        WebDriverWait(self.driver, PATIENCE_S, 0.02).until(lambda _: condition(), what)

    def frame(self):
        return self.run_script("return page.parts.player.index")

    def wait_for_frame(self, k):
        self.wait(lambda: self.frame() == k, f"frame {k} does not come")

    def assert_shows(self, k):
        """Every canvas shows its loop's frame k, by its pixels."""
        self.wait_for_frame(k)
        for loop in range(self.run_script("return page.parts.player.loops.length")):
            if not self.run_script("return !!page.parts.player.loops[arguments[0]].store.images.length", loop):
                continue
            self.assertLessEqual(self.driver.execute_async_script(DIFFERENCE, loop, k), 1,
                                 f"loop {loop} does not show its frame {k}")

    def click_curve(self, chart, series, k):
        """A real click on point k of a series, as a reader would."""
        at = self.run_script("""
            const chart = page.parts.charts[arguments[0]];
            chart.getDom().scrollIntoView({ block: "center" });
            const point = chart.getOption().series[arguments[1]].data[arguments[2]];
            const box = chart.getDom().getBoundingClientRect();
            const [x, y] = chart.convertToPixel({ seriesIndex: arguments[1] }, point);
            return [Math.round(box.left + x), Math.round(box.top + y)];""", chart, series, k)
        actions = ActionChains(self.driver)
        actions.w3c_actions.pointer_action.move_to_location(*at)
        actions.w3c_actions.pointer_action.click()
        actions.perform()

    def text(self, element_id):
        return self.run_script("return document.getElementById(arguments[0]).textContent", element_id)

    # What every page keeps to.

    def test_loads_offline_and_asks_for_nothing(self):
        asked = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        urls = [m["params"]["request"]["url"] for m in asked if m["method"] == "Network.requestWillBeSent"]
        self.assertIn("file://" + os.path.abspath(self.path), urls)
        others = [u[:80] for u in urls if not u.startswith(("data:", "blob:", "file://" + os.path.abspath(self.path)))]
        self.assertEqual(others, [])
        entries = self.run_script("return performance.getEntriesByType('resource').map(e => e.name)")
        self.assertEqual([e[:80] for e in entries if not e.startswith(("data:", "blob:"))], [])

    def test_says_nothing_to_the_console(self):
        """But for what a software renderer says of its own speed."""
        said = [e for e in self.driver.get_log("browser") if "GL Driver Message (OpenGL, Performance" not in e["message"]]
        self.assertEqual(said, [])

    def test_fits_its_window(self):
        for width in (1400, 800, 500):
            self.browser.open(self.path, width)
            inner, content = self.run_script("return [innerWidth, document.documentElement.scrollWidth]")
            self.assertLessEqual(content, inner, f"at {width} pixels")

    def test_no_legend_cuts_its_words(self):
        """Above or below; beside, a legend scrolls. A tenth of its height is spare."""
        cut = self.run_script("""
            const placed = (element) => {
              const box = element.getBoundingRect().clone();
              if (element.transform) box.applyTransform(element.transform);
              return box;
            };
            return page.parts.charts.flatMap((chart) => chart.getZr().storage.getDisplayList(true)
              .filter((e) => e.type === "tspan" && e.__clipPaths?.length)
              .filter((e) => {
                const text = placed(e), clip = placed(e.__clipPaths[0]), spare = 0.1 * text.height;
                return text.y - spare < clip.y || text.y + text.height + spare > clip.y + clip.height;
              }).map((e) => e.style.text));""")
        self.assertEqual(cut, [])

    def test_fits_a_phone(self):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})
        try:
            self.browser.open(self.path)
            self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), 390)
            self.assertEqual(self.run_script(BROKEN_WORDS), [])
        finally:
            self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_can_be_read_in_the_dark_in_light_and_on_paper(self):
        grounds = {}
        for media, scheme in (("screen", "dark"), ("screen", "light"), ("print", "light"), ("print", "dark")):
            self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                "media": media, "features": [{"name": "prefers-color-scheme", "value": scheme}]})
            try:
                colours = {name: brightness(self.run_script("return page.colour(arguments[0])", name))
                           for name in ("ground", "card", "text", "muted", "accent")}
                frames = self.run_script("""return Array.from(document.querySelectorAll(".loop canvas"),
                    (canvas) => getComputedStyle(canvas).backgroundColor)""")
            finally:
                self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": []})
            grounds[media, scheme] = colours["ground"]
            for name in ("text", "muted", "accent"):
                light, dark = sorted((colours[name], colours["card"]), reverse=True)
                # Of the Web Content Accessibility Guidelines 2.1, 1.4.3.
                self.assertGreaterEqual((light + 0.05) / (dark + 0.05), 4.5, f"{name}, {media}, {scheme}")
            if media == "print":  # frames that are not decoded yet are white paper
                self.assertEqual([f for f in frames if f != "rgba(0, 0, 0, 0)"], [])
        self.assertLess(grounds["screen", "dark"], 0.1)
        self.assertGreater(grounds["screen", "light"], 0.8)
        self.assertEqual({grounds["print", "light"], grounds["print", "dark"]}, {1.0})

    def test_every_control_has_a_name_and_every_chart_a_description(self):
        nameless = self.run_script("""
            const named = (e) => e.ariaLabel || e.labels?.length || e.textContent.trim();
            return Array.from(document.querySelectorAll("button, input, select")).filter((e) => !named(e))
              .map((e) => e.outerHTML)""")
        self.assertEqual(nameless, [])
        silent = self.run_script(
            "return page.parts.charts.filter((c) => !c.getDom().getAttribute('aria-label')).length")
        self.assertEqual(silent, 0)

    def check_player(self):
        """Plays, stops, steps by keys and scrubs; called by pages that have one."""
        last = self.run_script("return page.parts.player.count") - 1
        self.run_script("window.seen = []; page.parts.player.addEventListener('frame',"
                        " (event) => seen.push(event.detail.index))")
        self.driver.find_element(By.CSS_SELECTOR, "button[aria-label=Play]").click()
        self.wait(lambda: len(set(self.run_script("return seen"))) >= 3, "it does not play")
        self.driver.find_element(By.CSS_SELECTOR, "button[aria-label=Pause]").click()
        self.wait(lambda: self.run_script("return !page.parts.player.busy"), "it does not come to rest")
        stopped = self.frame()
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))")
        self.assertEqual(self.frame(), stopped)
        self.assert_shows(stopped)

        body = self.driver.find_element(By.TAG_NAME, "body")
        body.send_keys(Keys.HOME)
        self.assert_shows(0)
        body.send_keys(Keys.ARROW_RIGHT)
        self.assert_shows(1)
        body.send_keys(Keys.ARROW_LEFT)
        body.send_keys(Keys.ARROW_LEFT)  # round the loop
        self.assert_shows(last)

        scrubber = self.driver.find_element(By.CSS_SELECTOR, "input[type=range]")
        ActionChains(self.driver).move_to_element(scrubber).click().perform()
        middle = int(scrubber.get_attribute("value"))
        self.assertTrue(0 < middle < last)
        self.assert_shows(middle)
        scrubber.send_keys(Keys.ARROW_RIGHT)
        self.assert_shows(middle + 1)

    def check_curves_move_the_player(self, charts, series=0):
        count = self.run_script("return page.parts.player.count")
        for chart in charts:
            for k in sorted({0, 1, count // 3, count - 2}):
                self.click_curve(chart, series, k)
                self.assert_shows(k)
                away = self.run_script("""
                    const chart = page.parts.charts[arguments[0]];
                    const cursor = chart.getDom().querySelector(".cursor").getBoundingClientRect();
                    const point = chart.getOption().series[arguments[1]].data[arguments[2]];
                    return Math.abs(cursor.left - chart.getDom().getBoundingClientRect().left
                      - chart.convertToPixel({ seriesIndex: arguments[1] }, point)[0]);""", chart, series, k)
                self.assertLess(away, 3, "the cursor is not at the frame")


def main(test, make_page):
    """Runs the tests of class `test` on the page that make_page(folder) writes and returns."""
    if not (webdriver and CHROMIUM and DRIVER):
        print("SKIPPED: needs chromium, chromium-driver and python3-selenium (.ci/test-packages.txt)")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory(prefix="echocine_pages_") as folder:
        test.path = make_page(folder)
        with Browser() as browser:
            test.browser = browser
            tests = unittest.defaultTestLoader.loadTestsFromTestCase(test)
            result = unittest.TextTestRunner(verbosity=2).run(tests)
    sys.exit(0 if result.wasSuccessful() and result.testsRun else 1)
