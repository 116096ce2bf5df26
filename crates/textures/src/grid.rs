//! `gridvolume`: values on a grid of points of space, as Mitsuba's `.vol` files and NanoVDB files hold them.
//!
//! The grid fills the unit cube, which `to_world` places (with `use_grid_bbox`, first the file's box or, of a NanoVDB file,
//! where that puts it); the value i of n along
//! an axis is at (i + ½)/n, and values between are interpolated (`trilinear`), or those of the `nearest`. Beyond the
//! cube the grid goes on as `wrap_mode` says. Three channels are colours, interpolated as spectra; those of a
//! share of light are held to 1. Six are symmetric matrices (xx, yy, zz, xy, xz, yz).

use crate::nanovdb;
use crate::pixels::{Image, Pixels, Texels, Values};
use crate::reader::Use;
use crate::recovered;
use crate::texture::TextureModel;
use crate::vol_file::VolFile;
use crate::{Filter, Texture, TextureReader, TextureTable, Wrap};
use core::ops::{Add, Mul};
use etalon_params::{Diagnostic, Params};
use etalon_spectrum::RgbCoefficients;
use etalon_transport::{Shapes, SpectrumKind, TexturePoint, file};
use glam::{Affine3A, DAffine3, DMat4, DVec3, IVec3, UVec2, UVec3, Vec3, Vec4};
use std::sync::Arc;

/// Values on a grid in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Values along x, y and z.
    size: UVec3,
    /// By z, y and x.
    values: Arc<Image>,
    /// From the world to the grid, in which values are 1 apart.
    to_grid: Affine3A,
    filter: Filter,
    wrap: Wrap,
    /// Whether values are at most 1.
    is_share: bool,
    /// The world's box around the unit cube (m).
    bounds: [Vec3; 2],
}

impl Grid {
    /// Eight values and their weights; one where nothing is interpolated.
    #[inline]
    fn interpolate<T>(&self, at: Vec3, value: impl Fn(usize) -> T) -> T
    where
        T: Add<Output = T> + Mul<f32, Output = T>,
    {
        let place = self.to_grid.transform_point3(at);
        if self.filter == Filter::Nearest {
            return value(self.index(floor(place)));
        }
        let low = (place - 0.5).floor();
        let part = place - 0.5 - low;
        let low = floor(low);
        let row = |y: i32, z: i32| {
            let [a, b] = [0, 1].map(|x| value(self.index(low + IVec3::new(x, y, z))));
            a * (1.0 - part.x) + b * part.x
        };
        let plane = |z: i32| row(0, z) * (1.0 - part.y) + row(1, z) * part.y;
        plane(0) * (1.0 - part.z) + plane(1) * part.z
    }

    /// Where the value of a cell is that may be beyond the grid.
    #[inline]
    fn index(&self, cell: IVec3) -> usize {
        let size = self.size;
        let [x, y, z] = [(cell.x, size.x), (cell.y, size.y), (cell.z, size.z)]
            .map(|(i, n)| self.wrap.texel(i64::from(i), n));
        (z * size.y as usize + y) * size.x as usize + x
    }

    /// Not less than any value at a cell.
    fn most(&self, index: usize) -> f32 {
        match &self.values.texels {
            Texels::Number(values) => values[index],
            Texels::Raw(values) => values[index].into_iter().fold(0.0, f32::max),
            Texels::Colour(_) => 1.0,
            Texels::Bright(values) => values[index][3],
        }
    }
}

/// The cell of a place.
#[inline]
fn floor(place: Vec3) -> IVec3 {
    place.floor().as_ivec3()
}

impl TextureModel for Grid {
    const VARIES: bool = true;

    #[inline]
    fn spectrum(&self, _: &TextureTable, _: &impl Shapes, at: &TexturePoint, lambda: Vec4) -> Vec4 {
        let value = match &self.values.texels {
            Texels::Number(values) => Vec4::splat(self.interpolate(at.position, |i| values[i])),
            Texels::Colour(values) => {
                self.interpolate(at.position, |i| RgbCoefficients(values[i]).eval(lambda))
            }
            Texels::Bright(values) => self.interpolate(at.position, |i| {
                let [a, b, c, scale] = values[i];
                RgbCoefficients([a, b, c]).eval(lambda) * scale
            }),
            Texels::Raw(values) => {
                let rgb = self.interpolate(at.position, |i| Vec3::from_array(values[i]));
                RgbCoefficients::from_rgb(rgb.to_array()).eval(lambda)
            }
        };
        // The spectrum of a bright colour may exceed what the colour does.
        if self.is_share {
            value.min(Vec4::ONE)
        } else {
            value
        }
    }

    #[inline]
    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        match &self.values.texels {
            Texels::Number(values) => self.interpolate(at.position, |i| values[i]),
            _ => recovered::luminance(self.colour(set, shapes, at)),
        }
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        match &self.values.texels {
            Texels::Number(values) => Vec3::splat(self.interpolate(at.position, |i| values[i])),
            Texels::Raw(values) => self.interpolate(at.position, |i| Vec3::from_array(values[i])),
            _ => recovered::colour(|lambda| self.spectrum(set, shapes, at, lambda)),
        }
    }

    fn mean(&self, _: &TextureTable) -> f32 {
        self.values.mean
    }

    fn is_constant(&self, _: &TextureTable) -> bool {
        self.size == UVec3::ONE
    }

    fn most_within(&self, _: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        self.within(low, high)
            .fold(0.0, |most, index| most.max(self.most(index)))
    }

    fn least_within(&self, _: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        let Texels::Number(values) = &self.values.texels else {
            return 0.0;
        };
        let least = (self.within(low, high)).fold(f32::INFINITY, |least, i| least.min(values[i]));
        if least.is_finite() { least } else { 0.0 }
    }

    fn extent(&self, _: &TextureTable) -> Option<[Vec3; 2]> {
        Some(self.bounds)
    }

    fn cells(&self, _: &TextureTable) -> u32 {
        self.size.max_element()
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }
}

impl Grid {
    /// All values that have a part in those within the world's box from `low` to `high`.
    fn within(&self, low: Vec3, high: Vec3) -> impl Iterator<Item = usize> {
        // The box's corners in the grid, with what interpolation reaches beyond.
        let corner = |i: u32| {
            let choose = |bit: u32, a: f32, b: f32| if i & bit == 0 { a } else { b };
            let p = Vec3::new(
                choose(1, low.x, high.x),
                choose(2, low.y, high.y),
                choose(4, low.z, high.z),
            );
            self.to_grid.transform_point3(p)
        };
        let (from, to) = (1..8)
            .map(corner)
            .fold((corner(0), corner(0)), |(from, to), p| {
                (from.min(p), to.max(p))
            });
        let last = self.size.as_ivec3() - 1;
        let (from, to) = match from.is_finite() && to.is_finite() {
            true => (floor(from - 0.51), floor(to + 0.51)),
            false => (IVec3::ZERO, last * 2 + 1),
        };
        let (from, to) = match self.wrap {
            Wrap::Clamp => (from.clamp(IVec3::ZERO, last), to.clamp(IVec3::ZERO, last)),
            // Mirrored or not, values repeat after twice the size.
            _ => (from, to.min(from.saturating_add(last * 2 + 1))),
        };
        let row = move |y, z| (from.x..=to.x).map(move |x| self.index(IVec3::new(x, y, z)));
        let plane = move |z| (from.y..=to.y).flat_map(move |y| row(y, z));
        (from.z..=to.z).flat_map(plane)
    }
}

/// Reads `filename`, `grid_name`, `to_world`, `use_grid_bbox`, `filter_type`, `wrap_mode`, `raw` and `max_value`.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let raw = params.boolean_or("raw", false);
    let filter = match params.choice("filter_type", "trilinear", &["trilinear", "nearest"]) {
        "nearest" => Filter::Nearest,
        _ => Filter::Bilinear,
    };
    let wrap = match params.choice("wrap_mode", "clamp", &["repeat", "mirror", "clamp"]) {
        "repeat" => Wrap::Repeat,
        "mirror" => Wrap::Mirror,
        _ => Wrap::Clamp,
    };
    let to_world = DAffine3::from_mat4(params.transform("to_world"));
    params.ignore(&["accel"]);
    if !params.has("filename") {
        params.missing("filename", "the name of a `.vol` or NanoVDB file");
    }
    let name = params.string("filename")?;
    let volume = reader
        .assets
        .bytes(name)
        .map_err(|error| file::report(params, error))
        .ok()?;
    // A NanoVDB file says where it is in the world.
    let by_place = nanovdb::is_nanovdb(&volume);
    let given = params.property("grid_name");
    let grid = given.and_then(|_| params.string("grid_name"));
    if !by_place && grid.is_some() {
        params.error_at(
            "grid_name",
            "a `.vol` file has one grid, and no name for it",
        );
    }
    let by_place = params.boolean_or("use_grid_bbox", by_place);
    let read = match nanovdb::is_nanovdb(&volume) {
        true => nanovdb::read(&volume, grid),
        false => VolFile::read(&volume),
    };
    let volume = read
        .map_err(|reason| params.error_at("filename", format!("`{name}` cannot be used: {reason}")))
        .ok()?;
    let is_share = role == SpectrumKind::Reflectance;
    let is_matrix = matches!(role, SpectrumKind::Raw(_));
    if is_matrix != volume.beside.is_some() {
        let message = match is_matrix {
            true => "a volume of matrices has six channels",
            false => "a volume of six channels is one of matrices, for `S` of `sggx`",
        };
        params.error_at("filename", message);
        return None;
    }
    for note in &volume.notes {
        let message = format!("`{name}`: {note}");
        let span = file::span_of_filename(params);
        (params.diagnostics).push(Diagnostic::note(span, message));
    }
    let place = match (by_place, volume.place) {
        (true, Some(place)) => to_world * place,
        (true, None) => {
            let message = format!("the box that `{name}` names is empty or not finite");
            let error = Diagnostic::error(file::span_of_filename(params), message);
            let help =
                "without `use_grid_bbox` the grid fills the unit cube, which `to_world` places";
            (params.diagnostics).push(error.help(help));
            return None;
        }
        (false, _) => to_world,
    };
    let to_grid = DAffine3::from_scale(volume.size.as_dvec3()) * place.inverse();
    if !(place.is_finite() && to_grid.is_finite()) {
        params.error_at(
            "to_world",
            "`to_world` of a volume must be finite and invertible",
        );
        return None;
    }
    let mut values = volume.values;
    if let Some(most) = params
        .property("max_value")
        .and_then(|_| params.float("max_value"))
    {
        scale_to(&mut values, most as f32);
    }
    let pixels = Pixels {
        size: UVec2::new(volume.size.x * volume.size.y, volume.size.z),
        values,
    };
    let corners = (0..8).map(|i| {
        let bit = |b: u32| f64::from(i >> b & 1);
        place
            .transform_point3(DVec3::new(bit(0), bit(1), bit(2)))
            .as_vec3()
    });
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = corners.fold(start, |(low, high), p| (low.min(p), high.max(p)));
    let beside = volume.beside.map(|beside| Pixels {
        size: pixels.size,
        values: Values::Three(beside),
    });
    let grid = Grid {
        size: volume.size,
        values: Arc::new(Image::new(pixels, raw || is_matrix, role, !is_share)),
        to_grid: Affine3A::from_mat4(DMat4::from(to_grid).as_mat4()),
        filter,
        wrap,
        is_share,
        bounds: [low, high],
    };
    if let Some(beside) = beside {
        let beside = Grid {
            values: Arc::new(Image::new(beside, true, role, true)),
            ..grid.clone()
        };
        let rest = reader.set.add(beside.into());
        reader.keep_rest(params.node, rest);
    }
    Some(grid.into())
}

/// `volume`: the surface shows the `volume` that it cuts through.
pub(crate) fn read_on_surface(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    purpose: Use,
) -> Option<Texture> {
    let id = reader.parameter_in(params, "volume", None, purpose);
    if purpose.role == SpectrumKind::Raw(0) && params.has("volume") {
        let role = SpectrumKind::Raw(3);
        let rest = reader.parameter_in(params, "volume", None, Use { role, ..purpose });
        reader.keep_rest(params.node, rest);
    }
    Some(reader.set.get(id).clone())
}

/// Scales values so that the largest is `most`.
fn scale_to(values: &mut Values, most: f32) {
    let all: &mut dyn Iterator<Item = &mut f32> = match values {
        Values::One(values) => &mut values.iter_mut(),
        Values::Three(values) => &mut values.iter_mut().flatten(),
    };
    let all: Vec<&mut f32> = all.collect();
    let largest = all
        .iter()
        .fold(0.0_f32, |largest, value| largest.max(**value));
    if largest > 0.0 {
        for value in all {
            *value *= most / largest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grid(wrap: Wrap, filter: Filter) -> Grid {
        let size = UVec3::new(3, 2, 2);
        // One value stands out.
        let values = (0..12).map(|i| if i == 7 { 9.0 } else { i as f32 / 12.0 });
        let pixels = Pixels {
            size: UVec2::new(6, 2),
            values: Values::One(values.collect()),
        };
        let to_grid = Affine3A::from_scale(size.as_vec3()) * Affine3A::from_rotation_z(0.3);
        Grid {
            size,
            values: Arc::new(Image::new(pixels, false, SpectrumKind::Unbounded, true)),
            to_grid,
            filter,
            wrap,
            is_share: false,
            bounds: [Vec3::ZERO, Vec3::ONE],
        }
    }

    proptest! {
        /// Near and far, inside and beyond the cube.
        #[test]
        fn no_value_in_a_box_exceeds_its_bound(
            low in prop::array::uniform3(-40.0_f32..40.0),
            side in 0.01_f32..1.5,
            part in prop::array::uniform3(0.0_f32..1.0),
            wrap in prop::sample::select(vec![Wrap::Clamp, Wrap::Repeat, Wrap::Mirror]),
            filter in prop::sample::select(vec![Filter::Bilinear, Filter::Nearest]),
            near in prop::bool::ANY,
        ) {
            let low = Vec3::from_array(low) * if near { 0.05 } else { 1.0 };
            let grid = grid(wrap, filter);
            let bound = grid.most_within(&TextureTable::new(), low, low + side);
            let at = low + side * Vec3::from_array(part);
            let Texels::Number(values) = &grid.values.texels else { unreachable!() };
            let value = grid.interpolate(at, |i| values[i]);
            prop_assert!(value <= bound * 1.0001, "{value} {bound}");
        }
    }
}
