//! The store against a simple model in memory, on random edits of two people.

mod comparing;
mod model;

use comparing::{compare, compare_past};
use model::{How, Model, Place, SCANS};
use proptest::prelude::*;
use ralf_corrections::{
    Mark, Outcome, SETTLE, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, Stroke, Who,
};
use std::collections::BTreeSet;

const POINTS: u32 = 4;

const SEQUENCE: &str = "00";

#[derive(Debug, Clone)]
enum Op {
    Stroke { points: BTreeSet<Place>, how: How, group: Option<u8>, stale: bool },
    Mark { scan: u32, reviewed: bool },
    Undo,
    Redo,
    Reopen,
}

fn who(author: u8) -> Who {
    Who::named(["ada", "bob"][usize::from(author)])
}

fn version(scan: u32) -> ScanVersion {
    let key = ScanKey { sequence: SEQUENCE.into(), radar: "front".into(), scan };
    ScanVersion { key, content: ScanContent { detections: POINTS, hash: None } }
}

/// What came of it: how many corrections changed, or nothing of a conflict.
fn changed(outcome: Outcome) -> Option<usize> {
    match outcome {
        Outcome::Done(edit) => Some(edit.changed as usize),
        Outcome::Conflict(_) => None,
    }
}

fn edits(model: &Model, points: &BTreeSet<Place>, stale: bool) -> Vec<ScanEdit> {
    let scans: BTreeSet<u32> = points.iter().map(|(scan, _)| *scan).collect();
    let edit = |scan: u32| ScanEdit {
        radar: "front".into(),
        scan,
        detections: POINTS,
        content: None,
        base: model.revisions[scan as usize] + u64::from(stale),
        points: points.iter().filter(|(of, _)| *of == scan).map(|(_, point)| *point).collect(),
    };
    scans.into_iter().map(edit).collect()
}

fn step(store: &mut Store, model: &mut Model, author: u8, op: &Op) {
    match op {
        Op::Stroke { points, how, group, stale } => {
            let scans = edits(model, points, *stale);
            let How { label, protect, confirms, settles } = *how;
            let group_name = group.map(|group| group.to_string());
            let by_hand = if confirms { "kind" } else { "lasso" };
            let tool = if settles { SETTLE } else { by_hand }.to_owned();
            let stroke = Stroke {
                sequence: SEQUENCE.to_owned(),
                tool,
                group: group_name,
                protect,
                confirm: confirms || settles,
                label,
                cause: None,
                scans,
            };
            let expected = (!stale).then(|| model.stroke(author, points, *how, *group));
            assert_eq!(changed(store.apply(&stroke, &who(author)).unwrap()), expected);
        }
        Op::Mark { scan, reviewed } => {
            let ScanVersion { key, .. } = version(*scan);
            let (machine, base) = (vec![99; POINTS as usize], model.revisions[*scan as usize]);
            let mark = Mark { key, content: None, base, machine, reviewed: *reviewed };
            let expected = Some(model.mark(author, *scan, *reviewed));
            assert_eq!(changed(store.mark(&mark, &who(author)).unwrap()), expected);
        }
        Op::Undo => assert_eq!(changed(store.undo(SEQUENCE, &who(author)).unwrap()), model.undo(author)),
        Op::Redo => assert_eq!(changed(store.redo(SEQUENCE, &who(author)).unwrap()), model.redo(author)),
        Op::Reopen => *store = Store::open(store.file()).unwrap(),
    }
}

fn op() -> impl Strategy<Value = Op> {
    let few = proptest::collection::btree_set((0..2u32, 0..POINTS), 1..4);
    // A thing is seen in every scan, now and then twice.
    let thing = (0..POINTS, proptest::collection::btree_set((0..SCANS, 0..POINTS), 0..3)).prop_map(
        |(point, twice)| (0..SCANS).map(|scan| (scan, point)).chain(twice).collect::<BTreeSet<Place>>(),
    );
    let points = prop_oneof![2 => few, 1 => thing];
    let label = prop_oneof![Just(None), Just(Some(1)), Just(Some(99))];
    let group = prop_oneof![3 => Just(None), 1 => (0..2u8).prop_map(Some)];
    let how = (label, any::<bool>(), proptest::bool::weighted(0.3), proptest::bool::weighted(0.2))
        .prop_map(|(label, protect, confirms, settles)| How { label, protect, confirms, settles });
    let stroke = (points, how, group, proptest::bool::weighted(0.1));
    prop_oneof![
        5 => stroke.prop_map(|(points, how, group, stale)| Op::Stroke { points, how, group, stale }),
        3 => (0..2u32, any::<bool>()).prop_map(|(scan, reviewed)| Op::Mark { scan, reviewed }),
        4 => Just(Op::Undo),
        3 => Just(Op::Redo),
        1 => Just(Op::Reopen),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn the_store_does_what_the_model_does(ops in proptest::collection::vec((0..2u8, op()), 1..40)) {
        let folder = tempfile::tempdir().unwrap();
        let mut store = Store::open(&folder.path().join("corrections.sqlite")).unwrap();
        let mut model = Model::default();
        for (author, op) in &ops {
            step(&mut store, &mut model, *author, op);
            compare(&store, &model);
        }
        compare_past(&store, &model);
    }

    #[test]
    fn one_person_can_take_everything_back_and_set_it_again(ops in proptest::collection::vec(op(), 1..25)) {
        let folder = tempfile::tempdir().unwrap();
        let mut store = Store::open(&folder.path().join("corrections.sqlite")).unwrap();
        let mut model = Model::default();
        ops.iter().for_each(|op| step(&mut store, &mut model, 0, op));
        let before: Vec<_> = (0..SCANS).map(|scan| store.scan(&version(scan)).unwrap().corrections).collect();
        let depth = store.history(SEQUENCE, "ada").unwrap().undo_depth;
        for _ in 0..depth {
            prop_assert!(changed(store.undo(SEQUENCE, &who(0)).unwrap()).is_some_and(|changed| changed > 0));
        }
        for scan in 0..SCANS {
            prop_assert_eq!(store.scan(&version(scan)).unwrap().corrections, []);
        }
        for _ in 0..depth {
            prop_assert!(changed(store.redo(SEQUENCE, &who(0)).unwrap()).is_some_and(|changed| changed > 0));
        }
        let after: Vec<_> = (0..SCANS).map(|scan| store.scan(&version(scan)).unwrap().corrections).collect();
        prop_assert_eq!(before, after);
    }
}
