//! Whether what islands took in, where they do not wait for each other, leads to what they became.

use super::check::{Check, counted};
use super::records::Records;
use super::rules::Terms;
use crate::archipelago::{Digest, lockstep};
use crate::runs::seeds;
use crate::runs::subject::Subject;
use crate::store::RunDir;

/// Evolves a run that has finished again from its record, if that is wished (`thorough`): it must come to the same
/// digest. `sound` says that nothing is wrong with its records. Where the seed alone fixes the result, nothing: who
/// descends from whom tells enough; but from the seed again where genomes are drawn from a distribution.
pub fn replay<P: Subject>(
    dir: &RunDir,
    problem: &P,
    terms: &Terms,
    records: &Records<P::Gene>,
    thorough: bool,
    sound: bool,
) -> Option<Check> {
    let generations = terms.config.generations;
    let checked = counted(generations as usize, "generation");
    let mut check = Check::of("replay").checked(checked);
    let finals = records.finals(terms).filter(|_| sound);
    match (finals, seeds::of_run(dir, terms.config, problem)) {
        _ if !terms.is_async() && !terms.is_drawn() => return None,
        _ if !thorough => check.note("not tried: --thorough evolves the run again"),
        _ if !terms.is_of_this_version() => {
            check.note("not tried: another version may evolve otherwise")
        }
        (Some(finals), Ok(founders)) => {
            let archipelago = terms.config.archipelago();
            let record = &records.arrivals;
            let (cause, again) = match terms.is_async() {
                true => (
                    "what the islands took in",
                    lockstep::replay(problem, &founders, &archipelago, generations, record, |_| ()),
                ),
                false => (
                    "the seed",
                    Ok(lockstep::run_from(problem, &founders, &archipelago, generations, |_| ())),
                ),
            };
            match again {
                Err(impossible) => check.damaged(impossible),
                Ok(islands) => {
                    let [found, expected] = [Digest::of(&islands), Digest::of(finals)];
                    match found == expected {
                        true if islands == finals => check.result("the same digest"),
                        true => check.damaged(format_args!(
                            "{cause} leads to the same digest by another descent"
                        )),
                        false => check.damaged(format_args!(
                            "{cause} leads to {found}, and the final populations have {expected}"
                        )),
                    }
                }
            }
        }
        _ => check.note("not tried: the run has not finished, or its records are damaged"),
    }
    Some(check)
}
