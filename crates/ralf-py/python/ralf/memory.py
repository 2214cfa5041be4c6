"""Sequences of arrays: no files."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ralf import _ralf, _told
from ralf._arrays import array, column, own, time_ns
from ralf._arrays import points as points_of
from ralf._jobs import Path_, Settings, above_0, job
from ralf._progress import Progress, listener
from ralf._warnings import warn_of
from ralf.run import Scan, scans_of
from ralf.sensors import Camera, DepthOutput, Lidar, Odometry, Poses, Radar, motion_json, sensors_json

Told = TypeVar("Told", Radar, Lidar, Camera)

LONGEST_AFTER = 1.0
"""A point farther in time from its scan is of another clock or unit, s."""


class Labels:
    """The labels of a sequence in memory: the table of a run, and its scans."""

    def __init__(self, table: _ralf.Table, radars: Iterable[str], told: dict[str, Any]) -> None:
        self.table = table
        self.warnings: list[str] = told["warnings"]
        """What lies outside of the known motion, and radars whose labels are to be doubted."""
        self.doubts: list[tuple[str, str, str]] = _told.doubts(told)
        """What the check says against the sequence: its name, a sensor or `motion`, and what is doubted."""
        self.labelled_without: list[tuple[str, str, int, str]] = _told.labelled_without(told)
        """Scans and images that can't be used, which others were labelled without: sequence, sensor, number, reason."""
        self._radars = list(radars)

    def scans(self, radar: str | None = None) -> Iterator[Scan]:
        """The scans with detections, radar by radar; of one radar, or of all. Columns are NumPy views."""
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
        _refuse_shared({"radar": self._radars, "LiDAR": self._lidars, "camera": self._cameras})

    def add_radar_scan(self, radar: str, t_ns: int, xyz: ArrayLike | None = None, **fields: ArrayLike) -> None:
        """Add a scan: `xyz` (n x 3, in the radar's frame, m), or `range`, `azimuth` and `elevation` (m, rad) each.

        All other fields (`doppler`, `rcs`, ...) are kept as they are; every scan of a radar has the same ones.
        """
        sensor = _known(self._radars, radar, "radar")
        when = time_ns(t_ns, f"{radar}: t_ns")
        columns = _radar_columns(radar, xyz, fields)
        names = list(columns)
        if sensor.measured and sorted(names) != sorted(sensor.fields):
            raise ValueError(f"{radar}: expected the fields {sensor.fields}, found {names}")
        sensor.fields = sensor.fields or names
        sensor.measured.append((when, [columns[name] for name in sensor.fields]))

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
        if after is not None and not (np.abs(after) <= LONGEST_AFTER).all():
            found = after[~(np.abs(after) <= LONGEST_AFTER)][0]
            raise ValueError(f"{lidar}: times: expected seconds within {LONGEST_AFTER} of the scan's, found {found}")
        sensor.measured.append((when, rows, strengths, after))

    def add_image(
        self, camera: str, t_ns: int, rgb: ArrayLike, depth: NDArray[Any] | Iterable[NDArray[Any]] | None = None
    ) -> None:
        """Add an image: height x width x 3 bytes, and what a depth network gave for it, if it was asked.

        `depth` is an array of height x width, or one for each of the camera's views; NaN, 0 and below mean no depth.
        The image is as large as its camera says, and depth as its view.
        """
        sensor = _known(self._cameras, camera, "camera")
        pixels = array(rgb, f"{camera}: rgb")
        if pixels.dtype != np.uint8:
            raise TypeError(f"{camera}: expected an image of uint8, found {pixels.dtype}")
        if pixels.shape != (size := (sensor.told.height, sensor.told.width, 3)):
            raise ValueError(f"{camera}: expected an image of height x width x 3, {size}, found {pixels.shape}")
        told = None if depth is None else _depth_of(sensor.told, depth)
        sensor.measured.append((time_ns(t_ns, f"{camera}: t_ns"), pixels.copy(), told))

    def label(
        self,
        settings: Settings = None,
        *,
        method: str | None = None,
        model: Path_ | None = None,
        evidence: bool = False,
        check: bool = True,
        jobs: int | None = None,
        progress: Progress = None,
    ) -> Labels:
        """Label all radar scans: what `ralf label` says of the same data.

        What it doubts, what lies outside of the known motion, and what scans were labelled without are warnings: the
        first few of many, and the `Labels` have all.
        """
        how = job("", "", settings=settings, method=method, model=model, evidence=evidence, check=check)
        table, said = self._built().label(how, above_0(jobs, "jobs"), listener(progress))
        told: dict[str, Any] = json.loads(said)
        labels = Labels(table, self._radars, told)
        warn_of(_told.warnings_of(told, [self.name], labels.warnings))
        return labels

    def write(self, dataset: Path_) -> None:
        """Write the sequence in the project's own layout, which every command reads."""
        self._built().write(os.fsdecode(dataset))

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


def _refuse_shared(kinds: dict[str, Iterable[str]]) -> None:
    """Refuse a name that sensors of two kinds have: it tells them apart in labels, and in files."""
    known: dict[str, str] = {}
    for kind, names in kinds.items():
        for name in names:
            if name in known:
                found = f"a {known[name]} and a {kind} of the name {name}"
                raise ValueError(f"expected sensors of different names, found {found}")
            known[name] = kind


def _depth_of(camera: Camera, depth: NDArray[Any] | Iterable[NDArray[Any]]) -> list[NDArray[np.float32]]:
    """Depth of each of a camera's views, each as large as its view."""
    place = f"{camera.name}: depth"
    views = [depth] if isinstance(depth, np.ndarray) and depth.ndim == 2 else depth
    found = [own(view, place) for view in views]
    sizes = [(view.height, view.width) for view in camera.views] or [(camera.height, camera.width)]
    if len(found) != len(sizes):
        raise ValueError(f"{place}: expected {len(sizes)} arrays, one for each view, found {len(found)}")
    for number, (view, size) in enumerate(zip(found, sizes, strict=True)):
        if view.shape != size:
            raise ValueError(f"{place}: view {number}: expected depth of height x width, {size}, found {view.shape}")
    return found


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
