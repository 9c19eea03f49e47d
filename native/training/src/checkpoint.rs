//! The checkpoint of a run, of which a kill always leaves a whole one.
//!
//! `checkpoint.new` is written first, its state last. Then `checkpoint` is renamed to `checkpoint.old`,
//! `checkpoint.new` to `checkpoint`, and the old one is removed. Between the two renames there is no
//! `checkpoint`, but the other two are whole, and [`Checkpoint::recovered`] takes the new one.

use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::run::{TrainError, file_error};
use crate::settings::Settings;

/// What a checkpoint says besides its tensors.
#[derive(Serialize, Deserialize)]
pub struct State {
    pub settings: Settings,
    pub step: usize,
    /// The sum of the set that was trained on; older checkpoints do not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub set: Option<u64>,
}

/// Where the checkpoint of a run is, and what it was and will be.
pub struct Checkpoint {
    fresh: PathBuf,
    folder: PathBuf,
    old: PathBuf,
}

impl Checkpoint {
    /// The checkpoint of a run, which may not be there yet.
    pub fn of(run: &Path) -> Self {
        let [fresh, folder, old] =
            ["checkpoint.new", "checkpoint", "checkpoint.old"].map(|name| run.join(name));
        Self { fresh, folder, old }
    }

    /// The folder of the checkpoint, put back where a kill came between the two renames; none where
    /// there never was one.
    ///
    /// # Errors
    /// [`TrainError::File`].
    pub fn recovered(&self) -> Result<Option<&Path>, TrainError> {
        if !exists(&self.folder)? {
            let left = if read_state(&self.fresh).is_ok() {
                &self.fresh
            } else if exists(&self.old)? {
                &self.old
            } else {
                return Ok(None);
            };
            rename(left, &self.folder)?;
        }
        Ok(Some(&self.folder))
    }

    /// Replaces the checkpoint by what `write` puts into a folder, and a state beside it.
    ///
    /// # Errors
    /// [`TrainError::File`], or what `write` says.
    pub fn replace(
        &self,
        state: &State,
        write: impl FnOnce(&Path) -> Result<(), TrainError>,
    ) -> Result<(), TrainError> {
        let Self { fresh, folder, old } = self;
        let failed = |cause| file_error(fresh, cause);
        remove(fresh)?;
        fs::create_dir_all(fresh).map_err(failed)?;
        write(fresh)?;
        let text = serde_json::to_vec_pretty(state).map_err(|e| broken(fresh, &e))?;
        fs::write(fresh.join("state.json"), text).map_err(failed)?;
        if exists(folder)? {
            // Half of it may be left of a kill while it was removed.
            remove(old)?;
            rename(folder, old)?;
        }
        rename(fresh, folder)?;
        remove(old)
    }
}

/// What the checkpoint in a folder says besides its tensors.
///
/// # Errors
/// [`TrainError`], where it is not whole.
pub fn read_state(folder: &Path) -> Result<State, TrainError> {
    let path = folder.join("state.json");
    let text = fs::read(&path).map_err(|cause| file_error(&path, cause))?;
    serde_json::from_slice(&text).map_err(|e| broken(folder, &e))
}

/// A checkpoint that cannot be used.
pub fn broken(path: &Path, reason: &dyn Display) -> TrainError {
    TrainError::Checkpoint {
        path: path.to_owned(),
        reason: reason.to_string(),
    }
}

fn exists(path: &Path) -> Result<bool, TrainError> {
    path.try_exists().map_err(|cause| file_error(path, cause))
}

fn rename(from: &Path, to: &Path) -> Result<(), TrainError> {
    fs::rename(from, to).map_err(|cause| file_error(from, cause))
}

fn remove(folder: &Path) -> Result<(), TrainError> {
    if exists(folder)? {
        fs::remove_dir_all(folder).map_err(|cause| file_error(folder, cause))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(step: usize) -> State {
        let settings = Settings::default();
        State {
            settings,
            step,
            set: None,
        }
    }

    fn keep(run: &Path, step: usize) {
        let write = |folder: &Path| {
            // As burn does, which never replaces a file.
            let path = folder.join("network.bpk");
            let made = fs::File::create_new(&path).map(drop);
            made.map_err(|cause| file_error(&path, cause))
        };
        let kept = Checkpoint::of(run).replace(&state(step), write);
        kept.expect("the folder can be written");
    }

    fn step_of(run: &Path) -> Option<usize> {
        let checkpoint = Checkpoint::of(run);
        let folder = checkpoint.recovered().expect("the folder can be read");
        folder.map(|folder| read_state(folder).expect("it is whole").step)
    }

    /// A run with a checkpoint of step 4, and one of step 8 that is about to replace it.
    fn about_to_replace() -> tempfile::TempDir {
        let run = tempfile::tempdir().expect("there is a place");
        let path = |name: &str| run.path().join(name);
        keep(run.path(), 8);
        fs::rename(path("checkpoint"), path("kept")).expect("it is there");
        keep(run.path(), 4);
        fs::rename(path("kept"), path("checkpoint.new")).expect("it is there");
        run
    }

    #[test]
    fn a_kill_between_the_renames_loses_nothing() {
        let run = about_to_replace();
        let path = |name: &str| run.path().join(name);
        assert_eq!(step_of(run.path()), Some(4));
        fs::rename(path("checkpoint"), path("checkpoint.old")).unwrap();
        assert_eq!(step_of(run.path()), Some(8));
        keep(run.path(), 12);
        assert_eq!(step_of(run.path()), Some(12));
        assert!(!path("checkpoint.old").exists());
    }

    #[test]
    fn a_kill_while_the_old_one_is_removed_blocks_nothing() {
        let run = about_to_replace();
        let path = |name: &str| run.path().join(name);
        fs::rename(path("checkpoint"), path("checkpoint.old")).unwrap();
        fs::rename(path("checkpoint.new"), path("checkpoint")).unwrap();
        fs::remove_file(path("checkpoint.old/state.json")).unwrap();
        assert_eq!(step_of(run.path()), Some(8));
        keep(run.path(), 12);
        assert_eq!(step_of(run.path()), Some(12));
    }

    #[test]
    fn a_new_one_that_was_cut_counts_for_nothing() {
        for has_one in [true, false] {
            let run = about_to_replace();
            let path = |name: &str| run.path().join(name);
            fs::write(path("checkpoint.new/state.json"), "{\"sett").unwrap();
            if !has_one {
                fs::remove_dir_all(path("checkpoint")).unwrap();
            }
            assert_eq!(step_of(run.path()), has_one.then_some(4));
            keep(run.path(), 8);
            assert_eq!(step_of(run.path()), Some(8));
        }
    }
}
