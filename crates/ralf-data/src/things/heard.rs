//! What answers about kinds of detections tell of other kinds: how far off a model is in this sequence.
//!
//! A model may be wrong in a world all over, or about what shows one sign. Its log odds `l` are therefore believed as
//! `l + a + b_s`, with an offset `a` for all and one `b_s` for each sign; before anything is said each is 0 with a
//! standard deviation of [`WIDE`]. Answers tell the offsets by logistic regression, and how surely.

use super::sign::Sign;
use nalgebra::{SMatrix, SVector};
use ralf::learned::probability;

/// The standard deviation of an offset of which nothing was said, log odds.
const WIDE: f64 = 1.0;
/// That by which the detections of a kind are off together beside what others tell of them, log odds.
const OWN: f64 = 0.7;
/// Detections of a kind are alike: however many have an answer, they tell no more than so many.
const TELLING: f64 = 30.0;
/// Steps of Newton's method: it is there after some five.
const STEPS: usize = 15;

/// One offset for all, and one for each sign.
const OFFSETS: usize = 1 + Sign::ALL.len();
type Vector = SVector<f64, OFFSETS>;
type Matrix = SMatrix<f64, OFFSETS, OFFSETS>;

/// What was said of detections of one kind.
pub(super) struct Lesson {
    pub(super) sign: Sign,
    /// By detection: the model's log odds that it is plausible, and whether it is.
    pub(super) answers: Vec<(f64, bool)>,
}

/// How far off the model is, as far as answers tell.
pub(super) struct Heard {
    offsets: Vector,
    covariance: Matrix,
}

impl Heard {
    /// Of these answers, in this order.
    pub(super) fn of(lessons: &[Lesson]) -> Self {
        let mut offsets = Vector::zeros();
        let mut covariance = Matrix::identity() * (WIDE * WIDE);
        for _ in 0..STEPS {
            let (mut slope, mut bend) = (offsets / (WIDE * WIDE), Matrix::identity() / (WIDE * WIDE));
            for lesson in lessons {
                let (first, bent) = told(lesson, &offsets);
                for i in [0, place(lesson.sign)] {
                    slope[i] += first;
                    for j in [0, place(lesson.sign)] {
                        bend[(i, j)] += bent;
                    }
                }
            }
            // What is on the diagonal makes it definite.
            let Some(solved) = bend.cholesky() else { break };
            offsets -= solved.solve(&slope);
            covariance = solved.inverse();
        }
        Self { offsets, covariance }
    }

    /// How many labels of a kind are expected to be wrong, and how many fewer there are, on average over how far off
    /// the model may be, once all have the other label where that mends more than it breaks, and stay where it
    /// doesn't. `contrary`: the model's log odds that each is the other; `way`: 1 where that is plausible, else -1.
    pub(super) fn worth(&self, sign: Sign, way: f64, contrary: &[f64]) -> (f64, f64) {
        let s = place(sign);
        let offset = way * (self.offsets[0] + self.offsets[s]);
        let c = &self.covariance;
        let spread = (c[(0, 0)] + 2.0 * c[(0, s)] + c[(s, s)] + OWN * OWN).sqrt();
        let (mut errors, mut worth, mut all) = (0.0, 0.0, 0.0);
        for quarters in -10..=10 {
            let z = f64::from(quarters) / 4.0;
            let weight = (-0.5 * z * z).exp();
            let wrong: f64 = contrary.iter().map(|l| probability(l + offset + spread * z)).sum();
            all += weight;
            errors += weight * wrong;
            worth += weight * (2.0 * wrong - contrary.len() as f64).max(0.0);
        }
        (errors / all, worth / all)
    }
}

fn place(sign: Sign) -> usize {
    1 + sign as usize
}

/// The first and the second derivative of the loss of a lesson by its log odds.
fn told(lesson: &Lesson, offsets: &Vector) -> (f64, f64) {
    let weight = (TELLING / lesson.answers.len() as f64).min(1.0);
    let offset = offsets[0] + offsets[place(lesson.sign)];
    let derivatives = lesson.answers.iter().map(|(log_odds, plausible)| {
        let p = probability(log_odds + offset);
        (p - f64::from(u8::from(*plausible)), p * (1.0 - p))
    });
    derivatives.fold((0.0, 0.0), |(first, second), (a, b)| (first + weight * a, second + weight * b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn while_nothing_is_said_the_model_is_believed_and_more_detections_are_worth_more() {
        let heard = Heard::of(&[]);
        let (errors, worth) = heard.worth(Sign::Weak, 1.0, &[3.0; 10]);
        assert!((8.0..10.0).contains(&errors) && worth <= 10.0 && worth >= 2.0 * errors - 10.0);
        let (errors, worth) = heard.worth(Sign::Weak, 1.0, &[-2.0; 10]);
        assert!(errors < 3.0 && worth > 0.0, "it may be wrong there, and who is asked can say no");
        assert!(heard.worth(Sign::Weak, 1.0, &[3.0; 100]).1 > heard.worth(Sign::Weak, 1.0, &[3.0; 10]).1);
    }

    #[test]
    fn what_is_said_of_a_sign_is_heard_for_it_more_than_for_others() {
        let lesson = Lesson { sign: Sign::Moves, answers: vec![(2.0, false); 200] };
        let (nothing, heard) = (Heard::of(&[]), Heard::of(&[lesson]));
        let errors = |heard: &Heard, sign| heard.worth(sign, -1.0, &[-2.0; 10]).0;
        assert!(errors(&heard, Sign::Moves) > 2.0 * errors(&nothing, Sign::Moves));
        assert!(errors(&heard, Sign::Weak) > errors(&nothing, Sign::Weak));
        assert!(errors(&heard, Sign::Moves) > errors(&heard, Sign::Weak));
    }

    proptest! {
        /// An answer is worth at least what the expected errors say, and never more than all.
        #[test]
        fn worth_keeps_its_bounds(
            said in proptest::collection::vec((0..7usize, -5.0..5.0f64, any::<bool>(), 0..60usize), 0..6),
            contrary in proptest::collection::vec(-5.0..5.0f64, 0..30),
        ) {
            let lessons: Vec<Lesson> = said
                .into_iter()
                .map(|(sign, l, is, many)| Lesson { sign: Sign::ALL[sign], answers: vec![(l, is); many] })
                .collect();
            let heard = Heard::of(&lessons);
            for sign in Sign::ALL {
                let (errors, worth) = heard.worth(sign, 1.0, &contrary);
                let count = contrary.len() as f64;
                prop_assert!((0.0..=count).contains(&errors));
                prop_assert!(worth >= 0.0 && worth >= 2.0 * errors - count - 1e-9 && worth <= count + 1e-9);
            }
        }
    }
}
