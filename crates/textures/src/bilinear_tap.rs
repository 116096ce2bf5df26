//! The texels of an image that a look-up reads, and their weights.

use glam::{UVec2, Vec2};

/// The extension of an image beyond its borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image mirrored.
    Mirror,
    /// The texel at the border.
    Clamp,
    /// Nothing: 0.
    Zero,
}

/// The interpolation between the centres of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Interpolated between the four nearest centres.
    Bilinear,
    /// The texel that contains the point.
    Nearest,
}

impl Wrap {
    /// The texel in 0..n for texel `i` of the unbounded image, by the wrap mode.
    #[inline]
    pub(crate) fn texel(self, i: i64, n: u32) -> usize {
        let n = i64::from(n);
        let folded = match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Mirror => {
                let j = i.rem_euclid(2 * n);
                j.min(2 * n - 1 - j)
            }
            Self::Clamp | Self::Zero => i.clamp(0, n - 1),
        };
        folded as usize
    }

    /// 1 where there is something at texel `i` of the unbounded image, else 0.
    #[inline]
    fn share(self, i: i64, n: u32) -> f32 {
        f32::from(u8::from(
            self != Self::Zero || (0..i64::from(n)).contains(&i),
        ))
    }
}

/// Four texels (as indices into rows of texels) and their weights, which sum to one unless nothing is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearTap {
    /// Upper left, upper right, lower left, lower right.
    pub texels: [usize; 4],
    /// Their weights.
    pub weights: [f32; 4],
}

/// The upper left one of the four texels around `uv`, and how far it is from there to the others.
#[inline]
fn place(uv: Vec2, size: UVec2) -> (Vec2, Vec2) {
    let p = uv * size.as_vec2() - 0.5;
    let corner = p.floor();
    (corner, p - corner)
}

impl BilinearTap {
    /// The four texels around `uv` in an image of `size` texels.
    #[inline]
    pub fn bilinear(uv: Vec2, size: UVec2, wrap: Wrap) -> Self {
        let (corner, w) = place(uv, size);
        Self::weighted(corner, [[1.0 - w.x, w.x], [1.0 - w.y, w.y]], size, wrap)
    }

    /// The same with the derivatives of the weights by u and by v in place of the weights.
    pub(crate) fn slopes(uv: Vec2, size: UVec2, wrap: Wrap) -> [Self; 2] {
        let (corner, w) = place(uv, size);
        let (along, across) = (size.as_vec2(), [[1.0 - w.x, w.x], [1.0 - w.y, w.y]]);
        [
            Self::weighted(corner, [[-along.x, along.x], across[1]], size, wrap),
            Self::weighted(corner, [across[0], [-along.y, along.y]], size, wrap),
        ]
    }

    /// The four texels from `corner` on, weighted by products of one number for each column and one for each row.
    #[inline]
    fn weighted(corner: Vec2, [column, row]: [[f32; 2]; 2], size: UVec2, wrap: Wrap) -> Self {
        let (x, y) = (corner.x as i64, corner.y as i64);
        let (xs, ys) = ([x, x.saturating_add(1)], [y, y.saturating_add(1)]);
        let weight = |i: usize, j: usize| {
            column[i] * row[j] * (wrap.share(xs[i], size.x) * wrap.share(ys[j], size.y))
        };
        let weights = [weight(0, 0), weight(1, 0), weight(0, 1), weight(1, 1)];
        let column = xs.map(|i| wrap.texel(i, size.x));
        let row = ys.map(|i| wrap.texel(i, size.y) * size.x as usize);
        Self {
            texels: [
                row[0] + column[0],
                row[0] + column[1],
                row[1] + column[0],
                row[1] + column[1],
            ],
            weights,
        }
    }

    /// The texel that contains `uv` in an image of `size` texels, and its weight: 1, or 0 where there is nothing.
    #[inline]
    pub fn nearest(uv: Vec2, size: UVec2, wrap: Wrap) -> (usize, f32) {
        let p = (uv * size.as_vec2()).floor();
        let (x, y) = (p.x as i64, p.y as i64);
        (
            wrap.texel(y, size.y) * size.x as usize + wrap.texel(x, size.x),
            wrap.share(x, size.x) * wrap.share(y, size.y),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_far_away_stays_inside() {
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Zero] {
            for uv in [
                Vec2::splat(1e30),
                Vec2::splat(-1e30),
                Vec2::NAN,
                Vec2::INFINITY,
            ] {
                let size = UVec2::new(3, 2);
                assert!(
                    BilinearTap::bilinear(uv, size, wrap)
                        .texels
                        .iter()
                        .all(|&t| t < 6)
                );
                assert!(BilinearTap::nearest(uv, size, wrap).0 < 6);
            }
        }
    }

    #[test]
    fn mirrors_about_the_border() {
        let row: Vec<usize> = (-4..7).map(|i| Wrap::Mirror.texel(i, 3)).collect();
        assert_eq!(row, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(Wrap::Mirror.texel(5, 1), 0);
    }
}
