#!/usr/bin/env python3
"""How much of what radars tell lies far from every LiDAR point, by range: of real recordings and of simulated ones.

    far_from_lidar.py DATASET OUT [DATASET OUT]... [--every N]

DATASET has the project's own layout (`ralf convert`, `ralf simulate`), OUT is what `ralf label DATASET -o OUT
--evidence` wrote. Far is more than 2.5 m from every point of the LiDAR scans nearest in time; of a radar without
elevation in plan, from every point 0.2 to 2.5 m above the ground below the vehicle. Beside the share of the far ones
stand, of these: how many are plausible (where there is truth), how many move (3 sigma of `doppler_residual` or more),
and how often the radar sees them again (`persistence_own`). The vehicle's way between both scans is taken for
straight. --every N looks at each N-th scan.

Needs numpy, pyarrow and scipy.
"""

import argparse
import sys
import tomllib
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parent.parent / "testdata"))
from aimotive_boxes import rotation  # noqa: E402
from judge_families import ARTIFACTS  # noqa: E402

FAR = 2.5  # m
TOLERANCE = 60e6  # ns, between a radar scan and a LiDAR scan
HEIGHTS = 0.2, 2.5  # m, of points that a radar without elevation is compared with
MOVES = 3.0  # sigma
HEADS = [
    *("recording", "range, m", "detections", "share", "far"),
    *("of these: plausible", "moving", "seen again", "near ones: plausible"),
]
EDGES = 0, 20, 40, 60, 80, 100, 140, 300  # m


class Recording:
    """A sequence: its LiDARs, and how fast the vehicle goes."""

    def __init__(self, folder):
        self.folder = folder
        self.toml = tomllib.loads((folder / "sequence.toml").read_text())
        files = [folder / lidar["name"] / "timestamps.txt" for lidar in self.toml["lidar"]]
        self.times = [np.loadtxt(file, dtype=np.int64, ndmin=1) for file in files]
        self.speeds = self.read_speeds()
        self.flat = {radar["name"] for radar in self.toml["radar"] if radar["elevation"] == "none"}
        self.last = {}

    def read_speeds(self):
        odometry, poses = (self.rows(name) for name in ("odometry.csv", "poses.csv"))
        if len(odometry):
            return odometry[:, :2]
        if len(poses) < 2:
            return np.zeros((1, 2))
        steps = np.linalg.norm(np.diff(poses[:, 1:4], axis=0), axis=1) / np.diff(poses[:, 0]) * 1e9
        return np.column_stack([poses[1:, 0], steps])

    def rows(self, name):
        file = self.folder / name
        lines = file.read_text().splitlines()[1:] if file.exists() else []
        return np.array([line.split(",") for line in lines], dtype=float)

    def cloud(self, number, scan):
        """Points of a LiDAR scan in the vehicle's frame; the last one of each LiDAR is kept."""
        if self.last.get(number, (None,))[0] != scan:
            lidar = self.toml["lidar"][number]
            points = np.fromfile(self.folder / lidar["name"] / f"{scan:06}.bin", "<f4").reshape(-1, 4)[:, :3]
            points = points[np.isfinite(points).all(axis=1)].astype(float)
            self.last[number] = scan, points @ rotation(lidar["quaternion_xyzw"]).T + lidar["translation"]
        return self.last[number][1]

    def points_at(self, t_ns):
        """Of all LiDARs, where they are at a radar scan's time."""
        speed = np.interp(t_ns, self.speeds[:, 0], self.speeds[:, 1])
        found = []
        for number, times in enumerate(self.times):
            scan = int(np.abs(times - t_ns).argmin())
            late = t_ns - times[scan]
            if abs(late) <= TOLERANCE:
                found.append(self.cloud(number, scan) - [speed * late * 1e-9, 0.0, 0.0])
        return np.concatenate(found) if found else np.empty((0, 3))

    def distances(self, radar, t_ns, places):
        points = self.points_at(t_ns)
        axes = 3
        if radar in self.flat:
            axes, points = 2, points[(points[:, 2] > HEIGHTS[0]) & (points[:, 2] < HEIGHTS[1])]
        return cKDTree(points[:, :axes]).query(places[:, :axes])[0] if len(points) else None

    def truth(self, radar, scan, count):
        file = self.folder / "ground_truth" / radar / f"{scan:06}.label"
        if not file.exists():
            return np.full(count, np.nan)
        return ~np.isin(np.fromfile(file, "<u4") & 0xFFFF, ARTIFACTS)


def measured(dataset, out, every):
    """Rows of range, distance to the LiDAR, truth, motion, persistence."""
    found = []
    for file in sorted(Path(out).glob("sequences/*/plausibility.parquet")):
        table = pq.read_table(file)
        recording = Recording(Path(dataset) / "sequences" / file.parent.name)
        column = {name: table[name].to_numpy(zero_copy_only=False) for name in table.column_names}
        other = [column[name][1:] != column[name][:-1] for name in ("radar", "scan")]
        begins = np.flatnonzero(np.r_[True, other[0] | other[1]])
        for begin, end in list(zip(begins, np.r_[begins[1:], len(table)]))[::every]:
            places = np.column_stack([column[axis][begin:end] for axis in "xyz"])
            distances = recording.distances(column["radar"][begin], column["t_ns"][begin], places)
            if distances is not None:
                truth = recording.truth(column["radar"][begin], column["scan"][begin], end - begin)
                moves = np.abs(column["doppler_residual"][begin:end]) > MOVES
                reach, again = (column[name][begin:end] for name in ("range", "persistence_own"))
                found.append(np.column_stack([reach, distances, truth, moves, again]).astype(float))
    return np.concatenate(found)


def mean(values):
    values = values[~np.isnan(values)]
    return f"{values.mean():.2f}" if len(values) else "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pairs", nargs="+", metavar="DATASET OUT")
    parser.add_argument("--every", type=int, default=1)
    options = parser.parse_args()
    if len(options.pairs) % 2:
        parser.error("pairs of DATASET and OUT expected")
    print("| " + " | ".join(HEADS) + " |\n" + "| --- " * len(HEADS) + "|")
    for dataset, out in zip(options.pairs[::2], options.pairs[1::2]):
        rows = measured(dataset, out, options.every)
        for low, high in [(0, np.inf), *zip(EDGES, EDGES[1:])]:
            here = rows[(rows[:, 0] >= low) & (rows[:, 0] < high)]
            if len(here) < 20:
                continue
            far = here[:, 1] > FAR
            told = [mean(here[far, place]) for place in (2, 3, 4)] + [mean(here[~far, 2])]
            share, of_these = len(here) / len(rows), mean(far.astype(float))
            reach = "all" if high == np.inf else f"{low} to {high}"
            print(f"| {Path(out).name} | {reach} | {len(here)} | {share:.2f} | {of_these} | {' | '.join(told)} |")


if __name__ == "__main__":
    main()
