#!/usr/bin/env python3
"""How well labels keep what moves, where the truth is known.

    movers.py DATASET OUT

DATASET is a recording with its truth, such as `ralf simulate --scenario testdata/motorway.toml -o DATASET` makes one; OUT what
`ralf label DATASET -o OUT --evidence` wrote. A detection moves if its compensated range rate is more than three of the
scan's spreads from standing still (column `doppler_residual`). Of these are printed: recall (the share of the truly
plausible ones that is labelled plausible) and precision (the share of those labelled plausible that truly is), and the
largest recall at a precision of 0.90 or more, whatever the threshold. Needs NumPy and PyArrow.
"""

import sys
from pathlib import Path

import numpy
import pyarrow.parquet

MOVES = 3.0  # spreads
PRECISION = 0.9
# SemanticKITTI ids that are artifacts: outlier, road, parking, sidewalk, other-ground, lane-marking.
ARTIFACTS = [1, 40, 44, 48, 49, 60]


def movers(dataset, file):
    """`w`, label and truth of each detection of a sequence that moves."""
    table = pyarrow.parquet.read_table(file)
    if "doppler_residual" not in table.column_names:
        sys.exit(f"{file}: no column doppler_residual: label with --evidence")
    column = {name: table[name].to_numpy(zero_copy_only=False) for name in ["w", "label", "scan", "doppler_residual"]}
    radar = numpy.array(table["radar"].to_pylist())
    truth = numpy.full(len(radar), -1)
    for name in sorted(set(radar)):
        for scan in numpy.unique(column["scan"][radar == name]):
            labels = dataset / "sequences" / file.parent.name / "ground_truth" / name / f"{scan:06}.label"
            ids = numpy.fromfile(labels, "<u4") & 0xFFFF
            rows = numpy.flatnonzero((radar == name) & (column["scan"] == scan))
            if len(ids) != len(rows):
                sys.exit(f"{labels}: expected {len(rows)} labels, found {len(ids)}")
            truth[rows] = numpy.where(ids == 0, -1, ~numpy.isin(ids, ARTIFACTS))
    chosen = (numpy.abs(numpy.nan_to_num(column["doppler_residual"])) > MOVES) & (truth >= 0)
    return column["w"][chosen], column["label"][chosen] == 1, truth[chosen] == 1


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    dataset, out = map(Path, sys.argv[1:])
    files = sorted(out.glob("sequences/*/plausibility.parquet"))
    if not files:
        sys.exit(f"{out}: no sequences/*/plausibility.parquet")
    w, label, truth = (numpy.concatenate(part) for part in zip(*(movers(dataset, file) for file in files)))
    right = (label & truth).sum()
    print(f"{len(w)} detections move, {truth.sum()} of them are plausible")
    print(f"recall {right / max(truth.sum(), 1):.3f}, precision {right / max(label.sum(), 1):.3f}")
    order = numpy.argsort(-w, kind="stable")
    found = numpy.cumsum(truth[order])
    precise = found / numpy.arange(1, len(w) + 1) >= PRECISION
    best = found[precise].max() / max(truth.sum(), 1) if precise.any() else 0.0
    print(f"recall at a precision of {PRECISION:.2f}: {best:.3f}")


if __name__ == "__main__":
    main()
