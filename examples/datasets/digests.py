"""Prints SHA-256 digests of a finished dataset.

    digests.py FOLDER > echocine_tte_1000.sha256
    digests.py FOLDER --make --hearts 100 > echocine_tte_1000.sha256

The second command first makes or resumes the dataset of the first hearts of echocine_tte_1000.toml in FOLDER.

Lists have one line each, as sha256sum prints it. A loop has one line for its files in native/ID and its video in echonet,
joined in the order of their names: the digest of `cat native/ID/* echonet/Videos/ID.avi`. Needs Python 3.8."""

import argparse
import csv
import hashlib
import subprocess
import sys
import tempfile
from pathlib import Path

LISTS = ("echonet/FileList.csv", "echonet/VolumeTracings.csv", "nnunet/nnUNet_raw/Dataset501_EchoCine/dataset.json",
         "nnunet/nnUNet_preprocessed/Dataset501_EchoCine/splits_final.json", "loops.csv", "splits.json")


def digest_of(files):
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.read_bytes())
    return digest.hexdigest()


def loop_digest(folder, loop):
    return digest_of([*sorted((folder / "native" / loop).iterdir()), folder / "echonet/Videos" / (loop + ".avi")])


def digests(folder):
    """Name -> digest, lists first."""
    found = {name: digest_of([folder / name]) for name in LISTS if (folder / name).exists()}
    with open(folder / "loops.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found[row["id"]] = loop_digest(folder, row["id"])
    return found


def make(program, folder, hearts):
    """The dataset of the first hearts: the published spec with another number."""
    name = "echocine_tte_1000.toml"
    text = (Path(__file__).parent / name).read_text(encoding="utf-8")
    assert text.count("hearts = 1000\n") == 1
    with tempfile.TemporaryDirectory() as temporary:
        spec = Path(temporary) / name
        spec.write_text(text.replace("hearts = 1000\n", f"hearts = {hearts}\n"), encoding="utf-8")
        return subprocess.run([program, "dataset", spec, "-o", folder], stdout=sys.stderr).returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--make", action="store_true", help="make the dataset first")
    parser.add_argument("--program", default=str(Path(__file__).resolve().parents[2] / "build/release/echocine"),
                        help="with --make: the program; default build/release/echocine")
    parser.add_argument("--hearts", type=int, default=100, help="with --make: number of hearts; default 100")
    options = parser.parse_args()
    if options.make and make(options.program, options.folder, options.hearts) != 0:
        return 1
    if not (options.folder / "loops.csv").exists():
        print(f"{options.folder}: has no loops.csv, accepted: the folder of a finished dataset", file=sys.stderr)
        return 2
    for name, value in digests(options.folder).items():
        print(f"{value}  {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
