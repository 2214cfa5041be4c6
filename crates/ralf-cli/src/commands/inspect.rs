//! `ralf inspect`: what a recording holds, and what is missing.

use crate::Outcome;
use crate::cli::DatasetArgs;
use crate::settings::SettingsArgs;
use crate::text::{aligned, grouped, print};
use clap::Args;
use ralf_data::inspection::{Inspection, SensorInspection};

/// Arguments of `ralf inspect`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  ralf inspect recordings/city --sequence 00")]
pub(crate) struct InspectArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Looks into a recording.
pub(crate) fn run(arguments: &InspectArgs) -> anyhow::Result<Outcome> {
    let config = arguments.settings.resolve()?;
    let recording = arguments.dataset.open()?;
    let looks: Vec<_> =
        recording.sequences.iter().map(|reader| Inspection::of(reader.sequence(), &config)).collect();
    if arguments.json {
        print(&serde_json::to_string_pretty(
            &serde_json::json!({ "format": recording.format, "sequences": looks }),
        )?)?;
    } else {
        let head =
            format!("{} ({}), {} sequence(s)\n", recording.path.display(), recording.format, looks.len());
        print(&looks.iter().fold(head, |text, look| text + "\n" + &page(look)))?;
    }
    Ok(Outcome::Done)
}

fn page(look: &Inspection) -> String {
    let head = ["sensor", "kind", "count", "rate", "jitter", "gaps", "longest", "to LiDAR", "with LiDAR"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(look.sensors.iter().map(row));
    let missing: String = look.missing.iter().map(|sentence| format!("  - {sentence}\n")).collect();
    let missing = if missing.is_empty() { missing } else { format!("missing:\n{missing}") };
    format!(
        "{}  {}\n{:.1} s, {:.0} m, {} poses, {} odometry samples\n{}{missing}",
        look.name,
        look.title,
        look.seconds,
        look.path_m,
        grouped(look.poses as u64),
        grouped(look.odometry_samples as u64),
        aligned(&rows),
    )
}

fn row(sensor: &SensorInspection) -> Vec<String> {
    let value =
        |value: Option<f64>, unit: &str| value.map_or("-".to_owned(), |value| format!("{value:.1} {unit}"));
    let longest = sensor.gaps.iter().map(|gap| gap.ms).reduce(f64::max);
    vec![
        sensor.name.clone(),
        sensor.kind.to_owned(),
        grouped(sensor.count as u64),
        value(sensor.rate_hz, "Hz"),
        value(sensor.jitter_ms, "ms"),
        sensor.gaps.len().to_string(),
        value(longest, "ms"),
        value(sensor.lidar_offset_ms, "ms"),
        if sensor.kind == "lidar" { "-".to_owned() } else { grouped(sensor.with_lidar as u64) },
    ]
}
