//! What a set is made from: files below folders and in zip files, and seeds.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use orbflow_geometry::mesh::io::Format;
use orbflow_geometry::mesh::{PolygonMesh, TriangleMesh, io as mesh_io};
use orbflow_network::weights::fnv;
use thiserror::Error;

use crate::licence::Licences;
use crate::set::Split;
use crate::shapes::shape;
use crate::tree::Tree;

/// Of a hundred files or seeds, how many are held back, with all their parts.
const HELD_BACK_PCT: usize = 15;
/// Seeds of shapes that are held back start so much later; training never comes so far.
const FIRST_HELD_BACK: u64 = 1 << 40;

/// What one or a few shapes are made from.
#[derive(Clone)]
pub struct Item {
    /// The file below what was given, or the seed.
    pub name: String,
    /// The folder that it is in, or "made".
    pub category: String,
    /// What its folder says of its licence.
    pub licence: String,
    /// On which side it is.
    pub split: Split,
    origin: Origin,
}

#[derive(Clone)]
enum Origin {
    Seed(u64),
    File(Arc<Tree>, String),
    /// It cannot be opened.
    Broken(String),
}

/// Why there are no sources.
#[derive(Debug, Error)]
pub enum SourceError {
    /// A folder or file cannot be read.
    #[error("cannot read {path}: {cause}")]
    Read {
        /// Which.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// There is neither a file nor a seed.
    #[error("there is nothing to prepare: no mesh in the {n_given} places given, no made shapes")]
    Nothing {
        /// How many places there were to look.
        n_given: usize,
    },
    /// Two files have one name.
    #[error("two sources are called {name}; give the folder that both are in")]
    Twice {
        /// The name.
        name: String,
    },
}

/// The seeds and the files of folders, zip files and meshes: seeds first, then files in the order of
/// their paths. Files of unknown licence are under `licence`.
///
/// # Errors
/// [`SourceError`]; a zip file that cannot be read is left out and named.
pub fn items(
    given: &[PathBuf],
    (n_procedural, seed): (usize, u64),
    licence: Option<&str>,
) -> Result<Vec<Item>, SourceError> {
    let mut items = seeds(n_procedural, seed);
    let mut beside = BTreeMap::new();
    for path in given {
        let name = name_of(path);
        let said = licence_beside(path, &name, &mut beside);
        add(path, &name, said.as_deref().or(licence), &mut items)?;
    }
    if items.is_empty() {
        let n_given = given.len();
        return Err(SourceError::Nothing { n_given });
    }
    let mut names: Vec<&str> = items.iter().map(|item| item.name.as_str()).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(items),
        Some(pair) => {
            let name = pair[0].to_owned();
            Err(SourceError::Twice { name })
        }
    }
}

/// What a place is called; a link is called as it calls itself, which is what its folder has.
fn name_of(path: &Path) -> String {
    let whole = match path.file_name() {
        Some(_) => None,
        None => path.canonicalize().ok(),
    };
    let name = whole.as_deref().unwrap_or(path).file_name();
    name.unwrap_or_default().to_string_lossy().into_owned()
}

/// What the folder of a mesh or zip file that is given by itself says of its licence; each folder is
/// read once.
fn licence_beside(
    path: &Path,
    name: &str,
    read: &mut BTreeMap<PathBuf, Licences>,
) -> Option<String> {
    if path.is_dir() {
        return None;
    }
    let folder = Tree::folder_of(path);
    let licences = read
        .entry(folder.to_owned())
        .or_insert_with(|| Licences::of(&Tree::of_files_in(folder)));
    licences.licence_of(name)
}

fn seeds(n: usize, first: u64) -> Vec<Item> {
    let n_held_back = n * HELD_BACK_PCT / 100;
    let made = |split: Split, first: u64, n: usize| {
        let seeds = (0..n as u64).map(move |i| first.wrapping_add(i));
        seeds.map(move |seed| Item {
            name: format!("shape {seed}"),
            category: "made".to_owned(),
            licence: "made, needs none".to_owned(),
            split,
            origin: Origin::Seed(seed),
        })
    };
    let held_back = made(
        Split::Test,
        first.wrapping_add(FIRST_HELD_BACK),
        n_held_back,
    );
    made(Split::Train, first, n - n_held_back)
        .chain(held_back)
        .collect()
}

/// Adds the meshes of one place, and of the zip files in it.
fn add(
    path: &Path,
    name: &str,
    licence: Option<&str>,
    items: &mut Vec<Item>,
) -> Result<(), SourceError> {
    let failed = |cause| SourceError::Read {
        path: path.to_owned(),
        cause,
    };
    if is_zip(path) && path.is_file() {
        match Tree::of_zip(path, name) {
            Ok(tree) => add_tree(tree, licence, items)?,
            Err(reason) => items.push(Item {
                name: name.to_owned(),
                category: "zip".to_owned(),
                licence: licence.unwrap_or("unknown").to_owned(),
                split: split_of(name),
                origin: Origin::Broken(reason),
            }),
        }
        return Ok(());
    }
    let tree = if path.is_dir() {
        Tree::of_folder(path, name)
    } else {
        fs::metadata(path).map(|_| Tree::of_file(path, name))
    };
    add_tree(tree.map_err(failed)?, licence, items)
}

fn add_tree(tree: Tree, licence: Option<&str>, items: &mut Vec<Item>) -> Result<(), SourceError> {
    let licences = Licences::of(&tree);
    let tree = Arc::new(tree);
    for file in tree.files() {
        let name = tree.name_of(file);
        let said = licences.licence_of(file);
        if let (Some(path), true) = (tree.path_of(file), is_zip(Path::new(file))) {
            add(&path, &name, said.as_deref().or(licence), items)?;
        } else if Format::from_path(Path::new(file)).is_some() {
            let folder = Path::new(&name).parent().and_then(Path::file_name);
            items.push(Item {
                category: folder.unwrap_or_default().to_string_lossy().into_owned(),
                licence: said.unwrap_or_else(|| licence.unwrap_or("unknown").to_owned()),
                split: split_of(file),
                origin: Origin::File(tree.clone(), file.clone()),
                name,
            });
        }
    }
    Ok(())
}

fn is_zip(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("zip"))
}

/// By the name without its number, so that more files do not move a file to the other side and
/// that the parts and variants of one model (`sofa2_01`, `sofa2_02`, `sofa_01`) are on one side.
fn split_of(file: &str) -> Split {
    let stem = Path::new(file).file_stem().unwrap_or_default();
    let stem = stem.to_string_lossy();
    let model = stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    if (fnv(model.as_bytes()) >> 32) % 100 < HELD_BACK_PCT as u64 {
        Split::Test
    } else {
        Split::Train
    }
}

/// A mesh as it was found: made shapes are closed, files may be anything.
pub enum Found {
    /// A closed mesh of genus 0.
    Made(TriangleMesh),
    /// The polygons of a file.
    File(PolygonMesh),
}

impl Item {
    /// Makes or reads the mesh.
    ///
    /// # Errors
    /// Why it cannot be read, in words.
    pub fn read(&self) -> Result<Found, String> {
        match &self.origin {
            Origin::Seed(seed) => Ok(Found::Made(shape(*seed))),
            Origin::Broken(reason) => Err(reason.clone()),
            Origin::File(tree, file) => {
                let format = Format::from_path(Path::new(file)).ok_or("not a mesh")?;
                let read = mesh_io::read(&tree.read(file)?, format);
                Ok(Found::File(read.map_err(|e| e.to_string())?.mesh))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use rawzip::ZipArchiveWriter;

    use super::*;

    /// A zip file of files as they are.
    fn zip(files: &[(&str, &str)]) -> Result<Vec<u8>, rawzip::Error> {
        let mut bytes = Vec::new();
        let mut archive = ZipArchiveWriter::new(&mut bytes);
        for (name, text) in files {
            let (mut entry, config) = archive.new_file(*name).start()?;
            let mut out = config.wrap(&mut entry);
            out.write_all(text.as_bytes())?;
            let (_, descriptor) = out.finish()?;
            entry.finish(descriptor)?;
        }
        archive.finish()?;
        Ok(bytes)
    }

    fn licences(given: &[PathBuf]) -> Vec<(String, String)> {
        let items = items(given, (0, 0), Some("asked")).expect("there are meshes");
        let said = items.into_iter().map(|item| (item.name, item.licence));
        said.collect()
    }

    #[test]
    fn the_licence_beside_a_mesh_or_zip_is_its_own_unless_the_zip_has_one() {
        let folder = tempfile::tempdir().unwrap();
        let models = folder.path().join("models");
        fs::create_dir(&models).unwrap();
        let put = |name: &str, bytes: &[u8]| fs::write(models.join(name), bytes).unwrap();
        put("cat.obj", b"");
        put("dog.obj", b"");
        put("plain.zip", &zip(&[("fish.obj", "")]).unwrap());
        let own = zip(&[("fish.obj", ""), ("README", "CC0")]).unwrap();
        put("own.zip", &own);
        put("broken.zip", b"PK nonsense");
        put("LICENSE", b"The MIT License");
        put("table.csv", b"file,licence\ndog.obj,by the table\n");
        let wanted = [
            ("broken.zip", "MIT"),
            ("cat.obj", "MIT"),
            ("dog.obj", "by the table"),
            ("own.zip/fish.obj", "CC0-1.0"),
            ("plain.zip/fish.obj", "MIT"),
        ];
        let below = wanted.map(|(name, licence)| (format!("models/{name}"), licence.to_owned()));
        assert_eq!(licences(std::slice::from_ref(&models)), below);
        let names = ["broken.zip", "cat.obj", "dog.obj", "own.zip", "plain.zip"];
        let each = wanted.map(|(name, licence)| (name.to_owned(), licence.to_owned()));
        assert_eq!(licences(&names.map(|name| models.join(name))), each);

        fs::remove_file(models.join("LICENSE")).unwrap();
        let asked = [("cat.obj".to_owned(), "asked".to_owned())];
        assert_eq!(licences(&[models.join("cat.obj")]), asked);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_called_as_it_calls_itself() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all(path("kept/models")).unwrap();
        fs::write(
            path("kept/MD5-1234"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        )
        .unwrap();
        for link in ["cat.obj", "kept/models/dog.obj"] {
            std::os::unix::fs::symlink(path("kept/MD5-1234"), path(link)).unwrap();
            let items = items(&[path(link)], (0, 0), None).unwrap();
            assert!(link.ends_with(&items[0].name), "{}", items[0].name);
            assert!(matches!(items[0].read(), Ok(Found::File(_))));
        }
        let dots = items(&[path("kept/models/..")], (0, 0), None).unwrap();
        assert_eq!(dots[0].name, "kept/models/dog.obj");
    }

    #[test]
    fn a_file_stays_on_its_side() {
        let is_test = |name: &str| split_of(name) == Split::Test;
        let n = (0..1000)
            .filter(|i| is_test(&format!("a/{i}.model.obj")))
            .count();
        assert!((100..200).contains(&n), "{n}");
        for i in 0..40 {
            let sides = ["a/{i}sofa_01.obj", "b/c/{i}sofa_12.off", "{i}sofa2_03.obj"];
            let sides = sides.map(|name| is_test(&name.replace("{i}", &i.to_string())));
            assert!(sides.iter().all(|&side| side == sides[0]), "{i}");
        }
    }

    #[test]
    fn of_a_hundred_seeds_fifteen_are_held_back() {
        let items = seeds(100, 7);
        let test: Vec<_> = items.iter().filter(|i| i.split == Split::Test).collect();
        assert_eq!(test.len(), 15);
        assert_eq!(items[0].name, "shape 7");
        assert_eq!(test[0].name, format!("shape {}", (1u64 << 40) + 7));
    }
}
