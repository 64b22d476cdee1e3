//! Who descends from whom.
//!
//! Every individual is born once, on one island, and is known by its [`Id`] wherever it goes. Who was born of whom
//! is all that has to be kept of a generation: genomes need not be, since an offspring's genome depends on its
//! parents' genomes and on its place alone. So a hundred bytes tell what a whole ancestry looked like.

use super::Archipelago;
use crate::evolution::generation::{self, Moment};
use crate::evolution::{Fitness, Founders, Id, Individual, Memory, Problem, Reproduction};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// How an individual came to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Birth {
    /// Whom it comes from: nobody if it is random, one where crossover did not happen, else two.
    pub parents: [Option<Id>; 2],
    /// What it is worth.
    pub fitness: Fitness,
}

/// All who were born on an island in a generation, in the order of their index.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Births {
    /// The generation.
    pub generation: u32,
    /// What [`Memory::amount_scale`] was when they were bred.
    pub amount_scale: f64,
    /// Each of them.
    pub births: Vec<Birth>,
}

impl Births {
    /// Those of a brood, which need not live on; `memory` is what was known when it was bred.
    pub fn of<G>(generation: u32, memory: &Memory, brood: &[Individual<G>]) -> Self {
        let birth = |one: &Individual<G>| Birth { parents: one.parents, fitness: one.fitness };
        let births = brood.iter().map(birth).collect();
        Self { generation, amount_scale: memory.amount_scale, births }
    }
}

/// What knows who was born of whom.
pub trait Descent {
    /// What is on record of an individual's birth.
    fn recorded(&self, id: Id) -> Option<Birth>;

    /// How an individual came to be, if that is known. Nobody is born before its parents: what says so of those who
    /// were born on the same island is not believed. Immigrants may be of later generations than their offspring,
    /// where islands do not wait for each other.
    fn birth(&self, id: Id) -> Option<Birth> {
        let birth = self.recorded(id)?;
        let is_older = |parent: Id| parent.island != id.island || parent.generation < id.generation;
        birth.parents.into_iter().flatten().all(is_older).then_some(birth)
    }

    /// The mothers of an individual from the first one on, itself the last: whose root the bodies of the line have,
    /// since a genome begins with its mother's genes.
    fn line(&self, id: Id) -> Vec<Id> {
        let (mut line, mut seen) = (Vec::new(), BTreeSet::new());
        let mut next = Some(id);
        // A file may say of somebody to be its own ancestor.
        while let Some(id) = next.filter(|&id| seen.insert(id)) {
            line.push(id);
            next = self.birth(id).and_then(|birth| birth.parents[0]);
        }
        line.reverse();
        line
    }
}

impl Descent for Lineage {
    fn recorded(&self, id: Id) -> Option<Birth> {
        let births = self.islands.get(&id.island)?.get(id.generation as usize)?;
        births.births.get(id.index as usize).copied()
    }
}

/// The births of all islands, as far as they are known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lineage {
    islands: BTreeMap<u32, Vec<Births>>,
}

/// Why a genome cannot be bred again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Gap {
    /// Nothing is known of an ancestor.
    #[error("nothing is known of the ancestor {0}")]
    Unknown(Id),
    /// An offspring of these parents has another number of them: it was bred by another program, or under
    /// other settings.
    #[error("{0} cannot have the parents that it is said to have")]
    Unlike(Id),
    /// It was drawn from a distribution, which is not recorded.
    #[error("{0} has no ancestors: it was drawn from a distribution")]
    Drawn(Id),
    /// Somebody is said to be its own ancestor.
    #[error("{0} is said to be its own ancestor")]
    Circular(Id),
}

impl Lineage {
    /// The next generation of an island; they come in order, from 0.
    pub fn push(&mut self, island: u32, births: Births) {
        self.islands.entry(island).or_default().push(births);
    }

    /// The generations that are known of an island.
    pub fn generations(&self, island: u32) -> usize {
        self.islands.get(&island).map_or(0, Vec::len)
    }

    /// The genomes of individuals, bred again from generation 0 on.
    ///
    /// # Errors
    /// If an ancestor is not known, was bred otherwise, or is its own ancestor.
    pub fn genomes<P: Problem>(
        &self,
        ids: &[Id],
        problem: &P,
        founders: &Founders<P::Gene>,
        archipelago: &Archipelago,
    ) -> Result<BTreeMap<Id, Vec<P::Gene>>, Gap> {
        let mut genomes: BTreeMap<Id, Vec<P::Gene>> = BTreeMap::new();
        // Parents come before their offspring.
        for id in self.ancestors(ids)? {
            let parents = self.birth(id).ok_or(Gap::Unknown(id))?.parents;
            let [mother, father] = parents.map(|id| id.map(|id| &genomes[&id][..]));
            let strategy = &archipelago.strategy.on(id.island, self.amount_scale_at(id));
            let (source, index) = (archipelago.source(id.island), id.index as usize);
            let moment = Moment { source, generation: id.generation };
            let genome = match mother {
                None if strategy.reproduction == Reproduction::CmaEs && id.generation > 0 => {
                    return Err(Gap::Drawn(id));
                }
                None => generation::first(problem, founders, strategy, moment, index),
                Some(mother) => {
                    let other = father.unwrap_or(mother);
                    let (genome, two_parents) =
                        generation::breed(problem, strategy, moment, index, mother, other);
                    if two_parents != father.is_some() {
                        return Err(Gap::Unlike(id));
                    }
                    genome
                }
            };
            genomes.insert(id, genome);
        }
        genomes.retain(|id, _| ids.contains(id));
        Ok(genomes)
    }

    /// What an individual's island knew when it was bred, as far as breeding it depends on it.
    fn amount_scale_at(&self, id: Id) -> f64 {
        let births = self.islands.get(&id.island).and_then(|all| all.get(id.generation as usize));
        births.map_or(1.0, |births| births.amount_scale)
    }

    /// All ancestors of individuals and themselves, parents before their offspring.
    fn ancestors(&self, ids: &[Id]) -> Result<Vec<Id>, Gap> {
        let (mut order, mut is_in_order) = (Vec::new(), BTreeMap::new());
        let mut open: Vec<(Id, bool)> = ids.iter().map(|&id| (id, false)).collect();
        while let Some((id, has_ancestors)) = open.pop() {
            if has_ancestors {
                is_in_order.insert(id, true);
                order.push(id);
                continue;
            }
            match is_in_order.insert(id, false) {
                Some(true) => drop(is_in_order.insert(id, true)),
                Some(false) => return Err(Gap::Circular(id)),
                None => {
                    let birth = self.birth(id).ok_or(Gap::Unknown(id))?;
                    open.push((id, true));
                    open.extend(birth.parents.into_iter().flatten().map(|id| (id, false)));
                }
            }
        }
        Ok(order)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Migration;
    use super::super::lockstep;
    use super::super::tests::toy::{self, Toy};
    use super::*;

    fn archipelago() -> Archipelago {
        toy::archipelago(
            3,
            5,
            Migration { interval: 2, migrants: 2, lag: 1, ..Migration::default() },
        )
    }

    #[test]
    fn everybody_can_be_bred_again_from_the_births_alone() {
        let archipelago = archipelago();
        let (mut lineage, mut everybody) = (Lineage::default(), BTreeMap::new());
        lockstep::run(&Toy, &archipelago, 12, |step| {
            lineage.push(step.island.index, step.births.clone());
            everybody.extend(step.island.population.iter().map(|one| (one.id, one.clone())));
        });
        let ids: Vec<Id> = everybody.keys().copied().collect();
        let genomes = lineage.genomes(&ids, &Toy, &Founders::NONE, &archipelago).unwrap();
        let (mut crossed, mut moved) = (0, 0);
        for Individual { id, parents, genome, fitness, .. } in everybody.into_values() {
            assert_eq!(lineage.birth(id), Some(Birth { parents, fitness }));
            assert_eq!(genomes[&id], genome, "{id}");
            crossed += usize::from(parents[1].is_some());
            moved += usize::from(parents.iter().flatten().any(|it| it.island != id.island));
        }
        assert!(crossed > 0 && moved > 0, "{crossed} crossed, {moved} moved");
    }

    #[test]
    fn a_line_goes_from_a_random_genome_to_whom_it_is_of() {
        let mut lineage = Lineage::default();
        lockstep::run(&Toy, &archipelago(), 12, |step| {
            lineage.push(step.island.index, step.births.clone());
        });
        let last = Id { island: 1, generation: 12, index: 0 };
        let line = lineage.line(last);
        assert_eq!((line[0].generation, line.last()), (0, Some(&last)));
        for pair in line.windows(2) {
            assert_eq!(lineage.birth(pair[1]).unwrap().parents[0], Some(pair[0]));
        }
    }

    #[test]
    fn what_is_not_known_and_what_cannot_have_been_is_told_apart() {
        let id = |generation, index| Id { island: 0, generation, index };
        let birth = |parents| Birth { parents, fitness: Fitness::WORST };
        let breed = |parents: [Option<Id>; 2]| {
            let mut lineage = Lineage::default();
            for (generation, parents) in (0..).zip([[None; 2], parents]) {
                let births = vec![birth(parents)];
                lineage.push(0, Births { generation, amount_scale: 1.0, births });
            }
            lineage.genomes(&[id(1, 0)], &Toy, &Founders::NONE, &archipelago()).map(|_| ())
        };
        let parent = Some(id(0, 0));
        assert_eq!(breed([Some(id(0, 9)), None]), Err(Gap::Unknown(id(0, 9))));
        assert_eq!(breed([Some(id(1, 0)), None]), Err(Gap::Unknown(id(1, 0))));
        let elsewhere = Id { island: 1, generation: 3, index: 0 };
        assert_eq!(breed([Some(elsewhere), None]), Err(Gap::Unknown(elsewhere)));
        let found = [breed([parent, None]), breed([parent, parent])];
        assert!(
            found.contains(&Ok(())) && found.contains(&Err(Gap::Unlike(id(1, 0)))),
            "{found:?}"
        );
    }

    #[test]
    fn who_is_said_to_be_its_own_ancestor_is_not_bred() {
        let id = |island| Id { island, generation: 0, index: 0 };
        let mut lineage = Lineage::default();
        for island in 0..2 {
            let birth = Birth { parents: [Some(id(1 - island)), None], fitness: Fitness::WORST };
            lineage.push(island, Births { generation: 0, amount_scale: 1.0, births: vec![birth] });
        }
        let bred = lineage.genomes(&[id(0)], &Toy, &Founders::NONE, &archipelago());
        assert_eq!(bred, Err(Gap::Circular(id(0))));
        assert_eq!(lineage.line(id(0)), [id(1), id(0)]);
    }
}
