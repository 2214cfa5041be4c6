"""Scans for training, where PyTorch is at hand."""

import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")
from torch.utils.data import DataLoader  # noqa: E402

from ralf.torch import ScanDataset, ScanStream, collate  # noqa: E402

FEATURES = ["x", "y", "z", "doppler", "d_lm"]


def all_rows(loader):
    return np.concatenate([batch["features"].numpy() for batch in loader])


def in_order(rows):
    return rows[np.lexsort(rows.T)]


@pytest.fixture(scope="module")
def expected(run):
    scans = [scan for sequence in run for scan in run.scans(sequence)]
    return np.concatenate([np.stack([np.nan_to_num(scan[name]) for name in FEATURES], 1) for scan in scans])


@pytest.mark.parametrize("workers", [0, 2])
def test_every_scan_is_seen_once_whatever_the_workers(run, expected, workers):
    data = ScanDataset(run, FEATURES)
    loader = DataLoader(data, batch_size=5, num_workers=workers, collate_fn=collate)
    assert np.array_equal(all_rows(loader), expected)
    stream = ScanStream(data, shuffle=True, seed=3)
    streamed = all_rows(DataLoader(stream, batch_size=5, num_workers=workers, collate_fn=collate))
    assert not np.array_equal(streamed, expected)
    assert np.array_equal(in_order(streamed), in_order(expected))


@pytest.mark.parametrize(("workers", "persistent"), [(0, False), (2, False), (2, True)])
def test_every_epoch_has_another_order(run, workers, persistent):
    torch.manual_seed(1)
    stream = ScanStream(ScanDataset(run, FEATURES), shuffle=True)
    loader = DataLoader(stream, batch_size=5, num_workers=workers, collate_fn=collate, persistent_workers=persistent)
    first, second = all_rows(loader), all_rows(loader)
    assert not np.array_equal(first, second)
    assert np.array_equal(in_order(first), in_order(second))


def test_a_batch_says_which_scan_a_row_belongs_to(run):
    data = ScanDataset(run.out, FEATURES, radars=[next(run.scans(run.sequences[0])).radar])
    batch = collate([data[0], data[-1]])
    sizes = [len(data[0]["label"]), len(data[-1]["label"])]
    assert torch.bincount(batch["scan"]).tolist() == sizes
    assert torch.equal(batch["w"][: sizes[0]], data[0]["w"])
    for index in (len(data), -len(data) - 1):
        with pytest.raises(IndexError, match=f"expected a scan of {len(data)}, .*, found {index}$"):
            data[index]


def test_truth_takes_the_place_of_labels(run, drive):
    import ralf

    truth = ScanDataset(run, FEATURES, truth=drive)
    labels = ScanDataset(run, FEATURES)
    pairs = [(truth[i]["label"], labels[i]["label"]) for i in range(len(truth))]
    right, known = (
        sum(int(((a == b) & (a >= 0)).sum()) for a, b in pairs),
        sum(int((a >= 0).sum()) for a, b in pairs),
    )
    assert right / known == pytest.approx(ralf.evaluate(run, truth=drive)["overall"]["pooled"]["accuracy"])
    with pytest.raises(ralf.RalfError, match="expected files of corrected labels"):
        ScanDataset(run, truth=run.out)


def test_corrections_of_a_run_count_above_the_truth(run, drive, tmp_path):
    import ralf

    shutil.copytree(run.out, tmp_path / "out")
    (tmp_path / "out/corrections.sqlite").write_bytes(b"no database" * 100)
    with pytest.raises(ralf.RalfError, match="a whole SQLite database of corrections"):
        ScanDataset(tmp_path / "out", FEATURES, truth=drive)
    ScanDataset(tmp_path / "out", FEATURES, truth=ralf.Truth(drive))


def test_names_that_there_are_none_of_are_refused(run):
    with pytest.raises(KeyError, match=f"expected a sequence of {run.sequences[0]}, found nosuch"):
        ScanDataset(run, FEATURES, sequences=["nosuch"])
    with pytest.raises(KeyError, match=r"expected a radar of .*, found nosuch"):
        ScanDataset(run, FEATURES, radars=["nosuch"])
    assert len(ScanDataset([run, run.out], FEATURES, radars=run.radars_of(run.sequences[0])[:1])) > 0


def test_features_that_are_no_names_of_columns_are_refused(run):
    for features, error, found in (
        ("doppler", TypeError, "a list of names, found 'doppler'"),
        (["x", 1], TypeError, "names, found 1 among them"),
        ([], ValueError, "one or more names of columns, found none"),
    ):
        with pytest.raises(error, match=f"features: expected {found}"):
            ScanDataset(run, features)
    assert ScanDataset(run, np.array(FEATURES)).features == FEATURES
    for feature in ("nosuch", "radar"):
        with pytest.raises(KeyError, match=f"expected a column of numbers of scan, point, .*, found {feature}"):
            ScanDataset(run, ["x", feature])


def test_corrections_that_do_not_count_are_warned_of(run, drive, tmp_path, command):
    recording, out = tmp_path / "drive", tmp_path / "out"
    shutil.copytree(drive, recording)
    shutil.copytree(run.out, out)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ScanDataset(out, FEATURES)
    correct = Path(__file__).parents[3] / "testdata/correct_some.py"
    subprocess.run([sys.executable, correct, recording, out, "1", "--ralf", *command], check=True, capture_output=True)
    with pytest.warns(UserWarning, match="out: what people corrected doesn't count without `truth`"):
        ScanDataset(out, FEATURES)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ScanDataset(out, FEATURES, truth=recording)


def test_corrections_of_sequences_that_were_not_chosen_are_nobodys_matter(drive, tmp_path, command):
    import ralf

    recording, out = tmp_path / "drive", tmp_path / "out"
    [simulated] = (drive / "sequences").iterdir()
    shutil.copytree(simulated, recording / "sequences/corrected")
    ralf.label(recording, out)
    correct = Path(__file__).parents[3] / "testdata/correct_some.py"
    subprocess.run([sys.executable, correct, recording, out, "1", "--ralf", *command], check=True, capture_output=True)
    shutil.copytree(simulated, recording / "sequences/other")
    ralf.label(recording, out)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ScanDataset(out, FEATURES, sequences=["other"])
    with pytest.warns(UserWarning, match="what people corrected doesn't count"):
        ScanDataset(out, FEATURES, sequences=["corrected"])


def test_a_thread_gets_the_sequence_that_it_asks_for(run):
    class Raced(ScanDataset):
        """Another thread opens another sequence as soon as one is open."""

        def __setattr__(self, name, value):
            super().__setattr__(name, value if name != "_open" or value is None else (-1, []))

    data = Raced(run, FEATURES)
    assert len(data[0]["label"]) == len(next(run.scans(run.sequences[0])))
