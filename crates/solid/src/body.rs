//! The body: masses and constraints of a tetrahedral mesh with materials.
//!
//! Long because the shares of edges and the checks of a mesh, used nowhere else, stand with the body they serve.
//!
//! # The share of an edge
//!
//! An edge inside the body is worth a full spring, one on its surface less, or a thin wall would be
//! too stiff and the material would change with the voxel size. The share `s` is the sum of the
//! dihedral angles of the tetrahedra around the edge over a full turn: 1 inside, 1/4 at the outer
//! edge of a single voxel, 1/2 for a face diagonal on the surface. Written per voxel, every voxel
//! carries the same energy density, and materials meet at an interface in proportion:
//! `k = ℓ Σ_tets E_e(tet) θ(tet)/2π`.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

use crate::element::coarse::Coarse;
use crate::element::hex8::Within;
use crate::element::ties::Ties;
use crate::hyperelastic::LocalMaterials;
use crate::lattice::color::{color_order, interleave};
use crate::lattice::material::LatticeConstants;
use crate::matrix::{IDENTITY, Mat3, apply_transposed};
use crate::term::Term;
use crate::terms::{Attachment, Edge, Edges, Hex8s, Membranes, Tet, Tets};
use crate::vector::{Vec3, add, cross, dot, norm, scale, sub};
use crate::{
    Contact, Eigenstrain, Filling, Hex8, History, HyperelasticMaterial, LatticeMaterial, Material,
    Membrane, ProblemError, WarpingModes, element::free_faces, lattice::cube,
};

/// The six edges of a tetrahedron and, for each, the two vertices opposite to it.
pub(crate) const TET_EDGES: [([usize; 2], [usize; 2]); 6] = [
    ([0, 1], [2, 3]),
    ([0, 2], [3, 1]),
    ([0, 3], [1, 2]),
    ([1, 2], [0, 3]),
    ([1, 3], [2, 0]),
    ([2, 3], [0, 1]),
];

/// Largest relative difference between an edge and that of a cube for which angles need no arc tangent: positions are
/// products of integers and the voxel size, exact to rounding.
const CUBE_SLACK: f64 = 1e-9;

/// The plain arrays that a body is built from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Positions at rest in m.
    pub vertices: Vec<Vec3>,
    /// Four vertices each, positive volume.
    pub tets: Vec<[u32; 4]>,
    /// The material of each tetrahedron, an index into the list of materials.
    pub tet_part: Vec<u8>,
    /// The block of each tetrahedron (its voxel); blocks are numbered from 0 without gaps.
    pub tet_block: Vec<u32>,
    /// The part of each block that is filled with material, above zero; empty means all of it.
    /// Masses and all stiffness scale with it.
    pub block_fraction: Vec<f64>,
    /// Distribution of the material within each block; empty means uniform. Hyperelastic voxels bend accordingly;
    /// lattices and masses ignore it.
    pub block_filling: Vec<Filling>,
    /// The directions of each block's edges, unit vectors row by row; empty means x, y and z.
    pub block_axes: Vec<Mat3>,
    /// Groups of eight blocks of a hyperelastic material that are one element, a cube of twice the side; all such cubes
    /// lie on one grid of that size.
    pub coarse: Vec<[u32; 8]>,
    /// Membranes on triangles.
    pub membranes: Vec<Membrane>,
    /// Attachments, such as springs.
    pub attachments: Vec<Attachment>,
    /// Point masses (kg) on vertices besides those of the material: of rigid objects, whose vertices no tetrahedron
    /// has.
    pub point_masses: Vec<(u32, f64)>,
}

/// A body: lumped masses, and the terms of its energy.
///
/// Constraints are solved in chunks of several blocks (voxels) of one color; blocks of one color
/// share no vertex. Within a chunk, constraints of different blocks alternate. An edge belongs to
/// the first block that holds it.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    rest: Vec<Vec3>,
    masses: Vec<f64>,
    edges: Edges,
    tets: Tets,
    voxels: Vec<[u32; 8]>,
    hex8s: Hex8s,
    coarse: Coarse,
    membranes: Membranes,
    attachments: Vec<Attachment>,
    foreign: Vec<Foreign>,
    chunk_edges: Vec<u32>,
    chunk_tets: Vec<u32>,
    colors: Vec<u32>,
    unit_strain_force: f64,
    unit_strain_energy: f64,
    size: f64,
}

impl Body {
    /// Builds the body; `materials[mesh.tet_part[t]]` is the material of tetrahedron `t`.
    ///
    /// Blocks of a hyperelastic material must be voxels, cubes of five tetrahedra along [`Mesh::block_axes`].
    pub fn new<M: Clone + Into<Material>>(
        mesh: &Mesh,
        materials: &[M],
    ) -> Result<Self, ProblemError> {
        let materials: Vec<Material> = materials.iter().cloned().map(Into::into).collect();
        check(mesh, materials.len())?;
        let order = color_order(mesh);
        let volumes: Vec<f64> = mesh
            .tets
            .iter()
            .map(|t| volume(&mesh.vertices, *t))
            .collect();
        if let Some(tet) = volumes.iter().position(|v| v.is_nan() || *v <= 0.0) {
            return Err(ProblemError::RestVolume {
                tet,
                volume: volumes[tet],
            });
        }

        let mut masses = other_masses(mesh);
        let (mut voxels, mut hex8s) = (Vec::new(), Vec::new());
        let mut hex8_of = vec![u32::MAX; mesh.tets.len()];
        let mut local = LocalMaterials::beside(materials.len());
        // Stiffness of the material bonded to membranes: Young's modulus times size, the least around each vertex, N/m.
        let mut behind = vec![f64::INFINITY; mesh.vertices.len()];
        let mut found: Vec<Edge> = Vec::new();
        let mut edges_from = EdgesFrom::new(mesh.vertices.len());
        let (mut tets, mut edge_order) = (Vec::with_capacity(mesh.tets.len()), Vec::new());
        let (mut chunk_edges, mut chunk_tets) = (vec![0], vec![0]);
        for chunk in &order.chunks {
            let mut owned: Vec<Vec<usize>> = Vec::with_capacity(chunk.len());
            let mut volume_constraints: Vec<Vec<Tet>> = Vec::with_capacity(chunk.len());
            for block in chunk {
                let first_new = found.len();
                let side = libm::cbrt(block.iter().map(|&t| volumes[t]).sum());
                let fraction = fraction_of(mesh, block);
                let mut constraints = Vec::with_capacity(block.len());
                let cube = cube::corners(mesh, block, axes_of(mesh, block).as_ref());
                let young = materials[usize::from(mesh.tet_part[block[0]])].young(side);
                for &vertex in block.iter().flat_map(|&t| &mesh.tets[t]) {
                    let least = &mut behind[vertex as usize];
                    *least = least.min(young * side);
                }
                for &t in block {
                    let Material::Lattice(material) = materials[usize::from(mesh.tet_part[t])]
                    else {
                        continue;
                    };
                    for vertex in mesh.tets[t] {
                        masses[vertex as usize] += fraction * material.density() * volumes[t] / 4.0;
                    }
                    let mut constraint = volume_constraint(mesh.tets[t], volumes[t], material);
                    constraint.stiffness *= fraction;
                    constraints.push(constraint);
                    for (pair, opposite) in TET_EDGES {
                        let ends = pair.map(|corner| mesh.tets[t][corner]);
                        let apexes = opposite.map(|corner| mesh.tets[t][corner]);
                        let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                        let index = edges_from.find_or_add(key);
                        if index == found.len() {
                            found.push(unstressed_edge(&mesh.vertices, key));
                        }
                        let edge = &mut found[index];
                        let share = cube
                            .and_then(|(_, side)| share_in_cube(edge.length, volumes[t], side))
                            .unwrap_or_else(|| dihedral(&mesh.vertices, key, apexes) / TAU);
                        edge.stiffness += fraction
                            * edge_stiffness(material, edge.length, share, side)
                                .ok_or(ProblemError::NotVoxels { tet: t })?;
                    }
                }
                voxels.extend(cube.map(|(corners, _)| corners));
                if let Material::Hyperelastic(material) =
                    &materials[usize::from(mesh.tet_part[block[0]])]
                {
                    let (vertices, side) = cube.ok_or(ProblemError::NotCubes { tet: block[0] })?;
                    let part = u32::from(mesh.tet_part[block[0]]);
                    let filling = filling_of(mesh, block);
                    let mut hex8 = Hex8 {
                        vertices,
                        material: part,
                        side,
                        fraction,
                        filling,
                        warping: WarpingModes::NONE,
                        peak: material.first_peak(),
                    };
                    if material.is_local() {
                        let axes = axes_of(mesh, block).unwrap_or(IDENTITY);
                        let ends = [0, 7].map(|c| mesh.vertices[vertices[c] as usize]);
                        let shift = apply_transposed(&axes, scale(side / 2.0, filling.shift));
                        let place = add(scale(0.5, add(ends[0], ends[1])), shift);
                        let number = mesh.tet_block[block[0]] as usize;
                        let here = material.at(number, place, side, &axes)?;
                        hex8.material = local.number(part, here);
                    }
                    // An eighth for each corner: the shares of the tetrahedra differ five to one between
                    // corners, which an element's modes would feel as a rattle.
                    for vertex in vertices {
                        masses[vertex as usize] +=
                            material.density() * (fraction * side.powi(3)) / 8.0;
                    }
                    hex8_of[mesh.tet_block[block[0]] as usize] = hex8s.len() as u32;
                    hex8s.push(hex8);
                }
                owned.push((first_new..found.len()).collect());
                volume_constraints.push(constraints);
            }
            tets.extend(interleave(&volume_constraints));
            edge_order.extend(interleave(&owned));
            chunk_edges.push(edge_order.len() as u32);
            chunk_tets.push(tets.len() as u32);
        }
        let (mut coarse, mut ties) = (Coarse::default(), Ties::default());
        if !mesh.coarse.is_empty() {
            let number = |block: u32| hex8_of.get(block as usize).copied().unwrap_or(u32::MAX);
            let groups: Vec<[u32; 8]> = mesh.coarse.iter().map(|g| g.map(number)).collect();
            (coarse, hex8s, ties) = Coarse::of(hex8s, &groups, masses.len())?;
            ties.hand_over_numbers(&mut masses);
        }
        let edges: Vec<Edge> = edge_order.into_iter().map(|index| found[index]).collect();
        // The list of hyperelastic materials keeps the indices of the parts; the entry of a lattice is filled with that
        // of a neighbor, which no element uses. Materials that differ from voxel to voxel follow.
        let hyperelastic: Vec<HyperelasticMaterial> = if hex8s.is_empty() {
            Vec::new()
        } else {
            let some = materials.iter().find_map(Material::hyperelastic);
            let each = |m: &Material| m.hyperelastic().or(some).cloned();
            materials
                .iter()
                .filter_map(each)
                .chain(local.materials)
                .collect()
        };
        let mut membranes = Membranes(mesh.membranes.clone());
        membranes.set_behind(&behind);
        let mut attachments = mesh.attachments.clone();
        for attachment in &mut attachments {
            attachment.set_behind(&behind);
        }
        let mut body = Self {
            unit_strain_force: 0.0,
            unit_strain_energy: 0.0,
            size: size_of(mesh),
            rest: mesh.vertices.clone(),
            masses,
            edges: Edges(edges),
            tets: Tets(tets),
            voxels,
            hex8s: Hex8s::new(hex8s, hyperelastic, ties),
            coarse,
            membranes,
            attachments,
            foreign: Vec::new(),
            chunk_edges,
            chunk_tets,
            colors: order.colors,
        };
        body.measure();
        body.warp_unless(&vec![[false; 3]; mesh.vertices.len()], &[]);
        Ok(body)
    }

    /// Sets the force and the energy of a strain of one from the present stiffness.
    fn measure(&mut self) {
        let stuff = |hex8: &Hex8| self.material_of(hex8);
        let stiffness = |hex8: &Hex8| stuff(hex8).young() * hex8.volume(stuff(hex8));
        let hex8s = &self.hex8s.hex8s;
        let edges = &self.edges.0;
        let hex8_energy = hex8s.iter().map(stiffness).sum::<f64>();
        let edge_energy = edges
            .iter()
            .map(|e| e.stiffness * e.length.powi(2))
            .sum::<f64>();
        let mut strain_forces = edge_forces(edges, self.masses.len());
        for hex8 in hex8s {
            for vertex in hex8.vertices {
                strain_forces[vertex as usize] += stiffness(hex8) / hex8.free_side(stuff(hex8));
            }
        }
        self.unit_strain_force = strain_forces.iter().map(|f| f * f).sum::<f64>().sqrt();
        self.unit_strain_energy = (edge_energy + hex8_energy) / 2.0;
    }

    /// Sets masses (kg), the stiffness of edges (N/m) and tetrahedra (Pa/m³), and the filled fractions of the
    /// hyperelastic voxels of the mesh.
    pub(crate) fn fill(
        &mut self,
        masses: Vec<f64>,
        edges: &[f64],
        tets: &[f64],
        fractions: &[f64],
    ) {
        self.masses = masses;
        for (edge, stiffness) in self.edges.0.iter_mut().zip(edges) {
            edge.stiffness = *stiffness;
        }
        for (tet, stiffness) in self.tets.0.iter_mut().zip(tets) {
            tet.stiffness = *stiffness;
        }
        if self.coarse.is_empty() {
            for (hex8, fraction) in self.hex8s.hex8s.iter_mut().zip(fractions) {
                hex8.fraction = *fraction;
            }
        } else {
            self.coarse.fill(fractions, &mut self.hex8s.hex8s);
        }
        self.measure();
    }

    /// Lets the free faces of hyperelastic voxels warp, except those `held` (axes for each vertex). `pressed` are the
    /// triangles under pressure.
    pub(crate) fn warp_unless(&mut self, held: &[[bool; 3]], pressed: &[[u32; 3]]) {
        let (small, materials) = (self.small_hex8s(), &self.hex8s.materials);
        let membranes = &self.membranes.0;
        let (mut faces, mut edges) =
            free_faces::faces_of(small, materials, &self.voxels, membranes, held, pressed);
        if !self.coarse.is_empty() {
            (faces, edges) = self.coarse.merged(&faces, &edges);
        }
        for ((hex8, faces), edges) in self.hex8s.hex8s.iter_mut().zip(&faces).zip(&edges) {
            let poisson = materials[hex8.material as usize].poisson();
            hex8.warping = match faces {
                Some(faces) if free_faces::is_full(hex8) && !hex8.filling.surface.is_oblique() => {
                    WarpingModes::of(faces).with_reentrant_edges(edges, poisson)
                }
                Some(faces) => {
                    WarpingModes::of_cut(faces, &hex8.filling).with_reentrant_edges(edges, poisson)
                }
                None => WarpingModes::SURFACE,
            };
        }
    }

    /// Sets the peak isochoric energies (J/m³) of voxels that soften.
    pub(crate) fn set_peaks(&mut self, peaks: &[f64]) {
        self.hex8s.set_peaks(peaks);
    }

    /// Sets the response of hyperelastic voxels within a time step; `None` for the elastic response.
    pub(crate) fn set_within(&mut self, within: Option<Vec<Within>>) {
        self.hex8s.set_within(within);
    }

    /// Replaces the history of the free stretches with a number; returns whether there are any.
    pub(crate) fn set_growth(
        &mut self,
        number: usize,
        history: &History,
    ) -> Result<bool, ProblemError> {
        let mut found = false;
        for material in &mut self.hex8s.materials {
            found |= material.set_history(number, history)?;
        }
        Ok(found)
    }

    /// Sets the free stretch of all materials to that of a time (s).
    pub(crate) fn begin(&mut self, time: f64) {
        for material in &mut self.hex8s.materials {
            material.begin(time);
        }
    }

    /// The time in s after which no free stretch changes.
    pub fn eigenstrain_end(&self) -> f64 {
        self.eigenstrains()
            .map(Eigenstrain::end)
            .fold(0.0, f64::max)
    }

    /// The times in s of the histories of all free stretches.
    pub(crate) fn eigenstrain_times(&self) -> impl Iterator<Item = f64> {
        self.eigenstrains().flat_map(Eigenstrain::times)
    }

    fn eigenstrains(&self) -> impl Iterator<Item = &Eigenstrain> {
        let materials = self.hex8s.materials.iter();
        materials.flat_map(HyperelasticMaterial::eigenstrains)
    }

    /// Positions at rest in m.
    pub fn rest(&self) -> &[Vec3] {
        &self.rest
    }

    /// The lumped mass of every vertex in kg: a quarter of each tetrahedron of the lattice around it, an
    /// eighth of each hyperelastic voxel.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// The mass of the body in kg.
    pub fn total_mass(&self) -> f64 {
        self.masses.iter().sum()
    }

    /// Adds a term of a kind that is not an [`Attachment`].
    pub fn attach(&mut self, term: Arc<dyn Term>) -> Result<(), ProblemError> {
        term.check(self.rest.len())?;
        self.foreign.push(Foreign::Term(term));
        Ok(())
    }

    /// Adds the contact term.
    pub(crate) fn touch(&mut self, contact: Box<dyn Contact>) -> Result<(), ProblemError> {
        contact.check(self.rest.len())?;
        self.foreign.push(Foreign::Contact(contact));
        Ok(())
    }

    /// The contact term, if there is one.
    pub fn contact(&self) -> Option<&dyn Contact> {
        self.foreign.iter().find_map(|foreign| match foreign {
            Foreign::Contact(contact) => Some(&**contact),
            Foreign::Term(_) => None,
        })
    }

    /// Mutable access to the contact term, so that it can update its memory.
    pub(crate) fn contact_mut(&mut self) -> Option<&mut Box<dyn Contact>> {
        self.foreign.iter_mut().find_map(|foreign| match foreign {
            Foreign::Contact(contact) => Some(contact),
            Foreign::Term(_) => None,
        })
    }

    /// Removes the contact term, with its place among the terms.
    pub(crate) fn take_contact(&mut self) -> Option<(usize, Box<dyn Contact>)> {
        let is_contact = |foreign: &Foreign| matches!(foreign, Foreign::Contact(_));
        let place = self.foreign.iter().position(is_contact)?;
        match self.foreign.remove(place) {
            Foreign::Contact(contact) => Some((place, contact)),
            Foreign::Term(_) => None,
        }
    }

    /// Puts a contact term back to its place.
    pub(crate) fn put_contact(&mut self, (place, contact): (usize, Box<dyn Contact>)) {
        self.foreign.insert(place, Foreign::Contact(contact));
    }

    /// All terms of the energy, block by block.
    pub fn terms(&self) -> impl Iterator<Item = &dyn Term> {
        let own: [&dyn Term; 4] = [&self.edges, &self.tets, &self.hex8s, &self.membranes];
        own.into_iter().chain(self.attached())
    }

    /// All terms but hyperelastic voxels, whose response within a step depends on more than positions
    /// ([`crate::elastic::respond`]).
    pub fn terms_but_hex8s(&self) -> impl Iterator<Item = &dyn Term> {
        let own: [&dyn Term; 3] = [&self.edges, &self.tets, &self.membranes];
        own.into_iter().chain(self.attached())
    }

    /// All terms but membranes, whose stiffness some solvers treat separately.
    pub fn terms_but_membranes(&self) -> impl Iterator<Item = &dyn Term> {
        let own: [&dyn Term; 3] = [&self.edges, &self.tets, &self.hex8s];
        own.into_iter().chain(self.attached())
    }

    /// Terms that couple vertices which need not share a voxel: membranes and attached terms.
    pub fn terms_beyond_voxels(&self) -> impl Iterator<Item = &dyn Term> {
        let own: [&dyn Term; 1] = [&self.membranes];
        own.into_iter().chain(self.attached())
    }

    /// The attached terms: those not built from the mesh.
    pub fn attached(&self) -> impl Iterator<Item = &dyn Term> {
        let own = self.attachments.iter().map(|attachment| &**attachment);
        own.chain(self.foreign.iter().map(Foreign::term))
    }

    /// All hyperelastic voxels as one block.
    pub fn hex8_term(&self) -> &Hex8s {
        &self.hex8s
    }

    /// Ties of the hanging nodes: which vertices follow others.
    pub fn ties(&self) -> &Ties {
        &self.hex8s.ties
    }

    /// The hyperelastic voxels of the mesh: those of [`Body::hex8s`], but with the eight small ones in place of each
    /// coarse element.
    pub fn small_hex8s(&self) -> &[Hex8] {
        if self.coarse.is_empty() {
            &self.hex8s.hex8s
        } else {
            &self.coarse.small
        }
    }

    /// Index in [`Body::hex8s`] of the element that a voxel of the mesh is, or is a part of.
    pub fn element_of(&self, small: usize) -> usize {
        let element = self.coarse.element.get(small);
        element.map_or(small, |element| *element as usize)
    }

    /// All membranes as one block.
    pub fn membrane_term(&self) -> &Membranes {
        &self.membranes
    }

    /// All edge constraints, chunk after chunk.
    pub fn edges(&self) -> &[Edge] {
        &self.edges.0
    }

    /// All volume constraints, chunk after chunk.
    pub fn tets(&self) -> &[Tet] {
        &self.tets.0
    }

    /// The corners of every block that is a cube along the axes, of any material, in the order of the
    /// blocks' colors: corner `c` is at `(c >> 2 & 1, c >> 1 & 1, c & 1)`.
    pub fn voxels(&self) -> &[[u32; 8]] {
        &self.voxels
    }

    /// All hyperelastic voxels, blocks of one color after the other.
    pub fn hex8s(&self) -> &[Hex8] {
        &self.hex8s.hex8s
    }

    /// The material of a hyperelastic voxel.
    pub fn material_of(&self, hex8: &Hex8) -> &HyperelasticMaterial {
        self.hex8s.material_of(hex8)
    }

    /// All membranes.
    pub fn membranes(&self) -> &[Membrane] {
        &self.membranes.0
    }

    /// The chunks in the order of solution: the ranges of their edges and tetrahedra.
    pub fn chunks(&self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + '_ {
        let range = |ends: &[u32], i: usize| ends[i] as usize..ends[i + 1] as usize;
        (0..self.chunk_tets.len() - 1)
            .map(move |i| (range(&self.chunk_edges, i), range(&self.chunk_tets, i)))
    }

    /// End of each color in [`Body::chunks`]: chunks of one color share no vertex.
    pub fn colors(&self) -> &[u32] {
        &self.colors
    }

    /// The norm over vertices of the elastic forces at a strain of one, N: a scale of force that does not need a load.
    pub fn unit_strain_force(&self) -> f64 {
        self.unit_strain_force
    }

    /// The energy of the body at a strain of one, in J.
    pub fn unit_strain_energy(&self) -> f64 {
        self.unit_strain_energy
    }

    /// Diagonal of the bounding box of the tetrahedra at rest, m: the length scale of motion.
    pub fn size(&self) -> f64 {
        self.size
    }
}

/// A term of a type defined outside this module.
#[derive(Debug)]
enum Foreign {
    /// A term without memory, which copies share.
    Term(Arc<dyn Term>),
    /// The contact term with its memory.
    Contact(Box<dyn Contact>),
}

impl Foreign {
    fn term(&self) -> &dyn Term {
        match self {
            Self::Term(term) => &**term,
            Self::Contact(contact) => &**contact,
        }
    }
}

impl Clone for Foreign {
    fn clone(&self) -> Self {
        match self {
            Self::Term(term) => Self::Term(Arc::clone(term)),
            Self::Contact(contact) => Self::Contact(contact.boxed()),
        }
    }
}

/// Two foreign terms are equal if they are the same object, or contact with equal memory.
impl PartialEq for Foreign {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Term(a), Self::Term(b)) => Arc::ptr_eq(a, b),
            (Self::Contact(a), Self::Contact(b)) => a.memory() == b.memory(),
            _ => false,
        }
    }
}

/// The edges from each vertex to higher-numbered ones, a dozen at most in a mesh of voxels, as linked lists.
struct EdgesFrom {
    /// The last edge from each vertex.
    last: Vec<u32>,
    /// The other end of each edge, and the edge before it in the list.
    edges: Vec<(u32, u32)>,
}

impl EdgesFrom {
    const NONE: u32 = u32::MAX;

    fn new(vertices: usize) -> Self {
        Self {
            last: vec![Self::NONE; vertices],
            edges: Vec::new(),
        }
    }

    /// The number of an edge, which is the next one if it is new.
    fn find_or_add(&mut self, [low, high]: [u32; 2]) -> usize {
        let last = &mut self.last[low as usize];
        let mut at = *last;
        while at != Self::NONE {
            let (end, before) = self.edges[at as usize];
            if end == high {
                return at as usize;
            }
            at = before;
        }
        self.edges.push((high, *last));
        *last = self.edges.len() as u32 - 1;
        self.edges.len() - 1
    }
}

/// The masses of all vertices in kg that no tetrahedron brings.
pub(crate) fn other_masses(mesh: &Mesh) -> Vec<f64> {
    let mut masses = vec![0.0; mesh.vertices.len()];
    for membrane in &mesh.membranes {
        membrane.add_mass(&mut masses);
    }
    for attachment in &mesh.attachments {
        attachment.add_masses(&mut masses);
    }
    for &(vertex, mass) in &mesh.point_masses {
        masses[vertex as usize] += mass;
    }
    masses
}

fn check(mesh: &Mesh, materials: usize) -> Result<(), ProblemError> {
    let expected = mesh.tets.len();
    for (what, got) in [
        ("parts of tetrahedra", mesh.tet_part.len()),
        ("blocks of tetrahedra", mesh.tet_block.len()),
    ] {
        if got != expected {
            return Err(ProblemError::Length {
                what,
                got,
                expected,
            });
        }
    }
    if mesh
        .vertices
        .iter()
        .flatten()
        .any(|value| !value.is_finite())
    {
        return Err(ProblemError::NotFinite {
            what: "the vertices",
        });
    }
    let in_range = |what, index: usize, count: usize| {
        if index < count {
            Ok(())
        } else {
            Err(ProblemError::Index { what, index, count })
        }
    };
    for tet in &mesh.tets {
        for &vertex in tet {
            in_range(
                "vertex of a tetrahedron",
                vertex as usize,
                mesh.vertices.len(),
            )?;
        }
    }
    for &part in &mesh.tet_part {
        in_range("material of a tetrahedron", usize::from(part), materials)?;
    }
    for &block in &mesh.tet_block {
        in_range("block of a tetrahedron", block as usize, expected)?;
    }
    for &value in &mesh.block_fraction {
        if !(value > 0.0 && value.is_finite()) {
            let what = "part of a voxel that is filled";
            return Err(ProblemError::NotPositive { what, value });
        }
    }
    let blocks = mesh.tet_block.iter().max().map_or(0, |&b| b as usize + 1);
    for (what, got) in [
        ("filled parts of blocks", mesh.block_fraction.len()),
        ("directions of blocks", mesh.block_axes.len()),
    ] {
        if got != 0 && got != blocks {
            return Err(ProblemError::Length {
                what,
                got,
                expected: blocks,
            });
        }
    }
    for filling in &mesh.block_filling {
        for value in filling.spread {
            if !(value > 0.0 && value.is_finite()) {
                let what = "spread of a voxel's material";
                return Err(ProblemError::NotPositive { what, value });
            }
        }
    }
    if !mesh.block_filling.is_empty() && mesh.block_filling.len() != mesh.block_fraction.len() {
        return Err(ProblemError::Length {
            what: "fillings of blocks",
            got: mesh.block_filling.len(),
            expected: mesh.block_fraction.len(),
        });
    }
    for membrane in &mesh.membranes {
        for vertex in membrane.vertices() {
            in_range("vertex of a membrane", vertex as usize, mesh.vertices.len())?;
        }
    }
    for &(vertex, value) in &mesh.point_masses {
        in_range("vertex of a mass", vertex as usize, mesh.vertices.len())?;
        if !(value > 0.0 && value.is_finite()) {
            let what = "a mass on a vertex in kg";
            return Err(ProblemError::NotPositive { what, value });
        }
    }
    mesh.attachments
        .iter()
        .try_for_each(|attachment| attachment.check(mesh.vertices.len()))
}

/// The filled part of a block, given by its tetrahedra.
pub(crate) fn fraction_of(mesh: &Mesh, block: &[usize]) -> f64 {
    let index = mesh.tet_block[block[0]] as usize;
    mesh.block_fraction.get(index).copied().unwrap_or(1.0)
}

/// The edge directions of a block, given by its tetrahedra; `None` for x, y and z.
pub(crate) fn axes_of(mesh: &Mesh, block: &[usize]) -> Option<Mat3> {
    let index = mesh.tet_block[block[0]] as usize;
    mesh.block_axes.get(index).copied()
}

/// The distribution of material in a block, given by its tetrahedra.
fn filling_of(mesh: &Mesh, block: &[usize]) -> Filling {
    let index = mesh.tet_block[block[0]] as usize;
    *mesh.block_filling.get(index).unwrap_or(&Filling::FULL)
}

/// The diagonal of the bounding box of all tetrahedra, of all vertices if there are none, m.
fn size_of(mesh: &Mesh) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let mut take = |p: Vec3| {
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    };
    if mesh.tets.is_empty() {
        mesh.vertices.iter().copied().for_each(&mut take);
    }
    let used = mesh.tets.iter().flatten();
    used.for_each(|v| take(mesh.vertices[*v as usize]));
    norm(sub(high, low))
}

/// The signed volume of a tetrahedron in m³.
pub(crate) fn volume(vertices: &[Vec3], tet: [u32; 4]) -> f64 {
    let [a, b, c, d] = tet.map(|v| vertices[v as usize]);
    dot(sub(b, a), cross(sub(c, a), sub(d, a))) / 6.0
}

pub(crate) fn volume_constraint(vertices: [u32; 4], volume: f64, material: LatticeMaterial) -> Tet {
    let stiffness = match material.constants() {
        LatticeConstants::Moduli { bulk, .. } => bulk / volume,
        LatticeConstants::Compliances { volume, .. } => 1.0 / volume,
    };
    Tet {
        vertices,
        volume,
        stiffness,
    }
}

fn edge_forces(edges: &[Edge], vertices: usize) -> Vec<f64> {
    let mut forces = vec![0.0; vertices];
    for edge in edges {
        for vertex in edge.vertices {
            forces[vertex as usize] += edge.stiffness * edge.length;
        }
    }
    forces
}

fn unstressed_edge(vertices: &[Vec3], [a, b]: [u32; 2]) -> Edge {
    let length = norm(sub(vertices[a as usize], vertices[b as usize]));
    Edge {
        vertices: [a, b],
        length,
        stiffness: 0.0,
    }
}

/// The stiffness that one tetrahedron adds to one of its edges, or `None` for a raw compliance away
/// from a voxel of the given side.
pub(crate) fn edge_stiffness(
    material: LatticeMaterial,
    length: f64,
    share: f64,
    side: f64,
) -> Option<f64> {
    match material.constants() {
        LatticeConstants::Moduli { edge, .. } => Some(edge * length * share),
        LatticeConstants::Compliances { edge, .. } => {
            // A full turn holds four voxels around a cube edge and two around a face diagonal; each
            // voxel brings one edge of the raw compliance.
            let is_length = |multiple: f64| (length / (side * multiple) - 1.0).abs() < 1e-6;
            if is_length(1.0) {
                Some(4.0 * share / edge)
            } else if is_length(f64::sqrt(2.0)) {
                Some(2.0 * share / edge)
            } else {
                None
            }
        }
    }
}

/// The dihedral angle at an edge of the given length (m) over a full turn, for one of the five tetrahedra that
/// fill a cube: one of a third of its volume in the middle, regular, and four at its corners, with three right
/// angles each. `None` for a length that no edge of such a cube has.
pub(crate) fn share_in_cube(length: f64, volume: f64, side: f64) -> Option<f64> {
    let is_length = |multiple: f64| (length / (side * multiple) - 1.0).abs() < CUBE_SLACK;
    if is_length(1.0) {
        Some(0.25)
    } else if !is_length(std::f64::consts::SQRT_2) {
        None
    } else if volume > 0.25 * side.powi(3) {
        Some(f64::acos(1.0 / 3.0) / TAU)
    } else {
        Some(f64::atan(std::f64::consts::SQRT_2) / TAU)
    }
}

/// The angle in rad between the two faces of a tetrahedron that meet at the edge `ends`.
pub(crate) fn dihedral(vertices: &[Vec3], ends: [u32; 2], apexes: [u32; 2]) -> f64 {
    let [a, b] = ends.map(|v| vertices[v as usize]);
    let along = sub(b, a);
    let [n, m] = apexes.map(|v| cross(along, sub(vertices[v as usize], a)));
    libm::atan2(norm(cross(n, m)), dot(n, m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_in_a_cube_are_its_dihedral_angles() {
        let side = 0.3;
        let corner = |c: u32| [c >> 2 & 1, c >> 1 & 1, c & 1].map(|bit| side * f64::from(bit));
        let vertices: Vec<Vec3> = (0..8).map(corner).collect();
        let middle = [0, 3, 5, 6];
        let mut tets = vec![middle];
        // The other four tetrahedra: each of the other corners, with its three neighbors, which are corners of the
        // middle one.
        tets.extend([1, 2, 4, 7].map(|apex: u32| [apex, apex ^ 1, apex ^ 2, apex ^ 4]));
        for tet in tets {
            for (pair, opposite) in TET_EDGES {
                let ends = pair.map(|corner| tet[corner]);
                let length = unstressed_edge(&vertices, ends).length;
                let apexes = opposite.map(|corner| tet[corner]);
                let angle = dihedral(&vertices, ends, apexes);
                let share = share_in_cube(length, volume(&vertices, tet).abs(), side).unwrap();
                // Tolerance: a few roundings of a number below one.
                assert!((share * TAU - angle).abs() < 1e-15, "{tet:?} {pair:?}");
            }
        }
        assert_eq!(share_in_cube(1.1 * side, side.powi(3) / 6.0, side), None);
    }
}
