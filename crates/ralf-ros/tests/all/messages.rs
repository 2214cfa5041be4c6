//! What is encoded is decoded as it was, by ROS 1 and by CDR; and what is cut or of another type is refused.

use proptest::prelude::*;
use ralf_ros::encoding::Encoding;
use ralf_ros::message::*;

const ENCODINGS: [Encoding; 2] = [Encoding::Ros1, Encoding::Cdr];

fn header() -> impl Strategy<Value = Header> {
    // Times that both encodings hold.
    (0..i64::from(i32::MAX) * 1_000_000_000, ".{0,9}").prop_map(|(stamp_ns, frame_id)| Header {
        seq: 0,
        stamp_ns,
        frame_id,
    })
}

fn pose() -> impl Strategy<Value = Pose> {
    (any::<[f64; 3]>(), any::<[f64; 4]>()).prop_map(|(position, orientation)| Pose { position, orientation })
}

fn twist() -> impl Strategy<Value = Twist> {
    (any::<[f64; 3]>(), any::<[f64; 3]>()).prop_map(|(linear, angular)| Twist { linear, angular })
}

fn bytes() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..40)
}

fn point_cloud() -> impl Strategy<Value = PointCloud2> {
    let field = (".{0,5}", any::<(u32, u8, u32)>())
        .prop_map(|(name, (offset, datatype, count))| PointField { name, offset, datatype, count });
    let numbers = any::<(u32, u32, u32, u32, bool, bool)>();
    (header(), prop::collection::vec(field, 0..4), numbers, bytes()).prop_map(|(header, fields, n, data)| {
        let (height, width, point_step, row_step, is_bigendian, is_dense) = n;
        PointCloud2 { header, height, width, fields, is_bigendian, point_step, row_step, data, is_dense }
    })
}

fn camera_info() -> impl Strategy<Value = CameraInfo> {
    let roi =
        any::<(u32, u32, u32, u32, bool)>().prop_map(|(x_offset, y_offset, height, width, do_rectify)| {
            RegionOfInterest { x_offset, y_offset, height, width, do_rectify }
        });
    let matrices = (prop::collection::vec(any::<f64>(), 0..6), any::<[f64; 9]>(), any::<[f64; 9]>());
    (header(), any::<(u32, u32, u32, u32)>(), ".{0,9}", matrices, any::<[f64; 12]>(), roi).prop_map(
        |(header, (height, width, binning_x, binning_y), distortion_model, (d, k, r), p, roi)| CameraInfo {
            header,
            height,
            width,
            distortion_model,
            d,
            k,
            r,
            p,
            binning_x,
            binning_y,
            roi,
        },
    )
}

/// The same message again, whichever way it was written; none of its beginnings is a message.
fn holds<M: Message + PartialEq + std::fmt::Debug>(message: &M) -> Result<(), TestCaseError> {
    for encoding in ENCODINGS {
        let bytes = message.to_bytes(encoding).unwrap();
        let read = M::from_bytes(encoding, &bytes).unwrap();
        prop_assert_eq!(&read, message);
        for length in 0..bytes.len() {
            let cut = M::from_bytes(encoding, &bytes[..length]);
            prop_assert!(cut.is_err(), "{length} of {} bytes of {encoding:?}", bytes.len());
        }
        let longer = [bytes.as_slice(), &[0; 8]].concat();
        prop_assert!(M::from_bytes(encoding, &longer).is_err());
    }
    Ok(())
}

/// A list of numbers of four bytes.
fn returns() -> impl Strategy<Value = Vec<RadarReturn>> {
    let detection = any::<[f32; 5]>().prop_map(|[range, azimuth, elevation, doppler_velocity, amplitude]| {
        RadarReturn { range, azimuth, elevation, doppler_velocity, amplitude }
    });
    prop::collection::vec(detection, 0..5)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn point_clouds(message in point_cloud()) {
        holds(&message)?;
    }

    #[test]
    fn radar_scans(header in header(), returns in returns()) {
        holds(&RadarScan { header, returns })?;
    }

    #[test]
    fn images(header in header(), encoding in ".{0,9}", [height, width, step] in any::<[u32; 3]>(), data in bytes()) {
        holds(&CompressedImage { header: header.clone(), format: encoding.clone(), data: data.clone() })?;
        holds(&Image { header, height, width, encoding, is_bigendian: height % 2 == 0, step, data })?;
    }

    #[test]
    fn camera_infos(message in camera_info()) {
        holds(&message)?;
    }

    #[test]
    fn motion(header in header(), pose in pose(), twist in twist(), covariance in any::<f64>()) {
        holds(&TwistStamped { header: header.clone(), twist })?;
        holds(&Imu {
            header: header.clone(),
            orientation: pose.orientation,
            orientation_covariance: [covariance; 9],
            angular_velocity: twist.angular,
            angular_velocity_covariance: [covariance; 9],
            linear_acceleration: twist.linear,
            linear_acceleration_covariance: [covariance; 9],
        })?;
        let transform =
            TransformStamped { header: header.clone(), child_frame_id: "laser".to_owned(), transform: pose };
        holds(&TfMessage { transforms: vec![transform.clone(), transform] })?;
        let child_frame_id = "base_link".to_owned();
        let covariances = [covariance; 36];
        let (pose_covariance, twist_covariance) = (covariances, covariances);
        holds(&Odometry { header, child_frame_id, pose, pose_covariance, twist, twist_covariance })?;
    }
}

#[test]
fn a_header_is_read_without_the_rest() {
    let header = Header { seq: 7, stamp_ns: 1_500_000_000, frame_id: "radar".to_owned() };
    let cloud = PointCloud2 { header: header.clone(), ..PointCloud2::default() };
    for encoding in ENCODINGS {
        let bytes = cloud.to_bytes(encoding).unwrap();
        let seq = if encoding == Encoding::Ros1 { 7 } else { 0 };
        assert_eq!(peek_header(encoding, &bytes[..30]), Ok(Header { seq, ..header.clone() }));
    }
}

#[test]
fn times_that_an_encoding_lacks_are_refused() {
    let before_1970 = Header { stamp_ns: -1, ..Header::default() };
    assert!(before_1970.to_bytes(Encoding::Ros1).unwrap_err().to_string().contains("0 to 2^32 - 1 s"));
    let bytes = before_1970.to_bytes(Encoding::Cdr).unwrap();
    assert_eq!(bytes[4..12], [0xff, 0xff, 0xff, 0xff, 0xff, 0xc9, 0x9a, 0x3b], "-1 s and 999,999,999 ns");
    assert_eq!(Header::from_bytes(Encoding::Cdr, &bytes), Ok(before_1970));
}
