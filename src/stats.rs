//! Moments, standard errors, z, χ², Šidák.
