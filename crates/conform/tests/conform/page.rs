//! The page of made-up reports: nothing is missing, nothing is fetched, and nothing that a program says becomes markup.

use etalon_conform::badge::badge;
use etalon_conform::driver::PictureFormat;
use etalon_conform::judge::{Finding, Verdict};
use etalon_conform::mode::Mode;
use etalon_conform::page::{Run, page};
use etalon_conform::plan::Plan;
use etalon_conform::questions;
use etalon_conform::report::{Report, Row};
use etalon_conform::suite::Suite;
use etalon_conform::tier::Tier;
use etalon_conform::truth::Picture;
use std::fs;

/// What stands in a reason, and must not become markup.
const REASON: &str = "a <b>wide</b> & \"open\" interval <script>";

/// A finding of each kind.
fn finding(index: usize) -> Finding {
    let off = 0.001 * index as f64;
    let judged = |verdict| Finding {
        bias: Some(off),
        interval: Some([off - 0.002, off + 0.002]),
        run_interval: (!index.is_multiple_of(7)).then_some([off - 0.004, off + 0.004]),
        replicates: (0..32)
            .map(|i| {
                (
                    i % 2,
                    1.0 + off + 1e-3 * (f64::from(i * 7 % 32) / 16.0 - 1.0),
                )
            })
            .collect(),
        ..Finding::of(verdict)
    };
    match index % 5 {
        0 => judged(Verdict::Agrees),
        1 => Finding {
            tile: Some((3, 0, -1.7)),
            suspicion: Some("a factor of π: an intensity or irradiance for a radiance".to_owned()),
            ..judged(Verdict::Differs)
        },
        2 => judged(Verdict::Undecided(REASON.to_owned())),
        3 => Finding::of(Verdict::NotSupported("no media".to_owned())),
        _ => Finding::of(Verdict::Broken("seed 3: exit code 9".to_owned())),
    }
}

fn report(program: &str, driver: &str, first: usize) -> Report {
    let plan = Plan::new(1, Tier::Standard, Mode::Measure, |_| true);
    let rows = questions::ALL
        .iter()
        .enumerate()
        .map(|(index, question)| Row {
            question: question.name.to_owned(),
            finding: finding(index + first),
        });
    Report {
        version: etalon_conform::report::VERSION,
        plan: Plan {
            program: driver.to_owned(),
            title: program.to_owned(),
            program_version: "3.9.1".to_owned(),
            conventions: [
                ("units".to_owned(), "radiance < power".into()),
                (
                    "factors".to_owned(),
                    serde_json::json!({"sun": {"factor": "1/π", "reason": "no π"}, "list": [1, true]}),
                ),
            ]
            .into(),
            ..plan
        },
        seed_repeats: None,
        rows: rows.collect(),
    }
}

/// Means that are off to the right.
fn with_pictures(report: &Report) -> Run<'_> {
    let mean = |row: &Row| {
        let (_, truth) = (questions::by_name(&row.question)?.ask)();
        let means =
            (truth.means.iter().enumerate()).map(|(i, x)| x * (1.0 + 0.001 * (i % 16) as f64));
        let mean = Picture::exact(truth.pixels, means.collect());
        (!row.finding.replicates.is_empty()).then_some((row.question.clone(), mean))
    };
    Run {
        report,
        means: report.rows.iter().filter_map(mean).collect(),
    }
}

/// The page as XML: without what HTML reads in ways of its own, and with elements closed that have no contents.
fn as_xml(html: &str) -> String {
    let html = html
        .strip_prefix("<!DOCTYPE html>")
        .expect("a document type");
    let (mut xml, mut rest) = (String::new(), html);
    while let Some((text, after)) = rest.split_once('<') {
        let (tag, after) = after.split_once('>').expect("a tag ends");
        let name = tag.split([' ', '\n']).next().unwrap_or_default();
        let slash = if ["meta", "input", "img", "br"].contains(&name) {
            "/"
        } else {
            ""
        };
        xml += &format!("{text}<{tag}{slash}>");
        rest = match name {
            "script" | "style" => {
                let end = format!("</{name}>");
                let (_, after) = after.split_once(&end).expect("it ends");
                xml += &end;
                after
            }
            _ => after,
        };
    }
    xml + rest
}

/// Parses a page, and holds it to what all pages promise.
fn sound(html: &str) -> String {
    assert!(
        !html.contains("http://") && !html.contains("https://"),
        "a resource elsewhere"
    );
    for word in ["@import", "url(", "<link", "<iframe", "fetch("] {
        assert!(!html.contains(word), "{word}");
    }
    let xml = as_xml(html);
    let document = roxmltree::Document::parse(&xml).unwrap_or_else(|error| panic!("{error}"));
    let mut ids: Vec<_> = document
        .descendants()
        .filter_map(|node| node.attribute("id"))
        .collect();
    ids.sort_unstable();
    let count = ids.len();
    ids.dedup();
    assert_eq!(ids.len(), count, "an id twice");
    for node in document.descendants() {
        if let Some(place) = node
            .attribute("href")
            .and_then(|link| link.strip_prefix('#'))
        {
            assert!(ids.binary_search(&place).is_ok(), "{place} is nowhere");
        }
        if let Some(source) = node.attribute("src") {
            assert!(source.starts_with("data:image/png;base64,"), "{source}");
            assert!(node.attribute("alt").is_some_and(|text| !text.is_empty()));
        }
        if node.has_tag_name("th") {
            assert!(node.attribute("scope").is_some(), "a head of nothing");
        }
        if node.has_tag_name("svg") {
            let told = node
                .attribute("aria-label")
                .or(node.attribute("aria-hidden"));
            assert!(told.is_some(), "a drawing without words");
        }
    }
    xml
}

/// The cells of the table, row by row, as text.
fn cells(xml: &str) -> Vec<Vec<String>> {
    let document = roxmltree::Document::parse(xml).expect("it was parsed before");
    let table = document
        .descendants()
        .find(|node| node.attribute("class") == Some("matrix"));
    let body = table
        .expect("a table")
        .children()
        .find(|node| node.has_tag_name("tbody"));
    let text = |node: roxmltree::Node<'_, '_>| {
        node.descendants()
            .filter(|part| part.is_text())
            .filter_map(|part| part.text())
            .collect()
    };
    let rows = body.expect("its body").children();
    rows.map(|row| row.children().map(text).collect()).collect()
}

#[test]
fn every_question_and_verdict_is_there() {
    let report = report("Mitsuba <3>", "mitsuba", 0);
    let html = page(&[with_pictures(&report)]);
    let xml = sound(&html);
    let cells = cells(&xml);
    assert_eq!(cells.len(), questions::ALL.len());
    let signs = [
        "✓ agrees",
        "✗ differs",
        "? undecided",
        "– not supported",
        "! broken",
    ];
    for (index, (row, question)) in cells.iter().zip(questions::ALL).enumerate() {
        assert!(
            row[0].starts_with(question.name) && row[0].contains(question.title),
            "{row:?}"
        );
        assert!(row[1].starts_with(signs[index % 5]), "{row:?}");
        for text in [
            format!("id=\"question-{}\"", question.name),
            format!("scenes/{}-pose0.json", question.name),
            format!(
                "etalon conform run --driver mitsuba --only {} ",
                question.name
            ),
        ] {
            assert!(html.contains(&text), "{text}");
        }
    }
    assert!(
        cells[0][1].contains("+0.000 % [-0.200 %, +0.200 %]"),
        "{:?}",
        cells[0]
    );
    let judged = report
        .rows
        .iter()
        .filter(|row| row.finding.bias.is_some())
        .count();
    assert_eq!(html.matches("data:image/png;base64,").count(), 3 * judged);
    assert_eq!(
        html.matches("svg class=\"plot running dots\"").count(),
        judged
    );
    for text in [
        "3.9.1",
        "standard",
        "measure",
        "δ = 0.5 %",
        "1 in 1000",
        "1 in 100000",
        "no π",
        "a factor of π",
        "column 3, row 0 of 4 × 4",
        etalon_render::VERSION,
        "none can be given",
    ] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn what_programs_say_is_no_markup() {
    let report = report("Mitsuba <3>", "mine", 0);
    let html = page(&[Run::without_pictures(&report)]);
    sound(&html);
    assert!(!html.contains(REASON) && !html.contains("<b>wide"));
    assert!(
        html.contains("a &lt;b&gt;wide&lt;/b&gt; &amp; &quot;open&quot; interval &lt;script&gt;")
    );
    assert!(html.contains("Mitsuba &lt;3&gt;") && html.contains("radiance &lt; power"));
    assert!(html.contains("--driver mine.toml"));
}

#[test]
fn reports_alone_stand_side_by_side() {
    // As from their JSON; one was asked less, and one asks what this version does not know.
    let read =
        |report: &Report| -> Report { serde_json::from_str(&report.to_json()).expect("a report") };
    let mut first = read(&report("Mitsuba 3", "mitsuba", 0));
    let second = read(&report("A program", "mine", 1));
    first.rows.truncate(10);
    first.rows.push(Row {
        question: "from the future".to_owned(),
        finding: finding(0),
    });
    let html = page(&[&first, &second].map(Run::without_pictures));
    let xml = sound(&html);
    let cells = cells(&xml);
    assert_eq!(cells.len(), questions::ALL.len() + 1);
    assert!(
        cells[0][1].contains("agrees") && cells[0][2].contains("differs"),
        "{:?}",
        cells[0]
    );
    assert!(
        cells[10][1] == "not asked" && cells[10][2].contains("differs"),
        "{:?}",
        cells[10]
    );
    let last = cells.last().expect("rows");
    assert!(
        last[0] == "from the future" && last[2] == "not asked",
        "{last:?}"
    );
    assert!(!html.contains("data:image"), "there are no pictures");
    assert!(html.contains("Questions to 2 programs"));
}

#[test]
fn programs_of_one_name_are_told_apart() {
    let same = report("Mitsuba 3", "mitsuba", 0);
    let mut newer = same.clone();
    newer.plan.program_version = "4.0".to_owned();
    let html = page(&[&same, &newer, &same].map(Run::without_pictures));
    sound(&html);
    for name in [
        "<h2>Mitsuba 3 3.9.1 (1)</h2>",
        "<h2>Mitsuba 3 4.0</h2>",
        "<h2>Mitsuba 3 3.9.1 (3)</h2>",
    ] {
        assert!(html.contains(name), "{name}");
    }
}

#[test]
fn pictures_come_from_the_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let asked = |name: &str| ["wall", "sun-unit", "furnace"].contains(&name);
    let plan = Plan {
        picture: PictureFormat::Pfm,
        ..Plan::new(1, Tier::Quick, Mode::Measure, asked)
    };
    let suite = Suite::create(folder.path(), plan).expect("a run");
    let pfm = |value: f32| {
        let mut bytes = b"Pf\n16 16\n-1.0\n".to_vec();
        bytes.extend(value.to_le_bytes().repeat(256));
        bytes
    };
    for job in suite.first_look().expect("scenes") {
        let bytes = match &job.question[..] {
            "wall" => pfm(if job.seed % 2 == 0 { 0.5 } else { 1.0 }),
            "sun-unit" => b"no picture".to_vec(),
            _ => continue,
        };
        fs::write(job.picture(suite.folder.path()), bytes).expect("a picture");
    }
    let report = suite.judge();
    let run = suite.run_for_page(&report);
    let names: Vec<_> = run.means.keys().collect();
    assert_eq!(names, ["wall"], "those that can be read");
    let means = &run.means["wall"].means;
    assert_eq!(means.len(), 256);
    assert!(
        means.iter().all(|mean| (mean - 0.75).abs() < 1e-12),
        "{means:?}"
    );
    let html = page(&[run]);
    sound(&html);
    assert_eq!(html.matches("data:image/png;base64,").count(), 3);
    assert!(html.contains("--tier quick"));
}

#[test]
fn a_badge_counts_what_was_asked() {
    let report = report("A < B", "a", 0);
    let svg = badge(&report);
    let document = roxmltree::Document::parse(&svg).expect("SVG is XML");
    let texts: Vec<&str> = (document.descendants())
        .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "text")))
        .filter_map(|node| node.text())
        .collect();
    let of = |kind: usize| (questions::ALL.len() + 4 - kind) / 5;
    let expressed = questions::ALL.len() - of(3);
    let expected = format!("{} of {expressed} within 0.5 %, {} differ", of(0), of(1));
    assert_eq!(texts, ["etalon conform", &expected[..]]);
    let title = document.root_element().attribute("aria-label");
    assert!(title.is_some_and(|title| title.starts_with("A < B 3.9.1: ")));
}
