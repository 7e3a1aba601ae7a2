//! Which exhibits a page shows: those of failing subjects first, some of each topic, no more than a page can bear.

use super::super::{Group, Section, count, one_line};
use super::{curve, heat_map, picture};
use crate::verify::Exhibit;
use maud::{Markup, html};

/// Most figures of a topic's failing subjects, and of its passing ones.
const FAILING: usize = 12;
const PASSING: usize = 6;

/// Bytes of all figures together.
const BUDGET: usize = 2_500_000;

/// The figures of each topic.
pub(super) struct Figures(Vec<Shown>);

#[derive(Default)]
struct Shown {
    figures: Vec<Markup>,
    left_out: usize,
}

impl Figures {
    /// Chooses and draws, in the order of `groups`.
    pub(super) fn choose(groups: &[Group], share: f64) -> Self {
        let mut shown: Vec<Shown> = groups.iter().map(|_| Shown::default()).collect();
        let mut spent = 0;
        for (failing, most) in [(true, FAILING), (false, PASSING)] {
            for (group, shown) in groups.iter().zip(&mut shown) {
                let fails = |section: &Section| section.checks.iter().any(|check| check.p() < share);
                let sections = group.sections.iter().filter(|section| fails(section) == failing);
                let all: Vec<(&Section, &Exhibit)> = sections
                    .flat_map(|&section| section.exhibits.iter().map(move |exhibit| (section, exhibit)))
                    .collect();
                for &(section, exhibit) in &spread(&all, most) {
                    let figure = draw(section, exhibit);
                    if spent + figure.0.len() <= BUDGET {
                        spent += figure.0.len();
                        shown.figures.push(figure);
                    }
                }
            }
        }
        for (group, shown) in groups.iter().zip(&mut shown) {
            let all: usize = group.sections.iter().map(|section| section.exhibits.len()).sum();
            shown.left_out = all - shown.figures.len();
        }
        Self(shown)
    }

    /// Those of one topic.
    pub(super) fn section(&self, group: usize) -> Markup {
        let Some(Shown { figures, left_out }) = self.0.get(group) else { return Markup::default() };
        html! {
            @if !figures.is_empty() { div.figures { @for figure in figures { (figure) } } }
            @if *left_out > 0 {
                p.faint { (count(*left_out)) " more figures are left out here; --only with a subject's name shows them." }
            }
        }
    }
}

/// At most `most` of them, evenly spread.
fn spread<T: Copy>(all: &[T], most: usize) -> Vec<T> {
    let n = all.len().min(most);
    (0..n).map(|i| all[i * all.len() / n]).collect()
}

fn draw(section: &Section, exhibit: &Exhibit) -> Markup {
    let (title, content) = match exhibit {
        Exhibit::Curve(curve) => (&curve.title, curve::draw(curve)),
        Exhibit::HeatMap(map) => (&map.title, heat_map::draw(map)),
        Exhibit::Picture(picture) => (&picture.title, picture::draw(picture)),
        Exhibit::Listing(listing) => {
            let lines = listing.text.lines().map(one_line);
            (&listing.title, html! { pre { @for line in lines { (line) "\n" } } })
        }
    };
    html! {
        figure { figcaption { b { (one_line(title)) } span.faint { (one_line(&section.subject)) } } (content) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_spread() {
        assert_eq!(spread(&[1, 2, 3, 4, 5, 6], 3), [1, 3, 5]);
        assert_eq!(spread(&[1, 2], 3), [1, 2]);
        assert!(spread::<u8>(&[], 3).is_empty());
    }
}
