//! `etalon info`: what is in a file.

use crate::workshop::{Workshop, cornell_box};
use etalon_film::{ExactFilm, FilmSettings, Filter, RenderFacts};
use etalon_images::Image;

#[test]
fn of_an_image() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "8", "--seed", "3", "-q"]);
    let said = workshop.run(&["info", "a.exr"]).fine().stdout;
    for words in [
        "24 × 20 pixels\n",
        "  standard_error.G     mean 0.",
        "integrator   path\n",
        "samples      8 per pixel, 8 replicates, independent, seed 3\n",
        "replicates   blocks of one sequence: standard errors are upper estimates\n",
        "film         rgb, box\n",
        " % mean relative standard error\n",
    ] {
        assert!(said.contains(words), "{words:?} in {said}");
    }
}

#[test]
fn numbers_that_were_refused_are_traced_to_their_sample() {
    let workshop = Workshop::new();
    let settings = FilmSettings::new(4, 4, Filter::default());
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    let mut image = Image::new(4, 4);
    for name in ["R", "G", "B"] {
        let mut plane = vec![1.0; 16];
        plane[6] = if name == "G" { f32::NAN } else { 1.0 };
        image.push(name, plane);
    }
    film.add_replicate(&image, 1).expect("it fits");
    let developed = film.develop(RenderFacts::default());
    developed
        .write_exr(&workshop.path("a.exr"))
        .expect("written");
    let said = workshop.run(&["info", "a.exr"]).fine().stdout;
    assert!(
        said.contains("not finite   1 contributions, such as\n"),
        "{said}"
    );
    assert!(
        said.contains("  pixel (2, 1), replicate 0: G is not a number\n"),
        "{said}"
    );
}

#[test]
fn of_a_scene() {
    let workshop = Workshop::new();
    let said = workshop.run(&["info", &cornell_box()]).fine().stdout;
    for words in [
        "film         256 × 256 pixels\n",
        "integrator   path\n",
        "samples      64 per pixel, independent\n",
        "shapes       8 (36 triangles)\n",
        "materials    3\n",
        "lights       1\n",
    ] {
        assert!(said.contains(words), "{words:?} in {said}");
    }
}

/// All that `-D`, `--sensor` and their like may ask for, to people and to programs.
#[test]
fn of_a_scenes_parameters_and_sensors() {
    let workshop = Workshop::new();
    workshop.write(
        "scene.xml",
        "<scene version=\"3.0.0\"><default name=\"width\" value=\"40\"/><default name=\"grey\" value=\"0.5\"/>\
         <sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"$width\"/>\
         <integer name=\"height\" value=\"30\"/><integer name=\"crop_width\" value=\"10\"/></film></sensor>\
         <sensor type=\"thinlens\" id=\"close\"><float name=\"aperture_radius\" value=\"0.1\"/></sensor>\
         <shape type=\"sphere\"><bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"$grey\"/></bsdf></shape></scene>",
    );
    let said = workshop.run(&["info", "scene.xml"]).fine().stdout;
    for words in [
        "parameters   $width = 40\n             $grey = 0.5\n",
        "sensors      0 perspective, rendered\n             1 thinlens `close`\n",
        "film         40 × 30 pixels, of which 10 × 30 from (0, 0)\n",
        "files        1, 0.0 MiB\n",
        "memory       geometry 0.0 MiB, pictures 0.0 MiB, film 0.1 MiB\n",
    ] {
        assert!(said.contains(words), "{words:?} in {said}");
    }
    let said = workshop.run(&["info", "scene.xml", "--json"]).fine().stdout;
    let json: serde_json::Value = serde_json::from_str(&said).expect("valid JSON");
    assert_eq!(json["parameters"]["grey"], "0.5");
    assert_eq!(json["sensors"][1]["id"], "close");
    assert_eq!(json["film"]["crop_size"], serde_json::json!([10, 30]));
    workshop.render("a.exr", &["--spp", "8", "-q"]);
    let said = workshop.run(&["info", "a.exr", "--json"]).fine().stdout;
    let json: serde_json::Value = serde_json::from_str(&said).expect("valid JSON");
    assert_eq!(
        (&json["width"], &json["metadata"]["spp"]),
        (&24.into(), &8.into())
    );
    assert_eq!(json["channels"][0]["not_finite"], 0);
    workshop.run(&["info", "--json", "scene.txt"]).refused();
}

#[test]
fn of_what_is_neither() {
    let workshop = Workshop::new();
    workshop.write("a.txt", "");
    workshop.write("a.exr", "not an image");
    workshop.write("a.xml", "not a scene");
    for name in ["a.txt", "a.exr", "a.xml", "none.exr", "none.xml"] {
        let ran = workshop.run(&["info", name]).refused();
        assert!(ran.stderr.contains(name), "{}", ran.stderr);
        assert_eq!(ran.stdout, "");
    }
}
