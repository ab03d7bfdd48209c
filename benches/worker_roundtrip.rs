//! What a worker process costs: the same batch of 1,000 rays asked of a core in this process and of the same core in a
//! kept worker. The difference is the price of a request; it is to stay under 200 µs.
//!
//! `cargo bench --bench worker_roundtrip`

#![expect(clippy::unwrap_used, reason = "a bench that cannot go on has failed")]

use criterion::{BatchSize, Criterion, Throughput};
use furnace::contract::{Acceleration, Core, Hit, Ray};
use furnace::cores::{CoreSpec, Hosting};
use furnace::math::rng::{Seed, uniform};
use furnace::math::sphere::on_sphere;
use furnace::project::Project;
use furnace::scene::{Library, Overrides};
use glam::DVec3;

const RAYS: usize = 1000;

/// From inside the box in every direction.
fn rays() -> Vec<Ray> {
    let mut stream = Seed(1).stream();
    let mut ray = || {
        let origin = DVec3::from_array(std::array::from_fn(|_| uniform(&mut stream) - 0.5));
        Ray::new(origin, on_sphere(&mut stream))
    };
    (0..RAYS).map(|_| ray()).collect()
}

fn ask(criterion: &mut Criterion, name: &str, core: &mut dyn Core) {
    let scenes = Project::at(env!("CARGO_MANIFEST_DIR")).scenes();
    let scene = Library::new(scenes).load("cornell-diffuse-spheres", &Overrides::new()).unwrap();
    let rays = rays();
    let mut built = core.build_scene(&scene, Acceleration::DEFAULT).unwrap();
    let mut group = criterion.benchmark_group("worker_roundtrip");
    group.throughput(Throughput::Elements(RAYS as u64));
    group.bench_function(name, |bencher| {
        bencher.iter_batched_ref(
            || vec![Hit::MISS; RAYS],
            |hits| built.intersect(&rays, hits).unwrap(),
            BatchSize::LargeInput,
        );
    });
    group.finish();
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    // The plain core has no threads, which a busy machine would hold up here or there.
    let spec: CoreSpec = "textbook".parse().unwrap();
    ask(&mut criterion, "direct", spec.make().unwrap().as_mut());
    let program = env!("CARGO_BIN_EXE_furnace").into();
    let hosting = Hosting { program, isolates_own: true, ..Hosting::default() };
    ask(&mut criterion, "worker", hosting.host(&spec).unwrap().core_mut());
    criterion.final_summary();
}
