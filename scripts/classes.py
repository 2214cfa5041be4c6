#!/usr/bin/env python3
"""How often a recording's detections have a class, and the right one: what tells it, and where it errs.

    classes.py DATASET OUT [DATASET OUT]...

DATASET has `ground_truth/` with classes, as `ralf simulate` writes it, and OUT is what `ralf label DATASET -o OUT`
wrote. Counted are the detections that are plausible by label and by truth. Needs numpy and pyarrow.
"""

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

ARTIFACTS = 0, 1, 40, 44, 48, 49, 60  # SemanticKITTI ids of what is unlabelled or no plausible class


def rows(dataset, file):
    """Of each detection: whether it is labelled plausible, its class (0 without), what tells it, its true class."""
    table = pq.read_table(file)
    radars, scans = table["radar"].to_numpy(zero_copy_only=False), table["scan"].to_numpy()
    truth = np.zeros(len(table), int)
    for radar, scan in sorted(set(zip(radars, scans))):
        labels = dataset / "sequences" / file.parent.name / "ground_truth" / radar / f"{scan:06}.label"
        truth[(radars == radar) & (scans == scan)] = np.fromfile(labels, "<u4") & 0xFFFF
    told = table["class_from"].to_pylist() if "class_from" in table.column_names else ["lidar"] * len(table)
    return zip(table["label"].to_pylist(), table["semantic"].fill_null(0).to_pylist(), told, truth.tolist())


def counted(dataset, out):
    """Plausible detections, and of those with a class how many each source told right and wrong; pairs that differ."""
    total, found, differ = 0, Counter(), Counter()
    for file in sorted(Path(out).glob("sequences/*/plausibility.parquet")):
        for label, given, told, true in rows(Path(dataset), file):
            if label == 0 or true in ARTIFACTS:
                continue
            total += 1
            if given:
                found[told, given == true] += 1
                differ[true, given] += given != true
    return total, found, differ


def main():
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    print("| recording | plausible | told by | have a class | right | most often taken for another |")
    print("| --- " * 6 + "|")
    for dataset, out in zip(sys.argv[1::2], sys.argv[2::2]):
        total, found, differ = counted(dataset, out)
        if total == 0:
            sys.exit(f"{out}: no plausible detections whose true class {dataset} knows")
        wrong = ", ".join(f"{true} for {given}" for (true, given), count in differ.most_common(3) if count)
        for told in sorted({told for told, _ in found}):
            right, of = found[told, True], found[told, True] + found[told, False]
            print(f"| {Path(dataset).name} | {total} | {told} | {of / total:.3f} | {right / of:.3f} | {wrong} |")


if __name__ == "__main__":
    main()
