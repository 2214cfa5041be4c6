//! `ralf plot`: labelled scans from above.

use crate::Outcome;
use crate::cli::DatasetArgs;
use crate::progress::say;
use anyhow::{Context, bail, ensure};
use clap::Args;
use ralf::geometry::{Point, Transform};
use ralf::measurement::is_return;
use ralf::source::Sequence;
use ralf::sync;
use ralf_data::SequenceReader;
use ralf_data::output::{LabelledRows, read_labelled_rows};
use ralf_plot::{
    Extent, Mark, MarkLabel, OverviewPicture, RadarMount, ScanPicture, overview_picture, scan_picture,
};
use std::path::PathBuf;

/// A LiDAR scan farther from the radar scan than this is not drawn with it, ns.
const LIDAR_TOLERANCE_NS: i64 = 60_000_000;
/// Scans of a LiDAR that an overview draws at most, and points of each.
const OVERVIEW_LIDAR: (usize, usize) = (40, 20_000);

/// Arguments of `ralf plot`.
#[derive(Debug, Args)]
#[command(after_help = "\
Without --radar all radars are drawn: the first one's scan, and the others' nearest to it in time.

Examples:
  ralf plot recordings/city out --sequence 00 --scan 17 -o scan.png
  ralf plot recordings/city out --sequence 00 --scan 17 --radar radar_front --radius 40 -o front.png
  ralf plot recordings/city out --sequence 00 --all -o overview.png")]
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
    #[arg(long, value_name = "M")]
    radius: Option<f64>,
    /// The picture (PNG)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Draws a picture.
pub(crate) fn run(arguments: &PlotArgs) -> anyhow::Result<Outcome> {
    let recording = arguments.dataset.open()?;
    let [reader] = recording.sequences.as_slice() else {
        let names: Vec<_> =
            recording.sequences.iter().map(|reader| reader.sequence().name.as_str()).collect();
        bail!("expected one sequence, found {}: choose with --sequence ({})", names.len(), names.join(", "));
    };
    let file = arguments.labels.join("sequences").join(&reader.sequence().name).join("plausibility.parquet");
    let plot = Plot { reader: reader.as_ref(), rows: read_labelled_rows(&file)?, arguments };
    let png = match arguments.scan {
        Some(scan) => plot.scan(scan)?,
        None => plot.overview()?,
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

    fn extent(&self) -> Extent {
        self.arguments.radius.map_or(Extent::Fit, Extent::Radius)
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

    fn scan(&self, scan: usize) -> anyhow::Result<Vec<u8>> {
        let (sequence, radar) = (self.sequence(), self.radar()?);
        let times = &sequence.times.radars;
        let name = &sequence.rig.radars[radar].name;
        let count = times[radar].len();
        ensure!(
            scan < count,
            "expected a scan of {name} from 0 to {}, found {scan}",
            count.saturating_sub(1)
        );
        let t_ns = times[radar][scan];
        // Of each radar the scan nearest in time.
        let drawn: Vec<_> = times.iter().map(|times| sync::nearest(times, t_ns, i64::MAX)).collect();
        let belongs = |row: usize| {
            let radar = self.radar_of(row)?;
            let scan = drawn[radar].filter(|scan| *scan == self.rows.scan[row])?;
            Some(sequence.motion.between(t_ns, times[radar][scan]))
        };
        let marks: Vec<_> = (0..self.rows.scan.len())
            .filter(|row| self.is_drawn(*row))
            .filter_map(|row| Some(self.mark(row, &belongs(row)?)))
            .collect();
        let radars: Vec<_> = sequence
            .rig
            .radars
            .iter()
            .filter(|radar| self.arguments.radar.as_ref().is_none_or(|wanted| *wanted == radar.name))
            .map(mount)
            .collect();
        let who = self.arguments.radar.as_deref().unwrap_or("all radars");
        Ok(scan_picture(&ScanPicture {
            title: &format!("{}, scan {scan}", sequence.name),
            subtitle: &format!("{who}, {:.2} s into the sequence", self.seconds_into(t_ns)),
            extent: self.extent(),
            lidar: &self.lidar_at(t_ns)?,
            marks: &marks,
            radars: &radars,
            ..ScanPicture::default()
        })?)
    }

    fn overview(&self) -> anyhow::Result<Vec<u8>> {
        self.radar()?;
        let sequence = self.sequence();
        let times = &sequence.times.radars;
        let marks: Vec<_> = (0..self.rows.scan.len())
            .filter(|row| self.is_drawn(*row))
            .filter_map(|row| {
                let t_ns = *times[self.radar_of(row)?].get(self.rows.scan[row])?;
                Some(self.mark(row, &sequence.motion.odom_from_vehicle(t_ns)))
            })
            .collect();
        let mut moments: Vec<_> = times.iter().flatten().copied().collect();
        moments.sort_unstable();
        let path: Vec<_> = moments
            .iter()
            .map(|t_ns| sequence.motion.odom_from_vehicle(*t_ns).translation.vector)
            .map(|place| [place.x, place.y])
            .collect();
        Ok(overview_picture(&OverviewPicture {
            title: &format!("{}: {}", sequence.name, sequence.title),
            subtitle: &format!("{} scans accumulated", moments.len()),
            extent: self.extent(),
            lidar: &self.lidar_over_time()?,
            marks: &marks,
            path: &path,
            ..OverviewPicture::default()
        })?)
    }

    /// Index of a row's radar in the rig.
    fn radar_of(&self, row: usize) -> Option<usize> {
        let name = &self.rows.radars[self.rows.radar[row]];
        self.sequence().rig.radars.iter().position(|radar| radar.name == *name)
    }

    fn mark(&self, row: usize, to_from_vehicle: &Transform) -> Mark {
        let p = to_from_vehicle * Point::new(self.rows.x[row].into(), self.rows.y[row].into(), 0.0);
        let label = if self.rows.label[row] == 1 { MarkLabel::Plausible } else { MarkLabel::Artifact };
        Mark { x: p.x, y: p.y, label }
    }

    fn seconds_into(&self, t_ns: i64) -> f64 {
        let first = self.sequence().times.radars.iter().flatten().min();
        first.map_or(0.0, |first| t_ns.abs_diff(*first) as f64 * 1e-9)
    }

    /// The LiDAR scans nearest to a time, in the vehicle frame there.
    fn lidar_at(&self, t_ns: i64) -> anyhow::Result<Vec<[f64; 2]>> {
        let mut points = Vec::new();
        for (lidar, times) in self.sequence().times.lidars.iter().enumerate() {
            if let Some(scan) = sync::nearest(times, t_ns, LIDAR_TOLERANCE_NS) {
                let to_from_vehicle = self.sequence().motion.between(t_ns, times[scan]);
                self.add_lidar_scan(&mut points, lidar, scan, &to_from_vehicle, usize::MAX)?;
            }
        }
        Ok(points)
    }

    /// Some scans of each LiDAR, thinned, in the odom frame.
    fn lidar_over_time(&self) -> anyhow::Result<Vec<[f64; 2]>> {
        let mut points = Vec::new();
        let (scans, limit) = OVERVIEW_LIDAR;
        for (lidar, times) in self.sequence().times.lidars.iter().enumerate() {
            for scan in (0..times.len()).step_by(times.len().div_ceil(scans).max(1)) {
                let odom_from_vehicle = self.sequence().motion.odom_from_vehicle(times[scan]);
                self.add_lidar_scan(&mut points, lidar, scan, &odom_from_vehicle, limit)?;
            }
        }
        Ok(points)
    }

    fn add_lidar_scan(
        &self,
        points: &mut Vec<[f64; 2]>,
        lidar: usize,
        scan: usize,
        to_from_vehicle: &Transform,
        limit: usize,
    ) -> anyhow::Result<()> {
        let to_from_lidar = to_from_vehicle * self.sequence().rig.lidars[lidar].vehicle_from_lidar;
        let scan = self.reader.lidar_scan(lidar, scan).map_err(anyhow::Error::from_boxed)?;
        let every = scan.points.len().div_ceil(limit).max(1);
        let returns = scan.points.iter().step_by(every).filter(|point| is_return(point));
        points.extend(returns.map(|point| {
            let p = to_from_lidar * Point::from(point.map(f64::from));
            [p.x, p.y]
        }));
        Ok(())
    }
}

fn mount(radar: &ralf::rig::Radar) -> RadarMount {
    let place = radar.vehicle_from_radar.translation.vector;
    let boresight = radar.vehicle_from_radar.rotation * ralf::geometry::Vector::x();
    RadarMount { x: place.x, y: place.y, azimuth: boresight.y.atan2(boresight.x), fov: radar.fov_azimuth }
}
