//! `furnace schema`: the JSON Schema of a kind of file, by which editors complete and underline. It is asked of the types that
//! read the files, so that it knows what they know.

use super::say::say_line;
use super::{Answer, ExitCode, Failure};
use crate::cores::command::adapter::Adapter;
use crate::grade::Suite;
use crate::run::TrialRecord;
use crate::text::document::trace;
use crate::text::schema::{Instead, of};
use crate::{case, scene};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};

/// Of which draft the schemas are.
const DRAFT: &str = "https://json-schema.org/draft/2020-12/schema";

/// What `furnace schema` understands.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
An editor with taplo (Even Better TOML) completes where the first line names the schema:
  furnace schema case > case.schema.json
  #:schema ./case.schema.json")]
pub(crate) struct SchemaArguments {
    /// The kind of file.
    #[arg(value_enum, default_value_t)]
    what: What,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum What {
    #[default]
    Case,
    Scene,
    Suite,
    /// What a run keeps of a trial.
    Sidecar,
    /// The file of a program that renders images.
    Adapter,
}

pub(crate) fn schema(arguments: &SchemaArguments) -> Answer {
    let (title, mut schema) = match arguments.what {
        What::Case => ("A case of furnace", case::schema()),
        What::Scene => ("A scene of furnace", scene::schema()),
        What::Suite => ("A suite of furnace", of(trace::<Suite>, Instead::Nothing)),
        What::Sidecar => ("A trial of furnace", of(trace::<TrialRecord>, Instead::Null)),
        What::Adapter => ("An adapter of furnace", of(trace::<Adapter>, Instead::Nothing)),
    };
    schema["$schema"] = json!(DRAFT);
    schema["title"] = Value::from(title);
    say_line!("{}", serde_json::to_string_pretty(&schema).map_err(Failure::broken)?);
    Ok(ExitCode::Good)
}
