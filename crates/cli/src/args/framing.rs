//! What part of a scene is rendered, how large, and how pictures are shown.

use crate::arg_values::{parse_crop, parse_scale, parse_sensor, parse_size, parse_view};
use clap::Args;
use etalon_film::{FilmSize, Framing};
use etalon_images::{Development, View};
use etalon_scene::SensorChoice;
use glam::UVec2;

/// Another size, part or camera than the scene's.
#[derive(Debug, Args, Clone, Default)]
pub struct FramingArgs {
    /// Width and height of the film in pixels, instead of the scene's; a part that the scene crops is scaled with it.
    #[arg(long, value_name = "WxH", value_parser = parse_size, allow_hyphen_values = true)]
    pub size: Option<UVec2>,
    /// The scene's size times this: 25% or 0.25.
    #[arg(long, value_name = "SHARE", value_parser = parse_scale, allow_hyphen_values = true, conflicts_with = "size")]
    pub scale: Option<f64>,
    /// Render W × H pixels from column X and row Y alone, with the bits that they have in the whole picture.
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_crop, allow_hyphen_values = true)]
    pub crop: Option<[UVec2; 2]>,
    /// Which of the scene's sensors: its number, counted from 0, or its id [default: the first].
    #[arg(long, value_name = "N|ID", value_parser = parse_sensor)]
    pub sensor: Option<SensorChoice>,
}

impl FramingArgs {
    /// What replaces the film's size and part.
    pub fn framing(&self) -> Framing {
        let size = self.size.map(FilmSize::Pixels);
        Framing {
            size: size.or(self.scale.map(FilmSize::Share)),
            crop: self.crop,
        }
    }
}

/// How a picture for the eye is made.
#[derive(Debug, Args, Clone, Default)]
pub struct ShownArgs {
    /// Brighten pictures by so many stops (a factor of 2 each).
    #[arg(
        long,
        value_name = "EV",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub exposure: f32,
    /// How pictures show what is bright: srgb clips it, filmic rolls it off.
    #[arg(long, value_name = "NAME", default_value = "srgb", value_parser = parse_view)]
    pub view: View,
}

impl ShownArgs {
    /// The same for who develops it.
    ///
    /// # Errors
    /// If the exposure is no finite number.
    pub fn development(&self) -> Result<Development, String> {
        if !self.exposure.is_finite() {
            return Err("--exposure must be a finite number of stops".to_owned());
        }
        Ok(Development {
            exposure: self.exposure,
            view: self.view,
        })
    }
}
