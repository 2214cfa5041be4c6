//! Models, written.

use super::super::familiar::Seen;
use super::super::forest::Forest;
use super::super::model::{Input, Model, World};
use super::super::net::{Net, Shape};
use super::super::tree::{Leaf, Node, Split, Tree};
use super::{HEAD, checksum};
use std::fmt::Write;

/// A model as text.
pub(super) fn text(model: &Model) -> String {
    let Model { origin, expects, inputs, plausible, net, calibration, causes, corrected } = model;
    let mut lines =
        format!("{HEAD}\nprogram {}\ncommand {}\n", one_line(&origin.program), one_line(&origin.command));
    line(&mut lines, format_args!("seed {}", origin.seed));
    worlds(&mut lines, "world", &origin.worlds);
    if let Some(share) = expects {
        line(&mut lines, format_args!("expects {share:?}"));
    }
    for Input { name, seen: Seen { low, high, absent, gain } } in inputs {
        line(&mut lines, format_args!("input {name} {low:?} {high:?} {absent:?} {gain:?}"));
    }
    for (log_odds, probability) in calibration.points() {
        line(&mut lines, format_args!("calibrated {log_odds:?} {probability:?}"));
    }
    forest(&mut lines, "plausible", plausible);
    for cause in causes {
        forest(&mut lines, &format!("cause {}", one_line(&cause.name)), &cause.forest);
    }
    if let Some(net) = net {
        of_net(&mut lines, net);
    }
    if let Some(corrected) = corrected {
        worlds(&mut lines, "corrected", &corrected.worlds);
        forest(&mut lines, "corrected", &corrected.forest);
    }
    // A reader sees by their number that one is lost or there twice, and by their sum that one is another.
    let (before, sum) = (lines.lines().count(), checksum(lines.lines()));
    line(&mut lines, format_args!("end {before} {sum}"));
    lines
}

fn worlds(lines: &mut String, key: &str, worlds: &[World]) {
    for World { name, detections, plausible, scores } in worlds {
        let mut told = String::new();
        for (score, value) in scores {
            told += &format!(" {score} {value}");
        }
        let name = one_line(name).replace(':', ";");
        line(lines, format_args!("{key} {detections} {plausible} {name}:{told}"));
    }
}

fn forest(lines: &mut String, name: &str, Forest { base, trees }: &Forest) {
    line(lines, format_args!("forest {base:?} {name}"));
    for tree in trees {
        *lines += "tree";
        nodes(lines, tree);
        lines.push('\n');
    }
}

/// `FEATURE THRESHOLD y|n` of a question, where y says that absence counts as yes; `= VALUE COVER` of a leaf.
fn nodes(lines: &mut String, tree: &Tree) {
    for node in tree.nodes() {
        let text = match node {
            Node::Split(Split { feature, threshold, absent_is_yes, .. }) => {
                format!(" {feature} {threshold:?} {}", if *absent_is_yes { "y" } else { "n" })
            }
            Node::Leaf(Leaf { value, cover }) => format!(" = {value:?} {cover:?}"),
        };
        *lines += &text;
    }
}

/// Its shape; `VALUE SCORE` of each point of each feature's scale; its weights, matrix by matrix.
fn of_net(lines: &mut String, net: &Net) {
    let Shape { inputs, width, layers, nearest } = net.shape();
    line(lines, format_args!("net {inputs} {width} {layers} {nearest}"));
    for scale in &net.scales {
        numbers(lines, "scale", scale.points().iter().flat_map(|(value, score)| [*value, *score]));
    }
    for weights in net.weights() {
        numbers(lines, "weights", weights.iter().copied());
    }
}

fn numbers(lines: &mut String, key: &str, numbers: impl Iterator<Item = f32>) {
    *lines += key;
    for number in numbers {
        *lines += &format!(" {number:?}");
    }
    lines.push('\n');
}

fn line(lines: &mut String, line: std::fmt::Arguments) {
    // A string takes everything.
    let _ = writeln!(lines, "{line}");
}

/// What people typed, as one line.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
