//! What a worker may reach, decided for every system; how it is enforced is the system's business.
//!
//! A core may read itself and the system's libraries, write its scratch folder, and reach no
//! network; it can neither look up what is expected of it nor touch what is written about it. Where
//! a system cannot enforce that, the report says so.

use super::spec::{Confinement, Limits, WorkerSpec};

/// Sandboxes this process, as far as the system can.
pub(crate) fn confine(worker: &WorkerSpec) -> Confinement {
    let mut confinement = Confinement::default();
    let in_all = format!("files: {} in all", in_bytes(worker.limits.scratch));
    confinement.in_force.push(in_all);
    limit(&worker.limits, &mut confinement);
    if worker.confined {
        sandbox(worker, &mut confinement);
    } else {
        let why = "files, network, processes: everything is open to it, as was asked for";
        confinement.lacking.push(why.to_owned());
    }
    confinement
}

#[cfg(target_os = "linux")]
use super::confine_linux::sandbox;

#[cfg(not(target_os = "linux"))]
fn sandbox(_: &WorkerSpec, confinement: &mut Confinement) {
    confinement.lacking.push(
        "files, network, processes: only on Linux can a worker be sandboxed; here the core could \
         read cases and references and change results"
            .to_owned(),
    );
}

/// What a process may hold open: pipes hold memory, too.
#[cfg(unix)]
const OPEN_FILES: u64 = 1024;

#[cfg(unix)]
fn limit(limits: &Limits, confinement: &mut Confinement) {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let mut set = |resource, limit: Option<u64>, what: String| match setrlimit(
        resource,
        Rlimit { current: limit, maximum: limit },
    ) {
        Ok(()) => confinement.in_force.push(what),
        Err(error) => confinement.lacking.push(format!("{what}: {error}")),
    };
    if let Some(memory) = limits.memory {
        set(Resource::Data, Some(memory), format!("memory: {} a process", in_bytes(memory)));
        // Reserving is no using, so twice as much may be reserved.
        let reserved = memory.saturating_mul(2);
        set(Resource::As, Some(reserved), format!("address space: {}", in_bytes(reserved)));
    }
    set(Resource::Fsize, Some(limits.file), format!("files: {} each", in_bytes(limits.file)));
    set(Resource::Nofile, Some(OPEN_FILES), format!("open files: {OPEN_FILES}"));
    set(Resource::Core, Some(0), "no core dumps".to_owned());
}

#[cfg(not(unix))]
fn limit(_: &Limits, confinement: &mut Confinement) {
    confinement.lacking.push("memory, files: this system has no limits for a process".to_owned());
}

/// `4 GiB`, `64 MiB`, `17 bytes`
fn in_bytes(bytes: u64) -> String {
    match bytes {
        b if b >= 1 << 30 && b % (1 << 30) == 0 => format!("{} GiB", b >> 30),
        b if b >= 1 << 20 => format!("{} MiB", b >> 20),
        b => format!("{b} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_in_words() {
        assert_eq!(
            [in_bytes(4 << 30), in_bytes(1 << 26), in_bytes(17)],
            ["4 GiB", "64 MiB", "17 bytes"]
        );
    }
}
