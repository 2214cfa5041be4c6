//! A recording, and what its sensors measured.

use crate::arrays::Column;
use crate::errors::{data, other};
use crate::labelling::{ToldJob, to_json};
use arrow_buffer::Buffer;
use pyo3::prelude::*;
use ralf::sensors::Sequence;
use ralf_data::{DataError, SequenceReader};
use serde::Serialize;
use std::sync::Arc;

/// A recording: its tables are read, its measurements are not until they are asked for.
#[pyclass(frozen, module = "ralf._ralf")]
pub(crate) struct Recording {
    recording: Arc<ralf_data::Recording>,
}

/// A sensor for people.
#[derive(Serialize)]
struct Sensor<'a> {
    name: &'a str,
    /// Of a radar.
    #[serde(skip_serializing_if = "Option::is_none")]
    fields: Option<&'a [String]>,
    /// Of each measurement, ns.
    times_ns: &'a [i64],
}

/// A sequence for people.
#[derive(Serialize)]
struct Told<'a> {
    name: &'a str,
    title: &'a str,
    radars: Vec<Sensor<'a>>,
    lidars: Vec<Sensor<'a>>,
    cameras: Vec<Sensor<'a>>,
    warnings: &'a [String],
}

/// The time of a scan in ns, and its columns by name.
type RadarScan = (i64, Vec<(String, Column)>);
/// The time of an image in ns, its pixels, and the depth of each view where it is known.
type Image = (i64, Column, Option<Vec<Column>>);

#[pymethods]
impl Recording {
    /// Opens the recording of a job.
    #[new]
    fn new(py: Python<'_>, job: ToldJob) -> PyResult<Self> {
        let job = job.resolve()?;
        let recording = py.detach(|| job.open()).map_err(data)?;
        Ok(Self { recording: Arc::new(recording) })
    }

    /// The name of its format.
    #[getter]
    fn format(&self) -> &'static str {
        self.recording.format
    }

    /// The names of its sequences.
    #[getter]
    fn sequences(&self) -> Vec<&str> {
        self.recording.sequences.iter().map(|reader| reader.sequence().name.as_str()).collect()
    }

    /// Which sequences are left out, and what its reader warns of: a sentence each, with the name of its sequence.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let of_sequence = |reader: &dyn SequenceReader| {
            let name = &reader.sequence().name;
            reader.warnings().iter().map(|warning| format!("{name}: {warning}")).collect::<Vec<_>>()
        };
        let left_out = self.recording.left_out().into_iter().map(|sequence| format!("left out: {sequence}"));
        let left_out = left_out.chain(self.recording.told_not_copied());
        let of_sequences = self.recording.sequences.iter().flat_map(|reader| of_sequence(reader.as_ref()));
        left_out.chain(of_sequences).collect()
    }

    /// Sensors, times and warnings of a sequence; JSON.
    fn sequence(&self, name: &str) -> PyResult<String> {
        let reader = self.reader(name)?;
        let Sequence { name, title, rig, times, .. } = reader.sequence();
        let radars = rig.radars.iter().zip(&times.radars);
        to_json(&Told {
            name,
            title,
            radars: radars
                .map(|(radar, times_ns)| Sensor { name: &radar.name, fields: Some(&radar.fields), times_ns })
                .collect(),
            lidars: plain(rig.lidars.iter().map(|lidar| lidar.name.as_str()), &times.lidars),
            cameras: plain(rig.cameras.iter().map(|camera| camera.name.as_str()), &times.cameras),
            warnings: reader.warnings(),
        })
    }

    /// A scan of a radar: its time in ns, and each field as the recording has it.
    fn radar_scan(&self, py: Python<'_>, sequence: &str, radar: &str, scan: usize) -> PyResult<RadarScan> {
        let reader = self.reader(sequence)?;
        let radars = &reader.sequence().rig.radars;
        let index = place(radars.iter().map(|known| known.name.as_str()), radar)?;
        self.refuse_beyond(sequence, radar, "scan", scan, reader.sequence().times.radars[index].len())?;
        let read = py
            .detach(|| reader.radar_scan(index, scan))
            .map_err(|error| data(DataError::Measurement { sensor: radar.to_owned(), index: scan, error }))?;
        let columns = radars[index].fields.iter().zip(read.columns);
        let columns = columns.map(|(name, values)| (name.clone(), decimals(values, 1)));
        Ok((read.t_ns, columns.collect()))
    }

    /// A scan of a LiDAR: its time in ns, points (rows of x, y, z in the LiDAR's frame) and intensities.
    fn lidar_scan(
        &self,
        py: Python<'_>,
        sequence: &str,
        lidar: &str,
        scan: usize,
    ) -> PyResult<(i64, Column, Column)> {
        let reader = self.reader(sequence)?;
        let index = place(reader.sequence().rig.lidars.iter().map(|known| known.name.as_str()), lidar)?;
        self.refuse_beyond(sequence, lidar, "scan", scan, reader.sequence().times.lidars[index].len())?;
        let read = py
            .detach(|| reader.lidar_scan(index, scan))
            .map_err(|error| data(DataError::Measurement { sensor: lidar.to_owned(), index: scan, error }))?;
        Ok((read.t_ns, decimals(read.points.into_flattened(), 3), decimals(read.intensity, 1)))
    }

    /// An image of a camera: its time in ns, its pixels (height x width x 3), and depth (height x width per view).
    fn image(&self, py: Python<'_>, sequence: &str, camera: &str, image: usize) -> PyResult<Image> {
        let reader = self.reader(sequence)?;
        let Sequence { rig, times, .. } = reader.sequence();
        let index = place(rig.cameras.iter().map(|known| known.name.as_str()), camera)?;
        let times = &times.cameras[index];
        self.refuse_beyond(sequence, camera, "image", image, times.len())?;
        let read = || Ok((reader.image(index, image)?, reader.depth(index, image)?));
        let (pixels, depth) = py.detach(read).map_err(|error| {
            data(DataError::Measurement { sensor: camera.to_owned(), index: image, error })
        })?;
        let depth = depth.map(|views| views.into_iter().map(Column::of_depth).collect());
        Ok((times[image], Column::of_image(pixels), depth))
    }
}

impl Recording {
    fn reader(&self, name: &str) -> PyResult<&dyn SequenceReader> {
        let readers = &self.recording.sequences;
        let index = place(readers.iter().map(|reader| reader.sequence().name.as_str()), name)?;
        Ok(readers[index].as_ref())
    }

    /// Refuses the number of a measurement, of so many of a sensor, that isn't there.
    fn refuse_beyond(
        &self,
        sequence: &str,
        sensor: &str,
        what: &str,
        number: usize,
        of: usize,
    ) -> PyResult<()> {
        if number < of {
            return Ok(());
        }
        let place = format!("sequence {sequence}, {sensor}");
        let expected = format!("one of its {of} {what}s, counted from 0");
        Err(data(DataError::content(&self.recording.path, place, expected, number.to_string())))
    }
}

fn plain<'a>(names: impl Iterator<Item = &'a str>, times: &'a [Vec<i64>]) -> Vec<Sensor<'a>> {
    names.zip(times).map(|(name, times_ns)| Sensor { name, fields: None, times_ns }).collect()
}

fn decimals(values: Vec<f32>, width: usize) -> Column {
    let rows = values.len() / width;
    Column::new(Buffer::from_vec(values), "<f4", rows, width)
}

/// The place of a name among those that there are.
fn place<'a>(names: impl Iterator<Item = &'a str>, wanted: &str) -> PyResult<usize> {
    let names: Vec<&str> = names.collect();
    let found = names.iter().position(|name| *name == wanted);
    found.ok_or_else(|| match &names[..] {
        [] => other(format!("expected a recording with such sensors, found none, and {wanted} wanted")),
        names => other(format!("expected one of {}, found {wanted}", names.join(", "))),
    })
}
