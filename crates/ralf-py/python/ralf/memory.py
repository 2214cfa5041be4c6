"""Sequences of arrays: no files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ralf import _ralf
from ralf._arrays import column, own, time_ns
from ralf._arrays import points as points_of
from ralf._jobs import Path_, Settings, above_0, job
from ralf._progress import Progress, listener
from ralf.run import Scan, scans_of
from ralf.sensors import Camera, DepthOutput, Lidar, Odometry, Poses, Radar, motion_json, sensors_json

Told = TypeVar("Told", Radar, Lidar, Camera)


class Labels:
    """The labels of a sequence in memory: the table of a run, and its scans."""

    def __init__(self, table: _ralf.Table, radars: Iterable[str]) -> None:
        self.table = table
        self._radars = list(radars)

    def scans(self, radar: str | None = None) -> Iterator[Scan]:
        """The scans, radar by radar; of one radar, or of all. Columns are NumPy views."""
        return scans_of(self.table, self._radars, radar)

    def __getitem__(self, column: str) -> NDArray[Any]:
        """A column of all detections."""
        return np.asarray(self.table.column(column, 0))

    def __len__(self) -> int:
        return len(self.table)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)


@dataclass
class _Sensor(Generic[Told]):
    told: Told
    fields: list[str] = field(default_factory=list)
    measured: list[tuple[Any, ...]] = field(default_factory=list)


class Sequence:
    """A sequence of arrays. Measurements of a sensor are added in the order of time.

    What is added is copied: arrays can be used again, and views keep nothing alive.

    A LiDAR's points lie in its own frame and are motion-corrected to the scan's time.
    """

    def __init__(
        self,
        radars: Iterable[Radar],
        lidars: Iterable[Lidar] = (),
        motion: Odometry | Poses | None = None,
        name: str = "00",
        *,
        cameras: Iterable[Camera] = (),
        depth_output: DepthOutput = "depth",
    ) -> None:
        self.name = name
        self._motion = motion_json(motion)
        self._depth_output: DepthOutput = depth_output
        self._radars = _by_name(radars, "radars")
        self._lidars = _by_name(lidars, "LiDARs")
        self._cameras = _by_name(cameras, "cameras")

    def add_radar_scan(self, radar: str, t_ns: int, xyz: ArrayLike | None = None, **fields: ArrayLike) -> None:
        """Add a scan: `xyz` (n x 3, in the radar's frame, m), or `range`, `azimuth` and `elevation` (m, rad) each.

        All other fields (`doppler`, `rcs`, ...) are kept as they are; every scan of a radar has the same ones.
        """
        sensor = _known(self._radars, radar, "radar")
        when = time_ns(t_ns, f"{radar}: t_ns")
        columns = _radar_columns(radar, xyz, fields)
        names = list(columns)
        if sensor.measured and names != sensor.fields:
            raise ValueError(f"{radar}: expected the fields {sensor.fields}, found {names}")
        sensor.fields = names
        sensor.measured.append((when, list(columns.values())))

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
        when = time_ns(t_ns, f"{lidar}: t_ns")
        rows = points_of(points, f"{lidar}: points")
        n = len(rows)
        strengths = np.zeros(n, np.float32) if intensity is None else column(intensity, f"{lidar}: intensity", n)
        after = None if times is None else column(times, f"{lidar}: times", n)
        sensor.measured.append((when, rows, strengths, after))

    def add_image(
        self, camera: str, t_ns: int, rgb: ArrayLike, depth: NDArray[Any] | Iterable[NDArray[Any]] | None = None
    ) -> None:
        """Add an image: height x width x 3 bytes, and what a depth network gave for it, if it was asked.

        `depth` is an array of height x width, or one for each of the camera's views; NaN, 0 and below mean no depth.
        """
        sensor = _known(self._cameras, camera, "camera")
        pixels = np.asarray(rgb)
        if pixels.dtype != np.uint8:
            raise TypeError(f"{camera}: expected an image of uint8, found {pixels.dtype}")
        views = [depth] if isinstance(depth, np.ndarray) and depth.ndim == 2 else depth
        told = None if views is None else [own(view, f"{camera}: depth") for view in views]
        sensor.measured.append((time_ns(t_ns, f"{camera}: t_ns"), pixels.copy(), told))

    def label(
        self,
        settings: Settings = None,
        *,
        method: str | None = None,
        model: Path_ | None = None,
        evidence: bool = False,
        jobs: int | None = None,
        progress: Progress = None,
    ) -> Labels:
        """Label all radar scans: what `ralf label` says of the same data."""
        told = job("", "", settings=settings, method=method, model=model, evidence=evidence)
        table = self._built().label(told, above_0(jobs, "jobs"), listener(progress))
        return Labels(table, self._radars)

    def write(self, dataset: str | os.PathLike[str]) -> None:
        """Write the sequence in the project's own layout, which every command reads."""
        self._built().write(dataset)

    def _built(self) -> _ralf.MemorySequence:
        radars, lidars, cameras = self._radars.values(), self._lidars.values(), self._cameras.values()
        sensors = sensors_json(
            [(sensor.told, sensor.fields) for sensor in radars],
            [sensor.told for sensor in lidars],
            [sensor.told for sensor in cameras],
            self._depth_output,
        )
        return _ralf.MemorySequence(
            self.name,
            sensors,
            self._motion,
            [sensor.measured for sensor in radars],
            [sensor.measured for sensor in lidars],
            [sensor.measured for sensor in cameras],
        )


def _by_name(told: Iterable[Told], kind: str) -> dict[str, _Sensor[Told]]:
    """The sensors by name, which tells them apart."""
    sensors: dict[str, _Sensor[Told]] = {}
    for sensor in told:
        if sensor.name in sensors:
            raise ValueError(f"expected {kind} of different names, found two of the name {sensor.name}")
        sensors[sensor.name] = _Sensor(sensor)
    return sensors


def _known(sensors: dict[str, _Sensor[Told]], name: str, kind: str) -> _Sensor[Told]:
    if name not in sensors:
        raise KeyError(f"expected a {kind} of {', '.join(sensors)}, found {name}")
    return sensors[name]


def _radar_columns(radar: str, xyz: ArrayLike | None, fields: dict[str, ArrayLike]) -> dict[str, NDArray[np.float32]]:
    """The fields of a scan by name, a number for each detection."""
    columns: dict[str, NDArray[np.float32]] = {}
    if xyz is not None:
        if twice := [name for name in "xyz" if name in fields]:
            raise ValueError(f"{radar}: expected xyz or x, y and z, found xyz and {', '.join(twice)}")
        rows = points_of(xyz, f"{radar}: xyz")
        columns = {name: rows[:, axis].copy() for axis, name in enumerate("xyz")}
    for name, values in fields.items():
        detections = len(next(iter(columns.values()))) if columns else None
        columns[name] = column(values, f"{radar}: {name}", detections)
    return columns
