"""How good labels are, and what they look like."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ralf import _ralf
from ralf._jobs import Path_, anywhere, whole
from ralf._warnings import warn_of
from ralf.run import Run, Scan


class Evaluation(dict[str, Any]):
    """What `ralf evaluate --json` prints; a table in a notebook."""

    def _repr_html_(self) -> str:
        overall = self.get("overall", {})
        columns = overall if all(isinstance(value, dict) for value in overall.values()) else {"overall": overall}
        names = list(dict.fromkeys(name for column in columns.values() for name in column))
        head = "".join(f"<th>{name}</th>" for name in ["", *columns])
        rows = [
            f"<tr><th>{name}</th>"
            + "".join(f"<td>{_told(column.get(name))}</td>" for column in columns.values())
            + "</tr>"
            for name in names
        ]
        return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _told(value: object) -> str:
    return f"{value:.3f}" if isinstance(value, float) else str(value)


def evaluate(run: Run | Path_, truth: Path_ | None = None) -> Evaluation:
    """Compare labels with the corrected ones of a dataset, as `ralf evaluate`; without a truth, how balanced they are.

    Corrections of a review in the run's folder count above the dataset's. Those of scans that hold other detections now
    don't: each such scan is a warning.
    """
    known = None if truth is None else os.fsdecode(truth)
    told, orphaned = _ralf.evaluate(_out(run), known)
    warn_of(orphaned)
    return Evaluation(json.loads(told))


def _out(run: Run | Path_) -> str:
    return os.fsdecode(run.out if isinstance(run, Run) else run)


class Truth:
    """What is true of a dataset's detections, as far as people, a simulator or its format say it.

    With a `run`, what people corrected in its review counts above that; one of another recording is refused. Each scan
    whose corrections don't count, for it holds other detections now, is a warning.
    """

    def __init__(self, dataset: Path_, run: Run | Path_ | None = None) -> None:
        self._told = (anywhere(os.fsdecode(dataset)), None if run is None else anywhere(_out(run)))
        self._truth = _ralf.Truth(*self._told)
        warn_of(self._truth.orphaned)

    def labels(self, sequence: str, scan: Scan) -> NDArray[np.int8]:
        """Of each detection of a labelled scan: 1 plausible, 0 artifact, -1 unknown.

        A sequence that neither the dataset nor the run has is refused.
        """
        column = self._truth.labels(sequence, scan.radar, scan.number)
        if column is None:
            return np.full(len(scan), -1, np.int8)
        if len(column) != len(scan):
            place = f"{sequence}, {scan.radar}, scan {scan.number}"
            raise ValueError(f"{place}: expected the truth of {len(scan)} detections, found {len(column)}")
        return np.asarray(column)

    def __reduce__(self) -> tuple[type[Truth], tuple[Any, ...]]:
        return Truth, self._told


class Picture:
    """A PNG that notebooks show."""

    def __init__(self, png: bytes) -> None:
        self.png = png

    def save(self, file: Path_) -> None:
        """Write it to a file, whose name ends in `.png` if it has an ending."""
        path = Path(os.fsdecode(file))
        if path.suffix.lower() not in {"", ".png"}:
            raise ValueError(f"expected a name that ends in .png, found {path}")
        path.write_bytes(self.png)

    def _repr_png_(self) -> bytes:
        return self.png


def plot(
    run: Run,
    sequence: str,
    scan: int | None = None,
    *,
    radar: str | None = None,
    radius: float | None = None,
    color_by: str | None = None,
    recording: Path_ | None = None,
    width: int = 1600,
) -> Picture:
    """Draw a labelled scan from above, or the whole sequence where no scan is given.

    Without `radar` all radars are drawn: the first one's scan, and the others' nearest to it in time. `radius` is in
    m; `color_by` names a column of numbers that a scan is coloured by, and wants one. The picture is `width` pixels
    wide. The recording is the run's own if not given. Scans that could not be labelled are a warning each, and so are
    LiDAR scans that can't be read, without which it is drawn; a picture of scans without labels alone is refused: it
    would show that nothing is plausible.
    """
    source = recording or run.recording
    if source is None:
        raise ValueError("expected a recording: plot(..., recording=...) or load(out, recording)")
    if color_by is not None and scan is None:
        raise ValueError(f"color_by: expected a scan to colour, plot(..., scan=...), found none beside {color_by!r}")
    number = None if scan is None else whole(scan, "scan")
    pixels = whole(width, "width", 2**32 - 1)
    png, lacking = _ralf.plot(run.out, os.fsdecode(source), sequence, number, radar, radius, color_by, pixels)
    warn_of(lacking)
    return Picture(png)
