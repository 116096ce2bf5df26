//! The film as a camera sees it: its whole size, and the window of it that is looked at.

use glam::{UVec2, Vec2};

/// A film of `size` pixels, of which only the crop window is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmWindow {
    /// Size of the whole film (pixels). The field of view spans all of it.
    pub size: UVec2,
    /// First pixel of the crop window.
    pub origin: UVec2,
    /// Size of the crop window (pixels).
    pub crop: UVec2,
}

impl FilmWindow {
    /// A film without crop. Neither side of `size` may be zero.
    pub fn whole(size: UVec2) -> Self {
        Self {
            size,
            origin: UVec2::ZERO,
            crop: size,
        }
    }

    /// Width over height of the whole film.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size.x) / f64::from(self.size.y)
    }

    /// Whether a raster position is at most `margin` pixels outside of the crop window.
    #[inline]
    pub fn contains(&self, raster: Vec2, margin: f32) -> bool {
        let low = self.origin.as_vec2() - margin;
        let high = (self.origin + self.crop).as_vec2() + margin;
        raster.cmpge(low).all() && raster.cmple(high).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margin_extends_the_crop_window_on_all_sides() {
        let window = FilmWindow {
            size: UVec2::new(40, 30),
            origin: UVec2::new(4, 6),
            crop: UVec2::new(10, 8),
        };
        assert!(window.contains(Vec2::new(4.0, 14.0), 0.0));
        assert!(!window.contains(Vec2::new(3.0, 10.0), 0.5));
        assert!(window.contains(Vec2::new(3.0, 10.0), 1.5));
        assert!(!window.contains(Vec2::new(10.0, 16.0), 1.5));
        assert!(!window.contains(Vec2::new(f32::NAN, 10.0), 1.5));
    }
}
