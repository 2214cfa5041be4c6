//! Listening, serving, ending.

use crate::app::App;
use crate::http::{Guard, Token};
use crate::{ReviewError, routes};
use ralf_data::Recording;
use std::io::ErrorKind;
use std::net::{IpAddr, SocketAddr, TcpListener, ToSocketAddrs};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

/// Tried first where no port is asked for.
const FIRST_PORT: u16 = 8642;
/// How many ports are tried.
const PORTS: u16 = 20;
/// Files that are read at once.
const READERS: usize = 8;
/// How long requests may take to end when the server does.
const PATIENCE: Duration = Duration::from_secs(5);

/// How to serve.
#[derive(Debug, Clone)]
pub struct Options {
    /// Name or address to listen on.
    pub host: String,
    /// Port to listen on, 0 for any free one. `None`: 8642, or the next one that is free.
    pub port: Option<u16>,
    /// Who corrects.
    pub author: String,
}

/// A review that listens.
pub struct Server {
    app: Arc<App>,
    guard: Arc<Guard>,
    listener: TcpListener,
    runtime: Runtime,
    url: String,
}

impl Server {
    /// Opens labels and corrections, and begins to listen. A token is asked of requests unless only this machine can send any.
    ///
    /// # Errors
    /// No labels, a store that is none, an address that can't be listened on.
    pub fn bind(recording: Recording, out: &Path, options: &Options) -> Result<Self, ReviewError> {
        let app = App::open(recording, out, options)?;
        let listener = listen(&options.host, options.port)?;
        let address = listener.local_addr().map_err(ReviewError::system("local address"))?;
        listener.set_nonblocking(true).map_err(ReviewError::system("listening"))?;
        let token = if address.ip().is_loopback() { None } else { Some(Token::new()?) };
        let query = token.as_ref().map_or(String::new(), |token| format!("?token={}", token.digits()));
        let url = format!("http://{}/{query}", name_of(&options.host, address));
        let guard = Guard::new(&options.host, address, token);
        let runtime = Builder::new_current_thread().enable_all().max_blocking_threads(READERS).build();
        let runtime = runtime.map_err(ReviewError::system("threads"))?;
        Ok(Self { app: Arc::new(app), guard: Arc::new(guard), listener, runtime, url })
    }

    /// What to type in a browser.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Serves until the user interrupts (Ctrl-C).
    pub fn run(self) -> Result<(), ReviewError> {
        self.run_until(async {
            // Where it can't be waited for, the server serves on, and is ended by the signal itself.
            if tokio::signal::ctrl_c().await.is_err() {
                std::future::pending::<()>().await;
            }
        })
    }

    /// Serves until something happens; requests in hand are answered.
    pub fn run_until(self, end: impl Future<Output = ()> + Send + 'static) -> Result<(), ReviewError> {
        let Self { app, guard, listener, runtime, .. } = self;
        let router = routes::router(app.clone(), guard);
        let served = runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(listener)?;
            let closing = app.closing.clone();
            let ending = async move {
                end.await;
                closing.send_replace(true);
            };
            let mut ended = app.closing.subscribe();
            let serving = axum::serve(listener, router).with_graceful_shutdown(ending);
            let too_long = async {
                let _ = ended.wait_for(|ended| *ended).await;
                tokio::time::sleep(PATIENCE).await;
            };
            tokio::select! {
                served = serving.into_future() => served,
                () = too_long => Ok(()),
            }
        });
        runtime.shutdown_timeout(PATIENCE);
        served.map_err(ReviewError::system("serving"))
    }
}

/// Listens where asked, or on the first free port from 8642 on.
fn listen(host: &str, port: Option<u16>) -> Result<TcpListener, ReviewError> {
    let ip = ip_of(host)?;
    let ports = port.map_or(FIRST_PORT..=FIRST_PORT + PORTS, |port| port..=port);
    let last = *ports.end();
    for port in ports {
        let address = SocketAddr::new(ip, port);
        match TcpListener::bind(address) {
            Ok(listener) => return Ok(listener),
            Err(error) if error.kind() == ErrorKind::AddrInUse && port < last => {}
            Err(error) if error.kind() == ErrorKind::AddrInUse => {
                return Err(ReviewError::PortInUse { address });
            }
            Err(error) => return Err(ReviewError::Listen { address, error }),
        }
    }
    Err(ReviewError::PortInUse { address: SocketAddr::new(ip, last) })
}

fn ip_of(host: &str) -> Result<IpAddr, ReviewError> {
    let name = host.trim_start_matches('[').trim_end_matches(']');
    let refused = |error| ReviewError::Host { host: host.to_owned(), error };
    let mut found = (name, 0).to_socket_addrs().map_err(refused)?;
    let none = || refused(std::io::Error::new(ErrorKind::NotFound, "no address"));
    found.next().map(|address| address.ip()).ok_or_else(none)
}

/// The address as a browser takes it: the name asked for, where it is one.
fn name_of(host: &str, address: SocketAddr) -> String {
    let is_name = host.parse::<IpAddr>().is_err() && !host.starts_with('[') && !address.ip().is_loopback();
    if is_name { format!("{host}:{}", address.port()) } else { address.to_string() }
}
