//! Who said what, when, and how much.

use crate::app::{App, ScanPlace};
use crate::http::{Answer, ApiError, json};
use ralf_corrections::{Reader, Saying, ScanVersion};
use ralf_data::ScanIndex;
use ralf_data::team::Worked;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Of a detection alone, or of all that belong together with it.
#[derive(Debug, Deserialize)]
pub(crate) struct About {
    #[serde(default)]
    thing: bool,
}

/// What was ever said of a detection or of its thing, the last first.
pub(crate) fn said(
    app: &App,
    (sequence, radar, scan, point): (&str, &str, usize, usize),
    about: &About,
) -> Answer {
    let place = app.scan(sequence, radar, scan)?;
    let version = app.version(&place)?;
    let detections = version.content.detections as usize;
    if point >= detections {
        return Err(ApiError::unknown("detection", point, &format!("a number below {detections}")));
    }
    let asked = if about.thing { thing(app, &place, point)? } else { vec![(version, one(point)?)] };
    let count: usize = asked.iter().map(|(_, points)| points.len()).sum();
    let said = app.said(|store| store.sayings(&asked))?;
    json(&json!({ "detections": count, "said": said.iter().map(saying).collect::<Vec<_>>() }))
}

fn one(point: usize) -> Result<BTreeSet<u32>, ApiError> {
    let point = u32::try_from(point).map_err(|error| ApiError::Malformed(error.to_string()))?;
    Ok(BTreeSet::from([point]))
}

/// All detections of the thing that this one belongs to, scan by scan.
fn thing(app: &App, place: &ScanPlace, point: usize) -> Result<Vec<(ScanVersion, BTreeSet<u32>)>, ApiError> {
    let things = app.labels(place.sequence)?.things(place.reader)?;
    let numbers = things.things();
    let of_point = things.rows_of(place.scan).nth(point);
    let mut scans: BTreeMap<ScanIndex, BTreeSet<u32>> = BTreeMap::new();
    for row in of_point.into_iter().flat_map(|row| things.rows_of_thing(numbers[row])) {
        let (scan, point) = things.place_of(row);
        scans.entry(scan).or_default().extend(u32::try_from(point).ok());
    }
    let sequence = place.reader.sequence();
    let version = |(ScanIndex { radar, scan }, points): (ScanIndex, BTreeSet<u32>)| {
        let place = app.scan(&sequence.name, &sequence.rig.radars[radar].name, scan)?;
        Ok((app.known_version(place)?, points))
    };
    scans.into_iter().map(version).collect()
}

fn saying(saying: &Saying) -> Value {
    let Saying { author, at, tool, label, cause, detections, holds } = saying;
    json!({ "author": author, "at": at, "tool": tool, "label": label, "cause": cause, "detections": detections,
        "holds": holds })
}

/// How much everybody has done, day by day; who labels a second time is told of itself alone.
pub(crate) fn people(app: &App) -> Answer {
    let worked = match app.team.second {
        None => {
            // The files are opened anew: a store that was deleted under the server is noticed here.
            app.said(Reader::counter)?;
            Worked::below(&app.out)?
        }
        Some(_) => app.said(Reader::workdays)?.into_iter().map(|on| Worked { second: true, on }).collect(),
    };
    json(&json!({ "days": worked.iter().map(Worked::json).collect::<Vec<_>>() }))
}
