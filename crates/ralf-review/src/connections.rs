//! Connections: so many at a time, each of which has to say before long what it wants.

use crate::http::Ends;
use crate::patient_stream::PatientStream;
use axum::Router;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper::{Request, Result};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{Semaphore, watch};

/// Connections at a time, of which a browser has up to six. Who comes later waits until one ends.
const CONNECTIONS: u32 = 128;
/// How long a connection may take until the head of its first or next request has arrived, and to take anything more of
/// an answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long nobody is let in after the system could let nobody in, as where too many files are open.
const PAUSE: Duration = Duration::from_millis(500);

/// Serves whoever connects, until `end` happens and all requests in hand are answered.
pub(crate) async fn serve(listener: TcpListener, router: Router, end: impl Future<Output = ()>) {
    let places = Arc::new(Semaphore::new(CONNECTIONS as usize));
    let ending = watch::Sender::new(false);
    let accept = async {
        // The places are never closed.
        while let Ok(place) = places.clone().acquire_owned().await {
            let Ok((stream, _)) = listener.accept().await else {
                tokio::time::sleep(PAUSE).await;
                continue;
            };
            let (router, ended) = (router.clone(), ending.subscribe());
            tokio::spawn(async move {
                // Whatever ends a connection, the client has to ask again.
                let _ended = answer(stream, router, ended).await;
                drop(place);
            });
        }
    };
    tokio::select! {
        () = accept => {}
        () = end => {}
    }
    drop(listener);
    ending.send_replace(true);
    let _all_ended = places.acquire_many(CONNECTIONS).await;
}

/// Answers the requests of one connection.
async fn answer(stream: TcpStream, router: Router, mut ended: watch::Receiver<bool>) -> Result<()> {
    // Who has gone has no ends, and gets no answer.
    let Ok(ends) = Ends::of(&stream) else { return Ok(()) };
    let router = TowerToHyperService::new(router);
    let with_ends = service_fn(move |mut request: Request<Incoming>| {
        request.extensions_mut().insert(ends);
        router.call(request)
    });
    // Answers are sent at once; where the system knows no such wish, they come later.
    let _sooner = stream.set_nodelay(true);
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
    let mut connection =
        pin!(http.serve_connection(TokioIo::new(PatientStream::new(stream, PATIENCE)), with_ends));
    tokio::select! {
        answered = connection.as_mut() => return answered,
        _ = ended.wait_for(|ended| *ended) => connection.as_mut().graceful_shutdown(),
    }
    connection.await
}
