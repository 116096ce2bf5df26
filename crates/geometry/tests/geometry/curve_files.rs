//! Files of curves to test with.

/// Two curves of control points.
pub(crate) fn good_curves() -> String {
    let first =
        "-0.5 -0.3 -0.4 0.1\n-0.2 0.3 0 0.15\n0.3 0 0.2 0.05\n0.4 -0.4 0.1 0.1\n0.1 -0.5 -0.3 0.12";
    let second = "0.5 0.4 -0.5 0.05\n0.4 0.5 0 0.05\n0.4 0.5 0.3 0.2\n0.5 0.6 0.8 0.02";
    format!("{first}\n\n{second}")
}

/// The file of curves that is sound for a plugin.
pub(crate) fn curve_file(plugin: &str) -> &'static str {
    match plugin {
        "beziercurve" => "bezier",
        "hair" => "strands",
        _ => "good",
    }
}

/// A file of B-splines as one of Bézier curves: (1 4 1 0, 0 4 2 0, 0 2 4 0, 0 1 4 1) / 6 of every four control points.
pub(crate) fn as_bezier(splines: &str) -> String {
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let mut text = String::new();
    for spline in splines.split("\n\n") {
        let points = spline
            .lines()
            .map(|line| line.split(' ').map(number).collect());
        let points: Vec<Vec<f64>> = points.collect();
        let mut pieces = vec![];
        for (index, four) in points.windows(4).enumerate() {
            let rows = [
                [1.0, 4.0, 1.0, 0.0],
                [0.0, 4.0, 2.0, 0.0],
                [0.0, 2.0, 4.0, 0.0],
                [0.0, 1.0, 4.0, 1.0],
            ];
            for row in &rows[usize::from(index > 0)..] {
                let mixed = |axis: usize| (0..4).map(|k| row[k] * four[k][axis]).sum::<f64>() / 6.0;
                let [x, y, z, r] = [0, 1, 2, 3].map(mixed);
                pieces.push(format!("{x} {y} {z} {r}"));
            }
        }
        text += &format!("{}\n\n", pieces.join("\n"));
    }
    text
}
