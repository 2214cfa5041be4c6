//! Scans as `sensor_msgs/PointCloud2`.

use crate::write::export::columns::{Column, Values};
use ralf::sensors::{LidarScan, Radar, RadarScan};
use ralf_ros::message::{Datatype, Header, PointCloud2, PointField};

/// A cloud with a field for each column.
pub(super) fn of_columns(header: Header, columns: &[Column]) -> PointCloud2 {
    let points = columns.first().map_or(0, |column| column.values.len());
    let mut fields = Vec::with_capacity(columns.len());
    let mut offset = 0;
    for Column { name, values } in columns {
        fields.push(PointField::new(name, offset as u32, datatype(values)));
        offset += values.size();
    }
    // Records begin aligned, whatever the last field is.
    let point_step = offset.next_multiple_of(4);
    let mut data = Vec::with_capacity(points * point_step);
    for row in 0..points {
        columns.iter().for_each(|column| column.values.append_bytes(row, &mut data));
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

/// A radar's scan with its fields as they are.
pub(super) fn of_radar(header: Header, radar: &Radar, scan: RadarScan) -> PointCloud2 {
    let column = |(name, values): (&String, _)| Column { name: name.clone(), values: Values::F32(values) };
    let columns: Vec<Column> = radar.fields.iter().zip(scan.columns).map(column).collect();
    of_columns(header, &columns)
}

/// A LiDAR's scan: x, y, z, intensity.
pub(super) fn of_lidar(header: Header, scan: LidarScan) -> PointCloud2 {
    let axis = |axis: usize| Values::F32(scan.points.iter().map(|point| point[axis]).collect());
    let values = [axis(0), axis(1), axis(2), Values::F32(scan.intensity)];
    let names = ["x", "y", "z", "intensity"].map(str::to_owned);
    let columns: Vec<Column> =
        names.into_iter().zip(values).map(|(name, values)| Column { name, values }).collect();
    of_columns(header, &columns)
}

/// Of a field. Clouds have no times and no truth values; these would be their bytes.
fn datatype(values: &Values) -> Datatype {
    match values {
        Values::F32(_) => Datatype::Float32,
        Values::U16(_) => Datatype::Uint16,
        Values::U32(_) => Datatype::Uint32,
        Values::I64(_) => Datatype::Float64,
        Values::Truth(_) => Datatype::Int8,
    }
}
