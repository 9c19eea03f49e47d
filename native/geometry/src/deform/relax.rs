//! Evening out: vertices slide along the surface until faces are near to regular and of one size.

use glam::DVec3;

use super::Sizes;
use super::cover::Cover;
use super::sheet::{Face, Sheet};
use crate::mesh::{FaceId, VertexId};
use crate::progress::{Cancelled, Progress};

/// Quality that no move may spoil: below it a move must make the worst face at the vertex better.
/// At 0.2 slivers survive; at 0.5 vertices get stuck where the surface bends.
const GUARDED_QUALITY: f64 = 0.35;
/// Share of the wanted size in a face's wish; the rest is the size it has. At 1 faces on stretched
/// limbs push each other into slivers, at 0.5 sizes even out too slowly.
const SIZE_WISH: f64 = 0.8;
/// Moves every vertex that is not pinned `n_rounds` times to where its faces would be regular polygons of equal size.
///
/// Each face pulls its corners towards the regular polygon of its own centre and turn (shape
/// matching, Müller et al. 2005); a vertex goes to the mean of its faces' wishes, along the surface.
/// Moves that fold the sphere or spoil a face are halved once, then refused. Returns how many were.
pub(super) fn relax(
    sheet: &mut Sheet,
    mut cover: Option<&mut Cover>,
    (n_rounds, sizes): (usize, Sizes),
    progress: &Progress,
) -> Result<usize, Cancelled> {
    let mut n_refused = 0;
    for round in 0..n_rounds {
        progress.at(round as f64 / n_rounds as f64)?;
        if let Some(cover) = &mut cover {
            cover.update(sheet);
        }
        let cover = cover.as_deref();
        let mean = mean_area(sheet, sheet.faces().ids());
        n_refused = 0;
        for v in sheet.vertex_ids() {
            if v.0 % 4096 == 0 {
                progress.check()?;
            }
            if sheet.is_pinned(v) {
                continue;
            }
            let area = match sizes {
                Sizes::Equal => mean,
                Sizes::Own => mean_area(sheet, sheet.ring(v).iter().copied()),
            };
            let step = wish(sheet, cover, v, wanted_radius(area));
            if !slide(sheet, v, step) && !slide(sheet, v, step * 0.5) {
                n_refused += 1;
            }
        }
    }
    Ok(n_refused)
}

/// Moves a vertex along the surface if that neither folds the sphere nor spoils a face.
fn slide(sheet: &mut Sheet, vertex: VertexId, step: DVec3) -> bool {
    let now = *sheet.point(vertex);
    let there = sheet.walked(vertex, now.position + step);
    let before = sheet.worst_quality(vertex, &now);
    let after = sheet.worst_quality(vertex, &there);
    after >= before.min(GUARDED_QUALITY) && sheet.try_move(vertex, there)
}

fn mean_area(sheet: &Sheet, faces: impl ExactSizeIterator<Item = FaceId>) -> f64 {
    let n = faces.len().max(1) as f64;
    faces.map(|face| sheet.area(face)).sum::<f64>() / n
}

/// The circumradius of a regular triangle and of a square of an area.
fn wanted_radius(mean: f64) -> [f64; 2] {
    // A triangle of circumradius r has area 3√3/4 r², a square 2 r².
    [(mean * 4.0 / 27.0f64.sqrt()).sqrt(), (mean / 2.0).sqrt()]
}

/// The way to the mean of where the faces at a vertex want it, along the surface.
fn wish(sheet: &Sheet, cover: Option<&Cover>, vertex: VertexId, radius: [f64; 2]) -> DVec3 {
    let here = sheet.point(vertex);
    let ring = sheet.ring(vertex);
    let sum = ring.iter().fold(DVec3::ZERO, |sum, &id| {
        let face = &sheet.faces()[id];
        let corner = face.find(vertex).expect("a ring's faces have the vertex");
        let over = cover.map(|cover| Over {
            hidden: cover.hidden(sheet, id),
            excess: cover.excess(sheet, id),
            centre: cover.part(id).centre,
        });
        sum + regular_corner(sheet, (face, corner), over.unwrap_or_default(), radius)
    });
    let step = sum / ring.len() as f64 - here.position;
    step - here.normal * step.dot(here.normal)
}

/// What a face lies over.
#[derive(Clone, Copy, Default)]
struct Over {
    hidden: f64,
    excess: f64,
    centre: DVec3,
}

/// Where a corner goes when its face becomes the nearest regular polygon of about the wanted size.
///
/// A face that covers much more than it seems to lies over a tip: it wants to shrink around the
/// middle of what it covers, so that its corners climb the limb.
fn regular_corner(
    sheet: &Sheet,
    (face, corner): (&Face, usize),
    over: Over,
    radius: [f64; 2],
) -> DVec3 {
    let at = |steps| sheet.point(face.corner(corner, steps));
    let n = face.corners().len();
    let (here, next, before) = (at(0), at(1), at(n - 1));
    let sum = here.normal + next.normal + before.normal;
    let normal = sum.normalize_or_zero();
    let turned = normal.cross(before.position - next.position);
    let (centre, spoke, wanted) = if n == 3 {
        let centre = (here.position + next.position + before.position) / 3.0;
        let spoke = (here.position - centre) * 0.5 + turned * (3.0f64.sqrt() / 6.0);
        (centre, spoke, radius[0])
    } else {
        let far = at(2).position;
        let centre = (here.position + next.position + before.position + far) / 4.0;
        (centre, (here.position - far + turned) / 4.0, radius[1])
    };
    let hidden = over.hidden;
    let centre = centre.lerp(over.centre, hidden);
    let wanted = wanted * (1.0 - hidden + hidden / over.excess.max(1.0).sqrt());
    let length = spoke.length();
    let size = SIZE_WISH * wanted + (1.0 - SIZE_WISH) * length;
    centre + spoke * (size / length.max(f64::MIN_POSITIVE))
}
