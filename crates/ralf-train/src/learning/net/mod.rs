//! Fitting a [`Net`]: whole scans are drawn, worlds as likely as each other, and its weights follow the gradient.
//!
//! Everything is added up in the order of the rows, on one thread: the same table, parameters and seed give the same
//! net, whatever else runs beside. Several nets are fitted side by side by whoever needs several.

mod adam;
mod back;
mod begin;
mod scales;
mod scans;

pub(super) use scans::Scans;

use adam::Adam;
use back::gradient;
use ralf::learned::net::{Net, Pass, Shape};
use ralf::learned::probability;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scans::Batch;

/// How a net is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct NetParameters {
    /// Numbers that stand for a detection.
    pub width: usize,
    /// How often each detection hears of those around it.
    pub layers: usize,
    /// Of how many it hears.
    pub nearest: usize,
    /// How often each detection is looked at, about: a net that looks much oftener learns the worlds by heart.
    pub passes: f64,
    /// How far the weights go at most in one step.
    pub rate: f64,
}

/// Detections that are looked at for each change of the weights: one in so many of all, within bounds.
const CHANGES_A_PASS: usize = 120;
/// The bounds.
const LOOKED_AT: (usize, usize) = (256, 8192);

impl Default for NetParameters {
    fn default() -> Self {
        Self { width: 32, layers: 2, nearest: 8, passes: 6.0, rate: 2e-3 }
    }
}

/// Fits a net to the scans of some worlds. `blanked` is the share of scans that lack a group of evidence, for each
/// group.
pub(super) fn fit_net(
    scans: &Scans,
    worlds: &[u16],
    parameters: &NetParameters,
    blanked: f64,
    seed: u64,
) -> Net {
    let &NetParameters { width, layers, nearest, passes, rate } = parameters;
    let inputs = scans.table.features.len();
    let all: usize = worlds.iter().flat_map(|world| scans.of_world(*world)).map(ExactSizeIterator::len).sum();
    let rows = (all / CHANGES_A_PASS).clamp(LOOKED_AT.0, LOOKED_AT.1);
    let steps = (passes * all as f64 / rows as f64).ceil() as usize;
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut net = Net::zeros(Shape { inputs, width, layers, nearest }, scales::of(scans, worlds));
    begin::begin(&mut net, &mut random);
    let mut adam = Adam::new(&net);
    for step in 0..steps {
        let batch = scans.draw(worlds, rows, blanked, nearest, &mut random);
        let pass = Pass::new(&net, net.scores(&batch.rows), &batch.around);
        let gradient = gradient(&net, &pass, &batch.around, &wrong(&batch, &pass.log_odds));
        adam.step(&mut net, &gradient, rate * pace(step, steps));
    }
    net
}

/// How far each log odds is from the truth: the derivative of the mean logistic loss of a batch.
fn wrong(batch: &Batch, log_odds: &[f32]) -> Vec<f32> {
    let all = batch.plausible.len() as f32;
    let one = |(log_odds, plausible): (&f32, &bool)| {
        let target = if *plausible { 1.0 } else { 0.0 };
        (probability(f64::from(*log_odds)) as f32 - target) / all
    };
    log_odds.iter().zip(&batch.plausible).map(one).collect()
}

/// How fast the weights go in a step, of the fastest: faster in the first tenth, then slower (half a cosine).
fn pace(step: usize, steps: usize) -> f64 {
    let (step, steps) = (step as f64 + 0.5, steps.max(1) as f64);
    let begins = steps / 10.0;
    if step < begins {
        step / begins
    } else {
        0.5 + 0.5 * (std::f64::consts::PI * (step - begins) / (steps - begins)).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::places;
    use super::super::testing::table;
    use super::*;
    use ralf::learned::net::Around;

    #[test]
    fn what_only_those_around_tell_is_learned_from_them() {
        // What is plausible follows from what the nearest detection is like, and from nothing of its own.
        let mut table = table(150, 20);
        for row in 0..table.len() {
            let other = row ^ 1;
            let far = (row / 2) as f32 * 50.0;
            table.known[row].place = [far % 1000.0, far / 1000.0 * 50.0 + (row % 2) as f32, 0.0];
            table.known[row].plausible = table.rows.row(other)[0] > 0.0;
        }
        let scans = Scans::new(&table);
        let parameters = NetParameters { width: 8, layers: 1, nearest: 1, passes: 60.0, rate: 2e-2 };
        let net = fit_net(&scans, &[0, 1], &parameters, 0.0, 7);
        let right = scans.of_world(2).iter().flat_map(|scan| {
            let around = Around::of(&places(&table.known[scan.clone()]), net.nearest);
            let said = net.log_odds(&table.rows.pick(scan.clone()), &around);
            scan.clone().zip(said).map(|(row, said)| (said > 0.0) == table.known[row].plausible)
        });
        let right: Vec<bool> = right.collect();
        let share = right.iter().filter(|right| **right).count() as f64 / right.len() as f64;
        assert!(share > 0.9, "{share} of {}", right.len());
        // A few passes show as well what the result depends on.
        let brief = NetParameters { passes: 4.0, ..parameters };
        let briefly = |blanked| fit_net(&scans, &[0, 1], &brief, blanked, 7);
        assert_eq!(briefly(0.0), briefly(0.0));
        assert_ne!(briefly(0.0), briefly(0.1));
    }

    #[test]
    fn the_pace_rises_and_falls() {
        let paces: Vec<f64> = (0..100).map(|step| pace(step, 100)).collect();
        assert!(paces[..10].is_sorted() && paces[10..].iter().rev().is_sorted());
        assert!(paces[9] > 0.9 && paces[10] > 0.9 && paces[99] < 0.01);
    }
}
