//! What goes wrong around a run has a clear end: a sentence that says what to do, nothing left behind, and the
//! result of the undisturbed run once the fault is gone.

use crate::support::forger::Forger;
use crate::support::{Ending, Running, World, await_generation, run_id, signal, until};
use islands::archipelago::{Digest, Outbox, lockstep};
use islands::creature::Gene;
use islands::runs::config::{Config, Launch};
use islands::store::{Entry, RecordLog, RunDir};
use std::fs;
use std::process::{Command, Stdio};

/// A run of short generations that nobody waits for.
const ENDLESS: &str = "--out run --seed 3 --population 4 --robustness 0 --generations 1000000 --genes 1 \
                       --migration-interval 1 --no-monitor --quiet";
/// One that writes much, evolves nothing and needs little shared memory.
const COPYIST: &str = "--out run --seed 3 --population 8 --robustness 0 --migrants 8 --elites 1 --genes 1 --max-genes 1 \
                       --crossover-rate 0 --point-rate 0 --shrink-rate 0 --grow-rate 0 --migration-interval 1";
/// So often an island may end by itself at the same generation.
const FAILURES_MAX: usize = 5;

/// Starts a run and waits until every island has evolved a few generations.
fn start(world: &World, islands: u32) -> (Running, RunDir) {
    let run = world.start(&format!("--n {islands} {ENDLESS}"));
    let dir = RunDir::at(world.path("run"));
    await_generation(&dir, islands, 3);
    (run, dir)
}

/// How a run ends that must.
fn end_of(run: Running) -> Ending {
    until("the run ends", || !run.is_alive());
    run.wait()
}

/// What a run ends with, which must be this exit code and a sentence that begins and ends like this.
fn assert_ends(ending: &Ending, code: i32, beginning: &str, end: &str) {
    let said = ending.stderr.lines().next_back().unwrap_or_default();
    let is_so = said.starts_with(&format!("error: {beginning}")) && said.ends_with(end);
    assert!(is_so && ending.code == Some(code) && ending.stdout.is_empty(), "{ending:?}");
}

/// The last generation that an island of a run has recorded.
fn reached(dir: &RunDir, island: u32) -> u32 {
    RecordLog::<Entry>::read(&dir.reports(island)).unwrap().records.len() as u32 - 1
}

/// The epochs that an island of a run has sent.
fn epochs(dir: &RunDir, island: u32) -> u32 {
    RecordLog::<Outbox<Gene>>::read(&dir.migrations(island)).unwrap().records.len() as u32
}

/// Asserts that the run in a folder left nothing else, goes on, and ends as if nothing had ever happened.
/// Returns what was said about it.
fn assert_goes_on(world: &World, name: &str) -> String {
    world.assert_left_nothing();
    let dir = RunDir::at(world.path(name));
    let mut config = Config::read(&dir.config()).unwrap();
    config.generations = 3 + (0..config.islands).map(|i| reached(&dir, i)).max().unwrap();
    let ending = world.islands(&format!(
        "resume {name} --generations {} --no-monitor --quiet --json",
        config.generations
    ));
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let (problem, archipelago) = (config.locomotion(), config.archipelago());
    let expected = lockstep::run(&problem, &archipelago, config.generations, |_| ());
    assert_eq!(ending.json()["digest"], Digest::of(&expected).to_string());
    world.assert_left_nothing();
    ending.stderr
}

#[test]
fn a_run_that_shared_memory_is_too_small_for_is_refused_in_numbers() {
    let world = World::new();
    let huge =
        Config { islands: 256, migrants: 32, population: 32, max_genes: 1000, ..Config::default() };
    let launch = Launch { version: env!("CARGO_PKG_VERSION").to_owned(), run_id: "1".to_owned() };
    let begun = Config { seed: Some(3), launch: Some(launch), ..huge };
    fs::create_dir(world.path("begun")).unwrap();
    world.write("begun/run.toml", begun.to_toml());
    let new = "--n 256 --migrants 32 --population 32 --max-genes 1000 --out new";
    for arguments in [new, "resume begun"] {
        let said = world.refusal(arguments);
        let mut mib = said.split_whitespace().filter_map(|word| word.parse::<u64>().ok());
        let [needed, free] = [mib.next().unwrap(), mib.next().unwrap()];
        assert!(needed > free && said.contains("/dev/shm has only"), "{said}");
    }
}

/// The same command where no file can grow beyond so many KiB: a write then fails as on a full disk.
fn where_files_end_at(kib: u32, command: &Command) -> Command {
    let mut shell = Command::new("sh");
    // What is ignored is inherited. A block has 512 bytes.
    shell.args(["-c", &format!("trap '' XFSZ; ulimit -f {}; exec \"$0\" \"$@\"", 2 * kib)]);
    shell.arg(command.get_program()).args(command.get_args());
    shell.envs(command.get_envs().filter_map(|(name, value)| Some((name, value?))));
    shell.current_dir(command.get_current_dir().unwrap()).stdin(Stdio::null());
    shell
}

#[test]
fn a_full_disk_ends_a_run_with_the_file_and_the_reason_and_nothing_is_lost() {
    let world = World::new();
    let run = format!(
        "--n 2 {COPYIST} --generations 1000000 --checkpoint-interval 20 --no-monitor --quiet"
    );
    let ending: Ending = where_files_end_at(200, &world.command(&run)).output().unwrap().into();
    let dir = RunDir::at(world.path("run"));
    let reached = [0, 1].map(|island| reached(&dir, island));
    let island =
        usize::from(ending.stderr.lines().next_back().unwrap().contains("error: island 1"));
    let beginning = format!(
        "island {island} ended by itself 5 times after generation {} (exit status: 1), saying “cannot append to \
         run/migrations/island-{island}.log: File too large (os error 27)”",
        reached[island] - 1
    );
    let end = "; the run stops, and nothing is lost; go on with: islands resume run";
    assert_ends(&ending, 1, &beginning, end);
    assert!(reached[island] > 100, "{reached:?}");
    let said = assert_goes_on(&world, "run");
    assert!(!said.contains("warning"), "{said}");
}

#[test]
fn a_launcher_that_cannot_write_names_the_file_and_nothing_is_lost() {
    for file in ["champion.csv", "summary.json"] {
        let world = World::new();
        let (run, dir) = start(&world, 2);
        run.signal("INT");
        assert_eq!(end_of(run).code, Some(130));
        let path = dir.path().join(file);
        let _ = fs::remove_file(&path);
        // No file takes the place of a folder with something in it.
        fs::create_dir_all(path.join("occupied")).unwrap();
        let generations = 1 + reached(&dir, 0).max(reached(&dir, 1));
        let ending =
            world.islands(&format!("resume run --generations {generations} --no-monitor --quiet"));
        let beginning = format!("cannot write run/{file}: Is a directory (os error 21)");
        let end = "; the run stops, and nothing is lost; go on with: islands resume run";
        assert_ends(&ending, 1, &beginning, end);
        fs::remove_dir_all(path).unwrap();
        assert_goes_on(&world, "run");
    }
}

#[test]
fn a_run_whose_folder_is_removed_ends_at_once_and_says_so() {
    let world = World::new();
    let (run, dir) = start(&world, 2);
    let id = run_id(&world.read("run/run.toml"));
    // Its processes may be making files in it just now.
    until("the folder is gone", || fs::remove_dir_all(dir.path()).is_ok() || !dir.path().exists());
    let ending = end_of(run);
    let beginning = "the run's folder run is gone: somebody has moved or removed it";
    assert_ends(&ending, 1, beginning, "what was moved can go on with islands resume");
    assert!(!dir.path().exists(), "nobody makes it again");
    world.assert_left_nothing_of(&id);
}

#[test]
fn a_run_whose_folder_is_moved_ends_at_once_and_goes_on_in_its_new_place() {
    let world = World::new();
    let (run, dir) = start(&world, 2);
    fs::rename(dir.path(), world.path("elsewhere")).unwrap();
    assert_ends(&end_of(run), 1, "the run's folder run is gone: ", "can go on with islands resume");
    assert!(!dir.path().exists(), "nobody makes it again");
    assert_goes_on(&world, "elsewhere");
}

#[test]
fn without_the_folder_of_its_checkpoints_an_island_ends_the_run_and_begins_again_from_the_seed() {
    let world = World::new();
    let (run, dir) = start(&world, 2);
    let folder = dir.checkpoints(1);
    until("the folder is gone", || fs::remove_dir_all(&folder).is_ok() || !folder.exists());
    let ending = end_of(run);
    assert_ends(&ending, 1, "island 1 ended by itself 5 times", "go on with: islands resume run");
    assert!(
        ending.stderr.contains("run/checkpoints/island-1: No such file or directory"),
        "{ending:?}"
    );
    let said = assert_goes_on(&world, "run");
    assert!(
        said.contains("island 1: no checkpoint is of use: it starts again from the seed"),
        "{said}"
    );
}

#[test]
fn what_cannot_be_from_an_island_is_refused_counted_and_reported_and_changes_nothing() {
    let world = World::new();
    let (run, dir) = start(&world, 2);
    let forger = Forger::join(&world);
    // Epochs that are yet to come, so that what is believed would take the place of what is true.
    let ahead = epochs(&dir, 0) + 20;
    type Forgery = fn(&mut islands::transport::wire::BatchHeader, &mut Vec<Gene>);
    let forgeries: [Forgery; 16] = [
        |header, _| header.count = 3,
        |header, _| header.count = u32::MAX,
        |header, _| header.migrants[0].gene_count = 0,
        |header, _| header.migrants[0].gene_count = 13,
        |header, _| header.migrants[0].gene_count = u32::MAX,
        |_, genes| genes.push(genes[0]),
        |_, genes| genes[0].0[16] = f64::NAN,
        |_, genes| genes[0].0[0] = f64::INFINITY,
        |_, genes| genes[0].0[0] = -0.1,
        |header, _| header.migrants[0].fitness = f64::NAN,
        |header, _| header.migrants[0].fitness = f64::INFINITY,
        |header, _| header.migrants[0].id = [2, 0, 0],
        |header, _| header.migrants[0].parents[1] = [0, u32::MAX - 1, 0],
        |header, _| header.island = 1,
        |header, _| header.run_id ^= 1,
        |header, _| header.epoch = u32::MAX,
    ];
    for (forgery, epoch) in forgeries.into_iter().zip(ahead..) {
        forger.send(epoch, forgery);
    }
    // What was taken in long ago is nothing to speak of.
    forger.send(0, |_, _| ());
    let last = ahead + forgeries.len() as u32;
    until("these epochs have come", || epochs(&dir, 0).min(epochs(&dir, 1)) > last + 3);
    run.signal("INT");
    let ending = end_of(run);
    let end = "; nothing is lost; go on with: islands resume run";
    assert_ends(&ending, 130, "interrupted after generation ", end);
    let refused = |count| {
        format!("WARN island 1: refused {count} batch(es) of migrants that came as island 0's: ")
    };
    let log = world.read("run/run.log");
    assert!([1, 2, 4, 8, 16].iter().all(|&count| log.contains(&refused(count))), "{log}");
    assert!(!log.contains(&refused(32)), "{log}");
    assert_eq!(ending.stderr.matches("warning: island 1: refused ").count(), 5, "{ending:?}");
    world.assert_left_nothing();
    drop(forger);
    assert_goes_on(&world, "run");
}

#[test]
fn islands_wait_for_one_that_is_stopped_and_say_for_whom() {
    let world = World::new();
    let (run, dir) = start(&world, 3);
    let stopped = run.child("--index=1");
    signal(stopped, "STOP");
    let words = "of island 1, which may be stopped";
    until("its neighbour wonders", || world.read("run/run.log").contains(words));
    signal(stopped, "CONT");
    await_generation(&dir, 3, reached(&dir, 0) + 3);
    run.signal("INT");
    let ending = end_of(run);
    assert_eq!(ending.code, Some(130), "{ending:?}");
    let wonders =
        |line: &str| line.starts_with("warning: island 2: has waited ") && line.contains(words);
    assert!(ending.stderr.lines().any(wonders), "{ending:?}");
    assert!(!ending.stderr.contains("died"), "{ending:?}");
    assert_goes_on(&world, "run");
}

#[test]
fn a_run_with_a_stopped_island_can_be_interrupted() {
    let world = World::new();
    let (run, _) = start(&world, 3);
    signal(run.child("--index=1"), "STOP");
    run.signal("INT");
    let ending = end_of(run);
    assert_eq!(ending.code, Some(130), "{ending:?}");
    assert_goes_on(&world, "run");
}

/// Starts a run of two islands in which island 1 cannot get any further until the process is continued that is
/// returned with it: island 0.
fn start_without_progress(world: &World) -> (Running, u32) {
    let (run, dir) = start(world, 2);
    let island = run.child("--index=0");
    signal(island, "STOP");
    // What island 0 had journalled and not sent yet its neighbour reads there when it is born again.
    signal(run.child("--index=1"), "KILL");
    // With an interval of 1 and a lag of 1, epoch k is taken in by generation k + 3 at its beginning.
    until("it gets no further", || dir.checkpoint(1, epochs(&dir, 0) + 2).exists());
    (run, island)
}

/// Sends these signals to island 1 and to those that come after it, one to each.
fn kill_again_and_again<'a>(run: &Running, signals: impl IntoIterator<Item = &'a str>) {
    let mut dead = None;
    for name in signals {
        let is_another = |pid: u32| Some(pid) != dead;
        until("it is born again", || run.find_child("--index=1").is_some_and(is_another));
        let pid = run.child("--index=1");
        signal(pid, name);
        dead = Some(pid);
    }
}

#[test]
fn an_island_that_ends_itself_again_and_again_without_progress_stops_the_run() {
    let world = World::new();
    let (run, other) = start_without_progress(&world);
    kill_again_and_again(&run, ["ABRT"; FAILURES_MAX]);
    signal(other, "CONT");
    let ending = end_of(run);
    let beginning = "island 1 ended by itself 5 times after generation ";
    assert_ends(&ending, 1, beginning, "go on with: islands resume run");
    assert!(ending.stderr.contains("(signal: 6 (SIGABRT)"), "{ending:?}");
    assert_eq!(ending.stderr.matches("it is started again").count(), FAILURES_MAX, "{ending:?}");
    assert_goes_on(&world, "run");
}

#[test]
fn an_island_that_is_killed_again_and_again_from_outside_is_never_given_up() {
    let world = World::new();
    let (run, other) = start_without_progress(&world);
    let own_fault = ["ABRT"; FAILURES_MAX - 1];
    let from_outside = ["KILL", "TERM"].repeat(FAILURES_MAX.div_ceil(2));
    kill_again_and_again(&run, own_fault.into_iter().chain(from_outside));
    signal(other, "CONT");
    let dir = RunDir::at(world.path("run"));
    await_generation(&dir, 2, reached(&dir, 0) + 3);
    run.signal("INT");
    let ending = end_of(run);
    assert_eq!(ending.code, Some(130), "{ending:?}");
    assert_goes_on(&world, "run");
}

#[test]
fn an_island_that_cannot_start_stops_the_run_and_says_why() {
    let world = World::new();
    let (run, dir) = start(&world, 3);
    run.signal("INT");
    assert_eq!(end_of(run).code, Some(130));
    let journal = dir.migrations(1);
    fs::remove_file(&journal).unwrap();
    fs::create_dir(&journal).unwrap();
    let ending = world.islands("resume run --no-monitor --quiet");
    let beginning = "island 1 ended by itself 5 times before it had evolved anything (exit status: 1), saying “cannot open \
                     run/migrations/island-1.log: Is a directory (os error 21)”";
    assert_ends(&ending, 1, beginning, "go on with: islands resume run");
    fs::remove_dir(&journal).unwrap();
    let said = assert_goes_on(&world, "run");
    assert!(
        said.contains("island 1: no checkpoint is of use: it starts again from the seed"),
        "{said}"
    );
}

#[test]
#[cfg(feature = "view")]
fn a_recording_that_finds_no_room_costs_the_film_and_nothing_else() {
    let world = World::new();
    let settings = format!("--n 1 {COPYIST} --generations 100 --json");
    let ending: Ending =
        where_files_end_at(170, &world.command(&settings)).output().unwrap().into();
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let is_about_it = |line: &&str| line.starts_with("warning: the monitor");
    let warnings: Vec<_> = ending.stderr.lines().filter(is_about_it).collect();
    assert!(warnings.iter().any(|line| line.contains("recording.rrd")), "{warnings:?}");
    let config = Config::read(&world.path("run/run.toml")).unwrap();
    let undisturbed =
        lockstep::run(&config.locomotion(), &config.archipelago(), config.generations, |_| ());
    assert_eq!(ending.json()["digest"], Digest::of(&undisturbed).to_string());
    assert!(ending.json().get("recording").is_none(), "half a film is no film");
    world.assert_left_nothing();
}

#[test]
#[cfg(feature = "view")]
fn islands_do_not_wait_for_a_monitor_that_is_stopped() {
    let world = World::new();
    let run = world.start(&format!("--n 2 {COPYIST} --generations 200 --json"));
    let monitor = run.child("monitor");
    signal(monitor, "STOP");
    let dir = RunDir::at(world.path("run"));
    await_generation(&dir, 2, 200);
    signal(monitor, "CONT");
    let ending = end_of(run);
    assert_eq!(ending.code, Some(0), "{ending:?}");
    assert!(!ending.stderr.contains("warning"), "{ending:?}");
    assert_eq!(ending.json()["recording"], "run/recording.rrd");
    world.assert_left_nothing();
}
