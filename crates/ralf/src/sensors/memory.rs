//! A sequence whose measurements lie in memory: for whoever has decoded them already.

use crate::sensors::{
    Camera, CameraImage, DepthImage, DepthOutput, KNOWN_NS, LONGEST_AFTER, Lidar, LidarScan, Radar,
    RadarScan, Rig, Sequence, Source, SourceError, Timelines, check_mounting,
};
use crate::space::{EgoMotion, Transform};
use thiserror::Error;

/// Why a sensor's measurements, or a motion, can't be part of a sequence.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{sensor}: {place}: expected {expected}, found {found}")]
pub struct MemoryError {
    /// The sensor's name, or `motion`.
    pub sensor: String,
    /// Its measurement, from 0, or what else of it.
    pub place: String,
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
}

/// An image of a camera, and what a depth network gave for each of its views, if it was asked.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedImage {
    /// Time of the image, ns.
    pub t_ns: i64,
    /// Its pixels.
    pub image: CameraImage,
    /// One per view of the camera, in their order.
    pub depth: Option<Vec<DepthImage>>,
}

/// A [`Source`] of arrays. Sensors are added one by one, each with all its measurements in the order of time; what
/// doesn't fit together is refused then, so that reading never fails.
///
/// ```
/// use ralf::config::Config;
/// use ralf::paper::Labeler;
/// use ralf::scene::FrameWindow;
/// use ralf::sensors::{Elevation, Lidar, LidarScan, MemorySource, Radar, Reliability, Source};
/// use ralf::space::{EgoMotion, OdometrySample, Transform};
///
/// let radar = Radar {
///     name: "radar_front".into(),
///     fields: ["range", "azimuth", "elevation", "doppler"].map(str::to_owned).to_vec(),
///     vehicle_from_radar: Transform::translation(3.6, 0.0, 0.5),
///     elevation: Elevation::Measured,
///     fov_azimuth: 2.6,
///     fov_elevation: 0.4,
///     sigma_range: 0.1,
///     sigma_azimuth: 0.01,
///     sigma_elevation: 0.02,
///     reliability: Reliability::default(),
/// };
/// let lidar = Lidar {
///     name: "lidar_top".into(),
///     vehicle_from_lidar: Transform::translation(1.2, 0.0, 2.0),
///     sigma_range: 0.03,
///     lowest_beam: 0.4,
///     max_range: None,
/// };
/// let standing = OdometrySample { t_ns: 0, velocity: 0.0, yaw_rate: 0.0 };
/// let motion = EgoMotion::new(vec![standing], vec![]).ok_or("no motion")?;
/// // A wall 20 m ahead, and a detection on it and one in the air before it: a column per field.
/// let wall = (0..60).flat_map(|y| (0..30).map(move |z| [18.8, 0.1 * y as f32 - 3.0, 0.1 * z as f32 - 2.0]));
/// let points: Vec<[f32; 3]> = wall.collect();
/// let revolution = LidarScan { intensity: vec![0.0; points.len()], points, ..LidarScan::default() };
/// let columns = vec![vec![16.4, 9.0], vec![0.05, -0.3], vec![0.02, 0.05], vec![0.0, 0.0]];
/// let street = MemorySource::new("street", motion)?
///     .with_radar(radar, vec![(10_000_000, columns)])?
///     .with_lidar(lidar, vec![revolution])?;
///
/// let config = Config::from_toml("ground.model = \"flat\"", &[])?;
/// let mut window = FrameWindow::new(&street, &street.sequence().rig, &config);
/// let labels = Labeler::new(&config)?.label(&window.frame(0, 0)?);
/// assert!(labels[0].plausible && !labels[1].plausible);
/// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
/// ```
#[derive(Debug, Clone)]
pub struct MemorySource {
    sequence: Sequence,
    radars: Vec<Vec<RadarScan>>,
    lidars: Vec<Vec<LidarScan>>,
    cameras: Vec<Vec<TimedImage>>,
}

impl MemorySource {
    /// A sequence without sensors of a vehicle that moves so. [`EgoMotion::unknown`] is a vehicle that stands still.
    ///
    /// # Errors
    /// A motion that [`EgoMotion::check`] refuses.
    pub fn new(name: &str, motion: EgoMotion) -> Result<Self, MemoryError> {
        motion.check().map_err(|(place, reason)| refused("motion", &place, &reason))?;
        let sequence = Sequence {
            name: name.to_owned(),
            title: name.to_owned(),
            rig: Rig::default(),
            times: Timelines::default(),
            motion,
            depth_output: DepthOutput::default(),
        };
        Ok(Self { sequence, radars: Vec::new(), lidars: Vec::new(), cameras: Vec::new() })
    }

    /// Gives the sequence another title for people.
    pub fn titled(mut self, title: &str) -> Self {
        self.sequence.title = title.to_owned();
        self
    }

    /// Says what depth images mean; [`DepthOutput::Depth`] if not said.
    pub fn with_depth_output(mut self, output: DepthOutput) -> Self {
        self.sequence.depth_output = output;
        self
    }

    /// Adds a radar and its scans: a time (ns) and a column per field of the radar, each with a value per detection.
    ///
    /// # Errors
    /// A name that another sensor has, values or a mounting that no radar has, columns that don't fit, times that go
    /// back.
    pub fn with_radar(mut self, radar: Radar, scans: Vec<(i64, Vec<Vec<f32>>)>) -> Result<Self, MemoryError> {
        mounted(&radar.name, &radar.vehicle_from_radar)?;
        radar.check().map_err(|reason| refused(&radar.name, "values", &reason))?;
        let mut read = Vec::with_capacity(scans.len());
        for (n, (t_ns, columns)) in scans.into_iter().enumerate() {
            let scan = RadarScan::new(&radar, t_ns, columns);
            read.push(scan.map_err(|reason| refused(&radar.name, &format!("scan {n}"), &reason))?);
        }
        let times = self.times(&radar.name, read.iter().map(|scan| scan.t_ns))?;
        self.sequence.times.radars.push(times);
        self.sequence.rig.radars.push(radar);
        self.radars.push(read);
        Ok(self)
    }

    /// Adds a LiDAR and its scans, motion-corrected ones: [`LidarScan::motion_corrected`] makes such of points that
    /// were measured one after the other.
    ///
    /// # Errors
    /// A name that another sensor has, values or a mounting that no LiDAR has, lists of different lengths in a scan,
    /// points measured more than a second before or after it, times that go back.
    pub fn with_lidar(mut self, lidar: Lidar, scans: Vec<LidarScan>) -> Result<Self, MemoryError> {
        mounted(&lidar.name, &lidar.vehicle_from_lidar)?;
        lidar.check().map_err(|reason| refused(&lidar.name, "values", &reason))?;
        for (n, scan) in scans.iter().enumerate() {
            check_points(scan).map_err(|reason| refused(&lidar.name, &format!("scan {n}"), &reason))?;
        }
        let times = self.times(&lidar.name, scans.iter().map(|scan| scan.t_ns))?;
        self.sequence.times.lidars.push(times);
        self.sequence.rig.lidars.push(lidar);
        self.lidars.push(scans);
        Ok(self)
    }

    /// Adds a camera and its images.
    ///
    /// # Errors
    /// A name that another sensor has, values or a mounting that no camera has, images of another size, depth of
    /// another number of views or of another size than theirs, times that go back.
    pub fn with_camera(mut self, camera: Camera, images: Vec<TimedImage>) -> Result<Self, MemoryError> {
        mounted(&camera.name, &camera.vehicle_from_camera)?;
        camera.check().map_err(|reason| refused(&camera.name, "values", &reason))?;
        for (n, TimedImage { image, depth, .. }) in images.iter().enumerate() {
            let wrong = |reason: String| Err(refused(&camera.name, &format!("image {n}"), &reason));
            if let Err(reason) = camera.check_image(image) {
                return wrong(reason);
            }
            if let Some(Err(reason)) = depth.as_ref().map(|depth| check_depth(&camera, depth)) {
                return wrong(reason);
            }
        }
        let times = self.times(&camera.name, images.iter().map(|image| image.t_ns))?;
        self.sequence.times.cameras.push(times);
        self.sequence.rig.cameras.push(camera);
        self.cameras.push(images);
        Ok(self)
    }

    /// A new sensor's times, which never go back; its name is no other's.
    fn times(&self, name: &str, times: impl Iterator<Item = i64>) -> Result<Vec<i64>, MemoryError> {
        let rig = &self.sequence.rig;
        if rig.names().any(|known| known == name) {
            let reason = format!("expected a name that no other sensor has, found `{name}`");
            return Err(refused(name, "name", &reason));
        }
        let times: Vec<i64> = times.collect();
        if let Some(n) = times.iter().position(|t_ns| !KNOWN_NS.contains(t_ns)) {
            let (first, last) = KNOWN_NS.into_inner();
            let reason = format!("expected a time from {first} to {last} ns, found {} ns", times[n]);
            return Err(refused(name, &format!("measurement {n}"), &reason));
        }
        match times.windows(2).position(|pair| pair[1] < pair[0]) {
            Some(n) => {
                let reason =
                    format!("expected a time of {} ns or later, found {} ns", times[n], times[n + 1]);
                Err(refused(name, &format!("measurement {}", n + 1), &reason))
            }
            None => Ok(times),
        }
    }
}

fn mounted(sensor: &str, vehicle_from_sensor: &Transform) -> Result<(), MemoryError> {
    check_mounting(vehicle_from_sensor).map_err(|reason| refused(sensor, "mounting", &reason))
}

/// Refuses, with what was expected and found, depth that isn't of a camera's views.
fn check_depth(camera: &Camera, depth: &[DepthImage]) -> Result<(), String> {
    let mut sizes: Vec<_> = camera.views.iter().map(|view| [view.width, view.height]).collect();
    if sizes.is_empty() {
        sizes.push([camera.width, camera.height]);
    }
    if depth.len() != sizes.len() {
        return Err(format!("expected depth of {} views, found {}", sizes.len(), depth.len()));
    }
    for (view, (image, [width, height])) in depth.iter().zip(sizes).enumerate() {
        if [image.width, image.height] != [width, height] {
            let found = format!("{} x {} px", image.width, image.height);
            return Err(format!("expected depth of {width} x {height} px for view {view}, found {found}"));
        }
        if image.values.len() != width * height {
            let values = image.values.len();
            return Err(format!(
                "expected {width} x {height} values of depth for view {view}, found {values}"
            ));
        }
    }
    Ok(())
}

/// Refuses a scan whose lists are of different lengths, or points of another clock or unit.
fn check_points(scan: &LidarScan) -> Result<(), String> {
    let points = scan.points.len();
    let times = scan.times.as_ref().map_or(points, Vec::len);
    let classes = scan.classes.as_ref().map_or(points, Vec::len);
    let lists = [("intensities", scan.intensity.len()), ("times", times), ("classes", classes)];
    if let Some((what, found)) = lists.into_iter().find(|(_, found)| *found != points) {
        return Err(format!("expected {points} {what}, one per point, found {found}"));
    }
    let is_off = |seconds: &f32| f64::from(*seconds).abs() > LONGEST_AFTER || seconds.is_nan();
    match scan.times.iter().flatten().copied().enumerate().find(|(_, seconds)| is_off(seconds)) {
        Some((n, found)) => Err(format!(
            "expected times within {LONGEST_AFTER} s of the scan's, found {found} s of point {n}"
        )),
        None => Ok(()),
    }
}

/// From a sentence that says what was expected and found.
fn refused(sensor: &str, place: &str, reason: &str) -> MemoryError {
    let (expected, found) = reason.split_once(", found ").unwrap_or((reason, "something else"));
    MemoryError {
        sensor: sensor.to_owned(),
        place: place.to_owned(),
        expected: expected.strip_prefix("expected ").unwrap_or(expected).to_owned(),
        found: found.to_owned(),
    }
}

/// A measurement, which must exist.
fn measurement<'a, T>(
    kind: &str,
    all: &'a [Vec<T>],
    sensor: usize,
    index: usize,
) -> Result<&'a T, SourceError> {
    let found = all.get(sensor).and_then(|measurements| measurements.get(index));
    found.ok_or_else(|| format!("{kind} {sensor} has no measurement {index}").into())
}

impl Source for MemorySource {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        measurement("radar", &self.radars, radar, scan).cloned()
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        measurement("LiDAR", &self.lidars, lidar, scan).cloned()
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        Ok(measurement("camera", &self.cameras, camera, image)?.image.clone())
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(measurement("camera", &self.cameras, camera, image)?.depth.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::{Elevation, Intrinsics, Reliability, View};
    use crate::space::{OdometrySample, PoseSample};

    fn radar(name: &str) -> Radar {
        Radar {
            name: name.into(),
            fields: ["x", "y", "z"].map(str::to_owned).to_vec(),
            vehicle_from_radar: Transform::identity(),
            elevation: Elevation::Measured,
            fov_azimuth: 2.0,
            fov_elevation: 0.4,
            sigma_range: 0.1,
            sigma_azimuth: 0.01,
            sigma_elevation: 0.02,
            reliability: Reliability::default(),
        }
    }

    fn lidar() -> Lidar {
        let vehicle_from_lidar = Transform::identity();
        Lidar { name: "top".into(), vehicle_from_lidar, sigma_range: 0.02, lowest_beam: 0.4, max_range: None }
    }

    fn camera() -> Camera {
        let intrinsics = Intrinsics::Pinhole { focal: [2.0; 2], center: [0.5; 2], distortion: [0.0; 5] };
        let vehicle_from_camera = Transform::identity();
        Camera { name: "eye".into(), vehicle_from_camera, width: 2, height: 1, intrinsics, views: vec![] }
    }

    fn image(t_ns: i64, depth: Option<Vec<DepthImage>>) -> TimedImage {
        TimedImage { t_ns, image: CameraImage { width: 2, height: 1, rgb: vec![[1, 2, 3]; 2] }, depth }
    }

    fn empty() -> MemorySource {
        MemorySource::new("a", EgoMotion::unknown()).unwrap()
    }

    fn one(t_ns: i64) -> (i64, Vec<Vec<f32>>) {
        (t_ns, vec![vec![3.0], vec![4.0], vec![0.0]])
    }

    #[test]
    fn what_is_put_in_comes_out() {
        let revolution = LidarScan {
            t_ns: 7,
            points: vec![[1.0, 2.0, 3.0]],
            times: Some(vec![-0.01]),
            intensity: vec![0.5],
            classes: Some(vec![50]),
        };
        let depth = Some(vec![DepthImage { width: 2, height: 1, values: vec![1.0, 2.0] }]);
        let source = empty()
            .titled("A street")
            .with_depth_output(DepthOutput::Metric)
            .with_radar(radar("front"), vec![one(0), (5, vec![vec![], vec![], vec![]])])
            .and_then(|source| source.with_lidar(lidar(), vec![revolution.clone()]))
            .and_then(|source| source.with_camera(camera(), vec![image(9, depth.clone()), image(9, None)]))
            .unwrap();
        let sequence = source.sequence();
        assert_eq!((sequence.title.as_str(), sequence.depth_output), ("A street", DepthOutput::Metric));
        assert_eq!(sequence.times.radars, [[0, 5]]);
        assert_eq!((&sequence.times.lidars[0][..], &sequence.times.cameras[0][..]), (&[7][..], &[9, 9][..]));
        assert_eq!(source.radar_scan(0, 0).unwrap().spherical[0].range, 5.0);
        assert!(source.radar_scan(0, 1).unwrap().is_empty());
        assert_eq!(format!("{:?}", source.lidar_scan(0, 0).unwrap()), format!("{revolution:?}"));
        assert_eq!((source.depth(0, 0).unwrap(), source.depth(0, 1).unwrap()), (depth, None));
        assert_eq!(source.image(0, 1).unwrap().rgb.len(), 2);
        let missing = source.radar_scan(1, 0).unwrap_err().to_string();
        assert_eq!(missing, "radar 1 has no measurement 0");
        assert!(
            source.lidar_scan(0, 1).is_err() && source.image(0, 2).is_err() && source.depth(1, 0).is_err()
        );
    }

    #[test]
    fn what_does_not_fit_together_is_refused() {
        let says = |result: Result<MemorySource, MemoryError>, expected: &str| {
            assert_eq!(result.unwrap_err().to_string(), expected);
        };
        says(
            empty().with_radar(radar("front"), vec![one(5), one(4)]),
            "front: measurement 1: expected a time of 5 ns or later, found 4 ns",
        );
        says(
            empty().with_radar(radar("front"), vec![(0, vec![vec![1.0], vec![2.0]])]),
            "front: scan 0: expected 3 columns, found 2",
        );
        says(
            empty().with_radar(Radar { sigma_range: -1.0, ..radar("front") }, vec![]),
            "front: values: expected `sigma_range_m` of at least 0, found -1",
        );
        says(
            empty().with_radar(radar("top"), vec![]).and_then(|source| source.with_lidar(lidar(), vec![])),
            "top: name: expected a name that no other sensor has, found `top`",
        );
        let points = vec![[1.0; 3]; 2];
        let short = |intensity: usize, times| LidarScan {
            points: points.clone(),
            intensity: vec![0.0; intensity],
            times,
            ..LidarScan::default()
        };
        says(
            empty().with_lidar(lidar(), vec![short(1, None)]),
            "top: scan 0: expected 2 intensities, one per point, found 1",
        );
        says(
            empty().with_lidar(lidar(), vec![short(2, Some(vec![0.0]))]),
            "top: scan 0: expected 2 times, one per point, found 1",
        );
        says(
            empty().with_camera(Camera { width: 3, ..camera() }, vec![image(0, None)]),
            "eye: image 0: expected an image of 3 x 1 px as calibrated, found 2 x 1 px",
        );
        says(
            empty().with_camera(camera(), vec![image(0, Some(vec![]))]),
            "eye: image 0: expected depth of 1 views, found 0",
        );
        let apart = Transform::translation(f64::NAN, 0.0, 0.0);
        says(
            empty().with_lidar(Lidar { vehicle_from_lidar: apart, ..lidar() }, vec![]),
            "top: mounting: expected finite numbers, found NaN",
        );
        let quaternion = nalgebra::Quaternion::new(2.0, 0.0, 0.0, 0.0);
        let mut long = Transform::identity();
        long.rotation = nalgebra::UnitQuaternion::new_unchecked(quaternion);
        says(
            empty().with_radar(Radar { vehicle_from_radar: long, ..radar("front") }, vec![]),
            "front: mounting: expected a rotation of length 1, found 2",
        );
        says(
            empty().with_camera(Camera { width: 0, ..camera() }, vec![]),
            "eye: values: expected an image of 1 x 1 to 16384 x 16384 pixels, found 0 x 1",
        );
        let intrinsics =
            Intrinsics::Pinhole { focal: [2.0, f64::NAN], center: [0.5; 2], distortion: [0.0; 5] };
        says(
            empty().with_camera(Camera { intrinsics, ..camera() }, vec![]),
            "eye: values: expected finite camera parameters, found NaN",
        );
        let view = View { yaw: 0.0, pitch: 0.0, horizontal_fov: 4.0, width: 2, height: 1 };
        says(
            empty().with_camera(Camera { views: vec![view], ..camera() }, vec![]),
            "eye: values: expected a view's horizontal field above 0 and below 180 deg, found 229.1831180523293",
        );
        let cut = DepthImage { width: 2, height: 1, values: vec![1.0] };
        says(
            empty().with_camera(camera(), vec![image(0, Some(vec![cut]))]),
            "eye: image 0: expected 2 x 1 values of depth for view 0, found 1",
        );
        let turned = DepthImage { width: 1, height: 2, values: vec![1.0; 2] };
        says(
            empty().with_camera(camera(), vec![image(0, Some(vec![turned.clone()]))]),
            "eye: image 0: expected depth of 2 x 1 px for view 0, found 1 x 2 px",
        );
        let view = View { yaw: 0.0, pitch: 0.0, horizontal_fov: 1.0, width: 1, height: 2 };
        let camera = Camera { views: vec![view; 2], ..camera() };
        let whole = DepthImage { width: 2, height: 1, values: vec![1.0; 2] };
        says(
            empty().with_camera(camera, vec![image(0, Some(vec![turned, whole]))]),
            "eye: image 0: expected depth of 1 x 2 px for view 1, found 2 x 1 px",
        );
    }
    #[test]
    fn a_motion_that_no_vehicle_makes_is_refused() {
        let says = |odometry: &[(i64, f64)], expected: &str| {
            let sample = |&(t_ns, velocity): &(i64, f64)| OdometrySample { t_ns, velocity, yaw_rate: 0.0 };
            let motion = EgoMotion::new(odometry.iter().map(sample).collect(), vec![]).unwrap();
            assert_eq!(MemorySource::new("a", motion).unwrap_err().to_string(), expected);
        };
        says(&[(5, 0.0), (4, 0.0)], "motion: odometry: 1: expected a time of 5 ns or later, found 4 ns");
        says(&[(5, f64::NAN)], "motion: odometry: 0: expected finite numbers, found NaN");
        says(
            &[(i64::MIN, 0.0), (i64::MAX, 1.0)],
            "motion: odometry: 0: expected a time within 146 years of 0, found -9223372036854775808 ns",
        );
        let mut odom_from_vehicle = Transform::identity();
        odom_from_vehicle.rotation =
            nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(0.0, 0.0, 0.0, 0.0));
        let motion = EgoMotion::new(vec![], vec![PoseSample { t_ns: 0, odom_from_vehicle }]).unwrap();
        assert_eq!(
            MemorySource::new("a", motion).unwrap_err().to_string(),
            "motion: poses: 0: expected a rotation of length 1, found 0"
        );
    }
}
