// A scene as paths see it, and the paths.
#ifndef PATHTRACER_SCENE_HPP
#define PATHTRACER_SCENE_HPP

#include "bvh.hpp"
#include "lights.hpp"
#include "surfaces.hpp"

namespace pathtracer {

// Rays keep this share of the largest length involved clear of the surface they leave.
constexpr Real CLEARANCE = Real(IS_SINGLE ? 2e-5 : 1e-10);

// What of a path's settings matters to emission alone: nothing but their size.
constexpr furnace_integrator EMISSION_ALONE{sizeof(furnace_integrator), 1, 0, 0, 0, 1, 0, 0, 0, 0};

// What a ray sees: a point of a surface, or (without a material) the sky.
struct Vertex {
   const furnace_material *material = nullptr;
   Vec                     point{}, normal{}; // geometric
   Frame                   frame{{0, 0, 1}};  // shading
   Ray                     ray{{}, 0, {}, 0}; // that arrived
   Vec                     direction{}, wo{}; // of the ray; back along it, local
   Rgb                     emission{};
   int64_t                 light = -1; // the light that the surface is
   Real                  clearance = 0;

   // Rays begin beside the surface, on the side that they leave on: rounding may have put the point
   // on the other one, from where a grazing ray would meet the surface again.
   Vec beside(Vec way) const { return point + std::copysign(clearance, dot(normal, way)) * normal; }
   Ray ray_along(Vec way) const { return {beside(way), 0, way, INFINITE}; }
   Ray ray_to(Vec wi) const { return ray_along(frame.to_world(wi)); }
   // Up to shortly before what lies at `distance`: a light would shadow itself.
   Ray ray_along(Vec way, Real distance) const {
      if (!std::isfinite(distance)) return ray_along(way);
      Vec whole = point + distance * way - beside(way);
      return {beside(way), 0, whole, 1 - std::max(CLEARANCE, clearance / distance)};
   }
};

class Scene {
 public:
   Scene(const furnace_scene &scene, const furnace_build &settings)
       : geometry(scene), bvh(geometry, settings), bench_built(settings.bench),
         materials(scene.materials, scene.materials + scene.material_count) {
      for (auto &material : materials) material.name = nullptr; // it dies with the call
      for (uint32_t i = 0; i < scene.mesh_count; ++i)
         material_of_shape.push_back(scene.meshes[i].material);
      for (uint32_t i = 0; i < scene.sphere_count; ++i)
         material_of_shape.push_back(scene.spheres[i].material);
      light_of_shape.assign(material_of_shape.size(), -1);
      for (uint32_t i = 0; i < scene.light_count; ++i) {
         lights.emplace_back(scene.lights[i], scene, geometry);
         if (scene.lights[i].kind == FURNACE_AREA) light_of_shape[scene.lights[i].shape] = i;
      }
   }

   furnace_build_stats stats() const { return bvh.stats; }

   Hit intersect(const Ray &ray, Stats &stats) const {
      Hit hit;
      return bvh.closest(ray, hit, stats) >= 0 ? hit : Hit();
   }

   bool occluded(const Ray &ray, Stats &stats) const { return bvh.any(ray, stats); }

   LightSample sample_light(uint32_t light, Vec from, const Numbers &random) const {
      if (light >= lights.size()) throw std::out_of_range("there is no such light");
      return sample(lights[light], from, random);
   }

   Rgb radiance(const Ray &ray, const furnace_integrator &settings, size_t index) const {
      Random random(settings.seed, index, 0);
      return trace(ray, settings, random);
   }

   void render(const furnace_camera &, const furnace_render &, float *, uint32_t *) const;

 private:
   Geometry                      geometry;
   Bvh                           bvh;
   furnace_built                *bench_built;
   std::vector<furnace_material> materials;
   std::vector<uint32_t>         material_of_shape;
   std::vector<int64_t>          light_of_shape;
   std::vector<Light>            lights;

   LightSample sample(const Light &light, Vec from, const Numbers &random) const {
      if (!bench.has(FURNACE_TAKES_LIGHT_SAMPLING)) return light.sample(from, random);
      return bench.sample_light(bench_built, uint32_t(&light - lights.data()), from, random);
   }

   Vertex look(const Ray &ray) const {
      Vertex v = found(ray);
      v.ray = ray;
      if (bench.has(FURNACE_TAKES_EMISSION))
         v.emission = bench.radiance(bench_built, ray, EMISSION_ALONE, 0, 0, 0);
      return v;
   }

   Vertex found(const Ray &ray) const {
      Vertex      v;
      Hit hit;
      Stats       unused{};
      v.direction = unit(ray.direction);
      int64_t primitive = bvh.closest(ray, hit, unused);
      if (primitive < 0) {
         for (const Light &light : lights) v.emission = v.emission + light.sky(v.direction);
         return v;
      }
      v.material = &materials[material_of_shape[hit.shape]];
      v.light = light_of_shape[hit.shape];
      v.point = point_on(ray, hit.t);
      v.normal = hit.geometric_normal;
      // Glass has an inside: where the normals disagree about the side, the geometric one knows.
      bool agree = dot(hit.shading_normal, v.direction) * dot(v.normal, v.direction) > 0;
      bool is_glass = v.material->kind == FURNACE_GLASS;
      v.frame = Frame(is_glass && !agree ? hit.geometric_normal : hit.shading_normal);
      v.wo = v.frame.to_local(-v.direction);
      const Primitive &met = geometry.primitives[size_t(primitive)];
      v.emission = emitted(*v.material, met, v);
      Real travelled = hit.t * length(ray.direction);
      v.clearance = CLEARANCE * std::max({met.reach, largest(ray.origin), travelled});
      return v;
   }

   // Emission leaves the front alone, and of a sphere with a cap only the cap.
   Rgb emitted(const furnace_material &m, const Primitive &met, const Vertex &v) const {
      if (!m.emits || dot(v.normal, v.direction) >= 0) return {0, 0, 0};
      if (!met.is_sphere || m.cap_half_angle == 0) return m.emission;
      Vec outward = geometry.spheres[met.index].inward ? -v.normal : v.normal;
      return dot(outward, m.cap_axis) >= std::cos(Real(m.cap_half_angle)) ? Rgb(m.emission) : Rgb{0, 0, 0};
   }

   // Light of bounce k has been scattered k times on its way to the camera. At each vertex light
   // sampling (next event estimation) adds the next bounce; so emission that the path itself hits
   // counts only for the camera, and after delta lobes, towards which no light can be sampled.
   Rgb trace(const Ray &ray, const furnace_integrator &settings, Random &random) const {
      if (bench.has(FURNACE_TAKES_PATH))
         return bench.radiance(bench_built, ray, settings, settings.first_bounce,
                               settings.last_bounce, random.seed());
      auto wanted = [&](uint32_t bounce) {
         return settings.first_bounce <= bounce && bounce <= settings.last_bounce;
      };
      Rgb    sum{0, 0, 0}, throughput{1, 1, 1};
      bool   sees_lights = true;
      Vertex v = look(ray);
      for (uint32_t bounce = 0;; ++bounce) {
         if (sees_lights && wanted(bounce)) sum = sum + throughput * v.emission;
         if (!v.material || bounce >= settings.last_bounce) return sum;
         sees_lights = is_delta(*v.material);
         if (!sees_lights && wanted(bounce + 1))
            sum = sum + throughput * direct_light(v, settings, random);
         if (!sees_lights && bounce + 1 >= settings.last_bounce) return sum;

         bool   plays = settings.roulette_stop > 0 && bounce >= settings.roulette_guaranteed;
         Real survival = plays ? 1 - Real(settings.roulette_stop) : 1;
         if (random.number() >= survival) return sum;
         auto way = sample_surface(*v.material, v.wo, random.numbers());
         if (!way.is_valid) return sum;
         throughput = throughput * way.f * (std::abs(way.wi.z) / (way.pdf * survival));
         if (is_black(throughput)) return sum;
         v = look(v.ray_to(way.wi));
      }
   }

   // Light that is scattered at `v`, and only there.
   Rgb direct_light(const Vertex &v, const furnace_integrator &settings, Random &random) const {
      if (bench.has(FURNACE_TAKES_DIRECT_LIGHTING))
         return bench.radiance(bench_built, v.ray, settings, 1, 1, random.seed());
      uint32_t samples = std::max(1u, settings.samples_per_light), area_lights = 0;
      // The bench's light samples have no pdf of ours to be weighed against.
      bool glossy = v.material->kind == FURNACE_CONDUCTOR &&
                    !bench.has(FURNACE_TAKES_LIGHT_SAMPLING);
      Rgb      sum{0, 0, 0};
      for (const Light &light : lights) {
         area_lights += !light.is_delta();
         if (settings.by_hemisphere && !light.is_delta()) continue;
         uint32_t count = light.is_delta() ? 1 : samples;
         for (uint32_t i = 0; i < count; ++i)
            sum = sum + from_light(v, light, random.numbers(), glossy) / Real(count);
      }
      if (settings.by_hemisphere) {
         uint32_t count = std::max(1u, samples * area_lights);
         for (uint32_t i = 0; i < count; ++i)
            sum = sum + from_hemisphere(v, random.numbers()) / Real(count);
      } else if (glossy) {
         for (uint32_t i = 0; i < samples; ++i)
            sum = sum + from_lobe(v, random.numbers()) / Real(samples);
      }
      return sum;
   }

   Rgb from_hemisphere(const Vertex &v, const Numbers &random) const {
      auto [wi, pdf] = sample_hemisphere(FURNACE_UNIFORM_HEMISPHERE, random);
      if (v.wo.z < 0) wi = -wi;
      Rgb f = eval_surface(*v.material, v.wo, wi).f;
      return look(v.ray_to(wi)).emission * f * (std::abs(wi.z) / pdf);
   }

   // On a glossy surface the lights and the narrow lobe are both sampled; the balance heuristic
   // (Veach 1997) shares out what either could have found.
   static Real balance(Real own, Real other) { return own / (own + other); }

   Rgb from_light(const Vertex &v, const Light &light, const Numbers &random, bool glossy) const {
      LightSample s = sample(light, v.point, random);
      if (!s.is_valid) return {0, 0, 0};
      Vec  wi = v.frame.to_local(s.wi);
      auto [f, pdf] = eval_surface(*v.material, v.wo, wi);
      if (is_black(f)) return f;
      Stats unused{};
      if (bvh.any(v.ray_along(s.wi, s.distance), unused)) return {0, 0, 0};
      Real weight = glossy && !s.is_delta ? balance(s.pdf, pdf) : 1;
      return s.radiance * f * (weight * std::abs(wi.z) / s.pdf);
   }

   Rgb from_lobe(const Vertex &v, const Numbers &random) const {
      auto way = sample_surface(*v.material, v.wo, random);
      if (!way.is_valid) return {0, 0, 0};
      Vertex seen = look(v.ray_to(way.wi));
      Rgb    arriving = seen.emission * balance(way.pdf, light_pdf(v, seen));
      return arriving * way.f * (std::abs(way.wi.z) / way.pdf);
   }

   // The pdf with which light sampling would have chosen `seen` (multiple importance sampling).
   Real light_pdf(const Vertex &v, const Vertex &seen) const {
      if (seen.material)
         return seen.light < 0 ? 0 : lights[seen.light].area_pdf(v.point, seen.point, seen.normal);
      Real pdf = 0; // a scene has one sky at most
      for (const Light &light : lights) pdf += light.sky_pdf();
      return pdf;
   }
};

} // namespace pathtracer

#endif
