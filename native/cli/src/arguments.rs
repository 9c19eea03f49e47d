//! What can be asked for on the command line.

use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{ArgAction, Args, CommandFactory, Parser, Subcommand, ValueEnum};
use orbflow_geometry::pipeline::{Kind, Mirror, Primitive, Settings, Style};
use orbflow_geometry::score;

use crate::formats::{FileFormat, READ, WRITTEN};
use crate::guides::Guides;
use crate::parsers::{degrees, format, kind, mirror, n_faces, on_off, primitive, share};
use crate::parts::OfParts;
use crate::place::Place;

const AFTER_HELP: &str = "\
Meshes are read as OBJ, PLY, STL, OFF, GLB or glTF and written as OBJ, PLY, OFF, GLB or glTF, by the
ending of the file name; import others (FBX, ...) in Blender, or convert them. '-' is standard input
or output; standard input is recognised by its first bytes unless --input-format is given, standard
output is OBJ unless --output-format is given. Files are written whole or not at all.

From GLB or glTF to either, all but the meshes stays as it is, and texture coordinates, colours, bones'
weights and morph targets are carried over; polygons become triangles there. OBJ keeps texture
coordinates and the names of materials.

Exit codes: 0 done, 2 wrong usage, 3 this input cannot be done (with --strict: not soundly), 130
cancelled by Ctrl-C.";

/// Rebuild meshes with a chosen face count and good edge flow, by deforming a sphere.
#[derive(Parser, Debug)]
#[command(name = "orbflow", version, after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

/// One verb of the core.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Rebuild a mesh with a chosen number of faces
    #[command(after_help = AFTER_HELP)]
    Remesh(Remesh),
    /// Rebuild a mesh from what the graph network proposes, or say that it is beyond repair
    #[command(after_help = AFTER_HELP)]
    Predict(Predict),
    /// Map every vertex of a mesh to the unit sphere
    #[command(after_help = AFTER_HELP)]
    Embed(Embed),
    /// Lower the number of triangles of a mesh and keep the rest of its vertices in place
    #[command(after_help = AFTER_HELP)]
    Decimate(Decimate),
    /// Measure the edge flow of a mesh and its distance to another
    #[command(after_help = AFTER_HELP)]
    Score(Score),
    /// Make a set of meshes and made shapes to train on, or go on where that was cut
    #[cfg(feature = "train")]
    Prepare(crate::prepare::Prepare),
    /// Train weights of the graph network, or go on where training was cut
    #[cfg(feature = "train")]
    Train(crate::train::Train),
    /// Draw the log of a run, as training did it, anew
    #[cfg(feature = "train")]
    Curve(crate::train::Curve),
    /// Measure what trained weights reach on shapes, seen in training and never seen
    #[cfg(feature = "train")]
    Evaluate(crate::evaluate::Evaluate),
}

#[derive(Args, Debug)]
pub struct Remesh {
    #[command(flatten)]
    pub files: Rebuilt,
    #[command(flatten)]
    pub wanted: Wanted,
    #[command(flatten)]
    pub run: Run,
    #[command(flatten)]
    pub work: Work,
}

#[derive(Args, Debug)]
pub struct Predict {
    #[command(flatten)]
    pub files: Rebuilt,
    #[command(flatten)]
    pub wanted: Wanted,
    /// The weights of the network, as `orbflow train` writes them [default: the program's own]
    #[arg(long, value_name = "FILE")]
    pub weights: Option<PathBuf>,
    #[command(flatten)]
    pub work: Work,
}

/// The mesh that comes in and all that goes out.
#[derive(Args, Debug)]
pub struct Rebuilt {
    #[command(flatten)]
    pub files: InAndOut,
    /// Write what is told of the run, as JSON
    #[arg(long, value_name = "R.json")]
    pub report: Option<Place>,
    /// Write the sphere that was deformed, vertex by vertex the same mesh as OUT
    #[arg(long, value_name = "SPHERE_OUT")]
    pub sphere: Option<Place>,
}

/// What is to be made.
#[derive(Args, Debug)]
pub struct Wanted {
    /// How many faces to make
    #[arg(long, value_name = "N", default_value_t = Settings::default().faces, value_parser = n_faces())]
    pub faces: usize,
    /// The polygons to make [default: quads, or what the primitive has]
    #[arg(long, value_parser = kind())]
    pub kind: Option<Kind>,
    /// The sphere to deform [default: adaptive for triangles, flow for quads]
    #[arg(long, value_parser = primitive())]
    pub primitive: Option<Primitive>,
    #[command(flatten)]
    pub flow: Flow,
    /// Edges sharper than this get edges of the result along them; 180 for none
    #[arg(long, value_name = "DEGREES", default_value_t = Settings::default().sharp_angle, value_parser = degrees)]
    pub sharp_angle: f64,
    /// Numbers from 0 to 1, one for each vertex of IN, as text: where they are 1, edges of flowing
    /// quads are half as long as where they are 0
    #[arg(long, value_name = "FILE")]
    pub density: Option<PathBuf>,
    #[command(flatten)]
    pub drawn: Guides,
    /// Numbers of faces of IN that are kept as they are, counted from 0 in the order of the file, as
    /// text: 12, or 12-40 for all from 12 to 40; the new faces join them without a gap, and --faces
    /// counts them too
    #[arg(long, value_name = "FILE")]
    pub keep: Option<PathBuf>,
    /// Make quads that are their own image across an axis, in the plane through the origin or the
    /// middle of the mesh; auto: across the first in which every vertex is another's image
    #[arg(long, default_value = "auto", value_parser = mirror())]
    pub mirror: Mirror,
    #[command(flatten)]
    pub parts: OfParts,
}

/// How quads flow.
#[derive(Args, Clone, Copy, Debug)]
pub struct Flow {
    /// How quads flow: 0 for smooth loops, 1 along the curvature wherever there is any
    #[arg(long, value_name = "SHARE", default_value_t = Style::default().follow_shape, value_parser = share)]
    pub follow_shape: f64,
    /// How much smaller quads are where the surface is bent: 0 for one size
    #[arg(long, value_name = "SHARE", default_value_t = Style::default().adaptivity, value_parser = share)]
    pub adaptivity: f64,
    /// Keep a part's own quads, cut into finer ones or without some strips of them, where good ones
    /// come of it; off: make new ones
    #[arg(long, value_name = "on|off", default_value = "on", action = ArgAction::Set, value_parser = on_off())]
    pub own_quads: bool,
}

#[derive(Args, Debug)]
pub struct Embed {
    #[command(flatten)]
    pub input: In,
    /// Write what is told of the run, as JSON
    #[arg(long, value_name = "R.json")]
    pub report: Place,
    #[command(flatten)]
    pub run: Run,
    #[command(flatten)]
    pub threads: Threads,
    /// Write the triangles of IN with their vertices on the unit sphere
    #[arg(long, value_name = "OUT")]
    pub sphere: Option<Place>,
    /// The format of the sphere, whatever the name ends in
    #[arg(long, value_name = "FORMAT", value_parser = format(WRITTEN))]
    pub output_format: Option<FileFormat>,
}

#[derive(Args, Debug)]
pub struct Decimate {
    #[command(flatten)]
    pub files: InAndOut,
    /// How many triangles to leave
    #[arg(long, value_name = "N", value_parser = n_faces())]
    pub faces: usize,
}

#[derive(Args, Debug)]
pub struct Score {
    /// The mesh that was to be rebuilt
    #[arg(value_name = "IN")]
    pub input: Place,
    /// The mesh to measure
    #[arg(value_name = "OUT")]
    pub output: Place,
    /// The format of both, whatever the names end in
    #[arg(long, value_name = "FORMAT", value_parser = format(READ))]
    pub input_format: Option<FileFormat>,
    /// Write the figures as JSON instead of printing them
    #[arg(long, value_name = "R.json")]
    pub report: Option<Place>,
}

/// The mesh that comes in.
#[derive(Args, Debug)]
pub struct In {
    /// The mesh to read
    #[arg(value_name = "IN")]
    pub input: Place,
    /// The format of IN, whatever its name ends in
    #[arg(long, value_name = "FORMAT", value_parser = format(READ))]
    pub input_format: Option<FileFormat>,
}

/// The mesh that comes in and the one that goes out.
#[derive(Args, Debug)]
pub struct InAndOut {
    #[command(flatten)]
    pub input: In,
    /// The mesh to write
    #[arg(value_name = "OUT")]
    pub output: Place,
    /// The format of what is written, whatever the name ends in
    #[arg(long, value_name = "FORMAT", value_parser = format(WRITTEN))]
    pub output_format: Option<FileFormat>,
}

/// How the embedding is run.
#[derive(Args, Debug)]
pub struct Run {
    /// What proposes the map to the sphere
    #[arg(long, value_enum, default_value_t = Predictor::Auto)]
    pub predictor: Predictor,
    /// The weights of the network, as `orbflow train` writes them [default: the program's own]
    #[arg(long, value_name = "FILE")]
    pub weights: Option<PathBuf>,
}

/// What does not change the kind of work.
#[derive(Args, Clone, Copy, Debug)]
pub struct Work {
    #[command(flatten)]
    pub threads: Threads,
    /// Where random choices start; equal seeds give equal bytes
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
}

/// How many threads do the work.
#[derive(Args, Clone, Copy, Debug)]
pub struct Threads {
    /// How many threads to use, 0 for all; the result is the same
    #[arg(long = "threads", value_name = "T", default_value_t = 0)]
    pub n: usize,
}

/// The predictors by name.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Predictor {
    /// The network where a part has 20,000 vertices on its map or more, else the solver
    Auto,
    /// Progressive embedding; needs no training
    Solver,
    /// A graph network for the coarse levels; the solver grows the rest
    Network,
}

impl Wanted {
    /// What the core is asked for.
    pub fn settings(&self, work: Work, files: &Rebuilt) -> Settings {
        self.parts.asked(&Settings {
            faces: self.faces,
            kind: self.kind(),
            primitive: self.primitive,
            style: Style {
                follow_shape: self.flow.follow_shape,
                adaptivity: self.flow.adaptivity,
            },
            own_quads: self.flow.own_quads,
            sharp_angle: self.sharp_angle,
            mirror: self.mirror,
            seed: work.seed,
            threads: work.threads.n,
            score: files.report.as_ref().map(|_| score::Settings::default()),
            ..Settings::default()
        })
    }

    fn kind(&self) -> Kind {
        let of_primitive = self.primitive.map(Primitive::kind);
        self.kind.or(of_primitive).unwrap_or_default()
    }
}

impl Rebuilt {
    /// Where meshes go, where the report goes, and in which format meshes are asked for.
    fn outputs(&self) -> ([Option<&Place>; 2], Option<&Place>, Option<FileFormat>) {
        let meshes = [Some(&self.files.output), self.sphere.as_ref()];
        (meshes, self.report.as_ref(), self.files.output_format)
    }
}

impl Arguments {
    /// Checks what the parser cannot: arguments that do not go together.
    pub fn check(&self) -> Result<(), clap::Error> {
        let (meshes, reports, wanted) = match &self.command {
            Command::Remesh(a) => {
                check_primitive(&a.wanted)?;
                check_weights(&a.run)?;
                a.files.outputs()
            }
            Command::Predict(a) => {
                check_primitive(&a.wanted)?;
                a.files.outputs()
            }
            Command::Embed(a) => {
                check_weights(&a.run)?;
                ([a.sphere.as_ref(), None], Some(&a.report), a.output_format)
            }
            Command::Decimate(a) => {
                let meshes = [Some(&a.files.output), None];
                (meshes, None, a.files.output_format)
            }
            Command::Score(a) => {
                check_different(
                    "read",
                    [&a.input, &a.output]
                        .into_iter()
                        .filter(|p| **p == Place::Standard),
                )?;
                ([None, None], a.report.as_ref(), None)
            }
            #[cfg(feature = "train")]
            Command::Prepare(a) => ([None, None], a.manifest.as_ref(), None),
            #[cfg(feature = "train")]
            Command::Train(_) | Command::Curve(_) => ([None, None], None, None),
            #[cfg(feature = "train")]
            Command::Evaluate(a) => ([None, None], Some(&a.report), None),
        };
        for mesh in meshes.into_iter().flatten() {
            if FileFormat::of_output(mesh, wanted).is_none() {
                return Err(wrong(format!(
                    "cannot tell the format of {mesh}: its name must end in .obj, .ply, .off, .glb \
                     or .gltf, or --output-format be given"
                )));
            }
        }
        check_different("written", meshes.into_iter().flatten().chain(reports))
    }
}

fn check_primitive(wanted: &Wanted) -> Result<(), clap::Error> {
    match wanted.primitive {
        Some(primitive) if primitive.kind() != wanted.kind() => Err(wrong(format!(
            "the primitive {} has {}, but --kind asks for {}",
            primitive.name(),
            primitive.kind().name(),
            wanted.kind().name()
        ))),
        _ => Ok(()),
    }
}

fn check_weights(run: &Run) -> Result<(), clap::Error> {
    match (run.predictor, &run.weights) {
        (Predictor::Solver, Some(_)) => {
            Err(wrong("--weights is not for --predictor solver".into()))
        }
        _ => Ok(()),
    }
}

fn check_different<'a>(
    verb: &str,
    places: impl Iterator<Item = &'a Place>,
) -> Result<(), clap::Error> {
    let mut seen: Vec<Place> = Vec::new();
    for place in places {
        let resolved = place.resolved();
        if seen.contains(&resolved) {
            return Err(wrong(format!("{place} would be {verb} twice")));
        }
        seen.push(resolved);
    }
    Ok(())
}

fn wrong(message: String) -> clap::Error {
    Arguments::command().error(ErrorKind::ArgumentConflict, message)
}
