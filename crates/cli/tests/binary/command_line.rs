//! The command line itself: help, versions, and what is no command.

use crate::workshop::Workshop;

#[test]
fn help_has_examples_and_exit_codes() {
    let workshop = Workshop::new();
    let help = workshop.run(&["--help"]).fine().stdout;
    for command in [
        "render",
        "merge",
        "compare",
        "estimators",
        "convert",
        "info",
        "denoise",
        "replicates",
    ] {
        assert!(help.contains(&format!("\n  {command} ")), "{help}");
        let help = workshop.run(&[command, "--help"]).fine().stdout;
        let examples = help.split("Examples:\n").nth(1).expect("examples");
        let example = format!("  etalon {command} ");
        assert!(examples.matches(&example).count() >= 2, "{help}");
        assert!(help.contains("Exit codes:"), "{help}");
    }
    assert!(help.contains("Exit codes:"), "{help}");
    // What is not built yet is not offered.
    for absent in ["serve", "--checkpoint"] {
        let all = ["render", "merge", "compare", "convert", "info"]
            .map(|command| workshop.run(&[command, "--help"]).fine().stdout)
            .concat();
        assert!(!all.contains(absent) && !help.contains(absent), "{absent}");
    }
}

#[test]
fn plugins_and_their_parameters_are_told() {
    let workshop = Workshop::new();
    let all = workshop.run(&["info", "--plugins"]).fine().stdout;
    for name in [
        "\n  diffuse ",
        "\n  hair ",
        "\nEmitters\n",
        "\n  linearcurve, bsplinecurve ",
    ] {
        assert!(all.contains(name), "{name} in {all}");
    }
    let one = workshop.run(&["info", "--plugins", "scale"]).fine().stdout;
    assert!(one.starts_with("Textures and spectra: `scale`"), "{one}");
    let rough = workshop
        .run(&["info", "--plugins", "roughconductor"])
        .fine()
        .stdout;
    assert!(
        rough.contains("| `alpha` | spectrum or texture | 0.1 |"),
        "{rough}"
    );
    let ran = workshop.run(&["info", "--plugins", "dieletric"]).refused();
    assert!(
        ran.stderr.contains("did you mean `dielectric`?"),
        "{}",
        ran.stderr
    );
    let script = workshop.run(&["completions", "bash"]).fine().stdout;
    assert!(script.contains("complete -F _etalon"), "{script}");
}

#[test]
fn the_version_is_told() {
    let said = Workshop::new().run(&["--version"]).fine().stdout;
    assert_eq!(said, format!("etalon {}\n", env!("CARGO_PKG_VERSION")));
    for order in [["--version", "--verbose"], ["--verbose", "-V"]] {
        let all = Workshop::new().run(&order).fine().stdout;
        assert!(all.starts_with(&said), "{all}");
        for line in ["\ncommit: ", "\ntarget: ", "\ninstructions: "] {
            assert!(all.contains(line), "{line} in {all}");
        }
    }
}

/// A processor of 2008, if the emulator of one is installed, is told what it lacks instead of being stopped without a word.
#[test]
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
fn a_processor_without_avx2_is_refused_in_words() {
    let binary = env!("CARGO_BIN_EXE_etalon");
    let old = |arguments: &[&str]| {
        (std::process::Command::new("qemu-x86_64").args(["-cpu", "Nehalem", binary]))
            .args(arguments)
            .output()
    };
    let Ok(ran) = old(&["--version"]) else {
        eprintln!("not tried: there is no qemu-x86_64");
        return;
    };
    let said = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(2), "{said}");
    assert!(
        said.starts_with("error: this processor has no AVX2") && said.contains("target-cpu=native"),
        "{said}"
    );
}

#[test]
fn nonsense_is_refused() {
    let workshop = Workshop::new();
    for arguments in [
        &[][..],
        &["rendr"],
        &["render"],
        &["render", "a.xml"],
        &["render", "a.xml", "-o", "a.exr", "--spp", "0"],
        &["render", "a.xml", "-o", "a.exr", "--spp", "-1"],
        &["render", "a.xml", "-o", "a.exr", "--spp", "many"],
        &["render", "a.xml", "-o", "a.exr", "--seed", "-1"],
        &["render", "a.xml", "-o", "a.exr", "--threads", "0"],
        &["render", "a.xml", "-o", "a.exr", "--replicates", "0"],
        &["render", "a.xml", "-o", "a.exr", "-D", "=1"],
        &["compare", "a.exr"],
        &["estimators", "a.xml"],
        &["estimators", "--time", "3"],
        &["convert", "a.exr"],
        &["info"],
    ] {
        let ran = workshop.run(arguments).refused();
        assert!(
            ran.stderr.contains("Usage") || ran.stderr.contains("error: "),
            "{arguments:?}"
        );
    }
    assert!(workshop.files().is_empty());
}

#[test]
fn messages_have_no_colours_where_nobody_looks() {
    let workshop = Workshop::new();
    workshop.write(
        "bad.xml",
        "<scene version=\"3.0.0\"><shape type=\"sphear\"/></scene>",
    );
    let ran = workshop
        .run(&["render", "bad.xml", "-o", "a.exr"])
        .refused();
    assert!(!ran.stderr.contains('\u{1b}'), "{:?}", ran.stderr);
    assert!(
        ran.stderr.contains("did you mean `sphere`?"),
        "{}",
        ran.stderr
    );
}

/// A number that cannot be is told what could be, not how to pass it as something else.
#[test]
fn negative_numbers_are_told_what_is_accepted() {
    let workshop = Workshop::new();
    let whole = "expected a whole number from ";
    for (option, value, words) in [
        ("--time", "-1", "expected a number of seconds from 0.001"),
        ("--time", "-1e9", "expected a number of seconds from 0.001"),
        (
            "--seed",
            "-1",
            "expected a whole number from 0 to 18446744073709551615",
        ),
        ("--seed", "1.5", whole),
        (
            "--spp",
            "-1",
            "expected a whole number from 1 to 4294967295",
        ),
        ("--spp", "4294967296", whole),
        ("--threads", "-2", "expected a whole number from 1 to 1024"),
        (
            "--replicates",
            "-3",
            "expected a whole number from 1 to 4096",
        ),
        ("--error", "-0.1", "expected a number from 0.000001 to 1"),
        ("--part", "-1/2", "expected I/N"),
        ("--replay", "-1,0,-1,0", "expected four numbers"),
    ] {
        let ran = workshop.run(&["render", "a.xml", option, value]).refused();
        assert!(
            ran.stderr.contains(words),
            "{option} {value}: {}",
            ran.stderr
        );
        assert!(!ran.stderr.contains("-- -"), "{option}: {}", ran.stderr);
    }
    for option in ["--bound", "--tile-bound", "--alpha"] {
        let ran = workshop.run(&["compare", "a.exr", "b.exr", option, "-1"]);
        let said = ran.refused().stderr;
        assert!(said.contains("expected a number between 0 and 1"), "{said}");
    }
    for option in ["--time", "--seed", "--threads", "--reference-share"] {
        let ran = workshop.run(&["estimators", "a.xml", option, "-1"]);
        let said = ran.refused().stderr;
        assert!(!said.contains("-- -1"), "{option}: {said}");
    }
}
