//! `furnace lint`: reads every case and scene, runs nothing.

use super::{Answer, ExitCode, Failure};
use crate::case;
use crate::project::Project;
use crate::scene::Library;

/// Says what is wrong with cases and scenes, all of it at once.
pub fn lint() -> Answer {
    let project = Project::find().map_err(Failure::request)?;
    let scenes = Library::new(project.scenes());
    let mut complaints = Vec::new();
    for name in scenes.names().map_err(Failure::request)? {
        complaints.extend(scenes.load(&name, &toml::Table::new()).err().map(|e| e.to_string()));
    }
    let mut count = 0;
    match case::load_all(&project.cases()) {
        Err(error) => complaints.push(error.to_string()),
        Ok(cases) => {
            count = cases.len();
            for case in &cases {
                let Some(scene) = &case.scene else { continue };
                if let Err(error) = scenes.load(&scene.name, &scene.parameters) {
                    complaints.push(format!("{}: {error}", case.path.display()));
                }
            }
        }
    }
    if complaints.is_empty() {
        println!("{count} cases and their scenes are in order");
        Ok(ExitCode::Good)
    } else {
        Err(Failure::request(complaints.join("\n\n")))
    }
}
