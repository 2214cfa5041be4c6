//! F1 over alpha and `w_0`.

use super::*;
use crate::settings_map::{STEPS, SettingsMap, value_at};

/// Highest F1 of the scale: F1 itself, so that maps of several runs can be compared.
const SCALE: u32 = 64;

/// The map with the setting of the run as a ring and the best one as a cross.
pub(crate) fn settings_map(map: &SettingsMap, used: (f64, f64)) -> Result<String, ReportError> {
    svg((660, 520), |area| {
        let (left, right) = area.split_horizontally(560);
        let half = 0.5 / (STEPS - 1) as f64;
        let axis = |name| Axis { from: -half, to: 1.0 + half, ..Axis::share(name) };
        let mut chart = axes(&left, axis("threshold w0"), axis("branch weight alpha"), true)?;
        let cells = (0..STEPS * STEPS).map(|cell| {
            let (alpha, threshold) = (cell / STEPS, cell % STEPS);
            let (x, y) = (value_at(threshold), value_at(alpha));
            let colour = ViridisRGB.get_color(map.f1[alpha][threshold] as f32);
            bar(x - half, x + half, y - half, y + half, colour)
        });
        chart.draw_series(cells)?;
        let (alpha, threshold, _) = map.best();
        chart.draw_series([
            Cross::new((threshold, alpha), 7, BLACK.stroke_width(5)),
            Cross::new((threshold, alpha), 7, WHITE.stroke_width(2)),
        ])?;
        let at = (used.1, used.0);
        chart.draw_series([
            Circle::new(at, 9, BLACK.stroke_width(5)),
            Circle::new(at, 9, WHITE.stroke_width(3)),
        ])?;
        scale(&right)
    })
}

/// The colours beside their values.
fn scale(area: &Area) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .margin_top(12)
        .margin_bottom(46)
        .margin_right(30)
        .y_label_area_size(46)
        .build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
    let bands = (0..SCALE).map(|band| {
        let [from, to] = [band, band + 1].map(|edge| f64::from(edge) / f64::from(SCALE));
        bar(0.0, 1.0, from, to, ViridisRGB.get_color(from as f32))
    });
    chart.draw_series(bands)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(AXIS)
        .label_style(label(SMALL))
        .axis_desc_style(label(LARGE))
        .y_labels(6)
        .y_label_formatter(&|value| one_decimal(*value))
        .y_desc("F1 of plausible detections")
        .draw()?;
    Ok(())
}
