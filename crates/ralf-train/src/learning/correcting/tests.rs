use super::super::testing::{small, table};
use super::super::{Fitting, fit};
use super::*;
use ralf::config::Config;
use ralf::learned::Calibration;
use std::sync::LazyLock;

/// A model of the first feature, fitted once.
fn begin() -> &'static Model {
    static MODEL: LazyLock<Model> = LazyLock::new(|| {
        let fitting = Fitting {
            parameters: Parameters { rounds: 20, rows_per_leaf: 20, ..Parameters::default() },
            net: Some(small()),
            expects: Some(0.3),
            blanking: false,
            causes: false,
            threshold: 0.5,
            learned: Config::default().learned,
            jobs: 2,
        };
        fit(&table(150, 10), &fitting, Origin::default(), &|_, _| {}).unwrap().model
    });
    &MODEL
}

/// Recordings in which, of what the model takes for plausible, all with a second feature above 0.4 is none.
fn own(scans: u32) -> TrainingTable {
    let mut own = table(scans, 10);
    for row in 0..own.len() {
        own.known[row].plausible &= !is_other(&own, row);
    }
    own
}

fn is_other(table: &TrainingTable, row: usize) -> bool {
    table.rows.row(row)[1] > 0.4
}

fn correcting(jobs: usize) -> Correcting {
    let Config { learned, .. } = Config::default();
    Correcting { parameters: Correcting::trees(), threshold: 0.5, learned, jobs }
}

fn corrected(table: &TrainingTable, jobs: usize) -> Result<CorrectedModel, LearnError> {
    correct(begin(), table, &correcting(jobs), Origin::default(), &|_, _| {})
}

/// Whether each row is plausible to a model.
fn labels(model: &Model, table: &TrainingTable) -> Vec<bool> {
    Says::new(model, table, &Config::default().learned)
        .unwrap()
        .at_last
        .into_iter()
        .map(|says| says > 0.0)
        .collect()
}

/// How many rows of those asked for a model labels otherwise than is true.
fn wrong(model: &Model, table: &TrainingTable, of: fn(&TrainingTable, usize) -> bool) -> usize {
    let labels = labels(model, table);
    (0..table.len()).filter(|row| of(table, *row) && labels[*row] != table.known[*row].plausible).count()
}

#[test]
fn what_was_said_of_other_sequences_is_heard_and_the_model_is_the_same_whatever_the_number_of_jobs() {
    let own = own(90);
    let found = corrected(&own, 1).unwrap();
    assert_eq!(found, corrected(&own, 3).unwrap());
    assert_eq!(found.judged.len(), 3);
    for Judged { world, turns, before, after } in &found.judged {
        assert_eq!((turns.said, turns.left_alone, turns.turned), (300, 0, Some(0)));
        assert!(turns.wrong_after.unwrap() * 2 < turns.wrong_before, "{world}: {turns:?}");
        let (before, after) = (before.f1.unwrap(), after.f1.unwrap());
        assert!(before < 0.8 && after > 0.85, "{world}: {before} {after}");
    }
    assert_eq!(found.model.check(), Ok(()));
    assert_eq!(Model::from_text(&found.model.to_text()).unwrap(), found.model);
    assert_eq!(found.model.origin.worlds, begin().origin.worlds);
    let told = found.model.corrected.unwrap().worlds;
    assert_eq!(
        told.iter().map(|world| world.name.as_str()).collect::<Vec<_>>(),
        ["town", "motorway", "yard"]
    );
    assert_eq!(told[0].scores[0].0, "f1");
}

/// Nobody says anything of what the model labels right: it must not learn that all is wrong.
#[test]
fn who_corrects_errors_alone_changes_what_is_like_them() {
    let mut own = own(90);
    for (row, is_right) in labels(begin(), &own).into_iter().enumerate() {
        own.known[row].said = is_right != own.known[row].plausible && is_other(&own, row);
        // What nobody knows means nothing.
        own.known[row].plausible &= own.known[row].said;
    }
    let CorrectedModel { model: found, judged } = corrected(&own, 2).unwrap();
    let all: Turns = judged.iter().map(|judged| judged.turns).sum();
    assert!(all.wrong_before == all.said && all.wrong_after.unwrap() * 2 < all.said, "{all:?}");
    assert!(all.left_alone == 900 - all.said && all.turned.unwrap() * 20 < all.left_alone, "{all:?}");
    let truth = self::own(90);
    let count = |model| {
        [is_other, |table: &TrainingTable, row| !is_other(table, row)].map(|of| wrong(model, &truth, of))
    };
    let ([others_before, rest_before], [others, rest]) = (count(begin()), count(&found));
    assert!(others * 3 < others_before, "{others} of {others_before} are wrong still");
    assert!(
        rest < rest_before + 30,
        "{rest} in place of {rest_before} are wrong of those nobody complained of"
    );
}

/// Who corrects labels of a corrected model leaves alone what that one has right.
#[test]
fn what_is_left_alone_counts_as_it_was_shown() {
    let truth = own(90);
    let mut own = truth.clone();
    for (row, known) in own.known.iter_mut().enumerate() {
        (known.said, known.shown) = (row % 10 == 0, Some(known.plausible));
    }
    let found = corrected(&own, 2).unwrap().model;
    own.known.iter_mut().for_each(|known| known.shown = None);
    let without = corrected(&own, 2).unwrap().model;
    let [shown, unknown] = [&found, &without].map(|model| wrong(model, &truth, is_other));
    assert!(shown * 2 < unknown, "{shown} {unknown}");
}

#[test]
fn where_people_say_what_the_model_says_labels_stay() {
    let mut own = table(60, 10);
    let before = Says::new(begin(), &own, &Config::default().learned).unwrap().at_last;
    own.known.iter_mut().zip(&before).for_each(|(known, says)| known.plausible = *says > 0.0);
    let after = labels(&corrected(&own, 2).unwrap().model, &own);
    // Where the model itself is nearly undecided it may turn.
    let is_sure = |says: &f64| says.abs() > 0.5;
    let turned = before.iter().zip(after).filter(|(says, label)| is_sure(says) && (**says > 0.0) != *label);
    assert_eq!(turned.count(), 0);
    assert!(before.iter().filter(|says| is_sure(says)).count() > 500);
}

#[test]
fn one_sequence_alone_is_judged_part_by_part_and_one_scan_not_at_all() {
    let mut own = own(90);
    own.known.iter_mut().for_each(|known| known.said &= known.world == 1);
    let found = corrected(&own, 2).unwrap();
    let [Judged { world, turns: Turns { said: 300, .. }, after, .. }] = &found.judged[..] else {
        panic!("{:?}", found.judged)
    };
    assert!(world == "motorway" && after.f1.unwrap() > 0.85, "{after:?}");
    own.known.iter_mut().for_each(|known| known.said &= known.scan == 4);
    let found = corrected(&own, 2).unwrap();
    let [Judged { turns, before, after, .. }] = &found.judged[..] else { panic!("{:?}", found.judged) };
    assert!(before.accuracy.is_some() && *after == Default::default());
    assert_eq!((turns.said, turns.wrong_after, turns.turned), (10, None, None));
    assert_eq!(Model::from_text(&found.model.to_text()).unwrap(), found.model);
}

#[test]
fn more_sequences_than_parts_are_each_judged() {
    let mut own = own(92);
    own.worlds = (0..23).map(|world| format!("{world:02}")).collect();
    own.known.iter_mut().for_each(|known| known.world = (known.scan % 23) as u16);
    let found = corrected(&own, 2).unwrap();
    assert_eq!(found.judged.len(), 23);
    assert!(found.judged.iter().all(|judged| judged.after.accuracy.is_some()));
}

#[test]
fn what_was_not_seen_before_is_familiar_where_it_was_corrected() {
    let mut own = own(30);
    (0..own.len()).for_each(|row| own.rows.row_mut(row)[2] += 100.0);
    let found = corrected(&own, 1).unwrap().model;
    let (before, after) = (begin().inputs[2].seen, found.inputs[2].seen);
    assert!(before.high < 2.0 && after.high > 99.0 && after.low == before.low, "{before:?} {after:?}");
}

#[test]
fn silence_one_class_a_corrected_model_and_missing_evidence_are_refused() {
    let mut own = own(30);
    let once = corrected(&own, 1).unwrap().model;
    let twice = correct(&once, &own, &correcting(1), Origin::default(), &|_, _| {});
    assert_eq!(twice, Err(LearnError::AlreadyCorrected));
    let mut level = begin().clone();
    level.calibration = Calibration::new(vec![(-1.0, 0.3), (2.0, 0.45)]).unwrap();
    let same = correct(&level, &own, &correcting(1), Origin::default(), &|_, _| {});
    assert_eq!(same, Err(LearnError::SaysTheSame { low: 0.3, high: 0.45 }));
    let blind = own.without_groups(&[own.features[0].group.to_owned()]);
    assert!(matches!(corrected(&blind, 1), Err(LearnError::Use(_))));
    own.known.iter_mut().for_each(|known| known.plausible = false);
    let one_class = corrected(&own, 1);
    assert_eq!(one_class, Err(LearnError::OneClass { plausible: 0, artifacts: own.len() }));
    own.known.iter_mut().for_each(|known| known.said = false);
    assert_eq!(corrected(&own, 1), Err(LearnError::NothingSaid));
}
