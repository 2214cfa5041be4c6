//! How far two people agree who labelled the same detections, neither of whom saw what the other said.

use crate::error::DataError;
use crate::truth::{Corrections, ScanId};
use ralf::label::truth_of;
use ralf::metrics::Confusion;
use std::collections::{BTreeMap, BTreeSet};

/// What two people said, in counts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Agreement {
    /// Every scan of which both said something of the same detections, in order; what the first said counts as truth.
    pub scans: Vec<(ScanId, Confusion)>,
    /// How many detections the first and the second gave these labels (SemanticKITTI ids).
    pub pairs: BTreeMap<(u16, u16), u64>,
    /// Of detections of which both said why they are artifacts: how many the first and the second gave these causes.
    pub causes: BTreeMap<(String, String), u64>,
}

/// A detection of which two people said different labels, or different causes where both said one, and which nobody
/// has settled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// The scan.
    pub scan: ScanId,
    /// The detection's place in it.
    pub point: usize,
    /// What the first said, a SemanticKITTI id.
    pub first: u16,
    /// What the second said.
    pub second: u16,
    /// Why the first calls it an artifact, where that was said.
    pub first_cause: Option<String>,
    /// Why the second does.
    pub second_cause: Option<String>,
}

impl Agreement {
    /// Of two people's corrections, each [bound](Corrections::bound) to what the recording holds. What somebody
    /// corrected or accepted counts, before anything was settled, and nothing that the machine alone says.
    ///
    /// # Errors
    /// Corrections of several contents of a scan, of which nothing says which is meant.
    pub fn of(first: &Corrections, second: &Corrections) -> Result<Self, DataError> {
        Ok(compare(first, second)?.0)
    }

    /// Counts what both said of a detection: the labels, and whether these are plausible.
    fn count(&mut self, scan: &ScanId, labels: (u16, u16), (one, other): (bool, bool)) {
        *self.pairs.entry(labels).or_default() += 1;
        if self.scans.last().is_none_or(|(known, _)| known != scan) {
            self.scans.push((scan.clone(), Confusion::default()));
        }
        if let Some((_, counts)) = self.scans.last_mut() {
            counts.add(one, other);
        }
    }

    /// Over all scans of each sequence.
    pub fn sequences(&self) -> BTreeMap<&str, Confusion> {
        self.by(|scan| &scan.sequence)
    }

    /// Over all scans of each radar.
    pub fn radars(&self) -> BTreeMap<&str, Confusion> {
        self.by(|scan| &scan.radar)
    }

    fn by<'a>(&'a self, name: impl Fn(&'a ScanId) -> &'a str) -> BTreeMap<&'a str, Confusion> {
        let mut found: BTreeMap<&str, Confusion> = BTreeMap::new();
        for (scan, counts) in &self.scans {
            *found.entry(name(scan)).or_default() += *counts;
        }
        found
    }

    /// For each label (SemanticKITTI id) that one of them gave: it against all others, as if these were one.
    pub fn classes(&self) -> BTreeMap<u16, Confusion> {
        against_others(&self.pairs)
    }

    /// For each cause that one of them gave where both gave one: it against all others.
    pub fn each_cause(&self) -> BTreeMap<String, Confusion> {
        against_others(&self.causes)
    }

    /// Over all scans.
    pub fn overall(&self) -> Confusion {
        self.scans.iter().map(|(_, counts)| *counts).sum()
    }

    /// The scans in which they disagree, the most disagreements first.
    pub fn disagreements(&self) -> Vec<&(ScanId, Confusion)> {
        let mut scans: Vec<&(ScanId, Confusion)> =
            self.scans.iter().filter(|(_, counts)| disagreements(counts) > 0).collect();
        scans.sort_by_key(|(_, counts)| std::cmp::Reverse(disagreements(counts)));
        scans
    }
}

/// Each of what two people said against all else, as if that were one.
fn against_others<T: Ord + Clone>(pairs: &BTreeMap<(T, T), u64>) -> BTreeMap<T, Confusion> {
    let names: BTreeSet<&T> = pairs.keys().flat_map(|(first, second)| [first, second]).collect();
    let of_one = |name: &T| {
        let counts = |is: (bool, bool)| {
            let same = |said: &(T, T)| (said.0 == *name, said.1 == *name) == is;
            pairs.iter().filter(|(said, _)| same(said)).map(|(_, count)| count).sum()
        };
        let [tp, r#fn] = [counts((true, true)), counts((true, false))];
        let [fp, tn] = [counts((false, true)), counts((false, false))];
        (name.clone(), Confusion { tp, fp, tn, r#fn })
    };
    names.into_iter().map(of_one).collect()
}

/// How far two people agree, as [`Agreement::of`] has it, and the detections to which they gave different labels, or of
/// which both said a cause and not the same, but for those that somebody has settled in the first's store, in the order
/// of scans and detections.
///
/// # Errors
/// Those of [`Agreement::of`].
pub fn compare(first: &Corrections, second: &Corrections) -> Result<(Agreement, Vec<Difference>), DataError> {
    let (mut agreement, mut differences) = (Agreement::default(), Vec::new());
    for scan in first.scans_ever() {
        let (Some(ones), Some(others)) = (first.unsettled(scan)?, second.unsettled(scan)?) else { continue };
        for (point, (one, other)) in ones.labels.iter().zip(&others.labels).enumerate() {
            let (Some(a), Some(b)) = (truth_of(one.id), truth_of(other.id)) else { continue };
            agreement.count(scan, (one.id, other.id), (a, b));
            let Ok(number) = u32::try_from(point) else { continue };
            let causes = [&ones, &others].map(|said| said.causes.get(&number));
            if let [Some(one), Some(other)] = causes {
                *agreement.causes.entry((one.clone(), other.clone())).or_default() += 1;
            }
            let other_cause = matches!(causes, [Some(one), Some(other)] if one != other);
            if (one.id != other.id || other_cause) && !ones.settled.contains(&number) {
                let [first_cause, second_cause] = causes.map(Option::<&String>::cloned);
                let (first, second, scan) = (one.id, other.id, scan.clone());
                differences.push(Difference { scan, point, first, second, first_cause, second_cause });
            }
        }
    }
    Ok((agreement, differences))
}

/// Whether only one of two labels (SemanticKITTI ids) says plausible.
pub fn is_about_plausibility(first: u16, second: u16) -> bool {
    truth_of(first) != truth_of(second)
}

/// How many detections one calls plausible and the other doesn't.
pub fn disagreements(counts: &Confusion) -> u64 {
    counts.fp + counts.r#fn
}

/// Cohen's kappa (1960): how much oftener they agree than they would by chance, 1 where always. `None` where chance
/// alone would have them always agree, and of nothing.
///
/// `(p_o - p_e) / (1 - p_e)`, with the share of agreement and what the shares of plausible ones of each lead to.
pub fn kappa(counts: &Confusion) -> Option<f64> {
    let share = |count: u64| count as f64 / counts.total() as f64;
    let agreed = share(counts.tp + counts.tn);
    let (first, second) = (share(counts.tp + counts.r#fn), share(counts.tp + counts.fp));
    beyond_chance(agreed, first * second + (1.0 - first) * (1.0 - second))
}

/// The share of agreement beyond what chance alone leads to.
fn beyond_chance(agreed: f64, by_chance: f64) -> Option<f64> {
    let kappa = (agreed - by_chance) / (1.0 - by_chance);
    kappa.is_finite().then_some(kappa)
}

/// Cohen's kappa of any number of names: `(p_o - p_e) / (1 - p_e)` with the share `p_o` of detections to which both
/// gave the same, and the sum `p_e` over all names of the product of the shares that each gave them. `None` as of
/// [`kappa`].
pub fn kappa_of_names<T: Ord + Clone>(pairs: &BTreeMap<(T, T), u64>) -> Option<f64> {
    let total = pairs.values().sum::<u64>() as f64;
    let each = against_others(pairs);
    let agreed = each.values().map(|counts| counts.tp as f64).sum::<f64>() / total;
    let shares = |counts: &Confusion| {
        let (first, second) = (counts.tp + counts.r#fn, counts.tp + counts.fp);
        (first as f64 / total) * (second as f64 / total)
    };
    beyond_chance(agreed, each.values().map(shares).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_corrections::{FILE, SETTLE, ScanEdit, Store, Stroke, Who};
    use std::path::Path;

    /// Somebody's corrections: by scan, detections with labels.
    fn said(out: &Path, strokes: &[(u32, u16, &[u32])]) -> Corrections {
        let mut store = Store::open(&out.join(FILE)).unwrap();
        for (scan, label, points) in strokes {
            let points = points.to_vec();
            let edit = ScanEdit {
                radar: "front".into(),
                scan: *scan,
                detections: 6,
                content: None,
                base: 0,
                points,
            };
            let stroke = Stroke { label: Some(*label), scans: vec![edit], ..Stroke::of_sequence("00") };
            store.apply(&stroke, &Who::named("ada")).unwrap();
        }
        Corrections::open(out).unwrap()
    }

    /// The textbook's: of 50 they agree on 20 and 15, where chance would have them agree on half.
    #[test]
    fn kappa_is_what_it_is_by_hand() {
        let found = kappa(&Confusion { tp: 20, r#fn: 5, fp: 10, tn: 15 }).unwrap();
        assert!((found - 0.4).abs() < 1e-12);
        assert_eq!(kappa(&Confusion { tp: 3, ..Confusion::default() }), None);
        assert_eq!(kappa(&Confusion::default()), None);
    }

    /// Of ten they agree on four and three, where chance would have them agree on 0.5 0.5 + 0.3 0.4 + 0.2 0.1 = 0.39.
    #[test]
    fn kappa_of_three_names_is_what_it_is_by_hand_and_of_two_that_of_a_table() {
        let pairs = BTreeMap::from([
            (("a", "a"), 4),
            (("a", "b"), 1),
            (("b", "b"), 3),
            (("c", "a"), 1),
            (("c", "c"), 1),
        ]);
        assert!((kappa_of_names(&pairs).unwrap() - 0.41 / 0.61).abs() < 1e-12);
        let two = BTreeMap::from([(("a", "a"), 20), (("a", "b"), 5), (("b", "a"), 10), (("b", "b"), 15)]);
        assert!((kappa_of_names(&two).unwrap() - 0.4).abs() < 1e-12);
        assert_eq!(kappa_of_names(&BTreeMap::from([(("a", "a"), 3)])), None);
        assert_eq!(kappa_of_names::<u16>(&BTreeMap::new()), None);
    }

    #[test]
    fn what_both_said_is_counted_by_hand_and_what_one_alone_said_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| folder.path().join(name));
        for out in [&one, &other] {
            std::fs::create_dir(out).unwrap();
        }
        // In scan 1 a car and a plausible one are both plausible; in scan 2 they differ twice, and nobody else saw 5.
        let ada = said(&one, &[(1, 10, &[0]), (2, 1, &[0, 1, 2]), (3, 99, &[4])]);
        let bob = said(&other, &[(1, 99, &[0, 3]), (2, 99, &[1, 2, 5])]);
        let found = Agreement::of(&ada, &bob).unwrap();
        let counts: Vec<(u32, Confusion)> =
            found.scans.iter().map(|(scan, counts)| (scan.scan, *counts)).collect();
        let (alike, unlike) =
            (Confusion { tp: 1, ..Confusion::default() }, Confusion { fp: 2, ..Confusion::default() });
        assert_eq!(counts, [(1, alike), (2, unlike)]);
        assert_eq!((found.overall().total(), found.sequences()["00"]), (3, found.overall()));
        assert_eq!(found.disagreements().iter().map(|(scan, _)| scan.scan).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn each_class_is_told_against_all_others() {
        let pairs = BTreeMap::from([((10, 10), 4), ((10, 1), 1), ((30, 10), 2), ((1, 1), 3)]);
        let found = Agreement { pairs, ..Agreement::default() }.classes();
        assert_eq!(found[&10], Confusion { tp: 4, r#fn: 1, fp: 2, tn: 3 });
        assert_eq!(found[&30], Confusion { tp: 0, r#fn: 2, fp: 0, tn: 8 });
        assert_eq!(found[&1], Confusion { tp: 3, r#fn: 0, fp: 1, tn: 6 });
    }

    /// Who settles says who is right; how far both agreed stays what it was.
    #[test]
    fn what_is_settled_is_no_difference_any_more_and_agreement_stays() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| folder.path().join(name));
        for out in [&one, &other] {
            std::fs::create_dir(out).unwrap();
        }
        let ada = said(&one, &[(1, 1, &[0, 1, 2])]);
        let bob = said(&other, &[(1, 99, &[1, 2, 3])]);
        let before = Agreement::of(&ada, &bob).unwrap();
        let points = |found: &[Difference]| found.iter().map(|one| one.point).collect::<Vec<_>>();
        assert_eq!(points(&compare(&ada, &bob).unwrap().1), [1, 2]);
        // The first is right about one of them, the second about the other.
        let mut store = Store::open(&one.join(FILE)).unwrap();
        for (base, (label, point)) in [(1, (1, 1)), (2, (99, 2))] {
            let radar = "front".to_owned();
            let edit = ScanEdit { radar, scan: 1, detections: 6, content: None, base, points: vec![point] };
            let stroke = Stroke {
                tool: SETTLE.into(),
                confirm: true,
                label: Some(label),
                ..Stroke::of_sequence("00")
            };
            store.apply(&Stroke { scans: vec![edit], ..stroke }, &Who::named("cem")).unwrap();
        }
        let settled = Corrections::open(&one.join(FILE)).unwrap();
        assert!(compare(&settled, &bob).unwrap().1.is_empty());
        assert_eq!(Agreement::of(&settled, &bob).unwrap(), before);
        let ids: Vec<u16> =
            settled.truth(&before.scans[0].0, None).unwrap().unwrap().iter().map(|l| l.id).collect();
        assert_eq!(ids, [1, 1, 99, 0, 0, 0]);
        store.undo("00", &Who::named("cem")).unwrap();
        assert_eq!(points(&compare(&Corrections::open(&one).unwrap(), &bob).unwrap().1), [2]);
    }
}
