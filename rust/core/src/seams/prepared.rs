// SPDX-License-Identifier: MIT OR Apache-2.0
//! A component made ready for the search: its proxy with the costs and the plate, and the way of its seams back to the
//! component.

use std::mem::{swap, take};

use super::cost::{Preferences, costs};
use super::cut::Cut;
use super::cut_graph::cut_graph;
use super::edge_mesh::EdgeMesh;
use super::lift::{Lift, Mirrors, image};
use super::merge::merged;
use super::openness::openness;
use super::options::{SeamMethod, Symmetry};
use super::paths::{Paths, far_points_within_reach};
use super::plate::Plate;
use super::progress::{MESSAGE, report};
use super::proxy::{Proxy, coarser, nearest_vertices, proxy};
use super::search::{Figures, Problem, Search, Solution, with_partners};
use super::symmetry::{MirrorPlane, mirror_vertices};
use crate::control::{Observer, Phase, Watch};
use crate::error::Error;
use crate::mesh::ties::on_cost_grid;
use crate::mesh::{Edge, Vertex};
use crate::vector::Vector3;

/// The vertices of the proxy of a preview.
const SKETCH: usize = 500;

/// Meshes of more vertices have such a proxy.
const LARGEST_SKETCH: usize = 800;

/// The largest 99th percentile of σ₁/σ₂ is 1 + this · (target − 1).
const PERCENTILE: f64 = 6.0;

/// A symmetric cut is given up where the excess of its shear over 1 exceeds that of the target by this factor.
const MISSED: f64 = 1.15;

/// A symmetric cut is given up where an island is smaller than this share of the area.
const SLIVER: f64 = 0.004;

/// A symmetric cut into several islands is given up where a cut without symmetry is cheaper by this factor.
const CHEAPER: f64 = 1.2;

/// Where seams are forbidden somewhere, the wanted excess of the shear over 1 is at least that of the least possible shear
/// by this factor, and this part of that asked for: nearer to the least, seams get long for little.
const OVER_LEAST: f64 = 1.3;

/// See [`OVER_LEAST`].
const PART_OF_WANTED: f64 = 0.3;

/// It is at most so many times that asked for: the plate overrates a large shear.
const MOST_EXCESS: f64 = 2.5;

/// The 99th percentile may exceed the least possible one by this factor.
const PERCENTILE_SLACK: f64 = 2.0;

/// What a slit must lower the distortion by over its price: anything, and where seams are forbidden somewhere, so that
/// none run along the rim of such a region for little.
const LEAST_RATE: f64 = 1e-9;
const LEAST_RATE_WHERE_FORBIDDEN: f64 = 0.01;

/// The factor of the cost of a proxy's edge beside which seams are forbidden at one end.
const NEARLY_FORBIDDEN: f64 = 30.0;

/// What the caller wants, on the edges of the component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wishes<'a> {
    pub target: f64,
    /// Factors of the cost of a seam, (e,).
    pub weights: Option<&'a [f64]>,
    /// Given seams that lie alone: they cut the component where others meet them.
    pub alone: &'a [Edge],
    pub front: Option<Vector3>,
    pub symmetry: Symmetry,
    pub max_islands: usize,
    pub overlap: bool,
    /// Whether maps whose outlines may not cross are worth other starts, which take long.
    pub tries_other_starts: bool,
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
    /// Given seams that lie alone.
    alone: Vec<Edge>,
}

/// A component with all that the search needs.
pub(super) struct Prepared<'a> {
    pub proxy: EdgeMesh,
    pub cost: Vec<f64>,
    /// The mirror images of the vertices and edges of the proxy.
    mirror: Option<(Vec<Vertex>, Vec<Edge>)>,
    /// The edge of the component of which each edge of a refined proxy is a part.
    parents: Option<Vec<Option<Edge>>>,
    /// All parts of the edge of which each edge of a refined proxy is a part.
    parts: Option<Vec<Vec<Edge>>>,
    plate: Plate,
    pub component: Fine<'a>,
    /// The openness at each vertex of the proxy, and the mirror plane.
    openness: Vec<f64>,
    plane: Option<MirrorPlane>,
    /// The least figures that allowed seams leave; no bounds where none are forbidden.
    least: Figures,
    least_rate: f64,
    /// What a search without symmetry works with.
    plain: Costs,
    max_islands: usize,
}

/// The costs of seams on the proxy and the component, and the mirror images of vertices and edges.
struct Costs {
    proxy: Vec<f64>,
    component: Vec<f64>,
    mirror: Option<(Vec<Vertex>, Vec<Edge>)>,
    component_mirror: Option<Vec<Vertex>>,
}

impl<'a> Prepared<'a> {
    /// A component with its mirror plane.
    pub(super) fn new(
        fine: &'a EdgeMesh,
        plane: Option<MirrorPlane>,
        wishes: &Wishes<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Self, Error> {
        // 1. The proxy
        report(observer, 0.3)?;
        let mut phase = Phase { whole: &mut *observer, from: 0.3, to: 0.6 };
        let coarse = if wishes.method == SeamMethod::Cones && fine.n_vertices() > LARGEST_SKETCH {
            coarser(&fine.mesh, plane.as_ref(), SKETCH, &mut phase)?
        } else {
            proxy(&fine.mesh, plane.as_ref(), &mut phase)?
        };
        let proxy = EdgeMesh::new(coarse.mesh.clone());
        let parents = coarse.halves.as_ref().map(|_| parents(fine, &proxy, &coarse));
        let mirror = coarse.mirror.clone().map(|vertices| (mirrored_edges(&proxy, &vertices), vertices));
        let mirror = mirror.map(|(edges, vertices)| (vertices, edges));
        let parts = parents.as_ref().map(|parents| parts(parents, fine.n_edges()));
        // 2. The costs
        report(observer, 0.6)?;
        let sight = openness(&proxy.mesh, coarse.mirror.as_deref());
        let view =
            View { proxy: &proxy, openness: &sight, plane: plane.as_ref(), is_symmetric: mirror.is_some() };
        let cost = view.proxy_costs(fine, wishes, parents.as_deref());
        report(observer, 0.8)?;
        let mut component = view.fine(fine, coarse.nearest, wishes);
        let plain = Costs {
            proxy: cost.clone(),
            component: component.cost.clone(),
            mirror: None,
            component_mirror: None,
        };
        let cost = symmetric_costs(cost, mirror.as_ref().map(|(_, edges)| &edges[..]));
        component.make_symmetric(coarse.mirror.as_deref());
        // 3. The plate
        report(observer, 0.9)?;
        let plate = Plate::new(&proxy)?;
        let least = Figures { mean: 1.0, percentile: 0.0 };
        let max_islands = wishes.max_islands;
        let mut prepared = Self {
            proxy,
            cost,
            mirror,
            parents,
            parts,
            plate,
            component,
            openness: sight,
            plane,
            least,
            least_rate: LEAST_RATE,
            plain,
            max_islands,
        };
        if wishes.weights.is_some_and(|weights| weights.contains(&f64::INFINITY)) {
            prepared.least = prepared.least_figures(observer)?;
            prepared.least_rate = LEAST_RATE_WHERE_FORBIDDEN;
        }
        Ok(prepared)
    }

    /// The figures that are left when there is a seam wherever it is allowed.
    fn least_figures(&self, observer: &mut dyn Observer) -> Result<Figures, Error> {
        let allowed: Vec<_> = self.proxy.edges.all().filter(|&edge| self.cost[edge].is_finite()).collect();
        let everywhere = Cut::none(&self.proxy).with(&allowed);
        let watch = Watch::new(observer, 1.0, MESSAGE);
        let workspace = &mut self.plate.workspace();
        let deflection = self.plate.solve(&self.proxy, &everywhere, None, workspace, &watch)?;
        Ok(Figures::of(&self.proxy.areas, &deflection.shear))
    }

    /// The wishes with the target within reach of the allowed seams.
    pub(super) fn within_reach<'w>(&self, wishes: &Wishes<'w>) -> Wishes<'w> {
        let excess = wishes.target - 1.0;
        let near_least = OVER_LEAST * (self.least.mean - 1.0) + PART_OF_WANTED * excess;
        let with_least = near_least.clamp(excess, MOST_EXCESS * excess);
        Wishes { target: 1.0 + with_least, ..*wishes }
    }

    /// The best cut of the proxy with the predicted shear `aim`; without symmetry where that costs too much.
    pub(super) fn search(
        &mut self,
        wishes: &Wishes<'_>,
        aim: f64,
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        let mut phase = Phase { whole: &mut *observer, from: 0.0, to: 0.6 };
        let solution = self.search_once(wishes, aim, &mut phase)?;
        if self.mirror.is_none() {
            return Ok(solution);
        }
        let islands = solution.state.cut.islands(&self.proxy);
        let mean = self.predicted(&solution).mean;
        let is_bad = !islands.are_disks()
            || solution.state.cut.seams().any(|edge| self.cost[edge] == f64::INFINITY)
            || mean > 1.0 + MISSED * (aim - 1.0)
            || islands.least_area() < SLIVER
            || islands.len() > self.max_islands;
        if !is_bad && islands.len() == 1 {
            return Ok(solution);
        }
        self.exchange_costs();
        let mut phase = Phase { whole: observer, from: 0.6, to: 1.0 };
        let plain = self.search_once(wishes, aim, &mut phase)?;
        let is_sound = plain.state.cut.islands(&self.proxy).are_disks();
        if is_bad || (is_sound && CHEAPER * plain.price < solution.price) {
            return Ok(plain);
        }
        self.exchange_costs();
        Ok(solution)
    }

    /// Puts the costs without symmetry in the place of those with it, or the other way round.
    fn exchange_costs(&mut self) {
        swap(&mut self.cost, &mut self.plain.proxy);
        swap(&mut self.component.cost, &mut self.plain.component);
        swap(&mut self.mirror, &mut self.plain.mirror);
        swap(&mut self.component.mirror, &mut self.plain.component_mirror);
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

    /// Edges of the proxy together with those that are seams only with them.
    pub(super) fn with_partners(&self, edges: &[Edge]) -> Vec<Edge> {
        with_partners(edges, self.mirrored(), self.parts.as_deref())
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
            parts: self.parts.as_deref(),
            least_rate: self.least_rate,
            given,
            max_islands: self.max_islands,
            target: aim,
            // where the mean is predicted too high, so is the percentile
            bound: (1.0 + PERCENTILE * (aim.max(target) - 1.0)).max(PERCENTILE_SLACK * self.least.percentile),
        }
    }

    /// The shear that the plate predicts for a solution.
    pub(super) fn predicted(&self, solution: &Solution) -> Figures {
        Figures::of(&self.proxy.areas, &solution.state.shear)
    }

    /// The seams of a cut of the proxy on the component.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`].
    pub(super) fn lifted(&self, cut: &Cut, observer: &mut dyn Observer) -> Result<Cut, Error> {
        let fine = &self.component;
        if let Some(parents) = &self.parents {
            let edges: Vec<_> = cut.seams().filter_map(|edge| parents[edge]).collect();
            let inner = edges.into_iter().filter(|&edge| !fine.mesh.edges.is_boundary(edge));
            let seams = Cut::none(fine.mesh).with(&inner.collect::<Vec<_>>());
            return Ok(fine.completed(seams, self.max_islands));
        }
        let mirror = self.mirror.as_ref().map(|(vertices, _)| &vertices[..]);
        fine.lifted(&self.proxy, cut, mirror, self.max_islands, observer)
    }

    /// A finer mesh onto which seams of the component are lifted; `nearest` is the vertex for which each vertex of the
    /// component stands, and `mirror` its mirror image.
    pub(super) fn finer<'b>(
        &self,
        mesh: &'b EdgeMesh,
        nearest: Vec<Vertex>,
        mirror: Option<&[Vertex]>,
        wishes: &Wishes<'_>,
    ) -> Fine<'b> {
        let view = View {
            proxy: &self.proxy,
            openness: &self.openness,
            plane: self.plane.as_ref(),
            is_symmetric: self.mirror.is_some() && mirror.is_some(),
        };
        let mut finer = view.fine(mesh, nearest, wishes);
        finer.make_symmetric(mirror);
        finer
    }
}

impl Fine<'_> {
    /// The seams of a cut of a mesh whose vertices stand for those of this one, with the mirror images of these where
    /// both are symmetric.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`].
    pub(super) fn lifted(
        &self,
        proxy: &EdgeMesh,
        cut: &Cut,
        mirror: Option<&[Vertex]>,
        max_islands: usize,
        observer: &mut dyn Observer,
    ) -> Result<Cut, Error> {
        let Self { mesh, cost, nearest, .. } = self;
        let wanted = cut.islands(proxy).len();
        let is_sound = |lifted: &Cut| {
            let islands = lifted.islands(mesh);
            islands.are_disks() && islands.len() == wanted
        };
        let mirrors = self.mirror.as_ref().zip(mirror).map(|(fine, proxy)| Mirrors { fine, proxy });
        let watch = Watch::new(observer, 0.0, MESSAGE);
        let mut lifted = Lift { fine: mesh, proxy, cost, nearest, mirrors }.of(cut, &watch)?;
        if mirrors.is_some() && !is_sound(&lifted) {
            lifted = Lift { fine: mesh, proxy, cost, nearest, mirrors: None }.of(cut, &watch)?;
        }
        Ok(self.completed(lifted, max_islands))
    }

    /// Makes costs and the vertices for which others stand symmetric, where the triangulation is; `of_proxy` are the
    /// mirror images of those others.
    fn make_symmetric(&mut self, of_proxy: Option<&[Vertex]>) {
        let Some(mirror) = &self.mirror else { return };
        mirror_nearest(&mut self.nearest, mirror, of_proxy);
        let images = mirrored_edges(self.mesh, mirror);
        self.cost = symmetric_costs(take(&mut self.cost), Some(&images));
    }

    /// Edges through an island with their mirror images through another one, where the cut is symmetric, and both leave
    /// disks and not too many.
    pub(super) fn with_image(&self, cut: &Cut, edges: Vec<Edge>, max_islands: usize) -> Vec<Edge> {
        let Some(mirror) = &self.mirror else { return edges };
        let image = |edge: Edge| image(self.mesh, edge, mirror);
        let labels = cut.islands(self.mesh).of_face;
        let island_at = |edge: Edge| labels[self.mesh.faces_at(edge).0];
        let is_elsewhere =
            |&edge: &Edge| image(edge).is_some_and(|image| island_at(image) != island_at(edge));
        let is_symmetric = cut.seams().all(|edge| image(edge).is_some_and(|image| cut.is_seam(image)));
        let mut all = edges.clone();
        all.extend(edges.iter().filter_map(|&edge| image(edge)));
        all.sort_unstable();
        all.dedup();
        let islands = cut.with(&all).islands(self.mesh);
        let is_sound = islands.are_disks() && islands.len() <= max_islands;
        if is_symmetric && is_sound && edges.iter().all(is_elsewhere) { all } else { edges }
    }

    /// The seams with those that islands lack to be disks, without islands beyond a number.
    fn completed(&self, cut: Cut, max_islands: usize) -> Cut {
        let completed = self.cut_into_disks(&cut);
        let is_allowed = completed.seams().all(|edge| self.cost[edge].is_finite());
        // what has been found may lie where no allowed path leads
        let completed = if is_allowed { completed } else { self.cut_into_disks(&Cut::none(self.mesh)) };
        self.with_alone(merged(self.mesh, &self.cost, completed, max_islands))
    }

    /// The cut with the given seams that lie alone where it meets them.
    pub(super) fn with_alone(&self, mut cut: Cut) -> Cut {
        loop {
            let is_met = cut.border_vertices(self.mesh);
            let meets = |&edge: &Edge| {
                !cut.is_seam(edge) && self.mesh.edges.ends(edge).iter().any(|&vertex| is_met[vertex])
            };
            let met: Vec<_> = self.alone.iter().copied().filter(meets).collect();
            if met.is_empty() {
                return cut;
            }
            cut.add(&met);
        }
    }

    /// The cut graph with some seams; a sphere is slit.
    fn cut_into_disks(&self, seams: &Cut) -> Cut {
        if seams.islands(self.mesh).are_disks() {
            return seams.clone();
        }
        let cut = cut_graph(self.mesh, &self.cost, seams);
        if !cut.is_empty() || cut.islands(self.mesh).are_disks() {
            return cut;
        }
        let points = far_points_within_reach(self.mesh, 2, &self.cost);
        cut.with(&Paths::from(self.mesh, &points[..1], &self.cost).to(self.mesh, points[1]))
    }
}

/// Makes the vertices for which mirror images on the proxy stand mirror images too.
fn mirror_nearest(nearest: &mut [Vertex], mirror: &[Vertex], of_proxy: Option<&[Vertex]>) {
    for (vertex, &image) in Vertex::all(nearest.len()).zip(of_proxy.unwrap_or_default()) {
        if image > vertex {
            nearest[image] = mirror[nearest[vertex]];
        }
    }
}

/// The costs with the mean of each edge's cost and that of its mirror image in place of both.
fn symmetric_costs(costs: Vec<f64>, mirror: Option<&[Edge]>) -> Vec<f64> {
    let Some(mirror) = mirror else { return costs.into_iter().map(on_cost_grid).collect() };
    mirror.iter().zip(&costs).map(|(&image, cost)| on_cost_grid(0.5 * (cost + costs[image]))).collect()
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
        Fine { mesh, cost: costs(mesh, &preferences), nearest, mirror, alone: wishes.alone.to_vec() }
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
            *cost = on_cost_grid(*cost);
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

/// All parts of the edge of which each edge is a part.
fn parts(parents: &[Option<Edge>], n_edges: usize) -> Vec<Vec<Edge>> {
    let mut parts_of = vec![Vec::new(); n_edges];
    for (part, parent) in Edge::all(parents.len()).zip(parents) {
        parent.iter().for_each(|&parent| parts_of[parent].push(part));
    }
    let parts = Edge::all(parents.len()).zip(parents);
    parts.map(|(edge, parent)| parent.map_or_else(|| vec![edge], |parent| parts_of[parent].clone())).collect()
}

/// Factors of the edges of a mesh carried to a coarser one: each vertex of that has the mean of the edges near to it,
/// infinite where most of them are; edges have the mean of their ends, and are nearly forbidden where one end is.
pub(super) fn carried(fine: &EdgeMesh, weights: &[f64], coarse: &EdgeMesh) -> Vec<f64> {
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
