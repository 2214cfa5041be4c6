"""How a recording is labelled, as the compiled module wants it told."""

from __future__ import annotations

import json
import operator
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ralf import _ralf

Path_ = str | bytes | os.PathLike[str] | os.PathLike[bytes]
Settings = Mapping[str, Any] | Path_ | None


def settings_json(settings: Settings, method: str | None = None) -> Any:
    """All settings: of a TOML file, or of a mapping whose keys are `lidar.beta` or `lidar` with a mapping below it."""
    file: str | None = None
    assignments: list[str] = []
    if isinstance(settings, Mapping):
        assignments = [f"{key}={_toml(value)}" for key, value in _flat(settings)]
    elif settings is not None:
        file = os.fsdecode(settings)
    if method is not None:
        assignments.append(f"method={_toml(method)}")
    return json.loads(_ralf.settings(file, assignments))


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
        return json.dumps(os.fspath(value), ensure_ascii=False)
    # NumPy's numbers are told as Python's.
    return repr(value.item() if hasattr(value, "item") else value)


def utf8(value: Path_, what: str) -> str:
    """A path as text: plans and tasks are JSON, which has no word for other bytes than UTF-8."""
    text = os.fsdecode(value)
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{what}: expected a path in UTF-8, found {os.fsencode(text)!r}") from None
    return text


def above_0(value: int | None, what: str) -> int | None:
    """A number of something that there has to be one of, if it is given."""
    if value is not None and value < 1:
        raise ValueError(f"{what}: expected a number above 0, found {value}")
    return None if value is None else whole(value, what)


def whole(value: int, what: str, most: int = sys.maxsize) -> int:
    """A whole number from 0 to `most`: Python's own may be below, and of any size."""
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{what}: expected a whole number, found {value!r}") from None
    if not 0 <= found <= most:
        raise ValueError(f"{what}: expected {'0 or more' if found < 0 else f'at most {most}'}, found {found}")
    return found


@dataclass(frozen=True)
class Job:
    """What is labelled, how, and where to. Paths are as Python has them, of whatever bytes; all else is JSON."""

    recording: str
    out: str
    model: str | None
    depth: str | None
    segmentation: str | None
    told: str


def job(
    recording: Path_,
    out: Path_,
    *,
    settings: Settings = None,
    method: str | None = None,
    model: Path_ | None = None,
    format: str | None = None,  # noqa: A002
    sequences: list[str] | None = None,
    depth: Path_ | None = None,
    segmentation: Path_ | None = None,
    evidence: bool = False,
    check: bool = True,
) -> Job:
    """A job, with its settings resolved."""
    resolved = settings_json(settings, method)
    if model is not None and resolved["method"] != "learned":
        raise ValueError(f'model: expected the method that asks one, method="learned", found {resolved["method"]!r}')
    told = {
        "format": format,
        "sequences": sequences or [],
        "settings": resolved,
        "evidence": evidence,
        "check": check,
    }
    return Job(
        recording=os.fsdecode(recording),
        out=os.fsdecode(out),
        model=_decoded(model),
        depth=_decoded(depth),
        segmentation=_decoded(segmentation),
        told=json.dumps(told),
    )


def _decoded(path: Path_ | None) -> str | None:
    return None if path is None else os.fsdecode(path)
