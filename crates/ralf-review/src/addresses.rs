//! Under which addresses a server can be reached.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

/// Names with ports as a browser takes them, of a server that listens at `address`, which was asked for by the
/// name `host`. The first is good on this machine; where it listens on all addresses the others are good on
/// other machines.
pub(crate) fn reachable(host: &str, address: SocketAddr) -> Vec<String> {
    let port = address.port();
    if !address.ip().is_unspecified() {
        let is_name =
            host.parse::<IpAddr>().is_err() && !host.starts_with('[') && !address.ip().is_loopback();
        return vec![if is_name { format!("{host}:{port}") } else { address.to_string() }];
    }
    let here: IpAddr = match address.ip() {
        IpAddr::V4(_) => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(_) => Ipv6Addr::LOCALHOST.into(),
    };
    let interfaces = if_addrs::get_if_addrs().unwrap_or_default();
    let mut others: Vec<IpAddr> = interfaces.iter().map(if_addrs::Interface::ip).collect();
    others.retain(|other| is_for_others(*other) && (other.is_ipv4() || address.is_ipv6()));
    others.sort();
    others.dedup();
    [here].into_iter().chain(others).map(|ip| SocketAddr::new(ip, port).to_string()).collect()
}

/// Whether another machine can open it in a browser; addresses that need the name of an interface can't be typed there.
fn is_for_others(ip: IpAddr) -> bool {
    let is_link_local = match ip {
        IpAddr::V4(ip) => ip.is_link_local(),
        IpAddr::V6(ip) => ip.is_unicast_link_local(),
    };
    !ip.is_loopback() && !ip.is_unspecified() && !ip.is_multicast() && !is_link_local
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_for_all_is_told_as_addresses_that_can_be_opened() {
        let told = reachable("0.0.0.0", "0.0.0.0:8642".parse().unwrap());
        assert_eq!(told[0], "127.0.0.1:8642");
        for address in &told {
            let address: SocketAddr = address.parse().unwrap();
            assert!(!address.ip().is_unspecified() && address.port() == 8642, "{address}");
        }
        for address in &told[1..] {
            assert!(is_for_others(address.parse::<SocketAddr>().unwrap().ip()), "{address}");
        }
        assert_eq!(reachable("::", "[::]:80".parse().unwrap())[0], "[::1]:80");
    }

    #[test]
    fn one_address_is_told_by_its_name() {
        assert_eq!(reachable("127.0.0.1", "127.0.0.1:80".parse().unwrap()), ["127.0.0.1:80"]);
        assert_eq!(reachable("localhost", "127.0.0.1:80".parse().unwrap()), ["127.0.0.1:80"]);
        assert_eq!(reachable("radar-pc", "10.0.0.7:80".parse().unwrap()), ["radar-pc:80"]);
        assert_eq!(reachable("[::1]", "[::1]:80".parse().unwrap()), ["[::1]:80"]);
    }
}
