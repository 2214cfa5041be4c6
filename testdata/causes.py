#!/usr/bin/env python3
"""How well the told causes of artifacts are those that a simulator knows.

    causes.py DATASET OUT [DATASET OUT]...

DATASET is a recording with its causes (`ralf simulate --preset worlds --family city --seed 10 -o DATASET`), OUT what `ralf label
DATASET -o OUT --method learned` wrote. Of the true artifacts that are labelled so, for each cause: how many there are, the share of
which the cause is told (recall), the share that is told to be unclear, and of those of which it is told the share that has it
(precision). Needs NumPy and PyArrow.
"""

import sys
from pathlib import Path

import numpy
import pyarrow.parquet


def causes(dataset, file):
    """True and told cause of each artifact of a sequence that is labelled one."""
    truth_folder = dataset / "sequences" / file.parent.name / "ground_truth"
    names = numpy.array((truth_folder / "causes.txt").read_text().split("\n")[:-1])
    table = pyarrow.parquet.read_table(file, columns=["radar", "scan", "label", "cause"])
    radar, scan = numpy.array(table["radar"].to_pylist()), table["scan"].to_numpy()
    true = numpy.full(len(table), "none", dtype=object)
    for name in sorted(set(radar)):
        for number in numpy.unique(scan[radar == name]):
            codes = numpy.fromfile(truth_folder / name / f"{number:06}.cause", "u1")
            true[(radar == name) & (scan == number)] = names[codes]
    artifacts = (table["label"].to_numpy() == 0) & (true != "none")
    return true[artifacts], numpy.array(table["cause"].to_pylist(), dtype=object)[artifacts]


def main():
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    parts = []
    for dataset, out in zip(sys.argv[1::2], sys.argv[2::2]):
        parts += [causes(Path(dataset), file) for file in sorted(Path(out).glob("sequences/*/plausibility.parquet"))]
    true, told = (numpy.concatenate(part) for part in zip(*parts))
    print("| cause | artifacts | recall | unclear | precision |\n| --- | --- | --- | --- | --- |")
    for name in sorted(set(true)):
        here, said = true == name, told == name
        precision = f"{(here & said).sum() / said.sum():.2f}" if said.any() else "-"
        unclear = (told[here] == "unclear").mean()
        print(f"| {name} | {here.sum()} | {(told[here] == name).mean():.2f} | {unclear:.2f} | {precision} |")
    print(f"\n{(true == told).mean():.1%} of {len(true)} are told rightly, {(told == 'unclear').mean():.1%} are unclear")


if __name__ == "__main__":
    main()
