//! Models that are wrong on purpose, each with the test that rejects it.

use crate::adjoint::asymmetry;
use crate::determinant;
use crate::directions;
use crate::pointwise::{inconsistency, lane_dependence};
use crate::scene::Sample;
use crate::statistical::{Integrals, chi_squared_p, quadrature_p};
use etalon_bsdf::BsdfAtPoint;
use etalon_math::{Density, Frame, SolidAngle};
use etalon_transport::{Bsdf, BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A fault.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// The density of a sampled direction lacks its cosine.
    NoCosineInDensity,
    /// Values are two per cent too high, in `eval` and `sample` alike.
    Brighter,
    /// Samples are drawn by another density than they say: a little nearer to the normal.
    Narrower,
    /// Radiance is not squeezed by refraction.
    NoSqueeze,
    /// All lanes are given the density of the one that chooses.
    ChooserForAll,
}

/// A right model with a fault.
#[derive(Clone, Copy)]
struct Wrong<'a> {
    right: BsdfAtPoint<'a>,
    fault: Fault,
}

impl Wrong<'_> {
    fn spoil(&self, wi: Vec3, value: Vec4, density: Vec4) -> (Vec4, Vec4) {
        match self.fault {
            Fault::NoCosineInDensity => (value, density * (0.5 / wi.z.abs().max(1e-3))),
            Fault::Brighter => (value * 1.02, density),
            Fault::ChooserForAll => (value, Vec4::splat(density.x)),
            Fault::Narrower | Fault::NoSqueeze => (value, density),
        }
    }

    fn mode(&self, mode: TransportMode) -> TransportMode {
        match self.fault {
            Fault::NoSqueeze => TransportMode::Importance,
            _ => mode,
        }
    }
}

impl Bsdf for Wrong<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        self.eval_and_density(wo, wi, mode).0
    }

    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        self.eval_and_density(wo, wi, TransportMode::Radiance).1
    }

    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        let (value, density) = self.right.eval_and_density(wo, wi, self.mode(mode));
        let (value, density) = self.spoil(wi, value, density.lanes());
        (value, Density::per_lane(density))
    }

    fn sample(
        &self,
        wo: Vec3,
        u_lobe: f32,
        mut u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        if self.fault == Fault::Narrower {
            u.x *= 0.97;
        }
        let mut s = self.right.sample(wo, u_lobe, u, self.mode(mode))?;
        if let SamplePdf::Continuous(density) = s.chance {
            let (value, density) = self.spoil(s.wi, s.value, density.lanes());
            s.value = value;
            s.chance = SamplePdf::Continuous(Density::per_lane(density));
        }
        Some(s)
    }

    fn has_continuous(&self) -> bool {
        self.right.has_continuous()
    }

    fn null_transmittance(&self) -> Vec4 {
        self.right.null_transmittance()
    }

    fn null_probability(&self) -> Vec4 {
        self.right.null_probability()
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.right.albedo(wo)
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        self.right.discrete(wo, index, mode)
    }

    fn has_discrete(&self) -> bool {
        self.right.has_discrete()
    }

    fn hemisphere(&self) -> Option<Frame> {
        self.right.hemisphere()
    }

    fn projected_area(&self, direction: Vec3) -> f32 {
        self.right.projected_area(direction)
    }
}

/// The least p-values of χ² and quadrature over the known directions.
fn p_values(sample: &Sample, fault: Fault) -> (f64, f64) {
    let (mut chi, mut energy) = (1.0f64, 1.0f64);
    for wo in directions::known() {
        let at = |turn| Wrong {
            right: sample.rotated(wo, turn),
            fault,
        };
        let integrals = Integrals::new(&at(0), wo);
        chi = chi.min(chi_squared_p(&at(0), wo, &integrals, 1));
        let lanes = quadrature_p(at, wo, &integrals, 1);
        energy = lanes.into_iter().fold(energy, f64::min);
    }
    (chi, energy)
}

/// What the family of `statistical.rs` would reject: α over its number of hypotheses.
const LEVEL: f64 = 1e-3 / 1000.0;

#[test]
fn a_dropped_cosine_is_rejected() {
    let sample = Sample::new("diffuse");
    let wo = directions::at(50.0, 1.0);
    let wrong = Wrong {
        right: sample.at(wo),
        fault: Fault::NoCosineInDensity,
    };
    assert!(p_values(&sample, Fault::NoCosineInDensity).0 < LEVEL);
    assert!(determinant::worst(&wrong, wo, 7).0 > 0.1);
}

#[test]
fn samples_narrower_than_their_density_are_rejected() {
    for text in [
        "diffuse",
        "roughconductor alpha=f:0.3 distribution=s:ggx",
        "roughdielectric alpha=f:0.3",
    ] {
        let sample = Sample::new(text);
        let (chi, energy) = p_values(&sample, Fault::Narrower);
        assert!(chi < LEVEL || energy < LEVEL, "{text} {chi} {energy}");
        let wo = directions::at(50.0, 1.0);
        let wrong = Wrong {
            right: sample.at(wo),
            fault: Fault::Narrower,
        };
        assert!(determinant::worst(&wrong, wo, 7).0 > 0.01, "{text}");
    }
}

#[test]
fn a_forgotten_index_squared_is_rejected() {
    let sample = Sample::new("roughdielectric alpha=f:0.3");
    let wrong = |wo| Wrong {
        right: sample.at(wo),
        fault: Fault::NoSqueeze,
    };
    assert!(asymmetry(wrong, 1).is_some());
}

#[test]
fn one_density_for_all_lanes_is_rejected() {
    let sample = Sample::new("roughdielectric alpha=f:0.3 int_ior=s:cauchy:1.2,0.08");
    let wo = directions::at(50.0, 1.0);
    let wrong = |turn| Wrong {
        right: sample.rotated(wo, turn),
        fault: Fault::ChooserForAll,
    };
    assert!(lane_dependence(wrong, wo, 1).is_some());
}

#[test]
fn energy_from_nowhere_is_rejected_where_mitsuba_has_the_value() {
    // Consistent in itself, so that only an oracle can tell: a white diffuse surface is not white.
    let sample = Sample::new("diffuse reflectance=u:1");
    let wo = directions::at(50.0, 1.0);
    let wrong = Wrong {
        right: sample.at(wo),
        fault: Fault::Brighter,
    };
    assert_eq!(inconsistency(&wrong, wo, 1), None);
    let energy = crate::sphere::total(&crate::sphere::integrate(8, |wi| {
        wrong.eval(wo, wi, TransportMode::Importance).to_array()
    }));
    assert!(energy[0] > 1.001);
}
