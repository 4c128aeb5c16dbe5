//! Tables for a terminal and for a page.

use std::fmt::Write as _;

/// A table in Markdown, which reads well as it is: the first column flush left, the others flush right.
pub(super) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let cells = || rows.iter().map(|r| r.iter().map(String::as_str).collect::<Vec<_>>());
    let widths: Vec<usize> = (0..header.len())
        .map(|c| {
            cells().filter_map(|r| r.get(c).map(|s| s.chars().count())).fold(header[c].chars().count(), usize::max)
        })
        .collect();
    let line = |cells: &[&str]| {
        let mut line = String::from("|");
        for (i, width) in widths.iter().enumerate() {
            let cell = cells.get(i).unwrap_or(&"");
            let _ = if i == 0 { write!(line, " {cell:<width$} |") } else { write!(line, " {cell:>width$} |") };
        }
        line + "\n"
    };
    let rule: String = widths
        .iter()
        .enumerate()
        .map(|(i, w)| if i == 0 { format!("| {} ", "-".repeat(*w)) } else { format!("| {}: ", "-".repeat(w - 1)) })
        .collect();
    let mut text = line(header) + &rule + "|\n";
    for row in cells() {
        text.push_str(&line(&row));
    }
    text
}

/// A number with so many digits behind the point; what is none is a dash.
pub(super) fn number(x: f64, digits: usize) -> String {
    if x.is_finite() { format!("{x:.digits$}") } else { "-".into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let rows = [vec!["a".into(), number(1.26, 1)], vec!["uniform".into(), number(f64::NAN, 2)]];
        let expected = "| K       |  dB |\n| ------- | --: |\n| a       | 1.3 |\n| uniform |   - |\n";
        assert_eq!(table(&["K", "dB"], &rows), expected);
    }
}
