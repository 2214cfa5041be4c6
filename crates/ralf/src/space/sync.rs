//! Which measurements belong together (docs/method.md, sections 1, 7 and 13).

use std::ops::Range;

/// The measurement nearest in time, if within the tolerance (inclusive, ns). A tie takes the earlier. `times` ascend.
pub fn nearest(times: &[i64], t_ns: i64, tolerance_ns: i64) -> Option<usize> {
    let after = times.partition_point(|time| *time < t_ns);
    let distance = |i: usize| times[i].abs_diff(t_ns);
    let before = after.checked_sub(1).map(|i| times.partition_point(|time| *time < times[i]));
    let candidates = [before, (after < times.len()).then_some(after)];
    let best = candidates.into_iter().flatten().min_by_key(|i| distance(*i))?;
    (i128::from(distance(best)) <= i128::from(tolerance_ns)).then_some(best)
}

/// The measurements within a time of another (inclusive, ns), in order; the nearest ones where there are more than
/// `at_most`. `times` ascend.
pub fn around(times: &[i64], t_ns: i64, reach_ns: i64, at_most: usize) -> Range<usize> {
    let within = |time: &i64| i128::from(time.abs_diff(t_ns)) <= i128::from(reach_ns);
    let mut begin = times.partition_point(|time| *time < t_ns && !within(time));
    let mut end = times.partition_point(|time| *time < t_ns || within(time));
    while end.saturating_sub(begin) > at_most {
        if times[begin].abs_diff(t_ns) > times[end - 1].abs_diff(t_ns) {
            begin += 1;
        } else {
            end -= 1;
        }
    }
    begin..end.max(begin)
}

/// The scans `k - n_b ..= k + n_b` without `k` itself, in order, as far as they exist and no two scans in a row between
/// them and `k` are more than `max_gap_ns` apart.
pub fn batch(times: &[i64], k: usize, n_b: usize, max_gap_ns: i64) -> Vec<usize> {
    let connected = |earlier: usize| {
        i128::from(times[earlier + 1]) - i128::from(times[earlier]) <= i128::from(max_gap_ns)
    };
    let earliest = (k.saturating_sub(n_b)..k).rev().take_while(|i| connected(*i)).last().unwrap_or(k);
    let end = k.saturating_add(n_b).saturating_add(1).min(times.len());
    let latest = (k + 1..end).take_while(|i| connected(*i - 1)).last().unwrap_or(k);
    (earliest..=latest).filter(|i| *i != k).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_takes_the_earlier_of_a_tie_within_an_inclusive_tolerance() {
        let times = [10, 20, 20, 40];
        for (t, tolerance, expected) in [
            (15, 5, Some(0)),
            (15, 4, None),
            (16, 9, Some(1)),
            (30, 10, Some(1)),
            (31, 10, Some(3)),
            (0, 10, Some(0)),
            (50, 9, None),
            (50, 10, Some(3)),
        ] {
            assert_eq!(nearest(&times, t, tolerance), expected, "t {t}, tolerance {tolerance}");
        }
        assert_eq!(nearest(&[], 0, i64::MAX), None);
        assert_eq!(nearest(&[i64::MIN], i64::MAX, i64::MAX), None);
    }

    #[test]
    fn around_a_time_the_nearest_are_kept() {
        let times = [0, 10, 20, 20, 30, 47];
        for (t, reach, at_most, expected) in [
            (20, 10, 9, 1..5),
            (20, 9, 9, 2..4),
            (20, 20, 3, 1..4),
            (25, 100, 1, 2..3),
            (100, 10, 9, 6..6),
            (-5, 4, 9, 0..0),
            (20, 10, 0, 1..1),
        ] {
            let found = around(&times, t, reach, at_most);
            assert!(found == expected || (found.is_empty() && expected.is_empty()), "{t} {reach} {found:?}");
        }
    }

    #[test]
    fn a_batch_ends_at_the_sequences_ends_and_beside_a_gap() {
        let times = [0, 10, 20, 31, 41, 51];
        assert_eq!(batch(&times, 1, 2, 20), [0, 2, 3]);
        assert_eq!(batch(&times, 2, 5, 10), [0, 1], "11 is strictly more than 10");
        assert_eq!(batch(&times, 3, 1, 10), [4]);
        assert_eq!(batch(&times, 5, usize::MAX, 100), [0, 1, 2, 3, 4]);
        assert!(batch(&[7], 0, 5, 10).is_empty());
    }
}
