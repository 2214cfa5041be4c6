//! Names in a recording lead nowhere: whatever they are, nothing outside the output folder changes.

use crate::support::{Dataset, nuscenes_named, ralf, tree, view_of_delft};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder with what must not be touched, the recording, and room for output.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("victim/labels")).unwrap();
        fs::write(folder.path().join("victim/labels/000000.label"), "mine").unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    /// Every verb that writes below a folder refuses the recording, names what is wrong, and leaves everything as it
    /// was.
    #[track_caller]
    fn nothing_is_written(&self, arguments: &[&str], shown: &str) {
        let recording = self.text("recording");
        let out = self.text("room/out");
        let before = tree(self.0.path());
        for verb in [["label", &recording, "-o", &out], ["convert", &recording, "-o", &out]] {
            let ran = crate::support::program().args(verb).args(arguments).output().unwrap();
            crate::support::Ran::of(&ran).exits(1).says([shown, "expected"]);
            assert!(tree(self.0.path()) == before, "{verb:?} {shown}");
        }
    }
}

/// Names that lead out of a folder, or that a folder can't have.
fn bad_names(place: &Place) -> Vec<String> {
    let fixed = [
        "../victim/labels",
        "..",
        "../../../victim",
        "a/../../../victim/labels",
        "a/b",
        "a\nb",
        "NUL",
        "c.",
        "..\\victim",
    ];
    fixed.map(str::to_owned).into_iter().chain([place.text("victim/labels"), "n".repeat(300)]).collect()
}

#[test]
fn a_nuscenes_channel_or_scene_writes_nothing_elsewhere() {
    for name in bad_names(&Place::new()) {
        for (scene, channel) in [("scene-0001", name.as_str()), (name.as_str(), "RADAR_FRONT")] {
            let place = Place::new();
            nuscenes_named(&place.path("recording"), scene, channel);
            let shown = format!("{name:?}");
            place.nothing_is_written(&[], shown.trim_matches('"'));
        }
    }
}

#[test]
fn a_name_that_leads_nowhere_is_labelled_as_ever() {
    let place = Place::new();
    nuscenes_named(&place.path("recording"), "scene 0001, at 10:30", "RADAR_FRONT");
    let (recording, out) = (place.text("recording"), place.text("out"));
    ralf(["label", &recording, "-o", &out]).exits(0);
    assert!(Path::new(&out).join("sequences/scene 0001, at 10:30/RADAR_FRONT/000000.label").is_file());
    ralf(["export", &recording, &out, "--to", "nuscenes", "-o", &place.text("radarseg")]).exits(0);
}

#[test]
fn a_nuscenes_token_writes_no_sidecar_elsewhere() {
    let place = Place::new();
    nuscenes_named(&place.path("recording"), "scene-0001", "RADAR_FRONT");
    let table = place.path("recording/v1.0-test/sample_data.json");
    let text = fs::read_to_string(&table).unwrap();
    fs::write(&table, text.replace("\"token\":\"data-RADAR_FRONT-0\"", "\"token\":\"../../victim/x\""))
        .unwrap();
    let (recording, out) = (place.text("recording"), place.text("out"));
    ralf(["label", &recording, "-o", &out]).exits(0);
    let before = tree(place.0.path());
    ralf(["export", &recording, &out, "--to", "nuscenes", "-o", &place.text("radarseg")])
        .exits(1)
        .says(["../../victim/x", "expected a name"]);
    assert!(tree(place.0.path()) == before);
}

/// ROS names of sensors are those of the table `topics`.
#[test]
fn a_ros_sensor_writes_nothing_elsewhere() {
    let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros/plain.bag");
    for name in bad_names(&Place::new()) {
        let place = Place::new();
        fs::create_dir(place.path("bags")).unwrap();
        fs::copy(&fixture, place.path("recording")).unwrap();
        let quoted = serde_json::to_string(&name).unwrap();
        let topics = format!(
            "[topics.{quoted}]\ntopic = '/radar/points'\nkind = 'radar'\nmodel = 'ars408-21'\n\
             [topics.odom]\ntopic = '/odom'\nkind = 'odometry'\n[topics.tf]\ntopic = '/tf_static'\nkind = 'tf_static'\n"
        );
        fs::write(place.path("topics.toml"), topics).unwrap();
        let shown = format!("{name:?}");
        place.nothing_is_written(&["--topics", &place.text("topics.toml")], shown.trim_matches('"'));
    }
}

/// View-of-Delft's sequence and sensors have fixed names; what is left are the numbers of its frames.
#[test]
fn a_view_of_delft_frame_writes_nothing_elsewhere() {
    for name in ["-1", "1e3", "a\\..\\victim", "a\nb", "NUL", "99999999999999999999999"] {
        let place = Place::new();
        view_of_delft(&place.path("recording"));
        let folder = place.path("recording/radar/training/velodyne");
        fs::copy(folder.join("00005.bin"), folder.join(format!("{name}.bin"))).unwrap();
        place.nothing_is_written(&[], "file name: expected a frame's number");
    }
    let place = Place::new();
    view_of_delft(&place.path("recording"));
    // Hidden files are no frames.
    let folder = place.path("recording/radar/training/velodyne");
    for name in ["..", "..\\victim"] {
        fs::copy(folder.join("00005.bin"), folder.join(format!("{name}.bin"))).unwrap();
    }
    ralf(["label", &place.text("recording"), "-o", &place.text("room/out")]).exits(0);
    let outside: Vec<String> =
        tree(place.0.path()).into_keys().filter(|name| name.contains(".label")).collect();
    assert!(
        outside.iter().all(|name| name.starts_with("room/out/sequences/") || name.starts_with("victim/"))
    );
}

/// What somebody has linked into the output folder is not written to, and nothing of it is removed.
#[cfg(unix)]
#[test]
fn a_link_in_the_output_folder_leads_nowhere() {
    use std::os::unix::fs::symlink;
    let dataset = Dataset::new();
    let place = Place::new();
    let out = place.path("out");
    let label = || ralf(["label", &dataset.path, "-o", &place.text("out"), "--set", "fusion.threshold=0.9"]);
    for link in ["sequences", "sequences/00", "sequences/00/radar_front", ".ralf-run", ".ralf-lock"] {
        // Of a new folder, and of one with results that are to be replaced.
        for labelled in [false, true] {
            if labelled {
                ralf(["label", &dataset.path, "-o", &place.text("out")]).exits(0);
            }
            let link = out.join(link);
            fs::create_dir_all(link.parent().unwrap()).unwrap();
            if link.exists() {
                fs::rename(&link, place.path("victim/moved")).unwrap();
                symlink(place.path("victim/moved"), &link).unwrap();
            } else {
                symlink(place.path("victim"), &link).unwrap();
            }
            let before = tree(place.0.path());
            label().exits(1).says([link.to_str().unwrap(), "a link"]);
            assert!(tree(place.0.path()) == before, "{link:?}");
            fs::remove_dir_all(&out).unwrap();
            let _ = fs::remove_dir_all(place.path("victim/moved"));
        }
    }
    label().exits(0);
}

/// The own layout's sequences have the names of folders on disk.
#[test]
fn a_folder_of_the_own_layout_that_other_systems_can_not_have_is_refused() {
    for name in ["nul", "COM1.txt", "00.part"] {
        let dataset = Dataset::new();
        let place = Place::new();
        fs::create_dir_all(place.path("recording/sequences")).unwrap();
        let folder = place.path("recording/sequences").join(name);
        fs::rename(Path::new(&dataset.path).join("sequences/00"), folder).unwrap();
        place.nothing_is_written(&[], name);
    }
}

/// A record that somebody has edited leads nowhere when its results are removed.
#[test]
fn an_edited_record_removes_nothing_elsewhere() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let victim = dataset.beside("victim");
    fs::create_dir_all(format!("{victim}/radar_front")).unwrap();
    for file in ["plausibility.parquet", "radar_front/000000.label"] {
        fs::write(format!("{victim}/{file}"), "mine").unwrap();
    }
    let before = tree(&victim);
    let record = format!("{}/run.json", dataset.out);
    let text = fs::read_to_string(&record).unwrap();
    fs::write(&record, text.replace("\"name\": \"00\"", "\"name\": \"../../victim\"")).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.threshold=0.9"]).exits(0);
    assert!(tree(&victim) == before);
}

/// What a name tells a terminal to do is shown, and not done; files and JSON keep it as it is.
#[test]
fn control_characters_of_a_recording_never_reach_a_terminal() {
    let dataset = Dataset::new();
    dataset.edit("sequence.toml", "\"a street\"", "\"a \\u001b[31m\\u009b2Jstreet\"");
    ralf(["inspect", &dataset.path]).exits(0).prints(["a \\u001b[31m\\u009b2Jstreet"]);
    let told = ralf(["inspect", &dataset.path, "--json"]).exits(0);
    assert!(!told.stdout.contains(|c: char| c.is_control() && c != '\n'), "{}", told.stdout);
    assert!(told.json().to_string().contains("\u{9b}2Jstreet"));
    dataset.edit("sequence.toml", "elevation = \"none\"", "elevation = \"\\u001b]0;x\\u0007\"");
    ralf(["inspect", &dataset.path]).exits(1).ends_with_error(["unknown variant `\\u001b]0;x\\u0007`"]);
}
