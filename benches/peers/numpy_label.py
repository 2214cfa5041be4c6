#!/usr/bin/env python3
"""Labels a recording with NumPy and pykdtree, says what a scan costs, and how far its labels are from RALF's.

    pip install -r benches/peers/requirements.txt
    ralf simulate -o sim --scans 1000 --sequence 00 --no-images
    python3 benches/peers/numpy_label.py sim --sequence 00 --ralf target/release/ralf --rounds 7

Both label the same files with one thread, in turn: RALF as a process (`label --jobs 1`), from its start to the last
byte on the disk, and the script what it does after its imports, without writing anything. Times are those of the
processor, in the kernel, too.
"""

import argparse
import os
import resource
import subprocess
import tempfile
import time
from collections import defaultdict
from pathlib import Path

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np  # noqa: E402  the number of threads is read once
import pyarrow.parquet as pq  # noqa: E402
from method import Settings, detections, fuse, match_lidar, moment, track  # noqa: E402
from recording import Recording  # noqa: E402


class Stages:
    """Processor seconds by the name of what was done."""

    def __init__(self):
        self.seconds = defaultdict(float)
        self.since = time.process_time()

    def done(self, name):
        now = time.process_time()
        self.seconds[name] += now - self.since
        self.since = now


def label(dataset, sequence, settings):
    """`w` and label of every scan, by (radar, scan), and the seconds of each stage."""
    stages = Stages()
    recording = Recording(dataset, sequence)
    rng = np.random.default_rng(0)
    stages.done("opening")
    moments, result = {}, {}
    for radar in recording.radars:
        table = radar.table
        sigmas = (table["sigma_range_m"], *np.radians([table["sigma_azimuth_deg"], table["sigma_elevation_deg"]]))
        reliability = np.array(table.get("reliability", [[0.0, 1.0]])) * [np.pi / 180, 1.0]
        scans = []
        for scan in range(len(radar.times)):
            xyz = radar.points(scan).astype(float)
            scans.append(detections(xyz, radar.rotation, radar.translation, sigmas, reliability))
        stages.done("radar scans")
        for k, scan in enumerate(scans):
            t = int(radar.times[k])
            away = np.abs(recording.lidar.times - t)
            nearest = int(np.argmin(away))
            d_lm = floor = None
            if away[nearest] <= settings.lidar_tolerance_ns:
                if nearest not in moments:
                    lidar = recording.lidar
                    read = lidar.points(nearest)
                    stages.done("LiDAR: reading")
                    moments[nearest] = moment(
                        read, lidar.rotation, lidar.translation, lidar.table["sigma_range_m"], settings, rng
                    )
                    stages.done("LiDAR: ground, tree")
                d_lm, floor = match_lidar(
                    scan, moments[nearest], recording.between(int(recording.lidar.times[nearest]), t), settings
                )
                stages.done("LiDAR matching")
            around = in_batch(radar.times, k, settings)
            neighbours = [(scans[j], recording.between(int(radar.times[j]), t)) for j in around]
            d_tr = track(scan, neighbours, settings) if neighbours else None
            stages.done("tracking")
            floor = np.zeros(len(scan.xyz), bool) if floor is None else floor
            result[table["name"], k] = fuse(scan, d_lm, floor, d_tr, settings)
            stages.done("fusion")
    return result, stages.seconds


def in_batch(times, k, settings):
    """The neighbouring scans, as far as no gap lies between (section 7.4)."""
    around = []
    for towards in (-1, 1):
        for j in range(k + towards, k + towards * (settings.tracking_scans + 1), towards):
            if not 0 <= j < len(times) or abs(int(times[j]) - int(times[j - towards])) > settings.max_gap_ns:
                break
            around.append(j)
    return around


def ralf_seconds(ralf, dataset, sequence, out):
    """Processor seconds of `ralf label`, user and system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = [ralf, "label", dataset, "--sequence", sequence, "-o", out, "--jobs", "1", "--no-check", "--quiet"]
    subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def compare(result, out, sequence):
    """How far the two are from each other: RANSAC draws other numbers here, all else should be the same."""
    table = pq.read_table(
        Path(out) / "sequences" / sequence / "plausibility.parquet", columns=["radar", "scan", "point", "w", "label"]
    )
    radars, scans, points = (np.array(table[name]) for name in ("radar", "scan", "point"))
    w = np.concatenate(
        [result[radar, scan][0][[point]] for radar, scan, point in zip(radars, scans, points, strict=True)]
    )
    mine = np.concatenate(
        [result[radar, scan][1][[point]] for radar, scan, point in zip(radars, scans, points, strict=True)]
    )
    away = np.abs(w - np.array(table["w"]))
    print(
        f"the same label: {np.mean(mine == np.array(table['label']).astype(bool)):.2%} of {len(w):,} detections;",
        end=" ",
    )
    print(f"|w - w| is below .001 for {np.mean(away < 1e-3):.2%}")


def main():
    """Alternates the two, and prints the medians."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset")
    parser.add_argument("--sequence", default="00")
    parser.add_argument("--ralf", help="the program to compare with; without it the script's own times alone")
    parser.add_argument("--rounds", type=int, default=7)
    arguments = parser.parse_args()
    mine, theirs = [], []
    for _ in range(arguments.rounds):
        result, seconds = label(arguments.dataset, arguments.sequence, Settings())
        mine.append(seconds)
        if arguments.ralf:
            with tempfile.TemporaryDirectory() as out:
                theirs.append(ralf_seconds(arguments.ralf, arguments.dataset, arguments.sequence, out))
                if len(theirs) == 1:
                    compare(result, out, arguments.sequence)
    report(result, mine, theirs)


def report(result, mine, theirs):
    """The medians, ms per scan."""
    scans = len(result)
    each = 1e3 / scans
    found = sum(len(w) for w, _ in result.values()) / scans
    print(f"{scans} scans, {found:.0f} detections each; medians of {len(mine)} rounds, ms per scan")
    for name in mine[0]:
        print(f"  {name:22} {each * np.median([seconds[name] for seconds in mine]):8.2f}")
    whole = np.median([sum(seconds.values()) for seconds in mine])
    print(f"NumPy and pykdtree       {each * whole:8.2f}")
    if theirs:
        ratio = whole / np.median(theirs)
        print(f"ralf label, everything   {each * np.median(theirs):8.2f}   {ratio:.1f} times as fast")


if __name__ == "__main__":
    main()
