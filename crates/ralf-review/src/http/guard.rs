//! Who may ask: requests for another host, from another origin, without the token or for other corrections are
//! refused; and the headers of every answer, which forbid the page to load anything but its own.

use super::{ApiError, Ends, Invitation, Token};
use crate::error::ReviewError;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The headers of every answer.
const HEADERS: [(HeaderName, &str); 4] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; \
         font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// What requests are measured by.
pub(crate) struct Guard {
    /// How requests name this server; `None` where it listens on all addresses, which have many names.
    hosts: Option<Hosts>,
    /// Asked for by all but the page itself.
    token: Token,
    /// What the browser is let in by that was started with it; `None` where none was, or it was used.
    invited: Mutex<Option<Invitation>>,
    served: Served,
}

/// What a server is called in `Host`.
struct Hosts {
    names: Vec<String>,
    /// `None`: any. Another port may be forwarded here (`ssh -L`), and browsers name that one. Nothing is lost by it: a
    /// name that somebody rebinds to this machine is another name, a page on another port of this machine is another
    /// origin, and all but the page itself asks for the token.
    port: Option<u16>,
}

impl Hosts {
    fn of(host: &str, address: SocketAddr) -> Self {
        let ip = match address.ip() {
            IpAddr::V4(ip) => ip.to_string(),
            IpAddr::V6(ip) => format!("[{ip}]"),
        };
        let names: &[&str] =
            if address.ip().is_loopback() { &["localhost", "127.0.0.1", "[::1]"] } else { &[host] };
        let mut names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        if !names.contains(&ip) {
            names.push(ip);
        }
        Self { names, port: (!address.ip().is_loopback()).then_some(address.port()) }
    }

    fn hold(&self, found: &str) -> bool {
        // Browsers leave port 80 out.
        let (name, port) = match found.rsplit_once(':') {
            Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => {
                (name, port.parse::<u16>().ok())
            }
            _ => (found, Some(80)),
        };
        let known = self.names.iter().any(|known| known.eq_ignore_ascii_case(name));
        known && port.is_some_and(|port| self.port.is_none_or(|own| own == port))
    }

    /// For people.
    fn told(&self) -> String {
        let named = |name: &String| match self.port {
            Some(port) => format!("{name}:{port}"),
            None => name.clone(),
        };
        self.names.iter().map(named).collect::<Vec<_>>().join(" or ")
    }
}

/// The corrections that are served.
pub(crate) struct Served {
    /// What no others have.
    pub(crate) identity: String,
    /// For people.
    pub(crate) name: String,
}

impl Guard {
    /// For a server that listens at `address`, which was asked for by the name `host`.
    pub(crate) fn new(host: &str, address: SocketAddr, token: Token, served: Served) -> Self {
        let hosts = (!address.ip().is_unspecified()).then(|| Hosts::of(host, address));
        Self { hosts, token, invited: Mutex::default(), served }
    }

    /// A path that leads the user's own browser to the page with its token, once and soon; `None` where the system
    /// doesn't tell whose browser it is that asks.
    pub(crate) fn invite(&self) -> Result<Option<String>, ReviewError> {
        if !Ends::are_told() {
            return Ok(None);
        }
        let invitation = Invitation::new(Instant::now())?;
        let path = invitation.path();
        *self.invited.lock().unwrap_or_else(PoisonError::into_inner) = Some(invitation);
        Ok(Some(path))
    }

    /// The path of the page with its token, for who was invited: that takes the invitation.
    pub(crate) fn admit(&self, code: &str, ends: Ends) -> Result<String, ApiError> {
        let mut invited = self.invited.lock().unwrap_or_else(PoisonError::into_inner);
        let is_meant = |invitation: &Invitation| invitation.is(code, Instant::now());
        if invited.as_ref().is_some_and(is_meant) && ends.are_of_one_user() {
            *invited = None;
            return Ok(self.page());
        }
        Err(ApiError::Unauthorized(
            "address: expected one that `ralf review --open` gave to a browser of yours just now, found one that was \
             used, is too old or is for somebody else: open the address that `ralf review` printed"
                .into(),
        ))
    }

    /// The path of the page with its token.
    pub(crate) fn page(&self) -> String {
        format!("/?token={}", self.token.digits())
    }

    fn check(&self, path: &str, headers: &HeaderMap) -> Result<(), ApiError> {
        let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("not ASCII"));
        let host = text(header::HOST).unwrap_or("");
        let known = self.hosts.as_ref().is_none_or(|hosts| hosts.hold(host));
        if !known || host.is_empty() {
            let expected = self.hosts.as_ref().map_or("a name of this machine".into(), Hosts::told);
            return Err(ApiError::Forbidden(format!("Host: expected {expected}, found `{host}`")));
        }
        let origin = format!("http://{host}");
        if let Some(found) = text(header::ORIGIN).filter(|found| !found.eq_ignore_ascii_case(&origin)) {
            return Err(ApiError::Forbidden(format!("Origin: expected {origin}, found `{found}`")));
        }
        if !path.starts_with("/api/") {
            return Ok(());
        }
        let site = text(HeaderName::from_static("sec-fetch-site"));
        if let Some(found) = site.filter(|found| !["same-origin", "none"].contains(found)) {
            return Err(ApiError::Forbidden(format!(
                "Sec-Fetch-Site: expected same-origin, found `{found}`"
            )));
        }
        if !self.token.is_in(text(header::AUTHORIZATION).unwrap_or("")) {
            return Err(ApiError::Unauthorized(
                "Authorization: expected `Bearer` and the token of the address that `ralf review` printed, \
                 found another"
                    .into(),
            ));
        }
        self.check_meant(text(HeaderName::from_static("x-ralf-store")))
    }

    /// Refuses who means other corrections: a page that was opened while another server was here.
    fn check_meant(&self, meant: Option<&str>) -> Result<(), ApiError> {
        if meant.is_none_or(|meant| meant == self.served.identity) {
            return Ok(());
        }
        let name = &self.served.name;
        Err(ApiError::Elsewhere(format!("corrections: expected those of the page, found those of {name}")))
    }
}

/// Lets a request pass, or answers it.
pub(crate) async fn guard(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response {
    let mut response = match guard.check(request.uri().path(), request.headers()) {
        Ok(()) => next.run(request).await,
        Err(error) => error.into_response(),
    };
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    headers.entry(header::CACHE_CONTROL).or_insert(HeaderValue::from_static("no-store"));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        let pairs = pairs.iter().map(|(name, value)| (HeaderName::from_static(name), value.parse().unwrap()));
        pairs.collect()
    }

    fn guard(host: &str, address: &str) -> (Guard, String) {
        let token = Token::new().unwrap();
        let bearer = format!("Bearer {}", token.digits());
        let served = Served { identity: "these".into(), name: "out".into() };
        (Guard::new(host, address.parse().unwrap(), token, served), bearer)
    }

    fn passes(guard: &Guard, path: &str, pairs: &[(&'static str, &str)]) -> bool {
        guard.check(path, &headers(pairs)).is_ok()
    }

    #[test]
    fn on_this_machine_the_host_must_be_this_machine() {
        let (guard, bearer) = guard("127.0.0.1", "127.0.0.1:8642");
        let token = ("authorization", bearer.as_str());
        for host in ["127.0.0.1:8642", "localhost:8642", "LOCALHOST:8642", "[::1]:8642"] {
            assert!(passes(&guard, "/api/recording", &[("host", host), token]), "{host}");
        }
        // Forwarded from another port, with `ssh -L`.
        for host in ["127.0.0.1", "localhost:9999", "[::1]"] {
            assert!(passes(&guard, "/api/recording", &[("host", host), token]), "{host}");
            assert!(!passes(&guard, "/api/recording", &[("host", host)]), "{host} without the token");
        }
        for host in ["", ":", "localhost:", "localhost:99999", "localhost:8642:1", "evil.example:8642"] {
            assert!(!passes(&guard, "/", &[("host", host), token]), "{host}");
        }
        assert!(!passes(&guard, "/", &[("host", "localhost.evil.example:8642")]));
        assert!(!passes(&guard, "/", &[]));
    }

    #[test]
    fn on_an_address_that_others_reach_the_port_must_be_its_own() {
        let (guard, _) = guard("radar-host", "192.0.2.7:8642");
        for (host, passed) in [
            ("192.0.2.7:8642", true),
            ("Radar-Host:8642", true),
            ("192.0.2.7:9999", false),
            ("192.0.2.7", false),
            ("localhost:8642", false),
        ] {
            assert_eq!(passes(&guard, "/", &[("host", host)]), passed, "{host}");
        }
    }

    #[test]
    fn other_origins_and_sites_are_refused() {
        let (guard, bearer) = guard("127.0.0.1", "127.0.0.1:80");
        let asked = |path, name, value| {
            passes(&guard, path, &[("host", "localhost"), ("authorization", &bearer), (name, value)])
        };
        assert!(asked("/api/recording", "origin", "http://localhost"));
        // A page of another program on another port of this machine says so here.
        for origin in ["null", "https://localhost", "http://localhost:8000", "http://127.0.0.1"] {
            assert!(!asked("/api/recording", "origin", origin), "{origin}");
        }
        let site = |path, site| asked(path, "sec-fetch-site", site);
        assert!(site("/api/recording", "same-origin") && site("/", "cross-site"));
        assert!(!site("/api/recording", "cross-site") && !site("/api/recording", "same-site"));
    }

    #[test]
    fn the_token_guards_all_but_the_page_itself() {
        for address in ["0.0.0.0:8642", "127.0.0.1:8642"] {
            let (guard, bearer) = guard("0.0.0.0", address);
            let host = ("host", "localhost:8642");
            assert!(passes(&guard, "/assets/page.js", &[host]));
            assert!(!passes(&guard, "/api/recording", &[host]));
            assert!(!passes(&guard, "/api/recording", &[host, ("authorization", "Bearer 0")]));
            let with_token = [host, ("authorization", bearer.as_str())];
            assert!(passes(&guard, "/api/recording", &with_token));
            for (store, passed) in [("these", true), ("others", false), ("", false)] {
                let asked = [&with_token[..], &[("x-ralf-store", store)]].concat();
                assert_eq!(passes(&guard, "/api/recording", &asked), passed, "{store}");
            }
        }
    }
}
