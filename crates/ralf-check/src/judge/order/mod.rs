//! Whether a sensor's files lie in the order of its times: whoever sorts them by names that are numbers of several
//! lengths has 10 after 1, and all else goes on as if nothing were.
//!
//! Of a radar its range rates tell, where the speed changes; of LiDARs, and of other radars, what both see.

mod orders;
mod scans;

use crate::change::used_motion;
use crate::doppler::predicted;
use crate::overlap::Tally;
use crate::remedy::Remedy;
use crate::sample::{RadarLook, Sample};
use crate::statistics::paired_sigmas;
use crate::velocity_fit::{TRUSTED, VelocityFit};
use crate::verdict::{Question, Verdict};
use nalgebra::Vector2;
use orders::{Order, Orders};
use ralf::sensors::Source;
use ralf::space::{EgoMotion, Transform};
use scans::{Of, Scans};

/// In the other order so many times as many detections lie beside the LiDAR's points.
const GAIN: f64 = 1.3;
/// Of range rates this share of the misfit is left, and so much of it goes, m/s.
const MISFIT: (f64, f64) = (0.6, 0.3);
/// Velocities are at odds with the vehicle's from this on, mean, m/s.
const AT_ODDS: f64 = 1.0;
/// What a single scan's range rates can add, m/s.
const CAP: f64 = 3.0;
/// By so many standard errors.
const SIGMAS: f64 = 4.0;
/// So many scans tell.
const SCANS: usize = 10;
/// Files that lie this much aside tell one order from another, ns.
const ASIDE_NS: u64 = 300_000_000;

/// Judges radars and LiDARs that are fit; nothing is said of those in order.
pub(super) fn judge(source: &dyn Source, sample: &Sample, unfit: &[String]) -> Vec<Verdict> {
    let rig = &source.sequence().rig;
    let is_fit = |name: &String| !unfit.contains(name);
    let radars: Vec<usize> = (0..rig.radars.len()).filter(|i| is_fit(&rig.radars[*i].name)).collect();
    let lidars: Vec<usize> = (0..rig.lidars.len()).filter(|i| is_fit(&rig.lidars[*i].name)).collect();
    let motion = used_motion(&source.sequence().motion);
    let orders = Orders::of(&source.sequence().times);
    let mut verdicts = Vec::new();
    let mut found = vec![None; rig.radars.len()];
    for radar in &radars {
        if let Some((order, verdict)) =
            by_range_rates(source, &sample.radars[*radar], *radar, &motion, &orders)
        {
            found[*radar] = Some(order);
            verdicts.push(verdict);
        }
    }
    let mut scans = Scans::new(source, sample, &motion, &orders, found);
    verdicts.extend(by_what_both_see(&mut scans, &radars, &lidars));
    verdicts
}

/// The order in which a radar's velocities go with the vehicle's, and better than mirrored ones do as recorded: in a
/// slalom, another order has turns to the other side, as a mirrored radar has.
fn by_range_rates(
    source: &dyn Source,
    looks: &[RadarLook],
    radar: usize,
    motion: &EgoMotion,
    orders: &Orders,
) -> Option<(Order, Verdict)> {
    let times = &source.sequence().times.radars[radar];
    let sensor = &source.sequence().rig.radars[radar];
    let told = told_velocities(looks);
    let one = |order: Order| {
        let files = &orders.get(order, times.len()).files;
        let aside = told.iter().filter(|(scan, _)| times[files[*scan]].abs_diff(times[*scan]) > ASIDE_NS);
        let misfit = |t_ns, velocity| misfit(motion, &sensor.vehicle_from_radar, t_ns, velocity);
        // Of each scan as recorded, in the order, and as recorded of a radar whose y is mirrored.
        let misfits: Vec<[f64; 3]> = aside
            .map(|(scan, fit)| {
                let [now, then] = [*scan, files[*scan]].map(|place| misfit(times[place], fit.velocity));
                [now, then, misfit(times[*scan], Vector2::new(fit.velocity.x, -fit.velocity.y))]
            })
            .collect();
        let mean = |which: usize| {
            misfits.iter().map(|misfits| misfits[which]).sum::<f64>() / misfits.len().max(1) as f64
        };
        let gains: Vec<f64> = misfits.iter().map(|[now, then, _]| now - then).collect();
        let [now, then, mirrored] = [0, 1, 2].map(mean);
        let is_better =
            misfits.len() >= SCANS && then < MISFIT.0 * now && now - then > MISFIT.1 && then < mirrored;
        (is_better && paired_sigmas(&gains) > SIGMAS).then_some((order, now, then))
    };
    let found = Order::ALL.into_iter().filter_map(one).min_by(|a, b| a.2.total_cmp(&b.2));
    found.map(|(order, now, then)| {
        let evidence = format!(
            "its velocities are {now:.2} m/s off the vehicle's, and {then:.2} m/s with its scans in another order"
        );
        (order, doubt(&sensor.name, evidence, order))
    })
}

/// Scans with the velocities that they tell for sure.
fn told_velocities(looks: &[RadarLook]) -> Vec<(usize, VelocityFit)> {
    let told = looks.iter().filter_map(|look| Some((look.scan, look.fit?)));
    told.filter(|(_, fit)| fit.inliers >= TRUSTED).collect()
}

/// How far a radar's velocity at a time is from the vehicle's, m/s.
fn misfit(motion: &EgoMotion, vehicle_from_radar: &Transform, t_ns: i64, velocity: Vector2<f64>) -> f64 {
    (predicted(motion, vehicle_from_radar, t_ns) - velocity).norm().min(CAP)
}

/// Whether a radar's velocities don't go with the vehicle's. Where no order explains it, something else is wrong, and
/// what lies beside the LiDAR's points in another order does so by chance.
fn is_at_odds(scans: &Scans, radar: usize) -> bool {
    let sequence = scans.source.sequence();
    let (times, mount) = (&sequence.times.radars[radar], &sequence.rig.radars[radar].vehicle_from_radar);
    let told = told_velocities(&scans.sample.radars[radar]);
    let misfits = told.iter().map(|(scan, fit)| misfit(scans.motion, mount, times[*scan], fit.velocity));
    told.len() >= SCANS && misfits.sum::<f64>() > AT_ODDS * told.len() as f64
}

/// A LiDAR, as all radars see it; else a radar, as the LiDARs see it; else all of them at once.
fn by_what_both_see(scans: &mut Scans, radars: &[usize], lidars: &[usize]) -> Vec<Verdict> {
    let rig = &scans.source.sequence().rig;
    let is_unknown = |radar: &usize| scans.found[*radar].is_none() && !is_at_odds(scans, *radar);
    let unknown: Vec<usize> = radars.iter().copied().filter(is_unknown).collect();
    let of_radars = unknown.iter().map(|radar| &rig.radars[*radar].name);
    let of_lidars = lidars.iter().map(|lidar| &rig.lidars[*lidar].name);
    let mut verdicts = Vec::new();
    for (lidar, name) in lidars.iter().zip(of_lidars.clone()) {
        verdicts.extend(told([name], best(|order| scans.tallies(order, Of::Lidar, radars, &[*lidar]))));
    }
    if verdicts.is_empty() {
        for (radar, name) in unknown.iter().zip(of_radars.clone()) {
            verdicts.extend(told([name], best(|order| scans.tallies(order, Of::Radars, &[*radar], lidars))));
        }
    }
    if verdicts.is_empty() {
        let found = best(|order| scans.tallies(order, Of::Both, &unknown, lidars));
        verdicts.extend(told(of_radars.chain(of_lidars), found));
    }
    verdicts
}

/// What is said of sensors of which an order was found.
fn told<'a>(names: impl IntoIterator<Item = &'a String>, found: Option<(Order, [Tally; 2])>) -> Vec<Verdict> {
    let Some((order, tallies)) = found else { return Vec::new() };
    names.into_iter().map(|name| doubt(name, in_words(&tallies), order)).collect()
}

/// The order in which clearly more lies beside the LiDAR's points, with the tallies as recorded and in it.
fn best(mut tallies: impl FnMut(Order) -> [Tally; 2]) -> Option<(Order, [Tally; 2])> {
    let tried = Order::ALL.map(|order| (order, tallies(order)));
    let better = tried.into_iter().filter(|(_, [now, then])| now.is_beaten_by_factor(then, GAIN));
    better.max_by(|a, b| a.1[1].share().total_cmp(&b.1[1].share()))
}

fn in_words([now, then]: &[Tally; 2]) -> String {
    format!(
        "{:.0} % of {:.0} detections lie beside LiDAR points, and {:.0} % with its scans in another order",
        now.share() * 100.0,
        now.points(),
        then.share() * 100.0
    )
}

fn doubt(name: &str, evidence: String, order: Order) -> Verdict {
    Verdict::doubt(name, Question::Clock, evidence, Some(Remedy::LookInto(order.remedy())))
}
