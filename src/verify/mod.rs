//! The battery that proves the estimator, and whatever else is given to it.
//!
//! A *check* is a hypothesis test ([`crate::stats::Check`]): an estimate with its standard error against a closed form, counts
//! against an integrated density, two estimators of one integral, or an identity that rounding alone may break. A
//! [`Task`] is a piece of work that makes some checks about one subject, under one [`Topic`]. [`run`] does tasks on all
//! cores, and all checks of a run share one significance α (Šidák), so that correct code fails one run in 1/α.
//!
//! | module | what it makes |
//! | --- | --- |
//! | [`agreement`] | two images of one thing |
//! | [`battery`] | the tasks that check this crate |
//! | [`calibration`] | whether checks fail as often as they should |
//! | [`chart`] | bins of equal solid angle, and the goodness of fit of a density of directions |
//! | [`expect`] | a scene that carries its exact answer |
//! | [`measure`] | means with as many samples as a detectable bias asks for |
//! | [`picture`] | what a failing image looks like |
//! | [`random`] | random scenes, in which any two features meet |
//! | [`replicated`] | images in independent replicates |
//! | [`report`] | what a run found |
//! | [`scattering`] | what must hold of a BSDF, ours or anyone's |
//! | [`scene`] | the tasks that check a scene file |
//! | [`scenes`] | the scene files of the crate, held in the binary |
//! | [`tiles`] | parts of images, with errors that know what was not seen |

pub mod agreement;
pub mod battery;
pub mod calibration;
pub mod chart;
pub mod expect;
pub mod measure;
pub mod picture;
pub mod random;
pub mod replicated;
pub mod report;
pub mod scattering;
pub mod scene;
pub mod scenes;
mod task;
pub mod tiles;

pub use report::{Report, Section};
pub use task::{Curve, Exhibit, Findings, HeatMap, Listing, Picture, Progress, Size, Task, Topic, Trial, run};
