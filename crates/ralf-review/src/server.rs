//! Listening, serving, ending.

use crate::app::App;
use crate::error::ReviewError;
use crate::http::{Guard, Token};
use crate::listening::listen;
use crate::options::Options;
use crate::{addresses, connections, routes};
use ralf_data::Recording;
use std::io;
use std::net::TcpListener;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

/// Files that are read at once.
const READERS: usize = 8;
/// Without an edit for so long, the journal is written back.
const IDLE: Duration = Duration::from_millis(500);
/// How long requests may take to end when the server does.
const PATIENCE: Duration = Duration::from_secs(5);

/// A review that listens.
pub struct Server {
    app: Arc<App>,
    guard: Arc<Guard>,
    listener: TcpListener,
    runtime: Runtime,
    origins: Vec<String>,
}

impl Server {
    /// Opens labels and corrections, and begins to listen. Every request but those for the page itself needs the token.
    ///
    /// # Errors
    /// No labels, a store that is none, an address that can't be listened on.
    pub fn bind(recording: Recording, out: &Path, options: &Options) -> Result<Self, ReviewError> {
        let app = App::open(recording, out, options)?;
        let listener = listen(app.store.file(), options)?;
        let address = listener.local_addr().map_err(ReviewError::system("local address"))?;
        listener.set_nonblocking(true).map_err(ReviewError::system("listening"))?;
        let token = Token::of(out, options.token_folder.as_deref())?;
        let named = addresses::reachable(&options.host, address);
        let guard = Guard::new(&options.host, address, token, app.served()?);
        let origins = named.into_iter().map(|name| format!("http://{name}")).collect();
        let runtime = Builder::new_current_thread().enable_all().max_blocking_threads(READERS).build();
        let runtime = runtime.map_err(ReviewError::system("threads"))?;
        Ok(Self { app: Arc::new(app), guard: Arc::new(guard), listener, runtime, origins })
    }

    /// What to type in a browser: on this machine the first one, on others those behind it. Each holds the token.
    pub fn urls(&self) -> Vec<String> {
        let page = self.guard.page();
        self.origins.iter().map(|origin| format!("{origin}{page}")).collect()
    }

    /// What to start a browser with on this machine: it holds no token, leads to the page once, within two minutes, and
    /// lets nobody in but the user who runs this, for everybody on the machine can see what programs are started with.
    /// The one before is worth nothing any more. `None` where the system (other than Linux) doesn't tell who asks.
    ///
    /// # Errors
    /// No random numbers.
    pub fn invitation(&self) -> Result<Option<String>, ReviewError> {
        let path = self.guard.invite()?;
        Ok(self.origins.first().zip(path).map(|(origin, path)| format!("{origin}{path}")))
    }

    /// Why nothing can be corrected here; `None` where it can.
    pub fn read_only(&self) -> Option<&str> {
        self.app.store.read_only()
    }

    /// Serves until the user interrupts (Ctrl-C), or the system ends it.
    ///
    /// # Errors
    /// Those of the system.
    pub fn run(self) -> Result<(), ReviewError> {
        self.run_until(told_to_end())
    }

    /// Serves until something happens; requests in hand are answered, and the store's file holds everything by
    /// itself then.
    ///
    /// # Errors
    /// Those of the system.
    pub fn run_until(self, end: impl Future<Output = ()> + Send + 'static) -> Result<(), ReviewError> {
        let Self { app, guard, listener, runtime, .. } = self;
        let served = runtime.block_on(serve(app.clone(), guard, listener, end));
        runtime.shutdown_timeout(PATIENCE);
        let written_back = app.store.write_back();
        served.map_err(ReviewError::system("serving"))?;
        Ok(written_back?)
    }
}

async fn serve(
    app: Arc<App>,
    guard: Arc<Guard>,
    listener: TcpListener,
    end: impl Future<Output = ()> + Send + 'static,
) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let closing = app.closing.clone();
    let ending = async move {
        end.await;
        closing.send_replace(true);
    };
    let mut ended = app.closing.subscribe();
    let too_long = async {
        let _ = ended.wait_for(|ended| *ended).await;
        tokio::time::sleep(PATIENCE).await;
    };
    let settling = tokio::spawn(settle(app.clone()));
    tokio::select! {
        () = connections::serve(listener, routes::router(app, guard), ending) => {}
        () = too_long => {}
    }
    settling.abort();
    Ok(())
}

/// Writes the store's journal back whenever nobody has edited for a moment, so that a copy of the file alone
/// holds everything.
async fn settle(app: Arc<App>) {
    let mut news = app.news.subscribe();
    while news.changed().await.is_ok() {
        while tokio::time::timeout(IDLE, news.changed()).await.is_ok_and(|rung| rung.is_ok()) {}
        let app = app.clone();
        // What can't be written back stays in the journal, where it is as safe.
        let _written_back = tokio::task::spawn_blocking(move || app.store.write_back()).await;
    }
}

/// Ctrl-C, or the system's wish. Where it can't be waited for, the server serves on, and is ended by the signal itself.
async fn told_to_end() {
    let interrupted = async {
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    tokio::select! {
        () = interrupted => {}
        () = terminated() => {}
    }
}

#[cfg(unix)]
async fn terminated() {
    use tokio::signal::unix::{SignalKind, signal};
    match signal(SignalKind::terminate()) {
        Ok(mut wish) => drop(wish.recv().await),
        Err(_) => std::future::pending().await,
    }
}

#[cfg(not(unix))]
async fn terminated() {
    std::future::pending().await
}
