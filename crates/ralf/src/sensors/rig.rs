//! The sensors of a vehicle and how they are mounted.

use super::camera::Camera;
use crate::space::{Point, Spherical, Transform};

/// All sensors of a recording. A sensor is named by its index in these lists.
#[derive(Debug, Clone, Default)]
pub struct Rig {
    /// In the order of the output.
    pub radars: Vec<Radar>,
    /// None, one or several.
    pub lidars: Vec<Lidar>,
    /// None, one or several.
    pub cameras: Vec<Camera>,
}

/// Whether a radar measures the elevation of a detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elevation {
    /// Range, azimuth and elevation.
    Measured,
    /// Range and azimuth only: the search and `h` are horizontal (docs/method.md, section 3).
    None,
}

/// A radar: its mounting, its measurement uncertainties, its prior reliability.
#[derive(Debug, Clone)]
pub struct Radar {
    /// Unique in its rig.
    pub name: String,
    /// Names of the columns of a scan, as they lie in the file.
    pub fields: Vec<String>,
    /// Extrinsics.
    pub vehicle_from_radar: Transform,
    /// Whether theta is measured.
    pub elevation: Elevation,
    /// Full horizontal field of view, rad.
    pub fov_azimuth: f64,
    /// Full vertical field of view, rad.
    pub fov_elevation: f64,
    /// `s_r`, m.
    pub sigma_range: f64,
    /// `s_phi`, rad.
    pub sigma_azimuth: f64,
    /// `s_theta`, rad; unused where elevation isn't measured.
    pub sigma_elevation: f64,
    /// `gamma_s(phi)`.
    pub reliability: Reliability,
}

/// `gamma_s(phi) >= 1`: what the sensor's mounting does to its plausibility (docs/method.md, section 8).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reliability {
    /// Azimuth (rad, ascending) and value.
    table: Vec<(f64, f64)>,
}

impl Reliability {
    /// A table of (azimuth in rad, value). Refused, with the reason, unless azimuths ascend and values are at least 1.
    pub fn new(table: Vec<(f64, f64)>) -> Result<Self, String> {
        if let Some((azimuth, value)) =
            table.iter().find(|(a, v)| !a.is_finite() || !v.is_finite() || *v < 1.0)
        {
            let azimuth = azimuth.to_degrees();
            return Err(format!("values of at least 1, found {value} at {azimuth} deg"));
        }
        if let Some(pair) = table.windows(2).find(|pair| pair[0].0 >= pair[1].0) {
            let [before, after] = [pair[0].0.to_degrees(), pair[1].0.to_degrees()];
            return Err(format!("ascending azimuths, found {after} deg after {before} deg"));
        }
        Ok(Self { table })
    }

    /// Azimuths (rad) and values, ascending.
    pub fn table(&self) -> &[(f64, f64)] {
        &self.table
    }

    /// `gamma_s` at an azimuth (rad): linear between the table's rows, held at its ends, 1 without a table.
    pub fn at(&self, azimuth: f64) -> f64 {
        let above = self.table.partition_point(|(a, _)| *a <= azimuth);
        match (above.checked_sub(1).map(|below| self.table[below]), self.table.get(above)) {
            (Some((a0, v0)), Some((a1, v1))) => v0 + (v1 - v0) * (azimuth - a0) / (a1 - a0),
            (Some((_, value)), None) => value,
            (None, Some((_, value))) => *value,
            (None, None) => 1.0,
        }
    }
}

/// A LiDAR: its mounting and its range uncertainty.
#[derive(Debug, Clone)]
pub struct Lidar {
    /// Unique in its rig.
    pub name: String,
    /// Extrinsics.
    pub vehicle_from_lidar: Transform,
    /// `s_r,lidar`, m.
    pub sigma_range: f64,
    /// `alpha_l`: depression of the lowest beam, rad, > 0.
    pub lowest_beam: f64,
    /// Farthest return, m, where it is known.
    pub max_range: Option<f64>,
}

impl Rig {
    /// The names of all sensors: radars, LiDARs, cameras.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let radars = self.radars.iter().map(|radar| radar.name.as_str());
        let lidars = self.lidars.iter().map(|lidar| lidar.name.as_str());
        radars.chain(lidars).chain(self.cameras.iter().map(|camera| camera.name.as_str()))
    }
}

/// Names of fields that give a detection's place, in either of two kinds.
pub const COORDINATE_FIELDS: [&str; 6] = ["x", "y", "z", "range", "azimuth", "elevation"];

impl Radar {
    /// The fields that are not coordinates: index of the column, and name.
    pub fn further_fields(&self) -> impl Iterator<Item = (usize, &str)> {
        let names = self.fields.iter().map(String::as_str).enumerate();
        names.filter(|(_, name)| !COORDINATE_FIELDS.contains(name))
    }

    /// The column of a range, azimuth or elevation that was measured and gives no place, for x, y and z do.
    pub fn told_beside_place(&self, field: &str) -> Option<usize> {
        let is_told = match field {
            "range" | "azimuth" => true,
            "elevation" => self.elevation == Elevation::Measured,
            _ => false,
        };
        let measured = self.elevation == Elevation::Measured;
        let mut place = ["x", "y", "z"].into_iter().filter(|name| measured || *name != "z");
        let is_placed = place.all(|name| self.column(name).is_some());
        if is_told && is_placed { self.column(field) } else { None }
    }

    /// The column of a field.
    pub fn column(&self, field: &str) -> Option<usize> {
        self.fields.iter().position(|name| name == field)
    }

    /// Whether a point (radar frame) lies within half the vertical field of view above and below the radar's horizon.
    pub fn sees_height_of(&self, p: &Point) -> bool {
        Spherical::from_cartesian(p).elevation.abs() <= self.fov_elevation / 2.0
    }

    /// [`Self::sees_height_of`], for many points: the exact angle is asked only near the border.
    pub fn sees_heights_of(&self) -> impl Fn(&Point) -> bool {
        /// More than angles and sines are rounded by, as a share; steeper than this, rad, they don't tell each other.
        const BORDER: f64 = 1e-9;
        const STEEP: f64 = 1.5;
        let half = self.fov_elevation / 2.0;
        let sine = if half < STEEP { half.sin() } else { f64::NAN };
        move |p| {
            let (height, limit) = (p.z.abs(), sine * p.coords.norm());
            let (inside, outside) = (height < limit * (1.0 - BORDER), height > limit * (1.0 + BORDER));
            if inside | outside { inside } else { self.sees_height_of(p) }
        }
    }

    /// Refuses, with what was expected and found, values that no radar has.
    pub fn check(&self) -> Result<(), String> {
        let measured = self.elevation == Elevation::Measured;
        at_least_zero("sigma_range_m", self.sigma_range)?;
        at_least_zero("sigma_azimuth_deg", self.sigma_azimuth.to_degrees())?;
        at_least_zero("sigma_elevation_deg", if measured { self.sigma_elevation.to_degrees() } else { 0.0 })?;
        angle("fov_azimuth_deg", self.fov_azimuth, 360.0)?;
        angle("fov_elevation_deg", self.fov_elevation, 180.0)
    }
}

impl Lidar {
    /// Refuses, with what was expected and found, values that no LiDAR has.
    pub fn check(&self) -> Result<(), String> {
        at_least_zero("sigma_range_m", self.sigma_range)?;
        if let Some(range) = self.max_range.filter(|range| !(range.is_finite() && *range > 0.0)) {
            return Err(format!("`max_range_m` above 0, found {range}"));
        }
        angle("lowest_beam_deg", self.lowest_beam, 90.0)
    }
}

fn at_least_zero(key: &str, value: f64) -> Result<(), String> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(format!("`{key}` of at least 0, found {value}"))
}

fn angle(key: &str, radians: f64, limit: f64) -> Result<(), String> {
    let degrees = radians.to_degrees();
    // Room for the rounding of the conversion.
    if degrees > 0.0 && degrees <= limit * (1.0 + 1e-12) {
        return Ok(());
    }
    Err(format!("`{key}` above 0 and up to {limit}, found {degrees}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::Elevation;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn many_heights_are_seen_as_one_is(
            half in 0.001f64..1.57, [x, y, z] in prop::array::uniform3(-40.0f64..40.0), ulps in -3i64..4,
        ) {
            let radar = Radar {
                name: "radar".into(),
                fields: vec![],
                vehicle_from_radar: Transform::identity(),
                elevation: Elevation::None,
                fov_azimuth: 2.0,
                fov_elevation: 2.0 * half,
                sigma_range: 0.1,
                sigma_azimuth: 0.01,
                sigma_elevation: 0.0,
                reliability: Reliability::default(),
            };
            let border = half.tan() * x.hypot(y);
            let border = f64::from_bits((border.to_bits() as i64 + ulps) as u64);
            for z in [z, border, -border, 0.0, f64::NAN, f64::INFINITY] {
                let p = Point::new(x, y, z);
                prop_assert_eq!(radar.sees_heights_of()(&p), radar.sees_height_of(&p));
            }
        }
    }

    #[test]
    fn reliability_is_linear_between_its_rows_and_held_at_its_ends() {
        let table = Reliability::new(vec![(-1.0, 2.0), (0.0, 1.0), (1.0, 3.0)]).unwrap();
        for (azimuth, expected) in
            [(-2.0, 2.0), (-1.0, 2.0), (-0.5, 1.5), (0.0, 1.0), (0.25, 1.5), (1.0, 3.0), (9.0, 3.0)]
        {
            assert_eq!(table.at(azimuth), expected, "at {azimuth}");
        }
        assert_eq!(Reliability::default().at(0.3), 1.0);
    }

    #[test]
    fn a_table_that_descends_or_favours_is_refused() {
        assert!(Reliability::new(vec![(0.0, 1.0), (0.0, 1.5)]).unwrap_err().contains("ascending"));
        assert!(Reliability::new(vec![(0.0, 0.9)]).unwrap_err().contains("at least 1"));
        assert!(Reliability::new(vec![(0.0, f64::NAN)]).is_err());
    }
}
