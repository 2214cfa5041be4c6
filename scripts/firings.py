#!/usr/bin/env python3
"""Are the points of a LiDAR scan of nuScenes where they were measured, or were they brought to one time?

    firings.py SCAN.pcd.bin

All beams of the LiDAR fire in the same azimuth. For each firing (32 points, ring 0 to 31) the azimuth of points 3 to
10 m away is compared with that of points beyond 25 m; printed is the median of the differences, degrees, for each
eighth of the revolution. Where points lie as they were measured it is near 0 throughout. Needs NumPy.
"""

import sys

import numpy as np

RINGS = 32
EIGHTHS = 8
NEAR = 3.0, 10.0  # m
FAR = 25.0  # m


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    points = np.fromfile(sys.argv[1], "<f4").reshape(-1, 5)
    firing = np.cumsum(np.r_[0, np.diff(points[:, 4]) < 0])
    distance = np.hypot(points[:, 0], points[:, 1])
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    near, far = (distance > NEAR[0]) & (distance < NEAR[1]), distance > FAR
    differences = [[] for _ in range(EIGHTHS)]
    for number in range(firing[-1] + 1):
        of = firing == number
        if not (of & near).any() or not (of & far).any():
            continue
        turned = np.angle(np.exp(1j * azimuth[of & near][:, None]) / np.exp(1j * azimuth[of & far][None, :]))
        differences[number * EIGHTHS // (firing[-1] + 1)].append(np.degrees(abs(np.median(turned))))
    for eighth, found in enumerate(differences):
        print(f"eighth {eighth}: {np.median(found):.1f}" if found else f"eighth {eighth}: -")


if __name__ == "__main__":
    main()
