//! Frames of one sequence, gathered in bounded memory.

use super::camera::{Calibration, ImageId, ImageMoment, ImageView};
use super::floor::LocalGround;
use super::frame::Frame;
use super::lidar::{LidarMoment, LidarView};
use super::located::LocatedScan;
use super::neighbouring::{NeighbouringScan, ScanStep};
use crate::config::{Config, GroundModel, TrackingSources, nanoseconds};
use crate::sensors::{LidarScan, Rig, Source, SourceError};
use crate::space::{Recent, sync};
use std::sync::Arc;

/// Names a measurement: sensor and number.
type Key = (usize, usize);

/// Gathers frames of one sequence. It remembers the last measurements, so that frames asked for in time order read each
/// one once, and no more than these, so that its memory doesn't grow with the length of the recording.
///
/// ```
/// # use ralf::sensors::{Rig, SourceError};
/// use ralf::{config::Config, paper::Labeler, scene::FrameWindow, sensors::Source};
///
/// /// How many detections of a radar's first scan are plausible.
/// fn plausible(source: &dyn Source, radar: usize) -> Result<usize, SourceError> {
///     let config = Config::default();
///     let mut window = FrameWindow::new(source, &source.sequence().rig, &config);
///     let labels = Labeler::new(&config).label(&window.frame(radar, 0)?);
///     Ok(labels.iter().filter(|label| label.plausible).count())
/// }
/// ```
pub struct FrameWindow<'a> {
    source: &'a dyn Source,
    config: &'a Config,
    rig: &'a Rig,
    /// Whether the other radars' scans are gathered, too.
    all_radars: bool,
    radar_scans: Recent<Key, Option<Arc<LocatedScan>>>,
    lidar_scans: Recent<Key, Arc<LidarScan>>,
    moments: Recent<(i64, Vec<Key>), Arc<LidarMoment>>,
    images: Recent<Key, Option<Arc<ImageMoment>>>,
}

impl<'a> FrameWindow<'a> {
    /// A window over a sequence. `rig` is the sequence's, with the user's overrides in it.
    pub fn new(source: &'a dyn Source, rig: &'a Rig, config: &'a Config) -> Self {
        let batch = config.tracking.scans.saturating_mul(2).saturating_add(2);
        // A batch can't be longer than the sequence.
        let longest = source.sequence().times.radars.iter().map(Vec::len).max().unwrap_or(0);
        let moments = config.lidar.window_scans.saturating_mul(2).saturating_add(2);
        Self {
            source,
            config,
            rig,
            all_radars: config.tracking.sources == TrackingSources::All,
            radar_scans: Recent::new(batch.min(longest) * rig.radars.len()),
            lidar_scans: Recent::new(moments * rig.lidars.len()),
            // The images around a radar scan may have other LiDAR scans nearest to them.
            moments: Recent::new(moments + rig.cameras.len()),
            images: Recent::new(2 * rig.cameras.len()),
        }
    }

    /// The same window, whose frames carry all radars' neighbouring scans, whatever the settings say.
    pub fn with_all_radars(mut self) -> Self {
        self.all_radars = true;
        self
    }

    /// All that belongs to one scan of one radar. Fails where that scan, or a LiDAR scan that belongs to it, can't be
    /// read; neighbouring scans that can't be read are left out.
    pub fn frame(&mut self, radar: usize, scan: usize) -> Result<Frame<'a>, SourceError> {
        let located = match self.radar_scans.get(&(radar, scan)) {
            Some(Some(known)) => known,
            _ => Arc::new(self.locate(radar, scan)?),
        };
        self.radar_scans.insert((radar, scan), Some(located.clone()));
        let t_ns = located.t_ns();
        let lidar = self.lidar_view(t_ns)?;
        Ok(Frame {
            rig: self.rig,
            radar: &self.rig.radars[radar],
            motion: &self.source.sequence().motion,
            ground: LocalGround::around(lidar.as_ref(), &self.config.ground),
            lidar,
            lidar_window: self.lidar_window(t_ns),
            images: if self.config.camera.enabled { self.images(t_ns)? } else { Vec::new() },
            steps: if self.config.tracking.enabled { self.steps(radar, scan, t_ns) } else { Vec::new() },
            scan: located,
        })
    }

    fn locate(&self, radar: usize, scan: usize) -> Result<LocatedScan, SourceError> {
        Ok(LocatedScan::new(&self.rig.radars[radar], self.source.radar_scan(radar, scan)?))
    }

    /// A neighbouring scan as seen at a time; `None` where it can't be read.
    fn neighbouring_scan(&mut self, radar: usize, scan: usize, t_ns: i64) -> Option<NeighbouringScan> {
        let located = match self.radar_scans.get(&(radar, scan)) {
            Some(known) => known?,
            None => {
                let read = self.locate(radar, scan).ok().map(Arc::new);
                self.radar_scans.insert((radar, scan), read.clone());
                read?
            }
        };
        let vehicle_from_scan = self.source.sequence().motion.between(t_ns, located.t_ns());
        Some(NeighbouringScan { radar, scan: located, vehicle_from_scan })
    }

    /// The batch of scans before and after (docs/method.md, section 7).
    fn steps(&mut self, radar: usize, scan: usize, t_ns: i64) -> Vec<ScanStep> {
        let max_gap = nanoseconds(self.config.tracking.max_gap_ms);
        let times = &self.source.sequence().times.radars;
        let mut steps = Vec::new();
        for j in sync::batch(&times[radar], scan, self.config.tracking.scans, max_gap) {
            let step_time = times[radar][j];
            let Some(own) = self.neighbouring_scan(radar, j, t_ns) else { continue };
            let mut others = Vec::new();
            for other in 0..times.len() {
                if other == radar || !self.all_radars {
                    continue;
                }
                let nearest = sync::nearest(&times[other], step_time, max_gap);
                others.extend(nearest.and_then(|nearest| self.neighbouring_scan(other, nearest, t_ns)));
            }
            steps.push(ScanStep { j: j as isize - scan as isize, t_ns: step_time, own, others });
        }
        steps
    }

    /// The LiDAR scans nearest to a time, with their ground; `None` where there is none within the tolerance.
    pub fn lidar_view(&mut self, t_ns: i64) -> Result<Option<LidarView>, SourceError> {
        let nearest = self.nearest_lidar_scans(t_ns);
        if nearest.is_empty() { Ok(None) } else { self.view(nearest, t_ns).map(Some) }
    }

    /// The LiDAR scans before and after the ones nearest to a time; those that can't be read are left out.
    fn lidar_window(&mut self, t_ns: i64) -> Vec<LidarView> {
        let reach = self.config.lidar.window_scans as isize;
        let times = &self.source.sequence().times.lidars;
        let mut views = Vec::new();
        for step in (-reach..=reach).filter(|step| *step != 0) {
            let mut keys = Vec::new();
            for (lidar, nearest) in self.nearest_lidar_scans(t_ns) {
                let scan = nearest.checked_add_signed(step).filter(|scan| *scan < times[lidar].len());
                keys.extend(scan.map(|scan| (lidar, scan)));
            }
            if !keys.is_empty() {
                views.extend(self.view(keys, t_ns).ok());
            }
        }
        views
    }

    fn nearest_lidar_scans(&self, t_ns: i64) -> Vec<Key> {
        let tolerance = nanoseconds(self.config.sync.lidar_tolerance_ms);
        let times = self.source.sequence().times.lidars.iter().enumerate();
        times.filter_map(|(lidar, times)| Some((lidar, sync::nearest(times, t_ns, tolerance)?))).collect()
    }

    /// LiDAR scans that belong together, at least one, as seen at a time.
    fn view(&mut self, scans: Vec<Key>, t_ns: i64) -> Result<LidarView, SourceError> {
        let (first_lidar, first_scan) = scans[0];
        // `flat` is z = 0 of the vehicle frame at the radar scan's time; any other ground belongs to the LiDAR scan.
        let moment_time = match self.config.ground.model {
            GroundModel::Flat => t_ns,
            _ => self.source.sequence().times.lidars[first_lidar][first_scan],
        };
        let moment = self.moment(moment_time, scans)?;
        let vehicle_from_moment = self.source.sequence().motion.between(t_ns, moment_time);
        Ok(LidarView { moment, vehicle_from_moment })
    }

    fn moment(&mut self, t_ns: i64, keys: Vec<Key>) -> Result<Arc<LidarMoment>, SourceError> {
        let name = (t_ns, keys);
        if let Some(known) = self.moments.get(&name) {
            return Ok(known);
        }
        let mut scans = Vec::with_capacity(name.1.len());
        for &(lidar, scan) in &name.1 {
            let scan = self.lidar_scan(lidar, scan)?;
            let moment_from_vehicle = self.source.sequence().motion.between(t_ns, scan.t_ns);
            scans.push((&self.rig.lidars[lidar], scan, moment_from_vehicle));
        }
        let moment = Arc::new(LidarMoment::new(t_ns, scans, &self.config.ground, self.config.seed));
        self.moments.insert(name, moment.clone());
        Ok(moment)
    }

    /// The images nearest to a time, calibrated; those without depth are absent.
    fn images(&mut self, t_ns: i64) -> Result<Vec<ImageView>, SourceError> {
        let tolerance = nanoseconds(self.config.sync.camera_tolerance_ms);
        let times = &self.source.sequence().times.cameras;
        let mut images = Vec::new();
        for (camera, times) in times.iter().enumerate() {
            let Some(image) = sync::nearest(times, t_ns, tolerance) else { continue };
            if let Some(moment) = self.image(camera, image)? {
                let vehicle_from_image = self.source.sequence().motion.between(t_ns, moment.id.t_ns);
                images.push(ImageView { moment, vehicle_from_image });
            }
        }
        Ok(images)
    }

    /// An image with its views calibrated by the LiDAR scans nearest to it; `None` where there is no depth.
    pub fn image(&mut self, camera: usize, image: usize) -> Result<Option<Arc<ImageMoment>>, SourceError> {
        if let Some(known) = self.images.get(&(camera, image)) {
            return Ok(known);
        }
        let t_ns = self.source.sequence().times.cameras[camera][image];
        let content = match self.source.depth(camera, image) {
            Ok(None) => {
                self.images.insert((camera, image), None);
                return Ok(None);
            }
            Ok(Some(depth)) => self.source.image(camera, image).map(|pixels| (pixels, depth)),
            Err(error) => Err(error),
        };
        let lidar = self.lidar_view(t_ns)?;
        let points = lidar.as_ref().map(LidarView::all_points);
        let ground = LocalGround::around(lidar.as_ref(), &self.config.ground);
        let calibration = Calibration {
            lidar: points.as_deref(),
            height: &|p| ground.as_ref().map(|ground| ground.height(p)),
            output: self.source.sequence().depth_output,
            camera: &self.config.camera,
            ground: &self.config.ground,
        };
        let content = content.map_err(|error| error.to_string());
        let id = ImageId { camera, image, t_ns };
        let moment = Arc::new(ImageMoment::new(&self.rig.cameras[camera], id, content, &calibration));
        self.images.insert((camera, image), Some(moment.clone()));
        Ok(Some(moment))
    }

    fn lidar_scan(&mut self, lidar: usize, scan: usize) -> Result<Arc<LidarScan>, SourceError> {
        if let Some(known) = self.lidar_scans.get(&(lidar, scan)) {
            return Ok(known);
        }
        let read = Arc::new(self.source.lidar_scan(lidar, scan)?);
        self.lidar_scans.insert((lidar, scan), read.clone());
        Ok(read)
    }
}
