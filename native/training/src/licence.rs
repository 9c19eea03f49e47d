//! What a folder says of the licences of its files.

use std::collections::BTreeMap;
use std::path::Path;

use crate::tree::Tree;

/// Words that stand in the texts of licences, and their short names. Where one text has the words of
/// another, that stands first.
const KNOWN: [(&str, &str); 9] = [
    ("CC0", "CC0-1.0"),
    ("CREATIVE COMMONS ZERO", "CC0-1.0"),
    ("PUBLIC DOMAIN", "public domain"),
    ("CC-BY-4.0", "CC-BY-4.0"),
    ("CC BY 4.0", "CC-BY-4.0"),
    ("ATTRIBUTION 4.0 INTERNATIONAL", "CC-BY-4.0"),
    ("CC BY", "CC-BY"),
    ("MIT LICENSE", "MIT"),
    ("APACHE LICENSE", "Apache-2.0"),
];

/// The licences of the files of a tree.
pub struct Licences {
    /// By file, from tables with columns "file" and "licence".
    by_file: BTreeMap<String, String>,
    /// By folder (empty, or with `/` at its end), from texts called LICENSE or README.
    by_folder: BTreeMap<String, String>,
}

impl Licences {
    /// Reads the tables and texts of a tree; what cannot be read says nothing.
    pub fn of(tree: &Tree) -> Self {
        let mut licences = Self {
            by_file: BTreeMap::new(),
            by_folder: BTreeMap::new(),
        };
        for file in tree.files() {
            let (folder, name) = match file.rfind('/') {
                Some(at) => file.split_at(at + 1),
                None => ("", file.as_str()),
            };
            let is_table = Path::new(name).extension().is_some_and(|e| e == "csv");
            let rank = rank(name);
            if !is_table && rank.is_none() {
                continue;
            }
            let Some(text) = tree.read(file).ok().and_then(|b| String::from_utf8(b).ok()) else {
                continue;
            };
            if is_table {
                licences.add_table(folder, &text);
            } else if let Some(found) = recognised(&text) {
                // What is called a licence counts for more than a README.
                let said = licences.by_folder.entry(folder.to_owned());
                let said = said.or_insert_with(|| found.to_owned());
                if rank == Some(Rank::Licence) {
                    found.clone_into(said);
                }
            }
        }
        licences
    }

    /// The licence of a file: from a table, or from the text in its folder or the next one above.
    pub fn licence_of(&self, file: &str) -> Option<String> {
        if let Some(said) = self.by_file.get(file) {
            return Some(said.clone());
        }
        let above = file.match_indices('/').map(|(at, _)| &file[..=at]);
        let mut folders: Vec<&str> = std::iter::once("").chain(above).collect();
        folders.reverse();
        let said = folders
            .iter()
            .find_map(|&folder| self.by_folder.get(folder));
        said.cloned()
    }

    fn add_table(&mut self, folder: &str, text: &str) {
        let mut lines = text.lines().map(cells);
        let header = lines.next().unwrap_or_default();
        let column = |names: &[&str]| {
            let is_it = |cell: &String| names.contains(&cell.to_lowercase().as_str());
            header.iter().position(is_it)
        };
        let (Some(file), Some(licence)) = (column(&["file"]), column(&["licence", "license"]))
        else {
            return;
        };
        for line in lines {
            if let (Some(file), Some(licence)) = (line.get(file), line.get(licence))
                && !licence.is_empty()
            {
                let name = format!("{folder}{file}");
                self.by_file.insert(name, licence.clone());
            }
        }
    }
}

/// What a text counts for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rank {
    Readme,
    Licence,
}

fn rank(name: &str) -> Option<Rank> {
    let name = name.to_lowercase();
    let begins = |words: &[&str]| words.iter().any(|word| name.starts_with(word));
    if begins(&["license", "licence", "copying"]) {
        Some(Rank::Licence)
    } else {
        begins(&["readme"]).then_some(Rank::Readme)
    }
}

/// The licence that a text names; none where it names none or several.
fn recognised(text: &str) -> Option<&'static str> {
    let text = text.to_uppercase();
    let mut named = KNOWN.iter().filter(|(words, _)| text.contains(words));
    let (_, first) = named.next()?;
    let is_of_it = |name: &str| {
        let is_zero = *first == "CC0-1.0" && name == "public domain";
        name == *first || is_zero || first.starts_with(name)
    };
    named.all(|(_, name)| is_of_it(name)).then_some(*first)
}

/// The cells of a line of comma-separated values; quotes may hold commas.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut is_quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            c => cells.last_mut().expect("there is one").push(c),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_name_one_licence_or_none() {
        for (text, wanted) in [
            ("All models are CC0 (public domain).", Some("CC0-1.0")),
            ("License: CC-BY-4.0", Some("CC-BY-4.0")),
            ("The MIT License", Some("MIT")),
            ("cats: CC0, dogs: CC BY 4.0", None),
            ("Ask me.", None),
        ] {
            assert_eq!(recognised(text), wanted, "{text}");
        }
    }

    #[test]
    fn quotes_hold_commas() {
        assert_eq!(cells("a,\"b, c\",,d"), ["a", "b, c", "", "d"]);
    }
}
