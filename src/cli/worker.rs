//! `furnace worker`: the process of a core. Hidden, since only furnace starts it.

use super::{Answer, ExitCode, Failure};
use crate::contract::Core;
use crate::contract::validate::Validated;
use crate::cores::CoreSpec;
use crate::cores::command::{CommandCore, Program};
use crate::cores::dylib::{self, Dylib};
use crate::worker::{self, CoreOrigin, WorkerSpec, child};
use clap::Args;

/// What `furnace worker` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct WorkerArguments {
    /// The request, as JSON.
    spec: String,
}

/// Enters its sandbox, and becomes the core.
pub(crate) fn worker(arguments: &WorkerArguments) -> Answer {
    let spec: WorkerSpec = serde_json::from_str(&arguments.spec).map_err(Failure::request)?;
    let inherited = child::begin(&spec).map_err(Failure::broken)?;
    if let CoreOrigin::Program(words) = &spec.origin {
        let code = child::run_program(words, inherited).map_err(Failure::broken)?;
        return Ok(if code == 0 { ExitCode::Good } else { ExitCode::Failed });
    }
    let channel = inherited.into_channel().map_err(Failure::broken)?;
    dylib::let_faults_kill();
    worker::overflow::watch();
    let served = match load(&spec) {
        Ok(mut core) => worker::serve(&mut Validated::in_worker(core.as_mut()), channel),
        Err(why) => worker::refuse(why, channel),
    };
    served.map_err(Failure::broken)?;
    Ok(ExitCode::Good)
}

fn load(spec: &WorkerSpec) -> Result<Box<dyn Core>, String> {
    let words = |error: &dyn std::fmt::Display| error.to_string();
    match &spec.origin {
        CoreOrigin::Library(path) => Ok(Box::new(Dylib::load(path).map_err(|e| words(&e))?)),
        CoreOrigin::Renderer { adapter, .. } => {
            let program = Program::load(adapter).map_err(|e| words(&e))?;
            Ok(Box::new(CommandCore(program.within_a_worker())))
        }
        _ => {
            let core: CoreSpec = spec.core.parse().map_err(|e| words(&e))?;
            core.make().map_err(|e| words(&e))
        }
    }
}
