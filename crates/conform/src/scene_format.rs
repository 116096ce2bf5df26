//! The languages, beside JSON, in which scenes are written for programs that read them.
//!
//! To add one, write it in a file of its own and add it to the list.

use crate::mode::Mode;
use crate::scene::Scene;
use crate::{mitsuba_xml, pbrt_scene};

/// Names and bytes of files.
pub type Files = Vec<(String, Vec<u8>)>;

/// A language.
#[derive(Clone, Copy, Debug)]
pub struct SceneFormat {
    /// The ending of its files, which is its placeholder in drivers' commands too.
    pub ending: &'static str,
    /// Writes a scene, whose own files are named after the second argument, or says what the language cannot say.
    pub write: fn(&Scene, &str, Mode) -> Result<Files, String>,
}

/// All of them.
pub const ALL: [SceneFormat; 2] = [
    SceneFormat {
        ending: "xml",
        write: |scene, name, mode| {
            let xml = mitsuba_xml::write(scene, name, mode)?;
            let own = (format!("{name}.xml"), xml.text.into_bytes());
            Ok(xml.files.into_iter().chain([own]).collect())
        },
    },
    SceneFormat {
        ending: "pbrt",
        write: |scene, name, mode| {
            let text = pbrt_scene::write(scene, mode)?;
            Ok(vec![(format!("{name}.pbrt"), text.into_bytes())])
        },
    },
];
