//! Evidence from the radars alone, on drives of a few detections, with numbers worked out by hand and by brute force.

mod brute_force;

use crate::support::{MS, Memory, lidar, radar};
use ralf::config::Config;
use ralf::evidence::{self, Column};
use ralf::scene::{Frame, FrameWindow};
use ralf::sensors::{Elevation, Radar};
use ralf::space::{Transform, Vector};

/// x, y, z, range rate and cross-section of each detection of a scan.
type Rows = Vec<[f32; 5]>;

const SPEED: f64 = 10.0;
const NO_PLACE: [f32; 5] = [f32::NAN, 0.0, 0.0, 0.0, 0.0];

fn front() -> Radar {
    let fields = ["x", "y", "z", "doppler", "rcs"].map(str::to_owned).to_vec();
    Radar { name: "front".into(), fields, ..radar(Elevation::Measured) }
}

/// A drive ahead at [`SPEED`]; each radar with its scans and their times, ms.
fn drive(radars: Vec<(Radar, Vec<(i64, Rows)>)>) -> Memory {
    let mut memory = Memory::new(SPEED);
    for (radar, scans) in radars {
        memory = memory.measured(radar, scans.into_iter().map(|(ms, rows)| (ms * MS, rows)).collect());
    }
    memory
}

fn with_frame<R>(memory: &Memory, radar: usize, scan: usize, look: impl FnOnce(&Frame) -> R) -> R {
    let config = Config::default();
    let mut window = FrameWindow::new(memory, &memory.sequence.rig, &config).with_evidence();
    look(&window.frame(radar, scan).unwrap())
}

fn observe(memory: &Memory, scan: usize) -> Vec<Column> {
    with_frame(memory, 0, scan, |frame| evidence::observe(frame, &Config::default()))
}

fn column(columns: &[Column], name: &str) -> Vec<Option<f64>> {
    columns.iter().find(|column| column.feature.name == name).expect("a column of this name").values.clone()
}

#[track_caller]
fn close(found: &[Option<f64>], expected: &[Option<f64>]) {
    let near = |(found, expected): (&Option<f64>, &Option<f64>)| match (found, expected) {
        (Some(found), Some(expected)) => (found - expected).abs() < 1e-4 * expected.abs().max(1.0),
        (found, expected) => found.is_none() && expected.is_none(),
    };
    let same = found.len() == expected.len() && found.iter().zip(expected).all(near);
    assert!(same, "found {found:?}, expected {expected:?}");
}

#[test]
fn amplitude_by_hand() {
    let scan = vec![
        [10.0, 0.0, 0.0, 0.0, 0.0],
        [14.0, 0.0, 0.0, 0.0, 10.0],
        [100.0, 0.0, 0.0, 0.0, 30.0],
        [20.0, 0.0, 0.0, 0.0, f32::NAN],
        NO_PLACE,
    ];
    let found = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    // The last has a cross-section, but no place that a power could be told from.
    let ranks = column(&found, "amplitude_rank");
    close(&ranks, &[Some(0.5 / 3.0), Some(2.0 / 3.0), Some(1.0), None, Some(0.5 / 3.0)]);
    // Powers: -40, 10 - 45.845 = -35.845, 30 - 80 = -50.
    close(&column(&found, "amplitude_power_rank"), &[Some(0.5), Some(1.0), Some(0.0), None, None]);
    // Within 5 m: 0 and 10 dB; alone.
    close(&column(&found, "amplitude_over_ring"), &[Some(-5.0), Some(5.0), Some(0.0), None, None]);
    // The floor is the weakest of three.
    close(&column(&found, "amplitude_over_floor"), &[Some(10.0), Some(14.15488), Some(0.0), None, None]);
    close(&column(&found, "amplitude_over_ring_floor"), &[Some(0.0), Some(4.15488), Some(0.0), None, None]);
}

#[test]
fn the_floor_is_that_of_the_radars_own_scans_around() {
    let rows = |rcs: f32| vec![[10.0, 0.0, 0.0, 0.0, rcs]];
    let other = Radar { name: "other".into(), ..front() };
    let memory = drive(vec![
        (front(), vec![(0, rows(0.0)), (100, rows(-7.0)), (700, rows(-20.0))]),
        (other, vec![(0, rows(-30.0))]),
    ]);
    let found = observe(&memory, 0);
    close(&column(&found, "amplitude_over_floor"), &[Some(7.0)]);
    close(&column(&found, "amplitude_over_ring_floor"), &[Some(7.0)]);
}

#[test]
fn a_radar_that_measures_place_alone_has_geometry_and_no_amplitude_or_doppler() {
    let memory = Memory::new(SPEED).radar(radar(Elevation::None), vec![(0, Some(vec![[3.0, 4.0, 9.0]]))]);
    let found = observe(&memory, 0);
    for Column { feature, values } in &found {
        if ["Amplitude", "Doppler"].contains(&feature.group) {
            assert_eq!(values, &[None], "{}", feature.name);
        }
    }
    close(&column(&found, "geometry_range"), &[Some(5.0)]);
    close(&column(&found, "geometry_azimuth"), &[Some((4.0f64 / 3.0).atan() / 1.25)]);
    close(&column(&found, "geometry_elevation"), &[None]);
    close(&column(&found, "geometry_sigma_across"), &[Some(0.05)]);
    close(&column(&found, "geometry_beside_course"), &[Some(4.0)]);
}

#[test]
fn a_radar_upside_down_sees_the_same() {
    let scan: Rows =
        vec![[10.0, 3.0, 1.5, -9.4, 0.0], [12.0, -4.0, -0.4, -9.5, 5.0], [20.0, 0.5, 3.0, -10.0, 9.0]];
    let turned = scan.iter().map(|&[x, y, z, rate, rcs]| [x, -y, -z, rate, rcs]).collect();
    let mut hanging = front();
    hanging.vehicle_from_radar *= Transform::rotation(Vector::x() * std::f64::consts::PI);
    let upright = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    let found = observe(&drive(vec![(hanging, vec![(0, turned)])]), 0);
    for (found, expected) in found.iter().zip(&upright) {
        close(&found.values, &expected.values);
    }
    assert!(column(&found, "geometry_elevation")[0] > Some(0.0));
}

#[test]
fn doppler_by_hand() {
    // Ahead, what stands still comes nearer at 10 m/s.
    let scan = vec![
        [10.0, 0.0, 0.0, -10.0, 0.0],
        [10.5, 0.0, 0.0, -10.1, 0.0],
        [11.0, 0.0, 0.0, -4.0, 0.0],
        [10.0, 0.0, 9.0, f32::NAN, 0.0],
        [40.0, 0.0, 0.0, -10.0, 0.0],
        NO_PLACE,
    ];
    let found = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    // The rates 0, -0.1, 6, 0, 0 have a spread of 0, for which 0.12 m/s is taken.
    let residuals = [Some(0.0), Some(0.1 / 0.12), Some(50.0), None, Some(0.0), None];
    close(&column(&found, "doppler_residual"), &residuals);
    close(&column(&found, "doppler_agreeing"), &[Some(1.0), Some(1.0), Some(0.0), None, Some(0.0), None]);
    close(&column(&found, "doppler_agreeing_share"), &[Some(0.5), Some(0.5), Some(0.0), None, None, None]);
    close(&column(&found, "doppler_track_residual"), &[None; 6]);
}

/// Scans every 100 ms, made of where things are at a time, s.
fn scans(count: i64, rows: impl Fn(f32) -> Rows) -> Vec<(i64, Rows)> {
    (0..count).map(|scan| (scan * 100, rows(scan as f32 * 0.1))).collect()
}

#[test]
fn what_stands_still_what_moves_and_what_moves_along() {
    // A post ahead on the left; a car ahead that drives at 25 m/s; something on the own bumper.
    let memory = drive(vec![(
        front(),
        scans(13, |t| {
            let post = [40.0 - 10.0 * t, 8.0];
            let towards_post = post[0] / post[0].hypot(post[1]);
            vec![
                [post[0], post[1], 0.0, -10.0 * towards_post, 0.0],
                [20.0 + 15.0 * t, 0.0, 0.0, 15.0, 0.0],
                [3.0, -1.0, 0.0, 0.0, 0.0],
            ]
        }),
    )]);
    let found = observe(&memory, 6);
    close(&column(&found, "persistence_own"), &[Some(1.0), Some(0.0), Some(0.0)]);
    // What lies on the bumper drives as the vehicle does.
    close(&column(&found, "persistence_moving"), &[Some(1.0); 3]);
    close(&column(&found, "persistence_others"), &[None; 3]);
    // What moves along has the range rate of what drives away as fast.
    close(&column(&found, "doppler_track_residual"), &[Some(0.0); 3]);
    close(&column(&found, "persistence_distance")[..1], &[Some(0.0)]);
    // All scans saw the post again, and none the last where it would be if it stood still; all look at the car along
    // one line.
    close(&column(&found, "persistence_aspect"), &[Some(1.0), None, Some(0.0)]);
    // All 12 scans see it; in each of them one detection lies within 5 m, and within 2 sigma of it an ellipse of
    // variances 2 * 0.3^2 + 0.01 along the ray and 2 * (0.01 r)^2 + 0.01 across it.
    let r = 34.0f64.hypot(8.0);
    let area = std::f64::consts::PI * 4.0 * (0.19 * (2.0 * (0.01 * r).powi(2) + 0.01)).sqrt();
    let expected = 12.0 * (1.0 - (-area / (std::f64::consts::PI * 25.0)).exp());
    close(&column(&found, "persistence_excess")[..1], &[Some((12.5 / (expected + 0.5)).ln())]);
    // What moves along is at the same place of the radar's frame in all scans. Where it would be if it stood still, it
    // isn't: 3 sigma of 2 * (0.3^2 + 0.03162^2) + 0.01 are 1.31 m, which the vehicle drives in 0.2 s, so that 10 scans
    // count, with one detection each within 5 m. Variances are 0.19 and 2 * 0.03162^2 + 0.01 = 0.012.
    let area = std::f64::consts::PI * 4.0 * (0.19f64 * 0.012).sqrt();
    let expected = 10.0 * (1.0 - (-area / (std::f64::consts::PI * 25.0)).exp());
    close(&column(&found, "persistence_sensor")[2..], &[Some((10.5 / (expected + 0.5)).ln())]);
}

#[test]
fn scans_together_place_what_stands() {
    // A post that is told 0.4 m to the left, to the right, and where it is, in turn; a car that drives ahead.
    let memory = drive(vec![(
        front(),
        scans(13, |t| {
            let post = [40.0 - 10.0 * t, 0.0];
            let aside = [0.4, 0.0, -0.4][(t * 10.0).round() as usize % 3];
            vec![[post[0], post[1] + aside, 0.0, -10.0, 0.0], [20.0 + 15.0 * t, 5.0, 0.0, 14.5, 0.0]]
        }),
    )]);
    let found = observe(&memory, 6);
    // At 34 m it is told 0.4 m aside, where it is known to 0.34 m; of all 13 scans five tell it so and four each of the
    // other two ways. Nearer ones know it better.
    let [post, car] = column(&found, "persistence_shift")[..] else { panic!("two detections") };
    assert!((post.unwrap() - 0.4 / 0.34f64.hypot(0.1)).abs() < 0.2, "{post:?}");
    assert_eq!(car, Some(0.0), "what moves stays where it was measured");
    let scatter = column(&found, "persistence_scatter");
    // Across the ray 0.4^2 2 / 3 over some 0.34^2 + 0.01, along the other axes nearly nothing.
    let expected = (0.4f64.powi(2) * 2.0 / 3.0 / (0.34f64.powi(2) + 0.01) / 3.0).sqrt();
    assert!((scatter[0].unwrap() - expected).abs() < 0.15, "{scatter:?}, {expected}");
    assert_eq!(scatter[1], None);
}

#[test]
fn what_drives_beside_is_sought_along_the_road() {
    // A car in the next lane, as fast as the vehicle and 2 m/s faster: at 45 degrees and beside the radar. Along the ray
    // they would be 0.5, 0.5 and 0.4 m aside in a tenth of a second, and more.
    let car = |t: f32, ahead: f32, speed: f32| {
        let x = ahead + (speed - 10.0) * t;
        [x, 4.0, 0.0, (speed - 10.0) * x / x.hypot(4.0), 0.0]
    };
    let rows = |t: f32| vec![car(t, 4.0, 10.0), car(t, 2.0, 12.0), car(t, 12.0, 12.0)];
    let found = observe(&drive(vec![(front(), scans(13, rows))]), 6);
    close(&column(&found, "persistence_moving"), &[Some(1.0); 3]);
    close(&column(&found, "doppler_track_residual"), &[Some(0.0); 3]);
    // What crosses the road goes along its ray: one of the two ways is enough. In half a second the other would lead 3 m
    // aside.
    let crossing = |t: f32| {
        let range = 30.0 + 8.0 * t;
        vec![[0.8 * range, 0.6 * range, 0.0, 8.0, 0.0]]
    };
    let mut memory = drive(vec![(front(), scans(13, crossing))]);
    memory.sequence.motion = Memory::new(0.0).sequence.motion;
    close(&column(&observe(&memory, 6), "persistence_moving"), &[Some(1.0)]);
}

#[test]
fn only_scans_that_could_have_seen_it_count() {
    // A second radar looks ahead as far as 20 m, and saw one of two posts once in two scans.
    let post = |t: f32| [20.0 - 10.0 * t, 0.0, 0.0, -10.0, 0.0];
    let far = |t: f32| [60.0 - 10.0 * t, 0.0, 0.0, -10.0, 0.0];
    let other = Radar { name: "other".into(), ..front() };
    let memory = drive(vec![
        (front(), vec![(0, vec![post(0.0), far(0.0)])]),
        (other, vec![(-100, vec![post(-0.1)]), (100, vec![[20.0, 2.0, 0.0, 0.0, 0.0]])]),
    ]);
    let found = observe(&memory, 0);
    close(&column(&found, "persistence_others"), &[Some(0.5), None]);
    close(&column(&found, "persistence_own"), &[None, None]);
    close(&column(&found, "persistence_sensor"), &[None, None]);
}

#[test]
fn a_vehicle_that_stands_tells_nothing_of_what_moves_along() {
    let mut memory = drive(vec![(front(), scans(3, |_| vec![[9.0, 1.0, 0.0, 0.0, 0.0]]))]);
    memory.sequence.motion = Memory::new(0.0).sequence.motion;
    close(&column(&observe(&memory, 1), "persistence_sensor"), &[None]);
    close(&column(&observe(&memory, 1), "persistence_own"), &[Some(1.0)]);
}

#[test]
fn context_by_hand() {
    let degrees =
        |range: f32, degrees: f32| [range * degrees.to_radians().cos(), range * degrees.to_radians().sin()];
    let row = |[x, y]: [f32; 2], rate: f32, rcs: f32| [x, y, 0.0, rate, rcs];
    let scan = vec![
        row([10.0, 0.0], 0.0, 20.0),
        row([20.5, 0.0], 0.0, 5.0),
        row([14.5, 0.0], 0.0, 0.0),
        row(degrees(10.0, 30.0), 0.08, -5.0),
        row(degrees(10.0, 31.0), 9.0, -8.0),
        NO_PLACE,
    ];
    let found = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    let crowded = [0.25, 0.25, 0.25, 0.875, 0.875].map(Some);
    close(&column(&found, "context_density_rank")[..5], &crowded);
    close(&column(&found, "context_density_around"), &[None; 6]);
    // Behind the first lie the second and the third; before the second lies the third, which is weaker.
    close(&column(&found, "context_before")[..5], &[0.0, 1.0, 1.0, 0.0, 0.0].map(Some));
    close(&column(&found, "context_before_distance"), &[None, Some(10.5), Some(4.5), None, None, None]);
    // 20.5 - 2 * 10 and 14.5 - 2 * 10, of a variance of 5 * (0.09 + 0.01).
    let sigma = 0.5f64.sqrt();
    close(
        &column(&found, "context_double_bounce"),
        &[None, Some(0.5 / sigma), Some(5.5 / sigma), None, None, None],
    );
    // Three at 10 m.
    close(&column(&found, "context_beside_rank"), &[Some(1.0), None, None, Some(0.5), Some(0.0), None]);
    close(&column(&found, "context_beside_angle"), &[None, None, None, Some(30.0), Some(1.0), None]);
    // The rates of the first and the fourth agree, those of the others don't; one degree is the same azimuth.
    close(&column(&found, "context_side_lobe"), &[Some(-25.0), None, None, Some(25.0), None, None]);
}

/// Behind the radar one turn ends and the next begins: what lies there has the neighbours that it has elsewhere.
#[test]
fn a_radar_that_sees_all_around_has_no_seam() {
    let around = |turn: f32| {
        let row = |range: f32, degrees: f32, rcs: f32| {
            let (sin, cos) = (turn + degrees).to_radians().sin_cos();
            vec![[range * cos, range * sin, 0.0, 0.0, rcs]]
        };
        let scan = [row(10.0, 0.3, 20.0), row(14.5, -0.3, 0.0), row(10.0, -0.2, -5.0), row(10.0, 30.0, 5.0)]
            .concat();
        let radar = Radar { fov_azimuth: 2.0 * std::f64::consts::PI, ..front() };
        observe(&drive(vec![(radar, vec![(0, scan)])]), 0)
    };
    let (left, behind) = (around(90.0), around(180.0));
    for name in ["context_before", "context_before_distance", "context_beside_angle", "context_side_lobe"] {
        let expected = column(&left, name);
        assert!(expected.iter().any(Option::is_some), "{name}");
        for (found, expected) in column(&behind, name).into_iter().zip(expected) {
            let apart = found.zip(expected).map_or(0.0, |(found, expected)| f64::abs(found - expected));
            assert!(found.is_some() == expected.is_some() && apart < 1e-3, "{name}: {found:?}, {expected:?}");
        }
    }
}

#[test]
fn what_a_wall_mirrors_is_found_on_the_radars_side_of_it() {
    // A wall along the left, 5 m away. A post at (10, 2) and its image at (10, 8), a weaker one that is nobody's
    // image, and one that is stronger than the post.
    let scan = vec![
        [10.0, 2.0, 1.0, 0.0, 10.0],
        [10.0, 8.0, 1.0, 0.0, 0.0],
        [20.0, 8.0, 1.0, 0.0, 0.0],
        [10.2, 8.0, 1.0, 0.0, 20.0],
        NO_PLACE,
    ];
    let wall: Vec<[f32; 3]> =
        (0..4000).map(|k| [(k % 200) as f32 * 0.1, 5.05, (k / 200) as f32 * 0.12 - 1.8]).collect();
    let memory = drive(vec![(front(), vec![(0, scan)])]).lidar(lidar(), vec![(0, wall)]);
    let found = column(&observe(&memory, 0), "context_mirror");
    // Columns are 0.25 m wide: the wall is taken to be 5.125 m away, the image to come from (10, 2.25). That misses by
    // 0.25 m, across rays whose ends are known by 0.1 m each, with 0.1 m of room: 1.44 sigma at most.
    let [none_before, image, nobodys, stronger] = [0, 1, 2, 3].map(|row| found[row]);
    assert!(image.is_some_and(|distance| distance < 1.5), "{image:?}");
    assert_eq!([none_before, nobodys, stronger, found[4]], [None; 4]);
}
