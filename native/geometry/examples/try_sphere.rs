use glam::DVec3;
use orbflow_geometry::{mesh::*, nearest::Bvh, progress::Progress, sphere::*, sphere_map::*};
use std::io::Write;
pub fn stats(name: &str, mesh: &PolygonMesh, pos: &[DVec3]) {
    let mut l = vec![];
    let mut mins = vec![];
    let mut areas = vec![];
    for f in mesh.faces() {
        let n = f.len();
        let p: Vec<DVec3> = f.iter().map(|v| pos[v.index()]).collect();
        let mut m = 180.0f64;
        let mut ar = DVec3::ZERO;
        for i in 0..n {
            let (a, b, c) = (p[i], p[(i + 1) % n], p[(i + n - 1) % n]);
            l.push(a.distance(b));
            m = m.min((b - a).angle_between(c - a).to_degrees());
            ar += a.cross(b);
        }
        mins.push(m);
        areas.push(ar.length() / 2.0);
    }
    let cv = |x: &Vec<f64>| {
        let m = x.iter().sum::<f64>() / x.len() as f64;
        (x.iter().map(|y| (y - m) * (y - m)).sum::<f64>() / x.len() as f64).sqrt() / m
    };
    let mm = mins.iter().sum::<f64>() / mins.len() as f64;
    let b10 = mins.iter().filter(|&&x| x < 10.0).count();
    print!(
        "{name:14} F {} edge cv {:.3} area cv {:.3} min angle {:.1} <10: {}",
        mesh.n_faces(),
        cv(&l),
        cv(&areas),
        mm,
        b10
    );
}
pub fn load(path: &str) -> SphereMap {
    let (mut p, mut s, mut f) = (vec![], vec![], vec![]);
    for line in std::fs::read_to_string(path).unwrap().lines() {
        let w: Vec<&str> = line.split(' ').collect();
        if w[0] == "v" {
            let n: Vec<f64> = w[1..].iter().map(|x| x.parse().unwrap()).collect();
            p.push(DVec3::new(n[0], n[1], n[2]));
            s.push(DVec3::new(n[3], n[4], n[5]));
        } else {
            let n: Vec<u32> = w[1..].iter().map(|x| x.parse().unwrap()).collect();
            f.push([VertexId(n[0]), VertexId(n[1]), VertexId(n[2])]);
        }
    }
    SphereMap::prove(TriangleMesh::new(p, f).unwrap(), VertexMap::from_vec(s)).unwrap()
}
fn samples(bvh_tris: &[[DVec3; 3]], n: usize) -> Vec<DVec3> {
    let mut r = orbflow_geometry::random::Random::new(5);
    let a: Vec<f64> = bvh_tris
        .iter()
        .map(|[a, b, c]| (*b - *a).cross(*c - *a).length())
        .collect();
    let total: f64 = a.iter().sum();
    let mut acc = 0.0;
    let mut out = vec![];
    for (t, w) in bvh_tris.iter().zip(&a) {
        acc += w;
        while (out.len() as f64 + 0.5) / n as f64 * total <= acc {
            let u = r.unit().sqrt();
            let v = r.unit();
            out.push(t[0] * (1.0 - u) + t[1] * u * (1.0 - v) + t[2] * u * v);
        }
    }
    out
}
pub fn compare(full: &str, mesh: &PolygonMesh, pos: &[DVec3]) {
    let (mut p, mut t) = (vec![], vec![]);
    for line in std::fs::read_to_string(full).unwrap().lines() {
        let w: Vec<&str> = line.split(' ').collect();
        if w[0] == "v" {
            let n: Vec<f64> = w[1..].iter().map(|x| x.parse().unwrap()).collect();
            p.push(DVec3::new(n[0], n[1], n[2]));
        } else {
            let n: Vec<usize> = w[1..].iter().map(|x| x.parse().unwrap()).collect();
            t.push([p[n[0] - 1], p[n[1] - 1], p[n[2] - 1]]);
        }
    }
    let input = Bvh::new(&t);
    // vertices projected onto the full input
    let pos: Vec<DVec3> = pos.iter().map(|&q| input.closest(q).position).collect();
    let mut o = vec![];
    for f in mesh.faces() {
        let q: Vec<DVec3> = f.iter().map(|v| pos[v.index()]).collect();
        if q.len() == 4 && q[1].distance(q[3]) < q[0].distance(q[2]) {
            o.push([q[1], q[2], q[3]]);
            o.push([q[1], q[3], q[0]]);
        } else {
            for i in 1..q.len() - 1 {
                o.push([q[0], q[i], q[i + 1]]);
            }
        }
    }
    let output = Bvh::new(&o);
    let d1: Vec<f64> = samples(&t, 30000)
        .iter()
        .map(|&q| output.closest(q).distance_squared.sqrt())
        .collect();
    let d2: Vec<f64> = samples(&o, 30000)
        .iter()
        .map(|&q| input.closest(q).distance_squared.sqrt())
        .collect();
    let mean = |d: &[f64]| d.iter().sum::<f64>() / d.len() as f64 * 100.0;
    let f1 = |thr: f64| {
        let r = d1.iter().filter(|&&x| x < thr).count() as f64 / d1.len() as f64;
        let p = d2.iter().filter(|&&x| x < thr).count() as f64 / d2.len() as f64;
        200.0 * p * r / (p + r)
    };
    println!(
        " chamfer {:.4} hausd {:.2} F1@.5 {:.2} F1@1 {:.2}",
        (mean(&d1) + mean(&d2)) / 2.0,
        d1.iter().chain(&d2).fold(0.0f64, |a, &b| a.max(b)) * 100.0,
        f1(0.005),
        f1(0.01)
    );
}
fn main() {
    let mode = std::env::args().nth(1).unwrap();
    let n_faces: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let out = std::env::args().nth(3).unwrap();
    for path in std::env::args().skip(4) {
        let name = std::path::Path::new(&path)
            .file_stem()
            .unwrap()
            .to_str()
            .unwrap()
            .to_string();
        let map = load(&path);
        let t = std::time::Instant::now();
        let prim = match mode.as_str() {
            "adaptive" => {
                let a = adaptive(
                    &map,
                    &Settings {
                        n_faces,
                        ..Settings::default()
                    },
                    &Progress::none(),
                )
                .unwrap();
                print!("{:?} ", a.report);
                a.primitive
            }
            "uniform" => quad_sphere(quad_sphere_counts(n_faces)),
            m if m.starts_with("spread") => {
                let w: Vec<&str> = m.split(':').collect();
                let s = SpreadSettings {
                    n_trials: w[1].parse().unwrap(),
                    ..SpreadSettings::default()
                };
                spread(
                    &map,
                    &quad_sphere(quad_sphere_counts(n_faces)),
                    &s,
                    &Progress::none(),
                )
                .unwrap()
            }
            _ => panic!(),
        };
        print!("{:?} ", t.elapsed());
        check_cover(&prim, prim.positions()).unwrap();
        let pos: Vec<DVec3> = prim
            .positions()
            .iter()
            .map(|&p| map.surface_position(map.locate(p)))
            .collect();
        stats(&name, &prim, &pos);
        compare(&path.replace(".map", ".full.obj"), &prim, &pos);
        if out != "-" {
            let mut o = std::fs::File::create(format!("{out}/{name}.obj")).unwrap();
            for q in &pos {
                writeln!(o, "v {} {} {}", q.x, q.y, q.z).unwrap();
            }
            for f in prim.faces() {
                let s: Vec<String> = f.iter().map(|v| (v.0 + 1).to_string()).collect();
                writeln!(o, "f {}", s.join(" ")).unwrap();
            }
        }
    }
}
