//! Spectra in files: rows of a wavelength (nm) and a value, linear between the rows.

use std::path::Path;

/// Reads pairs of wavelength (nm) and value, one a line.
///
/// # Errors
/// Names the file and the line that is not such a pair.
pub fn table(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    text.lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty())
        .map(|line| {
            let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
            match numbers.as_deref() {
                Ok(&[lambda, value]) => Ok([lambda, value]),
                _ => Err(format!("{}: `{line}` is not two numbers", path.display())),
            }
        })
        .collect()
}

/// The value at `lambda`, by linear interpolation. The table must begin at or before `lambda`.
pub fn at(table: &[[f64; 2]], lambda: f64) -> f64 {
    let next = table.partition_point(|[l, _]| *l <= lambda);
    let (Some(&[l0, v0]), Some(&[l1, v1])) = (table.get(next.saturating_sub(1)), table.get(next))
    else {
        return table.last().map_or(0.0, |[_, value]| *value);
    };
    v0 + (v1 - v0) * (lambda - l0) / (l1 - l0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_linear_between_their_rows() {
        let table = [[400.0, 1.0], [410.0, 3.0], [500.0, 0.0]];
        assert_eq!(at(&table, 400.0), 1.0);
        assert_eq!(at(&table, 405.0), 2.0);
        assert_eq!(at(&table, 410.0), 3.0);
        assert_eq!(at(&table, 500.0), 0.0);
    }
}
