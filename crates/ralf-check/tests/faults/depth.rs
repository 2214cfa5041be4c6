//! Stored depth that tells nothing, or the wrong way round.

use crate::recording::{Planted, Recording};
use crate::{STRAIGHT, TURNING, told};
use ralf::sensors::{DepthImage, DepthOutput};
use ralf_check::{Question, Remedy, State, Verdict, check};
use std::sync::Arc;

/// What is said of depth, each camera's; nothing else is doubted.
fn of_depth(base: &Arc<Recording>, output: DepthOutput, edit: fn(&mut DepthImage)) -> Vec<Verdict> {
    let mut planted = Planted::new(base);
    planted.sequence.depth_output = output;
    // What the other radars say of each other is no matter here.
    planted.sequence.rig.radars.truncate(1);
    planted.sequence.times.radars.truncate(1);
    planted.with_depth(move |views| views.iter_mut().for_each(edit));
    let found = check(&planted);
    assert!(found.doubts().all(|verdict| verdict.question == Question::Depth), "{}", told(&found));
    let own = found.verdicts.into_iter().filter(|verdict| verdict.question == Question::Depth);
    let own: Vec<Verdict> = own.collect();
    assert_eq!(own.len(), planted.sequence.rig.cameras.len());
    own
}

fn upside_down(depth: &mut DepthImage) {
    let rows: Vec<Vec<f32>> = depth.values.chunks(depth.width).map(<[f32]>::to_vec).rev().collect();
    depth.values = rows.concat();
}

fn inside_out(depth: &mut DepthImage) {
    depth.values.iter_mut().for_each(|value| *value = 1.0 / *value);
}

#[test]
fn depth_that_tells_nothing_or_the_wrong_way_round_is_doubted() {
    type Planting = (&'static str, DepthOutput, fn(&mut DepthImage));
    let faults: [Planting; 5] = [
        ("tells nothing", DepthOutput::Depth, |depth| depth.values.fill(7.5)),
        ("looks upside down", DepthOutput::Depth, upside_down),
        ("looks like disparity", DepthOutput::Depth, inside_out),
        ("looks like depth", DepthOutput::Disparity, |_| ()),
        ("upside down and like the other", DepthOutput::Depth, |depth| {
            upside_down(depth);
            inside_out(depth);
        }),
    ];
    let base = Recording::of(TURNING, 120, 2);
    for (says, output, edit) in faults {
        for verdict in of_depth(&base, output, edit) {
            let is_right = |remedy: &Remedy| matches!(remedy, Remedy::LookInto(what) if what.contains(says));
            assert_eq!(verdict.state, State::Doubt, "{says}: {verdict:?}");
            assert!(verdict.remedy.as_ref().is_some_and(is_right), "{says}: {verdict:?}");
        }
    }
}

#[test]
fn right_depth_raises_nothing() {
    for base in [Recording::of(STRAIGHT, 120, 1), Recording::of(TURNING, 120, 2)] {
        let inverted = of_depth(&base, DepthOutput::Disparity, inside_out);
        for verdict in of_depth(&base, DepthOutput::Depth, |_| ()).into_iter().chain(inverted) {
            assert_eq!(verdict.state, State::Good, "{verdict:?}");
        }
    }
}
