//! A sensor's times.

use crate::remedy::Remedy;
use crate::statistics::median;
use crate::verdict::{Question, Verdict};

/// Between two scans in a row, s: the median of any sensor of a vehicle.
const SPACING: std::ops::Range<f64> = 0.004..3.0;

pub(super) fn judge(name: &str, times: &[i64]) -> Vec<Verdict> {
    let doubts = [spacing(name, times), equal(name, times)];
    doubts.into_iter().flatten().collect()
}

/// A sensor of a recording starts and stops within this of the others, ns: recorders start one part after another.
const TOGETHER_NS: i64 = 500_000_000;

/// A LiDAR or camera whose clock is not the radars'.
pub(super) fn beside_radars(name: &str, times: &[i64], radars: &[Vec<i64>]) -> Option<Verdict> {
    let [first, last] = [*times.first()?, *times.last()?];
    let begin = radars.iter().filter_map(|times| times.first()).min()?;
    let end = radars.iter().filter_map(|times| times.last()).max()?;
    let [late, later] = [first.saturating_sub(*begin), last.saturating_sub(*end)];
    let seconds = |ns: i64| ns.unsigned_abs() as f64 * 1e-9;
    let side = |ns: i64| if ns > 0 { "after" } else { "before" };
    let evidence = if first.saturating_sub(*end) > TOGETHER_NS || begin.saturating_sub(last) > TOGETHER_NS {
        format!(
            "all its times lie {} those of the radars: it begins {:.1} s {0} them",
            side(late),
            seconds(late)
        )
    } else if is_shifted(late, later) {
        let way = side(late);
        format!(
            "it begins {:.1} s {way} the radars, and ends {:.1} s {way} them",
            seconds(late),
            seconds(later)
        )
    } else {
        return None;
    };
    let remedy = Remedy::LookInto("its clock may be another one, which its time_offset_ms puts right");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}

/// Whether both ends lie as far to the same side: what is recorded for a longer or a shorter time has no wrong clock.
fn is_shifted(begin: i64, end: i64) -> bool {
    begin.signum() == end.signum()
        && begin.unsigned_abs().min(end.unsigned_abs()) > TOGETHER_NS.unsigned_abs()
        && begin.abs_diff(end) < TOGETHER_NS.unsigned_abs()
}

fn spacing(name: &str, times: &[i64]) -> Option<Verdict> {
    let steps: Vec<f64> =
        times.windows(2).map(|pair| pair[1].saturating_sub(pair[0]) as f64 * 1e-9).collect();
    let usual = median(&steps).filter(|usual| steps.len() >= 3 && !SPACING.contains(usual))?;
    let evidence = format!("its scans come every {usual:.6} s");
    let remedy = Remedy::LookInto("timestamps look like another unit than ns");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}

/// Radars and LiDARs measure evenly: what lies aside of that by this share of a step, and by so much, s, has been given
/// when it arrived. Of recorded radars half lie aside by less than a fiftieth.
const UNEVEN: (f64, f64) = (0.12, 0.015);
/// Fewer steps tell no beat.
const STEPS: usize = 20;
/// So many steps tell how long one is.
const BEATS: usize = 8;
/// Sensors with several modes go on evenly over so many steps.
const MODES: usize = 4;

/// A radar or LiDAR whose times have no beat.
pub(super) fn uneven(name: &str, times: &[i64]) -> Option<Verdict> {
    let over = |steps: usize| -> Vec<f64> {
        times.windows(steps + 1).map(|w| w[steps].saturating_sub(w[0]) as f64 * 1e-9).collect()
    };
    let steps = over(1);
    // Over several: of what arrives in bursts most steps are nothing.
    let usual = median(&over(BEATS)).map(|of_some| of_some / BEATS as f64);
    let usual = usual.filter(|usual| steps.len() >= STEPS && SPACING.contains(usual))?;
    // Scans that were lost leave whole steps.
    let whole = |step: &f64| (step - usual * (step / usual).round().max(1.0)).abs();
    let aside = median(&steps.iter().map(whole).collect::<Vec<_>>());
    let of_modes = (1..=MODES).map(|modes| {
        let steps = over(modes);
        let usual = median(&steps)?;
        median(&steps.iter().map(|step| (step - usual).abs()).collect::<Vec<_>>())
    });
    let aside = of_modes.chain([aside]).flatten().min_by(f64::total_cmp)?;
    if aside < UNEVEN.0 * usual || aside < UNEVEN.1 || is_even_with_gaps(&steps) {
        return None;
    }
    let evidence = format!(
        "half of its times lie {:.0} ms and more aside of an even beat of {:.0} ms",
        aside * 1e3,
        usual * 1e3
    );
    let remedy = Remedy::LookInto("are they times of arrival? Those of the measurement are expected");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}

/// Whether all is even by the shortest steps: of scans most of which were lost.
fn is_even_with_gaps(steps: &[f64]) -> bool {
    let mut sorted = steps.to_vec();
    sorted.sort_by(f64::total_cmp);
    let shortest = sorted[sorted.len() / 10];
    sorted.retain(|step| *step < 1.5 * shortest);
    let beat = median(&sorted).filter(|beat| SPACING.contains(beat));
    beat.is_some_and(|beat| {
        let aside = |step: &f64| (step - beat * (step / beat).round()).abs();
        median(&steps.iter().map(aside).collect::<Vec<_>>()).is_some_and(|aside| aside < UNEVEN.0 * beat)
    })
}

/// Measurements that have the time of the one before: no sensor measures twice at once.
fn equal(name: &str, times: &[i64]) -> Option<Verdict> {
    let same: Vec<usize> = (1..times.len()).filter(|i| times[*i] == times[i - 1]).collect();
    let first = *same.first()?;
    let evidence = format!(
        "{} of its {} measurements have the time of the one before, first number {first} at {} ns",
        same.len(),
        times.len(),
        times[first]
    );
    let remedy = Remedy::LookInto("a measurement may be recorded twice or in parts, or its clock may stand");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_times_are_counted_and_the_first_is_named() {
        let found = judge("radar", &[0, 50_000_000, 50_000_000, 100_000_000, 150_000_000, 150_000_000]);
        assert_eq!(found.len(), 1, "{found:?}");
        let expected =
            "2 of its 6 measurements have the time of the one before, first number 2 at 50000000 ns";
        assert_eq!(found[0].evidence, expected);
        assert_eq!(judge("radar", &[0, 50_000_000, 100_000_000, 150_000_000]), []);
    }

    /// So many times, each by a function of its number, ms.
    fn at(time: impl Fn(i64) -> i64) -> Vec<i64> {
        (0..60).map(|scan| time(scan) * 1_000_000).collect()
    }

    #[test]
    fn times_of_arrival_have_no_beat() {
        // Up to 90 ms late.
        let late = uneven("radar", &at(|scan| 100 * scan + scan * scan * 17 % 91)).unwrap();
        assert!(late.evidence.contains("aside of an even beat"), "{late:?}");
        assert_eq!(uneven("radar", &at(|scan| 100 * scan + scan % 7)), None, "a scheduler's few ms");
        assert_eq!(uneven("radar", &at(|scan| 100 * scan + 30 * (scan % 2))), None, "two modes in turn");
        assert_eq!(uneven("radar", &at(|scan| 100 * (scan + scan / 5))), None, "scans are lost");
        let kept = |scan: i64| 100 * (scan * 5 / 2 + scan * scan * 17 % 3) + scan % 4;
        let mut most_lost = at(kept);
        most_lost.sort_unstable();
        most_lost.dedup();
        assert_eq!(uneven("radar", &most_lost), None, "most scans are lost");
    }
}
