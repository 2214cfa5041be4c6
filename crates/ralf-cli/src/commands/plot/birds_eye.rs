//! Labelled scans from above.

use super::Plot;
use anyhow::Result;
use ralf::geometry::{Point, Transform};
use ralf::measurement::is_return;
use ralf::sync;
use ralf_plot::{Extent, Mark, OverviewPicture, RadarMount, ScanPicture, overview_picture, scan_picture};

/// A LiDAR scan farther from the radar scan than this is not drawn with it, ns.
const LIDAR_TOLERANCE_NS: i64 = 60_000_000;
/// Scans of a LiDAR that an overview draws at most, and points of each.
const OVERVIEW_LIDAR: (usize, usize) = (40, 20_000);

impl Plot<'_> {
    fn extent(&self) -> Extent {
        self.arguments.radius.map_or(Extent::Fit, Extent::Radius)
    }

    /// One scan.
    pub(super) fn scan(&self, scan: usize) -> Result<Vec<u8>> {
        let sequence = self.sequence();
        let t_ns = self.time_of(scan)?;
        let marks: Vec<_> = self
            .rows_of_scan(t_ns)
            .map(|(row, scan_ns)| self.mark(row, &sequence.motion.between(t_ns, scan_ns)))
            .collect();
        let radars: Vec<_> = sequence
            .rig
            .radars
            .iter()
            .filter(|radar| self.arguments.radar.as_ref().is_none_or(|wanted| *wanted == radar.name))
            .map(mount)
            .collect();
        Ok(scan_picture(&ScanPicture {
            title: &format!("{}, scan {scan}", sequence.name),
            subtitle: &format!("{}, {:.2} s into the sequence", self.who(), self.seconds_into(t_ns)),
            extent: self.extent(),
            lidar: &self.lidar_at(t_ns)?,
            marks: &marks,
            radars: &radars,
            ..ScanPicture::default()
        })?)
    }

    /// The whole sequence.
    pub(super) fn overview(&self) -> Result<Vec<u8>> {
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

    fn mark(&self, row: usize, to_from_vehicle: &Transform) -> Mark {
        let p = to_from_vehicle * Point::new(self.rows.x[row].into(), self.rows.y[row].into(), 0.0);
        Mark { x: p.x, y: p.y, label: self.label(row) }
    }

    /// The LiDAR scans nearest to a time, in the vehicle frame there.
    fn lidar_at(&self, t_ns: i64) -> Result<Vec<[f64; 2]>> {
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
    fn lidar_over_time(&self) -> Result<Vec<[f64; 2]>> {
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
    ) -> Result<()> {
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
