"""Loops in memory, in folders, and as the program makes them."""

import json
import os
import random
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import echocine


@pytest.fixture(scope="module")
def pair(recorded, program, tmp_path_factory):
    """The same loop in memory, by the program, and into a folder."""
    folder = tmp_path_factory.mktemp("loops")
    scene = recorded.copy()
    scene.update({"output.channels": ["Y", "display.Y", "structure.id", "displacement.lateral", "displacement.axial",
                                      "displacement.elevation"], "truth.write": ["all"], "truth.tracks": 50})
    written = folder / "heart"
    assert subprocess.run([program, "heart", "--ef", "0.5", "--keyframes", "6", "-o", written, "--quiet"]).returncode == 0
    (written / "scene.toml").write_text(scene.text)
    assert subprocess.run([program, "render", written / "scene.toml", "-o", folder / "loop", "--quiet"]).returncode == 0
    return echocine.render(scene), echocine.open(folder / "loop")


def test_intensities_and_greys_are_the_programs_bytes(pair):
    memory, folder = pair
    assert memory.intensities.shape == (len(memory), 64, 24) and memory.intensities.dtype == np.float32
    assert memory.intensities.tobytes() == folder.intensities.tobytes()
    assert memory.greys.tobytes() == folder.greys.tobytes()
    assert memory.reference_intensity == folder.reference_intensity


def test_images_are_those_of_the_cine(pair):
    memory, folder = pair
    assert memory.images.shape == (len(memory), 90, 120)
    assert np.array_equal(memory.images, folder.images)


def test_truth_is_the_same(pair):
    memory, folder = pair
    assert np.array_equal(memory.labels, folder.labels) and memory.labels.max() > 3
    assert np.array_equal(memory.tracks, folder.tracks)
    assert np.allclose(memory.strain, folder.strain, atol=1e-12, equal_nan=True)
    assert np.allclose(memory.times_s, folder.times_s) and np.allclose(memory.phases, folder.phases)
    assert list(memory.volumes) == list(folder.volumes)
    for name, ml in memory.volumes.items():
        assert np.allclose(ml, folder.volumes[name])
    for name, values in memory.curves.items():
        assert np.allclose(values, folder.curves[name], equal_nan=True)
    assert memory.displacement.shape == (len(memory), 3, 64, 24)
    for ours, theirs in zip(memory.contours, folder.contours):
        assert [c["structure"] for c in ours] == [c["structure"] for c in theirs]
        assert np.allclose(ours[0]["points_mm"], theirs[0]["points_mm"], atol=1e-3)
        for a, b in zip(ours, theirs):
            assert a["visible"].dtype == bool and a["visible"].shape == a["points_mm"].shape[:1]
            assert np.array_equal(a["visible"], b["visible"])
    assert any(c["visible"].any() and not c["visible"].all() for frame in memory.contours for c in frame)


def test_displacement_comes_back_from_files(pair):
    memory, folder = pair
    assert np.array_equal(memory.displacement, folder.displacement, equal_nan=True)
    assert np.nanmax(np.abs(memory.displacement)) > 1 and np.isnan(memory.displacement).any()
    assert np.array_equal(memory.channel("structure.id"), folder.channel("structure.id"))


def test_views(pair):
    memory, _ = pair
    for name in ("intensities", "greys", "images", "labels", "displacement", "tracks"):
        assert np.shares_memory(getattr(memory, name), getattr(memory, name)), name
    assert memory.greys[0].strides == (4, 256)


def test_a_frame_is_the_loops(pair):
    memory, _ = pair
    scene = memory.scene.copy()
    scene.update({"truth.write": ["labels"], "output.channels": ["Y"], "truth.tracks": None})
    frame = echocine.Simulator(scene).frame(memory.times_s[2])
    assert np.array_equal(frame.greys, memory.greys[2]) and np.array_equal(frame.image, memory.images[2])
    assert np.array_equal(frame.intensities, memory.intensities[2]) and np.array_equal(frame.labels, memory.labels[2])


def test_threads_change_nothing(scene):
    assert echocine.render(scene, threads=1).greys.tobytes() == echocine.render(scene, threads=2).greys.tobytes()


def test_truth_is_asked_for_by_name(scene):
    loop = echocine.render(scene, truth=["labels", "contours"], frames=(0, 2))
    assert len(loop) == 2 and loop.labels.shape == (2, 90, 120) and len(loop.contours) == 2
    assert scene["truth.write"] is None  # the scene itself is as it was
    with pytest.raises(ValueError, match="tracks.*truth"):
        loop.tracks
    with pytest.raises(echocine.SceneError, match="not a kind of truth, accepted"):
        echocine.render(scene, truth="depth")


def test_volumes_are_those_of_the_meshes(scene):
    points, faces = scene.mesh("ball")
    a, b, c = (points[:, faces[:, k]] - points.mean(axis=1, keepdims=True) for k in range(3))
    ml = np.einsum("kfi,kfi->k", a, np.cross(b, c)) / 6 * 1e-3
    volumes = echocine.render(scene).volumes["ball"]
    assert volumes.max() == pytest.approx(ml.max(), rel=1e-6) and ml.min() * 0.999 <= volumes.min()


def test_planes_without_a_stack(scene):
    """The stack's planes are made only where it is; the greys are there for any picture."""
    asked = scene.copy()
    asked.update({"output.channels": ["Y", "display.Y"], "output.exr": False})
    loop = echocine.render(asked, frames=(0, 2))
    assert loop.greys.shape == (2, 64, 24) and loop.images.shape == (2, 90, 120)
    with pytest.raises(ValueError, match="Y: the scene does not request it, accepted: .*output.exr = true"):
        loop.intensities
    asked["output.exr"] = True
    loop = echocine.render(asked, frames=(0, 2))
    assert np.array_equal(loop.channel("display.Y"), loop.greys)


def test_the_default_channel_is_that_of_the_scene(scene):
    assert scene["output.channels"] == ["Y"]
    bare = scene.copy()
    bare["effects.attenuation"] = "off"
    assert bare["output.channels"] == ["unattenuated.Y"] and bare["truth.tracks"] == 1000 and bare["truth.papillary"] == "wall"
    loop = echocine.render(bare, frames=(0, 1), truth="displacement")
    assert loop.channel("unattenuated.Y").shape == loop.displacement.shape[:1] + loop.displacement.shape[2:]


def test_valve_times_of_a_part_of_a_beat_are_those_of_the_beat(heart, tmp_path):
    times = []
    for beats in (1.0, 0.25):
        asked = heart.copy()
        asked["acquisition.beats"] = beats
        echocine.render(asked, tmp_path / str(beats), truth="function")
        events = json.loads((tmp_path / str(beats) / "truth" / "function.json").read_text())["valves"]
        times.append({name: event["time_s"] for name, event in events.items()})
    assert len(times[0]) == 4 and times[1] == pytest.approx(times[0], abs=1e-6)


def test_a_loop_keeps_the_scene_it_was_made_from(scene):
    changed = scene.copy()
    loop = echocine.render(changed, frames=(0, 1))
    changed["probe.depth_mm"] = 77
    assert loop.scene["probe.depth_mm"] == scene["probe.depth_mm"]


def test_a_part_of_a_loop_stays_a_part(scene, tmp_path):
    part = echocine.render(scene, frames=(1, 3))
    assert echocine.export(part, tmp_path / "part.gif").frames == 2


def test_names_of_channels_are_not_those_of_properties(pair):
    folder = pair[1]
    assert folder.times_s.ndim == 1 and folder.displacement.ndim == 4
    for name in ("times_s", "displacement"):
        with pytest.raises(ValueError, match=f"{name}: is not in"):
            folder.channel(name)


def test_a_closed_loop(scene):
    with echocine.render(scene, frames=(0, 2)) as loop:
        greys = loop.greys
        before = greys.copy()
    with pytest.raises(ValueError, match="closed"):
        loop.greys
    with pytest.raises(ValueError, match="closed"):
        loop.manifest
    assert np.array_equal(greys, before) and "closed" in repr(loop)


def test_ranges_and_threads_are_checked(scene):
    for frames in ((3, 3), (-1, 2), (0, 999)):
        with pytest.raises(echocine.SceneError, match="frames.*accepted"):
            echocine.render(scene, frames=frames)
    with pytest.raises(ValueError, match="threads"):
        echocine.render(scene, threads=-1)
    with pytest.raises(TypeError, match="scene: is str"):
        echocine.render("scene.toml")


def test_folders_that_are_none(tmp_path, scene):
    with pytest.raises(echocine.SceneError, match="manifest.json.*accepted"):
        echocine.open(tmp_path)
    (tmp_path / "manifest.json").write_text("{}")
    with pytest.raises(echocine.SceneError, match="damaged"):
        echocine.open(tmp_path)
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(echocine.JobError):
        echocine.render(scene, blocked)


def test_half_floats_come_back_unscaled(scene, tmp_path):
    scene.output.exr_pixel = "half"
    stored = echocine.render(scene, tmp_path / "half").intensities
    exact = echocine.render(scene).intensities
    bright = exact > exact.max() * 1e-6
    assert np.allclose(stored[bright], exact[bright], rtol=2**-10)


def test_missing_and_damaged_files(scene, tmp_path):
    loop = echocine.render(scene, tmp_path / "loop")
    (tmp_path / "loop" / "intensity" / "frame_0001.exr").write_bytes(b"none")
    with pytest.raises(echocine.JobError, match="frame_0001.exr"):
        loop.intensities
    with pytest.raises(ValueError, match="display.Y.*accepted: Y"):
        loop.greys


@pytest.mark.parametrize("numbers", [None, {"lv_cavity": 3, "lv_wall": 7}])
def test_labels_have_names(heart, tmp_path, numbers):
    heart.update({"acquisition.frame_rate_hz": 3.0, "truth.labels": numbers})
    loop = echocine.render(heart, truth="labels")
    assert loop.label_names == echocine.render(heart, tmp_path / "loop", truth="labels").label_names
    assert set(np.unique(loop.labels)) - {0} <= set(loop.label_names)
    assert loop.label_names[int(np.bincount(loop.labels[loop.labels > 0]).argmax())] in ("lv_cavity", "lv_wall", "lung_left", "lung_right")
    assert numbers is None or loop.label_names == {3: "lv_cavity", 7: "lv_wall"}
    with pytest.raises(ValueError, match="labels.*accepted"):
        echocine.render(heart, frames=(0, 1)).label_names


def test_rolling_lines_are_the_same_in_frames_and_loops(heart):
    still = echocine.render(heart)
    heart.update({"acquisition.rolling": True, "accuracy.rolling_lines": 6, "output.channels": ["Y", "display.Y"]})
    loop = echocine.render(heart)
    frame = echocine.Simulator(heart).frame(float(loop.times_s[3]))
    assert frame.intensities.tobytes() == loop.intensities[3].tobytes()
    assert frame.greys.tobytes() == loop.greys[3].tobytes()
    assert frame.intensities.tobytes() != still.intensities[3].tobytes()


def flip(file, at):
    data = bytearray(file.read_bytes())
    data[at] ^= 4
    file.write_bytes(data)


def test_a_file_that_is_not_as_it_was_written_is_named(pair, tmp_path):
    _, folder = pair
    for name, read in (("intensity/frame_0001.exr", lambda l: l.intensities), ("truth/labels_0001.png", lambda l: l.labels),
                       ("truth/contours_0000.json", lambda l: l.contours), ("truth/tracks.npz", lambda l: l.tracks),
                       ("truth/function.json", lambda l: l.strain), ("truth/labels.json", lambda l: l.label_names)):
        copy = tmp_path / name.replace("/", "_")
        shutil.copytree(folder.folder, copy)
        flip(copy / name, (copy / name).stat().st_size - 40)
        with pytest.raises(echocine.JobError, match=f"{Path(name).name}: is not as it was written"):
            read(echocine.open(copy))
    copy = tmp_path / "halved"
    shutil.copytree(folder.folder, copy)
    cine = copy / "cine.avi"
    cine.write_bytes(cine.read_bytes()[:cine.stat().st_size // 2])
    with pytest.raises(echocine.JobError, match="cine.avi: is not as it was written"):
        echocine.open(copy).images
    shutil.copy(folder.folder / "cine.avi", cine)
    flip(cine, cine.stat().st_size - 40)  # in the index, which a reader does not need
    with pytest.raises(echocine.JobError, match="cine.avi: is not as it was written"):
        echocine.open(copy).images
    assert np.array_equal(echocine.open(copy, verify=False).images, folder.images)


def contents(loop):
    """All that a folder's loop gives, as bytes or plain values."""
    return [a.tobytes() for a in (loop.intensities, loop.greys, loop.images, loop.labels, loop.displacement, loop.tracks, loop.strain,
                                  loop.times_s, loop.phases)] + [
        {name: a.tobytes() for name, a in loop.volumes.items()}, {name: a.tobytes() for name, a in loop.curves.items()},
        repr(loop.contours), loop.label_names, loop.reference_intensity, loop.manifest]


def test_no_flipped_bit_is_believed(pair, tmp_path):
    """ECHOCINE_FLIPS sets how many bits flip. report.html is not read."""
    _, folder = pair
    wanted = repr(contents(folder))
    files = sorted(f for f in folder.folder.rglob("*") if f.is_file() and f.name != "report.html")
    dice, copy, refused = random.Random(29), tmp_path / "copy", 0
    shutil.copytree(folder.folder, copy)
    flips = int(os.environ.get("ECHOCINE_FLIPS", "40"))
    for n in range(flips):
        # Every other flip is in the manifest, whose numbers nothing else proves.
        file = copy / ("manifest.json" if n % 2 else dice.choice(files).relative_to(folder.folder))
        whole = file.read_bytes()
        bit = dice.randrange(8 * len(whole))
        file.write_bytes(whole[:bit // 8] + bytes([whole[bit // 8] ^ 1 << bit % 8]) + whole[bit // 8 + 1:])
        try:
            assert repr(contents(echocine.open(copy))) == wanted, (file.name, bit)
        except (echocine.JobError, echocine.SceneError) as error:
            assert file.name in str(error)
            refused += 1
        file.write_bytes(whole)
    print(f"{refused} of {flips} flips refused")
    assert refused > flips // 2


def test_motion_channels_in_memory_are_those_of_files(heart, tmp_path):
    scene = heart
    scene["output.channels"] = ["Y", "displacement.axial", "velocity.beam"]
    memory, files = echocine.render(scene, frames=(0, 3)), echocine.render(scene, tmp_path / "loop", frames=(0, 3))
    for name in ("displacement.axial", "velocity.beam"):
        assert np.array_equal(memory.channel(name), files.channel(name), equal_nan=True)
    assert np.nanmax(np.abs(memory.channel("displacement.axial"))) > 0
    with pytest.raises(ValueError, match="displacement.lateral"):
        memory.channel("displacement.lateral")
    scene["output.exr"] = False
    with pytest.raises(echocine.SceneError, match="output.exr"):
        echocine.render(scene, truth="displacement")
