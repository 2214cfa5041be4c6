//! Evidence is asked for, and follows into every table by itself.

use crate::support::{Dataset, Ran, program, ralf, schema, tree};
use ralf::evidence::features;
use std::fs;

#[test]
fn evidence_comes_after_the_other_columns_and_changes_none_of_them() {
    let dataset = Dataset::new();
    let plain = dataset.beside("plain");
    ralf(["label", &dataset.path, "-o", &plain]).exits(0);
    ralf(["label", &dataset.path, "-o", &dataset.out, "--evidence"]).exits(0);
    let columns = |out: &str| schema(format!("{out}/sequences/00/plausibility.parquet"));
    let (without, with) = (columns(&plain), columns(&dataset.out));
    assert_eq!(with[..without.len()], without[..]);
    assert_eq!(with.len(), without.len() + features().count());
    for (column, feature) in with[without.len()..].iter().zip(features()) {
        assert!(format!("{column:?}").contains(feature.name), "{column:?}");
    }
    let labels =
        |out: &str| tree(out).into_iter().filter(|(name, _)| name.ends_with(".label")).collect::<Vec<_>>();
    assert!(labels(&plain) == labels(&dataset.out));
    // Asked for again, there is nothing to do; without it, it goes.
    ralf(["label", &dataset.path, "-o", &dataset.out, "--evidence"]).exits(0).says(["nothing to do"]);
    ralf(["export", &dataset.path, &dataset.out, "--to", "npz", "-o", &dataset.beside("npz")]).exits(0);
    ralf(["export", &dataset.path, &dataset.out, "--to", "pcd", "-o", &dataset.beside("pcd")]).exits(0);
    let archive = fs::read(dataset.beside("npz/sequences/00/radar_front/000000.npz")).unwrap();
    let cloud = fs::read(dataset.beside("pcd/sequences/00/radar_front/000000.pcd")).unwrap();
    for feature in features() {
        let holds =
            |bytes: &[u8]| bytes.windows(feature.name.len()).any(|found| found == feature.name.as_bytes());
        assert!(holds(&archive) && holds(&cloud), "{}", feature.name);
    }
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    assert_eq!(columns(&dataset.out), without);
}

#[test]
fn detections_are_drawn_in_the_colours_of_a_column() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--evidence"]).exits(0);
    let picture = |name: &str, more: &[&str]| {
        let path = dataset.beside(name);
        let common = ["plot", &dataset.path, &dataset.out, "--sequence", "00", "--scan", "0", "-o", &path];
        (Ran::of(&program().args(common).args(more).output().unwrap()), path)
    };
    let mut drawn = std::collections::BTreeSet::new();
    for (name, more) in [
        ("labels.png", &[][..]),
        ("w.png", &["--color-by", "w"]),
        ("distance.png", &["--color-by", "map_distance"]),
    ] {
        let (done, path) = picture(name, more);
        done.exits(0);
        assert!(drawn.insert(fs::read(path).unwrap()), "{name} is like another");
    }
    picture("none.png", &["--color-by", "no_such_column"]).0.exits(1).says(["no_such_column"]);
    picture("text.png", &["--color-by", "label"]).0.exits(1).says(["label"]);
}
