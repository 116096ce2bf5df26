//! Where a render goes: without `-o`, beside a picture, and not over what is somebody else's.

use crate::workshop::{Workshop, small_scene};

fn workshop() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("scene.xml", small_scene("<integrator type=\"path\"/>"));
    workshop
}

/// Refused before anything is rendered, in one sentence with these words; nothing is left or changed.
#[track_caller]
fn refused(workshop: &Workshop, arguments: &[&str], words: &[&str]) {
    let before = workshop.files();
    let all = [&["render"][..], arguments, &["--spp", "1000000"]].concat();
    let said = workshop.run(&all).refused().stderr;
    for word in words {
        assert!(said.contains(word), "{arguments:?}: {said}");
    }
    assert_eq!(workshop.files(), before);
}

#[test]
fn without_a_name_it_is_the_scene_s() {
    let workshop = workshop();
    std::fs::create_dir(workshop.path("deep")).expect("created");
    std::fs::copy(workshop.path("scene.xml"), workshop.path("deep/room.xml")).expect("copied");
    let said = workshop.run(&["render", "scene.xml"]).fine().stderr;
    assert!(said.contains("the image goes to scene.exr"), "{said}");
    assert!(said.contains("\nscene.exr: "), "{said}");
    // Into the current folder, wherever the scene is.
    workshop.run(&["render", "deep/room.xml", "-q"]).fine();
    assert_eq!(
        workshop.files(),
        ["deep", "room.exr", "scene.exr", "scene.xml"]
    );
    // Once more: it is ours.
    let before = workshop.read("scene.exr");
    workshop.run(&["render", "scene.xml", "--seed", "3"]).fine();
    assert!(workshop.read("scene.exr") != before);
    // Parts do not take each other's place.
    for part in ["1/2", "2/2"] {
        workshop
            .run(&["render", "scene.xml", "--part", part])
            .fine();
    }
    let parts = ["scene-part-1-of-2.exr", "scene-part-2-of-2.exr"];
    let merge = ["merge", parts[1], parts[0], "-o", "whole.exr"];
    workshop.run(&merge).fine();
    workshop.run(&["render", "scene.xml"]).fine();
    assert!(workshop.read("whole.exr") == workshop.read("scene.exr"));
}

/// The picture is beside the image that has the statistics.
#[test]
fn a_png_lies_beside_an_exr() {
    let workshop = workshop();
    let said = workshop
        .run(&["render", "scene.xml", "-o", "a.PNG"])
        .fine()
        .stderr;
    assert!(said.contains("all else are in a.exr"), "{said}");
    assert_eq!(workshop.files(), ["a.PNG", "a.exr", "scene.xml"]);
    assert!(workshop.image("a.exr").standard_error("G").is_some());
    workshop.run(&["convert", "a.exr", "b.png"]).fine();
    assert!(workshop.read("a.PNG") == workshop.read("b.png"));
}

#[test]
fn what_is_somebody_else_s_is_left_alone() {
    let workshop = workshop();
    workshop.write("scene.exr", "mine");
    let words = ["scene.exr exists, and Etalon has not rendered it", "`-o`"];
    refused(&workshop, &["scene.xml"], &words);
    refused(&workshop, &["scene.xml", "-o", "scene.png"], &words);
    assert_eq!(workshop.read("scene.exr"), b"mine");
    // Whoever names it means it.
    workshop
        .run(&["render", "scene.xml", "-o", "scene.exr"])
        .fine();
    // But not what the scene is read from.
    let textured = small_scene("").replace(
        "<shape type=\"sphere\">",
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\">\
         <string name=\"filename\" value=\"scene.exr\"/></texture></bsdf>",
    );
    workshop.write("scene.xml", textured);
    let before = workshop.read("scene.exr");
    for arguments in [
        &["scene.xml"][..],
        &["scene.xml", "-o", "scene.exr"],
        &["scene.xml", "-o", "./scene.exr"],
        &["scene.xml", "-o", "scene.png"],
    ] {
        refused(&workshop, arguments, &["scene.exr: it is ", "read from"]);
    }
    refused(
        &workshop,
        &["scene.xml", "-o", "a.exr", "--stats", "scene.xml"],
        &["read from"],
    );
    assert!(workshop.read("scene.exr") == before);
}

#[test]
fn names_that_cannot_be() {
    let workshop = workshop();
    std::fs::create_dir(workshop.path("folder")).expect("created");
    let output = |name: &str, words: &[&str]| refused(&workshop, &["scene.xml", "-o", name], words);
    output(
        "a.jpg",
        &["cannot write a.jpg", ".exr, .png", "JPEG is only read"],
    );
    output(
        "a.tif",
        &["cannot write a.tif", ".exr, .png", ".hdr or .pfm"],
    );
    output("a", &["such as a.exr"]);
    output("-", &["standard output"]);
    output("folder", &["it is a folder", "folder/scene.exr"]);
    output("folder/", &["it is a folder", "folder/scene.exr"]);
    output("none/", &["it is a folder", "none/scene.exr"]);
    output("none/a.png", &["no such folder"]);
    output("none/a.exr", &["no such folder"]);
    refused(
        &workshop,
        &["scene.xml", "-o", "a.exr", "--stats", "a.exr"],
        &["a.exr would be written twice"],
    );
    refused(
        &workshop,
        &["scene.xml", "-o", "a.hdr", "--part", "1/2"],
        &["only .exr can hold a part"],
    );
    refused(&workshop, &["none.xml"], &["none.xml"]);
}
