"""Many recordings on many machines: what is to be done, one part of it, and putting the parts together.

tasks = ralf.plan(["recordings/a", "recordings/b"], "out")
for task in tasks:                       # in any order, on any machine that sees the same folders, twice if need be
    ralf.label_one(task)
ralf.assemble("out")                     # what one machine would have written, to the byte
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ralf import _ralf, _told
from ralf._jobs import Job, Path_, Settings, above_0, job, utf8
from ralf._progress import Progress, listener
from ralf._warnings import warn_of
from ralf.run import Run

SCANS = 2048
"""Radar scans of a task, if not said: some ten seconds of work for one core."""

Done = tuple[list[str], list[str], list[str], list[str]]
"""What `_ralf.assemble` tells: sequences it labelled, those asked for, what became of earlier results, warnings."""


class Task(str):
    """A stretch of a sequence of a recording, as JSON: it can be sent anywhere."""

    @property
    def told(self) -> dict[str, Any]:
        """What it is."""
        told: dict[str, Any] = json.loads(self)
        return told

    @property
    def name(self) -> str:
        """Recording, sequence and stretch, for people."""
        told = self.told
        stretch = told["stretch"]
        name = Path(told["job"]["out"]).name
        return f"{name}/{stretch['sequence']} {stretch['number'] + 1} of {stretch['of']}"

    @property
    def out(self) -> Path:
        """Where its recording's results go."""
        return Path(self.told["job"]["out"])


@dataclass
class Plan(Sequence[Task]):
    """The tasks of recordings, and those recordings that can't be planned, with the reason."""

    tasks: list[Task] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)

    def __getitem__(self, index: Any) -> Any:
        return self.tasks[index]

    def __len__(self) -> int:
        return len(self.tasks)


@dataclass
class Assembled:
    """What became of recordings, by the names of their folders."""

    runs: dict[str, Run] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)
    """Recordings without results, with the reason."""


def plan(
    recordings: Iterable[Path_] | Path_,
    out: Path_,
    *,
    settings: Settings = None,
    method: str | None = None,
    model: Path_ | None = None,
    depth: Path_ | None = None,
    segmentation: Path_ | None = None,
    evidence: bool = False,
    check: bool = True,
    scans: int = SCANS,
    jobs: int | None = None,
    progress: Progress = None,
) -> Plan:
    """Plan what is left to be done of recordings, or of one: tasks of so many radar scans at most, for `label_one`.

    The results of a recording go to a folder of its name in `out`. `depth` and `segmentation` are folders that `ralf
    depth -o` and `ralf segment -o` wrote. Every file is read once, for its hash. A recording that can't be opened is
    named in `failed`, and costs the others nothing. What `out` holds of a recording with other settings is removed,
    which is a warning; so is a sequence that can't be read, and is left out. Plans and tasks tell paths as text, which
    must be UTF-8.
    """
    found = Plan()
    above_0(scans, "scans")
    above_0(jobs, "jobs")
    planned = jobs_of(
        recordings,
        out,
        settings=settings,
        method=method,
        model=model,
        depth=depth,
        segmentation=segmentation,
        evidence=evidence,
        check=check,
    )
    for told in planned:
        name = Path(told.out).name
        try:
            tasks, warnings = _ralf.plan(told, scans, jobs, listener(progress))
        except _ralf.RalfError as error:
            found.failed[name] = str(error)
            continue
        found.tasks += map(Task, tasks)
        warn_of([f"{name}: {what}" for what in warnings])
    return found


def jobs_of(
    recordings: Iterable[Path_] | Path_,
    out: Path_,
    *,
    settings: Settings = None,
    method: str | None = None,
    model: Path_ | None = None,
    depth: Path_ | None = None,
    segmentation: Path_ | None = None,
    evidence: bool = False,
    check: bool = True,
) -> list[Job]:
    """The jobs of recordings, or of one, each with a folder of its own in `out`. Nothing of a recording is read.

    Two recordings of one name, settings that are none, and paths that no plan can tell are refused.
    """
    for name, place in (("model", model), ("depth", depth), ("segmentation", segmentation)):
        if place is not None:
            utf8(place, name)
    # The letters of a path are no recordings.
    given = [recordings] if isinstance(recordings, str | bytes | os.PathLike) else recordings
    places = [utf8(recording, "recordings") for recording in given]
    asked = [
        job(
            recording,
            folder,
            settings=settings,
            method=method,
            model=model,
            depth=depth,
            segmentation=segmentation,
            evidence=evidence,
            check=check,
        )
        for recording, folder in zip(places, _ralf.folders(places, utf8(out, "out")), strict=True)
    ]
    if len(asked) > 1 and any(one.settings.get("motion", {}).get("trajectory") for one in asked):
        raise ValueError(f"motion.trajectory: expected one recording, whose motion it tells, found {len(asked)}")
    return asked


def label_one(task: str, *, jobs: int | None = 1, progress: Progress = None) -> list[dict[str, Any]]:
    """Label a task's scans, as far as nobody has. Returns the scans that can't be labelled, with the reason."""
    failed: list[dict[str, Any]] = json.loads(_ralf.label_one(task, above_0(jobs, "jobs"), listener(progress)))
    return failed


def assemble(out: Path_, *, jobs: int | None = None, progress: Progress = None) -> Assembled:
    """Put together what tasks have labelled, recording by recording. Scans that nobody has labelled are labelled now.

    A recording that can't be read is named in `failed`, and costs the others nothing. A folder that nothing was planned
    for is refused. What `ralf.label` warns of is a warning here, after the recording's name.
    """
    found = Assembled()
    above_0(jobs, "jobs")
    for folder in _ralf.planned(os.fsdecode(out)):
        name = Path(folder).name
        try:
            done = _ralf.assemble(folder, jobs, listener(progress))
        except _ralf.RalfError as error:
            found.failed[name] = str(error)
            continue
        found.runs[name], warnings = run_of(folder, done)
        warn_of(warnings)
    return found


def run_of(folder: Path_, done: Done) -> tuple[Run, list[str]]:
    """The run of a recording that was put together, by what `_ralf.assemble` told, and what to warn of."""
    labelled, asked, earlier, warnings = done
    run = Run(folder, recording_of(folder))
    run.labelled, run.warnings = labelled, warnings
    told = [*earlier, *_told.warnings_of_run(run.record, asked, warnings)]
    return run, [f"{run.out.name}: {what}" for what in told]


def recording_of(out: Path_) -> str:
    """Where the recording lies that was planned for this folder."""
    told: dict[str, Any] = json.loads((Path(os.fsdecode(out)) / "plan.json").read_text(encoding="utf-8"))
    return str(told["recording"])
