//! Which echoes are peaks of their own, and what the sensor mistakes.

use super::view::{Echo, THRESHOLD_DB, View};
use crate::random::Random;
use crate::truth::Truth;
use ralf::label::Cause;
use std::collections::HashMap;

/// By how much the sine of an azimuth is off where a range rate is taken for another.
const TURNED: [f64; 3] = [0.5, 0.25, -0.5];
/// Two things so many standard deviations of the azimuth apart may be told as one.
const MERGING: [f64; 2] = [4.0, 12.0];
/// What a strong echo hides is heard all the same so often.
const ALL_THE_SAME: f64 = 0.06;
/// Nothing is told nearer than this, m.
const NEAREST: f64 = 0.1;

/// The peaks, as many as there is room for, by range.
pub(super) fn peaks(view: &View<'_>, mut echoes: Vec<Echo>, random: &mut Random) -> Vec<Echo> {
    for echo in &mut echoes {
        mistake_rate(view, echo, random);
    }
    merge(view, &mut echoes, random);
    let [wide, _] = view.radar.half_view;
    echoes.retain(|echo| {
        let seen = &echo.seen;
        echo.level_db > THRESHOLD_DB - 4.0
            && seen.range > NEAREST
            && seen.range < view.radar.max_range
            && seen.azimuth.abs() < wide
    });
    for echo in &mut echoes {
        let told = if view.radar.elevation { view.clamped(echo.seen.elevation) } else { 0.0 };
        echo.seen.elevation = told;
    }
    hide(view, &mut echoes, random);
    let mut found = one_in_a_cell(view, echoes);
    found.retain(|_| random.chance(view.radar.handed_on));
    found.truncate(view.radar.room);
    for echo in &mut found {
        echo.rate += random.normal(view.radar.cell[1] / 3.0);
        echo.level_db += random.normal(0.7);
    }
    found.sort_by(|a, b| a.seen.range.total_cmp(&b.seen.range));
    found
}

/// The next range rate that looks alike; the transmitters' phases then tell another angle.
fn mistake_rate(view: &View<'_>, echo: &mut Echo, random: &mut Random) {
    let real = matches!(echo.truth.cause, Cause::Plausible | Cause::Road);
    if !real || echo.level_db > THRESHOLD_DB + 18.0 || !random.chance(view.radar.wrong_rate) {
        return;
    }
    let sign = if random.chance(0.5) { 1.0 } else { -1.0 };
    echo.rate -= sign * view.radar.half_interval;
    let turned = TURNED[(random.uniform() * 3.0) as usize];
    echo.seen.azimuth = (echo.seen.azimuth.sin() + sign * turned).clamp(-1.0, 1.0).asin();
    echo.truth = Truth::artifact(Cause::Ambiguity);
}

/// Two things of one range and range rate whose angles are close: one peak between them.
fn merge(view: &View<'_>, echoes: &mut Vec<Echo>, random: &mut Random) {
    let [range, rate] = view.radar.cell;
    let cell =
        |echo: &Echo| [(echo.seen.range / range).round() as i64, (echo.rate / (3.0 * rate)).round() as i64];
    let mut real: Vec<usize> =
        (0..echoes.len()).filter(|i| echoes[*i].truth.cause == Cause::Plausible).collect();
    real.sort_by_key(|i| cell(&echoes[*i]));
    let sigma = view.radar.sigmas[1];
    let mut gone = Vec::new();
    for pair in real.windows(2) {
        let [a, b] = [echoes[pair[0]], echoes[pair[1]]];
        let apart = (a.seen.azimuth - b.seen.azimuth).abs() / sigma;
        let close = cell(&a) == cell(&b) && (MERGING[0]..MERGING[1]).contains(&apart);
        if !close || !random.chance(view.radar.merged) {
            continue;
        }
        let share = 1.0 / (1.0 + 10.0_f64.powf((b.level_db - a.level_db) / 20.0));
        let between = share * a.seen.azimuth + (1.0 - share) * b.seen.azimuth;
        let off = |azimuth: f64| (between - azimuth).abs() > 3.0 * sigma;
        if off(a.seen.azimuth) && off(b.seen.azimuth) {
            echoes[pair[0]].seen.azimuth = between;
            echoes[pair[0]].truth = Truth::artifact(Cause::Ambiguity);
            gone.push(pair[1]);
        }
    }
    gone.sort_unstable();
    for index in gone.into_iter().rev() {
        echoes.remove(index);
    }
}

/// In a cell of range and range rate what is much weaker than the strongest isn't found.
fn hide(view: &View<'_>, echoes: &mut Vec<Echo>, random: &mut Random) {
    let [range, rate] = view.radar.cell;
    let cell = |echo: &Echo| [(echo.seen.range / range).floor() as i64, (echo.rate / rate).floor() as i64];
    let mut strongest: HashMap<[i64; 2], f64> = HashMap::new();
    for echo in echoes.iter() {
        let level = strongest.entry(cell(echo)).or_insert(f64::NEG_INFINITY);
        *level = level.max(echo.level_db);
    }
    echoes.retain(|echo| {
        echo.level_db > strongest[&cell(echo)] - view.radar.dynamic_db || random.chance(ALL_THE_SAME)
    });
}

/// The strongest of each cell of range, range rate and azimuth, the strongest first.
fn one_in_a_cell(view: &View<'_>, mut echoes: Vec<Echo>) -> Vec<Echo> {
    let [range, rate] = view.radar.cell;
    let aside = (2.2 * view.radar.sigmas[1]).max(0.02);
    echoes.sort_by(|a, b| b.level_db.total_cmp(&a.level_db));
    let mut taken = std::collections::HashSet::new();
    echoes.retain(|echo| {
        taken.insert([
            (echo.seen.range / range).floor() as i64,
            (echo.rate / rate).floor() as i64,
            (echo.seen.azimuth.sin() / aside).floor() as i64,
        ])
    });
    echoes
}
