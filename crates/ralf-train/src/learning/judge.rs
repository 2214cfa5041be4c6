//! How good models are in worlds that they never saw.

use super::calibrate::{Answered, calibration};
use super::fitting::Fitting;
use super::scores::{Scored, Scores, best_threshold, scored};
use super::suite::{SUITES, SuiteScores, suites_of};
use super::table::{Known, TrainingTable, scans_of};
use super::view::View;
use ralf::learned::{Weighing, World};

/// How well a model labels a world that it was not fitted to.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// The world.
    pub world: String,
    /// Detections.
    pub detections: usize,
    /// Plausible ones.
    pub plausible: usize,
    /// What the model is worth at the threshold that is best in the other worlds, with all evidence.
    pub learned: Scores,
    /// The same at the threshold of the settings.
    pub at_threshold: Scores,
    /// What the paper's method is worth, with its settings.
    pub paper: Scores,
    /// What the model and the paper's method are worth where less can be observed, and by sensors.
    pub suites: Vec<SuiteScores>,
}

/// Rows of some worlds, in which every world counts the same, but where it has few ([`World::say_of`]).
pub(super) fn answered(table: &TrainingTable, log_odds: &[f64], of: impl Fn(u16) -> bool) -> Vec<Answered> {
    let (mut rows, mut detections) = (vec![0.0; table.worlds.len()], vec![0; table.worlds.len()]);
    for known in &table.known {
        rows[usize::from(known.world)] += 1.0;
        detections[usize::from(known.world)] += u64::from(known.view == View::Whole);
    }
    let says: Vec<f64> = detections.into_iter().map(World::say_of).collect();
    let all: f64 = says.iter().sum();
    let mut found = Vec::new();
    for (known, log_odds) in table.known.iter().zip(log_odds).filter(|(known, _)| of(known.world)) {
        let world = usize::from(known.world);
        // Where each has its full say, `all / says` is how many they are, to the bit.
        let weight = table.len() as f64 / (all / says[world] * rows[world]);
        found.push(Answered { log_odds: *log_odds, plausible: known.plausible, weight });
    }
    found
}

/// Every world by the others' calibration and threshold.
pub(super) fn judge(table: &TrainingTable, log_odds: &[f64], fitting: &Fitting) -> Vec<LeftOut> {
    let suites_of = suites_of(table);
    let whole: Vec<usize> = (0..table.len()).filter(|row| table.known[*row].view == View::Whole).collect();
    let mut all = Vec::new();
    for (number, name) in table.worlds.iter().enumerate() {
        let is_here = |row: &usize| usize::from(table.known[*row].world) == number;
        let (here, others): (Vec<usize>, Vec<usize>) = whole.iter().copied().partition(is_here);
        let stranger = Stranger::new(table, log_odds, number as u16, fitting);
        let elsewhere = best_threshold(&stranger.judged(&others));
        let mut suites = Vec::new();
        for (bit, name) in SUITES.into_iter().enumerate() {
            let is_of = |row: &usize| is_here(row) && suites_of[*row] >> bit & 1 == 1;
            let rows: Vec<usize> = (0..table.len()).filter(is_of).collect();
            if !rows.is_empty() {
                let learned = Scores::new(&stranger.judged(&rows), elsewhere);
                suites.push(SuiteScores {
                    name,
                    detections: rows.len(),
                    learned,
                    paper: paper(table, &rows),
                });
            }
        }
        let judged = stranger.judged(&here);
        all.push(LeftOut {
            world: name.clone(),
            detections: here.len(),
            plausible: judged.iter().filter(|row| row.plausible).count(),
            learned: Scores::new(&judged, elsewhere),
            at_threshold: Scores::new(&judged, fitting.threshold),
            paper: paper(table, &here),
            suites,
        });
    }
    all
}

/// What is said of rows of a world by a model that knows nothing of it. Its calibration is told by other worlds, of
/// which models spoke that know this one: a line and a share, no more.
struct Stranger<'a> {
    table: &'a TrainingTable,
    log_odds: &'a [f64],
    weighing: Weighing,
}

impl<'a> Stranger<'a> {
    fn new(table: &'a TrainingTable, log_odds: &'a [f64], world: u16, fitting: &Fitting) -> Self {
        let others = answered(table, log_odds, |other| other != world);
        let names = table.features.iter().map(|feature| feature.name);
        let line = calibration(&others);
        let weighing = Weighing::as_calibrated(line, share(&others), names, &fitting.learned);
        Self { table, log_odds, weighing }
    }

    /// Of rows in rising order: those of a scan are all that are judged of it.
    fn judged(&self, rows: &[usize]) -> Vec<Scored> {
        let known: Vec<Known> = rows.iter().map(|row| self.table.known[*row]).collect();
        let mut judged = Vec::with_capacity(rows.len());
        for scan in scans_of(&known) {
            let of = &rows[scan.clone()];
            let log_odds: Vec<f64> = of.iter().map(|row| self.log_odds[*row]).collect();
            let rows = self.table.rows.pick(of.iter().copied());
            judged.extend(scored(self.weighing.plausibilities(&rows, &log_odds), &known[scan]));
        }
        judged
    }
}

/// The share that is plausible where a calibration comes from.
fn share(answered: &[Answered]) -> f64 {
    let of =
        |is: fn(&Answered) -> bool| answered.iter().filter(|row| is(row)).map(|row| row.weight).sum::<f64>();
    of(|row| row.plausible) / of(|_| true).max(f64::MIN_POSITIVE)
}

/// What the paper's method is worth in some rows.
fn paper(table: &TrainingTable, rows: &[usize]) -> Scores {
    let judged = |score: fn(&Known) -> f64| -> Vec<Scored> {
        let known = rows.iter().map(|row| &table.known[*row]);
        known.map(|known| Scored { score: score(known), plausible: known.plausible }).collect()
    };
    let by_label = Scores::new(&judged(|known| if known.paper_label { 1.0 } else { 0.0 }), 0.5);
    let by_w = Scores::new(&judged(|known| known.paper.into()), 0.5);
    Scores { f1: by_label.f1, accuracy: by_label.accuracy, ..by_w }
}

impl LeftOut {
    /// For the model's file.
    pub(super) fn told(&self) -> World {
        let scores = Scores::told([("", &self.learned), ("paper_", &self.paper)]);
        let (detections, plausible) = (self.detections as u64, self.plausible as u64);
        World { name: self.world.clone(), detections, plausible, scores }
    }
}
