//! What must hold of any scene, and is known of it without an answer.

use super::{bits, mitsuba};
use crate::desc::{self, Alpha};
use crate::scene::Scene;
use crate::stats::Check;
use crate::verify::Findings;
use crate::verify::scene::Subject;
use crate::verify::scene::agreement::compare;
use crate::verify::scene::furnace::Furnace;
use crate::verify::scene::view::Budget;
use crate::verify::scene::white::{Dress, lossless};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// A part of what must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aspect {
    /// All strategies estimate one image.
    Agreement,
    /// In a uniform environment nothing is brighter than it.
    Furnace,
    /// Made white, nothing is darker either.
    White,
    /// Threads, replays and files change nothing.
    Bits,
    /// Another renderer makes the same image.
    Mitsuba,
}

impl Aspect {
    /// All of them.
    pub(super) const ALL: [Self; 5] = [Self::Agreement, Self::Furnace, Self::White, Self::Bits, Self::Mitsuba];

    /// Those that need nobody else.
    pub(super) const OURS: [Self; 4] = [Self::Agreement, Self::Furnace, Self::White, Self::Bits];
}

/// Pixels of an image.
const PIXELS: f64 = 256.0;

/// Looks at one aspect of a scene, with so many rays an image.
pub(super) fn look(desc: &desc::Scene, aspect: Aspect, rays: u64, seed: u64) -> Findings {
    let mut found = Findings::new("");
    let looked = catch_unwind(AssertUnwindSafe(|| {
        let mut found = Findings::new("");
        judge(desc, aspect, Budget { rays, pixels: PIXELS, seed }, &mut found);
        found
    }));
    match looked {
        Ok(found) => return found,
        Err(cause) => {
            let text = cause.downcast_ref::<String>().map(String::as_str).or(cause.downcast_ref::<&str>().copied());
            found.checks.holds(format!("{aspect:?} panics: {}", text.unwrap_or("without a word")), false);
        }
    }
    found
}

fn judge(desc: &desc::Scene, aspect: Aspect, budget: Budget, found: &mut Findings) {
    // Another renderer is asked about what it can say.
    let said = match aspect {
        Aspect::Mitsuba => mitsuba::python().and_then(|python| Some((python, mitsuba::sayable(desc)?))),
        _ => None,
    };
    let desc = said.as_ref().map_or(desc, |(_, said)| said);
    let scene = match Scene::compile(desc) {
        Ok(scene) => Arc::new(scene),
        Err(e) => return found.checks.holds(format!("is compiled: {e}"), false),
    };
    let subject = Subject { desc: Arc::new(desc.clone()), scene };
    let furnace = |dress, vanishes| Furnace { desc, dress, budget, vanishes };
    match aspect {
        Aspect::Agreement => {
            if let Err(e) = compare(&subject, budget, found) {
                found.checks.holds(format!("an image is made: {e}"), false);
            }
        }
        Aspect::Furnace if holds_volumes_closed(desc) => furnace(Dress::Written, false).burn(false, found),
        Aspect::White if holds_volumes_closed(desc) => furnace(Dress::Flat, is_lossless(desc)).burn(false, found),
        Aspect::Furnace | Aspect::White => {}
        Aspect::Bits => bits::judge(&subject, budget.seed, found),
        Aspect::Mitsuba => {
            if let Some((python, _)) = &said {
                mitsuba::compare(python, &subject, budget.rays, budget.seed, found);
            }
        }
    }
}

/// No material that light passes through into a volume has holes: who enters by a hole and leaves by refraction gains n².
fn holds_volumes_closed(desc: &desc::Scene) -> bool {
    let open = |m: &desc::Material| m.alpha != Alpha::Opaque && crate::material::interior(m).is_some();
    !desc.objects.iter().any(|o| open(&desc.materials[o.material]))
}

/// Everything that is worn can be made to scatter all that it receives.
fn is_lossless(desc: &desc::Scene) -> bool {
    desc.objects.iter().all(|o| lossless(&desc.materials[o.material]).is_some())
}

/// The p-value of the least likely of some checks.
pub(super) fn least(checks: &[Check]) -> f64 {
    checks.iter().map(Check::p).fold(1.0, f64::min)
}

/// What the least likely of some checks compares, without where and how: `Light against Mis: mean R` and `Light against Mis:
/// worst of 16 tiles` are one kind of failure.
pub(super) fn kind(checks: &[Check]) -> String {
    let worst = checks.iter().min_by(|a, b| a.p().total_cmp(&b.p()));
    worst.map_or(String::new(), |check| kind_of(check).to_owned())
}

/// The least likely check of a kind.
pub(super) fn least_of_kind(checks: &[Check], kind: &str) -> f64 {
    checks.iter().filter(|check| kind_of(check) == kind).map(Check::p).fold(1.0, f64::min)
}

fn kind_of(check: &Check) -> &str {
    check.name.split(':').next().unwrap_or_default()
}
