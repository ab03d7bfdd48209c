//! The plain core.
