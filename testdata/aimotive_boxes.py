#!/usr/bin/env python3
"""Compares the labels of `ralf label` with the boxes and the LiDAR of aiMotive.

    aimotive_boxes.py AIMOTIVE CONVERTED OUT

AIMOTIVE is the folder of one sequence, of which the boxes are read. CONVERTED is the same as `ralf convert` wrote it with
the corrections of its clocks and mountings (docs/aimotive.md), and OUT the output folder of `ralf label CONVERTED`. Of the
detections of each kind the share is printed that is labelled plausible:

1. in boxes: inside an annotated box where it was at the scan's time, grown by 0.5 m along its sides and by 1 degree in
   height, with a Doppler within 2 m/s of the box's. The box holds at least 5 points of the LiDAR scan nearest in time, each
   of which is compared at its own time;
2. on guard rails: standing by its Doppler (within 0.5 m/s), in no box, at least 3 m to a side, and within 0.5 m in plan of
   points 0.3 to 1.5 m above the road both of the LiDAR scan nearest in time and of at least 3 scans of the sequence (in a
   cell of 0.25 m); points in boxes are left out. These are rails, and posts and noise barriers beside them;
3. far: more than 2.5 m from every point of the LiDAR scan nearest in time, the road's too, and of neither kind above;
4. all others.

Scans without a LiDAR scan within 60 ms are left out. None of it is ground truth: a box may hide another reflection, and a
detection far from the LiDAR may still be real. A labeler that works gives two high shares and then a low one. Needs NumPy.
"""

import csv
import json
import math
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

GROWN_BY = 0.5  # m in plan
GROWN_BY_ELEVATION = math.radians(1.0)
POINTS_IN_BOX = 5
POINT_MARGIN = 0.3  # m, of boxes that LiDAR points are counted in
DOPPLER_OF_BOX = 2.0  # m/s
DOPPLER_OF_STANDING = 0.5  # m/s
RAIL_HEIGHTS = 0.3, 1.5  # m
RAIL_ASIDE = 3.0  # m
RAIL_CELL = 0.25  # m
RAIL_SCANS = 3
RAIL_WITHIN = 0.5  # m
FAR_FROM_LIDAR = 2.5  # m
LIDAR_TOLERANCE = 60e6  # ns
ARTIFACT = 1
KINDS = "in boxes", "on guard rails", f"more than {FAR_FROM_LIDAR:g} m from every LiDAR point", "others"


def rotation(quaternion):
    """The matrix of a quaternion x, y, z, w."""
    x, y, z, w = np.asarray(quaternion) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@dataclass
class Pose:
    """Takes points of one frame to another."""

    turn: np.ndarray
    shift: np.ndarray

    def __matmul__(self, points):
        return points @ self.turn.T + self.shift

    def inverse(self):
        return Pose(self.turn.T, -self.turn.T @ self.shift)


class Motion:
    """The vehicle's poses, linear between them, and its velocity."""

    def __init__(self, file):
        rows = list(csv.DictReader(file.open()))
        self.times = np.array([int(row["t_ns"]) for row in rows])
        self.places = np.array([[float(row[axis]) for axis in "xyz"] for row in rows])
        self.turns = np.array([[float(row["q" + axis]) for axis in "xyzw"] for row in rows])

    def odom_from_vehicle(self, t_ns):
        place = [np.interp(t_ns, self.times, self.places[:, axis]) for axis in range(3)]
        turn = [np.interp(t_ns, self.times, self.turns[:, part]) for part in range(4)]
        return Pose(rotation(turn), np.array(place))

    def between(self, to_ns, from_ns):
        """The vehicle at one time in its frame at another."""
        to, start = self.odom_from_vehicle(to_ns).inverse(), self.odom_from_vehicle(from_ns)
        return Pose(to.turn @ start.turn, to @ start.shift)

    def velocity_of(self, point, t_ns, half=25e6):
        """Of a point of the vehicle, m/s, in the vehicle's frame."""
        before, after = self.between(t_ns, t_ns - half), self.between(t_ns, t_ns + half)
        return ((after @ point) - (before @ point)) / (2 * half * 1e-9)


class Box:
    """An annotated object at a frame's time: `CapturedObjects` of `dynamic/box/3d_body/*.json`."""

    def __init__(self, row, t_ns):
        def values(name, axes="XYZ"):
            return np.array([row[f"{name} {axis}"] for axis in axes])

        self.t_ns = t_ns
        self.center = values("BoundingBox3D Origin")
        self.half = values("BoundingBox3D Extent") / 2
        self.turn = rotation(values("BoundingBox3D Orientation Quat", "XYZW"))
        # Of the box's place in the vehicle's frame, which moves as well.
        self.velocity = values("Relative Velocity")

    def center_at(self, t_ns):
        return self.center + self.velocity * (t_ns - self.t_ns) * 1e-9

    def hold(self, points, center, margin):
        """Which points are inside, the box grown by a margin per axis."""
        inside = np.abs((points - center) @ self.turn) <= self.half + margin
        return inside.all(axis=-1)


class Sequence:
    """A sequence of the own layout."""

    def __init__(self, folder):
        self.folder = folder
        self.toml = tomllib.loads((folder / "sequence.toml").read_text())
        self.motion = Motion(folder / "poses.csv")
        (self.lidar,) = self.toml["lidar"]
        self.lidar_times = self.times(self.lidar["name"])

    def times(self, name):
        return np.loadtxt(self.folder / name / "timestamps.txt", dtype=np.int64, ndmin=1)

    @staticmethod
    def mounting(sensor):
        return Pose(rotation(sensor["quaternion_xyzw"]), np.array(sensor["translation"]))

    def floats(self, name, scan, ending, columns):
        return np.fromfile(self.folder / name / f"{scan:06}.{ending}", dtype="<f4").reshape(-1, columns)

    def cloud(self, scan):
        """Points in the vehicle's frame, and the time of each after the scan's, s."""
        name = self.lidar["name"]
        points = self.floats(name, scan, "bin", 4)[:, :3].astype(float)
        times = self.floats(name, scan, "time", 1)[:, 0].astype(float)
        returns = np.abs(points).sum(axis=1) > 0
        return self.mounting(self.lidar) @ points[returns], times[returns]

    def detections(self, radar, scan):
        """Azimuth, elevation, range, Doppler."""
        rows = self.floats(radar["name"], scan, "bin", len(radar["fields"])).astype(float)
        fields = ("azimuth", "elevation", "range", "doppler")
        return [rows[:, radar["fields"].index(field)] for field in fields]


def read_boxes(aimotive, lidar_times):
    """The boxes of each LiDAR scan."""
    by_time = {}
    for file in (aimotive / "dynamic/box/3d_body").glob("frame_*.json"):
        content = json.loads(file.read_text())
        t_ns = int(content["Timestamp"])
        by_time[t_ns] = [Box(row, t_ns) for row in content["CapturedObjects"]]
    return [by_time[int(t_ns)] for t_ns in lidar_times]


def points_in(box, points, times, motion):
    """Which LiDAR points are the box's, each compared where the box was at the point's own time."""
    # The cloud is corrected for a standing world: what moves is drawn where it was, in the frame of the scan's time.
    over_ground = box.velocity + motion.velocity_of(box.center, box.t_ns)
    return box.hold(points - over_ground * times[:, None], box.center, POINT_MARGIN)


class Rails:
    """Cells beside the road that hold what stands: LiDAR points of rails' height, scan after scan."""

    def __init__(self, sequence, boxes):
        seen = {}
        for scan, t_ns in enumerate(sequence.lidar_times):
            points, times = sequence.cloud(scan)
            rail = self.of_height(points)
            for box in boxes[scan]:
                rail &= ~points_in(box, points, times, sequence.motion)
            placed = sequence.motion.odom_from_vehicle(t_ns) @ points[rail]
            for cell in {(x, y) for x, y in np.floor(placed[:, :2] / RAIL_CELL).astype(int).tolist()}:
                seen[cell] = seen.get(cell, 0) + 1
        cells = [cell for cell, scans in seen.items() if scans >= RAIL_SCANS]
        self.centers = (np.array(cells).reshape(-1, 2) + 0.5) * RAIL_CELL

    @staticmethod
    def of_height(points):
        low, high = RAIL_HEIGHTS
        return (points[:, 2] > low) & (points[:, 2] < high) & (np.abs(points[:, 1]) > RAIL_ASIDE)


def is_beside(place, points):
    """Whether a point lies within reach of a rail, in plan."""
    return bool((np.hypot(*(points[:, :2] - place[:2]).T) <= RAIL_WITHIN).any())


def kinds(sequence, boxes, rails, radar, scan, t_ns):
    """The kind of each detection of a scan; None where no LiDAR scan is near."""
    nearest = int(np.abs(sequence.lidar_times - t_ns).argmin())
    if abs(sequence.lidar_times[nearest] - t_ns) > LIDAR_TOLERANCE:
        return None
    motion, mounting = sequence.motion, sequence.mounting(radar)
    azimuth, elevation, distance, doppler = sequence.detections(radar, scan)
    level = np.cos(elevation)
    rays = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=1)
    places = mounting @ (rays * distance[:, None])
    directions = rays @ mounting.turn.T
    standing = -(directions @ motion.velocity_of(mounting.shift, t_ns))
    cloud, times = sequence.cloud(nearest)
    with_points = [box for box in boxes[nearest] if points_in(box, cloud, times, motion).sum() >= POINTS_IN_BOX]
    rail_heights = Rails.of_height(cloud)
    cloud = motion.between(t_ns, sequence.lidar_times[nearest]) @ cloud
    odom = motion.odom_from_vehicle(t_ns) @ places
    found = []
    for n, place in enumerate(places):
        margin = np.array([GROWN_BY, GROWN_BY, distance[n] * GROWN_BY_ELEVATION])
        around = [box for box in boxes[nearest] if box.hold(place, box.center_at(t_ns), margin)]
        seen = [box for box in around if box in with_points]
        stands_aside = abs(doppler[n] - standing[n]) <= DOPPLER_OF_STANDING and abs(place[1]) > RAIL_ASIDE
        beside = is_beside(place, cloud[rail_heights]) and is_beside(odom[n], rails.centers)
        if any(abs(directions[n] @ box.velocity - doppler[n]) <= DOPPLER_OF_BOX for box in seen):
            found.append(0)
        elif stands_aside and beside and not around:
            found.append(1)
        elif np.linalg.norm(cloud - place, axis=1).min() > FAR_FROM_LIDAR:
            found.append(2)
        else:
            found.append(3)
    return found


def labels(out, radar, scan, count):
    file = out / radar / f"{scan:06}.label"
    found = np.fromfile(file, dtype="<u4") & 0xFFFF
    if len(found) != count:
        sys.exit(f"{file}: expected {count} labels, found {len(found)}")
    return found


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    aimotive, converted, out = map(Path, sys.argv[1:])
    (folder,) = [child for child in (converted / "sequences").iterdir() if child.name == aimotive.resolve().name]
    sequence = Sequence(folder)
    boxes = read_boxes(aimotive, sequence.lidar_times)
    rails = Rails(sequence, boxes)
    plausible, total = np.zeros(len(KINDS), int), np.zeros(len(KINDS), int)
    for radar in sequence.toml["radar"]:
        for scan, t_ns in enumerate(sequence.times(radar["name"])):
            found = kinds(sequence, boxes, rails, radar, scan, t_ns)
            if found is None:
                continue
            label = labels(out / "sequences" / folder.name, radar["name"], scan, len(found))
            for kind, value in zip(found, label):
                total[kind] += 1
                plausible[kind] += value != ARTIFACT
    for kind, name in enumerate(KINDS):
        share = f"{plausible[kind] / total[kind]:.3f}" if total[kind] else "none"
        print(f"plausible {name}: {share} ({plausible[kind]} of {total[kind]})")


if __name__ == "__main__":
    main()
