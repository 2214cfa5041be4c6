//! Who may ask, and for what.

use crate::support::{CAMERA, Out, RADAR, SEQUENCE, Serving, recording, stroke};
use ralf_review::{MAX_BODY, Options, Server};
use std::net::TcpListener;

#[test]
fn every_answer_forbids_the_network() {
    let out = Out::new();
    let server = out.serve();
    let missing = format!("/api/sequences/{SEQUENCE}/radars/{RADAR}/scans/99");
    for path in ["/", "/api/recording", "/nowhere", "/api/nowhere", &missing] {
        let headers = server.get(path).headers;
        let policy = &headers["content-security-policy"];
        assert!(
            policy.starts_with("default-src 'none'; script-src 'self'; style-src 'self';"),
            "{path}: {policy}"
        );
        assert_eq!(headers["x-content-type-options"], "nosniff");
        assert_eq!(headers["referrer-policy"], "no-referrer");
        assert_eq!(headers["cross-origin-resource-policy"], "same-origin");
        assert_eq!(headers["cache-control"], "no-store");
        assert!(!headers.contains_key("access-control-allow-origin"));
    }
    let page = server.get("/");
    assert_eq!((page.status, page.headers["content-type"].as_str()), (200, "text/html; charset=utf-8"));
    assert!(String::from_utf8(page.body).unwrap().to_lowercase().contains("<!doctype html>"));
}

#[test]
fn other_hosts_and_origins_are_refused() {
    let out = Out::new();
    let server = out.serve();
    let port = server.port();
    let asked = |head: &[(&str, &str)]| server.ask("GET", "/api/recording", head, &[]);
    let [local, evil] = ["localhost", "evil.example"].map(|host| format!("{host}:{port}"));
    assert_eq!(asked(&[("Host", &local)]).status, 200);
    assert!(asked(&[("Host", &evil)]).refused(403).contains("evil.example"));
    assert!(asked(&[("Origin", "http://evil.example")]).refused(403).contains("Origin"));
    assert!(asked(&[("Origin", "null")]).refused(403).contains("Origin"));
    assert!(asked(&[("Sec-Fetch-Site", "cross-site")]).refused(403).contains("Sec-Fetch-Site"));
    assert_eq!(asked(&[("Origin", &format!("http://127.0.0.1:{port}"))]).status, 200);
    let head = [("Content-Type", "application/json"), ("Origin", "http://evil.example")];
    let body = stroke(1, 0, Some(99), &[0]).to_string();
    let path = format!("/api/sequences/{SEQUENCE}/strokes");
    assert!(server.ask("POST", &path, &head, body.as_bytes()).refused(403).contains("Origin"));
    assert_eq!(server.table(1).header["revision"], 0);
}

#[test]
fn nobody_reads_or_writes_without_the_token_not_even_on_this_machine() {
    for host in ["127.0.0.1", "0.0.0.0"] {
        let out = Out::new();
        let server = Serving::of(out.path(), host, "ada").unwrap();
        let token = server.token();
        assert_eq!(token.len(), 32);
        let other = Serving::of(out.path(), host, "ada").unwrap();
        assert_ne!(other.token(), token);
        let with = |path: &str, value: &str| server.ask("GET", path, &[("Authorization", value)], &[]);
        assert_eq!(with("/", "").status, 200, "the page itself is no secret");
        for wrong in ["", &format!("Bearer {}", &token[..31]), &format!("Bearer {}", other.token())] {
            assert!(with("/api/recording", wrong).refused(401).contains("Authorization"));
            let asked = format!("/api/recording?token={token}");
            assert!(with(&asked, wrong).refused(401).contains("Authorization"));
        }
        assert_eq!(with("/api/recording", &format!("Bearer {token}")).status, 200);
        let head = [("Content-Type", "application/json"), ("Authorization", "")];
        let body = stroke(1, 0, Some(99), &[0]).to_string();
        let path = format!("/api/sequences/{SEQUENCE}/strokes");
        server.ask("POST", &path, &head, body.as_bytes()).refused(401);
        assert_eq!(server.table(1).header["revision"], 0);
    }
}

#[test]
fn a_server_that_is_started_again_keeps_its_token() {
    let out = Out::new();
    let kept = tempfile::tempdir().unwrap();
    let bind = || {
        let token_folder = Some(kept.path().to_owned());
        let options = Options {
            host: "127.0.0.1".into(),
            port: Some(0),
            author: "ada".into(),
            token_folder,
            ..Options::default()
        };
        Server::bind(recording(), out.path(), &options).unwrap().urls()[0]
            .split_once("token=")
            .unwrap()
            .1
            .to_owned()
    };
    assert_eq!(bind(), bind());
}

#[test]
fn a_server_that_is_started_again_is_where_it_was() {
    let (out, other) = (Out::new(), Out::new());
    let kept = tempfile::tempdir().unwrap();
    let bind = |out: &Out, second: Option<&str>, port| {
        let options = Options {
            host: "127.0.0.1".into(),
            port,
            second: second.map(str::to_owned),
            token_folder: Some(kept.path().to_owned()),
            ..Options::default()
        };
        let server = Server::bind(recording(), out.path(), &options).unwrap();
        let address = server.urls()[0].split("/?").next().unwrap().to_owned();
        (server, address)
    };
    let (first, at) = bind(&out, None, Some(0));
    // Taken now; and not remembered of other corrections.
    assert_ne!(bind(&out, Some("bob"), None).1, at);
    drop(first);
    for (out, second) in [(&out, Some("bob")), (&other, None)] {
        assert_ne!(bind(out, second, None).1, at);
    }
    let (again, address) = bind(&out, None, None);
    assert_eq!(address, at);
    assert_ne!(bind(&out, None, None).1, at, "somebody has it");
    drop(again);
}

/// The name of the corrections that are served.
fn store(server: &Serving) -> String {
    server.get("/api/recording").json()["store"].as_str().unwrap().to_owned()
}

#[test]
fn what_a_page_of_other_corrections_asks_for_is_refused() {
    let out = Out::new();
    let first = out.serve();
    let own = store(&first);
    first.stroke(1, 0, Some(99), &[0]).json();
    first.end();
    // The same folder once more: its corrections have the same name of their own.
    let copied = Out::copy_of(out.path());
    let others = [Serving::second(out.path(), "bob").unwrap(), copied.serve()];
    let path = format!("/api/sequences/{SEQUENCE}/strokes");
    for (server, name) in others.iter().zip(["second labels of bob", "`"]) {
        assert_ne!(store(server), own);
        let asked = |revision: u64, store: &str| {
            let head = [("Content-Type", "application/json"), ("X-Ralf-Store", store)];
            let body = stroke(1, revision, Some(99), &[1]).to_string();
            server.ask("POST", &path, &head, body.as_bytes())
        };
        let revision = server.table(1).header["revision"].as_u64().unwrap();
        let sentence = asked(revision, &own).refused(412);
        assert!(
            sentence.starts_with("corrections: expected those of the page, found those of `"),
            "{sentence}"
        );
        assert!(sentence.ends_with(name), "{sentence}");
        assert_eq!(server.ask("GET", "/api/recording", &[("X-Ralf-Store", &own)], &[]).status, 412);
        assert_eq!(server.table(1).header["revision"], revision, "nothing was written");
        asked(revision, &store(server)).json();
    }
    assert_eq!(store(&out.serve()), own, "served again, they are the same");
}

#[test]
fn nothing_but_the_recording_can_be_read() {
    let out = Out::new();
    let server = out.serve();
    let up = "..%2F..%2F..%2F..%2Fetc%2Fpasswd";
    for path in [
        "/../../../../etc/passwd".to_owned(),
        format!("/{up}"),
        format!("/assets/{up}"),
        format!("/api/sequences/{up}/queue"),
        format!("/api/sequences/{SEQUENCE}/cameras/{up}/images/0"),
        format!("/api/sequences/{SEQUENCE}/cameras/{CAMERA}/images/{up}"),
        format!("/api/sequences/{SEQUENCE}/cameras/{CAMERA}/images/-1"),
        format!("/api/sequences/{SEQUENCE}/cameras/{CAMERA}/images/99999999999999999999"),
        format!("/api/sequences/{SEQUENCE}/radars/%FF/scans/0"),
        format!("/api/sequences/{SEQUENCE}/radars/{RADAR}/scans/3"),
        "/api/sequences/other/queue".to_owned(),
    ] {
        let reply = server.get(&path);
        assert!(reply.status == 404 || reply.status == 400, "{path}: {}", reply.status);
        assert!(!reply.refused(reply.status).is_empty());
    }
}

#[test]
fn large_bodies_and_other_methods_are_refused() {
    let out = Out::new();
    let server = out.serve();
    let path = format!("/api/sequences/{SEQUENCE}/strokes");
    let length = (MAX_BODY + 1).to_string();
    let head = [("Content-Type", "application/json"), ("Content-Length", &length)];
    let error = server.ask("POST", &path, &head, b"{}").refused(413);
    assert!(error.contains(&MAX_BODY.to_string()), "{error}");
    for (method, path) in [("POST", "/api/recording"), ("DELETE", &path), ("GET", &path), ("POST", "/")] {
        server.ask(method, path, &[], &[]).refused(405);
    }
}

#[test]
fn a_port_in_use_is_told_and_without_one_the_next_free_one_is_taken() {
    let out = Out::new();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let bind = |host: &str, port| {
        let options = Options { host: host.into(), port, author: "ada".into(), ..Options::default() };
        Server::bind(recording(), out.path(), &options)
    };
    let error = bind("127.0.0.1", Some(port)).err().unwrap().to_string();
    assert!(error.starts_with(&format!("127.0.0.1:{port}: expected a free port")), "{error}");
    let [first, second] = [(); 2].map(|()| bind("127.0.0.1", None).unwrap());
    let address = |server: &Server| server.urls()[0].split("/?").next().unwrap().to_owned();
    assert_ne!(address(&first), address(&second));
    let error = bind("no such host", None).err().unwrap().to_string();
    assert!(
        error.starts_with("--host: expected an address of this machine, found `no such host`"),
        "{error}"
    );
}

#[test]
fn without_labels_there_is_nothing_to_review() {
    let folder = tempfile::tempdir().unwrap();
    let error = Serving::of(folder.path(), "127.0.0.1", "ada").err().unwrap().to_string();
    assert!(error.contains("run.json: expected the record of a finished `ralf label`"), "{error}");
    assert!(!folder.path().join("corrections.sqlite").exists());
    let out = Out::new();
    std::fs::write(out.path().join("corrections.sqlite"), "notes ".repeat(200)).unwrap();
    let error = Serving::of(out.path(), "127.0.0.1", "ada").err().unwrap().to_string();
    assert!(error.contains("expected a whole SQLite database of corrections"), "{error}");
    let out = Out::new();
    std::fs::remove_file(out.parquet()).unwrap();
    let server = out.serve();
    assert_eq!(server.get("/api/recording").json()["sequences"][0]["labelled"], false);
    assert!(server.of_sequence("queue").refused(404).contains("expected a result of `ralf label`"));
}
