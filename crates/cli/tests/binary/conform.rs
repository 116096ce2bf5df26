//! `etalon conform`: questions to other programs, and to Etalon itself.

use crate::workshop::Workshop;

#[test]
fn questions_and_truths_are_told() {
    let workshop = Workshop::new();
    let ran = workshop.run(&["conform", "list"]).fine();
    for name in ["wall", "sphere-light-small", "mitsuba"] {
        assert!(ran.stdout.contains(name), "{}", ran.stdout);
    }
    let ran = workshop.run(&["conform", "truth", "pane-0"]).fine();
    // (1 - F)/(1 + F) with F = 0.04.
    assert!(ran.stdout.contains("0.923076"), "{}", ran.stdout);
    let ran = workshop.run(&["conform", "truth", "pane-00"]);
    assert_eq!(ran.code, Some(2));
    assert!(
        ran.stderr.contains("did you mean `pane-0`?"),
        "{}",
        ran.stderr
    );
}

/// Etalon answers its own questions; the same with a lamp twice as bright as it should be differs. The quick tier, two questions.
#[test]
fn a_run_is_judged_kept_and_compared() {
    let workshop = Workshop::new();
    let run = |more: &[&str]| {
        let fixed = ["conform", "run", "--tier", "quick", "--only", "*-unit"];
        workshop.run(&[&fixed, more].concat())
    };
    let ran = run(&["--driver", "etalon", "-o", "sound"]).fine();
    assert!(
        ran.stdout.contains("point-light-unit  agrees"),
        "{}",
        ran.stdout
    );
    assert!(ran.stdout.contains("2 agrees"), "{}", ran.stdout);

    // The program's own pictures, twice as bright.
    let etalon = env!("CARGO_BIN_EXE_etalon");
    let script = "\"$1\" render \"$2\" -o \"$3.exr\" --spp 16 --seed $4 -q && \"$1\" convert \"$3.exr\" \"$3\" --exposure 1";
    std::fs::write(workshop.path("twice.sh"), script).expect("a script");
    let toml = format!(
        "name = \"twice\"\ntitle = \"Twice\"\nversion = [\"echo\", \"2\"]\nscript = \"twice.sh\"\npicture = \"pfm\"\n\
         command = [\"sh\", \"{{driver}}\", \"{}\", \"{{xml}}\", \"{{out}}\", \"{{seed}}\"]\n",
        etalon
    );
    std::fs::write(workshop.path("twice.toml"), toml).expect("a driver");
    let ran = run(&["--driver", "twice.toml", "--baseline", "sound/report.json"]);
    assert_eq!(ran.code, Some(1), "{}{}", ran.stdout, ran.stderr);
    assert!(ran.stdout.contains("a factor of 2"), "{}", ran.stdout);
    assert!(
        ran.stdout.contains("agrees, now differs  worse"),
        "{}",
        ran.stdout
    );
    let diff = |old, new| workshop.run(&["conform", "diff", old, new]);
    let ran = diff("sound/report.json", "conform-twice/report.json");
    assert_eq!(ran.code, Some(1));
    let ran = diff("conform-twice/report.json", "sound/report.json").fine();
    assert!(ran.stdout.contains("differs, now agrees"), "{}", ran.stdout);
    let page = [
        "conform",
        "page",
        "sound/report.json",
        "conform-twice/report.json",
        "-o",
        "both.html",
    ];
    workshop.run(&page).fine();
    let page = String::from_utf8(workshop.read("both.html")).expect("text");
    assert!(page.contains("point-light-unit") && page.contains("Twice"));
    assert!(workshop.path("sound/index.html").is_file());
    assert!(workshop.path("sound/badge.svg").is_file());
    let ran = run(&[
        "--driver",
        "twice.toml",
        "--baseline",
        "conform-twice/report.json",
    ]);
    assert_eq!(ran.code, Some(2), "what was read is not written over");
    // Pictures that are there are judged again without the program.
    let ran = workshop.run(&["conform", "judge", "conform-twice"]);
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert!(ran.stdout.contains("2 differs"), "{}", ran.stdout);
}

#[test]
fn scenes_are_exported_for_others() {
    let workshop = Workshop::new();
    let export = ["conform", "export", "--to", "asked", "--only", "wall"];
    workshop.run(&export).fine();
    let text = |name: &str| std::fs::read_to_string(workshop.path(name)).expect("a file");
    assert_eq!(text("asked/jobs.jsonl").lines().count(), 32);
    assert!(text("asked/scenes/wall-pose1.json").contains("\"width_m\""));
    let ran = workshop.run(&["conform", "judge", "asked"]);
    assert_eq!(ran.code, Some(3), "{}", ran.stdout);
}

#[test]
fn mistakes_are_told() {
    let workshop = Workshop::new();
    for (arguments, word) in [
        (
            &["run", "--driver", "nobody"][..],
            "there is no driver `nobody`",
        ),
        (&["run", "--driver", "none.toml"], "none.toml"),
        (
            &["run", "--driver", "etalon", "--only", "walls"],
            "no question",
        ),
        (
            &["run", "--driver", "mitsuba", "--python", "no-such-python"],
            "it needs the Python module",
        ),
        (
            &["run", "--driver", "etalon", "--part", "3/2"],
            "expected I/N",
        ),
        (&["judge", "nowhere"], "nowhere"),
        (&["diff", "a.json", "b.json"], "a.json"),
    ] {
        let ran = workshop.run(&[&["conform"], arguments].concat());
        assert_eq!(ran.code, Some(2), "{arguments:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(word), "{arguments:?}: {}", ran.stderr);
    }
}
