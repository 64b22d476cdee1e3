//! The command that films the champion of a run, as the run tried it.

use crate::app::console::quoted;
use crate::runs::config::Config;
use crate::store::RunDir;

/// The command, as a shell takes it.
pub fn command(dir: &RunDir, config: &Config) -> String {
    let genome = quoted(&dir.champion_genome());
    let flags: Vec<String> = flags(dir, config).iter().map(|flag| format!("{flag} ")).collect();
    format!("islands replay {genome} {}--out champion.rrd", flags.concat())
}

/// How the run tried its bodies.
fn flags(dir: &RunDir, config: &Config) -> Vec<String> {
    let mut flags = vec![format!("--task {} --profile {}", config.task, config.profile)];
    flags.extend(config.scales.iter().map(|(name, scale)| format!("--scale {name}={scale}")));
    let Config { robustness, robust_by, judged, engine, .. } = config;
    flags.push(format!(
        "--engine {engine} --robustness {robustness} --robust-by {robust_by} --judged={judged}"
    ));
    flags.push(format!("--max-links {}", config.max_links));
    if config.terrain.is_some() {
        flags.push(format!("--terrain {}", quoted(&dir.terrain())));
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::{Profile, Scales};
    use crate::problems::{RobustBy, Task};
    use crate::runs::terrains::KeptTerrain;

    #[test]
    fn the_command_says_how_the_run_tried_its_bodies_and_can_be_pasted_into_a_shell() {
        let mut scales = Scales::NONE;
        scales.set("link-length", 0.5).unwrap();
        let config = Config {
            task: Task::Climb,
            profile: Profile::Coursework,
            scales,
            robustness: 3,
            robust_by: RobustBy::Mean,
            max_links: 9,
            terrain: Some(KeptTerrain { digest: String::new(), terrain: None }),
            ..Config::default()
        };
        assert_eq!(
            command(&RunDir::at("my run"), &config),
            "islands replay 'my run/champion.csv' --task climb --profile coursework --scale link-length=0.5 \
             --engine featherstone --robustness 3 --robust-by mean --judged=false --max-links 9 --terrain 'my run/terrain.csv' --out champion.rrd"
        );
    }
}
