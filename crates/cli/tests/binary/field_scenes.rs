//! Scenes as people have them: constructs of Mitsuba 0.6 and of lenient readers, rendered.

use crate::workshop::Workshop;

/// A sensor that looks at the plane z = 0 along −z under a uniform sky of radiance 1, followed by
/// `body`. A diffuse rectangle there shows its reflectance.
fn furnace(version: &str, sampler: &str, film: &str, integrator: &str, body: &str) -> String {
    format!(
        "<scene version=\"{version}\">
{integrator}
<sensor type=\"perspective\">
<transform name=\"toWorld\"><lookAt origin=\"0 0 3\" target=\"0 0 0\" up=\"0 1 0\"/></transform>
<film type=\"{film}\"><integer name=\"width\" value=\"4\"/><integer name=\"height\" value=\"4\"/>
<rfilter type=\"box\"/></film>{sampler}</sensor>
<emitter type=\"constant\"/>
{body}
</scene>
"
    )
}

fn plain(version: &str, body: &str) -> String {
    let text = furnace(version, "", "hdrfilm", "", body);
    match version {
        "3.0.0" => text.replace("toWorld", "to_world"),
        _ => text,
    }
}

fn on_rectangle(bsdf: &str) -> String {
    format!(
        "<shape type=\"rectangle\"><transform name=\"toWorld\"><scale value=\"9\"/></transform>{bsdf}</shape>"
    )
}

/// The mean colour of a scene's picture, and what was said. `t.pfm` is a picture of one grey pixel.
#[track_caller]
fn rendered(scene: &str) -> ([f32; 3], String) {
    let workshop = Workshop::new();
    workshop.write("scene.xml", scene);
    let mut grey = b"PF\n1 1\n-1.0\n".to_vec();
    (0..3).for_each(|_| grey.extend(0.5f32.to_le_bytes()));
    workshop.write("t.pfm", grey);
    let ran = workshop
        .run(&["render", "scene.xml", "-o", "x.exr", "--spp", "64"])
        .fine();
    let image = workshop.image("x.exr").image;
    let mean = |name| {
        let plane = image.channel(name).expect("a channel");
        plane.iter().sum::<f32>() / plane.len() as f32
    };
    (["R", "G", "B"].map(mean), ran.stderr)
}

#[track_caller]
fn near(found: [f32; 3], expected: [f32; 3], tolerance: f32) {
    let far = |(a, b): (&f32, &f32)| (a - b).abs() > tolerance;
    assert!(
        !found.iter().zip(&expected).any(far),
        "{found:?} is not {expected:?}"
    );
}

#[track_caller]
fn refused(scene: &str, words: &str) {
    let workshop = Workshop::new();
    workshop.write("scene.xml", scene);
    let ran = workshop
        .run(&["render", "scene.xml", "-o", "x.exr"])
        .refused();
    assert!(ran.stderr.contains(words), "{}", ran.stderr);
}

#[test]
fn reflectances_above_one_are_held_to_one_with_a_note() {
    let held = "cannot be above 1";
    for value in [
        "<float name=\"reflectance\" value=\"2\"/>",
        "<spectrum name=\"reflectance\" value=\"2\"/>",
        "<rgb name=\"reflectance\" value=\"1.5\"/>",
        "<spectrum name=\"reflectance\" value=\"300:1.5, 500:3, 900:1.5\"/>",
    ] {
        let bsdf = format!("<bsdf type=\"diffuse\">{value}</bsdf>");
        let (colour, said) = rendered(&plain("0.6.0", &on_rectangle(&bsdf)));
        near(colour, [1.0; 3], 0.02);
        assert!(said.contains(held), "{said}");
    }
    // Only what is above: a table keeps the rest.
    let bsdf =
        "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"300:0.5, 900:0.5\"/></bsdf>";
    let (colour, said) = rendered(&plain("0.6.0", &on_rectangle(bsdf)));
    near(colour, [0.5; 3], 0.02);
    assert!(!said.contains(held), "{said}");
}

#[test]
fn the_outside_of_a_conductor_counts() {
    let mirror = |eta: &str, outside: &str| {
        let outside = match outside {
            "" => String::new(),
            name if name.starts_with(char::is_alphabetic) => {
                format!("<string name=\"extEta\" value=\"{name}\"/>")
            }
            number => format!("<float name=\"extEta\" value=\"{number}\"/>"),
        };
        let bsdf = format!(
            "<bsdf type=\"conductor\"><spectrum name=\"eta\" value=\"{eta}\"/>\
             <spectrum name=\"k\" value=\"0\"/>{outside}</bsdf>"
        );
        rendered(&plain("0.6.0", &on_rectangle(&bsdf))).0
    };
    // ((η − 1)/(η + 1))² at (nearly) normal incidence.
    near(mirror("3", ""), [0.25; 3], 0.02);
    near(mirror("3", "1.5"), [1.0 / 9.0; 3], 0.01);
    near(mirror("1.333", "water"), [0.0; 3], 1e-3);
}

/// Weights below one absorb the rest.
#[test]
fn mixtures_of_several_materials_are_weighted_sums() {
    let grey = |reflectance: f32| {
        format!(
            "<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"{reflectance}\"/></bsdf>"
        )
    };
    let mixture = |weights: &str, parts: &[f32]| {
        let parts: String = parts.iter().map(|&part| grey(part)).collect();
        let bsdf = format!(
            "<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"{weights}\"/>{parts}</bsdf>"
        );
        rendered(&plain("0.6.0", &on_rectangle(&bsdf))).0
    };
    near(mixture("0.7, 0.3", &[1.0, 0.2]), [0.76; 3], 0.02);
    near(mixture("0.2 0.1 0.3", &[1.0, 0.5, 0.5]), [0.4; 3], 0.02);
}

#[test]
fn films_samplers_and_parameters_of_old_scenes_are_read() {
    let body = on_rectangle("<bsdf type=\"Diffuse\"/>");
    let samplers = [
        "<sampler type=\"ldsampler\"><integer name=\"dimension\" value=\"4\"/></sampler>",
        "<sampler type=\"halton\"><integer name=\"scramble\" value=\"0\"/></sampler>",
        "<sampler type=\"hammersley\"/>",
        "<sampler type=\"independent\"/>",
    ];
    let films = ["ldrfilm", "mfilm", "tiledhdrfilm", "hdrfilm"];
    let integrators = [
        "<integrator type=\"path\"><boolean name=\"strictNormals\" value=\"true\"/></integrator>",
        "<integrator type=\"direct\"><integer name=\"shadingSamples\" value=\"1\"/></integrator>",
        "<integrator type=\"volpath_simple\"/>",
        "<integrator type=\"bdpt\"><boolean name=\"lightImage\" value=\"false\"/></integrator>",
    ];
    let words = [
        "`strict_normals` has no effect",
        "",
        "the integrator `volpath_simple` is not built: `volpath` stands in",
        "",
    ];
    for i in 0..4 {
        let scene = furnace("0.5.0", samplers[i], films[i], integrators[i], &body);
        let (colour, said) = rendered(&scene);
        near(colour, [0.5; 3], 0.02);
        assert!(said.contains(words[i]), "{said}");
        let film = format!("the film `{}` is read as an `hdrfilm`", films[i]);
        assert_eq!(said.contains(&film), films[i] != "hdrfilm", "{said}");
    }
    // Every file is held to the parameters of its version.
    let scene =
        furnace("3.0.0", "", "hdrfilm", integrators[1], &body).replace("toWorld", "to_world");
    refused(&scene, "`direct` has no parameter `shadingSamples`");
    let slip = integrators[1].replace("shadingSamples", "luminaireSamples");
    let scene = furnace("0.5.0", "", "hdrfilm", &slip, &body);
    refused(&scene, "`direct` has no parameter `luminaire_samples`");
    let strict = integrators[0].replace("strictNormals", "strict_normals");
    let scene = furnace("3.0.0", "", "hdrfilm", &strict, &body).replace("toWorld", "to_world");
    assert!(
        rendered(&scene)
            .1
            .contains("`strict_normals` has no effect")
    );
}

#[test]
fn definitions_may_stand_at_the_top() {
    let lamp = "<emitter type=\"area\" id=\"lamp\"><rgb name=\"radiance\" value=\"3\"/></emitter>";
    let top = format!(
        "{lamp}<sampler type=\"independent\" id=\"s\"/><film type=\"hdrfilm\" id=\"f\"/>
        <rfilter type=\"box\" id=\"r\"/><texture type=\"checkerboard\" id=\"t\"/>"
    );
    let used =
        format!("{top}{}", on_rectangle("<ref id=\"lamp\"/>")).replace("toWorld", "to_world");
    let (colour, said) = rendered(&plain("3.0.0", &used));
    near(colour, [3.0; 3], 0.02);
    assert!(!said.contains("note: "), "{said}");
    let (colour, said) = rendered(&plain("3.0.0", &top));
    near(colour, [1.0; 3], 0.02);
    assert!(
        said.contains("no shape refers to this `area` light"),
        "{said}"
    );
    // Nobody can refer to one without an `id`.
    let nameless = lamp.replace(" id=\"lamp\"", "");
    let (colour, said) = rendered(&plain("3.0.0", &nameless));
    near(colour, [1.0; 3], 0.02);
    assert!(
        said.contains("no shape refers to this `area` light"),
        "{said}"
    );
    // Mistakes in them are found although nobody uses them.
    let film = "<film type=\"hdrfilm\" id=\"f\"><integer name=\"widht\" value=\"3\"/></film>";
    refused(&plain("3.0.0", film), "`hdrfilm` has no parameter `widht`");
}

#[test]
fn filters_and_wraps_of_old_bitmaps_are_read() {
    let scene = |extra: &str| {
        let bitmap = format!(
            "<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">
             <string name=\"filename\" value=\"t.pfm\"/>{extra}</texture></bsdf>"
        );
        plain("0.6.0", &on_rectangle(&bitmap))
    };
    for (extra, words) in [
        (
            "<string name=\"filterType\" value=\"ewa\"/>",
            "`ewa` is read as `bilinear`",
        ),
        (
            "<string name=\"filterType\" value=\"trilinear\"/>",
            "`trilinear` is read as",
        ),
        (
            "<string name=\"wrapModeU\" value=\"clamp\"/><string name=\"wrapModeV\" value=\"clamp\"/>",
            "",
        ),
        (
            "<float name=\"gamma\" value=\"2.2\"/>",
            "a `gamma` of 2.2 is read as sRGB",
        ),
        (
            "<float name=\"gamma\" value=\"1\"/><boolean name=\"cache\" value=\"true\"/>",
            "",
        ),
    ] {
        let (colour, said) = rendered(&scene(extra));
        near(colour, [0.5; 3], 0.03);
        assert!(said.contains(words), "{said}");
    }
    let two =
        "<string name=\"wrapModeU\" value=\"clamp\"/><string name=\"wrapModeV\" value=\"repeat\"/>";
    refused(&scene(two), "one mode for both directions is built");
}

#[test]
fn a_negative_radius_is_refused() {
    let sphere = "<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>";
    refused(
        &plain("3.0.0", sphere),
        "parameter `radius` of `sphere` cannot be -1",
    );
}

#[test]
fn a_note_made_at_many_places_is_shown_once() {
    let metal = "<bsdf type=\"conductor\"><spectrum name=\"eta\" value=\"500:0.9, 600:0.3\"/>\
                 <spectrum name=\"k\" value=\"500:1.8, 600:3\"/></bsdf>\n";
    let scene = plain("0.6.0", &metal.repeat(20));
    let (_, said) = rendered(&scene);
    assert_eq!(
        said.matches("this index is given from 500 to 600 nm")
            .count(),
        1,
        "{said}"
    );
    assert!(said.contains("(and at 39 more places)"), "{said}");
}

/// exp(−½ · 2) through a cube of σt ½ and two metres, whose surface is not seen.
#[test]
fn media_of_mitsuba_06_are_read() {
    let grid = |value: &str| format!("<volume type=\"constvolume\" name=\"{value}\">");
    let body = format!(
        "<integrator type=\"volpath\"/><shape type=\"cube\"><medium type=\"heterogeneous\" name=\"interior\">
         {}<float name=\"value\" value=\"1\"/></volume>
         {}<spectrum name=\"value\" value=\"0\"/></volume>
         <string name=\"method\" value=\"woodcock\"/><float name=\"scale\" value=\".5\"/></medium></shape>",
        grid("density"),
        grid("albedo"),
    );
    let narrow = "<sensor type=\"perspective\"><float name=\"fov\" value=\"4\"/>";
    let scene = plain("0.6.0", &body).replace("<sensor type=\"perspective\">", narrow);
    near(rendered(&scene).0, [0.3679; 3], 0.01);
}

#[test]
fn a_filter_in_the_sensor_is_the_films() {
    let scene = plain("3.0.0", "");
    let filter = "<rfilter type=\"box\"/>";
    let sensor = "<sensor type=\"perspective\">";
    let moved = scene
        .replace(filter, "")
        .replace(sensor, &format!("{sensor}{filter}"));
    let (colour, said) = rendered(&moved);
    near(colour, [1.0; 3], 0.001);
    assert!(said.contains("this one is taken as the film's"), "{said}");
    let both = scene.replace(sensor, &format!("{sensor}{filter}"));
    refused(&both, "the film has a filter of its own");
}

#[test]
fn one_mistake_in_a_material_is_told_alone() {
    let mixture = "<bsdf type=\"mixture\"><float name=\"diffuse\" value=\".8\"/>
        <float name=\"refractive\" value=\".7\"/><float name=\"int_ior\" value=\"1.5\"/></bsdf>";
    let workshop = Workshop::new();
    let scene = plain("3.0.0", &on_rectangle(mixture)).replace("toWorld", "to_world");
    workshop.write("scene.xml", scene);
    let ran = workshop
        .run(&["render", "scene.xml", "-o", "x.exr"])
        .refused();
    assert_eq!(ran.stderr.matches("error: ").count(), 1, "{}", ran.stderr);
}
