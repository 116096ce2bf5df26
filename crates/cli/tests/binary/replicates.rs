//! `etalon replicates`: pictures of another program's seeds.

use crate::workshop::Workshop;

/// Eight pictures of eight seeds as another program might have made them: colours alone, in PFM. The scene
/// of the last is told by `-D`.
fn seeds(workshop: &Workshop, further: &[&str]) -> Vec<String> {
    let make = |seed: u32| {
        let (exr, pfm) = ("seed.exr", format!("{seed}.pfm"));
        let seed = seed.to_string();
        let chosen = ["--spp", "256", "-q", "--seed", &seed];
        workshop.render(exr, &[&chosen, further].concat()).fine();
        workshop.run(&["convert", exr, &pfm]).fine();
        pfm
    };
    (1..=8).map(make).collect()
}

fn together(workshop: &Workshop, pictures: &[String], output: &str) -> crate::workshop::Ran {
    let mut arguments = vec!["replicates"];
    arguments.extend(pictures.iter().map(String::as_str));
    arguments.extend(["-o", output, "--spp", "256", "--program", "mine 1.0"]);
    workshop.run(&arguments)
}

#[test]
fn seeds_of_another_program_can_be_judged() {
    let workshop = Workshop::new();
    let pictures = seeds(&workshop, &[]);
    let ran = together(&workshop, &pictures, "mine.exr").fine();
    assert!(
        ran.stderr
            .contains("mine.exr: 8 replicates, mean relative standard error")
    );
    let image = workshop.image("mine.exr");
    let facts = image.metadata.as_ref().expect("statistics");
    assert_eq!((facts.replicates, facts.spp), (8, 2048));
    assert_eq!(facts.version, "mine 1.0");
    workshop.render("ours.exr", &["--spp", "1024", "-q", "--seed", "99"]);
    let bound = ["--bound", "0.1"];
    let compare = |a, b| workshop.run(&[&["compare", a, b][..], &bound].concat());
    // α = 10⁻³; the mutant below, a scene half again as bright, is rejected.
    let ran = compare("mine.exr", "ours.exr");
    assert_eq!(ran.code, Some(0), "{}{}", ran.stdout, ran.stderr);
    assert!(!ran.stderr.contains("different scenes"), "{}", ran.stderr);
    let bright: Vec<String> = pictures
        .iter()
        .map(|name| format!("bright-{name}"))
        .collect();
    for (name, bright) in pictures.iter().zip(&bright) {
        let brighter = ["convert", name, bright, "--exposure", "0.585"];
        workshop.run(&brighter).fine();
    }
    together(&workshop, &bright, "bright.exr").fine();
    assert_eq!(compare("bright.exr", "ours.exr").code, Some(1));
}

#[test]
fn what_would_spoil_the_errors_is_named() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "4", "-q"]);
    workshop.render("b.exr", &["--spp", "4", "-q", "--seed", "2"]);
    workshop.render("small.exr", &["--spp", "4", "-q", "--scale", "50%"]);
    let names = |names: &[&str]| -> Vec<String> { names.iter().map(|&n| n.to_owned()).collect() };
    for (pictures, reason) in [
        (&["a.exr"][..], "one picture has no standard error"),
        (
            &["a.exr", "b.exr", "a.exr"],
            "a.exr: it has the pixels of picture 1",
        ),
        (
            &["a.exr", "small.exr"],
            "small.exr: the image has 12 × 10 pixels, not 24 × 20",
        ),
        (&["a.exr", "nowhere.exr"], "nowhere.exr"),
    ] {
        let ran = together(&workshop, &names(pictures), "new.exr").refused();
        assert!(ran.stderr.contains(reason), "{}", ran.stderr);
    }
    let ran = together(&workshop, &names(&["a.exr", "b.exr"]), "new.png").refused();
    assert!(ran.stderr.contains("must end in .exr"), "{}", ran.stderr);
    let spp = [
        "replicates",
        "a.exr",
        "b.exr",
        "-o",
        "new.exr",
        "--spp",
        "0",
    ];
    workshop.run(&spp).refused();
    assert_eq!(workshop.files(), ["a.exr", "b.exr", "small.exr"]);
}
