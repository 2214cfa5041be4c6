//! `ralf plot`: labelled scans from above, and as a camera sees them.

mod camera;

use crate::arguments::{ChangedArgs, DatasetArgs, check_picture, the_only};
use crate::outcome::Outcome;
use crate::progress::say;
use clap::Args;
use ralf_data::result::LabelledRun;
use ralf_data::{Corrections, Recording, SequenceReader};
use ralf_plot::Extent;
use ralf_report::{AsFarAsRead, Detections, Pictures, told_corrections};
use std::path::{Path, PathBuf};

/// Width of the picture of a scan, and of an overview's half, pixels.
const WIDTHS: [u32; 2] = [1600, 1400];

/// Arguments of `ralf plot`.
#[derive(Debug, Args)]
#[command(after_help = "\
Without --radar all radars are drawn: the first one's scan, and the others' nearest to it in time. With --camera the \
picture shows the straight views of the image nearest to the scan, each beside its depth as the LiDAR calibrates it.

Examples:
  ralf plot recordings/city out --sequence 00 --scan 17 -o scan.png
  ralf plot recordings/city out --sequence 00 --scan 17 --radar radar_front --radius 40 -o front.png
  ralf plot recordings/city out --sequence 00 --scan 17 --color-by lidar_window_beyond -o free.png
  ralf plot recordings/city out --sequence 00 --all -o overview.png
  ralf plot recordings/city out --sequence 00 --scan 17 --camera camera_front -o camera.png")]
pub(crate) struct PlotArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// What `ralf label` wrote
    #[arg(value_name = "OUT")]
    labels: PathBuf,
    #[command(flatten)]
    changed: ChangedArgs,
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
    /// Detections in the colours of this column of numbers: a mismatch, the plausibility w, a radar's field, or a piece
    /// of evidence where it was labelled with --evidence
    #[arg(long, value_name = "COLUMN", requires = "scan", conflicts_with_all = ["camera", "all"])]
    color_by: Option<String>,
    /// What this camera sees, beside its depth, with LiDAR and radar in it
    #[arg(long, value_name = "NAME", requires = "scan", conflicts_with = "all")]
    camera: Option<String>,
    /// Only this view of the camera, from 0
    #[arg(long, value_name = "V", requires = "camera")]
    view: Option<usize>,
    /// Take depth images from this folder; if not given, from where the labels were made with them
    #[arg(long, value_name = "FOLDER", requires = "camera")]
    depth: Option<PathBuf>,
    /// The picture (PNG); only another picture is replaced
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Draws a picture.
pub(crate) fn run(arguments: &PlotArgs) -> anyhow::Result<Outcome> {
    check_picture("--output", &arguments.output, &[&arguments.dataset.dataset, &arguments.labels])?;
    let mut recording = arguments.dataset.open_labelled(&arguments.labels, &arguments.changed)?;
    let run = LabelledRun::open(&arguments.labels)?;
    leave_out_unlabelled(&mut recording, &run);
    let recording = match camera::depth_store(arguments, &recording, &run)? {
        Some(store) => store.attach(recording),
        None => recording,
    };
    let reader = the_only(&recording)?;
    let labelled = run.sequence(reader)?;
    say_corrected(&arguments.labels, &reader.sequence().name)?;
    let extent = arguments.radius.map_or(Extent::Fit, Extent::Radius);
    let as_read = AsFarAsRead::new(reader);
    let pictures =
        Pictures { reader: &as_read, tables: &labelled.tables, radar: arguments.radar.as_deref(), extent };
    let missing = pictures.missing(&labelled.record, arguments.scan)?;
    missing.iter().for_each(|scan| say(&format!("not labelled: {scan}")));
    let png = match (arguments.scan, &arguments.camera) {
        (Some(scan), Some(name)) => {
            let pictures = Pictures { reader, ..pictures };
            camera::Plot { pictures, labelled: &labelled, arguments }.camera(scan, name)?
        }
        (Some(scan), None) => match &arguments.color_by {
            Some(column) => pictures.scan_by(scan, column, WIDTHS[0])?,
            None => pictures.scan(scan, Detections::Labelled, WIDTHS[0])?,
        },
        (None, _) => pictures.overview(WIDTHS[1])?,
    };
    as_read.drawn_without().iter().for_each(|line| say(line));
    ralf_data::write_named(&arguments.output, &png)?;
    say(&format!("wrote {}", arguments.output.display()));
    Ok(Outcome::done_if(missing.is_empty()))
}

/// Says where people corrected what is drawn: a picture shows what the program found.
fn say_corrected(out: &Path, sequence: &str) -> anyhow::Result<()> {
    let corrections = Corrections::open(out)?.of_scans(|scan| scan.sequence == sequence);
    if !corrections.is_empty() {
        let told = told_corrections(&corrections, "not drawn");
        say(&format!("{}: {told}", corrections.file().display()));
    }
    Ok(())
}

/// Leaves out the sequences that have no labels, of which there is no picture, unless none has any.
fn leave_out_unlabelled(recording: &mut Recording, run: &LabelledRun) {
    let labelled = &run.record().sequences;
    let is_labelled =
        |reader: &dyn SequenceReader| labelled.iter().any(|found| found.name == reader.sequence().name);
    if recording.sequences.iter().any(|reader| is_labelled(reader.as_ref())) {
        recording.sequences.retain(|reader| is_labelled(reader.as_ref()));
    }
}
