//! Where and how sensors are mounted: what is on no vehicle, and what a mounting looks like that was told in another
//! way.

use crate::change::used_motion;
use crate::doppler::{compare, fits};
use crate::ground::{GroundFit, SUPPORT};
use crate::remedy::{OTHER_ORDER, OTHER_WAY, Remedy};
use crate::sample::{RadarLook, Sample};
use crate::statistics::median;
use crate::verdict::{Question, Verdict};
use nalgebra::{Quaternion, UnitQuaternion};
use ralf::sensors::Sequence;
use ralf::space::{EgoMotion, Point, Transform};

/// A sensor farther from the rear axle than this is on no vehicle, m.
const FARTHEST: f64 = 20.0;
/// What lies lower than the road by more than this is on no vehicle, m: than what a LiDAR sees of it, and than z = 0
/// where none does, for there are frames at an axle's height.
const BELOW_ROAD: f64 = 0.2;
const BELOW_ZERO: f64 = 0.3;
/// Scans in which a LiDAR sees the road.
const SCANS: usize = 3;
/// A sensor that is held upright has its vertical axis within some 20 degrees of the vertical; one that isn't has it
/// beyond 40 degrees, and isn't turned over. As cosines.
const UPRIGHT: f64 = 0.94;
const ASKEW: f64 = 0.77;
/// A mounting this far from the vehicle's origin looks away from it, and not over it, m.
const OUTER: f64 = 1.0;

/// The order in which the numbers of a quaternion stand, and are taken for x, y, z, w.
type Order = fn(&Quaternion<f64>) -> Quaternion<f64>;
/// Orders that are mistaken for it: w, x, y, z; and y, z, w, x.
const ORDERS: [Order; 2] = [w_first, w_third];

/// The same numbers where w stands first.
pub(super) fn w_first(q: &Quaternion<f64>) -> Quaternion<f64> {
    Quaternion::new(q.i, q.j, q.k, q.w)
}

pub(super) fn w_third(q: &Quaternion<f64>) -> Quaternion<f64> {
    Quaternion::new(q.k, q.w, q.i, q.j)
}

/// A rotation whose numbers stood in another order.
pub(super) fn reordered(rotation: &UnitQuaternion<f64>, order: Order) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(order(rotation.quaternion()))
}

/// Range rates go with a mounting whose direction is off by less than this, in so many scans, rad.
const GOES_WITH: (f64, usize) = (0.1, 10);

/// Whether a radar's range rates go with the vehicle's motion as it is mounted.
fn goes_with(looks: &[RadarLook], motion: &EgoMotion, mount: &Transform) -> bool {
    let (angle, scans) = GOES_WITH;
    let figures = compare(&fits(looks), motion, mount);
    figures.is_some_and(|figures| figures.scans >= scans && figures.angle.value.abs() < angle)
}

/// A sensor as it is mounted.
#[derive(Clone, Copy)]
struct Mounted<'a> {
    name: &'a str,
    mount: &'a Transform,
    /// A camera's frame is x right, y down and z ahead; others have x ahead and z up.
    is_camera: bool,
    /// Whether what it measures goes with how it is turned.
    is_acquitted: bool,
}

/// The mountings of a rig.
pub(super) struct Mountings<'a> {
    sensors: Vec<Mounted<'a>>,
    /// Planes that LiDARs see.
    road: Vec<&'a GroundFit>,
}

impl<'a> Mountings<'a> {
    pub(super) fn new(sequence: &'a Sequence, sample: &'a Sample) -> Self {
        let (rig, motion) = (&sequence.rig, used_motion(&sequence.motion));
        let of = |name, mount, is_acquitted| Mounted { name, mount, is_camera: false, is_acquitted };
        let radars = rig.radars.iter().zip(&sample.radars).map(|(radar, looks)| {
            let mount = &radar.vehicle_from_radar;
            of(radar.name.as_str(), mount, goes_with(looks, &motion, mount))
        });
        let road_of = |lidar: Option<usize>| {
            let looks =
                sample.lidars.iter().filter(move |look| lidar.is_none_or(|lidar| look.lidar == lidar));
            looks.filter_map(|look| look.ground.as_ref()).filter(|fit| fit.support >= SUPPORT)
        };
        let lidars = rig.lidars.iter().enumerate().map(|(at, lidar)| {
            of(lidar.name.as_str(), &lidar.vehicle_from_lidar, road_of(Some(at)).next().is_some())
        });
        let cameras = rig.cameras.iter().map(|camera| Mounted {
            is_camera: true,
            ..of(camera.name.as_str(), &camera.vehicle_from_camera, false)
        });
        Self { sensors: radars.chain(lidars).chain(cameras).collect(), road: road_of(None).collect() }
    }

    /// What speaks against the mounting of the sensor of this name.
    pub(super) fn judge(&self, name: &str) -> Option<Verdict> {
        let own = self.sensors.iter().find(|sensor| sensor.name == name)?;
        let far = own.far();
        far.or_else(|| self.other_order(own)).or_else(|| own.camera()).or_else(|| self.below_the_road(own))
    }

    /// A quaternion that is upright in another order only, of a sensor that nothing acquits. One that is turned over as
    /// it is may be right: radars are mounted so; but not where another one of the rig asks for the same order.
    fn other_order(&self, own: &Mounted) -> Option<Verdict> {
        let is_askew_but_for = |sensor: &Mounted, order: Order| {
            !sensor.is_acquitted
                && sensor.upright().abs() < ASKEW
                && sensor.reordered(order).is_some_and(|up| up > UPRIGHT)
        };
        let is_of_rig = |order: &Order| self.sensors.iter().any(|other| is_askew_but_for(other, *order));
        let is_own =
            |order: &Order| own.upright() < ASKEW && own.reordered(*order).is_some_and(|up| up > UPRIGHT);
        ORDERS.into_iter().filter(is_of_rig).find(is_own)?;
        let evidence = format!("its frame is tilted by {:.0} degrees, and level otherwise", own.tilt_deg());
        Some(own.doubt(evidence, OTHER_ORDER))
    }

    fn below_the_road(&self, own: &Mounted) -> Option<Verdict> {
        let height = self.height(own.mount);
        let least = if self.sees_road() { BELOW_ROAD } else { BELOW_ZERO };
        if height > -least {
            return None;
        }
        let back = own.mount.inverse();
        let looks_in = own.mount.translation.vector.xy().dot(&own.ahead().xy()) < 0.0;
        let is_outside = own.mount.translation.vector.xy().norm() > OUTER;
        let what = match looks_in && is_outside && self.height(&back) > 0.0 {
            true => OTHER_WAY,
            false => {
                "is z down, is the vehicle's frame above the road, or is it the vehicle's mounting in its frame?"
            }
        };
        Some(own.doubt(format!("mounted {:.2} m below the road", -height), what))
    }

    fn sees_road(&self) -> bool {
        self.road.len() >= SCANS
    }

    /// The height of a mounting above the road: above z = 0, or the plane that LiDARs see, whichever is lower.
    fn height(&self, mount: &Transform) -> f64 {
        let place = Point::from(mount.translation.vector);
        let seen: Vec<f64> = self.road.iter().map(|fit| fit.height(&place)).collect();
        let seen = median(&seen).filter(|_| self.sees_road());
        seen.map_or(place.z, |seen| place.z.max(seen))
    }
}

impl Mounted<'_> {
    fn doubt(&self, evidence: String, look_into: &'static str) -> Verdict {
        Verdict::doubt(self.name, Question::Bounds, evidence, Some(Remedy::LookInto(look_into)))
    }

    fn far(&self) -> Option<Verdict> {
        let distance = self.mount.translation.vector.norm();
        let evidence =
            format!("mounted {distance:.0} m from the rear axle, on no vehicle farther than {FARTHEST} m");
        (distance > FARTHEST).then(|| self.doubt(evidence, "the translation looks like cm"))
    }

    /// A camera whose mounting was told the other way round, or in the axes of other sensors, whose z is up.
    fn camera(&self) -> Option<Verdict> {
        if !self.is_camera || self.upright().abs() > ASKEW {
            return None;
        }
        if upright(&self.mount.rotation.inverse(), true) > UPRIGHT {
            let evidence = format!("its images are tilted by {:.0} degrees", self.tilt_deg());
            return Some(self.doubt(evidence, OTHER_WAY));
        }
        let what = "a camera's frame is x right, y down and z ahead: do its axes look like another one's?";
        (self.ahead().z > UPRIGHT).then(|| self.doubt("it looks straight up".into(), what))
    }

    /// The cosine between its vertical axis and the vertical.
    fn upright(&self) -> f64 {
        upright(&self.mount.rotation, self.is_camera)
    }

    /// The same where the quaternion stood in another order, and is another rotation then.
    fn reordered(&self, order: Order) -> Option<f64> {
        let other = reordered(&self.mount.rotation, order);
        (self.mount.rotation.angle_to(&other) > 0.02).then(|| upright(&other, self.is_camera))
    }

    fn tilt_deg(&self) -> f64 {
        self.upright().clamp(-1.0, 1.0).acos().to_degrees()
    }

    /// Where it looks.
    fn ahead(&self) -> nalgebra::Vector3<f64> {
        self.mount.rotation * if self.is_camera { nalgebra::Vector3::z() } else { nalgebra::Vector3::x() }
    }
}

fn upright(rotation: &UnitQuaternion<f64>, is_camera: bool) -> f64 {
    let up = if is_camera { -nalgebra::Vector3::y() } else { nalgebra::Vector3::z() };
    (rotation * up).z
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn upright_mount(is_camera: bool, degrees: f64) -> Transform {
        let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), f64::to_radians(degrees));
        let optical = UnitQuaternion::from_quaternion(Quaternion::new(0.5, -0.5, 0.5, -0.5));
        let rotation = if is_camera { yaw * optical } else { yaw };
        Transform::from_parts(Vector3::new(3.0, 0.5, 0.7).into(), rotation)
    }

    fn says(sensors: &[(bool, Transform)]) -> Vec<Option<&'static str>> {
        let names: Vec<String> = (0..sensors.len()).map(|at| at.to_string()).collect();
        let mounted = sensors.iter().zip(&names);
        let mounted = mounted.map(|((is_camera, mount), name)| Mounted {
            name,
            mount,
            is_camera: *is_camera,
            is_acquitted: false,
        });
        let mountings = Mountings { sensors: mounted.collect(), road: Vec::new() };
        let remedy = |name: &String| match mountings.judge(name)?.remedy {
            Some(Remedy::LookInto(what)) => Some(what),
            _ => None,
        };
        names.iter().map(remedy).collect()
    }

    #[test]
    fn what_is_mounted_as_sensors_are_raises_nothing() {
        let yaws = [0.0, 57.0, -90.0, 120.0, 180.0];
        let mut sensors: Vec<(bool, Transform)> =
            yaws.iter().flat_map(|yaw| [false, true].map(|is| (is, upright_mount(is, *yaw)))).collect();
        let over = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        let front = upright_mount(false, 0.0);
        sensors.push((false, Transform::from_parts(front.translation, front.rotation * over)));
        let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), f64::to_radians(-35.0));
        let fisheye = upright_mount(true, 90.0);
        sensors.push((true, Transform::from_parts(fisheye.translation, fisheye.rotation * down)));
        assert!(says(&sensors).iter().all(Option::is_none), "{:?}", says(&sensors));
    }

    #[test]
    fn quaternions_in_another_order_are_told() {
        // Each of the two orders undoes the other.
        for read in ORDERS {
            let as_read = |yaw: f64| {
                let right = upright_mount(false, yaw);
                (false, Transform::from_parts(right.translation, reordered(&right.rotation, read)))
            };
            let sensors = [0.0, 57.0, -110.0].map(as_read);
            assert_eq!(says(&sensors)[1..], [Some(OTHER_ORDER); 2]);
            let alone = [as_read(57.0), (false, upright_mount(false, 30.0))];
            assert_eq!(says(&alone), [Some(OTHER_ORDER), None]);
        }
    }

    #[test]
    fn mountings_told_the_other_way_round_are_told() {
        let inverted = [(false, 0.0), (false, 20.0), (true, 0.0), (true, 90.0)]
            .map(|(is_camera, yaw)| (is_camera, upright_mount(is_camera, yaw).inverse()));
        assert_eq!(says(&inverted)[..3], [Some(OTHER_WAY); 3]);
        assert!(says(&inverted)[3].is_some(), "{:?}", says(&inverted));
        let below = Transform::from_parts(Vector3::new(3.0, 0.0, -0.5).into(), UnitQuaternion::identity());
        assert!(says(&[(false, below)])[0].is_some_and(|what| what.contains("z down")));
        let optical = Transform::from_parts(Vector3::new(1.0, 0.0, 1.5).into(), UnitQuaternion::identity());
        assert!(says(&[(true, optical)])[0].is_some_and(|what| what.contains("axes")));
    }
}
