//! A film that is there is lost neither to damage nor to impatience.

use crate::support::reel::Recording;
use crate::support::{Ending, TINY, World, rewrite, until};
use islands::store::{Entry, RecordLog, RunDir};
use std::path::Path;

#[test]
fn a_recording_that_is_there_is_not_lost_to_damaged_logs() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let dir = RunDir::at(world.path("run"));
    let (files, recording) = (world.files(), std::fs::read(dir.recording()).unwrap());
    let refused = || {
        let Ending { code, stdout, stderr } = world.islands("monitor run");
        assert_eq!((code, stdout.as_str()), (Some(1), ""), "{stderr}");
        assert_eq!(world.files(), files);
        assert_eq!(std::fs::read(dir.recording()).unwrap(), recording);
        stderr
    };
    let entries = RecordLog::<Entry>::read(&dir.reports(1)).unwrap().records;
    rewrite(&dir.reports(1), &entries[..3]);
    let said = "error: the run in run has come to generation 3 of island 1, whose logs hold only the first 3 of its 4 \
                generations; run/recording.rrd is left as it was\n";
    assert_eq!(refused(), said);

    rewrite(&dir.reports(1), [&entries[0], &entries[2]]);
    let warning = "warning: run/reports/island-1.log is damaged: after 1 generations it has generation 2 \
                   of island 1; the film shows island 1 up to there only\n";
    assert_eq!(refused(), format!("{warning}{}", said.replace("first 3", "first 1")));

    std::fs::remove_file(dir.recording()).unwrap();
    let ending = world.islands("monitor run");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let recording = Recording::read(&dir.recording());
    let lengths = [0, 1].map(|island| recording.scalars(&format!("/diversity/{island}")).len());
    assert_eq!(lengths, [4, 1]);
}

#[test]
fn a_recording_that_is_there_is_not_lost_to_damaged_champions_even_without_a_summary() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let dir = RunDir::at(world.path("run"));
    let recording = std::fs::read(dir.recording()).unwrap();
    std::fs::remove_file(dir.summary()).unwrap();
    for damage in [&b""[..], &[0x5a; 4_000]] {
        std::fs::write(dir.champions(1), damage).unwrap();
        let ending = world.islands("monitor run");
        let said = "warning: run/champions/island-1.log is damaged: it has no champion of generation 0; the film shows \
                    island 1 up to there only\n\
                    error: the run in run has come to generation 3 of island 1, whose logs hold only the first 0 of its 4 \
                    generations; run/recording.rrd is left as it was\n";
        assert_eq!((ending.code, ending.stderr.as_str()), (Some(1), said));
        assert_eq!(std::fs::read(dir.recording()).unwrap(), recording);
    }
}

#[test]
fn who_interrupts_a_monitor_does_not_wait_for_what_is_not_shown_yet() {
    let world = World::new();
    let run = "--problem sphere --dimensions 2 --n 1 --seed 5 --population 4 --generations 30000";
    world.json(&format!("{run} --out run --no-monitor --quiet --json --checkpoint-interval 30000"));
    let dir = RunDir::at(world.path("run"));
    let drafts = || world.files().len();
    let files = drafts();
    let monitor = world.start("monitor run --view off");
    until("it films", || drafts() > files);
    monitor.signal("INT");
    let ending = monitor.wait();
    let is_filmed = dir.recording().exists();
    assert_eq!(ending.code, Some(if is_filmed { 0 } else { 130 }), "{ending:?}");
    let shown = |path: &Path| Recording::read(path).generations(1).last().copied();
    let shown = if is_filmed { shown(&dir.recording()) } else { None };
    assert!(shown.is_none_or(|generation| generation < 30_000), "{shown:?}");
    assert_eq!(drafts(), files + usize::from(is_filmed));

    std::fs::write(dir.recording(), "an older film").unwrap();
    let monitor = world.start("monitor run --view off");
    until("it films", || drafts() > files + 1);
    monitor.signal("INT");
    let ending = monitor.wait();
    let said = "error: interrupted; run/recording.rrd is left as it was\n";
    assert_eq!((ending.code, ending.stderr.as_str()), (Some(130), said));
    assert_eq!(world.read("run/recording.rrd"), "an older film");
}

#[test]
fn what_is_no_file_is_no_film() {
    let world = World::new();
    world.json(&format!("--n 1 --seed 3 --out run --no-monitor --quiet --json {TINY}"));
    let pipe = world.path("run/recording.rrd");
    assert!(std::process::Command::new("mkfifo").arg(pipe).status().unwrap().success());
    let ending = world.json("resume run --no-monitor --quiet --json");
    assert_eq!(ending.get("recording"), None);
}

#[test]
fn a_recording_that_is_there_is_not_lost_to_a_full_disk() {
    let world = World::new();
    world.json(&format!("--n 2 --seed 41 --out run --quiet --json {TINY}"));
    let path = world.path("run/recording.rrd");
    let (files, recording) = (world.files(), std::fs::read(&path).unwrap());
    for (arguments, name) in [
        ("monitor run", "run/recording.rrd"),
        ("replay run/champion.csv --out run/recording.rrd", "run/recording.rrd"),
        ("replay run/champion.csv --out champion.rrd", "champion.rrd"),
    ] {
        // To a process that may write so little in a file, the disk is full.
        let mut command = std::process::Command::new("sh");
        command.args(["-c", "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$@\""]);
        command.arg(world.command("").get_program()).args(arguments.split(' '));
        let ending: Ending = command.current_dir(world.path("")).output().unwrap().into();
        assert_eq!(ending.code, Some(1), "{ending:?}");
        let said = format!("error: cannot write the recording {name}: ");
        assert!(ending.stderr.contains(&said), "{ending:?}");
        assert_eq!(world.files(), files);
        assert_eq!(std::fs::read(&path).unwrap(), recording);
    }
}
