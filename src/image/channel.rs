//! The channels of a colour.

use crate::text::spoken;
use serde::{Deserialize, Serialize};

spoken! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Channel {
        Red = "red",
        Green = "green",
        Blue = "blue",
    }
}

/// All of them, in the order of a pixel.
pub(crate) const CHANNELS: [Channel; 3] = [Channel::Red, Channel::Green, Channel::Blue];

impl Channel {
    pub(crate) const fn index(self) -> usize {
        self as usize
    }
}
