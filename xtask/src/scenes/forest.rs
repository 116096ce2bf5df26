//! A forest: two trees as meshes, and a scene fragment with where each of them stands.
//!
//! Both trees are a few thousand triangles; 600 instances make more than a million.

use super::ply::{Mesh, cross, normalised};
use super::sequence::halton;
use etalon_math::float64::{cos, pow, sin};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Instances along each side of the wood.
const COLUMNS: u32 = 24;
const ROWS: u32 = 25;

/// The files with their names.
pub(crate) fn files() -> Vec<(&'static str, Vec<u8>)> {
    let (fir, needles) = fir();
    let (oak, leaves) = oak();
    let instanced = (COLUMNS * ROWS / 2) as usize;
    let triangles = instanced * (fir.len() + needles.len() + oak.len() + leaves.len());
    println!("forest: {triangles} instanced triangles");
    vec![
        ("fir-wood.ply", fir.to_ply()),
        ("fir-needles.ply", needles.to_ply()),
        ("oak-wood.ply", oak.to_ply()),
        ("oak-leaves.ply", leaves.to_ply()),
        ("trees.xml", places().into_bytes()),
    ]
}

/// A fir of height 1: whorls of drooping branches with pairs of needles.
fn fir() -> (Mesh, Mesh) {
    let (mut wood, mut needles) = (Mesh::default(), Mesh::default());
    wood.tube([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.022, 0.002], 8);
    for whorl in 0..16 {
        let t = f64::from(whorl) / 16.0;
        let height = 0.12 + 0.85 * t;
        let reach = 0.27 * (1.0 - t) + 0.02;
        for branch in 0..9 {
            let angle = TAU * (f64::from(branch) + halton(1, whorl)) / 9.0;
            let out = [cos(angle), sin(angle)];
            let at = |s: f64| {
                [
                    reach * s * out[0],
                    height - 0.35 * reach * s * s,
                    reach * s * out[1],
                ]
            };
            for step in 0..7 {
                let s = (f64::from(step) + 0.6) / 7.0;
                let root = at(s);
                let tip = at(s + 0.22);
                let width = 0.055 * (1.15 - s) * (1.2 - t);
                for side in [-1.0, 1.0] {
                    let corner = [
                        root[0] - side * width * out[1],
                        root[1] - 0.25 * width,
                        root[2] + side * width * out[0],
                    ];
                    needles.triangle([root, corner, tip]);
                }
            }
        }
    }
    (wood, needles)
}

/// A broad-leaved tree of height 1: a trunk, boughs, and a crown of leaves on an ellipsoid.
fn oak() -> (Mesh, Mesh) {
    let (mut wood, mut leaves) = (Mesh::default(), Mesh::default());
    let fork = [0.0, 0.4, 0.0];
    wood.tube([0.0, 0.0, 0.0], fork, [0.04, 0.025], 10);
    for bough in 0..10 {
        let angle = TAU * (f64::from(bough) * 0.381_966);
        let rise = 0.25 + 0.3 * halton(0, bough);
        let tip = [0.24 * cos(angle), 0.4 + rise, 0.24 * sin(angle)];
        wood.tube(fork, tip, [0.016, 0.004], 6);
    }
    for leaf in 0..1600 {
        let [a, b, c] = [halton(0, leaf), halton(1, leaf), halton(2, leaf)];
        let z = 2.0 * a - 1.0;
        let (ring, angle) = ((1.0 - z * z).sqrt(), TAU * b);
        let depth = pow(c, 0.25);
        let lumps = 1.0 + 0.13 * sin(5.0 * angle) * sin(4.0 * z);
        let direction = [ring * cos(angle), z, ring * sin(angle)];
        let radius = depth * lumps;
        let centre = [
            0.31 * radius * direction[0],
            0.68 + 0.29 * radius * direction[1],
            0.31 * radius * direction[2],
        ];
        let tilt: [f64; 3] = std::array::from_fn(|i| halton(3 + i, leaf) - 0.5);
        let normal = normalised(std::array::from_fn(|i| direction[i] + 1.6 * tilt[i]));
        let along = normalised(cross(normal, [tilt[1], 0.3, tilt[0] + 0.01]));
        let across = cross(normal, along);
        let size = 0.017 + 0.012 * halton(6, leaf);
        let corner = |u: f64, v: f64| -> [f64; 3] {
            std::array::from_fn(|i| centre[i] + size * (u * along[i] + v * across[i]))
        };
        leaves.triangle([corner(-1.2, 0.0), corner(0.0, -0.7), corner(1.2, 0.0)]);
        leaves.triangle([corner(-1.2, 0.0), corner(1.2, 0.0), corner(0.0, 0.7)]);
    }
    (wood, leaves)
}

/// The instances, as a scene to be included.
fn places() -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
         <!-- Where the trees stand; written by `cargo xtask scenes`. -->\n<scene version=\"3.0.0\">\n",
    );
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let index = row * COLUMNS + column;
            let jitter = |dimension: usize| halton(dimension, index) - 0.5;
            let x = 1.1 * (f64::from(column) - 0.5 * f64::from(COLUMNS - 1) + 0.8 * jitter(0));
            let z = -1.1 * (f64::from(row) + 0.8 * jitter(1));
            let kind = if index % 2 == row % 2 { "fir" } else { "oak" };
            let size = if kind == "fir" { 2.3 } else { 1.7 } * (1.0 + 0.5 * jitter(2));
            let turn = 360.0 * halton(3, index);
            let _ = writeln!(
                text,
                "    <shape type=\"instance\"><ref id=\"{kind}\"/><transform name=\"to_world\">\
                 <scale value=\"{size:.4}\"/><rotate y=\"1\" angle=\"{turn:.3}\"/>\
                 <translate x=\"{x:.4}\" z=\"{z:.4}\"/></transform></shape>"
            );
        }
    }
    text + "</scene>\n"
}
