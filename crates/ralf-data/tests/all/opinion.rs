//! What a second opinion is worth: somebody who knows the truth answers a few things, and the rest is thought over.

use ralf::label::truth_of;
use ralf::learned::Model;
use ralf_data::judge::Certainty;
use ralf_data::result::{LabelledRun, LabelledSequence};
use ralf_data::run::{LabelRun, Unwatched};
use ralf_data::things::{Answer, Change, Extent, SequenceEvidence, SequenceThings};
use ralf_data::{Recording, SequenceReader, Settings};
use ralf_sim::{SimulatedSequence, presets, world};
use std::path::Path;

/// A labelled sequence whose truth is known.
struct Known {
    things: SequenceThings,
    observed: SequenceEvidence,
    /// By detection; `None` of what has no truth.
    truth: Vec<Option<bool>>,
}

impl Known {
    fn new(sequence: SimulatedSequence, jobs: usize) -> Self {
        let recording = Recording::new(Path::new("simulated"), "simulated", vec![Box::new(sequence)]);
        let reader = recording.sequences[0].as_ref();
        let (settings, out) = (Settings::default(), tempfile::tempdir().unwrap());
        LabelRun {
            recording: &recording,
            settings: &settings,
            out: out.path(),
            jobs,
            evidence: false,
            checks: &[],
            model: None,
        }
        .execute(&Unwatched)
        .unwrap();
        let LabelledSequence { rig, settings, tables, .. } =
            LabelledRun::open(out.path()).unwrap().sequence(reader).unwrap();
        let things = SequenceThings::of(reader, &rig, &Certainty::of(&settings), &tables).unwrap();
        let model = Model::shipped().unwrap();
        let whole = Extent { t_ns: 0, scans: usize::MAX, detections: usize::MAX };
        let observed = SequenceEvidence::of(reader, &rig, &settings, &model, &things, whole, jobs).unwrap();
        let truth = truth(reader, &things);
        Self { things, observed, truth }
    }

    fn is_wrong(&self, row: usize) -> bool {
        self.truth[row].is_some_and(|truth| truth != self.things.sightings()[row].plausible)
    }

    /// What somebody says of so many things, most expected errors first: each gets the label that most of it should
    /// have. `corrects`: nothing is said of those that have it.
    fn answered(&self, count: usize, corrects: bool) -> Vec<Option<Answer>> {
        let mut answers = vec![None; self.truth.len()];
        let queue = self.things.doubtful(&answers, usize::MAX, |_| true).things;
        let rows_of = |number: u32| -> Vec<usize> {
            (0..self.truth.len()).filter(|row| self.things.things()[*row] == number).collect()
        };
        let is_wrong =
            |rows: &[usize]| rows.iter().filter(|row| self.is_wrong(**row)).count() * 2 > rows.len();
        let asked =
            queue.iter().map(|thing| rows_of(thing.number)).filter(|rows| !corrects || is_wrong(rows));
        for rows in asked.take(count) {
            let plausible =
                rows.iter().filter(|row| self.truth[**row] == Some(true)).count() * 2 > rows.len();
            for row in rows {
                let right = self.things.sightings()[row].plausible == plausible;
                answers[row] = Some(if right { Answer::Right } else { Answer::Wrong });
            }
        }
        answers
    }

    /// How many labels are wrong once answers and changes count.
    fn wrong(&self, answers: &[Option<Answer>], changes: &[Change]) -> usize {
        let mut flipped: Vec<bool> = answers.iter().map(|answer| *answer == Some(Answer::Wrong)).collect();
        changes.iter().flat_map(|change| &change.rows).for_each(|row| flipped[*row] = true);
        (0..flipped.len())
            .filter(|row| self.truth[*row].is_some() && self.is_wrong(*row) != flipped[*row])
            .count()
    }
}

fn truth(reader: &dyn SequenceReader, things: &SequenceThings) -> Vec<Option<bool>> {
    let mut all = Vec::new();
    for at in things.scans() {
        let labels = reader.truth(at.radar, at.scan).unwrap().unwrap().labels;
        all.extend(labels.iter().map(|label| truth_of(label.id)));
    }
    all
}

/// A line of the table, and how many labels fewer are wrong with the proposals than without.
fn told(name: &str, known: &Known, jobs: usize) -> (String, i64) {
    let before = (0..known.truth.len()).filter(|row| known.is_wrong(*row)).count();
    let mut gain = 0;
    let mut line = format!("{name:12} {:6} {before:6}", known.truth.len());
    for corrects in [false, true] {
        for count in [10, 40] {
            let answers = known.answered(count, corrects);
            let changes = known.things.second_opinion(&known.observed, &answers, jobs);
            let proposed: usize = changes.iter().map(|change| change.rows.len()).sum();
            let (own, after) = (known.wrong(&answers, &[]), known.wrong(&answers, &changes));
            gain += own as i64 - after as i64;
            line += &format!("   {count:2}: {own:5} -> {after:5} ({proposed:5})");
        }
    }
    (line, gain)
}

/// Families of worlds and the preset `paper`: wrong labels before, after 10 and 40 answers, and once the proposal was
/// accepted too, unseen (how many labels it changed); then the same of who only corrects. With
/// `cargo test --release -p ralf-data --test all opinion -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn what_a_second_opinion_is_worth() {
    let jobs = 2;
    println!(
        "sequence     labels  wrong   answers: wrong labels without and with the proposal; of who only corrects"
    );
    let mut gain = 0;
    let mut judge = |name: &str, sequence: SimulatedSequence| {
        let (line, gained) = told(name, &Known::new(sequence, jobs), jobs);
        println!("{line}");
        gain += gained;
    };
    for family in &world::FAMILIES {
        judge(family.name, world::Recording::new(family, 5).sequence(0, 12).unwrap());
    }
    for place in [0, 2] {
        let sequence = &presets::find("paper").unwrap().sequences[place];
        judge(sequence.name, sequence.simulate(0, 25).unwrap());
    }
    assert!(gain > 0, "{gain} labels fewer are wrong with proposals that nobody looked at");
}
