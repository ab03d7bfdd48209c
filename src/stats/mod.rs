//! How a statistical verdict is reached. Every statistical check decides here, and only here.
