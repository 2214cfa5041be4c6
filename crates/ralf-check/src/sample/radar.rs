//! What is kept of a radar's scan.

use super::digest;
use crate::velocity_fit::{TRUSTED, Told, VelocityFit, fit, told};
use ralf::scene::Doppler;
use ralf::sensors::{Elevation, Radar, RadarScan, Source, SourceError};
use ralf::space::{Point, Vector};

/// A radar's scan.
#[derive(Debug, Clone)]
pub(crate) struct RadarLook {
    /// Number in its timeline.
    pub(crate) scan: usize,
    pub(crate) t_ns: i64,
    /// Detections with finite coordinates, radar frame, m.
    pub(crate) positions: Vec<Point>,
    /// Those that stand still by the scan's own range rates; all where these tell no velocity to be trusted.
    pub(crate) standing: Vec<Point>,
    /// The radar's own velocity by the range rates.
    pub(crate) fit: Option<VelocityFit>,
    /// The same by range rates that are said to be without the vehicle's motion: none, where they are.
    pub(crate) compensated: Option<VelocityFit>,
    /// Unit directions of detections with a finite range rate, radar frame.
    pub(crate) rays: Vec<Vector>,
    /// Their raw range rates, m/s.
    pub(crate) range_rates: Vec<f64>,
    /// Ranges, azimuths and elevations as measured, m and rad.
    pub(crate) spherical: Vec<[f64; 3]>,
    /// The same as the radar's own fields tell them, in whatever unit.
    pub(crate) told: Vec<[f64; 3]>,
    /// Rows of the scan, and those among them without finite coordinates.
    pub(crate) rows: usize,
    pub(crate) not_finite: usize,
    /// Of each column, how many values are finite.
    pub(crate) numbers: Vec<usize>,
    /// Of all columns: the same scan again has the same.
    pub(crate) digest: u64,
}

impl RadarLook {
    pub(crate) fn read(source: &dyn Source, radar: usize, scan: usize) -> Result<Self, SourceError> {
        let read = source.radar_scan(radar, scan)?;
        Ok(Self::of(&source.sequence().rig.radars[radar], scan, &read))
    }

    /// The same scan where what stands still is read as lying elsewhere.
    pub(crate) fn read_otherwise(&self, place: impl FnMut(&Point) -> Point) -> Self {
        Self { standing: self.standing.iter().map(place).collect(), ..self.clone() }
    }

    fn of(radar: &Radar, scan: usize, read: &RadarScan) -> Self {
        let finite = |p: &Point| p.coords.iter().all(|v| v.is_finite());
        let positions: Vec<Point> = read.positions.iter().copied().filter(finite).collect();
        let (without, rates_without) = rays_and_rates(&told(radar, read, Doppler::COMPENSATED));
        let told = told(radar, read, Doppler::RAW);
        let (rays, range_rates) = rays_and_rates(&told);
        let fit_of = |rays: &[Vector], rates: &[f64]| fit(rays, rates, scan as u64);
        let fit = fit_of(&rays, &range_rates);
        let standing = match fit.filter(|fit| fit.inliers >= TRUSTED) {
            Some(fit) => told.iter().filter(|told| fit.agrees(told)).map(|told| told.place).collect(),
            None => positions.clone(),
        };
        Self {
            scan,
            t_ns: read.t_ns,
            rows: read.len(),
            not_finite: read.len() - positions.len(),
            numbers: read.columns.iter().map(|column| count_finite(column)).collect(),
            standing,
            positions,
            fit,
            compensated: fit_of(&without, &rates_without),
            rays,
            range_rates,
            spherical: read.spherical.iter().map(|s| [s.range, s.azimuth, s.elevation]).collect(),
            told: as_told(radar, read),
            digest: digest(read.columns.iter().flatten()),
        }
    }
}

fn rays_and_rates(told: &[Told]) -> (Vec<Vector>, Vec<f64>) {
    told.iter().map(|told| (told.ray, told.range_rate)).unzip()
}

/// Range, azimuth and elevation by the radar's fields of these names; of x, y and z what these make.
fn as_told(radar: &Radar, read: &RadarScan) -> Vec<[f64; 3]> {
    let is_used = |name: &&str| *name != "elevation" || radar.elevation == Elevation::Measured;
    let column = |name: &str| radar.column(name).map(|column| &read.columns[column]);
    let fields = ["range", "azimuth", "elevation"].map(|name| Some(name).filter(is_used).and_then(column));
    let value =
        |field: usize, row: usize, made: f64| fields[field].map_or(made, |column| f64::from(column[row]));
    let rows = read.spherical.iter().enumerate();
    rows.map(|(row, s)| [value(0, row, s.range), value(1, row, s.azimuth), value(2, row, s.elevation)])
        .collect()
}

fn count_finite(values: &[f32]) -> usize {
    values.iter().filter(|value| value.is_finite()).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::sensors::Reliability;
    use ralf::space::Transform;

    /// Things around a radar that drives at 30 m/s, and a lorry that follows it.
    #[test]
    fn what_moves_is_told_from_what_stands_by_the_scan_itself() {
        let radar = Radar {
            name: "radar_rear".into(),
            vehicle_from_radar: Transform::identity(),
            elevation: Elevation::None,
            sigma_range: 0.1,
            sigma_azimuth: 0.02,
            sigma_elevation: 0.02,
            fov_azimuth: 2.0,
            fov_elevation: 0.3,
            fields: ["range", "azimuth", "doppler"].map(str::to_owned).to_vec(),
            reliability: Reliability::default(),
        };
        let azimuths: Vec<f32> = (-9..=9).map(|i| 0.1 * i as f32).collect();
        let mut rates: Vec<f32> = azimuths.iter().map(|azimuth| -30.0 * azimuth.cos()).collect();
        rates[8..11].fill(0.5);
        let look = |rates: Vec<f32>| {
            let columns = vec![vec![20.0; azimuths.len()], azimuths.clone(), rates];
            RadarLook::of(&radar, 0, &RadarScan::new(&radar, 0, columns).unwrap())
        };
        let seen = look(rates);
        assert_eq!(seen.positions.len(), 19);
        assert_eq!(seen.standing, [&seen.positions[..8], &seen.positions[11..]].concat());
        let silent = look(vec![f32::NAN; 19]);
        assert_eq!(silent.standing, silent.positions, "range rates tell nothing");
    }
}
