//! Clocks.

use super::planting::radar_late;
use super::right::{clock_of, near};
use super::{ALL_RADARS, FRONT, Fault, LEFT, MS};
use ralf_check::Remedy;

/// Scans that a recorder dropped.
const LOST: usize = 3;

pub(super) fn faults() -> Vec<Fault> {
    vec![
        fault!("radar clock +200 ms", ["radar_left"], true, |p| radar_late(p, LEFT, 200), |r| {
            clock_of(r).is_some_and(|ms| near(ms, -200.0, 60.0))
        }),
        fault!("radar clock -200 ms", ["radar_front"], true, |p| radar_late(p, FRONT, -200), |r| {
            clock_of(r).is_some_and(|ms| near(ms, 200.0, 60.0))
        }),
        fault!(
            "all radar clocks +200 ms",
            ALL_RADARS,
            true,
            |p| (0..4).for_each(|radar| radar_late(p, radar, 200)),
            |r| { clock_of(r).is_some_and(|ms| near(ms, -200.0, 60.0)) }
        ),
        fault!(
            "LiDAR clock +200 ms",
            ["lidar_top"],
            true,
            |p| {
                p.sequence.times.lidars[0].iter_mut().for_each(|t| *t += 200 * MS);
            },
            |r| clock_of(r).is_some_and(|ms| near(ms, -200.0, 60.0))
        ),
        fault!("LiDAR clock +1 h", ["lidar_top"], true, |p| {
            p.sequence.times.lidars[0].iter_mut().for_each(|t| *t += 3_600_000 * MS);
        }),
        fault!("LiDAR clock -2 s", ["lidar_top"], true, |p| {
            p.sequence.times.lidars[0].iter_mut().for_each(|t| *t -= 2000 * MS);
        }),
        fault!(
            "odometry clock +200 ms",
            ["motion"],
            true,
            |p| p.edit_odometry(|s| s.t_ns += 200 * MS),
            |r| { matches!(r, Remedy::MotionClock(ms) if near(*ms, -200.0, 60.0)) }
        ),
        fault!(
            "LiDAR scans lost whose times stay",
            ["lidar_top"],
            true,
            |p| {
                let all = p.sequence.times.lidars[0].len();
                p.sequence.times.lidars[0].truncate(all - LOST);
                p.read_of_lidar(move |scan| if scan < all / 2 { scan } else { scan + LOST });
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("lost"))
        ),
        fault!("times of arrival", ["radar_left"], true, |p| {
            // Up to 95 ms late, as evenly spread as golden steps are, and never before the one before.
            let late = |scan: usize| ((scan * scan) as f64 * 0.618_033_988_75).fract() * 95.0;
            let mut before = i64::MIN;
            for (scan, t_ns) in p.sequence.times.radars[LEFT].iter_mut().enumerate() {
                *t_ns = (*t_ns + late(scan) as i64 * MS).max(before + MS);
                before = *t_ns;
            }
        }),
        fault!("timestamps in us, taken for ns", ["radar_front"], true, |p| {
            p.sequence.times.radars[FRONT].iter_mut().for_each(|t| *t /= 1000);
        }),
    ]
}
