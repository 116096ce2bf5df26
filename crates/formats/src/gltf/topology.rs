//! From the vertices in their order to triangles (glTF 2.0, §3.7.2.1): lists, strips and fans.

use ::gltf::mesh::Mode;

/// The triangles of `count` corners, of which the i-th is the vertex `corner(i)`; `None` if the mode has none.
pub(crate) fn triangles(
    mode: Mode,
    count: usize,
    corner: impl Fn(usize) -> u32,
) -> Option<Vec<[u32; 3]>> {
    let strip = count.saturating_sub(2);
    let of = |corners: [usize; 3]| corners.map(&corner);
    Some(match mode {
        Mode::Triangles => (0..count / 3)
            .map(|i| of([3 * i, 3 * i + 1, 3 * i + 2]))
            .collect(),
        // Every other triangle is turned over, so that all have the same side in front.
        Mode::TriangleStrip => (0..strip)
            .map(|i| of([i, i + 1 + i % 2, i + 2 - i % 2]))
            .collect(),
        Mode::TriangleFan => (0..strip).map(|i| of([i + 1, i + 2, 0])).collect(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::triangles;
    use ::gltf::mesh::Mode;

    #[test]
    fn strips_and_fans_keep_their_sides() {
        let found = |mode, count| triangles(mode, count, |i| i as u32 + 10);
        let list = vec![[10, 11, 12], [13, 14, 15]];
        assert_eq!(found(Mode::Triangles, 7), Some(list));
        let strip = vec![[10, 11, 12], [11, 13, 12], [12, 13, 14]];
        assert_eq!(found(Mode::TriangleStrip, 5), Some(strip));
        let fan = vec![[11, 12, 10], [12, 13, 10]];
        assert_eq!(found(Mode::TriangleFan, 4), Some(fan));
        assert_eq!(found(Mode::TriangleStrip, 1), Some(Vec::new()));
        assert_eq!(found(Mode::Lines, 4), None);
    }
}
