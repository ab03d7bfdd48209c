//! The vertex normals of the course's mesh class, bit for bit.
//!
//! The class walks half-edges around each vertex. At the rim of an open mesh it turns into the wrong
//! direction and walks around the vertex's *neighbour* instead, which for a flat patch gives exactly
//! minus the normal of the winding. Every wall of the course's boxes is such a patch, wound the
//! wrong way round, so the two mistakes cancel: what is read here is right only if both are made.

use glam::DVec3;
use std::collections::HashMap;

/// Stands for "no twin yet".
const NONE: usize = usize::MAX;

#[derive(Clone, Copy)]
struct HalfEdge {
    /// Where it starts.
    vertex: usize,
    /// The next one around its polygon, or around the rim.
    next: usize,
    /// The one that runs the other way.
    twin: usize,
    /// Whether it runs along the rim, outside of every polygon.
    is_rim: bool,
}

/// A mesh of half-edges, as the course builds it.
struct HalfEdges {
    all: Vec<HalfEdge>,
    /// One that starts at each vertex.
    of_vertex: Vec<usize>,
}

/// One unit normal a vertex. `polygons` must be an oriented manifold that uses every vertex; if not,
/// the answer says why, as a fragment that fits after the name of the mesh.
pub(crate) fn vertex_normals(
    positions: &[DVec3],
    polygons: &[Vec<u32>],
) -> Result<Vec<DVec3>, String> {
    let mesh = HalfEdges::new(positions.len(), polygons)?;
    let normal = |vertex: usize| {
        let normal = mesh.normal(vertex, positions);
        normal.is_finite().then_some(normal).ok_or_else(|| {
            format!("gets no normal from the course at vertex {vertex}: the sum over it is zero")
        })
    };
    (0..positions.len()).map(normal).collect()
}

impl HalfEdges {
    fn new(vertices: usize, polygons: &[Vec<u32>]) -> Result<Self, String> {
        let mut mesh = Self { all: Vec::new(), of_vertex: vec![NONE; vertices] };
        mesh.add_polygons(polygons)?;
        if let Some(vertex) = mesh.of_vertex.iter().position(|edge| *edge == NONE) {
            return Err(format!("does not use vertex {vertex}: remove it"));
        }
        mesh.start_at_the_rim();
        mesh.add_rim()?;
        for vertex in 0..vertices {
            mesh.of_vertex[vertex] = mesh.around_vertex(mesh.of_vertex[vertex]);
        }
        mesh.check_fans(polygons)?;
        Ok(mesh)
    }

    fn add_polygons(&mut self, polygons: &[Vec<u32>]) -> Result<(), String> {
        let mut by_ends = HashMap::new();
        for polygon in polygons {
            let first = self.all.len();
            for (corner, &start) in polygon.iter().enumerate() {
                let after = (corner + 1) % polygon.len();
                let (start, end) = (start as usize, polygon[after] as usize);
                let new = self.all.len();
                if start == end || by_ends.insert((start, end), new).is_some() {
                    return Err(format!(
                        "is no oriented manifold: the edge from vertex {start} to {end} is there \
                         twice, or has no length"
                    ));
                }
                let twin = by_ends.get(&(end, start)).copied().unwrap_or(NONE);
                self.all.push(HalfEdge { vertex: start, next: first + after, twin, is_rim: false });
                if twin != NONE {
                    self.all[twin].twin = new;
                }
                self.of_vertex[start] = new;
            }
        }
        Ok(())
    }

    /// Lets each vertex at the rim name the half-edge that has no twin.
    fn start_at_the_rim(&mut self) {
        for vertex in 0..self.of_vertex.len() {
            let first = self.of_vertex[vertex];
            let mut edge = first;
            while self.all[edge].twin != NONE {
                edge = self.around_vertex(edge);
                if edge == first {
                    break;
                }
            }
            if self.all[edge].twin == NONE {
                self.of_vertex[vertex] = edge;
            }
        }
    }

    /// Gives a twin to every half-edge that has none, and joins these twins into loops.
    fn add_rim(&mut self) -> Result<(), String> {
        let inner = self.all.len();
        let mut from = HashMap::new();
        for edge in (0..inner).filter(|edge| self.all[*edge].twin == NONE).collect::<Vec<_>>() {
            let HalfEdge { vertex: start, next, .. } = self.all[edge];
            let end = self.all[next].vertex;
            let twin = self.all.len();
            self.all[edge].twin = twin;
            self.all.push(HalfEdge { vertex: end, next: start, twin: edge, is_rim: true });
            if from.insert(end, twin).is_some() {
                return Err(not_manifold(end));
            }
        }
        for edge in inner..self.all.len() {
            // Until here `next` held the vertex at which the next one starts.
            let start = self.all[edge].next;
            self.all[edge].next = *from.get(&start).ok_or_else(|| not_manifold(start))?;
        }
        Ok(())
    }

    /// That the polygons around each vertex are one fan.
    fn check_fans(&self, polygons: &[Vec<u32>]) -> Result<(), String> {
        let mut uses = vec![0_usize; self.of_vertex.len()];
        polygons.iter().flatten().for_each(|vertex| uses[*vertex as usize] += 1);
        for (vertex, &first) in self.of_vertex.iter().enumerate() {
            let fan = self.orbit(first, |edge| self.around_vertex(edge));
            if fan.filter(|edge| !self.all[*edge].is_rim).count() != uses[vertex] {
                return Err(not_manifold(vertex));
            }
        }
        Ok(())
    }

    /// The next half-edge that starts at the same vertex.
    fn around_vertex(&self, edge: usize) -> usize {
        self.all[self.all[edge].twin].next
    }

    /// Where the course goes at the rim: the next half-edge that *ends* where `edge` ends.
    fn around_neighbour(&self, edge: usize) -> usize {
        self.all[self.all[edge].next].twin
    }

    /// `first` and what follows it until it comes again. Both ways of walking are permutations.
    fn orbit(&self, first: usize, step: impl Fn(usize) -> usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(first), move |edge| {
            Some(step(*edge)).filter(|next| *next != first)
        })
    }

    fn normal(&self, vertex: usize, positions: &[DVec3]) -> DVec3 {
        let first = self.of_vertex[vertex];
        let mut edges = self.orbit(first, |edge| self.around_vertex(edge));
        let here = positions[vertex];
        let area = |sum: DVec3, edge: usize| {
            let next = self.all[self.all[edge].next];
            let after = self.all[next.next];
            sum + (positions[next.vertex] - here).cross(positions[after.vertex] - here)
        };
        let sum = if edges.any(|edge| self.all[edge].is_rim) {
            self.orbit(first, |edge| self.around_neighbour(edge)).fold(DVec3::ZERO, area)
        } else {
            self.orbit(first, |edge| self.around_vertex(edge)).fold(DVec3::ZERO, area)
        };
        sum * sum.length_recip()
    }
}

fn not_manifold(vertex: usize) -> String {
    format!("is no manifold: its polygons do not form one fan around vertex {vertex}")
}
