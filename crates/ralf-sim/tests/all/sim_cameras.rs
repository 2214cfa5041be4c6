//! Depth of an unknown scale becomes metric on a simulated fisheye rig, and the monitor tells bad images from good
//! ones.
use ralf::config::Config;
use ralf::scene::{CalibratedView, Calibration, Failure, ViewState, calibrate, luminance};
use ralf::sensors::Source;
use ralf::space::Point;
use ralf_sim::{CameraFailure, FailureKind, Scenario, SimulatedSequence, presets};

/// Little of everything, with cameras that fail as listed.
fn sequence(failures: &[(&str, FailureKind)]) -> SimulatedSequence {
    let mut scenario = Scenario::from_toml(&presets::find("tiny").unwrap().sequences[0].text()).unwrap();
    let failure = |(camera, kind): &(&str, FailureKind)| CameraFailure {
        camera: (*camera).to_owned(),
        kind: *kind,
        from_s: 0.0,
        until_s: 60.0,
    };
    scenario.failure = failures.iter().map(failure).collect();
    SimulatedSequence::new("00", &scenario, 11, 6).unwrap()
}

/// The views of an image, calibrated by the LiDAR scan of the same number.
fn views(sequence: &SimulatedSequence, camera: usize, image: usize) -> Vec<CalibratedView> {
    let known = sequence.sequence();
    let (t_image, t_lidar) = (known.times.cameras[camera][image], known.times.lidars[0][image]);
    let vehicle_from_lidar = known.motion.between(t_image, t_lidar) * known.rig.lidars[0].vehicle_from_lidar;
    let points = sequence.lidar_scan(0, image).unwrap().points;
    let points: Vec<Point> = points
        .iter()
        .map(|p| vehicle_from_lidar * Point::new(p[0].into(), p[1].into(), p[2].into()))
        .collect();
    let config = Config::default();
    let calibration = Calibration {
        lidar: Some(&points),
        height: &|p| Some(p.z),
        output: known.depth_output,
        camera: &config.camera,
        ground: &config.ground,
    };
    let sensor = &known.rig.cameras[camera];
    let depth = sequence.depth(camera, image).unwrap().unwrap();
    let luminance = luminance(&sequence.image(camera, image).unwrap());
    calibrate(sensor, &sensor.straight_views(), &depth, luminance, &calibration).unwrap()
}

#[test]
fn relative_depth_becomes_metric_within_five_percent() {
    let sequence = sequence(&[]);
    for camera in 0..4 {
        let sensor = &sequence.sequence().rig.cameras[camera];
        let view = sensor.straight_views()[0];
        let truth = &sequence.true_depth(camera, 1).unwrap()[0];
        let found = &views(&sequence, camera, 1)[0];
        assert_eq!(found.report.state, ViewState::Calibrated, "{:?}", found.report);
        let camera_from_vehicle = sensor.vehicle_from_camera.inverse();
        let error = |point: &ralf::scene::CameraPoint| {
            let seen = view.project(&(camera_from_vehicle * point.position)).unwrap();
            let [u, v] = seen.pixel.map(|value| value.round() as usize);
            let exact = f64::from(truth.values[v * view.width + u]);
            (exact < 40.0).then_some((point.depth - exact).abs() / exact)
        };
        let mut errors: Vec<f64> = found.points.iter().filter_map(error).collect();
        errors.sort_by(f64::total_cmp);
        assert!(errors.len() > 50, "{}: {} points", sensor.name, errors.len());
        let median = errors[errors.len() / 2];
        assert!(median < 0.05, "{}: {median}", sensor.name);
    }
}

#[test]
fn the_monitor_fails_bad_images_and_no_good_one() {
    let failing = [("camera_left", FailureKind::Dark), ("camera_rear", FailureKind::Garbage)];
    let sequence = sequence(&failing);
    for (camera, sensor) in sequence.sequence().rig.cameras.iter().enumerate() {
        for image in 0..2 {
            let report = views(&sequence, camera, image)[0].report;
            let expected = match sensor.name.as_str() {
                "camera_left" => ViewState::Failed(Failure::Dark),
                "camera_rear" => ViewState::Failed(Failure::Residual),
                _ => ViewState::Calibrated,
            };
            assert_eq!(report.state, expected, "{} {image}: {report:?}", sensor.name);
        }
    }
}
