"""Recordings from a store, and labels into one."""

import shutil
import sqlite3
from contextlib import closing

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


def said(database):
    """What a database of the tests holds."""
    with closing(sqlite3.connect(database)) as opened:
        return [row[0] for row in opened.execute("SELECT what FROM said")]


def say(database, what):
    """An open database in which something is said that its journal alone has."""
    opened = sqlite3.connect(database)
    opened.execute("PRAGMA journal_mode = WAL")
    opened.execute("PRAGMA wal_autocheckpoint = 0")
    opened.execute("CREATE TABLE IF NOT EXISTS said (what TEXT)")
    opened.execute("INSERT INTO said VALUES (?)", [what])
    opened.commit()
    return opened


@pytest.fixture
def reviewed(run, tmp_path):
    """Results that people review: one of them still does, and one did for a second time."""
    out = tmp_path / "reviewed"
    shutil.copytree(run.out, out)
    (out / "second").mkdir()
    with closing(say(out / "corrections.sqlite", "a")) as one, closing(say(out / "second/bob.sqlite", "b")) as two:
        assert one and two
        yield out


def test_what_is_not_finished_is_refused_before_the_store_is_touched(run, tmp_path):
    storage.publish(run.out, f"file://{tmp_path}/store")
    (tmp_path / "unfinished/.ralf-run").mkdir(parents=True)
    for name in ("unfinished", "mistyped"):
        with pytest.raises(ralf.RalfError, match=rf"{name}: run\.json: expected the record of a finished"):
            storage.publish(tmp_path / name, f"file://{tmp_path}/store")
    assert tree(tmp_path / "store") == tree(run.out)


def test_what_people_said_is_published_as_it_is_at_that_moment(reviewed, tmp_path):
    store = tmp_path / "store"
    # An earlier version left journals there.
    (store / "second").mkdir(parents=True)
    journals = [f"{name}.sqlite-{what}" for name in ("corrections", "second/bob") for what in ("wal", "shm")]
    for journal in journals:
        (store / journal).write_bytes((reviewed / journal).read_bytes())
    before = tree(reviewed)
    for _ in range(2):
        storage.publish(reviewed, f"file://{store}")
        found = {str(path.relative_to(store)) for path in store.rglob("*.sqlite*")}
        assert found == {"corrections.sqlite", "second/bob.sqlite"}
    # What readers hold lies in `-shm`.
    after = tree(reviewed)
    assert {name for name in before | after if before.get(name) != after.get(name)} <= set(journals[1::2])
    say(reviewed / "corrections.sqlite", "c").close()
    storage.publish(reviewed, f"file://{store}")
    assert said(store / "corrections.sqlite") == ["a", "c"]
    assert said(store / "second/bob.sqlite") == ["b"]


def test_a_database_that_nobody_has_open_is_published_and_left_as_it_is(run, tmp_path):
    out = tmp_path / "out"
    shutil.copytree(run.out, out)
    say(out / "corrections.sqlite", "a").close()
    before = tree(out)
    assert "corrections.sqlite-wal" not in before
    storage.publish(out, f"file://{tmp_path}/store")
    assert tree(out) == before
    assert said(tmp_path / "store/corrections.sqlite") == ["a"]


def test_a_damaged_database_is_refused_before_the_store_is_touched(run, tmp_path):
    out = tmp_path / "out"
    shutil.copytree(run.out, out)
    storage.publish(out, f"file://{tmp_path}/store")
    (out / "corrections.sqlite").write_bytes(b"no database" * 100)
    with pytest.raises(ValueError, match=r"corrections\.sqlite: expected a whole SQLite database, found: file is not"):
        storage.publish(out, f"file://{tmp_path}/store")
    assert tree(tmp_path / "store") == tree(run.out)


def test_a_database_with_a_journal_in_the_store_is_not_staged(reviewed, tmp_path):
    with pytest.raises(ValueError, match=r"expected databases without journals, found corrections\.sqlite-wal"):
        storage.stage(f"file://{reviewed}", tmp_path / "copy")
    assert not (tmp_path / "copy").exists()


def test_what_was_said_of_a_copy_is_not_replaced(run, tmp_path):
    out = tmp_path / "out"
    shutil.copytree(run.out, out)
    say(out / "corrections.sqlite", "a").close()
    storage.publish(out, f"file://{tmp_path}/store")
    copy = storage.stage(f"file://{tmp_path}/store", tmp_path / "copy")
    say(out / "corrections.sqlite", "b").close()
    storage.publish(out, f"file://{tmp_path}/store")
    assert said(storage.stage(f"file://{tmp_path}/store", tmp_path / "copy") / "corrections.sqlite") == ["a", "b"]
    with closing(say(copy / "corrections.sqlite", "here")):
        storage.stage(f"file://{tmp_path}/store", tmp_path / "copy")
        storage.publish(out, f"file://{tmp_path}/store")
        with pytest.raises(ValueError, match="found what was said here since: publish it elsewhere, or move it away"):
            storage.stage(f"file://{tmp_path}/store", tmp_path / "copy")
    assert said(copy / "corrections.sqlite") == ["a", "b", "here"]


def test_what_others_said_in_a_store_is_not_replaced(run, tmp_path):
    url = f"file://{tmp_path}/store/city"
    shutil.copytree(run.out, tmp_path / "city")
    say(tmp_path / "city/corrections.sqlite", "a").close()
    storage.publish(tmp_path / "city", url)
    ours, others = (storage.stage(url, tmp_path / name) for name in ("ours", "others"))
    say(ours / "corrections.sqlite", "by us").close()
    say(others / "corrections.sqlite", "by others").close()
    storage.publish(others, url)
    before = tree(tmp_path / "store")
    for place in (ours, tmp_path / "city"):
        with pytest.raises(ValueError, match=r"found corrections\.sqlite in which others may have said"):
            storage.publish(place, url)
    assert tree(tmp_path / "store") == before
    assert said(tmp_path / "store/city/corrections.sqlite") == ["a", "by others"]
    # What one has published oneself may be published anew.
    say(others / "corrections.sqlite", "more").close()
    storage.publish(others, url)
    assert said(tmp_path / "store/city/corrections.sqlite") == ["a", "by others", "more"]
    storage.publish(ours, f"file://{tmp_path}/elsewhere")
    assert said(tmp_path / "elsewhere/corrections.sqlite") == ["a", "by us"]


def test_what_was_published_may_be_staged_again(run, tmp_path):
    url = f"file://{tmp_path}/store/city"
    shutil.copytree(run.out, tmp_path / "city")
    say(tmp_path / "city/corrections.sqlite", "a").close()
    storage.publish(tmp_path / "city", url)
    copy = storage.stage(url, tmp_path / "copy")
    for what, open_ in (("b", False), ("c", True)):
        # Also where the review ends only after it was published.
        opened = say(copy / "corrections.sqlite", what)
        if not open_:
            opened.close()
        storage.publish(copy, url)
        opened.close()
        storage.stage(url, tmp_path / "copy")
    assert said(copy / "corrections.sqlite") == ["a", "b", "c"]
    say(copy / "corrections.sqlite", "d").close()
    storage.publish(tmp_path / "city", f"file://{tmp_path}/other/city")
    with pytest.raises(ValueError, match="found what was said here since"):
        storage.stage(f"file://{tmp_path}/other/city", tmp_path / "copy")


def test_a_url_that_leads_to_nothing_is_named(tmp_path):
    for url in (f"file://{tmp_path}/nosuch/city", "memory://nosuch/city"):
        with pytest.raises(FileNotFoundError, match=f"{url}: expected a recording or results, found nothing"):
            storage.stage(url, tmp_path / "copy")
    assert not (tmp_path / "copy").exists()


def test_a_copy_has_no_more_than_the_store_but_what_others_put_there(drive, tmp_path):
    store = tmp_path / "store/city"
    shutil.copytree(drive, store)
    (sequence,) = store.glob("sequences/*")
    shutil.copytree(sequence, store / "sequences/gone")
    copy = storage.stage(f"file://{store}", tmp_path / "copy")
    assert tree(copy) == tree(store)
    (copy / "notes.txt").write_text("mine")
    changed = copy / "sequences/gone/sequence.toml"
    changed.write_text(changed.read_text() + "\n")
    shutil.rmtree(store / "sequences/gone")
    with pytest.warns(UserWarning, match=r"notes\.txt and 1 more: not in file://.*left as it is") as told:
        storage.stage(f"file://{store}", tmp_path / "copy")
    assert told[0].filename == __file__
    assert set(tree(copy)) - set(tree(store)) == {"notes.txt", "sequences/gone/sequence.toml"}
    changed.unlink()
    # What was copied before copies were recorded is known by its size and time.
    shutil.copytree(sequence, store / "sequences/gone")
    (tmp_path / "copy/.city.staged").unlink()
    with pytest.warns(UserWarning, match=r"city: notes\.txt: not in "):
        storage.stage(f"file://{store}", tmp_path / "copy")
    shutil.rmtree(store / "sequences/gone")
    with pytest.warns(UserWarning, match=r"city: notes\.txt: not in "):
        storage.stage(f"file://{store}", tmp_path / "copy")
    assert not (copy / "sequences/gone").exists()
    assert ralf.open(copy).sequences == ralf.open(drive).sequences


def test_a_single_file_is_staged(tmp_path):
    (tmp_path / "store").mkdir()
    (tmp_path / "store/city.mcap").write_bytes(b"1")
    for content in (b"1", b"22"):
        (tmp_path / "store/city.mcap").write_bytes(content)
        file = storage.stage(f"file://{tmp_path}/store/city.mcap", tmp_path / "copy")
        assert (file.name, file.read_bytes()) == ("city.mcap", content)


def test_two_urls_of_one_name_are_not_staged_into_one_place(drive, tmp_path):
    for day in ("mon", "tue"):
        shutil.copytree(drive, tmp_path / day / "drive")
    place = storage.stage(f"file://{tmp_path}/mon/drive", tmp_path / "here")
    before = tree(place)
    with pytest.raises(
        ValueError, match=r"expected what was staged from file://.*/tue/drive, found file://.*/mon/drive"
    ):
        storage.stage(f"file://{tmp_path}/tue/drive", tmp_path / "here")
    assert tree(place) == before
    # Told in another way it is the same place.
    assert storage.stage(f"{tmp_path}/mon/drive/", bytes(tmp_path / "here")) == place


def test_results_that_were_removed_since_are_told_of_in_the_store(run, tmp_path, monkeypatch):
    out = tmp_path / "out"
    shutil.copytree(run.out, out)
    monkeypatch.chdir(out)
    storage.publish(".", f"file://{tmp_path}/store")
    assert (tmp_path / "store/run.json").exists()
    (tmp_path / "store/sequences/gone").mkdir()
    (tmp_path / "store/sequences/gone/plausibility.parquet").write_bytes(b"")
    with pytest.warns(UserWarning, match=r"sequences/gone/plausibility.parquet: not in .*/out: left there"):
        storage.publish(b".", f"file://{tmp_path}/store")
