#!/usr/bin/env python3
"""Which weights carry over from some families of worlds to others (docs/method.md, section 12).

    tune_families.py DATASET OUT [--trials N] [--lidar-alone FROM TO] [--hold lidar ...]
                      [--try alpha=A,threshold=W,...]

DATASET is a simulated dataset whose sequences are named FAMILY_..., OUT what `ralf label DATASET -o OUT` wrote. The
mismatches d don't depend on alpha, the betas and w0, so that the fusion alone is done again for each trial. Every
family counts the same, however many detections it has. Each family in turn is left out: settings are found on the
others and judged on it, beside what the settings of the run reach there, and what these reach with the threshold that
suits that family best.

--lidar-alone refuses settings with which a detection of which the LiDAR alone speaks is plausible up to fewer than
FROM or more than TO standard deviations: ln(1 / w0) / beta_lm. Real mountings, clocks and elevations are less exact
than simulated ones, and the annotated frame of View-of-Delft says what they need (testdata/vod_boxes.py). --hold
keeps a beta as the run had it. --try judges these settings, too.

Needs numpy and pyarrow.
"""

import argparse
import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

FLOOR = 1
BLIND_SPOT = 2
COLUMNS = ["radar", "scan", "d_lm", "d_cm", "d_tr", "w_opt", "w_tr", "w", "flags"]
BETAS = ("lidar", "camera", "tracking")
GRID = np.linspace(0.0, 1.0, 401)
START = {"alpha": 0.5, "threshold": 0.5, "lidar": 0.2, "camera": 0.2, "tracking": 0.2}


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
        flags = rows["flags"].astype(int)
        columns = {name: rows[name] for name in ("d_lm", "d_cm", "d_tr")}
        columns |= {"gamma": gamma, "floor": (flags & FLOOR) > 0, "blind": (flags & BLIND_SPOT) > 0}
        for name, values in columns.items():
            self.parts[name].append(values[known])
        self.parts["truth"].append(truth[known] != 1)

    def ready(self):
        self.columns = {name: np.concatenate(parts) for name, parts in self.parts.items()}
        return self

    def plausibility(self, settings):
        c = self.columns
        w_lm, w_cm = (np.exp(-settings[key] * c[d]) for key, d in (("lidar", "d_lm"), ("camera", "d_cm")))
        first, second = np.where(c["blind"], w_cm, w_lm), np.where(c["blind"], w_lm, w_cm)
        w_opt = np.where(c["floor"], 0.0, np.where(np.isnan(first), second, first))
        w_tr = np.exp(-settings["tracking"] * c["d_tr"])
        both = settings["alpha"] * w_opt + (1 - settings["alpha"]) * w_tr
        w = np.where(np.isnan(w_opt), w_tr, np.where(np.isnan(w_tr), w_opt, both))
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
        "camera": method["camera"]["beta"],
        "tracking": method["tracking"]["beta"],
    }


def read(dataset, out, settings):
    families = defaultdict(Family)
    for folder in sorted((out / "sequences").iterdir()):
        table = pq.read_table(folder / "plausibility.parquet", columns=COLUMNS)
        rows = {name: table[name].to_numpy(zero_copy_only=False) for name in COLUMNS}
        truth = np.zeros(len(table), dtype=int)
        other_scan, other_radar = (rows[name][1:] != rows[name][:-1] for name in ("scan", "radar"))
        starts = np.flatnonzero(np.r_[True, other_scan | other_radar])
        for start, end in zip(starts, np.r_[starts[1:], len(table)]):
            name = f"{rows['radar'][start]}/{rows['scan'][start]:06}.label"
            labels = np.fromfile(dataset / "sequences" / folder.name / "ground_truth" / name, dtype="<u4")
            truth[start:end] = labels & 0xFFFF
        families[folder.name.split("_")[0]].add(rows, truth, settings)
    return {name: family.ready() for name, family in families.items()}


def search(families, base, trials, alone, held, seed=0):
    """The settings of the best mean F1 over the families: alpha and the betas at random, then about the best so far."""
    rng = np.random.default_rng(seed)
    best, best_score = None, -1.0
    for trial in range(trials):
        near = trial > trials // 2
        settings = dict(base)
        settings["alpha"] = float(np.clip(rng.normal(best["alpha"], 0.08), 0, 1) if near else rng.uniform(0, 1))
        for key in BETAS:
            if key in held:
                continue
            settings[key] = float(10 ** (rng.normal(np.log10(best[key]), 0.15) if near else rng.uniform(-2, 1)))
        curve = np.mean([family.curve(settings) for family in families], axis=0)
        if alone:
            from_w0, to_w0 = (np.exp(-settings["lidar"] * d) for d in (alone[1], alone[0]))
            curve = np.where((GRID >= from_w0) & (GRID <= to_w0), curve, -1.0)
        place = int(curve.argmax())
        if curve[place] > best_score:
            settings["threshold"] = float(GRID[place])
            best, best_score = settings, float(curve[place])
    return best


def told(settings):
    return ", ".join(f"{key} {value:.3f}" for key, value in settings.items())


def given(text, base):
    """Settings as --try names them; what it doesn't name stays as the run had it."""
    changes = {key: float(value) for key, value in (pair.split("=") for pair in text.split(","))}
    if unknown := changes.keys() - base.keys():
        raise SystemExit(f"--try: expected {', '.join(base)}, found {', '.join(unknown)}")
    return base | changes


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--trials", type=int, default=300)
    parser.add_argument("--lidar-alone", type=float, nargs=2, metavar=("FROM", "TO"))
    parser.add_argument("--hold", nargs="*", default=[], choices=BETAS)
    parser.add_argument("--try", dest="tried", metavar="KEY=VALUE,...")
    return parser.parse_args()


def main():
    chosen = arguments()
    run = run_settings(chosen.out)
    families = read(chosen.dataset, chosen.out, run)
    find = lambda some: search(some, run, chosen.trials, chosen.lidar_alone, chosen.hold)
    everywhere = find(list(families.values()))
    print(f"the run: {told(run)}\nfound on all families: {told(everywhere)}\n")
    columns = {"start": START, "the run": run, "found on all": everywhere}
    if chosen.tried:
        columns["tried"] = given(chosen.tried, run)
    heads = [part for name in [*columns, "found on the others"] for part in (name, "with its best w0")]
    print("| family | detections | plausible | " + " | ".join(heads) + " |\n| --- |" + " --- |" * (len(heads) + 2))
    rows = []
    for name, family in families.items():
        others = find([other for key, other in families.items() if key != name])
        judged = [*columns.values(), others]
        rows.append([value for settings in judged for value in (family.f1(settings), family.curve(settings).max())])
        truth = family.columns["truth"]
        cells = " | ".join(f"{value:.3f}" for value in rows[-1])
        print(f"| {name} | {len(truth)} | {truth.mean():.3f} | {cells} |")
        print(f"  without {name}: {told(others)}", file=sys.stderr)
    print("| mean | | | " + " | ".join(f"{value:.3f}" for value in np.mean(rows, axis=0)) + " |")


if __name__ == "__main__":
    main()
