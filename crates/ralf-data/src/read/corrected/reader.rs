//! A sequence that reads as corrected.

use crate::read::corrections::{Altered, MotionSource, SensorCorrection};
use crate::read::recording::SequenceReader;
use ralf::scene::{Doppler, own_motion};
use ralf::sensors::{
    CameraImage, ClassImage, DepthImage, LidarScan, Radar, RadarScan, Sequence, Source, SourceError,
};
use ralf::space::EgoMotion;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A sequence with corrections.
pub(super) struct Corrected {
    inner: Box<dyn SequenceReader>,
    sequence: Sequence,
    /// In the rig's order; none where nothing is corrected.
    radars: Vec<Option<SensorCorrection>>,
    lidars: Vec<Option<SensorCorrection>>,
    altered: Altered,
    source: MotionSource,
    trajectory: Option<PathBuf>,
    warnings: Vec<String>,
}

impl Corrected {
    /// The sequence has its mountings and times corrected already.
    pub(super) fn new(
        inner: Box<dyn SequenceReader>,
        sequence: Sequence,
        corrections: &BTreeMap<String, SensorCorrection>,
    ) -> Self {
        let radars = sequence.rig.radars.iter().map(|radar| corrections.get(&radar.name).copied()).collect();
        let lidars = sequence.rig.lidars.iter().map(|lidar| corrections.get(&lidar.name).copied()).collect();
        let (source, warnings) = (MotionSource::Recorded, inner.warnings().to_vec());
        let altered = inner.altered();
        Self { inner, sequence, radars, lidars, altered, source, trajectory: None, warnings }
    }

    /// The settings name something of this kind.
    pub(super) fn alter(&mut self, altered: Altered) {
        self.altered = self.altered.max(altered);
    }

    pub(super) fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// Takes back the warning that the recording tells no motion, for the settings say where to take it from.
    pub(super) fn motion_was_named(&mut self) {
        let known = self.inner.warning_of_motion();
        self.warnings.retain(|warning| Some(warning.as_str()) != known);
    }

    pub(super) fn set_motion(&mut self, motion: EgoMotion, source: MotionSource, file: Option<PathBuf>) {
        self.sequence.motion = motion;
        self.source = source;
        self.trajectory = file;
    }
}

impl Source for Corrected {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let read = self.inner.radar_scan(radar, scan)?;
        let Some(correction) = self.radars.get(radar).copied().flatten() else { return Ok(read) };
        let sensor = &self.sequence.rig.radars[radar];
        let RadarScan { t_ns, mut columns, .. } = read;
        for (name, column) in sensor.fields.iter().zip(&mut columns) {
            let factor = factor(&correction, name) as f32;
            // Numbers that are not corrected keep their bits.
            if factor != 1.0 {
                column.iter_mut().for_each(|value| *value *= factor);
            }
        }
        let mut scan = RadarScan::new(sensor, correction.time(t_ns), columns)?;
        if correction.doppler_factor != 1.0 {
            compensate(sensor, &mut scan, &self.sequence.motion);
        }
        Ok(scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let Sequence { rig, motion, .. } = &self.sequence;
        match self.rolling_scan(lidar, scan)? {
            Some(rolling) => Ok(rolling.motion_corrected(&rig.lidars[lidar].vehicle_from_lidar, motion)),
            None => Ok(self.with_lidar_corrected(lidar, self.inner.lidar_scan(lidar, scan)?)),
        }
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.inner.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.inner.depth(camera, image)
    }

    fn classes(&self, camera: usize, image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        self.inner.classes(camera, image)
    }
}

impl Corrected {
    /// A LiDAR's scan with its time, its unit and its sides corrected.
    fn with_lidar_corrected(&self, lidar: usize, mut read: LidarScan) -> LidarScan {
        let Some(correction) = self.lidars.get(lidar).copied().flatten() else { return read };
        read.t_ns = correction.time(read.t_ns);
        if correction.position_factor != 1.0 {
            let factor = correction.position_factor as f32;
            read.points.iter_mut().flatten().for_each(|value| *value *= factor);
        }
        if correction.mirror_y {
            read.points.iter_mut().for_each(|[_, y, _]| *y = -*y);
        }
        read
    }
}

/// What a field's values are multiplied with. A mirrored velocity has its other component across, as a place has.
fn factor(correction: &SensorCorrection, field: &str) -> f64 {
    let SensorCorrection { doppler_factor, position_factor, mirror_y, .. } = *correction;
    let mirror = if mirror_y { -1.0 } else { 1.0 };
    match field {
        "x" | "z" | "range" => position_factor,
        "y" => position_factor * mirror,
        "azimuth" | "vy" | "vy_comp" => mirror,
        Doppler::RAW | Doppler::COMPENSATED => doppler_factor,
        _ => 1.0,
    }
}

/// Range rates without the vehicle's motion, of those that were corrected: what a recorder made of its motion and of
/// rates in another unit, or with another sign, no factor puts right. Where one is missing the other is left as it is.
fn compensate(radar: &Radar, scan: &mut RadarScan, motion: &EgoMotion) {
    let places = [Doppler::RAW, Doppler::COMPENSATED].map(|field| radar.column(field));
    let ([Some(raw), Some(compensated)], true) = (places, motion.is_known()) else { return };
    let rates = own_motion(radar, scan, motion).zip(&scan.columns[raw]);
    let anew: Vec<f32> = rates.map(|(along, raw)| (f64::from(*raw) + along) as f32).collect();
    let told = scan.columns[compensated].iter_mut().zip(anew);
    told.filter(|(told, anew)| !told.is_nan() && !anew.is_nan()).for_each(|(told, anew)| *told = anew);
}

impl SequenceReader for Corrected {
    fn inner(&self) -> Option<&dyn SequenceReader> {
        Some(self.inner.as_ref())
    }

    fn inputs(&self) -> Vec<PathBuf> {
        self.inner.inputs().into_iter().chain(self.trajectory.clone()).collect()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn altered(&self) -> Altered {
        self.altered
    }

    fn rolling_scan(&self, lidar: usize, scan: usize) -> Result<Option<LidarScan>, SourceError> {
        let rolling = self.inner.rolling_scan(lidar, scan)?;
        Ok(rolling.map(|rolling| self.with_lidar_corrected(lidar, rolling)))
    }

    fn alters_values(&self, radar: usize) -> bool {
        let own = self.radars.get(radar).copied().flatten();
        own.is_some_and(|correction| correction.alters_values()) || self.inner.alters_values(radar)
    }

    fn motion_source(&self) -> MotionSource {
        self.source
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use ralf::space::OdometrySample;

    #[test]
    fn compensated_rates_are_of_the_corrected_ones() {
        // At 5 m/s: a wall 10 m ahead, a car that drives as fast, and a row without a compensated rate.
        let motion =
            EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity: 5.0, yaw_rate: 0.0 }], vec![]).unwrap();
        let compensated = |motion: &EgoMotion, fields: &[&str], columns: Vec<Vec<f32>>| {
            let radar = testing::radar(&[&["x", "y"], fields].concat());
            let ahead = vec![vec![10.0; columns[0].len()], vec![0.0; columns[0].len()]];
            let columns = ahead.into_iter().chain(columns).collect();
            let mut scan = RadarScan::new(&radar, 0, columns).unwrap();
            compensate(&radar, &mut scan, motion);
            scan.columns.last().unwrap().clone()
        };
        let both = ["doppler", "doppler_compensated"];
        let told = vec![vec![-5.0, 0.0, -5.0], vec![10.0, -5.0, f32::NAN]];
        let anew = compensated(&motion, &both, told.clone());
        assert_eq!(anew[..2], [0.0, 5.0]);
        assert!(anew[2].is_nan(), "what the recording doesn't hold");
        assert_eq!(compensated(&EgoMotion::unknown(), &both, told)[..2], [10.0, -5.0], "of no motion");
        assert_eq!(compensated(&motion, &["doppler_compensated"], vec![vec![1.5]]), [1.5], "of nothing else");
    }

    #[test]
    fn what_is_mirrored_keeps_its_range_rates() {
        // A detection ahead to the left, whose velocity lies along its ray.
        let fields = ["x", "y", "vx", "vy", "vx_comp", "vy_comp", "vy_rms"];
        let values = [4.0, 3.0, -8.0, -6.0, 0.8, 0.6, 14.0];
        let mirrored = SensorCorrection { mirror_y: true, ..SensorCorrection::default() };
        let [x, y, vx, vy, vx_comp, vy_comp, code]: [f64; 7] =
            std::array::from_fn(|i| values[i] * factor(&mirrored, fields[i]));
        assert_eq!((x, y, vy, code), (4.0, -3.0, 6.0, 14.0));
        assert_eq!((x * vx + y * vy, x * vx_comp + y * vy_comp), (-50.0, 5.0), "as before");
    }
}
