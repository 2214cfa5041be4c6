//! Labels and corrections belong to the data that they were made from, and results to the run that wrote them.

use crate::support::{Dataset, Ran, program, ralf, tree, without_timings};
use ralf::sensors::RadarScan;
use ralf_corrections::{FILE, ScanEdit, Store, Stroke, Who};
use ralf_data::{Settings, scan_content};
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

fn labelled() -> Dataset {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

/// Turns the rows of a scan of the front radar: the same detections in another order, in a file of the same size.
fn rotate(dataset: &Dataset, scan: &str, rows: usize) {
    let name = format!("radar_front/{scan}.bin");
    let mut bytes = fs::read(dataset.file(&name)).unwrap();
    bytes.rotate_left(rows * 5 * 4);
    dataset.put(&name, bytes);
}

/// Every command that joins labels to a recording.
fn readers(dataset: &Dataset) -> Vec<Vec<String>> {
    let (data, out) = (dataset.path.as_str(), dataset.out.as_str());
    let place = |name: &str| dataset.beside(name);
    let export = |format: &str| {
        ["export", data, out, "--to", format, "-o", &place(&format!("exported-{format}"))]
            .map(str::to_owned)
            .to_vec()
    };
    let formats = ["mcap", "rosbag1", "semantickitti", "pcd", "npz", "parquet"];
    let mut readers: Vec<Vec<String>> = formats.map(export).to_vec();
    readers.push(["plot", data, out, "--scan", "0", "-o", &place("scan.png")].map(str::to_owned).to_vec());
    readers.push(["plot", data, out, "--all", "-o", &place("all.png")].map(str::to_owned).to_vec());
    readers.push(["report", data, out, "-o", &place("report.html")].map(str::to_owned).to_vec());
    readers.push(["evaluate", out, "--truth", data].map(str::to_owned).to_vec());
    readers.push(
        ["evaluate", out, "--truth", data, "--agreement", &agreeing(dataset)].map(str::to_owned).to_vec(),
    );
    readers
}

/// What somebody and somebody else said of a detection: here, and in the folder that is named.
fn agreeing(dataset: &Dataset) -> String {
    let other = dataset.beside("other");
    fs::create_dir_all(&other).unwrap();
    for folder in [&dataset.out, &other] {
        let edit =
            ScanEdit { radar: "radar_front".into(), detections: 1000, points: vec![0], ..Default::default() };
        let measured =
            ralf_data::open(Path::new(&dataset.path), None).unwrap().sequences[0].radar_scan(0, 0).unwrap();
        let edit = ScanEdit { detections: measured.len() as u32, ..edit };
        let stroke = Stroke { label: Some(99), scans: vec![edit], ..Stroke::of_sequence("00") };
        Store::open(&Path::new(folder).join(FILE)).unwrap().apply(&stroke, &Who::named("ada")).unwrap();
    }
    other
}

#[track_caller]
fn ran(arguments: &[String], more: &[&str]) -> crate::support::Ran {
    crate::support::Ran::of(&crate::support::program().args(arguments).args(more).output().unwrap())
}

#[test]
fn a_recording_that_changed_is_refused_by_name_or_used_knowingly() {
    let dataset = labelled();
    rotate(&dataset, "000002", 3);
    for arguments in readers(&dataset) {
        ran(&arguments, &[]).exits(1).prints_nothing().says([
            "radar_front/000002.bin: expected what was labelled, found another content",
            "--changed-recording",
        ]);
        ran(&arguments, &["--changed-recording"]).exits(0).says(["warning: ", "radar_front/000002.bin"]);
    }
}

#[test]
fn files_that_are_gone_or_new_are_named() {
    let dataset = labelled();
    let poses = "t_ns,x,y,z,qx,qy,qz,qw\n1700000000000000000,0,0,0,0,0,0,1\n";
    fs::write(dataset.file("poses.csv"), poses).unwrap();
    let plot = readers(&dataset).remove(6);
    ran(&plot, &[]).exits(1).says(["poses.csv: expected what was labelled, found a file that wasn't there"]);
    fs::remove_file(dataset.file("poses.csv")).unwrap();
    ran(&plot, &[]).exits(0);
}

/// Copying and checking out change times and not contents.
#[test]
fn another_time_alone_is_no_change() {
    let dataset = labelled();
    let earlier = SystemTime::now() - Duration::from_secs(86_400);
    for name in ["radar_front/000002.bin", "sequence.toml"] {
        fs::File::options().write(true).open(dataset.file(name)).unwrap().set_modified(earlier).unwrap();
    }
    for arguments in readers(&dataset) {
        ran(&arguments, &[]).exits(0);
    }
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
}

/// Somebody corrects a scan, and then the recording holds the same detections in another order.
#[test]
fn corrections_are_not_applied_to_another_content() {
    let dataset = labelled();
    let recording = ralf_data::open(Path::new(&dataset.path), None).unwrap();
    let edit = |scan: u32| {
        let measured = recording.sequences[0].radar_scan(0, scan as usize).unwrap();
        let detections = measured.len() as u32;
        ScanEdit {
            radar: "radar_front".into(),
            scan,
            detections,
            content: Some(scan_content(&measured)),
            base: 0,
            points: (0..detections).collect(),
        }
    };
    let stroke = Stroke { label: Some(30), scans: vec![edit(1), edit(2)], ..Stroke::of_sequence("00") };
    Store::open(&Path::new(&dataset.out).join(FILE)).unwrap().apply(&stroke, &Who::named("ada")).unwrap();
    let other = dataset.beside("bob.sqlite");
    Store::open(Path::new(&other)).unwrap().apply(&stroke, &Who::named("bob")).unwrap();
    let labels = |path: &str, scan: u32| {
        let bytes = fs::read(format!("{path}/sequences/00/labels/{scan:06}.label")).unwrap();
        bytes.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect::<Vec<_>>()
    };
    let export = |name: &str| {
        let path = dataset.beside(name);
        let both = ["--to", "semantickitti", "--sequence", "00"];
        let ran =
            ralf(["export", &dataset.path, &dataset.out, both[0], both[1], both[2], both[3], "-o", &path]);
        (path, ran)
    };
    let (before, said) = export("before");
    let said = said.exits(0);
    assert!(!said.stderr.contains("not applied"));
    // Two folders, for there are two radars.
    assert!(labels(&before, 2).iter().all(|label| *label == 30));
    rotate(&dataset, "000002", 3);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let told = "corrections of 00/radar_front/000002 are kept and not applied";
    let (after, said) = export("after");
    said.exits(3).says([told]);
    assert!(labels(&after, 1).iter().all(|label| *label == 30));
    assert!(labels(&after, 2).iter().all(|label| *label == 1 || *label == 99));
    for asked in [
        &["evaluate", &dataset.out, "--truth", &dataset.path][..],
        &["evaluate", &dataset.out, "--truth", &dataset.path, "--agreement", &other],
        &["report", &dataset.path, &dataset.out, "-o", &dataset.beside("report.html")],
    ] {
        Ran::of(&program().args(asked).output().unwrap()).exits(3).says([told]);
    }
    // The recording as it was has them again.
    rotate(&dataset, "000002", labels(&before, 2).len() - 3);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let (again, said) = export("again");
    let said = said.exits(0);
    assert!(!said.stderr.contains("not applied"));
    assert!(
        tree(again)
            .iter()
            .filter(|(name, _)| name.contains("labels/"))
            .eq(tree(before).iter().filter(|(name, _)| name.contains("labels/")))
    );
}

/// The front radar's first scan, as an edit on a scan with this content.
fn all_of(measured: &RadarScan) -> Stroke {
    let detections = measured.len() as u32;
    let edit = ScanEdit {
        radar: "radar_front".into(),
        scan: 0,
        detections,
        content: Some(scan_content(measured)),
        base: 0,
        points: (0..detections).collect(),
    };
    Stroke { label: Some(30), scans: vec![edit], ..Stroke::of_sequence("00") }
}

/// The radar delivered the same, whatever a setting makes of its values.
#[test]
fn corrections_hold_whatever_settings_make_of_values() {
    let dataset = labelled();
    let plain = ralf_data::open(Path::new(&dataset.path), None).unwrap();
    let factor = "corrections.radar_front.doppler_factor=-1";
    let settings = Settings::from_toml("", &[factor]).unwrap();
    let altered = settings.correct(ralf_data::open(Path::new(&dataset.path), None).unwrap()).unwrap();
    let contents = [plain, altered].map(|recording| recording.sequences[0].radar_scan(0, 0).unwrap());
    assert_ne!(scan_content(&contents[0]), scan_content(&contents[1]));
    let readers = |name: &str| {
        let place = dataset.beside(name);
        let (data, out) = (dataset.path.as_str(), dataset.out.as_str());
        for asked in [
            &["export", data, out, "--to", "npz", "--sequence", "00", "-o", &place][..],
            &["evaluate", out, "--truth", data],
        ] {
            let ran = Ran::of(&program().args(asked).output().unwrap()).exits(0);
            assert!(!ran.stderr.contains("not applied"), "{asked:?}: {}", ran.stderr);
        }
    };
    // What earlier versions wrote is known by the altered values.
    for (at, (content, label)) in
        [(0, &[][..]), (0, &["--set", factor]), (1, &["--set", factor])].iter().enumerate()
    {
        let store = Path::new(&dataset.out).join(FILE);
        let _none_yet = fs::remove_file(&store);
        Store::open(&store).unwrap().apply(&all_of(&contents[*content]), &Who::named("ada")).unwrap();
        let arguments = [&["label", &dataset.path, "-o", &dataset.out][..], label].concat();
        Ran::of(&program().args(arguments).output().unwrap()).exits(0);
        readers(&format!("exported-{at}"));
    }
}

/// Flips a byte in the middle of a file, or cuts it short.
fn damage(file: &Path, cut: bool) {
    let mut bytes = fs::read(file).unwrap();
    if cut {
        bytes.truncate(8);
    } else {
        let middle = bytes.len() / 2;
        bytes[middle] ^= 0x10;
    }
    fs::write(file, bytes).unwrap();
}

#[test]
fn damaged_results_are_labelled_again_and_this_is_said() {
    let dataset = labelled();
    let whole = without_timings(&dataset.out);
    for (name, cut) in [
        ("plausibility.parquet", false),
        ("plausibility.parquet", true),
        ("radar_front/000003.label", false),
        ("radar_left/000005.label", true),
    ] {
        damage(&dataset.result(name), cut);
        ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says([
            "sequence 00 is labelled again",
            name,
            "is not as it was written",
        ]);
        assert!(without_timings(&dataset.out) == whole, "{name}");
        ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
    }
}

#[test]
fn whoever_reads_results_notices_damage() {
    let dataset = labelled();
    damage(&dataset.result("plausibility.parquet"), false);
    for arguments in readers(&dataset).into_iter().take(9) {
        ran(&arguments, &[])
            .exits(1)
            .prints_nothing()
            .says(["plausibility.parquet: content: expected what `ralf label` wrote"]);
    }
    ralf(["evaluate", &dataset.out]).exits(1).says(["plausibility.parquet: content"]);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    damage(&dataset.result("radar_front/000003.label"), false);
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path])
        .exits(1)
        .says(["000003.label: content: expected what"]);
    fs::remove_file(dataset.result("radar_front/000003.label")).unwrap();
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path])
        .exits(1)
        .says(["000003.label: content", "missing"]);
}
