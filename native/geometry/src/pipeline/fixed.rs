//! Faces that do not flow, of a primitive: made on the sphere, laid on the part.

use super::Error;
use super::clock::Clock;
use super::ground::Ground;
use super::laid::Laid;
use super::part::Wanted;
use super::settings::Primitive;
use crate::deform::Held;
use crate::hierarchy::CollapseHierarchy;
use crate::mesh::{PolygonMesh, VertexMap};
use crate::progress::Progress;
use crate::sphere::Adaptive;
use crate::sphere_map::SphereMap;
use crate::{deform, embed, sphere};

/// Along borders the number of triangles is met roughly: they are made so often at most, until they
/// are off by no more than a share.
const N_COUNTS: usize = 4;
const NEAR_COUNT: f64 = 0.01;

/// A primitive and the map that carries it to the surface.
struct Placed {
    map: SphereMap,
    primitive: PolygonMesh,
    held: Held,
    report: Option<sphere::Report>,
}

impl Wanted<'_> {
    /// The faces of a primitive that is the same for all shapes, or adapts to them.
    pub fn fixed(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        ground: &Ground,
        clock: &mut Clock,
        progress: &Progress<'_>,
    ) -> Result<Laid, Error> {
        let stage = progress.part("sphere", 0.0, 0.5);
        let placed = clock.step("sphere", || self.place((hierarchy, map), ground, &stage))?;
        let stage = progress.part("deform", 0.5, 1.0);
        let (map, primitive) = (&placed.map, (&placed.primitive, &placed.held));
        let settings = ground.deform();
        let deform = || deform::deform_held(map, primitive, &ground.target, &settings, &stage);
        let deformed = clock.step("deform", deform)?;
        let deformed = ground.opened(map, deformed, &placed.held.edges, progress)?;
        let deformed = deformed.map_err(|reason| Error::Unopened { reason })?;
        Ok(Laid::new(deformed, placed.report, ground.bare()))
    }

    /// Makes the primitive and chooses its map: adaptive triangles lie where the surface needs them
    /// on any map; a fixed primitive is even on the sphere and needs a map that keeps areas.
    fn place(
        &self,
        (hierarchy, map): (&CollapseHierarchy, SphereMap),
        ground: &Ground,
        progress: &Progress<'_>,
    ) -> Result<Placed, Error> {
        let seed = self.settings.seed;
        let fixed = match self.settings.primitive() {
            Primitive::Adaptive => {
                let (made, held) = self.adaptive(&map, ground, progress)?;
                return Ok(Placed {
                    map,
                    primitive: made.primitive,
                    held,
                    report: Some(made.report),
                });
            }
            Primitive::Flow | Primitive::QuadSphere => {
                sphere::quad_sphere(sphere::quad_sphere_counts(self.n_faces))
            }
            Primitive::Icosphere => sphere::icosphere(sphere::icosphere_frequency(self.n_faces)),
        };
        let map = embed::even(hierarchy, &progress.part("", 0.0, 0.8))?;
        let settings = sphere::SpreadSettings {
            seed,
            ..sphere::SpreadSettings::default()
        };
        let primitive = sphere::spread(&map, &fixed, &settings, &progress.part("", 0.8, 1.0))?;
        Ok(Placed {
            map,
            primitive,
            held: Held::default(),
            report: None,
        })
    }

    /// Triangles that are even on the part, as many as are wanted on what is real.
    fn adaptive(
        &self,
        map: &SphereMap,
        ground: &Ground,
        progress: &Progress<'_>,
    ) -> Result<(Adaptive, Held), Error> {
        let density = VertexMap::filled(map.mesh().n_vertices(), 1.0);
        let lines = ground.lines();
        let (mut n_faces, n_asked) = (self.n_faces, ground.n_asked(self) as f64);
        for n_left in (0..N_COUNTS).rev() {
            let settings = sphere::Settings {
                n_faces,
                seed: self.settings.seed,
                ..sphere::Settings::default()
            };
            let made = sphere::sized(map, (&density, lines), &settings, progress)?;
            let held = ground.held(map, &made, progress)?;
            let faces = (&made.primitive, made.primitive.positions());
            let share = ground.real_share(map, faces, &held.edges, progress)?;
            let found = share * made.primitive.n_faces() as f64;
            let next = (n_faces as f64 * n_asked / found.max(1.0)).round() as usize;
            let is_near = (found - n_asked).abs() <= NEAR_COUNT * n_asked;
            if lines.is_empty() || is_near || n_left == 0 || next == n_faces {
                return Ok((made, held));
            }
            n_faces = next;
        }
        unreachable!("the last count is taken as it is")
    }
}
