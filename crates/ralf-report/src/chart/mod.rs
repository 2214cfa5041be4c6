//! Charts as SVG. Lines and text take their colours from the page's style sheet where they carry one of the colours
//! named here as part of the page, so that the same chart is at home on light and dark paper.

mod curve;
mod distribution;
mod heat_map;
mod profile;
mod reliability;

pub(crate) use curve::precision_recall;
pub(crate) use distribution::distribution;
pub(crate) use heat_map::settings_map;
pub(crate) use profile::profile;
pub(crate) use reliability::{histogram, reliability};

use crate::ReportError;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Part of the page: the style sheet replaces these.
const TEXT: RGBColor = RGBColor(0x4B, 0x55, 0x63);
const AXIS: RGBColor = RGBColor(0x9A, 0xA3, 0xAF);
const GRID: RGBColor = RGBColor(0xE5, 0xE7, 0xEB);
const COUNTS: RGBColor = RGBColor(0xB6, 0xBE, 0xC9);
/// Okabe and Ito's blue and vermilion, as in the pictures.
const PLAUSIBLE: RGBColor = RGBColor(0x00, 0x72, 0xB2);
const ARTIFACT: RGBColor = RGBColor(0xD5, 0x5E, 0x00);

const FONT: &str = "sans-serif";
const SMALL: u32 = 13;
const LARGE: u32 = 14;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Whatever the drawing library says.
type Drawn<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// An axis.
#[derive(Clone, Copy)]
struct Axis<'a> {
    name: &'a str,
    from: f64,
    to: f64,
    /// How values are written.
    text: fn(f64) -> String,
    /// About so many of them.
    labels: usize,
}

impl Axis<'_> {
    /// From 0 to 1.
    const fn share(name: &str) -> Axis<'_> {
        Axis { name, from: 0.0, to: 1.0, text: one_decimal, labels: 6 }
    }
}

fn one_decimal(value: f64) -> String {
    format!("{value:.1}")
}

fn whole(value: f64) -> String {
    // No "-0".
    format!("{:.0}", value + 0.0)
}

/// Large counts, short.
fn count(value: f64) -> String {
    match value {
        1e6.. => format!("{}M", (value / 1e5).round() / 10.0),
        1e3.. => format!("{}k", (value / 1e2).round() / 10.0),
        _ => whole(value),
    }
}

/// The SVG of what is drawn on an area of this size.
fn svg(size: (u32, u32), draw: impl FnOnce(&Area) -> Drawn) -> Result<String, ReportError> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let drawn = draw(&area).and_then(|()| Ok(area.present()?));
        drawn.map_err(|error| ReportError::Chart(error.to_string()))?;
    }
    Ok(text)
}

fn label(size: u32) -> TextStyle<'static> {
    TextStyle::from((FONT, size).into_font()).color(&TEXT)
}

/// An empty chart with its axes. `below` says whether x has its numbers and name.
fn axes<'a, 'b>(area: &Area<'b>, x: Axis, y: Axis, below: bool) -> Drawn<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(12)
        .margin_right(18)
        .x_label_area_size(if below { 46 } else { 8 })
        .y_label_area_size(62)
        .build_cartesian_2d(x.from..x.to, y.from..y.to)?;
    let (x_text, y_text) = (x.text, y.text);
    let write_x = move |value: &f64| if below { x_text(*value) } else { String::new() };
    let write_y = move |value: &f64| y_text(*value);
    let mut mesh = chart.configure_mesh();
    mesh.disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(AXIS)
        .label_style(label(SMALL))
        .axis_desc_style(label(LARGE))
        .x_labels(x.labels)
        .y_labels(y.labels)
        .x_label_formatter(&write_x)
        .y_label_formatter(&write_y)
        .y_desc(y.name);
    if below {
        mesh.x_desc(x.name);
    }
    mesh.draw()?;
    Ok(chart)
}

/// A bar from the x axis up.
fn bar(from: f64, to: f64, bottom: f64, top: f64, colour: RGBColor) -> Rectangle<(f64, f64)> {
    Rectangle::new([(from, bottom), (to, top)], colour.filled())
}

/// Counts of bins as grey bars over the same x axis as the chart above.
fn counts_below(area: &Area, x: Axis, edges: &[f64], counts: &[u64]) -> Drawn {
    let most = counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    let y = Axis { name: "count", from: 0.0, to: most * 1.08, text: count, labels: 3 };
    let mut chart = axes(area, x, y, true)?;
    let gap = edges.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min) * 0.06;
    chart.draw_series(
        edges
            .windows(2)
            .zip(counts)
            .map(|(edge, count)| bar(edge[0] + gap, edge[1] - gap, 0.0, *count as f64, COUNTS)),
    )?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_counts_are_short() {
        assert_eq!([0.0, 950.0, 1500.0, 2e6].map(count), ["0", "950", "1.5k", "2M"]);
        assert_eq!(whole(-0.0), "0");
    }
}
