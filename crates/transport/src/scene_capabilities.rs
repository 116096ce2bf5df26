//! Which scenes an estimator can render, decided before rendering: an estimator that cannot find any
//! of a scene's light refuses it, so that no picture is black without an explanation.

use crate::RowExposure;

/// How many lights there are, by the ways in which a path can find them. Lights that emit nothing
/// do not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightCount {
    /// All of them.
    pub all: u32,
    /// Those that a ray can run into: emitting surfaces, and skies.
    pub hittable: u32,
    /// Those that are ever chosen, for a connection or to emit a particle: their
    /// `sampling_weight` is not zero.
    pub chosen: u32,
    /// Those that can be hit, or are chosen, or both.
    pub either: u32,
    /// Of those that are chosen, the ones that only particles find ([`crate::LightKind::Beam`]).
    pub beams: u32,
}

/// First surfaces seen by a lattice of camera rays. A ray may count in several fields, as it
/// continues through null surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CameraProbe {
    /// All of them.
    pub rays: u32,
    /// Those that see a surface that scatters in a continuum of directions.
    pub scattering: u32,
    /// Those that see one that also, or only, scatters in discrete directions: a mirror, smooth
    /// glass, a varnish.
    pub smooth: u32,
    /// Those that see a light, the sky included.
    pub lights: u32,
    /// Those that come, perhaps by way of mirrors and smooth glass, to a surface that scatters in a
    /// continuum of directions, or to a light.
    pub reached: u32,
    /// Those of them that come to a surface which a light that is but a point or a direction lights
    /// through smooth glass.
    pub veiled: u32,
}

/// Plain facts of a scene that decide what an estimator can find in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneCapabilities {
    /// The lights.
    pub lights: LightCount,
    /// Whether the camera has an aperture that a ray can hit, see [`crate::Camera::intersect_aperture`].
    pub aperture: bool,
    /// Whether the camera cannot be connected with from a point of the scene, see [`crate::Camera::can_connect`].
    pub unconnected_camera: bool,
    /// Whether there is light at infinity that a ray can hit.
    pub sky: bool,
    /// Whether an unbounded medium absorbs all light from infinity.
    pub swallowed: bool,
    /// Whether there are participating media.
    pub media: bool,
    /// Whether any of them has a diffusion profile.
    pub diffusion: bool,
    /// Whether coefficients in any of them are those of the surface point where a random walk entered.
    pub textured_random_walk: bool,
    /// Whether light at infinity reaches unbounded surfaces, over which particles cannot be distributed.
    pub endless: bool,
    /// Whether a surface has a model that is valid for camera paths only (hair).
    pub one_way: bool,
    /// When rows of the picture are exposed, see [`crate::World::moment`].
    pub rows: RowExposure,
    /// Whether a surface has a classic Phong material, which says nothing of how it scatters light
    /// ([`crate::Surfaces::legacy_phong`]).
    pub classic: bool,
    /// Whether the film's filter is so narrow that splats find no pixel ([`crate::Film::light_paths`]).
    pub narrow_filter: bool,
    /// The first surfaces that the camera sees.
    pub view: CameraProbe,
}

/// How an estimator finds light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSearch {
    /// Rays run into lights by chance.
    Hitting,
    /// Lights are chosen: to be connected with, or to emit particles.
    Choosing,
    /// Lights are chosen to be connected with.
    Connecting,
    /// Both; either is enough.
    Either,
    /// Both, and by paths from the camera alone: they come through smooth glass only to lights that they
    /// run into.
    FromCamera,
}

/// The subject of an incompatibility, which decides the source position of its message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The estimator as a whole.
    Integrator,
    /// One of its parameters.
    Parameter(&'static str),
    /// The camera.
    Camera,
    /// A classic Phong material.
    Classic,
    /// The scene as a whole.
    Scene,
}

/// Why an estimator cannot render a scene, or not all of its light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Incompatibility {
    /// Whether rendering is refused; otherwise it is a remark.
    pub fatal: bool,
    /// Its subject.
    pub subject: Subject,
    /// One sentence.
    pub message: String,
    /// Advice.
    pub help: Option<String>,
}

impl Incompatibility {
    /// A reason not to render.
    pub fn fatal(subject: Subject, message: impl Into<String>) -> Self {
        Self {
            fatal: true,
            subject,
            message: message.into(),
            help: None,
        }
    }

    /// A remark.
    pub fn remark(subject: Subject, message: impl Into<String>) -> Self {
        Self {
            fatal: false,
            ..Self::fatal(subject, message)
        }
    }

    /// Adds advice.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(help.into()),
            ..self
        }
    }
}

/// A fatal incompatibility of the integrator.
fn impossible(message: &str, help: &str) -> Incompatibility {
    Incompatibility::fatal(Subject::Integrator, message).help(help)
}

impl SceneCapabilities {
    /// The incompatibilities of an estimator that follows light and finds it in one way: a remark if there
    /// is no light at all, or if some of it will be missing; a refusal if all of it would, or if a
    /// material says nothing of how it scatters light.
    pub fn incompatibilities(&self, finding: LightSearch) -> Vec<Incompatibility> {
        let mut incompatibilities = self.missing(finding);
        incompatibilities.extend(self.unreached());
        incompatibilities.extend(self.swallowed());
        if finding == LightSearch::FromCamera {
            incompatibilities.extend(self.veiled());
        }
        if self.classic {
            let message = "this integrator follows light, and this material says nothing of how it \
                           scatters light";
            incompatibilities.push(Incompatibility::fatal(Subject::Classic, message).help(
                "the integrator `whitted` shows classic Phong materials; `phong` is a BSDF that \
                 every integrator shows",
            ));
        }
        incompatibilities
    }

    /// The incompatibility, if any, of an estimator that follows light from where it comes from.
    pub fn endless_lit(&self) -> Option<Incompatibility> {
        let message = "this integrator sends light into the scene, and light at infinity falls on a `plane` that has no end";
        let help = "use a `rectangle` or a `disk` for a `plane`, or the integrator `path`";
        self.endless.then(|| impossible(message, help))
    }

    /// The incompatibility, if any, of an estimator that follows light, to materials that are made for the viewer.
    pub fn seen_one_way(&self) -> Option<Incompatibility> {
        let message = "this integrator sends light into the scene, and light that enters a hair leaves it elsewhere, which \
                       the model `hair` knows for paths from the camera only";
        let help = "use `path`, or another integrator that starts at the camera";
        self.one_way.then(|| impossible(message, help))
    }

    /// The incompatibility, if any, of an estimator whose paths meet light at moments of its choice, to a rolling shutter.
    pub fn rows_in_turn(&self) -> Option<Incompatibility> {
        let message = "this integrator sends light into the scene at any moment, and the sensor has a rolling shutter, whose rows see \
                       moments of their own";
        let help = "use `path`, or another integrator that starts at the camera, or `ptracer`";
        (self.rows != RowExposure::Together).then(|| impossible(message, help))
    }

    /// The incompatibility, if any, of an estimator that makes pictures of nothing but light paths, to a rolling shutter.
    pub fn instant_rows(&self) -> Option<Incompatibility> {
        let message = "this integrator sends light into the scene at any moment, and the rows of the sensor's rolling shutter are \
                       exposed at one moment each (`rolling_shutter_duration` 0)";
        let help = "use `path`, or another integrator that starts at the camera";
        (self.rows == RowExposure::Instants).then(|| impossible(message, help))
    }

    /// The incompatibility, if any, of an estimator that knows nothing of media, with the names of those that do.
    pub fn media_unseen(&self, able: &str) -> Option<Incompatibility> {
        let message = "this integrator sees surfaces only, and the scene has participating media";
        (self.media).then(|| impossible(message, &format!("integrators that see media: {able}")))
    }

    /// The incompatibility, if any, of an estimator that knows nothing of diffusion profiles, and nothing of where a random walk began,
    /// with the names of those that do.
    pub fn diffusion_unseen(&self, able: &str) -> Option<Incompatibility> {
        let profile = || {
            let message =
                "this integrator cannot have the scene's diffusion profiles, as `dipole` is one";
            let help = format!(
                "integrators that can: {able}; or let light walk: `<subsurface type=\"randomwalk\">`"
            );
            impossible(message, &help)
        };
        let random_walk = || {
            let message = "this integrator cannot have a `randomwalk` whose coefficients vary over the surface: it follows walks both \
                           ways, and they have those of where they begin";
            let help = format!(
                "integrators that can: {able}; a `heterogeneous` medium varies in space and is for all"
            );
            impossible(message, &help)
        };
        (self.diffusion.then(profile)).or_else(|| self.textured_random_walk.then(random_walk))
    }

    /// The incompatibility, if any, of an estimator that finds light by connecting surfaces with the
    /// camera, and lights in plain view: what reaches the camera off a smooth surface is missing.
    pub fn unconnected(&self) -> Option<Incompatibility> {
        let CameraProbe {
            rays,
            scattering,
            smooth,
            lights,
            ..
        } = self.view;
        if smooth == 0 {
            return None;
        }
        let help = "use an estimator that follows light from the camera, too (`path`, `bdpt`)";
        let why = "it connects surfaces with the camera, and one that is smooth sends light there \
                   from its own directions only";
        let incompatibility = if scattering == 0 && lights == 0 {
            let message =
                format!("this integrator cannot see anything that the camera sees: {why}");
            Incompatibility::fatal(Subject::Integrator, message)
        } else {
            let share = (100.0 * f64::from(smooth) / f64::from(rays)).ceil();
            let message = format!(
                "this integrator cannot see what is mirrored, or behind glass, in {share} % of \
                 the picture: {why}"
            );
            Incompatibility::remark(Subject::Integrator, message)
        };
        Some(incompatibility.help(help))
    }

    /// The incompatibility, if any, of an estimator that finds light only by connecting points of the scene with the camera, to one that measures along given rays.
    pub fn one_way_camera(&self) -> Option<Incompatibility> {
        self.unconnected_camera.then(|| {
            let message = "this integrator only connects points of the scene with the camera, and this sensor cannot be connected with: it \
                           measures along rays of its own";
            Incompatibility::fatal(Subject::Camera, message)
                .help("use an integrator that follows light from the camera, too (`path`, `bdpt`)")
        })
    }

    /// The incompatibility, if any, of an estimator that makes the picture, or all that is lit in it, of light that
    /// lands anywhere on the film.
    pub fn unsplattable(&self) -> Option<Incompatibility> {
        self.narrow_filter.then(|| {
            let message = "this integrator carries light to the film, wherever it lands, and the filter is so \
                           narrow that it practically never lands within";
            Incompatibility::fatal(Subject::Integrator, message).help(
                "use an estimator that asks for the light of a pixel (`path`, `bdpt`), or a filter whose \
                 radius is at least half a pixel",
            )
        })
    }

    /// A remark if there is no light at all.
    pub fn unlit(&self) -> Option<Incompatibility> {
        (self.lights.all == 0).then(|| {
            Incompatibility::remark(Subject::Scene, "nothing in this scene emits light")
                .help("the picture will be black: add a light")
        })
    }

    /// A remark where nothing that the camera sees, mirrored or not, can be lit or shines: a camera
    /// that looks past the scene, or a room of mirrors with lights that have no extent.
    fn unreached(&self) -> Option<Incompatibility> {
        let nothing = self.view.rays > 0 && self.view.reached == 0 && self.lights.all > 0;
        nothing.then(|| {
            let message = "the camera sees no light, and no surface that light could be connected \
                           with: not straight, nor by way of mirrors and smooth glass";
            Incompatibility::remark(Subject::Scene, message).help(
                "the picture will be black, or nearly: turn the camera to the scene, or give the \
                 lights an extent or a surface some roughness",
            )
        })
    }

    /// A remark where light from infinity never comes to the scene.
    fn swallowed(&self) -> Option<Incompatibility> {
        self.swallowed.then(|| {
            let message = "a medium without end is around the scene, and nothing comes through it of a sky or of other light at \
                           infinity";
            Incompatibility::remark(Subject::Scene, message).help(
                "make it the `interior` of a closed shape with a `null` material around camera and scene: fog is as thick then as \
                 that shape (Mitsuba has its sky on the scene's bounding sphere)",
            )
        })
    }

    /// A remark where light that smooth glass bends on its way is missing, for an estimator that connects
    /// surfaces with lights by straight lines.
    fn veiled(&self) -> Option<Incompatibility> {
        let CameraProbe { rays, veiled, .. } = self.view;
        (veiled > 0).then(|| {
            let share = (100.0 * f64::from(veiled) / f64::from(rays)).ceil();
            let message = format!(
                "this integrator cannot see light that comes through smooth glass to {share} % of the picture: \
                 it connects surfaces with lights by straight lines, and a point or a direction is never hit"
            );
            Incompatibility::remark(Subject::Integrator, message).help(
                "use an estimator that follows light from the lights, too (`bdpt`, `vcm`), or give the lights an \
                 extent",
            )
        })
    }

    /// The light that an estimator with this way of finding it misses.
    fn missing(&self, finding: LightSearch) -> Vec<Incompatibility> {
        let LightCount {
            all,
            hittable,
            chosen,
            either,
            beams,
        } = self.lights;
        let (found, why, help) = match finding {
            LightSearch::Hitting => (
                hittable,
                "it finds lights only by running into them, and a point or a direction is never hit",
                "use an estimator that samples lights (`path`), or give the lights an extent",
            ),
            LightSearch::Connecting | LightSearch::FromCamera if beams > 0 => (
                if finding == LightSearch::Connecting {
                    chosen - beams
                } else {
                    either - beams
                },
                "light along a surface's normals alone is found by following it from there",
                "use an integrator that follows light from its sources (`ptracer`, `bdpt`)",
            ),
            LightSearch::Choosing | LightSearch::Connecting => (
                chosen,
                "it finds lights only by choosing them, and their `sampling_weight` is 0",
                "give them a `sampling_weight` above 0",
            ),
            LightSearch::Either | LightSearch::FromCamera => (
                either,
                "their `sampling_weight` is 0, and a point or a direction is never hit",
                "give them a `sampling_weight` above 0",
            ),
        };
        if let Some(incompatibility) = self.unlit() {
            return vec![incompatibility];
        }
        let incompatibility = match found {
            0 => {
                let message = format!("this integrator cannot see any light of the scene: {why}");
                Incompatibility::fatal(Subject::Integrator, message).help(help)
            }
            _ if found < all => {
                let missing = all - found;
                let message = format!(
                    "this integrator cannot see {missing} of the scene's {all} lights: {why}"
                );
                Incompatibility::remark(Subject::Integrator, message).help(help)
            }
            _ => return Vec::new(),
        };
        vec![incompatibility]
    }
}

#[cfg(test)]
mod tests;
