//! What is damaged or contradicts itself is named.

use super::*;

#[test]
fn what_a_table_asks_for_and_the_file_lacks_is_named() {
    let with = |from: &str, to: &str| error(&Drive::default(), &TABLE.replace(from, to));
    let missing = with("'/front/points'", "'/side/points'");
    assert!(missing.contains("topics.front: expected one of the topics of the type "), "{missing}");
    assert!(
        missing.contains("RadarScan: /front/points, ") && missing.ends_with("found `/side/points`"),
        "{missing}"
    );
    assert!(
        with("'/rear/scan', kind = 'radar'", "'/rear/scan', kind = 'lidar'")
            .contains("sensor_msgs/PointCloud2, found radar_msgs")
    );
    assert!(
        with("hdl-32e", "hdl-99").contains("topics.roof.model: expected one of the models generic, hdl-32e")
    );
    assert!(with("odom =", "# odom =").contains("`vehicle_frame`"));
    assert!(with("tf =", "# tf =").contains("nothing connects `base`"));
    assert!(with("'/front/points', ", "'/front/points', frame = 'side', ").contains("no frame `side`"));
    assert!(with("info = '/cam/camera_info'", "info = '/imu'").contains("topics.cam.info"));
}

#[test]
fn without_odometry_the_motion_is_unknown() {
    let unmoved = TABLE.replace(
        "odom = { topic = '/odom', kind = 'odometry' }\nimu = { topic = '/imu', kind = 'imu' }",
        "imu = { topic = '/imu', kind = 'imu', vehicle_frame = 'base' }",
    );
    assert_ne!(unmoved, TABLE);
    let (_folder, path) = Drive::default().write();
    assert!(!open_file(&path, &unmoved).unwrap().sequence().motion.is_known());
    assert!(open_file(&path, TABLE).unwrap().sequence().motion.is_known());
}

#[test]
fn what_contradicts_itself_is_refused() {
    let error = |drive: &Drive| error(drive, TABLE);
    // Between the first scan and the last, where it is back.
    for mast in [[(-500, 3.0), (100, 3.6), (500, 4.0)], [(0, 3.5), (70, 4.0), (140, 3.5)]] {
        let moved = error(&Drive { mast: mast.to_vec(), ..Drive::default() });
        let (told, places) = moved.split_once(", found ").unwrap();
        assert!(
            told.ends_with("a sensor that doesn't move on `base`, by 5 mm or 0.1 deg at most"),
            "{moved}"
        );
        assert!(
            places.starts_with("x 4.000, y 0.000, z 0.250 m, yaw 0.00, pitch 0.00, roll 0.00 deg at"),
            "{moved}"
        );
    }
    let changed = error(&Drive { infos: vec![100.0, 101.0], ..Drive::default() });
    assert!(changed.contains("/cam/camera_info recorded at") && changed.contains("another one"), "{changed}");
}

#[test]
fn drivers_without_stamps_can_have_those_of_the_recorder() {
    let drive = Drive { stamped: false, ..Drive::default() };
    let refused = error(&drive, TABLE);
    assert!(
        refused.contains("/front/points, header.stamp: expected times (`topics.front.stamps"),
        "{refused}"
    );
    let text = TABLE
        .replace("'radar', ", "'radar', stamps = 'log', ")
        .replace("kind = 'odometry'", "kind = 'odometry', stamps = 'log'")
        .replace("'lidar', ", "'lidar', stamps = 'log', ")
        .replace("'camera', ", "'camera', stamps = 'log', ")
        .replace("kind = 'imu'", "kind = 'imu', stamps = 'log'");
    let (_folder, path) = drive.write();
    let opened = open_file(&path, &text).unwrap();
    assert_eq!(opened.sequence().times.radars[0], [90, 95, 160].map(|ms| T0 + ms * MS));
}

#[test]
fn a_scan_of_other_fields_is_refused_when_it_is_read() {
    let (_folder, path) = Drive { radar_fields: ["vx", "v_x"], ..Drive::default() }.write();
    let drive = open_file(&path, TABLE).unwrap();
    let error = drive.radar_scan(0, 1).unwrap_err().to_string();
    assert!(error.contains("those of the first scan, x, y, z, v_x, vy, found x, y, z, vx"), "{error}");
    assert!(drive.radar_scan(0, 0).is_ok());
}
