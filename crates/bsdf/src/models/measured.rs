//! A measured material: f(ωo, ωi) from a table.
//!
//! Mitsuba's plugin of that name reads the files of the RGL material database (Dupuy and Jakob 2018); this one also
//! those of MERL (Matusik et al. 2003) and spectral tables of `cargo xtask tabulate`. The kind of a file is known by
//! its beginning. The formats, their interpolation and their sampling are in the crate of tables.

use crate::{Bxdf, ShadingContext};
use etalon_params::{Diagnostic, Params};
use etalon_tables::{BrdfAtWavelengths, BrdfTable};
use etalon_transport::{BsdfSample, Build, Textures, TransportMode, file};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Parameters to test with (see [`crate::test_materials`]); the files are the harness's.
pub const EXEMPLARS: &[&str] = &[
    "measured filename=s:gloss.bsdf",
    "measured filename=s:brushed.bsdf",
    "measured filename=s:gloss.brdf",
    "measured filename=s:gloss.binary",
];

/// `measured` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    table: Arc<BrdfTable>,
}

impl Description {
    /// Reads `filename`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let what =
            "a measured material: a `.bsdf` of RGL, a `.binary` of MERL, or a spectral table";
        let table = file::read(params, build, what, |bytes| {
            BrdfTable::parse(bytes).map_err(|error| error.to_string())
        })?;
        let most = most_reflected(&table);
        if most > GAIN {
            let message =
                format!("this table gives back up to {most:.2} of the light that arrives");
            let place = params.node.plugin.span;
            params.diagnostics.push(Diagnostic::note(place, message));
        }
        Some(Self {
            table: Arc::new(table),
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Measured<'_> {
        Measured {
            table: self.table.at(site.lambda),
        }
    }
}

/// Albedo up to which energy gain is taken for noise of the measurement or of the estimate; above, there is a note.
const GAIN: f32 = 1.1;

/// Strata of each random number in [`most_reflected`].
const STRATA: u32 = 16;

/// An estimate of the table's largest albedo over some directions and wavelengths.
fn most_reflected(table: &BrdfTable) -> f32 {
    let at = table.at(Vec4::new(450.0, 520.0, 590.0, 650.0));
    let albedo = |cos: f32| {
        let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        let part = |i: u32| (i as f32 + 0.5) / STRATA as f32;
        let sample = |index: u32| {
            let u = Vec2::new(part(index % STRATA), part(index / STRATA));
            // Every row of strata chooses among lobes by other numbers.
            let u_lobe = part((index * 7 + index / STRATA) % STRATA);
            let (value, density) = at.eval_and_density(wo, at.sample(wo, u_lobe, u)?);
            (density > 0.0).then(|| value / density)
        };
        let sum: Vec4 = (0..STRATA * STRATA).filter_map(sample).sum();
        sum.max_element() / (STRATA * STRATA) as f32
    };
    [1.0, 0.9, 0.7, 0.4]
        .map(albedo)
        .into_iter()
        .fold(0.0, f32::max)
}

/// A table at the path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    table: BrdfAtWavelengths<'a>,
}

impl Bxdf for Measured<'_> {
    /// Measurements are not exactly reciprocal. Radiance is seen from `wo`; of a particle from `wo`, it is `wi` where
    /// the viewer is, so that light paths see the material that camera paths see.
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        let (value, density) = self.table.eval_and_density(wo, wi);
        let value = match mode {
            TransportMode::Radiance => value,
            TransportMode::Importance if density > 0.0 => {
                self.table.eval_and_density(wi, wo).0 * (wi.z / wo.z)
            }
            TransportMode::Importance => Vec4::ZERO,
        };
        (value, Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let wi = self.table.sample(wo, u_lobe, u)?;
        self.continuous(wo, wi, 1.0, mode)
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        false
    }
}
