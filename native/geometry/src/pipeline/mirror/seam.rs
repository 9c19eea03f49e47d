//! Half of a part, and the seam where it is to be joined to its image.
//!
//! ```text
//!   whole            half         seam ┃, borders ─
//!  ╭──────╮          ┃───╮
//!  │      │    ─▶    ┃   │
//!  ╰──────╯          ┃───╯
//! ```
//!
//! A part with borders or handles is its own image for certain, whatever its shape, if faces are made
//! on one half of it alone, and their image is joined to them.

use glam::DVec3;

use super::Plane;
use crate::mesh::{HalfedgeId, TriangleMesh};
use crate::mirror::{self, Half};
use crate::pipeline::density::Density;
use crate::pipeline::marks::Marks;
use crate::pipeline::open::Whole;

/// Vertices nearer to the plane than this share of an edge across it are moved onto it.
const SNAP: f64 = 0.02;

/// Where a half goes on beyond the plane.
#[derive(Clone, Debug)]
pub struct Seam {
    /// The axis across the plane.
    pub axis: usize,
    /// Its edges.
    pub edges: Vec<[DVec3; 2]>,
    /// The other edges of the half's borders.
    pub borders: Vec<[DVec3; 2]>,
    /// Where it ends at these.
    pub ends: Vec<DVec3>,
    /// How many borders the whole has, and its Euler number.
    pub whole: (usize, i64),
}

/// Half of a part, with what lies on it.
pub struct Halved {
    pub half: Whole,
    pub density: Density,
}

/// The half of a part on the positive side of a plane through the origin, or why there is none.
pub fn halved(
    whole: &Whole,
    plane: Plane,
    (marks, density): (&Marks, &Density),
) -> Result<Halved, String> {
    let mesh = &whole.mesh;
    let half = mirror::half(mesh, plane.axis, SNAP).map_err(|error| error.to_string())?;
    let seam = Seam::new(&half, plane.axis);
    let (n_borders, euler) = seam.whole;
    let shape = &whole.shape;
    let was = 2 - 2 * shape.genus.unwrap_or(0) - shape.n_borders as i64;
    if plane.was_symmetric && (n_borders, euler) != (shape.n_borders, was) {
        return Err(format!(
            "its half and that half's image have {n_borders} borders and the Euler number {euler}, \
             it has {} and {was}",
            shape.n_borders
        ));
    }
    let marked = [marks, &whole.pieces].map(|marks| marks.on(mesh));
    let marked = marked[0].iter().zip(&marked[1]).map(|(a, b)| *a || *b);
    let marked = half.carried(mesh, &marked.collect());
    let on = half.mesh.halfedge_ids().filter(|&h| marked[h]);
    let pieces = Marks::at(on.map(|h| ends(&half.mesh, h)));
    let values = density.on(mesh);
    let values = values.map(|values| half.carried_values(mesh, &values));
    let density = match values {
        Some(values) => Density::at(
            half.mesh
                .positions()
                .iter()
                .copied()
                .zip(values.iter().copied()),
        ),
        None => Density::default(),
    };
    Ok(Halved {
        half: whole.halved(half.mesh, (pieces, seam)),
        density,
    })
}

fn ends(mesh: &TriangleMesh, h: HalfedgeId) -> [DVec3; 2] {
    [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v))
}

impl Seam {
    fn new(half: &Half, axis: usize) -> Self {
        let mesh = &half.mesh;
        let (mut edges, mut borders, mut at_ends) = (Vec::new(), Vec::new(), Vec::new());
        let (mut n_borders, mut n_arcs) = (0, 0);
        for border in mesh.border_loops() {
            let n = border.len();
            let mut n_turns = 0;
            for (i, &h) in border.iter().enumerate() {
                let [own, next] = [h, border[(i + 1) % n]].map(|h| half.is_seam[h]);
                let list = if own { &mut edges } else { &mut borders };
                list.push(ends(mesh, h));
                if own != next {
                    n_turns += 1;
                    at_ends.push(mesh.position(mesh.target(h)));
                }
            }
            // A line between two ends is a border with its image; a loop has an image beside it.
            n_borders += match (n_turns, half.is_seam[border[0]]) {
                (0, true) => 0,
                (0, false) => 2,
                _ => n_turns / 2,
            };
            n_arcs += n_turns / 2;
        }
        Self {
            axis,
            edges,
            borders,
            ends: at_ends,
            whole: (n_borders, 2 * mesh.euler_number() - n_arcs as i64),
        }
    }

    /// The length of the shortest border of a half in which it has a part; infinite where there is none.
    pub fn shortest_loop(&self, mesh: &TriangleMesh) -> f64 {
        let is_seam = Marks::at(self.edges.iter().copied()).on(mesh);
        let length = |border: &Vec<HalfedgeId>| -> f64 {
            let edges = border.iter().map(|&h| ends(mesh, h));
            edges.map(|[a, b]| a.distance(b)).sum()
        };
        let loops = mesh.border_loops();
        let own = loops
            .iter()
            .filter(|border| border.iter().any(|&h| is_seam[h]));
        own.map(length).fold(f64::INFINITY, f64::min)
    }
}
