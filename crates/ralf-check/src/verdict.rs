//! What the check says: a verdict per sensor and question, with its evidence and, where one is found, the remedy.

use crate::remedy::Remedy;
use serde::Serialize;

/// What was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// Are the numbers such as a sensor can give?
    Bounds,
    /// Do range rates go with the vehicle's motion?
    Doppler,
    /// Do the clocks agree?
    Clock,
    /// Do detections lie where LiDAR points do?
    Lidar,
    /// Do sensors of a kind see the same where their views overlap?
    Neighbours,
    /// Do edges of images lie where the LiDAR sees things end?
    Camera,
    /// Does stored depth grow with the distances that the LiDAR measures?
    Depth,
    /// Do things lie where the motion takes them?
    Motion,
    /// Is the ground level?
    Ground,
}

/// How it was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Nothing speaks against the recording.
    Good,
    /// Something does.
    Doubt,
    /// Worth knowing, and no fault of what labels rest on.
    Fact,
    /// The data don't suffice; the evidence says what is missing.
    CannotJudge,
}

/// One answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// The sensor's name, or `motion`.
    pub subject: String,
    /// What was asked.
    pub question: Question,
    /// How it was answered.
    pub state: State,
    /// On what grounds, or what is missing: a clause for people.
    pub evidence: String,
    /// What would put it right.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<Remedy>,
}

impl Verdict {
    /// In a few words: what is wrong and what to do, where that is known; else what was found.
    pub fn says(&self) -> String {
        self.remedy.as_ref().map_or_else(|| self.evidence.clone(), Remedy::words)
    }

    pub(crate) fn new(subject: &str, question: Question, state: State, evidence: String) -> Self {
        Self { subject: subject.to_owned(), question, state, evidence, remedy: None }
    }

    pub(crate) fn good(subject: &str, question: Question, evidence: String) -> Self {
        Self::new(subject, question, State::Good, evidence)
    }

    pub(crate) fn doubt(subject: &str, question: Question, evidence: String, remedy: Option<Remedy>) -> Self {
        Self { remedy, ..Self::new(subject, question, State::Doubt, evidence) }
    }

    pub(crate) fn cannot_judge(subject: &str, question: Question, missing: impl Into<String>) -> Self {
        Self::new(subject, question, State::CannotJudge, missing.into())
    }
}

/// All answers about one sequence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SequenceCheck {
    /// The sequence's name.
    pub name: String,
    /// By sensor: the motion, the radars, the LiDARs, the cameras.
    pub verdicts: Vec<Verdict>,
    /// What pictures show, of each radar; nothing where nobody asked for it.
    pub figures: Vec<RadarFigures>,
}

impl SequenceCheck {
    /// What is doubted.
    pub fn doubts(&self) -> impl Iterator<Item = &Verdict> {
        self.verdicts.iter().filter(|verdict| verdict.state == State::Doubt)
    }
}

/// What a picture shows of one radar.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct RadarFigures {
    /// Its name.
    pub name: String,
    /// Scans: seconds after the first, and the radar's own velocity (x, y; m/s, its frame) as its range rates have it,
    /// and as the vehicle's motion has it.
    pub velocities: Vec<[f64; 5]>,
    /// Share of detections beside a LiDAR point, by added yaw, degrees.
    pub by_yaw: Vec<[f64; 2]>,
    /// The same by added time, ms.
    pub by_clock: Vec<[f64; 2]>,
}
