//! The files that the shapes of the tests are read from.

use crate::curve_files::{as_bezier, good_curves};
use etalon_transport::{AssetError, Assets, Attribute, MeshData, MeshFormat, OpenFile, in_memory};
use glam::{DVec3, Vec2, Vec3};
use std::sync::Arc;

/// A directory of files.
pub(crate) struct Files;

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError> {
        let text = match path {
            "good" => good_curves(),
            "bezier" => as_bezier(&good_curves()),
            "strands" => "0 0 0\n0 0 1\n0 0.5 1.5".to_owned(),
            "short" => "0 0 0 1\n1 0 0 1\n\n2 0 0 1".into(),
            "words" => "0 0 zero 1".into(),
            "volume" => return Ok(Arc::new(good_volume())),
            "picture" => return Ok(Arc::new(b"P5 3 2 255\n\x00\x80\xff\x33\x66\x99".to_vec())),
            "line" => return Ok(Arc::new(b"P5 3 1 255\n\x00\x80\xff".to_vec())),
            "flat" => return Ok(Arc::new(volume([2; 3], |_| 1.0))),
            "three" => "0 0 0 1\n1 0 0 1\n2 0 0 1\n".into(),
            _ => {
                return Err(AssetError {
                    message: format!("no file `{path}`"),
                    help: None,
                });
            }
        };
        Ok(Arc::new(text.into_bytes()))
    }

    fn open(&self, path: &str) -> Result<Box<dyn OpenFile>, AssetError> {
        self.bytes(path).map(in_memory)
    }

    fn mesh(&self, format: MeshFormat, path: &str) -> Result<MeshData, AssetError> {
        if format == MeshFormat::PlyPoints
            && let Some(data) = points(path)
        {
            return Ok(data);
        }
        let mut data = MeshData {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::new(0.0, 0.25)],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        };
        match path {
            "good" => {}
            "nan" => data.positions[1].y = f32::NAN,
            "index" => data.triangles[0][2] = 3,
            "empty" => data.triangles.clear(),
            "faceted" => {
                data.normals = vec![Vec3::new(0.6, 0.0, 0.8); 3];
                data.face_normals = true;
                data.notes = vec!["it is odd".into()];
            }
            _ => {
                return Err(AssetError {
                    message: format!("no file `{path}`"),
                    help: Some("try `good`".into()),
                });
            }
        }
        Ok(data)
    }
}

/// A bicubic patch over the square [0, 3]².
pub(crate) fn good_patch() -> String {
    let height = |i: i32, j: i32| i * j - 3 * i + j * j;
    let points = (0..16).map(|k| format!("{} {} {}", k % 4, k / 4, height(k % 4, k / 4)));
    points.collect::<Vec<_>>().join(", ")
}

/// A volume file of one channel in the unit cube.
pub(crate) fn volume(size: [usize; 3], f: impl Fn(DVec3) -> f64) -> Vec<u8> {
    let mut bytes = b"VOL\x03".to_vec();
    let [x, y, z] = size.map(|n| n as i32);
    for word in [1, x, y, z, 1] {
        bytes.extend(word.to_le_bytes());
    }
    for corner in [0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0] {
        bytes.extend(corner.to_le_bytes());
    }
    let most = DVec3::from(size.map(|n| n as f64 - 1.0));
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in 0..size[0] {
                let p = DVec3::new(x as f64, y as f64, z as f64) / most;
                bytes.extend((f(p) as f32).to_le_bytes());
            }
        }
    }
    bytes
}

/// A coarse grid of two balls that have grown together and of a wave.
pub(crate) fn good_volume() -> Vec<u8> {
    volume([9, 8, 7], volume_function)
}

/// What the grid of [`good_volume`] samples.
pub(crate) fn volume_function(p: DVec3) -> f64 {
    let ball = |x: f64, y: f64, r: f64| (p - DVec3::new(x, y, 0.5)).length() - r;
    let wave = 0.06 * etalon_math::float64::sin(9.0 * p.x + 7.0 * p.z);
    ball(0.35, 0.4, 0.25).min(ball(0.65, 0.6, 0.25)) + wave
}

/// A ball of radius 3/5 around the origin, as a cloud of ellipsoids.
pub(crate) const ONE_BALL: &str =
    "vertex_scale:3,vertex_rot:4|0 0 0 -1.6094379 -1.6094379 -1.6094379 1 0 0 0";

/// A file of points whose name is its contents: `NAME:CHANNELS,…|x y z …;…`, the attributes and then a row for each point.
fn points(contents: &str) -> Option<MeshData> {
    let (names, rows) = contents.split_once('|')?;
    let number = |word: &str| word.parse().expect("a number");
    let rows = rows.split(';');
    let rows: Vec<Vec<f32>> = rows
        .map(|row| row.split_whitespace().map(number).collect())
        .collect();
    let mut at = 3;
    let attributes = names.split(',').map(|name| {
        let (name, channels) = name.split_once(':').expect("channels");
        let channels = channels.parse().expect("a count");
        at += channels;
        let values = |row: &Vec<f32>| row[at - channels..at].to_vec();
        Attribute {
            name: name.to_owned(),
            channels,
            values: rows.iter().flat_map(values).collect(),
        }
    });
    Some(MeshData {
        attributes: attributes.collect(),
        positions: rows.iter().map(|row| Vec3::from_slice(row)).collect(),
        ..MeshData::default()
    })
}
