"""Recordings: what was measured."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ralf import _ralf
from ralf._jobs import Job, Path_, Settings, job, whole
from ralf._told import bounded
from ralf._warnings import warn_of


@dataclass(frozen=True)
class RadarScan:
    """A scan of a radar, each field as the recording has it."""

    t_ns: int
    fields: dict[str, NDArray[np.float32]]

    def __getitem__(self, field: str) -> NDArray[np.float32]:
        return self.fields[field]


@dataclass(frozen=True)
class LidarScan:
    """A revolution of a LiDAR, motion-corrected to its time: x, y, z (m, in its own frame), and intensities."""

    t_ns: int
    points: NDArray[np.float32]
    intensity: NDArray[np.float32]


@dataclass(frozen=True)
class Image:
    """An image of a camera: height x width x 3 bytes, and the depth of each of its views (height x width), if known."""

    t_ns: int
    rgb: NDArray[np.uint8]
    depth: list[NDArray[np.float32]] | None


@dataclass(frozen=True)
class SequenceInfo:
    """A sequence: its sensors by name, each with the times of its measurements in ns."""

    name: str
    title: str
    radars: dict[str, NDArray[np.int64]]
    lidars: dict[str, NDArray[np.int64]]
    cameras: dict[str, NDArray[np.int64]]
    fields: dict[str, list[str]]
    """The fields of each radar."""
    warnings: list[str]


class Recording:
    """A recording of any format. Its tables are read, its measurements are not until they are asked for."""

    def __init__(self, job: Job) -> None:
        self._job = job.anywhere()
        self.path = self._job.recording
        self._recording = _ralf.Recording(self._job)

    @property
    def format(self) -> str:
        """The name of its format."""
        return self._recording.format

    @property
    def sequences(self) -> list[str]:
        """The names of its sequences."""
        return self._recording.sequences

    @property
    def warnings(self) -> list[str]:
        """What its reader ignored or misses, each after the name of its sequence."""
        return self._recording.warnings

    @property
    def chosen(self) -> list[str] | None:
        """The names of the sequences that it was opened for; `None` where none was named."""
        return json.loads(self._job.told)["sequences"] or None

    @property
    def settings(self) -> dict[str, Any]:
        """All settings that it was opened with, by which `ralf.label` labels it."""
        return self._job.settings

    def __getitem__(self, sequence: str) -> SequenceInfo:
        told: dict[str, Any] = json.loads(self._recording.sequence(sequence))
        times = {
            kind: {sensor["name"]: np.array(sensor["times_ns"], dtype=np.int64) for sensor in told[kind]}
            for kind in ("radars", "lidars", "cameras")
        }
        fields = {sensor["name"]: sensor["fields"] for sensor in told["radars"]}
        return SequenceInfo(told["name"], told["title"], **times, fields=fields, warnings=told["warnings"])

    def radar_scan(self, sequence: str, radar: str, scan: int) -> RadarScan:
        """A scan of a radar."""
        t_ns, columns = self._recording.radar_scan(sequence, radar, whole(scan, "scan"))
        return RadarScan(t_ns, {name: np.asarray(column) for name, column in columns})

    def lidar_scan(self, sequence: str, lidar: str, scan: int) -> LidarScan:
        """A revolution of a LiDAR."""
        t_ns, points, intensity = self._recording.lidar_scan(sequence, lidar, whole(scan, "scan"))
        return LidarScan(t_ns, np.asarray(points), np.asarray(intensity))

    def image(self, sequence: str, camera: str, image: int) -> Image:
        """An image of a camera, decoded; its depth is in metres where the recording says so, else relative."""
        t_ns, rgb, depth = self._recording.image(sequence, camera, whole(image, "image"))
        return Image(t_ns, np.asarray(rgb), None if depth is None else [np.asarray(view) for view in depth])

    def __repr__(self) -> str:
        return f"Recording({self.path!r}, format={self.format!r}, sequences={self.sequences})"

    # Where it lies is enough to open it again, in another process or on another machine.
    def __reduce__(self) -> tuple[type[Recording], tuple[Job]]:
        return Recording, (self._job,)


def open(  # noqa: A001
    path: Path_,
    *,
    format: str | None = None,  # noqa: A002
    sequences: Iterable[str] | None = None,
    settings: Settings = None,
) -> Recording:
    """Open a recording: a folder, or a ROS bag or MCAP file; its format is recognised by what it holds.

    What its reader ignored or misses is a warning; of many the first few are given, and `Recording.warnings` has all.
    `settings` may correct mountings, clocks and motion; `ralf.label` of the recording goes by them, too. `sequences`
    are those that are opened, all if not given.
    """
    recording = Recording(job(path, "", format=format, sequences=sequences, settings=settings))
    warn_of(bounded(recording.warnings, "warnings"))
    return recording
