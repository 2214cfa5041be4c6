//! Precision over recall.

use super::*;
use ralf::metrics::RankedPoint;

/// The curve over the threshold, the label's own point, and what labelling everything plausible would give.
pub(crate) fn precision_recall(
    curve: &[RankedPoint],
    used: Option<RankedPoint>,
    base_rate: f64,
) -> Result<String, ReportError> {
    svg((560, 420), |area| {
        let mut chart = axes(area, Axis::share("recall"), Axis::share("precision"), true)?;
        let dashes = [(0.0, base_rate), (1.0, base_rate)];
        chart.draw_series(DashedLineSeries::new(dashes, 5, 5, AXIS.stroke_width(1)))?;
        chart.draw_series(LineSeries::new(
            curve.iter().map(|point| (point.recall, point.precision)),
            PLAUSIBLE.stroke_width(3),
        ))?;
        if let Some(point) = used {
            let at = (point.recall, point.precision);
            chart.draw_series([Circle::new(at, 7, WHITE.filled()), Circle::new(at, 5, ARTIFACT.filled())])?;
        }
        Ok(())
    })
}
