//! Autograders: the scripts of `adapters/autograder` with a suite's name in them, and all that they need beside them.

use super::{copy, refuse_what_is_there, write_new};
use crate::cli::say::say_line;
use crate::cli::{Answer, ExitCode, Failure};
use crate::disk;
use crate::grade::Suite;
use crate::project::Project;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::Path;

/// What stands in the scripts for the suite's name.
const SUITE: &str = "SUITE";
/// Of a suite, what it asks and by what.
const OWN: [&str; 4] = ["suites", "cases", "scenes", "references"];

/// Writes what Gradescope and GitHub take.
pub(super) fn autograder(project: &Project, suite: &str, folder: &Path) -> Answer {
    refuse_what_is_there(folder)?;
    find(project, suite)?;
    let gradescope = folder.join("gradescope");
    for name in ["setup.sh", "run_autograder"] {
        let path = gradescope.join(name);
        write(&path, &script(project, &format!("gradescope/{name}"), suite)?)?;
        let_run(&path)?;
    }
    write(&gradescope.join("salt"), &salt())?;
    bench(project, suite, &gradescope)?;
    let github = folder.join("github/.github");
    let workflow = script(project, "github/furnace.yml", suite)?;
    write(&github.join("workflows/furnace.yml"), &workflow)?;
    bench(project, suite, &github.join("furnace"))?;
    let shown = folder.display();
    say_line!("{shown}");
    say_line!("  Gradescope  cd {shown}/gradescope && zip -r ../gradescope.zip .");
    say_line!("              upload gradescope.zip as the autograder; keep the file `salt` secret");
    say_line!(
        "  GitHub      copy {shown}/github/.github into the repository that students start from"
    );
    say_line!("              and make a secret FURNACE_SALT, for instance the word in `salt`");
    Ok(ExitCode::Good)
}

/// Writes the job array.
pub(super) fn slurm(project: &Project, suite: &str, file: &Path) -> Answer {
    find(project, suite)?;
    write_new(file, &script(project, "slurm/class.sbatch", suite)?)?;
    say_line!("  next  sbatch --array=1-8 {} handed-in", file.display());
    say_line!("        furnace merge classes/{suite}");
    Ok(ExitCode::Good)
}

fn find(project: &Project, suite: &str) -> Result<Suite, Failure> {
    Suite::find(project, suite).map_err(Failure::request)
}

fn script(project: &Project, name: &str, suite: &str) -> Result<String, Failure> {
    let path = project.of_the_bench("adapters/autograder").join(name);
    let text = std::fs::read_to_string(&path);
    let text = text.map_err(|error| Failure::broken(format!("{}: {error}", path.display())))?;
    // Shells on Linux read them, wherever they are written.
    Ok(text.replace("\r\n", "\n").replace(SUITE, suite))
}

/// This program, the suite, and what the project has of its own.
fn bench(project: &Project, suite: &str, folder: &Path) -> Result<(), Failure> {
    let program = std::env::current_exe().map_err(Failure::broken)?;
    let copied = folder.join("furnace");
    copy(&program, &copied).map_err(Failure::broken)?;
    let_run(&copied)?;
    for name in OWN {
        let layers = project.layers(name);
        // What the bench has the program carries.
        if layers.len() > 1 {
            copy(&layers[0], &folder.join(name)).map_err(Failure::broken)?;
        }
    }
    let file = format!("suites/{suite}.toml");
    let layers = project.layers("suites");
    let mut files = layers.iter().map(|layer| layer.join(format!("{suite}.toml")));
    match files.find(|path| path.is_file()) {
        Some(path) => copy(&path, &folder.join(file)).map_err(Failure::broken),
        None => Ok(()),
    }
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    disk::replace(path, text.as_bytes()).map_err(Failure::broken)
}

/// 32 letters that nobody can guess: hashes by keys that the system draws.
fn salt() -> String {
    let word = |_| format!("{:016x}", RandomState::new().build_hasher().finish());
    (0..2).map(word).collect::<String>() + "\n"
}

#[cfg(unix)]
fn let_run(path: &Path) -> Result<(), Failure> {
    use std::os::unix::fs::PermissionsExt;
    let permissions = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(path, permissions).map_err(Failure::broken)
}

/// Elsewhere no file says so, and Gradescope lets both scripts run by itself.
#[cfg(not(unix))]
fn let_run(_: &Path) -> Result<(), Failure> {
    Ok(())
}
