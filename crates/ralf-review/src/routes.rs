//! Which address leads where.

use crate::app::App;
use crate::correcting::{self, MarkRequest, Since, StepRequest, StrokeRequest};
use crate::http::{Answer, ApiError, Asked, Body, Ends, Guard, MAX_BODY, OPEN, Person, Place, guard, json};
use crate::page;
use crate::reading::{self, About, Around, AskedKinds, LidarProjection, Moment, Near, Projection};
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{Method, Uri};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post, put};
use axum::{Extension, Router};
use std::sync::Arc;

type Shared = State<Arc<App>>;

/// The interface, the page, and what guards them.
pub(crate) fn router(app: Arc<App>, guarded_by: Arc<Guard>) -> Router {
    let sequence = Router::new()
        .route("/queue", get(queue))
        .route("/progress", get(progress))
        .route("/things", get(things))
        .route("/things/doubtful", get(doubtful))
        .route("/opinion", get(opinion))
        .route("/kinds", get(kinds))
        .route("/disagreements", get(disagreements))
        .route("/radars/{radar}/scans/{scan}", get(detections))
        .route("/radars/{radar}/scans/{scan}/detections/{point}/said", get(said))
        .route("/radars/{radar}/scans/{scan}/reviewed", put(mark))
        .route("/lidars/{lidar}/scans/{scan}", get(cloud))
        .route("/lidars/{lidar}/scans/{scan}/around", get(map))
        .route("/lidars/{lidar}/scans/{scan}/near", get(near))
        .route("/cameras/{camera}/images/{image}", get(image))
        .route("/cameras/{camera}/images/{image}/detections", get(projection))
        .route("/cameras/{camera}/images/{image}/lidar", get(lidar_projection))
        .route("/cameras/{camera}/images/{image}/things/{thing}", get(thing_projection))
        .route("/moment", get(moment))
        .route("/strokes", post(stroke))
        .route("/undo", post(undo))
        .route("/redo", post(redo))
        .route("/history", get(history))
        .route("/changes", get(changes));
    let doors = Router::new().route(&format!("{OPEN}{{code}}"), get(admit)).with_state(guarded_by.clone());
    Router::new()
        .merge(doors)
        .route("/api/recording", get(recording))
        .route("/api/people", get(people))
        .nest("/api/sequences/{sequence}", sequence)
        .fallback(elsewhere)
        .method_not_allowed_fallback(async || ApiError::Method)
        .layer(DefaultBodyLimit::max(MAX_BODY))
        .layer(from_fn_with_state(guarded_by, guard))
        .with_state(app)
}

async fn elsewhere(method: Method, uri: Uri) -> Response {
    let path = uri.path();
    if path.starts_with("/api/") {
        return ApiError::unknown("address", path, "one of docs/review-api.md").into_response();
    }
    let reads = matches!(method, Method::GET | Method::HEAD);
    let unknown = || ApiError::unknown("address", path, "one of the page's files").into_response();
    match page::file(path) {
        Some(_) if !reads => ApiError::Method.into_response(),
        found => found.unwrap_or_else(unknown),
    }
}

async fn admit(
    State(guard): State<Arc<Guard>>,
    Extension(ends): Extension<Ends>,
    Place(code): Place<String>,
) -> Answer {
    Ok(Redirect::to(&guard.admit(&code, ends)?).into_response())
}

async fn recording(State(app): Shared) -> Answer {
    app.blocking(reading::recording).await
}

async fn queue(State(app): Shared, Place(sequence): Place<String>) -> Answer {
    app.blocking(move |app| reading::queue(app, &sequence)).await
}

async fn progress(State(app): Shared, Place(sequence): Place<String>) -> Answer {
    app.blocking(move |app| json(&reading::progress(app, &sequence)?)).await
}

async fn things(State(app): Shared, Place(sequence): Place<String>) -> Answer {
    app.blocking(move |app| reading::things(app, &sequence)).await
}

async fn doubtful(State(app): Shared, Place(sequence): Place<String>) -> Answer {
    app.blocking(move |app| reading::doubtful(app, &sequence)).await
}

async fn kinds(
    State(app): Shared,
    Place(sequence): Place<String>,
    Asked(asked): Asked<AskedKinds>,
) -> Answer {
    app.blocking(move |app| reading::kinds(app, &sequence, &asked)).await
}

async fn opinion(State(app): Shared, Place(sequence): Place<String>, Asked(asked): Asked<Around>) -> Answer {
    app.blocking(move |app| reading::opinion(app, &sequence, &asked)).await
}

async fn people(State(app): Shared) -> Answer {
    app.blocking(reading::people).await
}

async fn disagreements(State(app): Shared, Place(sequence): Place<String>) -> Answer {
    app.blocking(move |app| reading::disagreements(app, &sequence)).await
}

async fn said(
    State(app): Shared,
    Place((sequence, radar, scan, point)): Place<(String, String, usize, usize)>,
    Asked(about): Asked<About>,
) -> Answer {
    app.blocking(move |app| reading::said(app, (&sequence, &radar, scan, point), &about)).await
}

async fn detections(
    State(app): Shared,
    Place((sequence, radar, scan)): Place<(String, String, usize)>,
) -> Answer {
    app.blocking(move |app| reading::detections(app, &sequence, &radar, scan)).await
}

async fn cloud(State(app): Shared, Place((sequence, lidar, scan)): Place<(String, String, usize)>) -> Answer {
    app.blocking(move |app| reading::cloud(app, &sequence, &lidar, scan)).await
}

async fn map(State(app): Shared, Place((sequence, lidar, scan)): Place<(String, String, usize)>) -> Answer {
    app.blocking(move |app| reading::map(app, &sequence, &lidar, scan)).await
}

async fn near(
    State(app): Shared,
    Place((sequence, lidar, scan)): Place<(String, String, usize)>,
    Asked(place): Asked<Near>,
) -> Answer {
    app.blocking(move |app| reading::near(app, (&sequence, &lidar, scan), place)).await
}

async fn image(
    State(app): Shared,
    Place((sequence, camera, image)): Place<(String, String, usize)>,
) -> Answer {
    app.blocking(move |app| reading::image(app, &sequence, &camera, image)).await
}

async fn projection(
    State(app): Shared,
    Place((sequence, camera, image)): Place<(String, String, usize)>,
    Asked(asked): Asked<Projection>,
) -> Answer {
    app.blocking(move |app| reading::projection(app, (&sequence, &camera, image), &asked)).await
}

async fn lidar_projection(
    State(app): Shared,
    Place((sequence, camera, image)): Place<(String, String, usize)>,
    Asked(asked): Asked<LidarProjection>,
) -> Answer {
    app.blocking(move |app| reading::lidar_projection(app, (&sequence, &camera, image), &asked)).await
}

async fn thing_projection(
    State(app): Shared,
    Place((sequence, camera, image, thing)): Place<(String, String, usize, u32)>,
) -> Answer {
    app.blocking(move |app| reading::thing_projection(app, (&sequence, &camera, image), thing)).await
}

async fn moment(State(app): Shared, Place(sequence): Place<String>, Asked(asked): Asked<Moment>) -> Answer {
    app.blocking(move |app| reading::moment(app, &sequence, &asked)).await
}

async fn stroke(
    State(app): Shared,
    Place(sequence): Place<String>,
    person: Person,
    Body(asked): Body<StrokeRequest>,
) -> Answer {
    app.in_turn(move |app| correcting::stroke(app, &sequence, asked, person)).await
}

async fn undo(
    State(app): Shared,
    Place(sequence): Place<String>,
    person: Person,
    Body(asked): Body<StepRequest>,
) -> Answer {
    app.in_turn(move |app| correcting::undo(app, &sequence, asked, person)).await
}

async fn redo(
    State(app): Shared,
    Place(sequence): Place<String>,
    person: Person,
    Body(asked): Body<StepRequest>,
) -> Answer {
    app.in_turn(move |app| correcting::redo(app, &sequence, asked, person)).await
}

async fn history(State(app): Shared, Place(sequence): Place<String>, person: Person) -> Answer {
    app.blocking(move |app| correcting::history(app, &sequence, person)).await
}

async fn mark(
    State(app): Shared,
    Place((sequence, radar, scan)): Place<(String, String, usize)>,
    person: Person,
    Body(asked): Body<MarkRequest>,
) -> Answer {
    app.in_turn(move |app| correcting::mark(app, (&sequence, &radar, scan), asked, person)).await
}

async fn changes(
    State(app): Shared,
    Place(sequence): Place<String>,
    Asked(asked): Asked<Since>,
    person: Person,
) -> Answer {
    correcting::changes(app, sequence, asked, person).await
}
