//! Pictures of labelled scans.

use crate::errors::{data, other};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use ralf_data::result::LabelledRun;
use ralf_data::{DataError, open_selected};
use ralf_plot::Extent;
use ralf_report::{AsFarAsRead, Detections, Pictures, ReportError};
use std::path::{Path, PathBuf};

/// What is drawn.
struct Wish<'a> {
    scan: Option<usize>,
    radar: Option<&'a str>,
    radius: Option<f64>,
    color_by: Option<&'a str>,
    width: u32,
}

/// A scan from above, or a whole sequence where no scan is named, as PNG, and what it lacks, a sentence each: scans
/// that could not be labelled, and LiDAR scans that can't be read.
#[pyfunction]
#[pyo3(signature = (out, recording, sequence, scan=None, radar=None, radius=None, color_by=None, width=1600))]
#[expect(clippy::too_many_arguments, reason = "Python names them")]
pub(crate) fn plot<'py>(
    py: Python<'py>,
    out: PathBuf,
    recording: PathBuf,
    sequence: String,
    scan: Option<usize>,
    radar: Option<&str>,
    radius: Option<f64>,
    color_by: Option<&str>,
    width: u32,
) -> PyResult<(Bound<'py, PyBytes>, Vec<String>)> {
    let wish = Wish { scan, radar, radius, color_by, width };
    let (png, lacking) = py.detach(|| draw(&out, &recording, sequence, &wish))?;
    Ok((PyBytes::new(py, &png), lacking))
}

fn draw(out: &Path, recording: &Path, sequence: String, wish: &Wish<'_>) -> PyResult<(Vec<u8>, Vec<String>)> {
    let open = || {
        let run = LabelledRun::open(out)?;
        let format = Some(run.record().format.as_str());
        let recording = open_selected(recording, format, &run.settings().topics, &[sequence])?;
        let recording = run.settings().correct(recording)?;
        run.refuse_changes(&recording)?;
        Ok::<_, DataError>((run, recording))
    };
    let (run, recording) = open().map_err(data)?;
    let [reader] = recording.sequences.as_slice() else { return Err(other("expected one sequence")) };
    let labelled = run.sequence(reader.as_ref()).map_err(data)?;
    let Wish { scan, radar, radius, color_by, width } = *wish;
    let extent = radius.map_or(Extent::Fit, Extent::Radius);
    let as_read = AsFarAsRead::new(reader.as_ref());
    let pictures = Pictures { reader: &as_read, tables: &labelled.tables, radar, extent };
    let draw = || match (scan, color_by) {
        (Some(scan), Some(column)) => pictures.scan_by(scan, column, width),
        (Some(scan), None) => pictures.scan(scan, Detections::Labelled, width),
        (None, _) => pictures.overview(width),
    };
    let refused = |error| match error {
        ReportError::Data(error) => data(error),
        error => other(error),
    };
    let missing = pictures.missing(&labelled.record, scan).map_err(refused)?;
    let png = draw().map_err(refused)?;
    let missing = missing.iter().map(|scan| format!("not labelled: {scan}"));
    Ok((png, missing.chain(as_read.drawn_without()).collect()))
}
