//! What bringing LiDAR points to one time is worth: labels in a turn, of revolutions as a LiDAR measures them.
//!
//!     cargo test -p ralf-sim --test all rolling -- --nocapture

use ralf::config::Config;
use ralf::label::truth_of;
use ralf::metrics::{Confusion, Rates};
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::{
    CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError, is_return,
};
use ralf::space::{Point, Transform};
use ralf_sim::{Scenario, SimulatedSequence};
use std::f64::consts::TAU;

/// A turn to the left at 40 km/h between houses, parked cars and trees: 0.7 rad/s.
const TURN: &str = "title = 'A turn'
plausible_share = 0.3
ego = { start = [0, 0, 0], speed_kmh = 40, leg = [{ length = 60, turn_deg = 220 }] }
thing = [
  { kind = 'building', at = [15, -14], size = [70, 8, 9] },
  { kind = 'building', at = [42, 20], yaw_deg = 90, size = [60, 8, 9] },
  { kind = 'building', at = [5, 48], size = [60, 8, 9] },
  { kind = 'building', at = [2, 16], size = [10, 8, 7] },
  { kind = 'car', at = [-6, -5], count = 5, step = [7, 0] },
  { kind = 'car', at = [29, 8], yaw_deg = 90, count = 3, step = [0, 7] },
  { kind = 'tree', at = [25, 38], count = 4, step = [-9, 0] },
  { kind = 'pole', at = [12, -8], count = 3, step = [8, 0] },
]";
const SCANS: usize = 20;
/// A revolution, s; its middle is the scan's time.
const REVOLUTION: f64 = 0.1;

/// What becomes of a revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Points {
    /// All points of one moment, as no LiDAR measures them.
    OneMoment,
    /// Each where it was measured, taken as if it was of the scan's time.
    AsMeasured,
    /// The same, brought to the scan's time with the recorded motion.
    Corrected,
}

/// A simulated sequence whose LiDARs turn.
struct Turning {
    made: SimulatedSequence,
    points: Points,
}

impl Turning {
    /// The points where a LiDAR that turns once in the time of a revolution meets them.
    fn measured(&self, lidar: usize, mut scan: LidarScan) -> LidarScan {
        let vehicle_from_lidar = self.made.sequence().rig.lidars[lidar].vehicle_from_lidar;
        let now = self.made.true_pose(scan.t_ns) * vehicle_from_lidar;
        let mut times = Vec::with_capacity(scan.points.len());
        for point in &mut scan.points {
            let seconds = f64::from(point[1]).atan2(f64::from(point[0])) / TAU * REVOLUTION;
            times.push(if is_return(point) { seconds as f32 } else { 0.0 });
            if is_return(point) {
                let then: Transform =
                    self.made.true_pose(scan.t_ns + (seconds * 1e9) as i64) * vehicle_from_lidar;
                let seen = then.inv_mul(&now) * Point::from(point.map(f64::from));
                *point = [seen.x as f32, seen.y as f32, seen.z as f32];
            }
        }
        scan.times = Some(times);
        scan
    }
}

impl Source for Turning {
    fn sequence(&self) -> &Sequence {
        self.made.sequence()
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.made.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let at_once = self.made.lidar_scan(lidar, scan)?;
        if self.points == Points::OneMoment {
            return Ok(at_once);
        }
        let measured = self.measured(lidar, at_once);
        let Sequence { rig, motion, .. } = self.sequence();
        Ok(match self.points {
            Points::Corrected => measured.motion_corrected(&rig.lidars[lidar].vehicle_from_lidar, motion),
            _ => measured,
        })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.made.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.made.depth(camera, image)
    }
}

/// F1 of plausible detections over all scans of all radars.
fn f1(points: Points) -> f64 {
    let scenario = Scenario::from_toml(TURN).unwrap();
    let made = SimulatedSequence::new("turn", &scenario, 0, SCANS).unwrap().without_cameras();
    let source = Turning { made, points };
    let (config, sequence) = (Config::default(), source.sequence());
    let mut counts = Confusion::default();
    for radar in 0..sequence.rig.radars.len() {
        let mut window = FrameWindow::new(&source, &sequence.rig, &config);
        for scan in 0..sequence.times.radars[radar].len() {
            let labels = Labeler::new(&config).unwrap().label(&window.frame(radar, scan).unwrap());
            let truth = source.made.truth(radar, scan).unwrap();
            for (label, truth) in labels.iter().zip(truth) {
                if let Some(is_plausible) = truth_of(truth.class) {
                    counts.add(is_plausible, label.plausible);
                }
            }
        }
    }
    Rates::new(&counts).f1_plausible.unwrap()
}

#[test]
fn correction_gives_back_most_of_what_turning_costs() {
    let [ideal, measured, corrected] =
        [Points::OneMoment, Points::AsMeasured, Points::Corrected].map(|points| (points, f1(points)));
    for (points, f1) in [ideal, measured, corrected] {
        println!("{points:?}: F1 {f1:.3}");
    }
    let (lost, left) = (ideal.1 - measured.1, ideal.1 - corrected.1);
    assert!(lost > 0.03, "turning costs nothing: {lost}");
    assert!(left < 0.2 * lost, "{left} of {lost} is left");
}
