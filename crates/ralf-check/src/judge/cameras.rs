//! Whether a camera looks where and when it is said to: edges of its images lie where the LiDAR sees things end.

use super::case::Case;
use crate::change::SensorChange;
use crate::picture::{CameraLook, FEWEST_IMAGES, OddSize};
use crate::remedy::{LOWEST_BEAM, Remedy};
use crate::statistics::paired_sigmas;
use crate::verdict::{Question, State, Verdict};
use ralf::space::Transform;

/// Degrees and ms that are tried.
const TURNS: [f64; 8] = [-5.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 5.0];
const CLOCKS: [f64; 6] = [-300.0, -200.0, -100.0, 100.0, 200.0, 300.0];
/// What is found exactly has to be this large, degrees and ms: cameras of good recordings stay below.
const SMALLEST: (f64, f64) = (1.5, 80.0);
/// The last steps of making it exact, degrees and ms.
const STEPS: (f64, f64) = (0.25, 12.5);
/// A change is better by this factor and by so many standard errors over the images.
const GAIN: f64 = 1.06;
const SIGMAS: f64 = 4.5;

/// Judges each camera of which images were read.
pub(super) fn judge(case: &Case, known: &[Verdict]) -> Vec<Verdict> {
    let cameras = case.cameras();
    if is_lidar_doubted(case, known) {
        let missing = "the LiDAR's own height, tilt or numbers are doubted: they have to be put right before";
        let cannot = |camera| Verdict::cannot_judge(name(case, camera), Question::Camera, missing);
        return cameras.map(|camera| odd_size(case, camera).unwrap_or_else(|| cannot(camera))).collect();
    }
    let swapped = swapped(case);
    let mut verdicts = Vec::new();
    for camera in cameras.filter(|_| !case.lidars.is_empty()) {
        match swapped.iter().find(|(own, _, _)| *own == camera) {
            Some((_, other, scores)) => {
                let remedy = Remedy::SwapWith(name(case, *other).to_owned());
                let (subject, evidence) = (name(case, camera), scores.in_words());
                verdicts.push(Verdict::doubt(subject, Question::Camera, evidence, Some(remedy)));
            }
            None => verdicts.push(odd_size(case, camera).unwrap_or_else(|| one(case, camera))),
        }
    }
    verdicts
}

/// Whether something of a LiDAR is doubted that is not put right for the questions that follow; where its points lie
/// has nothing to do with how far down it looks.
pub(super) fn is_lidar_doubted(case: &Case, known: &[Verdict]) -> bool {
    let is_lidar = |name: &str| case.sequence.rig.lidars.iter().any(|lidar| lidar.name == name);
    known.iter().any(|verdict| {
        verdict.state == State::Doubt
            && matches!(verdict.question, Question::Ground | Question::Bounds)
            && is_lidar(&verdict.subject)
            && !matches!(verdict.remedy, Some(Remedy::Value { key: LOWEST_BEAM, .. }))
    })
}

fn name<'a>(case: &'a Case, camera: usize) -> &'a str {
    &case.sequence.rig.cameras[camera].name
}

/// Images that the calibration isn't of. Nothing tells whether they were scaled or cut, and so no remedy.
fn odd_size(case: &Case, camera: usize) -> Option<Verdict> {
    let mut odd = case.sample.pictures.odd_sizes.iter();
    let OddSize { size: [width, height], .. } = odd.find(|odd| odd.camera == camera)?;
    let own = &case.sequence.rig.cameras[camera];
    let evidence = format!("images are {width} x {height}, calibrated for {} x {}", own.width, own.height);
    Some(Verdict::doubt(&own.name, Question::Camera, evidence, None))
}

fn one(case: &Case, camera: usize) -> Verdict {
    let name = name(case, camera);
    let now = scores(case, camera, &SensorChange::default(), camera);
    if now.iter().flatten().count() < FEWEST_IMAGES {
        let missing = format!(
            "{FEWEST_IMAGES} images beside LiDAR scans are needed that show 25 ends of things that the LiDAR sees"
        );
        return Verdict::cannot_judge(name, Question::Camera, missing);
    }
    let mut found: Option<(SensorChange, Compared)> = None;
    for change in changes() {
        let compared = Compared::of(&now, &scores(case, camera, &change, camera));
        if compared.is_clear() && found.as_ref().is_none_or(|(_, best)| compared.then > best.then) {
            found = Some((change, compared));
        }
    }
    let exact = found.map(|(change, _)| exact(case, camera, &now, change));
    match exact.filter(|(change, _)| is_large(change)) {
        Some((change, compared)) => {
            let remedy = Some(Remedy::Camera(change));
            Verdict::doubt(name, Question::Camera, compared.in_words(), remedy)
        }
        None => Verdict::good(name, Question::Camera, "its edges lie where the LiDAR sees things end".into()),
    }
}

/// Turns to the sides, and clocks. Pitch and roll are left out: good recordings seemed to ask for some degrees of
/// pitch, perhaps because the rows of a LiDAR lie a degree and more apart and miss the tops of things.
fn changes() -> impl Iterator<Item = SensorChange> {
    let to_side = |degrees| SensorChange { turn_deg: [0.0, degrees, 0.0], ..SensorChange::default() };
    TURNS.into_iter().map(to_side).chain(CLOCKS.map(SensorChange::clock))
}

fn is_large(change: &SensorChange) -> bool {
    change.turn_deg.iter().any(|degrees| degrees.abs() >= SMALLEST.0) || change.clock_ms.abs() >= SMALLEST.1
}

/// The change in steps until none is better.
fn exact(case: &Case, camera: usize, now: &[Option<f64>], found: SensorChange) -> (SensorChange, Compared) {
    let unit = if found.clock_ms != 0.0 {
        SensorChange::clock(STEPS.1)
    } else {
        SensorChange {
            turn_deg: found.turn_deg.map(|value| STEPS.0 * value.signum() * f64::from(value != 0.0)),
            ..found
        }
    };
    let compared = |change: &SensorChange| Compared::of(now, &scores(case, camera, change, camera));
    let mut best = (found, compared(&found));
    for steps in -4..=4 {
        let change = found.and(&unit.times(f64::from(steps)));
        let compared = compared(&change);
        if compared.then > best.1.then {
            best = (change, compared);
        }
    }
    best
}

/// Cameras that see what they should in each other's mounting alone, each with the other: in no third one's nearly as
/// well, for along a motorway ends of things lie on the edges of any image.
fn swapped(case: &Case) -> Vec<(usize, usize, Compared)> {
    let count = case.sequence.rig.cameras.len();
    let in_place = |camera: usize, place: usize| scores(case, camera, &SensorChange::default(), place);
    let compared =
        |camera: usize, place: usize| Compared::of(&in_place(camera, camera), &in_place(camera, place));
    let is_alone = |camera: usize, place: usize| {
        let there = in_place(camera, place);
        let thirds = (0..count).filter(|third| *third != camera && *third != place);
        let beaten = |third: usize| Compared::of(&in_place(camera, third), &there);
        thirds.map(beaten).all(|third| third.images < FEWEST_IMAGES || third.is_clear())
    };
    let mut found = Vec::new();
    for first in 0..count {
        for second in first + 1..count {
            let [there, back] = [compared(first, second), compared(second, first)];
            let is_clear = there.is_clear() && back.is_clear();
            if is_clear && is_alone(first, second) && is_alone(second, first) {
                found.push((first, second, there));
                found.push((second, first, back));
            }
        }
    }
    found
}

/// How well each image of a camera fits under a change, in the mounting of a camera.
fn scores(case: &Case, camera: usize, change: &SensorChange, place: usize) -> Vec<Option<f64>> {
    let rig = &case.sequence.rig;
    let mount = change.mount(&rig.cameras[place].vehicle_from_camera);
    let looks = case.sample.pictures.looks.iter().filter(|look| look.camera == camera);
    looks.map(|look| score(case, look, &mount, change)).collect()
}

fn score(case: &Case, look: &CameraLook, mount: &Transform, change: &SensorChange) -> Option<f64> {
    let rig = &case.sequence.rig;
    let lidar = case.lidars.iter().find(|own| own.lidar == look.lidar && own.t_ns == look.lidar_ns)?;
    let of_lidar = case.lidar_changes[look.lidar];
    let recorded = &rig.lidars[look.lidar].vehicle_from_lidar;
    let forth = of_lidar.mount(recorded) * recorded.inverse();
    let moved = case.motion.between(change.time(look.t_ns), of_lidar.time(look.lidar_ns));
    look.score(&rig.cameras[look.camera], &(mount.inverse() * moved * forth), &lidar.edges)
}

/// How well images fit as recorded and otherwise.
struct Compared {
    now: f64,
    then: f64,
    sigmas: f64,
    images: usize,
}

impl Compared {
    /// Over the images of which both are known.
    fn of(now: &[Option<f64>], then: &[Option<f64>]) -> Self {
        let both: Vec<(f64, f64)> =
            now.iter().zip(then).filter_map(|(now, then)| (*now).zip(*then)).collect();
        let count = both.len().max(1) as f64;
        let (now, then) = both.iter().fold((0.0, 0.0), |(now, then), one| (now + one.0, then + one.1));
        let differences: Vec<f64> = both.iter().map(|(now, then)| then - now).collect();
        let sigmas = paired_sigmas(&differences);
        Self { now: now / count, then: then / count, sigmas, images: both.len() }
    }

    fn is_clear(&self) -> bool {
        self.images >= FEWEST_IMAGES && self.then > GAIN * self.now && self.sigmas > SIGMAS
    }

    fn in_words(&self) -> String {
        format!(
            "ends of things that the LiDAR sees lie on edges of {} images with {:.2}, and with {:.2} otherwise \
             (1: all on strong edges; a gain of {:.0} standard errors)",
            self.images, self.now, self.then, self.sigmas
        )
    }
}
