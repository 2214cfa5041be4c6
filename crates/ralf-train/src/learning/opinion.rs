//! A second opinion on the labels of a sequence, once a person has said what some of them should be.

use super::boosting::{Bins, Examples, Parameters, boost};
use ralf::learned::{Rows, probability};
use ralf_jobs::side_by_side;
use std::convert::Infallible;

/// What is believed of a detection before it is thought over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Believed {
    /// What a person said, else what the machine says.
    pub plausible: bool,
    /// Whether a person said it.
    pub said: bool,
    /// How sure the machine is, 0 to 1; of what a person said it doesn't matter.
    pub sure: f32,
    /// What it belongs to: things are judged by forests that saw nothing of what the machine says of them.
    pub thing: u32,
}

/// How much what the machine says of a detection counts beside what a person said of one: where it is sure, and where
/// it isn't at all.
const SURE: f32 = 0.3;
const UNSURE: f32 = 0.03;
/// Things are dealt to so many groups, each judged by a forest that was grown on the others and on what was said.
const GROUPS: u32 = 3;
/// Few rows tell little: small trees, and not many.
const PARAMETERS: Parameters = Parameters {
    rounds: 80,
    leaves: 12,
    rate: 0.1,
    feature_fraction: 0.5,
    bagging: 0.7,
    l2: 5.0,
    rows_per_leaf: 20,
    seed: 0,
};

/// How probably each detection is plausible, after what was said of others. `monotone` is by feature 1 where more of it
/// never makes a detection less plausible, -1 where never more, else 0. The answer doesn't depend on `jobs`.
pub fn second_opinion(rows: &Rows, monotone: &[i8], believed: &[Believed], jobs: usize) -> Vec<f64> {
    let bins = Bins::new(rows);
    let target: Vec<bool> = believed.iter().map(|one| one.plausible).collect();
    let weights: Vec<f32> = believed.iter().map(weight).collect();
    let (bins, target, weights) = (&bins, &target, &weights);
    let examples = Examples { rows, bins, target, weights, monotone, begin: None };
    let groups: Vec<u32> = (0..GROUPS).collect();
    let Ok(opinions) = side_by_side(&groups, jobs, |group| {
        let (mut train, mut asked) = (Vec::new(), Vec::new());
        for (row, one) in believed.iter().enumerate() {
            let is_asked = one.thing % GROUPS == *group;
            if is_asked {
                asked.push(row);
            }
            if one.said || !is_asked {
                train.push(row as u32);
            }
        }
        let forest = boost(&examples, &train, &PARAMETERS).forest;
        let answers = forest.log_odds(&rows.pick(asked.iter().copied()));
        Ok::<_, Infallible>(asked.into_iter().zip(answers).collect::<Vec<(usize, f64)>>())
    });
    let mut probabilities = vec![0.0; believed.len()];
    for (row, log_odds) in opinions.into_iter().flatten() {
        probabilities[row] = probability(log_odds);
    }
    probabilities
}

fn weight(one: &Believed) -> f32 {
    if one.said { 1.0 } else { UNSURE + (SURE - UNSURE) * one.sure }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Things of ten detections, in two features: the machine calls all with a first feature above 0 plausible.
    fn things() -> (Rows, Vec<Believed>) {
        let mut rows = Rows::absent(2000, 2);
        let mut believed = Vec::new();
        for row in 0..2000 {
            let thing = row as u32 / 10;
            let first = (thing as f32 * 0.618).fract() * 2.0 - 1.0;
            let second = (thing as f32 * 0.414).fract() * 2.0 - 1.0;
            rows.row_mut(row).copy_from_slice(&[first, second]);
            believed.push(Believed { plausible: first > 0.0, said: false, sure: 1.0, thing });
        }
        (rows, believed)
    }

    #[test]
    fn where_nobody_contradicts_the_machine_it_is_believed() {
        let (rows, believed) = things();
        let opinion = second_opinion(&rows, &[0, 0], &believed, 2);
        for (one, p) in believed.iter().zip(&opinion) {
            assert!(one.plausible == (*p > 0.5) || (0.2..0.8).contains(p), "{one:?}: {p}");
        }
    }

    /// What has a second feature above 0.5 is no target, and a person says so of two things in three.
    #[test]
    fn what_was_said_of_some_is_heard_for_those_like_them() {
        let (rows, mut believed) = things();
        let is_wrong = |row: usize| rows.row(row)[0] > 0.0 && rows.row(row)[1] > 0.5;
        for (row, one) in believed.iter_mut().enumerate() {
            if is_wrong(row) && one.thing % 3 != 0 {
                (one.plausible, one.said) = (false, true);
            }
        }
        let opinion = second_opinion(&rows, &[0, 0], &believed, 1);
        assert_eq!(opinion, second_opinion(&rows, &[0, 0], &believed, 3));
        let (mut heard, mut of, mut lost) = (0, 0, 0);
        for (row, one) in believed.iter().enumerate().filter(|(_, one)| !one.said) {
            if is_wrong(row) {
                of += 1;
                heard += usize::from(opinion[row] < 0.5);
            } else {
                lost += usize::from(one.plausible != (opinion[row] > 0.5));
            }
        }
        assert!(heard * 10 > of * 8 && lost * 20 < 2000, "{heard} of {of} heard, {lost} lost");
    }
}
