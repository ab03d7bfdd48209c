//! `furnace worker`: the process of a core. Hidden, since only furnace starts it.

use super::{Answer, ExitCode, Failure};
use crate::contract::Core;
use crate::contract::validate::Validated;
use crate::cores::CoreSpec;
use crate::cores::command::{CommandCore, Program};
use crate::cores::dylib::{self, Dylib};
use crate::worker::{self, Errand, Guest, child};
use clap::Args;

/// What `furnace worker` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct WorkerArguments {
    /// The request, as JSON.
    errand: String,
}

/// Enters its sandbox, and becomes the core.
pub(crate) fn worker(arguments: &WorkerArguments) -> Answer {
    let errand: Errand = serde_json::from_str(&arguments.errand).map_err(Failure::request)?;
    let entered = child::begin(&errand).map_err(Failure::broken)?;
    if let Guest::Program(words) = &errand.guest {
        let code = entered.run_program(words).map_err(Failure::broken)?;
        return if code == 0 { Ok(ExitCode::Good) } else { Ok(ExitCode::Failed) };
    }
    let channel = entered.into_channel().map_err(Failure::broken)?;
    dylib::let_faults_kill();
    let served = match load(&errand) {
        Ok(mut core) => worker::serve(&mut Validated::new(core.as_mut()), channel),
        Err(why) => worker::refuse(why, channel),
    };
    served.map_err(Failure::broken)?;
    Ok(ExitCode::Good)
}

fn load(errand: &Errand) -> Result<Box<dyn Core>, String> {
    if let Guest::Library(path) = &errand.guest {
        return Ok(Box::new(Dylib::load(path).map_err(|error| error.to_string())?));
    }
    if let Guest::Renderer { adapter, .. } = &errand.guest {
        let program = Program::load(adapter).map_err(|error| error.to_string())?;
        return Ok(Box::new(CommandCore(program.within_a_worker())));
    }
    let spec: CoreSpec = errand.spec.parse().map_err(|error| format!("{error}"))?;
    spec.make().map_err(|error| error.to_string())
}
