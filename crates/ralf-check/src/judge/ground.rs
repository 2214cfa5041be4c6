//! Whether the plane that a LiDAR sees is the vehicle's z = 0.

use super::case::Case;
use super::places::{PLACE, PLACES, by_place};
use crate::change::SensorChange;
use crate::ground::{GroundFit, OFFSET, SUPPORT, TILT_DEG};
use crate::misread::Misread;
use crate::remedy::Remedy;
use crate::sample::LidarLook;
use crate::statistics::{Estimate, estimate, median};
use crate::verdict::{Question, Verdict};
use nalgebra::UnitQuaternion;
use ralf::sensors::Lidar;
use ralf::space::{EgoMotion, Transform, Vector};

/// Scans that are needed: one may stand on a kerb.
const FEWEST: usize = 3;
/// A turn about the LiDAR's own upright axis that two tilts have besides, degrees.
const SMALL_YAW_DEG: f64 = 0.5;
/// No road is that steep, degrees, and no ramp that high, m: one place is enough.
const NO_RAMP: (f64, f64) = (12.0, 1.5);

pub(super) fn judge(case: &Case) -> Vec<Verdict> {
    let lidars = case.sequence.rig.lidars.iter().enumerate();
    lidars
        .map(|(i, lidar)| {
            let looks: Vec<&LidarLook> = case.sample.lidars.iter().filter(|look| look.lidar == i).collect();
            one(lidar, &looks, &case.motion)
        })
        .collect()
}

fn one(lidar: &Lidar, looks: &[&LidarLook], motion: &EgoMotion) -> Verdict {
    let name = lidar.name.as_str();
    let fits: Vec<&GroundFit> = looks.iter().filter_map(|look| look.ground.as_ref()).collect();
    let support = median(&fits.iter().map(|fit| fit.support).collect::<Vec<_>>()).unwrap_or(0.0);
    if let Some(remedy) = misread(looks) {
        let evidence = format!(
            "its points show a road at z = 0 when they are read so, and none in {} scans",
            looks.len()
        );
        return Verdict::doubt(name, Question::Ground, evidence, Some(Remedy::LookInto(remedy)));
    }
    if fits.len() < FEWEST || support < SUPPORT {
        let missing = format!(
            "a plane in {} of {} scans, with {:.0} % of the points nearby on it: {FEWEST} scans and {:.0} % are needed",
            fits.len(),
            looks.len(),
            support * 100.0,
            SUPPORT * 100.0
        );
        return Verdict::cannot_judge(name, Question::Ground, missing);
    }
    let seen = Seen::of(looks, motion);
    let evidence = seen.in_words();
    if !seen.is_off() {
        return Verdict::good(name, Question::Ground, evidence);
    }
    if seen.places < PLACES && !seen.is_no_ramp() {
        let missing =
            format!("{evidence}, which a ramp may be: {:.0} m of driving are needed", PLACE * PLACES as f64);
        return Verdict::cannot_judge(name, Question::Ground, missing);
    }
    Verdict::doubt(
        name,
        Question::Ground,
        evidence,
        Some(Remedy::Sensor(seen.remedy(&lidar.vehicle_from_lidar))),
    )
}

/// What most scans would show a road as, that show none.
fn misread(looks: &[&LidarLook]) -> Option<&'static str> {
    let as_what = [
        (Misread::InVehicleFrame, "its points look as if they were in the vehicle's frame already"),
        (Misread::Columns(3), "its rows look like three numbers each"),
        (Misread::Columns(5), "its rows look like five numbers each"),
        (Misread::Columns(6), "its rows look like six numbers each"),
    ];
    let is_most = |(what, _): &(Misread, &str)| {
        let count = looks.iter().filter(|look| look.misread.contains(what)).count();
        count >= FEWEST && 2 * count > looks.len()
    };
    as_what.into_iter().find(is_most).map(|(_, words)| words)
}

/// The plane as it was seen from several places.
struct Seen {
    /// Rise to the front and to the left, degrees.
    forward: Estimate,
    left: Estimate,
    /// Of the plane at the vehicle's origin, m.
    height: Estimate,
    places: usize,
}

impl Seen {
    /// The median of what is seen from each place: scans of one place see one road.
    fn of(looks: &[&LidarLook], motion: &EgoMotion) -> Self {
        let with_ground = looks.iter().copied().filter(|look| look.ground.is_some());
        let places = by_place(with_ground, motion);
        let over = |figure: fn(&GroundFit) -> f64| {
            let of_place = |looks: &Vec<&LidarLook>| {
                let fits = looks.iter().filter_map(|look| look.ground.as_ref());
                median(&fits.map(figure).collect::<Vec<_>>())
            };
            let values: Vec<f64> = places.iter().filter_map(of_place).collect();
            estimate(&values).unwrap_or(Estimate { value: 0.0, error: f64::INFINITY })
        };
        Self {
            forward: over(|fit| fit.slope[0].to_degrees()),
            left: over(|fit| fit.slope[1].to_degrees()),
            height: over(|fit| fit.offset),
            places: places.len(),
        }
    }

    fn is_off(&self) -> bool {
        is_beyond(&self.forward, TILT_DEG)
            || is_beyond(&self.left, TILT_DEG)
            || is_beyond(&self.height, OFFSET)
    }

    fn is_no_ramp(&self) -> bool {
        self.forward.value.hypot(self.left.value) > NO_RAMP.0 || self.height.value.abs() > NO_RAMP.1
    }

    /// The turn about the LiDAR that puts the plane level, as one about its own axes, and the height that is missing
    /// then: from the LiDAR the plane is as far as before.
    fn remedy(&self, mount: &Transform) -> SensorChange {
        let found =
            |estimate: &Estimate, limit: f64| if is_beyond(estimate, limit) { estimate.value } else { 0.0 };
        let [forward, left] = [&self.forward, &self.left].map(|rise| found(rise, TILT_DEG).to_radians());
        let (up, at) = (Vector::new(-forward.tan(), -left.tan(), 1.0), mount.translation.vector);
        let level = UnitQuaternion::rotation_between(&up, &Vector::z()).unwrap_or_default();
        let (roll, pitch, yaw) = (mount.rotation.inverse() * level * mount.rotation).euler_angles();
        // Two tilts are none about the vertical: what an upright LiDAR's angles have of one is too little to be told.
        let yaw = if yaw.to_degrees().abs() < SMALL_YAW_DEG { 0.0 } else { yaw };
        let below = self.height.value - up.x * at.x - up.y * at.y;
        let height = Estimate { value: at.z - (at.z - below) / up.norm(), ..self.height };
        SensorChange {
            turn_deg: [roll, pitch, yaw].map(|turn| (turn.to_degrees() * 1000.0).round() / 1000.0),
            shift_m: [0.0, 0.0, -found(&height, OFFSET)],
            ..SensorChange::default()
        }
    }

    fn in_words(&self) -> String {
        format!(
            "the ground rises by {:+.1} degrees to the front and {:+.1} to the left, and lies {:+.2} m high, as seen \
             from {} places",
            self.forward.value, self.left.value, self.height.value, self.places
        )
    }
}

fn is_beyond(estimate: &Estimate, limit: f64) -> bool {
    estimate.value.abs() > limit && estimate.value.abs() - 4.0 * estimate.error > limit / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::space::Point;

    /// A LiDAR that is pitched and rolled by mistake, however it is mounted: with the remedy the road is z = 0.
    #[test]
    fn the_remedy_puts_the_road_level_however_the_lidar_is_mounted() {
        let sure = |value: f64| Estimate { value, error: 1e-3 };
        for (yaw, roll) in [(0.0, 0.0), (90.0, 0.0), (-90.0, 0.0), (180.0, 0.0), (30.0, 180.0)] {
            let [yaw, roll] = [yaw, roll].map(f64::to_radians);
            let right = Transform::from_parts(
                Vector::new(3.8, -0.4, 1.6).into(),
                UnitQuaternion::from_euler_angles(roll, 0.0, yaw),
            );
            let (forward, left) = (5.0_f64.to_radians(), -3.0_f64.to_radians());
            let mistake = UnitQuaternion::from_euler_angles(left, -forward, 0.0);
            let place = (right.translation.vector + Vector::new(0.0, 0.0, 0.5)).into();
            let recorded = Transform::from_parts(place, mistake * right.rotation);
            // The road as it seems: three points of it, and the plane through these.
            let seen = [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0)]
                .map(|(x, y)| recorded * (right.inverse() * Point::new(x, y, 0.0)));
            let normal = (seen[1] - seen[0]).cross(&(seen[2] - seen[0])).normalize();
            let slopes = [-normal.x / normal.z, -normal.y / normal.z];
            let height = seen[0].z - slopes[0] * seen[0].x - slopes[1] * seen[0].y;
            let [forward, left] = slopes.map(|slope| sure(slope.atan().to_degrees()));
            let found = Seen { forward, left, height: sure(height), places: 9 }.remedy(&recorded);
            let put_right = found.mount(&recorded);
            for (x, y) in [(0.0, 0.0), (20.0, 0.0), (0.0, 20.0)] {
                let road = put_right * (right.inverse() * Point::new(x, y, 0.0));
                assert!(road.z.abs() < 0.05, "{yaw} {roll}: {road}");
            }
        }
    }
}
