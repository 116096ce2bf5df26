//! Patterns computed from a place: `noise`, `fbm`, `turbulence`, `marble`, `wood`, `voronoi`, `bricks`, `cubes`, `dots`, `gradient`.
//!
//! A pattern is a share s(p) in [0, 1] of `color1`, the rest being `color0`; either may be any texture. With n the
//! noise of [`etalon_math::noise`], r = `roughness`, N = `octaves`:
//!
//! ```text
//! noise       ½ + ½ n(p)
//! fbm         ½ + ½ Σ rⁱ n(2ⁱ p) / Σ rⁱ          (K. Perlin 1985; Ebert et al. 2003, Texturing and Modeling)
//! turbulence  Σ rⁱ |n(2ⁱ p)| / Σ rⁱ
//! marble      ½ + ½ sin(2π (x + `distortion` · Σ rⁱ |n(2ⁱ p)|))
//! wood        the fraction of |(x, y)| + `distortion` · n(p): rings around the z axis
//! voronoi     the distance to the nearest of random points, one in each cell (S. Worley 1996)
//! bricks      0 in joints of the width `joint`, 1 in bricks of 1 × ½, each row shifted by ½
//! cubes       0 and 1 in alternate cubes of side 1, 0 in that from (0, 0, 0) to (1, 1, 1)
//! dots        1 in disks of radius 0.35, in two fifths of the squares of side 1, each moved at random within its own
//! gradient    the fraction of x
//! ```
//!
//! p is the place in the world or, with `space` = `uv`, (u, v, 0), taken back by `to_world`, which places the pattern.

use crate::place;
use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use core::f64::consts::TAU;
use etalon_math::float64::sin;
use etalon_math::noise::{lattice_hash, noise, noise_within};
use etalon_params::Params;
use etalon_transport::{Shapes, TextureId, TexturePoint};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3, Vec4};

/// Number of cells along a medium with bounds of their own, see [`TextureModel::cells`].
const CELLS: u32 = 256;

/// A kind of pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pattern {
    Noise,
    Fbm,
    Turbulence,
    Marble,
    Wood,
    Voronoi,
    Bricks,
    Cubes,
    Dots,
    Gradient,
}

/// A pattern of two textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Procedural {
    pattern: Pattern,
    colours: [TextureId; 2],
    /// From the world, or from (u, v, 0), to where the pattern is defined.
    place: DAffine3,
    by_uv: bool,
    octaves: u32,
    roughness: f64,
    distortion: f64,
    joint: f64,
}

impl Procedural {
    /// s at a point.
    pub fn share(&self, at: &TexturePoint) -> f32 {
        let p = if self.by_uv {
            at.uv.extend(0.0)
        } else {
            at.position
        };
        self.share_at(self.place.transform_point3(p.as_dvec3())) as f32
    }

    /// Σ rⁱ f(n(2ⁱ p)).
    fn sum(&self, p: DVec3, of: impl Fn(f64) -> f64) -> f64 {
        let (mut sum, mut amplitude, mut p) = (0.0, 1.0, p);
        for _ in 0..self.octaves {
            sum += amplitude * of(noise(p));
            amplitude *= self.roughness;
            // Moved too, as all lattices have the origin in common, where noise vanishes.
            p = p * 2.0 + DVec3::new(17.0, 31.0, 47.0);
        }
        sum
    }

    /// The least and the greatest of [`Procedural::sum`] within `half` of `p` along each axis.
    fn sum_within(&self, p: DVec3, half: DVec3, of: impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
        let (mut sum, mut amplitude, mut p, mut half) = ([0.0; 2], 1.0, p, half);
        for _ in 0..self.octaves {
            let octave = of(noise_within(p, half));
            sum = [0, 1].map(|end| sum[end] + amplitude * octave[end]);
            amplitude *= self.roughness;
            p = p * 2.0 + DVec3::new(17.0, 31.0, 47.0);
            half *= 2.0;
        }
        sum
    }

    /// Bounds of s in a box.
    fn share_within(&self, low: Vec3, high: Vec3) -> [f64; 2] {
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let all = [0.0, 1.0];
        if self.by_uv || !(low.is_finite() && high.is_finite()) {
            return all;
        }
        let p = self.place.transform_point3(0.5 * (low + high));
        let m = self.place.matrix3;
        let extent = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
        // A little more, so that rounding does not matter.
        let half = extent * (high - low) * 0.500_001;
        let size = |[a, b]: [f64; 2]| {
            let least = if a * b <= 0.0 {
                0.0
            } else {
                a.abs().min(b.abs())
            };
            [least, a.abs().max(b.abs())]
        };
        let of = |range: [f64; 2], scale: f64| range.map(|n| 0.5 + 0.5 * scale * n);
        let range = match self.pattern {
            Pattern::Noise => of(noise_within(p, half), 1.0),
            Pattern::Fbm => of(self.sum_within(p, half, |n| n), 1.0 / self.total()),
            Pattern::Turbulence => {
                let total = self.total();
                self.sum_within(p, half, size).map(|sum| sum / total)
            }
            Pattern::Voronoi => {
                let (nearest, reach) = (nearest_point(p), half.length());
                [nearest - reach, nearest + reach]
            }
            // Steps and waves, which reach both.
            _ => all,
        };
        range.map(|share| share.clamp(0.0, 1.0))
    }

    /// Σ rⁱ.
    fn total(&self) -> f64 {
        (0..self.octaves).fold(0.0, |sum, _| 1.0 + sum * self.roughness)
    }

    fn share_at(&self, p: DVec3) -> f64 {
        let fraction = |x: f64| x - x.floor();
        let share = match self.pattern {
            Pattern::Noise => 0.5 + 0.5 * noise(p),
            Pattern::Fbm => 0.5 + 0.5 * self.sum(p, |n| n) / self.total(),
            Pattern::Turbulence => self.sum(p, f64::abs) / self.total(),
            Pattern::Marble => {
                0.5 + 0.5 * sin(TAU * (p.x + self.distortion * self.sum(p, f64::abs)))
            }
            Pattern::Wood => fraction(p.truncate().length() + self.distortion * noise(p)),
            Pattern::Voronoi => nearest_point(p),
            Pattern::Bricks => {
                let row = (2.0 * p.y).floor();
                let x = fraction(p.x + 0.5 * row.rem_euclid(2.0));
                let y = 0.5 * fraction(2.0 * p.y);
                let half = 0.5 * self.joint;
                let inside = |x: f64, width: f64| x >= half && x < width - half;
                f64::from(u8::from(inside(x, 1.0) && inside(y, 0.5)))
            }
            Pattern::Cubes => p.floor().element_sum().rem_euclid(2.0),
            Pattern::Dots => f64::from(u8::from(in_dot(p.truncate()))),
            Pattern::Gradient => fraction(p.x),
        };
        share.clamp(0.0, 1.0)
    }
}

/// The distance to the nearest of random points, one in each cell of side 1.
fn nearest_point(p: DVec3) -> f64 {
    let cell = p.floor();
    let mut least = f64::INFINITY;
    for index in 0..125 {
        let [x, y, z] = [index % 5, index / 5 % 5, index / 25].map(|i| f64::from(i) - 2.0);
        let q = cell + DVec3::new(x, y, z);
        let part =
            |key: f64| f64::from(lattice_hash(q + key * 0x1000_0000 as f64)) / 4_294_967_296.0;
        let point = q + DVec3::new(part(1.0), part(2.0), part(3.0));
        least = least.min(point.distance_squared(p));
    }
    least.sqrt()
}

/// Whether a place of the plane is in a dot. The squares have their middles at integers.
fn in_dot(p: DVec2) -> bool {
    const RADIUS: f64 = 0.35;
    let square = (p + 0.5).floor();
    // Noise of places apart from one another, and away from the lattice, where it vanishes.
    let random = |x: f64, y: f64| noise((square + DVec2::new(x, y)).extend(0.5));
    let moved = (0.5 - RADIUS) * DVec2::new(random(1.5, 2.8), random(4.5, 9.8));
    random(0.5, 0.5) > 0.0 && (p - square - moved).length() < RADIUS
}

impl TextureModel for Procedural {
    const VARIES: bool = true;

    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        let [a, b] = self.colours.map(|id| set.spectrum(id, shapes, at, lambda));
        a.lerp(b, self.share(at))
    }

    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        let [a, b] = self.colours.map(|id| set.number(id, shapes, at));
        a + self.share(at) * (b - a)
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        let [a, b] = self.colours.map(|id| set.colour(id, shapes, at));
        a.lerp(b, self.share(at))
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        let [a, b] = self.colours;
        0.5 * (set.mean(a) + set.mean(b))
    }

    fn most_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        let [a, b] = self
            .colours
            .map(|id| set.get(id).most_within(set, low, high));
        self.share_within(low, high)
            .map(|share| a + share as f32 * (b - a))
            .into_iter()
            .fold(f32::NEG_INFINITY, f32::max)
    }

    fn least_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        let [a, b] = self
            .colours
            .map(|id| set.get(id).least_within(set, low, high));
        self.share_within(low, high)
            .map(|share| a + share as f32 * (b - a))
            .into_iter()
            .fold(f32::INFINITY, f32::min)
    }

    fn cells(&self, _: &TextureTable) -> u32 {
        use Pattern::{Fbm, Noise, Turbulence, Voronoi};
        match self.pattern {
            Noise | Fbm | Turbulence | Voronoi if !self.by_uv => CELLS,
            _ => 1,
        }
    }

    fn is_constant(&self, _: &TextureTable) -> bool {
        self.colours[0] == self.colours[1]
    }

    fn nested(&self) -> &[TextureId] {
        &self.colours
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        self.by_uv
            .then_some("with `space` = `world` the pattern stands in space")
    }
}

/// Reads `color0` (0) and `color1` (1), `to_world`, `space` (`world` or `uv`; `uv` for `bricks`, `dots` and `gradient`), and
/// what the pattern has: `octaves` (6), `roughness` (0.5), `distortion` (1 for `marble`, 0.3 for `wood`), `joint`
/// (0.05).
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let pattern = match params.node.plugin.value.as_str() {
        "fbm" => Pattern::Fbm,
        "turbulence" => Pattern::Turbulence,
        "marble" => Pattern::Marble,
        "wood" => Pattern::Wood,
        "voronoi" => Pattern::Voronoi,
        "bricks" => Pattern::Bricks,
        "cubes" => Pattern::Cubes,
        "dots" => Pattern::Dots,
        "gradient" => Pattern::Gradient,
        _ => Pattern::Noise,
    };
    use Pattern::{Bricks, Dots, Fbm, Gradient, Marble, Turbulence, Wood};
    let flat = matches!(pattern, Bricks | Dots | Gradient);
    let space = if flat { "uv" } else { "world" };
    let by_uv = params.choice("space", space, &["world", "uv"]) == "uv";
    let (mut octaves, mut roughness, mut distortion, mut joint) = (6, 0.5, 0.0, 0.0);
    if matches!(pattern, Fbm | Turbulence | Marble) {
        octaves = params.integer_or("octaves", 6);
        if !(1..=32).contains(&octaves) {
            params.refuse("octaves", octaves, "1, 2, … 32");
        }
        let share = |r: f64| (0.0..=1.0).contains(&r);
        roughness = params.float_where("roughness", 0.5, "a number from 0 to 1", share);
    }
    if matches!(pattern, Marble | Wood) {
        let default = if pattern == Marble { 1.0 } else { 0.3 };
        distortion = params.float_where("distortion", default, "a finite number", f64::is_finite);
    }
    if pattern == Bricks {
        let width = |w: f64| (0.0..=0.5).contains(&w);
        joint = params.float_where("joint", 0.05, "a number from 0 to 0.5", width);
    }
    let place = place::from_world(params)?;
    let nested = Use { role, nested: true };
    Some(Texture::from(Procedural {
        pattern,
        colours: [
            reader.parameter_in(params, "color0", Some(0.0), nested),
            reader.parameter_in(params, "color1", Some(1.0), nested),
        ],
        place,
        by_uv,
        octaves: octaves.clamp(1, 32) as u32,
        roughness,
        distortion,
        joint,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// With a rotated and stretched pattern, in boxes smaller and larger than its features.
        #[test]
        fn no_share_in_a_box_is_beyond_its_bounds(
            low in prop::array::uniform3(-5.0_f32..5.0),
            size in -3.0_f32..1.0,
            part in prop::array::uniform3(0.0_f32..1.0),
            pattern in prop::sample::select(vec![
                Pattern::Noise, Pattern::Fbm, Pattern::Turbulence, Pattern::Voronoi, Pattern::Marble,
            ]),
        ) {
            let pattern = Procedural {
                pattern,
                colours: [TextureId(0), TextureId(1)],
                place: DAffine3::from_rotation_z(0.4) * DAffine3::from_scale(DVec3::new(1.0, 2.0, 0.7)),
                by_uv: false,
                octaves: 5,
                roughness: 0.6,
                distortion: 1.0,
                joint: 0.0,
            };
            let low = Vec3::from_array(low);
            let side = etalon_math::float::exp(size * 2.0) * Vec3::new(1.0, 0.6, 0.8);
            let [least, most] = pattern.share_within(low, low + side);
            let at = TexturePoint::in_space(low + side * Vec3::from_array(part));
            let share = f64::from(pattern.share(&at));
            prop_assert!(least - 1e-6 <= share && share <= most + 1e-6, "{least} {share} {most}");
        }
    }

    /// The bounds in a small box are tight.
    #[test]
    fn bounds_of_a_small_box_are_tight() {
        let pattern = Procedural {
            pattern: Pattern::Noise,
            colours: [TextureId(0), TextureId(1)],
            place: DAffine3::IDENTITY,
            by_uv: false,
            octaves: 1,
            roughness: 0.5,
            distortion: 0.0,
            joint: 0.0,
        };
        let [least, most] = pattern.share_within(Vec3::splat(0.4), Vec3::splat(0.45));
        assert!(most - least < 0.15, "{least} {most}");
    }
}
