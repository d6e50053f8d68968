"""Frames: views, buffers, threads."""

import gc
import threading

import numpy as np
import pytest

import echocine
from conftest import ball_scene


def test_views_share_memory_and_outlive_the_frame(scene):
    frame = echocine.Simulator(scene).frame(0.1)
    first, second = frame.intensities, frame.intensities
    assert np.shares_memory(first, second) and first.shape == (64, 24) and first.strides == (4, 256)
    assert np.shares_memory(frame.greys, frame.greys) and np.shares_memory(frame.image, frame.image)
    assert frame.greys.dtype == np.float32 and frame.image.shape == (90, 120) and frame.image.dtype == np.uint8
    kept = first.copy()
    del frame
    gc.collect()
    assert np.array_equal(first, kept)


def test_a_frame_is_filled_again_in_its_own_memory(scene):
    simulator = echocine.Simulator(scene)
    frame, fresh = simulator.frame(0.0), simulator.frame(0.3)
    greys, address = frame.greys, frame.greys.ctypes.data
    before = greys.copy()
    assert simulator.frame(0.3, out=frame) is frame
    assert frame.greys.ctypes.data == address and np.array_equal(greys, fresh.greys)
    assert not np.array_equal(before, greys) and frame.time_s == fresh.time_s and frame.volumes == fresh.volumes


def test_arrays_are_filled(scene):
    scene.update({"truth.write": ["labels"]})
    simulator = echocine.Simulator(scene)
    frame = simulator.frame(0.2)
    out = {"intensities": np.zeros((64, 24), np.float32, order="F"), "greys": np.zeros((64, 24), np.float32),
           "image": np.zeros((90, 240), np.uint8)[:, ::2], "labels": np.zeros((90, 120), np.uint8)}
    simulator.frame(0.2, out=out)
    for name, array in out.items():
        assert np.array_equal(array, getattr(frame, name)), name
    assert frame.labels.max() == 1


@pytest.mark.parametrize("out, error, words", [
    ({"greys": np.zeros((24, 64), np.float32)}, ValueError, r"out\[\"greys\"\]: is \(24, 64\), float32, accepted: .*\(64, 24\)"),
    ({"greys": np.zeros((64, 24))}, TypeError, "float64, accepted: .*float32"),
    ({"greys": [1, 2]}, TypeError, "is list, accepted"),
    ({"gray": np.zeros((64, 24), np.float32)}, ValueError, "\"gray\" is not known, accepted"),
    ({"labels": np.zeros((90, 120), np.uint8)}, ValueError, "does not request"),
    (7, TypeError, "out: is int"),
])
def test_bad_buffers_are_named(scene, out, error, words):
    with pytest.raises(error, match=words):
        echocine.Simulator(scene).frame(0.0, out=out)


def test_read_only_buffers_and_frames_of_others_are_refused(scene):
    simulator = echocine.Simulator(scene)
    locked = np.zeros((64, 24), np.float32)
    locked.flags.writeable = False
    with pytest.raises(ValueError, match="read-only"):
        simulator.frame(0.0, out={"greys": locked})
    for other in (ball_scene(**{"probe.lines": 12}), ball_scene()):  # of another shape, and of the same
        frame = echocine.Simulator(other).frame(0.0)
        with pytest.raises(ValueError, match="out: the frame is of another simulator"):
            simulator.frame(0.0, out=frame)
        with pytest.raises(ValueError, match="frame: the frame is of another simulator"):
            simulator.contours(frame)


def test_one_buffer_for_two_planes(scene):
    simulator, plane, both = echocine.Simulator(scene), np.zeros((64, 24), np.float32), np.zeros((64, 24, 2), np.float32)
    with pytest.raises(ValueError, match=r"greys.*shares memory with out.*intensities"):
        simulator.frame(0.0, out={"intensities": plane, "greys": plane})
    simulator.frame(0.0, out={"intensities": both[..., 0], "greys": both[..., 1]})  # interleaved: apart
    assert np.array_equal(both[..., 1], simulator.frame(0.0).greys)


@pytest.mark.parametrize("frames", [(0.0, 1.0), 3, ("0", "1"), (0, 1, 2)])
def test_frames_that_are_no_pair_of_whole_numbers(scene, frames):
    with pytest.raises(ValueError, match="frames: is .*accepted: two whole numbers"):
        echocine.render(scene, frames=frames)


def test_instants_outside_the_loop_and_no_numbers(scene):
    simulator = echocine.Simulator(scene)
    with pytest.raises(echocine.SceneError, match="not in the loop"):
        simulator.frame(99.0)
    with pytest.raises(echocine.SceneError):
        simulator.frame(float("nan"))
    with pytest.raises(TypeError):
        simulator.frame("now")


def test_a_scene_that_changed_is_refused(scene):
    simulator, kept = echocine.Simulator(scene), echocine.Simulator(scene.copy())
    scene.probe.lines = 30
    with pytest.raises(echocine.SceneError, match="changed after"):
        simulator.frame(0.0)
    assert kept.frame(0.0).greys.shape == (64, 24)
    assert echocine.Simulator(scene).frame(0.0).greys.shape == (64, 30)


def test_what_is_not_asked_for_says_how_to_ask():
    frame = echocine.Simulator(ball_scene(**{"output.cine": False})).frame(0.0)
    with pytest.raises(ValueError, match="image.*accepted"):
        frame.image
    with pytest.raises(ValueError, match="labels.*truth.write"):
        frame.labels


def test_threads_see_the_same_frames(scene):
    simulator = echocine.Simulator(scene)
    times = simulator.times_s
    alone = [simulator.frame(t).greys.copy() for t in times]
    together = [None] * len(times)

    def work(first):
        for i in range(first, len(times), 4):
            together[i] = simulator.frame(times[i]).greys

    workers = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert all(np.array_equal(a, b) for a, b in zip(alone, together))


def test_channels(scene):
    scene.output.channels = ["Y", "attenuation.A", "medium.id", "structure.id", "displacement.axial"]
    planes = echocine.Simulator(scene).frame(0.1).channels
    assert set(planes) >= {"Y", "attenuation.A", "medium.id", "structure.id", "displacement.axial"}
    assert planes["structure.id"].dtype == np.uint32 and planes["structure.id"].max() == 1
    assert all(p.shape == (64, 24) for p in planes.values())


def test_tracks_have_the_unit_of_a_loops(recorded):
    scene = recorded.copy()
    scene.update({"truth.write": ["tracks"], "truth.tracks": 20})
    loop = echocine.render(scene, frames=(0, 2))
    frame = echocine.Simulator(scene).frame(loop.times_s[1])
    assert np.array_equal(frame.tracks, loop.tracks[1]) and 10 < np.abs(frame.tracks).max() < 200


def test_without_stack_intensities_are_refused_by_name(scene):
    scene["output.exr"] = False
    simulator = echocine.Simulator(scene)
    with pytest.raises(ValueError, match="intensities.*output.exr"):
        simulator.frame(0).intensities
    with pytest.raises(ValueError, match=r'out\["intensities"\]: the scene does not request it'):
        simulator.frame(0, out={"intensities": np.zeros((64, 24), np.float32)})


def test_a_frame_of_another_simulator_is_refused_whatever_its_shape(scene):
    frame = echocine.Simulator(scene).frame(0)
    other = echocine.Simulator(scene.copy())
    with pytest.raises(ValueError, match="another simulator"):
        other.frame(0, out=frame)
    with pytest.raises(ValueError, match="another simulator"):
        other.contours(frame)


def test_a_simulator_says_what_it_does_not_use(scene):
    scene["accuracy.tolerance_db"] = 3.0
    with pytest.warns(echocine.SceneWarning, match="tolerance_db"):
        echocine.Simulator(scene)
