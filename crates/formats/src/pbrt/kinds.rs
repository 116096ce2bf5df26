//! The types that pbrt-v4 knows for each kind of entity, and those of pbrt-v3 that it does not know any more.

use super::number::excerpt;
use etalon_params::{Diagnostic, Spanned};

/// The types of one kind of entity.
#[derive(Debug)]
pub(crate) struct Kinds {
    /// What they are types of.
    family: &'static str,
    names: &'static [&'static str],
    /// Types of pbrt-v3, each with what does the same, if anything does.
    old: &'static [(&'static str, &'static str)],
}

impl Kinds {
    /// The types.
    #[cfg(test)]
    pub(crate) fn names(&self) -> &'static [&'static str] {
        self.names
    }

    /// The type of a name, or that there is none.
    pub(crate) fn find(&self, name: &Spanned<String>) -> Result<&'static str, Diagnostic> {
        let word = name.value.as_str();
        if let Some(found) = self.names.iter().find(|known| **known == word) {
            return Ok(found);
        }
        let family = self.family;
        if let Some((old, new)) = self.old.iter().find(|(old, _)| *old == word) {
            let message = format!("the {family} `{old}` is of pbrt-v3, not of pbrt-v4");
            return Err(Diagnostic::error(name.span, message).help(conversion(new)));
        }
        let message = format!("there is no {family} of the type `{}`", excerpt(word));
        let mistake = Diagnostic::error(name.span, message);
        Err(mistake.suggest(word, self.names.iter().copied()))
    }
}

/// What to do with a file of pbrt-v3, where `new` does what stands in it.
pub(crate) fn conversion(new: &str) -> String {
    let convert = "`pbrt --upgrade` of pbrt-v4 converts such files";
    match new {
        "" => convert.to_owned(),
        _ => format!("{convert}; it is now {new}"),
    }
}

pub(crate) const CAMERA: Kinds = Kinds {
    family: "camera",
    names: &["perspective", "orthographic", "realistic", "spherical"],
    old: &[(
        "environment",
        "`spherical` with `\"string mapping\" \"equirectangular\"`",
    )],
};

pub(crate) const FILM: Kinds = Kinds {
    family: "film",
    names: &["rgb", "gbuffer", "spectral"],
    old: &[("image", "`rgb`")],
};

pub(crate) const SAMPLER: Kinds = Kinds {
    family: "sampler",
    names: &[
        "halton",
        "independent",
        "paddedsobol",
        "pmj02bn",
        "sobol",
        "stratified",
        "zsobol",
    ],
    old: &[
        ("02sequence", "`paddedsobol`"),
        ("lowdiscrepancy", "`paddedsobol`"),
        ("maxmindist", "`pmj02bn`"),
        ("random", "`independent`"),
    ],
};

pub(crate) const FILTER: Kinds = Kinds {
    family: "pixel filter",
    names: &["box", "gaussian", "mitchell", "sinc", "triangle"],
    old: &[],
};

pub(crate) const INTEGRATOR: Kinds = Kinds {
    family: "integrator",
    names: &[
        "ambientocclusion",
        "bdpt",
        "function",
        "lightpath",
        "mlt",
        "path",
        "randomwalk",
        "simplepath",
        "simplevolpath",
        "sppm",
        "volpath",
    ],
    old: &[
        ("ao", "`ambientocclusion`"),
        ("directlighting", "`path` with `\"integer maxdepth\" 1`"),
        ("whitted", "`path`"),
    ],
};

pub(crate) const ACCELERATOR: Kinds = Kinds {
    family: "accelerator",
    names: &["bvh", "kdtree"],
    old: &[("grid", "`bvh`")],
};

pub(crate) const SHAPE: Kinds = Kinds {
    family: "shape",
    names: &[
        "bilinearmesh",
        "curve",
        "cylinder",
        "disk",
        "loopsubdiv",
        "plymesh",
        "sphere",
        "trianglemesh",
    ],
    old: &[
        ("cone", "a mesh"),
        ("heightfield", "a `trianglemesh`"),
        ("heightfield2", "a `trianglemesh`"),
        ("hyperboloid", "a mesh"),
        ("nurbs", "a mesh"),
        ("paraboloid", "a mesh"),
    ],
};

pub(crate) const LIGHT: Kinds = Kinds {
    family: "light",
    names: &[
        "distant",
        "goniometric",
        "infinite",
        "point",
        "projection",
        "spot",
    ],
    old: &[("exinfinite", "`infinite`")],
};

pub(crate) const AREA_LIGHT: Kinds = Kinds {
    family: "area light",
    names: &["diffuse"],
    old: &[("area", "`diffuse`")],
};

pub(crate) const MATERIAL: Kinds = Kinds {
    family: "material",
    names: &[
        "coatedconductor",
        "coateddiffuse",
        "conductor",
        "dielectric",
        "diffuse",
        "diffusetransmission",
        "hair",
        "interface",
        "measured",
        "mix",
        "subsurface",
        "thindielectric",
    ],
    old: &[
        ("disney", ""),
        ("fourier", ""),
        ("glass", "`dielectric`"),
        ("kdsubsurface", "`subsurface`"),
        ("matte", "`diffuse`"),
        ("metal", "`conductor`"),
        ("mirror", "`conductor`"),
        ("plastic", "`coateddiffuse`"),
        ("substrate", "`coateddiffuse`"),
        ("translucent", "`diffusetransmission`"),
        ("uber", "`coateddiffuse`"),
    ],
};

pub(crate) const MEDIUM: Kinds = Kinds {
    family: "medium",
    names: &["cloud", "homogeneous", "nanovdb", "rgbgrid", "uniformgrid"],
    old: &[("heterogeneous", "`uniformgrid`")],
};

pub(crate) const FLOAT_TEXTURE: Kinds = Kinds {
    family: "float texture",
    names: &[
        "bilerp",
        "checkerboard",
        "constant",
        "directionmix",
        "dots",
        "fbm",
        "imagemap",
        "mix",
        "ptex",
        "scale",
        "windy",
        "wrinkled",
    ],
    old: &[("uv", "")],
};

pub(crate) const SPECTRUM_TEXTURE: Kinds = Kinds {
    family: "spectrum texture",
    names: &[
        "bilerp",
        "checkerboard",
        "constant",
        "directionmix",
        "dots",
        "imagemap",
        "marble",
        "mix",
        "ptex",
        "scale",
    ],
    old: &[("uv", "")],
};

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_params::{FileId, Span};

    #[test]
    fn unknown_types_and_old_ones() {
        let message = |kinds: &Kinds, word: &str| {
            let (value, file) = (word.to_owned(), FileId(0));
            let span = Span {
                file,
                start: 0,
                end: 0,
            };
            let mistake = kinds.find(&Spanned { value, span }).expect_err("unknown");
            (mistake.message, mistake.help.unwrap_or_default())
        };
        let (said, help) = message(&SHAPE, "spher");
        assert_eq!(said, "there is no shape of the type `spher`");
        assert_eq!(help, "did you mean `sphere`?");
        let (said, help) = message(&MATERIAL, "matte");
        assert_eq!(said, "the material `matte` is of pbrt-v3, not of pbrt-v4");
        assert_eq!(
            help,
            "`pbrt --upgrade` of pbrt-v4 converts such files; it is now `diffuse`"
        );
        let (_, help) = message(&MATERIAL, "disney");
        assert_eq!(help, "`pbrt --upgrade` of pbrt-v4 converts such files");
    }
}
