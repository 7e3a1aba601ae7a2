//! Maps of the unit square, each with its density and inverse.
