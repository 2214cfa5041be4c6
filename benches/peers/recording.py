"""RALF's own layout (docs/formats.md, section 1), as much of it as labelling without cameras needs."""

import csv
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Sensor:
    """Where the files of a sensor are, when they were measured, and how it is mounted."""

    folder: Path
    times: np.ndarray
    columns: int
    rotation: np.ndarray
    translation: np.ndarray
    table: dict

    def points(self, scan):
        """x, y, z of a scan in the sensor's frame, m."""
        rows = np.fromfile(self.folder / f"{scan:06}.bin", np.float32).reshape(-1, self.columns)
        return rows[:, :3]


def rotation_of(x, y, z, w):
    """The matrix of a unit quaternion."""
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class Recording:
    """A sequence: its radars, its LiDAR, and where the vehicle was by its wheel odometry."""

    def __init__(self, dataset, sequence):
        """Reads what the sequence says of its sensors, and the times of all measurements."""
        self.folder = Path(dataset) / "sequences" / sequence
        described = tomllib.loads((self.folder / "sequence.toml").read_text())
        self.radars = [self._sensor(table) for table in described["radar"]]
        if any(
            radar.table["elevation"] != "measured" or radar.table["fields"][:3] != ["x", "y", "z"]
            for radar in self.radars
        ):
            raise SystemExit(f"{self.folder}: every radar has to measure x, y, z")
        if len(described["lidar"]) != 1:
            raise SystemExit(f"{self.folder}: expected one LiDAR, found {len(described['lidar'])}")
        self.lidar = self._sensor(described["lidar"][0])
        self._integrate()

    def _sensor(self, table):
        folder = self.folder / table["name"]
        times = np.loadtxt(folder / "timestamps.txt", dtype=np.int64, ndmin=1)
        rotation = rotation_of(*table["quaternion_xyzw"])
        return Sensor(folder, times, len(table.get("fields", "xyzi")), rotation, np.array(table["translation"]), table)

    def _integrate(self):
        """Exact arcs between the samples of the odometry (section 2)."""
        with (self.folder / "odometry.csv").open() as file:
            rows = [
                (int(row["t_ns"]), float(row["v_mps"]), float(row["yaw_rate_radps"])) for row in csv.DictReader(file)
            ]
        if not rows:
            raise SystemExit(f"{self.folder}: no odometry")
        self.times = np.array([row[0] for row in rows])
        self.v, self.yaw_rate = (np.array([row[i] for row in rows]) for i in (1, 2))
        seconds = np.diff(self.times) * 1e-9
        turn = np.concatenate([[0.0], np.cumsum(self.yaw_rate[:-1] * seconds)])
        steps = (
            np.stack([step(self.v[i], self.yaw_rate[i], dt) for i, dt in enumerate(seconds)])
            if len(seconds)
            else np.zeros((0, 2))
        )
        steps = np.stack([turned(s, a) for s, a in zip(steps, turn, strict=False)]) if len(steps) else steps
        self.places = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
        self.headings = turn

    def pose(self, t_ns):
        """Place and heading of the vehicle at a time."""
        i = int(np.clip(np.searchsorted(self.times, t_ns, side="right") - 1, 0, len(self.times) - 1))
        dt = (t_ns - int(self.times[i])) * 1e-9
        place = self.places[i] + turned(step(self.v[i], self.yaw_rate[i], dt), self.headings[i])
        return place, self.headings[i] + self.yaw_rate[i] * dt

    def between(self, to_ns, from_ns):
        """Rotation and translation that take the vehicle frame at one time to that at another."""
        (to, a), (begin, b) = self.pose(to_ns), self.pose(from_ns)
        s, c = np.sin(b - a), np.cos(b - a)
        translation = turned(begin - to, -a)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), np.array([*translation, 0.0])


def step(v, yaw_rate, dt):
    """The way along an arc, in the frame of its beginning."""
    turn = yaw_rate * dt
    if abs(turn) < 1e-6:
        return np.array([v * dt * (1 - turn * turn / 6), v * dt * turn / 2])
    return v * dt * np.array([np.sin(turn) / turn, (1 - np.cos(turn)) / turn])


def turned(vector, angle):
    """A plane vector, turned."""
    s, c = np.sin(angle), np.cos(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])
