//! Odometry beside poses: labels take speeds from the one and places from the other, so both have to be right.

use super::case::{Case, SCANS};
use super::clocks::{HARMLESS_MS, is_clear};
use super::doppler::RATIO;
use super::motion::{YAW_RATE_GAIN, YAW_RATES, count_explained};
use super::radar::CREEPING;
use crate::change::used_motion;
use crate::doppler::ClockFigures;
use crate::overlap::motion_overlap;
use crate::remedy::{Remedy, SPEEDS};
use crate::statistics::median;
use crate::verdict::{Question, State, Verdict};
use crate::wheels::{Beside, LEVER};
use ralf::space::EgoMotion;

/// Times that put less right are nothing that labels notice: 0.06 m/s, what a scan's range rates just tell.
const NOTICED: f64 = YAW_RATE_GAIN.1 * LEVER;

/// Judges odometry that is recorded beside poses; nothing where there is but one of both. What was found of the motion
/// so far is of the poses alone where odometry tells that very quantity otherwise than they do as they are recorded:
/// settings would change both.
pub(super) fn judge(case: &Case, known: &mut [Verdict]) -> Vec<Verdict> {
    let recorded = &case.sequence.motion;
    let has_poses = !recorded.poses().is_empty();
    of_poses(known, |remedy| has_poses && matches!(remedy, Remedy::YawRate(_)));
    let odometry = EgoMotion::new(recorded.odometry().to_vec(), vec![]);
    let Some(odometry) = odometry.filter(|_| has_poses) else { return Vec::new() };
    let as_recorded = Wheels::of(case, odometry.clone(), &used_motion(recorded));
    let doubts = as_recorded.doubts();
    if doubts.is_empty() {
        return vec![as_recorded.agreement()];
    }
    of_poses(known, |remedy| as_recorded.contradicts(remedy));
    // Poses that were wrong and are put right say nothing against odometry that goes with them now.
    let put_right = Wheels::of(case, odometry, &case.motion);
    let doubts = put_right.doubts();
    if doubts.is_empty() { vec![put_right.agreement()] } else { doubts }
}

/// Has remedies of the motion be those of its poses alone.
fn of_poses(known: &mut [Verdict], which: impl Fn(&Remedy) -> bool) {
    for verdict in known.iter_mut().filter(|verdict| verdict.subject == "motion") {
        verdict.remedy = match verdict.remedy.take() {
            Some(remedy) if which(&remedy) => Some(remedy.of_poses()),
            other => other,
        };
    }
}

/// Odometry beside the poses it is compared with.
struct Wheels<'a> {
    case: &'a Case<'a>,
    odometry: EgoMotion,
    poses: EgoMotion,
    beside: Beside,
    ratios: Vec<f64>,
}

impl<'a> Wheels<'a> {
    fn of(case: &'a Case, odometry: EgoMotion, poses: &EgoMotion) -> Self {
        let beside = Beside::of(&odometry, poses);
        let ratios = beside.ratios();
        Self { case, odometry, poses: poses.clone(), beside, ratios }
    }

    /// What speaks against it, speeds before times before turns: what is told at other times has other turns.
    fn doubts(&self) -> Vec<Verdict> {
        if let Some(doubt) = self.speed().or_else(|| self.standing()) {
            return vec![doubt].into_iter().chain(self.yaw_rate()).collect();
        }
        let clock = self.clock();
        if clock.is_some() { clock.into_iter().collect() } else { self.yaw_rate().into_iter().collect() }
    }

    /// Whether odometry tells what a remedy changes otherwise than the poses; a clock that is off by little is a fact.
    fn contradicts(&self, remedy: &Remedy) -> bool {
        match remedy {
            Remedy::Speed(_) => self.speed().or_else(|| self.standing()).is_some(),
            Remedy::MotionClock(_) => self.clock().is_some_and(|clock| clock.state == State::Doubt),
            _ => false,
        }
    }

    /// How far a speed times a factor is off in half of all moments, as a share.
    fn off(&self, factor: f64) -> f64 {
        let offs: Vec<f64> = self.ratios.iter().map(|ratio| (ratio * factor - 1.0).abs()).collect();
        median(&offs).unwrap_or(0.0)
    }

    fn speed(&self) -> Option<Verdict> {
        let goes = |factor: f64| self.off(factor) < RATIO.end - 1.0;
        if self.ratios.len() < SCANS || goes(1.0) {
            return None;
        }
        let known = [-1.0].into_iter().chain(SPEEDS.iter().map(|(factor, _)| *factor));
        let fitting =
            known.filter(|factor| goes(*factor)).min_by(|a, b| self.off(*a).total_cmp(&self.off(*b)));
        let usual = median(&self.ratios).unwrap_or(0.0);
        let evidence = format!(
            "odometry gives {usual:.2} of the speed of the poses, and is off by {:.0} % of it in half of {} moments",
            self.off(1.0) * 100.0,
            self.ratios.len()
        );
        Some(self.doubt(evidence, fitting.map(Remedy::Speed)))
    }

    fn standing(&self) -> Option<Verdict> {
        let moments = self.beside.contradicting();
        let evidence =
            format!("odometry and poses contradict each other on whether it stands in {moments} moments");
        (moments >= CREEPING).then(|| self.doubt(evidence, None))
    }

    fn clock(&self) -> Option<Verdict> {
        let is_noticed = |figures: &ClockFigures| figures.now - figures.then > NOTICED;
        let figures = self.beside.clock(&self.odometry).filter(is_clear).filter(is_noticed)?;
        let own = -figures.offset_ms.round();
        let evidence = format!(
            "odometry is {:.2} m/s off the poses, and {:.2} m/s when its times are moved by {own:+.0} ms",
            figures.now, figures.then
        );
        let state = if own.abs() <= HARMLESS_MS { State::Fact } else { State::Doubt };
        let remedy = Some(Remedy::Odometry(Box::new(Remedy::MotionClock(own))));
        Some(Verdict { remedy, ..Verdict::new("motion", Question::Clock, state, evidence) })
    }

    fn yaw_rate(&self) -> Option<Verdict> {
        self.unit_of_yaw_rate().or_else(|| self.no_yaw_rate())
    }

    /// Yaw rates that another sign or unit brings to those of the poses.
    fn unit_of_yaw_rate(&self) -> Option<Verdict> {
        let turning = self.beside.turning();
        let now = turning.misfit(1.0);
        let tried = YAW_RATES.map(|factor| (factor, turning.misfit(factor)));
        let (factor, then) = tried.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let evidence = format!(
            "odometry's yaw rate is {now:.3} rad/s off that of the poses, and {then:.3} rad/s otherwise"
        );
        let is_better = then < YAW_RATE_GAIN.0 * now && now - then > YAW_RATE_GAIN.1;
        is_better.then(|| self.doubt(evidence, Some(Remedy::YawRate(factor))))
    }

    /// Yaw rates that tell of turns hardly more than none at all would.
    fn no_yaw_rate(&self) -> Option<Verdict> {
        let turns = self.beside.turns();
        let (now, without) = (turns.misfit(1.0), turns.misfit(0.0));
        let evidence = format!(
            "in turns odometry's yaw rate is {now:.3} rad/s off that of the poses, and one of 0 would be {without:.3}"
        );
        let is_idle = turns.pairs.len() >= SCANS && now > YAW_RATE_GAIN.0 * without;
        is_idle.then(|| self.doubt(evidence, None))
    }

    fn doubt(&self, evidence: String, remedy: Option<Remedy>) -> Verdict {
        let (is_odometry, grounds) = self.blame();
        let remedy = remedy.filter(|_| is_odometry).map(|remedy| Remedy::Odometry(Box::new(remedy)));
        Verdict::doubt("motion", Question::Motion, format!("{evidence}; {grounds}"), remedy)
    }

    /// Whether the odometry is the one that is wrong, and on what grounds: by range rates, else by what stands still.
    fn blame(&self) -> (bool, String) {
        let motions = [&self.poses, &self.odometry];
        let [by_poses, by_odometry] = motions.map(|motion| count_explained(self.case, motion));
        if by_poses.max(by_odometry) > 0 {
            let grounds = format!(
                "range rates of {by_poses} radars go with the poses, of {by_odometry} with the odometry"
            );
            return (by_odometry <= by_poses, grounds);
        }
        let [poses, odometry] = motions.map(|motion| motion_overlap(&self.case.lidars, motion));
        if !poses.is_enough() {
            return (false, "nothing tells which of both is wrong".into());
        }
        let grounds = format!(
            "by the poses {:.0} % of what the LiDAR saw lies on what it sees half a second later, and {:.0} % by \
             the odometry",
            poses.share() * 100.0,
            odometry.share() * 100.0
        );
        (!poses.is_beaten_by(&odometry), grounds)
    }

    fn agreement(&self) -> Verdict {
        let moments = self.ratios.len();
        if moments < SCANS {
            let missing = format!(
                "odometry and poses are compared in {moments} moments in which it moves: {SCANS} are needed"
            );
            return Verdict::cannot_judge("motion", Question::Motion, missing);
        }
        let usual = median(&self.ratios).unwrap_or(0.0);
        let evidence = format!("odometry gives {usual:.2} of the speed of the poses in {moments} moments");
        Verdict::good("motion", Question::Motion, evidence)
    }
}
