"""Sequences of arrays: no files."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from collections.abc import Sequence as Items
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ralf import _ralf
from ralf._jobs import Settings, job
from ralf._progress import Progress, listener
from ralf.run import Scan, scans_of


@dataclass(frozen=True)
class Radar:
    """A radar: where it sits, and how well it measures.

    `mounting` is vehicle_from_radar: a 4 x 4 matrix, or x, y, z in m of one that looks straight ahead. A radar without
    `elevation` measures range and azimuth alone. The defaults are those of a 77 GHz radar of which nothing is known.
    """

    name: str
    mounting: ArrayLike = (0.0, 0.0, 0.0)
    elevation: bool = True
    fov_azimuth_deg: float = 120.0
    fov_elevation_deg: float = 30.0
    sigma_range_m: float = 0.2
    sigma_azimuth_deg: float = 1.0
    sigma_elevation_deg: float = 1.0


@dataclass(frozen=True)
class Lidar:
    """A LiDAR: where it sits (vehicle_from_lidar, as of a `Radar`), and how well it measures."""

    name: str
    mounting: ArrayLike = (0.0, 0.0, 0.0)
    sigma_range_m: float = 0.02
    lowest_beam_deg: float = 25.0
    max_range_m: float | None = None


@dataclass(frozen=True)
class Odometry:
    """What the wheels measured: times in ns, velocities in m/s, yaw rates in rad/s (positive to the left)."""

    t_ns: ArrayLike
    velocity: ArrayLike
    yaw_rate: ArrayLike


@dataclass(frozen=True)
class Poses:
    """Where the vehicle was: times in ns, and poses in any fixed frame, n x 4 x 4."""

    t_ns: ArrayLike
    poses: ArrayLike


class Labels:
    """The labels of a sequence in memory: the table of a run, and its scans."""

    def __init__(self, table: _ralf.Table) -> None:
        self.table = table

    def scans(self, radar: str | None = None) -> Iterator[Scan]:
        """The scans, radar by radar; of one radar, or of all. Columns are NumPy views."""
        return scans_of(self.table, radar)

    def __getitem__(self, column: str) -> NDArray[Any]:
        """A column of all detections."""
        return np.asarray(self.table.column(column, 0))

    def __len__(self) -> int:
        return len(self.table)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)


@dataclass
class _Sensor:
    told: Radar | Lidar
    fields: list[str] = field(default_factory=list)
    scans: list[tuple[Any, ...]] = field(default_factory=list)


class Sequence:
    """A sequence of arrays. Scans of a sensor are added in the order of time.

    A LiDAR's points lie in its own frame and are motion-corrected to the scan's time.
    """

    def __init__(
        self,
        radars: Items[Radar],
        lidars: Items[Lidar] = (),
        motion: Odometry | Poses | None = None,
        name: str = "00",
    ) -> None:
        self.name = name
        self._motion = _motion(motion)
        self._radars = {radar.name: _Sensor(radar) for radar in radars}
        self._lidars = {lidar.name: _Sensor(lidar) for lidar in lidars}

    def add_radar_scan(self, radar: str, t_ns: int, xyz: ArrayLike | None = None, **fields: ArrayLike) -> None:
        """Add a scan: `xyz` (n x 3, in the radar's frame, m), or `range`, `azimuth` and `elevation` (m, rad) each.

        All other fields (`doppler`, `rcs`, ...) are kept as they are; every scan of a radar has the same ones.
        """
        sensor = _known(self._radars, radar, "radar")
        columns = {name: _column(value) for name, value in fields.items()}
        if xyz is not None:
            points = np.asarray(xyz, dtype=np.float32).reshape(-1, 3)
            columns = {name: _column(points[:, axis]) for axis, name in enumerate("xyz")} | columns
        names = list(columns)
        if sensor.scans and names != sensor.fields:
            raise ValueError(f"{radar}: expected the fields {sensor.fields}, found {names}")
        sensor.fields = names
        sensor.scans.append((int(t_ns), list(columns.values())))

    def add_lidar_scan(
        self,
        lidar: str,
        t_ns: int,
        points: ArrayLike,
        intensity: ArrayLike | None = None,
        times: ArrayLike | None = None,
    ) -> None:
        """Add a revolution: n x 3 points (m), intensities, and when each point was measured (s after `t_ns`)."""
        sensor = _known(self._lidars, lidar, "LiDAR")
        rows = np.ascontiguousarray(np.asarray(points, dtype=np.float32).reshape(-1, 3))
        strengths = np.zeros(len(rows), np.float32) if intensity is None else _column(intensity)
        sensor.scans.append((int(t_ns), rows, strengths, None if times is None else _column(times)))

    def label(
        self,
        settings: Settings = None,
        *,
        method: str | None = None,
        model: str | os.PathLike[str] | None = None,
        evidence: bool = False,
        jobs: int | None = None,
        progress: Progress = None,
    ) -> Labels:
        """Label all radar scans: what `ralf label` says of the same data."""
        told = job("", "", settings=settings, method=method, model=model, evidence=evidence)
        return Labels(self._built().label(told, jobs, listener(progress)))

    def write(self, dataset: str | os.PathLike[str]) -> None:
        """Write the sequence in the project's own layout, which every command reads."""
        self._built().write(dataset)

    def _built(self) -> _ralf.MemorySequence:
        radars = [(_radar(sensor), sensor.scans) for sensor in self._radars.values()]
        lidars = [(_lidar(sensor), sensor.scans) for sensor in self._lidars.values()]
        return _ralf.MemorySequence(self.name, self._motion, radars, lidars)


def _known(sensors: dict[str, _Sensor], name: str, kind: str) -> _Sensor:
    if name not in sensors:
        raise KeyError(f"expected a {kind} of {', '.join(sensors)}, found {name}")
    return sensors[name]


def _column(values: ArrayLike) -> NDArray[np.float32]:
    return np.ascontiguousarray(np.asarray(values, dtype=np.float32).ravel())


def _radar(sensor: _Sensor) -> str:
    told = vars(sensor.told) | {"mounting": _pose(sensor.told.mounting)}
    # Without a scan, nothing is known of a radar's fields but that it has some.
    return json.dumps(told | {"fields": sensor.fields or ["x", "y", "z"]})


def _lidar(sensor: _Sensor) -> str:
    return json.dumps(vars(sensor.told) | {"mounting": _pose(sensor.told.mounting)})


def _motion(motion: Odometry | Poses | None) -> str:
    told: dict[str, Any] = {"odometry": [], "poses": []}
    if isinstance(motion, Poses):
        times = np.asarray(motion.t_ns, dtype=np.int64).tolist()
        told["poses"] = [[t_ns, _pose(pose)] for t_ns, pose in zip(times, np.asarray(motion.poses), strict=True)]
    else:
        standing = Odometry([0], [0.0], [0.0])
        wheels = motion or standing
        times = np.asarray(wheels.t_ns, dtype=np.int64).tolist()
        rates = [np.asarray(values, dtype=np.float64).tolist() for values in (wheels.velocity, wheels.yaw_rate)]
        told["odometry"] = list(zip(times, *rates, strict=True))
    return json.dumps(told)


def _pose(mounting: ArrayLike) -> dict[str, list[float]]:
    """A translation and a quaternion (x, y, z, w) of a 4 x 4 matrix, or of x, y, z."""
    matrix = np.asarray(mounting, dtype=np.float64)
    if matrix.shape == (3,):
        return {"translation": matrix.tolist(), "rotation": [0.0, 0.0, 0.0, 1.0]}
    if matrix.shape != (4, 4):
        raise ValueError(f"expected a 4 x 4 matrix or x, y, z, found an array of shape {matrix.shape}")
    rotation = matrix[:3, :3]
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-3) or np.linalg.det(rotation) < 0:
        raise ValueError("expected a rotation in the upper left 3 x 3 of the matrix, found something else")
    return {"translation": matrix[:3, 3].tolist(), "rotation": _quaternion(rotation)}


def _quaternion(r: NDArray[np.float64]) -> list[float]:
    """The unit quaternion (x, y, z, w) of a rotation matrix: the eigenvector of the largest eigenvalue.

    Bar-Itzhack, "New method for extracting the quaternion from a rotation matrix", 2000.
    """
    k = np.array(
        [
            [r[0, 0] - r[1, 1] - r[2, 2], r[1, 0] + r[0, 1], r[2, 0] + r[0, 2], r[2, 1] - r[1, 2]],
            [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], r[2, 1] + r[1, 2], r[0, 2] - r[2, 0]],
            [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]],
        ]
    )
    return [float(value) for value in np.linalg.eigh(k / 3.0)[1][:, -1]]
