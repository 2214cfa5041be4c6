//! What is done with a damaged place: what the commands do. Nothing is checked but that it returns.

use ralf::config::Config;
use ralf::sensors::{CameraImage, Source};
use ralf_data::read::inspection::Inspection;
use ralf_data::read::ros::Topics;
use ralf_data::run::{LabelRun, Unwatched, read_record};
use ralf_data::views::{DepthStore, SegmentationStore};
use ralf_data::write::export::{Export, ExportFormat, ExportOptions, RosFormat, Sensors, Split, write_ros};
use ralf_data::{Balances, Comparison, Corrections, DataError, GroundTruth, Recording, Settings};
use ralf_depth::{DepthEstimator, OnnxModel};
use ralf_files::Kind;
use ralf_report::Report;
use ralf_sim::{Scenario, SimulatedSequence};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use std::path::Path;

/// Something that a command does.
pub(crate) struct Verb {
    pub(crate) name: &'static str,
    /// The folder that it is done in.
    pub(crate) place: &'static str,
    /// The part of it whose files are damaged.
    pub(crate) damaged: &'static str,
    /// Whether it changes files that are there already.
    pub(crate) writes: bool,
    pub(crate) run: fn(&Path, &mut Pcg64Mcg),
}

const fn reading(place: &'static str) -> Verb {
    Verb { name: "read", place, damaged: "", writes: false, run: read }
}

const fn of_run(name: &'static str, run: fn(&Path, &mut Pcg64Mcg)) -> Verb {
    Verb { name, place: "run", damaged: "out", writes: true, run }
}

pub(crate) const VERBS: [Verb; 27] = [
    reading("own"),
    reading("own"),
    reading("nuscenes"),
    reading("view-of-delft"),
    reading("aimotive"),
    reading("truckscenes"),
    reading("zod"),
    reading("radar-ghost"),
    reading("radarscenes"),
    reading("nvidia"),
    reading("plain.bag"),
    reading("lz4.bag"),
    reading("zstd.mcap"),
    reading("lz4.mcap"),
    reading("db3"),
    reading("db3_zstd"),
    reading("folder"),
    of_run("label-again", label_again),
    of_run("evaluate", evaluate),
    of_run("export", export),
    of_run("report", report),
    of_run("review", review),
    Verb { name: "depth-store", place: "depth", damaged: "depth", writes: false, run: depth },
    Verb { name: "class-store", place: "classes", damaged: "classes", writes: false, run: classes },
    Verb { name: "network", place: "network", damaged: "", writes: false, run: network },
    Verb { name: "settings", place: "settings", damaged: "file", writes: false, run: settings },
    Verb { name: "scenario", place: "scenario", damaged: "", writes: false, run: scenario },
];

/// Labels a recording.
pub(crate) fn label(recording: &Recording, settings: &Settings, out: &Path) -> Result<(), DataError> {
    LabelRun { recording, settings, out, jobs: 1, evidence: false, checks: &[], model: None }
        .execute(&Unwatched)
        .map(drop)
}

fn settings_of(file: &Path) -> Option<Settings> {
    let text = ralf_files::read_text(file, Kind::Settings).ok()?;
    Settings::from_toml(&text, &[]).ok()
}

fn read(place: &Path, random: &mut Pcg64Mcg) {
    let file = place.join("topics.toml");
    let topics =
        if file.exists() { settings_of(&file).map(|settings| settings.topics) } else { Some(Topics::new()) };
    let path = place.join("recording");
    if random.random_range(0..8) == 0 {
        let _ = ralf_data::read::ros::inspect(&path);
    }
    let Some(topics) = topics else { return };
    let Ok(recording) = ralf_data::open_with(&path, None, &topics) else { return };
    let config = Config::default();
    for reader in &recording.sequences {
        let mut look = Inspection::new(reader.as_ref(), &config);
        look.try_scans(reader.as_ref(), 1, &|| {});
        all_images(reader.as_ref());
    }
    let new = place.join("new");
    match random.random_range(0..4) {
        0 => drop(label(&recording, &Settings::default(), &new)),
        1 => recording.sequences.iter().for_each(|reader| {
            let _ = ralf_data::write_sequence(reader.as_ref(), &new, &|_| {});
        }),
        2 => recording.sequences.iter().for_each(|reader| {
            let _ = write_ros(reader.as_ref(), &new.join("t.mcap"), RosFormat::Mcap, &|_| {});
            let _ = write_ros(reader.as_ref(), &new.join("t.bag"), RosFormat::Bag, &|_| {});
        }),
        _ => {
            if let Ok(Some(truth)) = GroundTruth::find(&path) {
                let _ = truth.scans().iter().try_for_each(|scan| truth.labels(scan).map(drop));
            }
        }
    }
}

fn all_images(source: &dyn Source) {
    for (camera, times) in source.sequence().times.cameras.iter().enumerate() {
        for image in 0..times.len() {
            let _ = source.image(camera, image);
            let _ = source.depth(camera, image);
            let _ = source.classes(camera, image);
        }
    }
}

/// The recording of a run, its sensors as the run had them.
fn labelled(place: &Path) -> Option<Recording> {
    let settings = read_record(&place.join("out")).ok()?.settings;
    ralf_data::open_with(&place.join("recording"), None, &settings.topics).ok()
}

fn label_again(place: &Path, _: &mut Pcg64Mcg) {
    if let Some(recording) = labelled(place) {
        let _ = label(&recording, &Settings::default(), &place.join("out"));
    }
}

fn evaluate(place: &Path, _: &mut Pcg64Mcg) {
    let (out, recording) = (place.join("out"), place.join("recording"));
    let _ = Balances::of_run(&out);
    let Ok(corrections) = Corrections::open(&out) else { return };
    let Ok(truth) = GroundTruth::merged(&recording, corrections) else { return };
    let _ = Comparison::new(&out, &truth).map(|comparison| comparison.evaluation());
}

fn export(place: &Path, random: &mut Pcg64Mcg) {
    let Some(recording) = labelled(place) else { return };
    let format = ExportFormat::ALL[random.random_range(0..ExportFormat::ALL.len())];
    let options = ExportOptions { format, split: Split::All, sensors: Sensors::default(), replace: false };
    let _ =
        Export { recording: &recording, out: &place.join("out"), options }.write(&place.join("new"), &|_| {});
}

fn report(place: &Path, _: &mut Pcg64Mcg) {
    if let Some(recording) = labelled(place) {
        let out = place.join("out");
        let page = Report { recording: &recording, out: &out, scans_per_sequence: 1 }.page(&|_| {});
        let _ = page.map(|page| page.html);
    }
}

fn review(place: &Path, _: &mut Pcg64Mcg) {
    let Some(recording) = labelled(place) else { return };
    let options = ralf_review::Options {
        host: "127.0.0.1".into(),
        port: Some(0),
        author: "ada".into(),
        ..Default::default()
    };
    let _ = ralf_review::Server::bind(recording, &place.join("out"), &options);
}

fn depth(place: &Path, _: &mut Pcg64Mcg) {
    let Ok(recording) = ralf_data::open(&place.join("recording"), None) else { return };
    let Ok(store) = DepthStore::open(&place.join("depth")) else { return };
    label_views(&store.attach(recording), place);
}

fn classes(place: &Path, _: &mut Pcg64Mcg) {
    let Ok(recording) = ralf_data::open(&place.join("recording"), None) else { return };
    let Ok(store) = SegmentationStore::open(&place.join("classes")) else { return };
    label_views(&store.attach(recording), place);
}

/// Reads and labels a recording with what a store says of its images.
fn label_views(recording: &Recording, place: &Path) {
    recording.sequences.iter().for_each(|reader| all_images(reader.as_ref()));
    let _ = label(recording, &Settings::default(), &place.join("new"));
}

fn network(place: &Path, _: &mut Pcg64Mcg) {
    let Ok(model) = OnnxModel::load(&place.join("net.onnx"), None) else { return };
    let view = CameraImage { width: 24, height: 16, rgb: vec![[90, 120, 60]; 24 * 16] };
    let _ = model.estimate(&view, 20.0);
}

fn settings(place: &Path, _: &mut Pcg64Mcg) {
    let Some(settings) = settings_of(&place.join("file/ralf.toml")) else { return };
    let Ok(recording) = ralf_data::open_with(&place.join("recording"), None, &settings.topics) else {
        return;
    };
    let _ = label(&recording, &settings, &place.join("new"));
}

fn scenario(place: &Path, _: &mut Pcg64Mcg) {
    let Ok(text) = ralf_files::read_text(&place.join("scenario.toml"), Kind::Settings) else { return };
    let Ok(scenario) = Scenario::from_toml(&text) else { return };
    let Ok(sequence) = SimulatedSequence::new("00", &scenario, 0, 1) else { return };
    let _ = sequence.radar_scan(0, 0);
}
