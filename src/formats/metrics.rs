//! The metrics of a run: a row an island and generation, as CSV.

use crate::archipelago::Report;
use crate::problems::outcomes;
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};

/// A row. Scores are in the task's unit; a cell is empty where there is none, because nobody was scored.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The island, from 0.
    pub island: u32,
    /// The generation, from 0.
    pub generation: u32,
    /// The best fitness of the population.
    pub best: Option<f64>,
    /// The mean over those that could be scored.
    pub mean: Option<f64>,
    /// The median of all.
    pub median: Option<f64>,
    /// The mean distance of two genomes, 0 to 1.
    pub diversity: f64,
    /// The mean distance of two phenotypes, 0 to 1: for creatures by the number of links and the height.
    pub phenotype_diversity: f64,
    /// Evaluations that were run.
    pub evaluations: u64,
    /// Offspring whose fitness was known already.
    pub reused: u64,
    /// Evaluations that did not end in a score, in all; the columns after this one say how they ended.
    pub failures: u64,
    /// Genomes that describe more than may be built.
    pub too_large: u64,
    /// Trials in which a position or a speed stopped being a number.
    pub not_finite: u64,
    /// Trials in which a part moved faster than anything healthy does.
    pub too_fast: u64,
    /// Trials in which the body left the ground by more than a jump explains.
    pub launched: u64,
    /// Trials in which the body gained more momentum than gravity and friction can give.
    pub unphysical: u64,
    /// Evaluations that panicked.
    pub panicked: u64,
    /// Immigrants that arrived.
    pub immigrants: u32,
    /// Species of the population at its end; 0 where it is not divided into such.
    #[serde(default)]
    pub species: u32,
    /// How long the generation took, waiting included, in seconds. The only column that the seed does not fix.
    pub seconds: f64,
}

impl Row {
    /// The row of a report.
    pub fn new(report: &Report, seconds: f64) -> Self {
        let Report { island, generation, statistics, effort, immigrants, species } = *report;
        let [_, too_large, not_finite, too_fast, launched, unphysical, panicked] =
            outcomes::ALL.map(|outcome| effort.outcomes.count(outcome));
        Self {
            island,
            generation,
            best: statistics.best.finite(),
            mean: statistics.mean.finite(),
            median: statistics.median.finite(),
            diversity: statistics.diversity,
            phenotype_diversity: statistics.phenotype_diversity,
            evaluations: effort.evaluations,
            reused: effort.reused,
            failures: effort.failures(),
            too_large,
            not_finite,
            too_fast,
            launched,
            unphysical,
            panicked,
            immigrants,
            species,
            seconds,
        }
    }
}

/// Writes rows as CSV, after a header if `with_header`.
///
/// # Errors
/// If the output refuses, or a row cannot be had.
pub fn write(
    rows: impl IntoIterator<Item = std::io::Result<Row>>,
    with_header: bool,
    output: impl Write,
) -> std::io::Result<()> {
    let mut writer = csv::WriterBuilder::new().has_headers(with_header).from_writer(output);
    for row in rows {
        writer.serialize(row?).map_err(std::io::Error::other)?;
    }
    writer.flush()
}

/// Reads what [`write`](fn@write) wrote, its header included.
///
/// # Errors
/// If the input cannot be read or is something else.
pub fn read(input: impl Read) -> std::io::Result<Vec<Row>> {
    let rows = csv::Reader::from_reader(input).into_deserialize();
    rows.collect::<Result<_, _>>().map_err(std::io::Error::other)
}

/// A table that [`write`](fn@write) wrote as it was before there were species: without their column.
///
/// # Errors
/// If it is no table.
pub fn without_species(table: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(table);
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut species = None;
    for line in reader.records() {
        let line = line.map_err(std::io::Error::other)?;
        let dropped = *species.get_or_insert_with(|| line.iter().position(|it| it == "species"));
        let kept = (0..).zip(&line).filter(|(column, _)| Some(*column) != dropped);
        let kept = kept.map(|(_, cell)| cell);
        writer.write_record(kept).map_err(std::io::Error::other)?;
    }
    writer.into_inner().map_err(|error| error.into_error())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolution::generation::Effort;
    use crate::evolution::{Fitness, Outcomes, Spread, Statistics};

    #[test]
    fn each_way_to_fail_has_a_column_of_its_name_in_the_order_of_all() {
        let worst = Fitness::WORST;
        let (mean, median, spread) = (worst, worst, Spread::default());
        let statistics = Statistics {
            best: worst,
            mean,
            median,
            diversity: 0.0,
            phenotype_diversity: 0.0,
            spread,
        };
        // As many of each as its number says.
        let counts = [0, 1, 2, 3, 4, 5, 6];
        let effort = Effort { evaluations: 21, reused: 0, outcomes: Outcomes::from(counts) };
        let report =
            Report { island: 0, generation: 0, statistics, effort, immigrants: 0, species: 0 };
        let mut bytes = Vec::new();
        write([Ok(Row::new(&report, 0.0))], true, &mut bytes).expect("memory takes everything");
        let mut table = csv::Reader::from_reader(bytes.as_slice());
        let names = table.headers().expect("it has a header").clone();
        let cells = table.records().next().expect("it has a row").expect("it is whole");
        let columns: Vec<_> = names.iter().zip(&cells).collect();
        let ways = ["too_large", "not_finite", "too_fast", "launched", "unphysical", "panicked"];
        let expected = ways.into_iter().zip(["1", "2", "3", "4", "5", "6"]);
        let failures = names.iter().position(|name| name == "failures").expect("it is there");
        for (column, (name, count)) in columns[failures + 1..].iter().zip(expected) {
            assert_eq!(*column, (name, count));
        }
        assert_eq!(columns[failures].1, "21");
    }

    #[test]
    fn rows_come_back_as_they_were_and_what_has_no_score_is_empty() {
        let row = Row {
            island: 1,
            generation: 2,
            best: Some(0.1 + 0.2),
            mean: None,
            median: None,
            diversity: 0.5,
            phenotype_diversity: 0.25,
            evaluations: 3,
            reused: 1,
            failures: 2,
            too_large: 0,
            not_finite: 0,
            too_fast: 1,
            launched: 1,
            unphysical: 0,
            panicked: 0,
            immigrants: 0,
            species: 5,
            seconds: 0.25,
        };
        let mut bytes = Vec::new();
        write([Ok(row), Ok(row)], true, &mut bytes).expect("memory takes everything");
        let text = String::from_utf8(bytes.clone()).expect("it is text");
        assert!(
            text.contains("1,2,0.30000000000000004,,,0.5,0.25,3,1,2,0,0,1,1,0,0,0,5,0.25\n"),
            "{text}"
        );
        assert_eq!(read(bytes.as_slice()).expect("it is ours"), [row, row]);
    }
}
