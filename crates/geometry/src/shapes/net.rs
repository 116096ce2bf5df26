//! Smooth surfaces as nets of triangles: `bicubic`, `heightfield`.
//!
//! A point (u, v) of the net lies on the surface and has its normal; between points it is flat. A net of n × n cells
//! is off a surface of second derivatives up to M by M/(4n²) at most (the error of linear interpolation, twice).

use crate::placement::Placement;
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::profile::numbers;
use crate::shapes::shape_model::read_flip;
use etalon_images::raster_file;
use etalon_math::bernstein;
use etalon_params::Params;
use etalon_spectrum::colour_space::LUMINANCE_WEIGHTS;
use etalon_transport::file;
use etalon_transport::{Build, MeshData};
use glam::{DVec3, Vec2};
use std::path::Path;

/// A net's points and normals at (column, row).
type Points<'a> = &'a dyn Fn(usize, usize) -> (DVec3, DVec3);

/// Reads `face_normals`, `flip_normals` and `to_world` of a net of so many columns and rows of points.
fn net(params: &Params<'_>, surface: Option<([usize; 2], Points<'_>)>) -> Option<Mesh> {
    let placement = Placement::from_params(params);
    let face_normals = params.boolean_or("face_normals", false);
    let flip_normals = read_flip(params);
    let ([columns, rows], point) = surface?;
    let mut data = MeshData::default();
    for row in 0..rows {
        for column in 0..columns {
            let (position, normal) = point(column, row);
            data.positions.push(position.as_vec3());
            data.normals.push(normal.normalize_or_zero().as_vec3());
            let [u, v] = [(column, columns), (row, rows)].map(|(k, n)| k as f32 / (n - 1) as f32);
            data.uvs.push(Vec2::new(u, v));
        }
    }
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let [a, b] = [row, row + 1].map(|row| (row * columns + column) as u32);
            data.triangles.extend([[a, a + 1, b], [a + 1, b + 1, b]]);
        }
    }
    let options = MeshOptions {
        placement: placement?,
        face_normals,
        flip_normals,
        ..MeshOptions::default()
    };
    Mesh::new(data, &options)
        .map_err(|message| params.error_at("to_world", message))
        .ok()
}

/// The bicubic Bézier patch p(u, v) = Σᵢⱼ Bᵢ(u) Bⱼ(v) pᵢⱼ: reads `points`, four rows of four, u first, and `steps` (32),
/// cells along each side.
pub(crate) fn bicubic(params: &Params<'_>) -> Option<Mesh> {
    let what = "sixteen points, u first: 48 numbers";
    let points = numbers(params, "points", what).and_then(|numbers| {
        let points: Vec<DVec3> = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
        let points = <[DVec3; 16]>::try_from(points).ok();
        let points = points.filter(|_| numbers.len() == 48);
        if points.is_none() {
            let count = numbers.len();
            params.error_at(
                "points",
                format!("`points` has {count} numbers; it takes {what}"),
            );
        }
        points
    });
    let asked = params.integer_or("steps", 32);
    let steps = usize::try_from(asked)
        .ok()
        .filter(|n| (1..=1024).contains(n));
    if steps.is_none() {
        params.refuse("steps", asked, "a whole number from 1 to 1024");
    }
    let (points, steps) = points.zip(steps)?;
    // The point and its derivatives; a normal from near by where a side has no length.
    let at = |u: f64, v: f64| {
        let curve = |points: [DVec3; 4], s: f64| {
            let value = |axis: usize| bernstein::value(&points.map(|p| p[axis]), s);
            let slope = |axis: usize| {
                let slopes = [0, 1, 2].map(|i| 3.0 * (points[i + 1] - points[i])[axis]);
                bernstein::value(&slopes, s)
            };
            let of = |f: &dyn Fn(usize) -> f64| DVec3::new(f(0), f(1), f(2));
            (of(&value), of(&slope))
        };
        let along_u = [0, 1, 2, 3].map(|j| {
            let row = core::array::from_fn(|i| points[4 * j + i]);
            curve(row, u)
        });
        let (point, dv) = curve(along_u.map(|(p, _)| p), v);
        let (du, _) = curve(along_u.map(|(_, d)| d), v);
        (point, du.cross(dv))
    };
    let point = |column: usize, row: usize| {
        let [u, v] = [column, row].map(|k| k as f64 / steps as f64);
        let (point, normal) = at(u, v);
        let inner = |x: f64| x + (0.5 - x) * 1e-4;
        let normal = match normal.try_normalize() {
            Some(normal) => normal,
            None => at(inner(u), inner(v)).1,
        };
        (point, normal)
    };
    net(params, Some(([steps + 1; 2], &point)))
}

/// A picture as heights over the square [−1, 1]², its first row at y = 1: reads `filename`, `height` (1) of white, and `raw`
/// (true), whether the numbers of the file are heights, or the luminance of its colours.
pub(crate) fn heightfield(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    let height = params.float_or("height", 1.0);
    let raw = params.boolean_or("raw", true);
    let what = "a picture of two pixels or more along each side";
    let picture = file::read(params, build, what, |bytes| {
        let name = params.string("filename").unwrap_or_default();
        let picture =
            raster_file::decode(bytes, Path::new(name)).map_err(|error| error.to_string())?;
        if picture.width() < 2 || picture.height() < 2 {
            return Err("it has less than two pixels along a side".into());
        }
        Ok(picture)
    });
    let Some(picture) = picture else {
        return net(params, None);
    };
    let (columns, rows, channels) = (picture.width(), picture.height(), picture.channels());
    let (floats, weights) = match raw {
        true => (picture.to_floats(), [1.0 / 3.0; 3]),
        false => (picture.to_linear(), LUMINANCE_WEIGHTS),
    };
    let value = |column: usize, row: usize| {
        let first = ((rows - 1 - row) * columns + column) * channels;
        let pixel = &floats[first..first + channels];
        let weighted = |(&x, w): (&f32, f64)| f64::from(x) * w;
        height
            * match channels {
                1 | 2 => f64::from(pixel[0]),
                _ => pixel.iter().zip(weights).map(weighted).sum::<f64>(),
            }
    };
    let step = [columns, rows].map(|n| 2.0 / (n as f64 - 1.0));
    let point = |column: usize, row: usize| {
        let [x, y] = [(column, 0), (row, 1)].map(|(k, axis)| k as f64 * step[axis] - 1.0);
        // The slope between the neighbours.
        let around = |k: usize, n: usize| (k.saturating_sub(1), (k + 1).min(n - 1));
        let ((left, right), (below, above)) = (around(column, columns), around(row, rows));
        let dx = value(right, row) - value(left, row);
        let dy = value(column, above) - value(column, below);
        let [wide, deep] = [((right - left) as f64, 0), ((above - below) as f64, 1)]
            .map(|(count, axis)| count * step[axis]);
        (
            DVec3::new(x, y, value(column, row)),
            DVec3::new(-dx / wide, -dy / deep, 1.0),
        )
    };
    net(params, Some(([columns, rows], &point)))
}
