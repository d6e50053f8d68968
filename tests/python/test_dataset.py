"""Datasets: made, read back, in parts, as the command makes them."""

import json
import shutil
import subprocess

import numpy as np
import pytest

import echocine

SPEC = {"hearts": 3, "views": ["a4c"], "keyframes": 8, "picture_px": 96, "layouts": ["native", "echonet"],
        "truth": ["labels", "contours", "tracks"], "track_count": 30, "split": {"train": 0.67, "val": 0.33, "test": 0.0},
        "heart": {"ef": {"uniform": [0.35, 0.65]}, "wall_thickness": {"uniform": [8, 11]}},
        "scene": {"probe": {"lines": 32, "samples": 96}, "signal": {"look": "paper"}, "acquisition": {"frame_rate_hz": 10.0}}}
TEXT = """
# The same with a comment.
hearts = 3
views = ["a4c"]
keyframes = 8
picture_px = 96
layouts = ["native", "echonet"]
truth = ["labels", "contours", "tracks"]
track_count = 30
[split]
train = 0.67
val = 0.33
test = 0.0
[heart]
ef = { uniform = [0.35, 0.65] }
wall-thickness = { uniform = [8, 11] }
[scene.probe]
lines = 32
samples = 96
[scene.signal]
look = "paper"
[scene.acquisition]
frame_rate_hz = 10.0
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("data") / "whole"


@pytest.fixture(scope="module")
def data(folder):
    seen = []
    made = echocine.dataset(SPEC, folder, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (3, 3)
    return made


def digests(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*"))
            if p.is_file() and p.suffix in (".avi", ".npz", ".json", ".csv") and "work" not in p.parts}


def test_the_table(data):
    assert len(data) == 3 and data.made["loops"] == 3 and data.made["failed"] == 0
    ef = data.table["ef_percent"]
    assert ef.shape == (3,) and ef.dtype == np.float64 and ((ef > 30) & (ef < 70)).all()
    assert np.allclose(data.table["heart.ef"] * 100, ef, atol=3)  # of the smooth surface against the dial
    assert list(data.table["split"]) == ["train", "train", "val"] and data.rows[0]["heart"] == 1
    assert data.details["counts"]["loops"] == 3 and data.impossible == [] and data.failed == []
    assert repr(data).startswith("<echocine.Dataset of 3 loops") and "<table>" in data._repr_html_()


def test_loops_are_arrays(data):
    loop = data[1]
    frames = loop.row["frames"]
    assert loop.images.shape == (frames, loop.row["height"], loop.row["width"]) and loop.images.dtype == np.uint8
    assert loop.labels.shape == loop.images.shape and set(np.unique(loop.labels)) <= {0, 1, 2, 3} and loop.labels.max() >= 2
    assert loop.tracks.shape == (frames, 30, 2) and loop.times_s.shape == (frames,)
    assert loop.volume_ml[loop.row["ed_frame"]] == pytest.approx(loop.row["edv_ml"], rel=1e-5)
    assert loop.images[0][loop.labels[0] == 2].mean() > loop.images[0].mean()
    assert {"contour_lv_cavity", "ecg"} <= set(loop.truth) and loop.details["id"] == loop.id
    assert data[loop.id].row == loop.row and [each.id for each in data.split("val")] == [data[2].id]
    with pytest.raises(KeyError, match="nobody"):
        data["nobody"]
    with pytest.raises(IndexError):
        data[3]
    with pytest.raises(ValueError, match="accepted"):
        data.split("training")


def test_a_text_and_parts_give_the_same_bytes(data, folder, tmp_path):
    part = echocine.dataset(TEXT, tmp_path / "parts", task=(1, 2))
    assert repr(part).endswith("not merged>") and part.made["loops"] == 2
    with pytest.raises(ValueError, match="loops.csv.*merge"):
        part.rows
    with pytest.raises(echocine.JobError, match="1 of 3 hearts"):
        echocine.dataset(TEXT, tmp_path / "parts", merge=True)
    echocine.dataset(TEXT, tmp_path / "parts", task=(2, 2), threads=1)
    whole = echocine.dataset(TEXT, tmp_path / "parts", merge=True)
    assert len(whole) == 3
    one, other = digests(folder), digests(tmp_path / "parts")
    assert set(one) == set(other) and len(one) > 8
    assert [name for name in one if one[name] != other[name]] == []


def test_the_command_goes_on_with_it(data, folder, tmp_path, program):
    (tmp_path / "dataset.toml").write_text(TEXT)
    ran = subprocess.run([program, "dataset", tmp_path / "dataset.toml", "-o", folder], capture_output=True, text=True)
    assert ran.returncode == 0 and "3 hearts were kept" in ran.stdout, ran.stdout + ran.stderr
    again = echocine.dataset(tmp_path / "dataset.toml", folder)
    assert again.made["kept"] == 3 and again.rows == data.rows


def test_bad_specs_are_named(tmp_path):
    with pytest.raises(echocine.SceneError, match="hearts") as caught:
        echocine.dataset({"views": ["a4c"]}, tmp_path / "x")
    assert caught.value.line is None
    with pytest.raises(echocine.SceneError, match="views.*a9c.*accepted"):
        echocine.dataset({"hearts": 1, "views": ["a9c"]}, tmp_path / "x")
    with pytest.raises(TypeError, match="spec: is int"):
        echocine.dataset(3, tmp_path / "x")
    with pytest.raises(TypeError, match="heart.ef.*object"):
        echocine.dataset({"hearts": 1, "views": ["a4c"], "heart": {"ef": object()}}, tmp_path / "x")
    for bad in ((0, 2), (3, 2), (1,), "1/2"):
        with pytest.raises(ValueError, match="task"):
            echocine.dataset(SPEC, tmp_path / "x", task=bad)
    with pytest.raises(ValueError, match="one of them"):
        echocine.dataset(SPEC, tmp_path / "x", task=(1, 2), merge=True)
    with pytest.raises(ValueError, match="threads"):
        echocine.dataset(SPEC, tmp_path / "x", threads=-1)
    assert not (tmp_path / "x").exists()
    with pytest.raises(echocine.SceneError, match="absent.toml"):
        echocine.dataset(tmp_path / "absent.toml", tmp_path / "x")
    with pytest.raises(echocine.SceneError, match="is no folder"):
        echocine.Dataset(tmp_path / "x")


def test_a_folder_of_another_spec_is_left_alone(data, folder):
    before = digests(folder)
    with pytest.raises(echocine.SceneError, match="another spec"):
        echocine.dataset({**SPEC, "seed": 2}, folder)
    assert digests(folder) == before


def test_a_loop_without_native_files_says_so(tmp_path):
    spec = {**SPEC, "hearts": 1, "layouts": ["echonet"]}
    loop = echocine.dataset(spec, tmp_path / "small")[0]
    assert loop.images.shape == (loop.row["frames"], 112, 112)
    with pytest.raises(ValueError, match="truth.npz.*layout"):
        loop.labels


def test_a_preview(tmp_path):
    spec = {**SPEC, "layouts": ["native"]}
    numbers = echocine.preview_dataset(spec, tmp_path / "look.html", 2)
    assert numbers["hearts"] == 2 and numbers["seconds"] > 0 and numbers["bytes"] > 1000
    assert (tmp_path / "look.html").exists() and (tmp_path / "look.png").exists()
    with pytest.raises(echocine.SceneError, match="ends in .html"):
        echocine.preview_dataset(spec, tmp_path / "look", 2)
    with pytest.raises(ValueError, match="hearts: is 0"):
        echocine.preview_dataset(spec, tmp_path / "look.html", 0)
    assert json.dumps(numbers)


def test_a_damaged_file_of_a_loop_is_named(data, folder, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    for name, read in (("truth.npz", lambda loop: loop.truth), ("cine.avi", lambda loop: loop.images),
                       ("loop.json", lambda loop: loop.details)):
        file = copy / "native" / data[1].id / name
        content = bytearray(file.read_bytes())
        content[len(content) // 2] ^= 1
        file.write_bytes(content)
        with pytest.raises(echocine.JobError, match=f"{name}: is not as it was written"):
            read(echocine.Dataset(copy)[1])
    echocine.Dataset(copy, verify=False)[1].images
    shutil.rmtree(copy / "work")  # published without its book-keeping
    echocine.Dataset(copy)[1].images
