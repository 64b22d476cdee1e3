//! `islands inspect`: the body that a genome describes.

use super::cli::InspectArgs;
use super::console::print;
use super::{Failure, genomes};
use crate::creature::{self, Creature, JointKind};
use crate::formats::Inspection;

/// Shows the body of the genome in a file.
///
/// # Errors
/// If it cannot be read or expressed.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
    let links_max = genomes::links_max(args.max_links)?;
    let genome = genomes::read(&args.genome)?;
    let wrong = |error| Failure::usage(format!("cannot build {}: {error}", args.genome.display()));
    let creature = creature::express(&genome, args.profile, links_max).map_err(wrong)?;
    if args.json {
        let source = args.genome.file_name().unwrap_or(args.genome.as_os_str());
        let inspection =
            Inspection::new(&creature, args.profile, source.to_string_lossy().into_owned());
        print(
            &serde_json::to_string(&inspection).expect("a body is plain data, its numbers finite"),
        );
    } else {
        table(&creature);
    }
    Ok(())
}

fn table(creature: &Creature) {
    print(
        "link  name     parent  shape     length m  radius m   mass kg  joint     amplitude rad/s  torque N·m",
    );
    for (index, (copy, link)) in creature.tree.iter().zip(&creature.morphology.links).enumerate() {
        let traits = &creature.traits[copy.gene];
        let shape = link.shape.name();
        let joint = match link.joint.as_ref().map(|joint| joint.kind) {
            None => "root",
            Some(JointKind::Fixed) => "fixed",
            Some(JointKind::Revolute(_)) => "hinge",
        };
        let (amplitude, torque) =
            creature.controller.motors[index].map_or_else(Default::default, |motor| {
                (format!("{:.2}", motor.amplitude_rad_s), format!("{:.1}", motor.torque_nm_max))
            });
        print(&format!(
            "{index:>4}  {:<8} {:>6}  {shape:<9} {:>8.3}  {:>8.3} {:>9.3}  {joint:<8} {amplitude:>16} {torque:>11}",
            copy.name(index),
            copy.parent.map_or_else(|| "-".to_owned(), |parent| parent.to_string()),
            traits.length_m,
            traits.radius_m,
            link.mass_kg,
        ));
    }
}
