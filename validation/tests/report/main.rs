//! The report in a real browser: it loads without errors, pictures are compared and exposed, rows
//! are filtered, sorted and unfolded, all of it by keyboard, wide and narrow, light and dark.
//!
//! The last test breaks the page on purpose, one part at a time: what finds nothing proves nothing.

mod browser;
mod rows;

use browser::{Folder, exercise, failures};
use etalon_render::decide::judged::{self, Against};
use etalon_render::report::{comparison, running};
use etalon_validation::claim::Claim;
use etalon_validation::json::Provenance;
use etalon_validation::outcome::Row;
use etalon_validation::{folders, html, json, table};

/// The size of a desk's window and of a phone's (pixels).
const DESK: [u32; 2] = [1280, 900];
const PHONE: [u32; 2] = [390, 844];

/// What [`browser::exercise`] runs, for a window of this width.
fn script([width, _]: [u32; 2]) -> String {
    include_str!("exercise.js").replace("WIDTH", &width.to_string())
}

fn provenance() -> Provenance {
    Provenance {
        version: "0.0.0".to_owned(),
        program: Some("89abcdef01234567".to_owned()),
        floating_point: "0123456789abcdef".to_owned(),
        machine: "a machine".to_owned(),
        threads: 2,
        seed: 1,
        tier: "default",
        part: None,
        hypotheses: 8,
        plan: "0123456789ab".to_owned(),
        seconds: 61.5,
    }
}

/// The page of a run with every kind of row.
fn validation() -> String {
    html::page(&rows::rows(&rows::claims()), &provenance())
}

/// The page of `etalon compare` on pictures that differ.
fn compared() -> String {
    let (known, truth) = rows::truth();
    let picture = rows::picture(5, 0.2, 1.0);
    let judged = judged::judge(
        &picture,
        Against::ExactImage(&known),
        rows::RULES,
        rows::ASKED,
    );
    let judgement = judged.expect("comparable").judgement;
    let names = [
        "a long name of a picture.exr".to_owned(),
        "b.exr".to_owned(),
    ];
    comparison::judged(&judgement, &picture, &truth, &names)
}

#[test]
fn a_report_works_at_a_desk_and_on_a_phone() {
    let Some(browser) = browser::found() else {
        return;
    };
    let folder = Folder::new("report");
    for (name, html, checks) in [("validate", validation(), 31), ("compare", compared(), 20)] {
        for size in [DESK, PHONE] {
            let findings = exercise(&browser, folder.path(), &html, &script(size), size);
            assert_eq!(failures(&findings), [""; 0], "{name} at {size:?}");
            assert_eq!(findings.len(), checks, "{name}: {findings:#?}");
        }
    }
}

#[test]
fn a_report_is_one_file_of_a_sane_size() {
    let html = validation();
    for foreign in ["http:", "https:", "<script src", "<link", "url(", "src=\"/"] {
        assert!(!html.contains(foreign), "{foreign}");
    }
    // Four pictures of our own, one oracle that four rows share, and two maps for each row.
    assert_eq!(
        html.matches("<script type=\"text/plain\"").count(),
        4 + 1 + 8
    );
    assert_eq!(html.matches("<canvas").count(), 8);
    // What was written by others cannot become markup.
    assert!(html.contains("there is no &lt;reference&gt;"));
    // The default run has 120 rows of pictures as large as these or a little larger.
    assert!(html.len() < 7 * 100_000, "{}", html.len());
}

#[test]
fn a_reference_says_who_made_it_and_how() {
    for (name, expected) in [
        ("cornell-box", ["mitsuba 3.9.1", "seeds 32", "spp 256"]),
        // Mutant rejected: descriptions read as Mitsuba's alone.
        (
            "povray-spheres",
            [
                "povray 3.7.0.10.unofficial",
                "options +FE -A -D +W128 +H96",
                "size 128 × 96",
            ],
        ),
    ] {
        let claim = Claim::read(&folders::claims().join(format!("{name}.toml")));
        let claim = claim.expect("a claim");
        let html = html::page(&[rows::broken(&claim)], &provenance());
        for text in expected {
            assert!(html.contains(text), "{name}: {text}");
        }
    }
}

#[test]
fn the_bound_that_is_counted_is_in_the_table_and_on_the_page() {
    let claims = rows::claims();
    let rows = rows::rows(&claims);
    let bound = rows[0].compared.as_ref().ok().and_then(|c| c.bias_bound);
    let percent = 100.0 * bound.expect("of pictures");
    // Rounded up: 0.500001 % is not below 0.5 %.
    let shown = format!("{:.4} %", (1e4 * percent).ceil() / 1e4);
    assert!(table::head().contains("bias < (99 %)"));
    assert!(table::line(&rows[0]).contains(&shown), "{shown}");
    let page = validation();
    assert!(page.contains(&format!("bias &lt; {shown} (99 %)")));
    assert_eq!(page.matches(&shown).count(), 2, "the line and its detail");
    // Headings stand over what they name.
    let at = |line: &str, text: &str| {
        line.find(text)
            .map(|i| line[..i].chars().count() + text.chars().count())
    };
    assert_eq!(
        at(&table::head(), "bias < (99 %)"),
        at(&table::line(&rows[0]), &shown)
    );
}

#[test]
fn what_is_in_doubt_is_told_from_what_is_too_wide() {
    let claims = rows::claims();
    let mut rows = rows::rows(&claims);
    let told = |rows: &[Row<'_>]| {
        let page = html::page(rows, &provenance());
        let found = json::of(rows, &provenance())["rows"][2]["in_doubt"].clone();
        let line = table::line(&rows[2]).contains("in doubt");
        (found, line, page.matches("numbers\">in doubt<").count())
    };
    assert_eq!(told(&rows), (false.into(), false, 0));
    rows[2].decision.in_doubt = true;
    assert_eq!(told(&rows), (true.into(), true, 1));
}

#[test]
fn a_running_bias_ends_with_the_decision() {
    let (known, truth) = rows::truth();
    let picture = rows::picture(6, 0.001, 1.0);
    let other = rows::picture(7, 0.0, 1.0);
    for (against, drawn) in [
        (Against::ExactImage(&known), &truth),
        (Against::Picture(&other), &other),
    ] {
        let judged = judged::judge(&picture, against, rows::RULES, rows::ASKED);
        let judgement = judged.expect("comparable").judgement;
        let widest = judgement.widest().expect("a channel");
        let curve = running::of(&judgement, &picture, drawn).expect("replicates");
        let last = curve.points.last().expect("points");
        assert_eq!(
            (curve.channel.as_str(), last.samples),
            (widest.channel.as_str(), 128.0)
        );
        for (found, decided) in [
            (last.bias, widest.bias),
            (last.interval[0], widest.interval[0]),
            (last.interval[1], widest.interval[1]),
        ] {
            // Mutant rejected: the level of the whole comparison in place of one question's.
            assert!((found - decided).abs() < 1e-9, "{found} {decided}");
        }
    }
}

#[test]
fn a_broken_page_is_found_out() {
    let Some(browser) = browser::found() else {
        return;
    };
    let folder = Folder::new("report-mutants");
    let html = validation();
    for (text, fault, finding) in [
        (
            "ArrowLeft: split - step",
            "ArrowLeft: split",
            "the slider moves by arrow keys",
        ),
        (
            "1.055 * Math.min(x, 1) ** (1 / 2.4)",
            "1.055 * Math.min(x, 1) ** (1 / 2.2)",
            "exposure is linear and honest",
        ),
        (
            "source.at(i) / full",
            "-source.at(i) / full",
            "the map is signed",
        ),
        (
            "row.hidden = !(",
            "row.hidden = false && (",
            "filters hide rows by outcome",
        ),
        (
            "--quiet: light-dark(#575f6b",
            "--quiet: light-dark(#a0a5ad",
            "the theme has a button",
        ),
        (
            "table.decisions { width: 100%;",
            "table.decisions { width: 1500px;",
            "the page is no wider",
        ),
    ] {
        assert_eq!(html.matches(text).count(), 1, "{text}");
        let broken = html.replace(text, fault);
        let findings = exercise(&browser, folder.path(), &broken, &script(DESK), DESK);
        let failures = failures(&findings).join("\n");
        assert!(failures.contains(finding), "{fault}: {failures}");
    }
}
