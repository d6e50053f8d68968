"""sweeps.html of hand-written sweeps: sweeps_page_test.py SWEEP_PLOTS SOURCE_FOLDER"""

import os
import subprocess
import sys

import browser

# file: (variable, bound, [(at, error)])
SWEEPS = {
    "angle.csv": ("cos_i", 1e-5, [(10.0 ** -(i / 10), 1e-9 if i == 40 else 1e-16) for i in range(100)]),
    "exact.csv": ("sample", 0, [(i, 0) for i in range(5)]),
    "one_point.csv": ("depth, m", 1e-5, [(0.05, 1e-7)]),
    "signed.csv": ("away", 1e-5, [(s * 10.0 ** -k, 3e-8) for k in range(2, 17) for s in (-1, 1)] + [(0, 0)]),
    "spike.csv": ("<b>contrast</b>", 1e-5, [(i / 10, 1e-3 if i == 7 else 1e-12) for i in range(20)] + [(3, "inf")]),
}


class SweepsPage(browser.PageTest):
    def series(self, chart):
        return self.run_script("""
            return page.parts.charts[arguments[0]].getOption().series.map((s) => ({ name: s.name, data: s.data }))""", chart)

    def test_every_sweep_is_drawn_with_its_bound(self):
        self.assertEqual(self.run_script("return page.parts.charts.length"), len(SWEEPS))
        for chart, (variable, bound, points) in enumerate(SWEEPS.values()):
            series = {s["name"]: s["data"] for s in self.series(chart)}
            drawn = sorted((p[2], p[3]) for p in series["error"] if p[3] is not None)
            self.assertEqual(drawn, sorted((at, error) for at, error in points if error != "inf"))
            self.assertEqual(len(series["error"]), len(points))
            self.assertEqual("bound" in series, bound > 0)
            for _, y in series.get("bound", []):
                self.assertEqual(y, bound)
            name, kind = self.run_script("""
                const { xAxis, yAxis } = page.parts.charts[arguments[0]].getOption();
                return [xAxis[0].name, yAxis[0].type];""", chart)
            self.assertEqual((name, kind), (variable, "log"))

    def test_points_keep_their_order_and_lie_on_the_plot(self):
        for chart in range(len(SWEEPS)):
            places = self.run_script("""
                const chart = page.parts.charts[arguments[0]];
                const box = chart.getModel().getComponent("grid").coordinateSystem.getRect();
                return chart.getOption().series[0].data.map((p) => {
                  const [x, y] = chart.convertToPixel({ seriesIndex: 0 }, p);
                  return [x - box.x, y - box.y, box.width, box.height];
                });""", chart)
            for x, y, width, height in places:
                self.assertTrue(-0.5 <= x <= width + 0.5 and -0.5 <= y <= height + 0.5, (chart, x, y))
            self.assertEqual([p[0] for p in places], sorted(p[0] for p in places))

    def test_what_is_beyond_its_bound_is_said(self):
        self.assertIn("5 sweeps, 158 points, 1 beyond its bound", self.text("subtitle"))
        rows = self.run_script("""
            return Array.from(document.querySelectorAll("#table tbody tr"), (row) => Array.from(row.cells, (c) => c.textContent))""")
        self.assertEqual({row[-1]: row[-2] for row in rows},
                         {name: "beyond" if name == "spike.csv" else "within" for name in SWEEPS})
        self.assertEqual(rows[0][3], "1.0e-9")
        self.assertEqual(rows[0][1], "<i>nothing</i>")
        self.assertIn("against <i>nothing</i>: worst 1.0e-9, bound 1e-5", self.text("plots"))
        self.assertEqual(rows[-1][3], "no number")


def make_page(folder):
    program = sys.argv[1]
    sweeps, out = os.path.join(folder, "sweeps"), os.path.join(folder, "out")
    os.mkdir(sweeps)
    for name, (variable, bound, points) in SWEEPS.items():
        with open(os.path.join(sweeps, name), "w") as file:
            file.write(f"# case: {name} </script>\n# against: <i>nothing</i>\n# variable: {variable}\n# bound: {bound}\n")
            file.write("at,got,expected,error\n")
            file.writelines(f"{at!r},0,0,{error}\n" for at, error in points)
    subprocess.run([program, sweeps, out], check=True)
    return os.path.join(out, "sweeps.html")


if __name__ == "__main__":
    browser.main(SweepsPage, make_page)
