//! Tables for people: columns in line, no colours, the same on a terminal and in a file.

/// Lays out rows of cells, the first row their heads: each column as wide as its widest cell, but for the last
/// one, which may hold sentences.
pub fn lay_out<const COLUMNS: usize>(rows: &[[String; COLUMNS]]) -> String {
    let rows: Vec<[String; COLUMNS]> =
        rows.iter().map(|row| row.each_ref().map(|cell| harmless(cell))).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let lines = rows.iter().map(|row| {
        let cell = |(column, cell): (usize, &String)| {
            let width = width(column).filter(|_| column + 1 < COLUMNS).unwrap_or(0);
            format!("{cell:<width$}")
        };
        let cells: Vec<String> = row.iter().enumerate().map(cell).collect();
        cells.join("  ").trim_end().to_owned()
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Text that came from a file, without what moves the cursor of a terminal.
pub fn harmless(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_in_line_and_nothing_moves_the_cursor() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned);
        let rows = [row(["a", "much", "what"]), row(["three", "", "x\u{1b}[2J\ny"])];
        assert_eq!(lay_out(&rows), "a      much  what\nthree        x\u{fffd}[2J\u{fffd}y");
    }
}
