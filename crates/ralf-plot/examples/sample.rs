//! Draws a made-up street: `cargo run -p ralf-plot --example sample -- FOLDER` writes scan.png and overview.png there.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::path::PathBuf;

use ralf_plot::{Mark, MarkLabel, OverviewPicture, RadarMount, ScanPicture, overview_picture, scan_picture};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("expected the folder to write to")?);
    std::fs::write(folder.join("scan.png"), scan()?)?;
    std::fs::write(folder.join("overview.png"), overview()?)?;
    Ok(())
}

/// Numbers in 0..1 that are the same in every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    fn near(&mut self, [x, y]: [f64; 2], spread: f64) -> [f64; 2] {
        [x + self.between(-spread, spread), y + self.between(-spread, spread)]
    }
}

/// Corners of buildings and cars along a street.
const WALLS: [[[f64; 2]; 2]; 8] = [
    [[-30.0, 11.0], [18.0, 11.0]],
    [[18.0, 11.0], [18.0, 30.0]],
    [[30.0, 12.0], [30.0, 34.0]],
    [[30.0, 12.0], [72.0, 12.5]],
    [[-30.0, -10.0], [42.0, -10.5]],
    [[42.0, -10.5], [42.0, -28.0]],
    [[54.0, -11.0], [78.0, -11.0]],
    [[54.0, -11.0], [54.0, -30.0]],
];
const CARS: [[f64; 2]; 6] =
    [[12.0, 5.2], [19.0, 5.3], [33.0, -5.5], [24.0, 1.6], [46.0, -1.8], [-12.0, -5.4]];

fn along(dice: &mut Dice, [from, to]: [[f64; 2]; 2], spread: f64) -> [f64; 2] {
    let part = dice.roll();
    dice.near([from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part], spread)
}

fn around_car(dice: &mut Dice, [x, y]: [f64; 2]) -> [f64; 2] {
    let corners = [[x - 2.2, y - 0.9], [x + 2.2, y - 0.9], [x + 2.2, y + 0.9], [x - 2.2, y + 0.9]];
    let side = (dice.roll() * 4.0) as usize;
    along(dice, [corners[side], corners[(side + 1) % 4]], 0.05)
}

fn street(dice: &mut Dice, count: usize, spread: f64) -> Vec<[f64; 2]> {
    let place = |index: usize, dice: &mut Dice| match index % 5 {
        0 => around_car(dice, CARS[index / 5 % CARS.len()]),
        _ => along(dice, WALLS[index % WALLS.len()], spread),
    };
    (0..count).map(|index| place(index, dice)).collect()
}

fn scan() -> Result<Vec<u8>, ralf_plot::PlotError> {
    let mut dice = Dice(7);
    let mut lidar = street(&mut dice, 26_000, 0.15);
    for ring in 0..9 {
        let radius = 4.2 * 1.24f64.powi(ring);
        let turn = (0..500).map(|step| f64::from(step) * 0.012_566);
        let ground = turn.map(|angle| dice.near([radius * angle.cos(), radius * angle.sin()], 0.06));
        lidar.extend(ground.filter(|[_, y]| (-10.0..10.5).contains(y)));
    }
    let mark = |label: MarkLabel| move |[x, y]: [f64; 2]| Mark { x, y, label };
    let mut marks: Vec<Mark> =
        street(&mut dice, 84, 0.3).into_iter().map(mark(MarkLabel::Plausible)).collect();
    let clutter: Vec<[f64; 2]> =
        (0..206).map(|_| [dice.between(-28.0, 80.0), dice.between(-34.0, 36.0)]).collect();
    marks.extend(clutter.into_iter().map(mark(MarkLabel::Artifact)));
    marks.push(Mark { x: f64::NAN, y: 0.0, label: MarkLabel::Artifact });
    let radar = |x: f64, y: f64, azimuth: f64| RadarMount { x, y, azimuth, fov: FRAC_PI_2 };
    scan_picture(&ScanPicture {
        title: "radar_front, scan 000142",
        subtitle: "t = 14.236 s, labelled with LiDAR, camera and tracking",
        lidar: &lidar,
        marks: &marks,
        radars: &[
            radar(3.6, 0.0, 0.0),
            radar(3.3, 0.8, FRAC_PI_4),
            radar(3.3, -0.8, -FRAC_PI_4),
            radar(-0.8, 0.8, 3.0 * FRAC_PI_4),
            radar(-0.8, -0.8, -3.0 * FRAC_PI_4),
        ],
        ..ScanPicture::default()
    })
}

fn overview() -> Result<Vec<u8>, ralf_plot::PlotError> {
    let mut dice = Dice(11);
    let path: Vec<[f64; 2]> = (0..900)
        .map(|step| {
            let s = f64::from(step) / 900.0;
            [260.0 * s + 20.0 * (9.0 * s).sin(), 300.0 * (s - 0.25).max(0.0).powi(2) - 20.0]
        })
        .collect();
    let (mut lidar, mut marks) = (Vec::new(), Vec::new());
    for pair in path.windows(2) {
        let [[x, y], [next_x, next_y]] = [pair[0], pair[1]];
        let length = (next_x - x).hypot(next_y - y);
        let (ahead, left) = ([(next_x - x) / length, (next_y - y) / length], 11.0);
        let side = |offset: f64| [x - ahead[1] * offset, y + ahead[0] * offset];
        let broken = (x / 35.0).sin() > -0.6;
        for offset in [left, -left + 1.5].into_iter().filter(|_| broken) {
            lidar.extend((0..40).map(|_| dice.near(side(offset * 1.1), 1.6)));
            let solid: Vec<[f64; 2]> = (0..35).map(|_| dice.near(side(offset), 0.9)).collect();
            marks.extend(solid.into_iter().map(|[x, y]| Mark { x, y, label: MarkLabel::Plausible }));
        }
        for _ in 0..85 {
            let [x, y] = dice.near([x, y], 38.0);
            marks.push(Mark { x, y, label: MarkLabel::Artifact });
        }
    }
    overview_picture(&OverviewPicture {
        title: "sequence_003",
        subtitle: "4 radars, 900 scans each, accumulated in the odometry frame",
        lidar: &lidar,
        marks: &marks,
        path: &path,
        ..OverviewPicture::default()
    })
}
