//! A run's recording: a file, and a server for those who watch live.

use super::blueprint::{self, Audience};
use super::card::RunCard;
use super::film::Film;
use super::{Clip, GENERATION, PLAYBACK, ViewError, clip, palette, scenery};
use crate::archipelago::island::Report;
use crate::evolution::Spread;
use crate::evolution::population::SPREAD_BARS;
use rerun::grpc_server::GrpcServerSink;
use rerun::sink::{FileSink, LogSink};
use rerun::{
    ApplicationId, BarChart, MemoryLimit, RecordingStream, RecordingStreamBuilder, Scalars,
    ServerOptions, TextLog,
};
use std::net::{Ipv4Addr, TcpListener};
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixDatagram};
use std::path::{Path, PathBuf};

/// How a recording is served while it is made, on this machine only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Live {
    /// The port that is tried first.
    pub port: u16,
    /// How much is kept for those who come late; the oldest is dropped first.
    pub memory_limit_bytes: u64,
}

impl Default for Live {
    /// Rerun's own port, so that `rerun --connect` finds it, and 1 GiB.
    fn default() -> Self {
        Self { port: rerun::DEFAULT_SERVER_PORT, memory_limit_bytes: 1 << 30 }
    }
}

/// A bar of a histogram is at least so wide, in the unit of fitness: equal scores need a bar too.
const BAR_WIDTH_MIN: f64 = 1e-6;
/// How many ports are tried.
const PORTS: u16 = 32;
/// The name of all runs' blueprints: a viewer keeps the user's own arrangement under it.
const APPLICATION: &str = "islands";

/// Writes a run's recording.
pub struct Recorder {
    stream: RecordingStream,
    film: Film,
    path: PathBuf,
    server: Option<Served>,
}

/// Where a recording is served.
struct Served {
    address: String,
    // Held open: it keeps the other runs of this machine from the port.
    _claim: UnixDatagram,
}

impl Recorder {
    /// Opens a recording at `path`, overwriting what is there, and serves it live if wanted.
    pub fn create(path: &Path, live: Option<Live>, card: RunCard) -> Result<Self, ViewError> {
        let application = ApplicationId::from(APPLICATION);
        let file = FileSink::new(path)
            .map_err(|source| ViewError::Create { path: path.to_owned(), source: source.into() })?;
        let (sink, server) = live.map(serve).transpose()?.unzip();

        let mut sinks: Vec<(Audience, Box<dyn LogSink>)> = vec![(Audience::File, Box::new(file))];
        sinks.extend(sink.map(|sink| (Audience::Live, Box::new(sink) as Box<dyn LogSink>)));
        // Rerun's switch RERUN=off turns everything off, and it cannot build a blueprint then.
        let on = rerun::decide_logging_enabled(true);
        for (audience, sink) in sinks.iter().filter(|_| on) {
            let (messages, activation) = blueprint::messages(&application, &card, *audience)?;
            sink.send_blueprint(messages, activation);
        }
        let sinks: Vec<_> = sinks.into_iter().map(|(_, sink)| sink).collect();
        let stream = RecordingStreamBuilder::new(application).enabled(on).set_sinks(sinks)?;
        // The wall clock has no place in a film.
        stream.set_log_time_enabled(false);
        stream.set_log_tick_enabled(false);
        scenery::build(&stream, &card)?;
        let film = Film::new(card.islands, card.pace);
        Ok(Self { stream, film, path: path.to_owned(), server })
    }

    /// What to give to a viewer to watch live: `rerun ADDRESS`.
    pub fn address(&self) -> Option<String> {
        self.server.as_ref().map(|server| server.address.clone())
    }

    /// One generation of one island: its figures, and the champion if it is time to show it. Report each
    /// island's generations in their order, and a generation's champion before it.
    pub fn report(&mut self, report: &Report) -> Result<(), ViewError> {
        let Report { island, generation, statistics, .. } = *report;
        self.film.reached(island, generation);
        self.stamp(generation);
        let figures = [
            ("fitness/best", statistics.best.finite()),
            ("fitness/mean", statistics.mean.finite()),
            ("diversity", Some(statistics.diversity)),
        ];
        for (metric, value) in figures {
            if let Some(value) = value {
                self.stream.log(format!("{metric}/{island}"), &Scalars::single(value))?;
            }
        }
        self.stream.log(format!("population/{island}"), &histogram(island, &statistics.spread))?;
        self.roll(island)
    }

    /// An island has a new champion. It is shown in the next slot of the film that opens; one that is
    /// replaced before is never seen.
    pub fn champion(&mut self, clip: &Clip) -> Result<(), ViewError> {
        self.film.champion(clip.clone());
        self.roll(clip.island)
    }

    /// Something happened in a generation, on an island or to the run.
    pub fn event(
        &mut self,
        island: Option<u32>,
        generation: u32,
        text: &str,
    ) -> Result<(), ViewError> {
        self.stamp(generation);
        let color = island.map_or(palette::MARKS, palette::island);
        let line = TextLog::new(text).with_level("INFO").with_color(palette::opaque(color));
        Ok(self.stream.log("events", &line)?)
    }

    /// Waits until everything is written. Only here a full disk is noticed: call it now and then.
    pub fn flush(&self) -> Result<(), ViewError> {
        self.stream
            .flush_blocking()
            .map_err(|e| ViewError::Flush { path: self.path.clone(), message: e.to_string() })
    }

    /// Shows the champions that came after the last slot had opened, and ends all islands' films at the
    /// same time. A recorder that is dropped without this leaves a whole file with less in it.
    pub fn finish(mut self) -> Result<(), ViewError> {
        self.film.end();
        for island in 0..self.film.islands() {
            self.roll(island)?;
        }
        self.flush()
    }

    /// Shows what is due.
    fn roll(&mut self, island: u32) -> Result<(), ViewError> {
        let slot_s = self.film.pace().slot_s;
        while let Some(screening) = self.film.next(island) {
            clip::show(&self.stream, screening, slot_s)?;
        }
        Ok(())
    }

    fn stamp(&self, generation: u32) {
        self.stream.set_duration_secs(PLAYBACK, self.film.pace().film_s(generation));
        self.stream.set_time_sequence(GENERATION, generation);
    }
}

/// A server on the first free port from the wanted one on.
fn serve(live: Live) -> Result<(GrpcServerSink, Served), ViewError> {
    let last = live.port.saturating_add(PORTS - 1);
    let free = |port| Some((port, claim(port)?));
    let (port, claim) = (live.port..=last)
        .find_map(free)
        .ok_or(ViewError::NoFreePort { first: live.port, last })?;
    let options = ServerOptions {
        memory_limit: MemoryLimit::from_bytes(live.memory_limit_bytes),
        ..Default::default()
    };
    let address = Ipv4Addr::LOCALHOST.to_string();
    let sink = GrpcServerSink::new(&address, port, options).expect("an address of this machine");
    let address = sink.uri().to_string();
    Ok((sink, Served { address, _claim: claim }))
}

/// Claims a port that nobody uses. Rerun's server opens it a while later and ends if it is taken by then, so
/// runs that start at once first agree on who has which: by a name that ends with its process.
fn claim(port: u16) -> Option<UnixDatagram> {
    let name = SocketAddr::from_abstract_name(format!("{APPLICATION}-live-{port}")).ok()?;
    let claim = UnixDatagram::bind_addr(&name).ok()?;
    TcpListener::bind((Ipv4Addr::LOCALHOST, port)).is_ok().then_some(claim)
}

fn histogram(island: u32, spread: &Spread) -> BarChart {
    let width = ((spread.high - spread.low) / SPREAD_BARS as f64).max(BAR_WIDTH_MIN);
    let middles = (0..SPREAD_BARS).map(|bar| spread.low + (bar as f64 + 0.5) * width);
    BarChart::new(spread.counts.map(f64::from).to_vec())
        .with_abscissa(middles.collect::<Vec<_>>())
        .with_widths([width as f32; SPREAD_BARS])
        .with_color(palette::opaque(palette::island(island)))
}
