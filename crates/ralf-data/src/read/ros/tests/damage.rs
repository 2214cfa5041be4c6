//! What can't be read is named, and costs the rest nothing.

use super::*;

/// How the messages of a bag begin behind their stamps, each a frame and what follows it.
const CLOUD: &[u8] = b"\x05\0\0\0radar\x01\0\0\0";
const LIDAR_CLOUD: &[u8] = b"\x05\0\0\0lidar\x01\0\0\0";
const CALIBRATION: &[u8] = b"\x06\0\0\0camera\x01\0\0\0\x02\0\0\0\x09\0\0\0plumb_bob";
const IMAGE: &[u8] = b"\x06\0\0\0camera\x01\0\0\0\x02\0\0\0\x04\0\0\0rgb8";

/// A bag in which some of the messages that begin so have frames that are longer than all of it.
fn damaged(drive: Drive, messages: &[u8], which: &[usize]) -> (TempDir, PathBuf) {
    let (folder, path) = Drive { bag: true, ..drive }.write();
    let mut bytes = std::fs::read(&path).unwrap();
    let is_one = |at: &usize| bytes[*at..].starts_with(messages);
    let found: Vec<usize> = (0..bytes.len()).filter(is_one).collect();
    which.iter().for_each(|number| bytes[found[*number] + 3] = 0xff);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn told(warnings: &[String], parts: &[&str]) -> bool {
    warnings.iter().any(|warning| parts.iter().all(|part| warning.contains(part)))
}

/// The first scan of the file was recorded 90 ms after `T0`; the others 95 and 20 ms after they were measured.
#[test]
fn a_radar_scan_that_can_not_be_read_stands_where_the_recorder_had_it() {
    let (_folder, path) = damaged(Drive::default(), CLOUD, &[0]);
    let drive = open_file(&path, TABLE).unwrap();
    assert_eq!(drive.sequence().times.radars[0], [-5, 0, 140].map(|ms| T0 + ms * MS));
    let error = drive.radar_scan(0, 0).unwrap_err().to_string();
    let expected =
        "/front/points recorded at 1600000000090000000 ns, byte 12: expected a list that fits into";
    assert!(error.contains(expected), "{error}");
    assert_eq!([1, 2].map(|scan| drive.radar_scan(0, scan).unwrap().len()), [1, 0]);
    assert_eq!(drive.sequence().rig.radars[0].fields, ["x", "y", "z", "vx", "vy", "doppler"]);
    assert!(drive.warnings().is_empty() && drive.lost().is_empty(), "it is named where it is asked for");
}

#[test]
fn a_radar_of_which_nothing_can_be_read_is_lost_and_the_other_stays() {
    let (_folder, path) = damaged(Drive::default(), CLOUD, &[0, 1, 2]);
    let drive = open_file(&path, TABLE).unwrap();
    let names: Vec<&str> = drive.sequence().rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!((names, drive.sequence().times.radars.len()), (vec!["rear"], 1));
    let [lost] = drive.lost() else { panic!("{:?}", drive.lost()) };
    assert!(lost.starts_with("front: none of its 3 messages can be read; the first: "), "{lost}");
    assert!(lost.contains("recorded at 1600000000090000000 ns"), "{lost}");
    assert_eq!(drive.radar_scan(0, 0).unwrap().len(), 2);
}

#[test]
fn a_lidar_or_camera_of_which_nothing_can_be_read_is_left_out() {
    let (_folder, path) = damaged(Drive::default(), LIDAR_CLOUD, &[0]);
    let drive = open_file(&path, TABLE).unwrap();
    assert!(drive.sequence().rig.lidars.is_empty() && drive.sequence().times.lidars.is_empty());
    assert!(told(drive.warnings(), &["left out, for none of", "can be read: the LiDAR roof; the first: "]));
    let (_folder, path) = damaged(Drive::default(), IMAGE, &[0]);
    let drive = open_file(&path, TABLE).unwrap();
    assert!(drive.sequence().rig.cameras.is_empty() && drive.sequence().times.cameras.is_empty());
    assert!(told(drive.warnings(), &["can be read: the camera cam; the first: "]));
    assert!(drive.lost().is_empty());
}

#[test]
fn a_camera_is_what_the_first_of_its_messages_tell_that_can_be_read() {
    let twice = || Drive { infos: vec![100.0; 2], images: 2, ..Drive::default() };
    let (_folder, path) = damaged(twice(), CALIBRATION, &[0]);
    let drive = open_file(&path, TABLE).unwrap();
    assert_eq!((drive.sequence().rig.cameras[0].width, drive.warnings().len()), (2, 1));
    assert!(told(drive.warnings(), &["1 messages of /cam/camera_info can't be read; the first: "]));
    let (_folder, path) = damaged(twice(), IMAGE, &[0]);
    let drive = open_file(&path, TABLE).unwrap();
    assert_eq!(drive.sequence().times.cameras, [[50, 60].map(|ms| T0 + ms * MS)]);
    assert!(drive.image(0, 0).unwrap_err().to_string().contains("/cam/image_raw recorded at"));
    assert_eq!(drive.image(0, 1).unwrap().rgb, [[1, 2, 3], [4, 5, 6]]);
    assert!(drive.warnings().is_empty());
    // Without any calibration it can't be used.
    let (_folder, path) = damaged(Drive::default(), CALIBRATION, &[0]);
    let drive = open_file(&path, TABLE).unwrap();
    assert!(told(
        drive.warnings(),
        &["the camera cam is left out: ", "a calibration, found none that can be read"]
    ));
}

/// What has the same reason is told with it, once.
#[test]
fn frames_that_can_not_be_read_are_told_where_they_are_missed() {
    let (_folder, path) = damaged(Drive::default(), b"\x04\0\0\0mast", &[0]);
    let refused = open_file(&path, TABLE).err().unwrap().to_string();
    assert!(refused.contains("expected a transform from `base`"), "{refused}");
    assert!(refused.contains("; 1 messages of /tf_static can't be read; the first: "), "{refused}");
}

#[test]
fn a_guess_goes_by_what_can_be_read() {
    let (_folder, path) = damaged(Drive::default(), LIDAR_CLOUD, &[0]);
    // Neither the topic's name nor a field tells what it is.
    assert_eq!(guess(&path).unwrap().topics["roof"].kind, TopicKind::Radar);
    let (_folder, path) = damaged(Drive::default(), CLOUD, &[0, 1]);
    let front = guess(&path).unwrap().topics["front"].clone();
    assert_eq!((front.kind, front.elevation), (TopicKind::Radar, None), "the model tells it");
}

#[test]
fn a_file_that_is_cut_is_read_up_to_the_cut_and_the_loss_is_said() {
    let (_folder, path) = Drive { bag: true, ..Drive::default() }.write();
    let whole = std::fs::metadata(&path).unwrap().len();
    File::options().write(true).open(&path).unwrap().set_len(whole - 3000).unwrap();
    let drive = open_file(&path, TABLE).unwrap();
    assert!(drive.warnings()[0].contains("cut short or damaged"), "{:?}", drive.warnings());
    assert!(drive.lost().is_empty(), "nothing lies behind a cut");
    assert_eq!(drive.sequence().times.radars[0].len(), 3);
}

/// A recording of several chunks: a scan each millisecond, and one message of the odometry at the beginning.
fn long(path: &Path) -> Vec<u8> {
    let mut to = MessageWriter::mcap(File::create(path).unwrap(), Compression::None).unwrap();
    let drive = Drive::default();
    let odometry: Topic<Odometry> = to.topic("/odom", Delivery::Live).unwrap();
    to.write(&odometry, T0, &drive.odometry(0)).unwrap();
    let scans: Topic<RadarScan> = to.topic("/scan", Delivery::Live).unwrap();
    for ms in 0..4000 {
        let scan = RadarScan { header: drive.header(ms, "base"), returns: vec![RadarReturn::default(); 40] };
        to.write(&scans, T0 + (ms + 7) * MS, &scan).unwrap();
    }
    to.finish().unwrap();
    std::fs::read(path).unwrap()
}

const LONG: &str = "[topics]\nodom = { topic = '/odom', kind = 'odometry' }\n\
                    scan = { topic = '/scan', kind = 'radar', model = 'generic' }";

#[test]
fn scans_in_damaged_chunks_keep_their_numbers_and_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.mcap");
    let whole = long(&path);
    let damaged = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        std::fs::write(&path, bytes).unwrap();
        open_file(&path, LONG)
    };
    let opened = damaged(whole.len() / 2).unwrap();
    let times: Vec<i64> = (0..4000).map(|ms| T0 + ms * MS).collect();
    assert_eq!(opened.sequence().times.radars[0], times, "the recorder was always 7 ms late");
    let read = |scan: usize| opened.radar_scan(0, scan).map_err(|error| error.to_string());
    let lost = (0..4000)
        .filter(|scan| read(*scan).is_err_and(|told| told.contains("expected the checksum")))
        .count();
    assert!((100..3000).contains(&lost) && read(0).is_ok() && read(3999).is_ok(), "{lost}");
    assert_eq!((opened.warnings(), opened.lost()), (&[][..], &[][..]));
    // The only odometry lies in the first chunk.
    let refused = damaged(2000).err().unwrap().to_string();
    assert!(
        refused.contains("/odom: expected a message that can be read, found none; the first: "),
        "{refused}"
    );
    assert!(refused.matches("checksum").count() == 1, "{refused}");
}

#[test]
fn what_hides_scans_is_lost_and_never_written_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.mcap");
    let mut bytes = long(&path);
    // In the midst of the file a length that leads beyond its end.
    let at = (bytes.len() / 2..)
        .find(|at| bytes[*at..].starts_with(b"\x06") && bytes[at + 5..].starts_with(&[0; 4]));
    bytes[at.unwrap() + 8] = 0xff;
    std::fs::write(&path, bytes).unwrap();
    let opened = open_file(&path, LONG).unwrap();
    let [lost] = opened.lost() else { panic!("{:?}", opened.lost()) };
    assert!(lost.contains("bytes from there on are not read"), "{lost}");
    assert!(opened.warnings().contains(lost));
    let refused = crate::write_sequence(opened.as_ref(), &folder.path().join("own"), &|_| {}).unwrap_err();
    assert_eq!(refused.to_string(), format!("long: content: {lost}"));
    assert!(!folder.path().join("own").exists());
}
