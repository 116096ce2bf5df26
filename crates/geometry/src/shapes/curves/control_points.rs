//! Files of control points: `x y z radius` on each line, an empty line between curves.
//!
//! Lines may end as on any system; a byte order mark, and a first line that begins with a word, are passed over.

use glam::DVec3;

/// A control point: where, and how thick there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlPoint {
    /// Position.
    pub position: DVec3,
    /// Radius (m).
    pub radius: f64,
}

/// The points of a curve, and the number of the line that ends it.
pub(crate) type Strand = (Vec<ControlPoint>, usize);

/// The contents of a file.
pub(crate) struct ControlPoints {
    /// The curves: none is empty.
    pub(crate) strands: Vec<Strand>,
    /// The first line, if it is no control point.
    pub(crate) header: Option<String>,
}

/// Reads a file; the error names the line.
pub(crate) fn parse(bytes: &[u8]) -> Result<ControlPoints, String> {
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let is_word = |word: &str| word.parse::<f64>().is_err();
    let first = text.lines().next().unwrap_or_default().trim();
    let header = first.split_whitespace().next().filter(|word| is_word(word));
    let (mut strands, mut strand) = (Vec::new(), Vec::new());
    // An empty line at the end finishes the last curve.
    let lines = text.lines().chain([""]).enumerate();
    for (index, line) in lines.skip(usize::from(header.is_some())) {
        let number = index + 1;
        if !line.trim().is_empty() {
            strand.push(point(line).map_err(|reason| format!("line {number}: {reason}"))?);
        } else if !strand.is_empty() {
            strands.push((std::mem::take(&mut strand), number));
        }
    }
    if strands.is_empty() {
        return Err("line 1: there are no control points".into());
    }
    Ok(ControlPoints {
        strands,
        header: header.map(|_| first.to_owned()),
    })
}

fn point(line: &str) -> Result<ControlPoint, String> {
    let numbers: Vec<f64> = line
        .split_whitespace()
        .map_while(|word| word.parse().ok())
        .filter(|number| fits(*number))
        .collect();
    match numbers[..] {
        [x, y, z, radius, ..] if radius >= 0.0 => Ok(ControlPoint {
            position: DVec3::new(x, y, z),
            radius,
        }),
        _ => Err(format!(
            "`{}` is no control point `x y z radius` of numbers that 32-bit floats can hold, the radius not below 0",
            line.trim()
        )),
    }
}

/// Whether a number is finite as a 32-bit float.
pub(crate) fn fits(number: f64) -> bool {
    (number as f32).is_finite()
}

/// A summary of a file; `None` if it is not a file of control points.
pub fn summary(bytes: &[u8]) -> Option<String> {
    let file = parse(bytes).ok()?;
    let points = || file.strands.iter().flat_map(|(points, _)| points);
    let (least, most) = points().fold((f64::INFINITY, 0.0_f64), |(least, most), point| {
        (least.min(point.radius), most.max(point.radius))
    });
    let low = points().fold(DVec3::INFINITY, |low, point| low.min(point.position));
    let high = points().fold(DVec3::NEG_INFINITY, |high, point| high.max(point.position));
    Some(format!(
        "curves       {} with {} control points, radii {least} to {most}\nbox          {low} to {high}\n",
        file.strands.len(),
        points().count(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_as_on_any_system() {
        let points = |text: &str| {
            let file = parse(text.as_bytes()).expect("curves");
            let counts: Vec<usize> = file.strands.iter().map(|(p, _)| p.len()).collect();
            (counts, file.header)
        };
        let two = (vec![2, 1], None);
        assert_eq!(points("0 0 0 1\n0 0 1 1\n\n5 0 0 1"), two);
        assert_eq!(points("\u{feff}0 0 0 1\r\n0 0 1 1\r\n\r\n5 0 0 1\r\n"), two);
        assert_eq!(points("0 0 0 1\r0 0 1 1\r\r5 0 0 1\r"), two);
        let (counts, header) = points("x y z radius\n0 0 0 1\n");
        assert_eq!((counts, header.as_deref()), (vec![1], Some("x y z radius")));
    }

    #[test]
    fn numbers_that_no_float_holds_are_refused() {
        let said = |text: &str| parse(text.as_bytes()).err().unwrap_or_default();
        assert!(
            said("0 0 0 1\n1e39 0 0 1").starts_with("line 2: `1e39 0 0 1` is no control point")
        );
        assert!(said("0 0 0 -1").starts_with("line 1: "));
        assert!(said("x y z\n0 0 0").starts_with("line 2: "));
        assert_eq!(said("\n\n"), "line 1: there are no control points");
    }
}
