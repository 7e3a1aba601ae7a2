//! Nearest hit? Occluded?
