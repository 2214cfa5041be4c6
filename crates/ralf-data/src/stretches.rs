//! Cutting sequences into stretches of time, of which each is one worker's.
//!
//! A stretch begins with a window to be filled: some ten scans of each radar, the LiDAR scan and the images around. So
//! they are as long as workers that end at nearly the same time allow, and begin where measurements change anyway.

use ralf::config::{Config, nanoseconds};
use ralf::sensors::Timelines;
use ralf::space::sync;
use std::ops::Range;

/// How many scans that follow each other in time are worked on with one window where there are several workers: the
/// least of the last stretches, and the most.
const STRETCH: [usize; 2] = [8, 256];
/// The same where evidence is asked for: each window then begins with seconds of LiDAR scans.
const LONG_STRETCH: [usize; 2] = [64, 512];

/// Scans of a sequence that one worker works on with one window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Stretch {
    /// The sequence's number.
    pub(crate) sequence: usize,
    /// Which of its scans, in the order of time; none of a sequence that has none.
    pub(crate) scans: Range<usize>,
}

/// Of radar scans at these times, ns, which ascend: how many LiDAR scans and images each shares with the one before it.
/// Where it shares some, both sides of a cut need them.
pub(crate) fn shared(times: &Timelines, config: &Config, scans: impl IntoIterator<Item = i64>) -> Vec<usize> {
    let tolerances = [config.sync.lidar_tolerance_ms, config.sync.camera_tolerance_ms].map(nanoseconds);
    let sensors: Vec<(&Vec<i64>, i64)> = [&times.lidars, &times.cameras]
        .into_iter()
        .zip(tolerances)
        .flat_map(|(sensors, tolerance)| sensors.iter().map(move |times| (times, tolerance)))
        .collect();
    let mut before = vec![None; sensors.len()];
    let shared = |t_ns: i64| {
        let mut same = 0;
        for ((sensor, tolerance), before) in sensors.iter().zip(&mut before) {
            let nearest = sync::nearest(sensor, t_ns, *tolerance);
            same += usize::from(nearest.is_some() && nearest == *before);
            *before = nearest;
        }
        same
    };
    scans.into_iter().map(shared).collect()
}

/// Cuts sequences into stretches, each sequence into one at least; of each scan is told what it shares with the one
/// before it. Stretches get shorter as less is left, so that no worker waits long for the last one. One worker takes
/// each sequence as it is.
pub(crate) fn stretches(sequences: &[Vec<usize>], evidence: bool, jobs: usize) -> Vec<Stretch> {
    let [least, most] = if evidence { LONG_STRETCH } else { STRETCH };
    let mut left: usize = sequences.iter().map(Vec::len).sum();
    let mut stretches = Vec::new();
    for (sequence, shared) in sequences.iter().enumerate() {
        let mut begin = 0;
        loop {
            let rest = shared.len() - begin;
            let wanted = if jobs > 1 { left.div_ceil(2 * jobs).clamp(least, most) } else { rest };
            // What is left of it is cut evenly: a window for two scans would cost more than they do.
            let length = rest.div_ceil(rest.div_ceil(wanted.max(1)).max(1));
            let end = if length < rest { begin + cut(&shared[begin..], length) } else { shared.len() };
            stretches.push(Stretch { sequence, scans: begin..end });
            left -= end - begin;
            begin = end;
            if begin == shared.len() {
                break;
            }
        }
    }
    stretches
}

/// Where to cut, near to a wanted length, so that least is shared across.
fn cut(shared: &[usize], wanted: usize) -> usize {
    let around = wanted - wanted / 4..=(wanted + wanted / 4).min(shared.len() - 1);
    around.min_by_key(|place| (shared[*place], place.abs_diff(wanted))).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(stretches: &[Stretch]) -> Vec<usize> {
        stretches.iter().map(|stretch| stretch.scans.len()).collect()
    }

    #[test]
    fn stretches_hold_every_scan_once_and_are_short_at_the_end() {
        for (counts, evidence, jobs) in [
            (vec![0], false, 2),
            (vec![1, 0, 200, 40], false, 1),
            (vec![40; 30], false, 2),
            (vec![20_000, 3], true, 7),
            (vec![110], false, 2),
            (vec![], false, 3),
        ] {
            let [least, most] = if evidence { LONG_STRETCH } else { STRETCH };
            // Images change with every seventh scan.
            let shared: Vec<Vec<usize>> = counts
                .iter()
                .map(|count| (0..*count).map(|scan: usize| usize::from(!scan.is_multiple_of(7))).collect())
                .collect();
            let stretches = stretches(&shared, evidence, jobs);
            for (sequence, count) in counts.iter().enumerate() {
                let own: Vec<_> = stretches.iter().filter(|stretch| stretch.sequence == sequence).collect();
                let scans: Vec<usize> = own.iter().flat_map(|stretch| stretch.scans.clone()).collect();
                assert!(!own.is_empty() && scans.into_iter().eq(0..*count));
                let shortest = own.iter().map(|stretch| stretch.scans.len()).min();
                assert!(shortest >= Some(least.div_ceil(3).min(*count)), "{own:?}");
            }
            assert!(stretches.is_sorted_by_key(|stretch| stretch.sequence));
            assert!(jobs == 1 || lengths(&stretches).iter().all(|length| *length <= most + most / 4));
        }
        // 110 scans for two: a quarter of what is left each time, and then short ones.
        let alone = vec![0; 110];
        assert_eq!(lengths(&stretches(std::slice::from_ref(&alone), false, 2)), [28, 21, 16, 12, 9, 8, 8, 8]);
        assert_eq!(stretches(&[alone], false, 1).len(), 1);
    }

    #[test]
    fn a_cut_is_where_images_change_if_that_is_near() {
        let mut shared = vec![4; 110];
        shared[25] = 0;
        shared[45] = 1;
        assert_eq!(lengths(&stretches(&[shared], false, 2))[..2], [25, 20]);
    }

    #[test]
    fn what_scans_share_is_what_is_nearest_to_both() {
        let times = Timelines {
            radars: vec![],
            lidars: vec![vec![0, 24]],
            cameras: vec![vec![2, 12, 22, 32], vec![]],
        };
        assert_eq!(shared(&times, &Config::default(), [0, 10, 20, 30]), [0, 1, 0, 1]);
    }
}
