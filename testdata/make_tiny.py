#!/usr/bin/env python3
"""Writes a tiny recording in RALF's own layout: python3 make_tiny.py OUT

A vehicle passes parked cars, poles and a wall at 3 m/s. A LiDAR and two radars are ray-cast against these boxes; each
radar also reports what isn't there: clutter on the road, mirror images behind the wall, and noise. Which detection is
which goes to ground_truth/. The same seed gives the same bytes, and Python's own library is all that it takes.
"""

import argparse
import math
import random
import struct
from pathlib import Path

# World: axis-aligned boxes (x, y, z of the lower and the upper corner, m) on the plane z = 0.
WALL_Y = 6.0
WALL = ((-30.0, WALL_Y, 0.0), (45.0, WALL_Y + 0.3, 3.0))
CARS = [((x, -4.6, 0.2), (x + 4.4, -2.8, 1.5)) for x in (-15.0, 12.0, 20.5)]
POLES = [((x, y, 0.0), (x + 0.2, y + 0.2, 4.0)) for x, y in ((-8.0, 4.5), (9.0, 4.5), (18.0, 4.5), (28.0, -5.5))]
BOXES = [WALL, *CARS, *POLES]

# The vehicle: wheel odometry, held constant.
SPEED, YAW_RATE = 3.0, 0.03
SCANS = 12
RADAR_PERIOD_NS, LIDAR_PERIOD_NS, ODOMETRY_PERIOD_NS = 75_000_000, 100_000_000, 20_000_000
END_NS = SCANS * RADAR_PERIOD_NS

LIDAR = {"name": "lidar_top", "at": (1.2, 0.0, 1.9), "sigma_range": 0.03, "lowest": 25.0, "range": 60.0}
RADARS = [
    {"name": "radar_front", "at": (3.6, 0.0, 0.5), "yaw": 0.0, "fov": (120.0, 20.0), "start_ns": 10_000_000,
     "sigma": (0.10, 0.6, 1.2), "measures_elevation": True, "fields": ["x", "y", "z", "doppler", "rcs"]},
    {"name": "radar_rear", "at": (-1.0, 0.0, 0.5), "yaw": math.pi, "fov": (140.0, 12.0), "start_ns": 35_000_000,
     "sigma": (0.15, 1.0, 0.0), "measures_elevation": False, "fields": ["range", "azimuth", "doppler", "rcs"]},
]
PLAUSIBLE, ARTIFACT = 99, 1


def vehicle_pose(t_ns):
    """x, y and yaw at a time: the exact arc."""
    yaw = YAW_RATE * t_ns * 1e-9
    radius = SPEED / YAW_RATE
    return radius * math.sin(yaw), radius * (1.0 - math.cos(yaw)), yaw


def sensor_pose(t_ns, at, yaw=0.0):
    """A sensor's position in the world, and its heading."""
    x, y, heading = vehicle_pose(t_ns)
    cos, sin = math.cos(heading), math.sin(heading)
    return (x + cos * at[0] - sin * at[1], y + sin * at[0] + cos * at[1], at[2]), heading + yaw


def direction(azimuth, elevation):
    cos = math.cos(elevation)
    return cos * math.cos(azimuth), cos * math.sin(azimuth), math.sin(elevation)


def to_spherical(point):
    x, y, z = point
    distance = math.sqrt(x * x + y * y + z * z)
    return distance, math.atan2(y, x), math.asin(z / distance)


def to_sensor(point, origin, heading):
    """A world point in the sensor's frame."""
    x, y, z = (p - o for p, o in zip(point, origin))
    cos, sin = math.cos(heading), math.sin(heading)
    return cos * x + sin * y, cos * y - sin * x, z


def box_distance(origin, ray, box):
    """Where a ray enters a box, infinity if it misses."""
    enter, leave = 0.0, math.inf
    for o, d, low, high in zip(origin, ray, *box):
        if abs(d) < 1e-12:
            if not low <= o <= high:
                return math.inf
            continue
        near, far = sorted(((low - o) / d, (high - o) / d))
        enter, leave = max(enter, near), min(leave, far)
    return enter if 0.0 < enter <= leave else math.inf


def cast(origin, ray):
    """Distance along a ray to the first surface, and whether that is the road."""
    road = -origin[2] / ray[2] if ray[2] < 0.0 else math.inf
    box = min(box_distance(origin, ray, box) for box in BOXES)
    return (road, True) if road < box else (box, False)


def lidar_scan(rng, t_ns):
    """One revolution as rows x, y, z, intensity, as if all rays were sent at once."""
    origin, heading = sensor_pose(t_ns, LIDAR["at"])
    rows = []
    for beam in range(24):
        elevation = math.radians(-LIDAR["lowest"] + beam * 30.0 / 23)
        for step in range(180):
            azimuth = math.radians(2.0 * step)
            distance, is_road = cast(origin, direction(azimuth + heading, elevation))
            if distance < LIDAR["range"]:
                distance += rng.gauss(0.0, LIDAR["sigma_range"])
                point = (distance * d for d in direction(azimuth, elevation))
                rows.append((*point, 0.2 if is_road else 0.6))
    return rows


def seen_objects(rng, radar, origin, heading, rays):
    """Points (sensor frame) on boxes that rays within the field of view meet."""
    half_azimuth, half_elevation = (math.radians(angle / 2) for angle in radar["fov"])
    points = []
    for _ in range(rays):
        azimuth = rng.uniform(-half_azimuth, half_azimuth)
        elevation = rng.uniform(-half_elevation / 2, half_elevation)
        distance, is_road = cast(origin, direction(azimuth + heading, elevation))
        if distance < 50.0 and not is_road:
            points.append(tuple(distance * d for d in direction(azimuth, elevation)))
    return points


def road_clutter(rng, radar, origin):
    """A point on the road before the radar."""
    azimuth = math.radians(rng.uniform(-0.4, 0.4) * radar["fov"][0])
    distance = rng.uniform(4.0, 15.0)
    return distance * math.cos(azimuth), distance * math.sin(azimuth), -origin[2]


def mirror_images(radar, points, origin, heading):
    """Points as seen in the wall: they appear well behind it, within the field of view."""
    for x, y, z in points:
        cos, sin = math.cos(heading), math.sin(heading)
        world = origin[0] + cos * x - sin * y, 2.0 * WALL_Y - (origin[1] + sin * x + cos * y), origin[2] + z
        image = to_sensor(world, origin, heading)
        if world[1] > WALL_Y + 1.4 and abs(math.atan2(image[1], image[0])) < math.radians(radar["fov"][0] / 2):
            yield image


def noise(rng, radar, origin, heading):
    """A point in the air, 2 m or more from everything."""
    while True:
        azimuth, elevation = (math.radians(rng.uniform(-0.5, 0.5) * angle) for angle in radar["fov"])
        distance = rng.uniform(3.0, 45.0)
        world = [o + distance * d for o, d in zip(origin, direction(azimuth + heading, elevation))]
        apart = min(math.dist(world, [max(a, min(w, b)) for a, w, b in zip(low, world, high)]) for low, high in BOXES)
        if apart > 2.0 and world[2] > 0.0:
            return tuple(distance * d for d in direction(azimuth, elevation))


def radar_scan(rng, radar, t_ns):
    """Rows in the order of the radar's fields, and the truth of each."""
    origin, heading = sensor_pose(t_ns, radar["at"], radar["yaw"])
    objects = seen_objects(rng, radar, origin, heading, 40)
    artifacts = [road_clutter(rng, radar, origin) for _ in range(5)]
    artifacts += list(mirror_images(radar, objects, origin, heading))[:4]
    artifacts += [noise(rng, radar, origin, heading) for _ in range(6)]
    found = [(point, PLAUSIBLE) for point in objects] + [(point, ARTIFACT) for point in artifacts]
    rng.shuffle(found)
    rows = [measured(rng, radar, point, truth) for point, truth in found]
    return rows, [truth for _, truth in found]


def measured(rng, radar, point, truth):
    """A row of a scan: the point with the radar's uncertainties, range rate and strength."""
    distance, azimuth, elevation = to_spherical(point)
    sigma_range, sigma_azimuth, sigma_elevation = radar["sigma"]
    # The vehicle's velocity along the ray, and that of the mounting as the vehicle turns.
    forward, left = SPEED - YAW_RATE * radar["at"][1], YAW_RATE * radar["at"][0]
    bearing = azimuth + radar["yaw"]
    doppler = -(forward * math.cos(bearing) + left * math.sin(bearing)) * math.cos(elevation) + rng.gauss(0.0, 0.05)
    distance = max(0.1, distance + rng.gauss(0.0, sigma_range))
    azimuth += math.radians(rng.gauss(0.0, sigma_azimuth))
    elevation += math.radians(rng.gauss(0.0, sigma_elevation))
    rcs = rng.gauss(8.0 if truth == PLAUSIBLE else 0.0, 5.0)
    if radar["measures_elevation"]:
        return (*(distance * d for d in direction(azimuth, elevation)), doppler, rcs)
    return distance, azimuth, doppler, rcs


def sequence_toml():
    text = 'format = 1\nname = "tiny: parked cars, poles and a wall"\n'
    for radar in RADARS:
        sigma_range, sigma_azimuth, sigma_elevation = radar["sigma"]
        half = radar["yaw"] / 2
        elevation = "measured" if radar["measures_elevation"] else "none"
        text += f"""
[[radar]]
name = "{radar['name']}"
fields = [{', '.join(f'"{field}"' for field in radar['fields'])}]
translation = {list(radar['at'])}
quaternion_xyzw = [0.0, 0.0, {math.sin(half):.9f}, {math.cos(half):.9f}]
elevation = "{elevation}"
fov_azimuth_deg = {radar['fov'][0]}
fov_elevation_deg = {radar['fov'][1]}
sigma_range_m = {sigma_range}
sigma_azimuth_deg = {sigma_azimuth}
"""
        if radar["measures_elevation"]:
            text += f"sigma_elevation_deg = {sigma_elevation}\n"
    return text + f"""
[[lidar]]
name = "{LIDAR['name']}"
translation = {list(LIDAR['at'])}
quaternion_xyzw = [0.0, 0.0, 0.0, 1.0]
sigma_range_m = {LIDAR['sigma_range']}
lowest_beam_deg = {LIDAR['lowest']}
max_range_m = {LIDAR['range']}
"""


def write(file, content):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(content if isinstance(content, bytes) else content.encode())


def floats(rows):
    return b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)


def timestamps(times):
    return "".join(f"{t_ns}\n" for t_ns in times)


def write_sequence(folder, rng):
    write(folder / "sequence.toml", sequence_toml())
    rows = (f"{t_ns},{SPEED},{YAW_RATE}\n" for t_ns in range(0, END_NS + 1, ODOMETRY_PERIOD_NS))
    write(folder / "odometry.csv", "t_ns,v_mps,yaw_rate_radps\n" + "".join(rows))
    times = range(0, END_NS + 1, LIDAR_PERIOD_NS)
    write(folder / LIDAR["name"] / "timestamps.txt", timestamps(times))
    for number, t_ns in enumerate(times):
        write(folder / LIDAR["name"] / f"{number:06}.bin", floats(lidar_scan(rng, t_ns)))
    for radar in RADARS:
        times = [radar["start_ns"] + scan * RADAR_PERIOD_NS for scan in range(SCANS)]
        write(folder / radar["name"] / "timestamps.txt", timestamps(times))
        for number, t_ns in enumerate(times):
            rows, truth = radar_scan(rng, radar, t_ns)
            write(folder / radar["name"] / f"{number:06}.bin", floats(rows))
            labels = struct.pack(f"<{len(truth)}I", *truth)
            write(folder / "ground_truth" / radar["name"] / f"{number:06}.label", labels)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="folder of the dataset")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    write_sequence(arguments.out / "sequences" / "00", random.Random(arguments.seed))


if __name__ == "__main__":
    main()
