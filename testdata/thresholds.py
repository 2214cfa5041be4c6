#!/usr/bin/env python3
"""How far one threshold for all is behind each family's own best one.

    thresholds.py --world FAMILY DATASET OUT [--world FAMILY DATASET OUT]... [--threshold W]...

DATASET is a recording with its truth (`ralf simulate --preset worlds --family FAMILY --seed S -o DATASET`), OUT what
`ralf label DATASET -o OUT` made of it. Plausible F1 is that of a threshold on `w`, a mean over the worlds of a FAMILY. Printed
are each family's best threshold, its F1, and how far F1 at the thresholds asked for (0.4 where none is) is behind that.

Needs what judge_families.py needs.
"""

import argparse

import numpy

import judge_families

TRIED = numpy.arange(0.02, 0.99, 0.02)


def f1_by_threshold(dataset, out, thresholds):
    """F1 of a world at each threshold."""
    features, _, _, truth, *_ = judge_families.read_world(dataset, out, ["w"])
    return [judge_families.f1_of(features[:, 0] >= threshold, truth == 1) for threshold in thresholds]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--world", nargs=3, action="append", required=True, metavar=("FAMILY", "DATASET", "OUT"))
    parser.add_argument("--threshold", type=float, action="append", metavar="W")
    options = parser.parse_args()
    asked = options.threshold or [0.4]
    thresholds = numpy.r_[asked, TRIED]
    worlds = {}
    for family, dataset, out in options.world:
        worlds.setdefault(family, []).append(f1_by_threshold(dataset, out, thresholds))
    print(f"| family | worlds | best | F1 | {' | '.join(f'behind at {threshold:g}' for threshold in asked)} |")
    print("| --- " * (4 + len(asked)) + "|")
    behind = []
    for family, rows in sorted(worlds.items()):
        f1 = numpy.mean(rows, axis=0)
        behind.append(f1.max() - f1[: len(asked)])
        told = " | ".join(f"{value:.3f}" for value in [f1.max(), *behind[-1]])
        print(f"| {family} | {len(rows)} | {thresholds[f1.argmax()]:.2f} | {told} |")
    print(f"| mean | | | | {' | '.join(f'{value:.3f}' for value in numpy.mean(behind, axis=0))} |")


if __name__ == "__main__":
    main()
