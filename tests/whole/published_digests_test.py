"""The first loop of examples/datasets/echocine_tte_1000.toml has its published digest: published_digests_test.py ECHOCINE SOURCE_DIR"""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2]) / "examples/datasets"
SYSTEM = "Debian GNU/Linux 12"  # the video's bytes name the version of libav
FIRST = "ec000001_a2c"


def main():
    release = pathlib.Path("/etc/os-release")
    if not release.exists() or SYSTEM not in release.read_text():
        print(f"SKIPPED: the digests are those of {SYSTEM}")
        return 77
    module = importlib.util.spec_from_file_location("digests", EXAMPLES / "digests.py")
    digests = importlib.util.module_from_spec(module)
    module.loader.exec_module(digests)
    lines = (EXAMPLES / "echocine_tte_1000.sha256").read_text().splitlines()
    published = {name: value for value, name in (line.split("  ") for line in lines)}
    text = (EXAMPLES / "echocine_tte_1000.toml").read_text()
    # A heart's draws depend on its number alone, a view's on the view: one loop is enough.
    for old, new in (("hearts = 1000", "hearts = 1"), ('views = ["a2c", "a4c"]', 'views = ["a2c"]')):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "echocine_tte_1000.toml").write_text(text)
        subprocess.run([PROGRAM, "dataset", folder / "echocine_tte_1000.toml", "-o", folder / "made", "--threads", "1", "--quiet"], check=True)
        made = digests.digests(folder / "made")[FIRST]
    if made != published[FIRST]:
        print(f"{FIRST}: {made}, published: {published[FIRST]}. If the change of pictures or truth is intended, make the dataset "
              "again and renew examples/datasets/echocine_tte_1000.sha256")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
