"""The steps by which EchoNet-Dynamic made its videos from DICOM files, applied to a DICOM file of this program, against
the videos of the layout echonet: echonet_conversion_test.py ECHOCINE

The steps are those of scripts/ConvertDICOMToAVI.ipynb in github.com/echonet/dynamic: cut the rows above the first dark one,
take the middle square, trim a tenth of each side, shrink to 112 x 112 by cubic interpolation, mask the upper corners.
"""

import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import cv2
    import numpy
    import pydicom
except ImportError as missing:
    print(f"SKIPPED: {missing}: needs python3-opencv, python3-numpy and python3-pydicom (.ci/test-packages.txt)")
    sys.exit(77)

SIDE = 112
SPEC = """name = "conversion"
scenes = ["heart/scene.toml"]
views = ["a4c"]
layouts = ["native", "echonet"]
truth = ["contours", "function"]
resolution_mm = 0.3
[split]
train = 1
[scene.probe]
lines = 96
samples = 256
[scene.acquisition]
frame_rate_hz = 12
"""


def sector_mask():
    """True where the published mask keeps a pixel: below two diagonals that meet the top a tenth beyond its middle."""
    x, y = numpy.meshgrid(numpy.arange(SIDE), numpy.arange(SIDE))
    reach = SIDE // 2 + SIDE // 10
    return (x + y > reach) & (x - y < reach)


def converted(screens, how):
    """Frames of 112 x 112 from screens (frame, row, column)."""
    first_dark = int(numpy.argmax(screens[0].mean(axis=1) < 1))
    screens = screens[:, first_dark:]
    height, width = screens.shape[1:]
    spare = abs(width - height) // 2
    if spare:
        screens = screens[:, :, spare:-spare] if height < width else screens[:, spare:-spare]
    height = screens.shape[1]
    trim = height // 10
    return numpy.array([cv2.resize(s[trim:height - trim, trim:height - trim], (SIDE, SIDE), interpolation=how) for s in screens])


def video_frames(path):
    video, frames = cv2.VideoCapture(path), []
    while True:
        there, frame = video.read()
        if not there:
            return numpy.array(frames)
        frames.append(frame[..., 0])


class Conversion(unittest.TestCase):
    folder = None

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def setUp(self):
        dicom = pydicom.dcmread(self.path("render", "cine.dcm"))
        pictures = dicom.pixel_array[..., 0]
        self.assertEqual(dicom.PhotometricInterpretation, "RGB")
        # A scanner's screen: a bright banner above, and around the picture so much black that the trimmed square is the
        # sector's bounding square, as the layout crops it.
        side = pictures.shape[1]
        margin = round(0.02 * side)
        square = side - 2 * margin
        height = next(h for h in range(square, 2 * square) if h - 2 * (h // 10) == square)
        around, banner, beside = height // 10 - margin, 40, 170
        self.screens = numpy.zeros((len(pictures), banner + height, height + 2 * beside), numpy.uint8)
        self.screens[:, :banner] = 90
        self.screens[:, banner + around:banner + around + side, beside + around:beside + around + side] = pictures
        [video] = glob.glob(self.path("data", "echonet", "Videos", "*.avi"))
        self.frames = video_frames(video)
        self.assertEqual(self.frames.shape, (len(pictures), SIDE, SIDE))

    def test_the_published_steps_give_the_frames_of_the_layout(self):
        kept = sector_mask()
        for how, name, most_mean, most_rms in ((cv2.INTER_CUBIC, "cubic", 6.0, 13.0), (cv2.INTER_AREA, "area", 1.3, 2.4)):
            off = converted(self.screens, how).astype(float) - self.frames
            mean, rms = numpy.abs(off[:, kept]).mean(), numpy.sqrt((off[:, kept]**2).mean())
            print(f"echonet: {name}: mean difference {mean:.2f}, RMS {rms:.2f}, bias {off[:, kept].mean():.2f} grey levels")
            self.assertLess(mean, most_mean)
            self.assertLess(rms, most_rms)
            self.assertLess(abs(off[:, kept].mean()), 0.5)

    def test_they_lie_on_each_other(self):
        """The best shift is zero: the difference is larger for a shift of one pixel in any direction."""
        steps = converted(self.screens, cv2.INTER_CUBIC).astype(float)

        def difference(dx, dy):
            moved = numpy.roll(steps, (dy, dx), axis=(1, 2))[:, 2:-2, 2:-2]
            return ((moved - self.frames[:, 2:-2, 2:-2])**2).mean()

        still = difference(0, 0)
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            self.assertGreater(difference(dx, dy), 1.5 * still)

    def test_the_mask_leaves_all_but_the_tip(self):
        """The part of the frames that the mask removes lies within a fifth of the height from the probe."""
        removed = (self.frames > 20) & ~sector_mask()
        self.assertFalse(removed[:, SIDE // 5:].any())


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    with tempfile.TemporaryDirectory() as folder:
        Conversion.folder = folder

        def run(*args):
            subprocess.run([PROGRAM, *args, "--quiet"], check=True, cwd=folder)

        # Without speckle and noise, whose seeds a dataset draws, both programs make the same pictures.
        run("heart", "--view", "a4c", "--keyframes", "8", "--look", "paper", "-o", "heart")
        with open(os.path.join(folder, "spec.toml"), "w") as file:
            file.write(SPEC)
        run("dataset", "spec.toml", "-o", "data")
        with open(glob.glob(os.path.join(folder, "data", "native", "*", "loop.json"))[0]) as file:
            loop = json.load(file)
        with open(os.path.join(folder, "heart", "scene.toml")) as file:
            scene = file.read()
        probe = loop["scene"]["probe"]
        for key, value in (("lines", 96), ("samples", 256), ("frame_rate_hz", 12), ("apex", [1e3 * x for x in probe["apex_m"]]),
                           ("axis", probe["axis"]), ("lateral", probe["lateral"])):
            scene = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", scene)
        scene += (f'\n[output]\nwidth = {loop["width"]}\nheight = {loop["height"]}\necg = false\ndepth_ticks = false\n'
                  'dicom = true\ncodec = "ffv1"\n')
        with open(os.path.join(folder, "heart", "large.toml"), "w") as file:
            file.write(scene)
        run("render", os.path.join("heart", "large.toml"), "-o", "render")
        unittest.main(verbosity=1)
