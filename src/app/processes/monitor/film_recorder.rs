//! Shows what the islands report as a film.

use super::ancestry::Ancestry;
use super::logs::{BirthRecords, Sighting};
use super::news::News;
use crate::app::ancestry_text::{self, AncestryText};
use crate::app::console::say;
use crate::archipelago::{Champion, ExchangeMode};
use crate::runs::Failure;
use crate::runs::config::Config;
use crate::runs::subject::{Shot, Subject};
use crate::store::RunDir;
use crate::view::{
    Clip, Draft, Lane, Live, Pace, Program, Recorder, RunCard, ViewError, opens_row,
};
use std::path::Path;

/// A recorder that simulates the champions that will be seen, and no others: filming must cost the islands
/// little, and a film that is made anew must soon be where the run is.
pub struct FilmRecorder<P: Subject> {
    problem: P,
    ancestry_text: AncestryText<P>,
    recorder: Recorder,
    /// Each island's newest champion, if it was not filmed.
    unfilmed: Vec<Option<Champion<P::Gene>>>,
    news: Vec<News<P::Gene>>,
    ancestry: Ancestry<P>,
    /// Whom each island receives from.
    sources: Vec<Vec<u32>>,
    /// What to say before the sources: where nobody waits, not all of them have sent something.
    among: &'static str,
    has_shown: bool,
}

impl<P: Subject> FilmRecorder<P> {
    /// Begins the recording of a run, in `folder`, and serves it if wanted; where it cannot be served, it is only
    /// recorded.
    ///
    /// # Errors
    /// If nothing can be written there.
    pub fn open(
        folder: &Path,
        dir: &RunDir,
        live: Option<Live>,
        config: &Config,
        problem: P,
        clip_every: Option<u32>,
    ) -> Result<Self, Failure> {
        let card = run_card(config, &problem, clip_every);
        let record =
            |live| Recorder::create(Draft::within(folder, &dir.recording())?, live, card.clone());
        let recorder = match record(live) {
            Err(error @ (ViewError::NoFreePort { .. } | ViewError::Serve { .. })) => {
                say(&format!("warning: {error}; this run is only recorded"));
                record(None)?
            }
            result => result?,
        };
        let islands = config.islands;
        let ancestry_text = AncestryText::of(config, problem.clone());
        let births = BirthRecords::of(dir, islands);
        let ancestry = Ancestry::new(ancestry_text.clone(), births, islands, recorder.pace());
        let unfilmed = (0..islands).map(|_| None).collect();
        let news = (0..islands).map(|_| News::none()).collect();
        let graph = config.archipelago().graph();
        let sources = (0..islands).map(|island| graph.in_neighbours(island).to_vec()).collect();
        let among = if config.exchange == ExchangeMode::Async { "some of " } else { "" };
        let has_shown = false;
        Ok(Self {
            problem,
            ancestry_text,
            recorder,
            unfilmed,
            news,
            ancestry,
            sources,
            among,
            has_shown,
        })
    }

    /// What to give to a viewer to watch live.
    pub fn address(&self) -> Option<String> {
        self.recorder.address()
    }

    /// The port that it is served on.
    pub fn port(&self) -> Option<u16> {
        self.recorder.port()
    }

    /// Whether there is anything in the recording.
    pub fn has_shown(&self) -> bool {
        self.has_shown
    }

    /// Shows a generation of an island.
    ///
    /// # Errors
    /// If it cannot be recorded.
    pub fn show(&mut self, sighting: &Sighting<P::Gene>) -> Result<(), Failure> {
        let Sighting { report, champion } = sighting;
        let (island, generation) = (report.island, report.generation);
        self.news[island as usize].learn(sighting);
        if let Some(champion) = champion {
            self.unfilmed[island as usize] = Some(champion.clone());
        }
        if opens_row(generation) {
            self.tell(island)?;
        }
        if self.recorder.opens_slot(generation) {
            self.film(island)?;
        }
        self.has_shown = true;
        self.recorder.report(report)?;
        self.ancestry.learn(report, champion.as_ref());
        self.show_families(false)
    }

    /// Tells what is new of an island.
    fn tell(&mut self, island: u32) -> Result<(), Failure> {
        let news = self.news[island as usize].take();
        let generation = news.generation;
        if let Some(migration) = self.migration(island, &news) {
            self.recorder.event(Some(island), generation, &migration)?;
        }
        if let Some(champion) = self.succession(island, &news) {
            self.recorder.event(Some(island), generation, &champion)?;
        }
        match news.mood {
            Some(mood) => Ok(self.recorder.mood(island, generation, mood)?),
            None => Ok(()),
        }
    }

    fn migration(&self, island: u32, news: &News<P::Gene>) -> Option<String> {
        let News { immigrants, exchanges, .. } = *news;
        let sources: Vec<String> =
            self.sources[island as usize].iter().map(u32::to_string).collect();
        let times =
            if exchanges > 1 { format!(" in {exchanges} exchanges") } else { String::new() };
        let from = format!("{}{}", self.among, sources.join(", "));
        (immigrants > 0)
            .then(|| format!("migration {from} → {island}: {immigrants} immigrants{times}"))
    }

    fn succession(&self, island: u32, news: &News<P::Gene>) -> Option<String> {
        let champion = news.champion.as_ref()?;
        let more = match news.champions {
            0 | 1 => String::new(),
            many => format!("; the last of {many}"),
        };
        Some(format!("{}{more}", self.coronation(island, champion)))
    }

    /// Shows the families that are due.
    fn show_families(&mut self, is_over: bool) -> Result<(), Failure> {
        while let Some((start_s, generation, family)) = self.ancestry.next(is_over) {
            self.recorder.family(start_s, generation, &family)?;
        }
        Ok(())
    }

    /// Waits until everything is written.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn flush(&self) -> Result<(), Failure> {
        Ok(self.recorder.flush()?)
    }

    /// Puts the recording in its place, in which it goes on. A recording of before is worth more than one with
    /// nothing in it.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn publish(&mut self) -> Result<(), Failure> {
        if self.has_shown {
            self.recorder.publish()?;
        }
        Ok(())
    }

    /// Films the champions that were not seen yet and ends the recording.
    ///
    /// # Errors
    /// If the disk is full or gone.
    pub fn finish(mut self) -> Result<(), Failure> {
        (0..self.unfilmed.len() as u32).try_for_each(|island| self.tell(island))?;
        (0..self.unfilmed.len() as u32).try_for_each(|island| self.film(island))?;
        self.show_families(true)?;
        if self.has_shown {
            self.recorder.finish()?;
        }
        Ok(())
    }

    fn coronation(&self, island: u32, champion: &Champion<P::Gene>) -> String {
        let individual = &champion.individual;
        let score = self.score(champion);
        let remark = self.problem.remark(&individual.genome);
        let remark = remark.map_or_else(String::new, |remark| format!(", {remark}"));
        let origin = self.ancestry_text.origin(individual.id, individual.parents, island);
        format!("island {island}: new champion, {score}{remark}, {origin}")
    }

    /// A champion's fitness as people read it, and what of it holds on trials that it was not selected on.
    fn score(&self, champion: &Champion<P::Gene>) -> String {
        let fitness = self.problem.show(champion.individual.fitness);
        match champion.validated {
            Some(validated) => {
                format!("{fitness} ({} on fresh trials)", self.problem.show(validated))
            }
            None => fitness,
        }
    }

    /// Simulates an island's newest champion again, if that was not done. It must get the fitness that it was
    /// reported with, bit for bit: what is seen is what was scored.
    fn film(&mut self, island: u32) -> Result<(), Failure> {
        let Some(champion) = self.unfilmed[island as usize].take() else { return Ok(()) };
        let score = ancestry_text::standing(&self.problem, &champion);
        let short = self.problem.short(champion.individual.fitness);
        let Champion { generation, individual, .. } = champion;
        let Some(shot) = self.problem.shoot(&individual.genome) else { return Ok(()) };
        let Shot { creature, others, evaluation, trajectory } = shot;
        if evaluation.fitness != individual.fitness {
            let news = format!(
                "WARNING: the champion of island {island} was reported with {:?}, but gets {:?} here: \
                 the islands and the monitor do not simulate the same",
                individual.fitness, evaluation.fitness
            );
            say(&news);
            self.recorder.event(Some(island), generation, &news)?;
        }
        let origin = self.ancestry_text.origin(individual.id, individual.parents, island);
        Ok(self.recorder.champion(&Clip {
            lane: island,
            hue: island,
            generation,
            label: format!("gen {generation} · {score} · {origin}"),
            short_label: format!("{island} · {short}"),
            creature,
            others,
            trajectory,
        })?)
    }
}

fn run_card<P: Subject>(config: &Config, problem: &P, clip_every: Option<u32>) -> RunCard {
    let graph = config.archipelago().graph();
    let edges = (0..config.islands)
        .flat_map(|island| graph.out_neighbours(island).iter().map(move |&to| (island, to)));
    let clip_every = clip_every.or(config.clip_every);
    RunCard {
        program: Program::Run,
        lanes: Lane::of_islands(config.islands),
        unit: problem.unit().to_owned(),
        description_markdown: description(config, problem),
        topology_edges: edges.collect(),
        has_stage: P::HAS_BODIES,
        has_family: true,
        pace: Pace::for_run(config.generations, clip_every, problem.clip_s()),
        ground: problem.ground(),
    }
}

/// What decides the run, but neither when it was launched nor how it was run: films of equal runs are equal.
fn description<P: Subject>(config: &Config, problem: &P) -> String {
    let Config { islands, population, generations, .. } = config;
    let legend = match P::HAS_BODIES {
        true => {
            "On every champion, pins through its driven joints are light while the motor turns one way and dark \
             while it turns the other; white discs are where it touches the ground.\n\n"
        }
        false => "",
    };
    format!(
        "# {islands} islands × {population} {}, {generations} generations\n\n{}, seed **{}**\n\n{legend}\
         ```toml\n{}```\n",
        P::INHABITANTS,
        problem.title(),
        config.seed.unwrap_or_default(),
        Config { launch: None, threads: None, ..config.clone() }.to_toml()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::Topology;

    #[test]
    fn the_card_of_a_run_has_every_edge_of_its_topology() {
        for topology in Topology::ALL {
            let config = Config { islands: 6, seed: Some(7), topology, ..Config::default() };
            let (edges, graph) = (
                run_card(&config, &config.locomotion(), None).topology_edges,
                topology.graph(6, 7),
            );
            assert_eq!(edges.len(), graph.edges(), "{topology}");
            assert!(edges.iter().all(|(from, to)| graph.out_neighbours(*from).contains(to)));
        }
    }
}
