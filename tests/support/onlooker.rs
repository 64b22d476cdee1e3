//! A viewer as the live view's server sees it, HTTP/2 by hand: it can behave as badly as no real one means to.

use std::io::{Read, Result, Write};
use std::net::TcpStream;

/// What every connection begins with.
const PREFACE: &[u8] = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
/// Kinds of frames.
const DATA: u8 = 0;
const HEADERS: u8 = 1;
const SETTINGS: u8 = 4;
const WINDOW: u8 = 8;
/// The last frame of a request, and the last one of its headers.
const END_STREAM: u8 = 1;
const END_HEADERS: u8 = 4;
/// The largest window: who has it is sent everything, whether it reads or not.
const WINDOW_MAX: u32 = (1 << 31) - 1;
/// The window that a connection begins with.
const WINDOW_FIRST: u32 = (1 << 16) - 1;

/// A viewer that has asked for all that there is and will be.
pub struct Onlooker(TcpStream);

impl Onlooker {
    /// Asks the server on a port of this machine.
    pub fn attach(port: u16) -> Result<Self> {
        let mut stream = TcpStream::connect(("127.0.0.1", port))?;
        let mut request = PREFACE.to_vec();
        // Setting 4 is the window of each stream.
        let window = [&[0, 4][..], &WINDOW_MAX.to_be_bytes()].concat();
        request.extend(frame(SETTINGS, 0, 0, &window));
        request.extend(frame(WINDOW, 0, 0, &(WINDOW_MAX - WINDOW_FIRST).to_be_bytes()));
        let headers = [
            (":method", "POST"),
            (":scheme", "http"),
            (":path", "/rerun.sdk_comms.v1alpha1.MessageProxyService/ReadMessages"),
            (":authority", "127.0.0.1"),
            ("content-type", "application/grpc"),
            ("te", "trailers"),
        ];
        let headers: Vec<u8> = headers.into_iter().flat_map(header).collect();
        request.extend(frame(HEADERS, END_HEADERS, 1, &headers));
        // A message that is not compressed and has no fields.
        request.extend(frame(DATA, END_STREAM, 1, &[0; 5]));
        stream.write_all(&request)?;
        Ok(Self(stream))
    }

    /// Waits for something, and takes so many bytes of it at most; none if the server has ended.
    pub fn read(&mut self, most: usize) -> Result<Vec<u8>> {
        let mut bytes = vec![0; most];
        let count = self.0.read(&mut bytes)?;
        bytes.truncate(count);
        Ok(bytes)
    }
}

/// The port of an address that the program tells.
pub fn port_of(text: &str) -> Option<u16> {
    let (_, address) = text.split_once("rerun+http://")?;
    let (_, port) = address.split_once("/proxy")?.0.rsplit_once(':')?;
    port.parse().ok()
}

fn frame(kind: u8, flags: u8, stream: u32, payload: &[u8]) -> Vec<u8> {
    let length = (payload.len() as u32).to_be_bytes();
    [&length[1..], &[kind, flags], &stream.to_be_bytes(), payload].concat()
}

/// A header as it is, neither indexed nor compressed.
fn header((name, value): (&str, &str)) -> Vec<u8> {
    let text = |text: &str| [&[text.len() as u8][..], text.as_bytes()].concat();
    [vec![0], text(name), text(value)].concat()
}
