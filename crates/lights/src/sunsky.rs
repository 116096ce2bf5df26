//! `sunsky`: the clear sky of Hošek and Wilkie with the sun in it (see `sky/hosek_wilkie.rs`).
//!
//! The zenith is the light's +z. Radiance is interpolated linearly between the model's wavelengths and zero beyond
//! them, 320 to 720 nm, and below the horizon. The sun is a disk of mean radiance or, with `complex_sun`, darkens toward
//! its limb and toward the horizon; with another `sun_aperture` it keeps its irradiance. Directions are chosen in the
//! cone of the sun, uniformly, or by a table of the sky's brightness over φ/2π and 2θ/π, bilinear, with
//! dω = π² sin θ du dv.

use crate::light_model::LightModel;
use crate::pose::Pose;
use crate::sky::hosek_wilkie::{self, BANDS, FIRST, HosekWilkie, STEP, SUN_RADIUS};
use crate::sky::sun_position::Moment;
use crate::{BoundingSphere, sky};
use core::f32::consts::{FRAC_PI_2, PI, TAU};
use etalon_math::{Density, Frame, SolidAngle, float};
use etalon_params::{Diagnostic, Params};
use etalon_sampling::discrete::Bilinear;
use etalon_sampling::warps::{square_to_uniform_cone, uniform_cone_density};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, Shapes, SpectrumKind, TextureId,
    TexturePoint, Textures, refuse_varying,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Columns and rows of the table of brightness.
const COLUMNS: usize = 128;
const ROWS: usize = 64;

/// Share of the table that is the sky's mean, so that it is zero nowhere.
const FLOOR: f32 = 0.05;

/// Bounds of the share of samples that the sun has, if there are sun and sky.
const SHARE: [f32; 2] = [0.1, 0.7];

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
    table: Option<Arc<Bilinear>>,
    albedo: TextureId,
    sky_scale: f32,
    /// Factor of the sun's radiance; its aperture is in it.
    sun_scale: f32,
    /// Toward the sun, in the light's space.
    sun: Frame,
    /// Half of its aperture: 1 − cos, and sine.
    one_minus_cos: f32,
    sin_radius: f32,
    complex: bool,
    /// Whether the sun is above the horizon.
    day: bool,
    /// The share of samples that the sun has.
    sun_share: f32,
    /// ∫L dω, the mean over the wavelengths of the model.
    irradiance: f64,
}

impl SunSky {
    /// Reads `turbidity` (3), `albedo` (0.3), `sun_direction` or a moment (`latitude` to `second`), `sun_scale`, `sky_scale` (1),
    /// `sun_aperture` (0.5358°), `complex_sun` (false) and `to_world`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
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
            let message = "the sun is below the horizon, so that this light is black";
            let diagnostic = Diagnostic::note(params.node.plugin.span, message);
            (params.diagnostics).push(diagnostic);
        }
        let radius = 0.5 * (aperture as f32).to_radians();
        let scales = [sky_scale, sun_scale];
        Some(Self::new(
            pose?,
            turbidity as f32,
            albedo,
            sun,
            radius,
            scales,
            complex,
        ))
    }

    fn new(
        pose: Pose,
        turbidity: f32,
        albedo: TextureId,
        sun: Vec3,
        radius: f32,
        [sky_scale, sun_scale]: [f32; 2],
        complex: bool,
    ) -> Self {
        let one_minus_cos = |radius: f32| {
            let half = float::sin(0.5 * radius);
            2.0 * half * half
        };
        let ratio = one_minus_cos(SUN_RADIUS) / one_minus_cos(radius);
        let theta = float::atan2(sun.truncate().length(), sun.z);
        let model = HosekWilkie::new(turbidity, theta.min(FRAC_PI_2));
        let mut light = Self {
            pose,
            albedo,
            sky_scale,
            sun_scale: sun_scale * ratio,
            sun: Frame::from_normal(sun),
            one_minus_cos: one_minus_cos(radius),
            sin_radius: float::sin(radius),
            complex,
            day: sun.z >= 0.0,
            sun_share: 0.0,
            irradiance: 0.0,
            table: None,
            model: Arc::new(model),
        };
        if light.day {
            light.tabulate();
        }
        light
    }

    /// The table, and the shares of sun and sky; for these the ground has an albedo of 0.3.
    fn tabulate(&mut self) {
        let bands = 1..BANDS;
        let mean =
            |at: &dyn Fn(usize) -> f32| bands.clone().map(at).sum::<f32>() / bands.len() as f32;
        let mut nodes = Vec::with_capacity((COLUMNS + 1) * ROWS);
        let mut sky = 0.0;
        for row in 0..ROWS {
            let theta = FRAC_PI_2 * row as f32 / (ROWS - 1) as f32;
            let edge = if row == 0 || row == ROWS - 1 {
                0.5
            } else {
                1.0
            };
            for column in 0..=COLUMNS {
                let phi = TAU * column as f32 / COLUMNS as f32;
                let toward = hosek_wilkie::direction(theta, phi);
                let gamma = self.angle_to_sun(toward);
                let bright = mean(&|band| self.model.sky(band, toward.z.max(0.0), gamma, 0.3));
                // Not quite zero at the zenith, where a cell is a wedge.
                let sine = float::sin(theta).max(0.2 * FRAC_PI_2 / (ROWS - 1) as f32);
                nodes.push(bright * sine);
                if column < COLUMNS {
                    sky += f64::from(bright * float::sin(theta) * edge);
                }
            }
        }
        sky *= f64::from(PI * PI) / (COLUMNS * (ROWS - 1)) as f64 * f64::from(self.sky_scale);
        let floor = FLOOR * nodes.iter().sum::<f32>() / nodes.len() as f32;
        for node in &mut nodes {
            *node += floor;
        }
        let solid = TAU * self.one_minus_cos;
        let disk = mean(&|band| self.model.mean_sun(band)) * solid * self.sun_scale;
        self.irradiance = sky + f64::from(disk);
        self.table = Bilinear::new(&nodes, COLUMNS + 1).ok().map(Arc::new);
        let share = (f64::from(disk) / self.irradiance.max(f64::MIN_POSITIVE)) as f32;
        self.sun_share = match (sky > 0.0, disk > 0.0) {
            (true, true) => share.clamp(SHARE[0], SHARE[1]),
            (_, sun) => f32::from(u8::from(sun)),
        };
    }

    /// The angle between two unit vectors, exact where it is small.
    #[inline]
    fn angle_to_sun(&self, local: Vec3) -> f32 {
        2.0 * float::asin((0.5 * (local - self.sun.n).length()).min(1.0))
    }

    #[inline]
    fn is_in_sun(&self, local: Vec3) -> bool {
        // |a − b|² = 2 (1 − cos).
        local.z >= 0.0 && (local - self.sun.n).length_squared() <= 2.0 * self.one_minus_cos
    }

    /// Radiance from a direction in the light's space.
    fn radiance(&self, textures: &impl Textures, local: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        if !(self.day && local.z >= 0.0) {
            return Vec4::ZERO;
        }
        let anywhere = TexturePoint::at_uv(Vec2::ZERO);
        let place = (wavelengths.lambda - FIRST) / STEP;
        let low = place
            .floor()
            .clamp(Vec4::ZERO, Vec4::splat((BANDS - 2) as f32));
        let gamma = self.angle_to_sun(local);
        let in_sun = self.sun_scale > 0.0 && self.is_in_sun(local);
        let knot = |offset: f32| {
            let at = (low + offset) * STEP + FIRST;
            let albedo = textures.spectrum(self.albedo, &anywhere, at).to_array();
            Vec4::from_array(std::array::from_fn(|lane| {
                let band = (low[lane] + offset) as usize;
                let mut value = 0.0;
                if self.sky_scale > 0.0 {
                    value += self.sky_scale * self.model.sky(band, local.z, gamma, albedo[lane]);
                }
                if in_sun {
                    value += self.sun_scale * self.sun_radiance(band, local, gamma);
                }
                value
            }))
        };
        let value = knot(0.0) * (low + 1.0 - place) + knot(1.0) * (place - low);
        let inside = place.cmpge(Vec4::ZERO) & place.cmple(Vec4::splat((BANDS - 1) as f32));
        Vec4::select(inside, value.max(Vec4::ZERO), Vec4::ZERO)
    }

    fn sun_radiance(&self, band: usize, local: Vec3, gamma: f32) -> f32 {
        if !self.complex {
            return self.model.mean_sun(band);
        }
        let elevation = float::atan2(local.z, local.truncate().length());
        let share = (float::sin(gamma) / self.sin_radius).min(1.0);
        self.model.sun(band, elevation, share)
    }

    /// A direction in the light's space.
    #[inline]
    fn choose(&self, u: Vec2) -> Option<Vec3> {
        let table = self.table.as_deref()?;
        if u.x < self.sun_share {
            let cone =
                square_to_uniform_cone(Vec2::new(u.x / self.sun_share, u.y), self.one_minus_cos);
            return Some(self.sun.to_world(cone).normalize());
        }
        let rest = (u.x - self.sun_share) / (1.0 - self.sun_share);
        let place = table.sample(Vec2::new(rest, u.y));
        Some(hosek_wilkie::direction(FRAC_PI_2 * place.y, TAU * place.x))
    }

    /// The density of [`SunSky::choose`] per steradian.
    #[inline]
    fn density_of(&self, local: Vec3) -> f32 {
        let Some(table) = self.table.as_deref().filter(|_| local.z >= 0.0) else {
            return 0.0;
        };
        let sine = local.truncate().length();
        let turn = float::atan2(local.y, local.x) / TAU;
        let place = Vec2::new(turn - turn.floor(), float::atan2(sine, local.z) / FRAC_PI_2);
        let sky = table.density(place) / (PI * PI * sine.max(1e-6));
        let sun = if self.is_in_sun(local) {
            uniform_cone_density(self.one_minus_cos)
        } else {
            0.0
        };
        self.sun_share * sun + (1.0 - self.sun_share) * sky
    }
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
        _time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: self.density_of(self.pose.to_local(-direction)),
            ray: bounds.ray_density(),
        }
    }

    fn background(&self, textures: &impl Textures, direction: Vec3, at: &Wavelengths) -> Vec4 {
        self.radiance(textures, self.pose.to_local(direction), at)
    }

    fn background_density(&self, _: &LightSampleContext, direction: Vec3) -> Density<SolidAngle> {
        Density::uniform(self.density_of(self.pose.to_local(direction)))
    }

    fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        _: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let local = self.choose(u)?;
        let density = self.density_of(local);
        (density > 0.0).then(|| {
            let radiance = self.radiance(scene, local, wavelengths);
            sky::sample(
                self.pose.to_world(local),
                radiance,
                Density::uniform(density),
            )
        })
    }

    fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        _time: f32,
    ) -> Option<Emission> {
        let local = self.choose(u_direction)?;
        let density = self.density_of(local);
        (density > 0.0).then(|| {
            let radiance = self.radiance(scene, local, wavelengths);
            sky::emit(
                bounds,
                self.pose.to_world(local),
                u_position,
                radiance,
                density,
            )
        })
    }

    fn power(&self, _: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        bounds.cross_section() * self.irradiance
    }
}
