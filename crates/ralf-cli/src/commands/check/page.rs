//! What a check says, for people.

use ralf_check::{Question, SequenceCheck, State, Verdict};
use ralf_data::run::{CheckLine, CheckRecord};

/// A sequence: what is doubted first, with remedies; all else in a line, or in full.
pub(crate) fn page(check: &SequenceCheck, verbose: bool) -> String {
    let of = |state: State| check.verdicts.iter().filter(move |verdict| verdict.state == state);
    let doubts = of(State::Doubt).count();
    let head = match doubts {
        0 => format!("{}: nothing speaks against it\n", check.name),
        1 => format!("{}: 1 doubt\n", check.name),
        more => format!("{}: {more} doubts\n", check.name),
    };
    let mut text = head;
    for state in [State::Doubt, State::Fact, State::CannotJudge, State::Good] {
        if state != State::Good || verbose {
            of(state).for_each(|verdict| text += &line(verdict));
        }
    }
    let good = of(State::Good).count();
    if !verbose && good > 0 {
        text += &format!("  in order    {good} further answers (--verbose)\n");
    }
    text
}

fn line(verdict: &Verdict) -> String {
    let state = match verdict.state {
        State::Doubt => "DOUBT",
        State::Fact => "fact",
        State::CannotJudge => "can't judge",
        State::Good => "in order",
    };
    let remedy = verdict.remedy.as_ref().map(|remedy| format!("{}: ", remedy.words())).unwrap_or_default();
    let Verdict { subject, evidence, .. } = verdict;
    format!("  {state:<11} {subject} ({}): {remedy}{evidence}\n", question(verdict.question))
}

fn question(question: Question) -> &'static str {
    match question {
        Question::Bounds => "numbers",
        Question::Doppler => "range rates",
        Question::Clock => "clock",
        Question::Lidar => "LiDAR",
        Question::Neighbours => "neighbours",
        Question::Camera => "picture",
        Question::Depth => "depth",
        Question::Motion => "motion",
        Question::Ground => "ground",
    }
}

/// What is doubted of a sequence, a line each.
pub(crate) fn doubts(check: &CheckRecord) -> impl Iterator<Item = String> {
    let told = |line: &CheckLine| match &line.remedy {
        Some(remedy) => format!("{} {remedy}: {}", line.subject, line.evidence),
        None => format!("{}: {}", line.subject, line.evidence),
    };
    check.doubts.iter().map(move |line| format!("doubt: {}: {}", check.sequence, told(line)))
}
