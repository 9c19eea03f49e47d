//! What a surface wears before it is made flat: the field, the wish, the lines.

use std::f64::consts::PI;

use glam::DVec2;

use super::creases::{self, Line, Network, Sharp};
use super::error::Error;
use super::field::{self, OrientationField};
use super::guides::Guides;
use super::mirror::{Plan, plan, plane_edges, straighten};
use super::settings::{Creases, Settings};
use super::singularities::tidy;
use super::wish::wish;
use crate::measure::{sharp_edges, total_area};
use crate::mesh::{FaceMap, HalfedgeMap, TriangleMesh};
use crate::progress::Progress;

/// What a surface wears before it is made flat.
pub(super) struct Dressed {
    pub field: OrientationField,
    pub wish: HalfedgeMap<DVec2>,
    /// The edges that quads should lie along but for marked ones and those in the plane.
    sharp: HalfedgeMap<bool>,
    /// What to keep to: of a solid all lines; else all, if the sharp ones are clear; those of marked
    /// edges alone, if there are any; those alone that have to be met.
    pub plans: Vec<Plan>,
}

impl Dressed {
    /// Whether those lines of a plan that are met hold enough of the sharp edges, if it has any.
    pub fn are_met(&self, mesh: &TriangleMesh, plan: &Plan, is_met: &[bool]) -> bool {
        let length = |line: &Line| line.length_of(mesh, |h| self.sharp[*h]);
        let lines = plan.lines().zip(is_met).filter(|(_, is_met)| **is_met);
        let on_lines = lines.map(|(line, _)| length(line)).sum();
        let has_sharp = plan.beside.iter().any(|line| length(line) > 0.0);
        !has_sharp || creases::are_clear(mesh, &self.sharp, on_lines)
    }
}

/// The field, its singularities tidied for quads of the wanted sizes, the wish, and the lines of
/// marked edges and of sharp ones if these are clear.
pub(super) fn dress(
    mesh: &TriangleMesh,
    (guides, sizes): (Guides<'_>, &FaceMap<f64>),
    settings: &Settings,
    progress: &Progress,
) -> Result<Dressed, Error> {
    let sharp_angle = settings.sharp_angle.unwrap_or(f64::INFINITY);
    let edges = Edges::new(mesh, guides, (settings.creases, sharp_angle));
    let network = edges.network(mesh)?;
    let steering = Steering {
        edges: &edges,
        network: network.as_ref(),
        sizes,
    };
    let pull = field::Settings {
        sharp_angle: sharp_angle.min(PI),
        ..settings.field
    };
    let pull = (&pull, &edges.along);
    let mut field = field::orient_along(mesh, pull, &progress.part("", 0.0, 0.5))?;
    steering.tidy(mesh, &mut field);
    let h = (total_area(mesh) / settings.n_quads.max(1) as f64).sqrt();
    let kept = edges.kept((mesh, &field), h);
    steering.attract(mesh, &mut field, kept[0]);
    field::settle_along(mesh, &mut field, pull, &progress.part("", 0.5, 0.7))?;
    steering.mirror(&mut field);
    let wish = wish(mesh, &field, sizes, &progress.part("", 0.7, 1.0))?;
    let plans = edges.plans((mesh, &field), &kept, h);
    Ok(Dressed {
        field,
        wish,
        plans,
        sharp: edges.sharp,
    })
}

/// The edges that quads should lie along, on both sides of each.
struct Edges<'a> {
    guides: Guides<'a>,
    creases: Creases,
    /// All but those in the plane of symmetry.
    all: HalfedgeMap<bool>,
    /// All.
    along: HalfedgeMap<bool>,
    /// Those that are nothing but sharp: nobody marked them, and they need not be met.
    sharp: HalfedgeMap<bool>,
    /// Those that have to be met, and those in the plane; none where nothing has to be met.
    held: Option<HalfedgeMap<bool>>,
}

impl<'a> Edges<'a> {
    /// Those of a surface, where edges of at least some angle are sharp.
    fn new(
        mesh: &TriangleMesh,
        guides: Guides<'a>,
        (creases, sharp_angle): (Creases, f64),
    ) -> Self {
        let all = match creases {
            Creases::All => guides.lines.clone(),
            Creases::Long => sharp_edges(mesh, sharp_angle).or(guides.lines),
        };
        let is_firm = |h| guides.firm.is_some_and(|firm| firm.is_on[h]);
        let is_sharp = |h| all[h] && !guides.marked[h] && !is_firm(h);
        Self {
            along: match guides.turned {
                Some(turned) => with_plane(guides, &all).or(turned),
                None => with_plane(guides, &all),
            },
            sharp: mesh.halfedge_ids().map(is_sharp).collect(),
            held: firm(guides, (creases, &all)).map(|firm| with_plane(guides, firm)),
            all,
            creases,
            guides,
        }
    }

    /// Some edges, with the corners that are known.
    fn known<'b>(&self, edges: &'b HalfedgeMap<bool>) -> Sharp<'b>
    where
        'a: 'b,
    {
        let firm = self.guides.firm;
        Sharp { edges, firm }
    }

    /// Those that have to be met as a network of creases, if there are any.
    fn network(&self, mesh: &'a TriangleMesh) -> Result<Option<Network<'_>>, Error> {
        let firm = firm(self.guides, (self.creases, &self.all));
        let has_any = firm.is_some_and(|firm| firm.iter().any(|&is_firm| is_firm));
        match &self.held {
            Some(held) if has_any => {
                let network = Network::new(mesh, self.known(held), self.guides.mirror);
                Ok(Some(network.ok_or(Error::NoSolid)?))
            }
            _ if self.creases == Creases::All => Err(Error::NoSolid),
            _ => Ok(None),
        }
    }

    /// Those whose lines are kept, more of them first: all, if the sharp ones are clear; marked ones.
    fn kept(
        &self,
        (mesh, field): (&TriangleMesh, &OrientationField),
        h: f64,
    ) -> Vec<&HalfedgeMap<bool>> {
        let along = with_plane(self.guides, &self.all);
        let lines = creases::lines(mesh, field, self.known(&along), h).into_iter();
        let sharp = lines.map(|line| line.length_of(mesh, |h| self.sharp[*h]));
        let are_clear = creases::are_clear(mesh, &self.sharp, sharp.sum());
        let all = are_clear.then_some(&self.all);
        all.into_iter().chain([self.guides.marked]).collect()
    }

    /// What to keep to, from the most to the least.
    fn plans(
        &self,
        (mesh, field): (&TriangleMesh, &OrientationField),
        kept: &[&HalfedgeMap<bool>],
        h: f64,
    ) -> Vec<Plan> {
        let plan = |lines| planned(self.guides, field, lines);
        if self.creases == Creases::All {
            let lines = creases::whole_lines(mesh, field, self.known(&self.along), h);
            return vec![plan(lines).firm()];
        }
        let along = |edges: &HalfedgeMap<bool>| lines_of((mesh, field), self.known(edges), h);
        let kept = kept.iter().filter(|kept| kept.iter().any(|&is| is));
        let lines = kept.map(|kept| along(&with_plane(self.guides, kept)));
        let least = self.held.as_ref().map(along).unwrap_or_default();
        lines.chain([least]).map(plan).collect()
    }
}

/// What moves the singularities of a field.
struct Steering<'a> {
    edges: &'a Edges<'a>,
    network: Option<&'a Network<'a>>,
    sizes: &'a FaceMap<f64>,
}

impl Steering<'_> {
    /// Merges those that are near each other and splits large ones.
    fn tidy(&self, mesh: &TriangleMesh, field: &mut OrientationField) {
        self.mirror(field);
        tidy(mesh, field, self.sizes);
        self.mirror(field);
    }

    /// Moves those beside lines onto them, and gives patches those that they have to have.
    fn attract(&self, mesh: &TriangleMesh, field: &mut OrientationField, kept: &HalfedgeMap<bool>) {
        let is_long = self.edges.creases == Creases::Long;
        if is_long {
            creases::attract(mesh, field, self.edges.known(kept), self.sizes);
        }
        if let Some(network) = self.network {
            network.settle(field);
            if is_long {
                network.clear(field, self.sizes);
            }
        }
        self.mirror(field);
    }

    /// Makes the field its own image, where the surface is.
    fn mirror(&self, field: &mut OrientationField) {
        let is_long = self.edges.creases == Creases::Long;
        let corners = self.network.filter(|_| is_long);
        if let Some(doubled) = self.edges.guides.mirror {
            straighten(field, doubled, (self.sizes, corners));
        }
    }
}

/// The edges that have to be met: of a solid all.
fn firm<'a>(
    guides: Guides<'a>,
    (creases, all): (Creases, &'a HalfedgeMap<bool>),
) -> Option<&'a HalfedgeMap<bool>> {
    match creases {
        Creases::All => Some(all),
        Creases::Long => guides.firm.map(|firm| &firm.is_on),
    }
}

/// Some edges and those in the plane of symmetry.
fn with_plane(guides: Guides<'_>, edges: &HalfedgeMap<bool>) -> HalfedgeMap<bool> {
    match guides.mirror {
        Some(doubled) => edges.or(&plane_edges(doubled)),
        None => edges.clone(),
    }
}

/// Lines along some edges, of which those that have to be met are taken whole.
fn lines_of(
    (mesh, field): (&TriangleMesh, &OrientationField),
    along: Sharp<'_>,
    h: f64,
) -> Vec<Line> {
    let Some(known) = along.firm else {
        return creases::lines(mesh, field, along, h);
    };
    let edges = &along.edges.or(&known.is_on);
    let sharp = Sharp { edges, ..along };
    let whole = creases::whole_lines(mesh, field, sharp, h);
    let mut lines = creases::firm_lines(whole, &known.is_on);
    lines.extend(creases::lines_beside(&lines, (mesh, field, sharp), h));
    lines
}

/// What to keep to with some lines of sharp edges.
fn planned(guides: Guides<'_>, field: &OrientationField, beside: Vec<Line>) -> Plan {
    match guides.mirror {
        Some(doubled) => {
            let firm = guides.firm.map(|firm| &firm.is_on);
            plan((doubled, firm), field, &beside)
        }
        None => Plan {
            plane: Vec::new(),
            beside,
            pairs: Vec::new(),
        },
    }
}
