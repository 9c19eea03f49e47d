//! How the words of arguments become values.

use std::ops::RangeInclusive;

use clap::builder::{PossibleValuesParser, TypedValueParser, ValueParser};
use orbflow_geometry::pipeline::{
    Borders, Handles, Inner, Kind, MAX_FACES, MAX_FILL, MAX_WELD, MIN_FACES, Mirror, Primitive,
    SOLID_DETAILS, SmallParts,
};

use crate::formats::FileFormat;
use crate::parts::Weld;

/// A parser of the number of faces of a result.
pub fn n_faces() -> ValueParser {
    whole(MIN_FACES as u64..=MAX_FACES as u64)
}

/// A parser of whole numbers in a range.
pub fn whole(range: RangeInclusive<u64>) -> ValueParser {
    let parser = clap::value_parser!(u64).range(range);
    ValueParser::new(parser.map(|n| n as usize))
}

/// A parser of the names of some values.
fn named<T>(values: &'static [T], name: fn(T) -> &'static str) -> ValueParser
where
    T: Copy + Send + Sync + 'static,
{
    let parser = PossibleValuesParser::new(values.iter().map(|&value| name(value)));
    ValueParser::new(parser.try_map(move |given| {
        let value = values.iter().find(|value| name(**value) == given);
        value.copied().ok_or("no such value")
    }))
}

/// A parser of some formats by name.
pub fn format(values: &'static [FileFormat]) -> ValueParser {
    named(values, FileFormat::name)
}

/// A parser of the kinds of polygons by name.
pub fn kind() -> ValueParser {
    named(&[Kind::Triangles, Kind::Quads], Kind::name)
}

/// A parser of switches.
pub fn on_off() -> ValueParser {
    named(&[true, false], |is_on| if is_on { "on" } else { "off" })
}

/// Reads a share: 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    up_to(text, 1.0)
}

/// Reads an angle in degrees: 0 to 180.
pub fn degrees(text: &str) -> Result<f64, String> {
    up_to(text, 180.0)
}

/// Reads a percentage: 0 to 100.
pub fn percent(text: &str) -> Result<f64, String> {
    up_to(text, 100.0)
}

/// Reads a weld distance, or none.
pub fn weld(text: &str) -> Result<Weld, String> {
    if text == "off" {
        return Ok(Weld(None));
    }
    up_to(text, MAX_WELD).map(|share| Weld(Some(share)))
}

/// Reads what becomes of borders.
pub fn borders(text: &str) -> Result<Borders, String> {
    match text.split_once(':') {
        None if text == "keep" => Ok(Borders::Keep),
        None if text == "fill" => Ok(Borders::Fill),
        Some(("fill", size)) => up_to(size, MAX_FILL).map(Borders::FillUpTo),
        _ => Err("it is keep, fill, or fill:SIZE".to_owned()),
    }
}

/// Reads what becomes of handles.
pub fn handles(text: &str) -> Result<Handles, String> {
    match text.split_once(':') {
        None if text == "keep" => Ok(Handles::Keep),
        Some(("seal", size)) => up_to(size, MAX_FILL).map(Handles::SealUpTo),
        _ => Err("it is keep or seal:SIZE".to_owned()),
    }
}

/// Reads the detail of a solid.
pub fn solid_detail(text: &str) -> Result<f64, String> {
    let [least, most] = SOLID_DETAILS;
    let value = text.parse().map_err(|error| format!("{error}"))?;
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(format!("it goes from {least} to {most}"))
}

/// A parser of what becomes of parts inside others.
pub fn inner() -> ValueParser {
    named(&[Inner::Keep, Inner::Drop], Inner::name)
}

/// A parser of what becomes of small parts.
pub fn small_parts() -> ValueParser {
    named(&[SmallParts::Keep, SmallParts::Drop], SmallParts::name)
}

fn up_to(text: &str, most: f64) -> Result<f64, String> {
    let value = text.parse().map_err(|error| format!("{error}"))?;
    if (0.0..=most).contains(&value) {
        return Ok(value);
    }
    Err(format!("it goes from 0 to {most}"))
}

/// A parser of the planes of symmetry by name.
pub fn mirror() -> ValueParser {
    const ALL: &[Mirror] = &[Mirror::Off, Mirror::Auto, Mirror::X, Mirror::Y, Mirror::Z];
    named(ALL, Mirror::name)
}

/// A parser of the primitives by name.
pub fn primitive() -> ValueParser {
    const ALL: &[Primitive] = &[
        Primitive::Adaptive,
        Primitive::Flow,
        Primitive::QuadSphere,
        Primitive::Icosphere,
    ];
    named(ALL, Primitive::name)
}
