//! Which things are worth an answer of a person.

use super::SequenceThings;
use crate::frames::ScanIndex;
use std::collections::BTreeSet;

/// How many answers the machine's own doubt is worth beside those of people about the same thing.
const OWN_ANSWERS: f64 = 2.0;

/// What a person said of a detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// The machine is right.
    Right,
    /// It is wrong.
    Wrong,
}

/// A thing, as the queue shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Thing {
    /// Its number.
    pub number: u32,
    /// The middle of its detections in the odometry frame, m.
    pub place: [f64; 3],
    /// How far its detections lie from there at most, in the plane, m.
    pub radius: f64,
    /// How many detections it has.
    pub detections: usize,
    /// In how many scans.
    pub scans: usize,
    /// How many of them the machine calls plausible.
    pub plausible: usize,
    /// How many have an answer.
    pub answered: usize,
    /// How many wrong labels are expected among those without an answer.
    pub expected_errors: f64,
    /// A detection near the middle of its life: its scan, and its place in that.
    pub seen: (ScanIndex, usize),
}

/// What wants an answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubtful {
    /// Those with the most expected errors first.
    pub things: Vec<Thing>,
    /// Of all things, those that are not among these too.
    pub expected_errors: f64,
}

impl SequenceThings {
    /// What is left to ask of each detection: the machine's own doubt, and what people said of others of the thing.
    /// With `k` of `m` answers that the machine was wrong, an `e` becomes `(2 e + k) / (2 + m)`; nothing is left of a
    /// detection that has an answer.
    pub fn expected_errors(&self, answers: &[Option<Answer>]) -> Vec<f64> {
        let mut said = vec![(0.0, 0.0); self.count()];
        for (thing, answer) in self.things().iter().zip(answers) {
            let (all, wrong) = &mut said[*thing as usize];
            *all += f64::from(u8::from(answer.is_some()));
            *wrong += f64::from(u8::from(*answer == Some(Answer::Wrong)));
        }
        let own = self.things().iter().zip(self.own_doubt()).zip(answers);
        own.map(|((thing, own), answer)| {
            let (all, wrong) = said[*thing as usize];
            let left = (OWN_ANSWERS * f64::from(*own) + wrong) / (OWN_ANSWERS + all);
            if answer.is_some() { 0.0 } else { left }
        })
        .collect()
    }

    /// The things of which something is left to ask in these scans, at most so many, those with the most expected
    /// errors in them first.
    pub fn doubtful(
        &self,
        answers: &[Option<Answer>],
        most: usize,
        asks: impl Fn(ScanIndex) -> bool,
    ) -> Doubtful {
        let mut errors = self.expected_errors(answers);
        for scan in self.scans().iter().filter(|scan| !asks(**scan)) {
            errors[self.rows_of(*scan)].fill(0.0);
        }
        let mut left = vec![0.0; self.count()];
        for (thing, error) in self.things().iter().zip(&errors) {
            left[*thing as usize] += error;
        }
        let mut numbers: Vec<usize> = (0..self.count()).filter(|number| left[*number] > 0.0).collect();
        numbers.sort_by(|a, b| left[*b].total_cmp(&left[*a]).then(a.cmp(b)));
        numbers.truncate(most);
        let members = self.members();
        let thing = |number: &usize| self.thing(*number as u32, &members[*number], left[*number], answers);
        Doubtful { things: numbers.iter().map(thing).collect(), expected_errors: left.iter().sum() }
    }

    /// Tells of things, by their numbers, as they are before anybody has said anything.
    pub fn described(&self) -> impl Fn(u32) -> Thing {
        let (members, nobody) = (self.members(), vec![None; self.things().len()]);
        move |number| {
            let rows = &members[number as usize];
            let doubt = rows.iter().map(|row| f64::from(self.own_doubt()[*row])).sum();
            self.thing(number, rows, doubt, &nobody)
        }
    }

    /// The detections of each thing, in rising order.
    pub(super) fn members(&self) -> Vec<Vec<usize>> {
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); self.count()];
        for (row, thing) in self.things().iter().enumerate() {
            members[*thing as usize].push(row);
        }
        members
    }

    pub(super) fn thing(
        &self,
        number: u32,
        rows: &[usize],
        expected_errors: f64,
        answers: &[Option<Answer>],
    ) -> Thing {
        let sightings = self.sightings();
        let mut place = [0.0; 3];
        for row in rows {
            for (sum, metres) in place.iter_mut().zip(sightings[*row].place) {
                *sum += metres / rows.len() as f64;
            }
        }
        let apart = |row: &usize| {
            let [x, y, _] = sightings[*row].place;
            (x - place[0]).hypot(y - place[1])
        };
        let mut by_time: Vec<usize> = rows.to_vec();
        by_time.sort_by_key(|row| (sightings[*row].t_ns, *row));
        let scans: BTreeSet<ScanIndex> = rows.iter().map(|row| self.scan_of(*row)).collect();
        let middle = by_time[rows.len() / 2];
        Thing {
            number,
            place,
            radius: rows.iter().map(apart).fold(0.0, f64::max),
            detections: rows.len(),
            scans: scans.len(),
            plausible: rows.iter().filter(|row| sightings[**row].plausible).count(),
            answered: rows.iter().filter(|row| answers[**row].is_some()).count(),
            expected_errors,
            seen: self.place_of(middle),
        }
    }
}
