//! Genomes as CSV, in the format of the course: a gene a line, numbers from 0 (included) to 1 (excluded).
//!
//! A line holds [`Gene::values`], and [`Encoding::columns`] says what each of them is called, so that genomes of every
//! encoding are read and written here. The writer gives each number its shortest form that reads back as the same bits, and ends each with a comma,
//! as the course does. The reader takes what thousands of existing files hold: commas at the line's end or not,
//! blank lines, a byte order mark, line ends of any system, and values of 1 and more, which it clamps and
//! reports. All else is an error that names the line.
//!
//! Lines are split here rather than by the csv crate, which counts blank lines wrongly and lets a quoted cell
//! run over lines.

use crate::creature::encodings::Encoding;
use crate::evolution::Gene;
use crate::evolution::variation::values::VALUE_MAX;
use std::fmt;
use std::io::{self, BufRead, BufReader, Read, Write};

/// The most lines of a file, blank ones included.
pub const LINES_MAX: usize = 100_000;

/// The most bytes of a line; the course's 17 numbers in their longest useful form need a fifth of it.
pub const LINE_BYTES_MAX: usize = 1 << 15;

/// A genome that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadGenome<G> {
    /// Its genes, at least one.
    pub genome: Vec<G>,
    /// The values that were clamped, in the order of the file.
    pub clamped: Vec<Clamped>,
}

/// A value of 1 or more that became [`VALUE_MAX`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clamped {
    /// Its line, from 1.
    pub line: usize,
    /// Its column, from 1, not counting those that were left out.
    pub column: usize,
    /// What the column is called.
    pub name: &'static str,
    /// What the file says.
    pub value: f64,
}

impl fmt::Display for Clamped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column, name, value } = self;
        write!(f, "line {line}, column {column} ({name}) was {value} and is now just under 1")
    }
}

/// Why a genome could not be read.
#[derive(Debug, thiserror::Error)]
pub enum GenomeCsvError {
    /// The input could not be read.
    #[error("the genome cannot be read: {0}")]
    Read(#[from] io::Error),
    /// There is no gene.
    #[error("the file holds no gene: give one with at least one line of {numbers} numbers")]
    Empty {
        /// How many numbers a gene has.
        numbers: usize,
    },
    /// A line has not as many numbers as a gene.
    #[error(
        "line {line} has {columns} {} instead of {numbers}: {advice}",
        if *columns == 1 { "column" } else { "columns" },
    )]
    Columns {
        /// The line, from 1.
        line: usize,
        /// How many columns it has.
        columns: usize,
        /// How many numbers a gene has.
        numbers: usize,
        /// What to do about it.
        advice: &'static str,
    },
    /// A cell is no number that a gene can hold.
    #[error(
        "line {line}, column {column} ({name}) holds {cell:?}: write a number from 0 (included) to 1 (excluded) there"
    )]
    Value {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What the column is called.
        name: &'static str,
        /// The beginning of the cell.
        cell: String,
    },
    /// A line is not text.
    #[error("line {line} is not UTF-8 text: give a CSV file of numbers")]
    NotText {
        /// The line, from 1.
        line: usize,
    },
    /// A line is too long to be a gene.
    #[error("line {line} is longer than {LINE_BYTES_MAX} bytes: give a gene a line")]
    LineTooLong {
        /// The line, from 1.
        line: usize,
    },
    /// The file is too long to be a genome.
    #[error("the file has more than {LINES_MAX} lines: give one genome a file")]
    TooManyLines,
}

/// Reads a genome of an encoding.
///
/// # Errors
/// If the input cannot be read, is no such CSV, or is too large.
pub fn read<E: Encoding>(
    encoding: &E,
    input: impl Read,
) -> Result<ReadGenome<E::Gene>, GenomeCsvError> {
    read_without(encoding, input, &[])
}

/// Reads a genome from a file in which lines may have more columns than a gene has numbers: of a line with exactly
/// so many more as are to be left out, the columns `dropped`, counted from 1, are.
///
/// # Errors
/// As [`read`].
pub fn read_without<E: Encoding>(
    encoding: &E,
    input: impl Read,
    dropped: &[usize],
) -> Result<ReadGenome<E::Gene>, GenomeCsvError> {
    let names = encoding.columns();
    let mut input = BufReader::new(input);
    let mut bytes = Vec::new();
    let mut read = ReadGenome { genome: Vec::new(), clamped: Vec::new() };
    for line in 1.. {
        if !next_line(&mut input, &mut bytes, line)? {
            break;
        }
        let text = str::from_utf8(&bytes).map_err(|_| GenomeCsvError::NotText { line })?;
        let text = text.trim_start_matches('\u{feff}').trim();
        if !text.is_empty() {
            let (text, dropped) = cells_of(text, &names, dropped).map_err(|columns| {
                let advice = encoding.advice(columns).unwrap_or(USUAL_ADVICE);
                GenomeCsvError::Columns { line, columns, numbers: names.len(), advice }
            })?;
            read.genome.push(parse(text, line, &names, dropped, &mut read.clamped)?);
        }
    }
    match read.genome.is_empty() {
        true => Err(GenomeCsvError::Empty { numbers: names.len() }),
        false => Ok(read),
    }
}

/// Writes a genome.
///
/// # Errors
/// If the output cannot be written.
pub fn write(genome: &[impl Gene], mut output: impl Write) -> io::Result<()> {
    for gene in genome {
        let mut line: String = gene.values().iter().map(|value| format!("{value},")).collect();
        line.push('\n');
        output.write_all(line.as_bytes())?;
    }
    Ok(())
}

/// Replaces `bytes` by the next line; false at the end of the input.
fn next_line(
    input: &mut impl BufRead,
    bytes: &mut Vec<u8>,
    line: usize,
) -> Result<bool, GenomeCsvError> {
    bytes.clear();
    input.take(LINE_BYTES_MAX as u64 + 1).read_until(b'\n', bytes)?;
    if bytes.len() > LINE_BYTES_MAX {
        return Err(GenomeCsvError::LineTooLong { line });
    }
    if line > LINES_MAX && !bytes.is_empty() {
        return Err(GenomeCsvError::TooManyLines);
    }
    Ok(!bytes.is_empty())
}

/// What to do about a line with a wrong number of columns.
const USUAL_ADVICE: &str = "write a gene a line, its numbers separated by commas";

/// The cells of a line and which of them to leave out, or how many there are if that is wrong.
fn cells_of<'a>(
    text: &'a str,
    names: &[&str],
    dropped: &'a [usize],
) -> Result<(&'a str, &'a [usize]), usize> {
    let text = text.strip_suffix(',').unwrap_or(text);
    match text.split(',').count() {
        columns if columns == names.len() => Ok((text, &[])),
        columns if columns == names.len() + dropped.len() => Ok((text, dropped)),
        columns => Err(columns),
    }
}

fn parse<G: Gene>(
    text: &str,
    line: usize,
    names: &[&'static str],
    dropped: &[usize],
    clamped: &mut Vec<Clamped>,
) -> Result<G, GenomeCsvError> {
    let mut gene = G::zeroed();
    let cells = text.split(',').zip(1..).filter(|(_, column)| !dropped.contains(column));
    let places = gene.values_mut().iter_mut().zip(names).zip(1..);
    for ((cell, _), ((value, &name), column)) in cells.zip(places) {
        *value = number(cell.trim()).ok_or_else(|| GenomeCsvError::Value {
            line,
            column,
            name,
            cell: cell.trim().chars().take(CELL_SHOWN).collect(),
        })?;
        if *value > VALUE_MAX {
            clamped.push(Clamped { line, column, name, value: *value });
            *value = VALUE_MAX;
        }
    }
    Ok(gene)
}

/// Characters of a bad cell that its error shows.
const CELL_SHOWN: usize = 24;

fn number(cell: &str) -> Option<f64> {
    let value: f64 = cell.parse().ok()?;
    (value.is_finite() && value >= 0.0).then_some(value)
}
