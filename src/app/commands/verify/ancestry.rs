//! Whether the champions are who their ancestors can have bred.

use super::check::{Check, counted};
use super::records::Records;
use super::rules::Terms;
use crate::archipelago::Lineage;
use crate::archipelago::lineage::Gap;
use crate::evolution::Individual;
use crate::runs::seeds;
use crate::runs::subject::Subject;
use crate::store::RunDir;

/// Breeds every champion again from its first ancestors on, which simulates nothing; `sound` says that nothing is
/// wrong with the records.
pub fn check<P: Subject>(
    dir: &RunDir,
    problem: &P,
    terms: &Terms,
    records: &Records<P::Gene>,
    sound: bool,
) -> Check {
    let logs = || (0..).zip(&records.champions);
    let champions = || {
        let with = |(island, log)| std::iter::repeat(island).zip(log);
        logs().flat_map(with).map(|(island, champion)| (island, &champion.individual))
    };
    let mut check = Check::of("ancestry").checked(counted(champions().count(), "champion"));
    if !sound {
        check.note("not checked: the islands' records are damaged");
        return check;
    }
    if !terms.is_of_this_version() {
        check.note("not checked: another version may breed otherwise");
        return check;
    }
    let Ok(founders) = seeds::of_run(dir, terms.config, problem) else {
        check.note("not checked: the genomes that the run began with are damaged");
        return check;
    };
    let mut lineage = Lineage::default();
    for (island, births) in (0..).zip(&records.lineages) {
        births.iter().for_each(|births| lineage.push(island, births.clone()));
    }
    let ids: Vec<_> = champions().map(|(_, individual)| individual.id).collect();
    match lineage.genomes(&ids, problem, &founders, &terms.config.archipelago()) {
        Err(Gap::Drawn(_)) => {
            check.note("not checked: who is drawn from a distribution has no parents")
        }
        Err(gap) => check.damaged(format_args!("{}: {gap}", dir.path().display())),
        Ok(genomes) => {
            for (island, Individual { id, genome, .. }) in champions() {
                if genomes.get(id) != Some(genome) {
                    let reason = format!("the ancestors of {id} breed another genome");
                    check.judge(&dir.champions(island), Err(reason));
                }
            }
        }
    }
    check
}
