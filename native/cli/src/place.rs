//! Where bytes come from and go to.

use std::ffi::OsString;
use std::fmt;
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
