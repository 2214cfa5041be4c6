#!/usr/bin/env python3
"""Writes testdata/ros: the same few messages as bags, MCAP files and ROS 2 folders, by other programs than ours.

    pip install -r testdata/requirements.txt
    python3 testdata/make_ros.py

crates/ralf-ros/tests/all/fixtures.rs knows what is in there. Clouds have padding of 0xEE, mixed types, fields out of order; the
second one is in big endian.
"""

import shutil
import struct
from pathlib import Path

import numpy as np
from mcap.writer import CompressionType, Writer as McapWriter
from rosbags.rosbag1 import Writer as Rosbag1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer as Rosbag2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

OUT = Path(__file__).parent / "ros"
START = 1_500_000_000_000_000_000
STEP = 77_000_000

RADAR = {
    "radar_msgs/msg/RadarScan": "std_msgs/Header header\nradar_msgs/RadarReturn[] returns\n",
    "radar_msgs/msg/RadarReturn": "float32 range\nfloat32 azimuth\nfloat32 elevation\nfloat32 doppler_velocity\n"
    "float32 amplitude\n",
}
TF = {
    "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
}


def store(kind):
    types = get_typestore(kind)
    for name, text in {**RADAR, **TF}.items():
        if name not in types.types:
            types.register(get_types_from_msg(text, name))
    return types


class Messages:
    """One of each type, for ROS 1 (headers with seq) or ROS 2."""

    def __init__(self, types, ros1):
        self.types, self.ros1 = types.types, ros1

    def make(self, name, *values):
        return self.types[name](*values)

    def header(self, t_ns, frame):
        stamp = self.make("builtin_interfaces/msg/Time", t_ns // 10**9, t_ns % 10**9)
        return self.make("std_msgs/msg/Header", *([7] if self.ros1 else []), stamp, frame)

    def vector(self, *xyz):
        return self.make("geometry_msgs/msg/Vector3", *xyz)

    def cloud(self, k):
        order = "><"[k != 1]
        field = lambda *values: self.make("sensor_msgs/msg/PointField", *values)
        fields = [
            field("rcs", 16, 7, 1),
            field("x", 0, 7, 1),
            field("y", 4, 7, 1),
            field("z", 8, 8, 1),
            field("invalid_state", 20, 2, 1),
            field("ring", 22, 4, 1),
        ]
        records = b""
        for i in range(2):
            record = bytearray(b"\xee" * 28)
            struct.pack_into(order + "ffd", record, 0, 10.5 + i, -2.25 - k, 0.125)
            struct.pack_into(order + "f", record, 16, 3.5)
            struct.pack_into(order + "B", record, 20, 200 + i)
            struct.pack_into(order + "H", record, 22, 60000 + i)
            records += bytes(record)
        data = np.frombuffer(records, dtype=np.uint8)
        head = self.header(START + k * STEP, "radar")
        return self.make("sensor_msgs/msg/PointCloud2", head, 1, 2, fields, order == ">", 28, 56, data, True)

    def all(self):
        """Topic, type, log time, message; the clouds are recorded out of order."""
        head = lambda frame: self.header(START, frame)
        zeros = lambda n: np.zeros(n)
        quaternion = self.make("geometry_msgs/msg/Quaternion", 0.0, 0.0, 0.0, 1.0)
        twist = self.make("geometry_msgs/msg/Twist", self.vector(8.0, 0.0, 0.0), self.vector(0.0, 0.0, 0.25))
        transform = self.make("geometry_msgs/msg/Transform", self.vector(3.5, 0.25, 0.5), quaternion)
        stamped = self.make("geometry_msgs/msg/TransformStamped", head("base_link"), "radar", transform)
        pose = self.make("geometry_msgs/msg/Pose", self.make("geometry_msgs/msg/Point", 1.0, 2.0, 3.0), quaternion)
        pose = self.make("geometry_msgs/msg/PoseWithCovariance", pose, zeros(36))
        moving = self.make("geometry_msgs/msg/TwistWithCovariance", twist, zeros(36))
        roi = self.make("sensor_msgs/msg/RegionOfInterest", 0, 0, 0, 0, False)
        k = np.array([500.0, 0, 320, 0, 510, 240, 0, 0, 1])
        p = np.array([500.0, 0, 320, 0, 0, 510, 240, 0, 0, 0, 1, 0])
        info = (head("cam"), 480, 640, "plumb_bob", np.array([0.1, 0.2, 0.3, 0.4, 0.5]), k, np.eye(3).ravel(), p, 0, 0, roi)
        turning = (quaternion, zeros(9), self.vector(0.0, 0.0, 0.5), zeros(9), self.vector(0.0, 0.0, 9.81), zeros(9))
        detection = self.make("radar_msgs/msg/RadarReturn", 20.0, 0.5, 0.25, -3.0, 12.0)
        pixels = np.arange(6, dtype=np.uint8)
        return [
            ("/tf_static", "tf2_msgs/msg/TFMessage", 0, self.make("tf2_msgs/msg/TFMessage", [stamped])),
            ("/radar/points", "sensor_msgs/msg/PointCloud2", 1, self.cloud(1)),
            ("/radar/points", "sensor_msgs/msg/PointCloud2", 2, self.cloud(0)),
            ("/radar/points", "sensor_msgs/msg/PointCloud2", 3, self.cloud(2)),
            ("/odom", "nav_msgs/msg/Odometry", 4, self.make("nav_msgs/msg/Odometry", head("odom"), "base_link", pose, moving)),
            ("/twist", "geometry_msgs/msg/TwistStamped", 5, self.make("geometry_msgs/msg/TwistStamped", head("base_link"), twist)),
            ("/imu", "sensor_msgs/msg/Imu", 6, self.make("sensor_msgs/msg/Imu", head("imu"), *turning)),
            ("/scan", "radar_msgs/msg/RadarScan", 7, self.make("radar_msgs/msg/RadarScan", head("radar"), [detection])),
            ("/cam/camera_info", "sensor_msgs/msg/CameraInfo", 8, self.make("sensor_msgs/msg/CameraInfo", *info)),
            ("/cam/image_raw", "sensor_msgs/msg/Image", 9, self.make("sensor_msgs/msg/Image", head("cam"), 1, 2, "rgb8", 0, 6, pixels)),
            ("/cam/image_raw/compressed", "sensor_msgs/msg/CompressedImage", 10, self.make("sensor_msgs/msg/CompressedImage", head("cam"), "jpeg", pixels)),
        ]


def bag(name, compression):
    types = store(Stores.ROS1_NOETIC)
    writer = Rosbag1Writer(OUT / name)
    if compression:
        writer.set_compression(Rosbag1Writer.CompressionFormat[compression])
    with writer:
        connections = {}
        for topic, kind, step, message in Messages(types, True).all():
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            writer.write(connections[topic], START + step * STEP, types.serialize_ros1(message, kind))


def mcap(name, compression, ros1=False):
    types = store(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    with open(OUT / name, "wb") as file:
        writer = McapWriter(file, compression=compression, chunk_size=1500)
        writer.start(profile="ros1" if ros1 else "ros2", library="make_ros.py")
        channels = {}
        for number, (topic, kind, step, message) in enumerate(Messages(types, ros1).all()):
            if topic not in channels:
                spelled = kind.replace("/msg/", "/") if ros1 else kind
                definition, _ = types.generate_msgdef(kind, ros_version=1 if ros1 else 2)
                schema = writer.register_schema(spelled, "ros1msg" if ros1 else "ros2msg", definition.encode())
                channels[topic] = writer.register_channel(topic, "ros1" if ros1 else "cdr", schema)
            # Every second message in big endian, which ROS 2 may write.
            data = types.serialize_ros1(message, kind) if ros1 else types.serialize_cdr(message, kind, little_endian=number % 2 == 0)
            writer.add_message(channels[topic], START + step * STEP, bytes(data), START + step * STEP)
        writer.finish()


def folder(name, plugin, compressed=False):
    types = store(Stores.ROS2_HUMBLE)
    shutil.rmtree(OUT / name, ignore_errors=True)
    writer = Rosbag2Writer(OUT / name, version=8, storage_plugin=plugin)
    if compressed:
        writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    with writer:
        connections = {}
        for topic, kind, step, message in Messages(types, False).all():
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            writer.write(connections[topic], START + step * STEP, types.serialize_cdr(message, kind))


if __name__ == "__main__":
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir()
    bag("plain.bag", None)
    bag("bz2.bag", "BZ2")
    bag("lz4.bag", "LZ4")
    mcap("plain.mcap", CompressionType.NONE)
    mcap("lz4.mcap", CompressionType.LZ4)
    mcap("zstd.mcap", CompressionType.ZSTD)
    mcap("ros1.mcap", CompressionType.ZSTD, ros1=True)
    folder("db3", StoragePlugin.SQLITE3)
    folder("db3_zstd", StoragePlugin.SQLITE3, compressed=True)
    folder("folder", StoragePlugin.MCAP)
