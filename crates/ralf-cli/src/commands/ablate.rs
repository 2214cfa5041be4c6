//! `ralf ablate`: what each branch and each extension is good for.

use super::search::{SearchArgs, Sensed, name_what_is_left_out, tables};
use crate::outcome::Outcome;
use crate::text::{aligned, decimal, print};
use clap::Args;
use ralf::config::GroundModel;
use ralf::metrics::{Rates, Scores};
use ralf_data::{GroundTruth, Recording};
use ralf_train::{JudgedVariant, Variant};
use serde_json::{Map, Value, json};

/// Arguments of `ralf ablate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Compares the paper's method with variants that lack a branch, have one branch alone, or have one extension besides. \
Each variant is tuned on the sequences to tune on, as `ralf tune` does it, and judged on the others. All figures are \
of all detections together.

Examples:
  ralf ablate recordings/city --train 00,01 --test 02,03
  ralf ablate recordings/city --train 00,01 --test 02,03 --trials 1000 --seed 7 --json")]
pub(crate) struct AblateArgs {
    #[command(flatten)]
    search: SearchArgs,
    /// Sequences to judge the variants on
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required = true)]
    test: Vec<String>,
}

/// Tunes and judges all variants and prints what they reach.
pub(crate) fn run(arguments: &AblateArgs) -> anyhow::Result<Outcome> {
    let search = &arguments.search;
    search.check(&arguments.test)?;
    let base = search.base()?;
    let (recording, truth, mut outcome) = search.open(&base, &arguments.test)?;
    let mut variants = Variant::all(&base.method);
    let sensed = Sensed::by(&recording);
    variants.retain(|variant| sensed.depth || !variant.is_of_cameras());
    if !sensed.lidar {
        keep_without_lidar(&mut variants);
    }
    let mut judged = Vec::with_capacity(variants.len());
    // Those that share their mismatches follow each other, so that but those of one need be remembered.
    for group in variants.chunk_by(|a, b| a.matching_config() == b.matching_config()) {
        let (of_group, its_outcome) = arguments.judge(group, &recording, &truth, judged.is_empty())?;
        judged.extend(of_group);
        outcome = outcome.and(its_outcome);
    }
    print(&if search.json {
        serde_json::to_string_pretty(&arguments.json(&judged))?
    } else {
        arguments.page(&judged, &sensed)
    })?;
    Ok(outcome)
}

impl Sensed {
    /// What nothing is told of, a line.
    fn told(&self) -> &'static str {
        match self {
            Self { lidar: false, .. } => {
                "\nNo LiDAR: nothing is told of LiDARs, of the ground that they see, and of cameras, whose depth they \
                 scale\n"
            }
            Self { depth: false, .. } => "\nNo camera has depth: nothing is told of cameras\n",
            Self { .. } => "",
        }
    }
}

/// Leaves out the variants that are one of those before them where there is no LiDAR: by what they say of LiDARs, of
/// cameras, whose depth has no scale then, and of the ground, where that isn't taken for flat.
fn keep_without_lidar(variants: &mut Vec<Variant>) {
    let Some(paper) = variants.first().map(|variant| variant.config.clone()) else { return };
    let mut known = Vec::new();
    variants.retain(|variant| {
        let mut config = variant.config.clone();
        (config.lidar, config.camera) = (paper.lidar.clone(), paper.camera.clone());
        if config.ground.model != GroundModel::Flat {
            config.ground = paper.ground.clone();
        }
        let is_new = !known.contains(&config);
        known.push(config);
        is_new
    });
}

impl AblateArgs {
    /// Variants that share their mismatches. Scans that can't be matched are the same ones each time: the first group
    /// names them.
    fn judge(
        &self,
        variants: &[Variant],
        recording: &Recording,
        truth: &GroundTruth,
        first: bool,
    ) -> anyhow::Result<(Vec<JudgedVariant>, Outcome)> {
        let Some(shared) = variants.first() else { return Ok((Vec::new(), Outcome::Done)) };
        let config = shared.matching_config();
        let matched = self.search.gather(recording, truth, &config)?;
        let outcome = if first { name_what_is_left_out(&matched) } else { Outcome::Done };
        let parts = self.search.parts(matched);
        let (train, test) = (tables(&parts.train), tables(&parts.test));
        let judge = |variant: &Variant| {
            let progress = self.search.progress(variant.name);
            let mut show = |trial: usize, best: &_| self.search.show(&progress, trial, best);
            let judged = variant.judge(&self.search.search(&config), &train, &test, &mut show);
            Ok(judged?)
        };
        Ok((variants.iter().map(judge).collect::<anyhow::Result<_>>()?, outcome))
    }

    /// For people.
    fn page(&self, judged: &[JudgedVariant], sensed: &Sensed) -> String {
        let columns = ["Accuracy", "F1 plausible", "to the paper's", "Mean IoU", "MCC", "F1 where tuned"];
        let mut rows = vec![["Variant"].iter().chain(&columns).map(|&text| text.to_owned()).collect()];
        for variant in judged {
            let Rates { accuracy, f1_plausible, mean_iou, mcc, .. } = pooled(&variant.test);
            let difference = difference(variant, judged).map_or("-".to_owned(), |d| format!("{d:+.3}"));
            let cells = [
                decimal(accuracy),
                decimal(f1_plausible),
                difference,
                decimal(mean_iou),
                decimal(mcc),
                decimal(pooled(&variant.train).f1_plausible),
            ];
            rows.push([variant.name.to_owned()].into_iter().chain(cells).collect());
        }
        format!(
            "Each variant tuned on {} ({}) and judged on {}, all detections together\n{}\n{}",
            self.search.train.join(", "),
            self.search.told(),
            self.test.join(", "),
            sensed.told(),
            aligned(&rows)
        )
    }

    /// For machines.
    fn json(&self, judged: &[JudgedVariant]) -> Value {
        let variant = |variant: &JudgedVariant| {
            let settings =
                variant.found.settings.entries().map(|(key, value)| (key.to_owned(), json!(value)));
            json!({
                "name": variant.name,
                "settings": Value::Object(Map::from_iter(settings)),
                "train": variant.train.pooled,
                "test": variant.test.pooled,
                "f1_plausible_to_paper": difference(variant, judged),
            })
        };
        json!({
            "objective": self.search.objective.to_string(),
            "trials": self.search.trials,
            "seed": self.search.seed,
            "train": self.search.train,
            "test": self.test,
            "variants": judged.iter().map(variant).collect::<Vec<_>>(),
        })
    }
}

fn pooled(scores: &Scores) -> Rates {
    scores.pooled.rates
}

/// How much better the F1 of plausible detections is than that of the paper's method, which is the first variant.
fn difference(variant: &JudgedVariant, judged: &[JudgedVariant]) -> Option<f64> {
    let f1 = |variant: &JudgedVariant| pooled(&variant.test).f1_plausible;
    Some(f1(variant)? - f1(judged.first()?)?)
}
