"""Parts on several machines make what one makes."""

import json
import pickle
import shutil
from concurrent.futures import ProcessPoolExecutor

import pytest
from conftest import tree

import ralf


def test_three_plain_functions_make_what_one_call_makes(drive, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(drive, other)
    damaged = tmp_path / "damaged"
    (damaged / "sequences/00").mkdir(parents=True)
    (damaged / "sequences/00/sequence.toml").write_text("[[")
    out = tmp_path / "out"
    plan = ralf.plan([drive, damaged, other], out, scans=6)
    assert list(plan.failed) == ["damaged"]
    assert "sequence.toml" in plan.failed["damaged"]
    assert len(plan) > 4
    tasks = pickle.loads(pickle.dumps(plan.tasks))
    assert tasks[0].name == f"drive/{ralf.open(drive).sequences[0]} 1 of {len(plan) // 2}"
    with ProcessPoolExecutor(2) as pool:
        assert list(pool.map(ralf.label_one, tasks)) == [[]] * len(tasks)
    done = ralf.assemble(out)
    assert list(done.failed) == ["damaged"]
    assert done.failed["damaged"] == plan.failed["damaged"]
    assert sorted(done.runs) == ["drive", "other"]
    for name, recording in (("drive", drive), ("other", other)):
        whole = ralf.label(recording, tmp_path / "whole" / name)
        assert tree(done.runs[name].out) == tree(whole.out)
        assert done.runs[name].recording == recording
    assert list(ralf.plan([drive, other], out, scans=6)) == []


def test_a_plan_takes_segmentations_as_the_command_does(cli, tmp_path):
    import pyarrow as pa

    drive, classes = tmp_path / "drive", tmp_path / "classes"
    cli("simulate", "--preset", "tiny", "--scans", 2, "--segmentation", "-o", drive)
    for stored in drive.glob("sequences/*/*/segmentation"):
        there = classes / stored.relative_to(drive)
        there.parent.mkdir(parents=True)
        stored.rename(there)
    (classes / "segmentation.toml").write_text('network = "a"\n')
    cli("cluster", "plan", drive, "--segmentation", classes, "-o", tmp_path / "command")
    plan = ralf.plan([drive], tmp_path / "out", segmentation=classes)
    planned = [json.loads((tmp_path / name / "drive/plan.json").read_text()) for name in ("command", "out")]
    for told in planned:
        del told["out"]
    assert planned[0] == planned[1]
    for task in plan:
        assert ralf.label_one(task) == []
    labelled = ralf.assemble(tmp_path / "out").runs["drive"]
    table = pa.table(labelled["tiny"])
    assert "camera" in table["class_from"].to_pylist()
    whole = ralf.label(drive, tmp_path / "whole", segmentation=classes)
    assert tree(whole.out) == tree(labelled.out)
    assert "class_from" not in ralf.label(drive, tmp_path / "without")["tiny"].columns


def test_labels_of_other_settings_that_are_removed_are_a_warning(drive, tmp_path):
    ralf.label(drive, tmp_path / "drive")
    removed = r"drive: removed, for they were made .* with other settings: "
    with pytest.warns(UserWarning, match=removed):
        tasks = ralf.plan([drive], tmp_path, settings={"lidar.beta": 0.5}, scans=6)
    assert len(tasks) > 1
    ralf.label_one(tasks[0])
    with pytest.warns(UserWarning, match=removed + "what was labelled so far of"):
        ralf.plan([drive], tmp_path)


def test_two_recordings_of_one_name_are_refused(drive, tmp_path):
    with pytest.raises(ralf.RalfError, match="expected names of recordings that differ"):
        ralf.plan([drive, drive], tmp_path)


def test_a_trajectory_of_several_recordings_and_a_place_among_measurements_are_refused(drive, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(drive, other)
    before = tree(other)
    with pytest.raises(ValueError, match=r"motion\.trajectory: expected one recording, .* found 2"):
        ralf.plan([drive, other], tmp_path / "out", settings={"motion.trajectory": "poses.tum"})
    with pytest.raises(ralf.RalfError, match="output"):
        ralf.plan([drive], other / "sequences")
    assert not (tmp_path / "out").exists()
    assert tree(other) == before


def test_a_task_of_another_plan_is_refused(drive, tmp_path):
    task = ralf.plan([drive], tmp_path / "a")[0]
    shutil.rmtree(tmp_path / "a")
    with pytest.raises(ralf.RalfError, match="plan again") as raised:
        ralf.label_one(task)
    assert raised.value.place.startswith("stretch 0")
