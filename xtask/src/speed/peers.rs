//! Other renderers beside Etalon, on scenes that all of them can express: those of `etalon conform`, by its drivers.
//!
//! Each program renders pictures with seeds of their own, one at a time with one thread. A picture's time is all that passes until it is
//! there, the reading of the scene included (1 to 20 ms; the first, in which programs start, is not counted). Time to 1 % is
//! the shortest time × relative variance / 10⁻⁴, as elsewhere here, of pictures over the mean of the truth.

use super::pictures::{Facts, Pictures};
use etalon_conform::driver::{Driver, Programs};
use etalon_conform::mode::Mode;
use etalon_conform::plan::Plan;
use etalon_conform::questions;
use etalon_conform::runner::Runner;
use etalon_conform::suite::Suite;
use etalon_conform::tier::Tier;
use etalon_validation::folders;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// The scenes: one for each kind of light transport, all with noise.
const QUESTIONS: [&str; 6] = [
    "rectangle-light-tilted",
    "two-lights",
    "glowing-cube-0.8",
    "integrating-sphere-ball",
    "pile-of-panes",
    "scattering-box",
];

/// Samples per pixel, of pictures that are small.
const SAMPLES: u32 = 4096;

/// Pictures of each, besides the first.
const PICTURES: u32 = 8;

/// The longest that a picture may take.
const LIMIT: Duration = Duration::from_secs(300);

/// A program beside Etalon: the name of a driver of `etalon conform`, and what runs it if it is in Python.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Peer {
    driver: String,
    python: PathBuf,
}

impl FromStr for Peer {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (driver, python) = text.split_once('=').unwrap_or((text, "python3"));
        Ok(Self {
            driver: driver.to_owned(),
            python: python.into(),
        })
    }
}

/// Measures Etalon and these, and prints a table.
pub(super) fn compare(peers: &[Peer]) -> Result<(), String> {
    let etalon = folders::root().join("target/release/etalon");
    if !etalon.is_file() {
        return Err(format!(
            "there is no {}: `cargo build --release` makes it",
            etalon.display()
        ));
    }
    let own = "etalon".parse::<Peer>()?;
    let folder = folders::root().join("target/peers");
    let programs = [&[own], peers].concat();
    let drivers = programs.iter().map(|peer| {
        let programs = Programs {
            python: peer.python.clone(),
            etalon: etalon.clone(),
        };
        Driver::named(&peer.driver, &folder.join("drivers"), &programs)
    });
    let drivers = drivers.collect::<Result<Vec<Driver>, String>>()?;
    println!("{SAMPLES} samples per pixel, one thread, the shortest of {PICTURES} pictures\n");
    println!(
        "{:24} {:18} {:>9} {:>10} {:>11} {:>8}",
        "scene", "program", "s", "variance", "s to 1 %", "/ Etalon"
    );
    for question in QUESTIONS {
        let mut own = None;
        for driver in &drivers {
            let name = &driver.description.name;
            match measure(driver, question, &folder.join(name)) {
                Ok(facts) => {
                    let to_one_per_cent = 1.0 / (1e-4 * facts.efficiency());
                    let (seconds, [variance, _]) = (facts.seconds, facts.relative_variance);
                    let over = to_one_per_cent / *own.get_or_insert(to_one_per_cent);
                    println!(
                        "{question:24} {name:18} {seconds:9.3} {variance:10.3e} {to_one_per_cent:11.4} {over:8.2}"
                    );
                }
                Err(why) => println!("{question:24} {name:18} {why}"),
            }
        }
    }
    Ok(())
}

/// The times and the noise of a program's pictures.
fn measure(driver: &Driver, question: &str, folder: &Path) -> Result<Facts, String> {
    // Pictures that are there would take no time.
    let _ = std::fs::remove_dir_all(folder);
    let plan = Plan::new(1, Tier::Standard, Mode::Measure, |name| name == question);
    let suite = Suite::create(folder, plan.of(driver, driver.version()?))?;
    let ends = Mutex::new(Vec::new());
    let runner = Runner {
        workers: 1,
        limit: LIMIT,
        done: &|_, _| {
            ends.lock()
                .unwrap_or_else(|error| error.into_inner())
                .push(Instant::now())
        },
        stop: &AtomicBool::new(false),
    };
    let question = questions::by_name(question).ok_or("there is no such question")?;
    let pictures = suite.pictures(driver, &runner, question, SAMPLES, PICTURES + 1)?;
    let ends = ends.into_inner().unwrap_or_else(|error| error.into_inner());
    // The first has no time.
    let times = ends
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).as_secs_f64());
    let (_, truth) = (question.ask)();
    let mut measured = Pictures::default();
    for (picture, seconds) in pictures
        .iter()
        .zip(std::iter::once(f64::INFINITY).chain(times))
    {
        // Relative to the truth, so that its brightness does not matter.
        let relative = picture
            .luminance
            .iter()
            .map(|x| [(x / truth.mean()) as f32; 3]);
        measured.add(relative, seconds);
    }
    Ok(measured.facts(u64::from(SAMPLES)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peers_have_a_name_and_a_python() {
        let peer: Peer = "cycles=/opt/python3".parse().expect("a peer");
        assert_eq!(
            (&peer.driver[..], peer.python),
            ("cycles", "/opt/python3".into())
        );
        let peer: Peer = "luxcore".parse().expect("a peer");
        assert_eq!(peer.python, PathBuf::from("python3"));
    }
}
