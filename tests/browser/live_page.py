"""The page of `live` through the real server, for tests: a session and a browser."""

import os
import re
import signal
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


class LivePageCase(unittest.TestCase):
    """A session of the small scene, and its page in a browser."""

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

    def set(self, name, value):
        self.js("const e = document.getElementById(arguments[0]); e.value = arguments[1]; e.dispatchEvent(new Event('change'))", name, value)


def main(test):
    """Runs the tests of class `test`: NAME_test.py ECHOCINE SOURCE_FOLDER."""
    if not (browser.webdriver and browser.CHROMIUM and browser.DRIVER):
        print("SKIPPED: needs chromium, chromium-driver and python3-selenium (.ci/test-packages.txt)")
        sys.exit(browser.SKIPPED)
    test.program, test.source = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromTestCase(test))
    sys.exit(0 if result.wasSuccessful() and result.testsRun else 1)
