//! The corrections that a check proposes, as a settings file.

use ralf_check::{Refinement, Remedy, SensorChange, SequenceCheck, Setting, State};
use std::collections::BTreeMap;

/// A correction is proposed when it is so many standard deviations.
const SIGMAS: f64 = 3.0;
/// And larger than what labels notice: yaw in degrees, places in m, clock in ms.
const SMALLEST: [f64; 4] = [0.3, 0.05, 0.05, 15.0];

/// The text of the file: remedies of what is doubted, and refined corrections of the radars.
pub(crate) fn text(checks: &[SequenceCheck], refined: &[Refinement]) -> String {
    let mut text = String::from(
        "# What `ralf check` proposes. Each line is an offer: look at it, and take out what you know better.\n\
         # Corrections are added to what the recording says; ralf label --config takes them.\n",
    );
    let mut lines: BTreeMap<String, String> = BTreeMap::new();
    for check in checks {
        let doubted =
            check.verdicts.iter().filter(|verdict| matches!(verdict.state, State::Doubt | State::Fact));
        for (subject, remedy) in
            doubted.filter_map(|verdict| Some((&verdict.subject, verdict.remedy.as_ref()?)))
        {
            let known = refined.iter().any(|refinement| refinement.name == *subject);
            // A sensor's own change is told by its refinement.
            if !(known && matches!(remedy, Remedy::Sensor(change) if !is_vertical(change))) {
                remedy.settings(subject).into_iter().for_each(|setting| add(&mut lines, setting, ""));
            }
        }
    }
    for refinement in refined {
        for (setting, deviation) in settings(refinement) {
            add(&mut lines, setting, &deviation);
        }
    }
    lines.iter().for_each(|(key, rest)| text += &format!("{key}{rest}\n"));
    if lines.is_empty() {
        text += "# Nothing is proposed.\n";
    }
    text
}

/// Roll, pitch and height are found by other means than the refinement's.
fn is_vertical(change: &SensorChange) -> bool {
    change.turn_deg[0] != 0.0 || change.turn_deg[1] != 0.0 || change.shift_m[2] != 0.0
}

fn add(lines: &mut BTreeMap<String, String>, setting: Setting, note: &str) {
    lines.entry(setting.key).or_insert_with(|| format!(" = {}{note}", setting.value));
}

/// What is significant of a refinement, each with its standard deviation as a comment.
fn settings(refinement: &Refinement) -> Vec<(Setting, String)> {
    let SensorChange { turn_deg, shift_m, clock_ms, mirrored } = refinement.change;
    let values = [turn_deg[2], shift_m[0], shift_m[1], clock_ms];
    let matters = |i: usize| {
        let deviation = refinement.deviations[i];
        values[i].abs() > SMALLEST[i] && (deviation.is_nan() || values[i].abs() > SIGMAS * deviation)
    };
    let kept = |i: usize, digits: f64| if matters(i) { (values[i] * digits).round() / digits } else { 0.0 };
    let change = |change: SensorChange| Remedy::Sensor(change).settings(&refinement.name);
    let note = |which: &[usize], unit: &str| {
        let told: Vec<String> = which.iter().map(|i| format!("{:.3}", refinement.deviations[*i])).collect();
        if told.iter().any(|value| value == "NaN") {
            String::new()
        } else {
            format!("    # +- {} {unit}", told.join(", "))
        }
    };
    let nothing = SensorChange::default();
    let turned = SensorChange { turn_deg: [turn_deg[0], turn_deg[1], kept(0, 100.0)], ..nothing };
    let shifted = SensorChange { shift_m: [kept(1, 1000.0), kept(2, 1000.0), shift_m[2]], ..nothing };
    let later = SensorChange { clock_ms: kept(3, 10.0), ..nothing };
    let rows = [
        (turned, note(&[0], "degrees")),
        (shifted, note(&[1, 2], "m")),
        (later, note(&[3], "ms")),
        (SensorChange { mirrored, ..nothing }, String::new()),
    ];
    rows.into_iter()
        .flat_map(|(row, note)| change(row).into_iter().map(move |setting| (setting, note.clone())))
        .collect()
}
