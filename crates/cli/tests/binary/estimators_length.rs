//! How long the pictures of `etalon estimators` are, and what is said where they are too short.

use crate::estimators::{estimators, findings, number};
use crate::workshop::Workshop;

/// Pictures are as long as they are asked to be, of one that learns it is said where they were too short, and the page can be
/// exposed.
#[test]
fn pictures_are_as_long_as_asked() {
    let workshop = Workshop::new();
    let run = |length: &str| {
        let options = [
            "--integrators",
            "path,guided",
            "--time",
            "4",
            "--json",
            "f.json",
        ];
        let ran = estimators(
            &workshop,
            &[
                &options[..],
                &["--report", "r.html", "--picture-time", length],
            ]
            .concat(),
        );
        let rows = findings(&workshop)["estimators"].clone();
        let seconds = [0, 1].map(|row| number(&rows[row]["equal_time"]["seconds"]["value"]));
        assert_eq!([&rows[0]["prepares"], &rows[1]["prepares"]], [false, true]);
        (ran.fine().stdout, seconds)
    };
    let (said, short) = run("0.004");
    assert!(said.contains("equal time: pictures of about"), "{said}");
    assert!(
        said.contains("note: `guided` learns or prepares for each picture"),
        "{said}"
    );
    assert!(!said.contains("`path` learns"), "{said}");
    let (_, long) = run("0.04");
    // Samples come in powers of two, and a busy machine is slow.
    assert!(long[0] > 1.5 * short[0], "{short:?} {long:?}");
    let page = String::from_utf8(workshop.read("r.html")).expect("text");
    assert!(page.contains("Exposure of all pictures") && page.contains("data-picture"));
    let options = [
        "--integrators",
        "path,guided",
        "--time",
        "1",
        "--picture-time",
    ];
    let refused = estimators(&workshop, &[&options[..], &["20"]].concat()).refused();
    assert!(
        refused.stderr.contains("a picture 20 s"),
        "{}",
        refused.stderr
    );
    let refused = estimators(&workshop, &[&options[..], &["soon"]].concat()).refused();
    assert!(
        refused.stderr.contains("expected a number of seconds"),
        "{}",
        refused.stderr
    );
}
