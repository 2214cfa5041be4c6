//! `ralf plot`: labelled scans from above, and as a camera sees them.

mod birds_eye;
mod camera;

use crate::Outcome;
use crate::cli::DatasetArgs;
use crate::progress::say;
use anyhow::{Context, bail};
use clap::Args;
use ralf::source::Sequence;
use ralf::sync;
use ralf_data::SequenceReader;
use ralf_data::output::{LabelledRows, read_labelled_rows};
use ralf_plot::MarkLabel;
use std::path::PathBuf;

/// Arguments of `ralf plot`.
#[derive(Debug, Args)]
#[command(after_help = "\
Without --radar all radars are drawn: the first one's scan, and the others' nearest to it in time. With --camera the picture
shows the straight views of the image nearest to the scan, each beside its depth as the LiDAR calibrates it.

Examples:
  ralf plot recordings/city out --sequence 00 --scan 17 -o scan.png
  ralf plot recordings/city out --sequence 00 --scan 17 --radar radar_front --radius 40 -o front.png
  ralf plot recordings/city out --sequence 00 --all -o overview.png
  ralf plot recordings/city out --sequence 00 --scan 17 --camera front -o camera.png")]
pub(crate) struct PlotArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// What `ralf label` wrote
    #[arg(value_name = "OUT")]
    labels: PathBuf,
    /// Number of the scan
    #[arg(long, value_name = "N", required_unless_present = "all")]
    scan: Option<usize>,
    /// The whole sequence: all detections beside the plausible ones
    #[arg(long, conflicts_with = "scan")]
    all: bool,
    /// Only this radar
    #[arg(long, value_name = "NAME")]
    radar: Option<String>,
    /// Draw this far around the vehicle, m; fitted to the detections if not given
    #[arg(long, value_name = "M", conflicts_with = "camera")]
    radius: Option<f64>,
    /// What this camera sees, beside its depth, with LiDAR and radar in it
    #[arg(long, value_name = "NAME", requires = "scan")]
    camera: Option<String>,
    /// Only this view of the camera, from 0
    #[arg(long, value_name = "V", requires = "camera")]
    view: Option<usize>,
    /// Take depth images from this folder; OUT/depth if not given, or the recording's own
    #[arg(long, value_name = "FOLDER", requires = "camera")]
    depth: Option<PathBuf>,
    /// The picture (PNG)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Draws a picture.
pub(crate) fn run(arguments: &PlotArgs) -> anyhow::Result<Outcome> {
    let recording = arguments.dataset.open()?;
    let recording = match camera::depth_store(arguments)? {
        Some(store) => store.attach(recording),
        None => recording,
    };
    let [reader] = recording.sequences.as_slice() else {
        let names: Vec<_> =
            recording.sequences.iter().map(|reader| reader.sequence().name.as_str()).collect();
        bail!("expected one sequence, found {}: choose with --sequence ({})", names.len(), names.join(", "));
    };
    let file = arguments.labels.join("sequences").join(&reader.sequence().name).join("plausibility.parquet");
    let plot = Plot { reader: reader.as_ref(), rows: read_labelled_rows(&file)?, arguments };
    let png = match (arguments.scan, &arguments.camera) {
        (Some(scan), Some(camera)) => plot.camera(scan, camera)?,
        (Some(scan), None) => plot.scan(scan)?,
        (None, _) => plot.overview()?,
    };
    ralf_data::write_whole(&arguments.output, &png)?;
    say(&format!("wrote {}", arguments.output.display()));
    Ok(Outcome::Done)
}

struct Plot<'a> {
    reader: &'a dyn SequenceReader,
    rows: LabelledRows,
    arguments: &'a PlotArgs,
}

impl Plot<'_> {
    fn sequence(&self) -> &Sequence {
        self.reader.sequence()
    }

    /// Index of the radar asked for, or of the first.
    fn radar(&self) -> anyhow::Result<usize> {
        let radars = &self.sequence().rig.radars;
        let wanted = self.arguments.radar.as_ref();
        let found = radars.iter().position(|radar| wanted.is_none_or(|name| radar.name == *name));
        let names: Vec<_> = radars.iter().map(|radar| radar.name.as_str()).collect();
        found.with_context(|| format!("expected a radar of {}, found {wanted:?}", names.join(", ")))
    }

    /// Whether a row belongs to the radars that are drawn.
    fn is_drawn(&self, row: usize) -> bool {
        let name = &self.rows.radars[self.rows.radar[row]];
        self.arguments.radar.as_ref().is_none_or(|wanted| wanted == name)
    }

    /// The radars that are drawn, for people.
    fn who(&self) -> &str {
        self.arguments.radar.as_deref().unwrap_or("all radars")
    }

    /// Time of a scan of the radar asked for, or of the first, ns.
    fn time_of(&self, scan: usize) -> anyhow::Result<i64> {
        let radar = self.radar()?;
        let times = &self.sequence().times.radars[radar];
        let name = &self.sequence().rig.radars[radar].name;
        let last = times.len().saturating_sub(1);
        times
            .get(scan)
            .copied()
            .with_context(|| format!("expected a scan of {name} from 0 to {last}, found {scan}"))
    }

    /// The detections of each drawn radar's scan nearest to a time: row, and time of its scan, ns.
    fn rows_of_scan(&self, t_ns: i64) -> impl Iterator<Item = (usize, i64)> {
        let times = &self.sequence().times.radars;
        let drawn: Vec<_> = times.iter().map(|times| sync::nearest(times, t_ns, i64::MAX)).collect();
        let belongs = move |row: usize| {
            let radar = self.radar_of(row)?;
            let scan = drawn[radar].filter(|scan| *scan == self.rows.scan[row])?;
            Some((row, times[radar][scan]))
        };
        (0..self.rows.scan.len()).filter(|row| self.is_drawn(*row)).filter_map(belongs)
    }

    /// Index of a row's radar in the rig.
    fn radar_of(&self, row: usize) -> Option<usize> {
        let name = &self.rows.radars[self.rows.radar[row]];
        self.sequence().rig.radars.iter().position(|radar| radar.name == *name)
    }

    fn label(&self, row: usize) -> MarkLabel {
        if self.rows.label[row] == 1 { MarkLabel::Plausible } else { MarkLabel::Artifact }
    }

    fn seconds_into(&self, t_ns: i64) -> f64 {
        let first = self.sequence().times.radars.iter().flatten().min();
        first.map_or(0.0, |first| t_ns.abs_diff(*first) as f64 * 1e-9)
    }
}
