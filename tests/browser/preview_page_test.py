"""The preview of a small dataset: preview_page_test.py ECHOCINE SOURCE_FOLDER"""

import os
import subprocess
import sys

import browser

SPEC_HEAD = """name = "tiny & <small>"
hearts = 40
views = ["a4c", "plax"]
layouts = ["native"]
"""


class PreviewPage(browser.PageTest):
    def test_every_heart_has_its_picture_and_its_words(self):
        shown = self.run_script("""
            return Array.from(document.querySelectorAll("#sheet figure"), (figure) => [
              figure.querySelector("img").naturalWidth, figure.querySelector("figcaption").textContent])""")
        self.assertEqual(len(shown), 3)
        for (width, words), preview in zip(shown, self.run_script("return page.data.previews"), strict=True):
            self.assertEqual(width, 448)
            self.assertIn(preview["id"], words)
            self.assertIn(f"{preview['ef_percent']:.0f} %", words)
        self.assertIn("tiny & <small>", self.text("title"))

    def test_what_varies_has_a_chart_that_counts_every_draw(self):
        names = self.run_script("return Array.from(document.querySelectorAll('#drawn h3'), (e) => e.textContent)")
        self.assertIn("heart.edv", names)
        counts = self.run_script("""
            return page.parts.charts.map((c) => c.getOption().series[0].data.reduce((a, b) => a + b))""")
        self.assertEqual(counts[names.index("heart.edv")], 40)

    def test_nothing_constant_has_a_chart(self):
        varies = self.run_script("""
            return Object.values(page.data.drawn).filter((values) => new Set(values).size > 1).length""")
        self.assertEqual(len(self.run_script("return page.parts.charts.map(() => 1)")), varies)


def make_page(folder):
    program, source = sys.argv[1:3]
    spec, path = os.path.join(folder, "tiny.toml"), os.path.join(folder, "look.html")
    with open(spec, "w") as file, open(os.path.join(source, "tests", "support", "small_loops.toml")) as rest:
        file.write(SPEC_HEAD + rest.read())
    subprocess.run([program, "dataset", spec, "--preview", "3", "-o", path, "--quiet"], check=True)
    return path


if __name__ == "__main__":
    browser.main(PreviewPage, make_page)
