//! Edits with a name are made once, marks are steps, and a person's name is no person.
use ralf_corrections::{
    Conflict, Edit, Mark, Outcome, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, StoreError, Stroke,
    Who,
};

struct Open {
    _folder: tempfile::TempDir,
    store: Store,
}

impl Open {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(&folder.path().join("corrections.sqlite")).unwrap();
        Self { _folder: folder, store }
    }

    fn stroke(&mut self, base: u64, point: u32, label: u16, who: &Who) -> Outcome {
        let points = vec![point];
        let edit = ScanEdit { radar: "front".into(), scan: 3, detections: 10, content: None, base, points };
        let stroke =
            Stroke { tool: "box".into(), label: Some(label), scans: vec![edit], ..Stroke::of_sequence("00") };
        self.store.apply(&stroke, who).unwrap()
    }

    fn mark(&mut self, reviewed: bool, who: &Who) -> Outcome {
        let mark = Mark { key: key(), content: None, base: 0, machine: vec![99; 10], reviewed };
        self.store.mark(&mark, who).unwrap()
    }

    fn undo(&mut self, who: &Who) -> Outcome {
        self.store.undo("00", who).unwrap()
    }

    fn reviewed_by(&self) -> Option<String> {
        let version = ScanVersion { key: key(), content: ScanContent { detections: 10, hash: None } };
        self.store.scan(&version).unwrap().review.map(|review| review.author)
    }

    fn depths(&self, author: &str) -> (u64, u64) {
        let history = self.store.history("00", author).unwrap();
        (history.undo_depth, history.redo_depth)
    }
}

fn key() -> ScanKey {
    ScanKey { sequence: "00".into(), radar: "front".into(), scan: 3 }
}

fn named(author: &str, edit: &str) -> Who {
    Who { edit: Some(edit.into()), ..Who::named(author) }
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
fn a_stroke_whose_answer_was_lost_is_answered_again_and_made_once() {
    let mut open = Open::new();
    let first = done(open.stroke(0, 1, 99, &named("ada", "s1")));
    assert_eq!(done(open.stroke(0, 1, 99, &named("ada", "s1"))), first);
    assert_eq!(open.store.counter().unwrap(), 1);
    // Somebody else's later edit makes no conflict of it, and is still met by the next stroke.
    done(open.stroke(1, 2, 1, &Who::named("bob")));
    let again = done(open.stroke(0, 1, 99, &named("ada", "s1")));
    assert_eq!((again.stroke, again.changed, again.scans[0].revision), (first.stroke, 1, 1));
    assert_eq!(again.scans[0].corrections, [(1, 99), (2, 1)]);
    assert_eq!(conflict(open.stroke(1, 3, 99, &named("ada", "s2"))).author, "bob");
}

#[test]
fn a_stroke_that_changed_nothing_is_answered_alike_when_asked_again() {
    let mut open = Open::new();
    done(open.stroke(0, 1, 99, &Who::named("ada")));
    assert_eq!(done(open.stroke(1, 1, 99, &named("ada", "s1"))).changed, 0);
    done(open.stroke(1, 1, 1, &Who::named("bob")));
    let again = done(open.stroke(1, 1, 99, &named("ada", "s1")));
    assert_eq!((again.stroke, again.changed), (None, 0));
    assert_eq!(again.scans[0].revision, 1);
}

#[test]
fn undo_redo_and_marks_asked_for_twice_are_made_once() {
    let mut open = Open::new();
    for point in 0..3 {
        done(open.stroke(u64::from(point), point, 99, &Who::named("ada")));
    }
    let undone = done(open.undo(&named("ada", "u1")));
    assert_eq!(done(open.undo(&named("ada", "u1"))), undone);
    assert_eq!(open.depths("ada"), (2, 1));
    let redone = done(open.store.redo("00", &named("ada", "r1")).unwrap());
    assert_eq!(done(open.store.redo("00", &named("ada", "r1")).unwrap()), redone);
    assert_eq!(open.depths("ada"), (3, 0));
    let mut open = Open::new();
    let marked = done(open.mark(true, &named("ada", "m1")));
    assert_eq!(done(open.mark(true, &named("ada", "m1"))), marked);
    assert_eq!(open.depths("ada"), (1, 0));
}

#[test]
fn a_name_that_another_edit_has_is_refused_and_nothing_is_done() {
    let mut open = Open::new();
    done(open.stroke(0, 1, 99, &named("ada", "s1")));
    let refused = |found: Result<Outcome, StoreError>| {
        let error = found.unwrap_err();
        assert!(matches!(error, StoreError::Request { .. }), "{error}");
        assert_eq!(error.to_string(), "id: expected one of its own, found that of another edit");
    };
    refused(open.store.undo("00", &named("ada", "s1")));
    refused(open.store.undo("00", &named("bob", "s1")));
    assert_eq!((open.depths("ada"), open.store.counter().unwrap()), ((1, 0), 1));
}

#[test]
fn undo_takes_a_mark_back_and_redo_sets_it_again() {
    let mut open = Open::new();
    let ada = Who::named("ada");
    done(open.mark(true, &ada));
    let step = open.store.history("00", "ada").unwrap().undo.unwrap();
    assert_eq!((step.tool.as_str(), step.changed), ("reviewed", 1));
    let undone = done(open.undo(&ada));
    assert_eq!((undone.changed, undone.scans[0].revision, &undone.scans[0].review), (1, 0, &None));
    assert_eq!(open.reviewed_by(), None);
    done(open.store.redo("00", &ada).unwrap());
    assert_eq!(open.reviewed_by().as_deref(), Some("ada"));
    done(open.mark(false, &ada));
    assert_eq!(open.reviewed_by(), None);
    done(open.undo(&ada));
    assert_eq!(open.reviewed_by().as_deref(), Some("ada"), "taking a mark away is a step, too");
    // Somebody else's mark in its place.
    done(open.mark(true, &Who::named("bob")));
    let met = conflict(open.undo(&ada));
    assert_eq!((met.author.as_str(), met.tool.as_str()), ("bob", "reviewed"));
    done(open.undo(&Who::named("bob")));
    done(open.undo(&ada));
    assert_eq!(open.reviewed_by(), None);
}

#[test]
fn undo_takes_back_ones_own_last_stroke_and_nobody_elses() {
    let mut open = Open::new();
    let [ada, bob] = ["a1", "b2"].map(|id| Who {
        author: id.into(),
        name: "anna".into(),
        is_named: true,
        tab: None,
        edit: None,
    });
    done(open.stroke(0, 1, 99, &ada));
    done(open.stroke(1, 2, 99, &bob));
    let undone = done(open.undo(&ada));
    assert_eq!(undone.scans[0].corrections, [(2, 99)], "two people of one name are two");
    let nothing = done(open.undo(&ada));
    assert_eq!((nothing.stroke, nothing.changed), (None, 0));
    // Under another name it is the same person.
    let renamed = Who { name: "Anna B.".into(), ..bob };
    assert_eq!(conflict(open.stroke(0, 4, 99, &ada)).author, "anna");
    assert_eq!(done(open.undo(&renamed)).scans[0].corrections, []);
    assert_eq!(conflict(open.stroke(0, 4, 99, &ada)).author, "Anna B.");
    // A browser that knows no name says nothing of what its person was called before.
    let unnamed = Who { name: "anybody".into(), is_named: false, ..renamed };
    let base = conflict(open.stroke(0, 4, 99, &ada)).scans[0].revision;
    done(open.stroke(base, 5, 99, &unnamed));
    assert_eq!(conflict(open.stroke(0, 4, 99, &ada)).author, "Anna B.");
}
