"""NumPy reads the heart's .npz files, and the program those of NumPy: npz_test.py ECHOCINE SOURCE_FOLDER"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
except ImportError as missing:
    print(f"SKIPPED: {missing}: needs python3-numpy (.ci/test-packages.txt)")
    sys.exit(77)

KEYFRAMES = 5


def run(*arguments):
    return subprocess.run([sys.argv[1], *arguments], capture_output=True, text=True)


def obj_points(file):
    with open(file) as lines:
        return numpy.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=float)


class Npz(unittest.TestCase):
    folder = None

    def heart(self, name):
        return os.path.join(self.folder, name)

    def rendered(self, heart):
        """The first frame's picture, lossless."""
        out = self.heart("out")
        shutil.rmtree(out, ignore_errors=True)
        done = run("render", self.heart(heart) + "/scene.toml", "-o", out, "--frames", "0:1", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(os.path.join(out, "png", "frame_0000.png"), "rb") as file:
            return file.read()

    def changed(self, save, name="lv_wall"):
        """A copy of the .npz heart with one file written by `save(file, arrays)`."""
        copy = self.heart("changed")
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.heart("npz"), copy)
        with numpy.load(os.path.join(copy, name + ".npz"), allow_pickle=False) as npz:
            arrays = {key: npz[key] for key in npz.files}
        save(os.path.join(copy, name + ".npz"), arrays)
        return copy

    def refusal(self, save):
        copy = self.changed(save)
        done = run("render", copy + "/scene.toml", "-o", self.heart("out"), "--frames", "0:1", "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn("lv_wall.npz", done.stderr)
        return done.stderr

    def test_numpy_reads_the_heart(self):
        files = [f for f in os.listdir(self.heart("npz")) if f.endswith(".npz")]
        self.assertGreater(len(files), 20)
        self.assertFalse([f for f in os.listdir(self.heart("npz")) if f.endswith(".obj")])
        for file in files:
            with numpy.load(os.path.join(self.heart("npz"), file), allow_pickle=False) as npz:
                points, faces = npz["points"], npz["faces"]
            self.assertEqual(points.dtype, numpy.float64)
            self.assertEqual(faces.dtype, numpy.int32)
            still = os.path.join(self.heart("obj"), file[:-4] + ".obj")
            names = [still] if os.path.exists(still) else [
                os.path.join(self.heart("obj"), f"{file[:-4]}_{k:02d}.obj") for k in range(KEYFRAMES)]
            self.assertEqual(points.shape, (len(names), points.shape[1], 3))
            self.assertEqual((faces.min(), faces.max()), (0, points.shape[1] - 1))
            for k, name in enumerate(names):
                self.assertTrue((points[k] == obj_points(name)).all(), name)

    def test_the_pictures_are_those_of_the_obj_files(self):
        expected = self.rendered("obj")
        self.assertEqual(self.rendered("npz"), expected)
        for save in (
                lambda file, a: numpy.savez(file, **a),
                lambda file, a: numpy.savez_compressed(file, **a),
                lambda file, a: numpy.savez(file, **{k: numpy.asfortranarray(v) for k, v in a.items()}),
                lambda file, a: numpy.savez_compressed(file, **{k: v.astype(v.dtype.newbyteorder(">")) for k, v in a.items()}),
                lambda file, a: numpy.savez(file, **{**a, "faces": a["faces"].astype(numpy.uint64)})):
            self.changed(save)
            self.assertEqual(self.rendered("changed"), expected)

    def test_a_bad_file_is_one_line(self):
        def with_arrays(**changes):
            return lambda file, a: numpy.savez(file, **{**a, **changes})

        def with_points(change):
            return lambda file, a: numpy.savez(file, **{**a, "points": change(a["points"])})

        def spoilt(points):
            points[2, 7, 1] = numpy.nan
            return points

        self.assertIn("lv_wall.npz: points[2, 7, 1] is nan", self.refusal(with_points(spoilt)))
        self.assertIn("keyframes: 4 keyframes, accepted: as many as motion.keyframe_phases has, 5",
                      run_line(self, with_points(lambda p: p[:4])))
        self.assertIn("points is (", self.refusal(with_points(lambda p: p[0])))
        self.assertIn('points has the type "|O', self.refusal(with_points(lambda p: p.astype(object))))
        self.assertIn('points has the type "<c16"', self.refusal(with_points(lambda p: p.astype(complex))))
        self.assertIn("faces[0, 0] has vertex -1", self.refusal(with_arrays(faces=numpy.full((4, 3), -1))))
        self.assertIn("faces has floats", self.refusal(with_arrays(faces=numpy.zeros((4, 3)))))
        self.assertIn('has the array "phases"', self.refusal(with_arrays(phases=numpy.zeros(5))))
        self.assertIn('has no array "points"', self.refusal(lambda file, a: numpy.savez(file, faces=a["faces"])))
        self.assertIn("is no sound zip archive", self.refusal(lambda file, a: open(file, "wb").close()))
        self.assertIn("cannot be opened: No such file", self.refusal(lambda file, a: os.remove(file)))


def run_line(test, save):
    copy = test.changed(save)
    done = run("render", copy + "/scene.toml", "-o", test.heart("out"), "--frames", "0:1", "--quiet")
    test.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
    return done.stderr


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        Npz.folder = folder
        for format in ("obj", "npz"):
            made = run("heart", "-o", os.path.join(folder, format), "--keyframes", str(KEYFRAMES), "--format", format,
                       "--look", "paper", "--quiet")
            assert made.returncode == 0, made.stderr
            with open(os.path.join(folder, format, "scene.toml"), "a") as scene:
                scene.write("\n[output]\npng = true\n")
        result = unittest.main(argv=sys.argv[:1], exit=False).result
    sys.exit(not result.wasSuccessful())
