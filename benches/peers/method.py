"""The paper's method without cameras, in NumPy as somebody writes it who knows how: no loop over detections or points.

Each array of a scan is made once; a search stops where the mismatch has reached its cap. docs/method.md is what is
computed, section by section. Radars measure elevation; there is one LiDAR.
"""

from dataclasses import dataclass

import numpy as np
from pykdtree.kdtree import KDTree

EPSILON = 1e-6  # m^2, below the root of a mismatch
HYPOTHESES, FIRST_LOOK, FINALISTS, CLIMBS = 300, 1024, 8, 8


@dataclass(frozen=True)
class Settings:
    """The defaults of RALF (config/default.toml)."""

    lidar_tolerance_ns: int = 60_000_000
    max_tilt: float = np.radians(10.0)
    max_offset: float = 0.5
    inlier_distance: float = 0.15
    lidar_margin: float = 0.20
    radar_clearance: float = 0.10
    radar_sigmas: float = 2.0
    lidar_beta: float = 0.2
    lidar_neighbours: int = 3
    lidar_cap: float = 40.0
    tracking_beta: float = 0.682
    tracking_scans: int = 5
    tracking_cap: float = 20.0
    max_gap_ns: int = 500_000_000
    alpha: float = 0.554
    threshold: float = 0.4


@dataclass(frozen=True)
class Detections:
    """A radar scan in the vehicle frame at its own time: places (n, 3), roots of covariances (n, 3, 3), gamma_s (n).

    A root `a` stands for the covariance `a.T @ a`: its rows are the radar's unit vectors by their standard deviations.
    """

    xyz: np.ndarray
    roots: np.ndarray
    gamma: np.ndarray
    widest: np.ndarray
    tree: KDTree


def detections(xyz, rotation, translation, sigmas, reliability):
    """Spherical errors carried over to the vehicle frame (section 3). `xyz` (n, 3) in the radar's frame, m."""
    r = np.linalg.norm(xyz, axis=1)
    azimuth, elevation = np.arctan2(xyz[:, 1], xyz[:, 0]), np.arcsin(xyz[:, 2] / r)
    (sa, ca), (se, ce) = ((np.sin(v), np.cos(v)) for v in (azimuth, elevation))
    zero = np.zeros_like(r)
    rows = np.stack([ce * ca, ce * sa, se, -sa, ca, zero, -se * ca, -se * sa, ce], axis=1).reshape(-1, 3, 3)
    spread = np.stack([np.full_like(r, sigmas[0]), r * ce * sigmas[1], r * sigmas[2]], axis=1)
    placed = xyz @ rotation.T + translation
    gamma = np.interp(azimuth, reliability[:, 0], reliability[:, 1])
    return Detections(placed, (rows * spread[:, :, None]) @ rotation.T, gamma, spread.max(axis=1), KDTree(placed))


def fit_ground(points, settings, rng):
    """The plane (normal, offset) of RANSAC, scored on a part first, refitted while that helps (section 4.2)."""
    rho = np.hypot(points[:, 0], points[:, 1])
    reach = (settings.max_offset + settings.inlier_distance) / np.cos(settings.max_tilt)
    candidates = points[np.abs(points[:, 2]) <= reach + rho * np.tan(settings.max_tilt)]
    if len(candidates) < 3:
        return None
    a, b, c = candidates[rng.integers(0, len(candidates), (3, 8 * HYPOTHESES))].astype(float)
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1)
    normals = normals / np.where(length > 1e-12, length, np.inf)[:, None]
    normals[normals[:, 2] < 0] *= -1
    offsets = np.einsum("ij,ij->i", normals, a)
    good = (normals[:, 2] >= np.cos(settings.max_tilt)) & (np.abs(offsets) <= settings.max_offset)
    normals, offsets = normals[good][:HYPOTHESES], offsets[good][:HYPOTHESES]
    if len(normals) == 0:
        return None
    thinned = candidates[:: -(-len(candidates) // FIRST_LOOK)]
    near = np.abs(thinned @ normals.T.astype(np.float32) - offsets.astype(np.float32)) <= settings.inlier_distance
    finalists = np.argsort(-near.sum(axis=0), kind="stable")[:FINALISTS]

    def inliers(normal, offset):
        return np.abs(candidates @ normal.astype(np.float32) - np.float32(offset)) <= settings.inlier_distance

    def refitted(mask):
        chosen = candidates[mask].astype(float)
        centre = chosen.mean(axis=0)
        chosen -= centre
        normal = np.linalg.eigh(chosen.T @ chosen)[1][:, 0]
        normal = normal if normal[2] > 0 else -normal
        offset = normal @ centre
        admissible = normal[2] >= np.cos(settings.max_tilt) and abs(offset) <= settings.max_offset
        return (normal, offset) if admissible else None

    masks = [inliers(normals[i], offsets[i]) for i in finalists]
    best = int(np.argmax([mask.sum() for mask in masks]))
    plane, mask = (normals[finalists[best]], offsets[finalists[best]]), masks[best]
    better = refitted(mask)
    for _ in range(CLIMBS):
        if better is None:
            break
        higher = inliers(*better)
        if higher.sum() <= mask.sum():
            break
        plane, mask = better, higher
        better = refitted(mask)
    return better or plane


@dataclass(frozen=True)
class Moment:
    """What all radars share of a LiDAR scan: its points above the ground, their rays, a tree, the ground's plane."""

    points: np.ndarray
    rays: np.ndarray
    sigma: float
    tree: KDTree
    plane: tuple | None


def moment(points, rotation, translation, sigma, settings, rng):
    """A LiDAR scan (n, 3), moved to the vehicle frame at its own time and rid of its ground (section 4.2, 4.3)."""
    placed = points @ rotation.T.astype(np.float32) + translation.astype(np.float32)
    plane = fit_ground(placed, settings, rng)
    if plane is not None:
        placed = placed[placed @ plane[0].astype(np.float32) - np.float32(plane[1]) >= settings.lidar_margin]
    rays = placed - translation.astype(np.float32)
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    return Moment(placed, rays, sigma, KDTree(placed), plane)


def mismatches(h, *roots):
    """|h| over its standard deviation for offsets `h` (..., 3) and roots (..., k, 3) of covariances (section 3)."""
    distance = np.linalg.norm(h, axis=-1)
    variance = sum(np.square((root @ h[..., None])[..., 0]).sum(axis=-1) for root in roots)
    squared = np.square(distance)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = distance / np.sqrt(variance / squared + EPSILON)
    return np.where(distance < 1e-9, 0.0, found)


def moved(scan, transform):
    """Places and roots of a scan in another frame."""
    rotation, translation = transform
    return scan.xyz @ rotation.T + translation, scan.roots @ rotation.T


def match_lidar(scan, lidar, lidar_from_radar, settings):
    """`d_lm` and which detections lie on the floor, in the LiDAR scan's frame: distances are the same there."""
    xyz, roots = moved(scan, lidar_from_radar)
    floor = np.zeros(len(xyz), bool)
    if lidar.plane is not None:
        normal, offset = lidar.plane
        spread = np.linalg.norm(roots @ normal, axis=1)
        floor = xyz @ normal - offset + settings.radar_sigmas * spread < settings.radar_clearance
    k = settings.lidar_neighbours
    # Of the mean of k mismatches: one neighbour beyond the bound makes it reach the cap, wherever the others are.
    enough = k * settings.lidar_cap
    beyond = enough * np.sqrt(scan.widest.max() ** 2 + lidar.sigma**2 + EPSILON) * 1.01
    distances, nearest = lidar.tree.query(xyz.astype(np.float32), k=k, distance_upper_bound=beyond)
    there = np.isfinite(distances)
    nearest = np.where(there, nearest, 0)
    h = xyz[:, None, :] - lidar.points[nearest]
    each = mismatches(h, roots[:, None], (lidar.sigma * lidar.rays[nearest])[:, :, None, :])
    d = np.where(there, each, enough).mean(axis=1)
    return np.minimum(d, settings.lidar_cap), floor


def track(scan, neighbours, settings):
    """`d_tr` over (neighbouring scan, its frame from this one's) pairs (section 7)."""
    all_d = np.empty((len(neighbours), len(scan.xyz)))
    cap = settings.tracking_cap
    for d, (other, transform) in zip(all_d, neighbours, strict=True):
        xyz, roots = moved(scan, transform)
        beyond = cap * np.sqrt(scan.widest.max() ** 2 + other.widest.max() ** 2 + EPSILON) * 1.01
        distances, nearest = other.tree.query(xyz, k=1, distance_upper_bound=beyond)
        there = np.isfinite(distances)
        d[:] = cap
        chosen = nearest[there]
        each = mismatches(xyz[there] - other.xyz[chosen], roots[there], other.roots[chosen])
        d[there] = np.minimum(each, cap)
    all_d.sort(axis=0)
    weights = np.arange(len(neighbours), 0, -1.0)
    return weights @ all_d / weights.sum()


def fuse(scan, d_lm, floor, d_tr, settings):
    """`w` and the label (section 8). An absent branch is None."""
    w_lm = None if d_lm is None else np.where(floor, 0.0, np.exp(-settings.lidar_beta * d_lm))
    w_tr = None if d_tr is None else np.exp(-settings.tracking_beta * d_tr)
    if w_lm is None or w_tr is None:
        w = w_tr if w_lm is None else w_lm
        w = np.zeros(len(scan.xyz)) if w is None else w
    else:
        w = settings.alpha * w_lm + (1 - settings.alpha) * w_tr
    w = w / scan.gamma
    return w, (w >= settings.threshold) & ~floor
