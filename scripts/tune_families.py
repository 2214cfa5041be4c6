#!/usr/bin/env python3
"""Which weights carry over from some families of worlds to others (docs/method.md, section 12).

    tune_families.py DATASET OUT [--trials N] [--d-floor D]

DATASET is a simulated dataset whose sequences are named FAMILY_..., OUT what `ralf label DATASET -o OUT` wrote. The mismatches
d_lm and d_tr don't depend on alpha, the betas and w0, so that the fusion alone is done again for each trial. Every family counts
the same, however many detections it has. Each family in turn is left out: settings are found on the others and judged on it,
beside what the settings of the run reach there, and what these reach with the threshold that suits that family best.

--d-floor holds lidar.beta at its value and refuses settings with which a detection that the LiDAR alone speaks of is plausible up
to less than D standard deviations: real mountings, clocks and elevations are less exact than simulated ones.

Needs numpy and pyarrow.
"""

import argparse
import json
from collections import defaultdict
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

FLOOR = 1
COLUMNS = ["radar", "scan", "d_lm", "d_tr", "w_opt", "w_tr", "w", "flags"]
GRID = np.linspace(0.0, 1.0, 401)
START = {"alpha": 0.5, "threshold": 0.5, "lidar": 0.2, "tracking": 0.2}


class Family:
    """The detections with truth of all sequences of a family."""

    def __init__(self):
        self.parts = defaultdict(list)

    def add(self, rows, truth, settings):
        known = truth != 0
        alpha = settings["alpha"]
        w_opt, w_tr, w = (rows[name] for name in ("w_opt", "w_tr", "w"))
        both = alpha * w_opt + (1 - alpha) * w_tr
        fused = np.where(np.isnan(w_opt), w_tr, np.where(np.isnan(w_tr), w_opt, both))
        with np.errstate(invalid="ignore", divide="ignore"):
            gamma = np.where(w > 0, fused / w, 1.0)
        on_floor = (rows["flags"].astype(int) & FLOOR) > 0
        for name, values in [("d_lm", rows["d_lm"]), ("d_tr", rows["d_tr"]), ("gamma", gamma), ("floor", on_floor)]:
            self.parts[name].append(values[known])
        self.parts["truth"].append(truth[known] != 1)

    def ready(self):
        self.columns = {name: np.concatenate(parts) for name, parts in self.parts.items()}
        return self

    def plausibility(self, settings):
        c = self.columns
        w_lm = np.where(c["floor"], 0.0, np.exp(-settings["lidar"] * c["d_lm"]))
        w_tr = np.exp(-settings["tracking"] * c["d_tr"])
        both = settings["alpha"] * w_lm + (1 - settings["alpha"]) * w_tr
        w = np.where(np.isnan(w_lm), w_tr, np.where(np.isnan(w_tr), w_lm, both))
        return np.where(c["floor"] | np.isnan(w), -1.0, w / c["gamma"])

    def curve(self, settings):
        """F1 of plausible detections for every threshold of the grid."""
        w, truth = self.plausibility(settings), self.columns["truth"]
        kept = lambda values: len(values) - np.searchsorted(np.sort(values), GRID, side="left")
        tp, fp = kept(w[truth]), kept(w[~truth])
        return 2 * tp / (tp + fp + truth.sum())

    def f1(self, settings):
        return float(self.curve(settings)[np.abs(GRID - settings["threshold"]).argmin()])


def run_settings(out):
    method = json.loads((out / "run.json").read_text())["settings"]
    return {
        "alpha": method["fusion"]["alpha"],
        "threshold": method["fusion"]["threshold"],
        "lidar": method["lidar"]["beta"],
        "tracking": method["tracking"]["beta"],
    }


def read(dataset, out, settings):
    families = defaultdict(Family)
    for folder in sorted((out / "sequences").iterdir()):
        table = pq.read_table(folder / "plausibility.parquet", columns=COLUMNS)
        rows = {name: table[name].to_numpy(zero_copy_only=False) for name in COLUMNS}
        truth = np.zeros(len(table), dtype=int)
        starts = np.flatnonzero(np.r_[True, (rows["scan"][1:] != rows["scan"][:-1]) | (rows["radar"][1:] != rows["radar"][:-1])])
        for start, end in zip(starts, np.r_[starts[1:], len(table)]):
            name = f"{rows['radar'][start]}/{rows['scan'][start]:06}.label"
            labels = np.fromfile(dataset / "sequences" / folder.name / "ground_truth" / name, dtype="<u4")
            truth[start:end] = labels & 0xFFFF
        families[folder.name.split("_")[0]].add(rows, truth, settings)
    return {name: family.ready() for name, family in families.items()}


def search(families, base, trials, d_floor, seed=0):
    """The settings of the best mean F1 over the families; of alpha and the betas at random, and about the best so far."""
    rng = np.random.default_rng(seed)
    best, best_score = None, -1.0
    for trial in range(trials):
        near = trial > trials // 2
        settings = dict(base)
        settings["alpha"] = float(np.clip(rng.normal(best["alpha"], 0.08), 0, 1) if near else rng.uniform(0, 1))
        for key in ("lidar", "tracking"):
            if key == "lidar" and d_floor:
                continue
            settings[key] = float(10 ** (rng.normal(np.log10(best[key]), 0.15) if near else rng.uniform(-2, 1)))
        curve = np.mean([family.curve(settings) for family in families], axis=0)
        if d_floor:
            curve = np.where(GRID <= np.exp(-settings["lidar"] * d_floor), curve, -1.0)
        place = int(curve.argmax())
        if curve[place] > best_score:
            settings["threshold"] = float(GRID[place])
            best, best_score = settings, float(curve[place])
    return best


def told(settings):
    return ", ".join(f"{key} {value:.3f}" for key, value in settings.items())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--trials", type=int, default=300)
    parser.add_argument("--d-floor", type=float, default=0.0)
    arguments = parser.parse_args()
    now = run_settings(arguments.out)
    families = read(arguments.dataset, arguments.out, now)
    find = lambda chosen: search(chosen, now, arguments.trials, arguments.d_floor)
    everywhere = find(list(families.values()))
    print(f"the run:            {told(now)}")
    print(f"found on all:       {told(everywhere)}\n")
    print("| family | detections | plausible | start | the run | at its best threshold | found on the others | at its best threshold |")
    print("| --- |" + " --- |" * 7)
    sums = []
    for name, family in families.items():
        others = find([other for key, other in families.items() if key != name])
        truth = family.columns["truth"]
        figures = [family.f1(START), family.f1(now), family.curve(now).max(), family.f1(others), family.curve(others).max()]
        sums.append(figures)
        cells = " | ".join(f"{value:.3f}" for value in figures)
        print(f"| {name} | {len(truth)} | {truth.mean():.3f} | {cells} |   {told(others)}")
    print("| mean | | | " + " | ".join(f"{value:.3f}" for value in np.mean(sums, axis=0)) + " |")
    print(f"\nmean F1 with what is found on all: {np.mean([family.f1(everywhere) for family in families.values()]):.3f}")


if __name__ == "__main__":
    main()
