//! `ralf review`: the page where people correct labels.

use crate::arguments::{ChangedArgs, DatasetArgs};
use crate::browser::{self, Detour};
use crate::outcome::Outcome;
use crate::progress::say;
use crate::text::print;
use clap::Args;
use ralf_data::result::read_record;
use ralf_data::team::Assignment;
use ralf_review::{Options, Server};
use std::path::{Path, PathBuf};

/// Where the system keeps the user's name.
const NAMES: [&str; 2] = ["USER", "USERNAME"];

/// Arguments of `ralf review`.
#[derive(Debug, Args)]
#[command(after_help = "\
Every edit is in OUT/corrections.sqlite before the page shows it as saved; machine labels stay as they are, and \
labelling again keeps the corrections. `ralf evaluate` and `ralf tune` read them. The printed address holds a token, \
without which nobody can read or correct anything. Only this machine can open the page, unless --host says otherwise. \
Ctrl-C ends it.

Examples:
  ralf review recordings/city out
  ralf review recordings/city out --sequence 00 --author ada --open
  ralf review recordings/city out --second bob      bob's second labels, in out/second/bob.sqlite
  ralf review recordings/city out --host 0.0.0.0    for others in a network that you trust: it is not encrypted")]
pub(crate) struct ReviewArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// What `ralf label` wrote
    #[arg(value_name = "OUT")]
    out: PathBuf,
    #[command(flatten)]
    changed: ChangedArgs,
    /// Port to listen on, 0 for any free one; the last one of OUT or, where that is not free, 8642 and on
    #[arg(long, value_name = "P")]
    port: Option<u16>,
    /// Address to listen on
    #[arg(long, value_name = "H", default_value = "127.0.0.1")]
    host: String,
    /// What people are called who give no name in the page; the user's name if not given
    #[arg(long, value_name = "NAME", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    author: Option<String>,
    /// Label a second time, in a file of your own, without seeing what others said; the scans that `ralf assign` dealt
    /// to NAME, which is one of those in OUT/team.toml, where there is one
    #[arg(long, value_name = "NAME", conflicts_with = "author")]
    second: Option<String>,
    /// Open the page in the browser
    #[arg(long)]
    open: bool,
}

/// Serves the page until Ctrl-C.
pub(crate) fn run(arguments: &ReviewArgs) -> anyhow::Result<Outcome> {
    let recording = arguments.dataset.open_labelled(&arguments.out, &arguments.changed)?;
    let options = Options {
        host: arguments.host.clone(),
        port: arguments.port,
        author: arguments.author(),
        second: arguments.second.clone(),
        token_folder: token_folder(),
    };
    let server = Server::bind(recording, &arguments.out, &options)?;
    tell_waiting(&arguments.out)?;
    let urls = server.urls();
    for url in &urls {
        print(url)?;
    }
    if urls.len() > 1 {
        say("the first address is for this machine, the others are for other machines that can reach it");
    }
    match server.read_only() {
        Some(reason) => say(&format!("read-only, nothing can be corrected: {reason}")),
        None if arguments.second.is_some() => {
            say("second labels: nobody else's are shown; Ctrl-C ends the review")
        }
        None => say("Ctrl-C ends the review; every edit is on disk when the page shows it as saved"),
    }
    let invitation = arguments.open.then(|| server.invitation()).transpose()?.flatten();
    // It may be opened as long as the review goes on.
    let _detour = urls.first().filter(|_| arguments.open).and_then(|url| open_browser(url, invitation));
    server.run()?;
    Ok(Outcome::Done)
}

/// Says which sequences were dealt and aren't labelled at the moment.
fn tell_waiting(out: &Path) -> anyhow::Result<()> {
    let labelled = read_record(out)?.sequences;
    let dealt = Assignment::open(out, &labelled)?;
    dealt.and_then(|dealt| dealt.told_waiting(out, &labelled)).iter().for_each(|sentence| say(sentence));
    Ok(())
}

impl ReviewArgs {
    fn author(&self) -> String {
        let known = || NAMES.iter().find_map(|name| std::env::var(name).ok().filter(|user| !user.is_empty()));
        self.author.clone().or_else(known).unwrap_or_else(|| "anonymous".to_owned())
    }
}

/// Where programs keep what is the user's own and nobody else's; `None` where the system names no such place.
fn token_folder() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|folder| folder.is_absolute());
    let state = folder("XDG_STATE_HOME").or_else(|| folder("LOCALAPPDATA"));
    let state = state.or_else(|| Some(folder("HOME")?.join(".local").join("state")));
    Some(state?.join("ralf").join("review"))
}

/// Asks the system to open an address: by an invitation, else by a page that leads there and that is no longer needed
/// when the review ends. Browsers in a sandbox can't read such a page. The review goes on where nothing can be opened.
fn open_browser(url: &str, invitation: Option<String>) -> Option<Detour> {
    let opened = match invitation {
        Some(invitation) => browser::open(invitation.as_ref()).map(|()| None),
        None => {
            Detour::to(url).and_then(|detour| browser::open(detour.page().as_ref()).map(|()| Some(detour)))
        }
    };
    opened
        .inspect_err(|error| say(&format!("no browser could be opened ({error}): open {url} yourself")))
        .ok()
        .flatten()
}
