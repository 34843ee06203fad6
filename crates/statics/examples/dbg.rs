use voxsoft_solid::{Body, Clamp, HyperelasticMaterial, Load, Mesh, Problem};
use voxsoft_statics::{Settings, solve};
use voxsoft_voxel::{Grid, tet_mesh};
fn main() {
    let n = 20usize; let h=0.005;
    let mut grid = Grid::empty([n, 2, 2], [0.0; 3], h, u64::MAX).unwrap();
    grid.fill_box([0.0; 3], [n as f64*h, 2.0*h, 2.0*h], 1);
    let tets = tet_mesh(&grid, u64::MAX).unwrap();
    let mesh = Mesh {
        tet_part: vec![0; tets.tets.len()],
        tet_block: (0..tets.tets.len() as u32).map(|t| t / 5).collect(),
        tets: tets.tets.iter().map(|t| t.map(|v| v as u32)).collect(),
        vertices: tets.vertices,
        ..Mesh::default()
    };
    let rubber = HyperelasticMaterial::neo_hookean(60e3, 0.49, 1070.0).unwrap();
    let body = Body::new(&mesh, &[rubber]).unwrap();
    let wall = (0..mesh.vertices.len() as u32).filter(|&v| mesh.vertices[v as usize][0] < 0.0101);
    let loads = vec![Load::gravity([0.0, 0.0, -9.81])];
    let problem = Problem::new(body, vec![Clamp::fixed(wall.collect())], loads, None).unwrap();
    let t = std::time::Instant::now();
    let answer = solve(&problem, None, &Settings::default(), &mut |p| {
        println!("{} s={} r={:e} {}", p.iterations, p.factor, p.residual, p.converged);
        std::ops::ControlFlow::Continue(())});
    println!("{:?} {} {} {:?} {:?}", answer.status, answer.residual, answer.stable, answer.limit, t.elapsed());
    let v = (0..mesh.vertices.len()).filter(|&v| mesh.vertices[v][0] > 0.0999);
    for v in v { let (x, r) = (answer.positions[v], mesh.vertices[v]); println!("{:?} {:.3} {:.3} {:.3}", r, (x[0]-r[0])*1e3, (x[1]-r[1])*1e3, (x[2]-r[2])*1e3); }
}
