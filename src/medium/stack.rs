//! Nested dielectrics (Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray Traced Images").
//!
//! Glass that holds water is written as two closed surfaces that overlap: the water's lies somewhere within the wall. A
//! point may so be inside several interiors; the one of highest priority is there. A surface is *true* where what is
//! there changes at it, and *false* where it lies in something of higher priority: then it is no surface at all, and only
//! remembered. At a true one the relative index is that of what is really there on both sides.
//!
//! Among equal priorities the one entered last is there: a bubble in glass, an olive in oil need none. (Overlapping
//! interiors of equal priority, neither within the other, are then seen differently from either side; give them
//! different ones.) Surfaces between equals, interior for interior, are false: touching bodies of one glass are one.

use super::Interior;
use arrayvec::ArrayVec;

/// Most interiors about one point. What is entered beyond is not remembered, and whoever enters counts it
/// ([`MediumStack::is_full`]).
pub const MOST_NESTED: usize = 12;

/// The interiors about a point: ascending in priority, and among equals in the order in which they were entered. Numbers
/// index a list of [`Interior`]s.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MediumStack(ArrayVec<u32, MOST_NESTED>);

/// What the surface of an interior is to a path that meets it from one side.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The medium changes at the surface. False within something of higher priority, where there is nothing to see.
    pub is_true: bool,
    /// The interior before the front of the surface; `None`: vacuum.
    pub before: Option<u32>,
    /// The interiors on the other side.
    pub across: MediumStack,
}

impl MediumStack {
    /// No interiors: vacuum.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What is entered next is not remembered.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.0.is_full()
    }

    /// The interior that is there: the one of highest priority.
    #[inline]
    pub fn current(&self) -> Option<u32> {
        self.0.last().copied()
    }

    /// The stack after entering the interior `id`.
    #[must_use]
    pub fn entered(&self, id: u32, interiors: &[Interior]) -> Self {
        let mut after = self.clone();
        let priority = |id: u32| interiors[id as usize].priority;
        let place = self.0.iter().position(|&other| priority(other) > priority(id)).unwrap_or(self.0.len());
        // Full: then the way out finds nothing to leave, and is taken as it comes.
        let _ = after.0.try_insert(place, id);
        after
    }

    /// The stack after leaving the interior `id`, and whether it was on it.
    #[must_use]
    pub fn left(&self, id: u32) -> (Self, bool) {
        let mut after = self.clone();
        let place = self.0.iter().rposition(|&other| other == id);
        if let Some(place) = place {
            after.0.remove(place);
        }
        (after, place.is_some())
    }

    /// Crosses the surface of interior `id` from its front (entering) or its back (leaving).
    ///
    /// A back that was never entered belongs to a surface that is not closed, or to one whose front the path did not
    /// see: it is taken as the way out of `id` into what is there.
    pub fn cross(&self, id: u32, front: bool, interiors: &[Interior]) -> Crossing {
        let current = self.current();
        if front {
            let hidden =
                current.is_some_and(|c| c == id || interiors[c as usize].priority > interiors[id as usize].priority);
            return Crossing { is_true: !hidden, before: current, across: self.entered(id, interiors) };
        }
        let (across, known) = self.left(id);
        let before = across.current();
        let is_true = if known {
            current == Some(id) && before != Some(id)
        } else {
            current.is_none_or(|c| interiors[c as usize].priority <= interiors[id as usize].priority)
        };
        Crossing { is_true, before, across }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Medium;
    use super::*;
    use glam::Vec4;

    fn interiors<const N: usize>(priorities: [i32; N]) -> [Interior; N] {
        priorities.map(|priority| Interior { index: Vec4::splat(1.5), medium: Medium::CLEAR, priority })
    }

    /// Walks through surfaces (interior, front) and says which were true, with what was before their fronts.
    fn walk(priorities: &[i32], way: &[(u32, bool)]) -> Vec<Option<Option<u32>>> {
        let all: Vec<_> = priorities.iter().map(|&p| interiors([p])[0]).collect();
        let mut stack = MediumStack::default();
        let step = |&(id, front): &(u32, bool)| {
            let Crossing { is_true, before, across } = stack.cross(id, front, &all);
            stack = across;
            is_true.then_some(before)
        };
        let seen = way.iter().map(step).collect();
        assert!(stack.is_empty());
        seen
    }

    /// Schmidt & Budge, figure 2: water reaches into the wall of the glass.
    #[test]
    fn water_in_the_wall_of_a_glass_begins_where_the_glass_ends() {
        let (glass, water) = (0, 1);
        let way = [(glass, true), (water, true), (glass, false), (water, false)];
        // The glass's outer face, not the water's; then glass to water, seen from the glass's back; then water to air.
        assert_eq!(walk(&[2, 1], &way), [Some(None), None, Some(Some(water)), Some(None)]);
        // The other way round, water displaces glass.
        assert_eq!(walk(&[1, 2], &way), [Some(None), Some(Some(glass)), None, Some(None)]);
    }

    #[test]
    fn among_equals_the_innermost_is_there() {
        let way = [(0, true), (1, true), (1, false), (0, false)];
        assert_eq!(walk(&[0, 0], &way), [Some(None), Some(Some(0)), Some(Some(0)), Some(None)]);
    }

    #[test]
    fn bodies_of_one_glass_are_one() {
        let way = [(0, true), (0, true), (0, false), (0, false)];
        assert_eq!(walk(&[0], &way), [Some(None), None, None, Some(None)]);
    }

    #[test]
    fn a_back_that_was_never_entered_is_a_way_out() {
        assert_eq!(walk(&[0], &[(0, false)]), [Some(None)]);
        let way = [(0, true), (1, false), (0, false)];
        assert_eq!(walk(&[0, 0], &way), [Some(None), Some(Some(0)), Some(None)]);
    }

    #[test]
    fn what_does_not_fit_is_not_remembered() {
        let all = interiors([0; MOST_NESTED + 4]);
        let mut stack = MediumStack::default();
        for id in 0..MOST_NESTED as u32 + 4 {
            stack = stack.entered(id, &all);
        }
        assert_eq!(stack.current(), Some(MOST_NESTED as u32 - 1));
        assert!(stack.is_full() && !stack.left(MOST_NESTED as u32 + 3).1);
    }
}
