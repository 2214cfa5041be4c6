//! The store against a simple model in memory, on random edits of two people.
//!
//! The model keeps the strokes that hold in a list, in the order in which they were set, and finds the
//! corrections by going through it from the start. The store never does so.
use proptest::prelude::*;
use ralf_corrections::{
    Mark, Outcome, SETTLE, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, Stroke, Who, read_layer,
};
use std::collections::{BTreeMap, BTreeSet};

const SCANS: u32 = 5;
const POINTS: u32 = 4;
const SEQUENCE: &str = "00";

type Place = (u32, u32);
type Values = BTreeMap<Place, u16>;

#[derive(Debug, Clone)]
enum Op {
    Stroke { points: BTreeSet<Place>, how: How, group: Option<u8>, stale: bool },
    Mark { scan: u32, reviewed: bool },
    Undo,
    Redo,
    Reopen,
}

/// What a stroke says, and of which detections.
#[derive(Debug, Clone, Copy)]
struct How {
    label: Option<u16>,
    protect: bool,
    /// It says again what was said already, as the answer about a kind does.
    confirms: bool,
    /// It settles a disagreement, and says again what was said already.
    settles: bool,
}

#[derive(Debug, Clone, Default)]
struct Done {
    author: u8,
    group: Option<u8>,
    settles: bool,
    /// Correction before and after.
    changes: BTreeMap<Place, (Option<u16>, Option<u16>)>,
    /// A scan's mark before and after, each by the number of the edit that made it.
    mark: Option<(u32, Option<usize>, Option<usize>)>,
}

impl Done {
    fn changed(&self) -> usize {
        self.changes.len() + usize::from(self.mark.is_some())
    }
}

/// A step that was taken back, and how many edits there had been by then.
type Undone = (Vec<Done>, usize);

#[derive(Debug, Default)]
struct Model {
    /// Strokes that hold, with the number of the edit that set them.
    holding: Vec<(Done, usize)>,
    undone: BTreeMap<u8, Vec<Undone>>,
    marks: BTreeMap<u32, usize>,
    /// All that was ever done, whether it holds or not.
    made: Vec<Done>,
    revisions: [u64; SCANS as usize],
    edits: usize,
}

impl Model {
    fn values(&self) -> Values {
        let mut values = Values::new();
        for (stroke, _) in &self.holding {
            set(&mut values, stroke, |(_, after)| *after);
        }
        values
    }

    fn count(&mut self, strokes: &[Done]) {
        self.edits += 1;
        let scans: BTreeSet<u32> =
            strokes.iter().flat_map(|s| s.changes.keys()).map(|(scan, _)| *scan).collect();
        scans.into_iter().for_each(|scan| self.revisions[scan as usize] += 1);
    }

    fn hold(&mut self, done: Done) {
        self.count(std::slice::from_ref(&done));
        self.undone.remove(&done.author);
        self.made.push(done.clone());
        self.holding.push((done, self.edits));
    }

    /// How many corrections changed.
    fn stroke(&mut self, author: u8, points: &BTreeSet<Place>, how: How, group: Option<u8>) -> usize {
        let How { label, protect, confirms, settles } = how;
        let values = self.values();
        let before = |place: &Place| values.get(place).copied();
        let said = |place: &Place| confirms || settles || before(place) != label;
        let free = |place: &Place| !(protect && before(place).is_some());
        let places = points.iter().filter(|place| said(place) && free(place));
        let changes: BTreeMap<_, _> = places.map(|place| (*place, (before(place), label))).collect();
        let changed = changes.len();
        if changed > 0 {
            self.hold(Done { author, group, settles, changes, ..Done::default() });
        }
        changed
    }

    /// How many marks changed.
    fn mark(&mut self, author: u8, scan: u32, reviewed: bool) -> usize {
        let before = self.marks.get(&scan).copied();
        if !reviewed && before.is_none() {
            return 0;
        }
        let after = reviewed.then_some(self.edits + 1);
        self.hold(Done { author, mark: Some((scan, before, after)), ..Done::default() });
        self.move_mark(scan, after);
        1
    }

    fn move_mark(&mut self, scan: u32, to: Option<usize>) {
        match to {
            Some(mark) => self.marks.insert(scan, mark),
            None => self.marks.remove(&scan),
        };
    }

    /// Moves the marks of a step, unless one of them is another one now.
    fn move_marks(&mut self, step: &[Done], back: bool) -> bool {
        let moves = step.iter().filter_map(|stroke| stroke.mark);
        let turned = moves
            .map(|(scan, before, after)| if back { (scan, after, before) } else { (scan, before, after) });
        let moves: Vec<_> = turned.collect();
        if moves.iter().any(|(scan, from, _)| self.marks.get(scan).copied() != *from) {
            return false;
        }
        moves.into_iter().for_each(|(scan, _, to)| self.move_mark(scan, to));
        true
    }

    /// What was said of each detection before it was settled first, as far as that holds.
    fn settled(&self) -> BTreeMap<Place, Option<u16>> {
        let mut first = BTreeMap::new();
        for (stroke, _) in self.holding.iter().filter(|(stroke, _)| stroke.settles) {
            for (place, (before, _)) in &stroke.changes {
                first.entry(*place).or_insert(*before);
            }
        }
        first
    }

    /// How many corrections changed; `None` is a conflict.
    fn undo(&mut self, author: u8) -> Option<usize> {
        let mut rest = self.holding.clone();
        let mut step: Vec<Done> = Vec::new();
        while let Some(at) = rest.iter().rposition(|(stroke, _)| stroke.author == author) {
            let goes_on =
                step.last().is_none_or(|last: &Done| last.group.is_some() && last.group == rest[at].0.group);
            if !goes_on {
                break;
            }
            let (stroke, _) = rest.remove(at);
            if rest[at..].iter().any(|(later, _)| meets(later, &stroke)) {
                return None;
            }
            step.push(stroke);
        }
        if step.is_empty() {
            return Some(0);
        }
        step.reverse();
        if !self.move_marks(&step, true) {
            return None;
        }
        self.holding = rest;
        self.count(&step);
        let changed = step.iter().map(Done::changed).sum();
        self.undone.entry(author).or_default().push((step, self.edits));
        Some(changed)
    }

    /// The same.
    fn redo(&mut self, author: u8) -> Option<usize> {
        let Some((step, since)) = self.undone.get(&author).and_then(|steps| steps.last()).cloned() else {
            return Some(0);
        };
        let mut values = self.values();
        for stroke in &step {
            let touched = self.holding.iter().any(|(later, set)| *set > since && meets(later, stroke));
            let moved =
                stroke.changes.iter().any(|(place, (before, _))| values.get(place).copied() != *before);
            if touched || moved {
                return None;
            }
            set(&mut values, stroke, |(_, after)| *after);
        }
        if !self.move_marks(&step, false) {
            return None;
        }
        self.undone.get_mut(&author)?.pop();
        self.count(&step);
        let changed = step.iter().map(Done::changed).sum();
        let edit = self.edits;
        self.holding.extend(step.into_iter().map(|stroke| (stroke, edit)));
        Some(changed)
    }
}

/// Whether two strokes are of different people and share a detection.
fn meets(a: &Done, b: &Done) -> bool {
    a.author != b.author && a.changes.keys().any(|place| b.changes.contains_key(place))
}

fn set(values: &mut Values, stroke: &Done, to: impl Fn(&(Option<u16>, Option<u16>)) -> Option<u16>) {
    for (place, change) in &stroke.changes {
        match to(change) {
            Some(label) => values.insert(*place, label),
            None => values.remove(place),
        };
    }
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

fn compare(store: &Store, model: &Model) {
    let mut found = Values::new();
    for scan in 0..SCANS {
        let state = store.scan(&version(scan)).unwrap();
        assert_eq!(state.revision, model.revisions[scan as usize]);
        assert_eq!(state.review.is_some(), model.marks.contains_key(&scan));
        found.extend(state.corrections.into_iter().map(|(point, label)| ((scan, point), label)));
    }
    assert_eq!(found, model.values());
    for author in 0..2 {
        let history = store.history(SEQUENCE, &who(author).author).unwrap();
        let undone = model.undone.get(&author).map_or(0, Vec::len);
        assert_eq!(history.redo_depth as usize, undone);
        let own: Vec<Option<u8>> =
            model.holding.iter().filter(|(s, _)| s.author == author).map(|(s, _)| s.group).collect();
        let begins = |at: usize| at == 0 || own[at].is_none() || own[at] != own[at - 1];
        assert_eq!(history.undo_depth as usize, (0..own.len()).filter(|at| begins(*at)).count());
        assert_eq!((history.undo.is_some(), history.redo.is_some()), (!own.is_empty(), undone > 0));
    }
}

/// What is told of the past: who said what of each detection, and what was said before anything was settled.
fn compare_past(store: &Store, model: &Model) {
    let layers = read_layer(store.file()).unwrap();
    let layers =
        layers.into_iter().flat_map(|(key, said)| said.into_iter().map(move |layer| (key.scan, layer)));
    let settled = layers.flat_map(|(scan, layer)| {
        layer.settled.into_iter().map(move |(point, before)| ((scan, point), before))
    });
    assert_eq!(settled.collect::<BTreeMap<_, _>>(), model.settled());
    let concerns = |done: &Done, (scan, point): Place| {
        done.changes.contains_key(&(scan, point)) || done.mark.is_some_and(|(of, _, _)| of == scan)
    };
    for place in (0..SCANS).flat_map(|scan| (0..POINTS).map(move |point| (scan, point))) {
        let asked = [(version(place.0), BTreeSet::from([place.1]))];
        let told = store.sayings(&asked).unwrap();
        let names: Vec<&str> = told.iter().rev().map(|saying| saying.author.as_str()).collect();
        let expected = model.made.iter().filter(|done| concerns(done, place));
        assert_eq!(names, expected.map(|done| ["ada", "bob"][usize::from(done.author)]).collect::<Vec<_>>());
        let holding = model.holding.iter().filter(|(done, _)| concerns(done, place)).count();
        assert_eq!(told.iter().filter(|saying| saying.holds).count(), holding);
    }
    let thing: Vec<_> = (0..SCANS).map(|scan| (version(scan), (0..POINTS).collect())).collect();
    let told: u64 = store.sayings(&thing).unwrap().iter().map(|saying| saying.detections).sum();
    let marked = |done: &Done| if done.mark.is_some() { POINTS as usize } else { 0 };
    let said: usize = model.made.iter().map(|done| done.changes.len() + marked(done)).sum();
    assert_eq!(told, said as u64);
    compare_work(store, model);
}

/// All of it was done today, or at midnight; what holds, and still stands, is counted once for each person and day.
fn compare_work(store: &Store, model: &Model) {
    let days = store.workdays().unwrap();
    if days.iter().any(|day| day.day != days[0].day) {
        return;
    }
    let values = model.values();
    for (author, name) in ["ada", "bob"].into_iter().enumerate() {
        let own =
            || model.holding.iter().map(|(done, _)| done).filter(|done| usize::from(done.author) == author);
        let mut labelled: BTreeSet<&Place> = own()
            .flat_map(|done| {
                done.changes.iter().filter(|(_, (_, after))| after.is_some()).map(|(place, _)| place)
            })
            .collect();
        labelled.retain(|place| values.contains_key(place));
        let mut marked: BTreeSet<u32> =
            own().filter_map(|done| done.mark.and_then(|(scan, _, after)| after.map(|_| scan))).collect();
        marked.retain(|scan| model.marks.contains_key(scan));
        let day = days.iter().find(|day| day.author == name);
        let told = day.map_or((0, 0), |day| (day.detections as usize, day.scans as usize));
        assert_eq!(told, (labelled.len(), marked.len()), "{name}");
    }
    let edits: u64 = days.iter().map(|day| day.edits).sum();
    assert_eq!(edits as usize, model.edits);
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
        1 => (0..2u32, any::<bool>()).prop_map(|(scan, reviewed)| Op::Mark { scan, reviewed }),
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
