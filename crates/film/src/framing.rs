//! Another size of the film than the scene's, and another part of it.

use crate::FilmSettings;
use core::fmt::{Display, Formatter};
use glam::UVec2;

/// The size of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilmSize {
    /// Width and height (pixels).
    Pixels(UVec2),
    /// The scene's, times this.
    Share(f64),
}

/// Replacements for a film's size and crop window. `None` keeps the scene's value; a crop window of the scene is scaled
/// with the film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Framing {
    /// The size of the whole film.
    pub size: Option<FilmSize>,
    /// The first pixel and the extent of the part, in pixels of the whole film.
    pub crop: Option<[UVec2; 2]>,
}

impl Framing {
    /// Applies it to a film.
    ///
    /// # Errors
    /// One sentence, if a film would have no pixels or too many, or a part reaches beyond it.
    pub fn apply(&self, film: &mut FilmSettings) -> Result<(), String> {
        let before = film.size;
        let size = match self.size {
            None => before,
            Some(FilmSize::Pixels(size)) => size,
            Some(FilmSize::Share(share)) => {
                let scaled = before.as_dvec2() * share;
                scaled.round().max(glam::DVec2::ONE).as_uvec2()
            }
        };
        let largest = FilmSettings::LARGEST;
        if size.min_element() == 0 || size.max_element() > largest {
            return Err(format!(
                "a film of {} x {} pixels: each side must be from 1 to {largest}",
                size.x, size.y
            ));
        }
        if size != before {
            let factor = size.as_dvec2() / before.as_dvec2();
            let scaled = |corner: UVec2| (corner.as_dvec2() * factor).round().as_uvec2();
            let end = scaled(film.crop_offset + film.crop_size).min(size);
            film.crop_offset = scaled(film.crop_offset).min(size - UVec2::ONE);
            film.crop_size = end.saturating_sub(film.crop_offset).max(UVec2::ONE);
            film.size = size;
        }
        if let Some([offset, extent]) = self.crop {
            let within = |axis: usize| {
                let end = offset[axis].checked_add(extent[axis]);
                extent[axis] > 0 && end.is_some_and(|end| end <= size[axis])
            };
            if !(within(0) && within(1)) {
                return Err(format!(
                    "a part of {} x {} pixels from ({}, {}) is not within a film of {} x {}",
                    extent.x, extent.y, offset.x, offset.y, size.x, size.y
                ));
            }
            (film.crop_offset, film.crop_size) = (offset, extent);
        }
        Ok(())
    }
}

/// As on the command line, without what is kept from the scene.
impl Display for Framing {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let size = self.size.map(|size| match size {
            FilmSize::Pixels(size) => format!("--size {}x{}", size.x, size.y),
            FilmSize::Share(share) => format!("--scale {share}"),
        });
        let crop = self.crop.map(|[offset, extent]| {
            let [x, y, w, h] = [offset.x, offset.y, extent.x, extent.y];
            format!("--crop {x},{y},{w},{h}")
        });
        let words: Vec<String> = size.into_iter().chain(crop).collect();
        f.write_str(&words.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Filter;

    fn framed(framing: Framing) -> Result<[[u32; 2]; 3], String> {
        let mut film = FilmSettings::new(640, 480, Filter::default());
        film.crop_offset = UVec2::new(320, 0);
        film.crop_size = UVec2::new(320, 240);
        framing.apply(&mut film)?;
        let FilmSettings {
            size,
            crop_offset,
            crop_size,
            ..
        } = film;
        Ok([size, crop_offset, crop_size].map(UVec2::into))
    }

    #[test]
    fn the_scenes_part_is_scaled_and_replaced() {
        let quarter = Framing {
            size: Some(FilmSize::Share(0.25)),
            crop: None,
        };
        assert_eq!(framed(quarter), Ok([[160, 120], [80, 0], [80, 60]]));
        let other = Framing {
            size: Some(FilmSize::Pixels(UVec2::new(100, 100))),
            crop: Some([UVec2::new(90, 0), UVec2::new(10, 100)]),
        };
        assert_eq!(framed(other), Ok([[100, 100], [90, 0], [10, 100]]));
        assert_eq!(other.to_string(), "--size 100x100 --crop 90,0,10,100");
        let tiny = Framing {
            size: Some(FilmSize::Share(1e-9)),
            crop: None,
        };
        assert_eq!(framed(tiny), Ok([[1, 1], [0, 0], [1, 1]]));
    }

    #[test]
    fn parts_beyond_the_film_are_refused() {
        let crop = |offset: [u32; 2], extent: [u32; 2]| Framing {
            size: None,
            crop: Some([offset.into(), extent.into()]),
        };
        for wrong in [
            crop([600, 0], [41, 1]),
            crop([0, 0], [0, 1]),
            crop([u32::MAX, 0], [1, 1]),
        ] {
            assert!(framed(wrong).is_err(), "{wrong}");
        }
        assert!(framed(crop([639, 479], [1, 1])).is_ok());
    }
}
