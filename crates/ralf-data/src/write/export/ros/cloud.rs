//! Scans as `sensor_msgs/PointCloud2`.

use crate::error::DataError;
use crate::result::{Kind, Table};
use crate::write::export::bytes;
use crate::write::export::columns::decimals;
use ralf::sensors::{LidarScan, Radar};
use ralf_ros::message::{Datatype, Header, PointCloud2, PointField};

/// A cloud with a field for each column.
pub(super) fn of_columns(header: Header, table: &Table) -> PointCloud2 {
    let points = table.len();
    let columns = table.schema().columns();
    let mut fields = Vec::with_capacity(columns.len());
    let mut offset = 0;
    for column in columns {
        fields.push(PointField::new(&column.name, offset as u32, datatype(column.kind)));
        offset += bytes::size(column.kind);
    }
    // Records begin aligned, whatever the last field is.
    let point_step = offset.next_multiple_of(4);
    let mut data = Vec::with_capacity(points * point_step);
    for row in 0..points {
        table.columns().for_each(|(_, values)| bytes::append(values, row, &mut data));
        data.resize((row + 1) * point_step, 0);
    }
    PointCloud2 {
        header,
        height: 1,
        width: points as u32,
        fields,
        is_bigendian: false,
        point_step: point_step as u32,
        row_step: data.len() as u32,
        data,
        // Places, plausibilities and the radar's own values may all be NaN.
        is_dense: false,
    }
}

/// A radar's scan, or part of one, with the columns of its fields as they are.
pub(super) fn of_radar(
    header: Header,
    radar: &Radar,
    columns: Vec<Vec<f32>>,
) -> Result<PointCloud2, DataError> {
    let columns = radar.fields.iter().map(String::as_str).zip(columns);
    Ok(of_columns(header, &decimals(columns)?))
}

/// A LiDAR's scan: x, y, z, intensity.
pub(super) fn of_lidar(header: Header, scan: LidarScan) -> Result<PointCloud2, DataError> {
    let axis = |axis: usize| scan.points.iter().map(|point| point[axis]).collect();
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    let columns = [("x", x), ("y", y), ("z", z), ("intensity", scan.intensity)];
    Ok(of_columns(header, &decimals(columns.into_iter())?))
}

/// Clouds have no texts, times and truth values; these would be their bytes.
fn datatype(kind: Kind) -> Datatype {
    match kind {
        Kind::F32 => Datatype::Float32,
        Kind::U16 | Kind::Class => Datatype::Uint16,
        Kind::U32 => Datatype::Uint32,
        Kind::I64 => Datatype::Float64,
        Kind::U8 | Kind::Text => Datatype::Uint8,
        Kind::Truth => Datatype::Int8,
    }
}
