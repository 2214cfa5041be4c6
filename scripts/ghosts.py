#!/usr/bin/env python3
"""How many ghosts what moves has in simulated worlds, by their cause, and what is plausible by range.

    ghosts.py DATASET OUT [DATASET OUT]...

DATASET is a recording with its truth and causes (`ralf simulate --preset worlds --family FAMILY -o DATASET`), OUT what
`ralf label DATASET -o OUT --evidence` made of it. Counted are detections that move (3 sigma of `doppler_residual` or
more): those of each cause that shows a mover where it isn't, for each one that is plausible. Beside them stand the
share of all detections that move, of these the plausible ones' share of all, and the share of plausible ones among all,
within 40 m and beyond. Needs numpy and pyarrow.
"""

import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

MOVES = 3.0  # sigma
GHOSTS = "mirror", "double bounce", "side lobe", "ambiguity"
NEAR = 40.0  # m


def read_sequence(dataset, file):
    """Range, cause and motion of each detection."""
    table = pq.read_table(file, columns=["radar", "scan", "point", "range", "doppler_residual"])
    folder = Path(dataset) / "sequences" / file.parent.name / "ground_truth"
    radar, scan, point, reach, residual = (table[name].to_numpy(zero_copy_only=False) for name in table.column_names)
    begins = np.flatnonzero(np.r_[True, (radar[1:] != radar[:-1]) | (scan[1:] != scan[:-1])])
    causes = np.zeros(len(table), int)
    for begin, end in zip(begins, np.r_[begins[1:], len(table)]):
        told = np.fromfile(folder / radar[begin] / f"{scan[begin]:06}.cause", np.uint8)
        causes[begin:end] = told[point[begin:end]]
    names = np.array((folder / "causes.txt").read_text().splitlines())
    return reach, names[causes], np.abs(residual.astype(float)) > MOVES


def read_all(dataset, out):
    files = sorted(Path(out).glob("sequences/*/plausibility.parquet"))
    if not files:
        sys.exit(f"{out}: no sequences/*/plausibility.parquet")
    return [np.concatenate(column) for column in zip(*(read_sequence(dataset, file) for file in files))]


def main():
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    heads = "recording", *GHOSTS, "all ghosts", "moving", "real movers", "plausible", "within 40 m", "beyond"
    print("| " + " | ".join(heads) + " |\n" + "| --- " * len(heads) + "|")
    for dataset, out in zip(sys.argv[1::2], sys.argv[2::2]):
        reach, cause, moves = read_all(dataset, out)
        real = cause == "none"
        ghosts = np.array([np.sum(moves & (cause == name)) for name in GHOSTS]) / max(1, np.sum(moves & real))
        shares = [moves, moves & real, real, real[reach < NEAR], real[reach >= NEAR]]
        cells = [*ghosts, ghosts.sum(), *(share.mean() if len(share) else np.nan for share in shares)]
        print(f"| {Path(out).name} | " + " | ".join(f"{cell:.2f}" for cell in cells) + " |")


if __name__ == "__main__":
    main()
