//! Networks as CSV, to be read by people and back to the same bits: a neuron or a link a line.
//!
//! ```text
//! part,from,to,weight,enabled,function
//! neuron,h9f0c5a33b1d2e4f7,,,,sigmoid
//! link,cart,force,0.25,true,
//! link,h9f0c5a33b1d2e4f7,force,-1.5,false,
//! ```
//!
//! Inputs and outputs have the names that their problem gives them, and the bias is `bias`; hidden neurons are `h` and
//! their marking in hexadecimal, which is the same for the same innovation in every run.

use crate::networks::gene::Part;
use crate::networks::marking::{Marking, is_hidden};
use crate::networks::{Function, Gene, Genome, Link, Neuron, Sockets};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io::{self, Write};

/// The largest file, in bytes; a genome has a thousand genes at most.
const BYTES_MAX: usize = 1 << 20;
/// The first line.
const COLUMNS: &str = "part,from,to,weight,enabled,function";
/// What the bias is called.
const BIAS: &str = "bias";

/// What is said of a neuron or a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// `neuron` or `link`.
    pub part: String,
    /// The neuron, or the one that a link comes from.
    pub from: String,
    /// The neuron that a link leads to.
    pub to: String,
    /// The weight of a link.
    pub weight: Option<f64>,
    /// Whether a link is in use.
    pub enabled: Option<bool>,
    /// The function of a neuron.
    pub function: Option<Function>,
}

/// What inputs and outputs are called, in order.
#[derive(Debug, Clone, Copy)]
pub struct Names<'a> {
    /// What goes in, besides the bias.
    pub inputs: &'a [&'a str],
    /// What comes out.
    pub outputs: &'a [&'a str],
}

impl Names<'_> {
    fn sockets(&self) -> Sockets {
        Sockets { inputs: self.inputs.len() as u32, outputs: self.outputs.len() as u32 }
    }

    fn fixed(&self) -> impl Iterator<Item = &str> {
        self.inputs.iter().chain(&[BIAS]).chain(self.outputs).copied()
    }

    fn of(&self, marking: Marking) -> String {
        match self.fixed().nth(marking as usize) {
            Some(name) if !is_hidden(marking) => name.to_owned(),
            _ => format!("h{marking:016x}"),
        }
    }

    fn marking(&self, name: &str) -> Option<Marking> {
        let hidden = || {
            let digits = name.strip_prefix('h').filter(|digits| digits.len() == 16)?;
            Marking::from_str_radix(digits, 16).ok().filter(|marking| is_hidden(*marking))
        };
        let fixed = self.fixed().position(|fixed| fixed == name);
        fixed.map(|place| place as Marking).or_else(hidden)
    }
}

/// Whether a file is one that we wrote.
pub fn is_ours(bytes: &[u8]) -> bool {
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    first.strip_suffix(b"\r").unwrap_or(first) == COLUMNS.as_bytes()
}

/// What is said of each gene.
pub fn rows(genes: &[Gene], names: &Names<'_>) -> Vec<Row> {
    let row = |part| match part {
        Part::Neuron(Neuron { marking, function }) => Row {
            part: "neuron".to_owned(),
            from: names.of(marking),
            to: String::new(),
            weight: None,
            enabled: None,
            function: Some(function),
        },
        Part::Link(Link { from, to, weight, enabled }) => Row {
            part: "link".to_owned(),
            from: names.of(from),
            to: names.of(to),
            weight: Some(weight),
            enabled: Some(enabled),
            function: None,
        },
    };
    genes.iter().filter_map(Gene::part).map(row).collect()
}

/// Writes a genome.
///
/// # Errors
/// If the output cannot be written.
pub fn write(genes: &[Gene], names: &Names<'_>, output: &mut dyn Write) -> io::Result<()> {
    writeln!(output, "{COLUMNS}")?;
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(output);
    let mut rows = rows(genes, names).into_iter();
    rows.try_for_each(|row| writer.serialize(row)).map_err(io::Error::other)?;
    writer.flush()
}

/// Reads the lines of a file, whichever problem it is of.
///
/// # Errors
/// What is wrong with it, in a sentence.
pub fn read_rows(bytes: &[u8]) -> Result<Vec<Row>, String> {
    if bytes.len() > BYTES_MAX {
        return Err(format!("the file has more than {BYTES_MAX} bytes: give one network a file"));
    }
    if !is_ours(bytes) {
        return Err(format!("it is no network: the first line of one is {COLUMNS}"));
    }
    let rows = csv::Reader::from_reader(bytes).into_deserialize().collect::<Result<_, _>>();
    rows.map_err(|error| error.to_string())
}

/// Reads the genome of a network with such inputs and outputs.
///
/// # Errors
/// What is wrong with it, in a sentence.
pub fn read(bytes: &[u8], names: &Names<'_>) -> Result<Vec<Gene>, String> {
    let rows = read_rows(bytes)?;
    let mut genes = Vec::new();
    for (number, row) in (2..).zip(rows) {
        let part = part(&row, names).map_err(|reason| format!("line {number}: {reason}"))?;
        genes.push(Gene::from(part));
    }
    match Genome::of_genes(&genes, names.sockets()) {
        Ok(genome) if genome.is_empty() => Err("it has no link".to_owned()),
        Ok(_) => Ok(genes),
        Err(error) => Err(error.to_string()),
    }
}

fn part(row: &Row, names: &Names<'_>) -> Result<Part, String> {
    let marking = |name: &str| {
        names.marking(name).ok_or_else(|| {
            let known: Vec<&str> = names.fixed().collect();
            format!("a neuron is one of {}, or h and 16 hexadecimal digits", known.join(", "))
        })
    };
    match (row.part.as_str(), row.function, row.weight, row.enabled) {
        ("neuron", Some(function), None, None) if row.to.is_empty() => {
            Ok(Part::Neuron(Neuron { marking: marking(&row.from)?, function }))
        }
        ("link", None, Some(weight), Some(enabled)) => {
            let (from, to) = (marking(&row.from)?, marking(&row.to)?);
            Ok(Part::Link(Link { from, to, weight, enabled }))
        }
        _ => {
            Err("a line is a neuron with its function, or a link with its weight and true or false"
                .to_owned())
        }
    }
}

/// A drawing in the language of Graphviz: inputs on the left, outputs on the right; the wider a link, the larger its
/// weight, red where that is negative, and dashed where it is not in use.
pub fn dot(rows: &[Row]) -> String {
    let mut text =
        "digraph network {\n  rankdir=LR;\n  node [shape=circle, fontname=sans];\n".to_owned();
    let links = || rows.iter().filter(|row| row.part == "link");
    let neurons = rows.iter().filter(|row| row.part == "neuron").map(|row| row.from.as_str());
    let mut placed: BTreeSet<&str> = neurons.collect();
    let targets: BTreeSet<&str> = links().map(|row| row.to.as_str()).collect();
    let mut ends: Vec<(&str, &str)> = Vec::new();
    for (name, rank) in links().flat_map(|row| [(&row.from, "source"), (&row.to, "sink")]) {
        let is_target = rank == "source" && targets.contains(name.as_str());
        if !is_target && placed.insert(name) {
            ends.push((name, rank));
        }
    }
    for rank in ["source", "sink"] {
        let own = ends.iter().filter(|(_, of)| *of == rank);
        let names: String =
            own.map(|(name, _)| format!(" {} [shape=box];", quoted(name))).collect();
        text += &format!("  {{ rank={rank};{names} }}\n");
    }
    for row in rows.iter().filter(|row| row.part == "neuron") {
        let function = row.function.map(|it| it.to_string()).unwrap_or_default();
        text += &format!("  {} [label={}];\n", quoted(&row.from), quoted(&function));
    }
    for row in links() {
        let weight = row.weight.unwrap_or_default();
        let color = if weight < 0.0 { "firebrick" } else { "black" };
        let style = if row.enabled == Some(true) { "solid" } else { "dashed" };
        text += &format!(
            "  {} -> {} [label=\"{weight:.2}\", color={color}, style={style}, penwidth={:.2}];\n",
            quoted(&row.from),
            quoted(&row.to),
            0.5 + weight.abs().min(8.0) / 2.0,
        );
    }
    text + "}\n"
}

fn quoted(name: &str) -> String {
    let harmless: String = name.chars().filter(|c| !c.is_control()).collect();
    format!("\"{}\"", harmless.replace('\\', "\\\\").replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::networks::marking::of_split;

    const NAMES: Names<'_> = Names { inputs: &["a", "b"], outputs: &["out"] };

    fn genes() -> Vec<Gene> {
        let hidden = of_split(0, 3, 0);
        let mut genome = Genome::default();
        genome.add_neuron(Neuron { marking: hidden, function: Function::Gaussian });
        for (from, to, weight, enabled) in
            [(0, 3, 0.1 + 0.2, false), (0, hidden, 1.0, true), (hidden, 3, -2.5, true)]
        {
            genome.add_link(Link { from, to, weight, enabled });
        }
        genome.genes()
    }

    fn text() -> String {
        let mut bytes = Vec::new();
        write(&genes(), &NAMES, &mut bytes).expect("memory takes everything");
        String::from_utf8(bytes).expect("it is text")
    }

    #[test]
    fn a_network_is_read_as_it_was_written_to_the_last_bit() {
        assert!(text().contains("link,a,out,0.30000000000000004,false,\n"), "{}", text());
        assert_eq!(read(text().as_bytes(), &NAMES), Ok(genes()));
        assert_eq!(read(text().replace('\n', "\r\n").as_bytes(), &NAMES), Ok(genes()));
    }

    #[test]
    fn what_is_no_network_of_the_problem_is_refused_with_a_sentence() {
        let refusal = |from: &str, to: &str| {
            read(text().replacen(from, to, 1).as_bytes(), &NAMES).expect_err("it is refused")
        };
        assert!(refusal("part,", "party,").starts_with("it is no network"));
        assert!(refusal("link,a,out", "link,c,out").starts_with("line 3: a neuron is one of a, b"));
        assert!(refusal("link,a,out", "link,a,b").contains("leads nowhere"));
        assert!(refusal("0.30000000000000004", "NaN").contains("neither a neuron nor a link"));
        assert!(refusal("0.30000000000000004", "9.5").contains("neither a neuron nor a link"));
        assert!(refusal("gaussian", "magic").contains("magic"));
        assert!(refusal("link,a,out,", "wire,a,out,").starts_with("line 3: a line is"));
        assert_eq!(
            read(format!("{COLUMNS}\n").as_bytes(), &NAMES),
            Err("it has no link".to_owned())
        );
        assert!(read(&vec![b'x'; BYTES_MAX + 1], &NAMES).is_err());
    }

    #[test]
    fn a_drawing_has_every_neuron_and_link() {
        let drawing = dot(&rows(&genes(), &NAMES));
        assert!(drawing.starts_with("digraph network {\n") && drawing.ends_with("}\n"));
        for said in [
            "rank=source; \"a\" [shape=box]; }",
            "rank=sink; \"out\" [shape=box]; }",
            "[label=\"gaussian\"]",
            "\"a\" -> \"out\" [label=\"0.30\", color=black, style=dashed",
            "label=\"-2.50\", color=firebrick, style=solid",
        ] {
            assert!(drawing.contains(said), "{said} in {drawing}");
        }
    }
}
