//! Programs that are run: shell scripts in place of renderers.

#![cfg(unix)]

use etalon_conform::driver::{Driver, Programs};
use etalon_conform::judge::Verdict;
use etalon_conform::mode::Mode;
use etalon_conform::plan::Plan;
use etalon_conform::refinement::Trend;
use etalon_conform::report::Report;
use etalon_conform::runner::Runner;
use etalon_conform::suite::Suite;
use etalon_conform::tier::Tier;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

fn programs() -> Programs {
    Programs {
        python: "python3".into(),
        etalon: "etalon".into(),
    }
}

/// A driver whose script is this.
fn driver(folder: &Path, script: &str, more: &str) -> Result<Driver, String> {
    fs::write(folder.join("program.sh"), script).expect("a script");
    let toml = folder.join("program.toml");
    let text = format!(
        "name = \"program\"\ntitle = \"A program\"\nversion = [\"echo\", \"program 7\"]\n\
         script = \"program.sh\"\npicture = \"pfm\"\n{more}"
    );
    fs::write(&toml, text).expect("a driver");
    Driver::read(&toml, &programs())
}

const COMMAND: &str = "command = [\"sh\", \"{driver}\", \"{out}\", \"{seed}\", \"{scene}\"]\n";

/// The one question of a wall.
fn run(folder: &Path, driver: &Driver) -> Result<Report, String> {
    ask(&folder.join("run"), driver, Tier::Quick, Mode::Measure)
}

fn ask(folder: &Path, driver: &Driver, tier: Tier, mode: Mode) -> Result<Report, String> {
    let plan = Plan::new(1, tier, mode, |name| name == "wall");
    let plan = plan.of(driver, driver.version()?);
    let mut suite = Suite::create(folder, plan)?;
    let runner = Runner {
        workers: 2,
        limit: Duration::from_secs(2),
        done: &|_, _| {},
        stop: &AtomicBool::new(false),
    };
    suite.run(driver, &runner, |_, _| {})
}

#[test]
fn half_a_picture_is_not_left() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = "printf 'Pf\\n16 16\\n-1.0\\n' > \"$1\"; exit 9";
    let half = driver(folder.path(), script, COMMAND).expect("a driver");
    run(folder.path(), &half).expect("a run");
    let left = fs::read_dir(folder.path().join("run/pictures")).expect("a folder");
    assert_eq!(left.count(), 0);
}

/// Writes a picture of 16 × 16 pixels of 1.
const WALL: &str = r#"{ printf 'Pf\n16 16\n-1.0\n'; i=0; while [ $i -lt 256 ]; do printf '\0\0\200\77'; i=$((i+1)); done; } > "$1"
"#;

fn verdict(script: &str, more: &str) -> Verdict {
    let folder = tempfile::tempdir().expect("a folder");
    let driver = driver(folder.path(), script, &format!("{COMMAND}{more}")).expect("a driver");
    let report = run(folder.path(), &driver).expect("a run");
    assert_eq!(report.rows.len(), 1);
    assert_eq!(report.plan.program_version, "program 7");
    report.rows[0].finding.verdict.clone()
}

#[test]
fn a_program_that_is_right_agrees() {
    assert_eq!(verdict(WALL, ""), Verdict::Agrees);
}

#[test]
fn what_goes_wrong_is_told() {
    let said = |verdict: Verdict| match verdict {
        Verdict::Broken(how) | Verdict::NotSupported(how) => how,
        other => panic!("{other:?}"),
    };
    let unsupported = verdict("echo 'no walls' >&2; exit 3", "");
    assert_eq!(unsupported, Verdict::NotSupported("no walls".to_owned()));
    assert!(said(verdict("echo 'out of luck' >&2; exit 9", "")).contains("out of luck"));
    assert!(said(verdict("exit 0", "")).contains("no picture"));
    assert!(said(verdict("sleep 30", "")).contains("longer than 2 s"));
    assert!(said(verdict("echo P > \"$1\"", "")).contains("pfm"));
}

#[test]
fn jobs_are_answered_line_by_line() {
    let script = format!(
        "while read -r line; do out=${{line#*\\\"out\\\":\\\"}}; out=${{out%%\\\"*}}; set -- \"$out\"\n{WALL}\
         echo \"{{\\\"out\\\": \\\"$out\\\"}}\"; done"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let more = "command = [\"sh\", \"{driver}\"]\nbatch = true\n";
    let batch = driver(folder.path(), &script, more).expect("a driver");
    let report = run(folder.path(), &batch).expect("a run");
    assert_eq!(report.rows[0].finding.verdict, Verdict::Agrees);
    // Another run has no place in the folder; the same goes on.
    assert!(run(folder.path(), &batch).is_ok());
    let other = driver(folder.path(), WALL, &format!("{COMMAND}seed = false\n"));
    let refusal = run(folder.path(), &other.expect("a driver")).expect_err("another run");
    assert!(refusal.contains("another folder"), "{refusal}");
}

#[test]
fn drivers_are_read_with_care() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |more: &str| driver(folder.path(), "", more).expect_err("a mistake");
    assert!(refused("").contains("command"));
    assert!(refused("command = []\n").contains("no words"));
    assert!(refused("command = [\"x\"]\nspeed = 3\n").contains("speed"));
    let how = refused("command = [\"{nothing}\"]\n");
    assert!(
        how.contains("`{nothing}`") && how.contains("scene"),
        "{how}"
    );
    assert!(
        Driver::named("nobody", folder.path(), &programs()).is_err_and(|e| e.contains("etalon"))
    );
}

/// Writes a picture that is 1/128 to 1/64 too bright: by a number, of which each below 2¹⁶ gives another picture.
fn too_bright_by(number: &str) -> String {
    format!(
        r#"n=$(( {number} * 7919 )); b=$(printf '\\%03o\\%03o\\%03o\\077' $((n / 256 % 256)) $((n % 256)) 129)
b="$b$b$b$b"; b="$b$b$b$b"; b="$b$b$b$b"; {{ printf 'Pf\n16 16\n-1.0\n'; printf "$b$b$b$b"; }} > "$1"
"#
    )
}

/// Of what differs eight pictures with four times the samples are made, which have the same error, and one picture again.
#[test]
fn more_samples_and_a_seed_again_are_told() {
    let report = |number: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        let driver = driver(folder.path(), &too_bright_by(number), COMMAND).expect("a driver");
        let into = folder.path().join("run");
        ask(&into, &driver, Tier::Standard, Mode::Measure).expect("a report")
    };
    let repeats = report("$2");
    let finding = &repeats.rows[0].finding;
    assert_eq!(finding.verdict, Verdict::Differs, "{finding:?}");
    let refinement = finding.refinement.as_ref().expect("more samples");
    assert_eq!(refinement.trend, Some(Trend::Constant), "{refinement:?}");
    assert!(repeats.table().contains("the error stays the same"));
    assert_eq!(repeats.seed_repeats, Some(true));
    // What depends on the process is another one each time.
    let other = report("$$");
    assert_eq!(other.seed_repeats, Some(false));
    assert!(
        other.table().contains("cannot be repeated"),
        "{}",
        other.table()
    );
}

/// What a program ships is told, and decides nothing.
#[test]
fn shipped_programs_are_not_judged() {
    let folder = tempfile::tempdir().expect("a folder");
    let driver = driver(folder.path(), &too_bright_by("$2"), COMMAND).expect("a driver");
    for (mode, code) in [(Mode::Measure, 1), (Mode::Shipped, 0)] {
        let into = folder.path().join(mode.name());
        let report = ask(&into, &driver, Tier::Quick, mode).expect("a report");
        assert_eq!(report.rows[0].finding.verdict, Verdict::Differs);
        assert_eq!(report.exit_code(), code, "{}", mode.name());
    }
}
