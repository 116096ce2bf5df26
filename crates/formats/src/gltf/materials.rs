//! Materials (glTF 2.0, §3.9 and appendix B): `principled`.
//!
//! | glTF | `principled` |
//! |---|---|
//! | baseColorFactor × texture × COLOR_0 | `base_color` |
//! | metallicFactor × B, roughnessFactor × G | `metallic`, `roughness` (both have α = roughness²) |
//! | KHR_materials_transmission × R | `spec_trans` |
//! | KHR_materials_ior, the factor of KHR_materials_specular | `eta` with the same reflectance at normal incidence |
//! | KHR_materials_clearcoat | 4 × `clearcoat`, `clearcoat_gloss`, see `clear_coat` |
//! | KHR_materials_sheen | `sheen`, which is Disney's |
//! | | `diffuse_model` `lambert` |
//!
//! Opaque materials look alike from both sides, whether `doubleSided` or not.

use super::normal_map;
use super::primitives::Channels;
use super::reader::Reader;
use super::textures::{Look, TextureUse, of_vertices, product};
use crate::draft::{Draft, Given, given, times, word};
use ::gltf::json::material::{Material, PbrMetallicRoughness};
use ::gltf::json::texture::Info;
use etalon_params::{Class, DVec3, Node, Span, Value};
use std::sync::Arc;

/// What a material depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MaterialKey {
    /// Its number; `None` for the default one.
    pub(crate) material: Option<usize>,
    /// How many channels the colours of the vertices have.
    pub(crate) colours: Channels,
}

/// What a material is in the tree.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(crate) bsdf: Arc<Node>,
    pub(crate) emitter: Option<Arc<Node>>,
    pub(crate) interior: Option<Arc<Node>>,
    /// The number of the texture coordinates that its textures ask for.
    pub(crate) set: Option<u32>,
}

/// A material that is becoming nodes.
pub(crate) struct Maker<'r, 'a> {
    pub(crate) reader: &'r mut Reader<'a>,
    pub(crate) material: &'r Material,
    /// Where it stands.
    pub(crate) path: String,
    colours: Channels,
    /// The textures that it uses.
    used: Vec<TextureUse>,
}

impl<'a> Reader<'a> {
    /// The material; `None` after a mistake.
    pub(crate) fn surface(&mut self, key: MaterialKey) -> Option<Surface> {
        if let Some(found) = self.materials.get(&key) {
            return found.clone();
        }
        let found = self.new_surface(key);
        self.materials.insert(key, found.clone());
        found
    }

    fn new_surface(&mut self, key: MaterialKey) -> Option<Surface> {
        let root = self.root;
        let default = Material::default();
        let (material, path) = match key.material {
            Some(number) => (root.materials.get(number)?, format!("materials[{number}]")),
            None => (&default, String::new()),
        };
        let mut maker = Maker {
            reader: self,
            material,
            path,
            colours: key.colours,
            used: Vec::new(),
        };
        maker.surface()
    }
}

impl<'a> Maker<'_, 'a> {
    fn surface(&mut self) -> Option<Surface> {
        let colour = self.base_colour();
        let opacity = self.opacity();
        let emitter = self.emitter(&colour, &opacity);
        let unlit = (self.material.extensions.as_ref()).is_some_and(|e| e.unlit.is_some());
        let bsdf = match unlit {
            true => Some(self.dark()),
            false => self.principled(colour),
        };
        let interior = self.interior();
        let (opacity, emitter, bsdf) = (opacity?, emitter?, bsdf?);
        let bsdf = match opacity {
            Some(opacity) => {
                let mask = Draft::new(Class::Bsdf, "mask", opacity.span);
                mask.given("opacity", opacity).child(bsdf).node()
            }
            None => bsdf,
        };
        let set = self.set()?;
        Some(Surface {
            bsdf,
            emitter,
            interior,
            set,
        })
    }

    /// The place of a part of the material.
    pub(crate) fn span(&self, part: &str) -> Span {
        self.reader.span(&format!("{}.{part}", self.path))
    }

    /// A use of a texture, which counts as used.
    pub(crate) fn sample(&mut self, part: &str, info: &Info) -> TextureUse {
        let sample = TextureUse::of(format!("{}.{part}", self.path), info);
        self.used.push(sample.clone());
        sample
    }

    /// A use of a normal map.
    pub(crate) fn use_sample(&mut self, sample: &TextureUse) {
        self.used.push(sample.clone());
    }

    /// Which texture coordinates the textures ask for: meshes have one set. `None` after a mistake.
    fn set(&self) -> Option<Option<u32>> {
        let mut used = self.used.iter();
        let Some(first) = used.next() else {
            return Some(None);
        };
        let set = first.set();
        if let Some(other) = used.find(|sample| sample.set() != set) {
            let message = format!(
                "it is looked up by TEXCOORD_{}, and `{}` by TEXCOORD_{set}",
                other.set(),
                first.path
            );
            let accepted = "the same texture coordinates for all textures of a material";
            return self.reader.refuse(&other.path, message, accepted);
        }
        Some(Some(set))
    }

    /// A number times a channel of a texture, if there is one; `None` after a mistake.
    pub(crate) fn number(
        &mut self,
        [factor_part, texture_part]: [&str; 2],
        factor: f64,
        info: Option<&Info>,
        channel: &'static str,
    ) -> Option<Given> {
        let Some(info) = info else {
            return Some(given(Value::Float(factor), self.span(factor_part)));
        };
        let sample = self.sample(texture_part, info);
        let texture = self.reader.bitmap(&sample, Look::Channel(channel))?;
        Some(times(texture, factor))
    }

    fn rough_metal(&self) -> &PbrMetallicRoughness {
        &self.material.pbr_metallic_roughness
    }

    /// The base colour without its alpha; `None` after a mistake.
    fn base_colour(&mut self) -> Option<Given> {
        let model = &self.material.pbr_metallic_roughness;
        let [r, g, b, _] = model.base_color_factor.0.map(f64::from);
        let part = "pbrMetallicRoughness.baseColorTexture";
        let texture = match &model.base_color_texture {
            Some(info) => {
                let sample = self.sample(part, info);
                Some(self.reader.bitmap(&sample, Look::Colour)?)
            }
            None => None,
        };
        let span = self.span("pbrMetallicRoughness.baseColorFactor");
        let painted = (self.colours > 0).then(|| of_vertices("vertex_color", span));
        let varying = match (texture, painted) {
            (Some(a), Some(b)) => Some(product(b, a)),
            (a, b) => a.or(b),
        };
        Some(coloured(varying, DVec3::new(r, g, b), span))
    }

    /// The base colour's alpha; `None` after a mistake.
    pub(crate) fn alpha(&mut self) -> Option<Given> {
        let model = &self.material.pbr_metallic_roughness;
        let factor = f64::from(model.base_color_factor.0[3]);
        let part = "pbrMetallicRoughness.baseColorTexture";
        let mut varying = None;
        if let Some(info) = &model.base_color_texture {
            let sample = self.sample(part, info);
            let image = self.reader.image_of(&sample);
            if image.is_some_and(|image| self.reader.has_alpha(image)) {
                varying = Some(self.reader.bitmap(&sample, Look::Channel("a"))?);
            }
        }
        let span = self.span("pbrMetallicRoughness.baseColorFactor");
        if self.colours == 4 {
            let painted = of_vertices("vertex_alpha", span);
            varying = Some(match varying {
                Some(texture) => product(painted, texture),
                None => painted,
            });
        }
        Some(match varying {
            Some(varying) => times(varying, factor),
            None => given(Value::Float(factor), span),
        })
    }

    /// What reflects nothing.
    fn dark(&self) -> Arc<Node> {
        let draft = Draft::new(Class::Bsdf, "diffuse", self.reader.span(&self.path));
        let draft = draft.plain("reflectance", Value::Float(0.0));
        Draft::new(Class::Bsdf, "twosided", draft.span())
            .child(draft.node())
            .node()
    }

    fn principled(&mut self, colour: Option<Given>) -> Option<Arc<Node>> {
        let model = self.rough_metal();
        let (metal, rough) = (model.metallic_factor.0, model.roughness_factor.0);
        let info = model.metallic_roughness_texture.clone();
        let texture = "pbrMetallicRoughness.metallicRoughnessTexture";
        let metallic = ["pbrMetallicRoughness.metallicFactor", texture];
        let metallic = self.number(metallic, f64::from(metal), info.as_ref(), "b");
        let roughness = ["pbrMetallicRoughness.roughnessFactor", texture];
        let roughness = self.number(roughness, f64::from(rough), info.as_ref(), "g");
        let transmission = self.transmission()?;
        let draft = Draft::new(Class::Bsdf, "principled", self.reader.span(&self.path))
            .given("base_color", colour?)
            .given("metallic", metallic?)
            .given("roughness", roughness?)
            .given("eta", self.eta(transmission.is_some())?)
            .plain("diffuse_model", word("lambert"));
        let transmits = transmission.is_some();
        let draft = draft.maybe("spec_trans", transmission);
        let draft = self.clear_coat(draft)?;
        let draft = self.sheen(draft);
        let bsdf = match transmits {
            true => draft.node(),
            false => {
                let both = Draft::new(Class::Bsdf, "twosided", draft.span());
                both.child(draft.node()).node()
            }
        };
        normal_map::tilted(self, bsdf)
    }

    /// The share that is transmitted, if any is; the outer `None` is after a mistake.
    fn transmission(&mut self) -> Option<Option<Given>> {
        let extensions = self.material.extensions.as_ref();
        let Some(found) = extensions.and_then(|e| e.transmission.clone()) else {
            return Some(None);
        };
        let factor = f64::from(found.transmission_factor.0);
        if factor == 0.0 {
            return Some(None);
        }
        let parts = [
            "extensions.KHR_materials_transmission.transmissionFactor",
            "extensions.KHR_materials_transmission.transmissionTexture",
        ];
        let texture = found.transmission_texture.as_ref();
        self.number(parts, factor, texture, "r").map(Some)
    }

    /// The index of refraction: with a specular factor w, the one whose reflectance is w ((n − 1)/(n + 1))².
    fn eta(&self, transmits: bool) -> Option<Given> {
        let extensions = self.material.extensions.as_ref();
        let ior = extensions.and_then(|e| e.ior.as_ref());
        let ior = ior.map_or(1.5, |ior| f64::from(ior.ior.0));
        let place = self.span("extensions.KHR_materials_ior.ior");
        if !(ior >= 1.0 && ior.is_finite()) {
            let path = format!("{}.extensions.KHR_materials_ior.ior", self.path);
            let help = "a finite number from 1 on";
            return self
                .reader
                .refuse(&path, "this is no index of refraction", help);
        }
        let Some(specular) = extensions.and_then(|e| e.specular.as_ref()) else {
            return Some(given(Value::Float(ior), place));
        };
        let path = format!("{}.extensions.KHR_materials_specular", self.path);
        let weight = f64::from(specular.specular_factor.0);
        let white = specular.specular_color_factor.0 == [1.0; 3];
        if specular.specular_texture.is_some()
            || specular.specular_color_texture.is_some()
            || !white
        {
            let message =
                "of KHR_materials_specular only the factor is read, without colour and textures";
            self.reader.note(&path, message);
        }
        if weight == 1.0 {
            return Some(given(Value::Float(ior), place));
        }
        if transmits {
            let message = "the specular factor of a material that transmits is not read";
            self.reader.note(&path, message);
            return Some(given(Value::Float(ior), place));
        }
        let root = weight.clamp(0.0, 1.0).sqrt() * (ior - 1.0) / (ior + 1.0);
        let eta = (1.0 + root) / (1.0 - root);
        Some(given(Value::Float(eta), self.reader.span(&path)))
    }

    /// Disney's coat reflects a quarter of what its interface does, so it has four times the strength here; its gloss g has
    /// α = 0.1 − 0.099 g, with α = roughness² in glTF. `None` after a mistake.
    fn clear_coat(&mut self, draft: Draft) -> Option<Draft> {
        const NAME: &str = "KHR_materials_clearcoat";
        let extensions = self.material.extensions.as_ref();
        let Some(coat) = extensions.and_then(|e| e.others.get(NAME)).cloned() else {
            return Some(draft);
        };
        let number = |name: &str| coat.get(name).and_then(|value| value.as_f64());
        let [strength, rough] =
            ["clearcoatFactor", "clearcoatRoughnessFactor"].map(|name| number(name).unwrap_or(0.0));
        if strength == 0.0 {
            return Some(draft);
        }
        let part = |name: &str| format!("extensions.{NAME}.{name}");
        let texture = |name: &str| -> Option<Info> {
            ::gltf::json::deserialize::from_value(coat.get(name)?.clone()).ok()
        };
        let strength = self.number(
            [&part("clearcoatFactor"), &part("clearcoatTexture")],
            4.0 * strength,
            texture("clearcoatTexture").as_ref(),
            "r",
        )?;
        let place = self.span(&part("clearcoatRoughnessFactor"));
        let path = format!("{}.extensions.{NAME}", self.path);
        for name in ["clearcoatRoughnessTexture", "clearcoatNormalTexture"] {
            if coat.get(name).is_some() {
                let message = format!(
                    "`{name}` is not read: the coat is as rough as its factor says, and as even as the base"
                );
                self.reader.note(&format!("{path}.{name}"), message);
            }
        }
        let gloss = ((0.1 - rough * rough) / 0.099).clamp(0.0, 1.0);
        if rough * rough > 0.1 {
            self.reader
                .note(&path, "clear coats are at most as rough as √0.1 here");
        }
        Some(
            draft
                .given("clearcoat", strength)
                .with("clearcoat_gloss", Value::Float(gloss), place),
        )
    }

    fn sheen(&self, draft: Draft) -> Draft {
        const NAME: &str = "KHR_materials_sheen";
        let extensions = self.material.extensions.as_ref();
        let sheen = extensions.and_then(|e| e.others.get(NAME));
        let colour = sheen.and_then(|sheen| sheen.get("sheenColorFactor")?.as_array());
        let components = colour.into_iter().flatten().filter_map(|x| x.as_f64());
        let most = components.fold(0.0, f64::max);
        if most == 0.0 {
            return draft;
        }
        let path = format!("{}.extensions.{NAME}", self.path);
        let message = "KHR_materials_sheen becomes Disney's sheen, of the strength of its colour and without its roughness";
        self.reader.note(&path, message);
        draft.with("sheen", Value::Float(most), self.reader.span(&path))
    }
}

/// What varies times a colour; the colour if nothing varies.
pub(crate) fn coloured(varying: Option<Given>, colour: DVec3, span: Span) -> Given {
    match varying {
        None => given(Value::Rgb(colour), span),
        Some(varying) if colour == DVec3::splat(colour.x) => times(varying, colour.x),
        Some(varying) => product(given(Value::Rgb(colour), span), varying),
    }
}
