//! The pages as a book: all are in it, their links lead somewhere, and the scenes on them can be rendered.

use crate::workshop::Workshop;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// Every page below `docs/`, by its path from there.
fn pages() -> Vec<(String, String)> {
    let folders = [docs(), docs().join("course")];
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten());
    let mut pages: Vec<(String, String)> = (files.filter_map(Result::ok))
        .filter(|entry| entry.path().extension().is_some_and(|kind| kind == "md"))
        .map(|entry| {
            let name = entry
                .path()
                .strip_prefix(docs())
                .expect("it is below")
                .display()
                .to_string();
            (
                name,
                std::fs::read_to_string(entry.path()).expect("it is text"),
            )
        })
        .collect();
    pages.sort();
    assert!(pages.len() > 10);
    pages
}

/// What stands outside of blocks of code.
fn prose(text: &str) -> String {
    let parts = text.split("```");
    parts.step_by(2).collect()
}

/// The targets of links in a page, and of its pictures.
fn links(text: &str) -> Vec<String> {
    let prose = prose(text);
    let mut found = Vec::new();
    for (at, _) in prose.match_indices("](") {
        let rest = &prose[at + 2..];
        found.push(rest[..rest.find(')').unwrap_or(0)].to_owned());
    }
    found
}

/// The anchors of a page's headings, as GitHub and mdBook name them.
fn anchors(text: &str) -> BTreeSet<String> {
    let prose = format!("\n{}", prose(text));
    let headings = prose.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let title = line.trim_start_matches('#').trim().to_lowercase();
            let kept = title
                .chars()
                .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

#[test]
fn every_page_is_in_the_book() {
    let summary = std::fs::read_to_string(docs().join("SUMMARY.md")).expect("it is there");
    let listed: BTreeSet<String> = links(&summary).into_iter().collect();
    let mut expected: BTreeSet<String> = pages().into_iter().map(|(name, _)| name).collect();
    expected.remove("SUMMARY.md");
    assert_eq!(listed, expected);
}

/// Links to pages, to places within them, and to files.
#[test]
fn links_lead_somewhere() {
    let readme = std::fs::read_to_string(docs().join("../README.md")).expect("it is there");
    let all = pages()
        .into_iter()
        .chain([("../README.md".to_owned(), readme)]);
    let mut lost = Vec::new();
    for (name, text) in all {
        let folder = docs()
            .join(&name)
            .parent()
            .expect("a page is in a folder")
            .to_owned();
        for link in links(&text) {
            if link.starts_with("https://") {
                continue;
            }
            let (file, anchor) = match link.split_once('#') {
                Some((file, anchor)) => (file, Some(anchor)),
                None => (link.as_str(), None),
            };
            let target = match file {
                "" => docs().join(&name),
                file => folder.join(file),
            };
            let there = match anchor {
                None => target.exists(),
                Some(anchor) => std::fs::read_to_string(&target)
                    .is_ok_and(|text| anchors(&text).contains(anchor)),
            };
            if !there {
                lost.push(format!("{name}: {link}"));
            }
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
}

/// What a page gives as a whole scene renders, without a word.
#[test]
fn scenes_of_the_pages_render() {
    let workshop = Workshop::new();
    let mut count = 0;
    for (name, text) in pages() {
        for block in text.split("```xml\n").skip(1) {
            let scene = block.split("```").next().unwrap_or_default();
            if !scene.starts_with("<scene") {
                continue;
            }
            count += 1;
            workshop.write("page.xml", scene);
            let words = [
                "render", "page.xml", "-o", "page.exr", "--size", "24x16", "--spp", "2",
            ];
            let ran = workshop.run(&words).fine();
            assert!(!ran.stderr.contains("page.xml:"), "{name}: {}", ran.stderr);
        }
    }
    assert!(count > 0);
}
