"""What makes no sense is refused, by name and with what there is to choose from, and never answered with nothing."""

import importlib
import os
import pickle
import shutil
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ralf
from ralf import _ralf
from ralf._jobs import job


def one_scan():
    sequence = ralf.Sequence(radars=[ralf.Radar("front")])
    sequence.add_radar_scan("front", 0, xyz=[[9.0, 0.0, 0.0]])
    return sequence


def known(error):
    return error.file, error.place, error.expected, error.found


def test_a_model_is_refused_where_the_method_asks_none(drive, tmp_path):
    refused = 'model: expected the method that asks one, method="learned", found'
    with pytest.raises(ValueError, match=refused):
        ralf.label(drive, tmp_path / "out", model="nosuch.txt")
    with pytest.raises(ValueError, match=refused):
        ralf.label(drive, tmp_path / "out", model="nosuch.txt", settings={"method": "paper"})
    with pytest.raises(ValueError, match=refused):
        ralf.plan([drive], tmp_path / "out", model="nosuch.txt")
    with pytest.raises(ValueError, match=refused):
        one_scan().label(model="nosuch.txt")
    assert not (tmp_path / "out").exists()
    # Whoever makes a job by hand hears it, too.
    told = replace(job(drive, tmp_path / "out"), model="nosuch.txt")
    with pytest.raises(ralf.RalfError, match=r"nosuch\.txt: model: expected the method that asks a model"):
        _ralf.label(told)


def test_radars_that_there_are_none_of_are_refused(run):
    (name,) = run.sequences
    first = run.radars_of(name)[0]
    with pytest.raises(KeyError, match=f"expected a radar of {first}.*, found nosuch"):
        run.scans(name, radar="nosuch")
    with pytest.raises(KeyError, match="expected a radar of front, found nosuch"):
        one_scan().label().scans("nosuch")
    assert len(list(run.scans(name, radar=first))) > 1
    # One that has seen nothing is still one.
    silent = ralf.Sequence(radars=[ralf.Radar("front"), ralf.Radar("rear")])
    silent.add_radar_scan("front", 0, xyz=[[9.0, 0.0, 0.0]])
    assert list(silent.label().scans("rear")) == []


def test_two_sensors_of_one_name_are_refused():
    with pytest.raises(ValueError, match="expected radars of different names, found two of the name front"):
        ralf.Sequence(radars=[ralf.Radar("front"), ralf.Radar("front")])
    with pytest.raises(ValueError, match="expected LiDARs of different names, found two of the name top"):
        ralf.Sequence(radars=[ralf.Radar("front")], lidars=[ralf.Lidar("top"), ralf.Lidar("top")])
    camera = ralf.Camera("front", (0.0, 0.0, 1.0), 64, 48, ralf.Pinhole(40, 40, 31.5, 23.5))
    with pytest.raises(ValueError, match="different names, found a radar and a camera of the name front"):
        ralf.Sequence(radars=[ralf.Radar("front")], cameras=[camera])
    with pytest.raises(ValueError, match="different names, found a radar and a LiDAR of the name top"):
        ralf.Sequence(radars=[ralf.Radar("top")], lidars=[ralf.Lidar("top")])


def test_a_folder_that_nothing_was_planned_for_is_refused(tmp_path):
    for folder in (tmp_path / "nosuch", tmp_path):
        with pytest.raises(ralf.RalfError) as raised:
            ralf.assemble(folder)
        assert known(raised.value) == (str(folder), "plan.json", "what `ralf.plan` wrote", "nothing")


def test_truth_of_another_recording_is_refused(drive, run, tmp_path):
    (name,) = run.sequences
    other = tmp_path / "other"
    shutil.copytree(drive, other)
    (other / "sequences" / name).rename(other / "sequences/elsewhere")
    with pytest.raises(ralf.RalfError) as raised:
        ralf.Truth(other, run)
    assert known(raised.value) == (
        str(other),
        "truth",
        f"truth of scans that {run.out} has labels of",
        "truth of elsewhere alone",
    )
    assert ralf.Truth(drive, run)


def test_errors_of_settings_say_file_place_expected_and_found(tmp_path):
    file = tmp_path / "ralf.toml"

    def refused(settings):
        with pytest.raises(ralf.RalfError) as raised:
            ralf.open("nosuch", settings=settings)
        return raised.value

    file.write_text("[lidar]\nbeta = -1\n")
    error = refused(file)
    assert str(error) == f"{file}: setting `lidar.beta`: expected more than 0 and up to 1000000, found -1"
    assert known(error) == (str(file), "setting `lidar.beta`", "more than 0 and up to 1000000", "-1")
    assert known(refused({"lidar.beta": -1})) == (None, *known(error)[1:])
    file.write_text("[lidar]\ngamma = 1\n")
    error = refused(str(file))
    assert str(error).startswith(f"{file}: TOML parse error at line 2, column 1")
    assert error.expected.startswith("one of `enabled`, `beta`")
    assert known(error)[:2] == (str(file), "line 2, column 1")
    assert error.found == "unknown field `gamma`"
    error = refused({"lidar.beta": "a"})
    assert known(error) == (None, "lidar.beta", "a number", 'invalid type: string "a"')
    missing = tmp_path / "missing.toml"
    assert known(refused(missing)) == (str(missing), None, "a regular file", "none of this name")
    file.write_bytes(b"# \xff")
    assert known(refused(file)) == (str(file), "byte 2", "UTF-8 text", "other bytes")


def test_errors_of_models_say_file_place_expected_and_found(tmp_path):
    model = tmp_path / "model.txt"

    def refused():
        with pytest.raises(ralf.RalfError) as raised:
            one_scan().label(method="learned", model=model)
        return known(raised.value)

    assert refused() == (str(model), None, "a regular file", "none of this name")
    model.write_text("a recipe\n")
    assert refused() == (str(model), "model: line 1", "`ralf model 1`", "`a recipe`")


def test_errors_of_corrections_say_file_place_expected_and_found(drive, run, tmp_path):
    shutil.copytree(run.out, tmp_path / "out")
    store = tmp_path / "out/corrections.sqlite"
    store.write_bytes(b"no database" * 100)
    with pytest.raises(ralf.RalfError) as raised:
        ralf.Truth(drive, tmp_path / "out")
    told = ("file", "a whole SQLite database of corrections", "another file, or a damaged one")
    assert known(raised.value) == (str(store), *told)


def test_corrections_of_other_detections_are_warned_of(drive, tmp_path, command):
    recording, out = tmp_path / "drive", tmp_path / "out"
    shutil.copytree(drive, recording)
    run = ralf.label(recording, out)
    correct = Path(__file__).parents[3] / "testdata/correct_some.py"
    subprocess.run([sys.executable, correct, recording, out, "1", "--ralf", *command], check=True, capture_output=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ralf.evaluate(run, recording)
        ralf.Truth(recording, run)
    (name,) = ralf.open(recording).sequences
    radar = next(iter(ralf.open(recording)[name].radars))
    file = recording / "sequences" / name / radar / "000001.bin"
    detections = np.fromfile(file, "<f4").reshape(-1, len(ralf.open(recording)[name].fields[radar]))
    detections[::-1].tofile(file)
    run = ralf.label(recording, out)
    told = rf"corrections of {name}/{radar}/000001 are kept and not applied"
    with pytest.warns(UserWarning, match=told):
        ralf.evaluate(run, recording)
    with pytest.warns(UserWarning, match=told):
        ralf.Truth(recording, run)


def test_errors_of_arrays_say_place_expected_and_found():
    sequence = one_scan()
    sequence.add_radar_scan("front", -5, xyz=[[9.0, 0.0, 0.0]])
    with pytest.raises(ralf.RalfError) as raised:
        sequence.label()
    file, place, expected, found = known(raised.value)
    assert (file, expected, found) == (None, "a time of 0 ns or later", "-5 ns")
    assert "front" in place


@pytest.mark.parametrize("jobs", [0, -3])
def test_no_threads_are_refused(drive, tmp_path, jobs):
    refused = f"jobs: expected a number above 0, found {jobs}"
    for call in (
        lambda: ralf.label(drive, tmp_path / "out", jobs=jobs),
        lambda: ralf.plan([drive], tmp_path / "out", jobs=jobs),
        lambda: ralf.label_one("{}", jobs=jobs),
        lambda: ralf.assemble(tmp_path, jobs=jobs),
        lambda: one_scan().label(jobs=jobs),
    ):
        with pytest.raises(ValueError, match=refused):
            call()
    with pytest.raises(ValueError, match="scans: expected a number above 0, found 0"):
        ralf.plan([drive], tmp_path / "out", scans=0)


@pytest.mark.parametrize("number", [-1, -(2**70), 2**70])
def test_numbers_out_of_range_are_refused_by_name(drive, run, number):
    recording = ralf.open(drive)
    (name,) = recording.sequences
    radar, lidar = (next(iter(sensors)) for sensors in (recording[name].radars, recording[name].lidars))
    expected = "0 or more" if number < 0 else "at most [0-9]+"
    for what, call in (
        ("scan", lambda: recording.radar_scan(name, radar, number)),
        ("scan", lambda: recording.lidar_scan(name, lidar, number)),
        ("image", lambda: recording.image(name, "camera", number)),
        ("scan", lambda: ralf.plot(run, name, scan=number)),
        ("width", lambda: ralf.plot(run, name, scan=0, width=number)),
    ):
        with pytest.raises(ValueError, match=f"{what}: expected {expected}, found {number}"):
            call()
    with pytest.raises(TypeError, match=r"scan: expected a whole number, found 1\.5"):
        recording.radar_scan(name, radar, 1.5)
    assert recording.radar_scan(name, radar, np.int64(1)).t_ns == recording.radar_scan(name, radar, 1).t_ns


def test_paths_of_bytes_are_taken(drive, tmp_path):
    out = tmp_path / "out"
    assert ralf.open(bytes(drive)).sequences == ralf.open(drive).sequences
    run = ralf.label(bytes(drive), bytes(out))
    assert (run.out, run.recording) == (out, drive)
    assert ralf.load(bytes(out)).sequences == run.sequences
    assert ralf.evaluate(bytes(out), bytes(drive)) == ralf.evaluate(run, drive)
    scan = next(run.scans(run.sequences[0]))
    assert len(ralf.Truth(bytes(drive), bytes(out)).labels(run.sequences[0], scan)) == len(scan)


@pytest.mark.skipif(sys.platform != "linux", reason="no other system has such names")
def test_paths_of_other_bytes_than_utf8_are_taken(drive, run, tmp_path):
    """As the command takes them; plans and tasks are text, and have no word for them."""
    folder = tmp_path / os.fsdecode(b"caf\xe9")
    recording, out, model, settings = (folder / name for name in ("drive", "out", "model.txt", "ralf.toml"))
    shutil.copytree(drive, recording)
    settings.write_text("")
    assert pickle.loads(pickle.dumps(ralf.open(bytes(recording)))).sequences == ralf.open(drive).sequences
    labelled = ralf.label(recording, out, settings=settings, evidence=True)
    (name,) = labelled.sequences
    table = "sequences/" + name + "/plausibility.parquet"
    assert (out / table).read_bytes() == (run.out / table).read_bytes()
    assert ralf.evaluate(labelled, recording) == ralf.evaluate(run, drive)
    assert ralf.plot(labelled, name, 0).png == ralf.plot(ralf.load(run.out, drive), name, 0).png
    with pytest.raises(ralf.RalfError, match=r"model\.txt: "):
        ralf.label(recording, folder / "other", method="learned", model=model)
    for place, call in {
        "recordings": lambda: ralf.plan([recording], tmp_path / "out"),
        "out": lambda: ralf.plan([drive], out),
        "model": lambda: ralf.plan([drive], tmp_path / "out", method="learned", model=model),
        "depth": lambda: ralf.plan([drive], tmp_path / "out", depth=folder),
        "segmentation": lambda: ralf.plan([drive], tmp_path / "out", segmentation=folder),
    }.items():
        with pytest.raises(ValueError, match=rf"{place}: expected a path in UTF-8, found b'.*caf\\xe9"):
            call()


def test_a_picture_of_a_named_sequence_wants_no_other(drive, tmp_path, cli):
    """As with the command: what is gone of a recording is refused where the whole of it is asked for."""
    (name,) = ralf.open(drive).sequences
    recording, out = tmp_path / "drive", tmp_path / "out"
    shutil.copytree(drive, recording)
    shutil.copytree(recording / "sequences" / name, recording / "sequences/gone")
    run = ralf.label(recording, out)
    shutil.rmtree(recording / "sequences/gone")
    cli("plot", recording, out, "--scan", 0, "-o", tmp_path / "any.png", status=1)
    cli("plot", recording, out, "--sequence", name, "--scan", 0, "-o", tmp_path / "named.png")
    assert ralf.plot(run, name, scan=0, width=1600).png == (tmp_path / "named.png").read_bytes()
    with pytest.raises(ralf.RalfError, match="no sequence `gone`"):
        ralf.plot(run, "gone", scan=0)


def test_a_picture_of_what_could_not_be_labelled_is_refused_or_warned_of(drive, tmp_path):
    """As with the command: alone it would show that nothing is plausible."""
    (name,) = ralf.open(drive).sequences
    recording = tmp_path / "drive"
    shutil.copytree(drive, recording)
    radar = next(iter(ralf.open(drive)[name].radars))
    file = recording / "sequences" / name / radar / "000001.bin"
    file.write_bytes(file.read_bytes()[:-3])
    run = ralf.label(recording, tmp_path / "out")
    told = rf"not labelled: {name} {radar} scan 1: .*000001\.bin"
    with pytest.raises(ralf.RalfError, match=told):
        ralf.plot(run, name, scan=1, radar=radar, width=300)
    with pytest.warns(UserWarning, match=told):
        ralf.plot(run, name, scan=None, radar=radar, width=300)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ralf.plot(run, name, scan=0, radar=radar, width=300)


def test_a_picture_goes_on_without_a_lidar_scan_that_cannot_be_read(drive, tmp_path, cli):
    """As with the command."""
    (name,) = ralf.open(drive).sequences
    recording = tmp_path / "drive"
    shutil.copytree(drive, recording)
    told = ralf.open(drive)[name]
    lidar, times = next(iter(told.lidars.items()))
    beside = int(np.argmin(np.abs(times - next(iter(told.radars.values()))[1])))
    file = recording / "sequences" / name / lidar / f"{beside:06}.bin"
    file.write_bytes(file.read_bytes()[:-3])
    with pytest.warns(UserWarning, match=f"labelled without: {name} {lidar} {beside}"):
        run = ralf.label(recording, tmp_path / "out")
    with pytest.warns(UserWarning, match=rf"drawn without: {name} {lidar} scan {beside}: .*{file.name}"):
        picture = ralf.plot(run, name, scan=1, width=1600)
    cli("plot", recording, run.out, "--sequence", name, "--scan", 1, "-o", tmp_path / "scan.png")
    assert picture.png == (tmp_path / "scan.png").read_bytes()
    with pytest.warns(UserWarning, match="drawn without"):
        ralf.plot(run, name, width=300)


def test_measurements_that_there_are_none_of_are_refused(drive):
    recording = ralf.open(drive)
    (name,) = recording.sequences
    told = recording[name]
    for sensors, read in ((told.radars, recording.radar_scan), (told.lidars, recording.lidar_scan)):
        sensor, times = next(iter(sensors.items()))
        with pytest.raises(ralf.RalfError) as raised:
            read(name, sensor, 999)
        expected = f"one of its {len(times)} scans, counted from 0"
        assert known(raised.value) == (str(drive), f"sequence {name}, {sensor}", expected, "999")


def without_motion(sequence):
    """Takes from a sequence whatever tells how the vehicle moved."""
    for file in ("odometry.csv", "poses.csv"):
        (sequence / file).unlink(missing_ok=True)
    sensors = sequence / "sequence.toml"
    text = sensors.read_text().replace('"doppler"', '"speed"')
    tables = text.split("\n[[")
    sensors.write_text("\n[[".join(table for table in tables if not table.startswith("lidar]]")))


def test_a_sequence_that_cannot_be_read_costs_the_others_nothing(drive, tmp_path):
    """As with the command: it is left out, and this is a warning."""
    (name,) = ralf.open(drive).sequences
    recording = tmp_path / "drive"
    shutil.copytree(drive, recording)
    shutil.copytree(drive / "sequences" / name, recording / "sequences/unmoved")
    without_motion(recording / "sequences/unmoved")
    told = "left out: unmoved: .*the vehicle's motion"
    with pytest.warns(UserWarning, match=told):
        opened = ralf.open(recording)
    assert opened.sequences == [name]
    with pytest.warns(UserWarning, match=told):
        run = ralf.label(recording, tmp_path / "out")
    assert run.sequences == [name]
    with pytest.warns(UserWarning, match=f"drive: {told}"):
        plan = ralf.plan(recording, tmp_path / "many")
    assert (len(plan), plan.failed) == (1, {})
    with pytest.warns(UserWarning, match=f"drive: {told}"):
        assert ralf.assemble(tmp_path / "many").failed == {}
    with pytest.raises(ralf.RalfError, match="the vehicle's motion"):
        ralf.open(recording, sequences=["unmoved"])


def test_labels_of_another_recording_are_refused_and_what_is_gone_is_warned_of(drive, tmp_path, cli):
    (name,) = ralf.open(drive).sequences
    recording, other, out = tmp_path / "drive", tmp_path / "other", tmp_path / "out"
    shutil.copytree(drive, recording)
    shutil.copytree(drive / "sequences" / name, recording / "sequences/second")
    ralf.label(recording, out)
    cli("simulate", "--preset", "tiny", "--scans", 6, "--no-images", "--seed", 5, "-o", other)
    with pytest.raises(ralf.RalfError, match=f"expected labels of {other}.*those of another recording, {recording}"):
        ralf.label(other, out)
    shutil.rmtree(recording / "sequences/second")
    with pytest.warns(UserWarning, match="found none of second: their labels stay as they are"):
        assert ralf.label(recording, out).labelled == []


def test_pictures_of_another_name_are_refused(run, tmp_path):
    picture = ralf.plot(run, run.sequences[0], scan=0, width=300)
    with pytest.raises(ValueError, match=r"expected a name that ends in \.png, found .*x\.jpg"):
        picture.save(tmp_path / "x.jpg")
    for name in ("x.png", "x.PNG", "x"):
        picture.save(tmp_path / name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x", "x.PNG", "x.png"]


def test_what_storage_lacks_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "fsspec", None)
    monkeypatch.delitem(sys.modules, "ralf.storage", raising=False)
    with pytest.raises(ImportError, match=r"expected fsspec, found none: pip install ralf-radar\[storage\]"):
        importlib.import_module("ralf.storage")
