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


def test_datasets_are_joined_as_by_the_command(data, folder, tmp_path, program):
    other = tmp_path / "other"
    echocine.dataset({**SPEC, "seed": 5, "hearts": 1, "layouts": ["echonet"], "split": {"train": 0.0, "val": 0.0, "test": 1.0}}, other)
    seen = []
    with pytest.warns(echocine.SceneWarning, match="left out.*native"):
        both = echocine.join_datasets([folder, other], tmp_path / "both", name="both", progress=lambda done, total: seen.append((done, total)))
    assert both.made == {"hearts": 4, "loops": 4, "failed": 0} and seen[-1] == (4, 4)
    assert list(both.table["split"]) == ["train", "train", "val", "test"] and list(both.table["joined.part"]) == [1, 1, 1, 2]
    assert list(both.table["ef_percent"][:3]) == list(data.table["ef_percent"]) and both.details["name"] == "both"
    assert np.array_equal(both["ec000004_a4c"].images, echocine.Dataset(other)[0].images)
    ran = subprocess.run([program, "dataset", "--join", folder, other, "-o", tmp_path / "same", "--name", "both"], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert digests(tmp_path / "same") == digests(tmp_path / "both")


def test_joins_are_refused_as_by_the_command(data, folder, tmp_path, program):
    def refused(parts, words, **more):
        with pytest.raises(echocine.SceneError, match=words) as caught:
            echocine.join_datasets(parts, tmp_path / "x", **more)
        assert not (tmp_path / "x").exists()
        name = ["--name", more["name"]] if "name" in more else []
        ran = subprocess.run([program, "dataset", "--join", *parts, "-o", tmp_path / "x", *name], capture_output=True, text=True)
        assert ran.returncode == 2 and str(caught.value) in ran.stderr, ran.stderr

    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    refused([folder, copy], "the same heart")
    refused([folder, folder], "twice")
    refused([folder, tmp_path], "holds no dataset")
    refused([folder, copy], "--name: is empty", name="")
    with pytest.raises(echocine.SceneError, match="one folder, accepted: two"):
        echocine.join_datasets([folder], tmp_path / "x")
    with pytest.raises(TypeError, match="parts: is one path"):
        echocine.join_datasets(str(folder), tmp_path / "x")


def test_the_card_compares_with_real_loops(data, folder, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    real = {folder / "native" / loop.id / "cine.avi": loop.row["mm_per_pixel"] for loop in (data[0], data[2])}
    compared = echocine.dataset(TEXT, copy, merge=True, real=real)
    loops = compared.details["real_loops"]["loops"]
    assert [loop["frames"] for loop in loops] == [-(-data[k].row["frames"] // 3) for k in (0, 2)]
    assert all(0 <= loop["auc"] <= 1 for loop in loops) and "mean of 2 loops" in (copy / "README.md").read_text()
    with pytest.raises(ValueError, match="real: .*mm per pixel"):
        echocine.dataset(TEXT, copy, merge=True, real={"a.avi": 0})
    with pytest.raises(ValueError, match="merge=True"):
        echocine.dataset(TEXT, copy, real=real)
    with pytest.raises(echocine.SceneError, match="two or more"):
        echocine.dataset(TEXT, copy, merge=True, real=dict([*real.items()][:1]))


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
