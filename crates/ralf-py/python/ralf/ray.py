"""Labelling on a Ray cluster: `pip install ralf-radar[ray]`.

import ralf.ray

done = ralf.ray.label(recordings, "/shared/out", address="auto")
done.failed          # recordings without results, with the reason
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import ray

import ralf
from ralf.many import Assembled, Plan, Task

RETRIES = 5
"""A task that lost its worker or its node is done again so many times."""


def label(
    recordings: Sequence[str | os.PathLike[str]] | str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    address: str | None = None,
    scans: int = ralf.many.SCANS,
    progress: bool | Callable[[int, int], object] = True,
    **options: Any,
) -> Assembled:
    """Label recordings, or one, on a Ray cluster: what `ralf.label` writes of each to a folder of its name in `out`.

    All nodes see the folders of recordings and results under the same paths. Each recording is planned, labelled in
    stretches and put together on the cluster, a core at a time. What a lost node was at is done by another, a second
    call goes on where the first one stopped, and a recording that can't be labelled is named in `failed`. `options` are
    those of `ralf.plan`; `progress` may be a function of tasks done and known.
    """
    if not ray.is_initialized():
        ray.init(address=address, log_to_driver=False)
    told = _teller(progress)
    if isinstance(recordings, str | os.PathLike):
        recordings = [recordings]
    plans = [_plan.remote(os.fspath(recording), os.fspath(out), scans, options) for recording in recordings]
    plan = Plan()
    for recording, reference in zip(recordings, plans, strict=True):
        name = Path(recording).name
        try:
            found = ray.get(reference)
            plan.tasks += found.tasks
            plan.failed |= found.failed
        except ray.exceptions.RayError as error:
            plan.failed[name] = _sentence(error)
    lost = _label_all(plan.tasks, told)
    return _assemble_all(Path(out), plan.failed | lost)


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
                lost[task.out.name] = f"{task.name}: {_sentence(error)}"
            told(len(tasks) - len(pending), len(tasks))
    return lost


def _assemble_all(out: Path, failed: dict[str, str]) -> Assembled:
    """Put all recordings together but those that have failed."""
    done = Assembled(failed=dict(failed))
    try:
        folders = [Path(folder) for folder in ralf._ralf.planned(out)]
    except ralf.RalfError:
        # Where no recording could be planned, there is nothing to put together: each is named with its reason.
        if failed:
            return done
        raise
    references = {folder: _assemble.remote(os.fspath(folder)) for folder in folders if folder.name not in failed}
    for folder, reference in references.items():
        try:
            found = ray.get(reference)
        except ray.exceptions.RayError as error:
            done.failed[folder.name] = _sentence(error)
            continue
        done.failed |= found
        if not found:
            done.runs[folder.name] = ralf.load(folder, ralf.many.recording_of(folder))
    return done


@ray.remote(num_cpus=1, max_retries=RETRIES)
def _plan(recording: str, out: str, scans: int, options: dict[str, Any]) -> Plan:
    return ralf.plan([recording], out, scans=scans, jobs=1, **options)


@ray.remote(num_cpus=1, max_retries=RETRIES)
def _label_one(task: str) -> int:
    return len(ralf.label_one(Task(task), jobs=1))


@ray.remote(num_cpus=1, max_retries=RETRIES)
def _assemble(folder: str) -> dict[str, str]:
    # A lost node's last task may hold its lock until the file system notices.
    for _ in range(60):
        failed = ralf.assemble(folder, jobs=1).failed
        if not any("another run of ralf" in reason for reason in failed.values()):
            break
        time.sleep(1.0)
    return failed


def _sentence(error: Exception) -> str:
    """What went wrong, without the stack of another machine."""
    cause = getattr(error, "cause", None)
    lines = str(cause or error).strip().splitlines()
    return lines[-1] if lines else type(error).__name__


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
