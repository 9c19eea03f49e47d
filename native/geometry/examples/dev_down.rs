//! dev: reads OBJ files, takes each closed genus-0 component down.
use glam::DVec3;
use orbflow_geometry::decimate::*;
use orbflow_geometry::mesh::*;
use orbflow_geometry::progress::Progress;
use std::time::Instant;
pub fn cpu() -> f64 {
    std::fs::read_dir("/proc/self/task")
        .unwrap()
        .map(|d| {
            std::fs::read_to_string(d.unwrap().path().join("schedstat"))
                .unwrap()
                .split_whitespace()
                .next()
                .unwrap()
                .parse::<f64>()
                .unwrap()
        })
        .sum::<f64>()
        * 1e-9
}
pub fn read(path: &str) -> (Vec<DVec3>, Vec<[VertexId; 3]>) {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let (mut p, mut f) = (vec![], vec![]);
    let mut weld = std::collections::HashMap::new();
    let mut ids: Vec<u32> = vec![];
    for line in text.lines() {
        let mut w = line.split_whitespace();
        match w.next() {
            Some("v") => {
                let c: Vec<f64> = w.filter_map(|x| x.parse().ok()).collect();
                if c.len() < 3 {
                    return (vec![], vec![]);
                }
                let key = [c[0].to_bits(), c[1].to_bits(), c[2].to_bits()];
                let n = p.len() as u32;
                let id = *weld.entry(key).or_insert(n);
                if id == n {
                    p.push(DVec3::new(c[0], c[1], c[2]));
                }
                ids.push(id);
            }
            Some("f") => {
                let c: Vec<i64> = w
                    .filter_map(|x| x.split('/').next().unwrap().parse().ok())
                    .collect();
                if c.iter().any(|&i| i < 1 || i as usize > ids.len()) {
                    return (vec![], vec![]);
                }
                for i in 1..c.len().saturating_sub(1) {
                    let t = [c[0], c[i], c[i + 1]].map(|i| VertexId(ids[i as usize - 1]));
                    if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                        f.push(t)
                    }
                }
            }
            _ => {}
        }
    }
    (p, f)
}
pub fn compact(p: &[DVec3], f: &[[VertexId; 3]]) -> Option<TriangleMesh> {
    let mut map = vec![u32::MAX; p.len()];
    let mut q = vec![];
    let g: Vec<_> = f
        .iter()
        .map(|t| {
            t.map(|v| {
                let i = v.index();
                if map[i] == u32::MAX {
                    map[i] = q.len() as u32;
                    q.push(p[i]);
                }
                VertexId(map[i])
            })
        })
        .collect();
    TriangleMesh::new(q, g).ok()
}
pub fn parts(p: &[DVec3], f: &[[VertexId; 3]]) -> Vec<TriangleMesh> {
    // union find on vertices
    let mut up: Vec<usize> = (0..p.len()).collect();
    fn root(up: &mut Vec<usize>, mut a: usize) -> usize {
        while up[a] != a {
            up[a] = up[up[a]];
            a = up[a];
        }
        a
    }
    for t in f {
        for k in 1..3 {
            let (a, b) = (root(&mut up, t[0].index()), root(&mut up, t[k].index()));
            if a != b {
                up[a.max(b)] = a.min(b);
            }
        }
    }
    let mut groups: std::collections::BTreeMap<usize, Vec<[VertexId; 3]>> = Default::default();
    for t in f {
        let r = root(&mut up, t[0].index());
        groups.entry(r).or_default().push(*t);
    }
    groups.values().filter_map(|g| compact(p, g)).collect()
}
#[path = "../tests/common/mod.rs"]
pub mod shapes;
/// A mesh file, or gen:N for limbs with noise of n per side
pub fn load(path: &str) -> (Vec<DVec3>, Vec<[VertexId; 3]>) {
    if let Some(n) = path.strip_prefix("gen:") {
        let mesh = shapes::limbs(2, n.parse().unwrap());
        let mut r = orbflow_geometry::random::Random::new(1);
        let p = mesh
            .positions()
            .iter()
            .map(|&p| p + 0.002 * DVec3::new(r.unit(), r.unit(), r.unit()))
            .collect();
        return (p, mesh.faces().to_vec());
    }
    read(path)
}
fn main() {
    let (mut ok, mut no) = (0, 0);
    for path in std::env::args().skip(1) {
        let (p, f) = load(&path);
        for mesh in parts(&p, &f) {
            let n = mesh.n_vertices();
            if !(mesh.is_closed() && mesh.euler_number() == 2 && n >= 4) {
                no += 1;
                continue;
            }
            let (c, t) = (cpu(), Instant::now());
            let h = collapse_to_tetrahedron(mesh, &Progress::none()).unwrap();
            let (c, t) = (cpu() - c, t.elapsed());
            h.check().unwrap();
            ok += 1;
            if n > 2000 {
                let mean =
                    h.undone().map(|c| c.ring.len()).sum::<usize>() as f64 / h.n_collapses() as f64;
                println!(
                    "{path} n {n} rounds {} cpu {c:.3} wall {:.1} ms, {:.2} us/vertex, mean ring {mean:.2} max {}",
                    h.n_rounds(),
                    t.as_secs_f64() * 1e3,
                    t.as_secs_f64() * 1e6 / n as f64,
                    h.undone().map(|c| c.ring.len()).max().unwrap()
                );
            }
        }
    }
    println!("{ok} done, {no} not closed genus 0");
}
