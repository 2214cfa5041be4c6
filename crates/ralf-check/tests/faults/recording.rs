//! A simulated recording in which faults are planted.

use ralf::sensors::{CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError};
use ralf::space::{EgoMotion, OdometrySample, PoseSample};
use ralf_sim::{Scenario, SimulatedSequence};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

/// Between poses, ns.
const POSE_NS: i64 = 50_000_000;

/// What is simulated once and read by every check.
pub struct Recording {
    inner: SimulatedSequence,
    radars: Vec<Vec<OnceLock<RadarScan>>>,
    lidars: Vec<OnceLock<LidarScan>>,
    images: Vec<Vec<OnceLock<CameraImage>>>,
}

/// Drives that were asked for, by the drive, its scans and its seed: several tests read the same one.
static DRIVES: Mutex<BTreeMap<(String, usize, u64), Arc<Recording>>> = Mutex::new(BTreeMap::new());

impl Recording {
    /// A drive through the street of this folder.
    pub fn of(drive: &str, scans: usize, seed: u64) -> Arc<Self> {
        let simulated = || {
            let text = format!("{}\n{drive}", include_str!("street.toml"));
            let scenario = Scenario::from_toml(&text).unwrap();
            Self::simulated(SimulatedSequence::new("00", &scenario, seed, scans).unwrap())
        };
        DRIVES.lock().unwrap().entry((drive.into(), scans, seed)).or_insert_with(simulated).clone()
    }

    /// A sequence that is simulated already.
    pub fn simulated(inner: SimulatedSequence) -> Arc<Self> {
        let times = &inner.sequence().times;
        let radars =
            times.radars.iter().map(|times| times.iter().map(|_| OnceLock::new()).collect()).collect();
        let lidars = times.lidars[0].iter().map(|_| OnceLock::new()).collect();
        let images =
            times.cameras.iter().map(|times| times.iter().map(|_| OnceLock::new()).collect()).collect();
        Arc::new(Self { inner, radars, lidars, images })
    }

    /// Which detections of a scan are truly plausible.
    pub fn plausible(&self, radar: usize, scan: usize) -> Vec<bool> {
        let truth = self.inner.truth(radar, scan).unwrap();
        truth.iter().map(|truth| truth.class != 1).collect()
    }
}

/// Changes the columns (x, y, z, doppler, rcs) of a scan of a radar.
type RadarEdit = Box<dyn Fn(usize, usize, &mut Vec<Vec<f32>>) + Send + Sync>;
/// Changes the points of a LiDAR's scan.
type LidarEdit = Box<dyn Fn(&mut LidarScan) + Send + Sync>;

/// Which scan is read in place of one: of a radar, of the LiDAR.
type RadarFiles = Box<dyn Fn(usize, usize) -> usize + Send + Sync>;
type LidarFiles = Box<dyn Fn(usize) -> usize + Send + Sync>;

/// Changes the depth images of an image.
type DepthEdit = Box<dyn Fn(&mut [DepthImage]) + Send + Sync>;

/// A recording with a fault.
pub struct Planted {
    base: Arc<Recording>,
    pub sequence: Sequence,
    radar: Option<RadarEdit>,
    lidar: Option<LidarEdit>,
    depth: Option<DepthEdit>,
    radar_files: RadarFiles,
    lidar_files: LidarFiles,
}

impl Planted {
    pub fn new(base: &Arc<Recording>) -> Self {
        let sequence = base.inner.sequence().clone();
        Self {
            base: base.clone(),
            sequence,
            radar: None,
            lidar: None,
            depth: None,
            radar_files: Box::new(|_, scan| scan),
            lidar_files: Box::new(|scan| scan),
        }
    }

    /// Changes scans of radars: their number, the scan's, its columns.
    pub fn edit_radars(&mut self, edit: impl Fn(usize, usize, &mut Vec<Vec<f32>>) + Send + Sync + 'static) {
        self.radar = Some(Box::new(edit));
    }

    pub fn edit_lidar(&mut self, edit: impl Fn(&mut LidarScan) + Send + Sync + 'static) {
        self.lidar = Some(Box::new(edit));
    }

    /// Reads other scans of radars: their number and the scan's.
    pub fn read_of_radars(&mut self, files: impl Fn(usize, usize) -> usize + Send + Sync + 'static) {
        self.radar_files = Box::new(files);
    }

    pub fn read_of_lidar(&mut self, files: impl Fn(usize) -> usize + Send + Sync + 'static) {
        self.lidar_files = Box::new(files);
    }

    /// Has depth, which a recording lacks otherwise, and changes it.
    pub fn with_depth(&mut self, edit: impl Fn(&mut [DepthImage]) + Send + Sync + 'static) {
        self.depth = Some(Box::new(edit));
    }

    /// Changes every sample of the odometry.
    pub fn edit_odometry(&mut self, edit: impl Fn(&mut OdometrySample)) {
        self.replace_odometry(|samples| samples.iter_mut().for_each(edit));
    }

    /// Changes the odometry as a whole.
    pub fn replace_odometry(&mut self, edit: impl FnOnce(&mut Vec<OdometrySample>)) {
        let mut samples = self.sequence.motion.odometry().to_vec();
        edit(&mut samples);
        self.sequence.motion = EgoMotion::new(samples, self.sequence.motion.poses().to_vec()).unwrap();
    }

    /// Adds true poses, twenty a second.
    pub fn add_poses(&mut self) {
        let times = self.sequence.times.radars.iter().flatten();
        let (first, last) = (times.clone().min().unwrap(), times.max().unwrap());
        let poses = (first - POSE_NS..=last + POSE_NS).step_by(POSE_NS as usize);
        let true_pose = |t_ns: i64| PoseSample { t_ns, odom_from_vehicle: self.base.inner.true_pose(t_ns) };
        let poses = poses.map(true_pose).collect();
        self.sequence.motion = EgoMotion::new(self.sequence.motion.odometry().to_vec(), poses).unwrap();
    }

    /// Changes the poses as a whole.
    pub fn replace_poses(&mut self, edit: impl FnOnce(&mut Vec<PoseSample>)) {
        let mut poses = self.sequence.motion.poses().to_vec();
        edit(&mut poses);
        self.sequence.motion = EgoMotion::new(self.sequence.motion.odometry().to_vec(), poses).unwrap();
    }
}

impl Source for Planted {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let read = (self.radar_files)(radar, scan);
        let base =
            self.base.radars[radar][read].get_or_init(|| self.base.inner.radar_scan(radar, read).unwrap());
        let mut columns = base.columns.clone();
        if let Some(edit) = &self.radar {
            edit(radar, scan, &mut columns);
        }
        let t_ns = self.sequence.times.radars[radar][scan];
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], t_ns, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let read = (self.lidar_files)(scan);
        let base = self.base.lidars[read].get_or_init(|| self.base.inner.lidar_scan(lidar, read).unwrap());
        let mut found = LidarScan { t_ns: self.sequence.times.lidars[lidar][scan], ..base.clone() };
        if let Some(edit) = &self.lidar {
            edit(&mut found);
        }
        Ok(found)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let rendered = || self.base.inner.image(camera, image).unwrap();
        Ok(self.base.images[camera][image].get_or_init(rendered).clone())
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        let Some(edit) = &self.depth else { return Ok(None) };
        let mut found = self.base.inner.depth(camera, image)?;
        found.iter_mut().for_each(|views| edit(views));
        Ok(found)
    }
}
