//! Labels of another build are made again, so the program's identity has to hold every crate that decides labels.
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The workspace's crates that no label depends on: what people say, the simulator and the tuner.
const NOT_DECIDING: [&str; 3] = ["ralf-corrections", "ralf-sim", "ralf-train"];

/// The folder of a package.
fn folder(package: &str) -> &str {
    if package == "ralf-radar" { "ralf" } else { package }
}

/// The workspace's packages that each package of the workspace depends on, as the lock file tells.
fn dependencies() -> BTreeMap<String, Vec<String>> {
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.lock");
    let lock: toml::Table = fs::read_to_string(lock).unwrap().parse().unwrap();
    let ours = |name: &&toml::Value| name.as_str().unwrap().starts_with("ralf");
    let packages = lock["package"].as_array().unwrap().iter().filter(|package| ours(&&package["name"]));
    let named = packages.map(|package| {
        let needed = package.get("dependencies").and_then(toml::Value::as_array).into_iter().flatten();
        let needed = needed.filter(ours).map(|name| folder(name.as_str().unwrap()).to_owned());
        (folder(package["name"].as_str().unwrap()).to_owned(), needed.collect())
    });
    named.collect()
}

#[test]
fn every_crate_that_labelling_depends_on_counts_for_the_identity() {
    let dependencies = dependencies();
    let (mut expected, mut open) = (BTreeSet::new(), vec!["ralf-data".to_owned()]);
    while let Some(package) = open.pop() {
        for next in &dependencies[&package] {
            if !NOT_DECIDING.contains(&next.as_str()) && expected.insert(next.clone()) {
                open.push(next.clone());
            }
        }
    }
    let found: BTreeSet<String> = env!("RALF_SOURCE_CRATES").split(' ').map(str::to_owned).collect();
    assert_eq!(found, expected);
    assert!(["ralf", "ralf-files", "ralf-ros"].iter().all(|name| found.contains(*name)));
}
