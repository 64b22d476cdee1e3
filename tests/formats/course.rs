//! The course's genomes: thousands exist, and each must become the same body here, link for link.

use crate::support::assert_same;
use expect_test::expect;
use islands::creature::encodings::course::profile::COURSEWORK_LINKS_MAX;
use islands::creature::encodings::course::{PARAMETER_COUNT, VALUE_MAX};
use islands::creature::{Course, ExpressionError, Gene, Profile, develop, express};
use islands::evolution::Problem;
use islands::formats::{GenomeCsvError, Inspection, genome_csv};
use islands::problems::Locomotion;
use islands::rng::{Purpose, Source};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

pub const FIXTURES: usize = 7;

pub fn fixture(name: &str) -> String {
    let path: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "tests/fixtures/course", name].iter().collect();
    fs::read_to_string(path).unwrap()
}

fn genome(name: &str) -> Vec<Gene> {
    let read = genome_csv::read(&Course::DEFAULT, fixture(name).as_bytes()).unwrap();
    assert_eq!(read.clamped, [], "{name}");
    read.genome
}

#[test]
fn every_genome_of_the_course_becomes_the_same_links_to_the_last_bit() {
    for i in 0..FIXTURES {
        let source = format!("genome_{i}.csv");
        let development = develop(&genome(&source), Profile::Coursework, 1).unwrap();
        let found = Inspection::new(&development, Profile::Coursework, source.as_str());
        let expected = fixture(&format!("genome_{i}.expected.json"));
        let expected: Value = serde_json::from_str(&expected).unwrap();
        assert_same(&serde_json::to_value(found).unwrap(), &expected, &source);
    }
}

#[test]
fn writing_a_genome_and_reading_it_gives_the_same_bits() {
    let problem =
        Locomotion { encoding: Course { genes: 5, ..Course::DEFAULT }, ..Locomotion::default() };
    let random = (0..200).map(|index| {
        let mut rng = Source { seed: 17, island: 0 }.stream(0, index, Purpose::Genesis);
        problem.random_genome(&mut rng)
    });
    let ends = [0.0, f64::from_bits(1), f64::MIN_POSITIVE, 1e-7, VALUE_MAX];
    let extreme = ends.map(|value| vec![Gene([value; PARAMETER_COUNT])]);
    for genome in random.chain(extreme) {
        let mut file = Vec::new();
        genome_csv::write(&genome, &mut file).unwrap();
        let read = genome_csv::read(&Course::DEFAULT, file.as_slice()).unwrap();
        assert_eq!(read.clamped, []);
        let bits = |genome: &[Gene]| -> Vec<u64> {
            genome.iter().flat_map(|gene| gene.0).map(f64::to_bits).collect()
        };
        assert_eq!(bits(&read.genome), bits(&genome));
    }
}

#[test]
fn the_courses_files_are_written_back_byte_for_byte() {
    for i in 0..FIXTURES {
        let name = format!("genome_{i}.csv");
        let mut file = Vec::new();
        genome_csv::write(&genome(&name), &mut file).unwrap();
        assert_eq!(String::from_utf8(file).unwrap(), fixture(&name));
    }
}

/// A line of 17 numbers, the one at `column` (from 1) replaced.
fn line_with(column: usize, cell: &str) -> String {
    let mut cells = ["0.5"; PARAMETER_COUNT];
    cells[column - 1] = cell;
    cells.join(",")
}

#[test]
fn line_ends_blank_lines_a_byte_order_mark_and_a_last_comma_make_no_difference() {
    let [a, b] = [line_with(1, "0.25"), line_with(17, "2.5e-1")];
    let expected = genome_csv::read(&Course::DEFAULT, format!("{a}\n{b}\n").as_bytes()).unwrap();
    assert_eq!(expected.genome.len(), 2);
    for file in [
        format!("{a},\n{b},\n"),
        format!("{a}\r\n{b},\r\n"),
        format!("\u{feff}{a}\n\n  \r\n{b}"),
        format!("\n {} \n{b}\n\n", a.replace(',', " , ")),
    ] {
        assert_eq!(
            genome_csv::read(&Course::DEFAULT, file.as_bytes()).unwrap(),
            expected,
            "{file:?}"
        );
    }
}

#[test]
fn a_value_of_one_or_more_is_clamped_and_reported() {
    let file = format!("{}\n\n{}\n", line_with(2, "1.0"), line_with(17, "1.077"));
    let read = genome_csv::read(&Course::DEFAULT, file.as_bytes()).unwrap();
    assert_eq!(read.genome[0].0[1], VALUE_MAX);
    assert_eq!(read.genome[1].0[16], VALUE_MAX);
    let reports: Vec<String> = read.clamped.iter().map(ToString::to_string).collect();
    expect![[r#"
        line 1, column 2 (link-length) was 1 and is now just under 1
        line 3, column 17 (control-freq) was 1.077 and is now just under 1"#]]
    .assert_eq(&reports.join("\n"));
}

#[test]
fn a_broken_file_is_refused_with_the_line_and_what_to_do() {
    let good = line_with(1, "0.5");
    let lines = [
        "0.5",
        "0.5;0.5",
        &good[4..],
        &line_with(1, "0.5,0.5"),
        &line_with(1, "0.5,0.5,0.5"),
        &format!("{good},0.5,0.5,0.5,"),
        &line_with(2, "-0.1"),
        &line_with(5, "NaN"),
        &line_with(5, "-inf"),
        &line_with(5, "1e999"),
        &line_with(15, ""),
        &line_with(16, &"sine".repeat(20)),
        &line_with(17, "\u{1b}[31m"),
        &"0.5,".repeat(10_000),
    ];
    let after_good = lines.map(|line| format!("{good}\n\n{line}\n").into_bytes());
    let files = [
        b"".to_vec(),
        b"\xef\xbb\xbf\r\n \n".to_vec(),
        b"0.5,\xff\n".to_vec(),
        vec![b'\n'; genome_csv::LINES_MAX + 1],
    ];
    let errors = files.iter().chain(&after_good).map(|file| {
        let error: GenomeCsvError =
            genome_csv::read(&Course::DEFAULT, file.as_slice()).unwrap_err();
        error.to_string()
    });
    let expected = expect![[r#"
        the file holds no gene: give one with at least one line of 17 numbers
        the file holds no gene: give one with at least one line of 17 numbers
        line 1 is not UTF-8 text: give a CSV file of numbers
        the file has more than 100000 lines: give one genome a file
        line 3 has 1 column instead of 17: write a gene a line, its numbers separated by commas
        line 3 has 1 column instead of 17: write a gene a line, its numbers separated by commas
        line 3 has 16 columns instead of 17: write a gene a line, its numbers separated by commas
        line 3 has 18 columns instead of 17: leave out the additional one, link-geometry, usually with --drop-column 6
        line 3 has 19 columns instead of 17: leave out the additional ones, sensor gain and bias, usually with --drop-column 18 --drop-column 19
        line 3 has 20 columns instead of 17: write a gene a line, its numbers separated by commas
        line 3, column 2 (link-length) holds "-0.1": write a number from 0 (included) to 1 (excluded) there
        line 3, column 5 (link-mass) holds "NaN": write a number from 0 (included) to 1 (excluded) there
        line 3, column 5 (link-mass) holds "-inf": write a number from 0 (included) to 1 (excluded) there
        line 3, column 5 (link-mass) holds "1e999": write a number from 0 (included) to 1 (excluded) there
        line 3, column 15 (control-waveform) holds "": write a number from 0 (included) to 1 (excluded) there
        line 3, column 16 (control-amp) holds "sinesinesinesinesinesine": write a number from 0 (included) to 1 (excluded) there
        line 3, column 17 (control-freq) holds "\u{1b}[31m": write a number from 0 (included) to 1 (excluded) there
        line 3 is longer than 32768 bytes: give a gene a line"#]];
    expected.assert_eq(&errors.collect::<Vec<_>>().join("\n"));
}

#[test]
fn a_body_over_512_links_is_refused_by_name() {
    // Each gene's link is built twice on the link before it: 1 + 2 + 4 + ... links.
    let mut gene = Gene([0.5; PARAMETER_COUNT]);
    gene.0[3] = 0.4;
    gene.0[6] = VALUE_MAX;
    let links = |genes| {
        let creature = express(&vec![gene; genes], Profile::Coursework, 1)?;
        Ok(creature.morphology.links.len())
    };
    assert_eq!(links(9), Ok(COURSEWORK_LINKS_MAX - 1));
    let refused = ExpressionError::TooManyLinks {
        builder: "profile coursework".into(),
        max: COURSEWORK_LINKS_MAX,
    };
    assert_eq!(links(10), Err(refused.clone()));
    expect!["the body has more than 512 links, the most that profile coursework builds"]
        .assert_eq(&refused.to_string());
}
