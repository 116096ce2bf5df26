//! Photometric files as they are written, well and badly.

use crate::ies_profile::{IesProfile, is_ies};

/// Of 1991: numbers across lines as they come, commas, a multiplier, ballast factors, quarter symmetry.
const QUARTER: &str = "IESNA91\r\n[TEST] 1\r\n[MANUFAC] nobody\r\nTILT=NONE\r\n1 1000 2.0 3 2 1 2 0.1,0.1,0\r\n0.5 0.8 60\r\n0 45\r\n90\r\n0 90\r\n100 80 0\r\n100,60,0\r\n";

/// Of 1986: no version, words of any kind, a file of carriage returns.
const OLDEST: &str = "A LAMP\rby nobody\rTILT=INCLUDE\r1\r2\r0 90\r1 0.9\r1 1000 1 2 1 1 1 0 0 0\r1 1 60\r0 180\r0\r50 10\r";

/// Of 1995: half symmetry, a line of words behind TILT.
const HALF: &str = "IESNA:LM-63-1995\n[TEST] 2\nTILT=NONE\n[MORE] words\n1 -1 1 2 3 1 2 0 0 0\n1 7 60\n90 180\n0 90 180\n1 2\n3 4\n5 6\n";

/// Of 2002: all around, the last plane left out, a mark of byte order and of the end.
const WHOLE: &str = "\u{feff}IESNA:LM-63-2002\nTILT = NONE\n1 -1 1 2 4 1 2 0 0 0\n1 1 60\n0 90\n0 90 180 270\n1 1\n2 2\n3 3\n4 4\n\u{1a}";

/// Mirrored about the plane of 90° and 270°.
const SIDEWAYS: &str =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 3 1 2 0 0 0\n1 1 60\n0 90\n90 180 270\n1 1\n2 2\n3 3\n";

fn parsed(text: &str) -> IesProfile {
    assert!(is_ies(text.as_bytes()));
    IesProfile::parse(text.as_bytes()).unwrap_or_else(|why| panic!("{why}"))
}

/// The values of the first vertical angle, by horizontal angle.
fn around(profile: &IesProfile) -> Vec<(f64, f64)> {
    let rows = profile.vertical.len();
    let firsts = profile.candela.iter().step_by(rows);
    profile
        .horizontal
        .iter()
        .copied()
        .zip(firsts.copied())
        .collect()
}

#[test]
fn files_of_all_times_are_read() {
    let quarter = parsed(QUARTER);
    assert_eq!(quarter.vertical, [0.0, 45.0, 90.0]);
    assert_eq!(quarter.horizontal, [0.0, 90.0, 180.0, 270.0, 360.0]);
    // 2 · 0.5 · 0.8.
    let expected = [100.0, 80.0, 0.0, 100.0, 60.0, 0.0].map(|x| x * 0.8);
    assert_eq!(quarter.candela[..6], expected);
    assert_eq!(quarter.candela[6..9], expected[..3]);
    assert_eq!(quarter.candela[9..12], expected[3..]);
    assert_eq!(quarter.candela[12..], expected[..3]);

    let oldest = parsed(OLDEST);
    assert_eq!(oldest.horizontal, [0.0, 360.0]);
    assert_eq!(oldest.candela, [50.0, 10.0, 50.0, 10.0]);
    assert!(oldest.notes[0].contains("TILT"), "{:?}", oldest.notes);

    // The factor ahead of the wattage has no meaning any more.
    let half = around(&parsed(HALF));
    assert_eq!(
        half,
        [
            (0.0, 1.0),
            (90.0, 3.0),
            (180.0, 5.0),
            (270.0, 3.0),
            (360.0, 1.0)
        ]
    );
    let whole = around(&parsed(WHOLE));
    assert_eq!(
        whole,
        [
            (0.0, 1.0),
            (90.0, 2.0),
            (180.0, 3.0),
            (270.0, 4.0),
            (360.0, 1.0)
        ]
    );
    let sideways = around(&parsed(SIDEWAYS));
    assert_eq!(
        sideways,
        [
            (0.0, 2.0),
            (90.0, 1.0),
            (180.0, 2.0),
            (270.0, 3.0),
            (360.0, 2.0)
        ]
    );
}

#[test]
fn mistakes_are_named_where_they_are() {
    let with = |from: &str, to: &str| HALF.replacen(from, to, 1);
    for (text, expected) in [
        ("IESNA:LM-63-1995\n1 1\n".to_owned(), "no line `TILT=`"),
        (
            with("TILT=NONE", "TILT=LAMP.TLT"),
            "line 3: `TILT=LAMP.TLT` names another file",
        ),
        (
            with("2 3 1 2 0 0 0", "2 3 2 2 0 0 0"),
            "line 5, column 12: photometry of type B",
        ),
        (
            with("2 3 1 2 0 0 0", "2 3 3 2 0 0 0"),
            "photometry of type A",
        ),
        (
            with("2 3 1 2 0 0 0", "2 3 9 2 0 0 0"),
            "the photometric type 9 does not exist",
        ),
        (
            with("2 3 1 2 0 0 0", "2.5 3 1 2 0 0 0"),
            "the number of vertical angles cannot be 2.5",
        ),
        (
            with("90 180\n", "90 190\n"),
            "line 7, column 4: the vertical angle cannot be 190",
        ),
        (
            with("90 180\n", "90 80\n"),
            "the vertical angle 80 follows 90",
        ),
        (
            with("0 90 180\n", "0 90 120\n"),
            "line 8, column 6: horizontal angles from 0 to 120",
        ),
        (
            with("3 4", "3 x4"),
            "line 10, column 3: `x4` is no number, where a candela value",
        ),
        (with("3 4", "3 -4"), "a candela value cannot be -4"),
        (
            with("5 6", "5"),
            "line 11, column 1: the file ends here, before a candela value",
        ),
        (
            with("1 -1 1 ", "1 -1 0 "),
            "the candela multiplier cannot be 0",
        ),
        (with("1 -1 1 ", "1 -1 inf "), "`inf` is no number"),
        (with("2 3 1", "9000000 9 1"), "cannot be 9000000"),
        (with("2 3 1", "4000000 4000000 1"), "values are more than"),
        (
            HALF.replace("1 2\n3 4\n5 6", "0 0\n0 0\n0 0"),
            "all of its candela values are 0",
        ),
    ] {
        let why = IesProfile::parse(text.as_bytes()).expect_err(expected);
        assert!(why.contains(expected), "{expected}: {why}");
    }
}

/// Bytes changed, left out and repeated: an answer or a reason, never a panic.
#[test]
fn broken_files_are_refused_and_no_more() {
    let mut state = 7_u64;
    let mut next = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % below
    };
    let mut read = 0;
    for text in [QUARTER, OLDEST, HALF, WHOLE, SIDEWAYS] {
        for _ in 0..4000 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=next(3) {
                let place = next(bytes.len());
                match next(4) {
                    0 => bytes[place] = next(256) as u8,
                    1 => bytes.truncate(place.max(1)),
                    2 => bytes[place] = b"0123456789.-e, \n="[next(17)],
                    _ => {
                        let end = (place + next(20)).min(bytes.len());
                        let again = bytes[place..end].to_vec();
                        bytes.extend(again);
                    }
                }
            }
            if let Ok(profile) = IesProfile::parse(&bytes) {
                read += 1;
                let nodes = profile.vertical.len() * profile.horizontal.len();
                assert_eq!(profile.candela.len(), nodes);
                assert!(profile.horizontal.is_sorted_by(|a, b| a < b));
                assert_eq!(profile.horizontal.first(), Some(&0.0));
                assert_eq!(profile.horizontal.last(), Some(&360.0));
            }
        }
    }
    assert!(read > 1000, "{read}");
}
