//! Radar and LiDAR scans from messages, by the names of their fields.

use super::messages::Messages;
use super::point_clock::{PointClock, Told};
use crate::error::DataError;
use crate::read::radial::{radial, radial_3d};
use ralf::scene::Doppler;
use ralf::sensors::{Elevation, LidarScan};
use ralf_ros::container::MessageRef;
use ralf_ros::message::{Message, PointCloud2, RadarReturn, RadarScan};
use ralf_ros::point_cloud::{PointCloudError, PointTable};

/// Columns of equal length, with their names.
pub(super) struct Columns {
    pub(super) names: Vec<String>,
    pub(super) values: Vec<Vec<f32>>,
    /// How long they are; there may be none of them.
    pub(super) rows: usize,
}

/// A range rate that is derived, and the components of the velocity that it derives from.
type Derived = (&'static str, [&'static str; 3]);

/// What is derived where a cloud has the first two components of a velocity and no range rate of this name.
const DERIVED: [Derived; 2] =
    [("doppler", ["vx", "vy", "vz"]), ("doppler_compensated", ["vx_comp", "vy_comp", "vz_comp"])];

/// The range rates that derive from fields of these names.
fn derived(names: &[String]) -> Vec<Derived> {
    let has = |name: &str| names.iter().any(|known| known == name);
    let is_derived = |(name, [vx, vy, _]): &Derived| !has(name) && ["x", "y", vx, vy].into_iter().all(has);
    DERIVED.into_iter().filter(is_derived).collect()
}

/// Whether range rates are derived from a radar's fields, if nobody says otherwise.
pub(crate) fn derives_doppler(fields: &[String]) -> bool {
    !derived(fields).is_empty()
}

/// A radar's fields with the range rates that derive from them.
pub(super) fn with_derived(fields: &[String]) -> Vec<String> {
    let rates = derived(fields).into_iter().map(|(name, _)| name.to_owned());
    fields.iter().cloned().chain(rates).collect()
}

/// Every field of a radar's scan under its own name, as `doppler` the field `rate`, too, and those range rates that
/// derive from them and are wanted: in space where the radar measures elevation, else in its plane.
pub(super) fn radar_columns(
    messages: &Messages,
    message: &MessageRef,
    elevation: Elevation,
    rate: Option<&str>,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Columns, DataError> {
    if RadarScan::DEFINITION.is(&messages.topic(message).type_name) {
        return Ok(scan_columns(&messages.decode(message)?));
    }
    let cloud: PointCloud2 = messages.decode(message)?;
    let table = table(messages, message, &cloud)?;
    let names: Vec<String> = table.names().map(str::to_owned).collect();
    let values = names.iter().filter_map(|name| table.column(name)).collect();
    let mut columns = Columns { names, values, rows: table.len() };
    if let Some(told) = rate.and_then(|rate| columns.get(rate)).map(<[f32]>::to_vec) {
        columns.add(Doppler::RAW, told);
    }
    for (name, velocity) in derived(&columns.names).into_iter().filter(|(name, _)| is_wanted(name)) {
        if let Some(derived) = columns.along_rays(velocity, elevation) {
            columns.add(name, derived);
        }
    }
    Ok(columns)
}

/// A LiDAR's scan: x, y, z, the intensity where there is one, and the points' times if a field tells them.
pub(super) fn lidar_scan(
    messages: &Messages,
    message: &MessageRef,
    t_ns: i64,
    clock: Option<&PointClock>,
) -> Result<LidarScan, DataError> {
    let cloud: PointCloud2 = messages.decode(message)?;
    let table = table(messages, message, &cloud)?;
    if table.is_empty() {
        // Some drivers leave the fields out then.
        let times = clock.map(|_| Vec::new());
        return Ok(LidarScan { t_ns, points: Vec::new(), times, intensity: Vec::new(), classes: None });
    }
    let column = |name: &str| {
        table.column(name).ok_or_else(|| {
            let found = table.names().collect::<Vec<_>>().join(", ");
            messages.error(message, "fields", format!("a field `{name}`"), found)
        })
    };
    let points = points([column("x")?, column("y")?, column("z")?]);
    let intensity = table.column("intensity").unwrap_or_else(|| vec![0.0; points.len()]);
    let wrong = |(n, expected, found): (usize, String, String)| {
        messages.error(message, &format!("point {n}, times"), expected, found)
    };
    let times = clock.map(|clock| clock.times(&table, &points, t_ns).map_err(wrong)).transpose()?;
    Ok(LidarScan { t_ns, points, times, intensity, classes: None })
}

/// What one scan of a LiDAR says of how its points tell their times.
pub(super) fn point_clock(messages: &Messages, message: &MessageRef, t_ns: i64) -> Result<Told, DataError> {
    let cloud: PointCloud2 = messages.decode(message)?;
    let table = table(messages, message, &cloud)?;
    let places = ["x", "y", "z"].map(|name| table.column(name).unwrap_or_default());
    Ok(PointClock::find(&table, &points(places), t_ns))
}

fn points([x, y, z]: [Vec<f32>; 3]) -> Vec<[f32; 3]> {
    x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect()
}

impl Columns {
    fn add(&mut self, name: &str, values: Vec<f32>) {
        self.names.push(name.to_owned());
        self.values.push(values);
    }

    fn get(&self, name: &str) -> Option<&[f32]> {
        let place = self.names.iter().position(|known| known == name)?;
        self.values.get(place).map(Vec::as_slice)
    }

    /// The part of a velocity along each ray. Without its third component nothing is known but what lies in the plane:
    /// drivers that don't know it leave it out, at NaN or, in the whole scan, at 0.
    fn along_rays(&self, [vx, vy, vz]: [&str; 3], elevation: Elevation) -> Option<Vec<f32>> {
        let [x, y, vx, vy] = [self.get("x")?, self.get("y")?, self.get(vx)?, self.get(vy)?];
        let in_plane = radial(x, y, vx, vy);
        let (Elevation::Measured, Some(z), Some(vz)) = (elevation, self.get("z"), self.get(vz)) else {
            return Some(in_plane);
        };
        if vz.iter().all(|vz| *vz == 0.0 || !vz.is_finite()) {
            return Some(in_plane);
        }
        let in_space = radial_3d([x, y, z], [vx, vy, vz]);
        let known = |((vz, space), plane): ((&f32, f32), f32)| if vz.is_finite() { space } else { plane };
        Some(vz.iter().zip(in_space).zip(in_plane).map(known).collect())
    }
}

/// `doppler_velocity` is what is called `doppler` here.
fn scan_columns(scan: &RadarScan) -> Columns {
    let names = RadarReturn::FIELDS.map(|name| if name == "doppler_velocity" { "doppler" } else { name });
    let column = |field: usize| scan.returns.iter().map(|detection| detection.values()[field]).collect();
    let values = (0..names.len()).map(column).collect();
    Columns { names: names.map(str::to_owned).into(), values, rows: scan.returns.len() }
}

pub(super) fn table<'a>(
    messages: &Messages,
    message: &MessageRef,
    cloud: &'a PointCloud2,
) -> Result<PointTable<'a>, DataError> {
    PointTable::new(cloud).map_err(|PointCloudError { place, expected, found }| {
        messages.error(message, &place, expected, found)
    })
}
