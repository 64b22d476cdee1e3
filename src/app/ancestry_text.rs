//! Ancestries in words.

use crate::archipelago::{Birth, Champion, Descent};
use crate::evolution::Id;
use crate::runs::config::Config;
use crate::runs::subject::Subject;
use crate::view::Family;
use crate::view::family::{Generation, Member};

/// The most ancestors of a line that a graph shows: more are too small to read.
const LINE_MAX: usize = 14;

/// Says who the individuals of a run are.
#[derive(Debug, Clone)]
pub struct AncestryText<P> {
    problem: P,
    /// So many of the first of each island were not random.
    founders: usize,
}

impl<P: Subject> AncestryText<P> {
    /// The texts of a run.
    pub fn of(config: &Config, problem: P) -> Self {
        let founders = config.seed_genomes.as_ref().map_or(0, |it| it.count);
        Self { problem, founders }
    }

    /// How somebody came to be, for a label on an island.
    pub fn origin(&self, id: Id, parents: [Option<Id>; 2], island: u32) -> String {
        let how = match parents {
            [None, _] if (id.index as usize) < self.founders => "founder",
            [None, _] => "random",
            [_, None] => "mutated",
            [_, Some(_)] => "crossed",
        };
        match id.island {
            born if born == island => how.to_owned(),
            born => format!("{how}, from island {born}"),
        }
    }

    /// The family of somebody; empty if nothing is known of its birth.
    pub fn family(&self, lineage: &impl Descent, id: Id) -> Family {
        let whole = lineage.line(id);
        let place = |id: Id| whole.iter().position(|&other| other == id).unwrap_or(0);
        let member = |id: Id| {
            let birth = lineage.birth(id)?;
            Some(Member { label: self.label(id, birth), island: id.island })
        };
        let mut before: Option<Id> = None;
        let mut line = Vec::new();
        for id in selection(&whole, LINE_MAX) {
            let Some(birth) = lineage.birth(id) else { continue };
            let [mother, father] = birth.parents;
            let between = before.map_or(0, |before| place(id) - place(before) - 1);
            let moved = mother.filter(|mother| mother.island != id.island);
            line.push(Generation {
                member: Member { label: self.label(id, birth), island: id.island },
                other_parent: father.filter(|&father| Some(father) != mother).and_then(member),
                way: way(between, moved.map(|mother| (mother.island, id.island))),
            });
            before = Some(id);
        }
        Family { line }
    }

    fn label(&self, id: Id, birth: Birth) -> String {
        let score = self.problem.short(birth.fitness);
        format!(
            "gen {} · island {} · {score} · {}",
            id.generation,
            id.island,
            self.origin(id, birth.parents, id.island)
        )
    }
}

/// A selection of a line, evenly, with its first and its last one.
pub fn selection<T: Clone>(line: &[T], most: usize) -> Vec<T> {
    if line.len() <= most.max(2) {
        return line.to_vec();
    }
    let last = most.max(2) - 1;
    (0..=last).map(|place| line[place * (line.len() - 1) / last].clone()).collect()
}

/// What a champion is worth, and what of it holds on fresh trials, as a label has room for.
pub fn standing<P: Subject>(problem: &P, champion: &Champion<P::Gene>) -> String {
    let score = problem.short(champion.individual.fitness);
    match champion.validated {
        Some(validated) => format!("{score} ({} fresh)", problem.short(validated)),
        None => score,
    }
}

fn way(between: usize, moved: Option<(u32, u32)>) -> Option<String> {
    let more = (between > 0).then(|| format!("{between} more"));
    let moved = moved.map(|(from, to)| format!("migrates {from} → {to}"));
    match (more, moved) {
        (Some(more), Some(moved)) => Some(format!("{more}, {moved}")),
        (more, moved) => more.or(moved),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archipelago::{Births, Lineage};
    use crate::evolution::Fitness;

    #[test]
    fn a_family_says_who_was_crossed_and_who_moved() {
        let id = |island, generation, index| Id { island, generation, index };
        let birth = |parents, score| Birth { parents, fitness: Fitness::new(score) };
        let mut lineage = Lineage::default();
        for island in 0..2 {
            let births = vec![birth([None; 2], 0.5), birth([None; 2], 0.25)];
            lineage.push(island, Births { generation: 0, amount_scale: 1.0, births });
        }
        let crossed = [Some(id(0, 0, 0)), Some(id(1, 0, 1))];
        let births = vec![birth(crossed, 2.0)];
        lineage.push(1, Births { generation: 1, amount_scale: 1.0, births });
        let config = Config::default();
        let family = AncestryText::of(&config, config.locomotion()).family(&lineage, id(1, 1, 0));
        let labels: Vec<_> = family.line.iter().map(|it| it.member.label.as_str()).collect();
        let expected =
            ["gen 0 · island 0 · 0.50 m · random", "gen 1 · island 1 · 2.00 m · crossed"];
        assert_eq!(labels, expected);
        let last = &family.line[1];
        assert_eq!(last.way.as_deref(), Some("migrates 0 → 1"));
        assert_eq!(last.other_parent.as_ref().map(|it| it.island), Some(1));
    }

    #[test]
    fn a_selection_keeps_both_ends_and_its_order() {
        let line: Vec<Id> =
            (0..40).map(|generation| Id { island: 0, generation, index: 0 }).collect();
        let few = selection(&line, 5);
        let generations: Vec<_> = few.iter().map(|id| id.generation).collect();
        assert_eq!(generations, [0, 9, 19, 29, 39]);
        assert_eq!(selection(&line[..3], 5), line[..3]);
    }
}
