//! A radar whose positions are so many times too far: a range of there and back, or in feet.

use super::alternatives::yaws;
use super::case::Case;
use super::ground;
use crate::change::SensorChange;
use crate::overlap::{Measure, Tally, overlap};
use crate::remedy::Remedy;
use crate::sample::RadarLook;
use crate::verdict::{Question, State, Verdict};
use ralf::space::Point;

/// What positions are tried times.
const FACTORS: [f64; 4] = [0.5, 2.0, 0.3048, 1.0 / 0.3048];
/// Of a scale so many times as much lies beside the LiDAR's points: nearer to the vehicle there are more of these.
const GAIN: f64 = 1.5;
/// More or less of it by this share fits worse.
const BESIDE: f64 = 0.15;

/// Judges a radar; nothing is said of one in order, and nothing else is asked of one that isn't.
pub(super) fn judge(case: &mut Case, radar: usize) -> Option<Verdict> {
    let (factor, now, then) = found(case, radar)?;
    let evidence = format!(
        "{:.0} % of {:.0} detections lie beside LiDAR points, and {:.0} % in another unit",
        now.share() * 100.0,
        now.points(),
        then.share() * 100.0
    );
    let remedy = match is_the_lidars(case, radar, factor) {
        true => Remedy::LookInto("its positions, or the LiDAR's, look like another unit"),
        false => Remedy::Positions(factor),
    };
    let verdict = Verdict::doubt(case.name(radar), Question::Lidar, evidence, Some(remedy));
    case.leave_out(radar);
    Some(verdict)
}

/// The factor that a radar asks for, with what lies beside the LiDAR's points as recorded and with it.
fn found(case: &Case, radar: usize) -> Option<(f64, Tally, Tally)> {
    let tally = |factor: f64| scaled(case, radar, factor);
    let now = tally(1.0);
    let tried = FACTORS.map(|factor| (factor, tally(factor)));
    let better = tried.into_iter().filter(|(factor, then)| {
        let is_peak =
            || [1.0 - BESIDE, 1.0 + BESIDE].iter().all(|part| tally(factor * part).is_beaten_by(then));
        now.is_beaten_by_factor(then, GAIN) && is_peak()
    });
    let (factor, then) = better.max_by(|a, b| a.1.share().total_cmp(&b.1.share()))?;
    // Walls at 4 and 8 m lie at each other's place of twice the scale; a radar that is turned or mirrored does, too.
    let otherwise =
        yaws().chain([SensorChange::mirror()]).map(|change| case.overlap(radar, &change, Measure::Beside));
    let is_most = otherwise.fold(0.0, |most: f64, other| most.max(other.share())) < then.share();
    is_most.then_some((factor, now, then))
}

/// Whether the LiDAR's positions may be in another unit as well as the radar's: another radar asks for the same, and
/// the LiDAR doesn't see the road where it is.
fn is_the_lidars(case: &Case, radar: usize, factor: f64) -> bool {
    let is_level = || ground::judge(case).iter().any(|verdict| verdict.state == State::Good);
    let asks = |other: usize| found(case, other).is_some_and(|(own, ..)| own == factor);
    let mut radars = 0..case.sequence.rig.radars.len();
    radars.any(|other| other != radar && asks(other)) && !is_level()
}

/// A radar's overlap with the LiDARs where its positions are so many times as far.
fn scaled(case: &Case, radar: usize, factor: f64) -> Tally {
    let longer = |p: &Point| Point::from(p.coords * factor);
    let one = |look: &RadarLook| look.read_otherwise(longer);
    let looks: Vec<RadarLook> = case.sample.radars[radar].iter().map(one).collect();
    overlap(&case.setup(), radar, &looks, &case.radar_changes[radar], Measure::Beside)
}
