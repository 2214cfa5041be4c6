//! Pictures of a labelled sequence from above, with everything that belongs on them gathered: detections of all radars,
//! LiDAR returns, the vehicle's path.

use crate::ReportError;
use crate::choice::{one_below, one_of};
use ralf::sensors::{Radar, Sequence, is_return};
use ralf::space::sync;
use ralf::space::{Point, Transform, Vector, placed};
use ralf_data::result::{Group, Kind, PlausibilityReader, RadarScanKey, Table};
use ralf_data::{DataError, ScanIndex, SequenceReader};
use ralf_plot::{
    Extent, Mark, MarkLabel, Marks, OverviewPicture, PlotError, RadarMount, ScanPicture, ValueScale,
    overview_picture, scan_picture,
};

/// A LiDAR scan farther from the radar scan than this is not drawn with it, ns.
const LIDAR_TOLERANCE_NS: i64 = 60_000_000;
/// Scans of a LiDAR that an overview draws at most, and points of each.
const OVERVIEW_LIDAR: (usize, usize) = (40, 20_000);

/// What a picture of a scan tells of its detections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detections {
    /// Where they are.
    Raw,
    /// Where they are, and which are plausible.
    Labelled,
}

/// Draws one labelled sequence.
pub struct Pictures<'a> {
    /// The sequence.
    pub reader: &'a dyn SequenceReader,
    /// Its labels.
    pub tables: &'a PlausibilityReader,
    /// Only this radar; all of them if `None`.
    pub radar: Option<&'a str>,
    /// Which part of the ground is shown.
    pub extent: Extent,
}

/// The radar that numbers the scans of a sequence where none is asked for: the first that has any.
pub(crate) fn first_with_scans(sequence: &Sequence) -> Option<usize> {
    sequence.times.radars.iter().position(|times| !times.is_empty())
}

impl Pictures<'_> {
    fn sequence(&self) -> &Sequence {
        self.reader.sequence()
    }

    /// Index of the radar asked for, or of the first that has scans.
    fn first_radar(&self) -> Result<usize, ReportError> {
        let radars = &self.sequence().rig.radars;
        let asked = || radars.iter().position(|radar| self.shows(&radar.name));
        let first = if self.radar.is_none() { first_with_scans(self.sequence()) } else { None };
        first.or_else(asked).ok_or_else(|| {
            let names: Vec<_> = radars.iter().map(|radar| radar.name.as_str()).collect();
            let expected = one_of("radar", &names);
            ReportError::Unknown { expected, found: format!("{:?}", self.radar.unwrap_or_default()) }
        })
    }

    /// Time of a scan of the radar asked for, or of the first, ns.
    ///
    /// # Errors
    /// No such radar or scan.
    pub fn time_of(&self, scan: usize) -> Result<i64, ReportError> {
        let radar = self.first_radar()?;
        let times = &self.sequence().times.radars[radar];
        times.get(scan).copied().ok_or_else(|| {
            let name = &self.sequence().rig.radars[radar].name;
            let expected = one_below("scan", name, times.len());
            ReportError::Unknown { expected, found: scan.to_string() }
        })
    }

    /// The radars that are drawn, for people.
    pub fn who(&self) -> &str {
        self.radar.unwrap_or("all radars")
    }

    /// Whether a radar is drawn.
    pub fn shows(&self, radar: &str) -> bool {
        self.radar.is_none_or(|wanted| wanted == radar)
    }

    /// One scan of the radar asked for, or of the first, with the other radars' scans nearest to it in time; PNG.
    ///
    /// # Errors
    /// No such radar or scan, a LiDAR scan that can't be read, or a width outside its range.
    pub fn scan(&self, scan: usize, shown: Detections, width: u32) -> Result<Vec<u8>, ReportError> {
        let marks = self.marks_at(self.time_of(scan)?, shown)?;
        self.picture(scan, &marks, None, width)
    }

    /// One scan as [`Self::scan`] draws it, the detections in the colours of a column of numbers, such as a piece of
    /// evidence; PNG.
    ///
    /// # Errors
    /// As [`Self::scan`], and no such column of numbers.
    pub fn scan_by(&self, scan: usize, column: &str, width: u32) -> Result<Vec<u8>, ReportError> {
        self.refuse_other_columns(column)?;
        let t_ns = self.time_of(scan)?;
        let motion = &self.sequence().motion;
        let (mut marks, mut values) = (Vec::new(), Vec::new());
        for (scan_ns, table) in self.scans_near(t_ns, &["x", "y", "label", column])? {
            let to_from_vehicle = motion.between(t_ns, scan_ns);
            add_marks(&table, &to_from_vehicle, Detections::Raw, &mut |mark| marks.push(*mark))?;
            values.extend(table.get::<f32>(column)?.iter().map(|value| f64::from(*value)));
        }
        let name = name_of(column);
        let scale = ValueScale::fitting(&name, &values);
        for (mark, value) in marks.iter_mut().zip(values) {
            mark.label = scale.mark(Some(value));
        }
        self.picture(scan, &marks, Some(scale), width)
    }

    /// Refuses what is no column of numbers of this run.
    fn refuse_other_columns(&self, column: &str) -> Result<(), ReportError> {
        let columns = self.tables.schema().columns();
        let numbers: Vec<&str> = columns
            .iter()
            .filter(|column| column.kind == Kind::F32)
            .map(|column| column.name.as_ref())
            .collect();
        if numbers.contains(&column) {
            return Ok(());
        }
        let lacking = match columns.iter().any(|column| column.group == Group::Evidence) {
            true => "",
            false => "; `ralf label --evidence` adds pieces of evidence",
        };
        let expected = format!("a column of numbers of this run ({}{lacking})", numbers.join(", "));
        Err(ReportError::Unknown { expected, found: format!("`{column}`") })
    }

    fn picture(
        &self,
        scan: usize,
        marks: &[Mark],
        scale: Option<ValueScale>,
        width: u32,
    ) -> Result<Vec<u8>, ReportError> {
        let sequence = self.sequence();
        let t_ns = self.time_of(scan)?;
        let radars: Vec<_> =
            sequence.rig.radars.iter().filter(|radar| self.shows(&radar.name)).map(mount).collect();
        let who = self.who();
        Ok(scan_picture(&ScanPicture {
            title: &format!("{}, scan {scan}", sequence.name),
            subtitle: &format!("{who}, {:.2} s into the sequence", self.seconds_into(t_ns)),
            width,
            extent: self.extent,
            lidar: &self.lidar_at(t_ns)?,
            marks,
            scale,
            radars: &radars,
            ..ScanPicture::default()
        })?)
    }

    /// All scans, raw beside those labelled plausible; PNG.
    ///
    /// # Errors
    /// No such radar, a LiDAR scan that can't be read, or a width outside its range.
    pub fn overview(&self, half_width: u32) -> Result<Vec<u8>, ReportError> {
        self.first_radar()?;
        let sequence = self.sequence();
        let mut moments = self.moments();
        moments.sort_unstable();
        let place = |t_ns: &i64| sequence.motion.odom_from_vehicle(*t_ns).translation.vector;
        let path: Vec<_> = moments.iter().map(place).map(|place| [place.x, place.y]).collect();
        Ok(overview_picture(&OverviewPicture {
            title: &format!("{}: {}", sequence.name, sequence.title),
            subtitle: &self.overview_of(),
            half_width,
            extent: self.extent,
            lidar: &self.lidar_over_time()?,
            marks: self,
            path: &path,
        })?)
    }

    /// What an overview is of, for people: which radars, and how many scans.
    pub fn overview_of(&self) -> String {
        format!("{}, {} scans accumulated", self.who(), self.moments().len())
    }

    /// When the drawn radars measured, ns.
    fn moments(&self) -> Vec<i64> {
        let Sequence { rig, times, .. } = self.sequence();
        let drawn = rig.radars.iter().zip(&times.radars).filter(|(radar, _)| self.shows(&radar.name));
        drawn.flat_map(|(_, times)| times).copied().collect()
    }

    /// Each drawn radar's scan nearest to a time, in the rig's order: when it was made, ns, and its detections with
    /// these columns.
    ///
    /// # Errors
    /// Labels that can't be read, or lack a column.
    pub fn scans_near(&self, t_ns: i64, columns: &[&str]) -> Result<Vec<(i64, Table)>, ReportError> {
        let schema = self.tables.schema().only(columns)?;
        let mut near = Vec::new();
        for ScanIndex { radar, scan } in self.drawn_at(t_ns) {
            let Sequence { rig, times, .. } = self.sequence();
            let table = self.tables.table_of(&RadarScanKey::new(&rig.radars[radar].name, scan), &schema)?;
            near.extend(table.map(|table| (times.radars[radar][scan], table)));
        }
        Ok(near)
    }

    /// Each drawn radar's scan nearest to a time, in the rig's order.
    pub fn drawn_at(&self, t_ns: i64) -> impl Iterator<Item = ScanIndex> {
        let Sequence { rig, times, .. } = self.sequence();
        let drawn = rig.radars.iter().zip(&times.radars).enumerate();
        let drawn = drawn.filter(|(_, (radar, _))| self.shows(&radar.name));
        drawn.filter_map(move |(radar, (_, times))| {
            Some(ScanIndex { radar, scan: sync::nearest(times, t_ns, i64::MAX)? })
        })
    }

    /// These detections in the vehicle frame at that time.
    fn marks_at(&self, t_ns: i64, shown: Detections) -> Result<Vec<Mark>, ReportError> {
        let motion = &self.sequence().motion;
        let mut marks = Vec::new();
        for (scan_ns, table) in self.scans_near(t_ns, &MARKED)? {
            add_marks(&table, &motion.between(t_ns, scan_ns), shown, &mut |mark| marks.push(*mark))?;
        }
        Ok(marks)
    }

    fn seconds_into(&self, t_ns: i64) -> f64 {
        let first = self.sequence().times.radars.iter().flatten().min();
        first.map_or(0.0, |first| t_ns.abs_diff(*first) as f64 * 1e-9)
    }

    /// The LiDAR scans nearest to a time, in the vehicle frame there.
    fn lidar_at(&self, t_ns: i64) -> Result<Vec<[f64; 2]>, ReportError> {
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
    fn lidar_over_time(&self) -> Result<Vec<[f64; 2]>, ReportError> {
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
    ) -> Result<(), ReportError> {
        let to_from_lidar = to_from_vehicle * self.sequence().rig.lidars[lidar].vehicle_from_lidar;
        let scan = self.reader.lidar_scan(lidar, scan)?;
        let every = scan.points.len().div_ceil(limit).max(1);
        let returns = scan.points.iter().step_by(every).filter(|point| is_return(point));
        points.extend(returns.map(|point| {
            let p = placed(&to_from_lidar, point);
            [p.x, p.y]
        }));
        Ok(())
    }
}

/// A column's name, with the unit where it is a piece of evidence.
fn name_of(column: &str) -> String {
    let feature = ralf::evidence::features().find(|feature| feature.name == column);
    match feature.map(|feature| feature.unit).filter(|unit| *unit != "1") {
        Some(unit) => format!("{column}, {unit}"),
        None => column.to_owned(),
    }
}

fn mount(radar: &Radar) -> RadarMount {
    let place = radar.vehicle_from_radar.translation.vector;
    let boresight = radar.vehicle_from_radar.rotation * Vector::x();
    RadarMount { x: place.x, y: place.y, azimuth: boresight.y.atan2(boresight.x), fov: radar.fov_azimuth }
}

/// The columns that make a mark.
const MARKED: [&str; 3] = ["x", "y", "label"];

/// The marks of a scan's detections in another frame.
fn add_marks(
    table: &Table,
    to_from_vehicle: &Transform,
    shown: Detections,
    see: &mut dyn FnMut(&Mark),
) -> Result<(), DataError> {
    let (x, y, labels) = (table.get::<f32>("x")?, table.get::<f32>("y")?, table.get::<u8>("label")?);
    for ((x, y), label) in x.iter().zip(y).zip(labels) {
        let p = to_from_vehicle * Point::new((*x).into(), (*y).into(), 0.0);
        let label = match shown {
            Detections::Raw => MarkLabel::Unlabelled,
            Detections::Labelled => mark_label(*label),
        };
        see(&Mark { x: p.x, y: p.y, label });
    }
    Ok(())
}

/// What a detection is labelled.
pub fn mark_label(label: u8) -> MarkLabel {
    if label == 1 { MarkLabel::Plausible } else { MarkLabel::Artifact }
}

/// All detections of the drawn radars in the odom frame, one row group in memory at a time.
impl Marks for Pictures<'_> {
    fn each(&self, see: &mut dyn FnMut(&Mark)) -> Result<(), PlotError> {
        let sequence = self.sequence();
        let read = self.tables.each(&MARKED, |key, table| {
            let radar = sequence.rig.radars.iter().position(|radar| *radar.name == *key.radar);
            let times = radar.filter(|_| self.shows(&key.radar)).map(|radar| &sequence.times.radars[radar]);
            let Some(t_ns) = times.and_then(|times| times.get(key.scan)) else { return Ok(()) };
            let odom_from_vehicle = sequence.motion.odom_from_vehicle(*t_ns);
            add_marks(table, &odom_from_vehicle, Detections::Labelled, see)
        });
        read.map_err(|error: DataError| PlotError::Marks(error.to_string()))
    }
}
