"""Models against a real loop: the numbers of the program and of C++, and arguments that are refused."""

import csv
import json
import subprocess
import threading

import numpy as np
import pytest

import echocine

SIDE = {"read_ecg": False, "ed_frame": 0.0}
ASKED = ["--no-ecg", "--real-ed", "0"]


@pytest.fixture(scope="module")
def real(program, tmp_path_factory):
    """A heart of EF 0.5 as a real loop, and its scene as files."""
    folder = tmp_path_factory.mktemp("fit")
    heart = [program, "heart", "--ef", "0.5", "--hr", "72", "--keyframes", "8", "--look", "paper", "-o", folder, "--quiet"]
    assert subprocess.run(heart).returncode == 0
    scene = echocine.Scene(folder / "scene.toml")
    scene.update({"probe.lines": 96, "probe.samples": 192, "output.width": 320, "output.height": 240, "output.ecg": False,
                  "output.depth_ticks": False, "output.codec": "ffv1", "output.report": False, "acquisition.frame_rate_hz": 24})
    echocine.render(scene, folder / "loop")
    return folder


@pytest.fixture(scope="module")
def family():
    return echocine.HeartFamily({"ef": (0.4, 0.6)}, "a4c", nodes=4, tilt_deg=2, hr=72)


@pytest.fixture(scope="module")
def measure(real, family):
    return echocine.ModelDiscrepancy(real / "loop", family.at([0.5]), side=SIDE)


def test_a_scan_of_the_program_has_the_same_numbers(real, program, tmp_path):
    family = echocine.HeartFamily({"ef": (0.4, 0.6)}, "a4c", nodes=4, hr=72)  # with a tilt, other vertices are kept
    asked = [program, "compare", real / "loop", "-o", tmp_path / "scan", "--scan", "ef=0.4:0.6:0.1", "--dials", "hr=72", *ASKED]
    ran = subprocess.run(asked, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    rows = list(csv.DictReader((tmp_path / "scan" / "scan.csv").open()))
    measure = echocine.ModelDiscrepancy(real / "loop", echocine.HeartFamily({"ef": (0.4, 0.6)}, hr=72).at([0.5]), side=SIDE)
    centre = measure.search(family.at([0.5]))
    starts = [centre.pose, *centre.rivals[:1, :6]]
    assert len(rows) == 3
    for row in rows:
        found = measure.refine(family.at([float(row["ef"])]), starts)
        assert found.discrepancy == pytest.approx(float(row["discrepancy"]), abs=1e-5)
        assert found.terms["region"] == pytest.approx(float(row["region"]), abs=1e-5)
    assert max(rows, key=lambda row: float(row["discrepancy"]))["ef"].startswith("0.4")


def test_a_scene_has_the_programs_discrepancy(real, program, tmp_path):
    asked = [program, "compare", real / "loop", real / "loop", "-o", tmp_path / "c", "--scene", real / "scene.toml", *ASKED]
    ran = subprocess.run(asked, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    fit = json.loads((tmp_path / "c" / "summary.json").read_text())["scene_fit"]
    model = echocine.ModelLoop(echocine.Scene(real / "scene.toml"))
    found = echocine.ModelDiscrepancy(real / "loop", model, side=SIDE).search(model)
    assert found.discrepancy == pytest.approx(fit["discrepancy"], abs=1e-12)
    assert found.confidence == pytest.approx(fit["confidence"], abs=1e-12)


def test_the_parts_of_a_fit_have_its_cost(real, tmp_path):
    ranges = {"ef": (0.15, 0.75), "edv": (50, 280), "wall_thickness": (5, 15), "sphericity": (0.46, 0.78)}
    side = {**SIDE, "es_frame": 9.0}
    fit = echocine.fit({"a4c": real / "loop"}, side={"a4c": side}, searched=list(ranges), tilt_deg=0, starts=2, descents=1, own_loops=False, cache=tmp_path, hr=72)
    assert fit.details["model_error"]["agreement"] is None and fit.details["views"][0]["own_look"] is None  # not measured
    hearts = {file: file.stat().st_mtime_ns for file in tmp_path.glob("heart_*.bin")}
    family = echocine.HeartFamily(ranges, "a4c", cache=tmp_path, hr=72)
    assert family.nodes == 0 and len(hearts) == 23
    assert {file: file.stat().st_mtime_ns for file in tmp_path.glob("heart_*.bin")}.keys() == hearts.keys()  # read, not computed
    found = [fit.dials[dial] for dial in ranges]
    model = family.at(found, focus="left_ventricle")
    measure = echocine.ModelDiscrepancy(real / "loop", model, side=side)
    at = fit.details["views"][0]["fit"]["pose"]
    pose = [*at["shift_mm"], at["turn_deg"], at["scale"], 0, 0]
    prior = echocine.HeartPrior()

    def cost(values, **options):  # Eq. 14
        D = measure.refine(family.at(values, **options), pose).discrepancy
        return 500 * np.log(D) - prior.log_density(hr=72, **dict(zip(ranges, values)))

    assert cost(found, focus="left_ventricle") == pytest.approx(fit.details["cost"], abs=0.05)
    assert abs(cost(found) - fit.details["cost"]) > 1  # D of comparisons
    for i, step in enumerate([0.1, 30, 3, 0.08]):
        for sign in (-1, 1):
            moved = list(found)
            moved[i] += sign * step
            assert cost(moved, focus="left_ventricle") > fit.details["cost"]
    scene = echocine.ModelLoop(echocine.Scene(real / "scene.toml"), focus="left_ventricle")
    assert measure.search(scene).discrepancy < 0.5


def test_the_prior_of_hearts():
    prior = echocine.HeartPrior()
    mean, sd = prior.mean, prior.sd
    joint = {"ef", "edv", "wall_thickness", "sphericity", "mapse", "conicity"}
    sections = {"bow_lateral", "bow_anterior", "ellipticity", "ellipticity_45", "apical_thickness", "lateral_thickness", "anterior_thickness"}
    assert mean.keys() == sd.keys() == joint | sections | {"la_volume", "apical_motion", "rv_ratio"}
    assert mean["bow_lateral"] == 0 and sd["bow_lateral"] == 0.03
    # A normal dial.
    assert prior.log_density(ellipticity=0) - prior.log_density(ellipticity=-0.15) == pytest.approx(0.5, abs=1e-9)
    draws = [prior.draw(1, n) for n in range(2000)]
    assert prior.draw(1, 7) == draws[7] != prior.draw(2, 7)
    for dial in draws[0]:
        values = np.array([draw[dial] for draw in draws])
        assert values.mean() == pytest.approx(mean[dial], abs=0.25 * sd[dial])
    # Independent log-normal dials: the ratio of densities at two values.
    low, high = prior.log_density(ef=0.6, apical_motion=0.8), prior.log_density(ef=0.6, apical_motion=1.25)
    assert high - low == pytest.approx(np.log(0.8 / 1.25), abs=1e-9)
    assert prior.log_density(rv_ratio=mean["rv_ratio"]) > prior.log_density(rv_ratio=1.5)
    # Jointly: a ring that moves by 9 mm is likelier in a vigorous heart, one by 3 mm in a failing one.
    rise = {ef: prior.log_density(ef=ef, mapse=9) - prior.log_density(ef=ef, mapse=3) for ef in (0.35, 0.6)}
    assert rise[0.35] < 0 < rise[0.6]


def test_poses_as_arrays(measure, family):
    model = family.at([0.5])
    found = measure.search(model)
    assert 0 < found.discrepancy < 0.5 and found.pose.shape == (6,) and found.rivals.shape[1] == 7
    assert measure(model, found.pose) == pytest.approx(found.discrepancy, abs=1e-9)
    poses = np.tile(found.pose, (20, 1))
    poses[:, 0] += np.linspace(-20, 20, 20)
    values, terms = measure(model, poses), measure.terms(model, poses)
    assert values.shape == (20,) and terms.shape == (20, 4)
    # Eq. 6, with the documented weights.
    region, boundary, motion, overlap = terms.T
    assert values == pytest.approx(overlap * (0.5 * region + 0.3 * boundary + 0.2 * motion) + 1 - overlap, abs=1e-12)
    assert [measure(model, pose) for pose in poses] == list(values)  # one by one or together
    assert measure(model, poses[:0]).shape == (0,)
    assert values.argmin() in (9, 10)
    assert measure.refine(model, poses[8]).discrepancy <= values[8] + 1e-6
    assert measure.search(model, poses).discrepancy <= found.discrepancy + 1e-12
    assert measure.beat["end_diastole"] == 0 and measure.beat["frames"] > 10


def test_residuals_suit_a_least_squares_optimiser(measure, family):
    found = measure.search(family.at([0.45]))
    start = np.array([0.45, *found.pose[:3]])

    def placed(x):
        return family.at(x[:1]), [*x[1:4], *found.pose[3:]]

    residuals = measure.residuals(*placed(start))
    assert np.sum(residuals**2) == pytest.approx(1 + measure(*placed(start)), abs=1e-9)
    assert measure.residuals(family.at([0.55]), found.pose).shape == residuals.shape

    def columns(x):
        return measure.residual_columns(family.at, x[:1], [0.01], placed(x)[1])[1][:, :4]

    # A column is the slope of the residuals.
    slope = 2 * columns(start).T @ residuals
    for unknown, step in enumerate((0.015, 0.7, 0.7, 0.7)):
        move = np.zeros(4)
        move[unknown] = step
        wanted = (measure(*placed(start + move)) - measure(*placed(start - move))) / (2 * step)
        assert slope[unknown] == pytest.approx(wanted, rel=0.25, abs=0.003 / step)
    optimize = pytest.importorskip("scipy.optimize")
    best = optimize.least_squares(lambda x: measure.residuals(*placed(x)), start, columns, bounds=([0.4, -20, -20, -20], [0.6, 20, 20, 20]),
                                  x_scale=[0.05, 1, 1, 1], max_nfev=8)
    assert 2 * best.cost - 1 < measure(*placed(start)) - 1e-3
    assert best.x[0] == pytest.approx(0.5, abs=0.03)


def test_threads_share_a_measure(measure, family):
    model, pose = family.at([0.45]), [0, 0, 0, 1, 0, 0]
    alone, together = measure(model, pose), [None] * 4

    def work(i):
        together[i] = (measure(family.at([0.45]), pose), measure.refine(model, pose, threads=1).discrepancy)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(t == (alone, measure.refine(model, pose).discrepancy) for t in together)


def test_models_are_arrays(family):
    model = family.at([0.5], tilt_deg=1, rotate_deg=-2)
    assert model.tissue.shape == (20, *model.cells_mm.shape[:2]) and model.cells_mm.shape[2] == 2
    assert model.tissue.max() < len(model.tissues) and "blood" in model.tissues and 0.2 < model.systole < 0.6
    points, structures = model.boundary(0)
    assert points.shape == (len(structures), 2) and structures.max() < len(model.structures)
    assert family.ranges == {"ef": (0.4, 0.6)} and family.nodes == 4
    # Less blood at the end of systole.
    blood = (model.tissue == model.tissues.index("blood")).sum(axis=(1, 2))
    assert blood[round(20 * model.systole)] < blood[0]


NAN, INF = float("nan"), float("inf")
POSE = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]


def other(at, value):
    return [*POSE[:at], value, *POSE[at + 1:]]


# Dials with terms of degree 2: with 16 of them, a family has too many hearts.
QUADRATIC = {name: (row["least"], row["most"]) for name, row in echocine.dials().items()
             if not name.startswith(("bow", "ellipticity", "apical_thickness", "lateral", "anterior"))}


@pytest.mark.parametrize("call, words", [
    (lambda f, m, r: f.at([0.7]), "values: ef is 0.7, accepted: 0.4 to 0.6"),
    (lambda f, m, r: f.at([NAN]), "values: ef is nan, accepted"),
    (lambda f, m, r: f.at([0.5, 0.5]), "values: holds 2 numbers, accepted: 1"),
    (lambda f, m, r: f.at([[0.5]]), r"values: is \(1, 1\), float64, accepted: \(1,\)"),
    (lambda f, m, r: f.at("half"), "values: is str, accepted: an array of numbers"),
    (lambda f, m, r: f.at([0.5], tilt_deg=3), "tilt_deg: is 3, accepted: up to 2"),
    (lambda f, m, r: f.at([0.5], rotate_deg=NAN), "rotate_deg: is nan, accepted"),
    (lambda f, m, r: f.at([0.5]).boundary(20), "frame: is 20, accepted: 0 to 19"),
    (lambda f, m, r: echocine.HeartFamily({"eff": (0.4, 0.6)}), r"ranges: \"eff\" is not a dial of the heart \(nearest: ef\)"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.6, 0.4)}), "ranges: ef is 0.6 to 0.4, accepted"),
    (lambda f, m, r: echocine.HeartFamily({"ef": 0.4}), r"ranges: ef is 0.4, accepted: \(least, most\)"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, INF)}), "ranges: ef is inf, accepted"),
    (lambda f, m, r: echocine.HeartFamily([("ef", 0.4, 0.6)]), "ranges: is list, accepted"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6)}, ef=0.5), "dials: ef has a range"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6)}, hr=1000), "dials: hr is 1000, accepted"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6)}, "a5x"), "view: is \"a5x\", accepted: \"a4c\""),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6), "edv": (90, 100), "hr": (60, 70), "mapse": (9, 12), "ef ": (0.4, 0.6)}), "ranges: \"ef \" is not a dial"),
    (lambda f, m, r: echocine.HeartFamily(dict(list(QUADRATIC.items())[:16])), "ranges: needs 189 hearts, accepted: up to 125"),
    (lambda f, m, r: echocine.HeartFamily({f"ef{n}": (0.4, 0.6) for n in range(17)}), "ranges: holds 17, accepted: up to 16"),
    (lambda f, m, r: f.at([0.5], focus="lv"), "focus: is \"lv\", accepted: \"all\" | \"left_ventricle\""),
    (lambda f, m, r: echocine.ModelLoop(echocine.Scene(r / "scene.toml"), focus="lv"), "focus: is \"lv\""),
    (lambda f, m, r: echocine.HeartPrior().log_density(eff=0.6), r"dials: \"eff\" is not a dial of the heart \(nearest: ef\)"),
    (lambda f, m, r: echocine.HeartPrior().log_density(ef=2), "dials: ef is 2, accepted"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6)}, nodes=1), "nodes: is 1, accepted: 2 to 9"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6), "edv": (90, 100), "hr": (60, 70)}, nodes=6), "nodes: 6 for each of 3 ranges"),
    (lambda f, m, r: echocine.HeartFamily({"ef": (0.4, 0.6)}, tilt_deg=21), "tilt_deg: is 21, accepted: 0 to 20"),
    (lambda f, m, r: m(f.at([0.5]), POSE[:5]), r"poses: is \(5,\), float64, accepted: \(6,\) or \(poses, 6\)"),
    (lambda f, m, r: m(f.at([0.5]), [[POSE]]), "poses: is"),
    (lambda f, m, r: m(f.at([0.5]), other(0, NAN)), "shift_x_mm is nan, accepted"),
    (lambda f, m, r: m(f.at([0.5]), other(1, 1e300)), "shift_z_mm is 1e.303|shift_z_mm is 1e.300, accepted"),
    (lambda f, m, r: m(f.at([0.5]), other(2, 500)), "turn_deg is 500, accepted: -180 to 180"),
    (lambda f, m, r: m(f.at([0.5]), other(3, 0)), "scale is 0, accepted: 0.2 to 5"),
    (lambda f, m, r: m(f.at([0.5]), other(4, 0.5)), "poses: lag is 0.5, accepted: a whole number"),
    (lambda f, m, r: m(f.at([0.5]), other(4, 1e18)), "poses: lag is 1e.18, accepted"),
    (lambda f, m, r: m(f.at([0.5]), other(5, 1.0)), "systole is 1, accepted: 0.05 to 0.95"),
    (lambda f, m, r: m.residuals(f.at([0.5]), [POSE]), r"pose: is \(1, 6\), float64, accepted: \(6,\)"),
    (lambda f, m, r: m.residual_columns(f.at, [0.5], [0.0], POSE), "steps: accepted: 1 positive numbers"),
    (lambda f, m, r: m.refine(f.at([0.5]), np.empty((0, 6))), "starts: contains no pose"),
    (lambda f, m, r: m.refine(f.at([0.5]), other(3, -1)), "scale is -1, accepted"),
    (lambda f, m, r: m(f, POSE), "model: is HeartFamily, accepted: an echocine.ModelLoop"),
    (lambda f, m, r: echocine.ModelDiscrepancy(r / "loop", 3), "first: is int, accepted"),
    (lambda f, m, r: echocine.ModelDiscrepancy(r / "loop", f.at([0.5]), weights=(1, 2)), "weights: holds 2 numbers, accepted: 3"),
    (lambda f, m, r: echocine.ModelDiscrepancy(r / "loop", f.at([0.5]), weights=(0, 0, 0)), "weights: is 0, 0, 0, accepted"),
    (lambda f, m, r: echocine.ModelDiscrepancy(r / "loop", f.at([0.5]), weights=(NAN, 1, 1)), "weights: is nan"),
    (lambda f, m, r: echocine.ModelDiscrepancy(r / "loop", f.at([0.5]), side={"sid": 1}), "side: \"sid\" is not known, accepted"),
    (lambda f, m, r: echocine.ModelDiscrepancy(r / "none.avi", f.at([0.5])), "none.avi"),
])
def test_bad_arguments_are_refused_in_one_line(family, measure, real, call, words):
    with pytest.raises((ValueError, TypeError, IndexError, echocine.JobError), match=words) as refused:
        call(family, measure, real)
    assert "\n" not in str(refused.value)


def test_progress_can_stop_a_family():
    told = []

    def progress(done, total):
        told.append((done, total))
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        echocine.HeartFamily({"ef": (0.4, 0.6), "edv": (100, 160)}, nodes=4, progress=progress)
    assert told and told[0][1] == 16 and told[0][0] < 16
