//! The run as a film: champions that walk, curves that climb, in the Rerun viewer.
//!
//! A [`Recorder`] turns what the islands say into a recording, on disk and, if wanted, live. It is made as a [`Draft`]
//! and put in its place when it has everything that the one there has: a recording can be made anew at any time, and
//! the old one is there until then. Read in this order: [`film`] says when a champion is on screen, so that no other
//! need be simulated, [`clip`] what is shown of it, `take` turns its trajectory into columns of rows (`limbs` its
//! links and motors, `steps` its feet, `heading` brings it into its lane), `screen` puts it in its place, [`scenery`]
//! is what never changes, [`track`] where lanes lie, [`ruler`] paints distances on the ground, [`family`] and
//! [`state`] are graphs and bars, `figures` the curves of a replay, [`blueprint`] arranges it all, [`race`] the view
//! of all lanes, `file` writes it, [`live`] serves it, [`recorder`] puts it together, `packing` makes it smaller in
//! the end, and [`palette`] holds every colour.
//!
//! What a recording holds, by entity:
//!
//! ```text
//! /run                             the run card, a text document
//! /islands/{i}                     the island's lane: everything below it stands in it
//! /islands/{i}/ground              a floor that moves on under the champion, for the island's own view
//! /islands/{i}/ruler               distances on it
//! /islands/{i}/follow              where the champion is and how large: the island's view looks from here
//! /islands/{i}/follow/marker       its label, and a shorter one for the view of all islands
//! /islands/{i}/follow/flag
//! /islands/{i}/champion            turns what is below so that it goes along the lane
//! /islands/{i}/champion/boxes      its links as they were simulated, an entity a kind of solid
//! /islands/{i}/champion/cylinders
//! /islands/{i}/champion/capsules   spheres too
//! /islands/{i}/champion/motors     a pin through each driven joint: light or dark as the motor drives
//! /islands/{i}/others/{n}/…        who and what else is in its world, from 1, each as the champion
//! /islands/{i}/trail               the way that its centre of mass came
//! /islands/{i}/contacts            where it touches the ground, and where it did
//! /islands/{i}/prints
//! /race/lanes/{i}                  floors that stay, for the view of all islands
//! /race/ruler                      the start line and the distances on them
//! /race/frame                      how far champions get: that view looks from here
//! /fitness/best/{i}  /fitness/mean/{i}  /diversity/{i}  /population/{i}
//! /state/island-{i}                how the island fares
//! /events/{i}                      what happened, a text log
//! /family                          where the best champion comes from, a graph
//! /topology                        who sends to whom, a graph
//! ```
//!
//! A replay has `/distance/{i}` and `/speed/{i}` instead of a run's curves, a line of ancestors also
//! `/fitness/line` and `/line/follow`, where its view looks from.
//!
//! Timelines are `playback`, the film clock in seconds, and `generation`.
//!
//! Architecture invariant: nothing outside this module knows Rerun, and nothing here decides anything: a
//! run that nobody watches ends with the same bits.

pub mod blueprint;
pub mod card;
pub mod clip;
pub mod draft;
mod extent;
pub mod family;
mod figures;
mod file;
pub mod film;
mod heading;
mod landscape;
mod limbs;
pub mod live;
mod packing;
pub mod palette;
pub mod race;
pub mod recorder;
pub mod ruler;
pub mod scenery;
mod screen;
pub mod state;
mod steps;
mod take;
pub mod track;

#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "a walker of the tests decides no result")]
mod tests;

pub use card::{Lane, Program, RunCard};
pub use clip::Clip;
pub use draft::Draft;
pub use family::Family;
pub use film::{Pace, opens_row};
pub use live::Live;
pub use recorder::Recorder;
pub use state::Mood;

use std::net::IpAddr;
use std::path::PathBuf;

/// The version that a viewer must have to show what is recorded here.
pub const VIEWER_VERSION: &str = "0.36.3";

/// The name of all runs' blueprints: a viewer keeps the user's own arrangement under it.
const APPLICATION: &str = "islands";
/// The film clock, in seconds.
const PLAYBACK: &str = "playback";
/// The generation that something belongs to.
const GENERATION: &str = "generation";

/// Why a run could not be recorded.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The recording could not be made, or not be put in its place.
    #[error("cannot write the recording {}: {source}", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// What the file system said.
        source: std::io::Error,
    },
    /// The live view cannot be served on an address.
    #[error("cannot serve the live view on {address}: {source}")]
    Serve {
        /// The address.
        address: IpAddr,
        /// What the system said.
        source: std::io::Error,
    },
    /// Every port that was tried is in use.
    #[error("no port from {first} to {last} of {address} is free to serve the live view on")]
    NoFreePort {
        /// The address.
        address: IpAddr,
        /// The first port that was tried.
        first: u16,
        /// The last one.
        last: u16,
    },
    /// Rerun refused a message.
    #[error("cannot record: {0}")]
    Record(#[source] Box<rerun::RecordingStreamError>),
    /// What was recorded did not reach the disk.
    #[error("cannot write the recording {}: {message}; is the disk full?", path.display())]
    Flush {
        /// The file.
        path: PathBuf,
        /// What Rerun said.
        message: String,
    },
}

impl From<rerun::RecordingStreamError> for ViewError {
    fn from(error: rerun::RecordingStreamError) -> Self {
        ViewError::Record(Box::new(error))
    }
}

impl From<rerun::SerializationError> for ViewError {
    fn from(error: rerun::SerializationError) -> Self {
        rerun::RecordingStreamError::from(error).into()
    }
}
