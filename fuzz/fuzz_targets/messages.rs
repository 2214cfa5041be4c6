//! Messages of ROS 1 and ROS 2: the first byte says which.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ralf_ros::encoding::Encoding;
use ralf_ros::message::*;
use ralf_ros::point_cloud::PointTable;
use ralf_ros::tf::{Kind, TfTree};

fuzz_target!(|data: &[u8]| {
    let [first, bytes @ ..] = data else { return };
    let encoding = if first & 1 == 0 { Encoding::Ros1 } else { Encoding::Cdr };
    let _ = CameraInfo::from_bytes(encoding, bytes);
    let _ = CompressedImage::from_bytes(encoding, bytes);
    let _ = Image::from_bytes(encoding, bytes);
    let _ = Imu::from_bytes(encoding, bytes);
    let _ = Odometry::from_bytes(encoding, bytes);
    let _ = RadarScan::from_bytes(encoding, bytes);
    let _ = TwistStamped::from_bytes(encoding, bytes);
    if let Ok(cloud) = PointCloud2::from_bytes(encoding, bytes)
        && let Ok(table) = PointTable::new(&cloud)
    {
        table.names().for_each(|name| assert_eq!(table.column(name).map(|column| column.len()), Some(table.len())));
    }
    if let Ok(message) = TfMessage::from_bytes(encoding, bytes) {
        let mut tree = TfTree::default();
        message.transforms.iter().for_each(|transform| drop(tree.add(transform, Kind::Moving)));
        let frames = tree.frames();
        frames.windows(2).for_each(|pair| drop(tree.lookup(pair[0], pair[1], 0)));
    }
});
