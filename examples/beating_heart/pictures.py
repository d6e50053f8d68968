#!/usr/bin/env python3
"""Draws the pictures of this folder again: loop.gif, views.png, looks.png, probes.png, truth.png, report.png and study.png.

    examples/beating_heart/pictures.py [--program build/release/echocine] [--work FOLDER] [NAME ...]

NAME is a picture without its ending; without names all are drawn. looks.png and study.png take minutes.
Needs ffmpeg and chromium. Renders are kept in FOLDER and used again.
"""

import argparse
import base64
import json
import pathlib
import shutil
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
LOOKS = ["scanner", "smooth", "contrast", "sharp", "portable", "faint"]
VIEWS = ["a4c", "a2c", "a3c", "plax", "psax-base", "psax-mid", "psax-apex", "subcostal"]
CATHETER = """[probe]
kind = "radial"
apex = [0, 0, -22]
axis = [0, 0, 1]
lateral = [1, 0, 0]
face_radius_mm = 1.7
min_depth_mm = 1
depth_mm = 65
frequency_mhz = 5
aperture_mm = 3
elevation_aperture_mm = 3
elevation_focus_mm = 25
lines = 360

"""
END_SYSTOLE = 15  # frame of the shipped heart at 50 frames per second
TRUTH_FRAMES = [0, 9, 18, 30]
CROP = (40, 0, 720, 508)  # of a cine of 800 x 600: left, top, width, height; without the ECG

GIF = ("[0]crop=720:500:40:0,scale=360:-1:flags=area[a];[1]crop=720:500:40:0,scale=360:-1:flags=area[b];"
       "[a][b]hstack,select='not(mod(n,2))',setpts=N/25/TB,split[x][y];"
       "[x]palettegen=max_colors=32[p];[y][p]paletteuse=dither=none")

# Frames with labels in colours and contours in white, drawn by a browser.
TRUTH_PAGE = """<!doctype html><body style="margin:0;background:#000"><canvas></canvas><script>
const frames = %s, [left, top_, width, height] = %s, scale = 440 / width, columns = 2;
const picture = source => new Promise(done => {
  const image = new Image();
  image.onload = () => done(image);
  image.src = source;
});
(async () => {
  const canvas = document.querySelector("canvas"), side = Math.round(height * scale);
  canvas.width = 440 * columns;
  canvas.height = side * Math.ceil(frames.length / columns);
  const context = canvas.getContext("2d");
  for (const [k, frame] of frames.entries()) {
    const cine = await picture(frame.cine), labels = await picture(frame.labels);
    const sheet = new OffscreenCanvas(cine.width, cine.height), paint = sheet.getContext("2d");
    paint.drawImage(labels, 0, 0);
    const area = paint.getImageData(0, 0, cine.width, cine.height), data = area.data;
    for (let i = 0; i < data.length; i += 4) {
      const label = data[i], turn = label * 2.399963;  // golden angle: neighbours differ
      const part = shift => 128 + 100 * Math.cos(turn + shift);
      data.set(label ? [part(0), part(2.1), part(4.2), 120] : [0, 0, 0, 0], i);
    }
    paint.putImageData(area, 0, 0);
    context.save();
    context.translate(440 * (k %% columns), side * Math.floor(k / columns));
    context.beginPath();
    context.rect(0, 0, 440, side);
    context.clip();
    context.scale(scale, scale);
    context.translate(-left, -top_);
    context.drawImage(cine, 0, 0);
    context.drawImage(sheet, 0, 0);
    context.strokeStyle = "#fff";
    context.lineWidth = 2;
    for (const { closed, points } of frame.contours) {
      context.beginPath();
      for (const [x, y] of points) context.lineTo(x + 0.5, y + 0.5);
      if (closed) context.closePath();
      context.stroke();
    }
    context.restore();
  }
})();
</script>"""


def run(*command):
    subprocess.run([str(part) for part in command], check=True, stdin=subprocess.DEVNULL)


class Pictures:
    def __init__(self, program, work):
        self.program, self.work, self.ready = program, work, set()
        work.mkdir(parents=True, exist_ok=True)

    def made(self, name, *arguments):
        """The folder of a command of the program, which runs once for all pictures."""
        folder = self.work / name
        if name not in self.ready:
            shutil.rmtree(folder, ignore_errors=True)
            run(self.program, *arguments, "-o", folder, "--quiet")
            self.ready.add(name)
        return folder

    def shipped(self):
        return self.made("heart", "render", HERE / "scene.toml", "--truth", "labels,contours")

    def screenshot(self, page, name, size):
        whole = self.work / name
        run("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
            "--virtual-time-budget=20000", f"--window-size={size[0]},{size[1]}",
            f"--screenshot={whole}", page)
        run("ffmpeg", "-v", "error", "-y", "-i", whole, "-filter_complex",
            "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none", HERE / name)

    def loop(self):
        plain = self.made("plain", "heart", "--look", "paper")
        paper = self.made("paper", "render", plain / "scene.toml")
        run("ffmpeg", "-v", "error", "-y", "-i", paper / "cine.avi", "-i",
            self.shipped() / "cine.avi", "-filter_complex", GIF, HERE / "loop.gif")

    def instants(self, view, look):
        """Cines of one frame: end-diastole and end-systole."""
        heart = self.made(f"heart_{view}_{look}", "heart", "--view", view, "--look", look)
        return [self.made(f"{view}_{look}_{frame}", "render", heart / "scene.toml", "--frames",
                          f"{frame}:{frame + 1}") / "cine.avi" for frame in (0, END_SYSTOLE)]

    def sheet(self, cines, crop, width, height, columns, name):
        inputs = [part for cine in cines for part in ("-i", cine)]
        count = len(cines)
        small = "".join(f"[{k}]{crop}scale={width}:{height}:flags=area,format=gray[s{k}];"
                        for k in range(count))
        places = "|".join(f"{width * (k % columns)}_{height * (k // columns)}" for k in range(count))
        tiles = "".join(f"[s{k}]" for k in range(count))
        run("ffmpeg", "-v", "error", "-y", *inputs, "-filter_complex",
            f"{small}{tiles}xstack=inputs={count}:layout={places},format=gray", "-frames:v",
            "1", HERE / name)

    def views(self):
        cines = [cine for view in VIEWS for cine in self.instants(view, "scanner")]
        self.sheet(cines, "", 400, 300, 4, "views.png")

    def looks(self):
        """Two rows for each look: end-diastole and end-systole of all views."""
        cines = []
        for look in LOOKS:
            both = [self.instants(view, look) for view in VIEWS]
            cines += [one[k] for k in (0, 1) for one in both]
        left, top, width, height = CROP
        self.sheet(cines, f"crop={width}:{height}:{left}:{top},", 216, 152, len(VIEWS), "looks.png")

    def probes(self):
        """Transoesophageal, and a catheter in the left atrium."""
        tee = self.made("heart_tee", "heart", "--view", "tee-4c")
        text = (tee / "scene.toml").read_text()
        begin, end = text.index("[probe]"), text.index("[acquisition]")
        (tee / "catheter.toml").write_text(text[:begin] + CATHETER + text[end:])
        inputs = []
        for scene in ("scene", "catheter"):
            loop = self.made(f"probes_{scene}", "render", tee / f"{scene}.toml", "--frames", "0:1")
            inputs += ["-i", loop / "cine.avi"]
        run("ffmpeg", "-v", "error", "-y", *inputs, "-filter_complex",
            "[0]scale=600:450:flags=area[a];[1]scale=600:450:flags=area[b];[a][b]hstack,format=gray",
            "-frames:v", "1", HERE / "probes.png")

    def truth(self):
        folder = self.shipped()
        frames = []
        for k in TRUTH_FRAMES:
            still = self.work / f"still_{k}.png"
            run("ffmpeg", "-v", "error", "-y", "-i", folder / "cine.avi", "-vf",
                f"select=eq(n\\,{k})", "-frames:v", "1", still)
            contours = json.loads((folder / f"truth/contours_{k:04}.json").read_text())["contours"]
            frames.append({
                "cine": data_url(still),
                "labels": data_url(folder / f"truth/labels_{k:04}.png"),
                "contours": [{"closed": c["closed"], "points": c["points_px"]} for c in contours
                             if c["role"] != "surroundings"],
            })
        page = self.work / "truth.html"
        page.write_text(TRUTH_PAGE % (json.dumps(frames), json.dumps(CROP)))
        self.screenshot(page.as_uri(), "truth.png", (880, 2 * round(440 * CROP[3] / CROP[2])))

    def report(self):
        self.screenshot((self.shipped() / "report.html").as_uri(), "report.png", (1000, 641))

    def study(self):
        folder = self.made("study", "study", HERE / "scene.toml", "--repeats", "1")
        self.screenshot((folder / "study.html").as_uri() + "#plot", "study.png", (1200, 700))


def data_url(path):
    return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode()


def main():
    names = ["loop", "views", "looks", "probes", "truth", "report", "study"]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(names))
    parser.add_argument("--program", type=pathlib.Path, default="build/release/echocine")
    parser.add_argument("--work", type=pathlib.Path, default="out/pictures",
                        help="folder for the renders")
    options = parser.parse_args()
    if unknown := set(options.names) - set(names):
        parser.error(f"no picture is called {', '.join(sorted(unknown))}")
    pictures = Pictures(options.program.resolve(), options.work.resolve())
    for name in options.names or names:
        getattr(pictures, name)()


if __name__ == "__main__":
    main()
