"""The page of `live` through the real server, probe, server and console: live_page_test.py ECHOCINE SOURCE_FOLDER"""

import base64
import http.client
import os
import socket
import subprocess

import browser
import live_page


class LivePageTest(live_page.LivePageCase):
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
        self.assertEqual(self.driver.execute_async_script(live_page.DIFFERENCE, png), 0)
        self.js("page.parts.live.frame = 5")
        self.wait(lambda: self.js("return page.parts.live.shown.frame") == 5, "frame 5 does not come")
        self.assertGreater(self.driver.execute_async_script(live_page.DIFFERENCE, png), 0, "another frame looks the same")

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

    def test_a_probe_that_sees_nothing_finds_the_heart_by_a_view(self):
        hint = "return document.getElementById('warnings').textContent"
        self.assertEqual(self.js(hint), "")
        self.js("const e = document.getElementById('pose-z'); e.value = 400; e.dispatchEvent(new Event('change'))")
        self.wait(lambda: "choose a standard view" in self.js(hint), "no hint comes")
        self.driver.find_element(browser.By.XPATH, "//button[text()='1 apical 4-chamber']").send_keys(browser.Keys.ENTER)
        self.wait(lambda: self.js("return page.parts.live.reference_name") == "a4c", "no view comes")
        self.wait_for_rest()
        self.wait(lambda: self.js(hint) == "", "the hint stays")
        # The drawing has the probe in it, and its views are those of this pose.
        for name, column, sign in (("As the picture", 2, 1), ("From the probe", 1, 1)):
            self.driver.find_element(browser.By.XPATH, f"//button[text()='{name}']").click()
            place, along = self.js("""const { rig, camera, middle } = page.parts.space, axis = new THREE.Vector3().setFromMatrixColumn(rig.matrix, arguments[0]);
                camera.updateMatrixWorld();
                const p = new THREE.Vector3().setFromMatrixPosition(rig.matrix).project(camera);
                return [[p.x, p.y], camera.position.clone().sub(middle).normalize().dot(axis)]""", column)
            self.assertLess(max(map(abs, place)), 1)
            self.assertAlmostEqual(along, sign, 4)

    def test_the_tab_key_reaches_every_control(self):
        self.js("document.querySelectorAll('details').forEach((e) => { e.open = e.id !== 'all-keys'; }); document.activeElement.blur()")
        self.wait(lambda: self.js("return document.querySelectorAll('#effects input').length"), "no effects come")
        wanted = self.js("""return Array.from(document.querySelectorAll("button, input, select, summary, [tabindex]"))
            .filter((e) => e.checkVisibility() && !e.disabled).map((e, i) => e.dataset.tab = i).length""")
        reached = set()
        for _ in range(wanted + 5):
            browser.ActionChains(self.driver).send_keys(browser.Keys.TAB).perform()
            reached.add(self.js("return document.activeElement.dataset.tab ?? null"))
        self.assertEqual(len(reached - {None}), wanted,
                         self.js("return Array.from(document.querySelectorAll('[data-tab]')).filter((e) => !arguments[0].includes(e.dataset.tab)).map((e) => e.outerHTML)",
                                 list(reached - {None})))

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
        self.wait_for_rest()  # a request of the page would take the place of those below
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
    live_page.main(LivePageTest)
