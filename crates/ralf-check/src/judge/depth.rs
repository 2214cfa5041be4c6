//! Whether stored depth tells something, and the right way round: what the LiDAR has farther has to be farther. The
//! method's own monitor can't tell, for local scaling makes up for it.

use super::cameras::is_lidar_doubted;
use super::case::Case;
use crate::picture::{Agreement, DepthLook, FEWEST_IMAGES};
use crate::remedy::Remedy;
use crate::statistics::median;
use crate::verdict::{Question, State, Verdict};
use ralf::sensors::DepthOutput;

/// Depth goes with the LiDAR's by more than this (rank correlation); noise doesn't, however it is read.
const RIGHT: f64 = 0.6;
/// By less it has nothing to do with it.
const NOTHING: f64 = 0.2;
/// Read otherwise, it has to go with it by so much more: upside down, a street seen to the side is half right.
const GAIN: f64 = 0.25;

/// Judges the stored depth of each camera that has some.
pub(super) fn judge(case: &Case, known: &[Verdict]) -> Vec<Verdict> {
    let knows_lidar = !is_lidar_doubted(case, known);
    case.cameras().filter_map(|camera| one(case, camera, knows_lidar)).collect()
}

/// Of the views of a camera the first that is doubted, else the first.
fn one(case: &Case, camera: usize, knows_lidar: bool) -> Option<Verdict> {
    let looks = case.sample.pictures.depths.iter().filter(|look| look.camera == camera);
    let looks: Vec<&DepthLook> = looks.collect();
    let views = looks.iter().map(|look| look.view).max()? + 1;
    let name = &case.sequence.rig.cameras[camera].name;
    let of_view = |view: usize| {
        let own: Vec<&DepthLook> = looks.iter().copied().filter(|look| look.view == view).collect();
        let found = constant(name, &own)
            .unwrap_or_else(|| by_lidar(name, &own, knows_lidar, case.sequence.depth_output));
        if views == 1 {
            return found;
        }
        Verdict { evidence: format!("view {view}: {}", found.evidence), ..found }
    };
    let mut verdicts: Vec<Verdict> = (0..views).map(of_view).collect();
    let doubted = verdicts.iter().position(|verdict| verdict.state == State::Doubt);
    Some(verdicts.swap_remove(doubted.unwrap_or(0)))
}

fn constant(name: &str, looks: &[&DepthLook]) -> Option<Verdict> {
    let constant = looks.iter().filter(|look| look.is_constant).count();
    if constant < FEWEST_IMAGES || 2 * constant <= looks.len() {
        return None;
    }
    let evidence = format!("depth has one value for all pixels in {constant} of {} images", looks.len());
    Some(Verdict::doubt(name, Question::Depth, evidence, Some(Remedy::LookInto("its depth tells nothing"))))
}

fn by_lidar(name: &str, looks: &[&DepthLook], knows_lidar: bool, output: DepthOutput) -> Verdict {
    if !knows_lidar {
        let missing = "the LiDAR's own height, tilt or numbers are doubted: they have to be put right before";
        return Verdict::cannot_judge(name, Question::Depth, missing);
    }
    let known: Vec<Agreement> = looks.iter().filter_map(|look| look.agreement).collect();
    let middle = |of: fn(&Agreement) -> f64| median(&known.iter().map(of).collect::<Vec<f64>>());
    let both =
        middle(|a| a.as_stored).zip(middle(|a| a.upside_down)).filter(|_| known.len() >= FEWEST_IMAGES);
    let Some((as_stored, upside_down)) = both else {
        let missing = format!(
            "{} of {} images with depth show enough LiDAR points: {FEWEST_IMAGES} are needed",
            known.len(),
            looks.len()
        );
        return Verdict::cannot_judge(name, Question::Depth, missing);
    };
    let evidence = format!(
        "depth of {} images goes with the LiDAR's by {as_stored:.2} (rank correlation; 1: the same order)",
        known.len()
    );
    let (then, what) = otherwise(as_stored, upside_down, output);
    if then > RIGHT && then > as_stored + GAIN {
        let evidence = format!("{evidence}, and by {then:.2} otherwise");
        return Verdict::doubt(name, Question::Depth, evidence, Some(Remedy::LookInto(what)));
    }
    if as_stored > RIGHT {
        return Verdict::good(name, Question::Depth, evidence);
    }
    let evidence = format!("{evidence}, and by no more otherwise");
    if as_stored.abs() < NOTHING {
        let what = "is it this camera's depth, and are its mounting, lens and clock what is said?";
        return Verdict::doubt(name, Question::Depth, evidence, Some(Remedy::LookInto(what)));
    }
    Verdict::cannot_judge(name, Question::Depth, evidence)
}

/// How else depth goes best with the LiDAR's, and by how much.
fn otherwise(as_stored: f64, upside_down: f64, output: DepthOutput) -> (f64, &'static str) {
    let inside_out = match output {
        DepthOutput::Disparity => "its depth looks like depth, and is said to be disparity",
        DepthOutput::Depth | DepthOutput::Metric => "its depth looks like disparity: the larger, the nearer",
    };
    let readings = [
        (-as_stored, inside_out),
        (-upside_down, "its depth looks upside down and like the other of depth and disparity"),
    ];
    let first = (upside_down, "its depth looks upside down");
    readings.into_iter().fold(first, |best, other| if other.0 > best.0 { other } else { best })
}
