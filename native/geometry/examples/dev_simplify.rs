//! dev
#[path = "dev_down.rs"]
#[allow(dead_code)]
mod dev_down;
use dev_down::*;
use orbflow_geometry::decimate::*;
use orbflow_geometry::progress::Progress;
use std::io::Write;
fn main() {
    let mut args = std::env::args().skip(1);
    let n_faces: usize = args.next().unwrap().parse().unwrap();
    let out = args.next().unwrap();
    for path in args {
        let (p, f) = load(&path);
        let Some(mesh) = compact(&p, &f) else {
            println!("{path} not manifold");
            continue;
        };
        let c = cpu();
        let t = std::time::Instant::now();
        let s = simplify(
            &mesh,
            &Settings {
                n_faces,
                ..Default::default()
            },
            &Progress::none(),
        )
        .unwrap();
        println!(
            "{path} cpu {:.2} wall {:.2} {:?} euler {} {} loops {} {}",
            cpu() - c,
            t.elapsed().as_secs_f64(),
            s.report,
            mesh.euler_number(),
            s.mesh.euler_number(),
            mesh.border_loops().len(),
            s.mesh.border_loops().len()
        );
        if out != "-" {
            let mut w = std::io::BufWriter::new(std::fs::File::create(&out).unwrap());
            for p in s.mesh.positions() {
                writeln!(w, "v {} {} {}", p.x, p.y, p.z).unwrap();
            }
            for f in s.mesh.faces() {
                writeln!(w, "f {} {} {}", f[0].0 + 1, f[1].0 + 1, f[2].0 + 1).unwrap();
            }
        }
    }
    let s = std::fs::read_to_string("/proc/self/status").unwrap();
    println!("{}", s.lines().find(|l| l.starts_with("VmHWM")).unwrap());
}
