//! Strokes that edges are to follow, from a file of OBJ lines.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use orbflow_geometry::guidance::{Strength, Stroke};

use crate::error::Error;

/// Strokes, as they are asked for.
#[derive(Args, Debug)]
pub struct Guides {
    /// Lines that edges of flowing quads follow, as an OBJ file with v and l elements near the
    /// surface of IN; an l that ends where it begins is closed
    #[arg(long, value_name = "FILE")]
    pub guides: Option<PathBuf>,
    /// How strictly, for lines that are in no object or group named exact... or follow...: exact
    /// lays edges on them, follow turns edges along them
    #[arg(long, default_value = Strength::Exact.name(), value_parser = strength())]
    pub guides_strength: Strength,
}

fn strength() -> impl TypedValueParser<Value = Strength> {
    let all = [Strength::Exact, Strength::Follow];
    PossibleValuesParser::new(all.map(Strength::name)).map(move |name| {
        let named = all.into_iter().find(|strength| strength.name() == name);
        named.expect("only names of strengths are parsed")
    })
}

impl Guides {
    /// The strokes of the file, if one is given.
    ///
    /// # Errors
    /// A file that cannot be read or has no lines.
    pub fn read(&self) -> Result<Vec<Stroke>, Error> {
        let Some(path) = &self.guides else {
            return Ok(Vec::new());
        };
        let text = fs::read_to_string(path).map_err(|cause| Error::OpenGuides {
            path: path.clone(),
            cause,
        })?;
        let mut reader = Reader {
            path,
            points: Vec::new(),
            strength: self.guides_strength,
            strokes: Vec::new(),
        };
        for (i, line) in text.lines().enumerate() {
            reader.line(i + 1, line, self.guides_strength)?;
        }
        if reader.strokes.is_empty() {
            return Err(Error::NoGuides { path: path.clone() });
        }
        Ok(reader.strokes)
    }
}

struct Reader<'a> {
    path: &'a Path,
    points: Vec<[f64; 3]>,
    /// That of the object or group that is open.
    strength: Strength,
    strokes: Vec<Stroke>,
}

impl Reader<'_> {
    fn line(&mut self, at: usize, line: &str, usual: Strength) -> Result<(), Error> {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let words: Vec<&str> = words.take(3).collect();
                let numbers = words.iter().map(|word| self.number(at, word));
                let numbers = numbers.collect::<Result<Vec<f64>, _>>()?;
                let point = numbers.try_into().map_err(|_| self.wrong(at, line))?;
                self.points.push(point);
            }
            Some("l") => {
                let points = words.map(|word| self.point(at, word));
                let points = points.collect::<Result<Vec<[f64; 3]>, _>>()?;
                self.strokes.push(stroke(points, self.strength));
            }
            Some("o" | "g") => {
                let name = words.next().unwrap_or_default().to_lowercase();
                let all = [Strength::Exact, Strength::Follow];
                let named = all.into_iter().find(|s| name.starts_with(s.name()));
                self.strength = named.unwrap_or(usual);
            }
            _ => {}
        }
        Ok(())
    }

    fn number(&self, at: usize, word: &str) -> Result<f64, Error> {
        word.parse().map_err(|_| Error::NotANumber {
            path: self.path.to_owned(),
            line: at,
            word: word.to_owned(),
        })
    }

    /// The point with a number, from 1 on or, if negative, from the last one back.
    fn point(&self, at: usize, word: &str) -> Result<[f64; 3], Error> {
        let name = word.split('/').next().unwrap_or_default();
        let number: Option<i64> = name.parse().ok();
        let n_points = self.points.len() as i64;
        let place = number.map(|i| if i < 0 { n_points + i } else { i - 1 });
        let point = place.and_then(|i| self.points.get(usize::try_from(i).ok()?));
        point.copied().ok_or_else(|| self.wrong(at, word))
    }

    fn wrong(&self, at: usize, word: &str) -> Error {
        Error::NotAGuide {
            path: self.path.to_owned(),
            line: at,
            word: word.to_owned(),
            n_points: self.points.len(),
        }
    }
}

/// A line; one that ends where it begins is closed.
fn stroke(mut points: Vec<[f64; 3]>, strength: Strength) -> Stroke {
    let is_closed = points.len() > 3 && points.first() == points.last();
    if is_closed {
        points.pop();
    }
    Stroke {
        points: points.into_iter().map(Into::into).collect(),
        is_closed,
        strength,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Stroke>, Error> {
        let mut reader = Reader {
            path: Path::new("g.obj"),
            points: Vec::new(),
            strength: Strength::Follow,
            strokes: Vec::new(),
        };
        for (i, line) in text.lines().enumerate() {
            reader.line(i + 1, line, Strength::Follow)?;
        }
        Ok(reader.strokes)
    }

    #[test]
    fn lines_know_their_strength_and_whether_they_are_closed() {
        let text =
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\no exact.001\nl 1 2 3 1\ng eyes\nl -3 -1 # end\n";
        let strokes = read(text).unwrap();
        let told: Vec<_> = strokes
            .iter()
            .map(|s| (s.points.len(), s.is_closed, s.strength))
            .collect();
        let wanted = [
            (3, false, Strength::Follow),
            (3, true, Strength::Exact),
            (2, false, Strength::Follow),
        ];
        assert_eq!(told, wanted);
        assert_eq!(strokes[2].points[1], [1.0, 1.0, 0.0].into());
    }

    #[test]
    fn points_that_do_not_exist_are_refused_with_line_and_number() {
        let error = read("v 0 0 0\nv 1 0 x").unwrap_err().to_string();
        assert_eq!(error, "g.obj, line 2: 'x' is not a number");
        let error = read("v 0 0 0\nl 1 2").unwrap_err().to_string();
        assert_eq!(error, "g.obj, line 2: '2' names no point; there are 1");
    }
}
