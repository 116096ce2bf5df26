//! The drivers that come with Etalon. Their files are in `drivers`.

/// A driver within this program.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name.
    pub name: &'static str,
    /// Its description.
    pub toml: &'static str,
    /// Its files, by name.
    pub files: &'static [(&'static str, &'static str)],
}

macro_rules! file {
    ($name:literal) => {
        include_str!(concat!("../drivers/", $name))
    };
}

macro_rules! drivers {
    ($($name:literal $toml:literal $($file:literal)*,)*) => {
        /// All of them.
        pub const ALL: &[BuiltIn] = &[$(BuiltIn {
            name: $name,
            toml: file!($toml),
            files: &[$(($file, file!($file))),*],
        },)*];
    };
}

// The list: name, description, and the files that it needs.
drivers! {
    "etalon" "etalon.toml",
    "etalon-pbrt" "etalon-pbrt.toml",
    "mitsuba" "mitsuba.toml" "mitsuba.py" "protocol.py" "shapes.py",
    "mitsuba-spectral" "mitsuba-spectral.toml" "mitsuba.py" "protocol.py" "shapes.py",
    "cycles" "cycles.toml" "cycles.py" "protocol.py" "shapes.py",
    "luxcore" "luxcore.toml" "luxcore.py" "protocol.py" "shapes.py",
    "povray" "povray.toml" "povray.py" "protocol.py" "shapes.py",
    "radiance" "radiance.toml" "radiance.py" "protocol.py" "shapes.py",
    "raysect" "raysect.toml" "raysect.py" "protocol.py" "shapes.py",
}
