//! The creatures of a run, one after another.

use super::film::{Studio, recorder};
use crate::app::ancestry_text::{self, AncestryText};
use crate::app::args::cli::ReplayArgs;
use crate::app::console::{print, say};
use crate::archipelago::{Birth, Births, Champion, Descent, Lineage};
use crate::creature::Gene;
use crate::evolution::{Id, Individual};
use crate::problems::Locomotion;
use crate::runs::config::Config;
use crate::runs::kind::Kind;
use crate::runs::subject::Subject;
use crate::runs::{Failure, seeds};
use crate::store::{RecordLog, RunDir};
use crate::view::{Clip, Family, Lane, Pace, Program, RunCard};
use std::path::{Path, PathBuf};

/// Films the champions of a run through its generations, or the ancestors of its best, and returns the
/// recording's name.
///
/// # Errors
/// If there is no run, its records are damaged or do not say enough, or the recording cannot be written.
pub fn film(args: &ReplayArgs, dir: &Path) -> Result<PathBuf, Failure> {
    let dir = RunDir::at(dir);
    let config = Config::of_run(&dir)?;
    require_creatures(&config)?;
    let problem = config.locomotion();
    let studio = Studio::new(args, &config)?;
    let most = args.clips as usize;
    let champions = champions(&dir, &config)?;
    let best = champions.last().cloned();
    let best = best.ok_or_else(|| Failure::failed("the run has no champion yet"))?;
    let lineage = lineage(&dir, &config)?;
    let (name, line) = match args.ancestry {
        true => ("ancestry.rrd", ancestors(&dir, &config, &lineage, &best, most)?),
        false => ("champions.rrd", ancestry_text::selection(&champions, most)),
    };
    let out = args.out.clone().unwrap_or_else(|| dir.path().join(name));
    let is_as_scored = args.seconds.is_none() && studio.problem == problem;
    let ancestry_text = AncestryText::of(&config, problem);
    let family = ancestry_text.family(&lineage, best.id);
    Reel { studio, line, ancestry_text, family, is_as_scored }.record(args, &dir, &out)?;
    Ok(out)
}

fn require_creatures(config: &Config) -> Result<(), Failure> {
    match config.problem {
        Kind::Creatures => Ok(()),
        other => Err(Failure::usage(format!(
            "replay shows creatures, and this is a run of {other}, whose genomes have no bodies"
        ))),
    }
}

/// The creatures of a film.
struct Reel {
    studio: Studio,
    line: Vec<Individual<Gene>>,
    ancestry_text: AncestryText<Locomotion>,
    family: Family,
    /// Whether they are tried as they were in the run.
    is_as_scored: bool,
}

impl Reel {
    fn record(self, args: &ReplayArgs, dir: &RunDir, out: &Path) -> Result<(), Failure> {
        let mut recorder = recorder(out, self.card(args, dir))?;
        if !self.family.line.is_empty() {
            recorder.family(0.0, 0, &self.family)?;
        }
        for (slot, one) in (0..).zip(&self.line) {
            let Id { island, generation, .. } = one.id;
            let Ok(creature) = self.studio.problem.express(&one.genome) else { continue };
            let shot = self.studio.shoot(creature);
            let may_be = || self.studio.problem.possible_scores(&one.genome).contains(&one.fitness);
            if self.is_as_scored && shot.evaluation.fitness != one.fitness && !may_be() {
                say(&format!(
                    "WARNING: {} was recorded with {:?}, but gets {:?} here",
                    one.id, one.fitness, shot.evaluation.fitness
                ));
            }
            let origin = self.ancestry_text.origin(one.id, one.parents, island);
            let name = format!("generation {generation}, island {island}, {origin}");
            print(&self.studio.row(&shot, &name));
            let score = self.studio.problem.short(shot.evaluation.fitness);
            recorder.score(slot, generation, shot.evaluation.fitness)?;
            recorder.play(
                &Clip {
                    lane: slot,
                    hue: island,
                    generation,
                    label: format!("gen {generation} · {score} · {origin}"),
                    short_label: format!("gen {generation} · {score}"),
                    creature: shot.creature,
                    others: self.studio.trial.other_creatures(),
                    trajectory: shot.trajectory,
                },
                slot,
            )?;
        }
        Ok(recorder.finish()?)
    }

    fn card(&self, args: &ReplayArgs, dir: &RunDir) -> RunCard {
        let lane = |one: &Individual<Gene>| Lane {
            title: format!("gen {}", one.id.generation),
            hue: one.id.island,
        };
        let what = match args.ancestry {
            true => "The ancestors of the best creature, from generation 0 on",
            false => "The best creature of its time, through the generations",
        };
        RunCard {
            program: Program::Line,
            lanes: self.line.iter().map(lane).collect(),
            unit: self.studio.problem.unit().to_owned(),
            description_markdown: format!(
                "# {what}\n\nof the run in `{}`; colours are islands, numbers generations\n",
                dir.path().display()
            ),
            topology_edges: Vec::new(),
            has_stage: true,
            has_family: !self.family.line.is_empty(),
            pace: Pace { slot_s: self.studio.clip_s(), generations_per_slot: 1 },
            ground: self.studio.trial.ground.clone(),
        }
    }
}

/// The best creatures of their time, each better than all before it on any island.
fn champions(dir: &RunDir, config: &Config) -> Result<Vec<Individual<Gene>>, Failure> {
    let mut all = Vec::new();
    for island in 0..config.islands {
        let log = RecordLog::<Champion<Gene>>::read(&dir.champions(island))?.records;
        all.extend(log.into_iter().map(|champion| (champion.generation, island, champion)));
    }
    all.sort_by_key(|&(generation, island, _)| (generation, island));
    let mut best = None;
    let better = all.into_iter().filter(|(.., champion)| {
        let is_better = best.is_none_or(|best| champion.individual.fitness > best);
        if is_better {
            best = Some(champion.individual.fitness);
        }
        is_better
    });
    Ok(better.map(|(.., champion)| champion.individual).collect())
}

fn lineage(dir: &RunDir, config: &Config) -> Result<Lineage, Failure> {
    let mut lineage = Lineage::default();
    for island in 0..config.islands {
        let births = RecordLog::<Births>::read(&dir.lineages(island))?.records;
        births.into_iter().for_each(|births| lineage.push(island, births));
    }
    Ok(lineage)
}

/// The line of mothers of the best, bred again.
fn ancestors(
    dir: &RunDir,
    config: &Config,
    lineage: &Lineage,
    best: &Individual<Gene>,
    most: usize,
) -> Result<Vec<Individual<Gene>>, Failure> {
    let lost = |reason: String| {
        Failure::failed(format!(
            "the ancestors of the best creature cannot be bred again: {reason}"
        ))
    };
    let line = ancestry_text::selection(&lineage.line(best.id), most);
    let problem = config.locomotion();
    let founders = seeds::of_run(dir, config, &problem)?;
    let genomes = lineage.genomes(&line, &problem, &founders, &config.archipelago());
    let genomes = genomes.map_err(|gap| lost(gap.to_string()))?;
    if genomes.get(&best.id) != Some(&best.genome) {
        return Err(lost("they breed another genome; was the run made by another version?".into()));
    }
    let one = |&id: &Id| {
        let birth = lineage.birth(id)?;
        let genome = genomes.get(&id)?.clone();
        let Birth { parents, fitness } = birth;
        // Their age matters to nobody any more.
        Some(Individual { id, parents, origin: 0, genome, fitness })
    };
    Ok(line.iter().filter_map(one).collect())
}
