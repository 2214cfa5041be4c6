//! Why detections are artifacts, as far as a stroke said so.
//!
//! A cause is a stroke's. A detection has that of the stroke that said something of it last, of those that hold: where
//! that is taken back, what the one before it said is there again. Who confirms a label leaves its cause. So nothing
//! else is kept of it, and a program that knows no causes reads and writes the same store.

use crate::settled::SETTLE;
use rusqlite::{Connection, params};
use std::collections::{BTreeMap, BTreeSet};

/// The causes that strokes have said. A store of a program that knew none gets it when it is opened for writing.
const TABLE: &str = "CREATE TABLE IF NOT EXISTS stroke_cause (
  stroke INTEGER PRIMARY KEY REFERENCES stroke,
  cause TEXT NOT NULL
) STRICT";

/// Makes the table where there is none.
pub(crate) fn make_room(on: &Connection) -> rusqlite::Result<()> {
    on.execute_batch(TABLE)
}

/// Notes what a stroke says is the cause.
pub(crate) fn say(on: &Connection, stroke: i64, cause: &str) -> rusqlite::Result<()> {
    on.prepare_cached("INSERT INTO stroke_cause (stroke, cause) VALUES (?, ?)")?
        .execute(params![stroke, cause])
        .map(drop)
}

/// The cause of each detection of a scan that has one, ascending.
pub(crate) fn causes(on: &Connection, scan: i64) -> rusqlite::Result<Vec<(u32, String)>> {
    last_causes(on, scan, |_, _| true)
}

/// The same before each was settled for the first time.
pub(crate) fn causes_before_settling(on: &Connection, scan: i64) -> rusqlite::Result<Vec<(u32, String)>> {
    let mut settled = BTreeSet::new();
    last_causes(on, scan, |point, tool| {
        if tool == SETTLE {
            settled.insert(point);
        }
        !settled.contains(&point)
    })
}

/// The last cause of each detection, by the strokes that count of it: the detection and the stroke's tool tell.
fn last_causes(
    on: &Connection,
    scan: i64,
    mut counts: impl FnMut(u32, &str) -> bool,
) -> rusqlite::Result<Vec<(u32, String)>> {
    if !any(on)? {
        return Ok(Vec::new());
    }
    let mut query = on.prepare_cached(
        "SELECT point, cause, before IS after, tool FROM change JOIN stroke ON stroke.id = change.stroke
         LEFT JOIN stroke_cause ON stroke_cause.stroke = stroke.id
         WHERE scan = ? AND applied IS NOT NULL ORDER BY applied, stroke.id",
    )?;
    let mut last = BTreeMap::new();
    let mut rows = query.query([scan])?;
    while let Some(row) = rows.next()? {
        let (point, says_the_same): (u32, bool) = (row.get(0)?, row.get(2)?);
        if !counts(point, row.get_ref(3)?.as_str()?) {
            continue;
        }
        match row.get::<_, Option<String>>(1)? {
            Some(cause) => drop(last.insert(point, cause)),
            None if says_the_same => (),
            None => drop(last.remove(&point)),
        }
    }
    Ok(last.into_iter().collect())
}

/// Whether a cause was ever said: most stores hold none, and are read without looking further.
pub(crate) fn any(on: &Connection) -> rusqlite::Result<bool> {
    let tables = "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'stroke_cause'";
    let found: i64 = on.prepare_cached(tables)?.query_row([], |row| row.get(0))?;
    Ok(found > 0 && on.prepare_cached("SELECT 1 FROM stroke_cause LIMIT 1")?.exists([])?)
}

#[cfg(test)]
mod tests {
    use crate::{
        Reader, SETTLE, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, Stroke, Who, read_layer,
    };
    use proptest::prelude::*;
    use std::collections::{BTreeMap, BTreeSet};

    const POINTS: u32 = 4;

    fn version() -> ScanVersion {
        let key = ScanKey { sequence: "00".into(), radar: "front".into(), scan: 0 };
        ScanVersion { key, content: ScanContent { detections: POINTS, hash: None } }
    }

    fn stroke(store: &Store, points: Vec<u32>, label: Option<u16>, cause: Option<&str>) -> Stroke {
        let base = store.scan(&version()).unwrap().revision;
        let edit =
            ScanEdit { radar: "front".into(), scan: 0, detections: POINTS, content: None, base, points };
        let cause = cause.map(str::to_owned);
        Stroke { tool: "rule".into(), label, cause, scans: vec![edit], ..Stroke::of_sequence("00") }
    }

    fn open(folder: &tempfile::TempDir) -> Store {
        Store::open(&folder.path().join("corrections.sqlite")).unwrap()
    }

    #[test]
    fn what_was_said_before_it_was_settled_is_told_for_ever() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = open(&folder);
        for (tool, cause) in [("rule", "ground"), (SETTLE, "noise"), ("rule", "mirror")] {
            let made = stroke(&store, vec![1], Some(99), Some(cause));
            store.apply(&Stroke { tool: tool.into(), ..made }, &Who::named("ada")).unwrap();
        }
        let all = read_layer(&folder.path().join("corrections.sqlite")).unwrap();
        let [layer] = all.values().next().unwrap().as_slice() else { unreachable!() };
        assert_eq!(layer.causes, [(1, "mirror".to_owned())]);
        assert_eq!(layer.before_settling().causes, [(1, "ground".to_owned())]);
    }

    #[derive(Debug, Clone)]
    enum Op {
        Stroke(Vec<u32>, Option<u16>, Option<&'static str>),
        Undo,
        Redo,
    }

    fn op() -> impl Strategy<Value = Op> {
        let points = proptest::collection::btree_set(0..POINTS, 1..4).prop_map(Vec::from_iter);
        let said = prop_oneof![
            Just((None, None)),
            Just((Some(99), None)),
            Just((Some(1), None)),
            Just((Some(1), Some("mirror"))),
            Just((Some(1), Some("road")))
        ];
        prop_oneof![
            4 => (points, said).prop_map(|(points, (label, cause))| Op::Stroke(points, label, cause)),
            2 => Just(Op::Undo),
            1 => Just(Op::Redo),
        ]
    }

    /// What is said of each point: label and cause.
    type Said = BTreeMap<u32, (u16, Option<&'static str>)>;

    /// Everything that was said after each step that holds, the first before any.
    struct Model {
        past: Vec<Said>,
        future: Vec<Said>,
    }

    impl Model {
        fn now(&self) -> Said {
            self.past.last().cloned().unwrap_or_default()
        }

        fn apply(&mut self, op: &Op) {
            match op {
                Op::Stroke(points, label, cause) => {
                    let mut next = self.now();
                    for point in points {
                        let before = next.get(point).map(|said| said.0);
                        match label {
                            Some(label) if before != Some(*label) || cause.is_some() => {
                                next.insert(*point, (*label, *cause));
                            }
                            None => {
                                next.remove(point);
                            }
                            _ => (),
                        }
                    }
                    if next != self.now() {
                        self.past.push(next);
                        self.future.clear();
                    }
                }
                Op::Undo => self.future.extend(self.past.pop()),
                Op::Redo => self.past.extend(self.future.pop()),
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

        #[test]
        fn causes_come_and_go_with_the_strokes_that_said_them(ops in proptest::collection::vec(op(), 1..20)) {
            let folder = tempfile::tempdir().unwrap();
            let mut store = open(&folder);
            let mut model = Model { past: Vec::new(), future: Vec::new() };
            let who = Who::named("ada");
            for op in &ops {
                model.apply(op);
                match op {
                    Op::Stroke(points, label, cause) => {
                        let stroke = stroke(&store, points.clone(), *label, *cause);
                        drop(store.apply(&stroke, &who).unwrap());
                    }
                    Op::Undo => drop(store.undo("00", &who).unwrap()),
                    Op::Redo => drop(store.redo("00", &who).unwrap()),
                }
                let state = store.scan(&version()).unwrap();
                let causes: BTreeMap<u32, String> = state.causes.into_iter().collect();
                let found = state.corrections.iter().map(|(point, label)| (*point, (*label, causes.get(point))));
                let found: Vec<_> = found.map(|(point, (label, why))| (point, label, why.cloned())).collect();
                let expected: Vec<_> = model.now().into_iter()
                    .map(|(point, (label, why))| (point, label, why.map(str::to_owned))).collect();
                prop_assert_eq!(found, expected);
                prop_assert!(causes.keys().all(|point| model.now().contains_key(point)));
            }
        }
    }

    #[test]
    fn a_store_of_a_program_that_knew_no_causes_is_read_and_written() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = open(&folder);
        let first = stroke(&store, vec![1], Some(1), None);
        store.apply(&first, &Who::named("ada")).unwrap();
        drop(store);
        let file = folder.path().join("corrections.sqlite");
        rusqlite::Connection::open(&file).unwrap().execute_batch("DROP TABLE stroke_cause").unwrap();
        let said = read_layer(&file).unwrap();
        assert_eq!(said[&version().key][0].corrections, [(1, 1)]);
        let asked = [(version(), BTreeSet::from([1, 2]))];
        let told = |store: &Reader| -> Vec<(Option<String>, bool)> {
            store.sayings(&asked).unwrap().into_iter().map(|saying| (saying.cause, saying.holds)).collect()
        };
        assert_eq!(told(&Reader::open(&file).unwrap()), [(None, true)], "read where nothing can be written");
        let mut store = open(&folder);
        let with_cause = stroke(&store, vec![1, 2], Some(1), Some("noise"));
        store.apply(&with_cause, &Who::named("ada")).unwrap();
        let noise = [(1, "noise".to_owned()), (2, "noise".to_owned())];
        assert_eq!(store.scan(&version()).unwrap().causes, noise);
        assert_eq!(told(&store), [(Some("noise".to_owned()), true), (None, true)]);
        let confirmed = Stroke { confirm: true, ..stroke(&store, vec![1], Some(1), None) };
        store.apply(&confirmed, &Who::named("bob")).unwrap();
        assert_eq!(
            store.scan(&version()).unwrap().causes,
            noise,
            "the label is confirmed, and with it its cause"
        );
        store.undo("00", &Who::named("bob")).unwrap();
        store.undo("00", &Who::named("ada")).unwrap();
        assert_eq!(store.scan(&version()).unwrap().causes, []);
        assert_eq!(told(&store), [(None, false), (Some("noise".to_owned()), false), (None, true)]);
    }
}
