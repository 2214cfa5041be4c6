"""What speaks against labels is told beside them, in few warnings, as the command tells it."""

import re
import shutil
import subprocess
import warnings

import numpy as np
import pytest

import ralf
from ralf._told import SHOWN, bounded

HOUR_NS = 3_600_000_000_000


@pytest.fixture
def damaged(drive, tmp_path):
    """The simulated recording with all LiDAR files cut and an odometry that is an hour late."""
    folder = tmp_path / "damaged"
    shutil.copytree(drive, folder)
    for file in folder.glob("sequences/*/lidar*/*.bin"):
        file.write_bytes(file.read_bytes()[:1001])
    (odometry,) = folder.glob("sequences/*/odometry.csv")
    head, *rows = odometry.read_text().splitlines()
    late = [f"{int(t_ns) + HOUR_NS},{rest}" for t_ns, _, rest in (row.partition(",") for row in rows)]
    odometry.write_text("\n".join([head, *late]) + "\n")
    return folder


def heard(call):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = call()
    return result, [str(warning.message) for warning in caught]


def test_a_run_tells_what_the_command_tells(damaged, command, tmp_path):
    run, told = heard(lambda: ralf.label(damaged, tmp_path / "python"))
    done = subprocess.run(
        [*command, "label", damaged, "-o", tmp_path / "command"], capture_output=True, text=True, check=True
    )
    (name,) = run.sequences
    assert [(sequence, lidar) for sequence, lidar, _, _ in run.labelled_without] == [(name, "lidar_top")] * len(
        run.labelled_without
    )
    said = done.stderr.splitlines()
    without = [f"labelled without: {name} {lidar} scan {n}: {why}" for name, lidar, n, why in run.labelled_without]
    assert without and without == [line for line in said if line.startswith("labelled without: ")]
    assert [f"warning: {warning}" for warning in run.warnings] == [line for line in said if line.startswith("warning")]
    doubts = [line.removeprefix("doubt: ") for line in said if line.startswith("doubt: ")]
    assert [f"{name}: {subject} {what}" for name, subject, what in run.doubts] == doubts
    assert any("by up to 360" in warning for warning in run.warnings)
    # A sentence of each, whatever their number.
    [counted] = [warning for warning in told if warning.startswith("labelled without")]
    _, lidar, first, why = run.labelled_without[0]
    others = len(run.labelled_without) - 1
    assert re.fullmatch(rf"labelled without: {name} {lidar} {first} and {others} others?: {re.escape(why)}", counted)
    assert {f"doubt: {': '.join(doubt)}" for doubt in run.doubts} < set(told)
    assert set(run.warnings) < set(told)
    # What lies in a folder tells it again, but for what readers said.
    again = ralf.load(run.out)
    assert (again.labelled_without, again.doubts) == (run.labelled_without, run.doubts)


def test_parts_that_are_put_together_tell_it_too(damaged, tmp_path):
    for task in ralf.plan([damaged], tmp_path / "out"):
        ralf.label_one(task)
    done, told = heard(lambda: ralf.assemble(tmp_path / "out"))
    assert done.runs["damaged"].labelled_without
    for what in ("labelled without: ", "doubt: "):
        assert any(warning.startswith(f"damaged: {what}") for warning in told), what
    assert all(f"damaged: {warning}" in told for warning in done.runs["damaged"].warnings)


def test_scans_that_cannot_be_labelled_are_one_warning(drive, tmp_path):
    folder = tmp_path / "damaged"
    shutil.copytree(drive, folder)
    files = sorted(folder.glob("sequences/*/radar*/*.bin"))
    radar = files[0].parent
    for file in radar.glob("*.bin"):
        file.write_bytes(file.read_bytes()[:-1])
    run, told = heard(lambda: ralf.label(folder, tmp_path / "out"))
    scans = len(list(radar.glob("*.bin")))
    assert len(run.not_labelled) == scans
    [counted] = [warning for warning in told if warning.startswith("not labelled")]
    assert f"{radar.name} 0 and {scans - 1} others: " in counted


def test_what_was_warned_of_when_it_was_opened_is_not_said_twice(tmp_path, drive, cli):
    bag = tmp_path / "drive.mcap"
    cli("convert", drive, "-o", bag, "--quiet")
    recording, opened = heard(lambda: ralf.open(bag))
    assert opened == recording.warnings != []
    run, told = heard(lambda: ralf.label(recording, tmp_path / "out"))
    assert set(recording.warnings) <= set(run.warnings)
    assert not set(opened) & set(told)


def test_a_sequence_in_memory_tells_it_too(tmp_path):
    sequence = ralf.Sequence(
        [ralf.Radar("front", (3.5, 0.0, 0.5))],
        [ralf.Lidar("top", (1.0, 0.0, 1.8))],
        ralf.Odometry([0, 1_000_000_000], [10.0, 10.0], [0.0, 0.0]),
    )
    sequence.add_radar_scan("front", HOUR_NS, xyz=np.ones((3, 3)) * 5)
    sequence.add_lidar_scan("top", HOUR_NS, [])
    labels, told = heard(sequence.label)
    assert [(subject, "nothing came back" in what) for _, subject, what in labels.doubts] == [
        ("motion", False),
        ("top", True),
    ]
    assert labels.labelled_without == [("00", "top", 0, "expected returns, found none")]
    [warning] = labels.warnings
    assert "before or after all samples of the odometry, by up to 3599.0 s" in warning
    assert told == [
        warning,
        *(f"doubt: {': '.join(doubt)}" for doubt in labels.doubts),
        "labelled without: 00 top 0: expected returns, found none",
    ]
    assert sequence.label(check=False).doubts == []
    sequence.write(tmp_path / "drive")
    run = ralf.label(tmp_path / "drive", tmp_path / "out")
    assert (run.warnings, run.doubts) == (labels.warnings, labels.doubts)
    assert run.labelled_without == labels.labelled_without


def test_of_many_warnings_the_first_are_given():
    sentences = [str(n) for n in range(SHOWN + 3)]
    assert bounded(sentences[:SHOWN], "doubts") == sentences[:SHOWN]
    assert bounded(sentences, "doubts") == [*sentences[:SHOWN], "and 3 more like these: `doubts` has them all"]
