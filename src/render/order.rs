//! The order in which tiles are rendered.

/// A rectangle of the image: x0, y0, x1, y1, upper ends excluded.
pub(super) type Area = [u32; 4];

/// Tiles of `side` pixels that cover the window, along a Hilbert curve (Hilbert 1891): successive tiles are neighbours, so
/// that their rays meet what is still in the caches, whichever threads take them.
pub(super) fn tiles([x0, y0, x1, y1]: Area, side: u32) -> Vec<Area> {
    let side = side.max(1);
    let (across, down) = ((x1 - x0).div_ceil(side), (y1 - y0).div_ceil(side));
    let order = across.max(down).next_power_of_two().ilog2();
    let mut places: Vec<(u64, u32, u32)> =
        (0..down).flat_map(|y| (0..across).map(move |x| (along(order, x, y), x, y))).collect();
    places.sort_unstable();
    let area = |(_, x, y): (u64, u32, u32)| {
        let (x, y) = (x0 + x * side, y0 + y * side);
        [x, y, x.saturating_add(side).min(x1), y.saturating_add(side).min(y1)]
    };
    places.into_iter().map(area).collect()
}

/// Place of the cell (x, y) along the curve through 2^`order` × 2^`order` cells: of each quarter's bits, outermost first,
/// with what is left turned so that the curve through the quarter begins at its origin and ends beside it.
fn along(order: u32, mut x: u32, mut y: u32) -> u64 {
    let mut place = 0;
    for level in (0..order).rev() {
        let (right, up) = (x >> level & 1, y >> level & 1);
        place = place << 2 | u64::from((3 * right) ^ up);
        if up == 0 {
            if right == 1 {
                let last = (1 << level) - 1;
                (x, y) = (last ^ (x & last), last ^ (y & last));
            }
            (x, y) = (y, x);
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_every_cell_and_steps_to_neighbours() {
        let n = 1 << 5;
        let mut cells = vec![None; (n * n) as usize];
        for (x, y) in (0..n).flat_map(|y| (0..n).map(move |x| (x, y))) {
            assert_eq!(cells[along(5, x, y) as usize].replace((x, y)), None);
        }
        for pair in cells.windows(2) {
            let ((ax, ay), (bx, by)) = (pair[0].unwrap(), pair[1].unwrap());
            assert_eq!(ax.abs_diff(bx) + ay.abs_diff(by), 1);
        }
    }

    #[test]
    fn tiles_cover_the_window_once() {
        let window = [3, 5, 103, 70];
        let mut seen = vec![0; 100 * 65];
        for [x0, y0, x1, y1] in tiles(window, 16) {
            (y0..y1).for_each(|y| (x0..x1).for_each(|x| seen[((y - 5) * 100 + x - 3) as usize] += 1));
        }
        assert!(seen.iter().all(|&n| n == 1));
        assert_eq!(tiles([0, 0, 1, 1], 64), [[0, 0, 1, 1]]);
    }
}
