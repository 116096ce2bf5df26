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
