//! Files in a zip file, read without unpacking it. Hostile ones are thought of: a name is never a
//! path, and what a file unpacks to is bounded.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use flate2::read::DeflateDecoder;
use rawzip::{
    CompressionMethod, FileReader, RECOMMENDED_BUFFER_SIZE, ZipArchive, ZipArchiveEntryWayfinder,
};

/// A file that unpacks to more is not read: it may be made to fill the memory.
const MAX_UNPACKED: u64 = 1 << 30;

/// A zip file that is open.
pub struct Zip {
    archive: ZipArchive<FileReader>,
    members: BTreeMap<String, Member>,
}

#[derive(Clone, Copy)]
struct Member {
    place: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
    is_encrypted: bool,
}

impl Zip {
    /// Opens a zip file and reads its directory. Where two files have one name the last counts.
    ///
    /// # Errors
    /// Why it cannot be read, in words.
    pub fn open(path: &Path) -> Result<Self, String> {
        let file = File::open(path).map_err(|e| e.to_string())?;
        let mut buffer = vec![0; RECOMMENDED_BUFFER_SIZE];
        let archive = ZipArchive::from_file(file, &mut buffer).map_err(|e| e.to_string())?;
        let mut members = BTreeMap::new();
        let mut entries = archive.entries(&mut buffer);
        while let Some(entry) = entries.next_entry().map_err(|e| e.to_string())? {
            let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
            let member = Member {
                place: entry.wayfinder(),
                method: entry.compression_method(),
                is_encrypted: entry.flags().is_encrypted(),
            };
            if !entry.is_dir() {
                members.insert(name, member);
            }
        }
        Ok(Self { archive, members })
    }

    /// The names of its files, sorted.
    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.members.keys()
    }

    /// Unpacks a file.
    ///
    /// # Errors
    /// Why it cannot be, in words.
    pub fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        let member = self.members.get(name).ok_or("there is no such file")?;
        if member.is_encrypted {
            return Err("it is encrypted".to_owned());
        }
        let entry = self.archive.get_entry(member.place);
        let entry = entry.map_err(|e| e.to_string())?;
        match member.method {
            CompressionMethod::STORE => bounded(entry.verifying_reader(entry.reader())),
            CompressionMethod::DEFLATE => {
                bounded(entry.verifying_reader(DeflateDecoder::new(entry.reader())))
            }
            other => Err(format!("it is packed by {other:?}; only deflate is read")),
        }
    }
}

fn bounded(reader: impl Read) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = reader.take(MAX_UNPACKED + 1).read_to_end(&mut bytes);
    read.map_err(|e| e.to_string())?;
    if bytes.len() as u64 > MAX_UNPACKED {
        return Err(format!("it unpacks to more than {MAX_UNPACKED} bytes"));
    }
    Ok(bytes)
}
