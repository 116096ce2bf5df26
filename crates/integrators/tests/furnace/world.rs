//! The sphere: a world without scene, materials and shapes.

use crate::pinhole::Pinhole;
use etalon_math::{Area, Density, Frame, SolidAngle};
use etalon_spectrum::{SensorWeights, WavelengthDistribution, Wavelengths, sensor_response};
use etalon_transport::*;
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

/// What is deliberately wrong with the world, to show that the tests would notice.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    None,
    /// The light's density is reported too high by a tenth.
    LightDensity,
    /// Scattering forgets its cosine in the density.
    ScatteringDensity,
    /// Emission is 2 % too strong.
    Emission,
    /// The camera's importance forgets a cosine.
    Importance,
}

pub(crate) struct Sphere {
    pub(crate) reflectance: f32,
    pub(crate) fault: Fault,
    pub(crate) distribution: WavelengthDistribution,
    pub(crate) camera: Pinhole,
}

#[derive(Clone, Copy)]
pub(crate) struct Lambert {
    reflectance: f32,
    normal: Vec3,
    fault: Fault,
}

impl Bsdf for Lambert {
    fn eval(&self, _: Vec3, wi: Vec3, _: TransportMode) -> Vec4 {
        Vec4::splat(self.reflectance / PI * self.normal.dot(wi).max(0.0))
    }
    fn density(&self, _: Vec3, wi: Vec3) -> Density<SolidAngle> {
        let cos = self.normal.dot(wi).max(0.0);
        Density::uniform(if self.fault == Fault::ScatteringDensity {
            1.0 / PI
        } else {
            cos / PI
        })
    }
    fn sample(&self, wo: Vec3, _: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let (r, phi) = (u.x.sqrt(), 2.0 * PI * u.y);
        let (sin, cos) = etalon_math::float::sin_cos(phi);
        let local = Vec3::new(r * cos, r * sin, (1.0 - u.x).sqrt());
        let wi = Frame::from_normal(self.normal).to_world(local);
        let density = self.density(wo, wi);
        (density.hero() > 0.0).then(|| BsdfSample {
            wi,
            value: self.eval(wo, wi, mode),
            chance: SamplePdf::Continuous(density),
            eta: 1.0,
            is_null: false,
        })
    }
    fn has_continuous(&self) -> bool {
        true
    }
    fn null_transmittance(&self) -> Vec4 {
        Vec4::ZERO
    }
    fn null_probability(&self) -> Vec4 {
        Vec4::ZERO
    }
    fn albedo(&self, _: Vec3) -> Vec4 {
        Vec4::splat(self.reflectance)
    }
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        (self.eval(wo, wi, mode), self.density(wo, wi))
    }
    fn discrete(&self, _: Vec3, _: u32, _: TransportMode) -> Option<BsdfSample> {
        None
    }
    fn has_discrete(&self) -> bool {
        false
    }
    fn hemisphere(&self) -> Option<Frame> {
        None
    }
    fn projected_area(&self, _: Vec3) -> f32 {
        1.0
    }
}

fn on_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = etalon_math::float::sin_cos(2.0 * PI * u.y);
    Vec3::new(r * cos, r * sin, z)
}

impl Sphere {
    pub(crate) fn new(reflectance: f32, fault: Fault) -> Self {
        Self {
            reflectance,
            fault,
            distribution: WavelengthDistribution::default(),
            camera: Pinhole { fault },
        }
    }

    fn area_density(&self) -> f32 {
        let factor = if self.fault == Fault::LightDensity {
            1.1
        } else {
            1.0
        };
        factor / (4.0 * PI)
    }

    fn radiance(&self) -> f32 {
        if self.fault == Fault::Emission {
            1.02
        } else {
            1.0
        }
    }
}

impl Surfaces for Sphere {
    type Bsdf<'w> = Lambert;

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let b = ray.origin.dot(ray.direction);
        let t = -b + (b * b + 1.0 - ray.origin.length_squared()).max(0.0).sqrt();
        (t > 1e-4 && t < ray.t_max).then_some(Hit {
            t,
            parameters: Vec2::ZERO,
            shape: ShapeId(0),
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
        let normal = -ray.at(hit.t).normalize();
        SurfaceInteraction {
            position: -normal,
            error: Vec3::splat(1e-6),
            depth: f32::NAN,
            normal,
            shading: Frame::from_normal(normal),
            uv: Vec2::ZERO,
            dp_du: Vec3::ZERO,
            dp_dv: Vec3::ZERO,
            t: hit.t,
            time: 0.0,
            parameters: Vec2::ZERO,
            shape: ShapeId(0),
            primitive: 0,
            instance: InstanceId::NONE,
            material: MaterialId(0),
            light: LightId(0),
            media: etalon_transport::MediumInterface::NONE,
        }
    }
    fn bsdf(&self, vertex: &SurfaceInteraction, _: Vec3, _: &Wavelengths) -> Lambert {
        Lambert {
            reflectance: self.reflectance,
            normal: vertex.normal,
            fault: self.fault,
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

impl Lights for Sphere {
    fn count(&self) -> u32 {
        1
    }
    fn is_emitter(&self, _: &Hit) -> bool {
        true
    }
    fn emitted(&self, _: &SurfaceInteraction, _: Vec3, _: &Wavelengths) -> Vec4 {
        Vec4::splat(self.radiance())
    }
    fn has_background(&self) -> bool {
        false
    }
    fn background(&self, _: Vec3, _: f32, _: &Wavelengths) -> Vec4 {
        Vec4::ZERO
    }
    fn sample_one(
        &self,
        _: LightId,
        from: &LightSampleContext,
        w: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        self.sample_light(from, w, 0.0, u)
    }
}

impl Sensor for Sphere {
    fn wavelengths(&self, u: f32) -> Wavelengths {
        Wavelengths::sample(&self.distribution, u)
    }
    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        sensor_response(wavelengths)
    }
}

impl World for Sphere {
    type Surfaces = Self;
    type Lights = Self;
    type Media = NoMedia;
    type Camera = Pinhole;
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
    fn camera(&self) -> &Pinhole {
        &self.camera
    }
    fn sensor(&self) -> &Self {
        self
    }
    fn moment(&self, _: Vec2, u: f32) -> f32 {
        u
    }
    fn exposure(&self, _: Vec2, _: f32) -> f32 {
        1.0
    }
    fn transmittance(&self, _: &Ray, _: &Wavelengths, _: u32) -> Option<Transmission> {
        Some(Transmission::FREE)
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
        _: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let target = on_sphere(u);
        let d = target - from.position;
        let direction = d.try_normalize()?;
        let at = self.vertex(
            &Ray::new(target, Vec3::X, 0.0),
            &Hit {
                t: 0.0,
                ..self.intersect(&Ray::new(Vec3::ZERO, target, 0.0))?
            },
        );
        Some(LightSample {
            direction,
            target: Some(target),
            radiance: Vec4::splat(self.radiance()),
            chance: SamplePdf::Continuous(self.light_density(from, &at, direction)),
            cos: -at.normal.dot(direction),
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId(0),
        })
        .filter(|_| w.lambda.x > 0.0)
    }
    fn light_variety(&self, _: &LightSampleContext) -> LightVariety {
        LightVariety::Several
    }
    fn light_density(
        &self,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        let distance_squared = (at.position - from.position).length_squared();
        Density::<Area>::uniform(self.area_density())
            .to_solid_angle(distance_squared, at.normal.dot(direction))
    }
    fn background_density(&self, _: &LightSampleContext, _: Vec3) -> Density<SolidAngle> {
        Density::ZERO
    }
    fn emit(&self, _: &Wavelengths, _: f32, p: Vec2, d: Vec2, _: f32) -> Option<Emission> {
        let origin = on_sphere(p);
        let lambert = Lambert {
            reflectance: 1.0,
            normal: -origin,
            fault: Fault::None,
        };
        let sample = lambert.sample(-origin, 0.0, d, TransportMode::Importance)?;
        Some(Emission {
            ray: Ray::new(origin * (1.0 - 1e-6), sample.wi, 0.0),
            point: SurfacePoint {
                position: origin,
                error: Vec3::ZERO,
                normal: -origin,
                texture: TexturePoint::at_uv(Vec2::ZERO),
            },
            weight: Vec4::splat(self.radiance() * PI / self.area_density()),
            density: EmissionPdf {
                origin: self.area_density(),
                ray: sample.chance.lanes().x,
            },
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId(0),
        })
    }
    fn emission_density(&self, _: LightId, _: Vec3, cos: f32, _: f32) -> EmissionPdf {
        EmissionPdf {
            origin: self.area_density(),
            ray: cos.max(0.0) / PI,
        }
    }
    fn background_emission_density(&self, _: Vec3, _: f32) -> EmissionPdf {
        EmissionPdf::ZERO
    }
    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        let to = start.point.position - from.position;
        let cos = start.point.normal.dot(to.normalize());
        Density::<Area>::uniform(self.area_density())
            .to_solid_angle(to.length_squared(), cos)
            .hero()
    }
    fn medium_light_density(&self, _: MediumId, _: Vec3) -> f32 {
        0.0
    }
}
