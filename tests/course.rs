//! The course's genomes: thousands exist, and each must become the same body here, link for link.

use expect_test::{Expect, expect};
use islands::creature::gene::{PARAMETER_COUNT, VALUE_MAX};
use islands::creature::profile::COURSEWORK_LINKS_MAX;
use islands::creature::{Gene, Profile, express};
use islands::evolution::Problem;
use islands::formats::{GenomeCsvError, Inspection, genome_csv};
use islands::problems::{Locomotion, Task};
use islands::rng::{Purpose, Source};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

const FIXTURES: usize = 7;

fn fixture(name: &str) -> String {
    let path: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "tests/fixtures/course", name].iter().collect();
    fs::read_to_string(path).unwrap()
}

fn genome(name: &str) -> Vec<Gene> {
    let read = genome_csv::read(fixture(name).as_bytes()).unwrap();
    assert_eq!(read.clamped, [], "{name}");
    read.genome
}

/// Asserts that two JSON values are the same, numbers to the last bit, whether written as 1 or 1.0.
fn assert_same(found: &Value, expected: &Value, place: &str) {
    match (found, expected) {
        (Value::Object(found), Value::Object(expected)) => {
            assert!(found.keys().eq(expected.keys()), "{place}: {found:?}, not {expected:?}");
            for (key, value) in expected {
                assert_same(&found[key], value, &format!("{place}.{key}"));
            }
        }
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{place}");
            for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
                assert_same(found, expected, &format!("{place}[{i}]"));
            }
        }
        (Value::Number(_), Value::Number(_)) => {
            let (found, expected) = (found.as_f64().unwrap(), expected.as_f64().unwrap());
            assert_eq!(found.to_bits(), expected.to_bits(), "{place}: {found}, not {expected}");
        }
        _ => assert_eq!(found, expected, "{place}"),
    }
}

#[test]
fn every_genome_of_the_course_becomes_the_same_links_to_the_last_bit() {
    for i in 0..FIXTURES {
        let source = format!("genome_{i}.csv");
        let creature = express(&genome(&source), Profile::Coursework, 1).unwrap();
        let found = Inspection::new(&creature, Profile::Coursework, source.as_str());
        let expected = fixture(&format!("genome_{i}.expected.json"));
        let expected: Value = serde_json::from_str(&expected).unwrap();
        assert_same(&serde_json::to_value(found).unwrap(), &expected, &source);
    }
}
