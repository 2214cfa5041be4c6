//! What a model says of detections besides its plausibility, and what is another run's.

use crate::support::{Out, RADAR, SEQUENCE, Serving, label, recording};
use ralf::config::Method;
use ralf::learned::Model;
use ralf_data::Settings;
use ralf_data::result::LabelledRun;
use ralf_data::run::{LabelRun, Unwatched};
use serde_json::json;
use std::sync::Arc;

#[test]
fn the_machines_cause_is_told_beside_the_true_one_with_its_share() {
    let folder = tempfile::tempdir().unwrap();
    let (recording, out) = (recording(), folder.path().join("out"));
    let mut settings = Settings::default();
    settings.method.method = Method::Learned;
    let model = Model::shipped().unwrap();
    let run = LabelRun {
        recording: &recording,
        settings: &settings,
        out: &out,
        jobs: 1,
        evidence: false,
        checks: &[],
        model: Some(&model),
    };
    run.execute(&Unwatched).unwrap();
    let run = LabelledRun::open(&out).unwrap().sequence(recording.sequences[0].as_ref()).unwrap();
    let tables = run.tables.tables(0).unwrap();
    let (_, rows) = tables.iter().find(|(key, _)| &*key.radar == RADAR && key.scan == 1).unwrap();
    let words = rows.get::<Arc<str>>("cause").unwrap();

    let table = Serving::of_recording(recording, &out, "127.0.0.1", "ada").unwrap().table(1);
    let names = table.header["machine_causes"].as_array().unwrap();
    let told: Vec<&str> = table
        .u8("machine_cause")
        .iter()
        .map(|number| names[usize::from(*number)].as_str().unwrap())
        .collect();
    assert!(told.iter().any(|name| !name.is_empty()));
    assert_eq!(told, words.iter().map(|word| &**word).collect::<Vec<_>>());
    let shares = table.f32("cause_probability");
    assert!(told.iter().zip(&shares).all(|(name, share)| name.is_empty() == share.is_nan()));
    assert!(table.names().contains(&"cause"), "the recording's truth has a column of its own");
    let columns = table.header["columns"].as_array().unwrap();
    let novelty = columns.iter().find(|column| column["name"] == "novelty").unwrap();
    assert_eq!(novelty["unit"], json!(""), "a share has no unit");
}

#[test]
fn everything_that_is_of_the_labels_tells_the_run_and_another_one_once_they_are_made_again() {
    let out = Out::new();
    let server = out.serve();
    let runs = || {
        let moment = server.of_sequence("moment?t_ns=0&radars=all").json();
        let doubtful = server.of_sequence("things/doubtful").json();
        let tables = [server.of_sequence("things").table().header, server.table(1).header];
        let told = [&moment, &doubtful, &tables[0], &tables[1]].map(|answer| answer["run"].clone());
        assert!(told.iter().all(|run| run.is_string() && *run == told[0]), "{SEQUENCE}: {told:?}");
        told[0].clone()
    };
    let first = runs();
    assert_eq!(runs(), first);
    label(&recording(), out.path(), &Settings::from_toml("", &["fusion.threshold=0.7"]).unwrap());
    assert_ne!(runs(), first);
}
