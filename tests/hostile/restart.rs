//! What an island goes on from after its files were damaged, forged or led astray.

use super::pieces::{SETTINGS, archipelago, checkpoint_file, folder};
use super::seeds;
use crate::support::{TINY, World, until};
use islands::archipelago::{Archipelago, Island};
use islands::creature::Gene;
use islands::evolution::Id;
use islands::runs::config::Config;
use islands::store::{Checkpoint, Claim, Logbook, Restored, RunDir, StoreError, checkpoint};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A run directory in memory with files of island 0, which can be put back as they were.
struct Shelf {
    home: TempDir,
    archipelago: Archipelago,
    settings: String,
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Shelf {
    /// Island 0 of a run of the program.
    fn of_the_program() -> Self {
        let world = World::new();
        world.digest("run", &format!("--n 2 --seed 3 {TINY}"));
        let from = RunDir::at(world.path("run"));
        let config = Config::read(&from.config()).unwrap();
        let shelf = Self::new(config.archipelago(), config.settings());
        shelf.filled_from(&from)
    }

    /// Island 0 of a run of [`seeds::steps`].
    fn of_steps() -> Self {
        let shelf = Self::new(archipelago(), SETTINGS.to_owned());
        let claim = create(&shelf.dir(), 2).unwrap();
        let mut logbook = shelf.open().unwrap().logbook;
        for step in seeds::steps() {
            logbook.record(&step, 0.5).unwrap();
            logbook.save(&step.island).unwrap();
        }
        drop((logbook, claim));
        let from = shelf.dir();
        shelf.filled_from(&from)
    }

    fn new(archipelago: Archipelago, settings: String) -> Self {
        Self { home: folder(), archipelago, settings, files: Vec::new() }
    }

    fn filled_from(mut self, from: &RunDir) -> Self {
        let files = |dir: &RunDir| {
            let logs = [dir.champions(0), dir.lineages(0), dir.reports(0), dir.migrations(0)];
            let [last, before] = [3, 2].map(|generation| dir.checkpoint(0, generation));
            logs.into_iter().chain([before, last])
        };
        let bytes = files(from).map(|path| fs::read(path).unwrap());
        self.files = files(&self.dir()).zip(bytes).collect();
        drop(self.reopen().or_else(|_| create(&self.dir(), 2)).unwrap());
        self.put_back();
        self
    }

    fn dir(&self) -> RunDir {
        RunDir::at(self.home.path().join("run"))
    }

    /// Claims the run. A process that another test starts shares all our files until it is itself, a lock that
    /// we have given back among them.
    fn reopen(&self) -> Result<Claim, StoreError> {
        let mut claim = None;
        until("nobody else has the run", || {
            let claimed = claim.insert(reopen(&self.dir(), 2));
            !matches!(claimed, Err(StoreError::UnderWay { .. }))
        });
        claim.unwrap()
    }

    fn put_back(&self) {
        self.files.iter().for_each(|(path, bytes)| fs::write(path, bytes).unwrap());
    }

    fn last(&self) -> &(PathBuf, Vec<u8>) {
        self.files.last().unwrap()
    }

    fn open(&self) -> Result<Restored<Gene>, StoreError> {
        Logbook::open(&self.dir(), &self.archipelago, 0, &self.settings)
    }

    /// Asserts that the island starts from generation 2, and that this is what is said about generation 3.
    fn falls_back(&self, what: &str) -> String {
        let restored = self.open().unwrap();
        assert_eq!(restored.island.map(|island| island.generation), Some(2), "{what}");
        let [warning] = restored.warnings.try_into().unwrap();
        let path = self.last().0.display();
        warning.strip_prefix(&format!("{path} is damaged: ")).unwrap().to_owned()
    }
}

#[test]
fn a_checkpoint_with_any_byte_flipped_or_missing_is_named_and_the_one_before_it_is_used() {
    let shelf = Shelf::of_the_program();
    let (path, whole) = shelf.last();
    assert_eq!(shelf.open().unwrap().island.unwrap().generation, 3, "it is whole");
    for at in 0..whole.len() {
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (at % 8);
        for (damage, bytes) in [("flipped", &flipped[..]), ("cut", &whole[..at])] {
            shelf.put_back();
            fs::write(path, bytes).unwrap();
            shelf.falls_back(&format!("{damage} at {at}"));
        }
    }
}

#[test]
fn without_any_whole_checkpoint_an_island_begins_from_the_seed_and_says_why() {
    let shelf = Shelf::of_steps();
    for (path, bytes) in &shelf.files[4..] {
        fs::write(path, &bytes[1..]).unwrap();
    }
    let restored = shelf.open().unwrap();
    assert_eq!(restored.island, None);
    assert_eq!(restored.warnings.len(), 3);
    assert_eq!(restored.warnings[2], "no checkpoint is of use: it starts again from the seed");
    assert_eq!(restored.logbook.epochs(), 3, "what was sent was sent");
}

#[test]
fn a_state_that_cannot_be_of_the_run_is_not_believed_whatever_its_checksum_says() {
    let shelf = Shelf::of_steps();
    let nowhere = Id { island: 2, generation: 0, index: 0 };
    let unborn = Id { island: 0, generation: 4, index: 0 };
    type Forge<'a> = &'a dyn Fn(&mut Island<Gene>);
    let forgeries: [(Forge<'_>, &str); 10] = [
        (&|it| it.population.clear(), "its population has the wrong size"),
        (&|it| it.population.truncate(2), "its population has the wrong size"),
        (&|it| it.population[0].genome.clear(), "it has a genome that is empty or too long"),
        (
            &|it| it.champion.genome = vec![Gene([0.5; 17]); 4],
            "it has a genome that is empty or too long",
        ),
        (&|it| it.population[2].genome[0].0[16] = f64::NAN, "it has a gene that is not valid"),
        (&|it| it.champion.genome[0].0[0] = 1.0, "it has a gene that is not valid"),
        (
            &|it| it.population[0].parents[1] = Some(nowhere),
            "it has an individual that was born nowhere",
        ),
        (&|it| it.champion.id = unborn, "it has an individual that was born nowhere"),
        (&|it| it.population[1].fitness = 1e9.into(), "its champion is not the best"),
        (&|it| it.effort.reused = u64::MAX, "its evaluations do not add up"),
    ];
    for (forge, reason) in forgeries {
        shelf.put_back();
        forge_last(&shelf, forge);
        assert_eq!(shelf.falls_back(reason), reason);
    }
    shelf.put_back();
    forge_last(&shelf, &|it| it.effort.outcomes = [u64::MAX; 7].into());
    assert_eq!(shelf.falls_back("outcomes"), "its evaluations do not add up");
}

fn forge_last(shelf: &Shelf, forge: &dyn Fn(&mut Island<Gene>)) {
    let (path, bytes) = shelf.last();
    let mut forged: Checkpoint<Gene> = checkpoint::from_bytes(bytes, path).unwrap();
    forge(&mut forged.island);
    fs::write(path, checkpoint::to_bytes(&forged)).unwrap();
}

#[test]
fn a_state_of_another_format_version_stops_the_island_rather_than_start_it_anew() {
    let shelf = Shelf::of_steps();
    let path = &shelf.last().0;
    fs::write(path, checkpoint_file(2, b"whatever version 2 will be")).unwrap();
    let error = shelf.open().err().unwrap().to_string();
    let expected = "has format version 2, and this program reads version 1";
    assert_eq!(error, format!("{} {expected}", path.display()));
}

#[test]
fn links_in_a_run_directory_are_refused_and_what_they_lead_to_stays_as_it_is() {
    let outside = folder();
    let precious = outside.path().join("precious");
    fs::write(&precious, "a file").unwrap();
    let folders =
        ["champions", "reports", "migrations", "checkpoints", "checkpoints/island-1", ".partial"];
    for name in folders {
        let shelf = Shelf::of_steps();
        let place = shelf.dir().path().join(name);
        let _ = fs::remove_dir_all(&place);
        symlink(outside.path(), &place).unwrap();
        let error = shelf.reopen().map(drop).unwrap_err().to_string();
        assert!(error.contains("it is a link"), "{error}");
        assert_holds_only(outside.path(), &precious);
    }
    for log in [RunDir::champions, RunDir::reports, RunDir::migrations] {
        let shelf = Shelf::of_steps();
        let place = log(&shelf.dir(), 0);
        fs::remove_file(&place).unwrap();
        symlink(&precious, &place).unwrap();
        assert!(shelf.open().is_err(), "{}", place.display());
        assert_holds_only(outside.path(), &precious);
    }
}

#[test]
fn a_checkpoint_that_is_a_link_is_replaced_and_not_written_through() {
    let shelf = Shelf::of_steps();
    let outside = folder();
    let precious = outside.path().join("precious");
    fs::write(&precious, "a file").unwrap();
    let path = &shelf.last().0;
    fs::remove_file(path).unwrap();
    symlink(&precious, path).unwrap();
    let claim = shelf.reopen().unwrap();
    shelf.falls_back("a link to something else");
    let mut logbook = shelf.open().unwrap().logbook;
    let step = &seeds::steps()[3];
    logbook.record(step, 0.5).unwrap();
    logbook.save(&step.island).unwrap();
    drop((logbook, claim));
    assert!(!path.is_symlink());
    assert_eq!(shelf.open().unwrap().island.as_ref(), Some(&step.island));
    assert_holds_only(outside.path(), &precious);
}

fn assert_holds_only(folder: &Path, precious: &Path) {
    let left: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|it| it.unwrap().path()).collect();
    assert_eq!(left, [precious]);
    assert_eq!(fs::read(precious).unwrap(), b"a file");
}

#[test]
fn a_run_directory_that_is_a_pipe_is_not_waited_for() {
    let home = folder();
    let pipe = home.path().join("pipe");
    rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RWXU).unwrap();
    let dir = RunDir::at(&pipe);
    assert!(dir.create().is_err());
    assert!(reopen(&dir, 1).is_err());
    assert!(dir.is_under_way().is_err());
}

#[test]
fn a_run_whose_champions_are_a_pipe_is_not_waited_for() {
    let world = World::new();
    world.digest("run", &format!("--n 1 --seed 3 {TINY}"));
    let champions = world.path("run/champions");
    fs::remove_dir_all(&champions).unwrap();
    rustix::fs::mkfifoat(rustix::fs::CWD, &champions, rustix::fs::Mode::RWXU).unwrap();
    let monitor = world.start("monitor run");
    until("the monitor has given up", || !monitor.is_alive());
    let ending = monitor.wait();
    assert_eq!(ending.code, Some(1), "{ending:?}");
    assert!(ending.stderr.contains("run/champions"), "{ending:?}");
}

#[test]
fn what_a_checkpoint_says_commands_no_terminal() {
    let world = World::new();
    world.digest("run", &format!("--n 1 --seed 3 {TINY}"));
    let dir = RunDir::at(world.path("run"));
    let path = dir.checkpoint(0, 3);
    let mut forged = checkpoint::load::<Gene>(&path).unwrap();
    forged.settings.push_str("\"\\u001b]0;owned\\u0007\" = 1\n");
    fs::write(&path, checkpoint::to_bytes(&forged)).unwrap();
    let said = world.islands("resume run --generations 4").stderr;
    assert!(said.contains("owned") && said.contains("is 1"), "{said}");
    assert!(!said.contains(|c: char| c.is_control() && c != '\n'), "{said:?}");
}

/// As a new run makes its folder.
fn create(dir: &RunDir, islands: u32) -> Result<Claim, StoreError> {
    let claim = dir.create()?;
    claim.make_folders(islands)?;
    Ok(claim)
}

/// As a run that goes on opens its folder.
fn reopen(dir: &RunDir, islands: u32) -> Result<Claim, StoreError> {
    let claim = dir.claim()?;
    claim.make_folders(islands)?;
    Ok(claim)
}
