//! The corrections that a check proposes, as a settings file.

mod totals;

use ralf::config::ConfigError;
use ralf_check::{Refinement, Remedy, SensorChange, SequenceCheck, Setting, State, Verdict};
use ralf_data::Settings;
use totals::{Line, Lines, Totals};

/// The text of the file: remedies of what is doubted, and refined corrections of the radars, with those that the
/// recording was read with. A later settings file wins over an earlier one, key by key: the whole is told.
pub(crate) fn text(
    checks: &[SequenceCheck],
    refined: &[Refinement],
    given: &Settings,
) -> Result<String, ConfigError> {
    let mut text = String::from(
        "# What `ralf check` proposes. Each line is an offer: look at it, and take out what you know better.\n\
         # Corrections are added to what the recording says; ralf label takes them with a --config of their own.\n",
    );
    let lines = proposed(checks, refined);
    let is_proposed = lines.keys().any(|key| !key.starts_with('#'));
    Totals::of(lines, given)?.iter().for_each(|(key, line)| {
        text += &format!("{key} = {}{}\n", line.value, line.note);
    });
    if !is_proposed {
        text += "# Nothing is proposed.\n";
    }
    Ok(text)
}

/// What is proposed besides what was given, by key. Keys of what is only told begin with `#`.
fn proposed(checks: &[SequenceCheck], refined: &[Refinement]) -> Lines {
    let mut lines = Lines::new();
    for check in checks {
        let doubted =
            check.verdicts.iter().filter(|verdict| matches!(verdict.state, State::Doubt | State::Fact));
        for (verdict, remedy) in doubted.filter_map(|verdict| Some((verdict, verdict.remedy.as_ref()?))) {
            let known = refined.iter().any(|refinement| refinement.name == verdict.subject);
            // A sensor's own change is told by its refinement.
            if !(known && matches!(remedy, Remedy::Sensor(change) if !is_vertical(change))) {
                let denied = denied(checks, verdict);
                for Setting { key, value } in remedy.settings(&verdict.subject) {
                    let key = if denied.is_some() { format!("# {key}") } else { key };
                    add(&mut lines, Setting { key, value }, denied.as_deref().unwrap_or_default());
                }
            }
        }
    }
    for refinement in refined {
        for (setting, deviation) in settings(refinement) {
            add(&mut lines, setting, &deviation);
        }
    }
    lines
}

/// Settings are those of all sequences: what is doubted in some of them is not proposed, but told, where it is in order
/// in as many others or in more.
fn denied(checks: &[SequenceCheck], doubt: &Verdict) -> Option<String> {
    let is_said = |check: &SequenceCheck, state: State| {
        check.verdicts.iter().any(|verdict| {
            (&verdict.subject, verdict.question, verdict.state) == (&doubt.subject, doubt.question, state)
        })
    };
    let names = |state: State| -> Vec<&str> {
        checks.iter().filter(|check| is_said(check, state)).map(|check| check.name.as_str()).collect()
    };
    let (doubted, good) = (names(doubt.state), names(State::Good));
    let told = || format!("    # in {}; in order in {}", doubted.join(", "), good.join(", "));
    (good.len() >= doubted.len() && !good.is_empty()).then(told)
}

/// Roll, pitch and height are found by other means than the refinement's.
fn is_vertical(change: &SensorChange) -> bool {
    change.turn_deg[0] != 0.0 || change.turn_deg[1] != 0.0 || change.shift_m[2] != 0.0
}

fn add(lines: &mut Lines, Setting { key, value }: Setting, note: &str) {
    lines.entry(key).or_insert_with(|| Line { value, note: note.to_owned() });
}

/// What a refinement proposes, each with its standard deviation as a comment.
fn settings(refinement: &Refinement) -> Vec<(Setting, String)> {
    let SensorChange { turn_deg, shift_m, clock_ms, mirrored } = refinement.proposed;
    let rounded = |value: f64, digits: f64| (value * digits).round() / digits;
    let nothing = SensorChange::default();
    let turned = SensorChange { turn_deg: turn_deg.map(|value| rounded(value, 100.0)), ..nothing };
    let shifted = SensorChange { shift_m: shift_m.map(|value| rounded(value, 1000.0)), ..nothing };
    let later = SensorChange { clock_ms: rounded(clock_ms, 10.0), ..nothing };
    let rows = [
        (turned, note(refinement, &[0], "degrees")),
        (shifted, note(refinement, &[1, 2], "m")),
        (later, note(refinement, &[3], "ms")),
        (SensorChange { mirrored, ..nothing }, String::new()),
    ];
    let mut settings = Vec::new();
    for (change, note) in rows {
        for setting in Remedy::Sensor(change).settings(&refinement.name) {
            settings.push((setting, note.clone()));
        }
    }
    settings
}

/// Standard deviations, as a comment; nothing where there are none.
fn note(refinement: &Refinement, which: &[usize], unit: &str) -> String {
    if which.iter().any(|i| refinement.deviations[*i].is_nan()) {
        return String::new();
    }
    let told: Vec<String> = which.iter().map(|i| format!("{:.3}", refinement.deviations[*i])).collect();
    format!("    # +- {} {unit}", told.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_check::Question;

    fn text(checks: &[SequenceCheck], refined: &[Refinement]) -> String {
        super::text(checks, refined, &Settings::default()).unwrap()
    }

    fn check(sequence: &str, state: State) -> SequenceCheck {
        let remedy = (state == State::Doubt).then_some(Remedy::Speed(0.5));
        let (subject, question) = ("motion".to_owned(), Question::Motion);
        let verdict = Verdict { subject, question, state, evidence: String::new(), remedy };
        SequenceCheck { name: sequence.to_owned(), verdicts: vec![verdict], figures: Vec::new() }
    }

    #[test]
    fn what_is_in_order_in_as_many_other_sequences_is_told_and_not_proposed() {
        let doubt = [check("00", State::Doubt)];
        assert!(text(&doubt, &[]).contains("\nmotion.speed_factor = 0.5\n"));
        let denied = [check("00", State::Doubt), check("01", State::Good), check("02", State::CannotJudge)];
        let text_of_denied = text(&denied, &[]);
        let line = "\n# motion.speed_factor = 0.5    # in 00; in order in 01\n# Nothing is proposed.\n";
        assert!(text_of_denied.ends_with(line), "{text_of_denied}");
        let most = [check("00", State::Doubt), check("01", State::Good), check("02", State::Doubt)];
        assert!(text(&most, &[]).contains("\nmotion.speed_factor = 0.5\n"));
    }

    fn turned(name: &str, yaw: f64) -> Refinement {
        let change = SensorChange { turn_deg: [0.0, 0.0, yaw], ..SensorChange::default() };
        Refinement { name: name.to_owned(), change, deviations: [f64::NAN; 4], proposed: change }
    }

    #[test]
    fn what_the_recording_was_read_with_is_part_of_what_is_proposed() {
        let given = "motion.speed_factor = 0.5\ncorrections.a.add_yaw_deg = 3.0\ncorrections.b.time_offset_ms = -20.5";
        let given = Settings::from_toml(given, &[]).unwrap();
        let all = super::text(&[check("00", State::Doubt)], &[turned("a", 2.96)], &given).unwrap();
        for line in ["corrections.a.add_yaw_deg = 5.96", "motion.speed_factor = 0.25"] {
            assert!(all.contains(&format!("\n{line}\n")), "{all}");
        }
        assert!(all.contains("\ncorrections.b.time_offset_ms = -20.5    # as given\n"), "{all}");
        // Read with its own proposals, it keeps them.
        let given = Settings::from_toml(&all, &[]).unwrap();
        let again = super::text(&[], &[], &given).unwrap();
        assert_eq!(Settings::from_toml(&again, &[]).unwrap(), given);
        assert!(again.ends_with("# Nothing is proposed.\n"), "{again}");
        // And what takes it back takes its line away.
        let back = super::text(&[], &[turned("a", -5.96)], &given).unwrap();
        assert_eq!(
            Settings::from_toml(&back, &[]).unwrap().corrections.get("a").copied().unwrap_or_default(),
            Default::default()
        );
    }
}
