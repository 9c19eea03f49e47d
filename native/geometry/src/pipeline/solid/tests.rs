use super::*;
use crate::embed::Solver;
use crate::mesh::FaceId;
use crate::pipeline::Flowed;
use crate::shapes;

/// Two balls that intersect, and a small one in them: materials 0, 1 and 2.
fn balls() -> (PolygonMesh, Vec<i32>) {
    let ball = shapes::sphere(8);
    let (mut points, mut faces, mut materials) = (Vec::new(), Vec::new(), Vec::new());
    for (material, (radius, x)) in [(1.0, 0.0), (0.8, 1.2), (0.3, 0.5)].into_iter().enumerate() {
        let first = points.len() as u32;
        points.extend(ball.positions().iter().map(|&p| p * radius + DVec3::X * x));
        faces.extend(ball.faces().iter().map(|f| f.map(|v| v.0 + first)));
        materials.resize(faces.len(), material as i32);
    }
    (PolygonMesh::from_faces(points, &faces).unwrap(), materials)
}

fn made(input: Input<'_>, wanted: &Settings) -> Remeshed {
    super::super::remesh(input, wanted, &Solver::default(), &Progress::none()).unwrap()
}

/// The equator of the first ball, as edges.
fn equator(mesh: &PolygonMesh) -> Vec<[VertexId; 2]> {
    let points = mesh.positions();
    let on = |v: &VertexId| v.index() < points.len() / 3 && points[v.index()].z.abs() < 1e-9;
    let edges = mesh
        .faces()
        .flat_map(|f| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]]);
    edges.filter(|ends| ends.iter().all(on)).collect()
}

#[test]
fn one_closed_mesh_has_the_data_of_the_shells_that_it_lies_on() {
    let (mesh, materials) = balls();
    let points = mesh.positions();
    let ring = equator(&mesh);
    assert!(ring.len() > 30);
    let density: Vec<f64> = points
        .iter()
        .map(|p| f64::from(u8::from(p.x > 1.0)))
        .collect();
    let input = Input {
        materials: Some(&materials),
        marked: &ring,
        carried: &ring,
        density: Some(&density),
        cuts: Some(&[]),
        ..Input::new(&mesh)
    };
    let wanted = Settings {
        faces: 600,
        solid: true,
        solid_detail: 1.0,
        score: Some(crate::score::Settings::default()),
        ..Settings::default()
    };
    let made = made(input, &wanted);
    let report = &made.report;
    assert_eq!(
        (report.output.n_components, report.output.closed),
        (1, true)
    );
    assert_eq!(report.input.n_components, 3);
    let told = report.solid.expect("it was asked for");
    assert_eq!((told.report.n_shells, told.report.n_pieces), (3, 1));
    assert_eq!(told.text(), "3 shells made 1 closed surface");
    // Inner shells do not count as distance.
    let score = report.score.as_ref().expect("it was asked for");
    assert!(
        score.distance.hausdorff_pct < 2.0,
        "{}",
        score.distance.hausdorff_pct
    );
    let of_faces = made.materials.as_ref().expect("materials were given");
    let origins = made.origins.as_ref().expect("cuts were given");
    for (i, face) in made.mesh.faces().enumerate() {
        let x = face.iter().map(|&v| made.mesh.position(v).x).sum::<f64>() / face.len() as f64;
        let wanted = i32::from(x > 0.78);
        assert!(
            (x - 0.78).abs() < 0.2 || of_faces[i] == wanted,
            "{x}: {}",
            of_faces[i]
        );
        assert_eq!(materials[origins.faces[i].index()], of_faces[i]);
    }
    assert_eq!(origins.faces.len(), made.mesh.n_faces());
    assert!(
        origins
            .faces
            .iter()
            .all(|f: &FaceId| f.index() < mesh.n_faces())
    );
    check_ring(&made, ring.len());
}

/// Edges lie along the ring that was marked.
fn check_ring(made: &Remeshed, n: usize) {
    assert!(made.carried.len() >= 5, "{}", made.carried.len());
    for carried in &made.carried {
        let heights = carried.ends.map(|v| made.mesh.position(v).z.abs());
        assert!(heights[0].max(heights[1]) < 0.05, "{heights:?}");
        assert!(carried.from < n);
    }
}

#[test]
fn details_out_of_range_and_grids_too_fine_are_refused_with_numbers() {
    let (mesh, _) = balls();
    let told = |solid_detail| {
        let wanted = Settings {
            solid: true,
            solid_detail,
            ..Settings::default()
        };
        let run = super::super::remesh(
            Input::new(&mesh),
            &wanted,
            &Solver::default(),
            &Progress::none(),
        );
        run.unwrap_err().to_string()
    };
    for wrong in [0.0, 7.0, f64::NAN] {
        let text = format!("the solid detail is {wrong} %; it goes from 0.02 to 5");
        assert_eq!(told(wrong), text);
    }
    assert!(told(0.02).starts_with("so fine a grid would meet the surface in about"));
}

#[test]
fn a_handle_gets_rings_and_a_tunnel_without_room_for_quads_is_sealed() {
    for (tube, detail, genus, n_sealed) in [(0.4, 2.0, 1, None), (0.93, 1.0, 0, Some(1))] {
        let ring = shapes::torus(64, 48);
        // From the middle of the tube of the shape to that of this one.
        let wider = |p: &DVec3| {
            let middle = DVec3::new(p.x, p.y, 0.0).normalize_or_zero();
            middle + (*p - middle) * (tube / 0.4)
        };
        let points = ring.positions().iter().map(wider).collect();
        let faces: Vec<[u32; 3]> = ring.faces().iter().map(|f| f.map(|v| v.0)).collect();
        let mesh = PolygonMesh::from_faces(points, &faces).unwrap();
        let wanted = Settings {
            faces: 400,
            solid: true,
            solid_detail: detail,
            ..Settings::default()
        };
        let report = made(Input::new(&mesh), &wanted).report;
        assert_eq!(report.output.genus, Some(genus));
        let part = &report.parts[0];
        let sealed = part.opened.map(|opened| opened.n_sealed).filter(|&n| n > 0);
        assert_eq!(sealed, n_sealed);
        assert_eq!(part.deform.n_inverted, 0);
        let Some(Flowed::Used { n_rings, .. }) = &part.flow else {
            panic!("{:?}", part.flow);
        };
        assert_eq!(*n_rings, 2 * genus as usize);
    }
}
