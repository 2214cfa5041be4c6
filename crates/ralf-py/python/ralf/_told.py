"""What there is to know of labels beside them: out of a record, whose keys are those of `run.json`."""

from __future__ import annotations

from collections.abc import Container, Iterable
from itertools import groupby
from typing import Any

SHOWN = 8
"""So many warnings of a kind are told; of the others, how many they are."""

Scan = tuple[str, str, int, str]
"""A scan or an image: sequence, sensor, number, and what is wrong with it."""


def not_labelled(record: dict[str, Any]) -> list[Scan]:
    """Scans that can't be labelled."""
    return [
        (sequence["name"], scan["radar"], scan["scan"], scan["reason"])
        for sequence in record["sequences"]
        for scan in sequence["not_labelled"]
    ]


def lost(record: dict[str, Any]) -> list[tuple[str, str]]:
    """What can't be read and may have held scans: sequence, what."""
    return [(sequence["name"], what) for sequence in record["sequences"] for what in sequence.get("lost", [])]


def labelled_without(record: dict[str, Any]) -> list[Scan]:
    """Scans and images that can't be read or used."""
    found: list[Scan] = []
    for sequence in record["sequences"]:
        name = sequence["name"]
        found += [(name, scan["sensor"], scan["scan"], scan["reason"]) for scan in sequence.get("unreadable", [])]
        for camera in sequence["cameras"]:
            problems = ((image["image"], image.get("problem")) for image in camera["images"])
            found += [(name, camera["name"], number, problem) for number, problem in problems if problem]
    return found


def doubts(record: dict[str, Any]) -> list[tuple[str, str, str]]:
    """What speaks against the recording: sequence, a sensor or `motion`, what, after what would put it right."""
    return [
        (check["sequence"], line["subject"], ": ".join(filter(None, [line.get("remedy"), line["evidence"]])))
        for check in record.get("check", [])
        for line in check["doubts"]
    ]


def warnings_of(record: dict[str, Any], sequences: Container[str], warnings: list[str]) -> list[str]:
    """What callers are warned of: these warnings, and what the record tells of these sequences; few sentences each."""
    of_these = {
        "sequences": [sequence for sequence in record["sequences"] if sequence["name"] in sequences],
        "check": [check for check in record.get("check", []) if check["sequence"] in sequences],
    }
    return [
        *bounded(warnings, "warnings"),
        *bounded([f"doubt: {': '.join(doubt)}" for doubt in doubts(of_these)], "doubts"),
        *bounded(_by_sensor("labelled without", labelled_without(of_these)), "labelled_without"),
    ]


def warnings_of_run(record: dict[str, Any], sequences: Container[str], warnings: list[str]) -> list[str]:
    """The same of a run, which may have to go on where a scan can't be labelled."""
    asked = {"sequences": [sequence for sequence in record["sequences"] if sequence["name"] in sequences]}
    return [
        *warnings_of(record, sequences, warnings),
        *bounded(_by_sensor("not labelled", not_labelled(asked)), "not_labelled"),
        *bounded([f"not labelled: {': '.join(what)}" for what in lost(asked)], "lost"),
    ]


def bounded(sentences: list[str], where: str) -> list[str]:
    """The first of these sentences, and how many more of them there are where."""
    more = len(sentences) - SHOWN
    return sentences if more <= 0 else [*sentences[:SHOWN], f"and {more} more like these: `{where}` has them all"]


def _by_sensor(what: str, scans: Iterable[Scan]) -> list[str]:
    """A sentence for each sensor: its first scan, with its reason, and how many others there are."""
    sentences = []
    for (sequence, sensor), own in groupby(scans, lambda scan: scan[:2]):
        (_, _, first, reason), *others = own
        more = f" and {len(others)} other{'s' if len(others) > 1 else ''}" if others else ""
        sentences.append(f"{what}: {sequence} {sensor} {first}{more}: {reason}")
    return sentences
