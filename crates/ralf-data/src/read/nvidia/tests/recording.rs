//! Clips as the data set's tables have them.

use parquet::basic::{Compression, LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

pub(crate) const CLIP: &str = "0a1b2c3d-0000-4000-8000-00000000002a";
pub(crate) const FRONT: &str = "radar_front_center_imaging_lrr_1";
pub(crate) const REAR: &str = "radar_rear_left_srr_0";

/// The values of a column, in the type in which they are stored; `Optional` may be absent.
#[derive(Debug, Clone)]
pub(crate) enum Values {
    Byte(Vec<u8>),
    Long(Vec<i64>),
    Time(TimeUnit, Vec<i64>),
    Float(Vec<f32>),
    Double(Vec<f64>),
    Optional(Vec<Option<f64>>),
    Text(Vec<String>),
}

/// Columns by name.
pub(crate) type Columns = Vec<(&'static str, Values)>;

/// Three scans of a radar, the last of which has one detection; the first two rows are of one scan.
pub(crate) fn radar(elevations: bool) -> Columns {
    let scans = [7, 7, 8, 8, 8, 9];
    let time = |scan: &i64| -50_000 + 50_000 * (scan - 7);
    let per_row =
        |value: &dyn Fn(usize) -> f64| (0..scans.len()).map(value).map(|v| v as f32).collect::<Vec<f32>>();
    vec![
        ("scan_index", Values::Long(scans.to_vec())),
        ("timestamp", Values::Long(scans.iter().map(time).collect())),
        ("sensor_timestamp", Values::Long(scans.iter().map(|scan| 900_000 + time(scan)).collect())),
        ("num_returns", Values::Long(vec![2, 2, 3, 3, 3, 1])),
        ("doppler_ambiguity", Values::Float(vec![62.5; 6])),
        ("max_returns", Values::Optional(vec![None; 6])),
        ("detection_index", Values::Long(vec![0, 1, 0, 1, 2, 0])),
        ("radar_model", Values::Byte(vec![1; 6])),
        ("azimuth", Values::Float(per_row(&|row| 0.1 * row as f64 - 0.2))),
        ("elevation", Values::Float(per_row(&|row| if elevations { 0.01 * row as f64 } else { 0.0 }))),
        ("distance", Values::Float(vec![20.0, 21.5, 20.0, 21.0, 0.0, 19.5])),
        ("radial_velocity", Values::Float(vec![-9.5, 0.25, -9.5, 0.5, 0.0, -9.25])),
        ("rcs", Values::Float(vec![-3.0; 6])),
        ("snr", Values::Float(vec![14.5; 6])),
        ("exist_probb", Values::Byte(vec![100, 200, 99, 50, 0, 75])),
    ]
}

/// 10 m/s ahead, every 10 ms, from before the first scan.
pub(crate) fn egomotion() -> Columns {
    let times: Vec<i64> = (-20..10).map(|n| 10_000 * n).collect();
    let rows = times.len();
    let zeros = || Values::Double(vec![0.0; rows]);
    let x = Values::Double(times.iter().map(|t| *t as f64 * 1e-5).collect());
    vec![
        ("timestamp", Values::Long(times)),
        ("qx", zeros()),
        ("qy", zeros()),
        ("qz", zeros()),
        ("qw", Values::Double(vec![1.0; rows])),
        ("x", x),
        ("y", zeros()),
        ("z", zeros()),
        ("vx", Values::Double(vec![10.0; rows])),
        ("curvature", zeros()),
    ]
}

/// The mountings of two radars of this clip: one looks ahead, the other back.
pub(crate) fn extrinsics(clip: &str) -> Columns {
    let two = |a: f64, b: f64| Values::Double(vec![a, b]);
    vec![
        ("clip_id", Values::Text(vec![clip.to_owned(); 2])),
        ("sensor_name", Values::Text(vec![FRONT.to_owned(), REAR.to_owned()])),
        ("qx", two(0.0, 0.0)),
        ("qy", two(0.0, 0.0)),
        ("qz", two(0.0, 1.0)),
        ("qw", two(1.0, 0.0)),
        ("x", two(3.9, -0.8)),
        ("y", two(0.0, 0.6)),
        ("z", two(0.5, 0.7)),
    ]
}

/// Writes a clip where the data set's zip files would leave it.
pub(crate) fn write_unzipped(folder: &Path) {
    for (sensor, elevations) in [(FRONT, true), (REAR, false)] {
        write(&folder.join(format!("radar/{sensor}/{CLIP}.{sensor}.parquet")), &radar(elevations));
    }
    write(&folder.join(format!("labels/egomotion/{CLIP}.egomotion.parquet")), &egomotion());
    let chunk = "calibration/sensor_extrinsics/sensor_extrinsics.chunk_0000.parquet";
    write(&folder.join(chunk), &extrinsics(CLIP));
}

/// Writes a clip in a folder of its own.
pub(crate) fn write_clip(folder: &Path) {
    let of = |folder_name: &str, name: &str| {
        folder.join(CLIP).join(folder_name).join(format!("{CLIP}.{name}.parquet"))
    };
    write(&of("radar", FRONT), &radar(true));
    write(&of("radar", REAR), &radar(false));
    write(&of("labels", "egomotion"), &egomotion());
    let mut own = extrinsics(CLIP);
    own.remove(0);
    write(&of("calibration", "sensor_extrinsics"), &own);
}

/// Writes a clip as NVIDIA's own `pai-clip-dl` does: mountings aren't named after it, but name it.
pub(crate) fn write_downloaded(folder: &Path) {
    write_clip(folder);
    let calibration = folder.join(CLIP).join("calibration");
    fs::remove_dir_all(&calibration).unwrap();
    write(&calibration.join("sensor_extrinsics.parquet"), &extrinsics(CLIP));
}

/// Writes a table, its rows in one group.
pub(crate) fn write(file: &Path, columns: &Columns) {
    write_compressed(file, columns, Compression::UNCOMPRESSED);
}

/// The same, compressed.
pub(crate) fn write_compressed(file: &Path, columns: &Columns, compression: Compression) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    let fields = columns.iter().map(|(name, values)| Arc::new(field(name, values))).collect();
    let schema = Type::group_type_builder("schema").with_fields(fields).build().unwrap();
    let properties = Arc::new(WriterProperties::builder().set_compression(compression).build());
    let mut writer =
        SerializedFileWriter::new(File::create(file).unwrap(), Arc::new(schema), properties).unwrap();
    let mut group = writer.next_row_group().unwrap();
    columns.iter().for_each(|(_, values)| write_column(&mut group, values));
    group.close().unwrap();
    writer.close().unwrap();
}

fn field(name: &str, values: &Values) -> Type {
    let (physical, logical, repetition) = match values {
        Values::Byte(_) => (Physical::INT32, Some(LogicalType::integer(8, false)), Repetition::OPTIONAL),
        Values::Long(_) => (Physical::INT64, None, Repetition::OPTIONAL),
        Values::Time(unit, _) => {
            (Physical::INT64, Some(LogicalType::timestamp(false, *unit)), Repetition::OPTIONAL)
        }
        Values::Float(_) => (Physical::FLOAT, None, Repetition::OPTIONAL),
        Values::Double(_) => (Physical::DOUBLE, None, Repetition::REQUIRED),
        Values::Optional(_) => (Physical::DOUBLE, None, Repetition::OPTIONAL),
        Values::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::OPTIONAL),
    };
    Type::primitive_type_builder(name, physical)
        .with_logical_type(logical)
        .with_repetition(repetition)
        .build()
        .unwrap()
}

fn write_column(group: &mut SerializedRowGroupWriter<File>, values: &Values) {
    let mut column = group.next_column().unwrap().unwrap();
    let there = |rows: usize| Some(vec![1; rows]);
    match values {
        Values::Byte(values) => {
            let wide: Vec<i32> = values.iter().map(|value| i32::from(*value)).collect();
            column.typed::<Int32Type>().write_batch(&wide, there(wide.len()).as_deref(), None)
        }
        Values::Long(values) | Values::Time(_, values) => {
            column.typed::<Int64Type>().write_batch(values, there(values.len()).as_deref(), None)
        }
        Values::Float(values) => {
            column.typed::<FloatType>().write_batch(values, there(values.len()).as_deref(), None)
        }
        Values::Double(values) => column.typed::<DoubleType>().write_batch(values, None, None),
        Values::Optional(values) => {
            let present: Vec<f64> = values.iter().copied().flatten().collect();
            let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            column.typed::<DoubleType>().write_batch(&present, Some(&levels), None)
        }
        Values::Text(values) => {
            let texts: Vec<ByteArray> = values.iter().map(|text| text.as_str().into()).collect();
            column.typed::<ByteArrayType>().write_batch(&texts, there(texts.len()).as_deref(), None)
        }
    }
    .unwrap();
    column.close().unwrap();
}
