"""Sensors of a vehicle, and how it moved: what a sequence of arrays is made with."""

from __future__ import annotations

import json
from collections.abc import Iterable
from collections.abc import Sequence as Items
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ralf._arrays import array, finite, times_ns


@dataclass(frozen=True)
class Radar:
    """A radar: where it sits, and how well it measures.

    `mounting` is vehicle_from_radar: a 4 x 4 matrix; x, y, z in m and a quaternion x, y, z, w; or x, y, z alone of one
    that looks straight ahead. A radar without `elevation` (False, or "none" as files have it) measures range and
    azimuth alone. `reliability` is a list of azimuth (degrees) and the factor (1 or more) that uncertainties grow by
    there. The defaults are those of a 77 GHz radar of which nothing is known.
    """

    name: str
    mounting: ArrayLike = (0.0, 0.0, 0.0)
    elevation: bool | Literal["measured", "none"] = True
    fov_azimuth_deg: float = 120.0
    fov_elevation_deg: float = 30.0
    sigma_range_m: float = 0.2
    sigma_azimuth_deg: float = 1.0
    sigma_elevation_deg: float = 1.0
    reliability: Items[tuple[float, float]] = ()

    def __post_init__(self) -> None:
        _elevation(self)


@dataclass(frozen=True)
class Lidar:
    """A LiDAR: where it sits (vehicle_from_lidar, as of a `Radar`), and how well it measures."""

    name: str
    mounting: ArrayLike = (0.0, 0.0, 0.0)
    sigma_range_m: float = 0.02
    lowest_beam_deg: float = 25.0
    max_range_m: float | None = None


@dataclass(frozen=True)
class Pinhole:
    """A lens that keeps lines straight but for Brown-Conrady distortion (k1, k2, p1, p2, k3). Pixels count from 0."""

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: Items[float] = ()


@dataclass(frozen=True)
class KannalaBrandt:
    """A fisheye lens, as OpenCV's fisheye module has it (k1 to k4). Pixels count from 0."""

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: Items[float] = ()


@dataclass(frozen=True)
class Scaramuzza:
    """A fisheye lens of OCamCalib: ascending polynomials, `center` (row, column) from 0, `affine` (c, d, e)."""

    polynomial: Items[float]
    inverse_polynomial: Items[float]
    center: tuple[float, float]
    affine: tuple[float, float, float] = (1.0, 0.0, 0.0)


@dataclass(frozen=True)
class View:
    """A straight view cut out of a camera's image, turned to the left by `yaw_deg`, then down by `pitch_deg`."""

    yaw_deg: float
    pitch_deg: float
    horizontal_fov_deg: float
    width: int
    height: int


@dataclass(frozen=True)
class Camera:
    """A camera: where it sits, the size of its images in px, its lens, and the views that its depth is told of.

    `mounting` is vehicle_from_camera (as of a `Radar`), of the optical frame: x right, y down, z forward. Without
    `views` there is one along the axis, of the image's size.
    """

    name: str
    mounting: ArrayLike
    width: int
    height: int
    lens: Pinhole | KannalaBrandt | Scaramuzza
    views: Items[View] = ()


DepthOutput = Literal["depth", "disparity", "metric"]
"""What a depth image tells: larger is farther, larger is nearer, or metres."""


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


def sensors_json(
    radars: Iterable[tuple[Radar, list[str]]],
    lidars: Iterable[Lidar],
    cameras: Iterable[Camera],
    depth_output: DepthOutput,
) -> str:
    """Sensors, radars with their fields, with the keys of `sequence.toml`."""
    told = {
        "format": 1,
        "name": "",
        "radar": [_radar(radar, fields) for radar, fields in radars],
        "lidar": [_mounted(lidar) for lidar in lidars],
        "camera": [_camera(camera) for camera in cameras],
        "depth": {"output": depth_output},
    }
    # NumPy's numbers and arrays are told as Python's.
    return json.dumps(told, default=lambda value: np.asarray(value).tolist())


def motion_json(motion: Odometry | Poses | None) -> str:
    """How the vehicle moved; without a word of it, it stands."""
    told: dict[str, Any] = {"odometry": [], "poses": []}
    if isinstance(motion, Poses):
        times = _times(motion.t_ns, "poses")
        poses = array(motion.poses, "poses", np.float64)
        if poses.ndim == 0 or len(poses) != len(times):
            found = "one number" if poses.ndim == 0 else str(len(poses))
            raise ValueError(f"poses: expected {len(times)}, one for each time, found {found}")
        placed = [_pose(pose, f"poses: row {n}") for n, pose in enumerate(poses)]
        told["poses"] = list(zip(times, placed, strict=True))
    else:
        wheels = motion or Odometry([0], [0.0], [0.0])
        times = _times(wheels.t_ns, "odometry")
        velocities = finite(wheels.velocity, len(times), "odometry: velocity").tolist()
        yaw_rates = finite(wheels.yaw_rate, len(times), "odometry: yaw_rate").tolist()
        told["odometry"] = list(zip(times, velocities, yaw_rates, strict=True))
    return json.dumps(told)


def _times(values: ArrayLike, place: str) -> list[int]:
    times = times_ns(values, f"{place}: t_ns")
    if times.ndim != 1:
        raise ValueError(f"{place}: t_ns: expected n times, found {times.shape}")
    return [int(t_ns) for t_ns in times]


def _radar(radar: Radar, fields: list[str]) -> dict[str, Any]:
    # Without a scan, nothing is known of a radar's fields but that it has some.
    return _mounted(radar) | {"elevation": _elevation(radar), "fields": fields or ["x", "y", "z"]}


def _elevation(radar: Radar) -> str:
    """Whether a radar measures elevation, in the words of files. What is neither is refused: any text is true."""
    given = radar.elevation
    if isinstance(given, bool | np.bool_):
        return "measured" if given else "none"
    place = f'{radar.name}: elevation: expected True or False, "measured" or "none"'
    if not isinstance(given, str):
        raise TypeError(f"{place}, found {given!r}")
    if given not in {"measured", "none"}:
        raise ValueError(f"{place}, found {given!r}")
    return given


def _camera(camera: Camera) -> dict[str, Any]:
    models = {Pinhole: "pinhole", KannalaBrandt: "kannala-brandt", Scaramuzza: "scaramuzza"}
    told = _mounted(camera) | vars(camera.lens) | {"model": models[type(camera.lens)]}
    del told["lens"], told["views"]
    return told | {"view": [vars(view) for view in camera.views]}


def _mounted(sensor: Radar | Lidar | Camera) -> dict[str, Any]:
    told = dict(vars(sensor))
    mounting = told.pop("mounting")
    for key, value in told.items():
        _refuse_no_number(value, f"{sensor.name}: {key}")
    return told | _pose(mounting, f"{sensor.name}: mounting")


def _refuse_no_number(value: Any, place: str) -> None:
    """Refuse NaN and infinity, which JSON has no word for, wherever they are in a sensor."""
    if isinstance(value, float | np.floating) and not np.isfinite(value):
        raise ValueError(f"{place}: expected a finite number, found {value}")
    if isinstance(value, list | tuple | np.ndarray):
        for item in value:
            _refuse_no_number(item, place)
    elif hasattr(value, "__dict__"):
        for key, item in vars(value).items():
            _refuse_no_number(item, f"{place}: {key}")


def _pose(mounting: ArrayLike, place: str) -> dict[str, list[float]]:
    """A translation and a quaternion (x, y, z, w), of a 4 x 4 matrix, of both in a row, or of x, y, z."""
    given = array(mounting, place, np.float64)
    if given.shape not in {(3,), (7,), (4, 4)}:
        raise ValueError(f"{place}: expected a 4 x 4 matrix, or 3 or 7 numbers, found an array of shape {given.shape}")
    if not np.all(np.isfinite(given)):
        raise ValueError(f"{place}: expected finite numbers, found {given[~np.isfinite(given)][0]} among them")
    if given.shape == (3,):
        return {"translation": given.tolist(), "quaternion_xyzw": [0.0, 0.0, 0.0, 1.0]}
    if given.shape == (7,):
        return {"translation": given[:3].tolist(), "quaternion_xyzw": given[3:].tolist()}
    rotation = given[:3, :3]
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-3) or np.linalg.det(rotation) < 0:
        raise ValueError(f"{place}: expected a rotation in the upper left 3 x 3 of the matrix, found something else")
    # A transposed matrix has its translation there, and none where it is looked for.
    if not np.allclose(given[3], [0.0, 0.0, 0.0, 1.0], atol=1e-6):
        raise ValueError(f"{place}: expected 0 0 0 1 in the last row of the matrix, found {given[3].tolist()}")
    return {"translation": given[:3, 3].tolist(), "quaternion_xyzw": _quaternion(rotation)}


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
