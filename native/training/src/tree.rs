//! Files below folders and in zip files.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::zips::Zip;

/// Files below one folder or in one zip file.
pub struct Tree {
    root: Root,
    /// What its files are called from outside; empty for a single file.
    name: String,
    /// All files, by their path from the root with `/` between.
    files: Vec<String>,
}

enum Root {
    Folder(PathBuf),
    Zip(Zip),
}

impl Tree {
    /// A single file, of this name in its folder.
    pub fn of_file(path: &Path, name: &str) -> Self {
        Self {
            root: Root::Folder(Self::folder_of(path).to_owned()),
            name: String::new(),
            files: vec![name.to_owned()],
        }
    }

    /// The files of a folder and its subfolders.
    ///
    /// # Errors
    /// What the system says.
    pub fn of_folder(root: &Path, name: &str) -> io::Result<Self> {
        let mut files = Vec::new();
        list(root, "", &mut files)?;
        Ok(Self {
            root: Root::Folder(root.to_owned()),
            name: name.to_owned(),
            files,
        })
    }

    /// The files of a folder without its subfolders; none where it cannot be read.
    pub fn of_files_in(folder: &Path) -> Self {
        let mut files: Vec<String> = fs::read_dir(folder)
            .into_iter()
            .flatten()
            .flatten()
            .filter(|entry| entry.path().is_file())
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        files.sort_unstable();
        Self {
            root: Root::Folder(folder.to_owned()),
            name: String::new(),
            files,
        }
    }

    /// The files of a zip file.
    ///
    /// # Errors
    /// Why it cannot be read, in words.
    pub fn of_zip(path: &Path, name: &str) -> Result<Self, String> {
        let zip = Zip::open(path)?;
        Ok(Self {
            files: zip.names().cloned().collect(),
            root: Root::Zip(zip),
            name: name.to_owned(),
        })
    }

    /// The folder that a path is in.
    pub fn folder_of(path: &Path) -> &Path {
        match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        }
    }

    /// What a file of it is called from outside.
    pub fn name_of(&self, file: &str) -> String {
        if self.name.is_empty() {
            return file.to_owned();
        }
        format!("{}/{file}", self.name)
    }

    /// Where a file of it is, unless that is in a zip file.
    pub fn path_of(&self, file: &str) -> Option<PathBuf> {
        match &self.root {
            Root::Folder(root) => Some(root.join(file)),
            Root::Zip(_) => None,
        }
    }

    /// All files, by their path from the root with `/` between.
    pub fn files(&self) -> &[String] {
        &self.files
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// Why they cannot be read, in words.
    pub fn read(&self, file: &str) -> Result<Vec<u8>, String> {
        match &self.root {
            Root::Folder(root) => fs::read(root.join(file)).map_err(|e| e.to_string()),
            Root::Zip(zip) => zip.read(file),
        }
    }
}

/// The files of a folder and its subfolders, in the order of their names; links to folders are not
/// followed, they may lead back.
fn list(folder: &Path, below: &str, files: &mut Vec<String>) -> io::Result<()> {
    let mut entries: Vec<fs::DirEntry> = fs::read_dir(folder)?.collect::<io::Result<_>>()?;
    entries.sort_by_key(fs::DirEntry::path);
    for entry in entries {
        let name = format!("{below}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else if entry.path().is_file() {
            files.push(name);
        }
    }
    Ok(())
}
