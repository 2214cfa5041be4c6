//! What is left of a frame of which less can be observed.

use ralf::config::Config;
use ralf::evidence;
use ralf::paper::Labeler;
use ralf::scene::{Frame, FrameWindow};
use ralf::sensors::Source;
use ralf_sim::SimulatedSequence;
use ralf_train::learning::View;

/// The middle one of a second and a half.
fn with_frame<R>(look: impl FnOnce(&Frame) -> R) -> R {
    with_frame_of(&Config::default(), look)
}

fn with_frame_of<R>(config: &Config, look: impl FnOnce(&Frame) -> R) -> R {
    let preset = ralf_sim::presets::find("tiny").unwrap();
    let sequence: SimulatedSequence = preset.sequences[0].simulate(1, 30).unwrap();
    let rig = &Source::sequence(&sequence).rig;
    let mut window = FrameWindow::new(&sequence, rig, config).with_evidence();
    look(&window.frame(0, 15).unwrap())
}

/// How far before and after the scan the radars' and the LiDARs' scans around it lie, ns.
fn apart(frame: &Frame) -> [Vec<u64>; 2] {
    let t_ns = frame.scan.t_ns();
    let radars = frame.radar_window.iter().map(|neighbour| neighbour.scan.t_ns());
    let lidars = frame.lidar_window.iter().flat_map(|lidar| lidar.views().map(|view| view.moment.t_ns));
    [radars.map(|other| t_ns.abs_diff(other)).collect(), lidars.map(|other| t_ns.abs_diff(other)).collect()]
}

#[test]
fn half_a_second_holds_what_lies_within_a_quarter_before_and_after() {
    with_frame(|frame| {
        let whole = apart(frame);
        let near = apart(&View::HalfSecond.of(frame));
        for (whole, near) in whole.iter().zip(&near) {
            let expected: Vec<u64> = whole.iter().copied().filter(|ns| *ns <= 250_000_000).collect();
            assert_eq!(near, &expected);
            assert!(!near.is_empty() && near.len() < whole.len(), "{whole:?}");
        }
        let steps = &View::HalfSecond.of(frame).steps;
        assert!(
            !steps.is_empty()
                && steps.iter().all(|step| frame.scan.t_ns().abs_diff(step.t_ns) <= 250_000_000)
        );
        let config = Config::default();
        let [of_all, of_near] =
            [evidence::observe(frame, &config), evidence::observe(&View::HalfSecond.of(frame), &config)];
        for (all, near) in of_all.iter().zip(&of_near) {
            // What lies at this moment is the same, what lies around is another.
            let name = all.feature.name;
            match name {
                "amplitude_rank" | "doppler_residual" => assert!(all == near, "{name}"),
                "persistence_distance" | "lidar_window_in" => assert!(all != near, "{name}"),
                _ => {}
            }
        }
    });
}

#[test]
fn a_single_frame_has_one_moment_and_the_whole_is_as_it_was() {
    with_frame(|frame| {
        let [radars, lidars] = apart(&View::SingleFrame.of(frame));
        assert_eq!((radars.len(), lidars.len()), (0, 1));
        assert_eq!(apart(&View::Whole.of(frame)), apart(frame));
        assert!(View::NoLidar.of(frame).lidar_window.is_none());
    });
}

/// With `lidar.scans` above 1 a frame has further LiDAR scans, which are as little there.
#[test]
fn what_lacks_the_lidar_lacks_all_of_its_scans() {
    let config = Config::from_toml("", &["lidar.scans=9", "lidar.reach_ms=1000"]).unwrap();
    let labeler = Labeler::new(&config).unwrap();
    with_frame_of(&config, |frame| {
        let apart = |view: View| -> Vec<u64> {
            let seen = view.of(frame);
            seen.lidar_neighbours.iter().map(|view| view.moment.t_ns.abs_diff(frame.scan.t_ns())).collect()
        };
        let (all, near) = (apart(View::Whole), apart(View::HalfSecond));
        assert_eq!(near, all.iter().copied().filter(|ns| *ns <= 250_000_000).collect::<Vec<_>>());
        assert!(!near.is_empty() && near.len() < all.len(), "{all:?}");
        assert!(apart(View::SingleFrame).is_empty());
        assert!(labeler.label(frame).iter().any(|label| label.d_lm.is_some()));
        let blind = labeler.label(&View::NoLidar.of(frame));
        assert!(blind.iter().all(|label| label.d_lm.is_none()));
    });
}
