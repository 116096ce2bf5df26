//! Where a pixel is looked at: on a regular grid, refined where neighbours differ.
//!
//! Without refinement these are the centres of n × n squares. With it they are the squares'
//! corners, so that every edge passes between two points of some square: a square whose corners
//! differ is cut into four, and one that is not cut counts the mean of its corners (Whitted 1980,
//! section 4).

use glam::{Vec2, Vec4};

/// The most squares along a side.
pub(super) const MOST: u32 = 32;

/// The points of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Squares along each side, at most 32.
    pub side: u32,
    /// The most subdivisions of a square whose corners differ.
    pub levels: u32,
    /// The difference of colours, or of alpha, from which on corners differ.
    pub contrast: f32,
}

impl Grid {
    /// The mean of `look` over the pixel whose upper left corner is `corner`.
    pub(super) fn mean<L: FnMut(Vec2) -> Vec4>(&self, corner: Vec2, mut look: L) -> Vec4 {
        let side = self.side as f32;
        let place =
            |x: u32, y: u32, shift: f32| corner + (Vec2::new(x as f32, y as f32) + shift) / side;
        let mut sum = Vec4::ZERO;
        if self.levels == 0 {
            for y in 0..self.side {
                sum += (0..self.side).map(|x| look(place(x, y, 0.5))).sum::<Vec4>();
            }
            return sum / (side * side);
        }
        let row = |y: u32, look: &mut L| -> [Vec4; MOST as usize + 1] {
            core::array::from_fn(|x| {
                let x = x as u32;
                if x <= self.side {
                    look(place(x, y, 0.0))
                } else {
                    Vec4::ZERO
                }
            })
        };
        let mut above = row(0, &mut look);
        for y in 0..self.side {
            let below = row(y + 1, &mut look);
            for x in 0..self.side {
                let i = x as usize;
                let corners = [above[i], above[i + 1], below[i], below[i + 1]];
                let place = place(x, y, 0.0);
                sum += self.square(place, 1.0 / side, self.levels, corners, &mut look);
            }
            above = below;
        }
        sum / (side * side)
    }

    /// The mean over a square with these colours at its corners: upper left, upper right, lower
    /// left, lower right.
    fn square(
        &self,
        corner: Vec2,
        size: f32,
        levels: u32,
        [a, b, c, d]: [Vec4; 4],
        look: &mut impl FnMut(Vec2) -> Vec4,
    ) -> Vec4 {
        let spread = a.max(b).max(c).max(d) - a.min(b).min(c).min(d);
        if levels == 0 || spread.max_element() <= self.contrast {
            return 0.25 * (a + b + c + d);
        }
        let half = 0.5 * size;
        let mut at = |x: f32, y: f32| look(corner + half * Vec2::new(x, y));
        let [north, west, middle] = [at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
        let [east, south] = [at(2.0, 1.0), at(1.0, 2.0)];
        let quarters = [
            (Vec2::ZERO, [a, north, west, middle]),
            (Vec2::X, [north, b, middle, east]),
            (Vec2::Y, [west, middle, c, south]),
            (Vec2::ONE, [middle, east, south, d]),
        ];
        let quarter =
            |(part, corners)| self.square(corner + part * half, half, levels - 1, corners, look);
        quarters.map(quarter).into_iter().sum::<Vec4>() * 0.25
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
        // An edge at x = 0.3: each level halves the error's bound, and the corners of a square that
        // is all on one side are enough.
        let looks = Cell::new(0);
        let look = |p: Vec2| {
            looks.set(looks.get() + 1);
            Vec4::splat(f32::from(p.x < 0.3))
        };
        let mean = grid(2, 5).mean(Vec2::ZERO, look);
        assert!((mean.x - 0.3).abs() <= 1.0 / 64.0, "{mean}");
        // 4 + 8 + … + 64 squares are cut, with five looks each, after the first nine. With every
        // square cut there would be more than six thousand looks.
        assert_eq!(looks.get(), 9 + 5 * (2 + 4 + 8 + 16 + 32));
    }
}
