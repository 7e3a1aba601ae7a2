//! Tables: what they refuse, and the way back through them. Densities and inverses of all maps are rows of the battery.

use glam::Vec2;
use proptest::prelude::*;
use radianza::warp::{Table1, Table2};

#[test]
fn table_refuses_what_is_no_density() {
    for weights in [&[][..], &[0.0, 0.0], &[1.0, -1.0], &[1.0, f32::NAN], &[f32::INFINITY]] {
        assert!(Table1::new(weights).is_none(), "{weights:?}");
        assert!(Table2::new(weights, [weights.len(), 1]).is_none(), "{weights:?}");
    }
    assert!(Table2::new(&[1.0; 6], [2, 2]).is_none());
    assert!(Table2::new(&[1.0; 4], [usize::MAX, 2]).is_none());
    assert!(Table2::new(&[f32::MAX; 4], [2, 2]).is_some());
}

fn close(a: [f32; 2], b: [f32; 2], tolerance: f32) -> bool {
    (Vec2::from(a) - Vec2::from(b)).abs().max_element() <= tolerance
}

proptest! {
    #[test]
    fn tables_invert(weights in prop::collection::vec(0.0f32..10.0, 12), u in [0.0f32..1.0, 0.0f32..1.0]) {
        prop_assume!(weights.iter().any(|&w| w > 1e-3));
        let one = Table1::new(&weights).unwrap();
        let draw = one.sample(u[0]);
        prop_assert!((0.0..1.0).contains(&draw.x));
        // An entry of small probability spreads u over more of x than x can hold.
        prop_assert!((one.inverse(draw.x) - u[0]).abs() < 1e-6 * draw.pdf.max(1.0));
        let (index, probability, left) = one.choose(u[0]);
        prop_assert_eq!((index, probability), (draw.index, one.probability(index)));
        prop_assert!((0.0..1.0).contains(&left));
        let two = Table2::new(&weights, [4, 3]).unwrap();
        let draw = two.sample(u);
        prop_assert!(close(two.inverse(draw.p), u, 1e-5), "{:?} {:?}", two.inverse(draw.p), u);
    }
}

#[test]
fn rounding_carries_no_draw_into_an_entry_without_weight() {
    for n in 1..400 {
        let weights: Vec<f32> = (0..n).map(|i| if i % 2 == 0 { 1.0 } else { 0.0 }).collect();
        let one = Table1::new(&weights).unwrap();
        let rows = Table2::new(&weights, [1, n]).unwrap();
        let columns = Table2::new(&weights, [n, 1]).unwrap();
        // Both ends of every entry.
        let ends = (0..n).flat_map(|i| [one.inverse(i as f32 / n as f32), one.inverse((i + 1) as f32 / n as f32)]);
        for u in ends.flat_map(|u| [u, u.next_down().max(0.0)]) {
            let draw = one.sample(u);
            assert_eq!((draw.pdf > 0.0, one.pdf(draw.x)), (true, draw.pdf), "{n} {u}");
            let (row, column) = (rows.sample([0.5, u]), columns.sample([u, 0.5]));
            assert_eq!((rows.pdf(row.p), columns.pdf(column.p)), (row.pdf, column.pdf), "{n} {u}");
        }
    }
}
