//! The values of a point cloud, by the names of its fields.
//!
//! Every value is read where its field says: padding, mixed types, either byte order and fields in any order are all
//! the same.

use crate::message::{Datatype, PointCloud2};
use std::collections::HashSet;
use thiserror::Error;

/// The longest record that is believed; drivers have some 20 to 100 bytes.
const POINT_BYTES: usize = 1 << 16;
/// The most values of a record that are believed; drivers have some 4 to 30.
const MOST_COLUMNS: usize = 1 << 10;

/// Why a cloud has no meaning.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{place}: expected {expected}, found {found}")]
pub struct PointCloudError {
    /// Which part of the message.
    pub place: String,
    /// What the type asks for.
    pub expected: String,
    /// What is there.
    pub found: String,
}

impl PointCloudError {
    fn new(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { place: place.into(), expected: expected.into(), found: found.into() }
    }
}

/// A cloud whose fields and lengths were checked.
#[derive(Debug, Clone)]
pub struct PointTable<'a> {
    cloud: &'a PointCloud2,
    columns: Vec<Column>,
}

/// A value of each record.
#[derive(Debug, Clone)]
struct Column {
    name: String,
    offset: usize,
    datatype: Datatype,
}

impl<'a> PointTable<'a> {
    /// Checks a cloud: names that are unique, values inside their record, records inside the data, no data left over.
    ///
    /// A field of several values becomes as many columns, `name_0`, `name_1` and so on.
    pub fn new(cloud: &'a PointCloud2) -> Result<Self, PointCloudError> {
        check_lengths(cloud)?;
        let mut columns: Vec<Column> = Vec::new();
        let mut names = HashSet::new();
        for field in &cloud.fields {
            let place = || format!("field `{}`", field.name);
            let datatype = Datatype::from_code(field.datatype).ok_or_else(|| {
                PointCloudError::new(place(), "a datatype of 1 to 8", field.datatype.to_string())
            })?;
            let (offset, count) = (field.offset as usize, field.count.max(1) as usize);
            let end = count.checked_mul(datatype.size()).and_then(|size| size.checked_add(offset));
            if end.is_none_or(|end| end > cloud.point_step as usize) {
                let expected = format!("values inside the {} bytes of a record", cloud.point_step);
                let found = format!("{count} of {} bytes at {offset}", datatype.size());
                return Err(PointCloudError::new(place(), expected, found));
            }
            if columns.len().saturating_add(count) > MOST_COLUMNS {
                let expected = format!("at most {MOST_COLUMNS} values per record");
                return Err(PointCloudError::new(
                    place(),
                    expected,
                    format!("{count} more than {}", columns.len()),
                ));
            }
            for value in 0..count {
                let name = if count == 1 { field.name.clone() } else { format!("{}_{value}", field.name) };
                if !names.insert(name.clone()) {
                    // Room between the fields, as PCL tells it.
                    if field.name == "_" {
                        continue;
                    }
                    return Err(PointCloudError::new("fields", "unique names", format!("`{name}` twice")));
                }
                columns.push(Column { name, offset: offset + value * datatype.size(), datatype });
            }
        }
        Ok(Self { cloud, columns })
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.cloud.width as usize * self.cloud.height as usize
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The names of the columns, in the order of the fields.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    /// A column, row by row of the cloud. Integers beyond 2^24 and floats of 8 bytes are rounded to the nearest
    /// float32.
    pub fn column(&self, name: &str) -> Option<Vec<f32>> {
        self.values(name, value)
    }

    /// A column, row by row of the cloud, without rounding.
    pub fn wide_column(&self, name: &str) -> Option<Vec<f64>> {
        self.values(name, wide_value)
    }

    fn values<T>(&self, name: &str, value: fn(Datatype, &[u8]) -> T) -> Option<Vec<T>> {
        let Column { offset, datatype, .. } = *self.columns.iter().find(|column| column.name == name)?;
        let cloud = self.cloud;
        // Billions of rows may hold no point.
        if self.is_empty() {
            return Some(Vec::new());
        }
        let (step, width) = (cloud.point_step as usize, cloud.width as usize);
        let rows = (0..cloud.height as usize).map(|row| row * cloud.row_step as usize);
        let points = rows.flat_map(|row| (0..width).map(move |point| row + point * step + offset));
        let read = |at: usize| {
            let mut first = [0; 8];
            let little = &mut first[..datatype.size()];
            little.copy_from_slice(&cloud.data[at..][..datatype.size()]);
            if cloud.is_bigendian {
                little.reverse();
            }
            value(datatype, little)
        };
        Some(points.map(read).collect())
    }
}

/// Refuses a cloud whose numbers don't describe its data.
fn check_lengths(cloud: &PointCloud2) -> Result<(), PointCloudError> {
    let [height, width, point_step, row_step] =
        [cloud.height, cloud.width, cloud.point_step, cloud.row_step].map(|value| value as usize);
    if point_step > POINT_BYTES {
        let expected = format!("at most {POINT_BYTES} bytes");
        return Err(PointCloudError::new("point_step", expected, point_step.to_string()));
    }
    if height == 0 || width == 0 {
        // Nothing is read, whatever the steps say.
        return Ok(());
    }
    if point_step == 0 {
        return Err(PointCloudError::new("point_step", "at least 1 byte", "0"));
    }
    // Nothing follows a single row: drivers leave its length at 0.
    let is_long_enough = |row: &usize| height == 1 || *row <= row_step;
    let row = width.checked_mul(point_step).filter(is_long_enough).ok_or_else(|| {
        let expected = format!("at least width x point_step = {width} x {point_step}");
        PointCloudError::new("row_step", expected, row_step.to_string())
    })?;
    let row_step = row_step.max(row);
    // The last row may lack its padding.
    let least = (height - 1).checked_mul(row_step).and_then(|rows| rows.checked_add(row));
    let most = height.checked_mul(row_step);
    let found = cloud.data.len();
    if least.is_some_and(|least| least <= found) && most.is_some_and(|most| found <= most) {
        return Ok(());
    }
    let expected = format!("height x row_step = {height} x {row_step} bytes");
    Err(PointCloudError::new("data", expected, found.to_string()))
}

/// From as many little-endian bytes as the type has.
fn value(datatype: Datatype, bytes: &[u8]) -> f32 {
    match (datatype, bytes) {
        (Datatype::Float32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        _ => wide_value(datatype, bytes) as f32,
    }
}

/// The same without rounding.
fn wide_value(datatype: Datatype, bytes: &[u8]) -> f64 {
    match (datatype, bytes) {
        (Datatype::Int8, &[a]) => f64::from(a.cast_signed()),
        (Datatype::Uint8, &[a]) => f64::from(a),
        (Datatype::Int16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
        (Datatype::Uint16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
        (Datatype::Int32, &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
        (Datatype::Uint32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
        (Datatype::Float32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        (Datatype::Float64, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        // The bytes are as many as the type has.
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::PointField;

    /// Two rows of two points: y and x as f64 and i16 out of order, three bytes per value, padding of 0xEE, rows
    /// padded.
    fn cloud(is_bigendian: bool) -> PointCloud2 {
        let number = |value: i16| if is_bigendian { value.to_be_bytes() } else { value.to_le_bytes() };
        let float = |value: f64| if is_bigendian { value.to_be_bytes() } else { value.to_le_bytes() };
        let mut data = Vec::new();
        for row in 0..2i16 {
            for point in 0..2i16 {
                data.extend(number(-300 - 10 * row - point));
                data.extend([0xee; 3]);
                data.extend(float(0.25 + f64::from(10 * row + point)));
                data.extend([1, 2, 0xee]);
            }
            data.extend([0xee; 4]);
        }
        let fields = vec![
            PointField::new("y", 5, Datatype::Float64),
            PointField::new("x", 0, Datatype::Int16),
            PointField { count: 2, ..PointField::new("bits", 13, Datatype::Uint8) },
        ];
        let (height, width, point_step, row_step) = (2, 2, 16, 36);
        PointCloud2 {
            height,
            width,
            fields,
            is_bigendian,
            point_step,
            row_step,
            data,
            ..PointCloud2::default()
        }
    }

    #[test]
    fn room_between_the_fields_may_be_told_more_than_once() {
        let mut padded = cloud(false);
        padded.fields.extend(
            [2, 13].map(|offset| PointField { count: 2, ..PointField::new("_", offset, Datatype::Uint8) }),
        );
        let names = |cloud: &PointCloud2| {
            PointTable::new(cloud).unwrap().names().map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(names(&padded), ["y", "x", "bits_0", "bits_1", "__0", "__1"]);
    }

    #[test]
    fn what_a_small_message_claims_costs_nothing() {
        let empty = PointCloud2 { height: u32::MAX, width: 0, data: vec![], ..cloud(false) };
        let table = PointTable::new(&empty).unwrap();
        assert_eq!((table.len(), table.column("x")), (0, Some(vec![])));
        let field = PointField { count: 1 << 15, ..PointField::new("x", 0, Datatype::Uint8) };
        let wide = PointCloud2 { point_step: 1 << 16, fields: vec![field], ..empty };
        let error = PointTable::new(&wide).unwrap_err();
        assert_eq!(
            error.to_string(),
            "field `x`: expected at most 1024 values per record, found 32768 more than 0"
        );
    }

    #[test]
    fn values_are_read_where_their_fields_say() {
        for is_bigendian in [false, true] {
            let cloud = cloud(is_bigendian);
            let table = PointTable::new(&cloud).unwrap();
            assert_eq!(table.names().collect::<Vec<_>>(), ["y", "x", "bits_0", "bits_1"]);
            assert_eq!((table.len(), table.is_empty()), (4, false));
            assert_eq!(table.column("x").unwrap(), [-300.0, -301.0, -310.0, -311.0]);
            assert_eq!(table.column("y").unwrap(), [0.25, 1.25, 10.25, 11.25]);
            assert_eq!(table.wide_column("y").unwrap(), [0.25, 1.25, 10.25, 11.25]);
            assert_eq!(table.column("bits_1").unwrap(), [2.0; 4]);
            assert_eq!(table.column("z"), None);
        }
    }

    #[test]
    fn every_type() {
        use Datatype::{Float32, Float64, Int8, Int16, Int32, Uint8, Uint16, Uint32};
        for (datatype, little, expected) in [
            (Int8, vec![0xfe], -2.0),
            (Uint8, vec![0xfe], 254.0),
            (Int16, vec![0xfe, 0xff], -2.0),
            (Uint16, vec![1, 2], 513.0),
            (Int32, vec![0xfe, 0xff, 0xff, 0xff], -2.0),
            (Uint32, vec![0, 0, 0, 0x80], 2_147_483_648.0),
            (Float32, vec![0, 0, 0xc0, 0x3f], 1.5),
            (Float64, vec![0, 0, 0, 0, 0, 0, 0xf8, 0x3f], 1.5),
        ] {
            assert_eq!(little.len(), datatype.size());
            assert_eq!(
                (value(datatype, &little), wide_value(datatype, &little)),
                (expected as f32, expected)
            );
            assert_eq!(Datatype::from_code(datatype as u8), Some(datatype));
        }
        assert_eq!((Datatype::from_code(0), Datatype::from_code(9)), (None, None));
    }

    #[test]
    fn clouds_without_points_have_columns_without_values() {
        let empty = PointCloud2 { width: 0, data: Vec::new(), row_step: 0, ..cloud(false) };
        assert_eq!(PointTable::new(&empty).unwrap().column("x"), Some(Vec::new()));
    }

    #[test]
    fn absurd_clouds_are_refused() {
        let error = |change: &dyn Fn(&mut PointCloud2)| {
            let mut cloud = cloud(false);
            change(&mut cloud);
            PointTable::new(&cloud).unwrap_err().to_string()
        };
        assert!(error(&|c| c.point_step = u32::MAX).starts_with("point_step: expected at most 65536 bytes"));
        assert!(error(&|c| c.point_step = 0).contains("at least 1 byte"));
        assert!(
            error(&|c| c.point_step = 19)
                .starts_with("row_step: expected at least width x point_step = 2 x 19")
        );
        assert!(error(&|c| c.row_step = 31).starts_with("row_step"));
        assert!(error(&|c| c.row_step = u32::MAX).starts_with("data"));
        assert!(error(&|c| (c.width, c.height) = (u32::MAX, u32::MAX)).starts_with("row_step"));
        assert!(error(&|c| c.height = u32::MAX).starts_with("data"));
        assert!(
            error(&|c| c.data.truncate(67)).contains("expected height x row_step = 2 x 36 bytes, found 67")
        );
        assert!(error(&|c| c.data.push(0)).contains("found 73"));
        assert!(
            error(&|c| c.fields[0].offset = 9).starts_with("field `y`: expected values inside the 16 bytes")
        );
        assert!(error(&|c| c.fields[2].count = u32::MAX).starts_with("field `bits`"));
        assert!(error(&|c| c.fields[0].offset = u32::MAX).starts_with("field `y`"));
        assert!(error(&|c| c.fields[0].datatype = 11).contains("a datatype of 1 to 8, found 11"));
        assert!(error(&|c| c.fields[1].name = "y".to_owned()).contains("unique names, found `y` twice"));
        assert!(error(&|c| c.fields[1].name = "bits_0".to_owned()).contains("`bits_0` twice"));
    }

    #[test]
    fn a_single_row_needs_no_length() {
        let one = |row_step: u32, bytes: usize| {
            let mut one = PointCloud2 { height: 1, row_step, ..cloud(false) };
            one.data.truncate(bytes);
            PointTable::new(&one).map(|table| table.column("x"))
        };
        let read = Ok(Some(vec![-300.0, -301.0]));
        assert_eq!([one(0, 32), one(2, 32), one(36, 36), one(36, 32)], [(); 4].map(|()| read.clone()));
        let error = one(0, 31).unwrap_err().to_string();
        assert_eq!(error, "data: expected height x row_step = 1 x 32 bytes, found 31");
        assert!(one(0, 33).is_err(), "nothing tells of more");
    }

    #[test]
    fn the_last_row_may_lack_its_padding() {
        let mut cloud = cloud(false);
        cloud.data.truncate(68);
        assert_eq!(PointTable::new(&cloud).unwrap().column("x").unwrap()[3], -311.0);
    }
}
