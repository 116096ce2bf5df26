//! Cameras: each makes rays into the scene *and* can be connected to from a point of it.
//!
//! All follow Mitsuba 3's conventions: in camera space +X points left, +Y up and +Z forward;
//! raster coordinates grow to the right and downward, in pixels of the whole film. A crop window
//! changes nothing but which part of the film is looked at.
//!
//! A camera's measures are chosen so that a pixel is the mean radiance over its filter: a ray has
//! weight one, and a connection's weight is the Jacobian between film area and the beam's
//! cross-section (see [`etalon_transport::CameraSample`]).

pub mod any;
pub mod clip;
pub mod image_plane;
pub mod lens;
pub mod orthographic;
pub mod perspective;
pub mod pose;
pub mod thin_lens;
pub mod window;

pub use any::AnyCamera;
pub use clip::ClipRange;
pub use image_plane::ImagePlane;
pub use lens::Lens;
pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use pose::Pose;
pub use thin_lens::ThinLens;
pub use window::FilmWindow;

#[cfg(test)]
mod tests;
