//! Whether the store tells what the model tells.

use super::model::{Done, Model, Place, SCANS, Values};
use super::{POINTS, SEQUENCE, version, who};
use ralf_corrections::{Store, read_layer};
use std::collections::{BTreeMap, BTreeSet};

pub(super) fn compare(store: &Store, model: &Model) {
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
        let steps = model.steps(author).len();
        assert_eq!(history.undo_depth as usize, steps);
        assert_eq!((history.undo.is_some(), history.redo.is_some()), (steps > 0, undone > 0));
    }
}

/// What is told of the past: who said what of each detection, and what was said before anything was settled.
pub(super) fn compare_past(store: &Store, model: &Model) {
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
