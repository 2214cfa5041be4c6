//! What a model is worth, for people and for machines.

use ralf_train::learning::{Fitted, Judged, LeftOut, SUITES, Scores, SuiteScores, Turns};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// A table: each world by a model that never saw it.
pub(super) fn page(fitted: &Fitted) -> String {
    let mut page = String::from(
        "Each world, judged by a model that was fitted to all the others; the paper's method beside it.\n\
         F1 (plausible), average precision (AP), accuracy and calibration error (ECE) of each. AP ranks by w alone,\n\
         floor detections, too, which the paper's method calls plausible at no threshold: `ralf evaluate` and\n\
         `ralf report` never find these. The model answers for all of them: `ralf label` asks the paper's method\n\
         where evidence is unlike what the model knows (learned.max_novelty).\n\n",
    );
    let rows = &fitted.left_out;
    let width = rows.iter().map(|world| world.world.len()).max().unwrap_or(0).max(12);
    line(
        &mut page,
        width,
        "",
        "     detections   plausible   learned: F1   AP     acc.   ECE      paper: F1   AP     acc.",
    );
    for LeftOut { world, detections, plausible, learned, paper, .. } in rows {
        let counts = format!("{detections:>15} {plausible:>11}");
        line(&mut page, width, world, &format!("{counts}           {learned}          {}", three(paper)));
    }
    let mean = |of: fn(&LeftOut) -> Scores| Scores::mean(&rows.iter().map(of).collect::<Vec<_>>());
    let (learned, paper) = (mean(|world| world.learned), mean(|world| world.paper));
    line(&mut page, width, "mean", &format!("{:38}{learned}          {}", "", three(&paper)));
    let at_threshold = mean(|world| world.at_threshold);
    page += &format!(
        "\nAt the threshold of the settings, where as many are plausible as in these worlds: {at_threshold}\n"
    );
    page += &suites(rows);
    page + &worth(fitted)
}

/// By what could be observed: the mean over the worlds in which there is such a thing.
fn suites(rows: &[LeftOut]) -> String {
    let all = || rows.iter().flat_map(|world| &world.suites);
    let mut page = String::from("\nBy what could be observed, means over the worlds that have it:\n");
    for name in SUITES {
        let here: Vec<&SuiteScores> = all().filter(|suite| suite.name == name).collect();
        if here.is_empty() {
            continue;
        }
        let mean = |of: fn(&SuiteScores) -> Scores| {
            Scores::mean(&here.iter().map(|suite| of(suite)).collect::<Vec<_>>())
        };
        let detections: usize = here.iter().map(|suite| suite.detections).sum();
        let (learned, paper) = (mean(|suite| suite.learned), mean(|suite| suite.paper));
        let scores = format!("learned: {learned}    paper: {}", three(&paper));
        line(&mut page, 26, name, &format!("{:>2} worlds {detections:>7}   {scores}", here.len()));
    }
    page
}

/// What the model asks for most.
fn worth(fitted: &Fitted) -> String {
    let model = &fitted.model;
    let mut worth: Vec<(&str, f32)> =
        model.inputs.iter().map(|input| (input.name.as_str(), input.seen.gain)).collect();
    worth.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all: f32 = worth.iter().map(|(_, gain)| gain).sum();
    let mut page = String::from("\nWhat its questions ask for most:\n");
    for (name, gain) in worth.iter().take(15) {
        line(&mut page, 36, name, &format!("{:5.1} %", 100.0 * gain / all.max(f32::MIN_POSITIVE)));
    }
    page
}

pub(super) fn line(page: &mut String, width: usize, name: &str, rest: &str) {
    // A string takes everything.
    let _ = writeln!(page, "  {name:width$} {rest}");
}

/// F1, average precision and accuracy: `w` of the paper's method is no probability.
fn three(scores: &Scores) -> String {
    let parts = [scores.f1, scores.average_precision, scores.accuracy];
    parts.map(|value| value.map_or("    -".to_owned(), |value| format!("{value:.3}"))).join("  ")
}

/// Two tables: what becomes of labels, and what they are worth, each sequence before and after.
pub(super) fn corrected_page(judged: &[Judged]) -> String {
    let how = match judged {
        [only] if only.after == Scores::default() => "(one scan alone was: nothing is left to judge by)",
        [_] => "by what was said of other parts of it (which lie near: a new recording gains less)",
        _ => "by what was said of others",
    };
    let mut page = format!(
        "What was said of each sequence, as the model labels it before, and after it was corrected {how}.\n\n"
    );
    let width = judged.iter().map(|sequence| sequence.world.len()).max().unwrap_or(0).max(12);
    turned(&mut page, width, judged);
    page += "\n\
        F1 (plausible), average precision (AP), accuracy and calibration error (ECE) of what was said. Where that is\n\
        errors alone they are low whatever the model does: look at what is wrong and what turns. The model answers\n\
        for all detections: `ralf label` asks the paper's method where evidence is unlike what the model knows\n\
        (learned.max_novelty).\n\n";
    let head = "before: F1   AP     acc.   ECE      after: F1   AP     acc.   ECE";
    line(&mut page, width, "", head);
    for Judged { world, before, after, .. } in judged {
        line(&mut page, width, world, &format!("     {before}         {after}"));
    }
    if judged.len() > 1 {
        let mean = |of: fn(&Judged) -> Scores| Scores::mean(&judged.iter().map(of).collect::<Vec<_>>());
        let (before, after) = (mean(|sequence| sequence.before), mean(|sequence| sequence.after));
        line(&mut page, width, "mean", &format!("     {before}         {after}"));
    }
    page
}

/// How many detections are labelled otherwise than was said, and how many turn of those that were left alone.
fn turned(page: &mut String, width: usize, judged: &[Judged]) {
    let mut row = |name: &str, cells: [String; 6]| {
        let [said, plausible, before, after, alone, turned] = cells;
        let cells = format!("{said:>10} {plausible:>11} {before:>14} {after:>7} {alone:>12} {turned:>8}");
        line(page, width, name, &cells);
    };
    row("", ["said", "plausible", "wrong: before", "after", "left alone", "turned"].map(str::to_owned));
    let told = |count: Option<usize>| count.map_or("-".to_owned(), |count| count.to_string());
    let cells = |turns: &Turns| {
        let Turns { said, plausible, wrong_before, wrong_after, left_alone, turned } = *turns;
        let counts = [Some(said), Some(plausible), Some(wrong_before), wrong_after, Some(left_alone), turned];
        counts.map(told)
    };
    judged.iter().for_each(|sequence| row(&sequence.world, cells(&sequence.turns)));
    if judged.len() > 1 {
        row("all", cells(&judged.iter().map(|sequence| sequence.turns).sum()));
    }
}

/// The same as JSON.
pub(super) fn corrected_json(judged: &[Judged]) -> serde_json::Result<String> {
    let mut sequences = Map::new();
    for Judged { world, turns, before, after } in judged {
        let Turns { said, plausible, wrong_before, wrong_after, left_alone, turned } = turns;
        let told = json!({
            "detections": said,
            "plausible": plausible,
            "wrong_before": wrong_before,
            "wrong_after": wrong_after,
            "left_alone": left_alone,
            "turned": turned,
            "before": scores_json(before),
            "after": scores_json(after),
        });
        sequences.insert(world.clone(), told);
    }
    serde_json::to_string_pretty(&json!({ "corrected": sequences }))
}

/// What a new model is worth, as JSON.
pub(super) fn json(fitted: &Fitted) -> serde_json::Result<String> {
    let mut worlds = Map::new();
    for world in &fitted.left_out {
        let suites: Map<String, Value> =
            world.suites.iter().map(|suite| (suite.name.to_owned(), suite_json(suite))).collect();
        let told = json!({
            "detections": world.detections,
            "plausible": world.plausible,
            "learned": scores_json(&world.learned),
            "at_threshold": scores_json(&world.at_threshold),
            "paper": scores_json(&world.paper),
            "suites": suites,
        });
        worlds.insert(world.world.clone(), told);
    }
    serde_json::to_string_pretty(&json!({ "left_out": worlds }))
}

fn suite_json(suite: &SuiteScores) -> Value {
    let (learned, paper) = (scores_json(&suite.learned), scores_json(&suite.paper));
    json!({ "detections": suite.detections, "learned": learned, "paper": paper })
}

fn scores_json(scores: &Scores) -> Value {
    let named = scores.named().into_iter();
    Value::Object(named.map(|(name, value)| (name.to_owned(), json!(value))).collect())
}
