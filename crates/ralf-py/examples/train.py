"""Why labels exist: the same small network, trained on RALF's labels and on the true ones, judged by the truth.

python crates/ralf-py/examples/train.py FOLDER

Simulates recordings in FOLDER and labels them; minutes on a CPU. Wants `pip install ralf-radar[torch]`.
The network sees one radar scan at a time and no other sensor: what it knows of artifacts, RALF's labels have taught it.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn
from torch.utils.data import DataLoader

import ralf
from ralf.torch import Batch, ScanDataset, collate

FEATURES = ["range", "azimuth", "elevation", "x", "y", "z", "doppler", "rcs"]
TRAIN, TEST = [1, 2], 3
EPOCHS = 12


class PointNetwork(nn.Module):
    """A detection by itself and beside the whole of its scan (Qi et al., PointNet, 2017: one maximum, joined again)."""

    def __init__(self, features: int, width: int = 64) -> None:
        super().__init__()
        self.normal = nn.BatchNorm1d(features)
        self.each = nn.Sequential(nn.Linear(features, width), nn.ReLU(), nn.Linear(width, width), nn.ReLU())
        self.both = nn.Sequential(nn.Linear(2 * width, width), nn.ReLU(), nn.Linear(width, 1))

    def forward(self, batch: Batch) -> Tensor:
        """A logit per detection."""
        each = self.each(self.normal(batch["features"]))
        scans = int(batch["scan"].max()) + 1
        places = batch["scan"][:, None].expand_as(each)
        whole = each.new_zeros(scans, each.shape[1]).scatter_reduce(0, places, each, "amax")
        return self.both(torch.cat([each, whole[batch["scan"]]], dim=1)).squeeze(1)


def main() -> None:
    """Simulate, label, train twice, judge."""
    folder = Path(sys.argv[1])
    drives = [drive(folder, seed) for seed in [*TRAIN, TEST]]
    runs = [ralf.label(path, folder / "out" / path.name, progress=True) for path in drives]
    train = {
        "RALF's labels": [ScanDataset(run, FEATURES) for run in runs[:-1]],
        "the true labels": [
            ScanDataset(run, FEATURES, truth=path) for run, path in zip(runs[:-1], drives[:-1], strict=True)
        ],
    }
    test = ScanDataset(runs[-1], FEATURES, truth=drives[-1])
    print(f"RALF itself, with all sensors: {scores(*ralf_itself(runs[-1], test))}")
    for name, data in train.items():
        torch.manual_seed(0)
        network = fit(PointNetwork(len(FEATURES)), torch.utils.data.ConcatDataset(data))
        print(f"the network on {name}: {scores(*answers(network, test))}")


def drive(folder: Path, seed: int) -> Path:
    """A simulated recording of several places."""
    path = folder / f"drive-{seed}"
    if not path.exists():
        command = Path(sys.executable).with_name("ralf")
        arguments = ["--preset", "paper", "--scans", "110", "--no-images", "--seed", str(seed), "-o", path]
        subprocess.run([command, "simulate", *arguments], check=True)
    return path


def fit(network: PointNetwork, data: torch.utils.data.Dataset) -> PointNetwork:
    """Train by cross entropy, the rarer class weighted up; unknown detections say nothing."""
    chance = torch.Generator().manual_seed(0)
    loader = DataLoader(data, batch_size=16, shuffle=True, collate_fn=collate, generator=chance)
    optimizer = torch.optim.Adam(network.parameters(), lr=2e-3)
    for _ in range(EPOCHS):
        for batch in loader:
            known = batch["label"] >= 0
            target = batch["label"][known].float()
            weight = (1 - target.mean()) / target.mean().clamp(min=1e-3)
            logits = network(batch)[known]
            loss = nn.functional.binary_cross_entropy_with_logits(logits, target, pos_weight=weight)
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
    return network.eval()


def answers(network: PointNetwork, data: ScanDataset) -> tuple[np.ndarray, np.ndarray]:
    """Truth, and how plausible the network finds it."""
    truth, found = [], []
    with torch.no_grad():
        for batch in DataLoader(data, batch_size=64, collate_fn=collate):
            truth.append(batch["label"].numpy())
            found.append(torch.sigmoid(network(batch)).numpy())
    return np.concatenate(truth), np.concatenate(found)


def ralf_itself(run: ralf.Run, data: ScanDataset) -> tuple[np.ndarray, np.ndarray]:
    """Truth, and RALF's labels."""
    truth = np.concatenate([data[index]["label"].numpy() for index in range(len(data))])
    found = [scan.label for sequence in run for scan in run.scans(sequence)]
    return truth, np.concatenate(found).astype(float)


def scores(truth: np.ndarray, found: np.ndarray) -> str:
    """Accuracy, F1 of plausible detections, and average precision."""
    known = truth >= 0
    truth, found = truth[known] == 1, found[known]
    said = found >= 0.5
    hits = np.sum(said & truth)
    f1 = 2 * hits / (np.sum(said) + np.sum(truth))
    order = np.argsort(-found, kind="stable")
    precision = np.cumsum(truth[order]) / np.arange(1, len(order) + 1)
    average = np.sum(precision * truth[order]) / np.sum(truth)
    return f"accuracy {np.mean(said == truth):.3f}, F1 {f1:.3f}, average precision {average:.3f}"


if __name__ == "__main__":
    main()
