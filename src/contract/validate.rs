//! Every answer is checked before a check sees it.
