//! Any bytes are a mesh or an error; a mesh that was read is written and read back the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use orbflow_geometry::mesh::io::{Format, read, write};

fuzz_target!(|bytes: &[u8]| {
    // The first byte picks the format, so that no format is found by chance only.
    let Some((&pick, bytes)) = bytes.split_first() else {
        return;
    };
    let format = match pick % 5 {
        0 => Format::Obj,
        1 => Format::Ply,
        2 => Format::Stl,
        3 => Format::Off,
        _ => Format::sniff(bytes),
    };
    let Ok(file) = read(bytes, format) else {
        return;
    };
    for format in [Format::Obj, Format::Ply, Format::Off] {
        let mut written = Vec::new();
        write(&file, format, &mut written).expect("memory takes everything");
        let again = read(&written, format).expect("what is written can be read");
        assert_eq!(again.mesh, file.mesh);
    }
});
