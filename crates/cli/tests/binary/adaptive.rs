//! `render --adaptive`: samples dealt by a pilot's error.

use crate::workshop::{Workshop, cornell_box, small_scene};
use etalon_film::RenderedImage;
use serde_json::Value;

fn stats(workshop: &Workshop, name: &str) -> Value {
    serde_json::from_slice(&workshop.read(name)).expect("JSON")
}

/// How many samples each pixel has.
fn samples(image: &RenderedImage) -> &[f32] {
    image.image.channel("samples").expect("they are told")
}

#[test]
fn less_noise_of_the_same_picture_with_as_many_samples() {
    let workshop = Workshop::new();
    let size = ["-D", "resx=40", "-D", "resy=40", "--spp", "256"];
    let render = |name: &str, further: &[&str]| {
        let stats_file = format!("{name}.json");
        let further = [&size[..], &["--stats", &stats_file], further].concat();
        workshop.render(name, &further);
        stats(&workshop, &stats_file)
    };
    let even = render("even.exr", &["--seed", "1"]);
    let dealt = render("dealt.exr", &["--adaptive"]);
    let number = |stats: &Value, name: &str| stats[name].as_f64().expect("a number");
    for (error, most) in [
        ("relative_standard_error", 0.8),
        ("mean_relative_standard_error", 1.0),
    ] {
        let ratio = number(&dealt, error) / number(&even, error);
        assert!(ratio < most, "{error}: {ratio}");
    }
    let ratio = number(&dealt, "samples") / number(&even, "samples");
    assert!((0.97..=1.0).contains(&ratio), "{ratio} of the samples");
    assert_eq!(number(&dealt, "pilot_spp"), 64.0);
    assert_eq!(number(&dealt["adaptive"], "pilot"), 64.0);
    let image = workshop.image("dealt.exr");
    let total: f64 = samples(&image).iter().map(|&n| f64::from(n)).sum();
    assert_eq!(total, number(&dealt, "samples"));
    assert!(samples(&image).iter().any(|&n| n < 128.0));
    assert!(samples(&image).iter().any(|&n| n > 512.0));
    // Equal images are called different in one of a thousand cases. The mutant that divides all
    // pixels by the samples of an even render makes the bright ones several times as bright.
    let arguments = ["compare", "even.exr", "dealt.exr", "--bound", "0.05"];
    let said = workshop.run(&arguments);
    assert_ne!(said.code, Some(1), "{}", said.stdout);
}

#[test]
fn the_same_bits_however_it_is_rendered() {
    let workshop = Workshop::new();
    for integrator in ["path", "guided"] {
        let further = [
            "--adaptive",
            "--pilot",
            "32",
            "--spp",
            "24",
            "--replicates",
            "3",
            "--integrator",
            integrator,
        ];
        workshop.render("whole.exr", &further);
        for threads in ["1", "2", "5"] {
            workshop.render("b.exr", &[&further[..], &["--threads", threads]].concat());
            assert!(
                workshop.read("b.exr") == workshop.read("whole.exr"),
                "{threads}"
            );
        }
        for part in ["1/2", "2/2"] {
            let name = format!("p{}.exr", &part[..1]);
            workshop.render(&name, &[&further[..], &["--part", part]].concat());
        }
        workshop
            .run(&["merge", "p2.exr", "p1.exr", "-o", "m.exr"])
            .fine();
        assert!(workshop.read("m.exr") == workshop.read("whole.exr"));
    }
    // Parts that dealt differently do not belong together.
    let other = ["--spp", "24", "--replicates", "3", "--part", "1/2"];
    workshop.render(
        "p1.exr",
        &[&other[..], &["--integrator", "guided"]].concat(),
    );
    let said = workshop
        .run(&["merge", "p2.exr", "p1.exr", "-o", "n.exr"])
        .refused();
    assert!(
        said.stderr.contains("distribution of samples"),
        "{}",
        said.stderr
    );
}

#[test]
fn targets_fix_what_one_could_have_asked_for() {
    let workshop = Workshop::new();
    for target in [["--error", "0.1"], ["--time", "0.5"]] {
        let further = [&target[..], &["--adaptive", "--stats", "s.json"]].concat();
        let ran = workshop.render("a.exr", &further);
        assert!(
            ran.stderr.contains("note: a pilot of "),
            "{target:?}: {}",
            ran.stderr
        );
        let stats = stats(&workshop, "s.json");
        let number = |name: &str| stats[name].as_f64().expect("a number");
        if target[0] == "--error" {
            assert!(number("relative_standard_error") <= 0.1, "{stats}");
            assert_eq!(number("pilot_spp"), 128.0);
        }
        let spp = number("spp").to_string();
        let replicates = number("replicates").to_string();
        let pilot = stats["adaptive"]["pilot"].to_string();
        let by_number = [
            "--adaptive",
            "--spp",
            &spp,
            "--replicates",
            &replicates,
            "--pilot",
            &pilot,
        ];
        workshop.render("b.exr", &by_number);
        assert_eq!(workshop.image("a.exr").image, workshop.image("b.exr").image);
    }
}

#[test]
fn the_samples_of_a_pixel_can_be_replayed() {
    let workshop = Workshop::new();
    let options = ["--adaptive", "--spp", "64", "--replicates", "4"];
    workshop.render("a.exr", &options);
    let image = workshop.image("a.exr");
    let most = samples(&image).iter().copied().fold(0.0, f32::max);
    let pixel = samples(&image).iter().position(|&n| n == most);
    let pixel = pixel.expect("there is a largest");
    // The last of its samples, which an even render does not have.
    let last = most as u32 / 4 - 1;
    assert!(last >= 16);
    let scene = cornell_box();
    let replay = |last: u32| {
        let address = format!("{},{},1,{last}", pixel % 24, pixel / 24);
        let size = ["-D", "resx=24", "-D", "resy=20", "--replay", &address];
        workshop.run(&[&["render", &scene][..], &options, &size].concat())
    };
    let said = replay(last).fine().stdout;
    assert!(
        said.contains(&format!("sample {last} of {}", last + 1)),
        "{said}"
    );
    assert!(said.contains("radiance ("), "{said}");
    replay(last + 1).refused();
}

#[test]
fn what_cannot_be_dealt_is_refused() {
    let workshop = Workshop::new();
    workshop.write(
        "s.xml",
        small_scene(
            "<integrator type=\"path\"><integer name=\"max_depth\" value=\"4\"/></integrator>",
        ),
    );
    for (integrator, reason) in [
        ("ptracer", "its light paths may end in any pixel"),
        ("bdpt", "its light paths may end in any pixel"),
        ("mmlt", "its light paths may end in any pixel"),
        ("sppm", "passes over all pixels again and again"),
    ] {
        let arguments = [
            "render",
            "s.xml",
            "-o",
            "a.exr",
            "--adaptive",
            "--integrator",
            integrator,
        ];
        let said = workshop.run(&arguments).refused().stderr;
        assert!(said.contains(reason), "{integrator}: {said}");
        assert!(said.contains(integrator), "{said}");
    }
    let said = workshop
        .run(&["render", "s.xml", "-o", "a.exr", "--pilot", "32"])
        .refused()
        .stderr;
    assert!(said.contains("--adaptive"), "{said}");
    assert_eq!(workshop.files(), ["s.xml"]);
}
