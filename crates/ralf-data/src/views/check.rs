//! Which scaling of relative depth fits best? Measured on LiDAR points that had no part in it.

use crate::read::SequenceReader;
use ralf::config::{Config, DepthScaling};
use ralf::scene::{FrameWindow, median};
use ralf::sensors::SourceError;

/// The scalings that are compared.
pub const SCALINGS: [DepthScaling; 3] = [DepthScaling::Local, DepthScaling::Ransac, DepthScaling::Huber];

/// What one camera's views show.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraCheck {
    /// The camera's name.
    pub camera: String,
    /// Views with enough LiDAR points to say something.
    pub views: usize,
    /// LiDAR points in these views that the camera sees.
    pub samples: usize,
    /// Median over the views of their median relative error `|Z - Z_lidar| / Z_lidar`, for each of local, RANSAC,
    /// Huber.
    pub residuals: [Option<f64>; 3],
    /// Images of which nothing can be said, for they or their depth can't be read or used: their numbers, and why.
    pub unusable: Vec<(usize, String)>,
}

/// Calibrates every image that has depth with half of its LiDAR points, by each scaling, and measures the other half.
pub fn check_scalings(reader: &dyn SequenceReader, config: &Config) -> Result<Vec<CameraCheck>, SourceError> {
    let sequence = reader.sequence();
    let mut checks = Vec::with_capacity(sequence.rig.cameras.len());
    for (camera, times) in sequence.times.cameras.iter().enumerate() {
        let mut check = CameraCheck {
            camera: sequence.rig.cameras[camera].name.clone(),
            views: 0,
            samples: 0,
            residuals: [None; 3],
            unusable: Vec::new(),
        };
        for (place, scaling) in SCALINGS.into_iter().enumerate() {
            let mut config = config.clone();
            config.camera.scaling = scaling;
            config.check()?;
            let mut window = FrameWindow::new(reader, &sequence.rig, &config);
            let mut residuals = Vec::new();
            check.samples = 0;
            for image in 0..times.len() {
                let moment = window.image(camera, image);
                // Whatever the scaling, these are the same ones.
                let problem = moment.iter().filter(|_| place == 0).find_map(|moment| moment.problem.clone());
                check.unusable.extend(problem.map(|problem| (image, problem)));
                let views = moment.iter().flat_map(|moment| &moment.views);
                for report in views.map(|view| view.report).filter(|r| r.samples >= config.camera.min_samples)
                {
                    check.samples += report.samples;
                    residuals.extend(report.residual);
                }
            }
            check.views = residuals.len();
            check.residuals[place] = median(residuals);
        }
        checks.push(check);
    }
    Ok(checks)
}
