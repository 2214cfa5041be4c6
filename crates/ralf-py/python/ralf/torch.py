"""Labelled scans for training: `pip install ralf-radar[torch]`.

data = ralf.torch.ScanDataset(run, features=["x", "y", "z", "doppler"])
loader = torch.utils.data.DataLoader(data, batch_size=16, shuffle=True, num_workers=4, collate_fn=collate)
"""

from __future__ import annotations

import os
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any, TypedDict

import numpy as np
import torch
from torch.utils.data import Dataset, IterableDataset, get_worker_info

from ralf import _ralf
from ralf._jobs import names
from ralf._warnings import warn_of
from ralf.judging import Truth
from ralf.run import Run, Scan, load, refuse_unknown

_Out = Run | str | os.PathLike[str]


class Sample(TypedDict):
    """A scan."""

    features: torch.Tensor
    """n x the number of features, float32; absent values are 0."""
    label: torch.Tensor
    """n, int64: 1 plausible, 0 artifact, -1 unknown."""
    w: torch.Tensor
    """n, float32: RALF's plausibility, as a soft target or a weight."""


class Batch(Sample):
    """Several scans, one after the other: clouds are ragged, and nothing is padded."""

    scan: torch.Tensor
    """n, int64: which scan of the batch a row belongs to."""


class ScanDataset(Dataset[Sample]):
    """The scans of runs, by number. Tables are read when they are first asked for, in each worker by itself.

    Labels are RALF's own: without `truth` nothing that people corrected counts, and where they did that is a warning.
    `truth` is the dataset whose truth is taken in place of them; what people corrected in a run's review counts above
    it, as in `ralf.evaluate`. A `ralf.Truth` is taken as it is. A scan without truth is all unknown. `features` are
    names of columns of numbers; one that a table lacks is a `KeyError`.

    One sequence is in memory at a time, and another one is read when one of its scans is asked for: where scans of
    several sequences are drawn at random, every draw may read a whole table. `ScanStream` draws them by sequence.
    """

    def __init__(
        self,
        runs: _Out | Sequence[_Out],
        features: Sequence[str] = ("x", "y", "z"),
        *,
        radars: Sequence[str] | None = None,
        sequences: Sequence[str] | None = None,
        truth: Truth | str | os.PathLike[str] | None = None,
    ) -> None:
        self.features = names(features, "features") or []
        if not self.features:
            raise ValueError("features: expected one or more names of columns, found none")
        radars, sequences = names(radars, "radars"), names(sequences, "sequences")
        self._truths: list[Truth | None] = []
        self._scans: list[tuple[Path, str, list[int]]] = []
        self._ends: list[int] = []
        self._open: tuple[int, list[Scan]] | None = None
        given = [runs] if isinstance(runs, Run | str | bytes | os.PathLike) else runs
        opened = [run if isinstance(run, Run) else load(run) for run in given]
        held = [(run, sequence) for run in opened for sequence in run.record["sequences"]]
        refuse_unknown(sequences or [], (sequence["name"] for _, sequence in held), "sequence")
        chosen = [one for one in held if sequences is None or one[1]["name"] in sequences]
        refuse_unknown(radars or [], (radar for run, one in chosen for radar in run.radars_of(one["name"])), "radar")
        self._refuse_other_features(chosen)
        if truth is None:
            self._warn_of_corrections(chosen, radars)
        truths = [truth if isinstance(truth, Truth | None) else Truth(truth, run) for run in opened]
        for run, sequence in chosen:
            self._truths.append(truths[opened.index(run)])
            self._add(run.out, sequence, radars)

    @staticmethod
    def _warn_of_corrections(chosen: Sequence[tuple[Run, dict[str, Any]]], radars: list[str] | None) -> None:
        """Warn of runs where people corrected something of what was chosen."""
        for run, held in groupby(chosen, lambda one: one[0]):
            if _ralf.is_corrected(run.out, [sequence["name"] for _, sequence in held], radars):
                warn_of([f"{run.out}: what people corrected doesn't count without `truth`"])

    def _refuse_other_features(self, chosen: Sequence[tuple[Run, dict[str, Any]]]) -> None:
        """Refuse features that a table has no column of: a training may read that table hours later."""
        for run, held in groupby(chosen, lambda one: one[0]):
            for columns in _ralf.columns(run.out, [sequence["name"] for _, sequence in held]):
                refuse_unknown(self.features, columns, "column of numbers")

    def _add(self, out: Path, sequence: dict[str, object], radars: Sequence[str] | None) -> None:
        """Count a sequence's scans that hold detections, without reading its table."""
        held: list[int] = []
        place = 0
        for radar in sequence["radars"]:  # type: ignore[attr-defined]
            for detections in radar["detections"]:
                if detections > 0:
                    if radars is None or radar["name"] in radars:
                        held.append(place)
                    place += 1
        self._scans.append((out, str(sequence["name"]), held))
        self._ends.append((self._ends[-1] if self._ends else 0) + len(held))

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def __getitem__(self, index: int) -> Sample:
        number = index + len(self) if index < 0 else index
        if not 0 <= number < len(self):
            raise IndexError(f"expected a scan of {len(self)}, counted from 0 or backwards from -1, found {index}")
        part = bisect_right(self._ends, number)
        held = self._scans[part][2]
        return self.sample(part, self.read(part)[held[number - (self._ends[part] - len(held))]])

    def read(self, part: int) -> list[Scan]:
        """All scans of a sequence that hold detections; the last sequence that was asked for stays in memory."""
        # Another thread may open another sequence at any moment.
        held = self._open
        if held is None or held[0] != part:
            out, sequence, _ = self._scans[part]
            held = self._open = (part, list(load(out).scans(sequence)))
        return held[1]

    def sample(self, part: int, scan: Scan) -> Sample:
        """A scan as tensors."""
        columns = [np.nan_to_num(scan[name], nan=0.0, posinf=0.0, neginf=0.0) for name in self.features]
        truth = self._truths[part]
        label = scan.label if truth is None else truth.labels(self._scans[part][1], scan)
        features = np.stack(columns, axis=1).astype(np.float32)
        return {
            "features": torch.from_numpy(features),
            "label": torch.from_numpy(label.astype(np.int64)),
            "w": torch.from_numpy(scan.w.copy()),
        }

    # What is open stays behind when a loader sends the dataset to its workers.
    def __getstate__(self) -> dict[str, object]:
        return self.__dict__ | {"_open": None}

    @property
    def parts(self) -> list[list[int]]:
        """The scans of each sequence, by their places in it."""
        return [held for _, _, held in self._scans]


class ScanStream(IterableDataset[Sample]):
    """The same scans in order, sequence by sequence: a table is read once, and workers share the sequences out.

    With `shuffle` the sequences and the scans of each are in another order with every seed, and every time that they
    are gone through: in a loader's workers by what torch draws, so that `torch.manual_seed` makes a training the same
    again.
    """

    def __init__(self, dataset: ScanDataset, *, shuffle: bool = False, seed: int = 0) -> None:
        self._dataset = dataset
        self._shuffle = shuffle
        self.seed = seed
        self._times = 0

    def __iter__(self) -> Iterator[Sample]:
        worker = get_worker_info()
        number, of = (0, 1) if worker is None else (worker.id, worker.num_workers)
        parts = list(range(len(self._dataset.parts)))
        # A loader's workers begin anew with every epoch unless they persist; all of them draw the same order.
        drawn = 0 if worker is None else worker.seed - worker.id
        chance = np.random.default_rng([self.seed, drawn, self._times])
        self._times += 1
        if self._shuffle:
            chance.shuffle(parts)
        for part in parts[number::of]:
            places = list(self._dataset.parts[part])
            if self._shuffle:
                chance.shuffle(places)
            scans = self._dataset.read(part)
            for place in places:
                yield self._dataset.sample(part, scans[place])


def collate(samples: Sequence[Sample]) -> Batch:
    """Scans of different sizes, one after the other."""
    sizes = torch.tensor([len(sample["label"]) for sample in samples])
    return {
        "features": torch.cat([sample["features"] for sample in samples]),
        "label": torch.cat([sample["label"] for sample in samples]),
        "w": torch.cat([sample["w"] for sample in samples]),
        "scan": torch.repeat_interleave(torch.arange(len(samples)), sizes),
    }
