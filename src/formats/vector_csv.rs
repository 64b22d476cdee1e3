//! Genomes of bits or numbers as CSV: a gene a line, below a line that names the columns.
//!
//! The first column is the gene, a number in its shortest form that reads back as the same bits; what follows is for
//! people, and not read. The reader also takes files without the first line, blank lines, a byte order mark and line
//! ends of any system, so a column of a spreadsheet will do.

use std::io::{self, Read, Write};

/// What stands above the genes of numbers, and above bits.
pub const COLUMNS: [&str; 2] = ["gene,x", "bit"];

/// Whether a file is one that we wrote.
pub fn is_ours(bytes: &[u8]) -> bool {
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    COLUMNS.iter().any(|columns| first == columns.as_bytes())
}

/// The largest file, in bytes; a genome has a thousand genes at most.
pub const BYTES_MAX: u64 = 1 << 20;

/// Characters of a bad cell that its error shows.
const CELL_SHOWN: usize = 24;

/// Why a genome could not be read.
#[derive(Debug, thiserror::Error)]
pub enum VectorCsvError {
    /// The input could not be read, or is not text.
    #[error("the genome cannot be read: {0}")]
    Read(#[from] io::Error),
    /// The input is too long.
    #[error("the file has more than {BYTES_MAX} bytes: give one genome a file")]
    TooLong,
    /// There are more or fewer genes than a genome has.
    #[error(
        "the file holds {found} genes where there must be {expected}: give a gene a line, or another \
         --dimensions"
    )]
    Length {
        /// How many it holds.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A cell is no gene.
    #[error("line {line} begins with {cell:?}: write {gene} there")]
    Value {
        /// The line, from 1.
        line: usize,
        /// The beginning of the cell.
        cell: String,
        /// What a gene is.
        gene: &'static str,
    },
}

/// Writes a genome: a line that names the columns, and one for each gene.
///
/// # Errors
/// If the output cannot be written.
pub fn write(
    columns: &str,
    genes: impl IntoIterator<Item = String>,
    mut output: impl Write,
) -> io::Result<()> {
    writeln!(output, "{columns}")?;
    genes.into_iter().try_for_each(|gene| writeln!(output, "{gene}"))
}

/// Reads a genome of so many genes. What the first cell of a line holds is for `parse` to say, and `gene` says in words
/// what it takes.
///
/// # Errors
/// If the input cannot be read, or holds something else.
pub fn read<G>(
    input: impl Read,
    length: usize,
    gene: &'static str,
    parse: impl Fn(&str) -> Option<G>,
) -> Result<Vec<G>, VectorCsvError> {
    let mut text = String::new();
    input.take(BYTES_MAX + 1).read_to_string(&mut text)?;
    if text.len() as u64 > BYTES_MAX {
        return Err(VectorCsvError::TooLong);
    }
    let mut genome = Vec::new();
    for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let cell = text.split(',').next().unwrap_or_default().trim();
        match parse(cell) {
            Some(gene) => genome.push(gene),
            None if text.trim().is_empty() || (genome.is_empty() && is_name(cell)) => {}
            None => {
                let cell = cell.chars().take(CELL_SHOWN).collect();
                return Err(VectorCsvError::Value { line, cell, gene });
            }
        }
    }
    let found = genome.len();
    let is_whole = found == length;
    is_whole.then_some(genome).ok_or(VectorCsvError::Length { found, expected: length })
}

/// Whether a cell names a column. What no gene can be is none.
fn is_name(cell: &str) -> bool {
    !matches!(cell, "nan" | "inf" | "NaN" | "Infinity")
        && cell.starts_with(|c: char| c.is_ascii_alphabetic())
        && cell.chars().all(|c| c.is_ascii_alphanumeric())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(text: &str) -> Result<Vec<u8>, String> {
        let digit = |cell: &str| cell.parse().ok().filter(|digit: &u8| *digit < 10);
        read(text.as_bytes(), 3, "a digit", digit).map_err(|error| error.to_string())
    }

    #[test]
    fn a_genome_is_read_as_it_was_written_and_as_a_spreadsheet_writes_it() {
        let mut bytes = Vec::new();
        let lines = ["1,one", "2,two", "3,three"].map(str::to_owned);
        write("digit,name", lines, &mut bytes).unwrap();
        let written = String::from_utf8(bytes).unwrap();
        assert_eq!(written, "digit,name\n1,one\n2,two\n3,three\n");
        for text in [&written, "1\n2\n3", "\u{feff}digit\r\n1,\r\n\r\n 2 ,x\r\n3\r\n"] {
            assert_eq!(digits(text), Ok(vec![1, 2, 3]), "{text:?}");
        }
    }

    #[test]
    fn what_is_no_genome_is_refused_with_a_sentence() {
        let error = |text| digits(text).unwrap_err();
        assert!(error("1\n2\n").contains("holds 2 genes where there must be 3"));
        assert!(error("1\n2\n3\n4").contains("holds 4 genes"));
        assert_eq!(error("1\nx\n3"), "line 2 begins with \"x\": write a digit there");
        assert_eq!(error("NaN\n1\n2\n3"), "line 1 begins with \"NaN\": write a digit there");
        assert_eq!(error("12\n1\n2"), "line 1 begins with \"12\": write a digit there");
        let long = "1\n".repeat(600_000);
        assert!(error(&long).contains("more than 1048576 bytes"));
        let bytes = read(&[0xff_u8][..], 1, "a digit", |cell| cell.parse::<u8>().ok());
        assert!(bytes.is_err());
    }
}
