//! Photometric files of luminaires: IESNA LM-63, of 1986, 1991, 1995 and 2002.
//!
//! ```text
//! IESNA:LM-63-2002                                   absent in files of 1986
//! [TEST] ...                                         lines of words
//! TILT=NONE                                          or INCLUDE, with four more entries
//! lamps lumens multiplier n_v n_h type units width length height
//! ballast ballast_lamp watts
//! n_v vertical angles, n_h horizontal angles, n_h times n_v candelas
//! ```
//!
//! Numbers are separated by white space or commas, whatever the lines. Photometry of type C only: vertical angles from the nadir, horizontal
//! angles counterclockwise, seen from above (LM-63-2002, sections 3 and 5). The factor ahead of the lamp's wattage was the
//! ballast-lamp photometric factor until 1991, and has no meaning since.

use core::fmt::Display;

/// The most candela values that are read.
const MOST_VALUES: usize = 1 << 22;

/// A distribution of luminous intensity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IesProfile {
    /// Angles from the nadir (°), increasing.
    pub(crate) vertical: Vec<f64>,
    /// Angles around the vertical axis (°), increasing, from 0 to 360.
    pub(crate) horizontal: Vec<f64>,
    /// Luminous intensity (cd), all of one horizontal angle after those of another, with all factors.
    pub(crate) candela: Vec<f64>,
    /// What of the file is not used.
    pub(crate) notes: Vec<String>,
}

/// A number or word, and where it stands, counted from 1.
#[derive(Clone, Copy)]
struct Token<'t> {
    text: &'t str,
    line: usize,
    column: usize,
}

impl Token<'_> {
    fn refuse(&self, problem: impl Display) -> String {
        format!("line {}, column {}: {problem}", self.line, self.column)
    }
}

/// The numbers of a file, in order.
struct Numbers<'t> {
    tokens: Vec<Token<'t>>,
    next: usize,
}

impl<'t> Numbers<'t> {
    /// The next number, which is `what`.
    fn number(&mut self, what: &str) -> Result<(f64, Token<'t>), String> {
        let Some(&token) = self.tokens.get(self.next) else {
            let last = self.tokens.last();
            return Err(match last {
                Some(last) => last.refuse(format!("the file ends here, before {what}")),
                None => format!("the file ends before {what}"),
            });
        };
        self.next += 1;
        match token.text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok((number, token)),
            _ => Err(token.refuse(format!(
                "`{}` is no number, where {what} is expected",
                token.text
            ))),
        }
    }

    /// The next number, which is a count from 1.
    fn count(&mut self, what: &str) -> Result<usize, String> {
        let (number, token) = self.number(what)?;
        let whole = number.fract() == 0.0 && number >= 1.0 && number <= MOST_VALUES as f64;
        match whole {
            true => Ok(number as usize),
            false => Err(token.refuse(format!("{what} cannot be {number}"))),
        }
    }

    /// The next number, a factor above 0.
    fn factor(&mut self, what: &str) -> Result<f64, String> {
        let (number, token) = self.number(what)?;
        match number > 0.0 {
            true => Ok(number),
            false => Err(token.refuse(format!("{what} cannot be {number}, but must be above 0"))),
        }
    }

    /// Increasing angles between 0 and `most` degrees, and where the first and the last stand.
    fn angles(
        &mut self,
        count: usize,
        what: &str,
        most: f64,
    ) -> Result<(Vec<f64>, [Token<'t>; 2]), String> {
        let (mut angles, mut ends): (Vec<f64>, Option<[Token<'t>; 2]>) = (Vec::new(), None);
        for _ in 0..count {
            let (angle, token) = self.number(what)?;
            if !(0.0..=most).contains(&angle) {
                let problem = format!("{what} cannot be {angle}, but from 0 to {most}");
                return Err(token.refuse(problem));
            }
            if let Some(before) = angles.last().filter(|before| angle <= **before) {
                return Err(token.refuse(format!(
                    "{what} {angle} follows {before}, and they must increase"
                )));
            }
            angles.push(angle);
            ends = Some([ends.map_or(token, |[first, _]| first), token]);
        }
        let ends = ends.ok_or_else(|| format!("{what} is missing"))?;
        Ok((angles, ends))
    }
}

/// Lines with their numbers, whatever ends them.
fn lines(text: &str) -> Vec<(usize, &str)> {
    let mut lines = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
        lines.push((lines.len() + 1, &rest[..end]));
        let after = &rest[end..];
        rest = after
            .strip_prefix("\r\n")
            .unwrap_or_else(|| after.get(1..).unwrap_or_default());
    }
    lines
}

/// The words of a line.
fn tokens((line, text): (usize, &str)) -> Vec<Token<'_>> {
    let is_separator = |c: char| c.is_whitespace() || c == ',' || c == '\u{1a}' || c == '\0';
    let mut tokens = Vec::new();
    let mut start = None;
    for (place, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (start, is_separator(c)) {
            (None, false) => start = Some(place),
            (Some(from), true) => {
                let column = text[..from].chars().count() + 1;
                tokens.push(Token {
                    text: &text[from..place],
                    line,
                    column,
                });
                start = None;
            }
            _ => {}
        }
    }
    tokens
}

/// The tilt of a file, from its line `TILT=`.
fn tilt(line: &str) -> Option<&str> {
    let (name, value) = line.split_once('=')?;
    (name.trim().eq_ignore_ascii_case("tilt")).then(|| value.trim())
}

/// Whether bytes look like such a file.
pub(crate) fn is_ies(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 14)]);
    let text = text.trim_start_matches('\u{feff}');
    text.starts_with("IESNA")
        || lines(text)
            .into_iter()
            .any(|(_, line)| tilt(line).is_some())
}

impl IesProfile {
    /// Reads a file; otherwise says where it is wrong.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, String> {
        let text = String::from_utf8_lossy(bytes);
        let lines = lines(text.trim_start_matches('\u{feff}'));
        let Some((at, how)) =
            (lines.iter().enumerate()).find_map(|(i, (_, line))| Some((i, tilt(line)?)))
        else {
            return Err(
                "it has no line `TILT=`, with which the numbers of an IES file begin".to_owned(),
            );
        };
        let first = lines
            .iter()
            .map(|(_, line)| line.trim())
            .find(|line| !line.is_empty());
        let version = first.filter(|line| line.to_ascii_uppercase().starts_with("IESNA"));
        // 1986 and 1991.
        let is_old = version.is_none_or(|version| version.contains("91") || version.contains("86"));
        let is_words = |line: &&(usize, &str)| line.1.trim_start().starts_with('[');
        let numbers = lines[at + 1..].iter().filter(|line| !is_words(line));
        let mut numbers = Numbers {
            tokens: numbers.flat_map(|line| tokens(*line)).collect(),
            next: 0,
        };
        let mut notes = Vec::new();
        match how.to_ascii_uppercase().as_str() {
            "NONE" => {}
            "INCLUDE" => {
                numbers.number("the lamp-to-luminaire geometry")?;
                let pairs = numbers.count("the number of tilt angles")?;
                for what in ["a tilt angle", "a tilt factor"] {
                    for _ in 0..pairs {
                        numbers.number(what)?;
                    }
                }
                notes.push("its TILT factors are not used: they are for luminaires that are mounted at an angle".to_owned());
            }
            _ => {
                let (line, _) = lines[at];
                return Err(format!(
                    "line {line}: `TILT={how}` names another file; accepted: NONE, INCLUDE"
                ));
            }
        }
        numbers.number("the number of lamps")?;
        numbers.number("the lumens per lamp")?;
        let multiplier = numbers.factor("the candela multiplier")?;
        let rows = numbers.count("the number of vertical angles")?;
        let columns = numbers.count("the number of horizontal angles")?;
        let (kind, place) = numbers.number("the photometric type")?;
        if kind != 1.0 {
            let problem = match kind {
                2.0 => "photometry of type B, as for floodlights, is not read, but type C (1)"
                    .to_owned(),
                3.0 => "photometry of type A, as for headlights, is not read, but type C (1)"
                    .to_owned(),
                _ => format!("the photometric type {kind} does not exist; accepted: 1 (type C)"),
            };
            return Err(place.refuse(problem));
        }
        for what in ["the units", "the width", "the length", "the height"] {
            numbers.number(what)?;
        }
        let ballast = numbers.factor("the ballast factor")?;
        let (lamp, _) = numbers.number("the ballast-lamp factor")?;
        numbers.number("the input watts")?;
        let lamp = if is_old && lamp > 0.0 { lamp } else { 1.0 };
        if rows.saturating_mul(columns) > MOST_VALUES {
            return Err(format!(
                "{rows} × {columns} values are more than {MOST_VALUES}"
            ));
        }
        let (vertical, [start, _]) = numbers.angles(rows, "the vertical angle", 180.0)?;
        if rows < 2 {
            return Err(start.refuse("one vertical angle alone says nothing"));
        }
        let (horizontal, ends) = numbers.angles(columns, "the horizontal angle", 360.0)?;
        let mut candela = Vec::new();
        for _ in 0..rows * columns {
            let (value, token) = numbers.number("a candela value")?;
            if value < 0.0 {
                return Err(token.refuse(format!("a candela value cannot be {value}")));
            }
            candela.push(value * multiplier * ballast * lamp);
        }
        if !candela.iter().any(|value| *value > 0.0) {
            return Err("all of its candela values are 0".to_owned());
        }
        let (horizontal, planes) = whole_turn(&horizontal).map_err(|why| ends[1].refuse(why))?;
        let plane = |index: usize| candela[index * rows..(index + 1) * rows].iter().copied();
        Ok(Self {
            candela: planes.into_iter().flat_map(plane).collect(),
            vertical,
            horizontal,
            notes,
        })
    }
}

/// Angles all around, and which of the given planes has the values of each.
fn whole_turn(given: &[f64]) -> Result<(Vec<f64>, Vec<usize>), String> {
    let (Some(&first), Some(&last)) = (given.first(), given.last()) else {
        return Err("there are no horizontal angles".to_owned());
    };
    let mut around: Vec<(f64, usize)> = given.iter().copied().zip(0..).collect();
    if given.len() == 1 {
        // The same all around, whatever the angle is called.
        return Ok((vec![0.0, 360.0], vec![0, 0]));
    }
    let mirror = |around: &mut Vec<(f64, usize)>, about: f64| {
        let images: Vec<_> = around
            .iter()
            .map(|(angle, plane)| (2.0 * about - angle, *plane))
            .collect();
        around.extend(
            images
                .into_iter()
                .filter(|(angle, _)| *angle > last || *angle < first),
        );
    };
    match (first, last) {
        (0.0, 90.0) => {
            mirror(&mut around, 90.0);
            let half: Vec<_> = around
                .iter()
                .map(|(angle, plane)| (360.0 - angle, *plane))
                .collect();
            around.extend(half.into_iter().filter(|(angle, _)| *angle > 180.0));
        }
        (0.0, 180.0) => mirror(&mut around, 180.0),
        (90.0, 270.0) if given.contains(&180.0) => {
            mirror(&mut around, 90.0);
            let turned: Vec<_> = around
                .iter()
                .map(|(angle, plane)| (angle.rem_euclid(360.0), *plane))
                .collect();
            around = turned;
            around.sort_by(|a, b| a.0.total_cmp(&b.0));
            around.dedup_by_key(|(angle, _)| *angle);
            if let Some(&(0.0, plane)) = around.first() {
                around.push((360.0, plane));
            }
        }
        (0.0, 360.0) => {}
        // The last plane, which is the first again, is left out in some files.
        (0.0, last) if last > 180.0 => around.push((360.0, 0)),
        _ => {
            return Err(format!(
                "horizontal angles from {first} to {last} are no symmetry that there is; accepted: 0 alone, 0 to 90, \
                 0 to 180, 90 to 270 by way of 180, 0 to 360"
            ));
        }
    }
    around.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(around.into_iter().unzip())
}
