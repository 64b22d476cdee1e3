//! `verify` finds whatever is not as the run left it, names it, and changes nothing.

mod tools;

use crate::support::{TINY, World, until};
use islands::archipelago::{Births, Champion, Outbox};
use islands::creature::Gene;
use islands::evolution::{Fitness, Id};
use islands::formats::metrics;
use islands::store::{Checkpoint, Entry, RecordLog, RunDir};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tools::{a_bit_more, changed, cut, evolved, finds, flip, forge, forge_state, lengthen, verify};

/// A run that nobody waits for, whose islands exchange, with champions that are not soon the last.
const ENDLESS: &str =
    "--population 4 --robustness 0 --generations 1000000 --genes 1 --migration-interval 1";

#[test]
fn a_sound_run_is_verified_with_its_digest() {
    let world = World::new();
    let digest = world.digest("run", &format!("--n 2 --seed 3 {TINY}"));
    let table = verify(&world, "run");
    assert_eq!((table.code, table.stderr.as_str()), (Some(0), ""), "{table:?}");
    assert!(table.stdout.contains(&digest), "{table:?}");
    assert!(!table.stdout.contains('\u{1b}'), "colours where there is no terminal: {table:?}");
    for thorough in ["", "--thorough"] {
        let verdict = verify(&world, &format!("run --json --threads 2 {thorough}")).json();
        assert_eq!((&verdict["ok"], &verdict["finished"]), (&true.into(), &true.into()));
        assert_eq!(verdict["digest"].as_str(), Some(digest.as_str()));
        let [champions, simulated] =
            ["champions", "simulated"].map(|key| verdict[key].as_u64().unwrap());
        let dir = RunDir::at(world.path("run"));
        let logs = [0, 1].map(|i| RecordLog::<Champion<Gene>>::read(&dir.champions(i)).unwrap());
        assert_eq!(champions as usize, logs.iter().map(|log| log.records.len()).sum::<usize>());
        assert_eq!(simulated > champions, thorough == "--thorough", "{verdict}");
        assert!(verdict["damaged"].as_array().unwrap().is_empty(), "{verdict}");
    }
}

/// Such a run has no column of species.
#[test]
fn a_run_from_before_there_were_species_is_verified_and_its_metrics_are_not_taken_on_trust() {
    let world = World::new();
    world.digest("run", &format!("--n 2 --seed 3 {TINY}"));
    let path = RunDir::at(world.path("run")).metrics();
    let older = metrics::without_species(&fs::read(&path).unwrap()).unwrap();
    assert!(!String::from_utf8(older.clone()).unwrap().contains("species"));
    fs::write(&path, &older).unwrap();
    assert_eq!(verify(&world, "run").code, Some(0));
    let last = older.len() - 2;
    fs::write(&path, [&older[..last], b"7\n"].concat()).unwrap();
    assert_eq!(verify(&world, "run").code, Some(1));
}

#[test]
fn a_flipped_bit_is_found_in_every_file_that_has_a_checksum() {
    let world = evolved();
    let files: [fn(&RunDir) -> PathBuf; 6] = [
        |dir| dir.champions(0),
        |dir| dir.lineages(1),
        |dir| dir.reports(1),
        |dir| dir.migrations(0),
        |dir| dir.checkpoint(0, 3),
        |dir| dir.checkpoint(1, 2),
    ];
    for file in files {
        let places: [fn(usize) -> usize; 3] = [|_| 0, |length| length / 2, |length| length - 1];
        for place in places {
            finds(&world, file, |dir| flip(&file(dir), place));
        }
        finds(&world, file, |dir| cut(&file(dir), 1));
        finds(&world, file, |dir| lengthen(&file(dir)));
    }
    for file in &files[..5] {
        finds(&world, file, |dir| fs::remove_file(file(dir)).unwrap());
    }
}

#[test]
fn a_champion_that_is_not_as_good_as_recorded_is_found_by_simulating_it_again() {
    let world = evolved();
    let last = |dir: &RunDir| {
        let mut log = RecordLog::<Champion<Gene>>::open(&dir.champions(1)).unwrap();
        let mut champion = log.get(log.len() - 1).unwrap().unwrap();
        log.truncate(log.len() - 1).unwrap();
        a_bit_more(&mut champion.individual.fitness);
        log.append(&champion).unwrap();
        champion
    };
    let mut forged = None;
    let verdict = finds(&world, |dir| dir.champions(1), |dir| forged = Some(last(dir)));
    let Champion { generation, individual, .. } = forged.unwrap();
    let fitness = individual.fitness.get();
    let expected = serde_json::json!([{
        "who": "champion",
        "island": 1,
        "generation": generation,
        "recorded": fitness,
        "found": fitness.next_down(),
    }]);
    assert_eq!(verdict["mismatches"], expected);
}

#[test]
fn a_genome_that_cannot_have_lived_is_a_mismatch_and_not_simulated() {
    let world = evolved();
    let wrong: [fn(&mut Vec<Gene>); 3] = [
        |genome| genome.clear(),
        |genome| genome[0].0[3] = f64::NAN,
        |genome| genome.resize(1_000_000, Gene([0.5; 17])),
    ];
    for wrong in wrong {
        changed(&world, |dir| {
            forge(&dir.champions(0), |champions: &mut Vec<Champion<Gene>>| {
                wrong(&mut champions[0].individual.genome);
            });
        });
        let table = verify(&world, "changed");
        assert_eq!(table.code, Some(1), "{table:?}");
        assert!(table.stdout.contains("has a genome that cannot have lived"), "{table:?}");
        let verdict = verify(&world, "changed --json").json();
        assert_eq!(verdict["mismatches"][0]["found"], Value::Null, "{verdict}");
    }
}

#[test]
fn residents_and_migrants_are_simulated_again_if_that_is_asked_for() {
    let world = evolved();
    // The state before the last: what it says is in no digest.
    let dir = changed(&world, |dir| {
        fs::remove_file(dir.summary()).unwrap();
        (0..2).for_each(|island| fs::remove_file(dir.checkpoint(island, 3)).unwrap());
        let mut forged = None;
        forge_state(dir, 1, 2, |saved| {
            let born = saved.island.population.iter_mut().filter(|one| one.id.generation == 2);
            let worse = born.min_by_key(|one| one.fitness).unwrap();
            a_bit_more(&mut worse.fitness);
            forged = Some(worse.id);
        });
        // Nor must the records contradict it.
        let Id { island, generation, index } = forged.unwrap();
        forge(&dir.lineages(island), |log: &mut Vec<Births>| {
            a_bit_more(&mut log[generation as usize].births[index as usize].fitness);
        });
        forge(&dir.migrations(0), |outboxes: &mut Vec<Outbox<Gene>>| {
            let worst = &mut outboxes[2].migrants[1].fitness;
            *worst = Fitness::new(worst.get().next_down());
        });
    });
    assert!(!dir.summary().exists());
    let superficial = verify(&world, "changed");
    assert_eq!(superficial.code, Some(0), "{superficial:?}");
    let ending = verify(&world, "changed --thorough --json");
    assert_eq!(ending.code, Some(1), "{ending:?}");
    let verdict = ending.json();
    let found = verdict["mismatches"].as_array().unwrap();
    let who: Vec<_> = found.iter().map(|one| (&one["who"], &one["island"])).collect();
    assert_eq!(who, [(&"resident".into(), &1.into()), (&"migrant".into(), &0.into())]);
}

#[test]
fn records_that_contradict_one_another_are_found_although_their_checksums_are_right() {
    let world = evolved();
    type Champions = Vec<Champion<Gene>>;
    type Outboxes = Vec<Outbox<Gene>>;
    let reports: [fn(&mut Vec<Entry>); 8] = [
        |entries| entries.swap(1, 2),
        |entries| entries[1].report.island = 0,
        |entries| entries[2].report.effort.evaluations += 1,
        |entries| entries[2].report.effort.outcomes = [u64::MAX; 7].into(),
        |entries| entries[3].report.immigrants = 0,
        |entries| entries[3].seconds = f64::NAN,
        |entries| a_bit_more(&mut entries[3].report.statistics.best),
        |entries| entries.push(entries[3]),
    ];
    for wrong in reports {
        finds(&world, |dir| dir.reports(1), |dir| forge(&dir.reports(1), wrong));
    }
    let champions: [fn(&mut Champions); 4] = [
        |champions| champions.push(champions[0].clone()),
        |champions| champions[0].generation = 1,
        |champions| champions.truncate(0),
        |champions| champions.last_mut().unwrap().individual.id.index += 1,
    ];
    for wrong in champions {
        finds(&world, |dir| dir.champions(1), |dir| forge(&dir.champions(1), wrong));
    }
    let lineages: [fn(&mut Vec<Births>); 5] = [
        |log| log.swap(1, 2),
        |log| log[2].births.truncate(1),
        |log| log[2].births[0].parents = [None; 2],
        |log| log[1].births[0].parents[0].as_mut().unwrap().generation = 1,
        |log| a_bit_more(&mut log[3].births[0].fitness),
    ];
    for wrong in lineages {
        finds(&world, |dir| dir.lineages(1), |dir| forge(&dir.lineages(1), wrong));
    }
    let outboxes: [fn(&mut Outboxes); 5] = [
        |outboxes| outboxes.swap(0, 1),
        |outboxes| outboxes[1].migrants.truncate(1),
        |outboxes| outboxes[1].migrants[1].fitness = Fitness::new(1e9),
        |outboxes| outboxes[1].migrants[0].genome[0].0[0] = 1.0,
        |outboxes| a_bit_more(&mut outboxes[1].migrants[0].fitness),
    ];
    for wrong in outboxes {
        finds(&world, |dir| dir.migrations(1), |dir| forge(&dir.migrations(1), wrong));
    }
}

#[test]
fn a_champion_whom_its_ancestors_cannot_have_bred_is_found_without_simulating_anything() {
    let world = evolved();
    let forge_genome = |dir: &RunDir| {
        let change = |champions: &mut Vec<Champion<Gene>>| {
            champions[0].individual.genome[0].0[0] = 0.123;
        };
        forge(&dir.champions(0), change);
    };
    let verdict = finds(&world, |dir| dir.champions(0), forge_genome);
    let said = verdict["damaged"][0].as_str().unwrap();
    assert!(said.contains("the ancestors of 0.0.") && said.contains(" breed another"), "{said}");
}

#[test]
fn a_state_that_is_not_the_runs_is_found_although_its_checksum_is_right() {
    let world = evolved();
    let wrong: [fn(&mut Checkpoint<Gene>); 4] = [
        |saved| saved.settings.push_str("more = 1\n"),
        |saved| saved.island.population.truncate(3),
        |saved| saved.island.index = 0,
        |saved| saved.island.generation = 7,
    ];
    for wrong in wrong {
        finds(&world, |dir| dir.checkpoint(1, 3), |dir| forge_state(dir, 1, 3, wrong));
    }
    finds(
        &world,
        |dir| dir.checkpoint(1, 7),
        |dir| {
            fs::copy(dir.checkpoint(1, 3), dir.checkpoint(1, 7)).unwrap();
            forge_state(dir, 1, 7, |saved| saved.island.generation = 7);
        },
    );
    let verdict = finds(&world, RunDir::summary, |dir| {
        forge_state(dir, 1, 3, |saved| {
            let last = saved.island.population.last_mut().unwrap();
            last.genome[0].0[0] = 0.5;
        });
    });
    assert!(verdict["damaged"][0].as_str().unwrap().contains("final populations have"));
}

#[test]
fn a_claim_about_the_whole_run_is_compared_with_what_its_islands_left() {
    let world = evolved();
    let summary: Value = serde_json::from_str(&world.read("run/summary.json")).unwrap();
    for (key, value) in summary.as_object().unwrap() {
        if ["run_dir", "best_genome", "version"].contains(&key.as_str()) {
            continue;
        }
        let mut wrong = summary.clone();
        wrong[key] = match value {
            Value::String(text) => text.replace(|c: char| c.is_alphanumeric(), "0").into(),
            Value::Array(_) => Value::Array(Vec::new()),
            number => (number.as_f64().unwrap() + 1.0).into(),
        };
        finds(&world, RunDir::summary, |dir| fs::write(dir.summary(), wrong.to_string()).unwrap());
    }
    finds(&world, RunDir::summary, |dir| fs::write(dir.summary(), "{").unwrap());
    finds(&world, RunDir::summary, |dir| fs::write(dir.summary(), "{}").unwrap());
    for file in [RunDir::champion_genome, RunDir::champion_body, RunDir::metrics] {
        // In the middle of either is a number.
        finds(&world, file, |dir| flip(&file(dir), |length| length / 2));
        finds(&world, file, |dir| cut(&file(dir), 1));
        finds(&world, file, |dir| fs::remove_file(file(dir)).unwrap());
    }
}

#[test]
fn an_interrupted_run_is_verified_and_has_no_digest_yet() {
    let world = World::new();
    let run = world.start(&format!("--n 2 --seed 3 --out run --no-monitor --quiet {ENDLESS}"));
    let dir = RunDir::at(world.path("run"));
    let generations =
        |island| RecordLog::<Entry>::read(&dir.reports(island)).map_or(0, |log| log.records.len());
    until("every island has evolved", || (0..2).all(|island| generations(island) > 3));
    let refusal = world.islands("verify run");
    let said = "error: the run in run is under way: stop it first, or wait until it has finished\n";
    assert_eq!((refusal.code, refusal.stderr.as_str()), (Some(2), said));
    run.signal("INT");
    run.wait();
    let ending = verify(&world, "run");
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(0), ""), "{ending:?}");
    assert!(ending.stdout.contains("none yet: the run has not finished"), "{ending:?}");
    let verdict = verify(&world, "run --json").json();
    assert_eq!((&verdict["finished"], &verdict["digest"]), (&false.into(), &Value::Null));

    let logs: [fn(&RunDir) -> PathBuf; 3] =
        [|dir| dir.reports(0), |dir| dir.champions(0), |dir| dir.migrations(0)];
    for log in logs {
        changed(&world, |dir| lengthen(&log(dir)));
        let verdict = verify(&world, "changed --json").json();
        assert_eq!(verdict["ok"], true, "{verdict}");
        let note = "ends in a torn record of 7 bytes, which a resume writes again";
        assert!(verdict["notes"].to_string().contains(note), "{verdict}");
        // What the newest checkpoint needs is no longer there: no kill leaves that.
        finds(&world, log, |dir| cut(&log(dir), 1));
        finds(&world, log, |dir| fs::remove_file(log(dir)).unwrap());
    }
    finds(
        &world,
        |dir| dir.checkpoints(1),
        |dir| {
            fs::remove_dir_all(dir.checkpoints(1)).unwrap();
        },
    );
}

#[test]
fn a_run_of_another_version_is_verified_with_a_word_of_it() {
    let world = evolved();
    let older =
        |text: &str| text.replace(&format!("\"{}\"", env!("CARGO_PKG_VERSION")), "\"0.0.7\"");
    let rename = |dir: &RunDir| {
        fs::write(dir.config(), older(&fs::read_to_string(dir.config()).unwrap())).unwrap();
    };
    finds(&world, |dir| dir.checkpoint(0, 3), rename);
    changed(&world, |dir| {
        rename(dir);
        for (island, generation) in [(0, 2), (0, 3), (1, 2), (1, 3)] {
            forge_state(dir, island, generation, |saved| saved.settings = older(&saved.settings));
        }
    });
    let ending = verify(&world, "changed");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert!(ending.stdout.contains("version 0.0.7"), "{ending:?}");
    assert!(ending.stdout.contains(concat!("but this is version ", env!("CARGO_PKG_VERSION"))));
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let world = World::new();
    fs::create_dir(world.path("empty")).unwrap();
    world.write("file", "");
    for name in ["empty", "file", "nowhere"] {
        let said =
            format!("there is no run in {name}: name the folder of one, such as runs/walk-seed7");
        assert_eq!(world.refusal(&format!("verify {name}")), said);
    }
    assert_eq!(world.refusal("verify empty --threads 0"), "--threads must be at least 1");
}

#[test]
fn a_folder_that_holds_anything_is_damaged_and_no_trap() {
    let world = evolved();
    let files: [fn(&RunDir) -> PathBuf; 9] = [
        RunDir::config,
        RunDir::summary,
        RunDir::metrics,
        RunDir::champion_genome,
        RunDir::champion_body,
        |dir| dir.champions(0),
        |dir| dir.reports(0),
        |dir| dir.migrations(0),
        |dir| dir.checkpoint(0, 3),
    ];
    let make: [fn(&Path); 4] = [
        |path| fs::create_dir(path).unwrap(),
        |path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success()),
        |path| std::os::unix::fs::symlink("/dev/zero", path).unwrap(),
        |path| fs::write(path, [0xff; 4096]).unwrap(),
    ];
    for file in files {
        for make in make {
            finds(&world, file, |dir| {
                fs::remove_file(file(dir)).unwrap();
                make(&file(dir));
            });
        }
    }
    let escape = "\"\\u001b[2J\" = 1";
    for settings in [escape, "", "islands = 4000000000", "population = 0\n[launch]", "seed = 1"] {
        finds(&world, RunDir::config, |dir| fs::write(dir.config(), settings).unwrap());
        let ending = verify(&world, "changed");
        let moves_the_cursor = |text: &str| text.contains('\u{1b}');
        assert!(![ending.stdout, ending.stderr].iter().any(|text| moves_the_cursor(text)));
    }
}
