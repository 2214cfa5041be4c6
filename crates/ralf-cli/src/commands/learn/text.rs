//! What a model is worth, for people and for machines.

use ralf_train::learning::{Fitted, LeftOut, Scores, View};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// A table: each world by a model that never saw it.
pub(super) fn page(fitted: &Fitted) -> String {
    let mut page = String::from(
        "Each world, judged by a model that was fitted to all the others; the paper's method beside it.\n\
         F1 (plausible), average precision, accuracy and calibration error (ECE) of each:\n\n",
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
    page += &format!("\nAt the threshold of the settings: {at_threshold}\n");
    for view in View::ALL {
        let scores: Vec<Scores> = rows
            .iter()
            .flat_map(|world| &world.views)
            .filter(|(seen, _)| *seen == view)
            .map(|(_, scores)| *scores)
            .collect();
        if !scores.is_empty() {
            page += &format!("With {}: {}\n", view.name(), Scores::mean(&scores));
        }
    }
    page + &worth(fitted)
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

/// The same as JSON; `shipped` holds what the shipped model is worth in own sequences.
pub(super) fn json(fitted: &Fitted, before: &[(String, Scores)]) -> serde_json::Result<String> {
    let mut worlds = Map::new();
    for world in &fitted.left_out {
        let views: Map<String, Value> =
            world.views.iter().map(|(view, scores)| (view.name().to_owned(), scores_json(scores))).collect();
        let told = json!({
            "detections": world.detections,
            "plausible": world.plausible,
            "learned": scores_json(&world.learned),
            "at_threshold": scores_json(&world.at_threshold),
            "paper": scores_json(&world.paper),
            "views": views,
        });
        worlds.insert(world.world.clone(), told);
    }
    let before: Map<String, Value> =
        before.iter().map(|(sequence, scores)| (sequence.clone(), scores_json(scores))).collect();
    serde_json::to_string_pretty(&json!({ "left_out": worlds, "shipped": before }))
}

fn scores_json(scores: &Scores) -> Value {
    let named = scores.named().into_iter();
    Value::Object(named.map(|(name, value)| (name.to_owned(), json!(value))).collect())
}
