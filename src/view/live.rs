//! A recording is served while it is made.

use super::{APPLICATION, ViewError};
use rerun::grpc_server::GrpcServerSink;
use rerun::{MemoryLimit, ServerOptions};
use std::io::ErrorKind;
use std::net::{IpAddr, Ipv4Addr, TcpListener};
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixDatagram};

/// How a recording is served while it is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Live {
    /// The address of this machine that it is served on. There is no password: whoever reaches the address
    /// sees the recording, and can show something else to the others who watch. The file is out of their reach.
    pub address: IpAddr,
    /// The port that is tried first.
    pub port: u16,
    /// How much is kept for those who come late; the oldest is dropped first.
    pub memory_limit_bytes: u64,
}

impl Default for Live {
    /// For this machine alone, on Rerun's own port, so that `rerun --connect` finds it, and with 1 GiB.
    fn default() -> Self {
        Self {
            address: Ipv4Addr::LOCALHOST.into(),
            port: rerun::DEFAULT_SERVER_PORT,
            memory_limit_bytes: 1 << 30,
        }
    }
}

/// How many ports are tried.
const PORTS: u16 = 32;

/// Where a recording is served.
pub(super) struct Server {
    /// What to give to a viewer on this machine.
    pub address: String,
    /// Its port, which may be another one than was asked for.
    pub port: u16,
    // Held open: it keeps the other runs of this machine from the port.
    _claim: UnixDatagram,
}

/// A server on the first free port from the wanted one on.
pub(super) fn serve(live: Live) -> Result<(GrpcServerSink, Server), ViewError> {
    let (port, claim) = free_port(live)?;
    let options = ServerOptions {
        memory_limit: MemoryLimit::from_bytes(live.memory_limit_bytes),
        ..Default::default()
    };
    // Rerun puts a port behind it.
    let address = match live.address {
        IpAddr::V4(address) => address.to_string(),
        IpAddr::V6(address) => format!("[{address}]"),
    };
    let sink = GrpcServerSink::new(&address, port, options).expect("it is an address");
    let address = sink.uri().to_string();
    Ok((sink, Server { address, port, _claim: claim }))
}

fn free_port(Live { address, port: first, .. }: Live) -> Result<(u16, UnixDatagram), ViewError> {
    let last = first.saturating_add(PORTS - 1);
    for port in first..=last {
        let Some(claim) = claim(port) else { continue };
        match TcpListener::bind((address, port)) {
            Ok(_) => return Ok((port, claim)),
            Err(error) if error.kind() == ErrorKind::AddrInUse => {}
            Err(source) => return Err(ViewError::Serve { address, source }),
        }
    }
    Err(ViewError::NoFreePort { address, first, last })
}

/// Claims a port. Rerun's server opens it a while later and ends if it is taken by then, so runs that start at
/// once first agree on who has which: by a name that ends with its process.
fn claim(port: u16) -> Option<UnixDatagram> {
    let name = SocketAddr::from_abstract_name(format!("{APPLICATION}-live-{port}")).ok()?;
    UnixDatagram::bind_addr(&name).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_recording_is_served_on_the_address_that_was_asked_for_and_on_no_other() {
        for (address, bound, told) in [
            ("127.0.0.1", "0100007F", "127.0.0.1"),
            ("127.0.0.3", "0300007F", "127.0.0.3"),
            ("0.0.0.0", "00000000", "127.0.0.1"),
        ] {
            let live = Live { address: address.parse().unwrap(), ..Live::default() };
            let (_sink, server) = serve(live).unwrap();
            let told = format!("rerun+http://{told}:");
            let port = server.address.strip_prefix(&told).and_then(|p| p.strip_suffix("/proxy"));
            let port = port.unwrap_or_else(|| panic!("{}", server.address)).parse().unwrap();
            assert_bound(port, bound);
        }
        let default = serve(Live::default()).unwrap().1.address;
        assert!(default.starts_with("rerun+http://127.0.0.1:"), "{default}");
    }

    #[test]
    fn an_address_of_another_machine_is_an_error_that_names_it() {
        // Of the blocks that are for documentation.
        for address in ["192.0.2.77", "2001:db8::77"] {
            let live = Live { address: address.parse().unwrap(), ..Live::default() };
            let error = serve(live).err().unwrap().to_string();
            assert!(error.contains(address), "{error}");
        }
    }

    /// Asserts that a port comes to be listened to on this address, in the kernel's hexadecimal, and on no other.
    fn assert_bound(port: u16, address: &str) {
        let mut found = Vec::new();
        for _ in 0..500 {
            found = listeners(port);
            if found == [address] {
                return;
            }
            // A server opens its port a while later, and one that had it before closes it a while later.
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("port {port} is bound to {found:?}, not {address}");
    }

    fn listeners(port: u16) -> Vec<String> {
        // A row is a number, the local address and port, the remote ones, and the state: here, to listen.
        const LISTEN: &str = "0A";
        let ending = format!(":{port:04X}");
        let sockets = ["/proc/net/tcp", "/proc/net/tcp6"].map(std::fs::read_to_string);
        let sockets = sockets.map(Result::unwrap_or_default).concat();
        let rows = sockets.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        let listening = rows.filter(|row| row.get(3) == Some(&LISTEN));
        listening.filter_map(|row| row[1].strip_suffix(&ending).map(str::to_owned)).collect()
    }
}
