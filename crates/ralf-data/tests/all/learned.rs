//! A model from simulated recordings, and labels by it.

use ralf::config::{Config, Method};
use ralf::label::flag;
use ralf::learned::{Model, Origin};
use ralf_data::result::{LabelledRun, Table};
use ralf_data::run::{LabelRun, Unwatched};
use ralf_data::{Recording, SequenceReader, Settings, TrainingGatherer, TrainingTruth};
use ralf_sim::SimulatedSequence;
use ralf_train::learning::{Fitting, NetParameters, Parameters, TrainingTable, View, fit};
use std::path::Path;
use std::sync::LazyLock;

/// A simulated recording of one short sequence.
fn recording(seed: u64) -> Recording {
    let preset = ralf_sim::presets::find("tiny").unwrap();
    let sequence: SimulatedSequence = preset.sequences[0].simulate(seed, 3).unwrap();
    let sequences: Vec<Box<dyn SequenceReader>> = vec![Box::new(sequence)];
    Recording::new(Path::new(&format!("simulated-{seed}")), "simulated", sequences)
}

fn table(jobs: usize) -> TrainingTable {
    let config = Config::default();
    let gatherer = TrainingGatherer {
        config: &config,
        seed: 1,
        unsaid: false,
        shown: None,
        every: 1,
        jobs,
        observer: &Unwatched,
    };
    let mut table = gatherer.table();
    for (world, seed) in [("one", 1), ("two", 2)] {
        let left_out =
            gatherer.add(&mut table, &|_| world.to_owned(), &recording(seed), TrainingTruth::Known).unwrap();
        assert!(left_out.is_empty());
    }
    table
}

/// A model, learned once, for each test to change its own.
fn model() -> Model {
    static MODEL: LazyLock<Model> = LazyLock::new(|| {
        let parameters = Parameters { rounds: 20, leaves: 8, rows_per_leaf: 30, ..Parameters::default() };
        let net = NetParameters { width: 8, layers: 1, passes: 2.0, ..NetParameters::default() };
        let fitting = Fitting {
            parameters,
            net: Some(net),
            expects: None,
            blanking: true,
            causes: true,
            threshold: 0.5,
            learned: Config::default().learned,
            jobs: 2,
        };
        fit(&table(2), &fitting, Origin::default(), &|_, _| {}).unwrap().model
    });
    MODEL.clone()
}

/// What is said of the first radar's detections.
fn label(out: &Path, assignments: &[&str], model: Option<&Model>, jobs: usize) -> Result<Table, String> {
    let mut scans = label_scans(out, assignments, model, jobs)?.into_iter();
    let first = scans.next().unwrap();
    Ok(scans.fold(first, |mut all, more| {
        all.append(&more).unwrap();
        all
    }))
}

/// The same, scan by scan.
fn label_scans(
    out: &Path,
    assignments: &[&str],
    model: Option<&Model>,
    jobs: usize,
) -> Result<Vec<Table>, String> {
    let mut settings = Settings::from_toml("", assignments).unwrap();
    if model.is_some() {
        settings.method.method = Method::Learned;
    }
    let recording = recording(3);
    let run = LabelRun {
        recording: &recording,
        settings: &settings,
        out,
        jobs,
        evidence: false,
        checks: &[],
        model,
    };
    run.execute(&Unwatched).map_err(|error| error.to_string())?;
    let reader = recording.sequences[0].as_ref();
    let sequence = LabelledRun::open(out).unwrap().sequence(reader).unwrap();
    Ok(sequence.tables.tables(0).unwrap().into_iter().map(|(_, table)| table).collect())
}

/// What is gathered, with absence as one value.
fn bits(table: &TrainingTable) -> Vec<u32> {
    (0..table.len()).flat_map(|row| table.rows.row(row).iter().map(|value| value.to_bits())).collect()
}

#[test]
fn what_is_gathered_does_not_depend_on_the_number_of_jobs_and_shows_less_in_some_scans() {
    let one = table(1);
    let four = table(4);
    assert!(bits(&one) == bits(&four) && one.known == four.known);
    assert_eq!(one.worlds, ["one", "two"]);
    assert!(one.known.iter().any(|known| known.plausible) && one.known.iter().any(|known| known.cause > 0));
    let single = one.known.iter().position(|known| known.view == View::SingleFrame).unwrap();
    let persistence = one.features.iter().position(|feature| feature.name == "persistence_own").unwrap();
    assert!(one.rows.row(single)[persistence].is_nan(), "a single frame has nothing to persist in");
}

#[test]
fn a_model_labels_with_reasons_and_the_same_to_the_byte_whatever_the_number_of_jobs() {
    let model = model();
    let [first, second, paper] = [(); 3].map(|()| tempfile::tempdir().unwrap());
    let labelled = label(first.path(), &[], Some(&model), 1).unwrap();
    label(second.path(), &[], Some(&model), 3).unwrap();
    let file = "sequences/tiny/plausibility.parquet";
    let bytes = |out: &Path| std::fs::read(out.join(file)).unwrap();
    assert!(bytes(first.path()) == bytes(second.path()));
    let by_paper = label(paper.path(), &[], None, 2).unwrap();
    assert!(by_paper.get::<f32>("novelty").is_err(), "the paper's method says nothing of a model");
    let (w, label) = (labelled.get::<f32>("w").unwrap(), labelled.get::<u8>("label").unwrap());
    let threshold = Config::default().fusion.threshold;
    let by_model = labelled.get::<u16>("flags").unwrap().iter().map(|flags| flags & flag::PAPER == 0);
    for ((w, label), by_model) in w.iter().zip(label).zip(by_model) {
        assert!(!by_model || (f64::from(*w) >= threshold) == (*label == 1), "{w} is {label}");
    }
    assert_ne!(w, by_paper.get::<f32>("w").unwrap());
    assert_eq!(labelled.get::<f32>("d_lm").unwrap().len(), w.len());
    let reasons = labelled.get::<std::sync::Arc<str>>("reason").unwrap();
    assert!(reasons.iter().any(|reason| reason.contains("LiDAR")), "{:?}", &reasons[..3]);
    let neighbours = labelled.get::<f32>("reason_neighbours").unwrap();
    let causes = labelled.get::<std::sync::Arc<str>>("cause").unwrap();
    let flags = labelled.get::<u16>("flags").unwrap();
    for (row, cause) in causes.iter().enumerate() {
        let is_told = label[row] == 0 && flags[row] & flag::PAPER == 0;
        assert_eq!(!cause.is_empty(), is_told, "{cause:?} of detection {row}");
        assert_eq!(neighbours[row].is_nan(), flags[row] & flag::PAPER != 0, "{}", neighbours[row]);
    }
}

#[test]
fn as_many_are_plausible_as_are_said_to_be_expected() {
    let model = model();
    let as_trained = ["learned.unconfirmed=1", "learned.movers=false"];
    let few = [&as_trained[..], &["learned.share=0.1"]].concat();
    let expected = odds(0.1) / odds(model.share());
    let factors = factors(&model, &as_trained, &few).concat();
    assert!(factors.iter().all(|factor| (factor / expected - 1.0).abs() < 1e-4), "{expected} {factors:?}");
    assert!(factors.len() > 100, "{}", factors.len());
}

#[test]
fn each_scan_tells_how_many_of_its_movers_are_real() {
    let is = |factor: f64, expected: f64| (factor / expected - 1.0).abs() < 1e-3;
    let mut changed = Vec::new();
    for factors in factors(&model(), &["learned.movers=false"], &[]) {
        if let Some(of_movers) = factors.iter().copied().find(|factor| !is(*factor, 1.0)) {
            assert!(factors.iter().all(|factor| is(*factor, 1.0) || is(*factor, of_movers)), "{factors:?}");
            assert!(factors.iter().any(|factor| is(*factor, 1.0)), "not all moves");
            changed.push(of_movers);
        }
    }
    changed.sort_by(f64::total_cmp);
    assert!(
        changed.len() > 1 && !is(changed[0], changed[changed.len() - 1]),
        "each scan its own: {changed:?}"
    );
}

fn odds(share: f64) -> f64 {
    share / (1.0 - share)
}

/// By how much the odds of each detection change from some settings to others, scan by scan. The paper's method answers
/// where the model has no business, whatever the settings are: those are left out, and what is too sure to tell.
fn factors(model: &Model, before: &[&str], now: &[&str]) -> Vec<Vec<f64>> {
    let [before, now] = [before, now].map(|assignments| {
        let out = tempfile::tempdir().unwrap();
        label_scans(out.path(), assignments, Some(model), 2).unwrap()
    });
    let of_scan = |(before, now): (&Table, &Table)| {
        let [from, to] = [before, now].map(|table| table.get::<f32>("w").unwrap());
        let flags = now.get::<u16>("flags").unwrap();
        let is_told = |row: &usize| flags[*row] & flag::PAPER == 0 && (0.01..0.99).contains(&from[*row]);
        let factor = |row: usize| odds(f64::from(to[row])) / odds(f64::from(from[row]));
        (0..from.len()).filter(is_told).map(factor).collect()
    };
    before.iter().zip(&now).map(of_scan).collect()
}

#[test]
fn what_is_unlike_anything_the_model_knows_is_answered_by_the_paper_and_says_so() {
    let mut model = model();
    for input in &mut model.inputs {
        (input.seen.low, input.seen.high, input.seen.absent) = (1e30, 1e30, 0.0);
    }
    let [learned, paper] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let labelled = label(learned.path(), &[], Some(&model), 2).unwrap();
    let by_paper = label(paper.path(), &[], None, 2).unwrap();
    for column in ["w", "w_lm", "w_tr"] {
        let same =
            |table: &Table| table.get::<f32>(column).unwrap().iter().map(|w| w.to_bits()).collect::<Vec<_>>();
        assert_eq!(same(&labelled), same(&by_paper), "{column}");
    }
    assert!(labelled.get::<u16>("flags").unwrap().iter().all(|flags| flags & flag::PAPER != 0));
    assert!(labelled.get::<f32>("novelty").unwrap().iter().all(|novelty| (novelty - 1.0).abs() < 1e-6));
}

#[test]
fn a_model_that_cannot_be_used_is_refused_before_anything_is_written() {
    let mut model = model();
    model.inputs[0].name = "smell".to_owned();
    let out = tempfile::tempdir().unwrap();
    let refused = label(&out.path().join("labels"), &[], Some(&model), 1).unwrap_err();
    assert!(refused.contains("`smell`"), "{refused}");
    let refused = label(&out.path().join("labels"), &["method=learned"], None, 1).unwrap_err();
    assert!(refused.contains("no model"), "{refused}");
    assert!(!out.path().join("labels").exists());
}
