//! Each case is a test.

mod adapter;

fn main() -> std::process::ExitCode {
    // Without a BVH those take minutes.
    furnace::trials("tiny", || adapter::Tiny).cases(["!order-does-not-matter"]).test()
}
