//! A measured BRDF of any kind, and its use: value, density, sampling.

use crate::BrdfTableError;
use crate::half_vector::HalfVectors;
use crate::merl::Merl;
use crate::rgl::Rgl;
use crate::spectral::{self, SpectralTable};
use crate::tensor_file::{self, TensorFile};
use core::f32::consts::FRAC_1_PI;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_spectrum::upsample::basis;
use glam::{Vec2, Vec3, Vec4};

/// Share of samples of an RGL table that are diffuse: its brightness may be zero between nodes where its value is not.
const RGL_DIFFUSE: f32 = 0.1;

/// A measured BRDF.
#[derive(Clone, Debug)]
pub enum BrdfTable {
    /// Of the MERL database.
    Merl(Merl),
    /// Of the RGL material database.
    Rgl(Box<Rgl>),
    /// In the spectral format of this crate.
    Spectral(SpectralTable),
}

/// A table at four wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct BrdfAtWavelengths<'a> {
    table: &'a BrdfTable,
    lambda: Vec4,
    /// The spectra of red, green and blue, for tables of colours.
    primaries: [Vec4; 3],
}

impl BrdfTable {
    /// The BRDF in the bytes of a file, whose kind is known by its beginning.
    ///
    /// # Errors
    /// If it is of no known kind, truncated or corrupt. What is allocated is in proportion to the file.
    pub fn parse(bytes: &[u8]) -> Result<Self, BrdfTableError> {
        if bytes.starts_with(tensor_file::MAGIC) {
            let file = TensorFile::parse(bytes)?;
            if file.has(spectral::FIELD) {
                SpectralTable::parse(&file).map(Self::Spectral)
            } else {
                Rgl::parse(&file).map(|table| Self::Rgl(Box::new(table)))
            }
        } else if Merl::recognises(bytes) {
            Merl::parse(bytes).map(Self::Merl)
        } else {
            Err(BrdfTableError::new(
                "the file is no table of a BRDF: neither RGL's, nor MERL's, nor a spectral one",
            ))
        }
    }

    /// Its kind, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Merl(_) => "a BRDF of the MERL database",
            Self::Rgl(_) => "a BRDF of the RGL material database",
            Self::Spectral(_) => "a spectral table of a BRDF",
        }
    }

    /// The table at the wavelengths `lambda` in nm.
    #[inline]
    pub fn at(&self, lambda: Vec4) -> BrdfAtWavelengths<'_> {
        BrdfAtWavelengths {
            table: self,
            lambda,
            primaries: match self {
                Self::Merl(_) => basis::primaries(lambda),
                Self::Rgl(_) | Self::Spectral(_) => [Vec4::ZERO; 3],
            },
        }
    }

    /// The distribution of half vectors for sampling, if it is sampled by them.
    fn half_vectors(&self) -> Option<&HalfVectors> {
        match self {
            Self::Merl(table) => Some(table.half_vectors()),
            Self::Spectral(table) => Some(table.half_vectors()),
            Self::Rgl(_) => None,
        }
    }
}

impl BrdfAtWavelengths<'_> {
    /// The value for the known `wo` and the sampled `wi` (with the cosine of `wi`), and the density of
    /// [`BrdfAtWavelengths::sample`].
    #[inline]
    pub fn eval_and_density(&self, wo: Vec3, wi: Vec3) -> (Vec4, f32) {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return (Vec4::ZERO, 0.0);
        }
        let (value, half_vectors) = match self.table {
            BrdfTable::Rgl(table) => {
                let (value, density) = table.eval_and_density(wo, wi, self.lambda);
                let diffuse = wi.z * FRAC_1_PI;
                return (value, density + RGL_DIFFUSE * (diffuse - density));
            }
            BrdfTable::Merl(table) => {
                let [r, g, b] = self.primaries;
                let colour = table.brdf(wo, wi);
                let value = r * colour.x + g * colour.y + b * colour.z;
                (value, table.half_vectors())
            }
            BrdfTable::Spectral(table) => (table.brdf(wo, wi, self.lambda), table.half_vectors()),
        };
        (value * wi.z, half_vectors.density(wo, wi))
    }

    /// A direction for the known `wo`; `None` if it falls below the surface.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<Vec3> {
        if !(wo.z > 0.0) {
            return None;
        }
        let wi = match (self.table, self.table.half_vectors()) {
            (_, Some(half_vectors)) => half_vectors.sample(wo, u_lobe, u),
            (BrdfTable::Rgl(table), _) if u_lobe >= RGL_DIFFUSE => table.sample(wo, u)?,
            _ => square_to_cosine_hemisphere(u),
        };
        (wi.z > 0.0).then_some(wi)
    }
}
