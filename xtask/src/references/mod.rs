//! `cargo xtask references`: has the references of claims rendered, by Mitsuba 3 and by POV-Ray.

pub(crate) mod mitsuba;
mod povray;

use etalon_validation::claim::{Claim, Oracle};
use etalon_validation::{folders, run};
use mitsuba::Mitsuba;
use povray::PovRay;

/// Which references to make.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  cargo xtask references\n  cargo xtask references --only cornell-box\n  cargo xtask references --only povray --stale\n  ETALON_PYTHON=~/venv/bin/python cargo xtask references --only mitsuba"
)]
pub(crate) struct Arguments {
    /// Only those by this renderer (`mitsuba` or `povray`), or of the claim of this name or, if there
    /// is none, of those whose names contain it
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
    // Each renderer is looked for when it is first needed.
    let (mut mitsuba, mut pov_ray) = (None, None);
    let mut found = false;
    for claim in wanted(&claims, arguments.only.as_deref()) {
        match claim.oracle {
            Oracle::Reference { spp, seeds, .. } => {
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

/// The claims whose references are asked for, and others that have none.
fn wanted<'a>(claims: &'a [Claim], only: Option<&str>) -> Vec<&'a Claim> {
    let all = claims.iter();
    match only {
        None => all.collect(),
        Some("mitsuba") => all
            .filter(|claim| matches!(claim.oracle, Oracle::Reference { .. }))
            .collect(),
        Some("povray") => all
            .filter(|claim| matches!(claim.oracle, Oracle::Povray { .. }))
            .collect(),
        Some(name) => run::named(claims, name),
    }
}
