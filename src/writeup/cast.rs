//! Which scenes stand in a write-up: those of the course from a folder of theirs, or scenes of our own in their places.

use crate::render::Shot;
use std::path::{Path, PathBuf};
use walkdir::WalkDir;

/// A scene that the course shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Role {
    /// What figures call it.
    pub(super) name: &'static str,
    /// The course's files, without `.dae`: the first that is there counts.
    pub(super) files: &'static [&'static str],
    /// A scene of the project in its place, and a parameter of it.
    pub(super) stand_in: Option<(&'static str, Option<(&'static str, i64)>)>,
}

const fn role(
    name: &'static str,
    files: &'static [&'static str],
    stand_in: (&'static str, Option<(&'static str, i64)>),
) -> Role {
    Role { name, files, stand_in: Some(stand_in) }
}

const fn alone(name: &'static str, files: &'static [&'static str]) -> Role {
    Role { name, files, stand_in: None }
}

pub(super) const SPHERES: Role =
    role("spheres", &["CBspheres_lambertian", "CBspheres"], ("course-cornell-box", None));
pub(super) const BOX_BUNNY: Role = role("bunny", &["CBbunny"], ("cornell-teapot", None));
pub(super) const EMPTY: Role = role("empty", &["CBempty"], ("indirect-only-room", None));
pub(super) const COIL: Role = role("coil", &["CBcoil"], ("bumpy-sphere", None));
pub(super) const BANANA: Role = role("banana", &["banana"], ("sphereflake", None));
pub(super) const DRAGON: Role =
    role("dragon", &["CBdragon", "dragon"], ("cornell-diffuse-spheres", None));

/// Meshes for the BVH, each with a stand-in of about as many triangles.
pub(super) const MESHES: &[Role] = &[
    role("cow", &["cow"], ("bumpy-sphere", Some(("subdivisions", 4)))),
    role("teapot", &["teapot"], ("teapot", Some(("segments", 6)))),
    role("beetle", &["beetle"], ("soup", Some(("triangles", 7_558)))),
    role("maxplanck", &["maxplanck"], ("teapot", Some(("segments", 28)))),
    role("bunny", &["bunny"], ("soup", Some(("triangles", 33_696)))),
    role("dragon", &["dragon", "CBdragon"], ("bumpy-sphere", Some(("subdivisions", 6)))),
    role("lucy", &["CBlucy"], ("soup", Some(("triangles", 133_796)))),
    alone("wall-e", &["wall-e"]),
];

/// What the course's write-ups show of the 800 x 600 pixels of a scene of theirs: the part that `-r 480 360` cuts out.
const FRAME: [i64; 2] = [480, 360];

/// Where scenes are looked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cast {
    /// Every `.dae` file of the folder that the user has named.
    files: Vec<PathBuf>,
    folder: Option<PathBuf>,
}

impl Cast {
    /// Scenes of the project alone.
    pub(crate) fn of_project() -> Self {
        Self::default()
    }

    /// The course's scenes in a folder or below it; what is not there is stood in for.
    ///
    /// # Errors
    /// If none is there.
    pub(crate) fn in_folder(folder: &Path) -> Result<Self, String> {
        if !folder.is_dir() {
            return Err(format!("there is no folder `{}`", folder.display()));
        }
        let entries = WalkDir::new(folder).sort_by_file_name().into_iter().flatten();
        let paths = entries.map(walkdir::DirEntry::into_path);
        let is_scene = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "dae");
        let files: Vec<_> = paths.filter(is_scene).collect();
        if files.is_empty() {
            let hint = "hint: name the folder `dae` of the course, or leave --scenes out";
            return Err(format!("`{}` holds no .dae file\n{hint}", folder.display()));
        }
        Ok(Self { files, folder: Some(folder.to_owned()) })
    }

    /// The shot of a role's scene, or why there is none.
    pub(super) fn shot(&self, role: Role) -> Result<Shot, String> {
        if let Some(file) = self.file(role) {
            return Ok(Shot::of(file.to_string_lossy()));
        }
        let (scene, parameter) = role.stand_in.ok_or_else(|| self.missing(role))?;
        let set = parameter.map(|(name, value)| (name.to_owned(), value.into()));
        Ok(Shot { set: set.into_iter().collect(), ..Shot::of(scene) })
    }

    /// The same as a figure frames it.
    pub(super) fn framed(&self, role: Role) -> Result<Shot, String> {
        let mut shot = self.shot(role)?;
        if self.file(role).is_some() {
            shot.set.push(("film".to_owned(), FRAME.to_vec().into()));
        }
        Ok(shot)
    }

    /// What people call its scene, and whose place that takes.
    pub(super) fn name(&self, role: Role) -> String {
        let course = format!("{}.dae", role.files[0]);
        match (self.file(role), role.stand_in) {
            (Some(file), _) => file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            (None, None) => course,
            (None, Some((scene, None))) => format!("{scene} (for {course})"),
            (None, Some((scene, Some((name, value))))) => {
                format!("{scene}, {name} {value} (for {course})")
            }
        }
    }

    fn file(&self, role: Role) -> Option<&PathBuf> {
        let is_called = |path: &&PathBuf, name: &str| {
            path.file_stem().is_some_and(|stem| stem.eq_ignore_ascii_case(name))
        };
        role.files.iter().find_map(|name| self.files.iter().find(|path| is_called(path, name)))
    }

    fn missing(&self, role: Role) -> String {
        let file = format!("{}.dae", role.files[0]);
        match &self.folder {
            Some(folder) => format!("`{}` has no {file}", folder.display()),
            None => format!("no scene of the project stands in for {file}; give it with --scenes"),
        }
    }

    /// What the reader is to know of the scenes.
    pub(super) fn told(&self, roles: impl Iterator<Item = Role>) -> String {
        let Some(folder) = &self.folder else {
            return "Scenes: of the bench, standing in for the course's; `--scenes DIR` takes the \
                    course's own `.dae` files."
                .to_owned();
        };
        let absent = roles.filter(|role| self.file(*role).is_none() && role.stand_in.is_some());
        let mut absent: Vec<_> = absent.map(|role| format!("{}.dae", role.files[0])).collect();
        absent.sort();
        absent.dedup();
        let [width, height] = FRAME;
        let scenes = format!(
            "Scenes: the course's, from `{}`, framed as by its `-r {width} {height}`",
            folder.display()
        );
        match absent.as_slice() {
            [] => format!("{scenes}."),
            absent => {
                format!("{scenes}; scenes of the bench stand in for {}.", absent.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_folder_has_is_taken_and_the_rest_is_stood_in_for_or_missed() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("sky")).unwrap();
        std::fs::write(folder.path().join("sky/cbBunny.dae"), "").unwrap();
        let cast = Cast::in_folder(folder.path()).unwrap();
        assert!(cast.shot(BOX_BUNNY).unwrap().scene.ends_with("sky/cbBunny.dae"));
        assert_eq!(cast.shot(SPHERES).unwrap().scene, "course-cornell-box");
        let framed = |role| cast.framed(role).unwrap().set;
        assert_eq!(framed(BOX_BUNNY), [("film".to_owned(), vec![480, 360].into())]);
        assert_eq!(framed(SPHERES), []);
        assert_eq!(cast.name(BOX_BUNNY), "cbBunny.dae");
        assert_eq!(cast.name(SPHERES), "course-cornell-box (for CBspheres_lambertian.dae)");
        let missing = cast.shot(alone("wall-e", &["wall-e"])).unwrap_err();
        assert!(missing.ends_with("has no wall-e.dae"), "{missing}");
        let told = cast.told([BOX_BUNNY, SPHERES].into_iter());
        assert!(told.ends_with("stand in for CBspheres_lambertian.dae."), "{told}");
    }

    #[test]
    fn a_folder_without_scenes_is_refused_with_what_to_name() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Cast::in_folder(folder.path()).unwrap_err().contains("holds no .dae file"));
        assert!(Cast::in_folder(&folder.path().join("none")).is_err());
    }
}
