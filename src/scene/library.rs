//! The scenes of a folder, each read once.

use super::error::read_source;
use super::file::{self, Overrides};
use super::format::collada;
use super::{SceneDescription, SceneError};
use crate::project::Project;
use crate::text::{all_of, did_you_mean, hint};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Folders of `<name>.toml` and `<name>.dae` files. Shared between threads; a scene is read once for each set of
/// overrides.
#[derive(Debug)]
pub struct Library {
    /// Of two scenes of one name that of the first folder counts.
    folders: Vec<PathBuf>,
    read: Mutex<HashMap<String, Arc<SceneDescription>>>,
}

impl Library {
    /// The scenes in `folder`. Nothing is read yet.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folders: vec![folder.into()], read: Mutex::default() }
    }

    /// The scenes of a project, laid over those of the bench.
    pub(crate) fn of(project: &Project) -> Self {
        Self { folders: project.layers("scenes"), read: Mutex::default() }
    }

    /// The scene `name` with its parameters as they stand in its file, but for `overrides`. A name that ends
    /// in `.toml` or `.dae` is a path of its own.
    pub fn load(
        &self,
        name: &str,
        overrides: &Overrides,
    ) -> Result<Arc<SceneDescription>, SceneError> {
        let key = format!("{name} {overrides}");
        let remembered = || self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(scene) = remembered().get(&key) {
            return Ok(Arc::clone(scene));
        }
        let scene = Arc::new(self.read(name, overrides)?);
        remembered().insert(key, Arc::clone(&scene));
        Ok(scene)
    }

    /// The names of all scenes, in the order of the alphabet.
    pub(crate) fn names(&self) -> Result<Vec<String>, SceneError> {
        let mut names = Vec::new();
        for folder in &self.folders {
            let unreadable = |problem| SceneError::unreadable(folder, &problem);
            for entry in std::fs::read_dir(folder).map_err(unreadable)? {
                let path = entry.map_err(unreadable)?.path();
                if is_scene_file(&path) {
                    names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
                }
            }
        }
        names.sort_unstable();
        names.dedup();
        Ok(names)
    }

    fn read(&self, name: &str, overrides: &Overrides) -> Result<SceneDescription, SceneError> {
        if is_scene_file(Path::new(name)) {
            return load_file(Path::new(name), overrides);
        }
        let files = self.folders.iter().flat_map(|folder| {
            EXTENSIONS.map(|extension| folder.join(format!("{name}.{extension}")))
        });
        match files.into_iter().find(|path| path.is_file()) {
            Some(path) => load_file(&path, overrides),
            None => Err(self.no_such_scene(name)),
        }
    }

    fn no_such_scene(&self, name: &str) -> SceneError {
        let known = self.names().unwrap_or_default();
        let known = || known.iter().map(String::as_str);
        SceneError::NoSuchScene {
            name: name.to_owned(),
            folder: self.folders.first().map_or(String::new(), |own| own.display().to_string()),
            hint: hint(name, known(), || all_of(known())),
        }
    }
}

/// The kinds of scene files. Of two with the same name the first one counts.
const EXTENSIONS: [&str; 2] = ["toml", "dae"];

fn is_scene_file(path: &Path) -> bool {
    path.extension().is_some_and(|extension| EXTENSIONS.iter().any(|known| extension == *known))
}

/// The scene in a file, called by the file's name without its extension. A `.dae` file has the parameters
/// `film` and `camera`.
pub fn load_file(path: &Path, overrides: &Overrides) -> Result<SceneDescription, SceneError> {
    if path.extension().is_some_and(|extension| extension == "dae") {
        return load_collada(path, overrides);
    }
    let source = read_source(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    file::parse(&name, &source, folder, overrides)
}

/// A `.dae` file with its two parameters: the size of the image, and a camera file beside it, the course's `-c`.
fn load_collada(path: &Path, overrides: &Overrides) -> Result<SceneDescription, SceneError> {
    let (mut film, mut camera) = (collada::FILM, None);
    for (parameter, value) in overrides {
        let known = match parameter.as_str() {
            "film" => value.clone().try_into().ok().map(|pixels| film = pixels),
            "camera" => value.as_str().map(|name| camera = Some(path.with_file_name(name))),
            _ => None,
        };
        known.ok_or_else(|| SceneError::NoSuchParameter {
            parameter: parameter.clone(),
            problem: format!(
                "scene `{}` has no parameter `{parameter}`, only `film`, such as [480, 360], and \
                 `camera`, such as \"camera.txt\"",
                path.display()
            ),
            hint: did_you_mean(parameter, ["film", "camera"]),
        })?;
    }
    let mut scene = collada::load(path, film)?.scene;
    if let Some(settings) = camera {
        scene.camera = Some(collada::load_camera(&settings, film)?);
    }
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library() -> Library {
        Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"))
    }

    fn every_scene() -> Vec<Arc<SceneDescription>> {
        let library = library();
        let load = |name: String| library.load(&name, &Overrides::new());
        let scenes = library.names().unwrap().into_iter().map(load);
        scenes.map(|scene| scene.unwrap_or_else(|error| panic!("{error}"))).collect()
    }

    #[test]
    fn every_scene_of_the_suite_loads_and_has_a_camera() {
        let scenes = every_scene();
        assert!(scenes.len() > 30);
        assert!(scenes.iter().all(|scene| scene.camera.is_some()));
    }

    #[test]
    fn scenes_stay_where_single_precision_is_good() {
        // Renderers offset rays by a share of the coordinates: beyond 10 it starts to show.
        for scene in every_scene() {
            if let Some(bounds) = scene.bounds() {
                let furthest = bounds.min.abs().max(bounds.max.abs()).max_element();
                assert!(furthest <= 10.0, "{} reaches {furthest}", scene.name);
            }
        }
    }

    #[test]
    fn a_scene_is_read_once_for_each_set_of_overrides() {
        let library = library();
        let with = |text: &str| library.load("sphere-furnace", &toml::from_str(text).unwrap());
        let plain = with("").unwrap();
        assert!(Arc::ptr_eq(&plain, &with("").unwrap()));
        let dark = with("albedo = 0").unwrap();
        assert!(!Arc::ptr_eq(&plain, &dark));
        assert_ne!(plain.materials, dark.materials);
    }

    #[test]
    fn a_scene_that_is_not_there_is_answered_with_the_one_that_was_meant() {
        let message = library().load("sphere-furnice", &Overrides::new()).unwrap_err().to_string();
        assert!(message.starts_with("there is no scene `sphere-furnice` in `"), "{message}");
        assert!(message.ends_with("hint: did you mean `sphere-furnace`?"), "{message}");
        let message = library().load("zzz", &Overrides::new()).unwrap_err().to_string();
        assert!(message.contains("hint: there are `area-light-plane`, "), "{message}");
    }

    #[test]
    fn a_course_scene_is_a_scene_like_others_and_its_picture_can_be_cropped() {
        let room = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/collada/room.dae");
        let film = |overrides: &str| {
            let scene = library().load(room, &toml::from_str(overrides).unwrap());
            scene.map(|scene| scene.camera.unwrap().film).map_err(|error| error.to_string())
        };
        assert_eq!(film(""), Ok(collada::FILM));
        assert_eq!(film("film = [48, 36]"), Ok([48, 36]));
        let message = film("albedo = 0.5").unwrap_err();
        assert!(message.contains("has no parameter `albedo`, only `film`"), "{message}");
    }
}
