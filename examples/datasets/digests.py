"""Prints SHA-256 digests of a finished dataset: digests.py FOLDER > echocine_tte_1000.sha256

Lists have one line each, as sha256sum prints it. A loop has one line for its files in native/ID and its video in echonet,
joined in the order of their names: the digest of `cat native/ID/* echonet/Videos/ID.avi`. Needs Python 3.8."""

import csv
import hashlib
import sys
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


if __name__ == "__main__":
    if len(sys.argv) != 2 or not (Path(sys.argv[1]) / "loops.csv").exists():
        sys.exit("usage: digests.py FOLDER, accepted: the folder of a finished dataset")
    for name, value in digests(Path(sys.argv[1])).items():
        print(f"{value}  {name}")
