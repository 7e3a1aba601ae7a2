//! The kernels for any target.

use super::lanes::Lanes;

super::traverse::kernels!();
