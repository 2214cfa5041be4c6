//! What one sensor delivers at one moment, in its own frame.

use crate::sensors::{Elevation, Radar};
use crate::space::{Point, Spherical};

/// One scan of one radar: a row per detection, in the order of the file, and none is ever dropped.
#[derive(Debug, Clone)]
pub struct RadarScan {
    /// Time of the scan, ns.
    pub t_ns: i64,
    /// One column per entry of [`Radar::fields`], verbatim.
    pub columns: Vec<Vec<f32>>,
    /// Where each detection lies in the radar's frame, m; not finite where it wasn't measured.
    pub positions: Vec<Point>,
    /// The same as range, azimuth (within half a turn) and elevation. Elevation is 0 where the radar measures none.
    pub spherical: Vec<Spherical>,
}

impl RadarScan {
    /// A scan from its columns, one per field of the radar, all equally long.
    ///
    /// Coordinates come from the fields `x`, `y`, `z` or, without these, `range`, `azimuth`, `elevation` (m, rad); of a
    /// radar without elevation the third is not needed, and ignored. The error says what is wrong with the columns.
    pub fn new(radar: &Radar, t_ns: i64, columns: Vec<Vec<f32>>) -> Result<Self, String> {
        if columns.len() != radar.fields.len() {
            return Err(format!("expected {} columns, found {}", radar.fields.len(), columns.len()));
        }
        let rows = columns.first().map_or(0, Vec::len);
        if let Some(column) = columns.iter().position(|column| column.len() != rows) {
            let (name, found) = (&radar.fields[column], columns[column].len());
            return Err(format!("expected {rows} values of `{name}`, found {found}"));
        }
        let coordinates = Coordinates::for_radar(radar)?;
        let positions: Vec<Point> = (0..rows).map(|row| coordinates.position(&columns, row)).collect();
        let spherical = (0..rows).map(|row| coordinates.spherical(&columns, row, &positions[row])).collect();
        Ok(Self { t_ns, columns, positions, spherical })
    }

    /// How many detections.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether the radar saw nothing.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

/// Which columns hold the place of a detection, and in which kind of coordinates.
#[derive(Debug, Clone, Copy)]
enum Coordinates {
    Cartesian { x: usize, y: usize, z: Option<usize> },
    Spherical { range: usize, azimuth: usize, elevation: Option<usize> },
}

impl Coordinates {
    fn for_radar(radar: &Radar) -> Result<Self, String> {
        let measured = radar.elevation == Elevation::Measured;
        let third = |name: &str| radar.column(name).filter(|_| measured);
        let of_kind = |names: [&str; 3]| {
            let [first, second] = [radar.column(names[0])?, radar.column(names[1])?];
            (third(names[2]).is_some() || !measured).then_some((first, second, third(names[2])))
        };
        if let Some((x, y, z)) = of_kind(["x", "y", "z"]) {
            return Ok(Self::Cartesian { x, y, z });
        }
        let spherical = of_kind(["range", "azimuth", "elevation"]).ok_or_else(|| {
            format!(
                "expected the fields x, y, z or range, azimuth, elevation (the third only where elevation is \
                 measured), found neither in {:?}",
                radar.fields
            )
        });
        spherical.map(|(range, azimuth, elevation)| Self::Spherical { range, azimuth, elevation })
    }

    fn position(self, columns: &[Vec<f32>], row: usize) -> Point {
        let value = |column: usize| f64::from(columns[column][row]);
        match self {
            Self::Cartesian { x, y, z } => Point::new(value(x), value(y), z.map_or(0.0, value)),
            Self::Spherical { range, azimuth, elevation } => {
                let elevation = elevation.map_or(0.0, value);
                Spherical { range: value(range), azimuth: value(azimuth), elevation }.to_cartesian()
            }
        }
    }

    fn spherical(self, columns: &[Vec<f32>], row: usize, position: &Point) -> Spherical {
        let value = |column: usize| f64::from(columns[column][row]);
        match self {
            Self::Cartesian { .. } => Spherical::from_cartesian(position),
            Self::Spherical { range, azimuth, elevation } => {
                let elevation = elevation.map_or(0.0, value);
                Spherical { range: value(range), azimuth: value(azimuth), elevation }.principal(position)
            }
        }
    }
}

/// Checks that a radar's fields name a kind of coordinates, completely. The error says what was expected.
pub fn check_fields(radar: &Radar) -> Result<(), String> {
    Coordinates::for_radar(radar).map(drop)
}

/// A LiDAR's point farther in time from its scan is of another clock or unit, s.
pub const LONGEST_AFTER: f64 = 1.0;

/// One revolution of one LiDAR, motion-corrected to its timestamp, in the LiDAR's frame.
///
/// Motion-corrected means: every point lies where it would have been measured at [`t_ns`](Self::t_ns), had the world
/// stood still since. Where things move that isn't so: a vehicle at 30 m/s has gone on by 1.5 m in half a revolution.
/// [`times`](Self::times) tells when a point was truly measured.
#[derive(Debug, Clone, Default)]
pub struct LidarScan {
    /// Time of the scan, ns.
    pub t_ns: i64,
    /// x, y, z, m. Points that are not finite or exactly the origin are no returns.
    pub points: Vec<[f32; 3]>,
    /// When each point was measured, in seconds after [`t_ns`](Self::t_ns) and negative before it; finite. `None`
    /// where the recording doesn't say.
    pub times: Option<Vec<f32>>,
    /// One per point, in the recording's own unit.
    pub intensity: Vec<f32>,
    /// SemanticKITTI ids, one per point, where the recording carries them; 0 is unlabeled.
    pub classes: Option<Vec<u16>>,
}

/// Whether a LiDAR point is a return: finite, and not the sensor's own origin.
pub fn is_return(point: &[f32; 3]) -> bool {
    point.iter().all(|v| v.is_finite()) && *point != [0.0; 3]
}
