"""Runs an example in a folder of its own: run_example.py FILE.py|FILE.ipynb. Skips where a package is missing."""

import json
import os
import runpy
import sys
import tempfile

file = os.path.abspath(sys.argv[1])


def notebook(path):
    """Code cells one after the other; what ends a cell is shown as a notebook would."""
    with open(path, encoding="utf-8") as text:
        cells = json.load(text)["cells"]
    names = {"__name__": "__main__"}
    for cell in cells:
        if cell["cell_type"] != "code":
            continue
        lines = "".join(cell["source"])
        *body, last = lines.rstrip().split("\n")
        exec(compile("\n".join(body), path, "exec"), names)
        try:
            value = eval(compile(last, path, "eval"), names)
        except SyntaxError:
            exec(compile(last, path, "exec"), names)
        else:
            assert value is None or getattr(value, "_repr_html_", value.__repr__)()


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.environ["MPLBACKEND"] = "Agg"
    try:
        if file.endswith(".ipynb"):
            notebook(file)
        else:
            runpy.run_path(file, run_name="__main__")
    except ModuleNotFoundError as missing:
        if missing.name is None or missing.name.startswith("echocine"):
            raise
        print(f"SKIPPED: needs {missing.name}")
        sys.exit(77)
    finally:
        os.chdir("/")
