//! Where bytes come from and go to.

use std::ffi::OsString;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// A file, or the standard stream that `-` stands for.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Place {
    /// Standard input or standard output.
    Standard,
    /// A file.
    File(PathBuf),
}

impl Place {
    /// The path of a file.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Standard => None,
            Self::File(path) => Some(path),
        }
    }

    /// The same place by the one name that all its names lead to, where its folder exists: links
    /// are followed, for what they point to is what is written.
    pub fn resolved(&self) -> Self {
        let Self::File(path) = self else {
            return Self::Standard;
        };
        let in_folder = || {
            let folder = path.parent()?;
            let folder = Some(folder).filter(|folder| !folder.as_os_str().is_empty());
            let folder = fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
            Some(folder.join(path.file_name()?))
        };
        let resolved = fs::canonicalize(path).ok().or_else(in_folder);
        Self::File(resolved.unwrap_or_else(|| path.clone()))
    }
}

impl From<OsString> for Place {
    fn from(name: OsString) -> Self {
        if name == "-" {
            Self::Standard
        } else {
            Self::File(name.into())
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Standard => f.write_str("-"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}
