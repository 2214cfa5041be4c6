//! Classes from the segmentations of images.
use ralf::label::truth_of;
use ralf::sensors::{ClassImage, Source};
use ralf_data::result::{LabelledRun, Table};
use ralf_data::run::{LabelRun, RunRecord, Unwatched};
use ralf_data::views::{Estimate, SegmentationStore};
use ralf_data::{Recording, Settings, open, write_sequence};
use ralf_sim::SimulatedSequence;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const SCANS: usize = 3;

fn made() -> SimulatedSequence {
    ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(4, SCANS).unwrap()
}

/// A recording in files, and a folder for results beside it.
struct Written {
    folder: tempfile::TempDir,
}

impl Written {
    fn of(sequence: &SimulatedSequence) -> Self {
        let folder = tempfile::tempdir().unwrap();
        write_sequence(sequence, &folder.path().join("recording"), &|_| ()).unwrap();
        Self { folder }
    }

    fn recording(&self) -> Recording {
        open(&self.folder.path().join("recording"), None).unwrap()
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join("recording/sequences/tiny").join(name)
    }

    fn label(&self, recording: &Recording, out: &str) -> (RunRecord, Vec<Table>) {
        let out = self.folder.path().join(out);
        let settings = Settings::from_toml("", &[]).unwrap();
        let run = LabelRun {
            recording,
            settings: &settings,
            out: &out,
            jobs: 2,
            evidence: false,
            checks: &[],
            model: None,
        };
        let record = run.execute(&Unwatched).unwrap().record;
        let sequence = LabelledRun::open(&out).unwrap().sequence(recording.sequences[0].as_ref()).unwrap();
        // So few rows make one row group.
        let tables = sequence.tables.tables(0).unwrap().into_iter().map(|(_, table)| table).collect();
        (record, tables)
    }
}

/// Label, class, and what tells the class of all detections.
fn told(tables: &[Table]) -> Vec<(bool, Option<u16>, Arc<str>)> {
    let of_scan = |table: &Table| {
        let labels = table.get::<u8>("label").unwrap().to_vec();
        let classes = table.get::<Option<u16>>("semantic").unwrap().to_vec();
        let from = table.get::<Arc<str>>("class_from").unwrap().to_vec();
        labels.into_iter().zip(classes).zip(from).map(|((label, class), from)| (label == 1, class, from))
    };
    tables.iter().flat_map(|table| of_scan(table).collect::<Vec<_>>()).collect()
}

#[test]
fn true_segmentations_give_plausible_detections_nearly_their_true_classes() {
    let sequence = made().with_segmentation();
    let written = Written::of(&sequence);
    let recording = written.recording();
    assert_eq!(recording.sequences[0].classes(1, 0).unwrap(), sequence.classes(1, 0).unwrap());
    let (_, tables) = written.label(&recording, "out");
    let told = told(&tables);
    let radars = 0..sequence.sequence().rig.radars.len();
    let truth = radars.flat_map(|radar| (0..SCANS).flat_map(move |scan| [(radar, scan)]));
    let truth: Vec<u16> = truth
        .flat_map(|(radar, scan)| sequence.truth(radar, scan).unwrap())
        .map(|truth| truth.class)
        .collect();
    assert_eq!(told.len(), truth.len());
    let (mut plausible, mut with_class, mut right) = (0, 0, 0);
    for ((is_plausible, class, from), truth) in told.iter().zip(truth) {
        assert_eq!(class.is_some(), &**from == "camera");
        assert!(class.is_none() || *is_plausible, "only what is plausible has a class");
        assert!(class.is_none_or(|class| truth_of(class) == Some(true)), "{class:?}");
        if *is_plausible && truth_of(truth) == Some(true) {
            plausible += 1;
            with_class += usize::from(class.is_some());
            right += usize::from(*class == Some(truth));
        }
    }
    assert!(plausible > 300, "{plausible}");
    // One of the four cameras is dark, and says nothing.
    assert!(100 * with_class > 80 * plausible, "{with_class} of {plausible} have a class");
    assert!(100 * right > 95 * with_class, "{right} of {with_class} have the right one");
}

#[test]
fn without_segmentations_nothing_changes() {
    let (with, without) = (Written::of(&made().with_segmentation()), Written::of(&made()));
    let (_, with) = with.label(&with.recording(), "out");
    let (_, without) = without.label(&without.recording(), "out");
    for (with, without) in with.iter().zip(&without) {
        assert!(without.get::<Arc<str>>("class_from").is_err());
        for column in without.schema().columns().iter().filter(|column| column.name != "semantic") {
            let [mine, other] = [with, without].map(|table| {
                let (_, values) = table.columns().find(|(known, _)| known.name == column.name).unwrap();
                format!("{values:?}")
            });
            assert_eq!(mine, other, "{}", column.name);
        }
        assert!(without.get::<Option<u16>>("semantic").unwrap().iter().all(Option::is_none));
    }
}

#[test]
fn labels_of_the_lidar_come_first() {
    let written = Written::of(&made().with_segmentation());
    let lidar = made().sequence().rig.lidars[0].name.clone();
    for scan in fs::read_dir(written.file(&lidar)).unwrap().map(|entry| entry.unwrap().path()) {
        if scan.extension().is_some_and(|extension| extension == "bin") {
            let points = fs::metadata(&scan).unwrap().len() as usize / 16;
            fs::write(scan.with_extension("label"), 50_u32.to_le_bytes().repeat(points)).unwrap();
        }
    }
    let (_, tables) = written.label(&written.recording(), "out");
    let told = told(&tables);
    assert!(told.iter().any(|(plausible, ..)| *plausible));
    for (_, class, from) in told.iter().filter(|(plausible, ..)| *plausible) {
        assert_eq!((*class, &**from), (Some(50), "lidar"));
    }
}

#[test]
fn a_segmentation_that_cannot_be_read_is_named_and_left_out() {
    let written = Written::of(&made().with_segmentation());
    let file = written.file("camera_front/segmentation/000000.png");
    let whole = fs::read(&file).unwrap();
    fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    let (record, tables) = written.label(&written.recording(), "out");
    let named: Vec<_> = record.unreadable().collect();
    let reason = &named.first().unwrap().1.reason;
    assert_eq!((named[0].1.sensor.as_str(), named[0].1.scan), ("camera_front", 0));
    assert!(reason.contains("segmentation/000000.png: content: expected a whole PNG image"), "{reason}");
    assert!(told(&tables).iter().any(|(_, class, _)| class.is_some()), "the other cameras go on");
}

#[test]
fn a_store_beside_the_recording_is_filled_once_and_attached() {
    let written = Written::of(&made());
    let folder: &Path = &written.folder.path().join("classes");
    let store = SegmentationStore::create(folder, "a").unwrap();
    let images = [(0, 0), (0, 1)];
    let all_cars = |view: &ralf::sensors::CameraImage, _: f64| {
        Ok(ClassImage { width: view.width, height: view.height, ids: vec![10; view.width * view.height] })
    };
    let compute = |estimate: &Estimate<ClassImage>, images: &[(usize, usize)]| {
        let recording = written.recording();
        store.compute(recording.sequences[0].as_ref(), images, estimate, 2, &|| ()).unwrap()
    };
    assert!(compute(&all_cars, &images).without.is_empty());
    let none = |_: &ralf::sensors::CameraImage, _: f64| Err("asked again".to_owned());
    assert!(compute(&none, &images).without.is_empty(), "what is stored is kept");
    let failed = compute(&none, &[(1, 0)]).without;
    assert!(failed[0].to_string().contains("asked again"), "{}", failed[0]);
    // Another image, and another view of it: what was stored is made again, once.
    let [first, second] = ["0", "1"].map(|number| written.file(&format!("camera_front/00000{number}.png")));
    fs::copy(&second, &first).unwrap();
    assert_eq!(compute(&all_cars, &images).again, 1);
    let rig = written.file("sequence.toml");
    let changed = fs::read_to_string(&rig).unwrap().replace("yaw_deg = 0.0", "yaw_deg = 1.0");
    assert_ne!(changed, fs::read_to_string(&rig).unwrap());
    fs::write(&rig, changed).unwrap();
    assert_eq!(compute(&all_cars, &images).again, 2);
    assert_eq!(compute(&none, &images).again, 0);
    // Of what a store holds without a note nobody knows what it was made of.
    fs::remove_file(folder.join("sequences/tiny/camera_front/segmentation/000000.from")).unwrap();
    assert_eq!(compute(&all_cars, &images).again, 1);
    let attached = SegmentationStore::open(folder).unwrap().attach(written.recording());
    let reader = attached.sequences[0].as_ref();
    assert!(reader.has_segmentation() && reader.has_depth(0));
    assert!(reader.inputs().iter().any(|file| file.ends_with("camera_front/segmentation/000001.png")));
    assert!(reader.classes(0, 1).unwrap().unwrap()[0].ids.iter().all(|id| *id == 10));
    assert!(reader.classes(1, 0).unwrap().is_none() && reader.depth(1, 0).unwrap().is_some());
    let (_, tables) = written.label(&attached, "out");
    let cars = told(&tables).into_iter().filter(|(_, class, _)| *class == Some(10)).count();
    assert!(cars > 0 && told(&tables).iter().all(|(_, class, _)| class.is_none_or(|class| class == 10)));
}

/// Beside the images what is stored has the numbers of their files, which needn't be their places.
#[test]
fn what_is_stored_beside_images_belongs_to_the_image_of_the_same_number() {
    let written = Written::of(&made());
    let ids = [10_u8, 30];
    assert_eq!(written.recording().sequences[0].sequence().times.cameras[0].len(), ids.len());
    for number in (0..ids.len()).rev() {
        let [from, to] = [number, number + 1].map(|n| written.file(&format!("camera_front/{n:06}.png")));
        fs::rename(from, to).unwrap();
    }
    let beside = written.folder.path().join("recording");
    let elsewhere = written.folder.path().join("classes");
    for folder in [&beside, &elsewhere] {
        let store = SegmentationStore::create(folder, "a").unwrap();
        for (image, id) in ids.into_iter().enumerate() {
            let one_class = |view: &ralf::sensors::CameraImage, _: f64| {
                let (width, height) = (view.width, view.height);
                Ok(ClassImage { width, height, ids: vec![id; width * height] })
            };
            let recording = written.recording();
            let reader = recording.sequences[0].as_ref();
            let done = store.compute(reader, &[(0, image)], &one_class, 1, &|| ()).unwrap();
            assert!(done.without.is_empty(), "{done:?}");
        }
    }
    assert!(written.file("camera_front/segmentation/000002.png").exists());
    assert!(!written.file("camera_front/segmentation/000000.png").exists());
    let attached = |folder| SegmentationStore::open(folder).unwrap().attach(written.recording());
    for recording in [written.recording(), attached(&beside), attached(&elsewhere)] {
        let reader = recording.sequences[0].as_ref();
        for (image, id) in ids.into_iter().enumerate() {
            assert_eq!(reader.classes(0, image).unwrap().unwrap()[0].ids[0], id, "image {image}");
        }
    }
    let config = &Settings::from_toml("", &[]).unwrap().method;
    assert_eq!(ralf_data::views::lacking(&written.recording(), None, None, config).unwrap(), []);
}
