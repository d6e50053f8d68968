"""The live page of a scene, served beside the interpreter."""

import http.client
import json
import struct
import subprocess
import sys

import numpy as np
import pytest

import echocine


def ask(page, method, path, body=None, **more):
    host, token = page.link.split("/")[2], page.link.split("=")[1]
    connection = http.client.HTTPConnection(host, timeout=60)
    connection.request(method, path, body, {"Content-Type": "application/json", "Echocine-Token": token, **more})
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer, content


def test_the_page_shows_the_frames_of_its_scene_and_ends(scene):
    with scene.live() as page:
        token = page.link.split("=")[1]
        answer, content = ask(page, "GET", f"/?token={token}")
        assert answer.status == 200 and b"EchoCine live" in content
        assert answer.headers["X-Frame-Options"] is None and "frame-ancestors 'self'" in answer.headers["Content-Security-Policy"]
        answer, content = ask(page, "POST", "/picture", json.dumps({"frame": 2, "effort": "still"}))
        assert answer.status == 200, content
        size = struct.unpack("<I", content[:4])[0]
        head = json.loads(content[4:4 + size])
        greys = np.frombuffer(content[4 + size:], np.uint8).reshape(head["height"], head["width"])
        # Without ECG and ticks the picture is the frame's image.
        assert np.array_equal(greys, echocine.render(scene).images[2])
        assert ask(page, "POST", "/picture", "{}", **{"Echocine-Token": "0" * 32})[0].status == 403
        answer, content = ask(page, "POST", "/save", json.dumps({"name": "a.toml"}))
        assert answer.status == 422 and b"in memory" in content
        assert "<iframe" in page._repr_html_() and page.running
        with pytest.raises(echocine.JobError, match="Address already in use"):
            scene.live(port=int(page.link.split(":")[2].split("/")[0]))
    assert not page.running and "closed" in repr(page)
    with pytest.raises(OSError):
        ask(page, "GET", "/")
    with pytest.raises(ValueError, match="accepted: 0 to 65535"):
        scene.live(port=70000)


def test_a_program_ends_with_its_page_open(scene, tmp_path):
    program = ("import sys; sys.path.insert(0, sys.argv[1])\nfrom conftest import ball_scene\npage = ball_scene().live()\nprint(page.link)\n")
    done = subprocess.run([sys.executable, "-c", program, __file__.rsplit("/", 1)[0]], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout.startswith("http://127.0.0.1:"), done.stderr
