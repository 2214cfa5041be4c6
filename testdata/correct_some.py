#!/usr/bin/env python3
"""Corrects a share of a simulated recording's scans as somebody who knows the truth would, and judges labels of the others.

    correct_some.py DATASET OUT SHARE [--ralf RALF] [--judge LABELS]...

DATASET is a recording with its truth, OUT what `ralf label` made of it: `ralf review` is started on both, and every detection of
the chosen scans is labelled through its page's interface (docs/review-api.md). So many are chosen of each radar, evenly over each
sequence. With --judge nothing is corrected: of each output folder LABELS plausible F1, average precision and accuracy are
printed, over the scans that would not be chosen.

RALF is a build with the feature `review` (ralf in the path, if not given). --judge needs numpy, pandas, pyarrow and scikit-learn.
"""

import argparse
import json
import re
import struct
import subprocess
import sys
import urllib.request
from array import array
from collections import defaultdict
from pathlib import Path

ARTIFACTS = {1, 40, 44, 48, 49, 60}
PLAUSIBLE = 99


def truth_of(dataset, sequence, radar, scan):
    """SemanticKITTI ids of a scan's detections, 0 where unknown; none where there is no file."""
    file = Path(dataset) / "sequences" / sequence / "ground_truth" / radar / f"{scan:06}.label"
    return [label & 0xFFFF for label in array("I", file.read_bytes())] if file.exists() else []


def chosen(scans, share):
    """Every so many of a radar's scans."""
    step = max(round(1 / share), 1)
    return range(step // 2, scans, step)


class Review:
    """A running `ralf review`."""

    def __init__(self, options):
        command = [options.ralf, "review", options.dataset, options.out, "--port", "0"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in self.process.stdout:
            if found := re.search(r"(http://[^/]+)/\?token=(\w+)", line):
                self.address, self.token = found.groups()
                return
        sys.exit(f"{' '.join(command)} ended without an address")

    def ask(self, path, body=None):
        request = urllib.request.Request(self.address + path, data=body and json.dumps(body).encode())
        request.add_header("Authorization", f"Bearer {self.token}")
        request.add_header("Content-Type", "application/json")
        with urllib.request.urlopen(request) as answer:
            return answer.read()

    def header(self, sequence, radar, scan):
        table = self.ask(f"/api/sequences/{sequence}/radars/{radar}/scans/{scan}")
        (size,) = struct.unpack_from("<I", table)
        return json.loads(table[4 : 4 + size])

    def correct(self, sequence, radar, scan, truth, classes):
        points = defaultdict(list)
        for point, label in enumerate(truth):
            if label:
                points[label if label in classes else PLAUSIBLE].append(point)
        for label, of_label in points.items():
            header = self.header(sequence, radar, scan)
            place = {"radar": radar, "scan": scan}
            base = {**place, "revision": header["revision"], "content": header["content"]}
            stroke = {"tool": "lasso", "protect": False, "confirm": True, "label": label, "base": [base]}
            self.ask(f"/api/sequences/{sequence}/strokes", {**stroke, "points": [{**place, "points": of_label}]})
        return sum(map(len, points.values()))


def correct(options):
    review = Review(options)
    try:
        recording = json.loads(review.ask("/api/recording"))
        classes = {entry["id"] for entry in recording["classes"]}
        scans = detections = 0
        for sequence in recording["sequences"]:
            for radar in sequence["radars"]:
                for scan in chosen(len(radar["scans"]), options.share):
                    place = sequence["name"], radar["name"], scan
                    detections += review.correct(*place, truth_of(options.dataset, *place), classes)
                    scans += 1
        print(f"{detections} detections of {scans} scans are corrected or confirmed")
    finally:
        review.process.terminate()


def judge(options):
    import numpy
    import pyarrow.parquet
    from sklearn.metrics import average_precision_score

    for out in options.judge:
        scores, labels, truths = [], [], []
        for file in sorted(Path(out).glob("sequences/*/plausibility.parquet")):
            table = pyarrow.parquet.read_table(file, columns=["radar", "scan", "w", "label"]).to_pandas()
            for radar, rows in table.groupby("radar", observed=True):
                left_out = set(chosen(rows["scan"].max() + 1, options.share))
                for scan, of_scan in rows.groupby("scan"):
                    truth = numpy.array(truth_of(options.dataset, file.parent.name, radar, scan))
                    if scan not in left_out and len(truth):
                        known = truth > 0
                        scores.append(of_scan["w"].to_numpy()[known])
                        labels.append(of_scan["label"].to_numpy()[known] > 0)
                        truths.append(~numpy.isin(truth[known], list(ARTIFACTS)))
        score, label, truth = map(numpy.concatenate, (scores, labels, truths))
        f1 = 2 * (label & truth).sum() / (label.sum() + truth.sum())
        precision = average_precision_score(truth, score)
        print(f"{out}: F1 {f1:.3f}, average precision {precision:.3f}, accuracy {(label == truth).mean():.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset")
    parser.add_argument("out")
    parser.add_argument("share", type=float)
    parser.add_argument("--ralf", default="ralf")
    parser.add_argument("--judge", action="append", metavar="LABELS")
    options = parser.parse_args()
    judge(options) if options.judge else correct(options)


if __name__ == "__main__":
    main()
