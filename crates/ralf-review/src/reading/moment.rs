//! Which scans belong on the screen.

use super::{read_time, time};
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use ralf::space::sync;
use serde::Deserialize;
use serde_json::{Value, json};

/// Scans before and after that may be asked for.
const MOST_ACCUMULATED: usize = 100;

/// Which moment, how many scans around it, of which radars.
#[derive(Debug, Deserialize)]
pub(crate) struct Moment {
    t_ns: String,
    #[serde(default)]
    accumulate: usize,
    radars: String,
}

/// Of every radar asked for the scan nearest to the moment, and as many before and after it as asked for.
pub(crate) fn moment(app: &App, sequence: &str, asked: &Moment) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    let malformed = |what: &str| ApiError::Malformed(format!("query: {what}"));
    let t_ns = read_time(&asked.t_ns)?;
    if asked.accumulate > MOST_ACCUMULATED {
        let found = asked.accumulate;
        return Err(malformed(&format!("accumulate: expected at most {MOST_ACCUMULATED}, found {found}")));
    }
    let known = reader.sequence();
    let wanted: Vec<&str> = asked.radars.split(',').filter(|name| !name.is_empty()).collect();
    let has = |name: &&&str| known.rig.radars.iter().any(|radar| radar.name == **name);
    let all = wanted == ["all"];
    if let Some(name) = wanted.iter().find(|name| !all && !has(name)) {
        return Err(ApiError::unknown("radar", format!("`{name}`"), "one of the sequence's, or `all`"));
    }
    let radars = known.rig.radars.iter().zip(&known.times.radars);
    let radars = radars.filter(|(radar, _)| all || wanted.contains(&radar.name.as_str()));
    let around = |(radar, times): (&ralf::sensors::Radar, &Vec<i64>)| -> Vec<Value> {
        let Some(nearest) = sync::nearest(times, t_ns, i64::MAX) else { return Vec::new() };
        let last = (nearest + asked.accumulate).min(times.len() - 1);
        let scans = nearest.saturating_sub(asked.accumulate)..=last;
        scans.map(|scan| json!({ "radar": radar.name, "scan": scan, "t_ns": time(times[scan]) })).collect()
    };
    let scans: Vec<Value> = radars.flat_map(around).collect();
    json(&json!({ "run": app.labels(index)?.run(), "scans": scans }))
}
