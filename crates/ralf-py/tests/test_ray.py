"""Labelling on a cluster of one node, where Ray is at hand."""

import os
import shutil
import sys
import warnings

import pytest
from conftest import tree

import ralf

ray = pytest.importorskip("ray")
import ralf.ray  # noqa: E402


@pytest.fixture(scope="module")
def cluster():
    """A node whose workers import what the tests import, from a folder of their own."""
    paths = os.pathsep.join(path for path in sys.path if path)
    ray.init(num_cpus=2, log_to_driver=False, include_dashboard=False, runtime_env={"env_vars": {"PYTHONPATH": paths}})
    yield
    ray.shutdown()


@pytest.fixture
def nothing_started(monkeypatch):
    """The cluster must not be asked for anything."""

    def refuse(*_, **__):
        raise AssertionError("the cluster was asked for something")

    monkeypatch.setattr(ray, "init", refuse)
    monkeypatch.setattr(ray, "is_initialized", lambda: False)


def label(recordings, out, **options):
    """The results, and what was warned of that isn't Ray's own."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UserWarning)
        done = ralf.ray.label(recordings, out, progress=False, **options)
    own = [warning for warning in caught if warning.category is UserWarning and warning.filename == __file__]
    return done, [str(warning.message) for warning in own]


def copy_of(drive, folder):
    shutil.copytree(drive, folder)
    return folder


def test_two_recordings_of_one_name_are_refused_before_any_work(nothing_started, drive, tmp_path):
    other = copy_of(drive, tmp_path / "other" / drive.name)
    with pytest.raises(ralf.RalfError, match="another recording"):
        ralf.ray.label([drive, other], tmp_path / "out", progress=False)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"foo": 1}, TypeError, "foo"),
        ({"scans": 0}, ValueError, "scans: expected a number above 0, found 0"),
        ({"settings": {"fusion.treshold": 1}}, ralf.RalfError, "treshold"),
        ({"settings": "nosuch.toml"}, ralf.RalfError, r"nosuch\.toml"),
        ({"method": "lerned"}, ralf.RalfError, "lerned"),
        ({"model": "model.txt"}, ValueError, "model: expected the method"),
    ],
)
def test_arguments_are_refused_before_any_work(nothing_started, drive, tmp_path, options, error, words):
    with pytest.raises(error, match=words):
        ralf.ray.label([drive], tmp_path / "out", progress=False, **options)
    with pytest.raises(error, match=words):
        ralf.plan([drive], tmp_path / "out", **options)


def test_no_recording_is_refused(nothing_started, tmp_path):
    with pytest.raises(ValueError, match="recordings: expected one or more, found none"):
        ralf.ray.label([], tmp_path / "out", progress=False)


def test_what_can_t_be_labelled_is_named_with_all_that_is_said_of_it(cluster, drive, tmp_path):
    damaged = copy_of(drive, tmp_path / "damaged")
    min(damaged.glob("sequences/*/sequence.toml")).write_text("title = 1\n[[")
    done, _ = label((path for path in [bytes(drive), damaged]), tmp_path / "out", scans=8)
    assert list(done.runs) == [drive.name]
    assert done.failed == ralf.plan([damaged], tmp_path / "plain").failed
    whole = ralf.label(drive, tmp_path / "whole")
    assert tree(done.runs[drive.name].out) == tree(whole.out)


def test_warnings_are_those_of_plan_and_assemble(cluster, drive, tmp_path):
    damaged = copy_of(drive, tmp_path / "damaged")
    for file in damaged.glob("sequences/*/lidar*/*.bin"):
        file.write_bytes(file.read_bytes()[:1001])
    radar = min(damaged.glob("sequences/*/radar*/*.bin"))
    radar.write_bytes(radar.read_bytes()[:-1])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for settings in ({}, {"lidar.beta": 0.5}):
            for task in ralf.plan([damaged], tmp_path / "plain", settings=settings):
                ralf.label_one(task)
            plain = ralf.assemble(tmp_path / "plain")
    expected = [str(warning.message).replace("/plain/", "/out/") for warning in caught]
    first, told = label(damaged, tmp_path / "out")
    second, more = label(damaged, tmp_path / "out", settings={"lidar.beta": 0.5})
    assert told + more == expected
    for what in ("removed, for they were made", "labelled without: ", "not labelled: "):
        assert any(warning.startswith(f"damaged: {what}") for warning in expected), what
    assert second.runs["damaged"].warnings == plain.runs["damaged"].warnings
    assert second.runs["damaged"].labelled == plain.runs["damaged"].labelled == first.runs["damaged"].labelled


def test_relative_paths_are_meant_from_where_it_is_called(cluster, drive, tmp_path, monkeypatch):
    copy_of(drive, tmp_path / "here" / "drive")
    (tmp_path / "here/ralf.toml").write_text("lidar.beta = 0.5\n")
    monkeypatch.chdir(tmp_path / "here")
    done, _ = label("drive", "out", settings="ralf.toml")
    assert done.failed == {}
    assert done.runs["drive"].out == tmp_path / "here/out/drive"
    assert done.runs["drive"].recording == tmp_path / "here/drive"
    assert done.runs["drive"].record["settings"]["lidar"]["beta"] == 0.5


def test_what_others_have_planned_there_is_left_alone(cluster, drive, tmp_path):
    ralf.plan([copy_of(drive, tmp_path / "other")], tmp_path / "out")
    done, _ = label([drive], tmp_path / "out")
    assert list(done.runs) == [drive.name]
    assert not (tmp_path / "out/other/run.json").exists()


def test_all_paths_of_a_job_are_made_whole(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    names = {name: name for name in ("model", "depth", "segmentation")}
    (job,) = ralf.many.jobs_of(["a"], "out", settings={"motion.trajectory": "poses.tum"}, method="learned", **names)
    whole = job.anywhere()
    found = (whole.recording, whole.out, whole.model, whole.depth, whole.segmentation)
    assert found == tuple(str(tmp_path / name) for name in ("a", "out/a", "model", "depth", "segmentation"))
    assert whole.settings["motion"]["trajectory"] == str(tmp_path / "poses.tum")
