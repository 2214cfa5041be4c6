//! What is read of a good recording.

use super::recording::{
    FRAMES, POINT_TIMES, POSTS, SEQUENCE, T0, frame_time, start_from_vehicle, write_sequence,
};
use crate::read::aimotive::{open, recognises};
use crate::read::{MotionSource, Recording, SequenceReader};
use crate::{Settings, testing};
use nalgebra::Point3;
use ralf::sensors::{Intrinsics, LidarScan};
use ralf::space::{Point, Transform};
use std::fs;
use std::path::{Path, PathBuf};

/// A recording's only sequence.
fn only(path: &Path) -> Box<dyn SequenceReader> {
    open(path, &[]).unwrap().sequences.remove(0)
}

/// The sequence in a folder of its own.
fn drive() -> (tempfile::TempDir, Box<dyn SequenceReader>) {
    let folder = tempfile::tempdir().unwrap();
    write_sequence(folder.path());
    let drive = only(folder.path());
    (folder, drive)
}

#[test]
fn a_sequence_an_environment_and_the_whole_set_are_recognised() {
    for (below, opened) in [
        ("", ""),
        ("highway", "highway"),
        ("data/train/rain", ""),
        ("data/train/rain", "data"),
        ("val/urban", ""),
    ] {
        let folder = tempfile::tempdir().unwrap();
        write_sequence(&folder.path().join(below).join(SEQUENCE));
        fs::create_dir_all(folder.path().join("notes")).unwrap();
        let path = folder.path().join(opened);
        assert!(recognises(&path), "{below}");
        let recording = crate::read::open(&path, None).unwrap();
        assert_eq!((recording.format, recording.sequences.len()), ("aimotive", 1));
        assert_eq!(recording.sequences[0].sequence().name, SEQUENCE);
        let only = recording.sequences[0].sequence().title.clone();
        assert!(below.is_empty() || only.ends_with(below.rsplit('/').next().unwrap()), "{only}");
    }
    assert!(!recognises(tempfile::tempdir().unwrap().path()));
}

#[test]
fn frames_have_the_times_of_their_boxes() {
    let (_folder, drive) = drive();
    let sequence = drive.sequence();
    let times: Vec<i64> = (0..4).map(frame_time).collect();
    assert_eq!(sequence.times.radars, [times.clone(), times.clone()]);
    assert_eq!(sequence.times.lidars, [times]);
    let names: Vec<&str> = sequence.rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!(names, ["B_LRR_C", "F_LRR_C"]);
    assert!(drive.warnings().is_empty(), "{:?}", drive.warnings());
    let moved = sequence.motion.between(T0, frame_time(3));
    let expected = start_from_vehicle(frame_time(3));
    assert!((moved.to_homogeneous() - expected.to_homogeneous()).abs().max() < 1e-6, "{moved}");
}

#[test]
fn poses_go_on_for_a_while_beyond_the_frames() {
    let (_folder, drive) = drive();
    let motion = &drive.sequence().motion;
    let (first, last) = (T0, frame_time(3));
    for (t_ns, most) in [
        (first - 300_000_000, 0.25),
        (first - 130_000_000, 0.03),
        (last + 33_000_000, 0.01),
        (last + 300_000_000, 0.25),
    ] {
        let (found, truth) = (motion.odom_from_vehicle(t_ns), start_from_vehicle(t_ns));
        // Straight on, as from pose to pose: of 6 m in 300 ms the bend takes 0.2 m aside.
        let off = (found.translation.vector - truth.translation.vector).norm();
        let turned = found.rotation.angle_to(&truth.rotation);
        assert!(off < most && turned < 1e-6, "{off} m and {turned} rad at {t_ns} ns");
    }
    let far = motion.odom_from_vehicle(last + 1_000_000_000);
    assert_eq!(far, motion.odom_from_vehicle(last + 300_000_000), "held");
}

#[test]
fn targets_are_kept_as_they_are_and_decibels_are_derived() {
    let (_folder, drive) = drive();
    let front = &drive.sequence().rig.radars[1];
    let scan = drive.radar_scan(1, 2).unwrap();
    let row: Vec<_> =
        front.fields.iter().zip(&scan.columns).map(|(name, column)| (name.as_str(), column[0])).collect();
    let expected = [
        ("azimuth", 0.15),
        ("elevation", 0.01),
        ("range", 21.5),
        ("doppler", -19.75),
        ("rcs_linear", 2.0),
        ("power", 130.5),
        ("noise", 104.0),
        ("rcs", 3.0103),
        ("snr", 26.5),
    ];
    assert_eq!(row, expected);
    // The second is 48 m away, 0.1 rad to the right.
    let place = front.vehicle_from_radar * scan.positions[1];
    assert!((place.y + 48.0 * 0.01_f64.cos() * 0.1_f64.sin()).abs() < 1e-5 && place.x > 51.0, "{place}");
    let behind = drive.sequence().rig.radars[0].vehicle_from_radar * scan.positions[1];
    assert!(behind.x < -48.0 && behind.y > 4.0, "{behind}");
}

/// Whether the posts lie in the vehicle's frame at a frame's time where they are.
fn assert_posts(scan: &LidarScan, vehicle_from_lidar: &Transform, index: usize) {
    for (post, point) in POSTS.iter().zip(&scan.points) {
        let found = vehicle_from_lidar * Point::from(point.map(f64::from));
        let truth = start_from_vehicle(frame_time(index)).inverse() * Point3::from(*post);
        // Coordinates are rounded to 1 mm, and the bend between two poses is a chord of 1.3 m.
        assert!((found - truth).norm() < 0.01, "{found} and not {truth}");
    }
}

#[test]
fn points_go_to_the_frames_time_and_keep_their_own() {
    let (_folder, drive) = drive();
    let mounting = drive.sequence().rig.lidars[0].vehicle_from_lidar;
    // The first and the last, too: their points were measured before the first pose and after the last.
    for index in 0..FRAMES.len() {
        let scan = drive.lidar_scan(0, index).unwrap();
        assert_posts(&scan, &mounting, index);
        assert_eq!((scan.points[5], scan.points.len()), ([0.0; 3], 6));
        assert_eq!(scan.intensity, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let times = scan.times.unwrap();
        for (time, after) in times.iter().zip(POINT_TIMES) {
            assert!((f64::from(*time) - after as f64 * 1e-9).abs() < 1e-8, "{time}");
        }
        let measured = drive.rolling_scan(0, index).unwrap().unwrap();
        let skewed = mounting * Point::from(measured.points[0].map(f64::from));
        let straight = mounting * Point::from(scan.points[0].map(f64::from));
        assert!((skewed - straight).norm() > 1.2, "67 ms at 20 m/s");
    }
}

/// Poses of the vehicle every 10 ms, as TUM has them.
fn trajectory(file: &Path) {
    let line = |n: i64| {
        let t_ns = T0 - 100_000_000 + n * 10_000_000;
        let pose = start_from_vehicle(t_ns);
        let ([x, y, z], q) = (<[f64; 3]>::from(pose.translation.vector), pose.rotation);
        let seconds = format!("{}.{:09}", t_ns / 1_000_000_000, t_ns % 1_000_000_000);
        format!("{seconds} {x} {y} {z} {} {} {} {}\n", q.i, q.j, q.k, q.w)
    };
    fs::write(file, (0..50).map(line).collect::<String>()).unwrap();
}

/// The sequence without poses, and a trajectory's file beside it.
fn without_poses(folder: &Path) -> (PathBuf, PathBuf) {
    let (sequence, poses) = (folder.join(SEQUENCE), folder.join("poses.tum"));
    write_sequence(&sequence);
    fs::remove_file(sequence.join("sensor/gnssins/egomotion.json")).unwrap();
    trajectory(&poses);
    (sequence, poses)
}

#[test]
fn a_trajectory_corrects_points_where_the_recording_has_no_poses() {
    let folder = tempfile::tempdir().unwrap();
    let (sequence, poses) = without_poses(folder.path());
    let plain = only(&sequence);
    assert!(!plain.sequence().motion.is_known());
    assert!(plain.warnings()[0].contains("egomotion.json"), "{:?}", plain.warnings());
    let measured = plain.lidar_scan(0, 2).unwrap();
    assert_eq!(measured.points, plain.rolling_scan(0, 2).unwrap().unwrap().points);
    let mut settings = Settings::default();
    settings.motion.trajectory = Some(poses);
    let corrected = settings.correct(open(&sequence, &[]).unwrap()).unwrap().sequences.remove(0);
    assert_eq!((corrected.motion_source(), corrected.warnings()), (MotionSource::Trajectory, &[][..]));
    let mounting = corrected.sequence().rig.lidars[0].vehicle_from_lidar;
    assert_posts(&corrected.lidar_scan(0, 2).unwrap(), &mounting, 2);
    // Corrected once, however often it is asked to be.
    let again = Recording::new(&sequence, "aimotive", vec![corrected]);
    let again = settings.correct(again).unwrap().sequences.remove(0);
    assert_posts(&again.lidar_scan(0, 2).unwrap(), &mounting, 2);
}

#[test]
fn nothing_is_written_of_a_lidar_before_the_motion_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let (sequence, poses) = without_poses(folder.path());
    let own = folder.path().join("own");
    let refused = crate::write_sequence(only(&sequence).as_ref(), &own, &|_| ()).unwrap_err().to_string();
    assert!(refused.contains("M_LIDAR_M") && refused.contains("--trajectory"), "{refused}");
    assert!(!own.join("sequences").join(SEQUENCE).exists());
    let mut settings = Settings::default();
    settings.motion.trajectory = Some(poses);
    let corrected = settings.correct(open(&sequence, &[]).unwrap()).unwrap().sequences.remove(0);
    crate::write_sequence(corrected.as_ref(), &own, &|_| ()).unwrap();
    let written = crate::read::open(&own, None).unwrap().sequences.remove(0);
    let text = |reader: &dyn SequenceReader| format!("{:?}", reader.lidar_scan(0, 2).unwrap());
    assert_eq!(text(written.as_ref()), text(corrected.as_ref()));
    assert!(written.rolling_scan(0, 2).unwrap().is_none());
}

#[test]
fn egomotion2_is_preferred_and_may_know_fewer_frames() {
    let (folder, _) = drive();
    let gnss = folder.path().join("sensor/gnssins");
    let identity = "[[1,0,0,7],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
    let poses = format!(
        "{{\"0033644\": {{\"RT_ECEF_body\": {identity}, \"time\": 3, \"enh_sep\": []}}, \"0099999\": {{\"RT_ECEF_body\": {identity}}}}}"
    );
    fs::write(gnss.join("egomotion2.json"), poses).unwrap();
    let drive = only(folder.path());
    assert_eq!(drive.sequence().motion.poses().len(), 1);
    assert!(drive.inputs().contains(&gnss.join("egomotion2.json")));
    assert!(!drive.inputs().contains(&gnss.join("egomotion.json")));
}

#[test]
fn without_boxes_the_lidar_tells_the_times() {
    let (folder, _) = drive();
    let remove = |part: &str, extension: &str, indices: &[usize]| {
        for index in indices {
            let name = format!("dynamic/{part}/frame_{:07}.{extension}", FRAMES[*index]);
            fs::remove_file(folder.path().join(name)).unwrap();
        }
    };
    let [boxes, points] = [("box/3d_body", "json"), ("raw-revolutions", "laz")];
    let times = |warning: &str| {
        let drive = only(folder.path());
        assert!(drive.warnings()[0].contains(warning), "{:?}", drive.warnings());
        drive.sequence().times.radars[0].clone()
    };
    let true_times = [0, 1, 2, 3].map(frame_time);
    remove(boxes.0, boxes.1, &[1]);
    // The first of these points is measured 67 ms before the frame.
    assert_eq!(times("1 of 4 frames have no boxes"), true_times);
    remove(points.0, points.1, &[1]);
    let told = "are taken to be 67.0 ms after the LiDAR's first point";
    assert_eq!(times(told), true_times, "by the steps between");
    remove(boxes.0, boxes.1, &[0, 2, 3]);
    assert_eq!(times("taken to be 67.6 ms after"), true_times.map(|t_ns| t_ns + 600_000));
    remove(points.0, points.1, &[0, 2]);
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("expected boxes or LiDAR files of two frames or more"), "{error}");
}

#[test]
fn a_pinhole_is_read_and_a_fisheye_left_out() {
    let (folder, _) = drive();
    for camera in ["F_MIDLONGRANGECAM_CL", "M_FISHEYE_L"] {
        let images = folder.path().join("sensor/camera").join(camera);
        fs::create_dir_all(&images).unwrap();
        image::RgbImage::new(8, 4).save(images.join(format!("{camera}_{:07}.jpg", FRAMES[2]))).unwrap();
    }
    let drive = only(folder.path());
    let [camera] = &drive.sequence().rig.cameras[..] else { panic!("one camera") };
    let distortion = [-0.3, 0.08, 0.002, 0.0006, 0.0];
    assert_eq!(camera.intrinsics, Intrinsics::Pinhole { focal: [6.5, 6.25], center: [4.0, 2.0], distortion });
    let ahead = camera.vehicle_from_camera * Point::new(0.0, 0.0, 10.0);
    assert!((ahead - Point::new(11.9, 0.1, 1.25)).norm() < 1e-9, "{ahead}");
    assert_eq!(drive.sequence().times.cameras, [[frame_time(2)]]);
    assert_eq!(drive.image(0, 0).unwrap().width, 8);
    assert_eq!(
        drive.warnings(),
        [
            "M_FISHEYE_L: a fisheye of the model `mei`, which RALF doesn't know: left out",
            "3 of 4 files of F_MIDLONGRANGECAM_CL are not there and were left out"
        ]
    );
}

#[test]
fn the_genuine_frames() {
    let Some(folder) = testing::data("aimotive") else { return };
    let drive = only(&folder);
    let sequence = drive.sequence();
    assert_eq!(sequence.times.radars[1].len(), 20);
    assert_eq!(sequence.times.radars[1][..2], [4_833_189_570_000, 4_833_256_266_000]);
    let detections: usize = (0..20).map(|scan| drive.radar_scan(0, scan).unwrap().len()).sum();
    assert_eq!(detections, 745);
    let scan = drive.lidar_scan(0, 0).unwrap();
    assert_eq!(scan.points.len(), 129_715);
    let times = scan.times.unwrap();
    let bounds = [times.iter().copied().fold(0.0, f32::min), times.iter().copied().fold(0.0, f32::max)];
    assert!((bounds[0] + 0.067_894).abs() < 1e-6 && (bounds[1] - 0.032_355).abs() < 1e-6, "{bounds:?}");
}

#[test]
fn a_radar_without_its_folder_is_told() {
    let (folder, _) = drive();
    fs::remove_dir_all(folder.path().join("sensor/radar/B_LRR_C")).unwrap();
    let drive = only(folder.path());
    let told =
        "B_LRR_C: a radar in sensor/calibration/calibration.json without a folder in sensor/radar: left out";
    assert_eq!(drive.warnings(), [told]);
    assert_eq!(drive.sequence().rig.radars.len(), 1);
}
