//! What a file holds that a scene may name: volumes, measured materials, curves.

use etalon_geometry::control_points;
use etalon_images::Volume;
use etalon_tables::BrdfTable;
use etalon_tables::tensor_file::{MAGIC, TensorFile};
use etalon_textures::nanovdb;

/// Says what a file holds, by its beginning; `None` if it is of no kind known here.
pub fn describe(bytes: &[u8]) -> Option<Result<String, String>> {
    if bytes.starts_with(b"VOL") || bytes.starts_with(b" BDV") {
        return Some(Volume::decode(bytes).map(|volume| of_volume(&volume)));
    }
    if nanovdb::is_nanovdb(bytes) {
        return Some(nanovdb::summary(bytes));
    }
    if bytes.starts_with(MAGIC) {
        let file = TensorFile::parse(bytes).map_err(|error| error.to_string());
        let list = file.map(|file| format!("tensor file, with the fields\n{}", file.summary()));
        return Some(list.and_then(|list| of_material(bytes).map(|kind| kind + &list)));
    }
    if let Ok(kind) = of_material(bytes) {
        return Some(Ok(kind));
    }
    control_points::summary(bytes).map(Ok)
}

fn of_volume(volume: &Volume) -> String {
    let [x, y, z] = volume.size;
    let (channels, [low, high]) = (volume.channels, volume.bounds);
    let finite = || volume.samples.iter().copied().filter(|v| v.is_finite());
    let (least, most) = finite().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let mut text = format!(
        "volume       {x} × {y} × {z} values of {channels} channels, 32-bit floats\n\
         box          {low:?} to {high:?}\n\
         values       {least} to {most}\n"
    );
    let count = volume.samples.len() - finite().count();
    if count > 0 {
        text += &format!("not finite   {count} values\n");
    }
    if volume.behind > 0 {
        text += &format!("behind       {} bytes after the values\n", volume.behind);
    }
    text
}

fn of_material(bytes: &[u8]) -> Result<String, String> {
    let table = BrdfTable::parse(bytes).map_err(|error| error.to_string())?;
    Ok(format!("material     {}\n", table.kind()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_by_their_beginning() {
        let mut volume = b"VOL\x03".to_vec();
        for word in [1, 2, 1, 1, 1] {
            volume.extend(i32::to_le_bytes(word));
        }
        for x in [0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0, 0.5, 2.0] {
            volume.extend(x.to_le_bytes());
        }
        let text = describe(&volume).expect("a volume").expect("sound");
        assert!(text.contains("2 × 1 × 1 values of 1 channels"), "{text}");
        assert!(text.contains("values       0.5 to 2"), "{text}");
        assert!(describe(&volume[..50]).expect("a volume").is_err());
        let text = describe(b"0 0 0 1\n1 0 0 .5\n\n0 0 0 1\n0 1 0 1\n").expect("curves");
        assert!(
            text.expect("sound")
                .starts_with("curves       2 with 4 control points")
        );
        assert!(describe(b"hello world\n").is_none());
    }
}
