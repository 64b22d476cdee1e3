//! The command that films the champion of a run, as the run tried it.

use crate::app::console::quoted;
use crate::runs::config::{Config, SETTINGS};
use crate::runs::setting::Setting;
use crate::store::RunDir;

/// The command, as a shell takes it.
pub fn command(dir: &RunDir, config: &Config) -> String {
    let genome = quoted(&dir.champion_genome());
    let flags: Vec<String> = flags(dir, config).iter().map(|flag| format!("{flag} ")).collect();
    format!("islands replay {genome} {}--out champion.rrd", flags.concat())
}

/// How the run tried its bodies.
fn flags(dir: &RunDir, config: &Config) -> Vec<String> {
    let table = toml::Table::try_from(config).expect("a checked configuration is plain data");
    let settings = SETTINGS.iter().filter(|setting| setting.about.tries_bodies);
    let flag = |setting: &Setting<Config>| {
        let value = table.get(&setting.name)?;
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        // Without an equals sign a switch has no value.
        let between = if value.is_bool() { "=" } else { " " };
        Some(format!("--{}{between}{text}", setting.flag()))
    };
    let mut flags: Vec<String> = settings.filter_map(flag).collect();
    flags.extend(config.scales.iter().map(|(name, scale)| format!("--scale {name}={scale}")));
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
            "islands replay 'my run/champion.csv' --task climb --profile coursework --engine featherstone \
             --robustness 3 --robust-by mean --judged=false --max-links 9 --scale link-length=0.5 --terrain 'my run/terrain.csv' --out champion.rrd"
        );
    }
}
