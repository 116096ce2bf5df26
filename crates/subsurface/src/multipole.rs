//! `multidipole`: light below the surface of a slab of the thickness d, held between two boundaries by images of the source,
//!
//! ```text
//! R(r) = α'/4π Σᵢ [z⁺ᵢ (σtr + 1/d⁺ᵢ) e^(−σtr d⁺ᵢ)/d⁺ᵢ² − z⁻ᵢ (σtr + 1/d⁻ᵢ) e^(−σtr d⁻ᵢ)/d⁻ᵢ²]
//! z⁺ᵢ = 2i (d + 2z_b) + zᵣ,   z⁻ᵢ = 2i (d + 2z_b) − 2z_b − zᵣ,   z_b = ⅔ A zᵣ,   d±ᵢ² = r² + z±ᵢ²
//! ```
//!
//! and T(r), of the light that leaves on the other side, the same with d − z±ᵢ in place of z±ᵢ (C. Donner, H. W. Jensen, Light
//! diffusion in multi-layered translucent materials, 2005, eqs. 9 to 13). Where the slab bends, R and T count by how far the normal at
//! the exit has turned, ½(1 ± n·n') (ibid., section 5). With one image on each side it is [`crate::dipole`].
//!
//! Far from the source images cancel to many digits. There the same field is taken by its modes between the boundaries, L = d + 2z_b apart,
//!
//! ```text
//! R(r) = α' Σₙ n/L² sin(nπ (zᵣ + z_b)/L) cos(nπ z_b/L) K₀(kₙ r),   kₙ² = σtr² + (nπ/L)²
//! ```
//!
//! with the sign −(−1)ⁿ for T, and what leaves in all is known in closed form. A source deeper than the middle of the slab would
//! be out of place: in thin sheets zᵣ is ½d.

use crate::dipole::{Dipole, DipolePair, flux};
use crate::profile_model::{Boundary, LaneProfile, Matter, ProfileModel, Radial};
use core::f32::consts::PI;
use etalon_math::{bessel_k0, float};
use etalon_params::Params;
use etalon_transport::Exit;

/// Images of the source on either side.
const IMAGES: i32 = 5;

/// Modes.
const MODES: u8 = 8;

/// Modes are taken beyond this share of L, where eight of them are within 0.1 % and images within 0.4 %,
const FAR: f32 = 0.4;

/// and if L is less than this over σtr: where more is absorbed few images do for all distances.
const CLEAR: f32 = 2.0;

/// No light worth mention leaves beyond this many L: e^(−4π).
const REACH: f32 = 4.0;

/// The profile of any matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// d (m).
    thickness: f32,
}

impl Slab {
    /// Reads `thickness`.
    pub(crate) fn from_params(params: &Params<'_>) -> Self {
        let what = "a finite number above 0";
        let thickness = params.float_where("thickness", 1.0, what, |d| d > 0.0 && d.is_finite());
        Self {
            thickness: thickness as f32,
        }
    }
}

impl ProfileModel for Slab {
    type Lane<'a> = Multipole;
    const OF_HALF_SPACE: bool = false;

    fn at(&self, matter: &Matter, boundary: &Boundary) -> Multipole {
        Multipole::new(matter, boundary.inside, self.thickness)
    }
}

/// A profile at one wavelength.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Multipole {
    /// α'.
    albedo: f32,
    /// σtr (m⁻¹).
    transport: f32,
    /// zᵣ (m).
    depth: f32,
    /// z_b (m).
    beyond: f32,
    /// d (m).
    thickness: f32,
    /// By which distances are chosen: the nearest sources of R and of T.
    nearest: DipolePair,
}

/// A side of the slab.
#[derive(Clone, Copy, Debug)]
enum Side {
    /// Where light came in.
    Near,
    /// The other.
    Far,
}

impl LaneProfile for Multipole {
    fn radial(&self) -> &dyn Radial {
        &self.nearest
    }

    fn exitance(&self, exit: &Exit) -> f32 {
        let turned = 0.5 - 0.5 * exit.normal.z.clamp(-1.0, 1.0);
        let at = |side, share: f32, r: f32| match share > 0.0 {
            true => share * self.at(side, r),
            false => 0.0,
        };
        at(Side::Near, 1.0 - turned, exit.offset.length())
            + at(Side::Far, turned, exit.offset.truncate().length())
    }

    fn reach(&self, share: f32) -> f32 {
        self.nearest.sample(share).min(REACH * self.width())
    }
}

impl Multipole {
    /// The profile of a slab of this `thickness` (m), each boundary of which reflects `inside` of diffuse light from inside.
    pub(crate) fn new(matter: &Matter, inside: f32, thickness: f32) -> Self {
        let Dipole {
            albedo, transport, ..
        } = Dipole::new(matter, inside);
        let free_path = 1.0 / matter.reduced();
        let depth = free_path.min(0.5 * thickness);
        let beyond = 2.0 / 3.0 * free_path * (1.0 + inside) / (1.0 - inside);
        let dipole = |depth: f32| Dipole {
            albedo,
            transport,
            depths: [depth, depth + 2.0 * beyond],
        };
        let parts = [dipole(depth), dipole(thickness - depth)];
        let [reflected, transmitted] = shares(transport, depth, beyond, thickness);
        Self {
            albedo,
            transport,
            depth,
            beyond,
            thickness,
            nearest: DipolePair::new(parts, [albedo * reflected, albedo * transmitted]),
        }
    }

    fn width(&self) -> f32 {
        self.thickness + 2.0 * self.beyond
    }

    /// R or T (m⁻²) at a distance.
    fn at(&self, side: Side, r: f32) -> f32 {
        let width = self.width();
        let value = match r > FAR * width && self.transport * width < CLEAR {
            true => self.by_modes(side, r),
            false => self.by_images(side, r),
        };
        value.max(0.0)
    }

    fn by_images(&self, side: Side, r: f32) -> f32 {
        let leaving = |z: f32| {
            let height = match side {
                Side::Near => z,
                Side::Far => self.thickness - z,
            };
            flux(self.transport, height, (r * r + height * height).sqrt())
        };
        let sum: f32 = (-IMAGES..=IMAGES)
            .map(|i| {
                let middle = 2.0 * i as f32 * self.width();
                leaving(middle + self.depth) - leaving(middle - 2.0 * self.beyond - self.depth)
            })
            .sum();
        self.albedo / (4.0 * PI) * sum
    }

    fn by_modes(&self, side: Side, r: f32) -> f32 {
        let width = self.width();
        let sum: f32 = (1..=MODES)
            .map(|n| {
                let order = f32::from(n);
                let wave = order * PI / width;
                let sign = match side {
                    Side::Far if n % 2 == 0 => -1.0,
                    _ => 1.0,
                };
                let rate = (self.transport * self.transport + wave * wave).sqrt();
                let source = float::sin_cos(wave * (self.depth + self.beyond)).0;
                let slope = float::sin_cos(wave * self.beyond).1;
                sign * order * source * slope * bessel_k0(rate * r)
            })
            .sum();
        self.albedo * sum / (width * width)
    }
}

/// ∫R 2πr dr and ∫T 2πr dr, over α': sinh(σtr (L − s)) and sinh(σtr s), s = zᵣ + z_b, each times cosh(σtr z_b)/sinh(σtr L).
fn shares(transport: f32, depth: f32, beyond: f32, thickness: f32) -> [f32; 2] {
    let lost = |way: f32| float::exp(-transport * way);
    let width = thickness + 2.0 * beyond;
    // sinh(σ a)/sinh(σ L) less its exponential: a/L where nothing is absorbed.
    let ratio = |part: f32| match transport * width < 1e-3 {
        true => part / width,
        false => (1.0 - lost(2.0 * part)) / (1.0 - lost(2.0 * width)),
    };
    let source = depth + beyond;
    let both = 0.5 * (1.0 + lost(2.0 * beyond));
    [
        both * lost(depth) * ratio(width - source),
        both * lost(thickness - depth) * ratio(source),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64;
    use glam::Vec3;

    fn matter(absorption: f32) -> Matter {
        Matter {
            absorption,
            scattering: 1.0,
            g: 0.0,
        }
    }

    /// Integrated over either side, in ln r, as much leaves as in closed form (to 1 %); without absorption all of it, and of a sheet of
    /// two mean free paths half on each. The mutant that leaves out the images beyond the first fails.
    #[test]
    fn each_side_gives_its_share() {
        for (absorption, thickness) in [
            (1e-12, 0.3),
            (1e-12, 2.0),
            (1e-12, 8.0),
            (0.05, 2.0),
            (0.5, 1.0),
        ] {
            let slab = Multipole::new(&matter(absorption), 0.0, thickness);
            let expected = shares(slab.transport, slab.depth, slab.beyond, thickness);
            for (side, share) in [Side::Near, Side::Far].into_iter().zip(expected) {
                let steps = 20_000;
                let step = f64::from(float::ln(1e6)) / f64::from(steps);
                let sum: f64 = (0..steps)
                    .map(|i| {
                        let r = 1e-4 * float64::exp((f64::from(i) + 0.5) * step);
                        f64::from(slab.at(side, r as f32)) * core::f64::consts::TAU * r * r * step
                    })
                    .sum();
                let off = sum / f64::from(slab.albedo * share) - 1.0;
                assert!(
                    off.abs() < 0.01,
                    "{absorption} {thickness} {side:?}: {off}, of {share}"
                );
            }
        }
        let [near, far] = shares(1e-6, 1.0, 2.0 / 3.0, 2.0);
        assert!((near - 0.5).abs() < 1e-4 && (far - 0.5).abs() < 1e-4);
        let [near, far] = shares(1e-6, 1.0, 2.0 / 3.0, 10.0);
        assert!((near + far - 1.0).abs() < 1e-4 && (far - 5.0 / 34.0).abs() < 1e-4);
    }

    /// Images and modes are one field, to 1 %, about the distance where they take turns.
    #[test]
    fn images_and_modes_agree() {
        for absorption in [1e-12, 0.01, 0.1] {
            for thickness in [0.5, 1.0, 2.0] {
                let slab = Multipole::new(&matter(absorption), 0.0, thickness);
                let width = slab.width();
                assert!(slab.transport * width < CLEAR, "{absorption} {thickness}");
                for side in [Side::Near, Side::Far] {
                    let r = FAR * width;
                    let [a, b] = [slab.by_images(side, r), slab.by_modes(side, r)];
                    assert!(
                        (a / b - 1.0).abs() < 0.01,
                        "{absorption} {thickness}: {a} {b}"
                    );
                }
            }
        }
    }

    /// A thick slab is a half-space.
    #[test]
    fn a_thick_slab_is_a_dipole() {
        let matter = matter(0.1);
        let (slab, half_space) = (
            Multipole::new(&matter, 0.4, 60.0),
            Dipole::new(&matter, 0.4),
        );
        for r in [0.01, 0.3, 1.0, 4.0] {
            let exit = Exit {
                offset: Vec3::new(0.6 * r, -0.8 * r, 0.0),
                normal: Vec3::Z,
            };
            let off = slab.exitance(&exit) / half_space.value(r) - 1.0;
            assert!(off.abs() < 1e-4, "{r}: {off}");
        }
        assert!((slab.nearest.total() / half_space.total() - 1.0).abs() < 1e-5);
    }
}
