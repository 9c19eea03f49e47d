//! Strokes that are each other's images in a plane.

use glam::DVec3;

use crate::guidance::Stroke;
use crate::measure::Polyline;
use crate::mirror::mirrored;

/// A point nearer to the plane than this share of an edge lies in it.
const IN_PLANE: f64 = 1e-3;
/// A stroke whose image is nearer to another than so many edges, in the mean, is the same stroke.
const SAME: f64 = 1.5;

/// A piece of a stroke on one side of the plane.
struct Piece {
    stroke: Stroke,
    is_positive: bool,
    /// Whether its stroke has a piece on the positive side.
    has_positive: bool,
    /// Whether it begins and ends in the plane.
    in_plane: [bool; 2],
}

/// What lies on the positive side of the plane where a coordinate is 0, strokes of the other side that
/// are the image of nothing there, and the images of both.
pub fn both(strokes: &[Stroke], axis: usize, edge: f64) -> Vec<Stroke> {
    let pieces = strokes
        .iter()
        .flat_map(|stroke| cut(stroke, axis, IN_PLANE * edge));
    let (mut own, others): (Vec<Piece>, Vec<Piece>) = pieces.partition(|piece| piece.is_positive);
    let others = others.into_iter().map(|piece| Piece {
        stroke: image(&piece.stroke, axis),
        ..piece
    });
    let lines: Vec<Polyline> = own.iter().map(|piece| line(&piece.stroke)).collect();
    let is_new = |piece: &Piece| {
        let points = piece.stroke.spaced(edge);
        let off = |line: &Polyline| {
            let sum: f64 = points.iter().map(|&p| line.distance(p)).sum();
            sum / points.len() as f64
        };
        lines.iter().all(|line| off(line) > SAME * edge)
    };
    own.extend(others.filter(|piece| !piece.has_positive && is_new(piece)));
    own.into_iter()
        .flat_map(|piece| whole(piece, axis))
        .collect()
}

fn line(stroke: &Stroke) -> Polyline {
    Polyline::new(stroke.round().collect(), stroke.is_closed)
}

fn image(stroke: &Stroke, axis: usize) -> Stroke {
    Stroke {
        points: stroke.points.iter().map(|&p| mirrored(p, axis)).collect(),
        ..*stroke
    }
}

/// A piece and its image, as one stroke where they meet.
fn whole(piece: Piece, axis: usize) -> Vec<Stroke> {
    let Piece {
        stroke, in_plane, ..
    } = piece;
    let other = image(&stroke, axis);
    if in_plane == [false, false] {
        return vec![stroke, other];
    }
    let mut points = stroke.points;
    let mut back = other.points;
    if in_plane == [true, false] {
        points.reverse();
    }
    if in_plane != [true, false] {
        back.reverse();
    }
    // They share the point where they meet.
    points.extend(back.into_iter().skip(1));
    if in_plane == [true, true] {
        points.pop();
    }
    vec![Stroke {
        points,
        is_closed: in_plane == [true, true],
        strength: stroke.strength,
    }]
}

/// A stroke cut where it meets the plane.
fn cut(stroke: &Stroke, axis: usize, near: f64) -> Vec<Piece> {
    let mut points = crossed(stroke, axis, near);
    let is_in = |p: &DVec3| p[axis] == 0.0;
    let first = points.iter().position(is_in);
    let Some(first) = first else {
        let is_positive = points[0][axis] > 0.0;
        return vec![Piece {
            stroke: stroke.clone(),
            is_positive,
            has_positive: is_positive,
            in_plane: [false, false],
        }];
    };
    if stroke.is_closed {
        points.pop();
        points.rotate_left(first);
        points.push(points[0]);
    }
    let mut pieces = Vec::new();
    let mut from = 0;
    for to in 1..points.len() {
        if !is_in(&points[to]) && to + 1 < points.len() {
            continue;
        }
        let piece = &points[from..=to];
        // What runs in the plane is a line of edges there anyhow.
        if let Some(beside) = piece.iter().find(|p| !is_in(p)) {
            pieces.push(Piece {
                is_positive: beside[axis] > 0.0,
                has_positive: points.iter().any(|p| p[axis] > 0.0),
                in_plane: [is_in(&piece[0]), is_in(&piece[piece.len() - 1])],
                stroke: Stroke {
                    points: piece.to_vec(),
                    is_closed: false,
                    strength: stroke.strength,
                },
            });
        }
        from = to;
    }
    pieces
}

/// Its points, with one wherever it crosses the plane; those near to the plane in it.
fn crossed(stroke: &Stroke, axis: usize, near: f64) -> Vec<DVec3> {
    let snapped = |mut p: DVec3| {
        if p[axis].abs() < near {
            p[axis] = 0.0;
        }
        p
    };
    let mut points: Vec<DVec3> = Vec::new();
    for p in stroke.round().map(snapped) {
        if let Some(&last) = points.last()
            && last[axis] * p[axis] < 0.0
        {
            let mut between = last.lerp(p, last[axis] / (last[axis] - p[axis]));
            between[axis] = 0.0;
            points.push(between);
        }
        points.push(p);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::sin_cos;
    use crate::guidance::Strength;

    fn ring(centre: DVec3) -> Stroke {
        let point = |i: usize| {
            let (sin, cos) = sin_cos(std::f64::consts::TAU * i as f64 / 20.0);
            centre + DVec3::new(cos, sin, 0.0)
        };
        Stroke {
            points: (0..20).map(point).collect(),
            is_closed: true,
            strength: Strength::Exact,
        }
    }

    #[test]
    fn a_ring_beside_the_plane_gets_its_image_and_two_images_stay_two() {
        for centres in [vec![3.0], vec![-3.0], vec![3.0, -3.05]] {
            let strokes = centres.iter().map(|&x| ring(DVec3::X * x));
            let both = both(&strokes.collect::<Vec<_>>(), 0, 0.2);
            assert_eq!(both.len(), 2, "{centres:?}");
            assert!(both.iter().all(|stroke| stroke.is_closed));
            assert_eq!(both[1], image(&both[0], 0));
        }
    }

    #[test]
    fn a_ring_across_the_plane_becomes_its_own_image_from_the_positive_side() {
        let found = both(&[ring(DVec3::X * 0.3)], 0, 0.2);
        assert_eq!(found.len(), 1);
        let ring = &found[0];
        assert!(ring.is_closed);
        let farthest = |sign: f64| ring.points.iter().map(|p| sign * p.x).fold(0.0, f64::max);
        assert!((farthest(1.0) - 1.3).abs() < 1e-9 && (farthest(-1.0) - 1.3).abs() < 1e-9);
        let n_in = ring.points.iter().filter(|p| p.x == 0.0).count();
        assert_eq!(n_in, 2);
    }

    #[test]
    fn an_open_stroke_across_the_plane_stays_one_stroke() {
        let stroke = Stroke {
            points: vec![DVec3::new(-1.0, 0.0, 0.0), DVec3::new(2.0, 3.0, 0.0)],
            is_closed: false,
            strength: Strength::Follow,
        };
        let found = both(&[stroke], 0, 0.2);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].points.len(), 3);
        let across: Vec<f64> = found[0].points.iter().map(|p| p.x.abs()).collect();
        assert_eq!(across, [2.0, 0.0, 2.0]);
    }
}
