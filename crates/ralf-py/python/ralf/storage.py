"""Object stores, by fsspec: recordings in, labels out. `pip install ralf-radar[storage]`."""

from __future__ import annotations

import os
from datetime import datetime
from pathlib import Path, PurePosixPath
from typing import Any

try:
    import fsspec
except ImportError as error:
    raise ImportError("ralf.storage: expected fsspec, found none: pip install ralf-radar[storage]") from error

MARKER = "run.json"
"""Written last, and taken away first: who finds it finds all that it tells of."""


def stage(url: str, folder: str | os.PathLike[str]) -> Path:
    """Copy a recording into a folder of this machine. Returns where it lies.

    Files that are there with the same size and time are left alone, so that a second call copies what is new. The
    times of files are those of the store, by which RALF knows a file again.
    """
    store, root = fsspec.core.url_to_fs(url)
    root = root.rstrip("/")
    place = Path(folder) / PurePosixPath(root).name
    for name, told in sorted(store.find(root, detail=True).items()):
        inside = PurePosixPath(name).relative_to(root) if name != root else PurePosixPath()
        if ".." in inside.parts:
            raise ValueError(f"{url}: expected names that lead nowhere else, found {name}")
        file = place / inside
        changed = _changed_ns(told)
        if _is_there(file, told["size"], changed):
            continue
        file.parent.mkdir(parents=True, exist_ok=True)
        unfinished = file.with_name(f".{file.name}.part")
        store.get_file(name, os.fspath(unfinished))
        if changed is not None:
            os.utime(unfinished, ns=(changed, changed))
        unfinished.replace(file)
    return place


def publish(out: str | os.PathLike[str], url: str) -> None:
    """Copy results to a store, the marker last."""
    store, root = fsspec.core.url_to_fs(url)
    root = root.rstrip("/")
    if store.exists(f"{root}/{MARKER}"):
        store.rm_file(f"{root}/{MARKER}")
    files = sorted(path for path in Path(out).rglob("*") if path.is_file())
    results = [file for file in files if not any(part.startswith(".") for part in file.relative_to(out).parts)]
    for file in sorted(results, key=lambda file: file.name == MARKER):
        target = f"{root}/{file.relative_to(out).as_posix()}"
        store.makedirs(store._parent(target), exist_ok=True)
        store.put_file(os.fspath(file), target)


def _is_there(file: Path, size: int, changed: int | None) -> bool:
    if not file.is_file() or changed is None:
        return False
    stat = file.stat()
    return (stat.st_size, stat.st_mtime_ns) == (size, changed)


def _changed_ns(told: dict[str, Any]) -> int | None:
    """When a file was changed last, ns since 1970, whatever its store calls that."""
    for key in ("LastModified", "last_modified", "mtime", "created"):
        value = told.get(key)
        if isinstance(value, datetime):
            value = value.timestamp()
        if isinstance(value, int | float):
            return int(value * 1e9)
    return None
