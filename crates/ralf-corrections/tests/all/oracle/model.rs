//! The strokes that hold in a list, in the order in which they were set: corrections are found by going through it from
//! the start. The store never does so.

use std::collections::{BTreeMap, BTreeSet};

pub(super) const SCANS: u32 = 5;

pub(super) type Place = (u32, u32);

pub(super) type Values = BTreeMap<Place, u16>;

/// What a stroke says, and of which detections.
#[derive(Debug, Clone, Copy)]
pub(super) struct How {
    pub(super) label: Option<u16>,
    pub(super) protect: bool,
    /// It says again what was said already, as the answer about a kind does.
    pub(super) confirms: bool,
    /// It settles a disagreement, and says again what was said already.
    pub(super) settles: bool,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Done {
    pub(super) author: u8,
    pub(super) group: Option<u8>,
    pub(super) settles: bool,
    /// Correction before and after.
    pub(super) changes: BTreeMap<Place, (Option<u16>, Option<u16>)>,
    /// A scan's mark before and after, each by the number of the edit that made it.
    pub(super) mark: Option<(u32, Option<usize>, Option<usize>)>,
}

impl Done {
    fn changed(&self) -> usize {
        self.changes.len() + usize::from(self.mark.is_some())
    }
}

/// A step that was taken back, and how many edits there had been by then.
pub(super) type Undone = (Vec<Done>, usize);

#[derive(Debug, Default)]
pub(super) struct Model {
    /// Strokes that hold, with the number of the edit that set them.
    pub(super) holding: Vec<(Done, usize)>,
    pub(super) undone: BTreeMap<u8, Vec<Undone>>,
    pub(super) marks: BTreeMap<u32, usize>,
    /// All that was ever done, whether it holds or not.
    pub(super) made: Vec<Done>,
    pub(super) revisions: [u64; SCANS as usize],
    pub(super) edits: usize,
}

impl Model {
    pub(super) fn values(&self) -> Values {
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
    pub(super) fn stroke(
        &mut self,
        author: u8,
        points: &BTreeSet<Place>,
        how: How,
        group: Option<u8>,
    ) -> usize {
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
    pub(super) fn mark(&mut self, author: u8, scan: u32, reviewed: bool) -> usize {
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
    pub(super) fn settled(&self) -> BTreeMap<Place, Option<u16>> {
        let mut first = BTreeMap::new();
        for (stroke, _) in self.holding.iter().filter(|(stroke, _)| stroke.settles) {
            for (place, (before, _)) in &stroke.changes {
                first.entry(*place).or_insert(*before);
            }
        }
        first
    }

    /// The places of an author's strokes among those that hold, by steps, the last one first: those of a group belong
    /// together, whatever lies between them, but for what that was done upon.
    pub(super) fn steps(&self, author: u8) -> Vec<Vec<usize>> {
        let all = 0..self.holding.len();
        let mut left: Vec<usize> = all.rev().filter(|at| self.holding[*at].0.author == author).collect();
        let done = |at: usize| &self.holding[at].0;
        let mut steps = Vec::new();
        while !left.is_empty() {
            let mut step = vec![left.remove(0)];
            let mut between = 0;
            while let Some(group) = done(step[0]).group.filter(|_| between < left.len()) {
                if done(left[between]).group != Some(group) {
                    between += 1;
                } else if left[..between].iter().any(|at| shares(done(*at), done(left[between]))) {
                    break;
                } else {
                    step.push(left.remove(between));
                }
            }
            steps.push(step);
        }
        steps
    }

    /// How many corrections changed; `None` is a conflict.
    pub(super) fn undo(&mut self, author: u8) -> Option<usize> {
        let mut rest = self.holding.clone();
        let mut step: Vec<Done> = Vec::new();
        for at in self.steps(author).into_iter().next().unwrap_or_default() {
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
    pub(super) fn redo(&mut self, author: u8) -> Option<usize> {
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

/// Whether two strokes are of different people and share a detection, or the mark of a scan.
fn meets(a: &Done, b: &Done) -> bool {
    a.author != b.author && shares(a, b)
}

/// Whether two strokes share a detection, or the mark of a scan.
fn shares(a: &Done, b: &Done) -> bool {
    let marked = |done: &Done| done.mark.map(|(scan, _, _)| scan);
    let shared = a.changes.keys().any(|place| b.changes.contains_key(place));
    shared || marked(a).is_some_and(|scan| marked(b) == Some(scan))
}

fn set(values: &mut Values, stroke: &Done, to: impl Fn(&(Option<u16>, Option<u16>)) -> Option<u16>) {
    for (place, change) in &stroke.changes {
        match to(change) {
            Some(label) => values.insert(*place, label),
            None => values.remove(place),
        };
    }
}
