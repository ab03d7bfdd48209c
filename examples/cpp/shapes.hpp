// Boxes, triangles and spheres, and the primitives of a scene.
#ifndef PATHTRACER_SHAPES_HPP
#define PATHTRACER_SHAPES_HPP

#include "numbers.hpp"

#include <map>

namespace pathtracer {

inline bool within(const Ray &ray, Real t) { return ray.t_min < t && t < ray.t_max; }

// The bench's hit of one primitive, whose numbers stay those of the scene.
inline bool taken(Hit found, Hit &out) {
   if (found.primitive == FURNACE_NONE) return false;
   found.shape = out.shape, found.primitive = out.primitive;
   out = found;
   return true;
}

struct Box {
   Vec min{INFINITE, INFINITE, INFINITE}, max{-INFINITE, -INFINITE, -INFINITE};

   void add(Vec p) {
      min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
   }
   void add(const Box &box) { add(box.min), add(box.max); }
   Vec  centre() const { return (min + max) / 2; }
   int  longest_axis() const {
      Vec size = max - min;
      return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
   }
   Real half_area() const {
      Vec size = max - min;
      return size.x * size.y + size.y * size.z + size.z * size.x;
   }

   // The closed box against the closed segment. A ray along a pair of faces lies between them for
   // ever or never: dividing by its zero would make NaN on a face. `slack` makes the box longer by
   // that share, for those who must not lose a hit to rounding.
   bool meets(const Ray &ray, Real &enter, Real &exit, Real slack = 0) const {
      if (bench.has(FURNACE_TAKES_BOX_TEST)) {
         furnace_box_hit met = bench.intersect_box(min, max, ray);
         enter = Real(met.t_enter), exit = Real(met.t_exit);
         return met.hit;
      }
      enter = -INFINITE, exit = INFINITE;
      for (int axis = 0; axis < 3; ++axis) {
         Real from = at(ray.origin, axis), step = at(ray.direction, axis);
         Real low = at(min, axis), high = at(max, axis);
         if (step == 0) {
            if (from < low || from > high) return false;
            continue;
         }
         Real near = (low - from) / step, far = (high - from) / step;
         enter = std::max(enter, std::min(near, far));
         exit = std::min(exit, std::max(near, far));
      }
      exit += slack * std::abs(exit);
      return enter <= exit && enter <= ray.t_max && exit >= ray.t_min;
   }
};

struct Triangle {
   std::array<Vec, 3> positions;
   Vec    corner, edge1, edge2;
   Vec    cross_edges;     // along the normal, twice the area long
   Real parallel;        // a determinant below this, for a unit ray, is rounding error
   std::array<Vec, 3> normals; // shading, at the corners

   Triangle(const Vec *p, const Vec *n)
       : positions{p[0], p[1], p[2]}, corner(p[0]), edge1(p[1] - p[0]), edge2(p[2] - p[0]), cross_edges(cross(edge1, edge2)),
         parallel(4 * EPSILON * length(edge1) * length(edge2)) {
      Vec flat = has_area() ? unit(cross_edges) : Vec{0, 0, 1};
      for (int i = 0; i < 3; ++i) normals[i] = n ? n[i] : flat;
   }

   bool has_area() const { return length(cross_edges) > parallel; }
   Vec  normal() const { return unit(cross_edges); }
   Vec  point(Real u, Real v) const { return corner + u * edge1 + v * edge2; }

   // Cramer's rule for origin + t direction = corner + u edge1 + v edge2.
   bool hit(const Ray &ray, Hit &out) const {
      if (bench.has(FURNACE_TAKES_TRIANGLE_TEST))
         return taken(bench_hit(ray), out);
      Real determinant = -dot(ray.direction, cross_edges);
      if (!(std::abs(determinant) > parallel * length(ray.direction))) return false;
      Vec    from = ray.origin - corner, turned = cross(from, ray.direction);
      Real u = dot(edge2, turned) / determinant, v = -dot(edge1, turned) / determinant;
      Real t = dot(from, cross_edges) / determinant;
      if (!(u >= 0 && v >= 0 && u + v <= 1 && within(ray, t))) return false;
      out.t = t;
      out.uv = {u, v};
      out.geometric_normal = normal();
      out.shading_normal = unit((1 - u - v) * normals[0] + u * normals[1] + v * normals[2]);
      return true;
   }

   Hit bench_hit(const Ray &ray) const {
      furnace_vec3 p[]{positions[0], positions[1], positions[2]};
      furnace_vec3 n[]{normals[0], normals[1], normals[2]};
      return bench.intersect_triangle(p, n, ray);
   }

   Box bounds() const {
      Box box;
      box.add(corner), box.add(corner + edge1), box.add(corner + edge2);
      return box;
   }
};

struct Sphere {
   Vec    centre;
   Real radius;
   bool   inward;

   // From the point of the line that is nearest to the centre, half a chord back and forth: no
   // large squares are subtracted, however far away the ray begins.
   bool hit(const Ray &ray, Hit &out) const {
      if (bench.has(FURNACE_TAKES_SPHERE_TEST)) {
         Hit found = bench.intersect_sphere(centre, double(radius), ray);
         if (inward) {
            found.geometric_normal = -found.geometric_normal;
            found.shading_normal = -found.shading_normal;
         }
         return taken(found, out);
      }
      Real squared = dot(ray.direction, ray.direction);
      Real middle = dot(centre - ray.origin, ray.direction) / squared;
      Vec    off_axis = point_on(ray, middle) - centre;
      Real half_chord = std::sqrt((radius * radius - dot(off_axis, off_axis)) / squared);
      Real t = within(ray, middle - half_chord) ? middle - half_chord : middle + half_chord;
      if (!within(ray, t)) return false; // so does the NaN of a line that passes by
      Vec outward = unit(point_on(ray, t) - centre);
      out.t = t;
      out.uv = {0, 0};
      out.geometric_normal = out.shading_normal = inward ? -outward : outward;
      return true;
   }

   Box bounds() const {
      Box box;
      Vec r{radius, radius, radius};
      box.add(centre - r), box.add(centre + r);
      return box;
   }
};

// A triangle or a sphere of the scene, by its number there.
struct Primitive {
   uint32_t shape, number;
   uint32_t index; // into the triangles, or into the spheres
   bool     is_sphere;
   Real   reach; // largest coordinate: rounding errors grow with it
   Box      bounds;
};

struct Geometry {
   std::vector<Triangle>  triangles;
   std::vector<Sphere>    spheres;
   std::vector<Primitive> primitives;
   std::map<std::pair<uint32_t, uint32_t>, size_t> numbers; // of primitives, by shape and number

   explicit Geometry(const furnace_scene &scene) {
      for (uint32_t shape = 0; shape < scene.mesh_count; ++shape) add_mesh(scene, shape);
      for (uint32_t i = 0; i < scene.sphere_count; ++i) {
         const furnace_sphere &s = scene.spheres[i];
         spheres.push_back({s.centre, Real(s.radius), s.inward == 1});
         add(scene.mesh_count + i, 0, i, true, spheres.back().bounds());
      }
   }

   // The number of the primitive that is called so in the scene; -1 for a miss.
   int64_t find(const Hit &hit) const {
      auto found = numbers.find({hit.shape, hit.primitive});
      return found == numbers.end() ? -1 : int64_t(found->second);
   }

   bool hit(uint32_t number, const Ray &ray, Hit &out) const {
      const Primitive &p = primitives[number];
      out.shape = p.shape, out.primitive = p.number;
      return p.is_sphere ? spheres[p.index].hit(ray, out) : triangles[p.index].hit(ray, out);
   }

 private:
   void add_mesh(const furnace_scene &scene, uint32_t shape) {
      const furnace_mesh &mesh = scene.meshes[shape];
      for (uint32_t number = 0; number < mesh.triangle_count; ++number) {
         Vec positions[3], normals[3];
         for (int i = 0; i < 3; ++i) {
            uint32_t vertex = mesh.indices[3 * number + i];
            positions[i] = mesh.positions[vertex];
            if (mesh.normals) normals[i] = mesh.normals[vertex];
         }
         triangles.emplace_back(positions, mesh.normals ? normals : nullptr);
         if (!triangles.back().has_area()) continue; // nothing can hit it
         add(shape, number, uint32_t(triangles.size() - 1), false, triangles.back().bounds());
      }
   }
   void add(uint32_t shape, uint32_t number, uint32_t index, bool is_sphere, const Box &box) {
      Real reach = std::max(largest(box.min), largest(box.max));
      Box    padded = box; // a ray that rounding lets graze the primitive grazes the box too
      Vec    pad = 50 * EPSILON * reach * Vec{1, 1, 1};
      padded.add(box.min - pad), padded.add(box.max + pad);
      numbers[{shape, number}] = primitives.size();
      primitives.push_back({shape, number, index, is_sphere, reach, padded});
   }
};

} // namespace pathtracer

#endif
