//! Files that are put in a store's place, and journals that stay beside them.

use super::{Folder, apply, hash, is_gone, version};
use ralf_corrections::{Reader, Store, read_layer};
use std::fs;
use std::path::{Path, PathBuf};

fn journal(file: &Path) -> PathBuf {
    PathBuf::from(format!("{}-wal", file.display()))
}

/// The file of a store with edits of these scans.
fn file_of(scans: impl IntoIterator<Item = u32>) -> (Folder, Vec<u8>) {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    scans.into_iter().for_each(|scan| drop(apply(&mut store, scan).unwrap()));
    drop(store);
    let bytes = fs::read(&folder.file).unwrap();
    (folder, bytes)
}

/// An open store whose journal was written back, and one who reads from it.
fn written_back(scans: u32) -> (Folder, Store, Reader) {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    let reader = store.reader().unwrap();
    (0..scans).for_each(|scan| drop(apply(&mut store, scan).unwrap()));
    store.write_back().unwrap();
    (folder, store, reader)
}

fn corrected(file: &Path) -> usize {
    Store::open(file).unwrap().summaries("00").unwrap().len()
}

/// As a kill leaves a store in whose place another one is put then.
#[test]
fn another_stores_journal_is_named_and_nothing_is_touched() {
    let (_bobs, bytes) = file_of([5]);
    let adas = Folder::new();
    let mut store = Store::open(&adas.file).unwrap();
    apply(&mut store, 1).unwrap();
    let folder = Folder::new();
    fs::write(&folder.file, &bytes).unwrap();
    fs::copy(journal(&adas.file), journal(&folder.file)).unwrap();
    let edits = fs::read(journal(&folder.file)).unwrap();
    for error in
        [Store::open(&folder.file).err(), Reader::open(&folder.file).err(), read_layer(&folder.file).err()]
    {
        let error = error.unwrap().to_string();
        assert!(
            error.contains("journal: expected that of store") && error.contains("up to edit 1"),
            "{error}"
        );
        assert!(error.contains("move corrections.sqlite-wal away"), "{error}");
    }
    assert!(fs::read(&folder.file).unwrap() == bytes && fs::read(journal(&folder.file)).unwrap() == edits);
    fs::remove_file(journal(&folder.file)).unwrap();
    assert_eq!(Store::open(&folder.file).unwrap().summaries("00").unwrap()[0].key.scan, 5);
}

#[test]
fn a_journal_that_spoils_an_older_state_is_named_and_nothing_is_touched() {
    let (_older, bytes) = file_of([5]);
    let folder = Folder::new();
    fs::write(&folder.file, &bytes).unwrap();
    let mut store = Store::open(&folder.file).unwrap();
    (100..400).for_each(|scan| drop(apply(&mut store, scan).unwrap()));
    store.write_back().unwrap();
    apply(&mut store, 6).unwrap();
    let killed = Folder::new();
    fs::write(&killed.file, &bytes).unwrap();
    fs::copy(journal(&folder.file), journal(&killed.file)).unwrap();
    for error in [Store::open(&killed.file).err(), read_layer(&killed.file).err()] {
        let error = error.unwrap().to_string();
        assert!(error.contains("move corrections.sqlite-wal away"), "{error}");
    }
    assert!(fs::read(&killed.file).unwrap() == bytes);
    fs::remove_file(journal(&killed.file)).unwrap();
    assert_eq!(corrected(&killed.file), 1);
}

#[test]
fn what_is_put_in_the_place_of_a_store_that_was_written_back_is_what_is_read() {
    let (_bobs, bytes) = file_of([5]);
    let (folder, mut store, reader) = written_back(30);
    assert_eq!(journal(&folder.file).metadata().unwrap().len(), 0);
    fs::remove_file(&folder.file).unwrap();
    fs::write(&folder.file, &bytes).unwrap();
    assert!(is_gone(apply(&mut store, 40)) && is_gone(store.write_back()));
    drop((reader, store));
    assert!(fs::read(&folder.file).unwrap() == bytes);
    assert_eq!(corrected(&folder.file), 1);
}

#[test]
fn a_file_that_is_written_over_takes_no_edit() {
    let (_bobs, other) = file_of([5]);
    let (folder, mut store, reader) = written_back(20);
    let older = fs::read(&folder.file).unwrap();
    (20..25).for_each(|scan| drop(apply(&mut store, scan).unwrap()));
    store.write_back().unwrap();
    let whole = fs::read(&folder.file).unwrap();
    // Nobody asked anything since it was written back.
    for bytes in [&older, &other] {
        fs::write(&folder.file, bytes).unwrap();
        let error = apply(&mut store, 200).unwrap_err().to_string();
        assert!(error.contains("another store, or an older state of it, written over it"), "{error}");
        assert!(is_gone(reader.summaries("00")) && is_gone(store.write_back()));
    }
    for bytes in [&b""[..], b"these are notes, and no database of any kind"] {
        fs::write(&folder.file, bytes).unwrap();
        let error = apply(&mut store, 200).unwrap_err().to_string();
        assert!(error.contains("another file written over it"), "{error}");
    }
    fs::write(&folder.file, &whole).unwrap();
    apply(&mut store, 200).unwrap();
    assert_eq!(reader.summaries("00").unwrap().len(), 26, "put back, it goes on");
    store.write_back().unwrap();
    fs::write(&folder.file, &older).unwrap();
    drop((reader, store));
    assert!(fs::read(&folder.file).unwrap() == older);
    assert_eq!(corrected(&folder.file), 20);
}

#[test]
fn what_another_program_writes_back_is_no_replacement() {
    let folder = Folder::new();
    let [mut here, mut there] = [(); 2].map(|()| Store::open(&folder.file).unwrap());
    for scan in 0..10 {
        apply(&mut here, 2 * scan).unwrap();
        apply(&mut there, 2 * scan + 1).unwrap();
        there.write_back().unwrap();
    }
    assert_eq!(here.summaries("00").unwrap().len(), 20);
    assert_eq!(here.scan(&version(19, hash(1))).unwrap().corrections.len(), 2);
}

/// Who opens a store sees the file, and then the journal; somebody writes to both meanwhile.
#[test]
fn who_opens_a_store_while_another_writes_back_is_never_refused() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    std::thread::scope(|scope| {
        let file = &folder.file;
        let reading = scope.spawn(move || {
            (0..60).for_each(|_| drop(read_layer(file).unwrap()));
        });
        let mut scan = 0;
        while !reading.is_finished() {
            apply(&mut store, scan).unwrap();
            store.write_back().unwrap();
            scan += 1;
        }
        reading.join().unwrap();
    });
}
