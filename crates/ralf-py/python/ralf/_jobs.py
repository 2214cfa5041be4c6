"""How a recording is labelled, as the compiled module wants it told."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ralf import _ralf

Settings = Mapping[str, Any] | str | os.PathLike[str] | None


def settings_json(settings: Settings, method: str | None = None) -> Any:
    """All settings: of a TOML file, or of a mapping whose keys are `lidar.beta` or `lidar` with a mapping below it."""
    text = ""
    assignments: list[str] = []
    if isinstance(settings, Mapping):
        assignments = [f"{key}={_toml(value)}" for key, value in _flat(settings)]
    elif settings is not None:
        text = Path(settings).read_text(encoding="utf-8")
    if method is not None:
        assignments.append(f"method={_toml(method)}")
    return json.loads(_ralf.settings(text, assignments))


def _flat(settings: Mapping[str, Any], before: str = "") -> list[tuple[str, Any]]:
    """Nested mappings as dotted keys."""
    found: list[tuple[str, Any]] = []
    for key, value in settings.items():
        if isinstance(value, Mapping):
            found += _flat(value, f"{before}{key}.")
        else:
            found.append((before + key, value))
    return found


def _toml(value: Any) -> str:
    """A value as TOML has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    if isinstance(value, str | os.PathLike):
        return json.dumps(os.fspath(value))
    # NumPy's numbers are told as Python's.
    return repr(value.item() if hasattr(value, "item") else value)


def job(
    recording: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    settings: Settings = None,
    method: str | None = None,
    model: str | os.PathLike[str] | None = None,
    format: str | None = None,  # noqa: A002
    sequences: list[str] | None = None,
    depth: str | os.PathLike[str] | None = None,
    segmentation: str | os.PathLike[str] | None = None,
    evidence: bool = False,
    check: bool = True,
) -> str:
    """A job, as JSON."""
    told: dict[str, Any] = {
        "recording": os.fspath(recording),
        "out": os.fspath(out),
        "format": format,
        "sequences": sequences or [],
        "settings": settings_json(settings, method),
        "evidence": evidence,
        "model": None if model is None else os.fspath(model),
        "depth": None if depth is None else os.fspath(depth),
        "check": check,
    }
    # A plan without one is told as those before there were any.
    if segmentation is not None:
        told["segmentation"] = os.fspath(segmentation)
    return json.dumps(told)
