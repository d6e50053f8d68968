"""Keys, errors, meshes and copies of scenes."""

import copy
import pickle
import tomllib
from pathlib import Path

import numpy as np
import pytest

import echocine
from conftest import ball, ball_scene

SOURCE = Path(__file__).resolve().parents[2]
EVERY_KEY = SOURCE / "examples" / "every_key" / "scene.toml"


def test_segments_are_checked():
    for segments, words in (({7.9: 0}, "7.9 is no segment"), ({"x": 0}, "'x' is no segment"),
                            ({7: "a"}, "segment 7: is 'a', accepted: a number"), ({7: (0, 1, 2)}, "segment 7: is ")):
        with pytest.raises(echocine.SceneError, match=words):
            echocine.heart(segments=segments)


def test_every_key_of_the_documented_scene_reads_back():
    scene = echocine.Scene(EVERY_KEY)
    document = tomllib.loads(EVERY_KEY.read_text())
    for table in ("probe", "acquisition", "motion", "effects", "trabeculae", "speckle", "artefacts", "signal", "accuracy", "output"):
        for key, value in document[table].items():
            assert scene[f"{table}.{key}"] == value
            assert getattr(getattr(scene, table), key) == value
    for entry in document["structure"]:
        for key, value in entry.items():
            assert scene[f"structure.{entry['name']}.{key}"] == value


def test_defaults_are_those_that_the_documented_scene_names():
    document = tomllib.loads(EVERY_KEY.read_text())
    scene = ball_scene()
    for table in ("effects", "trabeculae", "speckle", "artefacts", "accuracy"):
        for key, value in document[table].items():
            assert scene[f"{table}.{key}"] == pytest.approx(value) if isinstance(value, float) else scene[f"{table}.{key}"] == value


def test_the_table_of_keys_names_every_key_of_a_scene():
    table = echocine.scene_keys()
    assert table["probe.depth_mm"]["unit"] == "mm" and '"linear"' in table["probe.kind"]["accepted"]
    for key in echocine.Scene(EVERY_KEY).keys():
        parts = key.split(".")
        if parts[0] == "structure":
            key = f"structure.{parts[-1]}"
        elif parts[0] == "media":
            key = "media." + ".".join(parts[2:])
        assert key in table or key == "media.backscatter"


def test_every_key_can_be_set_to_what_it_is():
    scene = echocine.Scene(EVERY_KEY)
    for key in scene.keys():
        value = scene[key]
        # Optional keys without a value, and those that only another setting makes useful.
        if value is None or key.startswith("media.") or isinstance(value, list) and not value:
            continue
        scene[key] = value
        assert scene[key] == value


def test_a_rewritten_scene_says_the_same():
    scene = echocine.Scene(EVERY_KEY)
    before = scene._native.json
    scene["signal.gain_db"] = 1.0
    scene["signal.gain_db"] = 0.0
    assert scene._native.json == before
    assert echocine.Scene(scene.text, folder=EVERY_KEY.parent)._native.json == before


def test_a_bad_value_is_named_and_leaves_the_scene(scene):
    text = scene.text
    with pytest.raises(echocine.SceneError, match="signal.look.*accepted") as caught:
        scene.signal.look = "foggy"
    assert caught.value.key == "signal.look" and caught.value.line is None
    with pytest.raises(echocine.SceneError, match="probe.linse.*nearest"):
        scene["probe.linse"] = 3
    with pytest.raises(echocine.SceneError, match="nearest is probe.lines"):
        scene["probe.linse"]
    with pytest.raises(AttributeError):
        scene.probe.linse
    with pytest.raises(TypeError, match="probe.lines.*object"):
        scene["probe.lines"] = object()
    assert scene.text == text and scene.probe.lines == 24


def test_errors_of_a_file_have_its_line(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text("[probe]\napex = [0, 0, 0]\naxis = [0, 0, 1]\nlateral = [1, 0, 0]\nkind = 'square'\n")
    with pytest.raises(echocine.SceneError) as caught:
        echocine.Scene(file)
    assert (caught.value.file, caught.value.line, caught.value.key) == (str(file), 5, "probe.kind")
    with pytest.raises(echocine.SceneError, match="cannot be read"):
        echocine.Scene(tmp_path / "absent.toml")


def test_none_is_the_default(scene):
    scene.signal.gain_db = 3
    assert scene.signal.gain_db == 3
    scene.signal.gain_db = None
    assert scene.signal.gain_db == 0
    del scene["output.codec"]
    assert scene.output.codec == "mjpg"


def test_numpy_values_are_numbers(scene):
    scene["probe.apex"] = np.array([0, 0, 1.0])
    scene["probe.lines"] = np.int64(30)
    assert scene["probe.apex"] == [0, 0, 1] and scene.probe.lines == 30


def test_copies_are_their_own(scene):
    for other in (scene.copy(), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        other.probe.lines = 12
        assert scene.probe.lines == 24
        points, faces = other.mesh("ball")
        assert np.array_equal(points, scene.mesh("ball")[0]) and np.array_equal(faces, scene.mesh("ball")[1])


def test_a_pickled_heart_is_the_same(heart):
    again = pickle.loads(pickle.dumps(heart))
    assert np.array_equal(echocine.Simulator(again).frame(0.1).intensities, echocine.Simulator(heart).frame(0.1).intensities)


def test_dials():
    table = echocine.dials()
    assert table["ef"]["least"] < 0.45 < table["ef"]["most"] and table["wall_thickness"]["unit"] == "mm"
    with pytest.raises(echocine.SceneError, match="ejection.*not a dial"):
        echocine.heart(ejection=0.3)
    with pytest.raises(echocine.SceneError, match="ef"):
        echocine.heart(ef=7)
    with pytest.raises(echocine.SceneError, match="view.*accepted"):
        echocine.heart(view="a9c")


@pytest.mark.parametrize("given, words", [
    (dict(EF=0.4), "EF: is not a dial, nearest: ef$"), (dict(rv_ed=100), "rv_ed: is not a dial, nearest: rv_edv$"),
    (dict(zzz=1), "accepted: .*wall_thickness"), (dict(ef="0.4"), "ef: is '0.4', accepted: a number"),
    (dict(ef=True), "ef: is True"), (dict(segments=[7, 13]), r"segments: is \[7, 13\], accepted"), (dict(view=0.4), "view: is 0.4"),
])
def test_dials_that_are_none_are_named_as_python_has_them(given, words):
    with pytest.raises(echocine.SceneError, match=words):
        echocine.heart(**given)


def test_new_points_keep_faces(scene):
    points, faces = scene.mesh("ball")
    scene["structure.ball.keyframes"] = points[:1] * [1, 1, 1.1]
    again, same = scene.mesh("ball")
    assert again.shape == (1, *points.shape[1:]) and np.array_equal(faces, same)
    assert np.allclose(again[0], points[0] * [1, 1, 1.1])


class Block:
    type = "triangle"

    def __init__(self, data):
        self.data = data


class Meshio:
    def __init__(self, points, faces):
        self.points, self.cells = points, [Block(faces)]


class Trimesh:
    def __init__(self, points, faces):
        self.vertices, self.faces = points, faces


class Pyvista:
    def __init__(self, points, faces):
        self.points, self.faces = points, np.concatenate([np.full((len(faces), 1), 3), faces], axis=1).ravel()


@pytest.mark.parametrize("kind", [Meshio, Trimesh, Pyvista, lambda p, f: {"points": p, "faces": f}])
def test_meshes_of_other_libraries(scene, kind):
    points, faces = ball()
    scene["structure.ball.keyframes"] = [kind(points, faces), kind(points * 0.9, faces)]
    got, triangles = scene.mesh("ball")
    assert np.array_equal(got, [points, points * 0.9]) and np.array_equal(triangles, faces)


POINTS, FACES = ball()


@pytest.mark.parametrize("bad, error, words", [
    ((POINTS[:, :2], FACES), ValueError, r"structure.ball.keyframes: points: is \(66, 2\), accepted"),
    ((POINTS, FACES[:, :2]), ValueError, r"faces: is \(128, 2\), .*accepted: \(F, 3\)"),
    ((POINTS, FACES.astype(float)), TypeError, "faces: .*float64, accepted: whole numbers"),
    ((POINTS, FACES + 1), ValueError, "faces: row .* vertex 66, accepted: 0 to 65"),
    ((POINTS, FACES - 1), ValueError, "faces: row .* vertex -1, accepted: 0 to 65"),
    ((POINTS.astype(str), FACES), TypeError, "points: .*accepted: numbers"),
    ((np.where(POINTS > 70, np.nan, POINTS), FACES), ValueError, "points: row .*nan.*accepted: finite"),
    ((POINTS[:0], FACES), ValueError, "points: is .*accepted"),
    (3.5, TypeError, None),
    ([], ValueError, None),
])
def test_bad_meshes_are_named(scene, bad, error, words):
    text = scene.text
    with pytest.raises((error, echocine.SceneError), match=words):
        scene["structure.ball.keyframes"] = bad
    assert scene.text == text


def test_an_inside_out_mesh_is_refused(scene):
    scene["structure.ball.keyframes"] = (POINTS, FACES[:, ::-1].copy())
    with pytest.raises(echocine.SceneError, match="ball"):
        echocine.Simulator(scene)


def test_arrays_of_any_order_and_type(scene):
    scene["structure.ball.keyframes"] = (np.asfortranarray(POINTS.astype(np.float32)), FACES.astype(np.uint8)[::1])
    assert np.allclose(scene.mesh("ball")[0][0], POINTS, atol=1e-4)


def test_structures_of_similar_names_keep_their_meshes():
    names = ("lv wall", "lv_wall", "lv.wall")
    source = ball_scene()._document()
    entry = {k: v for k, v in source["structure"][0].items() if k not in ("name", "keyframes")}
    source["structure"] = [{**entry, "name": name, "keyframes": (POINTS * (1 - 0.1 * i), FACES)} for i, name in enumerate(names)]
    scene = echocine.Scene(source)
    for i, name in enumerate(names):
        assert np.allclose(scene.mesh(name)[0][0], POINTS * (1 - 0.1 * i), atol=1e-4)
    scene["structure.lv wall.keyframes"] = POINTS[None] * 0.5
    assert np.allclose(scene.mesh("lv wall")[0][0], POINTS * 0.5, atol=1e-4)
    assert np.allclose(scene.mesh("lv_wall")[0][0], POINTS * 0.9, atol=1e-4)


def test_a_heart_has_the_scene_of_its_look():
    assert echocine.heart(keyframes=4, look="paper")["signal.dynamic_range_db"] == 58
    assert echocine.heart(keyframes=4, look="sharp")["signal.look"] == "sharp"
    with pytest.raises(echocine.SceneError, match='heart: look: is "foggy", accepted: "paper"'):
        echocine.heart(look="foggy")


def test_two_dials_of_one_width_are_refused():
    with pytest.raises(echocine.SceneError, match="lv-length and sphericity"):
        echocine.heart(lv_length=95, sphericity=0.7)


def test_media_of_any_name_read_back():
    names = ("a.b", "\U0001fac0", "de\x7fl")
    source = ball_scene()._document()
    medium = {"density_kg_m3": 1060.0, "sound_speed_m_s": 1540.0, "attenuation_db_cm_mhz": 0.5, "backscatter": {"kind": "none"}}
    source["media"] = {**source.get("media", {}), **{name: dict(medium) for name in names}}
    scene = echocine.Scene(source)
    for name in names:
        scene[f"media.{name}.density_kg_m3"] = 1041.0
        assert scene[f"media.{name}.density_kg_m3"] == 1041.0
        assert f"media.{name}.density_kg_m3" in scene.keys()
        assert scene[f"media.{name}.backscatter.kind"] == "none"
        scene.update({f"media.{name}.backscatter.kind": "fixed", f"media.{name}.backscatter.per_cm_sr": 1e-3})
        assert scene[f"media.{name}.backscatter.per_cm_sr"] == 1e-3
