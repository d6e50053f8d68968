"""The live page of a scene, served beside the interpreter."""

import http.client
import json
import pickle
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


def json_of(page, path, body):
    answer, content = ask(page, "POST", path, json.dumps(body))
    assert answer.status == 200, content
    return json.loads(content)


def test_a_heart_by_its_dials_has_them_on_its_page_and_is_saved_with_its_meshes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    heart = echocine.heart(ef=0.5, edv=110, hr=72, keyframes=4, look="paper", segments={7: 0.3})
    heart.update({"probe.lines": 24, "probe.samples": 128, "acquisition.frame_rate_hz": 5, "output.ecg": False, "output.depth_ticks": False})
    with pickle.loads(pickle.dumps(heart)).live() as page:
        made = json_of(page, "/heart", {})["heart"]
        values = {dial["key"]: dial["value"] for dial in made["dials"]}
        assert (values["ef"], values["edv"], values["hr"], made["segments"][6]) == (0.5, 110, 72, 0.3)
        for dials, name in (({}, "own"), ({"ef": 0.3, "hr": 90}, "other")):
            json_of(page, "/heart", {"dials": dials})
            answer, content = ask(page, "POST", "/picture", json.dumps({"frame": 2, "effort": "still", "dials": dials}))
            assert answer.status == 200, content
            size = struct.unpack("<I", content[:4])[0]
            head = json.loads(content[4:4 + size])
            greys = np.frombuffer(content[4 + size:], np.uint8).reshape(head["height"], head["width"])
            assert json_of(page, "/save", {"name": f"{name}.toml", "dials": dials})["saved"] == str(tmp_path / f"{name}.toml")
            assert (tmp_path / f"{name}_heart/truth.json").is_file()
            # Its meshes in files are rounded to micrometres.
            saved = echocine.render(echocine.Scene(f"{name}.toml")).images[2]
            assert np.mean(np.abs(saved.astype(int) - greys)) < 0.5
            assert head["frames"] == round(60 * 5 / dials.get("hr", 72))
        assert ask(page, "POST", "/heart", json.dumps({"dials": {"ef": 3}}))[0].status == 422
    # A mesh of another origin is no heart of these dials.
    points, _ = heart.mesh("lv_cavity")
    heart["structure.lv_cavity.keyframes"] = points * 1.02
    with heart.live() as page:
        assert ask(page, "POST", "/heart", "{}")[0].status == 422
    with pytest.raises(echocine.SceneError, match="record: the meshes"):
        heart.live(record=tmp_path / "poses")


def test_a_program_ends_with_its_page_open(scene, tmp_path):
    program = ("import sys; sys.path.insert(0, sys.argv[1])\nfrom conftest import ball_scene\npage = ball_scene().live()\nprint(page.link)\n")
    done = subprocess.run([sys.executable, "-c", program, __file__.rsplit("/", 1)[0]], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout.startswith("http://127.0.0.1:"), done.stderr
