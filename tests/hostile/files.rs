//! What the program says to files that are not what they should be.

use crate::support::{Ending, World, until};
use expect_test::expect;
use islands::creature::encodings::course::PARAMETER_COUNT;
use std::fs::{self, File};
use std::os::unix::fs::symlink;

/// Files of every unfriendly kind, and what is said of each.
fn unfriendly(world: &World) -> Vec<&'static str> {
    symlink("/dev/zero", world.path("endless")).unwrap();
    let pipe = world.path("pipe");
    rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RWXU).unwrap();
    fs::create_dir(world.path("folder")).unwrap();
    symlink("circle", world.path("circle")).unwrap();
    File::create(world.path("sparse")).unwrap().set_len(1 << 30).unwrap();
    world.write("latin", b"\xe9\xe8\xea");
    world.write("escape", "engine = \"\\u001b[2J\"");
    world.write("line", "0.5,".repeat(200_000));
    world.write("nested", format!("genes = {}", "[".repeat(100_000)));
    world.write("dotted", format!("{}a = 1", "a.".repeat(100_000)));
    vec![
        "endless", "pipe", "folder", "circle", "sparse", "latin", "escape", "line", "nested",
        "dotted",
    ]
}

/// How the program ends, which it must soon.
fn ending(world: &World, arguments: &str) -> Ending {
    let running = world.start(arguments);
    until(&format!("islands {arguments} has ended"), || !running.is_alive());
    running.wait()
}

/// What a command says to each file, which it must refuse.
fn refusals(world: &World, command: &str, files: &[&str]) -> String {
    let before = world.files();
    let sentences = files.iter().map(|file| {
        let ending = ending(world, &command.replace("FILE", file));
        assert_eq!((ending.code, ending.stdout.as_str()), (Some(2), ""), "{file}: {ending:?}");
        let sentence = ending.stderr.strip_suffix('\n').unwrap().to_owned();
        assert!(!sentence.contains(char::is_control) && sentence.len() < 600, "{sentence:?}");
        sentence.strip_prefix("error: ").unwrap().to_owned()
    });
    let sentences: Vec<String> = sentences.collect();
    assert_eq!(world.files(), before);
    world.assert_left_nothing();
    sentences.join("\n")
}

#[test]
fn an_unfriendly_genome_file_is_refused_with_a_sentence_and_soon() {
    let world = World::new();
    let mut files = unfriendly(&world);
    let cells = |cell: &str| format!("{}{}", "0.5,".repeat(PARAMETER_COUNT - 1), cell);
    for (name, cell) in [("nan", "NaN"), ("inf", "inf"), ("huge", "1e999"), ("below", "-0.1")] {
        world.write(name, cells(cell));
        files.push(name);
    }
    world.write("empty", "");
    world.write("blank", "\u{feff}\r\n \r\n");
    files.extend(["empty", "blank"]);
    let said = refusals(&world, "evaluate FILE", &files);
    assert_eq!(refusals(&world, "inspect FILE --json", &files), said);
    #[cfg(feature = "view")]
    {
        // A folder may be that of a run.
        let [of_a_file, of_a_folder] = [
            "cannot use folder: it is no regular file; name a file with a gene a line, such as a run's champion.csv",
            "there is no run in folder: name the folder of one, such as runs/walk-seed7",
        ];
        let expected = said.replace(of_a_file, of_a_folder);
        assert_eq!(refusals(&world, "replay FILE --out film.rrd", &files), expected);
    }
    expect![[r#"
        cannot use endless: it is no regular file; name a file with a gene a line, such as a run's champion.csv
        cannot use pipe: it is no regular file; name a file with a gene a line, such as a run's champion.csv
        cannot use folder: it is no regular file; name a file with a gene a line, such as a run's champion.csv
        cannot use circle: Too many levels of symbolic links (os error 40); name a file with a gene a line, such as a run's champion.csv
        cannot use sparse: it is larger than 67108864 bytes; name a file with a gene a line, such as a run's champion.csv
        cannot use latin: line 1 is not UTF-8 text: give a CSV file of numbers
        cannot use escape: line 1 has 1 column instead of 17: write a gene a line, its numbers separated by commas
        cannot use line: line 1 is longer than 32768 bytes: give a gene a line
        cannot use nested: line 1 is longer than 32768 bytes: give a gene a line
        cannot use dotted: line 1 is longer than 32768 bytes: give a gene a line
        cannot use nan: line 1, column 17 (control-freq) holds "NaN": write a number from 0 (included) to 1 (excluded) there
        cannot use inf: line 1, column 17 (control-freq) holds "inf": write a number from 0 (included) to 1 (excluded) there
        cannot use huge: line 1, column 17 (control-freq) holds "1e999": write a number from 0 (included) to 1 (excluded) there
        cannot use below: line 1, column 17 (control-freq) holds "-0.1": write a number from 0 (included) to 1 (excluded) there
        cannot use empty: the file holds no gene: give one with at least one line of 17 numbers
        cannot use blank: the file holds no gene: give one with at least one line of 17 numbers"#]]
    .assert_eq(&said);
}

#[test]
fn an_unfriendly_configuration_is_refused_with_a_sentence_and_soon() {
    let world = World::new();
    let mut files = unfriendly(&world);
    world.write("seed", "seed = -1");
    world.write("islands", "islands = 4294967295");
    world.write("nan", "grow-rate = nan");
    world.write("threads", "threads = 9223372036854775807");
    world.write("selection", "selection = \"tournament:1e308\"");
    files.extend(["seed", "islands", "nan", "threads", "selection"]);
    let said = refusals(&world, "run --config FILE --no-monitor", &files);
    expect![[r#"
        cannot use endless: it is no regular file; name a file such as a run's run.toml
        cannot use pipe: it is no regular file; name a file such as a run's run.toml
        cannot use folder: it is no regular file; name a file such as a run's run.toml
        cannot use circle: Too many levels of symbolic links (os error 40); name a file such as a run's run.toml
        cannot use sparse: it is larger than 1048576 bytes; name a file such as a run's run.toml
        cannot use latin: it is not text; name a file such as a run's run.toml
        cannot use escape: line 1: unknown variant ` [2J`, expected `rapier` or `featherstone`
        cannot use line: line 1: key with no value, expected `=`
        cannot use nested: line 1: cannot recurse further; max recursion depth met
        cannot use dotted: recursion limit
        cannot use seed: line 1: invalid value: integer `-1`, expected u64
        islands (--n) must be from 1 to 256, not 4294967295
        grow-rate must be from 0 to 1, not NaN
        threads must be from 1 to 4096, not 9223372036854776000
        cannot use selection: line 1: tournament takes a whole number from 1 to 1000"#]]
    .assert_eq(&said);
    world.write("long", format!("{} = 1", "x".repeat(100_000)));
    assert!(world.refusal("--config long").len() < 600);
}

#[test]
fn a_genome_from_another_system_is_read_like_ours() {
    let world = World::new();
    let line = ["0.5"; PARAMETER_COUNT].join(", ");
    world.write("ours", format!("{line},\n{line},\n"));
    world.write("theirs", format!("\u{feff}{line}\r\n\r\n{line}\r\n"));
    let score = |name: &str| {
        let scores = world.json(&format!("evaluate {name} --json"));
        scores["genomes"][0]["fitness"].as_f64().unwrap().to_bits()
    };
    assert_eq!(score("theirs"), score("ours"));
}

#[test]
fn a_genome_without_end_to_its_warnings_or_links_is_bounded() {
    let world = World::new();
    world.write("ones", format!("{}\n", ["1"; PARAMETER_COUNT].join(",")).repeat(1_000));
    let ending = ending(&world, "inspect ones");
    assert_eq!(ending.code, Some(0), "{ending:?}");
    let last = ending.stderr.lines().last().unwrap();
    assert_eq!(last, "warning: ones: 16980 more values are just under 1 now");
    assert_eq!(ending.stderr.lines().count(), 21);
    let sentence = "max-links must be from 1 to 512, not 1000000";
    for command in ["inspect", "evaluate"] {
        assert_eq!(world.refusal(&format!("{command} ones --max-links 1000000")), sentence);
    }
}
