//! References by POV-Ray: one picture of a scene's twin, one ray through each pixel's centre.
//!
//! POV-Ray is the program `povray`, or the one that `ETALON_POVRAY` names.

use etalon_validation::claim::Claim;
use etalon_validation::{folders, povray};
use std::ffi::OsString;
use std::fs;
use std::process::Command;

/// POV-Ray, found.
pub(super) struct PovRay {
    program: OsString,
    version: String,
}

impl PovRay {
    /// Looks for it.
    pub(super) fn new() -> Result<Self, String> {
        Self::named(std::env::var_os("ETALON_POVRAY").unwrap_or_else(|| "povray".into()))
    }

    /// The program of this name or path.
    fn named(program: OsString) -> Result<Self, String> {
        let output = Command::new(&program).arg("--version").output();
        let output = output.map_err(|e| {
            format!(
                "`{}` cannot be run ({e}): install POV-Ray 3.7 (`apt-get install povray` on \
                 Debian and Ubuntu), or name it in `ETALON_POVRAY`",
                program.display()
            )
        })?;
        // Where it says so depends on how it was built.
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8_lossy(&said);
        let version = (said.lines())
            .find_map(|line| line.trim().strip_prefix("POV-Ray "))
            .ok_or_else(|| format!("`{}` does not say that it is POV-Ray", program.display()))?;
        Ok(Self {
            version: version.to_owned(),
            program,
        })
    }

    /// Makes the reference of a claim.
    pub(super) fn make(&self, claim: &Claim) -> Result<(), String> {
        let twins = povray::twins(claim)?;
        let folder = folders::root().join("target/references");
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let picture = folder.join(format!("{}.exr", claim.name));
        let scene = folders::scenes().join(povray::twin(&claim.scene));
        // Where the files are that the scene names.
        let home = scene.parent().unwrap_or(&folder).to_owned();
        let output = Command::new(&self.program)
            .current_dir(home)
            .args(povray::options(twins.size))
            .arg(format!("+I{}", scene.display()))
            .arg(format!("+O{}", picture.display()))
            .output()
            .map_err(|e| format!("{}: {e}", self.program.display()))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(format!(
                "POV-Ray could not render `{}`:\n{}",
                claim.name,
                said.trim_end()
            ));
        }
        povray::write(claim, &picture, &self.version)?;
        fs::remove_file(&picture).map_err(|e| format!("{}: {e}", picture.display()))?;
        let [width, height] = twins.size;
        println!(
            "{}: {width} × {height} pixels by POV-Ray {}",
            claim.name, self.version
        );
        Ok(())
    }
}

/// Whether a claim's reference belongs to the present state of both twins.
pub(super) fn is_fresh(claim: &Claim) -> Result<bool, String> {
    let twins = povray::twins(claim)?;
    Ok(povray::read_in(&folders::references(), &claim.name, &twins).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_lacks_pov_ray_is_told_how_to_install_it() {
        let message = PovRay::named("no-such-program".into())
            .err()
            .expect("there is none");
        assert!(message.contains("apt-get install povray"), "{message}");
    }

    #[test]
    fn another_program_is_not_taken_for_pov_ray() {
        let message = PovRay::named("true".into()).err().expect("it is another");
        assert!(message.contains("POV-Ray"), "{message}");
    }
}
