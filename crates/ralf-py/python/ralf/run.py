"""Labelling, and what it leaves."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ralf import _ralf, _told
from ralf._jobs import Path_, Settings, above_0, job
from ralf._progress import Progress, listener
from ralf._warnings import warn_of
from ralf.recording import Recording


@dataclass(frozen=True)
class Scan:
    """A labelled scan. Columns are views into the sequence's table, in the order of the scan's detections."""

    radar: str
    number: int
    table: _ralf.Table
    _rows: tuple[int, slice]

    def __getitem__(self, column: str) -> NDArray[Any]:
        batch, rows = self._rows
        whole: NDArray[Any] = np.asarray(self.table.column(column, batch))
        return whole[rows]

    def __len__(self) -> int:
        rows = self._rows[1]
        return int(rows.stop - rows.start)

    @property
    def t_ns(self) -> int:
        """The time of the scan, ns."""
        return int(self["t_ns"][0])

    @property
    def xyz(self) -> NDArray[np.float32]:
        """Positions in the vehicle's frame at the scan's time, m; n x 3. Columns lie apart, so that this is a copy."""
        return np.stack([self["x"], self["y"], self["z"]], axis=1)

    @property
    def w(self) -> NDArray[np.float32]:
        """Plausibilities in [0, 1]."""
        return self["w"]

    @property
    def label(self) -> NDArray[np.uint8]:
        """1 plausible, 0 artifact."""
        return self["label"]

    @property
    def flags(self) -> NDArray[np.uint16]:
        """What was special about each detection, as bits."""
        return self["flags"]

    @property
    def evidence(self) -> dict[str, NDArray[np.float32]]:
        """What else is known of each detection, where it was gathered."""
        columns = self.table.columns
        after = columns[columns.index("semantic") + 1 :]
        found = {}
        for name in after:
            try:
                found[name] = self[name]
            except TypeError:  # Words are no numbers.
                continue
        return found


def scans_of(table: _ralf.Table, radars: Iterable[str], radar: str | None = None) -> Iterator[Scan]:
    """The scans of a table that has these radars, in its order; of one radar, or of all. Empty ones have no row."""
    if radar is not None:
        refuse_unknown([radar], radars, "radar")
    return (
        Scan(name, number, table, (batch, slice(first, first + rows)))
        for name, number, batch, first, rows in table.scans
        if rows > 0 and (radar is None or name == radar)
    )


def refuse_unknown(wanted: Iterable[str], known: Iterable[str], kind: str) -> None:
    """Refuse names that there are none of: what is asked for by such a name would be empty without a word."""
    names = list(dict.fromkeys(known))
    for name in wanted:
        if name not in names:
            raise KeyError(f"expected a {kind} of {', '.join(names)}, found {name}")


class Run:
    """What labelling left in a folder: a table per sequence, and a record."""

    def __init__(self, out: Path_, recording: Path_ | None = None) -> None:
        self.out = Path(os.fsdecode(out)).absolute()
        self.recording = None if recording is None else Path(os.fsdecode(recording)).absolute()
        """Where the recording lies, as far as it is known."""
        self.labelled: list[str] = []
        """Sequences that this call has labelled; the others were labelled before."""
        self.warnings: list[str] = []
        """What this call warns of: what readers ignored or miss, what lies outside of the known motion, and radars
        whose labels are unlike the others'."""
        self._told = _ralf.record(self.out)

    @cached_property
    def record(self) -> dict[str, Any]:
        """What run.json tells: version, settings, inputs, flags, timings."""
        record: dict[str, Any] = json.loads(self._told)
        return record

    @property
    def sequences(self) -> list[str]:
        """The names of the labelled sequences."""
        return [sequence["name"] for sequence in self.record["sequences"]]

    @property
    def not_labelled(self) -> list[tuple[str, str, int, str]]:
        """Scans that can't be labelled: sequence, radar, scan, reason."""
        return _told.not_labelled(self.record)

    @property
    def lost(self) -> list[tuple[str, str]]:
        """What of the recording can't be read and may have held scans that nothing else tells of: sequence, what."""
        return _told.lost(self.record)

    @property
    def labelled_without(self) -> list[tuple[str, str, int, str]]:
        """Scans and images that can't be used, which others were labelled without: sequence, sensor, number, reason."""
        return _told.labelled_without(self.record)

    @property
    def doubts(self) -> list[tuple[str, str, str]]:
        """What the check says against the recording: sequence, a sensor or `motion`, and what is doubted."""
        return _told.doubts(self.record)

    def radars_of(self, sequence: str) -> list[str]:
        """The names of a sequence's radars, those without any detection among them."""
        told = (told for told in self.record["sequences"] if told["name"] == sequence)
        return [radar["name"] for one in told for radar in one["radars"]]

    def __getitem__(self, sequence: str) -> _ralf.Table:
        """All labelled detections of a sequence; Arrow libraries read them without a copy."""
        return _ralf.table(self.out, sequence)

    def __iter__(self) -> Iterator[str]:
        return iter(self.sequences)

    def __len__(self) -> int:
        return len(self.sequences)

    def scans(self, sequence: str, radar: str | None = None) -> Iterator[Scan]:
        """The scans of a sequence, radar by radar; of one radar, or of all."""
        return scans_of(self[sequence], self.radars_of(sequence), radar)

    def __repr__(self) -> str:
        return f"Run({str(self.out)!r}, sequences={self.sequences})"

    def _repr_html_(self) -> str:
        rows = []
        for sequence in self.record["sequences"]:
            for radar in sequence["radars"]:
                detections, plausible = sum(radar["detections"]), sum(radar["plausible"])
                share = f"{plausible / detections:.1%}" if detections else "-"
                cells = [sequence["name"], radar["name"], len(radar["detections"]), detections, share]
                rows.append("<tr>" + "".join(f"<td>{_escaped(cell)}</td>" for cell in cells) + "</tr>")
        head = "".join(f"<th>{name}</th>" for name in ("sequence", "radar", "scans", "detections", "plausible"))
        return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _escaped(value: object) -> str:
    return str(value).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def label(
    recording: Recording | Path_,
    out: Path_,
    *,
    settings: Settings = None,
    method: str | None = None,
    model: Path_ | None = None,
    format: str | None = None,  # noqa: A002
    sequences: Iterable[str] | None = None,
    depth: Path_ | None = None,
    segmentation: Path_ | None = None,
    evidence: bool = False,
    check: bool = True,
    jobs: int | None = None,
    progress: Progress = None,
) -> Run:
    """Label every radar detection of a recording, as `ralf label` does: the same bytes, and resumable like it.

    `settings` is a mapping (`{"lidar.beta": 0.5}`) or a TOML file. A `Recording` brings the settings that it was opened
    with, its format and its sequences; what is given here counts above them, settings key by key. `method` is "paper"
    or "learned", which asks `model`, the shipped one if not given. `depth` is a folder of depth images, `segmentation`
    one of segmentations. `jobs` is the number of threads, as many as there are processors if not given. Ctrl-C stops
    it, and what is done is kept. What becomes of earlier results in `out`, those of other settings that are removed
    among them, is a warning. So is what `ralf label` warns of: what readers ignored, what the check doubts, what could
    not be labelled, and what others were labelled without. Of many warnings of a kind the first few are given, and the
    `Run` has all.
    """
    path, below = (recording.path, recording.settings) if isinstance(recording, Recording) else (recording, None)
    if isinstance(recording, Recording):
        format = format or recording.format  # noqa: A001
        # Of a recording that was opened whole, sequences that are gone are told.
        sequences = recording.chosen if sequences is None else sequences
    told = job(
        path,
        out,
        settings=settings,
        method=method,
        model=model,
        format=format,
        sequences=sequences,
        depth=depth,
        segmentation=segmentation,
        evidence=evidence,
        check=check,
        below=below,
    )
    labelled, asked, earlier, warnings = _ralf.label(told, above_0(jobs, "jobs"), listener(progress))
    run = Run(out, path)
    run.labelled, run.warnings = labelled, warnings
    # Whoever has opened the recording knows what its readers warn of.
    known = recording.warnings if isinstance(recording, Recording) else []
    new = [warning for warning in warnings if warning not in known]
    warn_of([*earlier, *_told.warnings_of_run(run.record, asked, new)])
    return run


def load(out: Path_, recording: Path_ | None = None) -> Run:
    """Open what `ralf label` wrote; `recording` is needed for pictures."""
    return Run(out, recording)
