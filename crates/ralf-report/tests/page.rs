//! The page of small recordings, labelled for the test.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use ralf_data::result::LabelledRun;
use ralf_data::run::{LabelRun, Unwatched};
use ralf_data::{Comparison, DataError, GroundTruth, Settings};
use ralf_report::Report;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One radar without LiDAR: three scans of a wall that stays, and of one detection that is somewhere else each time.
struct Tiny(tempfile::TempDir);

const TITLE: &str = "<script>alert('mine')</script> & \"more\"";

impl Tiny {
    fn new() -> Self {
        let tiny = Self(tempfile::tempdir().unwrap());
        let title = TITLE.replace('"', "\\\"");
        tiny.put(
            "sequence.toml",
            format!(
                "format = 1\nname = \"{title}\"\n[[radar]]\nname = \"front\"\nfields = [\"x\", \"y\", \"z\"]\n\
                 translation = [0.0, 0.0, 1.0]\nquaternion_xyzw = [0.0, 0.0, 0.0, 1.0]\nelevation = \"measured\"\n\
                 fov_azimuth_deg = 160.0\nfov_elevation_deg = 20.0\nsigma_range_m = 0.1\nsigma_azimuth_deg = 0.5\n\
                 sigma_elevation_deg = 1.0\n"
            )
            .as_bytes(),
        );
        tiny.put("odometry.csv", b"t_ns,v_mps,yaw_rate_radps\n0,0.0,0.0\n200000000,0.0,0.0\n");
        tiny.put("front/timestamps.txt", b"0\n100000000\n200000000\n");
        for scan in 0..3_u8 {
            let stray = [8.0, 5.0 * f32::from(scan) - 5.0, 0.0];
            let points = [[10.0, 1.0, 0.0], [10.0, 1.5, 0.0], stray];
            let bytes: Vec<u8> = points.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
            tiny.put(&format!("front/{scan:06}.bin"), &bytes);
        }
        tiny
    }

    fn dataset(&self) -> PathBuf {
        self.0.path().join("town")
    }

    fn out(&self) -> PathBuf {
        self.0.path().join("out")
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        ralf_data::write_whole(&self.dataset().join("sequences/00").join(name), bytes).unwrap();
    }

    /// The wall is a building, in the last scan unlabeled; strays are artifacts.
    fn add_truth(&self) {
        for (scan, ids) in [[50_u32, 50, 1], [50, 50, 1], [0, 50, 1]].iter().enumerate() {
            let bytes: Vec<u8> = ids.iter().flat_map(|id| id.to_le_bytes()).collect();
            self.put(&format!("ground_truth/front/{scan:06}.label"), &bytes);
        }
    }

    fn page(&self) -> String {
        page(&self.dataset(), &self.out(), 2)
    }
}

fn page(dataset: &Path, out: &Path, scans_per_sequence: usize) -> String {
    label(dataset, out, false);
    let recording = ralf_data::open(dataset, None).unwrap();
    Report { recording: &recording, out, scans_per_sequence }.page(&|_| ()).unwrap().html
}

fn label(dataset: &Path, out: &Path, evidence: bool) {
    let recording = ralf_data::open(dataset, None).unwrap();
    let settings = Settings::default();
    let run = LabelRun {
        recording: &recording,
        settings: &settings,
        out,
        jobs: 1,
        evidence,
        checks: &[],
        model: None,
    };
    run.execute(&Unwatched).unwrap();
}

#[test]
fn every_piece_of_evidence_has_its_line_where_it_was_gathered() {
    let tiny = Tiny::new();
    assert!(!tiny.page().contains("id=\"evidence\""));
    label(&tiny.dataset(), &tiny.out(), true);
    let recording = ralf_data::open(&tiny.dataset(), None).unwrap();
    let report = Report { recording: &recording, out: &tiny.out(), scans_per_sequence: 1 };
    let page = report.page(&|_| ()).unwrap().html;
    assert!(page.contains("id=\"evidence\""));
    for feature in ralf::evidence::features() {
        assert!(page.contains(feature.name) && page.contains(feature.meaning), "{}", feature.name);
    }
}

#[test]
fn classes_are_counted_by_what_tells_them_where_images_have_segmentations() {
    assert!(!Tiny::new().page().contains("id=\"classes\""));
    let sequence = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(4, 1).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let [dataset, out] = ["town", "out"].map(|name| folder.path().join(name));
    ralf_data::write_sequence(&sequence.with_segmentation(), &dataset, &|_| ()).unwrap();
    let page = page(&dataset, &out, 0);
    let recording = ralf_data::open(&dataset, None).unwrap();
    let run = LabelledRun::open(&out).unwrap().sequence(recording.sequences[0].as_ref()).unwrap();
    let (mut cars, mut by_camera, mut without) = (0, 0, 0);
    let count = run.tables.each(&["label", "semantic", "class_from"], |_, table| {
        let classes = table.get::<Option<u16>>("semantic")?.iter().zip(table.get::<Arc<str>>("class_from")?);
        for ((class, from), label) in classes.zip(table.get::<u8>("label")?) {
            cars += usize::from(*class == Some(10));
            by_camera += usize::from(&**from == "camera");
            without += usize::from(class.is_none() && *label == 1);
        }
        Ok::<_, DataError>(())
    });
    count.unwrap();
    assert!(cars > 0 && by_camera > cars && without > 0, "{cars}, {by_camera}, {without}");
    assert!(page.contains(&format!("car</th><td>0</td><td>{cars}</td>")));
    let share = 100.0 * without as f64 / (by_camera + without) as f64;
    let last = format!("no class</th><td>–</td><td>–</td><td>{without}</td><td>{share:.1} %</td>");
    assert!(page.contains(&last), "{last}");
}

/// So it is with every result of a recording without segmentations, and with those of older programs.
#[test]
fn classes_of_the_lidar_are_counted_where_nothing_says_what_tells_them() {
    let sequence = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(4, 1).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let [dataset, out] = ["town", "out"].map(|name| folder.path().join(name));
    ralf_data::write_sequence(&sequence, &dataset, &|_| ()).unwrap();
    let lidar = dataset.join("sequences/tiny/lidar_top");
    let points = fs::metadata(lidar.join("000000.bin")).unwrap().len() as usize / 16;
    fs::write(lidar.join("000000.label"), 50_u32.to_le_bytes().repeat(points)).unwrap();
    let page = page(&dataset, &out, 0);
    let recording = ralf_data::open(&dataset, None).unwrap();
    let run = LabelledRun::open(&out).unwrap().sequence(recording.sequences[0].as_ref()).unwrap();
    assert!(run.tables.schema().only(&["class_from"]).is_err());
    let mut buildings = 0;
    let count = run.tables.each(&["label", "semantic"], |_, table| {
        let classes = table.get::<Option<u16>>("semantic")?.iter().zip(table.get::<u8>("label")?);
        buildings += classes.filter(|(class, label)| **class == Some(50) && **label == 1).count();
        Ok::<_, DataError>(())
    });
    count.unwrap();
    assert!(buildings > 0);
    assert!(page.contains(&format!("building</th><td>{buildings}</td><td>0</td><td>{buildings}</td>")));
}

#[test]
fn of_very_many_sequences_the_worst_are_shown_and_the_others_folded_away() {
    let tiny = Tiny::new();
    tiny.add_truth();
    let all = tiny.dataset().join("sequences");
    for copy in 1..30 {
        copy_folder(&all.join("00"), &all.join(format!("{copy:02}")));
    }
    // The last one's truth calls the stray plausible and the wall an artifact.
    for (scan, ids) in [[1_u32, 1, 50], [1, 1, 50], [1, 1, 50]].iter().enumerate() {
        let bytes: Vec<u8> = ids.iter().flat_map(|id| id.to_le_bytes()).collect();
        fs::write(all.join(format!("29/ground_truth/front/{scan:06}.label")), bytes).unwrap();
    }
    let page = tiny.page();
    let [at_once, folded] =
        page.split_once("<summary>30 sequences</summary>").map(<[&str; 2]>::from).unwrap();
    let named = |part: &str| (0..30).filter(|name| part.contains(&format!("\"row\">{name:02}</th>"))).count();
    assert_eq!(named(at_once), 10);
    assert!(
        at_once.find("\"row\">29</th>").unwrap() < at_once.find("\"row\">00</th>").unwrap(),
        "the worst first"
    );
    assert_eq!(named(folded.split_once("</details>").unwrap().0), 30);
    assert!(page.contains("<summary>30 fingerprints</summary>"));
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy_folder(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

#[test]
fn the_page_tells_what_evaluate_prints() {
    let tiny = Tiny::new();
    tiny.add_truth();
    let page = tiny.page();
    let truth = GroundTruth::open(&tiny.dataset()).unwrap();
    let overall = Comparison::new(&tiny.out(), &truth).unwrap().evaluation().overall;
    for rates in [overall.scan_mean.rates, overall.pooled.rates] {
        for value in [rates.accuracy, rates.precision, rates.recall, rates.f1_plausible, rates.iou_artifact] {
            assert!(page.contains(&format!("<td>{:.3}</td>", value.unwrap())), "{value:?}");
        }
    }
    let counts = overall.pooled.counts;
    assert_eq!(counts.total(), 8);
    for count in [counts.tp, counts.fp, counts.tn, counts.r#fn] {
        assert!(page.contains(&format!("<strong>{count}</strong>")), "{count}");
    }
    assert!(page.contains("Paper, on other data") && page.contains("<td>0.873</td>"));
    assert!(page.contains("building") && page.contains("outlier"));
    assert!(!page.contains("This recording has no corrected labels"));
}

/// A radar tells an azimuth in degrees beside x, y, z: the method doesn't go by it, and neither does the page.
#[test]
fn an_angle_beside_the_place_changes_nothing() {
    let part = |page: &str| {
        let part =
            |begin: &str| page.split_once(begin).unwrap().1.split_once("</section>").unwrap().0.to_owned();
        [part("<section id=\"score\">"), part("<section id=\"errors\">")]
    };
    let tiny = Tiny::new();
    tiny.add_truth();
    let sensors = tiny.dataset().join("sequences/00/sequence.toml");
    let plain =
        fs::read_to_string(&sensors).unwrap() + "reliability = [[-30.0, 2.0], [10.0, 1.0], [30.0, 2.0]]\n";
    fs::write(&sensors, &plain).unwrap();
    let before = part(&tiny.page());
    let told = plain.replace("[\"x\", \"y\", \"z\"]", "[\"x\", \"y\", \"z\", \"range\", \"azimuth\"]");
    fs::write(&sensors, told).unwrap();
    for scan in 0..3 {
        let file = tiny.dataset().join(format!("sequences/00/front/{scan:06}.bin"));
        let rows = fs::read(&file).unwrap();
        let with = |place: &[u8]| [place, &1000.0_f32.to_le_bytes(), &20.0_f32.to_le_bytes()].concat();
        fs::write(file, rows.chunks(12).flat_map(with).collect::<Vec<u8>>()).unwrap();
    }
    assert_eq!(part(&tiny.page()), before);
}

#[test]
fn false_positives_have_their_causes() {
    let tiny = Tiny::new();
    tiny.add_truth();
    assert!(tiny.page().contains("The causes of artifacts are not known"));
    tiny.put("ground_truth/causes.txt", b"none\nclutter & co\n");
    for scan in 0..3 {
        tiny.put(&format!("ground_truth/front/{scan:06}.cause"), &[0, 0, 1]);
    }
    let page = tiny.page();
    assert!(page.contains("clutter &amp; co") && !page.contains("clutter & co"));
}

#[test]
fn without_truth_the_rest_stands() {
    let page = Tiny::new().page();
    assert_eq!(page.matches("This recording has no corrected labels").count(), 3);
    for part in
        ["Distinctiveness", "Class balance", "Flagged scans", "no LiDAR scan near in time", "From above"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("Paper, on other data"));
}

#[test]
fn what_comes_from_data_is_escaped_and_nothing_is_loaded() {
    let tiny = Tiny::new();
    tiny.add_truth();
    let page = tiny.page();
    assert!(!page.contains("<script>alert"));
    assert!(page.contains("&lt;script&gt;alert"));
    for attribute in ["src=\"", "href=\"", "url(", "@import"] {
        for (at, _) in page.match_indices(attribute) {
            let value = &page[at + attribute.len()..][..20];
            assert!(value.starts_with("data:image/png") || value.starts_with('#'), "{attribute}{value}");
        }
    }
    assert!(page.contains("default-src 'none'"));
    let folder = tiny.0.path().to_str().unwrap();
    assert!(!page.contains(folder), "the page tells nothing of the machine");
}

#[test]
fn the_same_data_give_the_same_bytes() {
    let tiny = Tiny::new();
    tiny.add_truth();
    let first = tiny.page();
    fs::remove_dir_all(tiny.out()).unwrap();
    assert!(tiny.page() == first);
}

#[test]
fn as_many_scans_are_drawn_as_asked_for() {
    let tiny = Tiny::new();
    for (wanted, drawn) in [(0, 0), (2, 2), (9, 3)] {
        let page = page(&tiny.dataset(), &tiny.out(), wanted);
        assert_eq!(page.matches("<figure class=\"scan\"").count(), drawn);
        // Raw beside labelled, and the overview.
        assert_eq!(page.matches("data:image/png").count(), 2 * drawn + 1);
    }
}

/// Scans are numbered by the first radar that has any: one that was switched off takes no picture from the others.
#[test]
fn scans_are_drawn_though_the_first_radar_has_none() {
    let tiny = Tiny::new();
    let sequence = tiny.dataset().join("sequences/00");
    let sensors = fs::read_to_string(sequence.join("sequence.toml")).unwrap();
    let (head, radar) = sensors.split_once("[[radar]]").unwrap();
    let off = radar.replace("\"front\"", "\"off\"");
    tiny.put("sequence.toml", format!("{head}[[radar]]{off}[[radar]]{radar}").as_bytes());
    tiny.put("off/timestamps.txt", b"");
    let page = page(&tiny.dataset(), &tiny.out(), 2);
    assert_eq!(page.matches("<figure class=\"scan\"").count(), 2);
}

#[test]
fn results_that_are_missing_are_named() {
    let tiny = Tiny::new();
    let recording = ralf_data::open(&tiny.dataset(), None).unwrap();
    let report = Report { recording: &recording, out: &tiny.out(), scans_per_sequence: 1 };
    let error = report.page(&|_| ()).unwrap_err().to_string();
    assert!(error.contains("run.json: expected the record of a finished `ralf label`"), "{error}");
}

#[test]
fn a_recording_of_another_format_without_truth() {
    let Some(root) = std::env::var_os("RALF_TEST_DATA") else {
        return println!("skipped: RALF_TEST_DATA is not set");
    };
    let recording = ralf_data::open(&Path::new(&root).join("nuscenes"), None).unwrap();
    let first = recording.sequences[0].sequence().name.clone();
    let recording = recording.select(&[first]).unwrap();
    let out = tempfile::tempdir().unwrap();
    let out = out.path().join("out");
    let run = LabelRun {
        recording: &recording,
        settings: &Settings::default(),
        out: &out,
        jobs: 2,
        evidence: false,
        checks: &[],
        model: None,
    };
    run.execute(&Unwatched).unwrap();
    let page = Report { recording: &recording, out: &out, scans_per_sequence: 1 }.page(&|_| ()).unwrap().html;
    assert!(page.contains("This recording has no corrected labels") && page.contains("RADAR_FRONT"));
}
