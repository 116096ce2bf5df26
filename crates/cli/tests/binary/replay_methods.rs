//! `etalon render --replay` of estimators that do much by themselves: what they say of it adds up.

use crate::workshop::{Workshop, small_scene};

/// What a replay of a sample in the small scene says.
fn replayed(integrator: &str, address: &str) -> String {
    let workshop = Workshop::new();
    workshop.write("a.xml", small_scene(integrator));
    let ran = workshop.run(&["render", "a.xml", "--replay", address]);
    ran.fine().stdout
}

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || ".-".contains(c)))
        .filter_map(|word| word.parse().ok())
        .collect()
}

/// The numbers in what follows some words.
fn after(line: &str, words: &str) -> Vec<f64> {
    let (_, rest) = line.split_once(words).expect(words);
    numbers(rest)
}

fn sum(triples: impl Iterator<Item = Vec<f64>>) -> [f64; 3] {
    triples.fold([0.0; 3], |[r, g, b], more| {
        [r + more[0], g + more[1], b + more[2]]
    })
}

#[track_caller]
fn assert_close(found: [f64; 3], expected: &[f64], scale: f64) {
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= 1e-5 * scale,
            "{found} {expected}"
        );
    }
}

/// Where all light is left to photons, those that are told bring the pixel's radiance; in their lines the
/// same as in the line that sums them up. Mutants rejected: photons that do not count, another wavelength
/// set's path, one of two maps not told.
#[test]
fn photons_bring_the_radiance() {
    let sppm = "<integrator type=\"sppm\"><boolean name=\"sample_lights\" value=\"false\"/>\
                <integer name=\"photons\" value=\"16384\"/><float name=\"radius\" value=\"0.3\"/></integrator>";
    let mut many = false;
    for address in ["10,10,0,0", "3,10,1,1", "10,6,0,0", "14,11,3,1"] {
        let said = replayed(sppm, address);
        let photons = |line: &&str| line.trim_start().starts_with("photons that count within");
        let gathered: Vec<&str> = said.lines().filter(photons).collect();
        assert_eq!(gathered.len(), 1, "{said}");
        let delivered = said.lines().find(|line| line.starts_with("radiance "));
        let delivered = numbers(delivered.expect("radiance"));
        let together = after(gathered[0], " together ");
        let scale = delivered[0].abs();
        assert!(scale > 0.0, "{said}");
        assert_close(sum([together].into_iter()), &delivered, scale);
        let told = said.lines().filter(|line| line.contains("nm, value"));
        let told = told.map(|line| after(line, "brings"));
        let rest = said.lines().filter(|line| line.contains("the rest, "));
        let rest = rest.map(|line| after(line, " together "));
        many |= rest.clone().count() == 1;
        assert_close(sum(told.chain(rest)), &delivered, scale);
        // A light is asked for; what is asked for photons' sake is not told beside them.
        assert!(said.matches("toward (").count() <= 1, "{said}");
        assert!(said.contains("wavelengths ["), "{said}");
    }
    assert!(many, "a summary is tested, too");
}

#[test]
fn all_that_gather_say_what() {
    for (integrator, more) in [
        ("photonmap", ""),
        ("vcm", ""),
        (
            "photonmap",
            "<integer name=\"global_nearest\" value=\"20\"/>",
        ),
    ] {
        let radius = match integrator {
            "vcm" => "<float name=\"radius\" value=\"0.3\"/>",
            _ => "<float name=\"global_radius\" value=\"0.5\"/>",
        };
        let integrator = format!(
            "<integrator type=\"{integrator}\"><integer name=\"photons\" value=\"4096\"/>{radius}{more}</integrator>"
        );
        let said = replayed(&integrator, "10,10,0,0");
        assert!(said.contains("photons that count within"), "{said}");
        assert!(said.contains("m away at ("), "{said}");
    }
}

/// The density of the mixture is that of its parts, and carries the walk on. Mutant: the model's own.
#[test]
fn guided_tells_the_mixture() {
    let guided = "<integrator type=\"guided\"><float name=\"training\" value=\"4\"/>\
                  <float name=\"spatial_threshold\" value=\"10\"/></integrator>";
    let (mut weighed, mut chosen) = (0, [0, 0]);
    for pixel in 0..12 {
        let said = replayed(guided, &format!("{},{pixel},0,1", 4 + pixel));
        let lines: Vec<&str> = said.lines().collect();
        for (place, line) in lines.iter().enumerate() {
            if !line.contains("the guide's density") {
                continue;
            }
            let parts = after(line, "the model's density");
            let [own, share, other] = [parts[0], parts[4], parts[5]];
            let density = after(lines[place - 1], "density [")[0];
            let expected = own * share + other * (1.0 - share);
            assert!((density / expected - 1.0).abs() < 1e-5, "{said}");
            if lines[place - 1].contains("toward") {
                weighed += 1;
                continue;
            }
            chosen[usize::from(line.contains("chosen by the guide"))] += 1;
            // The same before the direction was chosen.
            let before = lines[..place].iter().rev();
            let before = before.skip(1).find(|line| line.contains("f/p ["));
            let before = after(before.expect("a walk"), "f/p [")[0];
            let factor = after(lines[place - 1], "value [")[0];
            let then = after(lines[place + 1], "then f/p [")[0];
            let expected = before * factor / density;
            assert!((then / expected - 1.0).abs() < 1e-5, "{said}");
        }
        assert!(!said.contains("known to the estimator only"), "{said}");
    }
    assert!(weighed > 0 && chosen.iter().all(|count| *count > 0));
}

/// A path of a path tracer lands where it began: every splat belongs to a path that was told, that which
/// the chain has left. Mutants rejected: another uniform sample, splats out of order.
#[test]
fn chains_are_told_path_by_path() {
    for integrator in ["pssmlt", "mmlt"] {
        let pssmlt = integrator == "pssmlt";
        let integrator = format!(
            "<integrator type=\"{integrator}\"><integer name=\"max_depth\" value=\"6\"/></integrator>"
        );
        let said = replayed(&integrator, "0,0,0,0");
        let number = |line: &str| numbers(line);
        let share = said.lines().find(|line| line.contains("sample's share: "));
        let share = number(share.expect("it hosts something"));
        let [contributions, chains, steps] = [share[0], share[1], share[2]].map(|n| n as usize);
        assert!(contributions > 0 && chains == 1 && steps > 100, "{share:?}");
        // Where the chain stands, and the path told last.
        let (mut stands, mut told) = (Vec::new(), Vec::new());
        let (mut uniform, mut proposed, mut splats) = (0, 0, 0);
        let mut leaves = Vec::new();
        for line in said.lines().skip_while(|line| !line.contains("share: ")) {
            if line.contains("camera ray at raster") {
                told = numbers(line)[..2].to_vec();
                leaves = told.clone();
            } else if line.contains("-- uniform sample") {
                uniform += 1;
            } else if line.contains("-- step 0") {
                stands = told.clone();
            } else if line.contains(": taken;") {
                leaves = core::mem::replace(&mut stands, told.clone());
            } else if line.contains("-- the chain ends") {
                leaves = stands.clone();
            } else if line.starts_with("splat") {
                splats += 1;
                // A walk of a light may be seen anywhere.
                if pssmlt {
                    assert_eq!(numbers(line)[..2], leaves, "{line}");
                }
            }
            proposed += usize::from(line.contains("proposes"));
        }
        assert_eq!((uniform, proposed), (contributions, steps));
        assert!(splats > contributions, "{splats}");
        assert_eq!(said.contains("technique s = "), !pssmlt);
        // Other samples say where to look.
        let said = replayed(&integrator, "0,0,0,1");
        assert!(said.contains("belong to other samples"), "{said}");
        assert!(!said.contains("splat"), "{said}");
    }
}

/// What a replay would ignore is refused.
#[test]
fn a_replay_measures_keeps_and_splits_nothing() {
    let workshop = Workshop::new();
    workshop.write("a.xml", small_scene(""));
    for more in [
        &["--stats", "a.json"][..],
        &["--resume"],
        &["--strategies", "folder"],
        &["--part", "1/2"],
        &["--error", "0.1"],
        &["--time", "1"],
        &["-o", "a.exr"],
    ] {
        let arguments = [&["render", "a.xml", "--replay", "0,0,0,0"][..], more].concat();
        let ran = workshop.run(&arguments).refused();
        let words = "cannot be used with";
        assert!(ran.stderr.contains(words), "{more:?}: {}", ran.stderr);
    }
    assert_eq!(workshop.files(), ["a.xml"]);
}
