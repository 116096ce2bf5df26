//! Where a pixel is looked at: on a regular grid, refined where neighbours differ.

use glam::{Vec2, Vec4};

/// The points of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Points along each side of a square.
    pub side: u32,
    /// How often a square whose points differ may be cut into four, each looked at in the same way
    /// (Whitted 1980, section 4).
    pub levels: u32,
    /// The difference of colours, or of alpha, from which on points differ.
    pub contrast: f32,
}

impl Grid {
    /// The mean of `look` over the pixel whose upper left corner is `corner`.
    pub(super) fn mean(&self, corner: Vec2, look: impl Fn(Vec2) -> Vec4) -> Vec4 {
        self.square(corner, 1.0, self.levels, &look)
    }

    fn square(&self, corner: Vec2, size: f32, levels: u32, look: &impl Fn(Vec2) -> Vec4) -> Vec4 {
        let side = self.side as f32;
        let (mut sum, mut least, mut most) = (Vec4::ZERO, Vec4::INFINITY, Vec4::NEG_INFINITY);
        for y in 0..self.side {
            for x in 0..self.side {
                let place = Vec2::new(x as f32, y as f32) + 0.5;
                let seen = look(corner + place * (size / side));
                sum += seen;
                least = least.min(seen);
                most = most.max(seen);
            }
        }
        if levels == 0 || (most - least).max_element() <= self.contrast {
            return sum / (side * side);
        }
        let half = 0.5 * size;
        let parts = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE];
        let quarter = |part: Vec2| self.square(corner + part * half, half, levels - 1, look);
        parts.map(quarter).into_iter().sum::<Vec4>() * 0.25
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::Cell;

    fn grid(side: u32, levels: u32) -> Grid {
        Grid {
            side,
            levels,
            contrast: 0.1,
        }
    }

    #[test]
    fn a_linear_picture_is_met_in_the_middle() {
        let look = |p: Vec2| Vec4::new(p.x, p.y, 1.0, 1.0);
        for (side, levels) in [(1, 0), (2, 0), (3, 0), (2, 3)] {
            let mean = grid(side, levels).mean(Vec2::new(4.0, 7.0), look);
            assert!((mean - Vec4::new(4.5, 7.5, 1.0, 1.0)).length() < 1e-5);
        }
    }

    #[test]
    fn only_squares_with_an_edge_are_refined() {
        // An edge at x = 0.3: each level halves the error's bound, and four points of every square
        // that is all on one side are enough.
        let looks = Cell::new(0);
        let look = |p: Vec2| {
            looks.set(looks.get() + 1);
            Vec4::splat(f32::from(p.x < 0.3))
        };
        let mean = grid(2, 5).mean(Vec2::ZERO, look);
        assert!((mean.x - 0.3).abs() <= 1.0 / 64.0, "{mean}");
        // With every square refined there would be 4 + 4·4 + … + 4·4⁵ = 5460 looks.
        assert!(looks.get() < 600, "{}", looks.get());
    }
}
