//! Large triangles in a slant, taken apart: the box of a long thin triangle is nearly empty, those of its parts are not.

use super::Aabb;
use crate::math::UNIT_ROUNDOFF;
use glam::Vec3;
use obvhs::aabb::Aabb as ObvhsAabb;
use obvhs::splits::split_aabbs_preset;
use obvhs::triangle::Triangle;

/// Boxes, and the triangle that each belongs to, in place of `boxes` of `triangles`; those of a triangle cover it together.
///
/// obvhs cuts where it saves most area (Ganestam & Doggett 2016, "SAH guided spatial split partitioning", is alike). A
/// cut is rounded: a corner of a part is v₀ + t (v₁ − v₀), which is off by less than 16 u max|v|, and each part is
/// widened by that, so that no ray slips between two.
pub(super) fn split(triangles: &[[Vec3; 3]], boxes: &[Aabb]) -> (Vec<Aabb>, Vec<u32>) {
    let mut parts: Vec<ObvhsAabb> = boxes.iter().map(|b| ObvhsAabb::new(b.min.into(), b.max.into())).collect();
    let mut owners: Vec<u32> = (0..triangles.len() as u32).collect();
    let areas = parts.iter().map(ObvhsAabb::half_area);
    let (sum, largest) = areas.fold((0f64, 0f32), |(sum, most), area| (sum + f64::from(area), most.max(area)));
    let mean = (sum / parts.len().max(1) as f64) as f32;
    // What is too large to be compared is left whole.
    if largest.is_finite() {
        let corners = |t: &[Vec3; 3]| Triangle { v0: t[0].into(), v1: t[1].into(), v2: t[2].into() };
        let triangles: Vec<Triangle> = triangles.iter().map(corners).collect();
        split_aabbs_preset(&mut parts, &mut owners, &triangles, mean, largest);
    }
    let widened = parts.iter().zip(&owners).map(|(part, &owner)| {
        let whole = boxes[owner as usize];
        let error = triangles[owner as usize].iter().fold(Vec3::ZERO, |e, v| e.max(v.abs())) * (16.0 * UNIT_ROUNDOFF);
        Aabb { min: (Vec3::from(part.min) - error).max(whole.min), max: (Vec3::from(part.max) + error).min(whole.max) }
    });
    (widened.collect(), owners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::{Kind, Sampler};

    #[test]
    fn the_parts_of_a_triangle_cover_it() {
        let mut u = Sampler::new(Kind::Independent, 5, [0, 0], 0, 1);
        let mut point = |size: f32| (Vec3::new(u.next_1d(), u.next_1d(), u.next_1d()) * 2.0 - 1.0) * size;
        // Long ones among many short ones.
        let mut triangles = Vec::new();
        for i in 0..400 {
            let (centre, size) = (point(10.0), if i % 8 == 0 { 30.0 } else { 0.1 });
            let [a, b] = [point(size), point(0.02)];
            triangles.push([centre, centre + a, centre + a + b]);
        }
        let boxes: Vec<Aabb> = triangles.iter().map(|t| Aabb::of(*t)).collect();
        let (parts, owners) = split(&triangles, &boxes);
        assert!(parts.len() > boxes.len() + 50, "{} parts of {}", parts.len(), boxes.len());
        let area = |b: &Aabb| (b.max - b.min).x * (b.max - b.min).y;
        assert!(parts.iter().map(area).sum::<f32>() < 0.5 * boxes.iter().map(area).sum::<f32>());
        for (t, corners) in triangles.iter().enumerate() {
            let own: Vec<&Aabb> = parts.iter().zip(&owners).filter(|(_, o)| **o == t as u32).map(|(p, _)| p).collect();
            for i in 0..=100 {
                for v in [0.0, 0.3, 0.7, 1.0] {
                    let along = i as f32 / 100.0;
                    let p = corners[0] + (corners[1] - corners[0]) * along + (corners[2] - corners[1]) * (along * v);
                    // The point itself is rounded.
                    let e = 4.0 * UNIT_ROUNDOFF * (corners[0].abs() + corners[1].abs());
                    let inside = |b: &&Aabb| (b.min - e).cmple(p).all() && p.cmple(b.max + e).all();
                    assert!(own.iter().any(inside), "{p} of {corners:?} is in no part");
                }
            }
        }
    }
}
