//! Polygons over welded vertices: repeated corners, degenerate and duplicate polygons.

use super::Report;
use crate::mesh::{FaceId, PolygonMesh, VertexId};

/// Polygons without equal neighbouring corners, and the input face of each.
#[derive(Default)]
pub(super) struct Polygons {
    ends: Vec<u32>,
    corners: Vec<VertexId>,
    source: Vec<FaceId>,
}

impl Polygons {
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn corners(&self) -> &[VertexId] {
        &self.corners
    }

    pub(super) fn polygon(&self, i: usize) -> &[VertexId] {
        let start = i.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.corners[start as usize..self.ends[i] as usize]
    }

    pub(super) fn source(&self, i: usize) -> FaceId {
        self.source[i]
    }

    /// Drops polygons that came before with the same corners in the same direction; how many?
    pub(super) fn drop_repeated(&mut self) -> usize {
        let repeated = repeated(self);
        if !repeated.is_empty() {
            let mut kept = Self::default();
            for i in (0..self.len()).filter(|i| repeated.binary_search(i).is_err()) {
                kept.push(self.polygon(i), self.source(i));
            }
            *self = kept;
        }
        repeated.len()
    }

    fn push(&mut self, polygon: &[VertexId], source: FaceId) {
        self.corners.extend_from_slice(polygon);
        self.ends.push(self.corners.len() as u32);
        self.source.push(source);
    }
}

/// Drops corners that repeat, and polygons of which fewer than three corners are left.
///
/// `name` says what a vertex is called in a face.
pub(super) fn simplify(
    input: &PolygonMesh,
    name: impl Fn(FaceId, VertexId) -> VertexId,
    report: &mut Report,
) -> Polygons {
    let mut polygons = Polygons::default();
    [report.n_degenerate, report.n_shortened] = [0; 2];
    let mut corners = Vec::new();
    for face in input.face_ids() {
        let welded = input.face(face).iter().map(|&v| name(face, v));
        drop_spikes(welded, &mut corners);
        if corners.len() < 3 {
            report.n_degenerate += 1;
        } else {
            report.n_shortened += usize::from(corners.len() < input.face(face).len());
            polygons.push(&corners, face);
        }
    }
    polygons
}

/// Takes out a corner that equals the one before it, and one whose two neighbours are equal: both
/// enclose nothing, and the polygon's sides there cancel.
fn drop_spikes(polygon: impl Iterator<Item = VertexId>, out: &mut Vec<VertexId>) {
    out.clear();
    for vertex in polygon {
        out.push(vertex);
        loop {
            let n = out.len();
            if n >= 2 && out[n - 1] == out[n - 2] {
                out.pop();
            } else if n >= 3 && out[n - 1] == out[n - 3] {
                out.truncate(n - 2);
            } else {
                break;
            }
        }
    }
    // The same across the ends.
    let (mut start, mut end) = (0, out.len());
    while end - start >= 2 {
        if out[start] == out[end - 1] {
            end -= 1;
        } else if end - start >= 3 && out[start] == out[end - 2] {
            end -= 2;
        } else if end - start >= 3 && out[start + 1] == out[end - 1] {
            start += 1;
            end -= 1;
        } else {
            break;
        }
    }
    out.truncate(end);
    out.drain(..start);
}

/// The polygons, in order, that have the same corners in the same direction as one before.
fn repeated(polygons: &Polygons) -> Vec<usize> {
    let smallest = |i: usize| {
        let polygon = polygons.polygon(i);
        let corners = 0..polygon.len();
        corners.min_by_key(|&k| polygon[k]).unwrap_or(0)
    };
    // The smallest corner and the one after it; two polygons with the same are rare already.
    let mut order: Vec<(u64, u32)> = (0..polygons.len())
        .map(|i| {
            let (polygon, k) = (polygons.polygon(i), smallest(i));
            let next = polygon[(k + 1) % polygon.len()];
            (u64::from(polygon[k].0) << 32 | u64::from(next.0), i as u32)
        })
        .collect();
    order.sort_unstable();
    let turned = |i: u32| {
        let (polygon, k) = (polygons.polygon(i as usize), smallest(i as usize));
        polygon[k..].iter().chain(&polygon[..k])
    };
    let mut repeated = Vec::new();
    for run in order.chunk_by_mut(|x, y| x.0 == y.0) {
        if run.len() > 1 {
            run.sort_by(|x, y| turned(x.1).cmp(turned(y.1)));
            let pairs = run.windows(2).filter(|w| turned(w[0].1).eq(turned(w[1].1)));
            repeated.extend(pairs.map(|w| w[1].1 as usize));
        }
    }
    repeated.sort_unstable();
    repeated
}

#[cfg(test)]
mod tests {
    use super::*;

    fn without_spikes(polygon: &[u32]) -> Vec<u32> {
        let mut out = Vec::new();
        drop_spikes(polygon.iter().map(|&v| VertexId(v)), &mut out);
        out.into_iter().map(|v| v.0).collect()
    }

    #[test]
    fn repeated_corners_and_spikes_go() {
        assert_eq!(without_spikes(&[0, 1, 2, 3]), [0, 1, 2, 3]);
        assert_eq!(without_spikes(&[0, 0, 1, 1, 2, 0]), [0, 1, 2]);
        assert_eq!(without_spikes(&[0, 1, 2, 1, 3]), [0, 1, 3]);
        assert_eq!(without_spikes(&[0, 2, 3, 4, 2]), [2, 3, 4]);
        assert_eq!(without_spikes(&[1, 2, 3, 4, 2, 0]).len(), 6);
        for line in [&[0, 0, 1][..], &[2, 2, 2], &[0, 1, 0, 2], &[0, 1, 2, 1]] {
            assert!(without_spikes(line).len() < 3, "{line:?}");
        }
    }

    #[test]
    fn a_polygon_is_repeated_if_it_turns_the_same_way() {
        let mut polygons = Polygons::default();
        for (i, polygon) in [[0, 1, 2], [2, 0, 1], [0, 2, 1], [0, 1, 3], [1, 2, 0]]
            .iter()
            .enumerate()
        {
            polygons.push(&polygon.map(VertexId), FaceId(i as u32));
        }
        assert_eq!(repeated(&polygons), [1, 4]);
    }
}
