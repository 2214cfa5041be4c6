//! What a camera saw at the time of a scan.

use super::PlotArgs;
use crate::progress::say;
use anyhow::{Context, bail, ensure};
use ralf::config::{Config, nanoseconds};
use ralf::scene::{
    CalibratedImage, CalibratedView, Failure, FrameWindow, ViewReport, ViewState, project_points,
};
use ralf::sensors::{Camera, CameraImage, Sequence, StraightView, UndistortMap};
use ralf::space::{Point, Transform, sync};
use ralf_data::Recording;
use ralf_data::result::{LabelledRun, LabelledSequence};
use ralf_data::views::DepthStore;
use ralf_plot::{CameraPicture, MarkLabel, PixelDepth, ViewPicture, camera_picture};
use ralf_report::{Pictures, drawn_without, mark_label, one_below, one_of};
use std::path::PathBuf;

/// The depth that is asked for, or that the labels were made with, or that labelling left in its folder; of several
/// networks one must be chosen.
pub(super) fn depth_store(
    arguments: &PlotArgs,
    recording: &Recording,
    run: &LabelledRun,
) -> anyhow::Result<Option<DepthStore>> {
    if arguments.camera.is_none() {
        return Ok(None);
    }
    if let Some(folder) = &arguments.depth {
        return Ok(Some(DepthStore::open(folder)?));
    }
    if let [only] = run.depth_stores(&recording.path).as_slice() {
        return Ok(Some(DepthStore::open(only)?));
    }
    let all = arguments.labels.join("depth");
    let mut stores: Vec<PathBuf> = Vec::new();
    if all.is_dir() {
        for entry in std::fs::read_dir(&all).with_context(|| all.display().to_string())? {
            let folder = entry.with_context(|| all.display().to_string())?.path();
            stores.extend(folder.join("depth.toml").is_file().then_some(folder));
        }
    }
    match stores.as_slice() {
        [] => Ok(None),
        [only] => Ok(Some(DepthStore::open(only)?)),
        several => bail!(
            "{}: expected the depth of one network, found {}: choose with --depth",
            all.display(),
            several.len()
        ),
    }
}

/// An image with what was measured around it.
struct Shot<'a> {
    camera: &'a Camera,
    t_ns: i64,
    image: CameraImage,
    /// `None` where there is no depth.
    moment: Option<std::sync::Arc<CalibratedImage>>,
    /// In the vehicle frame at the image's time.
    lidar: Vec<Point>,
    occlusion_window: f64,
}

/// Draws what a camera of a labelled sequence sees.
pub(super) struct Plot<'a> {
    pub(super) pictures: Pictures<'a>,
    pub(super) labelled: &'a LabelledSequence,
    pub(super) arguments: &'a PlotArgs,
}

impl Plot<'_> {
    fn sequence(&self) -> &Sequence {
        self.pictures.reader.sequence()
    }

    /// The views of a camera's image nearest to a scan.
    pub(super) fn camera(&self, scan: usize, name: &str) -> anyhow::Result<Vec<u8>> {
        let config = self.settings();
        let (t_ns, camera) = (self.pictures.time_of(scan)?, self.camera_named(name)?);
        let (times, tolerance) = (&self.sequence().times.cameras[camera], config.sync.camera_tolerance_ms);
        let image = sync::nearest(times, t_ns, nanoseconds(tolerance)).with_context(|| {
            format!("expected an image of {name} within {tolerance} ms of scan {scan}, found none")
        })?;
        let shot = self.shot(camera, image, &config)?;
        let views = shot.camera.straight_views();
        let wanted = self.arguments.view;
        ensure!(
            wanted.is_none_or(|wanted| wanted < views.len()),
            "expected {}, found {}",
            one_below("view", name, views.len()),
            wanted.unwrap_or_default()
        );
        let drawn =
            views.iter().enumerate().filter(|(index, _)| wanted.is_none_or(|wanted| wanted == *index));
        let views = drawn.map(|(index, view)| self.view(&shot, t_ns, (index, view)));
        let offset_ms = (shot.t_ns - t_ns) as f64 * 1e-6;
        Ok(camera_picture(&CameraPicture {
            title: &format!("{}, scan {scan}, {name}", self.sequence().name),
            subtitle: &format!("{}; image {image}, {offset_ms:+.0} ms from the scan", self.pictures.who()),
            views: &views.collect::<anyhow::Result<Vec<_>>>()?,
            ..CameraPicture::default()
        })?)
    }

    /// Those that the labels were made with, except that every pixel which has a depth is calibrated: the ends of the
    /// settings' ranges.
    fn settings(&self) -> Config {
        let mut config = self.labelled.settings.clone();
        config.camera.stride = 1;
        config.camera.max_depth = 1e6;
        config.ground.camera_margin = -1000.0;
        config
    }

    fn camera_named(&self, name: &str) -> anyhow::Result<usize> {
        let cameras = &self.sequence().rig.cameras;
        let names: Vec<_> = cameras.iter().map(|camera| camera.name.as_str()).collect();
        let found = names.iter().position(|known| *known == name);
        found.with_context(|| format!("expected {}, found {name}", one_of("camera", &names)))
    }

    fn shot(&self, camera: usize, image: usize, config: &Config) -> anyhow::Result<Shot<'_>> {
        let sequence = self.sequence();
        let t_ns = sequence.times.cameras[camera][image];
        let mut window = FrameWindow::new(self.pictures.reader, &self.labelled.rig, config);
        let (lidar, unread) = window.readable_lidar_view(t_ns).map_err(anyhow::Error::from_boxed)?;
        unread.iter().for_each(|scan| say(&drawn_without(&sequence.name, scan)));
        Ok(Shot {
            camera: &sequence.rig.cameras[camera],
            t_ns,
            image: self.pictures.reader.image(camera, image).map_err(anyhow::Error::from_boxed)?,
            moment: window.image(camera, image),
            lidar: lidar.map(|lidar| lidar.all_points()).unwrap_or_default(),
            occlusion_window: config.camera.occlusion_window,
        })
    }

    fn view(
        &self,
        shot: &Shot<'_>,
        scan_ns: i64,
        (index, view): (usize, &StraightView),
    ) -> anyhow::Result<ViewPicture> {
        let Camera { name, intrinsics, width, height, .. } = shot.camera;
        intrinsics.check(*width, *height).map_err(|e| anyhow::anyhow!("{name}: expected {e}"))?;
        let straight = UndistortMap::new(intrinsics, *width, *height, view).apply(&shot.image);
        let straight = straight.map_err(|expected| anyhow::anyhow!("{name}: expected {expected}"))?;
        let camera_from_vehicle = shot.camera.vehicle_from_camera.inverse();
        let seen = project_points(&shot.lidar, &camera_from_vehicle, view, shot.occlusion_window);
        let marks = self.marks(scan_ns, shot.t_ns, &camera_from_vehicle, view)?;
        let calibrated = shot.moment.as_ref().and_then(|moment| moment.views.get(index));
        Ok(ViewPicture {
            size: [straight.width as u32, straight.height as u32],
            rgb: straight.rgb,
            depth: calibrated.map(|found| shot.dense_depth(view, found)).unwrap_or_default(),
            verdict: shot.verdict(calibrated),
            lidar: seen.iter().map(|p| PixelDepth { pixel: p.pixel, depth: p.depth }).collect(),
            marks,
        })
    }

    /// The detections near a time that a view sees, with what they are labelled.
    fn marks(
        &self,
        scan_ns: i64,
        image_ns: i64,
        camera_from_vehicle: &Transform,
        view: &StraightView,
    ) -> anyhow::Result<Vec<(PixelDepth, MarkLabel)>> {
        let mut marks = Vec::new();
        for (t_ns, table) in self.pictures.scans_near(scan_ns, &["x", "y", "z", "label"])? {
            let camera_from_scan = camera_from_vehicle * self.sequence().motion.between(image_ns, t_ns);
            let axis = |name| table.get::<f32>(name);
            let (x, y, z, labels) = (axis("x")?, axis("y")?, axis("z")?, table.get::<u8>("label")?);
            for (row, label) in labels.iter().enumerate() {
                let place = Point::from([x[row], y[row], z[row]].map(f64::from));
                if let Some(point) = view.project(&(camera_from_scan * place)) {
                    let mark = PixelDepth { pixel: point.pixel, depth: point.depth };
                    marks.push((mark, mark_label(*label)));
                }
            }
        }
        Ok(marks)
    }
}

impl Shot<'_> {
    /// The depth of each pixel, row by row, NaN where there is none; nothing of a view without any.
    fn dense_depth(&self, view: &StraightView, found: &CalibratedView) -> Vec<f32> {
        if found.points.is_empty() {
            return Vec::new();
        }
        let camera_from_vehicle = self.camera.vehicle_from_camera.inverse();
        let mut depth = vec![f32::NAN; view.width * view.height];
        for point in &found.points {
            if let Some(seen) = view.project(&(camera_from_vehicle * point.position)) {
                let [column, row] = seen.pixel.map(|value| value.round().max(0.0) as usize);
                depth[row * view.width + column] = point.depth as f32;
            }
        }
        depth
    }

    /// What the monitor says of a view.
    fn verdict(&self, found: Option<&CalibratedView>) -> String {
        let problem = self.moment.as_ref().and_then(|moment| moment.problem.as_ref());
        match (found, problem) {
            (_, Some(problem)) => format!("failed: {problem}"),
            (Some(found), None) => verdict(&found.report),
            (None, None) => "no depth is stored of this image".to_owned(),
        }
    }
}

fn verdict(report: &ViewReport) -> String {
    let state = match report.state {
        ViewState::Calibrated => "calibrated",
        ViewState::Failed(failure) => match failure {
            Failure::Unusable => "failed, it can't be used",
            Failure::NoScan => "failed, no LiDAR scan near in time",
            Failure::Dark => "failed, too dark",
            Failure::FewSamples => "failed, too few LiDAR points",
            Failure::Residual => "failed, its residual is too large",
        },
    };
    let residual = report.residual.map(|residual| format!(", residual {:.1} %", 100.0 * residual));
    format!("Depth: {state}; {} LiDAR points{}", report.samples, residual.unwrap_or_default())
}
