//! The grid of a box is its squares.

use glam::{DVec2, DVec3};

use super::*;
use crate::flow::complex::Located;
use crate::flow::complex::tests::box_complex;
use crate::flow::lines::trace;
use crate::flow::strips::{doubled_edges, strips};

#[test]
fn a_box_is_read_as_its_squares() {
    let grid = read(&box_complex(1)).unwrap();
    assert_eq!(grid.quads.len(), 2 * (80 + 60 + 48));
    assert_eq!(grid.n_vertices, grid.quads.len() + 2);
    let mut valence = vec![0; grid.n_vertices];
    for &v in grid.quads.iter().flatten() {
        valence[v as usize] += 1;
    }
    let three = (0..grid.n_vertices).filter(|&v| valence[v] == 3);
    assert_eq!(three.collect::<Vec<_>>(), (0..8).collect::<Vec<_>>());
    assert!(valence[8..].iter().all(|&n| n == 4));
    assert_eq!(doubled_edges(&grid.quads, grid.n_vertices), 0);
}

#[test]
fn flips_and_frames_do_not_change_the_grid() {
    let mut complex = box_complex(1);
    let mut n_flips = 0;
    for round in 0..4 {
        for h in complex.halfedge_ids() {
            complex.reframe(h.face(), (h.0 + round) as u8 % 4);
            if complex.is_flippable(h, 1e-6) {
                complex.flip(h);
                n_flips += 1;
            }
            let grid = read(&complex).unwrap();
            assert_eq!(grid.quads.len(), 376);
            assert_eq!(grid.n_vertices, 378);
            let [read, traced] = [
                strips(&grid.quads, grid.n_vertices).unwrap(),
                trace(&complex),
            ];
            assert_eq!(
                (read.n_strips, read.spiral),
                (traced.n_strips, traced.spiral)
            );
            assert!((read.loops - traced.loops).abs() < 1e-12);
        }
    }
    assert!(n_flips > 20);
}

#[test]
fn points_lie_where_their_weights_say() {
    let mut complex = box_complex(1);
    // The middle of a face, its corners, and a place on its side.
    let weights = [[0.2, 0.3, 0.5], [1.0, 0.0, 0.0], [0.0, 0.25, 0.75]];
    for face in 0..12 {
        for (i, weights) in weights.into_iter().enumerate() {
            complex.located.add(Located {
                vertex: VertexId(8 + 3 * face + i as u32),
                face: FaceId(face),
                weights,
            });
        }
    }
    let grid = read(&complex).unwrap();
    let positions = unfolded(&grid);
    let mesh = crate::flow::complex::tests::box_mesh(1);
    for face in 0..12 {
        let corners = mesh.triangle(FaceId(face));
        for (i, weights) in weights.into_iter().enumerate() {
            let Cell {
                quad,
                at: DVec2 { x: s, y: t },
            } = grid.cells[VertexId(8 + 3 * face + i as u32)];
            let [a, b, c, d] = grid.quads[quad as usize].map(|v| positions[v as usize]);
            let found = a.lerp(b, s).lerp(d.lerp(c, s), t);
            let point: DVec3 = (0..3).map(|k| corners[k] * weights[k]).sum();
            assert!(found.distance(point) < 1e-6, "{found} {point}");
        }
    }
}

/// Where the vertices of the box's grid are in space: from the corners along lines of the grid.
fn unfolded(grid: &Grid) -> Vec<DVec3> {
    let mesh = crate::flow::complex::tests::box_mesh(1);
    let mut positions: Vec<Option<DVec3>> = vec![None; grid.n_vertices];
    for v in mesh.vertex_ids() {
        positions[v.0 as usize] = Some(mesh.position(v));
    }
    // Least squares without factor: each free vertex moves to the mean of its neighbours within
    // its quads until nothing moves; on flat sides the rest is the unit grid.
    let mut neighbours = vec![Vec::new(); grid.n_vertices];
    for quad in &grid.quads {
        for i in 0..4 {
            neighbours[quad[i] as usize].push(quad[(i + 1) % 4] as usize);
        }
    }
    let mut known = positions.clone();
    let n_edges = trace_edges(&neighbours, &mut known);
    assert_eq!(n_edges, 12);
    let fixed: Vec<bool> = known.iter().map(Option::is_some).collect();
    let mut at: Vec<DVec3> = known
        .into_iter()
        .map(|p| p.unwrap_or(DVec3::ZERO))
        .collect();
    for _ in 0..2_000 {
        for v in (0..at.len()).filter(|&v| !fixed[v]) {
            let sum: DVec3 = neighbours[v].iter().map(|&u| at[u]).sum();
            at[v] = sum / neighbours[v].len() as f64;
        }
    }
    at
}

/// Puts the vertices on the box's edges in place; returns how many edges there are.
fn trace_edges(neighbours: &[Vec<usize>], known: &mut [Option<DVec3>]) -> usize {
    let mut n_edges = 0;
    for corner in 0..8 {
        for &first in &neighbours[corner] {
            let mut path = vec![corner, first];
            while path[path.len() - 1] >= 8 {
                let [before, here] = [path[path.len() - 2], path[path.len() - 1]];
                // The straight way on shares no neighbour but this one with where it came from.
                let shares = |u: &usize| {
                    neighbours[*u]
                        .iter()
                        .any(|w| *w != here && neighbours[before].contains(w))
                };
                let Some(next) = neighbours[here]
                    .iter()
                    .find(|u| **u != before && !shares(u))
                else {
                    break;
                };
                path.push(*next);
            }
            let last = path[path.len() - 1];
            if last < 8 && last > corner {
                let [a, b] = [corner, last].map(|v| known[v].unwrap());
                for (i, &v) in path.iter().enumerate() {
                    known[v] = Some(a.lerp(b, i as f64 / (path.len() - 1) as f64));
                }
                n_edges += 1;
            }
        }
    }
    n_edges
}
