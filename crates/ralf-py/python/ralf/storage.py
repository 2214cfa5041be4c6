"""Object stores, by fsspec: recordings in, labels out. `pip install ralf-radar[storage]`."""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
from contextlib import closing, suppress
from datetime import datetime
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Any

from ralf import _ralf
from ralf._jobs import Path_
from ralf._warnings import warn_of

try:
    import fsspec
except ImportError as error:
    raise ImportError("ralf.storage: expected fsspec, found none: pip install ralf-radar[storage]") from error

MARKER = "run.json"
"""Written last, and taken away first: who finds it finds all that it tells of."""

DATABASE = ".sqlite"
"""How the names of files end that hold what people said."""

JOURNALS = ("-wal", "-shm", "-journal")
"""How the names of what SQLite lays beside a database go on. It holds for that one file, and belongs to nobody else."""

_Files = dict[PurePosixPath, tuple[str, dict[str, Any]]]
"""By the place in what is staged: the name in the store, and what the store tells of it."""

_Stamps = dict[str, list[int]]
"""Size and time of files that were put somewhere, by their places."""

_Known = dict[str, list[str]]
"""By the place of a database: hashes of what was staged there, and of what was published from there since."""


def stage(url: str, folder: Path_) -> Path:
    """Copy a recording, or results, into a folder of this machine. Returns where it lies.

    Files that are there with the same size and time are left alone, so that a second call copies what is new. What it
    put there and the store has no more is removed, unless it has been changed; it is known by a hidden file beside the
    copy, `.NAME.staged`. Other files there that the store lacks are left as they are, which is a warning. The times of
    files are those of the store, by which RALF knows a file again.

    Raises `FileNotFoundError` where the URL leads to nothing, and a `ValueError` where the folder holds what was staged
    from another URL of the same last name, before anything is changed. A database of what people said is refused with a
    `ValueError`, before anything is copied, where it has a journal in the store, which is half of it at most, and where
    the store's would replace one in which something was said on this machine since it was staged or published; the
    latter is known by a hidden file, `.NAME.known`.
    """
    store, root = _opened(url)
    place = Path(os.fsdecode(folder)) / PurePosixPath(root).name
    wanted = _found(url, store, root)
    record = _staged_file(place)
    source = store.unstrip_protocol(root)
    put = _put(record)
    known: _Known = _read(_known_file(place))
    _refuse_to_lose(place, wanted, put, known)
    _refuse_another(record, source)
    record.parent.mkdir(parents=True, exist_ok=True)
    try:
        for gone in [inside for inside in put if PurePosixPath(inside) not in wanted]:
            _take_away(place, gone, put.pop(gone))
        for inside, (name, told) in wanted.items():
            fetched = _fetch(store, name, place / inside, told)
            put[str(inside)] = _stamp(place / inside)
            if fetched and inside.suffix == DATABASE:
                known[str(inside)] = [_hash(place / inside)]
    finally:
        _write(record, json.dumps({"url": source, "files": put}))
        if known:
            _write(_known_file(place), json.dumps(known))
    warn_of(_others(url, place, wanted))
    return place


def publish(out: Path_, url: str) -> None:
    """Copy results to a store, the marker last.

    What people said is copied as SQLite knows it at that moment, a review that goes on among it, into one file without
    a journal; journals that lie beside it in the store are removed. An `out` without the record of a finished labelling
    is refused with a `RalfError`; with a `ValueError` a damaged database, and one in the place of which the store has
    another, in which somebody else may have said something: neither staged here nor published from here. All of it
    before the store is touched. What was published is known by a hidden file beside `out`, `.NAME.known`. Files of the
    store that `out` lacks, such as sequences that were removed since, are left there, which is a warning.
    """
    place = Path(os.fsdecode(out)).absolute()
    _ralf.record(place)
    files = sorted(path.relative_to(place) for path in place.rglob("*") if path.is_file())
    results = [file for file in files if not _is_hidden(file) and not _is_journal(file)]
    with TemporaryDirectory() as scratch:
        copies = {
            file: _copy(place / file, Path(scratch) / str(number))
            for number, file in enumerate(results)
            if file.suffix == DATABASE
        }
        store, root = _opened(url)
        hashes = {file: _hash(copy) for file, copy in copies.items()}
        known: _Known = _read(_known_file(place))
        _refuse_to_replace(url, place, hashes, known, Path(scratch) / "found")
        _remove(store, f"{root}/{MARKER}")
        for file in sorted(results, key=lambda file: file == Path(MARKER)):
            target = f"{root}/{file.as_posix()}"
            store.makedirs(store._parent(target), exist_ok=True)
            if file in copies:
                for journal in JOURNALS:
                    _remove(store, target + journal)
                known.setdefault(file.as_posix(), []).append(hashes[file])
                # Before, for what is ours stays so if this ends here.
                _write(_known_file(place), json.dumps(known))
            store.put_file(os.fspath(copies.get(file, place / file)), target)
        warn_of(_left_there(url, place, {f"{root}/{file.as_posix()}" for file in results}))


def _opened(url: str) -> tuple[Any, str]:
    """The store of a URL, and the place in it. What it holds now counts, not what it held when it was last asked."""
    store, root = fsspec.core.url_to_fs(url)
    store.invalidate_cache()
    return store, root.rstrip("/")


def _found(url: str, store: Any, root: str) -> _Files:
    """All files of a URL, but for journals that hold nothing."""
    found: _Files = {}
    for name, told in sorted(store.find(root, detail=True).items()):
        inside = PurePosixPath(name).relative_to(root) if name != root else PurePosixPath()
        if ".." in inside.parts:
            raise ValueError(f"{url}: expected names that lead nowhere else, found {name}")
        if not _is_journal(inside):
            found[inside] = (name, told)
        elif told["size"] > 0 and not inside.name.endswith("-shm"):
            remedy = "end the review that is at work there, or publish it again"
            raise ValueError(f"{url}: expected databases without journals, found {inside}: {remedy}")
    if not found:
        raise FileNotFoundError(f"{url}: expected a recording or results, found nothing")
    return found


def _refuse_to_lose(place: Path, wanted: _Files, put: _Stamps, known: _Known) -> None:
    """Refuse to replace a database in which something was said since it was staged or published."""
    for inside, (_, told) in wanted.items():
        file = place / inside
        if inside.suffix != DATABASE or not file.exists() or _is_there(file, told["size"], _changed_ns(told)):
            continue
        if not _is_as_put(file, put.get(str(inside))) and not _is_known(file, known.get(str(inside), [])):
            expected = f"{file}: expected what was staged, which the store has anew"
            raise ValueError(f"{expected}, found what was said here since: publish it elsewhere, or move it away")


def _refuse_to_replace(url: str, place: Path, hashes: dict[Path, str], known: _Known, scratch: Path) -> None:
    """Refuse to replace a database in a store in which something was said that this place doesn't know of."""
    store, root = _opened(url)
    put = _put(_staged_file(place))
    for file, ours in hashes.items():
        inside, target = file.as_posix(), f"{root}/{file.as_posix()}"
        if not store.exists(target):
            continue
        told = store.info(target)
        # What an earlier version staged is known by its size and time alone.
        if inside not in known and put.get(inside) == [told["size"], _changed_ns(told)]:
            continue
        store.get_file(target, os.fspath(scratch))
        if _hash(scratch) not in [ours, *known.get(inside, [])]:
            expected = f"{url}: expected what was staged or published here before, which would be replaced"
            remedy = "publish it elsewhere, or stage that into another folder"
            raise ValueError(f"{expected}, found {inside} in which others may have said something since: {remedy}")


def _take_away(place: Path, inside: str, stamp: list[int]) -> None:
    """Remove a file that was put there, unless it has been changed, and the folders that it leaves empty."""
    file = place / inside
    if not _is_as_put(file, stamp):
        return
    file.unlink()
    with suppress(OSError):
        for folder in file.relative_to(place).parents:
            (place / folder).rmdir()


def _fetch(store: Any, name: str, file: Path, told: dict[str, Any]) -> bool:
    """Copy a file, unless it is there. Whether it was copied."""
    changed = _changed_ns(told)
    if _is_there(file, told["size"], changed):
        return False
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(f".{file.name}.part")
    store.get_file(name, os.fspath(unfinished))
    if changed is not None:
        os.utime(unfinished, ns=(changed, changed))
    unfinished.replace(file)
    return True


def _others(url: str, place: Path, wanted: _Files) -> list[str]:
    """What to warn of: files that the store lacks, which count like all others."""
    inside = (PurePosixPath(path.relative_to(place).as_posix()) for path in place.rglob("*") if path.is_file())
    others = sorted(file for file in inside if file not in wanted and not _is_hidden(file) and not _is_journal(file))
    left = f"not in {url}, and not as staged from there: left as it is"
    return [f"{place}: {_first_of(others)}: {left}"] if others else []


def _copy(database: Path, copy: Path) -> Path:
    """Copy a database, with what its journal holds, into one file. It stays as it is."""
    # Whoever has it open has laid a journal beside it. Where there is none, reading must not lay one.
    open_ = any(_beside(database, journal).exists() for journal in JOURNALS)
    uri = f"{database.absolute().as_uri()}?{'mode=ro' if open_ else 'immutable=1'}"
    try:
        with closing(sqlite3.connect(uri, uri=True)) as source, closing(sqlite3.connect(copy)) as target:
            source.backup(target)
            (found,) = target.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.Error as error:
        found = str(error)
    if found != "ok":
        raise ValueError(f"{database}: expected a whole SQLite database, found: {found}")
    return copy


def _is_known(database: Path, hashes: list[str]) -> bool:
    """Whether a database holds what was staged or published, its journal included."""
    if not hashes:
        return False
    with TemporaryDirectory() as scratch:
        return _hash(_copy(database, Path(scratch) / "copy")) in hashes


def _hash(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def _left_there(url: str, place: Path, published: set[str]) -> list[str]:
    """What to warn of: files of the store that were not published with the others, and count where it is staged."""
    store, root = _opened(url)
    others = [PurePosixPath(name).relative_to(root) for name in sorted(store.find(root)) if name not in published]
    others = [file for file in others if not _is_hidden(file) and not _is_journal(file)]
    counts = "left there, and counts for who evaluates what is there"
    return [f"{url}: {_first_of(others)}: not in {place}: {counts}"] if others else []


def _first_of(files: list[PurePosixPath]) -> str:
    """The first of some files, and how many more there are."""
    return f"{files[0]} and {len(files) - 1} more" if len(files) > 1 else str(files[0])


def _refuse_another(record: Path, source: str) -> None:
    """Refuse to put what a URL holds in the place of what was staged from another."""
    found = _read(record).get("url", source)
    if found != source:
        remedy = "stage one of them into another folder"
        raise ValueError(f"{record}: expected what was staged from {source}, found {found}: {remedy}")


def _put(record: Path) -> _Stamps:
    """What was put there. An earlier version told of files alone."""
    told = _read(record)
    stamps: _Stamps = told["files"] if "url" in told else told
    return stamps


def _staged_file(place: Path) -> Path:
    return place.with_name(f".{place.name}.staged")


def _known_file(place: Path) -> Path:
    return place.with_name(f".{place.name}.known")


def _read(record: Path) -> dict[str, Any]:
    """What a record tells, if there is one."""
    found: dict[str, Any] = json.loads(record.read_text(encoding="utf-8")) if record.is_file() else {}
    return found


def _write(file: Path, text: str) -> None:
    """Write a file whole or not at all."""
    unfinished = file.with_name(f"{file.name}.part")
    unfinished.write_text(text, encoding="utf-8")
    unfinished.replace(file)


def _remove(store: Any, name: str) -> None:
    if store.exists(name):
        store.rm_file(name)


def _is_there(file: Path, size: int, changed: int | None) -> bool:
    return file.is_file() and changed is not None and _stamp(file) == [size, changed]


def _is_as_put(file: Path, stamp: list[int] | None) -> bool:
    """Whether nobody has changed a file since it was put there, or said anything that its journal has."""
    if not file.is_file() or _stamp(file) != stamp:
        return False
    journals = (_beside(file, journal) for journal in JOURNALS if journal != "-shm")
    return file.suffix != DATABASE or not any(path.exists() and path.stat().st_size > 0 for path in journals)


def _stamp(file: Path) -> list[int]:
    stat = file.stat()
    return [stat.st_size, stat.st_mtime_ns]


def _beside(database: Path, journal: str) -> Path:
    return database.with_name(database.name + journal)


def _is_journal(file: Path | PurePosixPath) -> bool:
    return file.name.endswith(tuple(DATABASE + journal for journal in JOURNALS))


def _is_hidden(file: Path | PurePosixPath) -> bool:
    return any(part.startswith(".") for part in file.parts)


def _changed_ns(told: dict[str, Any]) -> int | None:
    """When a file was changed last, ns since 1970, whatever its store calls that."""
    for key in ("LastModified", "last_modified", "mtime", "created"):
        value = told.get(key)
        if isinstance(value, datetime):
            value = value.timestamp()
        if isinstance(value, int | float):
            return int(value * 1e9)
    return None
