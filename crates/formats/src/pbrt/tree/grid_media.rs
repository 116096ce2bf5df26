//! Media in a box of numbers (`media.h`, `media.cpp`: `GridMedium`, `RGBGridMedium`, `NanoVDBMedium`): `heterogeneous`.
//!
//! ```text
//! σₐ(p) = scale d(p) σₐ,   σₛ(p) = scale d(p) σₛ,   emitted: σₐ(p) Lescale(p) Lₑ
//! ```
//!
//! pbrt's numbers are at the centres of cells, x fastest, and fall to 0 within half a cell of the border of the box: a layer of zeros around
//! them does the same. σₜ is a grid times the spectrum σₐ + σₛ, the albedo the spectrum σₛ / (σₐ + σₛ), or a grid of colours.

use super::super::parameters::Parameters;
use super::super::scene::Medium;
use super::Mapper;
use super::color_space::to_rec709;
use super::node::{Draft, Given, given, word};
use super::spectrum::{Role, samples_of};
use crate::document::embedded_name;
use etalon_images::Volume;
use etalon_params::{Class, DMat4, DVec3, Node, SpectrumText, Value};
use std::sync::Arc;

/// What says that a NanoVDB file has temperatures.
const NANOVDB_GLOW: [&str; 5] = [
    "Lescale",
    "temperaturename",
    "temperaturescale",
    "temperatureoffset",
    "temperaturecutoff",
];

/// Cells along x, y and z, and the box that they fill.
struct Cells {
    counts: [usize; 3],
    low: DVec3,
    high: DVec3,
}

impl Cells {
    fn count(&self) -> usize {
        self.counts.iter().product()
    }

    /// A volume file in the unit cube of values, each of `C` numbers, with a layer of zeros around them.
    fn file<const C: usize>(&self, values: &[[f32; C]]) -> Vec<u8> {
        let sizes = self.counts.map(|n| n + 2);
        let [nx, ny, nz] = self.counts;
        let within = |i: usize, n: usize| (1..=n).contains(&i).then(|| i - 1);
        let places = (0..sizes.iter().product()).map(|i: usize| {
            let [x, y, z] = [
                i % sizes[0],
                i / sizes[0] % sizes[1],
                i / sizes[0] / sizes[1],
            ];
            let place = within(x, nx).zip(within(y, ny)).zip(within(z, nz));
            let value = place.and_then(|((x, y), z)| values.get((z * ny + y) * nx + x));
            value.copied().unwrap_or([0.0; C])
        });
        volume_file(sizes, places)
    }

    /// From the unit cube of such a file to the box and the layer around it.
    fn place(&self) -> DMat4 {
        let counts = DVec3::from_array(self.counts.map(|n| n as f64));
        let cell = (self.high - self.low) / counts;
        DMat4::from_translation(self.low - cell) * DMat4::from_scale(cell * (counts + 2.0))
    }
}

/// A volume file in the unit cube, whose values are given x fastest.
pub(crate) fn volume_file<const C: usize>(
    sizes: [usize; 3],
    values: impl IntoIterator<Item = [f32; C]>,
) -> Vec<u8> {
    let volume = Volume {
        size: sizes,
        channels: C,
        bounds: [[0.0; 3], [1.0; 3]],
        samples: values.into_iter().flatten().collect(),
        behind: 0,
    };
    volume.encode()
}

impl<'a> Mapper<'a> {
    /// A medium of densities; `None` after a mistake.
    pub(crate) fn uniform_grid(
        &mut self,
        params: &Parameters<'a>,
        medium: &Medium,
    ) -> Option<Arc<Node>> {
        let cells = cells(params)?;
        let density = self.cell_values(params, "density", &cells, medium)?;
        let strength = match params.floats("Lescale") {
            Some([one]) => Some(given(Value::Float(*one), params.span("Lescale"))),
            Some(_) => Some(self.cell_values(params, "Lescale", &cells, medium)?),
            None => None,
        };
        let draft = self.by_density(params, density)?;
        if !params.has("temperature") {
            return Some(self.glowing(params, draft, strength)?.node());
        }
        if params.has("Le") {
            params.error_at(
                "Le",
                "a medium glows either by `Le` or by its `temperature`",
            );
            params.ignore(&["Le"]);
            return None;
        }
        let temperature = self.cell_values(params, "temperature", &cells, medium)?;
        Some(self.hot(params, draft, temperature, strength).node())
    }

    /// A medium of a NanoVDB file; `None` after a mistake.
    pub(crate) fn nanovdb(
        &mut self,
        params: &Parameters<'a>,
        medium: &Medium,
    ) -> Option<Arc<Node>> {
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        let to_world = self.still(&medium.placement, "media", params.entity.span);
        let volume = |grid: Given| {
            let volume = Draft::of(params, Class::Volume, "gridvolume")
                .from(params, "filename", "filename", word(filename))
                .given("grid_name", grid);
            match to_world == DMat4::IDENTITY {
                true => volume.value(),
                false => volume.plain("to_world", Value::Transform(to_world)).value(),
            }
        };
        let named = |name: &str, default: &str| {
            let grid = params.string(name).unwrap_or(default);
            given(word(grid), params.span(name))
        };
        let draft = self.by_density(params, volume(named("gridname", "density")))?;
        let temperature = volume(named("temperaturename", "temperature"));
        let strength = params.float("Lescale", 1.0);
        let is_said = NANOVDB_GLOW.iter().any(|name| params.has(name));
        if is_said && strength > 0.0 {
            let strength = given(Value::Float(strength), params.span("Lescale"));
            return Some(self.hot(params, draft, temperature, Some(strength)).node());
        }
        params.ignore(&NANOVDB_GLOW);
        if strength > 0.0 {
            let message =
                "whether this file has temperatures is not looked at: it does not glow here";
            let help = "`\"float Lescale\" 1` says that it has a grid of them, and 0 that it need not glow";
            self.note(params.entity.span, message, help);
        }
        Some(draft.node())
    }

    /// A medium of colours; `None` after a mistake.
    pub(crate) fn rgb_grid(
        &mut self,
        params: &Parameters<'a>,
        medium: &Medium,
    ) -> Option<Arc<Node>> {
        let cells = cells(params)?;
        let absorbed = self.cell_colours(params, ("sigma_a", Role::Unbounded), &cells)?;
        let scattered = self.cell_colours(params, ("sigma_s", Role::Unbounded), &cells)?;
        let emitted = self.cell_colours(params, ("Le", Role::Emission(1.0)), &cells)?;
        if absorbed.is_none() && scattered.is_none() {
            params.missing("rgb sigma_s");
            return None;
        }
        // pbrt's default of the one that is not given.
        let ones = || vec![[1.0; 3]; cells.count()];
        let (absorbed, scattered) = (
            absorbed.unwrap_or_else(ones),
            scattered.unwrap_or_else(ones),
        );
        let both = |of: fn(f32, f32) -> f32| -> Vec<[f32; 3]> {
            let pairs = absorbed.iter().zip(&scattered);
            let mixed = pairs.map(|(a, s)| core::array::from_fn(|c| of(a[c], s[c])));
            mixed.collect()
        };
        let extinction = both(|a, s| a + s);
        let albedo = both(|a, s| if s > 0.0 { s / (a + s) } else { 0.0 });
        let scale = params.float("scale", 1.0);
        let draft = Draft::of(params, Class::Medium, "heterogeneous")
            .given(
                "sigma_t",
                self.grid(params, "sigma_s", medium, &cells, &extinction),
            )
            .given(
                "albedo",
                self.grid(params, "sigma_s", medium, &cells, &albedo),
            )
            .from(params, "scale", "scale", Value::Float(scale));
        let strength = params.float("Lescale", 1.0);
        let draft = self.with_phase(params, draft);
        Some(match emitted.filter(|_| strength > 0.0) {
            None => draft.node(),
            Some(emitted) => {
                let volume = self.grid(params, "Le", medium, &cells, &emitted);
                let lit = Draft::new(Class::Texture, "d65", params.span("Le"));
                let Value::Object(volume) = volume.value else {
                    return None;
                };
                let lit = lit.child(volume).plain("scale", Value::Float(strength));
                draft.given("emission", lit.value()).node()
            }
        })
    }

    /// σₜ and albedo of a medium whose densities are given, and its phase function.
    pub(crate) fn by_density(&mut self, params: &Parameters<'a>, density: Given) -> Option<Draft> {
        let names = ["sigma_a", "sigma_s"];
        let curve = |mapper: &mut Self, name: &str| match params.spectrum(name) {
            None if params.has(name) => None,
            None => etalon_spectrum::Spectrum::uniform(1.0).ok(),
            Some(value) => mapper.curve(params, name, value, Role::Unbounded),
        };
        let [absorbed, scattered] = names.map(|name| curve(self, name));
        let (absorbed, scattered) = (samples_of(&absorbed?), samples_of(&scattered?));
        let pairs = || {
            absorbed
                .iter()
                .zip(&scattered)
                .map(|([nm, a], [_, s])| (*nm, *a, *s))
        };
        let scale = params.float("scale", 1.0);
        let albedo = pairs().map(|(nm, a, s)| (nm, if s > 0.0 { s / (a + s) } else { 0.0 }));
        let extinction: Vec<(f64, f64)> = pairs().map(|(nm, a, s)| (nm, a + s)).collect();
        let first = extinction.first().map_or(0.0, |(_, x)| *x);
        let is_grey = extinction
            .iter()
            .all(|(_, x)| (x - first).abs() <= 1e-9 * first);
        let draft = Draft::of(params, Class::Medium, "heterogeneous");
        let draft = match is_grey {
            true => draft
                .given("sigma_t", density)
                .plain("scale", Value::Float(scale * first)),
            false => {
                let spectrum = Value::Spectrum(SpectrumText::Samples(extinction));
                let product = Draft::of(params, Class::Texture, "multiply")
                    .given("a", density)
                    .from(params, "sigma_s", "b", spectrum);
                draft.given("sigma_t", product.value()).from(
                    params,
                    "scale",
                    "scale",
                    Value::Float(scale),
                )
            }
        };
        let albedo = Value::Spectrum(SpectrumText::Samples(albedo.collect()));
        let draft = draft.from(params, "sigma_s", "albedo", albedo);
        Some(self.with_phase(params, draft))
    }

    fn with_phase(&self, params: &Parameters<'_>, draft: Draft) -> Draft {
        let g = params.float_where("g", 0.0, "a number between −1 and 1", |g| g.abs() < 1.0);
        let phase = Draft::of(params, Class::Phase, "hg");
        draft.child(phase.from(params, "g", "g", Value::Float(g)).node())
    }

    /// A grid of the numbers of a parameter; `None` after a mistake.
    fn cell_values(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        cells: &Cells,
        medium: &Medium,
    ) -> Option<Given> {
        let Some(values) = params.floats(name) else {
            params.missing(&format!("float {name}"));
            return None;
        };
        fits(params, name, values.len(), cells)?;
        if let Some(wrong) = values
            .iter()
            .find(|x| !(**x >= 0.0 && (**x as f32).is_finite()))
        {
            params.refuse(name, wrong, "finite numbers from 0 on");
            return None;
        }
        let values: Vec<[f32; 1]> = values.iter().map(|x| [*x as f32]).collect();
        Some(self.grid(params, name, medium, cells, &values))
    }

    /// The colours of a parameter, if it is given; the outer option is `None` after a mistake.
    fn cell_colours(
        &mut self,
        params: &Parameters<'a>,
        (name, role): (&str, Role),
        cells: &Cells,
    ) -> Option<Option<Vec<[f32; 3]>>> {
        let Some((colours, space)) = params.rgbs(name) else {
            return if params.has(name) { None } else { Some(None) };
        };
        fits(params, name, colours.len(), cells)?;
        let mut found = Vec::with_capacity(colours.len());
        for colour in colours {
            let rgb = to_rec709(*colour, space, role).to_array();
            match rgb.map(|c| c as f32) {
                rgb if rgb.iter().all(|c| *c >= 0.0 && c.is_finite()) => found.push(rgb),
                _ => {
                    let [r, g, b] = colour;
                    params.refuse(
                        name,
                        format!("({r}, {g}, {b})"),
                        "colours within Rec. 709, of numbers from 0 on",
                    );
                    return None;
                }
            }
        }
        Some(Some(found))
    }

    /// A grid that becomes part of the document.
    fn grid<const C: usize>(
        &mut self,
        params: &Parameters<'_>,
        name: &str,
        medium: &Medium,
        cells: &Cells,
        values: &[[f32; C]],
    ) -> Given {
        let to_world = self.still(&medium.placement, "media", params.entity.span);
        let file = embedded_name(self.embedded.len());
        self.embedded.push(Arc::new(cells.file(values)));
        let volume = Draft::new(Class::Volume, "gridvolume", params.span(name));
        let volume = volume
            .plain("filename", word(&file))
            .plain("to_world", Value::Transform(to_world * cells.place()));
        volume.value()
    }
}

/// The cells of a medium; `None` after a mistake.
fn cells(params: &Parameters<'_>) -> Option<Cells> {
    let counts = ["nx", "ny", "nz"].map(|name| params.integer_from(name, 1, 1));
    let [low, high] = box_of(params)?;
    Some(Cells {
        counts: counts.map(|n| n.unsigned_abs() as usize),
        low,
        high,
    })
}

/// The box from `p0` to `p1`; `None` after a mistake.
pub(crate) fn box_of(params: &Parameters<'_>) -> Option<[DVec3; 2]> {
    let [a, b] = [("p0", DVec3::ZERO), ("p1", DVec3::ONE)].map(|(n, p)| params.point3(n, p));
    let (low, high) = (a.min(b), a.max(b));
    if (high - low).min_element() <= 0.0 {
        params.error_at("p1", "the box from `p0` to `p1` has no volume");
        return None;
    }
    Some([low, high])
}

/// Says if there are more or fewer values than cells.
fn fits(params: &Parameters<'_>, name: &str, found: usize, cells: &Cells) -> Option<()> {
    let [x, y, z] = cells.counts;
    if x.checked_mul(y).and_then(|n| n.checked_mul(z)) == Some(found) {
        return Some(());
    }
    params.error_at(
        name,
        format!("there are {found} `{name}` for {x} × {y} × {z} cells"),
    );
    None
}
