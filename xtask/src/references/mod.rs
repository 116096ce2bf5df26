//! `cargo xtask references`: has the references of claims rendered, by Mitsuba 3 and by POV-Ray.

mod mitsuba;
mod povray;

use etalon_validation::claim::{Claim, Oracle};
use etalon_validation::folders;
use mitsuba::Mitsuba;
use povray::PovRay;

/// Which references to make.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  cargo xtask references\n  cargo xtask references --only cornell-box\n  cargo xtask references --only povray --stale\n  ETALON_PYTHON=~/venv/bin/python cargo xtask references --only mitsuba"
)]
pub(crate) struct Arguments {
    /// Only those by this renderer (`mitsuba` or `povray`), or of claims whose names contain this
    #[arg(long, value_name = "RENDERER|NAME")]
    only: Option<String>,
    /// Only references that are missing or belong to another state of their scene
    #[arg(long)]
    stale: bool,
    /// The variant of Mitsuba
    #[arg(long, default_value = "llvm_ad_spectral")]
    variant: String,
}

/// Makes references.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let claims = Claim::read_all(&folders::claims())?;
    let wanted = |claim: &&Claim| is_wanted(claim, arguments.only.as_deref());
    // Each renderer is looked for when it is first needed.
    let (mut mitsuba, mut pov_ray) = (None, None);
    let mut found = false;
    for claim in claims.iter().filter(wanted) {
        match claim.oracle {
            Oracle::Reference { spp, seeds } => {
                found = true;
                if arguments.stale && mitsuba::is_fresh(claim)? {
                    continue;
                }
                let renderer = match mitsuba.take() {
                    Some(renderer) => renderer,
                    None => Mitsuba::new(&arguments.variant)?,
                };
                mitsuba.insert(renderer).make(claim, spp, seeds)?;
            }
            Oracle::Povray { .. } => {
                found = true;
                if arguments.stale && povray::is_fresh(claim)? {
                    continue;
                }
                let renderer = match pov_ray.take() {
                    Some(renderer) => renderer,
                    None => PovRay::new()?,
                };
                pov_ray.insert(renderer).make(claim)?;
            }
            _ => {}
        }
    }
    if found {
        Ok(())
    } else {
        Err("no claim with such a reference: see `cargo xtask validate --list`".to_owned())
    }
}

/// Whether a claim's reference is asked for: all are, or those of one renderer, or those of some
/// names.
fn is_wanted(claim: &Claim, only: Option<&str>) -> bool {
    match only {
        None => true,
        Some("mitsuba") => matches!(claim.oracle, Oracle::Reference { .. }),
        Some("povray") => matches!(claim.oracle, Oracle::Povray { .. }),
        Some(part) => claim.name.contains(part),
    }
}
