"""Dials, measurements and truth on the page of `live`: live_dials_page_test.py ECHOCINE SOURCE_FOLDER"""

import http.client
import json

import browser
import live_page


class LiveDialsPageTest(live_page.LivePageCase):
    def test_a_refused_value_is_reported_at_its_dial(self):
        self.js("const e = document.querySelector('[id$=\"probe.depth_mm\"]'); e.value = -5; e.dispatchEvent(new Event('change'))")
        self.wait(lambda: "depth_mm" in self.js("return document.getElementById('refusal').textContent"), "nothing is refused")
        self.assertTrue(self.js("return !document.querySelector('[id$=\"probe.depth_mm\"]').closest('.dial').querySelector('.bad').hidden"))
        self.js("const e = document.querySelector('[id$=\"probe.depth_mm\"]'); e.value = 120; e.dispatchEvent(new Event('change'))")
        self.wait_for_rest()
        self.assertEqual(self.js("return document.getElementById('refusal').textContent"), "")

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


if __name__ == "__main__":
    live_page.main(LiveDialsPageTest)
