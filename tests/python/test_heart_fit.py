"""A heart fitted to a loop: the numbers of the program, its files, and arguments that are refused."""

import json
import subprocess

import numpy as np
import pytest

import echocine

SIDE = {"a4c": {"read_ecg": False, "ed_frame": 0.0}}
# All searched dials but one: the search takes seconds.
FIXED = {"hr": 72.0, "edv": 130.0, "wall_thickness": 9.0, "sphericity": 0.6, "mapse": 13.0, "conicity": 0.7, "apical_motion": 1.0, "rv_edv": 135.0}


@pytest.fixture(scope="module")
def real(tmp_path_factory):
    folder = tmp_path_factory.mktemp("heart_fit")
    scene = echocine.heart(ef=0.5, view="a4c", keyframes=8, **FIXED)
    scene.update({"probe.lines": 96, "probe.samples": 192, "output.width": 320, "output.height": 240, "output.ecg": False,
                  "output.depth_ticks": False, "output.codec": "ffv1", "output.report": False, "acquisition.frame_rate_hz": 24})
    echocine.render(scene, folder / "loop")
    return folder / "loop"


@pytest.fixture(scope="module")
def fitted(real, tmp_path_factory):
    folder = tmp_path_factory.mktemp("fitted")
    return folder, echocine.fit({"a4c": real}, folder, side=SIDE, tilt_deg=0, cache=folder / "hearts", **FIXED)


def test_the_heart_is_found_and_kept(fitted):
    folder, fit = fitted
    ef, edv, esv = (fit.result[key] for key in ("ef", "edv_ml", "esv_ml"))
    assert fit.refusal == "" and not fit.stopped
    assert ef.value == pytest.approx(0.5, abs=0.03) and ef.low < ef.value < ef.high
    assert edv.value == 130 and esv.value == pytest.approx(130 * (1 - ef.value))
    gls = fit.result["gls"]
    assert -0.3 < gls.low < gls.value < gls.high < 0
    assert fit.curves["gls"].min() == pytest.approx(gls.value, abs=0.005) and fit.curves["gls"][0] == 0
    assert fit.dials["ef"] == ef.value and fit.dials["wall_thickness"] == 9
    assert list(fit.intervals) == ["ef"] and fit.intervals["ef"].value == ef.value
    assert len(fit.views) == 1 and fit.views[0]["view"] == "a4c"
    assert json.loads((folder / "fit.json").read_text()) == fit.details
    assert fit.curves["lv_ml"].shape == (50,)
    assert fit.curves["lv_ml"].min() == pytest.approx(esv.value, rel=0.01) and np.all(fit.curves["low_ml"] < fit.curves["high_ml"])
    assert (folder / "heart" / "scene.toml").exists()
    assert fit.scene.acquisition.heart_rate_bpm == 72
    assert "ef 0." in repr(fit)


def test_the_program_has_the_same_numbers(real, fitted, program, tmp_path):
    dials = ",".join(f"{name.replace('_', '-')}={value}" for name, value in FIXED.items())
    asked = [program, "fit", "--no-cache", "--view", f"a4c={real}", "--ed", "a4c=0", "--no-ecg", "--tilt", "0", "--dials", dials, "-o", tmp_path / "fit"]
    ran = subprocess.run(asked, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    mine, its = dict(fitted[1].details), json.loads((tmp_path / "fit" / "fit.json").read_text())
    mine.pop("cpu_s"), its.pop("cpu_s")
    assert mine == its
    assert (tmp_path / "fit" / "heart" / "scene.toml").read_bytes() == (fitted[0] / "heart" / "scene.toml").read_bytes()
    again = subprocess.run(asked, capture_output=True, text=True)
    assert again.returncode == 2 and "exists" in again.stderr


def test_hearts_are_kept_and_a_finished_fit_is_not_resumed(real, fitted):
    folder, _ = fitted
    kept = sorted((folder / "hearts").iterdir())
    assert kept and all(path.name.startswith("heart_") and path.suffix == ".bin" for path in kept)
    assert not (folder / "fit.journal").exists()
    with pytest.raises(ValueError, match="heart: exists"):
        echocine.fit({"a4c": real}, folder, side=SIDE, resume=True, **FIXED)


def test_a_stop_comes_out(real):
    def progress(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        echocine.fit({"a4c": real}, side=SIDE, tilt_deg=0, progress=progress, **FIXED)


@pytest.mark.parametrize("given, options, words", [
    ({}, {}, "fit: has 0 loops, accepted: 1 to 3"),
    ({view: "x" for view in ("a4c", "a2c", "plax", "a3c")}, {}, "fit: has 4 loops, accepted: 1 to 3"),
    ({"a5x": "x"}, {}, "loops: \"a5x\" is not a view, accepted: \"a4c\""),
    ("loop.avi", {}, "loops: is str, accepted: view -> file"),
    ({"a4c": "none.avi"}, {}, "none.avi"),
    (None, {"side": {"a2c": {}}}, "side: 'a2c' has no loop, accepted: a4c"),
    (None, {"side": {"a4c": 3}}, "side: a4c is 3, accepted: options"),
    (["none.avi"], {}, "none.avi"),
    (["a", "b", "c", "d"], {}, "fit: has 4 loops, accepted: 1 to 3"),
    (["a", "b"], {"side": [{}]}, "side: is not a list of 2"),
    (["a"], {"side": {"a4c": {}}}, "side: is not a list of 1"),
    (["a"], {"side": [3]}, "side: 0 is 3, accepted: options"),
    (None, {"side": 3}, "side: is int, accepted: view -> options"),
    (None, {"side": {"a4c": {"sid": 1}}}, "side: \"sid\" is not known"),
    (None, {"tilt_deg": 21}, "tilt_deg: is 21, accepted: 0 to 20"),
    (None, {"resamples": 3}, "resamples: is 3, accepted: 0, or 4 to 10"),
    (None, {"starts": 0}, "starts and descents must be 1 or more"),
    (None, {"searched": ["hr"]}, 'searched: is "hr", accepted: ef, edv'),
    (None, {"searched": ["ef"], "ef": 0.5}, "searched: names no dial"),
    (None, {"ef": 3}, "dials: ef is 3, accepted"),
    (None, {"ef": "high"}, "dials: ef: is 'high', accepted: a number"),
    (None, {"eff": 0.5}, "\"eff\" is not a dial of the heart"),
])
def test_bad_arguments_are_refused_in_one_line(real, given, options, words):
    with pytest.raises((ValueError, echocine.JobError), match=words) as refused:
        echocine.fit({"a4c": real} if given is None else given, **options)
    assert "\n" not in str(refused.value)
