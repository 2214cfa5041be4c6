//! Whose browser it is that asks: Linux tells the owner of every connection on this machine.

use std::fs;
use std::io;
use std::net::{IpAddr, SocketAddr};
use tokio::net::TcpStream;

/// The tables of connections: a line each, with addresses, state and the user's number.
const TABLES: [&str; 2] = ["/proc/net/tcp", "/proc/net/tcp6"];
/// The state of a connection whose ends are both open; others have no owner that counts.
const ESTABLISHED: &str = "01";
/// Root can read the token wherever it lies.
const ROOT: u32 = 0;
/// Stands for all users whom the system doesn't name here (`/proc/sys/kernel/overflowuid`).
const UNNAMED: u32 = 65_534;

/// The two ends of a connection.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ends {
    here: SocketAddr,
    there: SocketAddr,
}

impl Ends {
    pub(crate) fn of(stream: &TcpStream) -> io::Result<Self> {
        let canonical = |end: SocketAddr| SocketAddr::new(end.ip().to_canonical(), end.port());
        Ok(Self { here: canonical(stream.local_addr()?), there: canonical(stream.peer_addr()?) })
    }

    /// Whether the system tells owners.
    pub(crate) fn are_told() -> bool {
        cfg!(target_os = "linux") && fs::read(TABLES[0]).is_ok()
    }

    /// Whether the connection comes from a program of the user who runs this one, on this machine. Whoever can't be
    /// told is somebody else.
    pub(crate) fn are_of_one_user(self) -> bool {
        let tables = TABLES.map(|table| fs::read_to_string(table).unwrap_or_default());
        cfg!(target_os = "linux") && self.are_of_one_user_by(&tables.concat())
    }

    fn are_of_one_user_by(self, tables: &str) -> bool {
        let owner = |from, to| tables.lines().find_map(|line| owner_of(line, from, to));
        match (owner(self.here, self.there), owner(self.there, self.here)) {
            (Some(own), Some(other)) => other == ROOT || other == own && own != UNNAMED,
            _ => false,
        }
    }
}

/// Who owns the end of a connection that leads from there to there, if that is what the line is about.
fn owner_of(line: &str, from: SocketAddr, to: SocketAddr) -> Option<u32> {
    let mut fields = line.split_whitespace().skip(1);
    let is_meant = address(fields.next()?)? == from && address(fields.next()?)? == to;
    (is_meant && fields.next()? == ESTABLISHED).then(|| fields.nth(3)?.parse().ok())?
}

/// `0100007F:1F90` is 127.0.0.1:8080 where the lowest byte comes first: words of four bytes, as they lie in memory.
fn address(text: &str) -> Option<SocketAddr> {
    let (ip, port) = text.split_once(':')?;
    let word =
        |digits: &[u8]| u32::from_str_radix(str::from_utf8(digits).ok()?, 16).ok().map(u32::to_ne_bytes);
    let words: Vec<[u8; 4]> = ip.as_bytes().chunks(8).map(word).collect::<Option<_>>()?;
    let ip = match words.as_flattened() {
        bytes if bytes.len() == 4 => IpAddr::from(<[u8; 4]>::try_from(bytes).ok()?),
        bytes => IpAddr::from(<[u8; 16]>::try_from(bytes).ok()?).to_canonical(),
    };
    Some(SocketAddr::new(ip, u16::from_str_radix(port, 16).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::{Ipv4Addr, Ipv6Addr};

    /// The table's text of an address.
    fn told(end: &str) -> String {
        let end: SocketAddr = end.parse().unwrap();
        let words = match end.ip() {
            IpAddr::V4(ip) => ip.octets().to_vec(),
            IpAddr::V6(ip) => ip.octets().to_vec(),
        };
        let words = words.as_chunks().0.iter().map(|word| format!("{:08X}", u32::from_ne_bytes(*word)));
        format!("{}:{:04X}", words.collect::<String>(), end.port())
    }

    fn line(from: &str, to: &str, state: &str, user: u32) -> String {
        let [from, to] = [from, to].map(told);
        format!(
            "   7: {from} {to} {state} 00000000:00000000 00:00000000 00000000  {user}        0 4711 1 0\n"
        )
    }

    const HEAD: &str =
        "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode\n";
    const HERE: &str = "127.0.0.1:8642";
    const THERE: &str = "127.0.0.1:50000";

    fn is_one_user(lines: &[String]) -> bool {
        let [here, there] = [HERE, THERE].map(|end| end.parse().unwrap());
        Ends { here, there }.are_of_one_user_by(&format!("{HEAD}{}", lines.concat()))
    }

    #[test]
    fn only_the_same_user_or_root_on_this_machine_is_let_in() {
        let own = line(HERE, THERE, "01", 1000);
        let listening = line(HERE, "0.0.0.0:0", "0A", 1000);
        for (user, passed) in [(1000, true), (0, true), (1001, false), (UNNAMED, false)] {
            let lines = [listening.clone(), own.clone(), line(THERE, HERE, "01", user)];
            assert_eq!(is_one_user(&lines), passed, "{user}");
        }
        assert!(!is_one_user(std::slice::from_ref(&own)), "from another machine");
        assert!(!is_one_user(&[own.clone(), line(THERE, HERE, "06", 0)]), "closed: that is nobody's");
        assert!(!is_one_user(&[own, line("127.0.0.1:50001", HERE, "01", 1000)]), "another connection");
        assert!(!is_one_user(&[line(HERE, THERE, "01", UNNAMED), line(THERE, HERE, "01", UNNAMED)]));
        assert!(!is_one_user(&["   7: x y 01\n".to_owned(), "7: 0:0:0 1\n".to_owned(), "\n".to_owned()]));
    }

    #[test]
    fn a_server_of_both_families_has_its_own_end_among_the_longer_addresses() {
        let own = line("[::ffff:127.0.0.1]:8642", "[::ffff:127.0.0.1]:50000", "01", 1000);
        assert!(is_one_user(&[line(THERE, HERE, "01", 1000), own]));
        let loopback = told("[::1]:1");
        assert_eq!(address(&loopback), Some(SocketAddr::new(Ipv6Addr::LOCALHOST.into(), 1)));
        assert_eq!(address(&told("127.0.0.1:1")), Some(SocketAddr::new(Ipv4Addr::LOCALHOST.into(), 1)));
    }
}
