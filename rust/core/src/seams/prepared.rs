// SPDX-License-Identifier: MIT OR Apache-2.0
//! A component made ready for the search: its proxy with the costs and the plate, and the way of its seams back to the
//! component.

use super::cost::{Preferences, costs};
use super::cut::Cut;
use super::cut_graph::cut_graph;
use super::edge_mesh::EdgeMesh;
use super::lift::{Lift, Mirrors, image};
use super::openness::openness;
use super::options::{SeamMethod, Symmetry};
use super::plate::Plate;
use super::proxy::{Proxy, nearest_vertices, proxy};
use super::search::{Figures, Problem, Search, Solution, with_mirrored};
use super::symmetry::{MirrorPlane, mirror_plane, mirror_vertices};
use crate::control::Observer;
use crate::error::Error;
use crate::mesh::{Edge, Vertex};
use crate::vector::Vector3;

/// The largest 99th percentile of σ₁/σ₂ is 1 + this · (target − 1).
const PERCENTILE: f64 = 6.0;

/// A symmetric cut is given up where the excess of its shear over 1 exceeds that of the target by this factor.
const MISSED: f64 = 1.15;

/// A symmetric cut is given up where an island is smaller than this share of the area.
const SLIVER: f64 = 0.004;

/// A symmetric cut into several islands is given up where a cut without symmetry is cheaper by this factor.
const CHEAPER: f64 = 1.2;

/// The factor of the cost of a proxy's edge beside which seams are forbidden at one end.
const NEARLY_FORBIDDEN: f64 = 30.0;

/// What the caller wants, on the edges of the component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wishes<'a> {
    pub target: f64,
    /// Factors of the cost of a seam, (e,).
    pub weights: Option<&'a [f64]>,
    pub front: Option<Vector3>,
    pub symmetry: Symmetry,
    pub max_islands: usize,
    pub overlap: bool,
    pub method: SeamMethod,
}

/// The component itself, onto which seams of the proxy are lifted.
pub(super) struct Fine<'a> {
    pub mesh: &'a EdgeMesh,
    /// The cost of a seam along each edge.
    pub cost: Vec<f64>,
    /// The vertex for which each vertex of the proxy stands.
    nearest: Vec<Vertex>,
    /// The mirror image of each vertex, where the triangulation is symmetric.
    mirror: Option<Vec<Vertex>>,
}

/// A component with all that the search needs.
pub(super) struct Prepared<'a> {
    pub proxy: EdgeMesh,
    pub cost: Vec<f64>,
    /// The mirror images of the vertices and edges of the proxy.
    mirror: Option<(Vec<Vertex>, Vec<Edge>)>,
    /// The edge of the component of which each edge of a refined proxy is a part.
    parents: Option<Vec<Option<Edge>>>,
    plate: Plate,
    pub component: Fine<'a>,
    max_islands: usize,
}

impl<'a> Prepared<'a> {
    pub(super) fn new(
        fine: &'a EdgeMesh,
        wishes: &Wishes<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Self, Error> {
        // 1. The proxy
        let plane = match wishes.symmetry {
            Symmetry::Auto => mirror_plane(&fine.mesh),
            Symmetry::Off => None,
        };
        let plane = plane.as_ref();
        let coarse = proxy(&fine.mesh, plane, observer)?;
        let proxy = EdgeMesh::new(coarse.mesh.clone());
        let parents = coarse.halves.as_ref().map(|_| parents(fine, &proxy, &coarse));
        let mirror = coarse.mirror.clone().map(|vertices| (mirrored_edges(&proxy, &vertices), vertices));
        let mirror = mirror.map(|(edges, vertices)| (vertices, edges));
        // 2. The costs
        let sight = openness(&proxy.mesh, coarse.mirror.as_deref());
        let view = View { proxy: &proxy, openness: &sight, plane, is_symmetric: mirror.is_some() };
        let cost = view.proxy_costs(fine, wishes, parents.as_deref());
        let component = view.fine(fine, coarse.nearest, wishes);
        // 3. The plate
        let plate = Plate::new(&proxy)?;
        Ok(Self { proxy, cost, mirror, parents, plate, component, max_islands: wishes.max_islands })
    }

    /// The best cut of the proxy with the predicted shear `aim`; without symmetry where that costs too much.
    pub(super) fn search(
        &mut self,
        wishes: &Wishes<'_>,
        aim: f64,
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        let solution = self.search_once(wishes, aim, observer)?;
        if self.mirror.is_none() {
            return Ok(solution);
        }
        let islands = solution.state.cut.islands(&self.proxy);
        let mean = self.predicted(&solution).mean;
        let is_bad = !islands.are_disks()
            || mean > 1.0 + MISSED * (aim - 1.0)
            || islands.least_area() < SLIVER
            || islands.len() > self.max_islands;
        if !is_bad && islands.len() == 1 {
            return Ok(solution);
        }
        let mirror = self.mirror.take();
        let plain = self.search_once(wishes, aim, observer)?;
        let is_sound = plain.state.cut.islands(&self.proxy).are_disks();
        if is_bad || (is_sound && CHEAPER * plain.price < solution.price) {
            return Ok(plain);
        }
        self.mirror = mirror;
        Ok(solution)
    }

    fn search_once(
        &self,
        wishes: &Wishes<'_>,
        aim: f64,
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        let given = Cut::none(&self.proxy);
        let mut search = Search::new(self.problem(&given, aim, wishes.target));
        match wishes.method {
            SeamMethod::Search => search.run(observer),
            SeamMethod::Cones => search.through_cones(observer).map(|state| search.priced(state)),
        }
    }

    /// A cut for another predicted shear `aim`, from one near to it.
    pub(super) fn go_on(
        &self,
        cut: Cut,
        given: &Cut,
        [aim, target]: [f64; 2],
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        Search::new(self.problem(given, aim, target)).polish(cut, 1, observer)
    }

    /// Edges of the proxy together with their mirror images.
    pub(super) fn with_mirrored(&self, edges: &[Edge]) -> Vec<Edge> {
        with_mirrored(edges, self.mirrored())
    }

    /// The mirror image of each edge of the proxy, if it is symmetric.
    fn mirrored(&self) -> Option<&[Edge]> {
        self.mirror.as_ref().map(|(_, edges)| &edges[..])
    }

    fn problem<'b>(&'b self, given: &'b Cut, aim: f64, target: f64) -> Problem<'b> {
        Problem {
            mesh: &self.proxy,
            plate: &self.plate,
            cost: &self.cost,
            mirror: self.mirrored(),
            given,
            max_islands: self.max_islands,
            target: aim,
            bound: 1.0 + PERCENTILE * (target - 1.0),
        }
    }

    /// The shear that the plate predicts for a solution.
    pub(super) fn predicted(&self, solution: &Solution) -> Figures {
        Figures::of(&self.proxy.areas, &solution.state.shear)
    }

    /// The seams of a cut of the proxy on the component.
    pub(super) fn lifted(&self, cut: &Cut) -> Cut {
        let fine = &self.component;
        if let Some(parents) = &self.parents {
            let edges: Vec<_> = cut.seams().filter_map(|edge| parents[edge]).collect();
            let inner = edges.into_iter().filter(|&edge| !fine.mesh.edges.is_boundary(edge));
            return fine.completed(Cut::none(fine.mesh).with(&inner.collect::<Vec<_>>()));
        }
        let wanted = cut.islands(&self.proxy).len();
        let is_sound = |lifted: &Cut| {
            let islands = lifted.islands(fine.mesh);
            islands.are_disks() && islands.len() == wanted
        };
        let mirrors = fine.mirror.as_ref().zip(self.mirror.as_ref());
        let mirrors = mirrors.map(|(fine, (proxy, _))| Mirrors { fine, proxy });
        let mut lifted = self.lift(mirrors).of(cut);
        if mirrors.is_some() && !is_sound(&lifted) {
            lifted = self.lift(None).of(cut);
        }
        fine.completed(lifted)
    }

    fn lift<'b>(&'b self, mirrors: Option<Mirrors<'b>>) -> Lift<'b> {
        let Fine { mesh, cost, nearest, .. } = &self.component;
        Lift { fine: mesh, proxy: &self.proxy, cost, nearest, mirrors }
    }
}

impl Fine<'_> {
    /// The seams with those that islands lack to be disks.
    fn completed(&self, cut: Cut) -> Cut {
        if cut.islands(self.mesh).are_disks() {
            return cut;
        }
        cut_graph(self.mesh, &self.cost, &cut)
    }
}

/// What all costs of seams have in common.
struct View<'a> {
    proxy: &'a EdgeMesh,
    /// At each vertex of the proxy.
    openness: &'a [f64],
    plane: Option<&'a MirrorPlane>,
    is_symmetric: bool,
}

impl View<'_> {
    fn fine<'b>(&self, mesh: &'b EdgeMesh, nearest: Vec<Vertex>, wishes: &Wishes<'_>) -> Fine<'b> {
        let mirror = self.plane.filter(|_| self.is_symmetric);
        let mirror = mirror.and_then(|plane| mirror_vertices(&mesh.mesh, plane));
        let lacks_image: Option<Vec<_>> = mirror
            .as_ref()
            .map(|mirror| mesh.edges.all().map(|edge| image(mesh, edge, mirror).is_none()).collect());
        let seen_from = nearest_vertices(&mesh.mesh, &self.proxy.mesh);
        let openness: Vec<_> = seen_from.iter().map(|&vertex| self.openness[vertex]).collect();
        let preferences = Preferences {
            openness: Some(&openness),
            plane: self.plane,
            front: wishes.front,
            weights: wishes.weights,
            lacks_image: lacks_image.as_deref(),
        };
        Fine { mesh, cost: costs(mesh, &preferences), nearest, mirror }
    }

    fn proxy_costs(
        &self,
        fine: &EdgeMesh,
        wishes: &Wishes<'_>,
        parents: Option<&[Option<Edge>]>,
    ) -> Vec<f64> {
        let weights = wishes.weights.map(|weights| match parents {
            Some(parents) => parents.iter().map(|edge| edge.map_or(1.0, |edge| weights[edge])).collect(),
            None => carried(fine, weights, self.proxy),
        });
        let preferences = Preferences {
            openness: Some(self.openness),
            plane: self.plane,
            front: wishes.front,
            weights: weights.as_deref(),
            lacks_image: None,
        };
        let mut cost = costs(self.proxy, &preferences);
        for (edge, cost) in self.proxy.edges.all().zip(&mut cost) {
            if parents.is_some_and(|parents| parents[edge].is_none()) {
                *cost = f64::INFINITY;
            }
        }
        cost
    }
}

/// The mirror image of each edge; the edge itself where that is none.
fn mirrored_edges(mesh: &EdgeMesh, vertices: &[Vertex]) -> Vec<Edge> {
    mesh.edges.all().map(|edge| image(mesh, edge, vertices).unwrap_or(edge)).collect()
}

/// The edge of the component of which each edge of the proxy is a part; none where its mirror image is no edge.
fn parents(fine: &EdgeMesh, proxy: &EdgeMesh, coarse: &Proxy) -> Vec<Option<Edge>> {
    let mut parents = vec![None; proxy.n_edges()];
    for half in coarse.halves.iter().flatten() {
        if let Some(edge) = proxy.edges.between(half.edge[0], half.edge[1]) {
            parents[edge] = fine.edges.between(half.of[0], half.of[1]);
        }
    }
    for &[a, b] in &coarse.without_image {
        proxy.edges.between(a, b).into_iter().for_each(|edge| parents[edge] = None);
    }
    parents
}

/// Factors of the edges of a mesh carried to a coarser one: each vertex of that has the mean of the edges near to it,
/// infinite where most of them are; edges have the mean of their ends, and are nearly forbidden where one end is.
fn carried(fine: &EdgeMesh, weights: &[f64], coarse: &EdgeMesh) -> Vec<f64> {
    let nearest = nearest_vertices(&fine.mesh, &coarse.mesh);
    // the sum and the number of finite factors, and the number of infinite ones
    let mut sums = vec![[0.0; 3]; coarse.n_vertices()];
    for (edge, &weight) in fine.edges.all().zip(weights) {
        for vertex in fine.edges.ends(edge) {
            let sum = &mut sums[nearest[vertex]];
            if weight.is_finite() {
                sum[0] += weight;
                sum[1] += 1.0;
            } else {
                sum[2] += 1.0;
            }
        }
    }
    let factor = |vertex: Vertex| match sums[vertex] {
        [_, finite, infinite] if infinite > finite => f64::INFINITY,
        [sum, finite, _] if finite > 0.0 => sum / finite,
        _ => 1.0,
    };
    let of_edge = |edge| match coarse.edges.ends(edge).map(factor) {
        [a, b] if a.is_infinite() && b.is_infinite() => f64::INFINITY,
        [a, b] if a.is_infinite() || b.is_infinite() => NEARLY_FORBIDDEN * a.min(b),
        [a, b] => 0.5 * (a + b),
    };
    coarse.edges.all().map(of_edge).collect()
}
