//! The same scene told in another way has the same labels, by the paper's method and by the model that comes with it:
//! another clock, another order of detections, another sign of a quaternion, radars that hang upside down.

use nalgebra::{Quaternion, Unit};
use ralf::config::Config;
use ralf::evidence::{features, observe};
use ralf::learned::{LearnedLabeler, Model};
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::{CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError};
use ralf::space::{EgoMotion, OdometrySample, PoseSample};
use ralf_sim::{SimulatedSequence, presets};
use std::sync::LazyLock;

/// What is said of a detection, as bits where there is any: the paper's plausibility, each of the evidence, and the
/// model's plausibility.
type Said = Vec<Option<u64>>;

/// A scene as somebody else tells it.
struct Told {
    scene: SimulatedSequence,
    sequence: Sequence,
    /// Added to every time, ns.
    later: i64,
    /// The columns of a radar's scan, as that one tells them.
    columns: fn(Vec<Vec<f32>>) -> Vec<Vec<f32>>,
}

impl Told {
    fn as_it_is() -> Self {
        let scene = presets::find("tiny").unwrap().sequences[0].simulate(5, 4).unwrap();
        let sequence = scene.sequence().clone();
        Self { scene, sequence, later: 0, columns: |columns| columns }
    }

    /// What is said of every detection of every radar's scan.
    fn said(&self) -> Vec<Vec<Said>> {
        let (config, model) = (Config::default(), Model::shipped().unwrap());
        let mut window = FrameWindow::new(self, &self.sequence.rig, &config).with_evidence();
        let learned = LearnedLabeler::new(&config, &model).unwrap();
        let mut all = Vec::new();
        for (radar, times) in self.sequence.times.radars.iter().enumerate() {
            for scan in 0..times.len() {
                let frame = window.frame(radar, scan).unwrap();
                let evidence = observe(&frame, &config);
                let by_paper = Labeler::new(&config).unwrap().label(&frame);
                let by_model = learned.label(&frame, &evidence).labels;
                let of = |row: usize| {
                    let seen = evidence.iter().map(|column| column.values[row]);
                    let said = [Some(by_paper[row].w)].into_iter().chain(seen).chain([Some(by_model[row].w)]);
                    said.map(|value| value.map(f64::to_bits)).collect()
                };
                all.push((0..by_paper.len()).map(of).collect());
            }
        }
        all
    }
}

impl Source for Told {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let read = self.scene.radar_scan(radar, scan)?;
        let columns = (self.columns)(read.columns);
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], read.t_ns + self.later, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let read = self.scene.lidar_scan(lidar, scan)?;
        Ok(LidarScan { t_ns: read.t_ns + self.later, ..read })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.scene.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.scene.depth(camera, image)
    }
}

/// The same is said as of the scene as it is, and not of nothing; of so many values in a thousand another.
#[track_caller]
fn same(found: &[Vec<Said>], in_thousand: usize) {
    static AS_IT_IS: LazyLock<Vec<Vec<Said>>> = LazyLock::new(|| Told::as_it_is().said());
    let expected = AS_IT_IS.as_slice();
    assert_eq!(found.len(), expected.len());
    let (mut others, mut all) = (Vec::new(), 0);
    for (scan, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!(found.len() > 100 && found.len() == expected.len(), "scan {scan}: {}", found.len());
        for (row, (found, expected)) in found.iter().zip(expected).enumerate() {
            for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
                all += 1;
                if !is_near(*found, *expected) {
                    let name = features().map(|feature| feature.name).nth(place.wrapping_sub(1));
                    let [found, expected] = [found, expected].map(|bits| bits.map(f64::from_bits));
                    let name = name.unwrap_or("w");
                    others.push(format!("scan {scan}, {row}: {name} {found:?} in place of {expected:?}"));
                }
            }
        }
    }
    assert!(
        others.len() * 1000 <= in_thousand * all,
        "{} of {all}: {:#?}",
        others.len(),
        &others[..others.len().min(9)]
    );
}

/// Nothing but the last digits is other: turning a place there and back costs them.
fn is_near(a: Option<u64>, b: Option<u64>) -> bool {
    match (a.map(f64::from_bits), b.map(f64::from_bits)) {
        (Some(a), Some(b)) => (a - b).abs() <= 1e-6 * b.abs().max(1.0),
        (a, b) => a == b,
    }
}

#[test]
fn another_clock() {
    let mut later = Told::as_it_is();
    let shift = -1_234_567_890_123_456_789;
    later.later = shift;
    let times = &mut later.sequence.times;
    let all = [&mut times.radars, &mut times.lidars, &mut times.cameras];
    all.into_iter().flatten().flatten().for_each(|time| *time += shift);
    let motion = &later.sequence.motion;
    let odometry = motion.odometry().iter().map(|s| OdometrySample { t_ns: s.t_ns + shift, ..*s });
    let poses = motion.poses().iter().map(|s| PoseSample { t_ns: s.t_ns + shift, ..*s });
    later.sequence.motion = EgoMotion::new(odometry.collect(), poses.collect()).unwrap();
    same(&later.said(), 0);
}

#[test]
fn another_order_of_detections() {
    let turned = Told {
        columns: |columns| columns.into_iter().map(|c| c.into_iter().rev().collect()).collect(),
        ..Told::as_it_is()
    };
    let mut said = turned.said();
    said.iter_mut().for_each(|scan| scan.reverse());
    same(&said, 0);
}

#[test]
fn another_sign_of_quaternions() {
    let mut other = Told::as_it_is();
    let rig = &mut other.sequence.rig;
    let radars = rig.radars.iter_mut().map(|radar| &mut radar.vehicle_from_radar);
    let lidars = rig.lidars.iter_mut().map(|lidar| &mut lidar.vehicle_from_lidar);
    let cameras = rig.cameras.iter_mut().map(|camera| &mut camera.vehicle_from_camera);
    for mounting in radars.chain(lidars).chain(cameras) {
        let Quaternion { coords } = *mounting.rotation.quaternion();
        mounting.rotation = Unit::new_unchecked(Quaternion { coords: -coords });
    }
    same(&other.said(), 0);
}

#[test]
fn radars_upside_down() {
    let mut hanging = Told::as_it_is();
    // Half a turn, without pi's rounding.
    let half = Unit::new_unchecked(Quaternion::new(0.0, 1.0, 0.0, 0.0));
    for radar in &mut hanging.sequence.rig.radars {
        assert_eq!(radar.fields[..3], ["x", "y", "z"]);
        radar.vehicle_from_radar.rotation *= half;
    }
    hanging.columns = |mut columns| {
        columns[1..3].iter_mut().flatten().for_each(|value| *value = -*value);
        columns
    };
    // Rounding takes a place over the edge of a cell here and there.
    same(&hanging.said(), 1);
}
