//! Two things in one cell of range and range rate whose angles lie closer than a beam is wide: one angle is told, and
//! it need be that of neither.

use super::antenna::{APART, displaced};
use super::echo::Echo;
use super::model::RadarModel;
use crate::random::Random;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::Spherical;
use std::f64::consts::TAU;

/// Beam widths between two things that are told apart (Rayleigh).
const RAYLEIGH: f64 = 1.2;
/// How far beyond the pair its angle may lie, in parts of what lies between: there it drowns.
const BEYOND: f64 = 1.0;

/// Where two echoes were one cell's neighbours, what is seen of both.
pub(super) fn pairs(radar: &RadarModel, mut echoes: Vec<Echo>, random: &mut Random) -> Vec<Echo> {
    let cell = |echo: &Echo| {
        let [range, rate] = [echo.seen.range / radar.cell.range, echo.range_rate / radar.cell.doppler];
        [range.floor() as i64, rate.floor() as i64]
    };
    echoes.sort_by(|a, b| cell(a).cmp(&cell(b)).then_with(|| a.seen.azimuth.total_cmp(&b.seen.azimuth)));
    let mut found: Vec<Echo> = Vec::with_capacity(echoes.len());
    let mut rest = echoes.into_iter().peekable();
    while let Some(first) = rest.next() {
        let second = rest.next_if(|next| cell(next) == cell(&first) && is_one_beam(radar, &first, next));
        found.push(match second {
            Some(second) => both(&first, &second, random.between(0.0, TAU)),
            None => first,
        });
    }
    found
}

fn is_one_beam(radar: &RadarModel, a: &Echo, b: &Echo) -> bool {
    let near = |a: f64, b: f64, width: f64| (a - b).abs() < RAYLEIGH * width;
    near(a.seen.azimuth, b.seen.azimuth, radar.cell.azimuth)
        && (!radar.elevation || near(a.seen.elevation, b.seen.elevation, radar.cell.elevation))
}

/// The angle of two unresolved echoes of amplitudes `a`, `b` and a phase between them:
/// `Re((a u + b v e^(i phase)) / (a + b e^(i phase)))` (Sherman 1984, Monopulse Principles and Techniques).
fn both(first: &Echo, second: &Echo, phase: f64) -> Echo {
    let mixed = (first.power * second.power).sqrt() * phase.cos();
    let power = (first.power + second.power + 2.0 * mixed).max(1e-3 * first.power.max(second.power));
    let share = ((second.power + mixed) / power).clamp(-BEYOND, 1.0 + BEYOND);
    let between = |value: fn(&Echo) -> f64| value(first) + share * (value(second) - value(first));
    let seen = Spherical {
        range: f64::midpoint(first.seen.range, second.seen.range),
        azimuth: between(|echo| echo.seen.azimuth),
        elevation: between(|echo| echo.seen.elevation),
    };
    let [weak, strong] = if first.power > second.power { [second, first] } else { [first, second] };
    let range_rate = f64::midpoint(first.range_rate, second.range_rate);
    // What is as good as in the place of one of them is that one.
    let truth = match [strong, weak].map(|echo| displaced(echo, &seen) > APART) {
        [false, _] => strong.truth,
        [true, false] => weak.truth,
        [true, true] if strong.truth.cause == Cause::Plausible => Truth::artifact(Cause::Ambiguity),
        [true, true] => strong.truth,
    };
    Echo { seen, range_rate, power, truth }
}

/// Peaks alone: an echo with a stronger one within `radar.grouping` cells of range, range rate and angles is but its
/// flank, for windows against side lobes widen a peak over its neighbours.
pub(super) fn peaks(radar: &RadarModel, mut echoes: Vec<Echo>) -> Vec<Echo> {
    echoes.sort_by(|a, b| a.seen.range.total_cmp(&b.seen.range));
    let reach = radar.grouping * radar.cell.range;
    let mut from = 0;
    let is_peak = |(index, echo): (usize, &Echo)| {
        while echoes[from].seen.range < echo.seen.range - reach {
            from += 1;
        }
        let near = echoes[from..].iter().take_while(|other| other.seen.range <= echo.seen.range + reach);
        let stronger = near.enumerate().any(|(offset, other)| {
            from + offset != index && other.power > echo.power && is_flank(radar, echo, other)
        });
        (!stronger).then_some(*echo)
    };
    echoes.iter().enumerate().filter_map(is_peak).collect()
}

fn is_flank(radar: &RadarModel, a: &Echo, b: &Echo) -> bool {
    let near = |a: f64, b: f64, width: f64| (a - b).abs() < radar.grouping * width;
    near(a.range_rate, b.range_rate, radar.cell.doppler)
        && near(a.seen.azimuth, b.seen.azimuth, radar.cell.azimuth)
        && (!radar.elevation || near(a.seen.elevation, b.seen.elevation, radar.cell.elevation))
}

#[cfg(test)]
mod tests {
    use super::super::model::tests::radar;
    use super::*;
    use crate::random::Purpose;

    fn echo(range: f64, azimuth: f64, level_db: f64) -> Echo {
        let truth = Truth { class: 10, cause: Cause::Plausible };
        Echo::new(Spherical { range, azimuth, elevation: 0.0 }, 1.03, level_db, truth)
    }

    #[test]
    fn two_in_one_beam_are_told_as_one_and_from_afar_as_neither() {
        let random = &mut Random::new(1, Purpose::Radar, 0, 0);
        let mut causes = Vec::new();
        for _ in 0..200 {
            let found = pairs(&radar(), vec![echo(90.1, 0.0, 30.0), echo(90.1, 0.034, 27.0)], random);
            assert_eq!(found.len(), 1);
            let azimuth = found[0].seen.azimuth;
            assert!((-0.035..0.069).contains(&azimuth), "{azimuth}");
            causes.push(found[0].truth.cause);
        }
        assert!(causes.contains(&Cause::Ambiguity) && causes.contains(&Cause::Plausible));
        assert_eq!(pairs(&radar(), vec![echo(90.1, 0.0, 30.0), echo(90.1, 0.1, 30.0)], random).len(), 2);
        // Of two as near as this, either is where it is seen.
        let near = pairs(&radar(), vec![echo(9.1, 0.0, 40.0), echo(9.1, 0.03, 30.0)], random);
        assert_eq!(near[0].truth.cause, Cause::Plausible);
    }

    #[test]
    fn the_flank_of_a_peak_is_none() {
        let echoes = vec![echo(50.0, 0.0, 30.0), echo(50.2, 0.01, 20.0), echo(50.7, 0.0, 20.0)];
        let found = peaks(&radar(), echoes);
        assert_eq!(found.iter().map(|echo| echo.seen.range).collect::<Vec<_>>(), [50.0, 50.7]);
    }
}
