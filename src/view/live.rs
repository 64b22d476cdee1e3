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
    Ok((sink, Server { address, _claim: claim }))
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
