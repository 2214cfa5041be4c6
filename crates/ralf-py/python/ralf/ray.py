"""Labelling on a Ray cluster: `pip install ralf-radar[ray]`.

import ralf.ray

done = ralf.ray.label(recordings, "/shared/out", address="auto")
done.failed          # recordings without results, with the reason
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path

import ray

import ralf
from ralf import _ralf, many
from ralf._jobs import Job, Path_, Settings, above_0
from ralf._warnings import warn_of
from ralf.many import Assembled, Done, Plan, Task

RETRIES = 5
"""A task that lost its worker or its node is done again so many times."""


def label(
    recordings: Iterable[Path_] | Path_,
    out: Path_,
    *,
    address: str | None = None,
    settings: Settings = None,
    method: str | None = None,
    model: Path_ | None = None,
    depth: Path_ | None = None,
    segmentation: Path_ | None = None,
    evidence: bool = False,
    check: bool = True,
    scans: int = many.SCANS,
    progress: bool | Callable[[int, int], object] = True,
) -> Assembled:
    """Label recordings, or one, on a Ray cluster: what `ralf.label` writes of each to a folder of its name in `out`.

    All nodes see the folders of recordings and results under the same paths; relative ones are meant from where this is
    called. Each recording is planned, labelled in stretches and put together on the cluster, a core at a time. What a
    lost node was at is done by another, a second call goes on where the first one stopped, and a recording that can't
    be labelled is named in `failed`. `settings` to `scans` are those of `ralf.plan`, and what it refuses is refused
    before the cluster is asked for anything; `progress` may be a function of tasks done and known. What `ralf.plan` and
    `ralf.assemble` warn of is a warning here, too.
    """
    above_0(scans, "scans")
    asked = many.jobs_of(
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
    if not asked:
        raise ValueError("recordings: expected one or more, found none")
    # Workers have folders of their own.
    jobs = [job.anywhere() for job in asked]
    told = _teller(progress)
    if not ray.is_initialized():
        ray.init(address=address, log_to_driver=False)
    plan, warnings = _plan_all(jobs, scans)
    warn_of(warnings)
    failed = plan.failed | _label_all(plan.tasks, told)
    done, warnings = _assemble_all([job.out for job in jobs], failed)
    warn_of(warnings)
    return done


def _plan_all(jobs: list[Job], scans: int) -> tuple[Plan, list[str]]:
    """What is left to be done of all jobs, and what to warn of."""
    plan = Plan()
    warnings: list[str] = []
    references = {Path(job.out).name: _plan.remote(job, scans) for job in jobs}
    for name, reference in references.items():
        try:
            tasks, found = ray.get(reference)
        except ray.exceptions.RayError as error:
            plan.failed[name] = _reason(error)
            continue
        plan.tasks += map(Task, tasks)
        warnings += [f"{name}: {what}" for what in found]
    return plan, warnings


def _label_all(tasks: list[Task], told: Callable[[int, int], object]) -> dict[str, str]:
    """Label all tasks. Returns recordings that lost one for good, with the reason."""
    pending = {_label_one.remote(task): task for task in tasks}
    lost: dict[str, str] = {}
    told(0, len(tasks))
    while pending:
        ready, _ = ray.wait(list(pending), num_returns=1)
        for reference in ready:
            task = pending.pop(reference)
            try:
                ray.get(reference)
            except ray.exceptions.RayError as error:
                lost[task.out.name] = f"{task.name}: {_reason(error)}"
            told(len(tasks) - len(pending), len(tasks))
    return lost


def _assemble_all(folders: list[str], failed: dict[str, str]) -> tuple[Assembled, list[str]]:
    """Put all recordings together but those that have failed. Tells what to warn of, too."""
    done = Assembled(failed=dict(failed))
    warnings: list[str] = []
    references = {folder: _assemble.remote(folder) for folder in folders if Path(folder).name not in failed}
    for folder, reference in references.items():
        name = Path(folder).name
        try:
            told = ray.get(reference)
        except ray.exceptions.RayError as error:
            done.failed[name] = _reason(error)
            continue
        done.runs[name], found = many.run_of(folder, told)
        warnings += found
    return done, warnings


@ray.remote(num_cpus=1, max_retries=RETRIES)
def _plan(job: Job, scans: int) -> tuple[list[str], list[str]]:
    return _ralf.plan(job, scans, 1)


@ray.remote(num_cpus=1, max_retries=RETRIES)
def _label_one(task: str) -> int:
    return len(ralf.label_one(Task(task), jobs=1))


@ray.remote(num_cpus=1, max_retries=RETRIES)
def _assemble(folder: str) -> Done:
    # A lost node's last task may hold its lock until the file system notices.
    for _ in range(60):
        try:
            return _ralf.assemble(folder, 1)
        except ralf.RalfError as error:
            if "another run of ralf" not in str(error):
                raise
            time.sleep(1.0)
    return _ralf.assemble(folder, 1)


def _reason(error: Exception) -> str:
    """What went wrong, without the stack of another machine: all that a task has raised says, or Ray's own sentence."""
    cause = getattr(error, "cause", None)
    if isinstance(cause, Exception):
        return str(cause) or type(cause).__name__
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__


def _teller(progress: bool | Callable[[int, int], object]) -> Callable[[int, int], object]:
    if callable(progress):
        return progress
    begun = time.monotonic()

    def tell(done: int, known: int) -> None:
        if progress:
            seconds = time.monotonic() - begun
            end = "\n" if done == known else ""
            print(f"\r{done} of {known} tasks, {seconds:.0f} s\033[K", end=end, file=sys.stderr, flush=True)

    return tell
