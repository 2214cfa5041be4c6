"""RALF: trustworthy labels for radar data.

    run = ralf.label("recordings/city", "out")
    run["00"]                                # an Arrow table of all detections
    for scan in run.scans("00"):             # NumPy views
        scan.xyz[scan.label == 1]

Whatever is wrong with a file is a `RalfError` that names the file, the place in it, what was expected and what was
found.
"""

from ralf._ralf import RalfError, Table
from ralf.judging import Evaluation, Picture, Truth, evaluate, plot
from ralf.many import Assembled, Task, assemble, label_one, plan
from ralf.memory import Labels, Sequence
from ralf.recording import Image, LidarScan, RadarScan, Recording, SequenceInfo, open  # noqa: A004
from ralf.run import Run, Scan, label, load
from ralf.sensors import Camera, KannalaBrandt, Lidar, Odometry, Pinhole, Poses, Radar, Scaramuzza, View

__all__ = [
    "Assembled",
    "Camera",
    "Evaluation",
    "Image",
    "KannalaBrandt",
    "Labels",
    "Lidar",
    "LidarScan",
    "Odometry",
    "Picture",
    "Pinhole",
    "Poses",
    "Radar",
    "RadarScan",
    "RalfError",
    "Recording",
    "Run",
    "Scan",
    "Scaramuzza",
    "Sequence",
    "SequenceInfo",
    "Table",
    "Task",
    "Truth",
    "View",
    "assemble",
    "evaluate",
    "label",
    "label_one",
    "load",
    "open",
    "plan",
    "plot",
]
