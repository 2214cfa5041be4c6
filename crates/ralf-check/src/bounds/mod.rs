//! What no sensor gives and no vehicle does, whatever the scene.

mod attitude;
mod camera;
mod lidar;
mod motion;
mod mounting;
mod radar;
mod timing;

pub(crate) use radar::one_elevation;

use crate::remedy::Remedy;
use crate::sample::Sample;
use crate::verdict::{Question, Verdict};
use mounting::Mountings;
use ralf::sensors::Sequence;
use std::ops::Range;

/// All questions about bounds. What is in order is said once per sensor.
pub(crate) fn judge(sequence: &Sequence, sample: &Sample) -> Vec<Verdict> {
    let mut verdicts = motion::judge(sequence);
    let (rig, times) = (&sequence.rig, &sequence.times);
    let radars = &times.radars;
    let mountings = Mountings::new(sequence, sample);
    for ((radar, looks), times) in rig.radars.iter().zip(&sample.radars).zip(&times.radars) {
        let mut found = Vec::from_iter(mountings.judge(&radar.name));
        found.extend(radar::judge(radar, looks, &sequence.motion));
        found.extend(timing::judge(&radar.name, times));
        found.extend(timing::uneven(&radar.name, times));
        verdicts.extend(settled(&radar.name, found));
    }
    for (i, (lidar, times)) in rig.lidars.iter().zip(&times.lidars).enumerate() {
        let looks: Vec<_> = sample.lidars.iter().filter(|look| look.lidar == i).collect();
        let mut found = Vec::from_iter(mountings.judge(&lidar.name));
        found.extend(lidar::judge(lidar, &looks));
        found.extend(timing::judge(&lidar.name, times));
        found.extend(timing::uneven(&lidar.name, times));
        found.extend(timing::beside_radars(&lidar.name, times, radars));
        verdicts.extend(settled(&lidar.name, found));
    }
    for (camera, times) in rig.cameras.iter().zip(&times.cameras) {
        let mut found = Vec::from_iter(mountings.judge(&camera.name));
        found.extend(camera::judge(camera));
        found.extend(timing::judge(&camera.name, times));
        found.extend(timing::beside_radars(&camera.name, times, radars));
        verdicts.extend(settled(&camera.name, found));
    }
    verdicts
}

fn settled(name: &str, found: Vec<Verdict>) -> Vec<Verdict> {
    if found.is_empty() {
        return vec![Verdict::good(name, Question::Bounds, "its numbers are such as a sensor gives".into())];
    }
    found
}

/// A value of the rig that no sensor has, and the first of some others that one has, as its remedy.
fn out_of_reason(
    name: &str,
    (key, value): (&'static str, f64),
    usual: &Range<f64>,
    others: [f64; 2],
) -> Option<Verdict> {
    if usual.contains(&value) {
        return None;
    }
    let other = others.into_iter().find(|other| usual.contains(other));
    let evidence = format!("{key} = {value} is out of reason ({} to {})", usual.start, usual.end);
    let remedy = other.map(|value| Remedy::Value { key, value });
    Some(Verdict::doubt(name, Question::Bounds, evidence, remedy))
}
