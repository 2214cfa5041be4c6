//! The corrections that a check proposes, as a settings file.

mod totals;

use ralf::config::ConfigError;
use ralf_check::{Question, Refinement, Remedy, SensorChange, SequenceCheck, Setting, State, Verdict};
use ralf_data::Settings;
use totals::{Line, Lines, TOLD, totals};

/// How such a file begins.
pub(crate) const BEGIN: &str = "# What `ralf check` proposes.";

/// The text of the file: remedies of what is doubted, and refined corrections of the radars, with those that the
/// recording was read with. A later settings file wins over an earlier one, key by key: the whole is told.
pub(crate) fn text(
    checks: &[SequenceCheck],
    refined: &[Refinement],
    given: &Settings,
) -> Result<String, ConfigError> {
    let mut text = format!(
        "{BEGIN} Each line is an offer: look at it, and take out what you know better.\n\
         # Corrections are added to what the recording says; ralf label takes them with a --config of their own.\n",
    );
    let lines = proposed(checks, refined);
    let is_proposed = lines.keys().any(|key| !key.starts_with(TOLD));
    totals(lines, given)?.iter().for_each(|(key, line)| {
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
    for refinement in refined {
        let height = height_of(checks, &refinement.name);
        let denied = denied_lidar(checks, refinement);
        for (setting, note) in settings(refinement, height) {
            let is_told = denied.is_some() || refinement.only_of.is_some();
            add(&mut lines, setting, denied.as_ref().unwrap_or(&note), is_told);
        }
    }
    // Of values of one key that which was measured stands before one that is only the usual reason.
    let is_guess = |verdict: &&Verdict| verdict.question == Question::Bounds;
    let (guessed, measured): (Vec<_>, Vec<_>) = doubted(checks).partition(is_guess);
    for verdict in measured.into_iter().chain(guessed) {
        let Some(remedy) = verdict.remedy.as_ref() else { continue };
        if !(is_refined(checks, refined, &verdict.subject) && is_plan(verdict)) {
            let denied = denied(checks, verdict);
            for setting in remedy.settings(&verdict.subject) {
                add(&mut lines, setting, denied.as_deref().unwrap_or_default(), denied.is_some());
            }
        }
    }
    lines
}

/// Whether a sensor's own change is told by its refinement: a radar's always, a LiDAR's where most ask for one.
fn is_refined(checks: &[SequenceCheck], refined: &[Refinement], name: &str) -> bool {
    let is_told = |own: &Refinement| is_radar(checks, name) || own.proposed != SensorChange::default();
    refined.iter().any(|own| own.name == name && is_told(own))
}

fn is_radar(checks: &[SequenceCheck], name: &str) -> bool {
    checks.iter().flat_map(|check| &check.figures).any(|figures| figures.name == name)
}

/// Whether a remedy is what refinements tell. Of a LiDAR on its side a tilt is a yaw.
fn is_plan(verdict: &Verdict) -> bool {
    verdict.question != Question::Ground
        && matches!(&verdict.remedy, Some(Remedy::Sensor(change)) if !is_vertical(change))
}

/// Where a LiDAR's change is in order as often as not: what refines it has not seen all sequences.
fn denied_lidar(checks: &[SequenceCheck], refinement: &Refinement) -> Option<String> {
    let is_own = |verdict: &&Verdict| verdict.subject == refinement.name && is_plan(verdict);
    let own = doubted(checks).find(is_own).filter(|_| !is_radar(checks, &refinement.name));
    own.and_then(|verdict| denied(checks, verdict))
}

/// What has a remedy if anything has, of all sequences.
fn doubted(checks: &[SequenceCheck]) -> impl Iterator<Item = &Verdict> {
    let verdicts = checks.iter().flat_map(|check| &check.verdicts);
    verdicts.filter(|verdict| matches!(verdict.state, State::Doubt | State::Fact))
}

/// Settings are those of all sequences: what is doubted in some of them is not proposed, but told, where it is in order
/// in as many others or in more.
fn denied(checks: &[SequenceCheck], doubt: &Verdict) -> Option<String> {
    let is_doubted = |check: &SequenceCheck| {
        let is_like = |verdict: &Verdict| {
            (&verdict.subject, verdict.question, verdict.state)
                == (&doubt.subject, doubt.question, doubt.state)
        };
        check.verdicts.iter().any(is_like)
    };
    let is_good = |check: &SequenceCheck| {
        let speaks =
            |verdict: &Verdict| verdict.state == State::Good && speaks_against(checks, doubt, verdict);
        !is_doubted(check) && check.verdicts.iter().any(speaks)
    };
    let names = |which: &dyn Fn(&SequenceCheck) -> bool| -> Vec<&str> {
        checks.iter().filter(|check| which(check)).map(|check| check.name.as_str()).collect()
    };
    let (doubted, good) = (names(&is_doubted), names(&is_good));
    let told = || format!("    # in {}; in order in {}", doubted.join(", "), good.join(", "));
    (good.len() >= doubted.len() && !good.is_empty()).then(told)
}

/// Whether something in order denies a doubt: the same of the same sensor, of the motion's clock that radars keep it,
/// and of a LiDAR's place that radars lie on LiDARs.
fn speaks_against(checks: &[SequenceCheck], doubt: &Verdict, good: &Verdict) -> bool {
    let of_radar = |question: Question| good.question == question && is_radar(checks, &good.subject);
    match &doubt.remedy {
        Some(Remedy::MotionClock(_)) => of_radar(Question::Clock),
        _ if is_plan(doubt) && !is_radar(checks, &doubt.subject) => of_radar(Question::Lidar),
        _ => (&good.subject, good.question) == (&doubt.subject, doubt.question),
    }
}

/// The height that is missing of a sensor, m, by what stands on the ground.
fn height_of(checks: &[SequenceCheck], name: &str) -> f64 {
    let own = doubted(checks).filter(|verdict| verdict.subject == name && denied(checks, verdict).is_none());
    let heights = own.filter_map(|verdict| match &verdict.remedy {
        Some(Remedy::Sensor(change)) => Some(change.shift_m[2]),
        _ => None,
    });
    heights.into_iter().find(|height| *height != 0.0).unwrap_or(0.0)
}

/// Roll, pitch and height are found by other means than the refinement's.
fn is_vertical(change: &SensorChange) -> bool {
    change.turn_deg[0] != 0.0 || change.turn_deg[1] != 0.0 || change.shift_m[2] != 0.0
}

/// Of several values of a key the first one stands.
fn add(lines: &mut Lines, Setting { key, value }: Setting, note: &str, is_told: bool) {
    let key = if is_told { format!("{TOLD}{key}") } else { key };
    lines.entry(key).or_insert_with(|| Line { value, note: note.to_owned() });
}

/// What a refinement proposes, and a height that was found besides, each with its standard deviation as a comment.
fn settings(refinement: &Refinement, height: f64) -> Vec<(Setting, String)> {
    let SensorChange { turn_deg, mut shift_m, clock_ms, mirrored } = refinement.proposed;
    if shift_m[2] == 0.0 {
        shift_m[2] = height;
    }
    let in_plan = shift_m[0] != 0.0 || shift_m[1] != 0.0;
    let rounded = |value: f64, digits: f64| (value * digits).round() / digits;
    let nothing = SensorChange::default();
    let turned = SensorChange { turn_deg: turn_deg.map(|value| rounded(value, 100.0)), ..nothing };
    let shifted = SensorChange { shift_m: shift_m.map(|value| rounded(value, 1000.0)), ..nothing };
    let later = SensorChange { clock_ms: rounded(clock_ms, 10.0), ..nothing };
    let rows = [
        (turned, note(refinement, &[0], "degrees")),
        (shifted, if in_plan { note(refinement, &[1, 2], "m") } else { String::new() }),
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

/// Standard deviations, as a comment, or whose alone it is; nothing where there is neither.
fn note(refinement: &Refinement, which: &[usize], unit: &str) -> String {
    if let Some(names) = &refinement.only_of {
        return format!("    # of {} alone: it is mounted otherwise in others", names.join(", "));
    }
    if which.iter().any(|i| refinement.deviations[*i].is_nan()) {
        return String::new();
    }
    let told: Vec<String> = which.iter().map(|i| format!("{:.3}", refinement.deviations[*i])).collect();
    format!("    # +- {} {unit}", told.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_check::RadarFigures;

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
        Refinement {
            name: name.to_owned(),
            change,
            deviations: [f64::NAN; 4],
            proposed: change,
            only_of: None,
        }
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
        // And what takes it back is told: read after the file that said it, it wins.
        let back = super::text(&[], &[turned("a", -5.96)], &given).unwrap();
        assert!(back.contains("\ncorrections.a.add_yaw_deg = 0.0\n"), "{back}");
    }

    #[test]
    fn what_was_given_of_a_sensor_is_said_again() {
        let given = Settings::from_toml("sensors.\"a b\".fov_azimuth_deg = 120.0", &[]).unwrap();
        let again = super::text(&[], &[], &given).unwrap();
        assert!(again.contains("\nsensors.\"a b\".fov_azimuth_deg = 120.0    # as given\n"), "{again}");
        assert_eq!(Settings::from_toml(&again, &[]).unwrap(), given);
    }

    fn doubt(subject: &str, question: Question, remedy: Remedy) -> Verdict {
        let (subject, evidence, remedy) = (subject.to_owned(), String::new(), Some(remedy));
        Verdict { subject, question, state: State::Doubt, evidence, remedy }
    }

    fn in_order(subject: &str, question: Question) -> Verdict {
        let (state, remedy) = (State::Good, None);
        Verdict { state, remedy, ..doubt(subject, question, Remedy::Speed(1.0)) }
    }

    fn with(name: &str, verdicts: Vec<Verdict>) -> SequenceCheck {
        let figures = vec![RadarFigures { name: "radar".to_owned(), ..RadarFigures::default() }];
        SequenceCheck { name: name.to_owned(), verdicts, figures }
    }

    #[test]
    fn what_was_measured_stands_before_what_is_the_usual_reason() {
        let [usual, measured] = [0.01, 1.0 / 3.6].map(Remedy::Speed);
        let verdicts =
            vec![doubt("motion", Question::Bounds, usual), doubt("motion", Question::Motion, measured)];
        let text = text(&[with("00", verdicts)], &[]);
        assert!(text.contains("\nmotion.speed_factor = 0.277778\n"), "{text}");
    }

    #[test]
    fn a_pitch_is_proposed_where_the_plan_is_in_order() {
        let pitch = SensorChange { turn_deg: [0.0, 3.0, 0.0], ..SensorChange::default() };
        let question = Question::Lidar;
        let verdicts = vec![doubt("radar", question, Remedy::Sensor(pitch)), in_order("radar", question)];
        let text = text(&[with("00", verdicts)], &[turned("radar", 0.0)]);
        assert!(text.contains("\ncorrections.radar.add_pitch_deg = 3.0\n"), "{text}");
    }

    #[test]
    fn a_height_and_a_place_are_one_translation() {
        let [low, ahead] = [[0.0, 0.0, -0.3], [0.5, 0.0, 0.0]]
            .map(|shift_m| SensorChange { shift_m, ..SensorChange::default() });
        let verdicts = vec![doubt("a", Question::Ground, Remedy::Sensor(low))];
        let refined = Refinement { proposed: ahead, ..turned("a", 0.0) };
        let text = text(&[with("00", verdicts.clone()), with("01", verdicts)], &[refined]);
        assert!(text.contains("\ncorrections.a.add_translation = [0.5, 0.0, -0.3]\n"), "{text}");
    }

    #[test]
    fn a_lidar_that_one_sequence_of_many_doubts_is_left_alone() {
        let far = SensorChange { turn_deg: [0.0, 0.0, 39.0], ..SensorChange::default() };
        let asking = || with("00", vec![doubt("a", Question::Motion, Remedy::Sensor(far))]);
        let good = |name: &str| with(name, vec![in_order("radar", Question::Lidar)]);
        let denied =
            "\n# corrections.a.add_yaw_deg = 39.0    # in 00; in order in 01, 02\n# Nothing is proposed.\n";
        // Whether its refinement has seen one sequence or all.
        for refined in [turned("a", 0.0), turned("a", 39.0)] {
            let text = text(&[asking(), good("01"), good("02")], &[refined]);
            assert!(text.ends_with(denied), "{text}");
        }
        let alone = text(&[asking(), with("01", Vec::new())], &[turned("a", 39.0)]);
        assert!(alone.contains("\ncorrections.a.add_yaw_deg = 39.0\n"), "{alone}");
    }

    #[test]
    fn the_clock_of_the_motion_is_denied_by_radars_that_keep_it() {
        let late = vec![doubt("motion", Question::Clock, Remedy::MotionClock(-200.0))];
        let good = || vec![in_order("radar", Question::Clock)];
        let text = text(&[with("00", late), with("01", good()), with("02", good())], &[]);
        assert!(
            text.contains("\n# motion.time_offset_ms = -200.0    # in 00; in order in 01, 02\n"),
            "{text}"
        );
    }

    #[test]
    fn what_is_mounted_otherwise_in_others_is_told_alone() {
        let refined = Refinement { only_of: Some(vec!["00".into(), "02".into()]), ..turned("a", 2.0) };
        let text = text(&[], &[refined]);
        let line =
            "\n# corrections.a.add_yaw_deg = 2.0    # of 00, 02 alone: it is mounted otherwise in others\n";
        assert!(text.contains(line), "{text}");
    }
}
