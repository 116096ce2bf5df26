//! What a scene may say of a material, and what it is told when it says something else.

use crate::scene::{Sample, Scene};
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// The messages for a material that must be refused, with their help.
fn refused(text: &str) -> String {
    let (material, said) = Scene::default().read(text);
    assert!(
        material.is_none() || !said.is_empty(),
        "{text} was accepted"
    );
    said.iter()
        .map(|d| format!("{}; {}", d.message, d.help.as_deref().unwrap_or_default()))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn mistakes_are_named() {
    for (text, expected) in [
        ("difuse", "did you mean `diffuse`"),
        ("polarizer", "not built yet"),
        (
            "principled eta=f:1.5 specular=f:0.5",
            "either `eta` or `specular`",
        ),
        ("principled specular=f:12.5", "below 12.5"),
        ("diffuse reflectence=u:0.5", "did you mean `reflectance`"),
        ("diffuse ( diffuse )", "does not take"),
        ("mask opacity=f:0.5", "needs 1 nested BSDF, not 0"),
        ("mask ( diffuse ) ( diffuse )", "needs 1 nested BSDF, not 2"),
        ("twosided", "needs 1 nested BSDF, not 0"),
        (
            "twosided ( diffuse ) ( diffuse ) ( diffuse )",
            "needs 2 nested BSDFs, not 3",
        ),
        ("twosided ( dielectric )", "let no light through"),
        (
            "twosided ( mask ( diffuse ) )",
            "put `mask` around `twosided`",
        ),
        ("blendbsdf ( diffuse ) ( diffuse )", "weight"),
        (
            "mixturebsdf weights=s:0.5,0.5 ( diffuse )",
            "2 numbers for 1 nested",
        ),
        (
            "mixturebsdf weights=s:0.5,0.6 ( diffuse ) ( diffuse )",
            "add up to 1.1",
        ),
        ("mixturebsdf weights=s:-1 ( diffuse )", "`-1` in `weights`"),
        ("mixturebsdf ( diffuse )", "needs the parameter `weights`"),
        (
            "blendbsdf weight=f:0.5 ( diffuse )",
            "needs 2 nested BSDFs, not 1",
        ),
        (
            "blendbsdf weight=f:0.5 ( blendbsdf weight=f:0.5 ( blendbsdf weight=f:0.5 ( diffuse ) \
             ( diffuse ) ) ( diffuse ) ) ( blendbsdf weight=f:0.5 ( diffuse ) ( diffuse ) )",
            "mixes 5 models",
        ),
        ("dielectric int_ior=s:watr", "did you mean `water`"),
        ("dielectric int_ior=f:-1", "cannot be -1"),
        ("dielectric ext_ior=f:0", "cannot be 0"),
        ("dielectric int_ior=b:true", "cannot be a boolean"),
        (
            "dielectric int_ior=s:cauchy:1.5",
            "cannot have 1 coefficients",
        ),
        ("dielectric int_ior=s:cauchy:1.5,x", "`x` is not a number"),
        ("dielectric int_ior=s:cauchy:-1.5,0", "is -1.5"),
        (
            "dielectric int_ior=s:abbe:1.5,50",
            "not a dispersion formula",
        ),
        ("dielectric int_ior=t:400:1.5,700:0", "cannot be 0"),
        (
            "plastic int_ior=t:400:1.5,700:1.4",
            "one index for all wavelengths",
        ),
        (
            "thindielectric int_ior=s:cauchy:1.5,0.01",
            "no refractive index is known",
        ),
        ("roughdielectric int_ior=s:air", "must differ"),
        (
            "roughdielectric distribution=s:phong",
            "`phong` of Mitsuba 0.6 is not built",
        ),
        ("roughdielectric alpha=f:-0.1", "cannot be -0.1"),
        ("roughplastic alpha=f:-0.1", "cannot be -0.1"),
        (
            "roughconductor alpha=f:0.1 alpha_u=f:0.2",
            "either `alpha` or",
        ),
        ("roughconductor alpha_u=f:0.2", "alpha_v"),
        ("conductor material=s:Unobtainium", "--data DIR"),
        (
            "conductor material=s:Unobtainium eta=f:1",
            "either `material` or",
        ),
    ] {
        let said = refused(text);
        assert!(said.contains(expected), "{text}: {said}");
    }
}

#[test]
fn several_mistakes_are_reported_at_once() {
    let said = refused(
        "blendbsdf weight=f:0.5 ( dielectric int_ior=s:watr ) ( roughplastic alpha=f:-1 colour=u:1 )",
    );
    for expected in ["watr", "cannot be -1", "colour"] {
        assert!(said.contains(expected), "{said}");
    }
}

/// The mirror's energies at normal incidence.
fn mirror(text: &str, scene: Scene) -> Vec4 {
    let sample = Sample::in_scene(text, scene);
    let found = sample
        .at(Vec3::Z)
        .sample(Vec3::Z, 0.0, Vec2::ZERO, TransportMode::Radiance);
    found.expect("a reflection").value
}

#[test]
fn a_conductor_without_data_is_looked_up_in_files() {
    let scene = || {
        Scene::default()
            .with_file("Xx.eta.spd", "# made up\n400 1.5\n700 1.5\n")
            .with_file("Xx.k.spd", "400 2\n700 2\n")
    };
    let expected = ((1.5f32 - 1.0).powi(2) + 4.0) / ((1.5f32 + 1.0).powi(2) + 4.0);
    let found = mirror("conductor material=s:Xx", scene());
    assert!((found - expected).abs().max_element() < 1e-6);
    let own = scene()
        .with_file("Cu.eta.spd", "400 1.5\n700 1.5\n")
        .with_file("Cu.k.spd", "400 2\n700 2\n");
    assert_eq!(mirror("conductor material=s:Cu", own), found);
    assert_ne!(mirror("conductor material=s:Cu", Scene::default()), found);
    let broken = Scene::default()
        .with_file("Xx.eta.spd", "400 1.5\n700\n")
        .read("conductor material=s:Xx")
        .1;
    assert!(broken[0].message.contains("line 2"), "{broken:?}");
}

#[test]
fn conductors_given_as_colours_are_metals() {
    for plugin in ["conductor", "roughconductor"] {
        let said = |text: &str| {
            let (material, notes) = Scene::default().read(&format!("{plugin} {text}"));
            assert!(material.is_some(), "{notes:?}");
            notes
        };
        let copper = "eta=c:0.200438,0.924033,1.10221 k=c:3.91295,2.45285,2.14219";
        let notes = said(copper);
        assert!(notes[0].message.contains("`Cu`"), "{notes:?}");
        assert_eq!(said("eta=c:0.21,0.97,1.16 k=c:3.91295,2.45285,2.14219"), []);
        assert_eq!(said("eta=f:0 k=c:1,1,1"), []);
    }
    let copper = "conductor eta=c:0.200438,0.924033,1.10221 k=c:3.91295,2.45285,2.14219";
    let named = mirror("conductor material=s:Cu", Scene::default());
    assert_eq!(mirror(copper, Scene::default()), named);
    let grey = mirror("conductor eta=c:1.5,1.5,1.5 k=f:2", Scene::default());
    assert!(
        (grey - mirror("conductor eta=f:1.5 k=f:2", Scene::default()))
            .abs()
            .max_element()
            < 1e-6
    );
    let (material, errors) = Scene::default().read("conductor eta=c:0,0,1");
    assert!(material.is_some(), "{errors:?}");
}

#[test]
fn an_index_that_ends_goes_on_with_a_note() {
    // The test's wavelengths lie on both sides of the tables' ends. Tables given by themselves: `rules` in `textures`.
    let short = "500 1.5\n510 1.5\n";
    let files = Scene::default()
        .with_file("Xx.eta.spd", "wavelength n\n510 1.5\n500 1.5\n")
        .with_file("Xx.k.spd", "500 2\n510 2\n");
    let flat = mirror("conductor eta=f:1.5 k=f:2", Scene::default());
    let held = mirror("conductor material=s:Xx", files);
    assert!((held - flat).abs().max_element() < 1e-6, "{held}");
    let mut files = Scene::default()
        .with_file("Xx.eta.spd", &format!("wavelength n\n{short}"))
        .with_file("Xx.k.spd", short);
    let said = files.read("conductor material=s:Xx").1;
    for part in ["line 1 of `Xx.eta.spd`", "from 500 to 510 nm"] {
        assert!(said.iter().any(|d| d.message.contains(part)), "{said:?}");
    }
    let notes = Scene::default()
        .read("dielectric int_ior=t:500:1.5,510:1.5")
        .1;
    assert!(notes[0].message.contains("from 500 to 510 nm"), "{notes:?}");
}

#[test]
fn the_perfect_mirror_is_the_default_conductor() {
    for text in ["conductor", "conductor material=s:none"] {
        assert_eq!(mirror(text, Scene::default()), Vec4::ONE);
    }
}

#[test]
fn indices_disperse_as_their_formula_says() {
    let reflectance = |eta: f64| ((eta - 1.0) / (eta + 1.0)).powi(2);
    // BK7 with the manufacturer's Sellmeier coefficients has n = 1.5168 at 587.56 nm; here at the
    // test's own wavelengths, by the formula in f64.
    let (b, c) = (
        [1.039_612_12, 0.231_792_344, 1.010_469_45],
        [0.006_000_698_67, 0.020_017_914_4, 103.560_653],
    );
    let text = format!(
        "dielectric ext_ior=f:1 int_ior=s:sellmeier:{},{},{},{},{},{}",
        b[0], b[1], b[2], c[0], c[1], c[2]
    );
    let found = mirror(&text, Scene::default());
    for (lane, lambda) in [0.45f64, 0.5, 0.55, 0.6].into_iter().enumerate() {
        let l2 = lambda * lambda;
        let n2: f64 = 1.0 + (0..3).map(|i| b[i] * l2 / (l2 - c[i])).sum::<f64>();
        assert!((f64::from(found[lane]) / reflectance(n2.sqrt()) - 1.0).abs() < 1e-4);
    }
    let cauchy = mirror(
        "dielectric ext_ior=f:1 int_ior=s:Cauchy:1.5,0.01,0.001",
        Scene::default(),
    );
    let n = 1.5 + 0.01 / 0.2025 + 0.001 / (0.2025 * 0.2025);
    assert!((f64::from(cauchy.x) / reflectance(n) - 1.0).abs() < 1e-4);
    // A table: linear between its samples, constant beyond them.
    let table = mirror(
        "dielectric ext_ior=f:1 int_ior=t:475:1.6,525:1.5",
        Scene::default(),
    );
    for (lane, n) in [1.6, 1.55, 1.5, 1.5].into_iter().enumerate() {
        assert!(
            (f64::from(table[lane]) / reflectance(n) - 1.0).abs() < 1e-4,
            "{table}"
        );
    }
}

#[test]
fn a_nested_index_counts_as_none_beyond_its_table() {
    // 450 and 600 nm lie outside.
    let text = "ext_ior=f:1 int_ior=n:475:1.6,575:1.5";
    for plugin in ["dielectric", "roughdielectric alpha=f:0.3"] {
        let sample = Sample::new(&format!("{plugin} {text}"));
        for wo in crate::directions::known() {
            for turn in 0..4 {
                let bsdf = sample.rotated(wo, turn);
                for u_lobe in [0.0, 0.02, 0.5, 0.99] {
                    if let Some(s) =
                        bsdf.sample(wo, u_lobe, Vec2::splat(0.3), TransportMode::Radiance)
                    {
                        assert!(s.value.is_finite() && s.chance.lanes().is_finite());
                    }
                }
            }
        }
    }
    let sample = Sample::new(&format!("dielectric {text}"));
    let s = sample
        .at(Vec3::Z)
        .sample(Vec3::Z, 0.0, Vec2::ZERO, TransportMode::Radiance)
        .expect("nothing is absorbed");
    assert_eq!((s.wi, s.eta), (Vec3::NEG_Z, 1.0));
}

#[test]
fn refraction_by_a_dispersive_interface_keeps_one_wavelength() {
    let sample = Sample::new("dielectric int_ior=s:cauchy:1.5,0.01");
    let wo = crate::directions::at(40.0, 0.0);
    let s = sample
        .at(wo)
        .sample(wo, 0.99, Vec2::ZERO, TransportMode::Radiance)
        .expect("refraction");
    assert!(s.wi.z < 0.0);
    assert!(s.chance.lanes().x > 0.9 && s.chance.lanes().truncate_x() == Vec3::ZERO);
    let reflected = sample
        .at(wo)
        .sample(wo, 0.0, Vec2::ZERO, TransportMode::Radiance)
        .expect("reflection");
    assert!(reflected.chance.lanes().min_element() > 0.0);
}

trait Rest {
    fn truncate_x(self) -> Vec3;
}

impl Rest for Vec4 {
    fn truncate_x(self) -> Vec3 {
        Vec3::new(self.y, self.z, self.w)
    }
}

#[test]
fn the_least_roughness_acts_for_smaller_ones() {
    let [zero, least] =
        ["0", "0.0001"].map(|a| Sample::new(&format!("roughconductor alpha=f:{a}")));
    let wo = crate::directions::at(30.0, 0.0);
    let wi = Vec3::new(-wo.x, wo.y, wo.z);
    let eval = |s: &Sample| s.at(wo).eval(wo, wi, TransportMode::Radiance);
    assert_eq!(eval(&zero), eval(&least));
}
