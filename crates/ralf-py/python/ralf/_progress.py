"""Progress, for people."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

Callback = Callable[[str, str, int, int, int], object]
Progress = bool | Callback | None
"""True draws a bar on standard error; a function is called with stage, name, done, steps and detections."""


def listener(progress: Progress) -> Callback | None:
    """What is called with each step."""
    if progress is True:
        return _Bar()
    return progress if callable(progress) else None


class _Bar:
    """A line on standard error that is written over."""

    def __init__(self) -> None:
        self._stage: tuple[str, str] | None = None
        self._begun = 0.0
        self._told = 0.0

    def __call__(self, stage: str, name: str, done: int, steps: int, detections: int) -> None:
        now = time.monotonic()
        if (stage, name) != self._stage:
            self._stage, self._begun, self._told = (stage, name), now, 0.0
        if now - self._told < 0.2 and done < steps:
            return
        self._told = now
        share = done / steps if steps else 1.0
        seconds = now - self._begun
        # Of a stage that has only begun, or was over at once, a rate says nothing.
        rate = f"  {detections / seconds / 1e3:.0f}k detections/s" if detections and seconds > 0.2 else ""
        bar = "#" * round(24 * share)
        end = "\n" if done >= steps else ""
        print(f"\r{stage} {name} [{bar:<24}] {share:4.0%}{rate}\033[K", end=end, file=sys.stderr, flush=True)
