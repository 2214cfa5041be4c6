//! The own layout: what is read, what a conversion keeps, and what is refused.

use crate::dataset::{SEQUENCE_TOML, floats, tiny, write};
use ralf::sensors::{DepthOutput, Intrinsics, Source};
use ralf_data::read::ros::Topics;
use ralf_data::{LayoutSequence, SequenceReader, has_sequence, write_sequence};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

#[test]
fn units_and_values_are_as_the_file_says() {
    let (_folder, path) = tiny();
    let reader = LayoutSequence::open(&path).unwrap();
    let sequence = reader.sequence();
    assert_eq!((sequence.name.as_str(), sequence.title.as_str()), ("00", "tiny"));
    assert_eq!(sequence.depth_output, DepthOutput::Disparity);
    assert_eq!(sequence.times.radars, [vec![1000, 50_001_000, 50_001_000], vec![-7, 30_000_000]]);
    let [front, rear] = &sequence.rig.radars[..] else { panic!("two radars") };
    assert!((front.vehicle_from_radar.rotation.euler_angles().2.to_degrees() - 45.0).abs() < 1e-6);
    assert_eq!((front.sigma_elevation, rear.sigma_elevation), (1.2f64.to_radians(), 0.0));
    assert_eq!(front.reliability.at(f64::to_radians(-65.0)), 1.25);
    assert_eq!(sequence.rig.lidars[0].max_range, None);
    let Intrinsics::KannalaBrandt { distortion, .. } = sequence.rig.cameras[0].intrinsics else {
        panic!("a fisheye")
    };
    assert_eq!(distortion, [0.05, -0.01, 0.0, 0.0]);
    assert_eq!(reader.lidar_scan(0, 0).unwrap().classes, Some(vec![10, 40]));
    assert_eq!(reader.lidar_scan(0, 1).unwrap().classes, None);
    assert_eq!(reader.lidar_scan(0, 0).unwrap().times, Some(vec![-0.048, 0.025]));
    assert_eq!(reader.lidar_scan(0, 1).unwrap().times, None);
    let scan = reader.radar_scan(1, 1).unwrap();
    assert_eq!((scan.spherical[0].range, scan.spherical[0].azimuth), (19.0, -0.5));
    let depth = reader.depth(0, 1).unwrap().unwrap();
    assert_eq!((depth.len(), &depth[0].values[..]), (2, &[1.0, 2.0, 3.0, 4.0][..]));
    assert!(reader.depth(0, 0).unwrap().is_none());
    assert_eq!(reader.inputs().len(), 3 + 4 + 3 + 5 + 4, "ground truth is no input of labelling");
    assert!(reader.warnings().is_empty());
}

#[test]
fn a_conversion_keeps_everything() {
    let (_folder, path) = tiny();
    let out = tempfile::tempdir().unwrap();
    let reader = LayoutSequence::open(&path).unwrap();
    let told = Mutex::new(vec![]);
    write_sequence(&reader, out.path(), &|done| told.lock().unwrap().push(done)).unwrap();
    assert_eq!(told.into_inner().unwrap(), (1..=9).collect::<Vec<_>>());
    let copy = out.path().join("sequences/00");
    // Numbers start from 0 and have no gaps; line ends are one kind. All else is the same to the byte.
    for (from, to) in [
        ("radar_rear/000003.bin", "radar_rear/000000.bin"),
        ("radar_rear/000010.bin", "radar_rear/000001.bin"),
    ] {
        assert_eq!(fs::read(path.join(from)).unwrap(), fs::read(copy.join(to)).unwrap());
    }
    assert_eq!(fs::read_to_string(copy.join("radar_rear/timestamps.txt")).unwrap(), "-7\n30000000\n");
    for file in
        files(&path).iter().filter(|file| !file.starts_with("radar_rear") && !file.ends_with("sequence.toml"))
    {
        assert_eq!(fs::read(path.join(file)).unwrap(), fs::read(copy.join(file)).unwrap(), "{file:?}");
    }
    assert_eq!(files(&path).len(), files(&copy).len());
    let again = LayoutSequence::open(&copy).unwrap();
    assert_eq!(format!("{:?}", again.sequence()), format!("{:?}", reader.sequence()));
    let values = |folder: &Path| fs::read_to_string(folder.join("sequence.toml")).unwrap().parse().unwrap();
    let (mut before, after): (toml::Table, toml::Table) = (values(&path), values(&copy));
    // Whole numbers become floats, and the two coefficients that weren't listed are 0.
    before["radar"][1]["translation"] = vec![-1.0, 0.0, 0.5].into();
    before["radar"][1]["quaternion_xyzw"] = vec![0.0, 0.0, 1.0, 0.0].into();
    before["camera"][0]["distortion"] = vec![0.05, -0.01, 0.0, 0.0].into();
    assert_eq!(before, after);
}

#[test]
fn a_conversion_is_whole_or_not_there_and_overwrites_nothing() {
    let (_folder, path) = tiny();
    let reader = LayoutSequence::open(&path).unwrap();
    let out = tempfile::tempdir().unwrap();
    write(&path.join("lidar_top/000001.bin"), [0; 15]);
    // Left by a conversion that was killed.
    write(&out.path().join("sequences/.00.part/.ralf-unfinished"), "");
    write(&out.path().join("sequences/.00.part/old"), "");
    let error = write_sequence(&reader, out.path(), &|_| ()).unwrap_err().to_string();
    assert!(
        error.starts_with("lidar_top, measurement 1: ") && error.contains("000001.bin: byte 0"),
        "{error}"
    );
    assert_eq!(fs::read_dir(out.path().join("sequences")).unwrap().count(), 0);
    // Killed again, while that was removed.
    write(&out.path().join("sequences/.00.part/.ralf-removed"), "");
    write(&out.path().join("sequences/.00.part/old"), "");
    write(&path.join("lidar_top/000001.bin"), [0; 16]);
    write_sequence(&reader, out.path(), &|_| ()).unwrap();
    let copy = out.path().join("sequences/00");
    assert!(!copy.join("old").exists() && !copy.join(".ralf-unfinished").exists());
    let error = write_sequence(&reader, out.path(), &|_| ()).unwrap_err().to_string();
    assert!(error.contains("sequences/00: folder: expected none of this name yet"), "{error}");
}

#[test]
fn what_lies_in_the_place_of_an_unfinished_sequence_and_is_none_is_kept() {
    let (_folder, path) = tiny();
    let reader = LayoutSequence::open(&path).unwrap();
    let out = tempfile::tempdir().unwrap();
    let mine = out.path().join("sequences/.00.part/mine");
    write(&mine, "mine");
    let error = write_sequence(&reader, out.path(), &|_| ()).unwrap_err().to_string();
    assert!(
        error.contains("/.00.part: folder: expected nothing of this name") && error.contains("move it away"),
        "{error}"
    );
    assert_eq!(fs::read(&mine).unwrap(), b"mine");
    // An empty folder is no loss.
    fs::remove_file(&mine).unwrap();
    write_sequence(&reader, out.path(), &|_| ()).unwrap();
    assert!(!mine.parent().unwrap().exists());
}

#[test]
fn a_folder_of_labels_takes_no_sequence() {
    let (_folder, path) = tiny();
    let reader = LayoutSequence::open(&path).unwrap();
    let out = tempfile::tempdir().unwrap();
    write(&out.path().join("run.json"), "{}");
    let error = write_sequence(&reader, out.path(), &|_| ()).unwrap_err().to_string();
    assert!(
        error.contains("output: expected a recording in the own layout") && error.contains("run.json"),
        "{error}"
    );
    assert!(has_sequence(&reader, out.path()).is_err());
    assert!(!out.path().join("sequences").exists());
}

#[test]
fn wanted_sequences_are_kept_and_unknown_ones_are_named() {
    let (folder, _) = tiny();
    let open = || ralf_data::open(folder.path(), None).unwrap();
    let names = |wanted: &[&str]| {
        let wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
        let kept = open().select(&wanted).map_err(|error| error.to_string())?;
        Ok::<_, String>(kept.sequences.iter().map(|s| s.sequence().name.clone()).collect::<Vec<_>>())
    };
    assert_eq!(names(&["01"]).unwrap(), ["01"]);
    assert_eq!(names(&["01", "00"]).unwrap(), ["00", "01"]);
    assert_eq!(names(&[]).unwrap(), ["00", "01"]);
    assert_eq!(names(&["07"]).unwrap_err(), "no sequence `07` in the recording, which holds 00, 01");
}

#[test]
fn a_damaged_sequence_is_in_nobodys_way_who_asks_for_another() {
    let (folder, _) = tiny();
    fs::write(folder.path().join("sequences/00/sequence.toml"), "format = ").unwrap();
    let open = |wanted: &[&str]| {
        let wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
        let opened = ralf_data::open_selected(folder.path(), None, &Topics::new(), &wanted);
        opened.map(|opened| opened.sequences.len()).map_err(|error| error.to_string())
    };
    assert_eq!(open(&["01"]), Ok(1));
    for wanted in [&["00"][..], &["01", "00"]] {
        assert!(open(wanted).unwrap_err().contains("sequences/00/sequence.toml"), "{wanted:?}");
    }
    assert!(open(&["07"]).unwrap_err().contains("no sequence `07`"));
    assert_eq!(open(&[]), Ok(1));
}

/// What of the sequence's settings is replaced, by what, and what is said of it.
const WRONG_SETTINGS: &[(&str, &str, &str)] = &[
    ("format = 1", "format = 2", "format: expected 1, found 2"),
    (
        "0.0, 0.0, 0.38268343, 0.92387953",
        "0, 0, 0, 0",
        "[[radar]] radar_front: quaternion_xyzw: expected a length of 1",
    ),
    (
        "[3.6, 0.0, 0.5]",
        "[nan, 0.0, 0.5]",
        "[[radar]] radar_front: translation: expected finite numbers, found NaN",
    ),
    ("translation = [3.6, 0.0, 0.5]", "", "[[radar]]: expected the key `translation`, found none"),
    ("sigma_elevation_deg = 1.2", "", "[[radar]] radar_front: sigma_elevation_deg: expected a value where"),
    ("\"measured\"", "\"some\"", "[[radar]]: expected `measured` or `none`, found unknown variant `some`"),
    ("sigma_range_m = 0.10", "sigma_range_m = -0.1", "`sigma_range_m` of at least 0, found -0.1"),
    ("fov_azimuth_deg = 160.0", "fov_azimuth_deg = 361", "`fov_azimuth_deg` above 0 and up to 360"),
    ("[-80.0, 1.5]", "[-80.0, 0.5]", "reliability: expected values of at least 1, found 0.5 at -80 deg"),
    (
        "\"radar_rear\"",
        "\"radar_front\"",
        "name: expected a name that no other sensor has, found `radar_front`",
    ),
    (
        "\"radar_rear\"",
        "\"../radar_rear\"",
        "expected the plain name of the sensor's own folder, found `../radar_rear`",
    ),
    ("\"radar_rear\"", "\"ground_truth\"", "expected the plain name"),
    ("\"rcs\"", "\"w_lm\"", "fields: expected names that no column of the output has, found `w_lm`"),
    ("\"rcs\"", "\"doppler\"", "fields: expected each name once, found `doppler`"),
    ("\"x\", \"y\", \"z\"", "\"x\", \"y\"", "found neither in"),
    ("lowest_beam_deg = 25.0", "lowest_beam_deg = 0", "`lowest_beam_deg` above 0 and up to 90, found 0"),
    (
        "lowest_beam_deg = 25.0",
        "lowest_beam_deg = 25.0\nmax_range_m = -1",
        "max_range_m: expected a finite number",
    ),
    (
        "distortion = [0.05, -0.01]",
        "distortion = [0, 0, 0, 0, 0]",
        "distortion: expected up to 4 coefficients, found 5",
    ),
    ("fx = 3.3", "", "[[camera]] camera_front: fx: expected a value for this model, found none"),
    ("fx = 3.3", "fx = 0", "fx, fy: expected values above 0, found 0"),
    ("\"kannala-brandt\"", "\"scaramuzza\"", "inverse_polynomial: expected coefficients, found none"),
    ("width = 4", "width = 0", "expected at least 1 x 1 pixels, found 0 x 2"),
    ("width = 4", "width = 16385", "width, height: expected at most 16384 x 16384 pixels, found 16385 x 2"),
    (
        "horizontal_fov_deg = 100.0\nwidth = 2",
        "horizontal_fov_deg = 100.0\nwidth = 4000000",
        "view: width, height: expected at most 16384 x 16384 pixels, found 4000000 x 2",
    ),
    ("horizontal_fov_deg = 100.0", "horizontal_fov_deg = 180", "expected an angle above 0 and below 180"),
];

#[test]
fn settings_that_no_sensor_has_are_refused() {
    for (from, to, expected) in WRONG_SETTINGS {
        let (_folder, path) = tiny();
        assert!(SEQUENCE_TOML.contains(from), "{from}");
        write(&path.join("sequence.toml"), SEQUENCE_TOML.replacen(from, to, 1));
        refused(&path, expected);
    }
}

#[test]
fn missing_and_surplus_files_are_named() {
    type Harm = fn(&Path);
    let harms: [(Harm, &str); 8] = [
        (|path| fs::remove_file(path.join("sequence.toml")).unwrap(), "sequence.toml: "),
        (|path| fs::remove_dir_all(path.join("lidar_top")).unwrap(), "lidar_top: "),
        (
            |path| fs::remove_file(path.join("radar_rear/timestamps.txt")).unwrap(),
            "radar_rear/timestamps.txt: ",
        ),
        (
            |path| fs::remove_file(path.join("radar_front/000001.bin")).unwrap(),
            "radar_front/timestamps.txt: end: expected a line for each of the 2 files beside it, found 3 lines",
        ),
        (|path| write(&path.join("radar_front/more.bin"), ""), "more.bin: name: expected a number"),
        (|path| write(&path.join("camera_front/0.jpg"), ""), "expected one file of number 0, found another"),
        (
            |path| write(&path.join("radar_front/timestamps.txt"), "3\n2\n4\n"),
            "line 2: expected a time of 3 or later",
        ),
        (
            |path| write(&path.join("odometry.csv"), "t_ns,v_mps,yaw_rate_radps\n0,1,NaN\n"),
            "odometry.csv: line 2, yaw_rate_radps: expected a finite number, found `NaN`",
        ),
    ];
    for (harm, expected) in harms {
        let (_folder, path) = tiny();
        harm(&path);
        refused(&path, expected);
    }
}

#[test]
fn bad_measurements_are_named_when_they_are_read() {
    let (_folder, path) = tiny();
    let reader = LayoutSequence::open(&path).unwrap();
    let harm = |file: &str, bytes: &[u8]| write(&path.join(file), bytes);
    let says = |result: Result<(), ralf::sensors::SourceError>, expected: &str| {
        let error = result.unwrap_err().to_string();
        assert!(error.contains(expected), "{error} lacks {expected}");
    };
    harm("radar_front/000000.bin", &floats(&[1.0; 9]));
    says(reader.radar_scan(0, 0).map(drop), "radar_front/000000.bin: byte 20: expected rows of 5 float32");
    harm("lidar_top/000000.label", &[0; 4]);
    says(reader.lidar_scan(0, 0).map(drop), "000000.label: size: expected 2 uint32, one per point, found 1");
    harm("lidar_top/000000.label", &[0; 8]);
    harm("lidar_top/000000.time", &floats(&[0.0; 3]));
    says(reader.lidar_scan(0, 0).map(drop), "000000.time: size: expected 2 float32, one per point, found 3");
    harm("lidar_top/000000.time", &floats(&[0.0, f32::NAN]));
    says(reader.lidar_scan(0, 0).map(drop), "000000.time: byte 4: expected a time within 1 s of the scan's");
    // Seconds since 1970, or milliseconds.
    harm("lidar_top/000000.time", &floats(&[1.6e9, 0.0]));
    says(reader.lidar_scan(0, 0).map(drop), "000000.time: byte 0: expected a time within 1 s of the scan's");
    let picture = fs::read(path.join("camera_front/000001.jpg")).unwrap();
    harm("camera_front/000001.jpg", &picture[..picture.len() - 2]);
    says(reader.image(0, 1).map(drop), "000001.jpg: content: expected a whole JPEG or PNG image");
    let depth = fs::read(path.join("camera_front/depth/000001.npy")).unwrap();
    harm("camera_front/depth/000001.npy", &depth[..depth.len() - 1]);
    says(reader.depth(0, 1).map(drop), "000001.npy: data: expected 2 x 2 x 2 float32");
    let one = String::from_utf8_lossy(&depth[10..128]).replace("(2, 2, 2)", "(4, 2)   ");
    harm("camera_front/depth/000001.npy", &[&depth[..10], one.as_bytes(), &depth[128..]].concat());
    says(reader.depth(0, 1).map(drop), "expected one image for each of the 2 views, found 1");
    fs::remove_file(path.join("radar_front/000001.bin")).unwrap();
    says(reader.radar_scan(0, 1).map(drop), "000001.bin");
}

#[test]
fn what_has_no_meaning_is_a_warning() {
    let (_folder, path) = tiny();
    write(&path.join("sequence.toml"), SEQUENCE_TOML.replace("fx = ", "lens = \"wide\"\nfx = "));
    write(&path.join("lidar_top/000007.label"), "");
    write(&path.join("lidar_top/000007.time"), "");
    write(&path.join("radar_left/timestamps.txt"), "");
    write(&path.join("notes/timestamps.md"), "");
    let warnings = LayoutSequence::open(&path).unwrap().warnings().join("\n");
    assert!(warnings.contains("sequence.toml: unknown key `camera.0.lens` ignored"), "{warnings}");
    assert!(warnings.contains("000007.label: belongs to no measurement, ignored"), "{warnings}");
    assert!(warnings.contains("000007.time: belongs to no measurement, ignored"), "{warnings}");
    assert!(
        warnings.contains("no table of sequence.toml names, and that are not read: radar_left"),
        "{warnings}"
    );
    assert!(!warnings.contains("notes"), "{warnings}");
}

#[test]
fn polar_coordinates_beside_x_and_y_give_no_place() {
    let (_folder, path) = tiny();
    let fields = "\"power\", \"azimuth\", \"range\"";
    assert!(SEQUENCE_TOML.contains(fields));
    let both = SEQUENCE_TOML.replacen(fields, "\"x\", \"y\", \"azimuth\", \"range\"", 1);
    write(&path.join("sequence.toml"), both);
    write(&path.join("radar_rear/000003.bin"), floats(&[3.0, 4.0, 28.6, 500.0]));
    let scan = LayoutSequence::open(&path).unwrap().radar_scan(1, 0).unwrap();
    assert_eq!((scan.positions[0].x, scan.positions[0].y, scan.spherical[0].range), (3.0, 4.0, 5.0));
    assert_eq!(scan.columns, [[3.0], [4.0], [28.6], [500.0]], "in whatever unit");
}

fn refused(sequence: &Path, expected: &str) {
    let error = LayoutSequence::open(sequence).unwrap_err().to_string();
    assert!(error.contains(expected), "{error} lacks {expected}");
    assert!(error.starts_with(sequence.to_str().unwrap()), "{error}");
}

/// All files below a folder, relative to it, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = vec![];
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { found.push(path) }
        }
    }
    let mut relative: Vec<_> =
        found.iter().map(|file| file.strip_prefix(folder).unwrap().to_owned()).collect();
    relative.sort();
    relative
}
