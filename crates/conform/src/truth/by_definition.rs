//! What irradiance is, for the tests of its closed forms: ∫ cos θ cos θ'/d² dA over the light.

/// Points of the plane z = 0 (m).
pub(crate) const POINTS: [[f64; 2]; 3] = [[0.1, 0.0], [0.7, -0.4], [-1.6, 1.9]];

/// The middles of n × n cells of the unit square.
pub(crate) fn grid(n: usize) -> impl Iterator<Item = (f64, f64)> {
    let at = move |i: usize| (i as f64 + 0.5) / n as f64;
    (0..n * n).map(move |i| (at(i % n), at(i / n)))
}

/// Of the plane z = 0 at (x, y) under parts of a light of radiance 1: their points, normals and areas.
pub(crate) fn irradiance(
    lights: impl Iterator<Item = ([f64; 3], [f64; 3], f64)>,
    [x, y]: [f64; 2],
) -> f64 {
    lights
        .map(|(p, n, area)| {
            let d = [p[0] - x, p[1] - y, p[2]];
            let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let facing = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
            facing.max(0.0) * d[2].max(0.0) / (square * square) * area
        })
        .sum()
}
