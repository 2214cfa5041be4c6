//! News for other windows: a request that waits.

use crate::app::App;
use crate::http::{Answer, ApiError, Person, json};
use ralf_corrections::Changes;
use serde::Deserialize;
use serde_json::json;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{Instant, sleep_until};

/// The longest wait.
const LONGEST: Duration = Duration::from_secs(25);
/// How often the store is asked: another program may write to it, and doesn't ring here.
const PERIOD: Duration = Duration::from_secs(1);

/// From which thing done on.
#[derive(Debug, Deserialize)]
pub(crate) struct Since {
    since: Option<i64>,
}

/// What other windows did in a sequence since then, as soon as there is something; without `since` where the
/// count is now.
pub(crate) async fn changes(app: Arc<App>, sequence: String, asked: Since, person: Person) -> Answer {
    app.sequence(&sequence)?;
    let tab = person.tab;
    let Some(since) = asked.since else {
        return answer(&ask(&app, sequence, i64::MAX, tab).await?);
    };
    let end = Instant::now() + LONGEST;
    let (mut news, mut closing) = (app.news.subscribe(), app.closing.subscribe());
    loop {
        let found = ask(&app, sequence.clone(), since, tab.clone()).await?;
        if !found.scans.is_empty() || Instant::now() >= end || *closing.borrow() {
            return answer(&found);
        }
        let wake = end.min(Instant::now() + PERIOD);
        tokio::select! {
            _ = news.changed() => {}
            _ = closing.changed() => {}
            () = sleep_until(wake) => {}
        }
    }
}

async fn ask(app: &Arc<App>, sequence: String, since: i64, tab: Option<String>) -> Result<Changes, ApiError> {
    let app = app.clone();
    let asked = move || app.said(|store| store.changes(&sequence, since, tab.as_deref()));
    let found = tokio::task::spawn_blocking(asked).await;
    found.map_err(|error| ApiError::Broken(error.to_string()))?
}

fn answer(found: &Changes) -> Answer {
    let scans = found.scans.iter().map(|change| {
        json!({
            "radar": change.radar,
            "scan": change.scan,
            "revision": change.revision,
            "author": change.author,
        })
    });
    json(&json!({ "counter": found.counter, "scans": scans.collect::<Vec<_>>() }))
}
