//! Open parts that are to get few faces, as hair cards: these are found without a flow.
//!
//! A flow costs as much for eight quads as for hundreds, and has no room: it is spent on parts that gain
//! by it. A part whose triangles pair into a grid of quads becomes a grid of other counts.

use glam::DVec3;

use super::Error;
use super::open::Whole;
use super::part::Wanted;
use super::settings::{Kind, Primitive};
use super::uncut::edges;
use crate::deform::Deformed;
use crate::mesh::HalfedgeMap;
use crate::pair::{self, Grid};
use crate::progress::Progress;

/// Of fewer quads open parts are no flow: most attempts fail there.
const FEWEST: usize = 7;
/// The same where there are many parts, and a tenth of a second for each would be long.
const FEWEST_OF_MANY: usize = 24;
/// Up to so many quads grids stay grids; of more a flow follows the shape better.
const MOST_OF_GRID: usize = 64;
/// A grid has no more triangles for each quad that is wanted: it would lose what they show.
const TRIANGLES_PER_QUAD: usize = 16;

impl Wanted<'_> {
    /// Why an open part is not worth a flow; none where it is.
    pub fn too_few(&self) -> Option<String> {
        let fewest = if self.is_one_of_many {
            FEWEST_OF_MANY
        } else {
            FEWEST
        };
        (self.n_faces < fewest && self.settings.primitive() == Primitive::Flow)
            .then(|| format!("{} quads are too few to flow", self.n_faces))
    }

    /// Whether an open part stays a grid, if it is one.
    pub(super) fn may_be_grid(&self, whole: &Whole) -> bool {
        self.settings.kind == Kind::Quads
            && self.settings.primitive() == Primitive::Flow
            && self.n_faces <= MOST_OF_GRID
            && whole.mesh.n_faces() <= TRIANGLES_PER_QUAD * self.n_faces
            && (whole.shape.n_borders, whole.shape.genus) == (1, Some(0))
    }

    /// The quads of an open part that is a grid already, if it is one. Lines of it that are sharp or
    /// marked stay lines.
    ///
    /// # Errors
    /// When cancelled.
    pub fn grid(&self, whole: &Whole, progress: &Progress<'_>) -> Result<Option<Deformed>, Error> {
        let mesh = &whole.mesh;
        if !self.may_be_grid(whole) || !self.strokes.is_empty() || self.density.on(mesh).is_some() {
            return Ok(None);
        }
        // A sharp diagonal, as of a card that is twisted, is no line.
        let nothing = HalfedgeMap::filled(3 * mesh.n_faces(), false);
        let pairs = pair::pair_open(mesh, &nothing, progress)?;
        if pairs.quads.n_vertices() != mesh.n_vertices() {
            return Ok(None);
        }
        let kept = edges(mesh, &self.kept(whole, mesh));
        let Some(grid) = Grid::of(&pairs.quads, &kept) else {
            return Ok(None);
        };
        let quads = grid.remade(self.n_faces);
        let sphere = vec![DVec3::ZERO; quads.n_vertices()];
        Ok(Some(Deformed::in_space(
            quads,
            sphere,
            Vec::new(),
            progress,
        )?))
    }
}

#[cfg(test)]
mod tests {
    use crate::embed::Solver;
    use crate::mesh::PolygonMesh;
    use crate::pipeline::{Flowed, Input, Settings, remesh};

    use super::*;

    #[test]
    fn hair_cards_become_strips_of_as_many_quads_as_are_asked_for() {
        let n_cards = 12;
        let (mut points, mut faces) = (Vec::new(), Vec::new());
        for card in 0..n_cards {
            for i in 0..=10 {
                let [x, y] = [f64::from(card), 0.3 * f64::from(i)];
                let width = 0.2 - 0.01 * f64::from(i);
                points.extend([-width, width].map(|w| DVec3::new(x + w, y, -0.02 * y * y * x)));
            }
            let first = 22 * card;
            for a in (0..10).map(|i| first + 2 * i) {
                faces.extend([[a, a + 1, a + 3], [a, a + 3, a + 2]]);
            }
        }
        let mesh = PolygonMesh::from_faces(points, &faces).unwrap();
        let settings = Settings {
            faces: 8 * n_cards as usize,
            ..Settings::default()
        };
        let quiet = Progress::none();
        let made = remesh(Input::new(&mesh), &settings, &Solver::default(), &quiet).unwrap();
        let report = made.report;
        assert_eq!(report.parts.len(), n_cards as usize);
        assert!(
            report
                .parts
                .iter()
                .all(|part| part.flow == Some(Flowed::Grid))
        );
        assert_eq!(report.output.n_borders, n_cards as usize);
        assert!(made.mesh.n_faces().abs_diff(settings.faces) <= 4);
        assert_eq!(
            made.mesh.n_vertices(),
            2 * (made.mesh.n_faces() + n_cards as usize)
        );
    }
}
