//! The picture of a check.

use ralf_check::{RadarFigures, SequenceCheck, Verdict};
use ralf_plot::{CheckPicture, CheckRow, MOST_CHECK_ROWS, PlotError, check_picture};

/// What a row shows, owned.
struct Row {
    name: String,
    says: String,
    speeds: Vec<[f64; 3]>,
}

/// All radars of all sequences, as PNG.
pub(crate) fn png(checks: &[SequenceCheck]) -> Result<Vec<u8>, PlotError> {
    let mut figures: Vec<(&SequenceCheck, &RadarFigures)> =
        checks.iter().flat_map(|check| check.figures.iter().map(move |figures| (check, figures))).collect();
    // Of too many to draw, those that something speaks against come first.
    if figures.len() > MOST_CHECK_ROWS {
        figures.sort_by_key(|(check, figures)| !check.doubts().any(|doubt| doubt.subject == figures.name));
    }
    let owned: Vec<Row> = figures.iter().map(|(check, figures)| row(check, figures)).collect();
    let rows: Vec<CheckRow> = owned
        .iter()
        .zip(&figures)
        .map(|(row, (_, figures))| CheckRow {
            name: &row.name,
            says: &row.says,
            speeds: &row.speeds,
            by_yaw: &figures.by_yaw,
            by_clock: &figures.by_clock,
        })
        .collect();
    let doubts = checks.iter().flat_map(SequenceCheck::doubts).count();
    let title = format!("Check of {} sequence(s): {doubts} doubt(s)", checks.len());
    check_picture(&CheckPicture { title: &title, rows: &rows })
}

fn row(check: &SequenceCheck, figures: &RadarFigures) -> Row {
    let own = check.doubts().filter(|verdict| verdict.subject == figures.name);
    let says: Vec<String> = own.map(Verdict::says).collect();
    Row {
        name: format!("{} {}", check.name, figures.name),
        says: if says.is_empty() { "nothing speaks against it".into() } else { says.join("; ") },
        speeds: figures.velocities.iter().map(|[t, x, y, u, v]| [*t, x.hypot(*y), u.hypot(*v)]).collect(),
    }
}
