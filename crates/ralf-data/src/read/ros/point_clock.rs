//! When the points of a LiDAR's clouds were measured: drivers agree neither on the field nor on its unit.
//!
//! The first scans whose times differ tell the unit, each by itself, and what most of them say counts: the first of a
//! drive may be cut short, to a packet or two, and then looks as if its unit was longer. Times are either on the
//! header's clock, and lie within a second of its stamp in one unit, or relative to the stamp, and then their spread
//! tells it: no scan is shorter than a millisecond or longer than a second, and units are a thousand apart.

use ralf::sensors::{LONGEST_AFTER, is_return};
use ralf_ros::point_cloud::PointTable;

/// What drivers call the time of a point.
const FIELDS: [&str; 5] = ["t", "time", "timestamp", "time_stamp", "offset_time"];
/// Seconds in a unit.
const UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
/// No LiDAR scans faster, s.
const SHORTEST: f64 = 1e-3;

/// So many scans whose times differ are asked.
const FIRST_SCANS: usize = 10;

/// What a scan says of how its points tell their times.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Told {
    /// Points without a time.
    NoTimes,
    /// No points, or all of one time in the field that is named: another scan may tell more.
    Nothing(Option<&'static str>),
    /// How.
    Clock(PointClock),
    /// A sentence: times in no unit.
    Strange(String),
}

/// A field of times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PointClock {
    pub(super) field: &'static str,
    pub(super) unit: &'static str,
    /// Its length, s.
    seconds: f64,
    /// Whether times are on the clock of the stamps; else they are relative to the scan's.
    is_absolute: bool,
}

impl PointClock {
    /// The field of a cloud that tells its points' times; the points themselves tell which of them are returns.
    pub(super) fn find(table: &PointTable, points: &[[f32; 3]], t_ns: i64) -> Told {
        let Some(field) = FIELDS.into_iter().find(|field| table.names().any(|name| name == *field)) else {
            // Some drivers leave the fields out where there are no points.
            return if table.is_empty() { Told::Nothing(None) } else { Told::NoTimes };
        };
        let times = table.wide_column(field).unwrap_or_default().into_iter();
        // What is no return has no time, whatever stands in its place.
        let returns = points.iter().map(is_return).chain(std::iter::repeat(true));
        let timed = times.zip(returns).filter(|(time, is_return)| *is_return && time.is_finite());
        let times: Vec<f64> = timed.map(|(time, _)| time).collect();
        let (first, last) = times.iter().fold((f64::MAX, f64::MIN), |(a, b), t| (a.min(*t), b.max(*t)));
        if first >= last {
            return Told::Nothing(Some(field));
        }
        let stamp = t_ns as f64 * 1e-9;
        let ends = |seconds: f64, is_absolute: bool| {
            [first, last].map(|t| t * seconds - if is_absolute { stamp } else { 0.0 })
        };
        let fits = |(seconds, is_absolute): (f64, bool)| {
            let [begin, end] = ends(seconds, is_absolute);
            begin.abs() <= LONGEST_AFTER
                && end.abs() <= LONGEST_AFTER
                && (SHORTEST..LONGEST_AFTER).contains(&(end - begin))
        };
        let clock = |is_absolute| {
            let unit = UNITS.into_iter().find(|(_, seconds)| fits((*seconds, is_absolute)));
            unit.map(|(unit, seconds)| Self { field, unit, seconds, is_absolute })
        };
        // A clock that begins with the recording tells times as small as those since a stamp: it is one of the two
        // by which the scan begins or ends at its stamp.
        let from_stamp = |clock: &Self| {
            let [begin, end] = ends(clock.seconds, clock.is_absolute);
            begin.abs().min(end.abs())
        };
        let clocks = [false, true].into_iter().filter_map(clock);
        let strange = || {
            format!("`{field}` from {first} to {last} is a time of points in no known unit, and is not used")
        };
        let nearest = clocks.min_by(|a, b| from_stamp(a).total_cmp(&from_stamp(b)));
        nearest.map_or_else(|| Told::Strange(strange()), Told::Clock)
    }

    /// Seconds after the scan's time, point by point; 0 of what is no return. The error is a point whose time lies more
    /// than a second away: what was expected and what was found.
    pub(super) fn times(
        &self,
        table: &PointTable,
        points: &[[f32; 3]],
        t_ns: i64,
    ) -> Result<Vec<f32>, (usize, String, String)> {
        let found = table.wide_column(self.field).unwrap_or_else(|| vec![f64::NAN; points.len()]);
        let offset = |(n, (time, point)): (usize, (&f64, &[f32; 3]))| {
            if !is_return(point) {
                return Ok(0.0);
            }
            let seconds = self.after(*time, t_ns);
            if seconds.abs() <= LONGEST_AFTER {
                return Ok(seconds as f32);
            }
            Err((
                n,
                format!("a time within {LONGEST_AFTER} s of the scan's"),
                format!("{time} {}", self.unit),
            ))
        };
        found.iter().zip(points).enumerate().map(offset).collect()
    }

    fn after(&self, time: f64, t_ns: i64) -> f64 {
        if !self.is_absolute {
            return time * self.seconds;
        }
        // In whole seconds first, which keeps the digits.
        let unit_s = 1.0 / self.seconds;
        let whole = (t_ns / 1_000_000_000) as f64;
        (time - whole * unit_s) * self.seconds - (t_ns % 1_000_000_000) as f64 * 1e-9
    }
}

/// What the first scans of a LiDAR say.
#[derive(Default)]
pub(super) struct Said {
    clocks: Vec<PointClock>,
    strange: Vec<String>,
    /// A field of one time for all points of a scan.
    pub(super) idle: Option<&'static str>,
}

impl Said {
    /// Hears what another scan says, and tells whether that is enough.
    pub(super) fn hear(&mut self, told: Told) -> bool {
        match told {
            Told::NoTimes => return true,
            Told::Nothing(field) => self.idle = self.idle.or(field),
            Told::Clock(clock) => self.clocks.push(clock),
            Told::Strange(sentence) => self.strange.push(sentence),
        }
        self.clocks.len() + self.strange.len() >= FIRST_SCANS
    }

    /// How times are told, as most scans have it; of as many the shorter unit, for a short scan leads to a longer one.
    /// The error is a sentence, of times in no unit, where more scans have such than any way to tell them.
    pub(super) fn clock(&self) -> Result<Option<PointClock>, String> {
        let votes = |clock: &PointClock| self.clocks.iter().filter(|other| *other == clock).count();
        let order = |a: &&PointClock, b: &&PointClock| {
            votes(a).cmp(&votes(b)).then_with(|| b.seconds.total_cmp(&a.seconds))
        };
        let clock = self.clocks.iter().max_by(order);
        match self.strange.first() {
            Some(sentence) if self.strange.len() > clock.map_or(0, votes) => Err(sentence.clone()),
            _ => Ok(clock.cloned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_ros::message::{Datatype, PointCloud2, PointField};

    /// 1.6e9 s and a quarter.
    const T_NS: i64 = 1_600_000_000_250_000_000;

    fn cloud(field: &str, datatype: Datatype, times: &[f64]) -> PointCloud2 {
        let bytes = |time: &f64| match datatype {
            Datatype::Float64 => time.to_le_bytes().to_vec(),
            Datatype::Float32 => (*time as f32).to_le_bytes().to_vec(),
            _ => (*time as u32).to_le_bytes().to_vec(),
        };
        let step = datatype.size() as u32;
        let data: Vec<u8> = times.iter().flat_map(bytes).collect();
        PointCloud2 {
            height: 1,
            width: times.len() as u32,
            fields: vec![PointField::new(field, 0, datatype)],
            point_step: step,
            row_step: data.len() as u32,
            data,
            ..PointCloud2::default()
        }
    }

    #[test]
    fn what_drivers_write_is_understood() {
        for (driver, field, datatype, times, expected, unit) in [
            ("Ouster", "t", Datatype::Uint32, [0.0, 99_000_000.0], [0.0, 0.099], "ns"),
            ("Velodyne", "time", Datatype::Float32, [-0.099, 0.0], [-0.099, 0.0], "s"),
            ("Hesai", "timestamp", Datatype::Float64, [1.6e9 + 0.26, 1.6e9 + 0.35], [0.01, 0.1], "s"),
            ("Livox", "timestamp", Datatype::Float64, [1.6e18 + 2.5e8, 1.6e18 + 3.4e8], [0.0, 0.09], "ns"),
            ("us", "offset_time", Datatype::Uint32, [0.0, 99_000.0], [0.0, 0.099], "us"),
        ] {
            let cloud = cloud(field, datatype, &times);
            let table = PointTable::new(&cloud).unwrap();
            let Told::Clock(clock) = PointClock::find(&table, &[], T_NS) else { panic!("{driver}") };
            assert_eq!(clock.unit, unit, "{driver}");
            let found = clock.times(&table, &[[1.0; 3]; 2], T_NS).unwrap();
            assert!(
                found.iter().zip(expected).all(|(a, b): (&f32, f64)| (f64::from(*a) - b).abs() < 1e-6),
                "{found:?}"
            );
        }
    }

    #[test]
    fn times_that_tell_nothing_are_none_and_strange_ones_are_named() {
        let find = |field: &str, times: &[f64]| {
            let cloud = cloud(field, Datatype::Float64, times);
            PointClock::find(&PointTable::new(&cloud).unwrap(), &[], T_NS)
        };
        assert_eq!(find("t", &[0.0, 0.0]), Told::Nothing(Some("t")));
        assert_eq!(find("t", &[f64::NAN]), Told::Nothing(Some("t")));
        assert_eq!(find("t", &[]), Told::Nothing(Some("t")));
        assert_eq!(find("ring", &[]), Told::Nothing(None));
        assert_eq!(find("ring", &[0.0, 0.1]), Told::NoTimes);
        let Told::Strange(sentence) = find("time", &[1.0e9, 1.0e9 + 0.1]) else { panic!("a unit") };
        assert!(sentence.contains("`time` from 1000000000 to"), "{sentence}");
    }

    /// The clock of a simulation begins at 0, and an organised cloud has cells in which nothing came back.
    #[test]
    fn a_clock_that_begins_with_the_recording_is_told_from_times_since_a_stamp() {
        for scan in 1..12 {
            let stamp = f64::from(scan) * 0.1;
            let t_ns = i64::from(scan) * 100_000_000;
            let on_clock = cloud("timestamp", Datatype::Float64, &[stamp, stamp + 0.05, stamp + 0.099]);
            let since = cloud("timestamp", Datatype::Float64, &[0.0, 0.05, 0.099]);
            for (cloud, is_absolute) in [(on_clock, true), (since, false)] {
                let found = PointClock::find(&PointTable::new(&cloud).unwrap(), &[], t_ns);
                let Told::Clock(clock) = found else { panic!("{scan}: {found:?}") };
                assert_eq!((clock.unit, clock.is_absolute), ("s", is_absolute), "{scan}");
            }
        }
    }

    #[test]
    fn what_is_no_return_says_nothing_of_the_clock() {
        let cloud = cloud("timestamp", Datatype::Float64, &[0.0, 1.6e9 + 0.26, 0.0, 1.6e9 + 0.35]);
        let table = PointTable::new(&cloud).unwrap();
        let points = [[f32::NAN; 3], [1.0; 3], [0.0; 3], [2.0; 3]];
        assert!(matches!(PointClock::find(&table, &points, T_NS), Told::Clock(clock) if clock.is_absolute));
        assert!(matches!(PointClock::find(&table, &[], T_NS), Told::Strange(_)));
    }

    #[test]
    fn scans_in_no_unit_have_a_vote() {
        let vote = |strange: usize, counted: usize| {
            let stray = (0..strange).map(|_| Told::Strange("strange".to_owned()));
            let clock = PointClock { field: "t", unit: "s", seconds: 1.0, is_absolute: false };
            let mut said = Said::default();
            let told = stray.chain((0..counted).map(|_| Told::Clock(clock.clone())));
            let enough: Vec<bool> = told.map(|told| said.hear(told)).collect();
            assert_eq!(enough.last(), Some(&(strange + counted >= FIRST_SCANS)));
            said.clock().map(|clock| clock.map(|clock| clock.unit))
        };
        for (strange, counted) in [(9, 1), (6, 4), (1, 0)] {
            assert_eq!(vote(strange, counted), Err("strange".to_owned()), "{strange} to {counted}");
        }
        for (strange, counted) in [(5, 5), (1, 9), (1, 1), (0, 1)] {
            assert_eq!(vote(strange, counted), Ok(Some("s")), "{strange} to {counted}");
        }
    }

    #[test]
    fn a_point_of_another_day_is_refused_unless_it_is_no_return() {
        let first = cloud("time", Datatype::Float64, &[0.0, 0.1]);
        let Told::Clock(clock) = PointClock::find(&PointTable::new(&first).unwrap(), &[], T_NS) else {
            panic!("no clock")
        };
        let later = cloud("time", Datatype::Float64, &[0.05, 7.0]);
        let table = PointTable::new(&later).unwrap();
        assert_eq!(clock.times(&table, &[[1.0; 3], [0.0; 3]], T_NS).unwrap(), [0.05, 0.0]);
        let (point, expected, found) = clock.times(&table, &[[1.0; 3]; 2], T_NS).unwrap_err();
        assert_eq!((point, expected.as_str(), found.as_str()), (1, "a time within 1 s of the scan's", "7 s"));
    }
}
