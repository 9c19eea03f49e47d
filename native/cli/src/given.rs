//! A mesh as it comes in, with what the artist left on it, and the way of that onto what is made of it.

use orbflow_geometry::mesh::io::{Format, MeshFile};
use orbflow_geometry::mesh::{Id, PolygonMesh, VertexId};
use orbflow_geometry::pipeline::{Origin, Origins};
use orbflow_geometry::transfer::Seams;
use orbflow_gltf::{Cuts, Made, Scene, Written};

use crate::error::Error;
use crate::formats::FileFormat;
use crate::outputs::Outputs;
use crate::place::Place;

/// Texture coordinates of one place that differ by more are on two sides of a seam.
const APART: f64 = 1e-5;

/// A mesh as it comes in.
#[derive(Debug)]
pub struct Given {
    /// Its polygons, materials and texture coordinates.
    pub file: MeshFile,
    /// The scene that it is, if it is one.
    scene: Option<Scene>,
}

/// What goes onto the result beside materials, and where it is cut.
pub enum Carried {
    /// All that lies on a scene.
    Scene(Cuts),
    /// Texture coordinates; one set.
    Coordinates([Vec<[VertexId; 2]>; 1]),
    /// Nothing.
    Nothing,
}

/// A mesh that was made.
pub struct Remade {
    pub mesh: PolygonMesh,
    pub materials: Option<Vec<i32>>,
    pub origins: Option<Origins>,
}

impl From<MeshFile> for Given {
    fn from(file: MeshFile) -> Self {
        Self { file, scene: None }
    }
}

impl From<Scene> for Given {
    fn from(scene: Scene) -> Self {
        Self {
            file: scene.plain(),
            scene: Some(scene),
        }
    }
}

impl Given {
    /// The material of each face, where it has any.
    pub fn materials(&self) -> Option<&[i32]> {
        Some(self.file.materials.as_slice()).filter(|materials| !materials.is_empty())
    }

    /// What a file of this format can take; borders are welded within this share of the diagonal.
    pub fn carried(&self, format: FileFormat, weld: Option<f64>) -> Carried {
        match (format, &self.scene) {
            (FileFormat::Scene(_), Some(scene)) => Carried::Scene(scene.cuts(weld)),
            (FileFormat::Scene(_) | FileFormat::Mesh(Format::Obj), _)
                if !self.file.coordinates.is_empty() =>
            {
                let seams = Seams::new(&self.file.mesh, weld);
                let faces = faces_of_corners(&self.file.mesh);
                Carried::Coordinates([seams.cuts(|a, b| self.is_cut(&faces, [a, b]))])
            }
            _ => Carried::Nothing,
        }
    }

    /// Says on standard error what of a scene is not taken over.
    pub fn tell(&self, place: &Place) {
        for note in self.scene.iter().flat_map(Scene::notes) {
            eprintln!("{place}: {note}");
        }
    }

    /// Writes what was made to where it waits, with all that is carried; returns it as a plain mesh.
    pub fn write(
        &self,
        made: Remade,
        carried: &Carried,
        (place, format): (&Place, FileFormat),
        outputs: &mut Outputs,
    ) -> Result<MeshFile, Error> {
        if let FileFormat::Scene(_) = format {
            tell_cut(place, &made.mesh);
        }
        let scene = self.scene.as_ref();
        if let (Some(scene), Carried::Scene(cuts), FileFormat::Scene(container), Some(origins)) =
            (scene, carried, format, &made.origins)
        {
            let mesh = &made.mesh;
            let written = scene.written(Made { mesh, origins }, cuts, container);
            let Written { bytes, notes } = written.map_err(|cause| Error::Scene {
                place: place.clone(),
                cause,
            })?;
            for note in notes {
                eprintln!("{place}: {note}");
            }
            outputs.write_bytes(place, &bytes)?;
            return Ok(self.file(made, carried));
        }
        let file = self.file(made, carried);
        outputs.write_mesh(place, &file, format)?;
        Ok(file)
    }

    /// What was made, with names and texture coordinates.
    fn file(&self, made: Remade, carried: &Carried) -> MeshFile {
        let mut file = MeshFile {
            mesh: made.mesh,
            materials: made.materials.unwrap_or_default(),
            material_names: self.file.material_names.clone(),
            material_libraries: self.file.material_libraries.clone(),
            coordinates: Vec::new(),
        };
        if let (Carried::Coordinates(_), Some(origins)) = (carried, &made.origins) {
            let of_corners = origins.corners[0].iter();
            let coordinates = of_corners.map(|origin| self.coordinate(origin));
            file.coordinates = coordinates.collect();
            if let Some(materials) = self.materials() {
                // As the coordinates, from one side of a border between materials.
                let from = origins.faces.iter().map(|face| materials[face.index()]);
                file.materials = from.collect();
            }
        }
        file
    }

    fn coordinate(&self, origin: &Origin) -> Option<[f64; 2]> {
        let mut sum = [0.0; 2];
        let parts = origin.corners.iter().zip(origin.weights);
        for (&corner, share) in parts.filter(|&(_, share)| share > 0.0) {
            let [u, v] = self.file.coordinates[corner as usize]?;
            sum[0] += share * u;
            sum[1] += share * v;
        }
        Some(sum)
    }

    /// Whether two corners at one place are on two sides of a seam or of a border between materials.
    fn is_cut(&self, faces: &[u32], corners: [usize; 2]) -> bool {
        if let Some(materials) = self.materials() {
            let [a, b] = corners.map(|corner| materials[faces[corner] as usize]);
            if a != b {
                return true;
            }
        }
        match corners.map(|corner| self.file.coordinates[corner]) {
            [Some(a), Some(b)] => a.iter().zip(b).any(|(a, b)| (a - b).abs() > APART),
            [a, b] => a.is_some() != b.is_some(),
        }
    }
}

impl Carried {
    /// Where it is cut, for the core.
    pub fn cuts(&self) -> Option<&[Vec<[VertexId; 2]>]> {
        match self {
            Self::Scene(cuts) => Some(&cuts.sets),
            Self::Coordinates(cuts) => Some(cuts),
            Self::Nothing => None,
        }
    }
}

/// The face of every corner.
fn faces_of_corners(mesh: &PolygonMesh) -> Vec<u32> {
    let faces = mesh.faces().enumerate();
    faces
        .flat_map(|(i, face)| std::iter::repeat_n(i as u32, face.len()))
        .collect()
}

/// Says on standard error that a scene has triangles alone.
fn tell_cut(place: &Place, mesh: &PolygonMesh) {
    let n = mesh.faces().filter(|face| face.len() > 3).count();
    if n > 0 {
        eprintln!(
            "{place}: {n} polygons are cut into triangles, as glTF has no others; OBJ and PLY keep them"
        );
    }
}
