//! Cameras of worlds: none, one ahead, six around as in nuScenes, or four fisheyes as in the paper.

use super::family::{CalibrationRanges, Mount, mount};
use super::scene::{Met, Moment};
use super::span::one_of;
use super::terrain::{Patch, Surface};
use crate::camera::{self, Painted, Visible};
use crate::mounting::off;
use crate::random::{Purpose, Random, grain};
use crate::shape::Ray;
use crate::vehicle::camera_mounting;
use ralf::sensors::{Camera, Intrinsics, View};
use ralf::space::{Point, Transform};

/// Images are small, so that they cost about as much as a LiDAR scan, px.
const STRAIGHT: [usize; 2] = [320, 180];
const FISHEYE: [usize; 2] = [200, 130];
const FISHEYE_FOCAL: f64 = 62.0;
/// The straight view of a fisheye.
const VIEW: [usize; 2] = [240, 150];

const AHEAD: &[Mount] = &[mount("camera_front", [1.6, 0.0, 1.35], 0.0)];
const AROUND: &[Mount] = &[
    mount("camera_front", [1.7, 0.0, 1.5], 0.0),
    mount("camera_front_left", [1.5, 0.5, 1.5], 55.0),
    mount("camera_front_right", [1.5, -0.5, 1.5], -55.0),
    mount("camera_back_left", [1.0, 0.5, 1.55], 110.0),
    mount("camera_back_right", [1.0, -0.5, 1.55], -110.0),
    mount("camera_back", [0.0, 0.0, 1.55], 180.0),
];
const FISHEYES: &[Mount] = &[
    mount("camera_front", [3.6, 0.0, 0.75], 0.0),
    mount("camera_left", [1.9, 1.0, 1.1], 90.0),
    mount("camera_right", [1.9, -1.0, 1.1], -90.0),
    mount("camera_rear", [-0.9, 0.0, 1.0], 180.0),
];

/// Sets of cameras.
#[derive(Debug, Clone, Copy)]
enum Layout {
    None,
    Ahead,
    Around,
    Fisheyes,
}

impl Layout {
    fn mounts(self) -> &'static [Mount] {
        match self {
            Self::None => &[],
            Self::Ahead => AHEAD,
            Self::Around => AROUND,
            Self::Fisheyes => FISHEYES,
        }
    }
}

/// A camera as it really sits, and as the recording says.
#[derive(Debug, Clone)]
pub(super) struct CameraModel {
    pub(super) vehicle_from_camera: Transform,
    pub(super) declared: Camera,
    /// Between images, ns.
    pub(super) period_ns: i64,
    /// The first image after the start, ns.
    pub(super) first_ns: i64,
}

/// The cameras of a world; every other one has none.
pub(super) fn cameras(ranges: &CalibrationRanges, seed: u64) -> Vec<CameraModel> {
    let random = &mut Random::new(seed, Purpose::World, 2, 0);
    let layouts = [(Layout::None, 3.0), (Layout::Ahead, 1.0), (Layout::Around, 1.0), (Layout::Fisheyes, 1.0)];
    let layout = one_of(&layouts, random).unwrap_or(Layout::None);
    // 10 to 20 images a second: nuScenes 12, View-of-Delft 30 of which one in three is kept.
    let period_ns = (1e9 / random.between(10.0, 20.0)).round() as i64;
    let first_ns = (random.uniform() * period_ns as f64) as i64;
    // 50 to 100 degrees: nuScenes 70, aiMotive 56 to 80.
    let fov = random.between(50.0, 100.0).to_radians();
    let [angle, place] = [ranges.angle.draw(random) / 2.0, ranges.place.draw(random) / 2.0];
    let mut found = Vec::new();
    for mount in layout.mounts() {
        let vehicle_from_camera = mounted(mount, if fisheye(layout) { 12.0 } else { 0.0 }, random);
        let said = off(&vehicle_from_camera, angle, place, random);
        let declared = if fisheye(layout) { wide(mount.name, said) } else { straight(mount.name, said, fov) };
        found.push(CameraModel { vehicle_from_camera, declared, period_ns, first_ns });
    }
    found
}

fn fisheye(layout: Layout) -> bool {
    matches!(layout, Layout::Fisheyes)
}

/// Looks about so many degrees down.
fn mounted(mount: &Mount, down_deg: f64, random: &mut Random) -> Transform {
    camera_mounting(mount.place, mount.yaw_deg, down_deg + random.between(-1.0, 1.0))
}

fn middle(size: [usize; 2]) -> [f64; 2] {
    size.map(|pixels| (pixels as f64 - 1.0) / 2.0)
}

fn straight(name: &str, vehicle_from_camera: Transform, fov: f64) -> Camera {
    let focal = STRAIGHT[0] as f64 / 2.0 / (fov / 2.0).tan();
    Camera {
        name: name.to_owned(),
        vehicle_from_camera,
        width: STRAIGHT[0],
        height: STRAIGHT[1],
        intrinsics: Intrinsics::Pinhole { focal: [focal; 2], center: middle(STRAIGHT), distortion: [0.0; 5] },
        views: Vec::new(),
    }
}

fn wide(name: &str, vehicle_from_camera: Transform) -> Camera {
    let view = View {
        yaw: 0.0,
        pitch: -8.0_f64.to_radians(),
        horizontal_fov: 110.0_f64.to_radians(),
        width: VIEW[0],
        height: VIEW[1],
    };
    Camera {
        name: name.to_owned(),
        vehicle_from_camera,
        width: FISHEYE[0],
        height: FISHEYE[1],
        intrinsics: Intrinsics::KannalaBrandt {
            focal: [FISHEYE_FOCAL; 2],
            center: middle(FISHEYE),
            distortion: [0.03, -0.008, 0.0, 0.0],
        },
        views: vec![view],
    }
}

impl Visible for Moment<'_> {
    fn distance(&self, ray: &Ray, limit: f64) -> Option<f64> {
        self.cast(ray, limit, |_, crossing| Some(crossing.enter)).map(|hit| hit.distance)
    }

    fn surface(&self, ray: &Ray, limit: f64) -> Option<Painted> {
        let hit = self.cast(ray, limit, |_, crossing| Some(crossing.enter))?;
        let p = ray.origin + ray.direction * hit.distance;
        let terrain = &self.site.terrain;
        let colour = match hit.on {
            Met::Ground(_) => ground(terrain.patch(p.x, p.y), &p, self.site.seed),
            Met::Body(solid) => camera::solid_colour(solid, &p, p.z - terrain.height(p.x, p.y), &hit.normal),
        };
        Some(Painted { distance: hit.distance, normal: hit.normal, colour })
    }

    fn class(&self, ray: &Ray, limit: f64) -> Option<u16> {
        let hit = self.cast(ray, limit, |_, crossing| Some(crossing.enter))?;
        let p = ray.origin + ray.direction * hit.distance;
        Some(match hit.on {
            Met::Ground(_) => self.site.terrain.patch(p.x, p.y).surface.seen_class(),
            Met::Body(solid) => solid.kind.seen_class(),
        })
    }
}

/// Grass is green to dry, each patch as it is.
fn ground(patch: &Patch, p: &Point, seed: u64) -> [f64; 3] {
    match patch.surface {
        Surface::Asphalt => camera::asphalt(p),
        Surface::Pavement => camera::slabs(p),
        Surface::Gravel => camera::gravel(p),
        Surface::Grass => {
            let place = patch.center.map(|value| (value * 10.0) as i64);
            let dry = grain(seed, [place[0], place[1], 0x67]);
            let mixed = |green: f64, straw: f64| green + (straw - green) * dry;
            camera::leaves(p, [mixed(84.0, 160.0), mixed(138.0, 146.0), mixed(64.0, 96.0)])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kind::Kind;
    use crate::world::item::{Course, Item};
    use crate::world::scene::Site;
    use crate::world::terrain::Terrain;

    /// A container of 4 m stands with its middle at x = 22 m, on grass.
    fn site() -> Site {
        let base = Patch::base(Surface::Grass, 0.2);
        let random = &mut Random::new(1, Purpose::Placement, 0, 0);
        let course = Course { start: [22.0, 0.0, 0.0], ..Course::default() };
        let item = Item::new(Kind::Container, [4.0, 8.0, 3.0], course, random);
        Site::new(Terrain::new(&[], Vec::new(), base, 1), vec![item], 1)
    }

    #[test]
    fn depth_is_along_the_axis_and_grass_is_greener_than_grey() {
        let site = site();
        let random = &mut Random::new(1, Purpose::World, 0, 0);
        let ahead = mounted(&mount("camera_front", [1.6, 0.0, 1.35], 0.0), 0.0, random);
        let camera = straight("camera_front", ahead, 1.2);
        let moment = camera::Moment { scene: site.at(0.0), camera: &camera, site_from_camera: ahead };
        let depth = &camera::true_depth(&moment)[0];
        let [u, v] = [depth.width / 2, depth.height / 2];
        // The container's front is at 20 m; the camera looks up or down by a degree at most.
        let middle = f64::from(depth.values[v * depth.width + u]);
        assert!((middle - 18.4).abs() < 0.05, "{middle}");
        let image = camera::image(&moment, &camera::rays(&camera), None, random);
        let lowest = &image.rgb[image.rgb.len() - image.width..];
        let mean = |channel: usize| {
            lowest.iter().map(|rgb| f64::from(rgb[channel])).sum::<f64>() / lowest.len() as f64
        };
        assert!(2.0 * mean(1) - mean(0) - mean(2) > 10.0, "{} {} {}", mean(0), mean(1), mean(2));
    }
}
