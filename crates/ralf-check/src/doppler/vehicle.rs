//! Speed and yaw rate of the vehicle from the range rates of all its radars.
//!
//! With `u` the ray and `t` the mounting in the vehicle frame, a standing detection has `range rate = -(u_x v + (u_y
//! t_x - u_x t_y) w)`: linear in speed `v` and yaw rate `w`, for a vehicle that doesn't slide sideways at its rear
//! axle.

use crate::sample::{RadarLook, nearest};
use crate::statistics::median;
use crate::velocity_fit::{VelocityFit, fit, told};
use ralf::scene::Doppler;
use ralf::sensors::{Radar, RadarScan, Source, SourceError};
use ralf::space::{EgoMotion, OdometrySample, Transform, Vector};

/// Scans of other radars count for a moment when they are this near, ns.
const TOGETHER_NS: i64 = 50_000_000;
/// Radars whose levers are shorter than this tell no yaw rate, m.
const SHORTEST_LEVER: f64 = 0.5;
/// A motion is known when one in so many scans tells it: samples are held in between.
const TELLING: usize = 3;
/// A fit that rests on less is left out.
const FEWEST_INLIERS: f64 = 0.15;

/// One detection's ray as the factors of speed and yaw rate.
fn factors(mount: &Transform, ray: &Vector) -> Vector {
    let u = mount.rotation * ray;
    let t = mount.translation.vector;
    Vector::new(u.x, u.y * t.x - u.x * t.y, 0.0)
}

/// What yaw rates the radars, or poses, saw, beside the recorded ones.
#[derive(Debug, Clone, Default)]
pub(crate) struct Turning {
    /// Recorded and seen, rad/s.
    pub(crate) pairs: Vec<[f64; 2]>,
}

impl Turning {
    /// Median distance of what was seen from the recorded value times a factor, rad/s.
    pub(crate) fn misfit(&self, factor: f64) -> f64 {
        let offs: Vec<f64> = self.pairs.iter().map(|[told, seen]| (seen - factor * told).abs()).collect();
        median(&offs).unwrap_or(f64::INFINITY)
    }

    /// The factor of the recorded yaw rates that fits best, by least squares.
    pub(crate) fn factor(&self) -> f64 {
        let sum = |with: usize| self.pairs.iter().map(|pair| pair[0] * pair[with]).sum::<f64>();
        sum(1) / sum(0).max(1e-12)
    }
}

/// Yaw rates at the moments of the first radar's scans, by the radars that are trusted.
pub(crate) fn turning(mounts: &[Transform], looks: &[&[RadarLook]], motion: &EgoMotion) -> Turning {
    let times: Vec<Vec<i64>> =
        looks.iter().map(|looks| looks.iter().map(|look| look.t_ns).collect()).collect();
    let mut found = Turning::default();
    for look in looks.first().copied().unwrap_or_default() {
        let (mut rays, mut rates) = (Vec::new(), Vec::new());
        for ((mount, looks), times) in mounts.iter().zip(looks).zip(&times) {
            let Some(near) = nearest(times, look.t_ns).map(|i| &looks[i]) else { continue };
            if near.t_ns.abs_diff(look.t_ns) <= TOGETHER_NS as u64 {
                rays.extend(near.rays.iter().map(|ray| factors(mount, ray)));
                rates.extend(&near.range_rates);
            }
        }
        if let Some(fit) = usable(&rays, &rates, look.scan) {
            found.pairs.push([motion.twist(look.t_ns).1.z, fit.velocity.y]);
        }
    }
    found
}

fn usable(rays: &[Vector], rates: &[f64], scan: usize) -> Option<VelocityFit> {
    fit(rays, rates, scan as u64).filter(|fit| fit.inliers > FEWEST_INLIERS)
}

/// The vehicle's motion from range rates alone, a sample per scan of the radar with the most scans: for recordings
/// that have neither odometry nor poses. Where a moment tells nothing, the samples around it are held.
///
/// The error says what is missing: range rates, or a lever arm from the rear axle that makes a turn visible. Scans that
/// can't be read are left out: a damaged file among thousands must not decide where the motion comes from.
pub fn from_doppler(source: &dyn Source) -> Result<EgoMotion, SourceError> {
    let sequence = source.sequence();
    let with_doppler: Vec<usize> = (0..sequence.rig.radars.len())
        .filter(|radar| sequence.rig.radars[*radar].column("doppler").is_some())
        .collect();
    let lever = |radar: &usize| sequence.rig.radars[*radar].vehicle_from_radar.translation.vector.xy().norm();
    let longest = with_doppler.iter().map(lever).fold(0.0, f64::max);
    let Some(first) = with_doppler.iter().copied().max_by_key(|radar| sequence.times.radars[*radar].len())
    else {
        return Err(
            "no motion from range rates: expected a radar with the field `doppler`, found none".into()
        );
    };
    if longest < SHORTEST_LEVER {
        return Err(format!(
            "no motion from range rates: expected a radar at least {SHORTEST_LEVER} m from the rear axle, \
             found {longest:.2} m"
        )
        .into());
    }
    let mut window = Window::new(source, with_doppler);
    let mut samples = Vec::new();
    for (scan, t_ns) in sequence.times.radars[first].iter().enumerate() {
        let (rays, rates) = window.around(*t_ns);
        if let Some(fit) = usable(&rays, &rates, scan) {
            samples.push(OdometrySample { t_ns: *t_ns, velocity: fit.velocity.x, yaw_rate: fit.velocity.y });
        }
    }
    let scans = sequence.times.radars[first].len();
    let known = samples.len();
    EgoMotion::new(centred(&samples), vec![]).filter(|_| known * TELLING >= scans).ok_or_else(|| {
        format!(
            "no motion from range rates: expected one in {TELLING} scans at least whose detections agree on a \
             velocity, found {known} of {scans}"
        )
        .into()
    })
}

/// A sample holds until the next, so it should say the mean of both: half a step earlier in time.
fn centred(samples: &[OdometrySample]) -> Vec<OdometrySample> {
    let steps: Vec<f64> = samples.windows(2).map(|pair| (pair[1].t_ns - pair[0].t_ns) as f64).collect();
    let half = (median(&steps).unwrap_or(0.0) / 2.0) as i64;
    samples.iter().map(|sample| OdometrySample { t_ns: sample.t_ns - half, ..*sample }).collect()
}

/// The scans of all radars about a time, read once each.
struct Window<'a> {
    source: &'a dyn Source,
    radars: Vec<usize>,
    /// Per radar: number and content of the scan read last, without content where it can't be read.
    read: Vec<Option<(usize, Option<RadarScan>)>>,
}

impl<'a> Window<'a> {
    fn new(source: &'a dyn Source, radars: Vec<usize>) -> Self {
        let read = radars.iter().map(|_| None).collect();
        Self { source, radars, read }
    }

    /// Factors and range rates of all detections within [`TOGETHER_NS`].
    fn around(&mut self, t_ns: i64) -> (Vec<Vector>, Vec<f64>) {
        let sequence = self.source.sequence();
        let (mut rays, mut rates) = (Vec::new(), Vec::new());
        for (radar, read) in self.radars.iter().zip(&mut self.read) {
            let times = &sequence.times.radars[*radar];
            let Some(scan) = nearest(times, t_ns) else { continue };
            if times[scan].abs_diff(t_ns) > TOGETHER_NS as u64 {
                continue;
            }
            if read.as_ref().is_none_or(|(number, _)| *number != scan) {
                *read = Some((scan, self.source.radar_scan(*radar, scan).ok()));
            }
            if let Some((_, Some(scan))) = read {
                add_detections(&sequence.rig.radars[*radar], scan, &mut rays, &mut rates);
            }
        }
        (rays, rates)
    }
}

fn add_detections(radar: &Radar, scan: &RadarScan, rays: &mut Vec<Vector>, rates: &mut Vec<f64>) {
    for told in told(radar, scan, Doppler::RAW) {
        rays.push(factors(&radar.vehicle_from_radar, &told.ray));
        rates.push(told.range_rate);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_told_from_two_radars() {
        let mounts = [Transform::translation(3.7, 0.0, 0.5), Transform::translation(2.6, 0.9, 0.5)];
        let (speed, yaw_rate) = (6.0, 0.3);
        let (mut rays, mut rates) = (Vec::new(), Vec::new());
        for mount in &mounts {
            let own = Vector::new(speed, 0.0, 0.0)
                + Vector::new(0.0, 0.0, yaw_rate).cross(&mount.translation.vector);
            for i in 0..20 {
                let azimuth = f64::from(i) * 0.1 - 1.0;
                let ray = Vector::new(azimuth.cos(), azimuth.sin(), 0.0);
                rays.push(factors(mount, &ray));
                rates.push(-ray.dot(&own));
            }
        }
        let found = fit(&rays, &rates, 0).unwrap();
        assert!(
            (found.velocity.x - speed).abs() < 1e-9 && (found.velocity.y - yaw_rate).abs() < 1e-9,
            "{found:?}"
        );
    }
}
