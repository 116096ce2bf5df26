//! `Option` directives: each asks for a picture of another kind, and Etalon has none of those.

use super::Mapper;
use etalon_params::{Diagnostic, Span};

impl Mapper<'_> {
    /// Refuses what is asked for; options that are given as they are by default ask for nothing. The seed is the sampler's, and
    /// what scales the edges of displaced meshes concerns none that are accepted.
    pub(crate) fn refuse_options(&self) {
        let options = &self.scene.options;
        let switches = [
            ("disablepixeljitter", &options.disable_pixel_jitter),
            (
                "disabletexturefiltering",
                &options.disable_texture_filtering,
            ),
            (
                "disablewavelengthjitter",
                &options.disable_wavelength_jitter,
            ),
            ("forcediffuse", &options.force_diffuse),
        ];
        for (name, switch) in switches {
            if let Some(on) = switch.as_ref().filter(|given| given.value) {
                self.refuse_option(name, on.span);
            }
        }
    }

    fn refuse_option(&self, name: &str, span: Span) {
        let message = format!("Etalon does not have pbrt's option `{name}`");
        let mistake = Diagnostic::error(span, message);
        self.diagnostics.push(mistake.help("accepted: false"));
    }
}
