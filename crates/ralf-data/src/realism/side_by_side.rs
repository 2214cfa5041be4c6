//! Two recordings side by side.

use super::distance::ENOUGH;
use super::{Distance, Distributions, Quantity};
use serde::Serialize;

/// A distribution in figures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    /// How many values were taken.
    pub values: usize,
    /// Their mean.
    pub mean: f64,
    /// Below these lie 5, 25, 50, 75 and 95 % of the values.
    pub quantiles: [f32; 5],
}

impl Summary {
    /// Of values in ascending order; `None` without any.
    pub fn of(values: &[f32]) -> Option<Self> {
        let last = values.len().checked_sub(1)?;
        let mean = values.iter().map(|value| f64::from(*value)).sum::<f64>() / values.len() as f64;
        let quantiles =
            [0.05, 0.25, 0.5, 0.75, 0.95].map(|share: f64| values[(share * last as f64).round() as usize]);
        Some(Self { values: values.len(), mean, quantiles })
    }
}

/// A quantity of two recordings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// Which one.
    #[serde(skip)]
    pub quantity: Quantity,
    /// Its name.
    pub name: &'static str,
    /// Its unit: `share` of shares, empty of counts.
    pub unit: &'static str,
    /// In the real recording; `None` where that lacks what it needs.
    pub real: Option<Summary>,
    /// In the simulated recording; `None` where that lacks what it needs.
    pub simulated: Option<Summary>,
    /// Between the two; `None` where one has fewer than eight values.
    pub distance: Option<Distance>,
    /// Between the first and the second half of the real recording: what reality itself varies.
    pub within_real: Option<Distance>,
}

/// How far a simulated recording is from a real one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Realism {
    /// Mean Kolmogorov-Smirnov distance over the quantities that both have, and whose halves have a distance where any
    /// have one; `None` where they share none.
    pub mean_ks: Option<f64>,
    /// The same between the halves of the real recording, over the same quantities.
    pub mean_ks_within_real: Option<f64>,
    /// Every quantity.
    pub quantities: Vec<Compared>,
}

impl Realism {
    /// Compares two recordings.
    pub fn new(real: &Distributions, simulated: &Distributions) -> Self {
        let compared = Quantity::ALL.map(|quantity| {
            let [first, second] = real.halves(quantity);
            let (all_real, all_simulated) = (real.values(quantity), simulated.values(quantity));
            Compared {
                quantity,
                name: quantity.description().name,
                unit: quantity.description().unit,
                real: Summary::of(&all_real),
                simulated: Summary::of(&all_simulated),
                distance: distance(&all_real, &all_simulated),
                within_real: distance(first, second),
            }
        });
        // A short recording has halves of some quantities only, and a mean over others says nothing beside theirs.
        let has_halves = compared.iter().any(|c| c.distance.and(c.within_real).is_some());
        let counts = |c: &&Compared| c.distance.is_some() && (!has_halves || c.within_real.is_some());
        let both = || compared.iter().filter(counts);
        Self {
            mean_ks: mean(both().filter_map(|compared| compared.distance)),
            mean_ks_within_real: mean(both().filter_map(|compared| compared.within_real)),
            quantities: compared.to_vec(),
        }
    }
}

/// The distance of two lists of values that are long enough to be distributions.
fn distance(real: &[f32], other: &[f32]) -> Option<Distance> {
    if real.len().min(other.len()) < ENOUGH { None } else { Distance::between(real, other) }
}

fn mean(distances: impl Iterator<Item = Distance>) -> Option<f64> {
    let ks: Vec<f64> = distances.map(|distance| distance.ks).collect();
    (!ks.is_empty()).then(|| ks.iter().sum::<f64>() / ks.len() as f64)
}
