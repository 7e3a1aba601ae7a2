//! The triangles of a primitive, whatever its mode.

use gltf::json::mesh::Mode;

/// Triangles over `count` vertices in the order of their use; `None` for points and lines (glTF 2.0, section 3.7.2.1).
/// Vertices that complete no triangle are left over.
pub(super) fn assemble(mode: Mode, count: usize, vertex: impl Fn(usize) -> u32) -> Option<Vec<[u32; 3]>> {
    let pick = |t: [usize; 3]| t.map(&vertex);
    let strip = count.saturating_sub(2);
    match mode {
        Mode::Triangles => Some((0..count / 3).map(|i| pick([3 * i, 3 * i + 1, 3 * i + 2])).collect()),
        // Every other triangle of a strip runs the other way round.
        Mode::TriangleStrip => Some((0..strip).map(|i| pick([i, i + 1 + i % 2, i + 2 - i % 2])).collect()),
        Mode::TriangleFan => Some((0..strip).map(|i| pick([i + 1, i + 2, 0])).collect()),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_follow_the_specification() {
        let of = |mode, count| assemble(mode, count, |i| i as u32 + 10);
        assert_eq!(of(Mode::Triangles, 7), Some(vec![[10, 11, 12], [13, 14, 15]]));
        assert_eq!(of(Mode::TriangleStrip, 5), Some(vec![[10, 11, 12], [11, 13, 12], [12, 13, 14]]));
        assert_eq!(of(Mode::TriangleFan, 4), Some(vec![[11, 12, 10], [12, 13, 10]]));
        assert_eq!(of(Mode::TriangleFan, 2), Some(vec![]));
        assert_eq!(of(Mode::LineStrip, 4), None);
    }
}
