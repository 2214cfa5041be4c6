//! Frames of one sequence, gathered in bounded memory.

mod checked;
mod evidence;
mod forgetting;
mod not_read;
mod segmentation;

use super::camera::{CalibratedImage, Calibration, ImageId, ImageView};
use super::floor::LocalGround;
use super::frame::{Frame, NotRead, SensorKind, Unreadable};
use super::lidar::{LidarSnapshot, LidarView};
use super::lidar_window::LidarWindow;
use super::located::LocatedScan;
use super::neighbouring::{NeighbouringScan, ScanStep};
use crate::config::{Config, GroundModel, LidarConfig, TrackingSources, nanoseconds};
use crate::sensors::{LidarScan, Rig, Source, SourceError, is_return};
use crate::space::{Recent, sync};
use not_read::Noted;
use segmentation::Segmented;
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};

/// Moments of the LiDARs that may be the nearest ones of radar scans that are asked for in turn.
const MOMENTS: usize = 2;

/// Moments of the LiDARs that are held at once: those, and what `lidar.scans` adds to the nearest one.
fn moments_at_once(config: &Config) -> usize {
    config.lidar.scans.saturating_sub(1).saturating_add(MOMENTS)
}

/// Names a measurement: sensor and number.
type Key = (usize, usize);

/// The LiDAR scans nearest to a time.
struct NearLidars {
    /// Those that can be read.
    scans: Vec<Key>,
    view: Option<LidarView>,
    unreadable: Vec<Unreadable>,
}

impl NearLidars {
    /// Scans of which nothing came back: a copy that broke off leaves empty files. They are scans all the same.
    fn without_returns(&self, rig: &Rig) -> Vec<Unreadable> {
        let sweeps = self.view.iter().flat_map(|view| view.moment.sweeps());
        let silent =
            self.scans.iter().zip(sweeps).filter(|(_, sweep)| !sweep.scan.points.iter().any(is_return));
        let named = |&(lidar, index): &Key| Unreadable {
            sensor: rig.lidars[lidar].name.clone(),
            index,
            reason: "expected returns, found none".to_owned(),
        };
        silent.map(|(key, _)| named(key)).collect()
    }
}

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
///     let labels = Labeler::new(&config)?.label(&window.frame(radar, 0)?);
///     Ok(labels.iter().filter(|label| label.plausible).count())
/// }
/// ```
pub struct FrameWindow<'a> {
    source: &'a dyn Source,
    config: &'a Config,
    rig: &'a Rig,
    /// Whether what evidence looks at is gathered, too.
    evidence: bool,
    /// With the reason where one can't be read.
    radar_scans: Recent<Key, Result<Arc<LocatedScan>, String>>,
    /// With the reason where one can't be read.
    lidar_scans: Recent<Key, Result<Arc<LidarScan>, String>>,
    moments: Recent<(i64, Vec<Key>), Arc<LidarSnapshot>>,
    /// By the scan of the leading LiDAR in their middle.
    lidar_windows: Recent<Key, Noted<Arc<LidarWindow>>>,
    images: Recent<Key, Noted<Option<Arc<CalibratedImage>>>>,
    segmented: Recent<Key, Noted<Segmented>>,
    /// What could not be read of the frame in the making.
    not_read: BTreeSet<NotRead>,
    /// Why no frame can be gathered.
    refused: Option<String>,
}

impl<'a> FrameWindow<'a> {
    /// A window over a sequence. `rig` is the sequence's, with the user's overrides in it.
    ///
    /// Settings out of their ranges ([`Config::check`]), a rig of other sensors than the sequence has timelines for,
    /// and timelines that don't ascend are refused by whatever is asked of it.
    pub fn new(source: &'a dyn Source, rig: &'a Rig, config: &'a Config) -> Self {
        let batch = config.tracking.scans.saturating_mul(2).saturating_add(2);
        // A batch can't be longer than the sequence.
        let longest = source.sequence().times.radars.iter().map(Vec::len).max().unwrap_or(0);
        let moments = moments_at_once(config);
        Self {
            source,
            config,
            rig,
            evidence: false,
            radar_scans: Recent::new(batch.min(longest) * rig.radars.len()),
            lidar_scans: Recent::new(moments * rig.lidars.len()),
            // The images around a radar scan may have other LiDAR scans nearest to them.
            moments: Recent::new(moments + rig.cameras.len()),
            lidar_windows: Recent::new(MOMENTS),
            images: Recent::new(2 * rig.cameras.len()),
            segmented: Recent::new(2 * rig.cameras.len()),
            not_read: BTreeSet::new(),
            refused: checked::refusal(source.sequence(), rig, config),
        }
    }

    /// All that belongs to one scan of one radar. A LiDAR scan that can't be read is left out and named in the frame;
    /// neighbouring radar scans are left out of the batch.
    ///
    /// # Errors
    /// A scan that isn't there or can't be read, and what [`Self::new`] names.
    pub fn frame(&mut self, radar: usize, scan: usize) -> Result<Frame<'a>, SourceError> {
        self.usable()?;
        let located = match self.radar_scans.get(&(radar, scan)) {
            Some(Ok(known)) => known,
            _ => Arc::new(self.locate(radar, scan)?),
        };
        self.radar_scans.insert((radar, scan), Ok(located.clone()));
        self.not_read.clear();
        let t_ns = located.t_ns();
        self.forget_what_is_past(t_ns);
        let near = self.near_lidars(t_ns);
        let silent = near.without_returns(self.rig);
        let NearLidars { scans, view: lidar, mut unreadable } = near;
        unreadable.extend(silent);
        let lidar_neighbours = self.lidar_neighbours(scans, t_ns, &mut unreadable);
        let images = if self.config.camera.enabled { self.images(t_ns) } else { Vec::new() };
        let segmented = self.segmented(t_ns, &mut unreadable);
        let mut frame = Frame {
            rig: self.rig,
            radar: &self.rig.radars[radar],
            motion: &self.source.sequence().motion,
            ground: LocalGround::around(lidar.as_ref(), &self.config.ground),
            lidar,
            lidar_neighbours,
            lidar_window: if self.evidence { self.lidar_window(t_ns) } else { None },
            radar_window: if self.evidence { self.radar_window(radar, scan, t_ns) } else { Vec::new() },
            images,
            segmented,
            steps: if self.config.tracking.enabled { self.steps(radar, scan, t_ns) } else { Vec::new() },
            scan: located,
            unreadable,
            not_read: Vec::new(),
            horizontal_index: OnceLock::new(),
        };
        frame.not_read.extend(std::mem::take(&mut self.not_read));
        Ok(frame)
    }

    fn locate(&self, radar: usize, scan: usize) -> Result<LocatedScan, SourceError> {
        let times = &self.source.sequence().times.radars;
        let t_ns = checked::time("radar", times, (radar, scan))?;
        let read = self.source.radar_scan(radar, scan)?;
        checked::same_time(t_ns, read.t_ns)?;
        Ok(LocatedScan::new(&self.rig.radars[radar], read))
    }

    /// A neighbouring scan as seen at a time; `None` where it can't be read.
    fn neighbouring_scan(&mut self, radar: usize, scan: usize, t_ns: i64) -> Option<NeighbouringScan> {
        let known = self.radar_scans.get(&(radar, scan));
        let located = known.unwrap_or_else(|| {
            let read = self.locate(radar, scan).map(Arc::new).map_err(|error| error.to_string());
            self.radar_scans.insert((radar, scan), read.clone());
            read
        });
        let located = located.map_err(|reason| self.note(SensorKind::Radar, (radar, scan), &reason)).ok()?;
        let vehicle_from_scan = self.source.sequence().motion.between(t_ns, located.t_ns());
        Some(NeighbouringScan { radar, scan: located, vehicle_from_scan })
    }

    /// The batch of scans before and after (docs/method.md, section 7).
    fn steps(&mut self, radar: usize, scan: usize, t_ns: i64) -> Vec<ScanStep> {
        let max_gap = nanoseconds(self.config.tracking.max_gap_ms);
        let all_radars = self.config.tracking.sources == TrackingSources::All;
        let times = &self.source.sequence().times.radars;
        let mut steps = Vec::new();
        for j in sync::batch(&times[radar], scan, self.config.tracking.scans, max_gap) {
            let step_time = times[radar][j];
            let Some(own) = self.neighbouring_scan(radar, j, t_ns) else { continue };
            let mut others = Vec::new();
            for (other, times) in times.iter().enumerate() {
                if other == radar || !all_radars {
                    continue;
                }
                let nearest = sync::nearest(times, step_time, max_gap);
                others.extend(nearest.and_then(|nearest| self.neighbouring_scan(other, nearest, t_ns)));
            }
            steps.push(ScanStep { j: j as isize - scan as isize, t_ns: step_time, own, others });
        }
        steps
    }

    /// The LiDAR scans nearest to a time (ns), with their ground; `None` where there is none within the tolerance.
    ///
    /// # Errors
    /// One of them that can't be read, and what [`Self::new`] names.
    pub fn lidar_view(&mut self, t_ns: i64) -> Result<Option<LidarView>, SourceError> {
        let (view, unreadable) = self.readable_lidar_view(t_ns)?;
        match unreadable.into_iter().next() {
            Some(Unreadable { reason, .. }) => Err(reason.into()),
            None => Ok(view),
        }
    }

    fn nearest_lidar_scans(&self, t_ns: i64) -> Vec<Key> {
        let tolerance = nanoseconds(self.config.sync.lidar_tolerance_ms);
        let times = self.source.sequence().times.lidars.iter().enumerate();
        times.filter_map(|(lidar, times)| Some((lidar, sync::nearest(times, t_ns, tolerance)?))).collect()
    }

    /// LiDAR scans that belong together as seen at a time; `None` where there is none, or one can't be read.
    fn view(&mut self, scans: Vec<Key>, t_ns: i64) -> Option<LidarView> {
        let moment_time = self.moment_time(t_ns, &scans);
        let moment = self.moment(moment_time, scans)?;
        let vehicle_from_moment = self.source.sequence().motion.between(t_ns, moment_time);
        Some(LidarView { moment, vehicle_from_moment })
    }

    /// The LiDAR scans nearest to a time but those that can't be read, which are named.
    fn near_lidars(&mut self, t_ns: i64) -> NearLidars {
        let nearest = self.nearest_lidar_scans(t_ns);
        self.readable(nearest, t_ns)
    }

    /// The other scans of `lidar.scans` around the nearest ones, as seen at a time: a moment of all LiDARs for each
    /// scan of the first one, no scan twice. Those that can't be read are left out and named.
    fn lidar_neighbours(
        &mut self,
        nearest: Vec<Key>,
        t_ns: i64,
        unreadable: &mut Vec<Unreadable>,
    ) -> Vec<LidarView> {
        let (mut views, mut taken) = (Vec::new(), nearest);
        let Some(&(lidar, middle)) = taken.first() else { return views };
        let times = &self.source.sequence().times.lidars[lidar];
        let LidarConfig { scans, reach_ms, .. } = self.config.lidar;
        let around = sync::around(times, times[middle], nanoseconds(reach_ms), scans);
        for scan in around.filter(|scan| *scan != middle) {
            let mut together = self.nearest_lidar_scans(times[scan]);
            together.retain(|key| !taken.contains(key));
            let found = self.readable(together, t_ns);
            taken.extend(found.scans);
            views.extend(found.view);
            unreadable.extend(found.unreadable);
        }
        views
    }

    /// Of scans that belong together, as seen at a time, those that can be read; the others are named.
    fn readable(&mut self, mut keys: Vec<Key>, t_ns: i64) -> NearLidars {
        let mut unreadable = Vec::new();
        // What a moment was made of could be read, and is perhaps no longer at hand.
        if self.moments.get(&(self.moment_time(t_ns, &keys), keys.clone())).is_none() {
            keys.retain(|&(lidar, index)| match self.lidar_scan((lidar, index)) {
                Ok(_) => true,
                Err(reason) => {
                    let sensor = self.rig.lidars[lidar].name.clone();
                    unreadable.push(Unreadable { sensor, index, reason });
                    false
                }
            });
        }
        NearLidars { view: self.view(keys.clone(), t_ns), scans: keys, unreadable }
    }

    /// The time of the ground: `flat` is z = 0 of the vehicle frame at the radar scan's time, any other belongs to the
    /// first LiDAR scan.
    fn moment_time(&self, t_ns: i64, keys: &[Key]) -> i64 {
        match keys.first() {
            Some(&(lidar, scan)) if self.config.ground.model != GroundModel::Flat => {
                self.source.sequence().times.lidars[lidar][scan]
            }
            _ => t_ns,
        }
    }

    /// The moment of scans that can be read; `None` of none.
    fn moment(&mut self, t_ns: i64, keys: Vec<Key>) -> Option<Arc<LidarSnapshot>> {
        let name = (t_ns, keys);
        if let Some(known) = self.moments.get(&name) {
            return Some(known);
        }
        let mut scans = Vec::with_capacity(name.1.len());
        for &key in &name.1 {
            let scan = self.lidar_scan(key).ok()?;
            let moment_from_vehicle = self.source.sequence().motion.between(t_ns, scan.t_ns);
            scans.push((&self.rig.lidars[key.0], scan, moment_from_vehicle));
        }
        if scans.is_empty() {
            return None;
        }
        let moment = Arc::new(LidarSnapshot::new(t_ns, scans, &self.config.ground, self.config.seed));
        self.moments.insert(name, moment.clone());
        Some(moment)
    }

    /// The images nearest to a time, calibrated; those without depth are absent.
    fn images(&mut self, t_ns: i64) -> Vec<ImageView> {
        let mut images = Vec::new();
        for (camera, image) in self.nearest_images(t_ns) {
            if let Some(moment) = self.image(camera, image) {
                let vehicle_from_image = self.source.sequence().motion.between(t_ns, moment.id.t_ns);
                images.push(ImageView { moment, vehicle_from_image });
            }
        }
        images
    }

    fn nearest_images(&self, t_ns: i64) -> Vec<Key> {
        let tolerance = nanoseconds(self.config.sync.camera_tolerance_ms);
        let times = self.source.sequence().times.cameras.iter().enumerate();
        times.filter_map(|(camera, times)| Some((camera, sync::nearest(times, t_ns, tolerance)?))).collect()
    }

    /// An image with its views calibrated by the LiDAR scans nearest to it; `None` where there is no depth or no such
    /// image, and of a window that gives no frames. What of it can't be read makes its views fail.
    pub fn image(&mut self, camera: usize, image: usize) -> Option<Arc<CalibratedImage>> {
        let there = checked::time("camera", &self.source.sequence().times.cameras, (camera, image));
        self.usable().and(there).ok()?;
        let known = self.images.get(&(camera, image));
        let found = known.unwrap_or_else(|| {
            let found = self.noting(|window| window.calibrated(camera, image));
            self.images.insert((camera, image), found.clone());
            found
        });
        self.noted(found)
    }

    fn calibrated(&mut self, camera: usize, image: usize) -> Option<Arc<CalibratedImage>> {
        let t_ns = self.source.sequence().times.cameras[camera][image];
        let content = match self.source.depth(camera, image) {
            Ok(None) => return None,
            Ok(Some(depth)) => self.source.image(camera, image).map(|pixels| (pixels, depth)),
            Err(error) => Err(error),
        };
        let lidar = self.near_lidars(t_ns).view;
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
        let content = content.inspect_err(|reason| self.note(SensorKind::Camera, (camera, image), reason));
        let id = ImageId { camera, image, t_ns };
        Some(Arc::new(CalibratedImage::new(&self.rig.cameras[camera], id, content, &calibration)))
    }

    fn read_lidar_scan(&self, (lidar, scan): Key) -> Result<LidarScan, SourceError> {
        let t_ns = checked::time("LiDAR", &self.source.sequence().times.lidars, (lidar, scan))?;
        let read = self.source.lidar_scan(lidar, scan)?;
        checked::same_time(t_ns, read.t_ns)?;
        Ok(read)
    }

    fn lidar_scan(&mut self, key: Key) -> Result<Arc<LidarScan>, String> {
        let known = self.lidar_scans.get(&key);
        let read = known.unwrap_or_else(|| {
            let read = self.read_lidar_scan(key).map(Arc::new).map_err(|error| error.to_string());
            self.lidar_scans.insert(key, read.clone());
            read
        });
        read.inspect_err(|reason| self.note(SensorKind::Lidar, key, reason))
    }
}
