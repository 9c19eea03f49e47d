//! What a set says of itself.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::thesis::chamfer;

/// What a set was asked for.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// How many faces the level has that is collapsed.
    pub n_faces: usize,
    /// How many shapes were made from seeds.
    pub n_procedural: usize,
    /// Where the seeds start.
    pub seed: u64,
    /// The licence of files whose folder names none.
    pub licence: Option<String>,
    /// How many sources there are to be.
    pub n_sources: usize,
    /// How the targets of the thesis were made, if they were; a set without says nothing of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub targets: Option<chamfer::Settings>,
}

/// Whether training may see a shape.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// It is to train on.
    Train,
    /// It is held back.
    Test,
}

/// A file or a seed, and what became of it.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// The file, below the folder or zip file that was given; or the seed.
    pub name: String,
    /// The folder that it is in, or "made".
    pub category: String,
    /// What its folder says of its licence.
    pub licence: String,
    /// On which side all of its parts are.
    pub split: Split,
    /// Its usable parts, the largest first.
    pub parts: Vec<Counts>,
    /// What was left out of it, and why.
    pub left_out: Vec<String>,
}

/// How large a part is, and its bytes.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counts {
    /// Vertices of the part; of one with very many faces, of what it was brought down to.
    pub n_vertices: usize,
    /// Its faces.
    pub n_faces: usize,
    /// Vertices of the level that is collapsed.
    pub n_level_vertices: usize,
    /// How many bytes the part takes in the set.
    pub n_bytes: u64,
    /// FNV-1a of these bytes.
    pub sum: u64,
}

/// All that a set says of itself, to be read by people.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Manifest<'a> {
    /// What it was asked for.
    pub asked: &'a Head,
    /// Whether every source is in it.
    pub is_complete: bool,
    /// Shapes to train on.
    pub n_train: usize,
    /// Shapes held back.
    pub n_test: usize,
    /// Sources without a usable part.
    pub n_left_out: usize,
    /// How many shapes are under each licence.
    pub licences: BTreeMap<&'a str, usize>,
    /// One by one.
    pub sources: Vec<&'a Source>,
}

impl<'a> Manifest<'a> {
    /// The manifest of some sources of a set.
    pub fn new(asked: &'a Head, sources: impl Iterator<Item = &'a Source>) -> Self {
        let sources: Vec<&Source> = sources.collect();
        let count = |split: Split| {
            let of = sources.iter().filter(|source| source.split == split);
            of.map(|source| source.parts.len()).sum()
        };
        let mut licences = BTreeMap::new();
        for source in sources.iter().filter(|source| !source.parts.is_empty()) {
            *licences.entry(source.licence.as_str()).or_default() += source.parts.len();
        }
        let is_left_out = |source: &&&Source| source.parts.is_empty();
        Self {
            asked,
            is_complete: sources.len() == asked.n_sources,
            n_train: count(Split::Train),
            n_test: count(Split::Test),
            n_left_out: sources.iter().filter(is_left_out).count(),
            licences,
            sources,
        }
    }

    /// The shapes and licences of the set in a sentence, for the header of weights.
    pub fn sentence(&self) -> String {
        let licences = self.licences.iter();
        let licences: Vec<String> = licences.map(|(name, n)| format!("{n}: {name}")).collect();
        let (n_train, n_test) = (self.n_train, self.n_test);
        let licences = licences.join("; ");
        format!("{n_train} shapes to train on, {n_test} held back ({licences})")
    }
}
