//! What an integrator must know of a scene before the first ray is traced.

use crate::desc::Integrator;
use crate::scene::Scene;

/// What was prepared. Nothing for integrators that trace from the camera and find all else on the way.
#[derive(Clone, Debug)]
pub enum Solver {
    /// Nothing.
    None,
}

impl Solver {
    /// Prepares what `integrator` needs of the scene.
    pub fn prepare(_scene: &Scene, integrator: Integrator) -> Self {
        match integrator {
            Integrator::Raycast | Integrator::Local | Integrator::Whitted | Integrator::Path => Self::None,
        }
    }

    /// Whether paths bring light to other pixels than the one that they are sampled for, so that replicates are whole only
    /// with their round.
    pub fn splats(&self) -> bool {
        match self {
            Self::None => false,
        }
    }
}
