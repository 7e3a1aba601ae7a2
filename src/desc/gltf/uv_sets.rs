//! TEXCOORD_n, of which a primitive may have many: a mesh holds two sets, and each material says which two.

/// The sets of the file that the textures of one material look at, by their place in [`Mesh::uv`](crate::desc::Mesh).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct UvSets([Option<u32>; 2]);

impl UvSets {
    /// The place of TEXCOORD_`set`, which is given one if need be: 0 and 1 their own where it is free. `None` where two
    /// other sets have both.
    pub(super) fn place(&mut self, set: u32) -> Option<usize> {
        let own = set.min(1) as usize;
        let places = [own, 1 - own];
        let known = places.into_iter().find(|p| self.0[*p] == Some(set));
        let place = known.or_else(|| places.into_iter().find(|p| self.0[*p].is_none()))?;
        self.0[place] = Some(set);
        Some(place)
    }

    /// n of the TEXCOORD_n at both places; 0 and 1 where no texture asks for another.
    pub(super) fn numbers(self) -> [u32; 2] {
        [self.0[0].unwrap_or(0), self.0[1].unwrap_or(1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_sets_of_any_number() {
        let of = |asked: &[u32]| {
            let mut sets = UvSets::default();
            (asked.iter().map(|set| sets.place(*set)).collect::<Vec<_>>(), sets.numbers())
        };
        assert_eq!(of(&[]), (vec![], [0, 1]));
        assert_eq!(of(&[1, 0, 1]), (vec![Some(1), Some(0), Some(1)], [0, 1]));
        assert_eq!(of(&[5, 0, 5]), (vec![Some(1), Some(0), Some(1)], [0, 5]));
        assert_eq!(of(&[5, 1, 5]), (vec![Some(1), Some(0), Some(1)], [1, 5]));
        assert_eq!(of(&[7, 5, 0]), (vec![Some(1), Some(0), None], [5, 7]));
        assert_eq!(of(&[u32::MAX]), (vec![Some(1)], [0, u32::MAX]));
    }
}
