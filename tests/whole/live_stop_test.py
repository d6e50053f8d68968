"""Signals end a live session in whatever it does: live_stop_test.py ECHOCINE"""

import http.client
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PROGRAM = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else "echocine"
PATIENCE_S = 120  # an upper bound for waits on conditions
DIALS = {"dials": {"ef": 0.4, "edv": 140}}


def ask(link, path, body, began=None):
    """The status; None if the program ends before it answers."""
    host, token = link.split("/")[2], link.split("=")[1]
    connection = http.client.HTTPConnection(host, timeout=PATIENCE_S)
    try:
        connection.request("POST", path, json.dumps(body), {"Content-Type": "application/json", "Echocine-Token": token})
        if began:
            began.set()
        return connection.getresponse().status
    except (OSError, http.client.HTTPException):
        return None
    finally:
        if began:
            began.set()
        connection.close()


class LiveStopTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="echocine_live_stop_")
        cls.heart = os.path.join(cls.folder.name, "heart")
        cls.temporary = os.path.join(cls.folder.name, "tmp")
        os.mkdir(cls.temporary)
        subprocess.run([PROGRAM, "heart", "--keyframes", "6", "-o", cls.heart, "--quiet"], check=True)
        cls.scene = os.path.join(cls.heart, "scene.toml")
        with open(cls.scene, encoding="utf-8") as file:
            text = file.read()
        for key, value in (("lines", 64), ("samples", 256), ("frame_rate_hz", 20)):
            text = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        with open(cls.scene, "w", encoding="utf-8") as file:
            file.write(text)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def serve(self):
        return subprocess.Popen([PROGRAM, "live", self.scene, "--no-browser", "--quiet", "--record", os.path.join(self.heart, "poses")],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, "TMPDIR": self.temporary})

    def stop(self, path, body, before=(), longest_s=0.4, seed=0):
        """Sends the request, and a signal at a random instant; whole files remain only."""
        for number in range(2):
            wished = random.Random(10 * seed + number)
            server, sent = self.serve(), [signal.SIGINT, signal.SIGTERM][number % 2]
            with self.subTest(path=path, body=body, signal=sent.name):
                try:
                    link = server.stdout.readline().strip()
                    for one in before:
                        self.assertEqual(ask(link, *one), 200)
                    began = threading.Event()
                    asking = threading.Thread(target=ask, args=(link, path, body, began))
                    asking.start()
                    began.wait(PATIENCE_S)
                    time.sleep(wished.uniform(0, longest_s))
                    server.send_signal(sent)
                    said = server.communicate(timeout=PATIENCE_S)[1]
                    asking.join(PATIENCE_S)
                finally:
                    server.kill()
                    server.wait()
                    server.stdout.close()
                    server.stderr.close()
                self.assertEqual((server.returncode, said), (0, ""))
                self.assert_whole()

    def assert_whole(self):
        self.assertEqual(os.listdir(self.temporary), [])
        for folder, names, files in os.walk(self.heart):
            self.assertEqual([n for n in names + files if "part" in n], [], folder)
            if folder != self.heart and os.path.basename(folder) != "poses":
                self.assertIn("truth.json", files)
                self.assertIn("scene.toml", files)

    def test_while_it_waits(self):
        self.stop("/scene", {}, seed=1)

    def test_while_it_renders(self):
        self.stop("/picture", {"frame": 3, "keys": {"speckle.seed": 4}}, seed=2)
        self.stop("/truth", {"frame": 3, "layers": ["labels", "wall"]}, seed=3)

    def test_while_it_makes_a_heart(self):
        self.stop("/heart", DIALS, seed=4)

    def test_while_it_writes_a_loop(self):
        for seed, form in enumerate(("mp4", "gif", "webp")):
            self.stop("/loop", {"format": form}, seed=5 + seed)

    def test_while_it_writes_a_heart(self):
        self.stop("/save", {"name": "failing.toml", "replace": True, **DIALS}, before=[("/heart", DIALS)], seed=8)

    def test_before_the_page_is_served(self):
        for number in range(4):
            server = self.serve()
            time.sleep(random.Random(90 + number).uniform(0.05, 0.3))
            server.send_signal(signal.SIGINT)
            link, said = server.communicate(timeout=PATIENCE_S)
            # Served by then: an ended session. Otherwise one line says that it was stopped. A signal
            # before main() listens for it ends the process.
            expected = (0, "") if link else (1, "echocine: stopped\n")
            if server.returncode != -signal.SIGINT:
                self.assertEqual((server.returncode, said), expected)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
