use super::*;
use crate::table::Row;
use crate::{DetectionMismatches, Weights};
use crate::{Space, check_folds, leave_one_out};

const SCAN: usize = 20;

/// Detections whose truth follows from planted weights, with `K` = 2 and `n_b` = 3; the other mismatches mean nothing.
pub(crate) fn planted(seed: u64, scans: usize) -> MismatchTable {
    let config = Config::from_toml(
        "",
        &[
            "fusion.alpha=0.2",
            "fusion.threshold=0.3",
            "lidar.beta=1.0",
            "camera.beta=0.05",
            "tracking.beta=0.1",
        ],
    );
    let weights = Weights::from(&config.unwrap());
    let space = Space { neighbours: vec![2, 3], scans: vec![3, 5] };
    let mut table = MismatchTable::new(space);
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    for _ in 0..scans {
        let rows: Vec<Row> = (0..SCAN).map(|_| row(&mut rng, &weights)).collect();
        table.push_scan(rows);
    }
    table
}

fn row(rng: &mut Pcg64Mcg, weights: &Weights) -> Row {
    let d = |rng: &mut Pcg64Mcg| rng.random_bool(0.9).then(|| rng.random_range(0.0..20.0));
    let [lm, other_lm, cm, tr, other_tr] = std::array::from_fn(|_| d(rng));
    let rest = DetectionMismatches {
        d_lm: lm,
        d_cm: cm,
        d_tr: tr,
        on_floor: false,
        in_blind_spot: rng.random_bool(0.3),
        gamma_s: rng.random_range(1.0..1.2),
    };
    Row { plausible: rest.is_plausible(weights), rest, d_lm: vec![lm, other_lm], d_tr: vec![tr, other_tr] }
}

fn search(base: &Config, trials: usize) -> Search<'_> {
    Search { base, objective: Objective::F1, trials, seed: 1, held: vec![] }
}

#[test]
fn a_planted_optimum_is_found_and_holds_on_other_detections() {
    let (train, test) = (planted(1, 50), planted(2, 50));
    let base = Config::default();
    let at_base = search(&base, 0).run(&[&train], &mut |_, _| {}).unwrap();
    assert!(at_base.score < 0.75, "the start must leave something to be found: {at_base:?}");
    let found = search(&base, 400).run(&[&train], &mut |_, _| {}).unwrap();
    assert_eq!((found.settings.neighbours, found.settings.scans), (2, 3));
    assert!(found.score > 0.95, "{found:?}");
    let counts = test.confusions(&found.settings).unwrap().into_iter().sum();
    assert!(Objective::F1.score(&counts) > 0.93, "{counts:?}");
}

#[test]
fn the_score_is_what_the_settings_reach_and_the_best_never_gets_worse() {
    let train = planted(3, 20);
    let base = Config::default();
    let mut seen = Vec::new();
    let found = search(&base, 40).run(&[&train], &mut |trial, best| seen.push((trial, best.score))).unwrap();
    let counts = train.confusions(&found.settings).unwrap().into_iter().sum();
    assert_eq!(Objective::F1.score(&counts), found.score);
    assert!(seen.iter().map(|(trial, _)| *trial).eq(1..=40));
    assert!(seen.is_sorted_by(|a, b| a.1 <= b.1));
    let own = train.confusions(&TunedSettings::from_config(&base)).unwrap().into_iter().sum();
    assert!(Objective::F1.score(&own) <= seen[0].1);
}

#[test]
fn a_seed_repeats_its_search() {
    let (train, base) = (planted(4, 10), Config::default());
    let run = |seed| Search { seed, ..search(&base, 60) }.run(&[&train], &mut |_, _| {}).unwrap();
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).settings, run(2).settings);
}

#[test]
fn the_floor_of_precision_is_kept() {
    let (train, base) = (planted(5, 30), Config::default());
    for floor in [0.5, 0.9] {
        let objective = Objective::RecallAtPrecision(floor);
        let found = Search { objective, ..search(&base, 80) }.run(&[&train], &mut |_, _| {}).unwrap();
        assert!(objective.is_met(found.score));
        let counts = train.confusions(&found.settings).unwrap().into_iter().sum();
        assert!(ralf::metrics::Rates::new(&counts).precision_plausible.unwrap() >= floor);
    }
}

#[test]
fn what_says_nothing_keeps_its_setting() {
    let space = Space { neighbours: vec![2, 3], scans: vec![3, 5] };
    let mut table = MismatchTable::new(space);
    let rest = DetectionMismatches::NOTHING;
    let row = |plausible: bool| {
        let d = if plausible { 1.0 } else { 9.0 };
        Row { rest, d_lm: vec![None; 2], d_tr: vec![Some(d), Some(10.0 - d)], plausible }
    };
    table.push_scan([row(true), row(false)]);
    let base = Config::default();
    let found = search(&base, 30).run(&[&table], &mut |_, _| {}).unwrap();
    let weights = found.settings.weights;
    assert_eq!(found.score, 1.0);
    let own = Weights::from(&base);
    assert_eq!((weights.beta_lm, weights.beta_cm), (own.beta_lm, own.beta_cm));
    assert_eq!(weights.fusion.alpha, own.fusion.alpha);
    assert_eq!((found.settings.neighbours, found.settings.scans), (3, 3));
}

#[test]
fn what_is_held_stays_and_the_rest_is_searched() {
    let (train, base) = (planted(6, 20), Config::default());
    for key in TunedSettings::KEYS {
        let found = Search { held: vec![key.to_owned()], ..search(&base, 60) };
        let found = found.run(&[&train], &mut |_, _| {}).unwrap();
        let own = TunedSettings::from_config(&base).entries();
        for ((name, value), (_, before)) in found.settings.entries().into_iter().zip(own) {
            assert!(name != key || value == before, "{name}");
        }
        assert_ne!(found.settings, TunedSettings::from_config(&base), "{key}");
        let counts = train.confusions(&found.settings).unwrap().into_iter().sum();
        assert_eq!(Objective::F1.score(&counts), found.score, "{key}");
    }
}

#[test]
fn one_class_alone_teaches_nothing() {
    let base = Config::default();
    let space = Space { neighbours: vec![3], scans: vec![5] };
    let mut table = MismatchTable::new(space);
    let refused = |table: &MismatchTable| search(&base, 1).run(&[table], &mut |_, _| {}).unwrap_err();
    assert_eq!(refused(&table), TuneError::OneClass("plausible detections"));
    let mut rng = Pcg64Mcg::seed_from_u64(0);
    table.push_scan([Row { plausible: true, ..row(&mut rng, &Weights::from(&base)) }]);
    assert_eq!(refused(&table), TuneError::OneClass("artifacts"));
}

#[test]
fn mismatches_that_were_not_gathered_is_named() {
    let base = Config::from_toml("", &["tracking.scans=4"]).unwrap();
    let error = search(&base, 1).run(&[&planted(1, 1)], &mut |_, _| {}).unwrap_err();
    assert_eq!(error.to_string(), "no mismatches were gathered for tracking.scans = 4");
}

#[test]
fn each_fold_is_tuned_without_the_sequence_it_is_judged_on() {
    let base = Config::default();
    let sequences: Vec<_> = (0..3).map(|seed| (format!("{seed:02}"), planted(seed, 10))).collect();
    let search = search(&base, 30);
    let folds = leave_one_out(&search, &sequences, &mut |_, _, _| {}).unwrap();
    assert!(folds.iter().map(|fold| &fold.left_out).eq(["00", "01", "02"]));
    let others = [&sequences[0].1, &sequences[2].1];
    assert_eq!(folds[1].found, search.run(&others, &mut |_, _| {}).unwrap());
    let counts = sequences[1].1.confusions(&folds[1].found.settings).unwrap();
    assert_eq!(folds[1].tuned, ralf::metrics::Scores::from_scans(&counts));
    assert_eq!(
        leave_one_out(&search, &sequences[..1], &mut |_, _, _| {}),
        Err(TuneError::TooFewSequences(1))
    );
    let mut of_one_class = MismatchTable::new(sequences[0].1.space().clone());
    let mut rng = Pcg64Mcg::seed_from_u64(0);
    of_one_class.push_scan([Row { plausible: true, ..row(&mut rng, &Weights::from(&base)) }]);
    let mixed_alone = [sequences[0].clone(), ("01".to_owned(), of_one_class)];
    let refused = TuneError::OneClassWithout { left_out: "00".to_owned(), missing: "artifacts" };
    assert_eq!(check_folds(&search, &mixed_alone), Err(refused));
    let of_one_class = [mixed_alone[1].clone(), mixed_alone[1].clone()];
    assert_eq!(check_folds(&search, &of_one_class), Err(TuneError::OneClass("artifacts")));
}
