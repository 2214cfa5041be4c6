#!/usr/bin/env python3
"""What it costs to believe less what only the radar tells of (docs/learned-tried.md), by why nobody else does.

    unconfirmed.py --world FAMILY DATASET OUT [--world FAMILY DATASET OUT]... [options of the learner]

Gradient-boosted trees that never saw a family of worlds label that family, as judge_families.py has it; then the odds of what
is unconfirmed are multiplied by 0.03: of none, of what lies beyond the LiDAR's map, of what lies behind walls, of single scans
where no ray goes within the map, of all three, which is the rule; and, one at a time, of what the rule leaves out: what time
confirms beyond the map, where no ray goes and time was asked, and what lies farther than the LiDAR sees.
Printed are means over the families left out, and of each kind how many there are and how many of them are plausible.

Needs what judge_families.py needs.
"""

import numpy
from judge_families import groups_of_features, judge, out_of_fold, parser_of, read_worlds

FACTOR = 0.03


def kinds_of(features, names):
    """Which rows are believed less, by name: unconfirmed beyond the map, behind walls and where no ray goes, by the rule of
    crates/ralf/src/learned/unconfirmed.rs, whose comparisons are false where something is absent, too; and what would be if
    time confirmed nothing, if it asked about all places within the map where no ray goes, and if it asked no LiDAR how far it
    sees."""
    value = lambda name: features[:, names.index(name)]
    unseen, away = value("lidar_unseen"), value("map_distance")
    known = ~numpy.isnan(unseen) & ~(value("lidar_moving_near") > 0)
    walled = (value("sight_wall_top") > 2.5) & (value("sight_wall_length") >= 4)
    near_any = (value("lidar_chi") < 3) | (value("lidar_window_chi_least") < 3)
    hidden = known & walled & (unseen + value("lidar_occluded") >= 0.999) & ~near_any
    silent = known & ~(value("lidar_distance") < 2.5)
    reached = value("lidar_reach") <= 1
    asked = ~numpy.isnan(value("persistence_moving"))
    again = (value("persistence_moving") >= 0.5) & ~numpy.isnan(value("persistence_aspect"))
    beyond = silent & numpy.isnan(away)
    no_ray = silent & reached & (unseen >= 0.999) & (away >= 2.5)
    unheard, walled, once = beyond & reached & ~again, hidden & ~beyond, no_ray & ~asked & ~hidden
    return {
        "nothing": numpy.zeros(len(features), bool), "behind walls": walled, "beyond the map": unheard,
        "where no ray goes in a single scan": once, "all three": unheard | walled | once,
        "only what time confirms": beyond & reached & again,
        "only where no ray goes and time was asked": no_ray & asked & ~hidden,
        "only what no LiDAR sees as far": beyond & ~reached & ~again,
    }


def weighed(scores, unconfirmed):
    odds = numpy.clip(scores, 1e-5, 1 - 1e-5)
    odds = odds / (1 - odds) * numpy.where(unconfirmed, FACTOR, 1)
    return odds / (1 + odds)


def main():
    options, names = parser_of(__doc__).parse_args(), list(groups_of_features())
    worlds = read_worlds(options, names)
    scores = out_of_fold(worlds.features, worlds, options)
    print("| believed less | of all | plausible of it | F1 | AP | accuracy | ECE |")
    print("| --- " * 7 + "|")
    for name, kind in kinds_of(worlds.features, names).items():
        told = " | ".join(f"{value:.3f}" for value in judge(weighed(scores, kind), worlds).mean(0))
        plausible = f"{(worlds.truth[kind] == 1).mean():.1%}" if kind.any() else ""
        print(f"| {name} | {kind.mean():.1%} | {plausible} | {told} |", flush=True)


if __name__ == "__main__":
    main()
