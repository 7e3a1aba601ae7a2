//! How much energy single scattering keeps, so that multiple scattering can give back what it loses.
//!
//! GGX with Smith masking counts light that leaves the microsurface after one bounce. The rest, `loss(μ) = 1 − E(μ)` of
//! the energy that arrives under μ = cos θ, is returned by the reciprocal lobe of Kulla & Conty (2017, "Revisiting
//! Physically Based Shading at Imageworks"),
//!
//! ```text
//! f_ms(o, i) = F_ms loss(o) loss(i) / (π loss_avg),    loss_avg = (1/π) ∫ loss(i) cos θi dωi
//! ```
//!
//! whose albedo is F_ms loss(o). So a lossless lobe (F_ms = 1) reflects exactly what falls on it, up to the error of the
//! tables here: the quadrature is converged, the interpolation cubic, and `loss_avg` belongs to the interpolant.

mod at;
mod atlas;
mod axes;
mod dielectric;
mod filmed;
mod grid;
mod interface;
mod mean;
mod moments;
mod quadrature;
mod sampling;
mod table;
mod volume;

pub use at::EnergyAt;
pub use dielectric::{DielectricEnergy, Pair as DielectricPair};
pub use filmed::FilmedEnergy;
pub(super) use grid::{Grid, Stencil};
pub use interface::{Energy, Interface};
pub(super) use quadrature::gauss_legendre;
pub use table::EnergyTable;
