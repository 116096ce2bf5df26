//! `subsurface` is a medium in a boundary, and gives back what it says it does.

use crate::workshop::Workshop;

/// A ball in a corner of light.
fn scene(ball: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">
    <default name=\"albedo\" value=\"0.5\"/>
    <integrator type=\"volpath\"><integer name=\"max_depth\" value=\"-1\"/></integrator>
    <sensor type=\"perspective\">
        <float name=\"fov\" value=\"3\"/>
        <transform name=\"to_world\"><lookat origin=\"0, -4, 0\" target=\"0, 0, 0\" up=\"0, 0, 1\"/></transform>
        <film type=\"hdrfilm\">
            <integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/><rfilter type=\"box\"/>
            <string name=\"pixel_format\" value=\"luminance\"/>
        </film>
        <sampler type=\"independent\"><integer name=\"sample_count\" value=\"16\"/></sampler>
    </sensor>
    <emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"/></emitter>
    <shape type=\"sphere\">{ball}</shape>
</scene>"
    )
}

const COEFFICIENTS: &str = "<spectrum name=\"sigma_a\" value=\"400:2, 700:1\"/>
    <spectrum name=\"sigma_s\" value=\"400:9, 700:7\"/><phase type=\"hg\"><float name=\"g\" value=\"0.3\"/></phase>";

#[test]
fn a_medium_in_the_same_boundary_is_the_same() {
    let index = "<float name=\"int_ior\" value=\"1.3\"/>";
    for (boundary, own, bsdf, further) in [
        (
            "diffuse",
            "",
            "difftrans",
            "<float name=\"transmittance\" value=\"1\"/>",
        ),
        ("smooth", index, "dielectric", index),
        ("rough", index, "roughdielectric", index),
    ] {
        let workshop = Workshop::new();
        let walk = format!(
            "<subsurface type=\"randomwalk\"><string name=\"boundary\" value=\"{boundary}\"/>{own}{COEFFICIENTS}</subsurface>"
        );
        let explicit = format!(
            "<bsdf type=\"{bsdf}\">{further}</bsdf><medium name=\"interior\" type=\"homogeneous\">{COEFFICIENTS}</medium>"
        );
        for (name, ball) in [("a", walk), ("b", explicit)] {
            workshop.write("s.xml", scene(&ball));
            let output = format!("{name}.exr");
            workshop
                .run(&["render", "s.xml", "-q", "-o", &output])
                .fine();
        }
        let [a, b] = ["a.exr", "b.exr"].map(|name| workshop.image(name).image);
        assert!(a == b, "{boundary}");
    }
}

/// The share of an even sky that a thick ball gives back is its `albedo`; to 1.5 %, as the ball is round and the fit is one,
/// and four standard errors (α = 10⁻⁴). The mutant that takes it for the albedo of single scattering is off by half.
#[test]
fn a_thick_piece_shows_its_albedo() {
    let workshop = Workshop::new();
    let ball = "<subsurface type=\"randomwalk\"><spectrum name=\"albedo\" value=\"$albedo\"/>
        <spectrum name=\"mean_free_path\" value=\"0.004\"/></subsurface>";
    workshop.write("s.xml", scene(ball));
    for albedo in [0.2, 0.5, 0.8, 1.0] {
        let define = format!("albedo={albedo}");
        let further = ["-D", &define, "--spp", "256", "-o", "a.exr", "-q"];
        workshop
            .run(&[&["render", "s.xml"], &further[..]].concat())
            .fine();
        let image = workshop.image("a.exr");
        let plane = image.image.channel("Y").expect("luminance");
        let errors = image.standard_error("Y").expect("errors");
        let count = plane.len() as f64;
        let mean = plane.iter().map(|&x| f64::from(x)).sum::<f64>() / count;
        let variance: f64 = errors.iter().map(|&s| f64::from(s).powi(2)).sum();
        let error = variance.sqrt() / count;
        assert!(error < 0.01, "too noisy: {error}");
        let off = (mean - albedo).abs();
        assert!(
            off < 4.0 * error + 0.015 * albedo,
            "{albedo}: {mean} ± {error}"
        );
    }
}
