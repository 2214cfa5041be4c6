//! What the settings for fast traffic and for slopes are good for, in worlds whose truth is known.
use ralf::config::Config;
use ralf::label::Cause;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::Source;
use ralf_sim::{Scenario, SimulatedSequence};

const CAR: u16 = 10;

/// 110 km/h between guard rails, among cars that are as fast, and oncoming ones.
const MOTORWAY: &str = "
title = 'A motorway'
plausible_share = 0.4
ego = { start = [0, -1.8, 0], speed_kmh = 110 }
thing = [
  { kind = 'fence', at = [-60, 2.2], size = [4, 0.15, 0.8], count = 80, step = [4, 0] },
  { kind = 'fence', at = [-60, -10.2], size = [4, 0.15, 0.8], count = 80, step = [4, 0] },
  { kind = 'car', at = [22, -5.4], velocity = [26, 0] },
  { kind = 'car', at = [40, -1.8], velocity = [31, 0] },
  { kind = 'car', at = [-18, -5.4], velocity = [33, 0] },
  { kind = 'car', at = [-30, -1.8], velocity = [34, 0] },
  { kind = 'car', at = [70, 5.4], yaw_deg = 180, velocity = [-30, 0] },
  { kind = 'car', at = [110, 5.4], yaw_deg = 180, velocity = [-27, 0] },
]";

/// Of the detections of the front and the rear radar: which share of those on cars is labelled plausible, and which
/// share of what is labelled plausible is.
struct Shares {
    recall_of_cars: f64,
    precision: f64,
}

fn labelled(sequence: &SimulatedSequence, assignments: &[&str]) -> Shares {
    let config = Config::from_toml("camera.enabled = false", assignments).unwrap();
    let mut window = FrameWindow::new(sequence, &sequence.sequence().rig, &config);
    let (mut cars, mut found_cars, mut found, mut right) = (0, 0, 0, 0);
    for (radar, scan) in [0, 3].into_iter().flat_map(|radar| (2..12).map(move |scan| (radar, scan))) {
        let labels = Labeler::new(&config).unwrap().label(&window.frame(radar, scan).unwrap());
        for (label, truth) in labels.iter().zip(sequence.truth(radar, scan).unwrap()) {
            let real = truth.cause == Cause::Plausible;
            let car = real && truth.class == CAR;
            cars += usize::from(car);
            found_cars += usize::from(car && label.plausible);
            found += usize::from(label.plausible);
            right += usize::from(real && label.plausible);
        }
    }
    assert!(cars > 100, "{cars}");
    Shares { recall_of_cars: found_cars as f64 / cars as f64, precision: right as f64 / found as f64 }
}

#[test]
fn on_a_motorway_far_more_of_the_cars_are_kept_and_hardly_more_of_the_artifacts() {
    let sequence = SimulatedSequence::new("00", &Scenario::from_toml(MOTORWAY).unwrap(), 3, 14).unwrap();
    let paper = labelled(&sequence, &[]);
    let movers = labelled(&sequence, &["tracking.doppler=true", "lidar.dynamic=true"]);
    let recalls = [paper.recall_of_cars, movers.recall_of_cars];
    assert!(recalls[1] > 0.9 && recalls[1] > recalls[0] + 0.4, "{recalls:?}");
    let precisions = [paper.precision, movers.precision];
    assert!(precisions[1] > precisions[0] - 0.03, "{precisions:?}");
}

/// How many LiDAR points are left above the ground, of a world that is nothing but road: level for 10 m, then up.
fn left_of_the_road(model: &str) -> f64 {
    let ramp = "
    title = 'A ramp'
    ego = { start = [0, 0, 0], speed_kmh = 7 }
    ramp = [{ at = [10, 0], direction_deg = 0, length = 30, slope_deg = 8 }]
    thing = [{ kind = 'pole', at = [6, 3] }]";
    let sequence = SimulatedSequence::new("00", &Scenario::from_toml(ramp).unwrap(), 1, 2).unwrap();
    let config = Config::from_toml("", &[&format!("ground.model={model}")]).unwrap();
    let mut window = FrameWindow::new(&sequence, &sequence.sequence().rig, &config);
    let view = window.lidar_view(sequence.sequence().times.lidars[0][0]).unwrap().unwrap();
    view.moment.index().len() as f64 / view.rays().len() as f64
}

#[test]
fn a_ramp_is_ground_for_the_local_model_where_one_plane_takes_it_for_a_wall() {
    let [plane, local] = ["plane", "local"].map(left_of_the_road);
    assert!(plane > 0.1, "of one plane {plane}");
    assert!(local < 0.02, "of a surface {local}");
}

/// Where plausible detections of the front radar lie in the vehicle frame, m, of a world with one garage from 7 to 21 m
/// ahead that is turned so.
fn heard_of_a_garage(yaw_deg: f64) -> Vec<[f64; 2]> {
    let garage = format!(
        "title = 'A garage'
        ego = {{ start = [0, 0, 0], speed_kmh = 1 }}
        thing = [{{ kind = 'garage', at = [14, 0], yaw_deg = {yaw_deg}, size = [14, 9, 3.2] }}]"
    );
    let sequence = SimulatedSequence::new("00", &Scenario::from_toml(&garage).unwrap(), 3, 12).unwrap();
    let config = Config::from_toml("camera.enabled = false", &[]).unwrap();
    let mut window = FrameWindow::new(&sequence, &sequence.sequence().rig, &config);
    let mut heard = Vec::new();
    for scan in 0..12 {
        let frame = window.frame(0, scan).unwrap();
        let truth = sequence.truth(0, scan).unwrap();
        let found = frame.scan.detections.iter().zip(truth);
        let real = found.filter(|(_, truth)| truth.cause == Cause::Plausible);
        heard.extend(
            real.filter_map(|(found, _)| found.as_ref()).map(|found| [found.position.x, found.position.y]),
        );
    }
    assert!(heard.len() > 50, "{}", heard.len());
    heard
}

#[test]
fn radars_look_into_a_garage_by_its_open_front_alone() {
    let from_behind = heard_of_a_garage(0.0);
    assert!(from_behind.iter().all(|[x, _]| (*x - 7.0).abs() < 1.0), "{from_behind:?}");
    let from_before = heard_of_a_garage(180.0);
    // Nothing hangs in the front, and the back wall shows its inside.
    let is_in_front = |[x, y]: &[f64; 2]| (x - 7.0).abs() < 0.5 && y.abs() < 3.0;
    assert!(!from_before.iter().any(is_in_front), "{from_before:?}");
    assert!(from_before.iter().any(|[x, _]| (*x - 20.75).abs() < 1.0));
}
