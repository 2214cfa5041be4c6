//! A reader for a format of one's own: a folder with a table of detections (`radar.csv`) and the vehicle's speed
//! (`speed.csv`).
//!
//!     cargo run -p ralf-data --example add_reader
//!
//! It writes such a folder, opens it, says what it holds, and converts it into RALF's own layout, which every command
//! reads. A reader within the project is the same in a folder of `read/`, with an entry in the table of `read/open.rs`.

#![allow(clippy::print_stdout, reason = "an example shows what it does")]

use ralf::config::Config;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, Elevation, LidarScan, Radar, RadarScan, Reliability, Rig, Sequence,
    Source, SourceError, Timelines,
};
use ralf::space::{EgoMotion, OdometrySample, Transform};
use ralf_data::read::inspection::Inspection;
use ralf_data::{DataError, Recording, SequenceReader, write_sequence};
use std::fs;
use std::path::{Path, PathBuf};

const MS: i64 = 1_000_000;

/// A row of `radar.csv`: the time and the place of a detection.
type Row = (i64, [f32; 3]);

/// What is known before a measurement is asked for, and where the measurements lie.
struct Drive {
    sequence: Sequence,
    file: PathBuf,
}

impl Drive {
    fn open(folder: &Path) -> Result<Self, DataError> {
        let file = folder.join("radar.csv");
        let mut times: Vec<i64> = rows(&file)?.into_iter().map(|(t_ns, _)| t_ns).collect();
        times.dedup();
        let speeds = rows(&folder.join("speed.csv"))?;
        let sample = |(t_ns, [v, ..]): Row| OdometrySample { t_ns, velocity: f64::from(v), yaw_rate: 0.0 };
        let motion = EgoMotion::new(speeds.into_iter().map(sample).collect(), Vec::new())
            .ok_or_else(|| DataError::content(folder, "speed.csv", "at least one row", "none"))?;
        let sequence = Sequence {
            name: "drive".to_owned(),
            title: "a table of detections".to_owned(),
            rig: Rig { radars: vec![radar()], ..Rig::default() },
            times: Timelines { radars: vec![times], ..Timelines::default() },
            motion,
            depth_output: DepthOutput::default(),
        };
        Ok(Self { sequence, file })
    }
}

/// The sensor: how it is mounted, what it measures and how well.
fn radar() -> Radar {
    Radar {
        name: "radar_front".to_owned(),
        fields: ["x", "y", "z"].map(str::to_owned).to_vec(),
        vehicle_from_radar: Transform::translation(3.6, 0.0, 0.5),
        elevation: Elevation::Measured,
        fov_azimuth: 120_f64.to_radians(),
        fov_elevation: 20_f64.to_radians(),
        sigma_range: 0.1,
        sigma_azimuth: 1_f64.to_radians(),
        sigma_elevation: 1_f64.to_radians(),
        reliability: Reliability::default(),
    }
}

/// The rows of a table: a time in ms, then up to three numbers. An error names the file, the line, and what was found.
fn rows(file: &Path) -> Result<Vec<Row>, DataError> {
    let text = fs::read_to_string(file).map_err(DataError::io(file))?;
    let mut rows = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        let bad = || DataError::content(file, format!("line {line}"), "a time in ms and numbers", text);
        let (time, values) = text.split_once(',').ok_or_else(bad)?;
        let mut row = [0.0; 3];
        for (value, word) in row.iter_mut().zip(values.split(',')) {
            *value = word.trim().parse().map_err(|_| bad())?;
        }
        rows.push((time.trim().parse::<i64>().map_err(|_| bad())? * MS, row));
    }
    Ok(rows)
}

/// Measurements, read when they are asked for.
impl Source for Drive {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let t_ns = self.sequence.times.radars[radar][scan];
        let mut columns = vec![Vec::new(); 3];
        for (_, row) in rows(&self.file)?.into_iter().filter(|(time, _)| *time == t_ns) {
            for (column, value) in columns.iter_mut().zip(row) {
                column.push(value);
            }
        }
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], t_ns, columns)?)
    }

    fn lidar_scan(&self, _lidar: usize, _scan: usize) -> Result<LidarScan, SourceError> {
        Err("this recording has no LiDAR".into())
    }

    fn image(&self, _camera: usize, _image: usize) -> Result<CameraImage, SourceError> {
        Err("this recording has no camera".into())
    }

    fn depth(&self, _camera: usize, _image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(None)
    }
}

/// What a run records beside the labels.
impl SequenceReader for Drive {
    fn inputs(&self) -> Vec<PathBuf> {
        vec![self.file.clone(), self.file.with_file_name("speed.csv")]
    }

    fn warnings(&self) -> &[String] {
        &[]
    }

    fn image_file(&self, _camera: usize, _image: usize) -> Option<PathBuf> {
        None
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::temp_dir().join(format!("ralf-add-reader-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    fs::write(
        folder.join("radar.csv"),
        "0,20.0,1.0,0.2\n0,25.0,-3.0,0.4\n100,19.5,1.0,0.2\n200,19.0,1.1,0.2\n",
    )?;
    fs::write(folder.join("speed.csv"), "0,5.0\n100,5.0\n200,5.0\n")?;

    let drive = Drive::open(&folder)?;
    let mut look = Inspection::new(&drive, &Config::default());
    look.try_scans(&drive, 1, &|| {});
    println!(
        "{}: {:.1} s, {:.1} m, {} unreadable scans",
        look.name,
        look.seconds,
        look.path_m,
        look.unreadable.len()
    );
    for sentence in &look.missing {
        println!("  {sentence}");
    }
    write_sequence(&drive, &folder.join("converted"), &|_| {})?;
    let recording = ralf_data::open(&folder.join("converted"), None)?;
    println!("converted: {} scans", recording.sequences[0].sequence().times.radars[0].len());

    // In memory it is a recording as well: what labelling and exports take.
    let sequences: Vec<Box<dyn SequenceReader>> = vec![Box::new(drive)];
    let recording = Recording::new(&folder, "table", sequences);
    println!("{recording:?}");
    fs::remove_dir_all(folder)?;
    Ok(())
}
