//! Cameras: each makes rays into the scene, and all but those that measure one number can be connected to from a point of it.
//!
//! All follow Mitsuba 3's conventions: in camera space +X points left, +Y up and +Z forward;
//! raster coordinates grow to the right and downward, in pixels of the whole film. A crop window
//! changes nothing but which part of the film is looked at.
//!
//! A camera's measures are chosen so that a pixel is the mean radiance over its filter: a ray has
//! weight one (π for irradiance), and a connection's weight is the Jacobian between film area and the beam's
//! cross-section (see [`etalon_transport::CameraSample`]).

pub mod any;
pub mod batch;
pub mod clip;
pub mod distant;
pub mod fisheye;
pub mod image_plane;
pub mod irradiance_meter;
pub mod lens;
pub mod measured_surface;
mod meter;
pub mod orthographic;
pub mod panoramic;
pub mod perspective;
pub mod pose;
pub mod radiance_meter;
pub mod spherical;
pub mod thin_lens;
pub mod window;

pub use any::AnyCamera;
pub use batch::Batch;
pub use clip::ClipRange;
pub use distant::Distant;
pub use fisheye::Fisheye;
pub use image_plane::ImagePlane;
pub use irradiance_meter::IrradianceMeter;
pub use lens::Lens;
pub use measured_surface::{MeasuredSurface, SensorShapes};
pub use orthographic::Orthographic;
pub use panoramic::{Panoramic, Projection};
pub use perspective::Perspective;
pub use pose::Pose;
pub use radiance_meter::RadianceMeter;
pub use spherical::Spherical;
pub use thin_lens::ThinLens;
pub use window::FilmWindow;

#[cfg(test)]
mod tests;
