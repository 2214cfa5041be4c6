//! Truth that is made of corrections alone, of a scan that nobody is through with: mostly its errors, so that figures
//! of it say little of the labels.

use super::ground_truth::GroundTruth;

/// How many scans of a truth are known by corrections of some of their detections alone: no file tells of them, and
/// nobody has marked as reviewed what they hold now.
pub fn partly_corrected(truth: &GroundTruth) -> usize {
    let Some(corrections) = truth.corrections() else { return 0 };
    let has_no_file = |scan: &_| truth.file(scan) == corrections.file();
    let known = truth.scans().iter().filter(|scan| has_no_file(scan));
    known.filter(|scan| corrections.is_partial(scan)).count()
}

/// The sentence about so many such scans; none of none.
pub fn told_partly_corrected(scans: usize) -> Option<String> {
    let who = match scans {
        0 => return None,
        1 => "of 1 scan the truth is".to_owned(),
        _ => format!("of {scans} scans the truth is"),
    };
    Some(format!(
        "{who} but what people corrected there, mostly errors, for nobody has marked them as reviewed: figures that \
         count them say little of the labels, and settings tuned by them repeat errors"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::DataError;
    use crate::testing::write;
    use crate::truth::{Corrections, ScanId};
    use ralf_corrections::{ContentHash, FILE, Mark, ScanContent, ScanEdit, Store, Stroke, Who};

    /// Three scans: one with some corrections, one with all, one that was reviewed besides.
    #[test]
    fn scans_that_nobody_is_through_with_are_counted_where_no_file_tells_of_them() {
        let [out, dataset] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let mut store = Store::open(&out.path().join(FILE)).unwrap();
        for (scan, points) in [(0, vec![1]), (1, vec![0, 1]), (2, vec![1])] {
            let radar = "front".to_owned();
            let edit = ScanEdit { radar, scan, detections: 2, content: None, base: 0, points };
            let stroke = Stroke { label: Some(10), scans: vec![edit], ..Stroke::of_sequence("00") };
            store.apply(&stroke, &Who::named("ada")).unwrap();
        }
        let key = (&ScanId { sequence: "00".into(), radar: "front".into(), scan: 2 }).into();
        let mark = Mark { key, content: None, base: 1, machine: vec![1, 99], reviewed: true };
        store.mark(&mark, &Who::named("ada")).unwrap();
        let corrections = Corrections::open(out.path()).unwrap();
        let found = || partly_corrected(&GroundTruth::merged(dataset.path(), corrections.clone()).unwrap());
        assert_eq!(found(), 1);
        write(&dataset.path().join("sequences/00/ground_truth/front/000000.label"), &[0; 8]);
        assert_eq!(found(), 0);
        assert!(told_partly_corrected(0).is_none());
        assert!(told_partly_corrected(2).unwrap().starts_with("of 2 scans the truth is but"));
    }

    /// Somebody was through with what the scan held before.
    #[test]
    fn a_mark_of_what_a_scan_held_before_is_none_of_what_it_holds() {
        let [out, dataset] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let mut store = Store::open(&out.path().join(FILE)).unwrap();
        let (id, who) = (ScanId { sequence: "00".into(), radar: "front".into(), scan: 0 }, Who::named("ada"));
        let [before, now] = [1, 2].map(|byte| Some(ContentHash::new([byte; 32])));
        let key = (&id).into();
        let mark = Mark { key, content: before, base: 0, machine: vec![1, 99], reviewed: true };
        store.mark(&mark, &who).unwrap();
        let (radar, points) = ("front".to_owned(), vec![1]);
        let edit = ScanEdit { radar, scan: 0, detections: 2, content: now, base: 0, points };
        let stroke = Stroke { label: Some(10), scans: vec![edit], ..Stroke::of_sequence("00") };
        store.apply(&stroke, &who).unwrap();
        let holds = ScanContent { detections: 2, hash: now };
        let bound =
            Corrections::open(out.path()).unwrap().bound(|_| Ok::<_, DataError>(Some(holds))).unwrap();
        assert_eq!(partly_corrected(&GroundTruth::merged(dataset.path(), bound).unwrap()), 1);
    }
}
