//! Truth that is made of corrections alone, of a scan that nobody is through with: mostly its errors, so that figures
//! of it say little of the labels.

use super::corrections::Corrections;
use super::ground_truth::GroundTruth;

/// How many scans of a truth are known by corrections of some of their detections alone: no file tells of them, and
/// nobody has marked them as reviewed.
pub fn partly_corrected(truth: &GroundTruth, corrections: &Corrections) -> usize {
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
    use crate::testing::write;
    use crate::truth::ScanId;
    use ralf_corrections::{FILE, Mark, ScanEdit, Store, Stroke, Who};

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
        let found = || {
            let truth = GroundTruth::merged(dataset.path(), corrections.clone()).unwrap();
            partly_corrected(&truth, &corrections)
        };
        assert_eq!(found(), 1);
        write(&dataset.path().join("sequences/00/ground_truth/front/000000.label"), &[0; 8]);
        assert_eq!(found(), 0);
        assert!(told_partly_corrected(0).is_none());
        assert!(told_partly_corrected(2).unwrap().starts_with("of 2 scans the truth is but"));
    }
}
