//! `etalon convert`: pictures to look at, and other formats.

use crate::workshop::Workshop;
use etalon_images::{Chromaticities, Frame, Image, exr, raster_file};

fn one_image() -> Workshop {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "8", "-q"]);
    workshop
}

/// The linear values of a picture, three per pixel.
fn values(workshop: &Workshop, name: &str) -> Vec<f32> {
    let picture = raster_file::read(&workshop.path(name)).expect("readable");
    assert_eq!(
        (picture.width(), picture.height(), picture.channels()),
        (24, 20, 3)
    );
    picture.to_linear().to_vec()
}

#[test]
fn to_every_format() {
    let workshop = one_image();
    for name in ["a.png", "a.hdr", "a.pfm"] {
        workshop.run(&["convert", "a.exr", name]).fine();
    }
    assert!(workshop.read("a.png").starts_with(b"\x89PNG"));
    let image = workshop.image("a.exr").image;
    let planes = image.colour().expect("colours").planes;
    let [png, hdr, pfm] = ["a.png", "a.hdr", "a.pfm"].map(|name| values(&workshop, name));
    for pixel in 0..24 * 20 {
        let largest = planes.iter().map(|p| p[pixel]).fold(0.0, f32::max);
        for (channel, plane) in planes.iter().enumerate() {
            let (index, value) = (3 * pixel + channel, plane[pixel]);
            assert_eq!(pfm[index], value);
            // RGBE has no negative numbers, and shares one exponent between the channels: steps of
            // 1/128 of the largest at worst.
            assert!((hdr[index] - value.max(0.0)).abs() <= largest * 0.501 / 128.0);
            // 8 bits of sRGB, of what is at most white: at most half a step of 1/255 at the
            // curve's greatest slope, 1.055 · 2.4.
            assert!((png[index] - value.clamp(0.0, 1.0)).abs() <= 0.5 / 255.0 * 2.54);
        }
    }
    workshop.run(&["convert", "a.pfm", "again.png"]).fine();
    assert_eq!(workshop.read("a.png"), workshop.read("again.png"));
}

#[test]
fn exposure_counts_in_stops() {
    let workshop = one_image();
    workshop.run(&["convert", "a.exr", "a.pfm"]).fine();
    let exposure = ["convert", "a.exr", "b.pfm", "--exposure", "-2"];
    workshop.run(&exposure).fine();
    let [a, b] = ["a.pfm", "b.pfm"].map(|name| values(&workshop, name));
    assert!(a.iter().zip(&b).all(|(a, b)| a / 4.0 == *b));
    workshop
        .run(&["convert", "a.exr", "c.png", "--exposure", "nan"])
        .refused();
}

#[test]
fn other_channels_can_be_shown() {
    let workshop = one_image();
    let noise = [
        "convert",
        "a.exr",
        "noise.pfm",
        "--channels",
        "standard_error",
    ];
    workshop.run(&noise).fine();
    let image = workshop.image("a.exr");
    let green: Vec<f32> = values(&workshop, "noise.pfm")
        .iter()
        .skip(1)
        .step_by(3)
        .copied()
        .collect();
    assert_eq!(image.standard_error("G").expect("G"), green);
    let ran = workshop
        .run(&["convert", "a.exr", "x.png", "--channels", "normals"])
        .refused();
    assert!(ran.stderr.contains("`normals.R`") && ran.stderr.contains("standard_error.R"));
}

#[test]
fn what_cannot_be_read_or_written_is_refused() {
    let workshop = one_image();
    for (input, output) in [
        ("a.exr", "a.gif"),
        ("a.exr", "nowhere/a.png"),
        ("none.exr", "a.png"),
        ("a.txt", "a.png"),
        ("a.exr", "a"),
    ] {
        let ran = workshop.run(&["convert", input, output]).refused();
        assert!(ran.stderr.starts_with("error: "), "{}", ran.stderr);
    }
    assert_eq!(workshop.files(), ["a.exr"]);
}

/// An EXR file of one pixel with these channels.
fn write_pixel(workshop: &Workshop, name: &str, channels: &[(&str, f32)]) {
    let one = Image::new(1, 1);
    let with = |image: Image, (name, value): &(&str, f32)| image.with(*name, vec![*value]);
    let image = channels.iter().fold(one, with);
    exr::write(&workshop.path(name), &image, Frame::whole(&image), "").expect("written");
}

fn colour_of(workshop: &Workshop, name: &str) -> Vec<f32> {
    raster_file::read(&workshop.path(name))
        .expect("readable")
        .to_linear()
}

#[test]
fn black_is_black_at_every_exposure() {
    let workshop = Workshop::new();
    write_pixel(&workshop, "in.exr", &[("R", 0.0), ("G", 1.0), ("B", 1e-30)]);
    // 2¹²⁸ is beyond 32-bit floats; 2¹⁰⁰ · 10⁻³⁰ = 1.2676506, whatever stands beside it.
    for (exposure, right) in [
        ("128", [0.0, f32::INFINITY, 3.402_823_7e8]),
        ("100", [0.0, 2_f32.powi(100), 1.267_650_6]),
        ("1e30", [0.0, f32::INFINITY, f32::INFINITY]),
        ("-1e30", [0.0; 3]),
    ] {
        let arguments = ["convert", "in.exr", "out.pfm", "--exposure", exposure];
        let said = workshop.run(&arguments).fine().stderr;
        for (found, right) in colour_of(&workshop, "out.pfm").into_iter().zip(right) {
            assert!(
                found == right || (found / right - 1.0).abs() < 1e-6,
                "{exposure}: {found}"
            );
        }
        let infinite = right.contains(&f32::INFINITY);
        assert_eq!(said.contains("became infinite"), infinite, "{said}");
        let arguments = ["convert", "in.exr", "out.png", "--exposure", exposure];
        workshop.run(&arguments).fine();
        let white = f32::from(right[1] > 1.0);
        assert_eq!(colour_of(&workshop, "out.png")[..2], [0.0, white]);
    }
}

#[test]
fn the_input_is_blamed_for_what_it_lacks() {
    let workshop = Workshop::new();
    write_pixel(&workshop, "in.exr", &[("Z", 1.0), ("uv.U", 0.5)]);
    for output in ["out.png", "out.hdr", "out.pfm"] {
        let said = workshop
            .run(&["convert", "in.exr", output])
            .refused()
            .stderr;
        assert!(
            said.contains("in.exr") && said.contains("Z, uv.U"),
            "{said}"
        );
        assert!(!said.contains(output), "{said}");
    }
    // What the message names can be shown.
    let arguments = ["convert", "in.exr", "out.pfm", "--channels", "Z"];
    workshop.run(&arguments).fine();
    assert_eq!(colour_of(&workshop, "out.pfm"), [1.0; 3]);
}

#[test]
fn layers_and_xyz_are_understood() {
    let workshop = Workshop::new();
    let layers = [
        ("Normal.X", 0.1),
        ("Normal.Y", 0.2),
        ("Normal.Z", 0.3),
        ("beauty.R", 0.5),
        ("beauty.G", 0.6),
        ("beauty.B", 0.7),
    ];
    write_pixel(&workshop, "in.exr", &layers);
    let said = workshop
        .run(&["convert", "in.exr", "out.pfm"])
        .fine()
        .stderr;
    assert_eq!(colour_of(&workshop, "out.pfm"), [0.5, 0.6, 0.7]);
    assert_eq!(said, "");
    let shown = ["convert", "in.exr", "out.pfm", "--channels", "Normal"];
    workshop.run(&shown).fine();
    assert_eq!(colour_of(&workshop, "out.pfm"), [0.1, 0.2, 0.3]);

    write_pixel(
        &workshop,
        "in.exr",
        &[("X", 0.3), ("Y", 0.4), ("Z", 0.5), ("A", 0.5)],
    );
    workshop.run(&["convert", "in.exr", "out.pfm"]).fine();
    let found = colour_of(&workshop, "out.pfm");
    let right = [0.108_016, 0.480_398, 0.463_733];
    assert!(
        found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-4),
        "{found:?}"
    );
}

#[test]
fn other_formats_are_read_and_written_through_links() {
    let workshop = Workshop::new();
    workshop.write("a.ppm", "P3 1 1 255 255 188 0");
    workshop.run(&["convert", "a.ppm", "a.pfm"]).fine();
    let found = colour_of(&workshop, "a.pfm");
    assert!(
        (found[1] - 0.502_886).abs() < 1e-5 && found[0] == 1.0,
        "{found:?}"
    );
    let said = workshop.run(&["info", "a.ppm"]).fine().stdout;
    assert_eq!(said, "1 × 1 pixels\nPNM, 3 channels of 8 bits\n");
    #[cfg(unix)]
    {
        std::fs::create_dir(workshop.path("disk")).expect("a folder");
        let link = workshop.path("b.pfm");
        std::os::unix::fs::symlink("disk/b.pfm", &link).expect("linked");
        workshop.run(&["convert", "a.ppm", "b.pfm"]).fine();
        assert_eq!(workshop.read("disk/b.pfm"), workshop.read("a.pfm"));
        assert!(std::fs::read_link(&link).is_ok());
        // Before anything is rendered, what the link leads to must be a place for a file.
        std::os::unix::fs::symlink("gone/c.exr", workshop.path("c.exr")).expect("linked");
        let scene = crate::workshop::cornell_box();
        let said = workshop
            .run(&["render", &scene, "-o", "c.exr"])
            .refused()
            .stderr;
        assert!(said.contains("no such folder"), "{said}");
    }
}

#[test]
fn primaries_are_converted_and_shown() {
    let workshop = Workshop::new();
    let acescg = Chromaticities {
        red: [0.713, 0.293],
        green: [0.165, 0.830],
        blue: [0.128, 0.044],
        white: [0.32168, 0.33767],
    };
    let image = Image::new(1, 1)
        .with("R", vec![0.5])
        .with("G", vec![0.25])
        .with("B", vec![0.75])
        .with_chromaticities(Some(acescg));
    let path = workshop.path("in.exr");
    exr::write(&path, &image, Frame::whole(&image), "").expect("written");
    workshop.run(&["convert", "in.exr", "out.pfm"]).fine();
    let found = colour_of(&workshop, "out.pfm");
    let right = [0.654_535, 0.211_391, 0.755_506];
    assert!(
        found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-5),
        "{found:?}"
    );
    let said = workshop.run(&["info", "in.exr"]).fine().stdout;
    assert!(
        said.contains("chromaticities red (0.713, 0.293), green"),
        "{said}"
    );
}

/// Numbers of a PNG are in proportion to what was rendered: 255 (x − A)/(B − A), rounded.
#[test]
fn a_range_is_shown_in_proportion() {
    let workshop = one_image();
    for (range, [a, b]) in [("0..2", [0.0, 2.0]), ("0.8..-0.3", [0.8, -0.3])] {
        workshop
            .run(&[
                "convert",
                "a.exr",
                "r.png",
                "--channels",
                "G",
                "--range",
                range,
            ])
            .fine();
        let picture = raster_file::read(&workshop.path("r.png"))
            .expect("readable")
            .to_floats()
            .to_vec();
        let image = workshop.image("a.exr").image;
        for (pixel, x) in image.channel("G").expect("G").iter().enumerate() {
            let expected = ((x - a) / (b - a)).clamp(0.0, 1.0);
            assert!((picture[3 * pixel] - expected).abs() < 0.51 / 255.0, "{x}");
        }
        workshop
            .run(&["convert", "a.exr", "r.pfm", "--range", range])
            .fine();
    }
    for wrong in ["1..1", "0", "a..b", "0..inf"] {
        workshop
            .run(&["convert", "a.exr", "x.png", "--range", wrong])
            .refused();
    }
    let both = [
        "convert",
        "a.exr",
        "x.png",
        "--range",
        "0..1",
        "--exposure",
        "1",
    ];
    workshop.run(&both).refused();
}
