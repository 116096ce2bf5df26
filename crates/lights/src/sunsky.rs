//! `sunsky`, `timed_sunsky`: the clear sky of Hošek and Wilkie with the sun in it (see `sky/hosek_wilkie.rs`).
//!
//! The zenith is the light's +z. Radiance is interpolated linearly between the model's wavelengths and zero beyond
//! them, 320 to 720 nm, and below the horizon. The sun is a disk of mean radiance or, with `complex_sun`, darkens toward
//! its limb and toward the horizon; with another `sun_aperture` it keeps its irradiance. `timed_sunsky` is the sky of the
//! moment at which a ray flies, as `sky/calendar.rs` says.

use crate::light_model::LightModel;
use crate::pose::Pose;
use crate::sky::calendar::Calendar;
use crate::sky::course::Course;
use crate::sky::guide::angle_between;
use crate::sky::hosek_wilkie::{self, BANDS, FIRST, HosekWilkie, STEP};
use crate::sky::hour::Hour;
use crate::sky::sun_disk::SunDisk;
use crate::sky::sun_position::Moment;
use crate::{BoundingSphere, sky};
use etalon_math::{Density, SolidAngle, float};
use etalon_params::{Diagnostic, Params};
use etalon_sampling::warps::{square_to_uniform_cone, uniform_cone_density};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, Shapes, SpectrumKind, TextureId,
    TexturePoint, Textures, refuse_varying,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Names of the parameters that say when and where.
const MOMENT: [&str; 9] = [
    "latitude",
    "longitude",
    "timezone",
    "year",
    "month",
    "day",
    "hour",
    "minute",
    "second",
];

/// Sky and sun.
#[derive(Clone, Debug)]
pub struct SunSky {
    pose: Pose,
    model: Arc<HosekWilkie>,
    course: Arc<Course>,
    albedo: TextureId,
    sky_scale: f32,
    disk: SunDisk,
}

impl SunSky {
    /// Reads `turbidity` (3), `albedo` (0.3), `sun_direction` or a moment (`latitude` to `second`), `sun_scale`, `sky_scale` (1),
    /// `sun_aperture` (0.5358°), `complex_sun` (false) and `to_world`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        Self::with_course(params, build, |pose, model, disk, sky_scale, _| {
            let sun = match params.vector("sun_direction") {
                Some(direction) => {
                    if let Some(name) = MOMENT.into_iter().find(|name| params.has(name)) {
                        params.error_at(name, format!("give either `sun_direction` or `{name}`"));
                    }
                    let unit = direction.try_normalize();
                    if unit.is_none() {
                        params.error_at("sun_direction", "`sun_direction` must not vanish");
                    }
                    pose?.to_local(unit?.as_vec3())
                }
                None => {
                    let [theta, phi] = Moment::from_params(params).sun_position();
                    hosek_wilkie::direction(theta as f32, phi as f32)
                }
            };
            if !(sun.z >= 0.0) {
                note(
                    params,
                    "the sun is below the horizon, so that this light is black",
                );
            }
            Some(Course::still(model, sun, disk, sky_scale))
        })
    }

    /// Reads `timed_sunsky`: what `sunsky` has, with the days and hours of a calendar in place of one moment.
    pub fn timed_from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        Self::with_course(params, build, |_, model, disk, sky_scale, build| {
            let calendar = Calendar::from_params(params, &build.shutter());
            let course = Course::passing(model, calendar, disk, sky_scale);
            if course.irradiance() == 0.0 && (sky_scale > 0.0 || disk.scale > 0.0) {
                note(params, "the sun never rises, so that this light is black");
            }
            if calendar.stands_still() {
                let message = "the sensor's shutter is open for no time (`shutter_open`, `shutter_close`), so that \
                               this sky stands still";
                note(params, message);
            }
            Some(course)
        })
    }

    /// Reads what does not depend on the course of the sun, which `course` makes, knowing the factor of the sky.
    fn with_course(
        params: &Params<'_>,
        build: &mut dyn Build,
        course: impl FnOnce(Option<Pose>, &HosekWilkie, &SunDisk, f32, &dyn Build) -> Option<Course>,
    ) -> Option<Self> {
        let scale = |name: &str| {
            let what = "a finite number not below 0";
            params.float_where(name, 1.0, what, |x| x >= 0.0 && x.is_finite()) as f32
        };
        let what = "a number from 1 to 10";
        let turbidity = params.float_where("turbidity", 3.0, what, |x| (1.0..=10.0).contains(&x));
        refuse_varying(params, "albedo", build);
        let albedo = build.texture(params, "albedo", Some(0.3), SpectrumKind::Reflectance);
        let what = "an angle above 0° and below 180°";
        let aperture = params.float_where("sun_aperture", 0.5358, what, |x| x > 0.0 && x < 180.0);
        let complex = params.boolean_or("complex_sun", false);
        let (sky_scale, sun_scale) = (scale("sky_scale"), scale("sun_scale"));
        let pose = Pose::from_params(params);
        let disk = SunDisk::new((aperture as f32).to_radians(), sun_scale, complex);
        let model = HosekWilkie::new(turbidity as f32);
        let course = course(pose, &model, &disk, sky_scale, build)?;
        Some(Self {
            pose: pose?,
            model: Arc::new(model),
            course: Arc::new(course),
            albedo,
            sky_scale,
            disk,
        })
    }

    #[inline]
    fn hour(&self, time: f32) -> Option<Hour<'_>> {
        self.course.hour(&self.model, time)
    }

    #[inline]
    fn is_in_sun(&self, hour: &Hour<'_>, local: Vec3) -> bool {
        // |a − b|² = 2 (1 − cos).
        local.z >= 0.0 && (local - hour.sun.n).length_squared() <= 2.0 * self.disk.one_minus_cos
    }

    /// Radiance from a direction in the light's space.
    fn radiance(
        &self,
        textures: &impl Textures,
        hour: &Hour<'_>,
        local: Vec3,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        if !(local.z >= 0.0) {
            return Vec4::ZERO;
        }
        let anywhere = TexturePoint::at_uv(Vec2::ZERO);
        let place = (wavelengths.lambda - FIRST) / STEP;
        let low = place
            .floor()
            .clamp(Vec4::ZERO, Vec4::splat((BANDS - 2) as f32));
        let gamma = angle_between(local, hour.sun.n);
        let in_sun = self.disk.scale > 0.0 && self.is_in_sun(hour, local);
        let knot = |offset: f32| {
            let at = (low + offset) * STEP + FIRST;
            let albedo = textures.spectrum(self.albedo, &anywhere, at).to_array();
            Vec4::from_array(std::array::from_fn(|lane| {
                let band = (low[lane] + offset) as usize;
                let mut value = 0.0;
                if self.sky_scale > 0.0 {
                    value += self.sky_scale * hour.radiance(band, local.z, gamma, albedo[lane]);
                }
                if in_sun {
                    value += self.disk.scale * self.sun_radiance(hour, band, local, gamma);
                }
                value
            }))
        };
        let value = knot(0.0) * (low + 1.0 - place) + knot(1.0) * (place - low);
        let inside = place.cmpge(Vec4::ZERO) & place.cmple(Vec4::splat((BANDS - 1) as f32));
        Vec4::select(inside, value.max(Vec4::ZERO), Vec4::ZERO)
    }

    fn sun_radiance(&self, hour: &Hour<'_>, band: usize, local: Vec3, gamma: f32) -> f32 {
        if !self.disk.complex {
            return hour.mean_sun(band);
        }
        let elevation = float::atan2(local.z, local.truncate().length());
        let share = (float::sin(gamma) / self.disk.sin_radius).min(1.0);
        self.model.sun(band, elevation, share)
    }

    /// A direction in the light's space.
    #[inline]
    fn choose(&self, hour: &Hour<'_>, u: Vec2) -> Option<Vec3> {
        let share = hour.guide.sun_share;
        if u.x < share {
            let cone = square_to_uniform_cone(Vec2::new(u.x / share, u.y), self.disk.one_minus_cos);
            return Some(hour.sun.to_world(cone).normalize());
        }
        let rest = (u.x - share) / (1.0 - share);
        hour.guide.choose(hour.turn, Vec2::new(rest, u.y))
    }

    /// The density of [`SunSky::choose`] per steradian.
    #[inline]
    fn density_of(&self, hour: &Hour<'_>, local: Vec3) -> f32 {
        if !(local.z >= 0.0) {
            return 0.0;
        }
        let sun = if self.is_in_sun(hour, local) {
            uniform_cone_density(self.disk.one_minus_cos)
        } else {
            0.0
        };
        let share = hour.guide.sun_share;
        share * sun + (1.0 - share) * hour.guide.density(hour.turn, local)
    }

    /// A direction in the light's space, its density and the radiance from there.
    #[inline]
    fn sampled(
        &self,
        textures: &impl Textures,
        wavelengths: &Wavelengths,
        u: Vec2,
        time: f32,
    ) -> Option<(Vec3, f32, Vec4)> {
        let hour = self.hour(time)?;
        let local = self.choose(&hour, u)?;
        let density = self.density_of(&hour, local);
        let radiance = || self.radiance(textures, &hour, local, wavelengths);
        (density > 0.0).then(|| (local, density, radiance()))
    }
}

/// A note at the light.
fn note(params: &Params<'_>, message: &str) {
    let note = Diagnostic::note(params.node.plugin.span, message);
    params.diagnostics.push(note);
}

impl LightModel for SunSky {
    fn is_infinite(&self) -> bool {
        true
    }

    fn is_background(&self) -> bool {
        true
    }

    fn emission_density(
        &self,
        _: &impl Shapes,
        bounds: &BoundingSphere,
        direction: Vec3,
        _cos: f32,
        time: f32,
    ) -> EmissionPdf {
        let local = self.pose.to_local(-direction);
        let hour = self.hour(time);
        EmissionPdf {
            origin: hour.map_or(0.0, |hour| self.density_of(&hour, local)),
            ray: bounds.ray_density(),
        }
    }

    fn background(
        &self,
        textures: &impl Textures,
        direction: Vec3,
        time: f32,
        at: &Wavelengths,
    ) -> Vec4 {
        let local = self.pose.to_local(direction);
        let radiance = |hour: Hour<'_>| self.radiance(textures, &hour, local, at);
        self.hour(time).map_or(Vec4::ZERO, radiance)
    }

    fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        let local = self.pose.to_local(direction);
        let density = |hour: Hour<'_>| Density::uniform(self.density_of(&hour, local));
        self.hour(from.time).map_or(Density::ZERO, density)
    }

    fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let (local, density, radiance) = self.sampled(scene, wavelengths, u, from.time)?;
        let direction = self.pose.to_world(local);
        Some(sky::sample(direction, radiance, Density::uniform(density)))
    }

    fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let (local, density, radiance) = self.sampled(scene, wavelengths, u_direction, time)?;
        let toward = self.pose.to_world(local);
        Some(sky::emit(bounds, toward, u_position, radiance, density))
    }

    fn power(&self, _: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        bounds.cross_section() * self.course.irradiance()
    }
}
