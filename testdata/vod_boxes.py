#!/usr/bin/env python3
"""Compares the labels of `ralf label` with the boxes and the LiDAR of View-of-Delft.

    vod_boxes.py VIEW_OF_DELFT OUT [FRAME]

VIEW_OF_DELFT holds radar/training and lidar/training, OUT is the output folder of `ralf label`. Without FRAME the first
one is taken. Two figures are printed:

1. of the radar detections inside an annotated box (grown by 0.3 m on every side) the share labelled plausible;
2. of the radar detections nearer than 40 m, but more than 2 m (3D) from every LiDAR point, the share labelled plausible.

A labeler that works gives a high first and a low second figure. Neither is ground truth: boxes cover few detections, and a
detection far from the LiDAR may still be real.
"""

import math
import struct
import sys
from pathlib import Path

GROWN_BY = 0.3  # m
NEAR = 40.0  # m
FAR_FROM_LIDAR = 2.0  # m
ARTIFACT = 1
IGNORED_CLASSES = {"DontCare"}


def rows(file, columns):
    data = file.read_bytes()
    if len(data) % (4 * columns):
        sys.exit(f"{file}: expected rows of {columns} float32, found {len(data)} bytes")
    return list(struct.iter_unpack(f"<{columns}f", data))


def camera_from_sensor(file):
    """The 3 x 4 matrix `Tr_velo_to_cam`, as rotation rows and translation."""
    for line in file.read_text().splitlines():
        if line.startswith("Tr_velo_to_cam:"):
            numbers = [float(word) for word in line.split()[1:]]
            return [numbers[i : i + 3] for i in (0, 4, 8)], numbers[3::4]
    sys.exit(f"{file}: expected a line `Tr_velo_to_cam:`, found none")


def lidar_from_radar(data, frame):
    """A function that moves points: radar -> camera -> LiDAR."""
    turn_r, shift_r = camera_from_sensor(data / f"radar/training/calib/{frame}.txt")
    turn_l, shift_l = camera_from_sensor(data / f"lidar/training/calib/{frame}.txt")

    def move(point):
        camera = [sum(a * p for a, p in zip(row, point)) + t for row, t in zip(turn_r, shift_r)]
        return inverse(turn_l, shift_l, camera)

    return move


def inverse(turn, shift, point):
    """Takes a point of the camera frame back to the sensor's."""
    moved = [p - t for p, t in zip(point, shift)]
    return tuple(sum(turn[j][i] * moved[j] for j in range(3)) for i in range(3))


class Box:
    """An annotated object from a row of `lidar/training/label_2/*.txt`, in the LiDAR frame.

    The row is KITTI's (h w l, centre of the bottom in the camera frame, angle), but the angle turns about the LiDAR's -z. The
    boxes of `radar/training/label_2/*.json` are not used: they claim the LiDAR's frame and lie in one with y right and z down.
    """

    def __init__(self, row, turn, shift):
        words = row.split()
        self.name = words[0]
        height, width, length, x, y, z, angle = map(float, words[8:15])
        self.center = inverse(turn, shift, (x, y, z))
        yaw = -(angle + math.pi / 2)
        self.cos, self.sin = math.cos(yaw), math.sin(yaw)
        self.size = length, width, height

    def holds(self, point, margin):
        """Whether a point of the LiDAR frame is inside, the box grown by the margin on every side."""
        x, y, z = (p - c for p, c in zip(point, self.center))
        along, across = self.cos * x + self.sin * y, self.cos * y - self.sin * x
        length, width, height = self.size
        return (
            abs(along) <= length / 2 + margin
            and abs(across) <= width / 2 + margin
            and -margin <= z <= height + margin
        )


class Grid:
    """Points in cells as wide as the distance that is asked for: only the 27 cells around a point matter."""

    def __init__(self, points, reach):
        self.reach = reach
        self.cells = {}
        for point in points:
            self.cells.setdefault(self.cell(point), []).append(point)

    def cell(self, point):
        return tuple(math.floor(value / self.reach) for value in point)

    def reaches(self, point):
        x, y, z = self.cell(point)
        around = ((x + i, y + j, z + k) for i in (0, -1, 1) for j in (0, -1, 1) for k in (0, -1, 1))
        return any(
            math.dist(point, other) <= self.reach for cell in around for other in self.cells.get(cell, ())
        )


def label_file(out, index):
    """The labels of a frame, by its place among all frames: sequences are clips (`delft_2`), in the frames' order."""
    clips = {int(folder.name.rpartition("_")[2]): folder for folder in out.glob("sequences/delft_*")}
    for _, folder in sorted(clips.items()):
        count = len(list((folder / "radar").glob("*.label")))
        if index < count:
            return folder / f"radar/{index:06}.label"
        index -= count
    return out / f"sequences/training/radar/{index:06}.label"


def labels(out, index, count):
    file = label_file(out, index)
    data = file.read_bytes()
    if len(data) != 4 * count:
        sys.exit(f"{file}: expected {count} labels, found {len(data)} bytes")
    return [value & 0xFFFF for (value,) in struct.iter_unpack("<I", data)]


def report(name, found):
    plausible = sum(label != ARTIFACT for label in found)
    share = f"{plausible / len(found):.3f}" if found else "none"
    print(f"{name}: {share} ({plausible} of {len(found)})")


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    data, out = Path(sys.argv[1]), Path(sys.argv[2])
    frames = sorted((file.stem for file in (data / "radar/training/velodyne").glob("*.bin")), key=int)
    frame = sys.argv[3] if len(sys.argv) == 4 else frames[0]
    detections = [row[:3] for row in rows(data / f"radar/training/velodyne/{frame}.bin", 7)]
    label = labels(out, frames.index(frame), len(detections))
    move = lidar_from_radar(data, frame)
    moved = [move(detection) for detection in detections]
    cloud = [row[:3] for row in rows(data / f"lidar/training/velodyne/{frame}.bin", 4)]
    turn, shift = camera_from_sensor(data / f"lidar/training/calib/{frame}.txt")
    annotations = (data / f"lidar/training/label_2/{frame}.txt").read_text().splitlines()
    boxes = [box for box in (Box(row, turn, shift) for row in annotations) if box.name not in IGNORED_CLASSES]

    with_points = sum(any(box.holds(point, 0.0) for point in cloud) for box in boxes)
    print(f"frame {frame}: {len(detections)} detections, {with_points} of {len(boxes)} boxes hold LiDAR points")
    in_boxes = [any(box.holds(point, GROWN_BY) for box in boxes) for point in moved]
    report("plausible inside boxes", [value for value, is_in in zip(label, in_boxes) if is_in])
    grid = Grid(cloud, FAR_FROM_LIDAR)
    lonely = [math.hypot(*d) < NEAR and not grid.reaches(m) for d, m in zip(detections, moved)]
    report(
        f"plausible below {NEAR:g} m, more than {FAR_FROM_LIDAR:g} m from every LiDAR point",
        [value for value, alone in zip(label, lonely) if alone],
    )


if __name__ == "__main__":
    main()
