//! `projector`: a picture thrown from a point, as a perspective camera would see it.
//!
//! ```text
//! I(x, y, 1) = π s E(u, v) / cos³θ         u = ½ − x / (2 t),   v = ½ − a y / (2 t)
//! ```
//!
//! along the direction (x, y, 1) of the light's space, at the angle θ from its axis: on the plane z = 1 a picture that is 1 everywhere makes the
//! same irradiance everywhere. t is the tangent of half the horizontal field of view, a the picture's width over its height, s a scale.
//! The counterpart of Mitsuba's perspective camera (Mitsuba 3, `projector`). Φ = 4π s Ē t² / a.
//!
//! With the `profile` `intensity` the picture is the intensity itself, as of pbrt-v4's projection light: I = s E(u, v). Then Φ is s Ē times the solid angle of
//! the picture, up to how the mean Ē differs from one over directions.

use crate::light::extent_of_cone;
use crate::light_model::LightModel;
use crate::pose::{Pose, emit_from_point, extent_of_way, sample_point};
use crate::{BoundingSphere, LightExtent};
use core::f32::consts::PI;
use etalon_math::{Animated, float64};
use etalon_params::Params;
use etalon_params::field_of_view::half_width_from_params;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, Shapes, SpectrumKind, TextureId,
    TexturePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A projector.
#[derive(Clone, Debug, PartialEq)]
pub struct Projector {
    pose: Animated<Pose>,
    /// E.
    picture: TextureId,
    /// s.
    scale: f32,
    /// Half the size of the picture on the plane z = 1.
    half: Vec2,
    /// Whether the picture is the intensity, not the irradiance on the plane.
    of_intensity: bool,
}

impl Projector {
    /// Reads `irradiance` (1), `scale` (1), `profile` (`irradiance`), `fov`, `fov_axis` or `focal_length` (50mm), and `to_world`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let picture = build.texture(params, "irradiance", Some(1.0), SpectrumKind::Emission);
        let what = "a finite number not below 0";
        let scale = params.float_where("scale", 1.0, what, |s| s >= 0.0 && s.is_finite());
        let [width, height] = build.resolution(picture).map(f64::from);
        let aspect = width / height;
        let half = half_width_from_params(params, aspect);
        let profiles = ["irradiance", "intensity"];
        let profile = params.choice("profile", profiles[0], &profiles);
        Some(Self {
            pose: Pose::animated(params, build)?,
            picture,
            scale: scale as f32,
            half: Vec2::new(half as f32, (half / aspect) as f32),
            of_intensity: profile == profiles[1],
        })
    }

    /// Intersection of a unit direction of the light's space with the plane z = 1, if within the picture.
    #[inline]
    fn on_plane(&self, local: Vec3) -> Option<Vec2> {
        let at = local.truncate() / local.z;
        (local.z > 0.0 && at.abs().cmple(self.half).all()).then_some(at)
    }

    /// Intensity (W·sr⁻¹·nm⁻¹) along a unit direction of the light's space.
    #[inline]
    fn intensity(&self, textures: &impl Textures, local: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let Some(at) = self.on_plane(local) else {
            return Vec4::ZERO;
        };
        let place = TexturePoint::at_uv(0.5 - 0.5 * at / self.half);
        let picture = textures.spectrum(self.picture, &place, wavelengths.lambda);
        let unit = if self.of_intensity {
            1.0
        } else {
            PI / local.z.powi(3)
        };
        picture * (self.scale * unit)
    }

    /// Density of directions that are uniform on the plane (sr⁻¹).
    #[inline]
    fn density(&self, local: Vec3) -> f32 {
        let area = 4.0 * self.half.x * self.half.y;
        (self.on_plane(local)).map_or(0.0, |_| 1.0 / (area * local.z.powi(3)))
    }
}

impl LightModel for Projector {
    #[inline]
    fn is_even(&self, _: &LightSampleContext) -> bool {
        true
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        _: &BoundingSphere,
        direction: Vec3,
        _cos: f32,
        time: f32,
    ) -> EmissionPdf {
        let local = self.pose.at(time, |pose| pose.to_local(direction));
        EmissionPdf {
            origin: 1.0,
            ray: self.density(local),
        }
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        sample_point(&self.pose, from, |local| {
            self.intensity(textures, local, wavelengths)
        })
    }

    #[inline]
    fn emit(
        &self,
        textures: &(impl Textures + Shapes),
        _: &BoundingSphere,
        wavelengths: &Wavelengths,
        _: Vec2,
        u: Vec2,
        time: f32,
    ) -> Option<Emission> {
        // Rounding must not put a border outside.
        let at = self.half * (2.0 * u - 1.0) * (1.0 - 4.0 * f32::EPSILON);
        let local = at.extend(1.0).normalize();
        let intensity = self.intensity(textures, local, wavelengths);
        let density = self.density(local);
        (density > 0.0).then(|| emit_from_point(&self.pose, local, intensity, density, time))
    }

    fn power(&self, textures: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        let [x, y] = [self.half.x, self.half.y].map(f64::from);
        let unit = match self.of_intensity {
            // Solid angle of a rectangle seen from a point before its middle.
            true => 4.0 * float64::asin(x * y / ((1.0 + x * x) * (1.0 + y * y)).sqrt()),
            false => 4.0 * core::f64::consts::PI * x * y,
        };
        unit * f64::from(textures.mean(self.picture) * self.scale)
    }

    fn extent(&self, _: &impl Shapes) -> Option<LightExtent> {
        let cos_corner = 1.0 / (1.0 + self.half.length_squared()).sqrt();
        let still = extent_of_cone(self.pose.start(), cos_corner);
        Some(extent_of_way(&self.pose, still))
    }
}
