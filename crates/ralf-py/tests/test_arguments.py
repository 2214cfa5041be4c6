"""What is asked for counts, wherever it was said; what makes no sense is refused by the name of its argument."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import tree

import ralf
from ralf._jobs import settings_json

SETTINGS = {"corrections.radar_front.add_yaw_deg": 2.0, "lidar.beta": 0.5}


def test_a_recording_is_labelled_with_the_settings_it_was_opened_with(drive, tmp_path):
    recording = ralf.open(drive, settings=SETTINGS)
    assert recording.settings["lidar"]["beta"] == 0.5
    ralf.label(recording, tmp_path / "opened")
    ralf.label(drive, tmp_path / "path", settings=SETTINGS)
    assert tree(tmp_path / "opened") == tree(tmp_path / "path")
    # It does so in another process, too.
    ralf.label(pickle.loads(pickle.dumps(recording)), tmp_path / "sent")
    assert tree(tmp_path / "sent") == tree(tmp_path / "path")


def test_what_label_is_told_counts_above_the_recording_s_settings(drive, tmp_path):
    told = {"lidar.beta": 0.7, "fusion.alpha": 0.25}
    file = tmp_path / "ralf.toml"
    file.write_text("lidar.beta = 0.7\nfusion.alpha = 0.25\n")
    ralf.label(drive, tmp_path / "path", settings=SETTINGS | told, method="learned")
    for name, settings in (("mapping", told), ("file", file)):
        ralf.label(ralf.open(drive, settings=SETTINGS), tmp_path / name, settings=settings, method="learned")
        assert tree(tmp_path / name) == tree(tmp_path / "path")


def test_numpy_s_values_are_settings(drive, tmp_path):
    place = np.array([1.0, 2.0, 3.0])
    given = {"lidar": {"enabled": np.bool_(False)}, "corrections.radar_front.add_translation": place}
    settings = ralf.open(drive, settings=given | {"lidar.beta": np.float64(0.5)}).settings
    assert settings["lidar"]["enabled"] is False
    assert settings["corrections"]["radar_front"]["add_translation"] == [1.0, 2.0, 3.0]
    listed = {"corrections.radar_front.add_translation": list(place)}
    assert ralf.open(drive, settings=listed).settings["corrections"] == settings["corrections"]


def test_a_sensor_s_name_may_hold_a_dot():
    told = {"sigma_range_m": 0.2}
    for settings in ({"sensors": {"radar.front": told}}, {'sensors."radar.front"': told}):
        assert settings_json(settings)["sensors"]["radar.front"]["sigma_range_m"] == 0.2
    assert settings_json({"sensors.front": told})["sensors"]["front"]["sigma_range_m"] == 0.2


def test_what_are_no_settings_is_named(drive, tmp_path):
    for settings, found in (({1: 2}, "1"), ({"lidar": {2: 3}}, r"lidar\.2"), (["ralf.toml"], r"\['ralf.toml'\]")):
        with pytest.raises(TypeError, match=f"settings: expected .*, found {found}"):
            ralf.label(drive, tmp_path / "out", settings=settings)


def test_no_sequence_is_not_taken_for_all(drive, tmp_path):
    recording = ralf.open(drive)
    for call in (
        lambda: ralf.open(drive, sequences=[]),
        lambda: ralf.label(drive, tmp_path / "out", sequences=()),
        lambda: ralf.label(recording, tmp_path / "out", sequences=[]),
    ):
        with pytest.raises(ValueError, match="sequences: expected one or more names"):
            call()
    with pytest.raises(TypeError, match="sequences: expected a list of names, found 'tiny'"):
        ralf.label(drive, tmp_path / "out", sequences="tiny")
    with pytest.raises(TypeError, match="sequences: expected names, found 0 among them"):
        ralf.label(drive, tmp_path / "out", sequences=[0])
    assert not (tmp_path / "out").exists()
    assert ralf.open(drive, sequences=np.array(recording.sequences)).sequences == recording.sequences


def test_what_was_opened_stays_what_it_is_when_the_folder_changes(drive, run, tmp_path, monkeypatch):
    (name,) = run.sequences
    monkeypatch.chdir(drive.parent)
    out = Path(run.out)
    recording = ralf.open(drive.name)
    truth = ralf.Truth(drive.name, out)
    labelled = ralf.label(drive.name, "labelled")
    monkeypatch.chdir(tmp_path)
    assert (recording.path, labelled.recording) == (str(drive), drive)
    assert len(pickle.loads(pickle.dumps(recording)).radar_scan(name, labelled.radars_of(name)[0], 0).fields) > 0
    scan = next(labelled.scans(name))
    assert len(pickle.loads(pickle.dumps(truth)).labels(name, scan)) == len(scan)
    assert ralf.label(recording, labelled.out).labelled == []
    assert len(ralf.plot(labelled, name, 0).png) > 0


def test_a_column_without_a_scan_to_colour_is_refused(drive, run):
    labelled = ralf.load(run.out, drive)
    with pytest.raises(ValueError, match="color_by: expected a scan to colour"):
        ralf.plot(labelled, run.sequences[0], color_by="doppler")
    assert len(ralf.plot(labelled, run.sequences[0], scan=0, color_by="doppler").png) > 0


def test_one_path_is_one_recording(drive, tmp_path):
    for number, path in enumerate([drive, str(drive), bytes(drive)]):
        plan = ralf.plan(path, tmp_path / str(number))
        assert len(plan) > 0
        assert plan.failed == {}
