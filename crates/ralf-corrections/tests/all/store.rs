//! Single cases, worked out by hand.
use ralf_corrections::{
    Conflict, Edit, Mark, Outcome, ScanContent, ScanEdit, ScanKey, ScanVersion, Step, Store, StoreError,
    Stroke, Who, read_layer,
};
use std::fs;
use std::path::PathBuf;

struct Folder {
    _folder: tempfile::TempDir,
    file: PathBuf,
}

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("corrections.sqlite");
        Self { _folder: folder, file }
    }

    fn open(&self) -> Store {
        Store::open(&self.file).unwrap()
    }

    fn refusal(&self) -> String {
        Store::open(&self.file).unwrap_err().to_string()
    }

    fn sql(&self, text: &str) {
        rusqlite::Connection::open(&self.file).unwrap().execute_batch(text).unwrap();
    }
}

fn who(author: &str) -> Who {
    Who { tab: Some(format!("{author}'s")), ..Who::named(author) }
}

fn key(scan: u32) -> ScanKey {
    ScanKey { sequence: "00".into(), radar: "front".into(), scan }
}

fn version(scan: u32) -> ScanVersion {
    ScanVersion { key: key(scan), content: ScanContent { detections: 10, hash: None } }
}

fn edit(scan: u32, base: u64, points: &[u32]) -> ScanEdit {
    ScanEdit { radar: "front".into(), scan, detections: 10, content: None, base, points: points.to_vec() }
}

fn stroke(label: u16, scans: Vec<ScanEdit>) -> Stroke {
    Stroke { tool: "lasso".into(), label: Some(label), scans, ..Stroke::of_sequence("00") }
}

fn done(outcome: Outcome) -> Edit {
    match outcome {
        Outcome::Done(edit) => edit,
        Outcome::Conflict(conflict) => panic!("{conflict:?}"),
    }
}

fn conflict(outcome: Outcome) -> Conflict {
    match outcome {
        Outcome::Done(edit) => panic!("{edit:?}"),
        Outcome::Conflict(conflict) => conflict,
    }
}

#[test]
fn a_stale_base_is_told_whose_edit_it_missed_and_nothing_is_written() {
    let folder = Folder::new();
    let [mut here, mut there] = [folder.open(), folder.open()];
    done(here.apply(&stroke(99, vec![edit(3, 0, &[1, 2])]), &who("ada")).unwrap());
    let both = vec![edit(2, 0, &[0]), edit(3, 0, &[2])];
    let found = conflict(there.apply(&stroke(1, both), &who("bob")).unwrap());
    assert_eq!((found.author.as_str(), found.tool.as_str()), ("ada", "lasso"));
    assert_eq!((found.radar.as_str(), found.scan), ("front", 3));
    assert_eq!(found.at.len(), "2026-01-31T12:34:56.789Z".len());
    let states: Vec<_> =
        found.scans.iter().map(|s| (s.key.scan, s.revision, s.corrections.clone())).collect();
    assert_eq!(states, [(2, 0, vec![]), (3, 1, vec![(1, 99), (2, 99)])]);
    assert_eq!(here.scan(&version(2)).unwrap().corrections, []);
    done(there.apply(&stroke(1, vec![edit(3, 1, &[2])]), &who("bob")).unwrap());
    let found = conflict(here.undo("00", &who("ada")).unwrap());
    assert_eq!((found.author.as_str(), found.scans[0].revision), ("bob", 2));
    done(there.undo("00", &who("bob")).unwrap());
    assert_eq!(done(here.undo("00", &who("ada")).unwrap()).changed, 2);
    let found = conflict(there.apply(&stroke(1, vec![edit(3, 2, &[2])]), &who("bob")).unwrap());
    assert_eq!((found.author.as_str(), found.tool.as_str()), ("ada", "undo"));
}

#[test]
fn other_windows_hear_of_each_scan_once() {
    let folder = Folder::new();
    let mut store = folder.open();
    assert_eq!(store.counter().unwrap(), 0);
    done(store.apply(&stroke(99, vec![edit(3, 0, &[1]), edit(4, 0, &[1])]), &who("ada")).unwrap());
    done(store.apply(&stroke(1, vec![edit(3, 1, &[1])]), &who("ada")).unwrap());
    let heard = store.changes("00", 0, Some("bob's")).unwrap();
    let scans: Vec<_> = heard.scans.iter().map(|s| (s.scan, s.revision, s.author.as_str())).collect();
    assert_eq!((heard.counter, scans), (2, vec![(4, 1, "ada"), (3, 2, "ada")]));
    assert_eq!(store.changes("00", 0, None).unwrap().scans.len(), 2);
    assert_eq!(store.changes("00", 1, None).unwrap().scans.len(), 1);
    for nothing in
        [store.changes("00", 0, Some("ada's")), store.changes("01", 0, None), store.changes("00", 2, None)]
    {
        let nothing = nothing.unwrap();
        assert_eq!((nothing.counter, nothing.scans), (2, vec![]));
    }
}

#[test]
fn a_mark_keeps_what_was_accepted_until_it_is_taken_away() {
    let folder = Folder::new();
    let mut store = folder.open();
    let mark =
        |reviewed, label| Mark { key: key(3), content: None, base: 0, machine: vec![label; 10], reviewed };
    let marked = |outcome| done(outcome).scans.remove(0).review;
    assert!(marked(store.mark(&mark(false, 99), &who("ada")).unwrap()).is_none());
    assert_eq!(store.counter().unwrap(), 0, "nothing was done");
    assert_eq!(marked(store.mark(&mark(true, 99), &who("ada")).unwrap()).unwrap().accepted, [99; 10]);
    let again = marked(store.mark(&mark(true, 1), &who("bob")).unwrap()).unwrap();
    assert_eq!((again.author.as_str(), again.accepted), ("bob", vec![99; 10]));
    assert_eq!(store.scan(&version(3)).unwrap().revision, 0, "a mark is no correction");
    assert_eq!(store.summaries("00").unwrap()[0].reviewed.as_ref().unwrap().0, "bob");
    assert_eq!(read_layer(&folder.file).unwrap()[&key(3)][0].accepted, Some(vec![99; 10]));
    assert!(marked(store.mark(&mark(false, 1), &who("ada")).unwrap()).is_none());
    assert!(store.summaries("00").unwrap().is_empty() && read_layer(&folder.file).unwrap().is_empty());
    assert_eq!(marked(store.mark(&mark(true, 1), &who("ada")).unwrap()).unwrap().accepted, [1; 10]);
    done(store.apply(&stroke(99, vec![edit(3, 0, &[1])]), &who("bob")).unwrap());
    assert!(
        matches!(store.mark(&mark(true, 1), &who("ada")).unwrap(), Outcome::Conflict(c) if c.author == "bob")
    );
}

/// There is no mark after the second step, nor after the fourth: what is there does not tell which of them came last.
#[test]
fn a_mark_that_another_set_and_took_away_since_is_in_the_way() {
    let folder = Folder::new();
    let mut store = folder.open();
    let mark = |reviewed| Mark { key: key(3), content: None, base: 0, machine: vec![99; 10], reviewed };
    for (reviewed, author) in [(true, "ada"), (false, "bob"), (true, "ada"), (false, "ada")] {
        done(store.mark(&mark(reviewed), &who(author)).unwrap());
    }
    let found = conflict(store.undo("00", &who("bob")).unwrap());
    assert_eq!((found.author.as_str(), found.tool.as_str(), found.scan), ("ada", "unreviewed", 3));
    drop(store);
    let mut store = folder.open();
    assert!(store.scan(&version(3)).unwrap().review.is_none());
    for author in ["ada", "ada", "bob", "ada"] {
        done(store.undo("00", &who(author)).unwrap());
    }
    done(store.mark(&mark(true), &who("bob")).unwrap());
    done(store.mark(&mark(false), &who("bob")).unwrap());
    assert_eq!(conflict(store.redo("00", &who("ada")).unwrap()).author, "bob");
    drop(store);
    folder.open();
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = Folder::new();
    let mut store = folder.open();
    let mut refusal = |scans| store.apply(&stroke(99, scans), &who("ada")).unwrap_err().to_string();
    let beyond = refusal(vec![edit(3, 0, &[10])]);
    assert_eq!(beyond, "front scan 3: expected detections below 10, found 10");
    let twice = refusal(vec![edit(3, 0, &[1]), edit(3, 0, &[2])]);
    assert_eq!(twice, "front scan 3: expected each scan once, found this one twice");
    done(store.apply(&stroke(99, vec![edit(3, 0, &[1])]), &who("ada")).unwrap());
}

#[test]
fn other_files_and_other_versions_are_refused() {
    let folder = Folder::new();
    fs::write(&folder.file, "these are notes, and no database of any kind".repeat(40)).unwrap();
    assert!(
        folder.refusal().contains("expected a whole SQLite database of corrections"),
        "{}",
        folder.refusal()
    );
    assert!(read_layer(&folder.file).is_err());
    let folder = Folder::new();
    folder.sql("CREATE TABLE notes (text TEXT)");
    let expected = "corrections.sqlite: application_id: expected 1380011078 (corrections), found 0";
    assert!(folder.refusal().ends_with(expected), "{}", folder.refusal());
    let folder = Folder::new();
    drop(folder.open());
    folder.sql("PRAGMA user_version = 3");
    let expected = "user_version: expected 2, found 3, of another version of the program";
    assert!(folder.refusal().ends_with(expected), "{}", folder.refusal());
    let error = read_layer(&folder.file).unwrap_err().to_string();
    assert!(error.ends_with(expected), "{error}");
}

#[test]
fn another_program_that_holds_the_file_is_waited_for_and_then_told() {
    let folder = Folder::new();
    let mut store = folder.open();
    let other = rusqlite::Connection::open(&folder.file).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    let error = store.apply(&stroke(99, vec![edit(3, 0, &[1])]), &who("ada")).unwrap_err();
    assert!(
        matches!(error, StoreError::Locked { .. }) && error.to_string().contains("locked by another"),
        "{error}"
    );
    // Reading goes on meanwhile.
    assert_eq!(store.scan(&version(3)).unwrap().revision, 0);
    other.execute_batch("COMMIT").unwrap();
    done(store.apply(&stroke(99, vec![edit(3, 0, &[1])]), &who("ada")).unwrap());
}

#[test]
fn every_commit_reaches_the_disk() {
    let folder = Folder::new();
    let mut store = folder.open();
    done(store.apply(&stroke(99, vec![edit(3, 0, &[1])]), &who("ada")).unwrap());
    let journal: String = rusqlite::Connection::open(&folder.file)
        .unwrap()
        .pragma_query_value(None, "journal_mode", |row| row.get(0))
        .unwrap();
    assert_eq!(journal, "wal");
    // As a kill leaves it: the journal is not written back yet.
    let copy = Folder::new();
    for suffix in ["", "-wal"] {
        let of = |file: &PathBuf| PathBuf::from(format!("{}{suffix}", file.display()));
        fs::copy(of(&folder.file), of(&copy.file)).unwrap();
    }
    assert_eq!(copy.open().scan(&version(3)).unwrap().corrections, [(1, 99)]);
}

/// Scan 2 and scan 3 by one stroke, scan 3 before and after it; then scan 2 holds something else.
#[test]
fn steps_on_what_is_gone_are_passed_over_and_found_when_it_is_back() {
    let folder = Folder::new();
    let (mut store, ada) = (folder.open(), who("ada"));
    done(store.apply(&stroke(30, vec![edit(3, 0, &[1, 2])]), &ada).unwrap());
    done(store.apply(&stroke(10, vec![edit(2, 0, &[4]), edit(3, 1, &[5, 6])]), &ada).unwrap());
    done(store.apply(&stroke(11, vec![edit(2, 1, &[7])]), &ada).unwrap());
    assert_eq!(store.versions("00").unwrap(), [version(3), version(2)]);
    let gone = [version(2)];
    let history = |store: &Store, gone: &[ScanVersion]| {
        let found = store.history_without("00", "ada", gone).unwrap();
        let label = |step: Option<Step>| step.and_then(|step| step.label);
        ((found.undo_depth, label(found.undo)), (found.redo_depth, label(found.redo)))
    };
    assert_eq!(history(&store, &gone), ((1, Some(30)), (0, None)));
    let undone = done(store.undo_without("00", &ada, &gone).unwrap());
    assert_eq!((undone.changed, undone.scans[0].corrections.as_slice()), (2, &[(5, 10), (6, 10)][..]));
    assert_eq!((undone.history.undo, undone.history.redo_depth), (None, 1));
    let nothing = done(store.undo_without("00", &ada, &gone).unwrap());
    assert_eq!((nothing.changed, nothing.stroke), (0, None));
    // What was taken back while it was there is not set again either.
    assert_eq!(done(store.undo("00", &ada).unwrap()).changed, 1);
    assert_eq!(history(&store, &gone), ((0, None), (1, Some(30))));
    assert_eq!(done(store.redo_without("00", &ada, &gone).unwrap()).changed, 2);
    assert_eq!(done(store.redo_without("00", &ada, &gone).unwrap()).changed, 0);
    assert_eq!(history(&store, &[]), ((2, Some(30)), (1, Some(11))));
    assert_eq!(store.scan(&version(2)).unwrap().corrections, [(4, 10)]);
    drop(folder.open());
}

/// Nothing is taken from below a step that was passed over, even where it left the same.
#[test]
fn a_step_below_one_that_is_passed_over_stays() {
    let folder = Folder::new();
    let (mut store, ada) = (folder.open(), who("ada"));
    done(store.apply(&stroke(30, vec![edit(3, 0, &[1])]), &ada).unwrap());
    let again = Stroke { confirm: true, ..stroke(30, vec![edit(2, 0, &[4]), edit(3, 1, &[1])]) };
    done(store.apply(&again, &ada).unwrap());
    let met = conflict(store.undo_without("00", &ada, &[version(2)]).unwrap());
    assert_eq!((met.author.as_str(), met.scan), ("ada", 3));
    drop(folder.open());
    assert_eq!(done(store.undo("00", &ada).unwrap()).changed, 2);
    assert_eq!(done(store.undo("00", &ada).unwrap()).changed, 1);
}

/// A group of two strokes with another window's stroke between them, which rests on the first one or doesn't.
#[test]
fn a_group_is_one_step_whatever_another_window_did_meanwhile() {
    for (between, depth, changed) in [(7, 2, [3, 1, 0]), (1, 3, [2, 1, 1])] {
        let folder = Folder::new();
        let (mut store, ada) = (folder.open(), who("ada"));
        let of_group = |label, at| Stroke { group: Some("a".into()), ..stroke(label, vec![at]) };
        done(store.apply(&of_group(10, edit(3, 0, &[1])), &ada).unwrap());
        done(store.apply(&stroke(30, vec![edit(3, 1, &[between])]), &ada).unwrap());
        let last = done(store.apply(&of_group(10, edit(2, 0, &[2, 4])), &ada).unwrap());
        assert_eq!(last.history.undo_depth, depth);
        assert_eq!(changed.map(|_| done(store.undo("00", &ada).unwrap()).changed), changed);
        assert_eq!(store.scan(&version(3)).unwrap().corrections, []);
        (0..3).for_each(|_| drop(done(store.redo("00", &ada).unwrap())));
        let label = if between == 1 { vec![(1, 30)] } else { vec![(1, 10), (7, 30)] };
        assert_eq!(store.scan(&version(3)).unwrap().corrections, label);
    }
}

#[test]
fn who_works_over_midnight_has_worked_without_a_break() {
    let folder = Folder::new();
    let (mut store, ada) = (folder.open(), who("ada"));
    for point in 0..3 {
        done(store.apply(&stroke(10, vec![edit(3, point, &[point as u32])]), &ada).unwrap());
    }
    for (event, at) in [(1, "03T23:57:00"), (2, "03T23:59:00"), (3, "04T00:02:00")] {
        folder.sql(&format!("UPDATE event SET at = '2026-02-{at}.000Z' WHERE id = {event}"));
    }
    let worked: Vec<_> =
        store.workdays().unwrap().into_iter().map(|day| (day.day, day.worked_s.round())).collect();
    assert_eq!(worked, [("2026-02-03".to_owned(), 120.0), ("2026-02-04".to_owned(), 180.0)]);
}
