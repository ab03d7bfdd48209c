//! The fast core.
