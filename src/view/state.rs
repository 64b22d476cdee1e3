//! How an island fares, in a word.

use super::card::RunCard;
use super::{ViewError, palette};
use rerun::{RecordingStream, StateChange, StateConfiguration};
use strum::VariantArray;

/// How an island fares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantArray)]
pub enum Mood {
    /// It bred a better champion.
    Improves,
    /// An immigrant became its champion.
    IsConquered,
    /// It has had no better champion for a while.
    Stagnates,
}

impl Mood {
    fn word(self) -> &'static str {
        match self {
            Mood::Improves => "improves",
            Mood::IsConquered => "led by an immigrant",
            Mood::Stagnates => "stagnates",
        }
    }

    /// The same for all islands: here colour says how, and the row says who.
    fn color(self) -> [u8; 3] {
        match self {
            Mood::Improves => [0, 158, 115],
            Mood::IsConquered => [230, 159, 0],
            Mood::Stagnates => [74, 80, 94],
        }
    }
}

/// Writes how moods look.
pub(super) fn configure(rec: &RecordingStream, card: &RunCard) -> Result<(), ViewError> {
    let looks = StateConfiguration::new()
        .with_values(Mood::VARIANTS.iter().map(|mood| mood.word()))
        .with_colors(Mood::VARIANTS.iter().map(|mood| palette::opaque(mood.color())));
    card.lanes().try_for_each(|(lane, _)| Ok(rec.log_static(path(lane), &looks)?))
}

/// Writes a mood; its time is that of the stream.
pub(super) fn show(rec: &RecordingStream, island: u32, mood: Mood) -> Result<(), ViewError> {
    Ok(rec.log(path(island), &StateChange::single(mood.word()))?)
}

fn path(island: u32) -> String {
    format!("state/island-{island}")
}
