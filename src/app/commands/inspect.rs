//! `islands inspect`: the body that a genome or a URDF describes, or a network.

use crate::app::args::cli::InspectArgs;
use crate::app::console::print;
use crate::app::genomes::{self, Specimen};
use crate::app::table::lay_out;
use crate::creature::{self, Controller, Development, JointKind, Link};
use crate::formats::network_csv::{self, Row};
use crate::formats::urdf::ReadBody;
use crate::formats::{BodyInspection, Inspection};
use crate::runs::Failure;
use crate::runs::config::Config;
use std::path::Path;

/// Shows the body or the network in a file.
///
/// # Errors
/// If it cannot be read or expressed.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
    let scales = args.changes.scales();
    let config = args.settings.over(Config { scales, ..Config::default() });
    config.check()?;
    let encoding = config.locomotion().encoding;
    if let Some(rows) = genomes::network(&args.genome)? {
        show_network(&rows, args);
        return Ok(());
    }
    if args.dot {
        return Err(Failure::usage("--dot draws networks, and this is none: leave it out"));
    }
    match Specimen::read(&args.genome, &encoding, &args.changes)? {
        Specimen::Body(body) if args.json => {
            print(&json(&BodyInspection::new(&body, source(&args.genome))));
        }
        Specimen::Body(body) => show_body(&body),
        Specimen::Genome(genome) => {
            let wrong =
                |error| Failure::usage(format!("cannot build {}: {error}", args.genome.display()));
            let (links_max, reading) = (config.max_links, encoding.reading());
            let development = creature::develop(&genome, reading, links_max).map_err(wrong)?;
            match args.json {
                true => print(&json(&Inspection::new(
                    &development,
                    reading.profile,
                    source(&args.genome),
                ))),
                false => show_genome(&development),
            }
        }
    }
    Ok(())
}

fn show_network(rows: &[Row], args: &InspectArgs) {
    if args.dot {
        return print(network_csv::dot(rows).trim_end());
    }
    if args.json {
        return print(&json(&rows));
    }
    let heads = ["part", "from", "to", "weight", "in use", "function"].map(str::to_owned);
    let row = |row: &Row| {
        let weight = row.weight.map(|weight| format!("{weight:.3}")).unwrap_or_default();
        let in_use = row.enabled.map(|enabled| if enabled { "yes" } else { "no" });
        let function = row.function.map(|it| it.to_string()).unwrap_or_default();
        let [part, from, to] = [&row.part, &row.from, &row.to].map(Clone::clone);
        [part, from, to, weight, in_use.unwrap_or_default().to_owned(), function]
    };
    print(&lay_out(&[heads].into_iter().chain(rows.iter().map(row)).collect::<Vec<_>>()));
}

fn json(inspection: &impl serde::Serialize) -> String {
    serde_json::to_string(inspection).expect("a body is plain data, its numbers finite")
}

fn source(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn show_genome(development: &Development) {
    print(
        "link  name     parent  shape     length m  radius m   mass kg  joint     amplitude rad/s  torque N·m",
    );
    let creature = development.creature();
    for (index, (copy, link)) in development.tree.iter().zip(&creature.morphology.links).enumerate()
    {
        let traits = &development.traits[copy.gene];
        let [amplitude, torque] = said(&creature.controller, index);
        print(&format!(
            "{index:>4}  {:<8} {:>6}  {:<9} {:>8.3}  {:>8.3} {:>9.3}  {:<8} {amplitude:>16} {torque:>11}",
            copy.name(index),
            copy.parent.map_or_else(|| "-".to_owned(), |parent| parent.to_string()),
            link.shape.name(),
            traits.length_m,
            traits.radius_m,
            link.mass_kg,
            joint(link),
        ));
    }
}

fn show_body(body: &ReadBody) {
    let heads = [
        "link",
        "name",
        "parent",
        "shape",
        "size m",
        "mass kg",
        "joint",
        "amplitude rad/s",
        "torque N·m",
    ];
    let mut rows = vec![heads.map(str::to_owned)];
    let links = body.creature.morphology.links.iter().zip(&body.link_names);
    for (index, (link, name)) in links.enumerate() {
        let size = link.shape.half_extents_m() * 2.0;
        let [amplitude, torque] = said(&body.creature.controller, index);
        rows.push([
            index.to_string(),
            name.clone(),
            link.joint.as_ref().map_or_else(|| "-".to_owned(), |joint| joint.parent.to_string()),
            link.shape.name().to_owned(),
            format!("{:.3} × {:.3} × {:.3}", size.x, size.y, size.z),
            format!("{:.3}", link.mass_kg),
            joint(link).to_owned(),
            amplitude,
            torque,
        ]);
    }
    print(&lay_out(&rows));
}

fn joint(link: &Link) -> &'static str {
    match link.joint.as_ref().map(|joint| joint.kind) {
        None => "root",
        Some(JointKind::Fixed) => "fixed",
        Some(JointKind::Revolute(_)) => "hinge",
    }
}

/// The top speed and the torque of a link's motor.
fn said(controller: &Controller, link: usize) -> [String; 2] {
    let speed = controller.wave(link).map(|wave| format!("{:.2}", wave.amplitude_rad_s));
    let torque = controller.motors[link].map(|motor| format!("{:.1}", motor.torque_nm_max));
    [speed, torque].map(Option::unwrap_or_default)
}
