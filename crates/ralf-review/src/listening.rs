//! Where the server listens: what a browser keeps of a page belongs to its port.

use crate::error::ReviewError;
use crate::options::Options;
use crate::place;
use std::fs;
use std::io::{self, ErrorKind};
use std::net::{IpAddr, SocketAddr, TcpListener, ToSocketAddrs};
use std::path::{Path, PathBuf};

/// Tried first where no port is asked for, and none was used before.
const FIRST_PORT: u16 = 8642;
/// How many ports are tried.
const PORTS: u16 = 20;

/// Listens where asked; else where the corrections in `store` were served last, or on the first free port from 8642 on.
/// Remembers where.
pub(crate) fn listen(store: &Path, options: &Options) -> Result<TcpListener, ReviewError> {
    let ip = ip_of(&options.host)?;
    let kept = options.token_folder.as_ref().map(|folder| kept_in(folder, store));
    let listener = match options.port {
        Some(port) => bind(ip, port..=port)?,
        None => {
            let last = kept.as_deref().and_then(last_port);
            let again = last.and_then(|port| TcpListener::bind(SocketAddr::new(ip, port)).ok());
            again.map_or_else(|| bind(ip, FIRST_PORT..=FIRST_PORT + PORTS), Ok)?
        }
    };
    if let (Some(file), Ok(address)) = (kept, listener.local_addr()) {
        // Where it can't be kept, the next start may be elsewhere.
        let _kept = keep(&file, address.port());
    }
    Ok(listener)
}

fn kept_in(folder: &Path, store: &Path) -> PathBuf {
    folder.join(format!("{}.port", place::digits(store)))
}

fn last_port(file: &Path) -> Option<u16> {
    fs::read_to_string(file).ok()?.trim().parse().ok().filter(|port| *port > 0)
}

fn keep(file: &Path, port: u16) -> io::Result<()> {
    file.parent().map_or(Ok(()), fs::create_dir_all)?;
    fs::write(file, format!("{port}\n"))
}

/// Listens on the first of these ports that is free.
fn bind(ip: IpAddr, ports: std::ops::RangeInclusive<u16>) -> Result<TcpListener, ReviewError> {
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
    let none = || refused(io::Error::new(ErrorKind::NotFound, "no address"));
    found.next().map(|address| address.ip()).ok_or_else(none)
}
