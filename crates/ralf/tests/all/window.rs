//! What a frame holds of the scans around it where evidence is asked for.

use crate::support::{MS, Memory, lidar, radar};
use ralf::config::Config;
use ralf::paper::Labeler;
use ralf::scene::{Frame, FrameWindow, NeighbouringDetections};
use ralf::sensors::{
    Camera, CameraImage, DepthImage, Elevation, Intrinsics, Lidar, LidarScan, RadarScan, Rig, Sequence,
    Source, SourceError,
};
use ralf::space::Transform;

const SCANS: i64 = 60;

/// 10 m/s ahead; a wall's point 30 m ahead of where the vehicle begins, seen by two radars every 50 ms, the second
/// 20 ms later, and by a LiDAR every 100 ms.
fn memory() -> Memory {
    let ahead = |t_ns: i64| 30.0 - 10.0 * (t_ns as f32 * 1e-9);
    let radar_scans = |after: i64| -> Vec<_> {
        let times = (0..SCANS).map(|scan| (scan * 50 + after) * MS);
        times.map(|t_ns| (t_ns, Some(vec![[ahead(t_ns), 0.0, 1.0], [f32::NAN; 3]]))).collect()
    };
    let lidar_scans =
        (0..SCANS / 2).map(|scan| (scan * 100 * MS, vec![[ahead(scan * 100 * MS), 0.0, -1.0]])).collect();
    Memory::new(10.0)
        .radar(radar(Elevation::Measured), radar_scans(0))
        .radar(radar(Elevation::Measured), radar_scans(20))
        .lidar(lidar(), lidar_scans)
}

#[test]
fn all_radars_scans_around_are_gathered_and_moved_into_the_frame() {
    let (memory, config) = (memory(), Config::default());
    let frame =
        FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence().frame(1, 30).unwrap();
    let around = NeighbouringDetections::around(&frame);
    // 0.6 s at 50 ms is 12 scans to each side; the first radar has 12 before and 12 after, and one at -20 ms, which
    // leaves it -620 ms out.
    let expected: Vec<(usize, i64)> = {
        let own = (-12..=12).filter(|j| *j != 0).map(|j| (1, j * 50));
        let other = (-12..=12).map(|j| (0, j * 50 - 20)).filter(|(_, ms)| *ms >= -600);
        let mut all: Vec<_> = own.chain(other).collect();
        all.sort_by_key(|(_, ms)| *ms);
        all
    };
    let found: Vec<(usize, i64)> = around
        .radars
        .iter()
        .zip(&around.seconds)
        .map(|(radar, s)| (*radar, (s * 1e3).round() as i64))
        .collect();
    assert_eq!(found, expected);
    assert_eq!(around.len(), expected.len(), "those without a position are left out");
    for (place, detection) in around.detections.iter().enumerate() {
        assert!((detection.position - frame.scan.detections[0].unwrap().position).norm() < 1e-4);
        assert_eq!((around.scans[place], around.rows[place]), (place as u32, 0));
    }
}

#[test]
fn of_radars_that_detect_very_much_every_so_many_scans_are_taken() {
    let (memory, mut config) = (memory(), Config::default());
    // Of two rows each: the frame's radar has 24 scans around, the other one 24.
    config.evidence.radar_detections = 20;
    let frame =
        FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence().frame(1, 30).unwrap();
    let found: Vec<(usize, i64)> = frame
        .radar_window
        .iter()
        .map(|near| (near.radar, (near.scan.t_ns() - frame.scan.t_ns()) / MS))
        .collect();
    let own = (-12..=12).filter(|j| *j != 0 && j % 3 == 0).map(|j| (1, j * 50));
    let other = (-9..=12).filter(|j| j % 3 == 0).map(|j| (0, j * 50 - 20));
    let mut expected: Vec<(usize, i64)> = own.chain(other).collect();
    expected.sort_by_key(|(_, ms)| *ms);
    assert_eq!(found, expected);
}

#[test]
fn the_lidar_scans_around_are_spread_and_shared() {
    let (memory, config) = (memory(), Config::default());
    let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence();
    // Every fourth LiDAR scan is taken: those at 0.8, 1.2 ... 2.4 s around 1.6 s.
    let frame = window.frame(0, 29).unwrap();
    let around = frame.lidar_window.clone().unwrap();
    let times: Vec<i64> = around.window.views.iter().map(|view| view.moment.t_ns / MS).collect();
    assert_eq!(times, [800, 1200, 1600, 2000, 2400]);
    let own = frame.scan.detections[0].unwrap().position;
    for view in around.views() {
        assert!((view.all_points()[0] - own).norm() < 1e-4, "{:?}", view.all_points());
    }
    let next = window.frame(0, 30).unwrap().lidar_window.unwrap();
    assert!(std::sync::Arc::ptr_eq(&around.window, &next.window));
}

/// At each moment that is asked, whether there is a window.
fn has_window(source: &dyn Source, scans: [usize; 3]) -> [bool; 3] {
    let config = Config::default();
    let mut window = FrameWindow::new(source, &source.sequence().rig, &config).with_evidence();
    scans.map(|scan| window.frame(0, scan).unwrap().lidar_window.is_some())
}

#[test]
fn where_the_first_lidar_falls_silent_the_next_one_has_the_say() {
    let all = memory();
    assert_eq!(has_window(&all, [0, 30, 59]), [true; 3]);
    let mut silent = memory();
    silent.sequence.times.lidars[0].truncate(3);
    assert_eq!(has_window(&silent, [0, 30, 59]), [true, false, false]);
    let scans = all.sequence.times.lidars[0].iter().copied().zip(all.lidar_scans[0].clone()).collect();
    let with_another = silent.lidar(Lidar { name: "other".into(), ..lidar() }, scans);
    assert_eq!(has_window(&with_another, [0, 30, 59]), [true; 3]);
}

#[test]
fn scans_that_come_twice_leave_a_window_everywhere() {
    let mut twice = memory();
    for apart in [0, 1, MS] {
        let times = &memory().sequence.times.lidars[0];
        twice.sequence.times.lidars[0] = times.iter().flat_map(|t_ns| [*t_ns, t_ns + apart]).collect();
        twice.lidar_scans[0] =
            memory().lidar_scans[0].iter().flat_map(|scan| [scan.clone(), scan.clone()]).collect();
        assert_eq!(has_window(&twice, [0, 30, 59]), [true; 3], "{apart} ns apart");
    }
}

/// Of no LiDAR scan anything is known from the twelfth on.
struct Torn(Memory);

impl Source for Torn {
    fn sequence(&self) -> &Sequence {
        self.0.sequence()
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.0.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        if scan < 12 { self.0.lidar_scan(lidar, scan) } else { Err("cut short".into()) }
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.0.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.0.depth(camera, image)
    }
}

#[test]
fn scans_that_cannot_be_read_are_none_and_not_an_empty_world() {
    assert_eq!(has_window(&Torn(memory()), [0, 20, 59]), [true, true, false]);
}

fn camera() -> Camera {
    Camera {
        name: "camera".into(),
        vehicle_from_camera: Transform::identity(),
        width: 200,
        height: 120,
        intrinsics: Intrinsics::Pinhole { focal: [100.0; 2], center: [100.0, 60.0], distortion: [0.0; 5] },
        views: Vec::new(),
    }
}

#[test]
fn moments_are_let_go_once_no_later_frame_asks_for_them() {
    let (mut memory, config) = (memory(), Config::default());
    // Cameras without images leave room for more moments than are needed.
    memory.sequence.rig.cameras = vec![camera(); 4];
    memory.sequence.times.cameras = vec![Vec::new(); 4];
    let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config);
    let mut moment = |scan| std::sync::Arc::downgrade(&window.frame(0, scan).unwrap().lidar.unwrap().moment);
    let (first, same, second) = (moment(10), moment(10), moment(12));
    assert!(first.ptr_eq(&same) && first.upgrade().is_none() && second.upgrade().is_some());
    assert_eq!(moment(10).upgrade().unwrap().t_ns, 500 * MS, "whoever goes back gets it anew");
}

#[test]
fn evidence_changes_nothing_for_the_papers_method() {
    let memory = memory();
    for sources in ["same", "all"] {
        let config = Config::from_toml("", &[&format!("tracking.sources={sources}")]).unwrap();
        let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence();
        for scan in [0, 7, 59] {
            let labels = Labeler::new(&config).unwrap().label(&window.frame(1, scan).unwrap());
            assert_eq!(labels, memory.label(&config, 1, scan));
        }
    }
    let config = Config::default();
    let frame = FrameWindow::new(&memory, &memory.sequence.rig, &config).frame(1, 30).unwrap();
    assert!(frame.lidar_window.is_none() && frame.radar_window.is_empty(), "nobody asked for it");
}

#[test]
fn what_is_not_there_and_sequences_that_contradict_themselves_are_refused() {
    let (config, asked) = (Config::default(), memory());
    let mut window = FrameWindow::new(&asked, &asked.sequence.rig, &config);
    let says = |found: Result<Frame, SourceError>, expected: &str| {
        assert_eq!(found.unwrap_err().to_string(), expected);
    };
    says(window.frame(0, 60), "radar 0 has no measurement 60");
    says(window.frame(2, 0), "radar 2 has no measurement 0");
    assert!(window.image(0, 0).is_none());
    let mut back = memory();
    back.sequence.times.radars[0].swap(3, 4);
    says(
        FrameWindow::new(&back, &back.sequence.rig, &config).frame(0, 0),
        "sequence memory: radar 0, time 4: expected 200000000 ns or later, found 150000000 ns",
    );
    let rig = Rig { lidars: Vec::new(), ..asked.sequence.rig.clone() };
    says(
        FrameWindow::new(&asked, &rig, &config).frame(0, 0),
        "sequence memory: expected a LiDAR timeline per sensor, 0, found 1",
    );
}

/// A source whose timelines tell other times than its scans.
struct Late(Memory, Sequence);

impl Source for Late {
    fn sequence(&self) -> &Sequence {
        &self.1
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.0.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.0.lidar_scan(lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.0.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.0.depth(camera, image)
    }
}

#[test]
fn a_scan_of_another_time_than_its_timelines_is_refused() {
    let (memory, config) = (memory(), Config::default());
    let mut told = memory.sequence.clone();
    told.times.radars[0][10] += 1;
    told.times.lidars[0].iter_mut().for_each(|t_ns| *t_ns += 1);
    let late = Late(memory, told);
    let mut window = FrameWindow::new(&late, &late.1.rig, &config);
    assert_eq!(
        window.frame(0, 10).unwrap_err().to_string(),
        "expected the timeline's time, 500000001 ns, found 500000000 ns"
    );
    let frame = window.frame(1, 10).unwrap();
    assert!(frame.lidar.is_none());
    let reason = &frame.unreadable[0].reason;
    assert!(reason.contains("expected the timeline's time"), "{reason}");
}
