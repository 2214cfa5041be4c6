#!/usr/bin/env python3
"""Judges evidence from outside: gradient-boosted trees (LightGBM) that never saw a family of worlds label that family.

    judge_families.py --world FAMILY DATASET OUT [--world FAMILY DATASET OUT]... [--rounds N] [--leaves N] [--rate R]
                      [--rows N] [--of-world N] [--seed S] [--no-groups]

DATASET is a recording with its truth (`ralf simulate --preset worlds --family FAMILY --seed S -o DATASET`), OUT what
`ralf label DATASET -o OUT --evidence` made of it. Worlds of one FAMILY are left out together. Printed are, for each family
left out and on average: plausible F1 (at the threshold that is best on the families trained on, in turn left out), average
precision, accuracy and calibration error (isotonic, fitted there, too): from all evidence, from the paper's columns alone,
by the paper's method itself; and what is lost where one group of evidence is missing. Groups are those of docs/evidence.md.

A FAMILY like survey+yard+motorway is a mixture, as `ralf simulate --family` makes them: it is learned from where none of its
parts is left out, and never judged.

Needs lightgbm, numpy, pyarrow and scikit-learn.
"""

import argparse
import re
import sys
from pathlib import Path
from typing import NamedTuple

import lightgbm
import numpy
import pyarrow.parquet
from sklearn.isotonic import IsotonicRegression
from sklearn.metrics import average_precision_score

# As the experiments had it that the project's learner starts from.
PARAMETERS = dict(
    objective="binary", feature_fraction=0.5, bagging_fraction=0.7, bagging_freq=1,
    lambda_l2=5.0, min_data_in_leaf=150, max_bin=63, deterministic=True, force_row_wise=True, verbose=-1,
)
# What the paper's method says, as columns of every result.
PAPER = ["d_lm", "d_cm", "d_tr", "w_lm", "w_cm", "w_tr", "w_opt", "w"]
# SemanticKITTI ids that are artifacts: outlier, road, parking, sidewalk, other-ground, lane-marking.
ARTIFACTS = [1, 40, 44, 48, 49, 60]
CELLS = 15
# The number of every mixture, which is no family.
MIXTURE = -1


def groups_of_features():
    """Group of each column, by the table of docs/evidence.md."""
    text = (Path(__file__).parent.parent / "docs/evidence.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| [^|]* \| ([^|]+) \|", text, re.MULTILINE)
    return {name: group.strip() for name, group in rows}


def read_world(dataset, out, names):
    """Features (absent: NaN), the paper's columns, labels of the paper's method and truth, of all its sequences."""
    parts = []
    for file in sorted(Path(out).glob("sequences/*/plausibility.parquet")):
        table = pyarrow.parquet.read_table(file)
        missing = [name for name in names if name not in table.column_names]
        if missing:
            sys.exit(f"{file}: no column {', '.join(missing)}: label with --evidence")
        truth_folder = Path(dataset) / "sequences" / file.parent.name / "ground_truth"
        radar, scan = table["radar"].to_numpy(zero_copy_only=False), table["scan"].to_numpy()
        truth = numpy.full(len(table), -1)
        begins = numpy.flatnonzero(numpy.r_[True, (radar[1:] != radar[:-1]) | (scan[1:] != scan[:-1])])
        for begin, end in zip(begins, numpy.r_[begins[1:], len(table)]):
            labels = truth_folder / radar[begin] / f"{scan[begin]:06}.label"
            if labels.exists():
                ids = numpy.fromfile(labels, "<u4") & 0xFFFF
                assert len(ids) == end - begin, f"{labels}: {len(ids)} labels for {end - begin} detections"
                truth[begin:end] = numpy.where(ids == 0, -1, ~numpy.isin(ids, ARTIFACTS))
        column = lambda name: table[name].to_numpy(zero_copy_only=False).astype("f4")
        known = truth >= 0
        features = numpy.column_stack([column(name) for name in names])[known]
        paper = numpy.column_stack([column(name) for name in PAPER])[known]
        parts.append((features, paper, table["label"].to_numpy()[known], truth[known]))
    if not parts:
        sys.exit(f"{out}: no sequences/*/plausibility.parquet")
    return [numpy.concatenate(part) for part in zip(*parts)]


def some_of(world, most, seed):
    """A draw of a world's rows, in their order; all where there are no more."""
    rows = len(world[0])
    if most is None or rows <= most:
        return world
    drawn = numpy.sort(numpy.random.default_rng(seed).choice(rows, most, replace=False))
    return [column[drawn] for column in world]


def parameters(options):
    return dict(PARAMETERS, num_leaves=options.leaves, learning_rate=options.rate, seed=options.seed)


def best_threshold(scores, truth):
    order = numpy.argsort(-scores, kind="stable")
    found = numpy.cumsum(truth[order])
    f1 = 2 * found / (numpy.arange(1, len(truth) + 1) + truth.sum())
    return scores[order][numpy.argmax(f1)]


def f1_of(labels, truth):
    return 2 * (labels & truth).sum() / max(labels.sum() + truth.sum(), 1)


def calibration_error(p, truth):
    cell = numpy.minimum((p * CELLS).astype(int), CELLS - 1)
    return sum(abs((p - truth)[cell == i].sum()) for i in range(CELLS)) / len(truth)


class Worlds(NamedTuple):
    """The rows of all worlds, one world after the other."""
    families: list
    features: numpy.ndarray
    paper: numpy.ndarray
    labels: numpy.ndarray
    truth: numpy.ndarray
    # Of each row the place of its family, or MIXTURE, and which families its world has parts of.
    family: numpy.ndarray
    holds: numpy.ndarray


def read_worlds(options, names):
    """The worlds that the command names. Each is let go as soon as its rows are copied, so that none is held twice."""
    worlds = [[name, *some_of(read_world(dataset, out, names), options.of_world, options.seed)]
              for name, dataset, out in options.world]
    families = sorted({world[0] for world in worlds if "+" not in world[0]})
    if len(families) < 2:
        sys.exit("two families or more, so that one can be left out")
    lengths, parts = [len(world[4]) for world in worlds], [world[0].split("+") for world in worlds]
    number = lambda part: families.index(part[0]) if len(part) == 1 else MIXTURE
    features, paper, labels, truth = (together(worlds, column) for column in range(1, 5))
    return Worlds(
        families, features, paper, labels, truth,
        family=numpy.repeat([number(part) for part in parts], lengths),
        holds=numpy.repeat([[name in part for name in families] for part in parts], lengths, axis=0),
    )


def together(worlds, column):
    """A column of all worlds, which is taken from them."""
    rows, first = sum(len(world[column]) for world in worlds), worlds[0][column]
    joined, end = numpy.empty((rows, *first.shape[1:]), first.dtype), 0
    for world in worlds:
        begin, end = end, end + len(world[column])
        joined[begin:end], world[column] = world[column], world[column][:0].copy()
    return joined


def out_of_fold(features, worlds, options):
    """Scores of every row by trees that never saw its family; none of a mixture's."""
    scores = numpy.full(len(worlds.truth), numpy.nan)
    for left_out in range(len(worlds.families)):
        train = numpy.flatnonzero(~worlds.holds[:, left_out])
        if len(train) > options.rows:
            train = numpy.sort(numpy.random.default_rng(options.seed).choice(train, options.rows, replace=False))
        data = lightgbm.Dataset(features[train], worlds.truth[train])
        model = lightgbm.train(parameters(options), data, options.rounds)
        here = worlds.family == left_out
        scores[here] = model.predict(features[here])
    return scores


def judge(scores, worlds):
    """F1, average precision, accuracy and calibration error of each family, by what the others say."""
    truth, family, rows = worlds.truth, worlds.family, []
    for left_out in range(len(worlds.families)):
        here, others = family == left_out, (family != left_out) & (family != MIXTURE)
        line = IsotonicRegression(out_of_bounds="clip").fit(scores[others], truth[others])
        p, labels = line.predict(scores[here]), scores[here] >= best_threshold(scores[others], truth[others])
        right = (labels == (truth[here] == 1)).mean()
        precision = average_precision_score(truth[here], scores[here])
        rows.append([f1_of(labels, truth[here] == 1), precision, right, calibration_error(p, truth[here])])
    return numpy.array(rows)


def print_families(worlds, every, of_paper):
    """`every` is what judge() says of all evidence, `of_paper` what it says of the paper's columns."""
    print("| family left out | detections | plausible | F1 | AP | accuracy | ECE | paper's columns: F1 | AP | paper's method: F1 | AP |")
    print("| --- " * 11 + "|")
    lines = []
    for number, name in enumerate(worlds.families):
        here = worlds.family == number
        labels, truth, w = worlds.labels[here] == 1, worlds.truth[here], worlds.paper[here, -1]
        method = [f1_of(labels, truth == 1), average_precision_score(truth, w)]
        lines.append([*every[number], *of_paper[number, :2], *method])
        told = " | ".join(f"{value:.3f}" for value in lines[-1])
        print(f"| {name} | {here.sum()} | {truth.mean():.1%} | {told} |")
    print(f"| mean | | | {' | '.join(f'{value:.3f}' for value in numpy.mean(lines, axis=0))} |", flush=True)


def print_groups(worlds, groups, every, options):
    """`groups` tells the group of each column of the features, `every` is what judge() says of all of them."""
    print("\n| group left out | columns | F1 | change | AP | change |\n| --- | --- | --- | --- | --- | --- |")
    of_column = numpy.array(list(groups.values()))
    for group in dict.fromkeys(groups.values()):
        kept = of_column != group
        if not kept.any():
            continue
        rows = judge(out_of_fold(worlds.features[:, kept], worlds, options), worlds)
        (f1, precision), change = rows[:, :2].mean(0), (rows - every)[:, :2].mean(0)
        told = f"{f1:.3f} | {change[0]:+.3f} | {precision:.3f} | {change[1]:+.3f}"
        print(f"| {group} | {(~kept).sum()} | {told} |", flush=True)


def parser_of(description):
    """Understands which worlds there are, and how a learner learns from them."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--world", nargs=3, action="append", required=True, metavar=("FAMILY", "DATASET", "OUT"))
    parser.add_argument("--rounds", type=int, default=220, help="trees")
    parser.add_argument("--leaves", type=int, default=31, help="most leaves of a tree")
    parser.add_argument("--rate", type=float, default=0.1, help="how much of each tree counts")
    parser.add_argument("--rows", type=int, default=200_000, help="most rows that a model is trained on")
    parser.add_argument("--of-world", type=int, metavar="N", help="most rows of each world, to learn from and to judge")
    parser.add_argument("--seed", type=int, default=0)
    return parser


def read_options():
    parser = parser_of(__doc__)
    parser.add_argument("--no-groups", action="store_true", help="leave out the table of groups")
    return parser.parse_args()


def main():
    options, groups = read_options(), groups_of_features()
    worlds = read_worlds(options, list(groups))
    every = judge(out_of_fold(worlds.features, worlds, options), worlds)
    of_paper = judge(out_of_fold(worlds.paper, worlds, options), worlds)
    rows, share = len(worlds.truth), worlds.truth.mean()
    print(f"{rows} detections, {share:.1%} plausible, {len(groups)} columns of evidence, seed {options.seed}\n")
    print_families(worlds, every, of_paper)
    if not options.no_groups:
        print_groups(worlds, groups, every, options)


if __name__ == "__main__":
    main()
