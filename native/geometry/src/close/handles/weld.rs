//! Joins the borders that cuts have left, once they are borders of quads.

use thiserror::Error;

use crate::mesh::{Id, PolygonMesh, VertexId, VertexMap};

/// A mesh whose twins are joined.
#[derive(Clone, PartialEq, Debug)]
pub struct Welded {
    /// The mesh: the same faces over fewer vertices, those that are left in their order.
    pub mesh: PolygonMesh,
    /// What became of each vertex.
    pub vertices: VertexMap<VertexId>,
}

/// Why twins cannot be joined.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum WeldError {
    /// The two borders of a cut have different numbers of vertices.
    #[error("the borders of cut {cut} have {} and {} vertices", counts[0], counts[1])]
    Unequal {
        /// The first such cut.
        cut: usize,
        /// How many vertices its borders have.
        counts: [usize; 2],
    },
    /// A vertex would be joined twice.
    #[error("vertex {vertex} is passed twice by the borders of cuts")]
    Repeated {
        /// The first such vertex.
        vertex: VertexId,
    },
    /// The two borders of a cut do not run in opposite directions along their faces.
    #[error("the borders of cut {cut} do not fit: each needs faces on one side, not the same one")]
    Sides {
        /// The first such cut.
        cut: usize,
    },
}

/// Joins the two borders of each cut, given as closed chains that run beside each other: along one
/// the faces are on the left, along the other on the right.
///
/// One of the two is turned by as many vertices as brings the two nearest to each other; joined
/// vertices go to the middle between them. The square of a border's number of vertices in time.
///
/// # Errors
/// [`WeldError`]; nothing is joined then.
pub fn weld(mesh: &PolygonMesh, twins: &[[Vec<VertexId>; 2]]) -> Result<Welded, WeldError> {
    check(mesh, twins)?;
    let mut positions = mesh.positions().to_vec();
    let mut joined: VertexMap<VertexId> =
        (0..mesh.n_vertices()).map(VertexId::from_index).collect();
    for [kept, other] in twins {
        let shift = best_shift(mesh, kept, other);
        let other = other.iter().cycle().skip(shift);
        for (&v, &w) in kept.iter().zip(other) {
            positions[v.index()] = mesh.position(v).midpoint(mesh.position(w));
            joined[w] = v;
        }
    }
    let mut names = joined.clone();
    let mut left = Vec::with_capacity(positions.len());
    for v in joined.ids().filter(|&v| joined[v] == v) {
        names[v] = VertexId::from_index(left.len());
        left.push(positions[v.index()]);
    }
    let vertices: VertexMap<VertexId> = joined.iter().map(|&v| names[v]).collect();
    let corners = mesh.corners().iter().map(|&v| vertices[v]).collect();
    let mesh = PolygonMesh::new(left, mesh.starts().to_vec(), corners);
    Ok(Welded {
        mesh: mesh.expect("joined vertices are in range"),
        vertices,
    })
}

/// By how many vertices to turn the second of two chains of the same length.
fn best_shift(mesh: &PolygonMesh, kept: &[VertexId], other: &[VertexId]) -> usize {
    let n = kept.len();
    let gap = |shift: usize| -> f64 {
        let pairs = kept.iter().zip(other.iter().cycle().skip(shift));
        pairs
            .map(|(&v, &w)| mesh.position(v).distance_squared(mesh.position(w)))
            .sum()
    };
    let gaps: Vec<f64> = (0..n).map(gap).collect();
    (0..n)
        .min_by(|&a, &b| gaps[a].total_cmp(&gaps[b]))
        .unwrap_or(0)
}

fn check(mesh: &PolygonMesh, twins: &[[Vec<VertexId>; 2]]) -> Result<(), WeldError> {
    let mut is_passed = VertexMap::filled(mesh.n_vertices(), false);
    for (cut, chains) in twins.iter().enumerate() {
        let counts = chains.each_ref().map(Vec::len);
        if counts[0] != counts[1] {
            return Err(WeldError::Unequal { cut, counts });
        }
        for &vertex in chains.iter().flatten() {
            if std::mem::replace(&mut is_passed[vertex], true) {
                return Err(WeldError::Repeated { vertex });
            }
        }
    }
    let sides = Sides::new(mesh, &is_passed);
    for (cut, chains) in twins.iter().enumerate() {
        let [a, b] = chains.each_ref().map(|chain| sides.of(chain));
        if a.is_none() || b.is_none() || a == b {
            return Err(WeldError::Sides { cut });
        }
    }
    Ok(())
}

/// The sides of faces between some vertices.
struct Sides(Vec<[VertexId; 2]>);

impl Sides {
    fn new(mesh: &PolygonMesh, is_wanted: &VertexMap<bool>) -> Self {
        let mut sides = Vec::new();
        for face in mesh.faces() {
            let next = face.iter().cycle().skip(1);
            let ends = face.iter().zip(next).map(|(&a, &b)| [a, b]);
            sides.extend(ends.filter(|ends| ends.iter().all(|&v| is_wanted[v])));
        }
        sides.sort_unstable();
        Self(sides)
    }

    /// Whether the faces along a chain are on its left, or on its right; none if it is no border.
    fn of(&self, chain: &[VertexId]) -> Option<bool> {
        let has = |ends: [VertexId; 2]| self.0.binary_search(&ends).is_ok();
        let next = chain.iter().cycle().skip(1);
        let mut sides = chain
            .iter()
            .zip(next)
            .map(|(&a, &b)| [has([a, b]), has([b, a])]);
        let first = sides.next()?;
        let is_border = first[0] != first[1] && sides.all(|side| side == first);
        is_border.then_some(first[0])
    }
}
