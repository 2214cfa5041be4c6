"""Recordings from a store, and labels into one."""

import pytest
from conftest import tree

import ralf

fsspec = pytest.importorskip("fsspec")
from ralf import storage  # noqa: E402


def test_what_was_staged_is_labelled_the_same_and_published_with_its_marker_last(drive, tmp_path):
    store = fsspec.filesystem("memory")
    store.put(str(drive), "/drives/city", recursive=True)
    local = storage.stage("memory://drives/city", tmp_path / "scratch")
    first = {path: path.stat().st_ino for path in local.rglob("*") if path.is_file()}
    assert storage.stage("memory://drives/city", tmp_path / "scratch") == local
    assert {path: path.stat().st_ino for path in local.rglob("*") if path.is_file()} == first
    run = ralf.label(local, tmp_path / "out")
    put = []
    store.put_file, put_file = lambda a, b: (put.append(b), put_file(a, b)), store.put_file
    try:
        storage.publish(run.out, "memory://labels/city")
    finally:
        store.put_file = put_file
    assert put[-1].endswith("/run.json")
    back = storage.stage("memory://labels/city", tmp_path / "back")
    assert tree(back) == tree(run.out)
