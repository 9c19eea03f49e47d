//! Surfaces that share edges, and what they are parted into.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::clean::{Apart, Error, clean, take_apart};
use crate::elementary::{cos, direction, sin};
use crate::mesh::{Id, PolygonMesh, VertexId};
use crate::progress::Progress;
use crate::random::Random;
use crate::shapes::CUBE_QUADS;

/// Quads over points that are told apart by their places.
#[derive(Default)]
struct Quads {
    points: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

impl Quads {
    fn name(&mut self, point: DVec3) -> u32 {
        let at = self.points.iter().position(|p| p.distance(point) < 1e-9);
        at.unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        }) as u32
    }

    fn add(&mut self, corners: &[DVec3]) {
        let face = corners.iter().map(|&p| self.name(p)).collect();
        self.faces.push(face);
    }

    /// `n` × `m` quads between two directions.
    fn grid(&mut self, from: DVec3, [along, up]: [DVec3; 2], [n, m]: [u32; 2]) {
        for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
            let at = |i: u32, j: u32| from + along * f64::from(i) + up * f64::from(j);
            self.add(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }

    fn cube(&mut self, from: DVec3) {
        let bit = |i: u32, b: u32| f64::from(i >> b & 1);
        for quad in CUBE_QUADS {
            self.add(&quad.map(|i| from + DVec3::new(bit(i, 0), bit(i, 1), bit(i, 2))));
        }
    }

    /// Pages of two quads each on the z axis, by their angles in degrees.
    fn book(degrees: impl IntoIterator<Item = i32>) -> Self {
        let mut book = Self::default();
        for angle in degrees {
            let away = direction(f64::from(angle).to_radians()).extend(0.0);
            book.grid(DVec3::ZERO, [away, DVec3::Z], [1, 2]);
        }
        book
    }

    /// A strip of so many faces across that turns by half on its way round.
    fn moebius(width: u32) -> Self {
        let n = 12;
        let at = |i: u32, j: u32| {
            let turn = f64::from(i % n) / f64::from(n) * std::f64::consts::TAU;
            let j = if i < n { j } else { width - j };
            let across = f64::from(j) / f64::from(width) - 0.5;
            let round = direction(turn) * (2.0 + across * cos(turn / 2.0));
            round.extend(across * sin(turn / 2.0))
        };
        let mut strip = Self::default();
        for (i, j) in (0..n).flat_map(|i| (0..width).map(move |j| (i, j))) {
            strip.add(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        strip
    }

    fn mesh(&self) -> PolygonMesh {
        PolygonMesh::from_faces(self.points.clone(), &self.faces).unwrap()
    }

    fn apart(&self) -> Apart {
        let apart = take_apart(&self.mesh(), None, &Progress::none()).unwrap();
        check(&self.mesh(), &apart);
        apart
    }
}

/// Whether every face is in one part, and lines are where sheets run.
fn check(mesh: &PolygonMesh, apart: &Apart) {
    assert_eq!(apart.mesh.check(), Ok(()));
    let mut faces: Vec<u32> = sheets(apart).into_iter().flatten().collect();
    faces.extend(
        apart
            .tangles
            .iter()
            .flat_map(|tangle| tangle.faces.iter().map(|f| f.0)),
    );
    faces.sort_unstable();
    assert!(
        faces.iter().copied().eq(0..mesh.n_faces() as u32),
        "{faces:?}"
    );
    let component = apart.mesh.face_components().0;
    for line in &apart.shared {
        for strand in &line.strands {
            let told: Vec<DVec3> = line.vertices.iter().map(|&v| mesh.position(v)).collect();
            let mut found: Vec<DVec3> = Vec::new();
            for &v in &strand.vertices {
                let fan = apart.mesh.outgoing(v).next().unwrap();
                assert_eq!(component[fan.face().index()] as usize, strand.sheet);
                found.push(apart.mesh.position(v));
            }
            found.retain(|p| told.contains(p));
            assert_eq!(found, told);
            for ends in strand.vertices.windows(2) {
                let mut leaving = apart.mesh.outgoing(ends[0]);
                let mut entering = apart.mesh.outgoing(ends[1]);
                let joined = leaving.any(|h| apart.mesh.target(h) == ends[1])
                    || entering.any(|h| apart.mesh.target(h) == ends[0]);
                assert!(joined, "{ends:?}");
            }
        }
    }
}

/// The input's faces of each sheet.
fn sheets(apart: &Apart) -> Vec<BTreeSet<u32>> {
    let (component, n) = apart.mesh.face_components();
    let mut sheets = vec![BTreeSet::new(); n];
    for (face, &component) in apart.mesh.face_ids().zip(&component) {
        sheets[component as usize].insert(apart.source[face].0);
    }
    sheets
}

fn sizes(apart: &Apart) -> Vec<usize> {
    let mut sizes: Vec<usize> = sheets(apart).iter().map(BTreeSet::len).collect();
    sizes.sort_unstable();
    sizes
}

#[test]
fn the_through_wall_of_a_t_is_one_sheet_and_the_stem_another() {
    for lean in [0.0, 1.0] {
        let mut wall = Quads::default();
        wall.grid(DVec3::ZERO, [DVec3::X, DVec3::Z], [4, 2]);
        let stem = DVec3::new(lean, 1.0, 0.0);
        wall.grid(DVec3::X * 2.0, [stem, DVec3::Z], [3, 2]);
        let apart = wall.apart();
        assert_eq!(sizes(&apart), [6, 8]);
        let [line] = &apart.shared[..] else {
            panic!("{:?}", apart.shared);
        };
        assert_eq!(
            (line.vertices.len(), line.n_faces, line.is_closed),
            (3, 3, false)
        );
        let ends: Vec<bool> = line.strands.iter().map(|strand| strand.is_border).collect();
        assert_eq!(ends.iter().filter(|&&ends| ends).count(), 1);
        let report = apart.report;
        assert_eq!((report.n_shared_edges, report.n_sheets), (2, 2));
        let told = report.sentences();
        assert!(told.contains(&"2 edges of three or more faces parted into 2 sheets".into()));
    }
}

#[test]
fn crossed_planes_are_two_planes_unless_all_halves_are_turned_as_sides_of_solids() {
    for turned in 0..16_u32 {
        let is_turned = |page: usize| turned >> page & 1 == 1;
        let mut planes = Quads::book([0, 90, 180, 270]);
        for page in (0..4).filter(|&page| is_turned(page)) {
            let faces = &mut planes.faces[2 * page..2 * page + 2];
            for face in faces {
                face.reverse();
            }
        }
        let apart = planes.apart();
        // What lies between the two sides of a solid is told by their turns alone.
        let alternates = (0..4).all(|page| is_turned(page) != is_turned((page + 1) % 4));
        assert_eq!(apart.shared.is_empty(), alternates, "{turned:04b}");
        let both: Vec<BTreeSet<u32>> = [[0, 1, 4, 5], [2, 3, 6, 7]].map(BTreeSet::from).into();
        assert_eq!(sheets(&apart) == both, !alternates, "{turned:04b}");
    }
}

#[test]
fn a_box_with_a_wall_stays_closed() {
    let mut walled = Quads::default();
    walled.cube(DVec3::ZERO);
    walled.cube(DVec3::X);
    // The face between both is there twice, once each way; a wall is there once.
    walled.faces.remove(6 + 4);
    let apart = walled.apart();
    let mut both = sheets(&apart);
    both.sort_by_key(BTreeSet::len);
    assert_eq!(sizes(&apart), [1, 10]);
    let [line] = &apart.shared[..] else {
        panic!("{:?}", apart.shared);
    };
    assert!(line.is_closed && line.edges().count() == 4);
    let [of_box, of_wall] = [false, true].map(|ends| {
        let strand = line.strands.iter().find(|strand| strand.is_border == ends);
        strand.unwrap()
    });
    assert_ne!(of_box.sheet, of_wall.sheet);
    assert_eq!(apart.mesh.border_loops().len(), 1);
}

#[test]
fn a_box_with_a_wall_from_edge_to_edge_or_a_fin_on_its_edge_stays_closed() {
    let mut walled = Quads::default();
    walled.cube(DVec3::ZERO);
    walled.add(&[DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE, DVec3::Z]);
    // The lid and the floor are cut where the wall meets them.
    for face in walled.faces.clone().iter().filter(|f| f.len() == 4) {
        let height = |v: &u32| walled.points[*v as usize].z.to_bits();
        let level = face.iter().all(|v| height(v) == height(&face[0]));
        if level {
            let at = face
                .iter()
                .position(|&v| walled.points[v as usize].truncate().length() < 0.1);
            let corner = |i: usize| face[(at.unwrap() + i) % 4];
            let halves = [[0, 1, 2], [0, 2, 3]].map(|half| half.map(corner).to_vec());
            walled.faces.retain(|other| other != face);
            walled.faces.extend(halves);
        }
    }
    assert_eq!(sizes(&walled.apart()), [1, 8]);
    for away in [[-1.0, -1.0], [-1.0, 0.3]] {
        let mut finned = Quads::default();
        finned.cube(DVec3::ZERO);
        let away = DVec3::new(away[0], away[1], 0.0);
        finned.add(&[DVec3::ZERO, DVec3::Z, away + DVec3::Z, away]);
        let apart = finned.apart();
        assert_eq!(sizes(&apart), [1, 6]);
        assert_eq!(apart.mesh.border_loops().len(), 1);
    }
}

#[test]
fn blocks_at_an_edge_part_inside_out_too() {
    let mut blocks = Quads::default();
    blocks.cube(DVec3::ZERO);
    blocks.cube(DVec3::new(1.0, 1.0, 0.0));
    let apart = blocks.apart();
    assert!(apart.shared.is_empty() && apart.report.n_sheets == 0);
    blocks.faces.iter_mut().for_each(|face| face.reverse());
    let apart = blocks.apart();
    assert_eq!((sizes(&apart), apart.shared.len()), (vec![6, 6], 1));
    assert!(apart.mesh.is_closed());
}

#[test]
fn of_three_fins_two_go_on_and_of_six_pages_all_that_do_not_fold() {
    assert_eq!(sizes(&Quads::book([0, 120, 240]).apart()), [2, 4]);
    assert_eq!(
        sizes(&Quads::book([0, 60, 120, 180, 240, 300]).apart()),
        [4, 4, 4]
    );
    assert_eq!(sizes(&Quads::book([0, 10, 20, 30, 40, 50]).apart()), [2; 6]);
}

#[test]
fn a_line_is_decided_as_a_whole() {
    // The stem leaves at more than a right angle, but for one edge.
    let mut wall = Quads::default();
    wall.grid(DVec3::ZERO, [DVec3::X, DVec3::Z], [2, 5]);
    for j in 0..5 {
        let [low, high] = [j, j + 1].map(|k| {
            let bent = if k == 2 { 1.0 } else { 0.0 };
            (f64::from(k), DVec3::new(1.0 + 3.0 * bent, 1.0, 0.0))
        });
        let at = |z: f64| DVec3::new(1.0, 0.0, z);
        let z = |(k, side): (f64, DVec3)| side + DVec3::Z * k;
        wall.add(&[at(low.0), at(high.0), z(high), z(low)]);
    }
    let apart = wall.apart();
    assert_eq!((sizes(&apart), apart.shared.len()), (vec![5, 10], 1));
}

#[test]
fn what_has_one_side_only_is_cut_or_stays_a_tangle() {
    let apart = Quads::moebius(1).apart();
    assert_eq!((apart.tangles.len(), apart.mesh.n_faces()), (1, 0));
    // With a fin across it is cut there.
    let mut finned = Quads::moebius(1);
    let [a, b] = [1.5, 2.5].map(|x| DVec3::new(x, 0.0, 0.0));
    let up = DVec3::Y * 0.1 + DVec3::Z;
    finned.add(&[a, b, b + up, a + up]);
    let apart = finned.apart();
    assert!(apart.tangles.is_empty());
    assert_eq!(apart.shared.len(), 1);
    // With a fin along its middle it has one side all the same, but the fin is a sheet.
    let mut finned = Quads::moebius(2);
    let [a, b] = [0, 2].map(|i| finned.points[finned.faces[i][2] as usize]);
    finned.add(&[a, b, b + DVec3::Z * 2.0, a + DVec3::Z * 2.0]);
    let apart = finned.apart();
    assert_eq!((apart.tangles.len(), sizes(&apart)), (1, vec![1]));
    assert_eq!(apart.shared[0].strands.len(), 1);
}

#[test]
fn cleaning_refuses_sheets_that_meet() {
    let error = clean(&Quads::book([0, 90, 180]).mesh(), &Progress::none()).unwrap_err();
    let [a, b] = [0, 3].map(VertexId);
    assert_eq!(error, Error::NonManifoldEdge { n_faces: 3, a, b });
}

/// Some of the faces between the cells of a small block, each turned either way.
fn random_faces(seed: u64) -> Quads {
    let mut random = Random::new(seed);
    let mut quads = Quads::default();
    let n_of_ten = 2 + random.below(7);
    for i in 0..27 {
        let at = DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
        for [a, b] in [
            [DVec3::X, DVec3::Y],
            [DVec3::Y, DVec3::Z],
            [DVec3::Z, DVec3::X],
        ] {
            if random.below(10) < n_of_ten {
                let mut corners = [at, at + a, at + a + b, at + b];
                if random.below(4) == 0 {
                    corners.reverse();
                }
                quads.add(&corners);
            }
        }
    }
    quads
}

#[test]
fn every_face_is_in_one_sheet_whatever_the_order() {
    for seed in 0..300 {
        let mut quads = random_faces(seed);
        let apart = quads.apart();
        assert_eq!(quads.apart(), apart);
        let mut order: Vec<usize> = (0..quads.faces.len()).collect();
        let mut random = Random::new(seed);
        for i in (1..order.len()).rev() {
            order.swap(i, random.below(i + 1));
        }
        quads.faces = order.iter().map(|&i| quads.faces[i].clone()).collect();
        let was = |sheet: BTreeSet<u32>| -> BTreeSet<u32> {
            sheet
                .into_iter()
                .map(|f| order[f as usize] as u32)
                .collect()
        };
        let again: BTreeSet<_> = sheets(&quads.apart()).into_iter().map(was).collect();
        assert_eq!(again, sheets(&apart).into_iter().collect(), "seed {seed}");
    }
}
