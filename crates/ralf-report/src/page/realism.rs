//! A simulated recording beside a real one.

use super::{document, figure, heads, swatch};
use crate::number::grouped;
use crate::realism::RealismPage;
use crate::{ReportError, chart};
use maud::{Markup, html};
use ralf_data::realism::{Compared, Distributions, Summary};

/// The whole page.
pub(crate) fn render(page: &RealismPage) -> Result<String, ReportError> {
    let figures: Result<Vec<Markup>, ReportError> =
        page.realism.quantities.iter().filter(|c| c.real.is_some()).map(|c| chart_of(page, c)).collect();
    let body = html! {
        (header(page))
        (distances(page))
        section #distributions {
            h2 { "Distributions" }
            p {
                (swatch("plausible")) "real " (swatch("artifact")) "simulated. Shares of values in bins from the first "
                "to the last hundredth of both recordings."
            }
            div.figures { @for figure in figures? { (figure) } }
        }
        (looked_at(page))
    };
    Ok(document(&format!("RALF realism: {} and {}", page.real_name, page.simulated_name), &body))
}

fn header(page: &RealismPage) -> Markup {
    let ks = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    let shared = page.realism.quantities.iter().filter(|compared| compared.distance.is_some()).count();
    html! {
        header {
            p.kicker { "Radar Artifact Labeling Framework" }
            h1 { "How real is " em { (page.simulated_name) } "?" }
            p.lead {
                "What its measurements are like, beside those of " em { (page.real_name) } "."
            }
            dl.tiles {
                div {
                    dt { "Mean distance" } dd { (ks(page.realism.mean_ks)) }
                    dd.note { "Kolmogorov-Smirnov, 0 to 1" }
                }
                div {
                    dt { "Of the real halves" } dd { (ks(page.realism.mean_ks_within_real)) }
                    dd.note { "what reality itself varies" }
                }
                div { dt { "Quantities" } dd { (shared) } dd.note { "that both recordings have" } }
            }
        }
    }
}

fn distances(page: &RealismPage) -> Markup {
    html! {
        section #distances {
            h2 { "Distances" }
            p {
                "Kolmogorov-Smirnov (KS) is the largest difference between the shares of values below any one number. "
                "Moved (1-Wasserstein) is how far values have to be moved on average to turn one distribution into the "
                "other; over the spread, which is the mean distance of the real values from their median, 1 is as far "
                "off as that median alone would be. Halves is the KS of the first half of the real recording and "
                "its second; real and simulated are medians. Fewer than eight values on a side are no distribution."
            }
            div.scroll { table.bars {
                (heads(&["Quantity", "Real", "5 to 95 %", "Simulated", "5 to 95 %", "Moved", "KS", "", "Halves"]))
                tbody { @for compared in &page.realism.quantities { (row(compared)) } }
            } }
            @for compared in &page.realism.quantities {
                @for (name, summary) in [(&page.real_name, compared.real), (&page.simulated_name, compared.simulated)] {
                    @if summary.is_none() {
                        p.note {
                            (name) " lacks what " em { (compared.name) } " needs: "
                            (compared.quantity.description().needs) "."
                        }
                    }
                }
            }
        }
    }
}

fn row(compared: &Compared) -> Markup {
    let Compared { name, unit, real, simulated, distance, within_real, .. } = compared;
    html! {
        tr {
            th scope="row" { (name) @if !unit.is_empty() { ", " (unit) } }
            @for summary in [real, simulated] {
                @match summary {
                    Some(summary) => { td { (number(summary.quantiles[2])) } td { (span(summary)) } }
                    None => { td.absent colspan="2" { "not measured" } }
                }
            }
            td { (distance.and_then(|d| d.normalised).map_or("–".to_owned(), |value| format!("{value:.2}"))) }
            td { (distance.map_or("–".to_owned(), |d| format!("{:.2}", d.ks))) }
            td.bar.whole {
                @if let Some(distance) = distance {
                    span.artifact style={ "width:" (format!("{:.1}", 100.0 * distance.ks)) "%" } {}
                }
            }
            td { (within_real.map_or("–".to_owned(), |d| format!("{:.2}", d.ks))) }
        }
    }
}

fn span(summary: &Summary) -> String {
    format!("{} to {}", number(summary.quantiles[0]), number(summary.quantiles[4]))
}

/// Three digits or so.
fn number(value: f32) -> String {
    match value.abs() {
        1e4.. => grouped(value.round() as u64),
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

fn chart_of(page: &RealismPage, compared: &Compared) -> Result<Markup, ReportError> {
    let description = compared.quantity.description();
    let axis = if compared.unit.is_empty() {
        compared.name.to_owned()
    } else {
        format!("{}, {}", compared.name, compared.unit)
    };
    let real = page.real.values(compared.quantity);
    let simulated = page.simulated.values(compared.quantity);
    let svg = chart::distribution(&real, &simulated, &axis, description.is_share())?;
    let mut heading = description.name.to_owned();
    if let Some(distance) = compared.distance {
        heading += &format!(": KS {:.2}", distance.ks);
    }
    Ok(figure(&heading, svg, html! { (description.meaning) }))
}

/// How much of each recording the page tells of.
fn looked_at(page: &RealismPage) -> Markup {
    let told = |name: &str, found: &Distributions| {
        html! {
            dt { (name) }
            dd {
                (grouped(found.radar_scans as u64)) " radar scans and "
                (grouped(found.lidar_scans as u64)) " LiDAR scans"
                @if !found.unreadable.is_empty() { "; " (grouped(found.unreadable.len() as u64)) " can't be read" }
            }
        }
    };
    html! {
        section #looked-at {
            h2 { "What was looked at" }
            dl.facts { (told(&page.real_name, &page.real)) (told(&page.simulated_name, &page.simulated)) }
            footer { "RALF " (env!("CARGO_PKG_VERSION")) }
        }
    }
}
