//! What answers about kinds of detections tell of other kinds: how far off a model is in this sequence.
//!
//! A model may be wrong in a world all over, or about what shows one sign. Its log odds `l` are therefore believed as
//! `l + m_s + a + b_s`, with what is usual of a sign, an offset `a` for all and one `b_s` for each sign; before
//! anything is said these two are 0 with a standard deviation of [`WIDE`]. Answers tell them by logistic regression,
//! and how surely.

use super::sign::Sign;
use nalgebra::{SMatrix, SVector};
use ralf::learned::probability;

/// By how much what the shipped model says of what contradicts a label is off as a rule, log odds: it calls too much
/// plausible there, most of all what moves, and least what shows where it is or was seen again.
pub(super) fn usual(sign: Sign) -> f64 {
    match sign {
        Sign::Moves => -2.5,
        Sign::Weak | Sign::Rest => -2.0,
        Sign::Ground | Sign::Behind | Sign::Free | Sign::Again => -1.0,
    }
}

/// The standard deviation of an offset of which nothing was said, log odds.
const WIDE: f64 = 1.0;
/// That by which the detections of a kind are off together beside what others tell of them, log odds.
const OWN: f64 = 0.7;
/// Detections of a kind are alike: however many have an answer, they tell no more than so many.
const TELLING: f64 = 30.0;
/// Steps of Newton's method: it is there after some five.
const STEPS: usize = 15;
/// A step is halved so often at most.
const HALVINGS: usize = 12;

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
            covariance = solved.inverse();
            offsets = descended(lessons, &offsets, &solved.solve(&slope));
        }
        Self { offsets, covariance }
    }

    /// How many labels of a kind are expected to be wrong, and how many fewer there are, on average over how far off
    /// the model may be, once those that are more probably wrong than right have the other label, for who is asked sees
    /// where to draw the line. `contrary`: the model's log odds that each is the other; `way`: 1 where that is
    /// plausible, else -1.
    pub(super) fn worth(&self, sign: Sign, way: f64, contrary: &[f64]) -> (f64, f64) {
        let (s, offset) = (place(sign), self.offset(sign, way));
        let c = &self.covariance;
        let spread = (c[(0, 0)] + 2.0 * c[(0, s)] + c[(s, s)] + OWN * OWN).sqrt();
        let (mut errors, mut worth, mut all) = (0.0, 0.0, 0.0);
        for quarters in -10..=10 {
            let z = f64::from(quarters) / 4.0;
            let weight = (-0.5 * z * z).exp();
            all += weight;
            for l in contrary {
                let wrong = probability(l + offset + spread * z);
                errors += weight * wrong;
                worth += weight * (2.0 * wrong - 1.0).max(0.0);
            }
        }
        // Rounding must not make them more than there are.
        let count = contrary.len() as f64;
        ((errors / all).min(count), (worth / all).min(count))
    }

    /// By how much more than the model says detections with a sign are believed to be the other, log odds.
    pub(super) fn offset(&self, sign: Sign, way: f64) -> f64 {
        way * offset(&self.offsets, sign)
    }
}

/// By how much more detections with a sign are believed to be plausible than the model says, log odds.
fn offset(offsets: &Vector, sign: Sign) -> f64 {
    usual(sign) + offsets[0] + offsets[place(sign)]
}

fn place(sign: Sign) -> usize {
    1 + sign as usize
}

/// As far along a step of Newton's method as it leads downhill: all of it near the least loss, less where that is far
/// and the whole step would lead beyond it, to and fro.
fn descended(lessons: &[Lesson], offsets: &Vector, step: &Vector) -> Vector {
    let before = loss(lessons, offsets);
    let parts = std::iter::successors(Some(1.0), |part| Some(part / 2.0)).take(HALVINGS);
    let mut tried = parts.map(|part| offsets - step * part);
    tried.find(|there| loss(lessons, there) < before).unwrap_or(*offsets)
}

/// The negative logarithm of what the answers and the offsets are worth together, but for a constant.
fn loss(lessons: &[Lesson], offsets: &Vector) -> f64 {
    let of_lesson = |lesson: &Lesson| {
        let offset = offset(offsets, lesson.sign);
        let of_answer = |(log_odds, plausible): &(f64, bool)| {
            let contrary = if *plausible { -log_odds - offset } else { log_odds + offset };
            contrary.max(0.0) + (-contrary.abs()).exp().ln_1p()
        };
        weight(lesson) * lesson.answers.iter().map(of_answer).sum::<f64>()
    };
    offsets.norm_squared() / (2.0 * WIDE * WIDE) + lessons.iter().map(of_lesson).sum::<f64>()
}

/// What each answer of a lesson counts.
fn weight(lesson: &Lesson) -> f64 {
    (TELLING / lesson.answers.len() as f64).min(1.0)
}

/// The first and the second derivative of the loss of a lesson by its log odds.
fn told(lesson: &Lesson, offsets: &Vector) -> (f64, f64) {
    let weight = weight(lesson);
    let offset = offset(offsets, lesson.sign);
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
    fn while_nothing_is_said_the_model_is_believed_as_far_as_it_is_right_as_a_rule_and_more_detections_are_worth_more()
     {
        let heard = Heard::of(&[]);
        let (errors, worth) = heard.worth(Sign::Weak, 1.0, &[5.0; 10]);
        assert!((8.0..10.0).contains(&errors) && worth <= 10.0 && worth >= 2.0 * errors - 10.0);
        let (errors, worth) = heard.worth(Sign::Weak, 1.0, &[0.0; 10]);
        assert!(errors < 3.0 && worth > 0.0, "it may be wrong there, and who is asked can say no");
        assert!(heard.worth(Sign::Weak, 1.0, &[5.0; 100]).1 > heard.worth(Sign::Weak, 1.0, &[5.0; 10]).1);
    }

    #[test]
    fn what_is_said_of_a_sign_is_heard_for_it_more_than_for_others() {
        let lesson = Lesson { sign: Sign::Moves, answers: vec![(4.0, false); 200] };
        let (nothing, heard) = (Heard::of(&[]), Heard::of(&[lesson]));
        let errors = |heard: &Heard, sign| heard.worth(sign, -1.0, &[-4.0; 10]).0;
        assert!(errors(&heard, Sign::Moves) > 2.0 * errors(&nothing, Sign::Moves));
        assert!(errors(&heard, Sign::Weak) > errors(&nothing, Sign::Weak));
        assert!(errors(&heard, Sign::Moves) > errors(&heard, Sign::Weak));
    }

    /// Newton's method alone leaps to and fro here, and ends where the slope isn't nothing.
    #[test]
    fn offsets_are_where_the_loss_is_least_however_far_that_is() {
        let answers = vec![(-4.0, true); 30];
        let lessons = [Lesson { sign: Sign::Weak, answers }];
        let offsets = Heard::of(&lessons).offsets;
        let (slope, _) = told(&lessons[0], &offsets);
        assert!((offsets[0] / (WIDE * WIDE) + slope).abs() < 1e-6, "{offsets} {slope}");
        assert!(offsets[0] > 2.0 && (offsets[0] - offsets[place(Sign::Weak)]).abs() < 1e-9);
    }

    proptest! {
        /// An answer is worth at least what the expected errors say, and never more than all.
        #[test]
        fn worth_keeps_its_bounds(
            said in proptest::collection::vec((0..Sign::ALL.len(), -5.0..5.0f64, any::<bool>(), 0..60usize), 0..6),
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
