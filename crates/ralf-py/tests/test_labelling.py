"""Labels by Python are the labels of the command, and errors are exceptions."""

import json
import pickle
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import real_recordings, tree

import ralf
from ralf._progress import listener


def test_the_bytes_are_those_of_the_command(drive, cli, tmp_path):
    ralf.label(drive, tmp_path / "python", settings={"lidar": {"beta": 0.5}, "tracking.sources": "all"})
    arguments = ["--set", "lidar.beta=0.5", "--set", "tracking.sources=all"]
    cli("label", drive, "-o", tmp_path / "command", *arguments)
    assert tree(tmp_path / "python") == tree(tmp_path / "command")


@pytest.mark.parametrize("recording", real_recordings(), ids=lambda path: path.name)
def test_the_bytes_are_those_of_the_command_on_real_recordings(recording, cli, tmp_path):
    ralf.label(recording, tmp_path / "python")
    cli("label", "--quiet", recording, "-o", tmp_path / "command")
    python = tree(tmp_path / "python")
    assert any(name.endswith("plausibility.parquet") for name in python)
    assert python == tree(tmp_path / "command")


def test_settings_files_are_taken(drive, cli, tmp_path):
    settings = tmp_path / "ralf.toml"
    settings.write_text("[fusion]\nalpha = 0.25\n")
    ralf.label(drive, tmp_path / "python", settings=settings, method="paper", jobs=1)
    cli("label", drive, "-o", tmp_path / "command", "--config", settings)
    assert tree(tmp_path / "python") == tree(tmp_path / "command")


def test_what_was_labelled_is_left_alone_and_found_again(drive, run):
    again = ralf.label(ralf.open(drive), run.out, evidence=True)
    assert again.labelled == []
    assert list(ralf.load(run.out)) == again.sequences == run.labelled
    assert run.not_labelled == []
    assert "plausible" in run._repr_html_()


def test_what_a_damaged_recording_may_have_held_is_told(drive, run, cli, tmp_path):
    assert run.lost == []
    recording = tmp_path / "recording.mcap"
    cli("convert", drive, "-o", recording, "--quiet")
    written = bytearray(recording.read_bytes())
    length = _last_chunk(written) + 1
    written[length : length + 8] = bytes([255] * 8)
    recording.write_bytes(written)
    found = ralf.label(recording, tmp_path / "out", settings=tmp_path / "recording.toml")
    [(sequence, what)] = found.lost
    assert sequence == "recording"
    assert "recording.mcap: damaged" in what


def _last_chunk(mcap):
    """Where the last chunk of an MCAP file begins. A record is its kind (a byte), its length (eight), its content."""
    at, found = 8, None
    while at < len(mcap) - 8:
        found = at if mcap[at] == 6 else found
        at += 9 + int.from_bytes(mcap[at + 1 : at + 9], "little")
    return found


def test_errors_say_file_place_expected_and_found(drive, tmp_path):
    with pytest.raises(ralf.RalfError) as raised:
        ralf.open(tmp_path / "nowhere")
    assert raised.value.file == str(tmp_path / "nowhere")
    assert raised.value.expected == "the folder or the file of a recording"
    assert raised.value.found == "none of this name"
    (tmp_path / "damaged/sequences/00").mkdir(parents=True)
    (tmp_path / "damaged/sequences/00/sequence.toml").write_text("[[")
    with pytest.raises(ralf.RalfError) as raised:
        ralf.label(tmp_path / "damaged", tmp_path / "out")
    error = raised.value
    assert error.file.endswith("sequence.toml")
    assert error.place and error.expected and error.found
    assert all(part in str(error) for part in (error.file, error.place, error.expected, error.found))
    # It comes through from other processes and machines.
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), vars(again)) == (str(error), vars(error))
    with pytest.raises(ralf.RalfError, match=r"lidar\.gamma|gamma"):
        ralf.label(drive, tmp_path / "out", settings={"lidar.gamma": 1})
    with pytest.raises(ralf.RalfError, match="no sequence `99`"):
        ralf.open(drive, sequences=["99"])
    with pytest.raises(ralf.RalfError) as raised:
        ralf.load(tmp_path / "nothing")
    assert raised.value.place == "run.json"


def test_ten_threads_label_at_once(drive, run, tmp_path):
    def work(number):
        return tree(ralf.label(drive, tmp_path / str(number), evidence=True, jobs=1).out)

    with ThreadPoolExecutor(10) as threads:
        results = list(threads.map(work, range(10)))
    assert all(result == tree(run.out) for result in results)


def test_others_run_while_labels_are_made(drive, tmp_path):
    """Another thread counts; with Python's lock held it would not get beyond its first number."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.0005)

    counter = threading.Thread(target=count)
    counter.start()
    before = counted[0]
    ralf.label(drive, tmp_path / "out", evidence=True, jobs=1)
    stop.set()
    counter.join()
    assert counted[0] - before > 10


def test_progress_is_told_and_may_end_it(drive, tmp_path):
    seen = []
    ralf.label(drive, tmp_path / "a", evidence=True, jobs=1, progress=lambda *step: seen.append(step))
    stages = {step[0] for step in seen}
    assert "labelling" in stages
    assert all(done <= steps for _, _, done, steps, _ in seen)

    def impatient(*_):
        raise TimeoutError("enough")

    with pytest.raises(TimeoutError, match="enough"):
        ralf.label(drive, tmp_path / "b", evidence=True, jobs=1, progress=impatient)
    assert not (tmp_path / "b/run.json").exists()


def test_a_bar_tells_no_rate_of_what_took_no_time(capsys):
    bar = listener(True)
    bar("writing", "00", 4, 4, 100_000)
    told = capsys.readouterr().err
    assert "writing 00" in told and "100%" in told
    assert "detections/s" not in told


def test_ctrl_c_stops_it_and_it_goes_on(drive, run, tmp_path):
    out = tmp_path / "out"
    program = (
        "import ralf, signal, sys\n"
        # Who was started in the background was told to ignore it.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "try:\n    ralf.label(sys.argv[1], sys.argv[2], evidence=True, jobs=1)\n"
        "except KeyboardInterrupt:\n    print('stopped')\n"
    )
    process = subprocess.Popen([sys.executable, "-c", program, drive, out], stdout=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not list(out.rglob("*.label")) and time.monotonic() < deadline and process.poll() is None:
        time.sleep(0.005)
    assert process.poll() is None, "it ended before it could be stopped"
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said == "stopped\n"
    assert not (out / "run.json").exists()
    kept = {path.name: path.stat().st_mtime_ns for path in out.rglob("*.label")}
    assert kept
    assert tree(ralf.label(drive, out, evidence=True).out) == tree(run.out)


def test_evaluation_and_pictures_are_those_of_the_command(drive, run, cli, tmp_path):
    truth = ralf.evaluate(run, truth=drive)
    assert truth == json.loads(cli("evaluate", run.out, "--truth", drive, "--json"))
    assert 0.5 < truth["overall"]["pooled"]["accuracy"] <= 1
    assert ralf.evaluate(run) == json.loads(cli("evaluate", run.out, "--json"))
    assert "accuracy" in truth._repr_html_()
    name = run.sequences[0]
    picture = ralf.plot(run, name, scan=2, width=1600)
    cli("plot", drive, run.out, "--sequence", name, "--scan", 2, "-o", tmp_path / "scan.png")
    assert picture._repr_png_() == (tmp_path / "scan.png").read_bytes()
    with pytest.raises(ralf.RalfError, match="expected a scan"):
        ralf.plot(run, name, scan=999)


def test_truth_is_what_evaluation_goes_by(drive, run, tmp_path):
    truth = pickle.loads(pickle.dumps(ralf.Truth(drive, run)))
    (name,) = run.sequences
    pairs = [(truth.labels(name, scan), scan.label) for scan in run.scans(name)]
    true, labels = (np.concatenate(columns) for columns in zip(*pairs, strict=True))
    pooled = ralf.evaluate(run, truth=drive)["overall"]["pooled"]
    assert np.sum((true == 1) & (labels == 1)) == pooled["tp"]
    assert np.sum((true == 0) & (labels == 0)) == pooled["tn"]
    assert np.sum(true >= 0) == sum(pooled[count] for count in ("tp", "fp", "tn", "fn"))
    with pytest.raises(ralf.RalfError, match="expected files of corrected labels"):
        ralf.Truth(run.out)
    scan = next(run.scans(name))
    with pytest.raises(ralf.RalfError, match=f"no sequence `elsewhere` in the recording, which holds {name}"):
        truth.labels("elsewhere", scan)
    file = tmp_path / f"sequences/{name}/ground_truth/{scan.radar}/{scan.number:06}.label"
    file.parent.mkdir(parents=True)
    (tmp_path / "sequences/without").mkdir()
    file.write_bytes(bytes(4))
    with pytest.raises(ValueError, match=f"scan 0: expected the truth of {len(scan)} detections, found 1"):
        ralf.Truth(tmp_path).labels(name, scan)
    assert set(ralf.Truth(tmp_path).labels("without", scan)) == {-1}


def test_the_wheel_carries_the_command():
    command = Path(sys.executable).with_name("ralf")
    version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True).stdout
    assert version.startswith("ralf 0.")
    wrong = subprocess.run([command, "labell"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2
    assert "label" in wrong.stderr


def test_a_sequence_that_is_gone_is_told_of_whichever_way_the_recording_is_given(drive, tmp_path):
    twice = tmp_path / "twice"
    shutil.copytree(drive, twice)
    (first,) = (twice / "sequences").iterdir()
    shutil.copytree(first, twice / "sequences/other")
    ralf.label(twice, tmp_path / "out", check=False)
    shutil.rmtree(twice / "sequences/other")
    for recording in (twice, ralf.open(twice)):
        with pytest.warns(UserWarning, match="other: their labels stay|none of other"):
            ralf.label(recording, tmp_path / "out", check=False)
