//! A run's recording: a file, and a server for those who watch live.

use super::blueprint::{self, Audience};
use super::card::{Program, RunCard};
use super::family::{self, Family};
use super::file::RrdFile;
use super::film::{Film, Pace, Screening, opens_row};
use super::live::{self, Live, Server};
use super::race::{self, Field};
use super::state::{self, Mood};
use super::track::Track;
use super::{
    APPLICATION, Clip, Draft, GENERATION, PLAYBACK, ViewError, figures, packing, palette, scenery,
    screen,
};
use crate::archipelago::island::Report;
use crate::evolution::population::SPREAD_BARS;
use crate::evolution::{Fitness, Spread};
use rerun::log::ChunkBatcherConfig;
use rerun::sink::LogSink;
use rerun::{
    ApplicationId, BarChart, RecordingStream, RecordingStreamBuilder, Scalars, TextLog, Transform3D,
};

use std::time::Duration;

/// A bar of a histogram is at least so wide, in the unit of fitness: equal scores need a bar too.
const BAR_WIDTH_MIN: f64 = 1e-6;

/// Writes a run's recording.
pub struct Recorder {
    stream: RecordingStream,
    film: Film,
    field: Field,
    program: Program,
    /// The last generation of each island, if it has no row yet.
    unshown: Vec<Option<Report>>,
    track: Track,
    server: Option<Server>,
    file: RrdFile,
    draft: Draft,
}

impl Recorder {
    /// Begins a recording, and serves it live if wanted.
    ///
    /// # Errors
    /// If the draft cannot be written, or the recording not be served where it was wanted.
    pub fn create(draft: Draft, live: Option<Live>, card: RunCard) -> Result<Self, ViewError> {
        let application = ApplicationId::from(APPLICATION);
        let file = RrdFile::new(draft.file()?).map_err(|source| draft.failed(source))?;
        let (sink, server) = live.map(live::serve).transpose()?.unzip();

        let mut sinks: Vec<(Audience, Box<dyn LogSink>)> =
            vec![(Audience::File, Box::new(file.clone()))];
        sinks.extend(sink.map(|sink| (Audience::Live, Box::new(sink) as Box<dyn LogSink>)));
        // Rerun's switch RERUN=off turns everything off, and it cannot build a blueprint then.
        let on = rerun::decide_logging_enabled(true);
        for (audience, sink) in sinks.iter().filter(|_| on) {
            let (messages, activation) = blueprint::messages(&application, &card, *audience)?;
            sink.send_blueprint(messages, activation);
        }
        let sinks: Vec<_> = sinks.into_iter().map(|(_, sink)| sink).collect();
        let stream = RecordingStreamBuilder::new(application)
            .enabled(on)
            .batcher_config(row_by_row())
            .set_sinks(sinks)?;
        // The wall clock has no place in a film.
        stream.set_log_time_enabled(false);
        stream.set_log_tick_enabled(false);
        scenery::build(&stream, &card)?;
        let film = Film::new(card.lane_count(), card.pace);
        let track = card.track();
        let mut recorder = Self {
            stream,
            film,
            field: Field::new(track),
            program: card.program,
            unshown: vec![None; card.lane_count() as usize],
            track,
            server,
            file,
            draft,
        };
        recorder.frame(0.0, 0, |field| card.has_stage.then(|| field.reach(0.0)))?;
        Ok(recorder)
    }

    /// What to give to a viewer to watch live: `rerun ADDRESS`.
    pub fn address(&self) -> Option<String> {
        self.server.as_ref().map(|server| server.address.clone())
    }

    /// The port that it is served on.
    pub fn port(&self) -> Option<u16> {
        self.server.as_ref().map(|server| server.port)
    }

    /// How fast generations pass.
    pub fn pace(&self) -> Pace {
        self.film.pace()
    }

    /// Whether the champion that an island has in this generation will be seen: no other needs to be simulated
    /// again before the end.
    pub fn opens_slot(&self, generation: u32) -> bool {
        self.film.pace().opens_slot(generation)
    }

    /// One generation of one island: its figures if it has a row of them, and the champion if it is time to show it.
    /// Report each island's generations in their order, and a generation's champion before it.
    pub fn report(&mut self, report: &Report) -> Result<(), ViewError> {
        let (island, generation) = (report.island, report.generation);
        self.film.reached(island, generation);
        let is_row = opens_row(generation);
        if is_row {
            self.figures(report)?;
        }
        if let Some(unshown) = self.unshown.get_mut(island as usize) {
            *unshown = (!is_row).then_some(*report);
        }
        self.roll(island)
    }

    /// A row of each curve.
    fn figures(&self, report: &Report) -> Result<(), ViewError> {
        let Report { island, generation, statistics, .. } = *report;
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
        Ok(self
            .stream
            .log(format!("population/{island}"), &histogram(island, &statistics.spread))?)
    }

    /// An island has a new champion. It is shown in the next slot of the film that opens; one that is
    /// replaced before is never seen.
    pub fn champion(&mut self, clip: &Clip) -> Result<(), ViewError> {
        self.film.champion(clip.clone());
        self.roll(clip.lane)
    }

    /// Shows a clip in a slot of a film that is no run's.
    pub fn play(&mut self, clip: &Clip, slot: u32) -> Result<(), ViewError> {
        let slot_s = self.film.pace().slot_s;
        let start_s = f64::from(slot) * slot_s;
        let lanes = self.film.lanes();
        let screening = Screening { clip, start_s, generation: clip.generation, slot, lanes };
        let far_m = screen::show(&self.stream, screening, slot_s)?;
        figures::show(&self.stream, screening, slot_s)?;
        if self.program == Program::Line {
            screen::follow(&self.stream, screening, slot_s, self.track)?;
        }
        self.frame(start_s, clip.generation, |field| Some(field.reach(far_m)))
    }

    /// What the creature of a slot got, in a film of a line.
    pub fn score(&mut self, slot: u32, generation: u32, fitness: Fitness) -> Result<(), ViewError> {
        let Some(score) = fitness.finite() else { return Ok(()) };
        let slot_s = self.film.pace().slot_s;
        // The end of a slot is the beginning of the next one.
        for share in [0.0, 0.999] {
            self.stream.set_duration_secs(PLAYBACK, (f64::from(slot) + share) * slot_s);
            self.stream.set_time_sequence(GENERATION, generation);
            self.stream.log("fitness/line", &Scalars::single(score))?;
        }
        Ok(())
    }

    /// From a generation on an island fares otherwise.
    pub fn mood(&mut self, island: u32, generation: u32, mood: Mood) -> Result<(), ViewError> {
        self.stamp(generation);
        state::show(&self.stream, island, mood)
    }

    /// From a film time on, in seconds, this is the family that is shown.
    pub fn family(
        &mut self,
        start_s: f64,
        generation: u32,
        family: &Family,
    ) -> Result<(), ViewError> {
        self.stream.set_duration_secs(PLAYBACK, start_s);
        self.stream.set_time_sequence(GENERATION, generation);
        family::show(&self.stream, family)
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
        let path = island.map_or("events".to_owned(), |island| format!("events/{island}"));
        Ok(self.stream.log(path, &line)?)
    }

    /// Waits until everything is written. Only here a full disk is noticed: call it now and then.
    ///
    /// # Errors
    /// If something could not be written.
    pub fn flush(&self) -> Result<(), ViewError> {
        self.stream.flush_blocking().map_err(|error| self.cannot_write(error.to_string()))
    }

    /// Puts the recording in its place, if it is not there, and goes on with it there.
    ///
    /// # Errors
    /// If something could not be written; what was in its place is still there.
    pub fn publish(&mut self) -> Result<(), ViewError> {
        self.flush()?;
        self.draft.publish()
    }

    /// Shows the champions that came after the last slot had opened, ends all islands' films at the same time,
    /// and puts the recording in its place. A recorder that is dropped without this leaves a whole file with
    /// less in it if it was published, and none otherwise.
    ///
    /// # Errors
    /// If something could not be written.
    pub fn finish(mut self) -> Result<(), ViewError> {
        self.film.end();
        let unshown = std::mem::take(&mut self.unshown);
        unshown.iter().flatten().try_for_each(|report| self.figures(report))?;
        for lane in 0..self.film.lanes() {
            self.roll(lane)?;
        }
        self.flush()?;
        self.file.finish().map_err(|message| self.cannot_write(message))?;
        match self.packed() {
            Ok(mut packed) => packed.publish(),
            // What there is has everything, too.
            Err(_) => self.draft.publish(),
        }
    }

    /// The same in less room.
    fn packed(&self) -> Result<Draft, ViewError> {
        let packed = self.draft.anew()?;
        let done = packing::pack(self.draft.place(), packed.file()?);
        done.map_err(|message| self.cannot_write(message))?;
        Ok(packed)
    }

    fn cannot_write(&self, message: String) -> ViewError {
        ViewError::Flush { path: self.draft.path().to_owned(), message }
    }

    /// Shows what is due.
    fn roll(&mut self, lane: u32) -> Result<(), ViewError> {
        let slot_s = self.film.pace().slot_s;
        while let Some(screening) = self.film.next(lane) {
            let Screening { start_s, generation, slot, .. } = screening;
            let far_m = screen::show(&self.stream, screening, slot_s)?;
            self.frame(start_s, generation, |field| field.learn(slot, far_m))?;
        }
        Ok(())
    }

    /// From a film time on, in seconds, the view of all lanes reaches as far as is told, if anything is.
    fn frame(
        &mut self,
        start_s: f64,
        generation: u32,
        told: impl FnOnce(&mut Field) -> Option<Transform3D>,
    ) -> Result<(), ViewError> {
        let Some(frame) = told(&mut self.field) else { return Ok(()) };
        self.stream.set_duration_secs(PLAYBACK, start_s);
        self.stream.set_time_sequence(GENERATION, generation);
        race::show(&self.stream, &frame)
    }

    fn stamp(&self, generation: u32) {
        self.stream.set_duration_secs(PLAYBACK, self.film.pace().film_s(generation));
        self.stream.set_time_sequence(GENERATION, generation);
    }
}

/// Every row is sent by itself and at once: how many came together would depend on the clock.
fn row_by_row() -> ChunkBatcherConfig {
    ChunkBatcherConfig {
        flush_tick: Duration::MAX,
        flush_num_rows: 0,
        flush_num_bytes: 0,
        ..ChunkBatcherConfig::DEFAULT
    }
}

fn histogram(island: u32, spread: &Spread) -> BarChart {
    let width = ((spread.high - spread.low) / SPREAD_BARS as f64).max(BAR_WIDTH_MIN);
    let middles = (0..SPREAD_BARS).map(|bar| spread.low + (bar as f64 + 0.5) * width);
    BarChart::new(spread.counts.map(f64::from).to_vec())
        .with_abscissa(middles.collect::<Vec<_>>())
        .with_widths([width as f32; SPREAD_BARS])
        .with_color(palette::opaque(palette::island(island)))
}
