//! Faces whose edges get a vertex on them.

use crate::mesh::VertexId;

/// Both ends of an edge, the smaller first.
pub fn key(a: VertexId, b: VertexId) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

/// A face cut at vertices on its edges, each on the edge from a corner to the next.
pub fn pieces(corners: [VertexId; 3], between: [Option<VertexId>; 3]) -> Vec<[VertexId; 3]> {
    let [a, b, c] = corners;
    if let [Some(ab), Some(bc), Some(ca)] = between {
        return vec![[ab, bc, ca], [a, ab, ca], [b, bc, ab], [c, ca, bc]];
    }
    // From the first new vertex on: what follows it lies across the face.
    let is_first = |k: &usize| between[*k].is_some() && between[(k + 2) % 3].is_none();
    let Some(k) = (0..3).find(is_first) else {
        return vec![corners];
    };
    let around = (k..k + 3).flat_map(|k| [Some(corners[k % 3]), between[k % 3]]);
    let mut polygon: Vec<VertexId> = around.flatten().collect();
    polygon.rotate_left(1);
    let fan = polygon[1..].windows(2);
    fan.map(|pair| [polygon[0], pair[0], pair[1]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_have_the_corners_and_the_sides_of_the_face() {
        let corners = [0, 1, 2].map(VertexId);
        for cut in 0_u32..8 {
            let between = [0, 1, 2].map(|k| (cut >> k & 1 == 1).then_some(VertexId(3 + k)));
            let found = pieces(corners, between);
            assert_eq!(found.len(), 1 + cut.count_ones() as usize);
            let mut sides = Vec::new();
            for face in &found {
                sides.extend((0..3).map(|k| [face[k], face[(k + 1) % 3]]));
            }
            let is_outer = |&&[a, b]: &&[VertexId; 2]| !sides.contains(&[b, a]);
            let mut outer: Vec<_> = sides.iter().filter(is_outer).copied().collect();
            let mut wanted = Vec::new();
            for k in 0..3 {
                let [a, b] = [corners[k], corners[(k + 1) % 3]];
                match between[k] {
                    Some(middle) => wanted.extend([[a, middle], [middle, b]]),
                    None => wanted.push([a, b]),
                }
            }
            outer.sort_unstable();
            wanted.sort_unstable();
            assert_eq!(outer, wanted, "{cut}");
        }
    }
}
