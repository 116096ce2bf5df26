//! The world of parallel planes.

use crate::camera_1d::Camera1D;
use crate::scatter::{Scatter, tilt};
use etalon_math::{Density, Frame, SolidAngle, float};
use etalon_spectrum::{SensorWeights, WavelengthDistribution, Wavelengths, sensor_response};
use etalon_transport::*;
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

/// A function of wavelength (nm).
pub(crate) type Curve = fn(f32) -> f32;

/// The curve that is zero.
pub(crate) const ZERO: Curve = |_| 0.0;

/// An infinite plane, the same seen from above and from below unless it says otherwise.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    pub height: f32,
    /// Fraction of light that passes straight.
    pub passing: Curve,
    /// Fraction of the rest that is reflected.
    pub reflectance: Curve,
    /// Exponent n of the lobe (n + 1) cosⁿθ / 2π about the normal; 1 is a Lambertian surface.
    pub exponent: Curve,
    /// Share of reflection that goes into one discrete direction, which turns with wavelength.
    pub smooth: f32,
    /// Radiance emitted downward and upward.
    pub emission: [Curve; 2],
}

impl Plane {
    /// A grey Lambertian reflector.
    pub(crate) const WHITE: Self = Self {
        height: 0.0,
        passing: ZERO,
        reflectance: |_| 0.8,
        exponent: |_| 1.0,
        smooth: 0.0,
        emission: [ZERO; 2],
    };

    /// A black plane.
    pub(crate) const BLACK: Self = Self {
        reflectance: ZERO,
        ..Self::WHITE
    };

    fn emits(&self) -> bool {
        self.emission.iter().any(|e| e(550.0) > 0.0)
    }
}

/// What is deliberately wrong with a world, to show that tests would notice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    None,
    /// Lobes report half of the density for the lanes that did not choose.
    OtherLanes,
    /// A discrete direction claims that every lane could have chosen it.
    AtomForAll,
    /// Shadow rays forget with what probability scattering passes.
    FreePassage,
    /// The density of a light forgets the choice among lights.
    LightChoice,
    /// The first lane always chooses.
    FirstLane,
}

/// A stack of planes, from low to high, with a sky above and below.
pub(crate) struct Stack {
    pub planes: Vec<Plane>,
    /// Radiance of the background.
    pub sky: Curve,
    /// The background's radiance falls off with the power of the cosine to the vertical.
    pub sky_power: f32,
    /// Where the camera is, and whether it looks up.
    pub camera: Camera1D,
    /// If given, the moment of every sample.
    pub row_moment: Option<f32>,
    /// If given, every path carries a rotation of these wavelengths.
    pub fixed: Option<Wavelengths>,
    pub fault: Fault,
    /// Whether scattering models say that they scatter to one side only.
    pub one_sided: bool,
    pub distribution: WavelengthDistribution,
}

fn curve(f: Curve, lambda: Vec4) -> Vec4 {
    Vec4::from_array(lambda.to_array().map(f))
}

impl Stack {
    /// A world without fault, seen by a camera at `height`.
    pub(crate) fn new(planes: Vec<Plane>, sky: Curve, height: f32, up: bool) -> Self {
        Self {
            planes,
            sky,
            sky_power: 0.0,
            camera: Camera1D {
                height,
                up,
                sees_after: 0.0,
            },
            row_moment: None,
            fixed: None,
            fault: Fault::None,
            one_sided: true,
            distribution: WavelengthDistribution::default(),
        }
    }

    /// The same world with a fault.
    pub(crate) fn with(mut self, fault: Fault) -> Self {
        self.fault = fault;
        self
    }

    /// Lights: the planes that emit, and the sky.
    fn light_total(&self) -> usize {
        self.planes.iter().filter(|p| p.emits()).count() + usize::from(self.has_background())
    }

    /// Directions toward a light are uniform over a hemisphere; the sky has two.
    fn hemisphere_density(&self) -> f32 {
        let choice = match self.fault {
            Fault::LightChoice => 1.0,
            _ => self.light_total() as f32,
        };
        1.0 / (2.0 * PI * choice)
    }
}

impl Surfaces for Stack {
    type Bsdf<'w> = Scatter;

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = |(i, plane): (usize, &Plane)| {
            let t = (plane.height - ray.origin.z) / ray.direction.z;
            (t > 1e-3 && t < ray.t_max).then_some((t, i))
        };
        let nearest = self.planes.iter().enumerate().filter_map(hit);
        let (t, i) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Hit {
            t,
            parameters: Vec2::ZERO,
            shape: ShapeId(i as u32),
            primitive: 0,
            instance: InstanceId::NONE,
            slot: 0,
        })
    }
    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.intersect(ray);
        }
    }
    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let plane = &self.planes[hit.shape.0 as usize];
        // Paths are confined to the axis, or they would lose precision far away from it; nothing
        // in this world depends on where on a plane they are.
        SurfaceInteraction {
            position: Vec3::Z * plane.height,
            error: Vec3::ZERO,
            depth: f32::NAN,
            normal: Vec3::Z,
            shading: Frame::from_normal(Vec3::Z),
            uv: Vec2::ZERO,
            dp_du: Vec3::X,
            dp_dv: Vec3::Y,
            t: hit.t,
            time: ray.time,
            parameters: Vec2::ZERO,
            shape: hit.shape,
            primitive: 0,
            instance: InstanceId::NONE,
            material: MaterialId(hit.shape.0),
            light: match plane.emits() {
                true => LightId(hit.shape.0),
                false => LightId::NONE,
            },
            media: etalon_transport::MediumInterface::NONE,
        }
    }
    fn bsdf(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Scatter {
        let plane = &self.planes[vertex.shape.0 as usize];
        let lambda = wavelengths.lambda;
        let passing = curve(plane.passing, lambda);
        let reflected = curve(plane.reflectance, lambda) * (1.0 - passing);
        Scatter {
            passing,
            lobe: reflected * (1.0 - plane.smooth),
            atom: reflected * plane.smooth,
            exponent: curve(plane.exponent, lambda),
            share: plane.smooth,
            normal: Vec3::Z * wo.z.signum(),
            tilt: lambda.map(tilt),
            fault: self.fault,
            one_sided: self.one_sided,
        }
    }
    fn legacy_phong(
        &self,
        _: &SurfaceInteraction,
        _: Vec3,
        _: &Wavelengths,
    ) -> Option<LegacyPhong> {
        None
    }
    fn take_ray_count(&self) -> u64 {
        0
    }
}

impl Lights for Stack {
    fn count(&self) -> u32 {
        self.light_total() as u32
    }
    fn is_emitter(&self, hit: &Hit) -> bool {
        self.planes[hit.shape.0 as usize].emits()
    }
    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let plane = &self.planes[vertex.shape.0 as usize];
        curve(plane.emission[usize::from(wo.z > 0.0)], wavelengths.lambda)
    }
    fn has_background(&self) -> bool {
        (self.sky)(550.0) > 0.0
    }
    fn background(&self, direction: Vec3, _: f32, wavelengths: &Wavelengths) -> Vec4 {
        curve(self.sky, wavelengths.lambda) * float::pow(direction.z.abs(), self.sky_power)
    }
    fn sample_one(
        &self,
        light: LightId,
        from: &LightSampleContext,
        w: &Wavelengths,
        v: Vec2,
    ) -> Option<LightSample> {
        let lights = self.light_total() as f32;
        let sample = self.sample_light(from, w, (light.0 as f32 + 0.5) / lights, v)?;
        let density = sample.chance.lanes() * lights;
        Some(LightSample {
            chance: SamplePdf::Continuous(Density::per_lane(density)),
            ..sample
        })
    }
}

impl Sensor for Stack {
    fn wavelengths(&self, u: f32) -> Wavelengths {
        match self.fixed {
            None => Wavelengths::sample(&self.distribution, u),
            Some(fixed) if self.fault == Fault::FirstLane => fixed,
            Some(fixed) => fixed.rotated((u * 4.0) as usize),
        }
    }
    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        sensor_response(wavelengths)
    }
}

impl World for Stack {
    type Surfaces = Self;
    type Lights = Self;
    type Media = NoMedia;
    type Camera = Camera1D;
    type Sensor = Self;
    type Lanes = NoLanes;
    fn lanes(&self) -> Option<&NoLanes> {
        None
    }
    fn surfaces(&self) -> &Self {
        self
    }
    fn lights(&self) -> &Self {
        self
    }
    fn media(&self) -> &NoMedia {
        &NoMedia
    }
    fn camera(&self) -> &Camera1D {
        &self.camera
    }
    fn sensor(&self) -> &Self {
        self
    }
    fn moment(&self, _: Vec2, u: f32) -> f32 {
        self.row_moment.unwrap_or(u)
    }
    fn exposure(&self, _: Vec2, _: f32) -> f32 {
        1.0
    }
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission> {
        let mut transmission = Transmission::FREE;
        let between = |plane: &&Plane| {
            let t = (plane.height - ray.origin.z) / ray.direction.z;
            t > 1e-3 && t < ray.t_max * 0.999
        };
        for (count, plane) in self.planes.iter().filter(between).enumerate() {
            let passing = curve(plane.passing, wavelengths.lambda);
            transmission.transmittance *= passing;
            transmission.probability *= passing;
            if count as u32 >= crossings || transmission.transmittance == Vec4::ZERO {
                return None;
            }
        }
        if self.fault == Fault::FreePassage {
            transmission.probability = Vec4::ONE;
        }
        Some(transmission)
    }
    fn transmittance_batch(
        &self,
        queries: &[ShadowQuery],
        transmissions: &mut [Option<Transmission>],
    ) {
        for (query, transmission) in queries.iter().zip(transmissions) {
            *transmission = self.transmittance(&query.ray, &query.wavelengths, query.crossings);
        }
    }
    fn sample_light(
        &self,
        from: &LightSampleContext,
        w: &Wavelengths,
        u: f32,
        v: Vec2,
    ) -> Option<LightSample> {
        let lights = self.light_total();
        let choice = ((u * lights as f32) as usize).min(lights.checked_sub(1)?);
        let mut emitting = self.planes.iter().enumerate().filter(|(_, p)| p.emits());
        let uniform = |density: f32| SamplePdf::Continuous(Density::uniform(density));
        let on_sphere = |z: f32| {
            let (y, x) = float::sin_cos(2.0 * PI * v.y);
            let r = (1.0 - z * z).max(0.0).sqrt();
            Vec3::new(x * r, y * r, z)
        };
        let Some((index, plane)) = emitting.nth(choice) else {
            let direction = on_sphere(2.0 * v.x - 1.0);
            return Some(LightSample {
                direction,
                target: None,
                radiance: self.background(direction, 0.0, w),
                chance: uniform(self.hemisphere_density() * 0.5),
                cos: 1.0,
                origin: LightKind::Sky,
                extinction: Vec4::ONE,
                light: LightId(u32::MAX - 1),
            });
        };
        let rise = plane.height - from.position.z;
        if rise == 0.0 {
            return None;
        }
        let direction = on_sphere((1.0 - v.x) * rise.signum());
        Some(LightSample {
            direction,
            target: Some(from.position + direction * (rise / direction.z)),
            radiance: curve(plane.emission[usize::from(direction.z < 0.0)], w.lambda),
            chance: uniform(self.hemisphere_density()),
            cos: direction.z.abs(),
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId(index as u32),
        })
    }
    fn light_variety(&self, _: &LightSampleContext) -> LightVariety {
        LightVariety::Several
    }
    fn light_density(
        &self,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
        _: Vec3,
    ) -> Density<SolidAngle> {
        let there = from.position.z != at.position.z && at.light.is_some();
        Density::uniform(match there {
            true => self.hemisphere_density(),
            false => 0.0,
        })
    }
    fn background_density(&self, _: &LightSampleContext, _: Vec3) -> Density<SolidAngle> {
        Density::uniform(self.hemisphere_density() * 0.5)
    }
    fn emit(&self, _: &Wavelengths, _: f32, _: Vec2, _: Vec2, _: f32) -> Option<Emission> {
        None
    }
    fn emission_density(&self, _: LightId, _: Vec3, _: f32, _: f32) -> EmissionPdf {
        EmissionPdf::ZERO
    }
    fn background_emission_density(&self, _: Vec3, _: f32) -> EmissionPdf {
        EmissionPdf::ZERO
    }
    fn light_sample_density(&self, _: &LightSampleContext, _: &Emission) -> f32 {
        0.0
    }
    fn medium_light_density(&self, _: MediumId, _: Vec3) -> f32 {
        0.0
    }
}
