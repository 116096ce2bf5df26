//! The colour spaces of ꟻLIP, and its distance (HPG 2020, sections 4.1 and 4.1.2).
//!
//! Linear sRGB → XYZ (D65) → the linearised opponent space of Zhang & Wandell's S-CIELAB,
//! Y = 116 y − 16, C_x = 500 (x − y), C_z = 200 (y − z) of the white-relative xyz, or CIE L*a*b*
//! (1976) with Hunt's adjustment: a* and b* times L*/100.

/// Linear sRGB to XYZ, rows; from the primaries' chromaticities of BT.709 and D65 (x = 0.3127,
/// y = 0.3290) in exact fractions.
const XYZ: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];

/// White: linear sRGB (1, 1, 1).
fn white() -> [f64; 3] {
    XYZ.map(|row| row.iter().sum())
}

/// XYZ relative to white.
fn relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    let white = white();
    std::array::from_fn(|i| dot(XYZ[i], rgb) / white[i])
}

/// The sRGB transfer function (IEC 61966-2-1), decoding.
pub(super) fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// To the opponent space.
pub(super) fn linear_to_ycxcz(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// From the opponent space.
pub(super) fn ycxcz_to_linear([lightness, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (lightness + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    let white = white();
    let xyz: [f64; 3] = std::array::from_fn(|i| relative[i] * white[i]);
    INVERSE.map(|row| dot(row, xyz))
}

/// The inverse of [`XYZ`], by its adjugate.
const INVERSE: [[f64; 3]; 3] = inverse(XYZ);

const fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let [[a, b, c], [d, e, f], [g, h, i]] = m;
    let determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
    let s = 1.0 / determinant;
    [
        [
            s * (e * i - f * h),
            s * (c * h - b * i),
            s * (b * f - c * e),
        ],
        [
            s * (f * g - d * i),
            s * (a * i - c * g),
            s * (c * d - a * f),
        ],
        [
            s * (d * h - e * g),
            s * (b * g - a * h),
            s * (a * e - b * d),
        ],
    ]
}

/// Linear sRGB to Hunt-adjusted L*a*b*.
pub(super) fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let [x, y, z] = relative_xyz(rgb).map(|t| {
        if t > DELTA * DELTA * DELTA {
            libm::cbrt(t)
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    });
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// The HyAB distance (Abasi, Tehran & Fairchild 2020): city block in lightness, Euclidean in a*b*.
pub(super) fn hyab(p: [f64; 3], q: [f64; 3]) -> f64 {
    let (a, b) = (p[1] - q[1], p[2] - q[2]);
    (p[0] - q[0]).abs() + (a * a + b * b).sqrt()
}

/// The greatest distance of two displayable colours: of pure green and blue.
pub(super) fn largest_distance() -> f64 {
    hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0]))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
