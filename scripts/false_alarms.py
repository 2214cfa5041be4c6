#!/usr/bin/env python3
"""How many false alarms a radar has, at most: of real recordings and of simulated ones.

    false_alarms.py OUT [OUT]...

OUT is what `ralf label RECORDING -o OUT --evidence` wrote. Noise has any range rate, lies anywhere, rises little above
the floor and comes only once. So these are counted: detections that move (3 sigma of `doppler_residual` or more),
farther than 3 sigma from every point of the nearest LiDAR scan (`lidar_chi`; all where there is none), less than 8 dB
above the radar's floor (`amplitude_over_floor`), which at most one in ten of the radar's own scans around shows again
(`persistence_moving`; all where there are none). Beside them stands the share of all detections that move. Needs numpy
and pyarrow.
"""

import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

NAMES = "doppler_residual", "lidar_chi", "amplitude_over_floor", "persistence_moving"
MOVES = 3.0  # sigma
FAR = 3.0  # sigma
WEAK = 8.0  # dB
ONCE = 0.1


def counted(out):
    """Scans, detections, those that move, and false alarms at most."""
    sums = np.zeros(4)
    for file in sorted(Path(out).glob("sequences/*/plausibility.parquet")):
        table = pq.read_table(file)
        scans = set(zip(table["radar"].to_pylist(), table["scan"].to_pylist()))
        columns = (table[name].to_numpy(zero_copy_only=False) for name in NAMES)
        residual, chi, floor, again = (column.astype(float) for column in columns)
        moves = residual > MOVES
        alarms = moves & ~(chi <= FAR) & (floor < WEAK) & ~(again > ONCE)
        sums += len(scans), len(table), moves.sum(), alarms.sum()
    return sums


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    print("| recording | detections a scan | moving | false alarms a scan, at most | share of all |")
    print("| --- " * 5 + "|")
    for out in sys.argv[1:]:
        scans, all_of_them, moves, alarms = counted(out)
        if all_of_them == 0:
            sys.exit(f"{out}: no sequences/*/plausibility.parquet with detections")
        row = f"{all_of_them / scans:.0f} | {moves / all_of_them:.2f} | {alarms / scans:.1f}"
        print(f"| {Path(out).name} | {row} | {alarms / all_of_them:.3f} |")


if __name__ == "__main__":
    main()
