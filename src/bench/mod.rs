//! How fast a BVH is: `furnace bench` and `cargo bench`.
//!
//! Times are CPU times of the cores' own processes while they answer, so that the channel to them is in none. Every
//! structure takes its turns once a round, in random order, on the same rays: whatever else the machine does falls on all
//! alike, and a ratio of two times of one round says more than either. A round has new processes and goes over all
//! subjects, so that those of one subject see the machine at different times, as another run would. Hits are compared with brute force in the same
//! run, because a fast wrong answer is worth nothing. Counts of tests stand beside the times, where a core counts: they
//! are the same on every machine.
//!
//! Not here: verdicts. A clock informs (`docs/decisions/0006`), but for hits that are not those of brute force.

mod contest;
mod growth;
mod subject;
mod table;

use contest::Row;
pub use contest::{Bench, Measured};
pub use subject::{Subject, made_here};
pub use table::table;

pub(crate) use subject::{FOUNDING, in_folder, names};
