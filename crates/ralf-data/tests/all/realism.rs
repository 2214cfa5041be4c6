//! Recordings beside each other.
use ralf::sensors::{CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError};
use ralf::space::Spherical;
use ralf_data::SequenceReader;
use ralf_data::realism::{Compared, Distributions, Quantity, Realism};
use ralf_sim::{SimulatedSequence, presets};

/// What is told by way of which a simulated sequence is another one's.
struct Changed {
    made: SimulatedSequence,
    sequence: Sequence,
    /// Added to every range, m.
    farther: f64,
}

impl Changed {
    fn farther(farther: f64) -> Self {
        let made = presets::find("tiny").unwrap().sequences[0].simulate(3, 12).unwrap();
        Self { sequence: made.sequence().clone(), made, farther }
    }

    /// Radars that tell nothing but places, and in the plane alone.
    fn without_columns() -> Self {
        let mut changed = Self::farther(0.0);
        for radar in &mut changed.sequence.rig.radars {
            radar.fields = ["x", "y"].map(str::to_owned).into();
            radar.elevation = ralf::sensors::Elevation::None;
        }
        changed
    }
}

impl Source for Changed {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let made = self.made.radar_scan(radar, scan)?;
        let sensor = &self.sequence.rig.radars[radar];
        let mut columns = made.columns;
        for (row, found) in made.spherical.iter().enumerate() {
            let moved = Spherical { range: found.range + self.farther, ..*found }.to_cartesian();
            for (column, value) in columns.iter_mut().zip([moved.x, moved.y, moved.z]) {
                column[row] = value as f32;
            }
        }
        columns.truncate(sensor.fields.len());
        Ok(RadarScan::new(sensor, made.t_ns, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.made.lidar_scan(lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.made.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.made.depth(camera, image)
    }
}

impl SequenceReader for Changed {}

fn gathered(changed: &Changed, jobs: usize) -> Distributions {
    Distributions::gather(&[changed], jobs, &|_, _| ())
}

fn of(realism: &Realism, quantity: Quantity) -> &Compared {
    realism.quantities.iter().find(|compared| compared.quantity == quantity).unwrap()
}

#[test]
fn a_recording_is_at_no_distance_from_itself_whatever_the_number_of_jobs() {
    let made = Changed::farther(0.0);
    let (one, three) = (gathered(&made, 1), gathered(&made, 3));
    assert_eq!(one, three);
    assert_eq!((one.radar_scans, one.unreadable.len()), (48, 0));
    let realism = Realism::new(&one, &three);
    assert_eq!(realism.mean_ks, Some(0.0));
    for compared in &realism.quantities {
        assert!(compared.real.is_some() && compared.real == compared.simulated, "{}", compared.name);
        if let Some(distance) = compared.distance {
            assert_eq!((distance.wasserstein, distance.ks), (0.0, 0.0), "{}", compared.name);
        }
    }
    assert!(of(&realism, Quantity::Range).within_real.unwrap().ks > 0.0);
}

#[test]
fn ranges_that_are_two_metres_longer_are_two_metres_away() {
    let (real, moved) = (gathered(&Changed::farther(0.0), 2), gathered(&Changed::farther(2.0), 2));
    let realism = Realism::new(&real, &moved);
    let range = of(&realism, Quantity::Range);
    assert!((range.distance.unwrap().wasserstein - 2.0).abs() < 1e-3, "{range:?}");
    let median =
        |compared: &Compared| [compared.real.unwrap(), compared.simulated.unwrap()].map(|s| s.quantiles[2]);
    let [before, after] = median(range);
    assert!((after - before - 2.0).abs() < 1e-3);
    // What doesn't depend on the range is as it was; what lay on surfaces doesn't any more.
    for same in [Quantity::Detections, Quantity::Amplitude, Quantity::LidarPoints, Quantity::Speed] {
        assert_eq!(of(&realism, same).real, of(&realism, same).simulated, "{same:?}");
    }
    assert!(of(&realism, Quantity::NearestLidar).distance.unwrap().ks > 0.1);
}

#[test]
fn what_a_radar_does_not_measure_is_lacking_and_told() {
    let realism =
        Realism::new(&gathered(&Changed::farther(0.0), 2), &gathered(&Changed::without_columns(), 2));
    let lacking: Vec<Quantity> = realism
        .quantities
        .iter()
        .filter(|compared| compared.simulated.is_none())
        .map(|compared| compared.quantity)
        .collect();
    use Quantity::{Amplitude, DopplerResidual, DopplerSpread, Elevation, Height};
    assert_eq!(lacking, [Elevation, Height, Amplitude, DopplerResidual, DopplerSpread]);
    assert!(lacking.iter().all(|quantity| !quantity.description().needs.is_empty()));
}

/// What is known of the simulated world: where it puts detections, and how exactly it measures.
#[test]
fn the_figures_are_those_that_the_world_was_made_with() {
    let found = gathered(&Changed::farther(0.0), 2);
    let summary = |quantity| ralf_data::realism::Summary::of(&found.values(quantity)).unwrap();
    let [least, .., most] = summary(Quantity::Azimuth).quantiles;
    assert!((-80.0..-60.0).contains(&least) && (60.0..80.0).contains(&most), "{least} {most}");
    // 0.06 m/s, and what the odometry is off.
    let noise = summary(Quantity::DopplerSpread).quantiles[2];
    assert!((0.05..0.12).contains(&noise), "{noise}");
    assert_eq!(summary(Quantity::Amplitude).quantiles[2], 0.0);
    let near = summary(Quantity::NearestLidar).quantiles[1];
    assert!(near < 1.0, "a quarter of the detections lies on surfaces: {near}");
}
