// Where light comes from, and directions towards it.
#ifndef PATHTRACER_LIGHTS_HPP
#define PATHTRACER_LIGHTS_HPP

#include "shapes.hpp"

namespace pathtracer {

inline const LightSample NO_LIGHT{{0, 0, 1}, 0, {0, 0, 0}, 0, 0, 0};

class Light {
 public:
   Light(const furnace_light &light, const furnace_scene &scene, const Geometry &geometry)
       : light(light) {
      if (light.kind != FURNACE_AREA) return;
      bool     is_mesh = light.shape < scene.mesh_count;
      uint32_t sphere_index = light.shape - scene.mesh_count;
      material = scene.materials[is_mesh ? scene.meshes[light.shape].material
                                         : scene.spheres[sphere_index].material];
      if (!is_mesh) take_sphere(geometry.spheres[sphere_index]);
      for (const Primitive &p : geometry.primitives) {
         if (p.shape != light.shape || p.is_sphere) continue;
         triangles.push_back(geometry.triangles[p.index]);
         area += length(triangles.back().cross_edges) / 2;
         area_up_to.push_back(area);
      }
   }

   bool is_delta() const {
      return light.kind == FURNACE_POINT || light.kind == FURNACE_DIRECTIONAL;
   }
   bool is_sky() const {
      return light.kind == FURNACE_CONSTANT_SKY || light.kind == FURNACE_GRADIENT_SKY;
   }

   Rgb sky(Vec w) const {
      if (light.kind == FURNACE_CONSTANT_SKY) return light.radiance;
      if (light.kind != FURNACE_GRADIENT_SKY) return {0, 0, 0};
      Real height = std::max(Real(0), dot(w, light.place));
      return (1 - height) * Rgb(light.radiance) + height * Rgb(light.zenith);
   }

   LightSample sample(Vec from, const Numbers &random) const {
      switch (light.kind) {
      case FURNACE_POINT: {
         Vec  way = Vec(light.place) - from;
         Real squared = dot(way, way);
         if (!(squared > 0)) return NO_LIGHT;
         return {unit(way), std::sqrt(squared), Rgb(light.radiance) / squared, 1, 1, 1};
      }
      case FURNACE_DIRECTIONAL: return {-Vec(light.place), INFINITE, light.radiance, 1, 1, 1};
      case FURNACE_AREA: return sample_area(from, random);
      default: {
         Vec wi = below_pole(2 * random.point.x, random.point.y);
         return {wi, INFINITE, sky(wi), sky_pdf(), 0, 1};
      }
      }
   }

   Real sky_pdf() const { return is_sky() ? 1 / (4 * PI) : 0; }

   // The pdf of `sample` in the direction of `p`, a point of the emitter.
   Real area_pdf(Vec from, Vec p, Vec normal) const {
      if (is_sphere && fills_a_cone(from)) return 1 / (2 * PI * cone_depth(from));
      return per_steradian(from, p, normal);
   }

 private:
   furnace_light         light;
   furnace_material      material{};
   std::vector<Triangle> triangles;
   std::vector<Real>   area_up_to;
   bool                  is_sphere = false;
   Sphere                sphere{};
   Real                area = 0;
   Real                cap_depth = 2; // of the emissive part of the unit sphere

   void take_sphere(const Sphere &of_scene) {
      is_sphere = true;
      sphere = of_scene;
      if (material.cap_half_angle > 0) cap_depth = 1 - std::cos(Real(material.cap_half_angle));
      area = 2 * PI * sphere.radius * sphere.radius * cap_depth;
   }

   // 1 / area on the surface, as pdf with respect to solid angle: 0 from behind.
   Real per_steradian(Vec from, Vec p, Vec normal) const {
      Vec    way = p - from;
      Real squared = dot(way, way), cosine = -dot(way, normal) / std::sqrt(squared);
      return cosine > 0 ? squared / (cosine * area) : 0;
   }

   LightSample towards(Vec from, Vec p, Vec normal) const {
      Real pdf = per_steradian(from, p, normal);
      if (!(pdf > 0)) return NO_LIGHT;
      return {unit(p - from), length(p - from), material.emission, pdf, 0, 1};
   }

   LightSample sample_area(Vec from, const Numbers &random) const {
      if (is_sphere) return fills_a_cone(from) ? sample_cone(from, random.point)
                                             : sample_cap(from, random.point);
      if (triangles.empty()) return NO_LIGHT;
      auto   found = std::upper_bound(area_up_to.begin(), area_up_to.end(), random.lobe * area);
      size_t chosen = std::min(size_t(found - area_up_to.begin()), triangles.size() - 1);
      Real root = std::sqrt(random.point.x); // Turk 1990
      const Triangle &triangle = triangles[chosen];
      Vec p = triangle.point(root * (1 - random.point.y), root * random.point.y);
      return towards(from, p, triangle.normal());
   }

   LightSample sample_cap(Vec from, Point u) const {
      Vec axis = material.cap_half_angle > 0 ? Vec(material.cap_axis) : Vec{0, 0, 1};
      Vec outward = Frame(axis).to_world(below_pole(u.x * cap_depth, u.y));
      return towards(from, sphere.centre + sphere.radius * outward, sphere.inward ? -outward : outward);
   }

   // From outside, a sphere light is sampled over the cone of directions that it subtends.
   bool fills_a_cone(Vec from) const {
      bool emits_everywhere = !sphere.inward && material.cap_half_angle == 0;
      return emits_everywhere && length(from - sphere.centre) > sphere.radius;
   }
   Real cone_depth(Vec from) const {
      Vec    way = sphere.centre - from;
      Real sine2 = sphere.radius * sphere.radius / dot(way, way);
      return sine2 / (1 + std::sqrt(std::max(Real(0), 1 - sine2)));
   }
   LightSample sample_cone(Vec from, Point u) const {
      Vec    way = sphere.centre - from;
      Real depth = u.x * cone_depth(from), distance = length(way);
      Real off_axis2 = distance * distance * depth * (2 - depth);
      Real half_chord = std::sqrt(std::max(Real(0), sphere.radius * sphere.radius - off_axis2));
      Vec    wi = Frame(unit(way)).to_world(below_pole(depth, u.y));
      Real pdf = 1 / (2 * PI * cone_depth(from));
      return {wi, distance * (1 - depth) - half_chord, material.emission, pdf, 0, 1};
   }
};

} // namespace pathtracer

#endif
