//! Replicates as blocks of one sequence: which pictures have them, and that the picture is the one that
//! all samples in one replicate give.

use crate::workshop::{Workshop, small_scene};
use etalon_film::RenderedImage;
use etalon_sampling::ReplicateKind;

/// A scene in which samples are `sobol`'s, under a lamp.
fn scene(integrator: &str) -> String {
    let lamp = "<shape type=\"sphere\"><point name=\"center\" value=\"1, 2, 0\"/>
        <float name=\"radius\" value=\"0.2\"/><emitter type=\"area\"/></shape>";
    small_scene(integrator)
        .replace("\"independent\"", "\"sobol\"")
        .replace("<emitter type=\"constant\"/>", lamp)
}

/// Renders `scene.xml` of the workshop.
fn render(workshop: &Workshop, further: &[&str]) -> RenderedImage {
    let fixed = ["render", "scene.xml", "-o", "a.exr", "-q"];
    workshop.run(&[&fixed, further].concat()).fine();
    workshop.image("a.exr")
}

/// The greatest difference of two pictures' green, relative to the first's mean.
fn apart(a: &RenderedImage, b: &RenderedImage) -> f64 {
    let green = |of: &RenderedImage| of.image.channel("G").expect("green").to_vec();
    let (a, b) = (green(a), green(b));
    let mean = a.iter().map(|x| f64::from(*x)).sum::<f64>() / a.len() as f64;
    let differences = a.iter().zip(&b).map(|(a, b)| f64::from((a - b).abs()));
    differences.fold(0.0, f64::max) / mean
}

#[test]
fn blocks_make_up_the_picture_of_one_replicate() {
    let workshop = Workshop::new();
    workshop.write("scene.xml", scene(""));
    for integrator in ["path", "bdpt", "ptracer"] {
        // Seven blocks are no power of two.
        for (replicates, spp) in [("8", "32"), ("7", "28")] {
            let common = [
                "--integrator",
                integrator,
                "--spp",
                spp,
                "--replicates",
                replicates,
            ];
            let blocks = render(&workshop, &common);
            // Mutant: independent replicates.
            let independent = [&common[..], &["--independent-replicates"]].concat();
            let independent = render(&workshop, &independent);
            assert!(apart(&blocks, &independent) > 1e-2, "{integrator}");
            if replicates == "8" {
                let one = [
                    "--integrator",
                    integrator,
                    "--spp",
                    spp,
                    "--replicates",
                    "1",
                ];
                let one = render(&workshop, &one);
                assert!(apart(&blocks, &one) < 1e-5, "{integrator}");
            }
        }
    }
}

#[test]
fn each_integrator_says_which_replicates_it_has() {
    let workshop = Workshop::new();
    let said = |of: &RenderedImage| of.metadata.as_ref().expect("ours").replicate_kind;
    let kind = |integrator: &str, further: &[&str]| {
        workshop.write("scene.xml", scene(integrator));
        said(&render(
            &workshop,
            &[&["--spp", "4", "--replicates", "2"], further].concat(),
        ))
    };
    for name in [
        "path",
        "naive",
        "direct",
        "depth",
        "ao",
        "distribution",
        "bdpt",
        "ptracer",
    ] {
        assert_eq!(
            kind("", &["--integrator", name]),
            ReplicateKind::Blocks,
            "{name}"
        );
        let independent = ["--integrator", name, "--independent-replicates"];
        assert_eq!(kind("", &independent), ReplicateKind::Independent, "{name}");
    }
    for name in ["sppm", "vcm", "pssmlt", "photonmap", "guided"] {
        assert_eq!(
            kind("", &["--integrator", name]),
            ReplicateKind::Independent,
            "{name}"
        );
    }
    let mmlt = "<integrator type=\"mmlt\"><integer name=\"max_depth\" value=\"4\"/></integrator>";
    assert_eq!(kind(mmlt, &[]), ReplicateKind::Independent);
    let path = "<integrator type=\"path\" name=\"p\"/>";
    for nest in ["moment", "aov"] {
        let aovs = match nest {
            "aov" => "<string name=\"aovs\" value=\"d:depth\"/>",
            _ => "",
        };
        let nested = format!("<integrator type=\"{nest}\">{aovs}{path}</integrator>");
        assert_eq!(kind(&nested, &[]), ReplicateKind::Blocks, "{nest}");
    }
}

/// Where every pixel gets its own number of samples, each has its own blocks.
#[test]
fn adaptive_pictures_have_blocks() {
    let workshop = Workshop::new();
    workshop.write("scene.xml", scene(""));
    let common = ["--spp", "32", "--adaptive", "--pilot", "32"];
    let blocks = render(&workshop, &common);
    let facts = blocks.metadata.as_ref().expect("ours");
    let dealt = facts.adaptive.as_ref().expect("dealt");
    assert!(dealt.least < dealt.most && facts.replicate_kind == ReplicateKind::Blocks);
    // The pilot's replicates are independent in both.
    let independent = render(
        &workshop,
        &[&common[..], &["--independent-replicates"]].concat(),
    );
    let facts = independent.metadata.as_ref().expect("ours");
    assert_eq!(facts.adaptive.as_ref(), Some(dealt));
    assert!(apart(&blocks, &independent) > 1e-2);
}
