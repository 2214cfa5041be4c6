"""How a recording is labelled, as the compiled module wants it told."""

from __future__ import annotations

import json
import operator
import os
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ralf import _ralf

Path_ = str | bytes | os.PathLike[str] | os.PathLike[bytes]
Settings = Mapping[str, Any] | Path_ | None


def settings_json(settings: Settings, method: str | None = None, below: Any = None) -> Any:
    """All settings: of a TOML file, or of a mapping whose keys are `lidar.beta` or `lidar` with a mapping below it.

    They count, key by key, above what `below` holds: all settings, as this function returned them.
    """
    file: str | None = None
    assignments: list[str] = []
    if isinstance(settings, Mapping):
        assignments = [f"{key}={_toml(value)}" for key, value in _flat(settings)]
    elif isinstance(settings, str | bytes | os.PathLike):
        file = os.fsdecode(settings)
    elif settings is not None:
        raise TypeError(f"settings: expected a mapping or a TOML file, found {settings!r}")
    if method is not None:
        assignments.append(f"method={_toml(method)}")
    return json.loads(_ralf.settings(file, assignments, None if below is None else json.dumps(below)))


def _flat(settings: Mapping[str, Any], before: str = "") -> list[tuple[str, Any]]:
    """Nested mappings as dotted keys; a sensor's name that holds a dot stands in quotes."""
    found: list[tuple[str, Any]] = []
    for key, value in settings.items():
        if not isinstance(key, str):
            raise TypeError(f"settings: expected the names of settings as keys, found {before}{key!r}")
        if isinstance(value, Mapping):
            name = _toml(key) if before and "." in key else key
            found += _flat(value, f"{before}{name}.")
        else:
            found.append((before + key, value))
    return found


def _toml(value: Any) -> str:
    """A value as TOML has it; NumPy's numbers and arrays are told as Python's."""
    if isinstance(value, np.generic | np.ndarray):
        return _toml(value.tolist())
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    if isinstance(value, str | os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    # So are the numbers of other packages.
    return repr(value.item() if hasattr(value, "item") else value)


def names(given: Iterable[str] | None, what: str) -> list[str] | None:
    """Names as a list, where there are any; a text by itself would be taken for its letters."""
    if given is None:
        return None
    if isinstance(given, str | bytes):
        raise TypeError(f"{what}: expected a list of names, found {given!r}")
    found = list(given)
    for name in found:
        if not isinstance(name, str):
            raise TypeError(f"{what}: expected names, found {name!r} among them")
    return [str(name) for name in found]


def anywhere(path: str) -> str:
    """A path that leads to the same place from every folder: a notebook's `%cd` must not lead to other data."""
    return str(Path.cwd() / path) if path else path


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

    @property
    def settings(self) -> dict[str, Any]:
        """All its settings."""
        settings: dict[str, Any] = json.loads(self.told)["settings"]
        return settings

    def anywhere(self) -> Job:
        """The same, with paths that lead to the same places from every folder."""
        told = json.loads(self.told)
        motion = told["settings"].get("motion", {})
        if motion.get("trajectory"):
            motion["trajectory"] = anywhere(motion["trajectory"])
        paths = {name: getattr(self, name) for name in ("recording", "out", "model", "depth", "segmentation")}
        whole = {name: anywhere(path) for name, path in paths.items() if path is not None}
        return replace(self, told=json.dumps(told), **whole)


def job(
    recording: Path_,
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
    below: Any = None,
) -> Job:
    """A job, with its settings resolved: those that are given, above those of `below`."""
    resolved = settings_json(settings, method, below)
    if model is not None and resolved["method"] != "learned":
        raise ValueError(f'model: expected the method that asks one, method="learned", found {resolved["method"]!r}')
    chosen = names(sequences, "sequences")
    if chosen == []:
        raise ValueError("sequences: expected one or more names, or None for all sequences, found an empty list")
    told = {
        "format": format,
        "sequences": chosen or [],
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
