//! Simulated sequences in files.
use ralf::sensors::Source;
use ralf_data::{GroundTruth, Label, open, write_sequence};
use ralf_sim::{SimulatedSequence, presets};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn tiny(seed: u64) -> SimulatedSequence {
    presets::find("tiny").unwrap().sequences[0].simulate(seed, 2).unwrap()
}

/// All files below a folder.
fn files(folder: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>, root: &Path) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found, root);
        } else {
            found.insert(path.strip_prefix(root).unwrap().to_owned(), fs::read(&path).unwrap());
        }
    }
}

fn written(seed: u64) -> (tempfile::TempDir, BTreeMap<PathBuf, Vec<u8>>) {
    let folder = tempfile::tempdir().unwrap();
    write_sequence(&tiny(seed), folder.path(), &|_| ()).unwrap();
    let mut found = BTreeMap::new();
    files(folder.path(), &mut found, folder.path());
    (folder, found)
}

#[test]
fn a_written_sequence_is_read_as_it_was_made_and_again_the_same() {
    let (folder, first) = written(1);
    let (_other, second) = written(1);
    assert!(first == second, "the same seed gave other bytes");
    let recording = open(folder.path(), None).unwrap();
    let [reader] = &recording.sequences[..] else { panic!("one sequence") };
    assert!(reader.warnings().is_empty(), "{:?}", reader.warnings());
    let made = tiny(1);
    assert_eq!(reader.sequence().times, made.sequence().times);
    assert_eq!(reader.radar_scan(1, 1).unwrap().columns, made.radar_scan(1, 1).unwrap().columns);
    assert_eq!(reader.image(2, 0).unwrap(), made.image(2, 0).unwrap());
    assert_eq!(reader.depth(2, 0).unwrap(), made.depth(2, 0).unwrap());
    let truth = GroundTruth::open(folder.path()).unwrap();
    assert_eq!(truth.scans().len(), 8);
    for scan in truth.scans() {
        let radar = reader.sequence().rig.radars.iter().position(|radar| radar.name == scan.radar).unwrap();
        let expected = made.truth(radar, scan.scan as usize).unwrap();
        let labels: Vec<Label> = expected.iter().map(|truth| Label::of_class(truth.class)).collect();
        assert_eq!(truth.labels(scan).unwrap(), labels);
        let causes = fs::read(scan.truth_file(folder.path()).with_extension("cause")).unwrap();
        assert_eq!(causes, expected.iter().map(|truth| truth.cause as u8).collect::<Vec<_>>());
    }
}
