#!/usr/bin/env python3
"""Reads what `ralf export` wrote with other people's packages, and prints what it holds as one JSON object.

    read_export.py FORMAT PATH

FORMAT is as `--to` takes it. `rows` has one entry per detection: sequence, radar, scan (or t_ns), point and every value.
What a package finds wrong is an error. SemanticKITTI's own tools are no package: their reading is worked out here after
what they do (float32 rows of four; uint32 labels, class in the lower half; as many labels as points).
"""

import csv
import json
import math
import sys
from pathlib import Path


def plain(value):
    """A value that JSON can hold; NaN is absent."""
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and math.isnan(value) else value


def table(columns, **more):
    """Rows from columns of equal length."""
    names = list(columns)
    lists = [columns[name].tolist() for name in names]
    assert len({len(values) for values in lists}) <= 1, "columns of different lengths"
    return [more | {name: plain(value) for name, value in zip(names, values)} for values in zip(*lists)]


def scans(path, extension):
    """Sequence, radar, number and file of each scan."""
    for file in sorted(path.glob(f"sequences/*/*/*.{extension}")):
        yield file.parts[-3], file.parts[-2], int(file.stem), file


def npz(path):
    import numpy

    rows, types = [], {}
    for sequence, radar, _, file in scans(path, "npz"):
        with numpy.load(file, allow_pickle=False) as archive:
            columns = {name: archive[name] for name in archive.files}
        types |= {name: str(values.dtype) for name, values in columns.items()}
        rows += table(columns, sequence=sequence, radar=radar)
    return {"rows": rows, "types": types}


def pcd(path):
    from pypcd4 import PointCloud

    rows, types, viewpoints = [], {}, {}
    for sequence, radar, scan, file in scans(path, "pcd"):
        cloud = PointCloud.from_path(file)
        types |= {name: str(cloud.pc_data[name].dtype) for name in cloud.fields}
        viewpoints[radar] = list(cloud.metadata.viewpoint)
        columns = {name: cloud.pc_data[name] for name in cloud.fields}
        rows += table(columns, sequence=sequence, radar=radar, scan=scan)
    return {"rows": rows, "types": types, "viewpoints": viewpoints}


def parquet(path):
    import pyarrow
    import pyarrow.dataset

    names = pyarrow.schema([("sequence", pyarrow.string())])
    by_sequence = pyarrow.dataset.partitioning(names, flavor="hive")
    found = pyarrow.dataset.dataset(path, format="parquet", partitioning=by_sequence)
    types = {field.name: str(field.type) + ("" if field.nullable else " not null") for field in found.schema}
    return {"rows": found.to_table().to_pylist(), "types": types}


def semantickitti(path):
    import numpy

    with open(path / "sequences.csv", newline="") as file:
        known = {row["number"]: row for row in csv.DictReader(file)}
    rows, files = [], {}
    for number, row in known.items():
        folder = path / "sequences" / number
        labels = sorted((folder / "labels").iterdir())
        clouds = sorted((folder / "velodyne").iterdir()) if (folder / "velodyne").is_dir() else []
        assert [file.name for file in labels] == [f"{scan:06}.label" for scan in range(int(row["scans"]))]
        assert not clouds or [file.stem for file in clouds] == [file.stem for file in labels]
        for scan, file in enumerate(labels):
            values = numpy.fromfile(file, dtype=numpy.uint32)
            columns = {"label": values & 0xFFFF, "instance": values >> 16}
            if clouds:
                cloud = numpy.fromfile(clouds[scan], dtype=numpy.float32).reshape((-1, 4))
                assert len(cloud) == len(values), "Scan and Label don't contain same number of points"
                columns |= dict(zip(["x", "y", "z", "intensity"], cloud.T))
            points = folder / "points" / f"{scan:06}.npy"
            columns["point"] = numpy.load(points) if points.exists() else numpy.arange(len(values))
            rows += table(columns, sequence=row["sequence"], radar=row["radar"], scan=scan)
        if clouds:
            poses = [[float(v) for v in line.split()] for line in open(folder / "poses.txt")]
            calib = [line.split() for line in open(folder / "calib.txt")]
            times = [float(line) for line in open(folder / "times.txt")]
            assert len(poses) == len(times) == len(labels) and all(len(pose) == 12 for pose in poses)
            files[number] = {"poses": poses, "times": times, "Tr": [float(v) for v in calib[0][1:]]}
    return {"rows": rows, "files": files}


def nuscenes(path):
    import numpy

    rows, classes = [], {}
    for table_file in sorted(path.glob("*/radarseg.json")):
        categories = json.loads((table_file.parent / "radarseg_category.json").read_text())
        classes = {category["index"]: category for category in categories}
        for entry in json.loads(table_file.read_text()):
            assert entry["filename"] == f"radarseg/{table_file.parent.name}/{entry['token']}_radarseg.bin"
            values = numpy.fromfile(path / entry["filename"], dtype=numpy.uint8)
            columns = {"point": numpy.arange(len(values)), "index": values}
            rows += table(columns, token=entry["sample_data_token"])
    return {"rows": rows, "classes": classes}


def cloud_columns(message):
    """The columns of a PointCloud2 by its fields."""
    import numpy

    kinds = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
    fields = message.fields
    kind = numpy.dtype({
        "names": [field.name for field in fields],
        "formats": [("<", ">")[message.is_bigendian] + kinds[field.datatype] for field in fields],
        "offsets": [field.offset for field in fields],
        "itemsize": message.point_step,
    })
    data = bytes(message.data)
    assert len(data) == message.height * message.row_step and message.row_step == message.width * message.point_step
    values = numpy.frombuffer(data, dtype=kind)
    return {name: values[name] for name in kind.names}


def nanoseconds(stamp):
    return stamp.sec * 10**9 + (stamp.nanosec if hasattr(stamp, "nanosec") else stamp.nsec)


class Recording:
    """Collects messages, whichever package decoded them."""

    def __init__(self):
        self.rows, self.topics, self.types, self.frames, self.mounted = [], {}, {}, {}, {}
        self.images, self.calibrations, self.twists, self.positions = {}, {}, [], []
        self.latest = None

    def add(self, sequence, topic, kind, log_ns, message):
        assert self.latest is None or log_ns >= self.latest, "messages out of order"
        self.latest = log_ns
        self.topics.setdefault(topic, [kind, 0])[1] += 1
        parts = topic.strip("/").split("/")
        if kind.endswith("TFMessage"):
            for transform in message.transforms:
                place, turn = transform.transform.translation, transform.transform.rotation
                if topic == "/tf_static":
                    values = [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]
                    self.mounted[transform.child_frame_id] = [transform.header.frame_id, values]
            return
        stamp = nanoseconds(message.header.stamp)
        assert stamp == log_ns, "a stamp that is not the log time"
        self.frames[topic] = message.header.frame_id
        if kind.endswith("PointCloud2"):
            columns = cloud_columns(message)
            self.types |= {f"{parts[1]}/{name}": str(values.dtype) for name, values in columns.items()}
            self.rows += table(columns, sequence=sequence, sensor=parts[0], topic=parts[1], t_ns=stamp)
        elif kind.endswith("CompressedImage"):
            data = bytes(message.data)
            self.images.setdefault(parts[0], []).append([stamp, message.format, len(data), sum(data)])
        elif kind.endswith("CameraInfo"):
            k, d = (message.k, message.d) if hasattr(message, "k") else (message.K, message.D)
            self.calibrations[parts[0]] = [message.distortion_model, message.width, message.height, list(k), list(d)]
        elif kind.endswith("TwistStamped"):
            self.twists.append([stamp, message.twist.linear.x, message.twist.angular.z])
        elif kind.endswith("Odometry"):
            self.positions.append([stamp, message.pose.pose.position.x, message.pose.pose.position.y])

    def found(self):
        return vars(self)


def files(path, extension):
    return [path] if path.is_file() else sorted(path.glob(f"*.{extension}"))


def with_mcap(path):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    found = Recording()
    for file in files(path, "mcap"):
        found.latest = None
        with open(file, "rb") as stream:
            reader = make_reader(stream, decoder_factories=[DecoderFactory()], validate_crcs=True)
            assert reader.get_header().profile == "ros2"
            for schema, channel, message, decoded in reader.iter_decoded_messages():
                found.add(file.stem, channel.topic, schema.name, message.log_time, decoded)
            counts = reader.get_summary().statistics.channel_message_counts
            assert sum(counts.values()) >= 1
    return found.found()


def with_rosbags(path, extension):
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    found = Recording()
    store = get_typestore(Stores.ROS1_NOETIC if extension == "bag" else Stores.ROS2_HUMBLE)
    for file in files(path, extension):
        found.latest = None
        with AnyReader([file], default_typestore=store) as reader:
            for connection, log_ns, raw in reader.messages():
                message = reader.deserialize(raw, connection.msgtype)
                found.add(file.stem, connection.topic, connection.msgtype, log_ns, message)
    return found.found()


def mcap(path):
    with_both = [with_mcap(path), with_rosbags(path, "mcap")]
    first, second = (json.dumps(found, default=plain, sort_keys=True) for found in with_both)
    assert first == second, "mcap and rosbags read different things"
    return with_both[0]


def rosbag1(path):
    return with_rosbags(path, "bag")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    read = {f.__name__: f for f in (npz, pcd, parquet, semantickitti, nuscenes, mcap, rosbag1)}[sys.argv[1]]
    json.dump(read(Path(sys.argv[2])), sys.stdout, default=plain)
