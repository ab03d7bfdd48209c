// A small complete path tracer behind furnace_core.hpp. Read it to see where
// each function of your own renderer would go; copy its parts freely.
//
//    c++ -std=c++17 -O2 -shared -fPIC -Iinclude examples/cpp/pathtracer.cpp -o libpathtracer.so
//    cargo furnace --core ./libpathtracer.so
//
// types.hpp      vectors, colours, rays; single or double precision
// numbers.hpp    random numbers, directions around an axis
// shapes.hpp     boxes, triangles, spheres
// bvh.hpp        the bounding volume hierarchy
// surfaces.hpp   how surfaces scatter
// lights.hpp     where light comes from
// scene.hpp      paths
// this file      images, and the type that the bench talks to
//
// It shares no code with the cores that come with the bench.
#include "scene.hpp"

#include <atomic>
#include <thread>

namespace pathtracer {

// ---- images -------------------------------------------------------------------------------------

Ray camera_ray(const furnace_camera &camera, Point film) {
   if (bench.has(FURNACE_TAKES_CAMERA))
      return bench.generate_ray(camera, {double(film.x), double(film.y)});
   Real x = (2 * film.x - 1) * std::tan(Real(camera.horizontal_fov) / 2);
   Real y = (2 * film.y - 1) * std::tan(Real(camera.vertical_fov) / 2);
   Vec  direction = unit(x * Vec(camera.right) + y * Vec(camera.up) - Vec(camera.backward));
   return {camera.position, Real(camera.near_clip), direction, Real(camera.far_clip)};
}

// Values as they come: how noisy their mean is, and the course's stopping rule over luminances.
// Squares of deviations are summed, which stay exact where values hardly differ (Welford 1962).
struct Tally {
   uint32_t count = 0;
   Real     mean = 0, squares = 0;

   void add(Real value) {
      Real off = value - mean;
      mean += off / Real(++count);
      squares += off * (value - mean);
   }
   bool may_stop(const furnace_adaptive &rule) const {
      if (count % std::max(1u, rule.samples_per_batch) != 0) return false;
      return Real(1.96) * std::sqrt(variance_of_mean()) <= Real(rule.max_tolerance) * mean;
   }
   Real variance_of_mean() const { return squares / Real(count - 1) / Real(count); }
};

// The bench stops a stream at a sample before its last one, or not at all: one more tells.
bool may_stop(const Tally &tally, const furnace_adaptive &rule, std::vector<double> &luminances) {
   if (!bench.has(FURNACE_TAKES_PIXEL)) return tally.may_stop(rule);
   if (tally.count % std::max(1u, rule.samples_per_batch) != 0) return false;
   luminances.push_back(0);
   auto used = bench.adaptive_mean(rule, luminances.data(), luminances.size()).used;
   luminances.pop_back();
   return used == tally.count;
}

// Where sample `number` lies in its pixel: anywhere, or anywhere in its own cell of a grid.
Point within_pixel(const furnace_render &settings, uint32_t number, Point jitter) {
   if (!settings.stratified) return jitter;
   auto side = uint32_t(std::lround(std::sqrt(settings.samples_per_pixel)));
   return {(Real(number % side) + jitter.x) / Real(side),
           (Real(number / side) + jitter.y) / Real(side)};
}

void Scene::render(const furnace_camera &camera, const furnace_render &settings, float *pixels,
                   uint32_t *sample_counts) const {
   if (settings.samples_per_pixel == 0) throw std::invalid_argument("no samples a pixel");
   auto render_pixel = [&](uint32_t index) {
      uint32_t x = index % settings.width, y = index / settings.width;
      Rgb      sum{0, 0, 0};
      Tally    tally, channels[3];
      std::vector<double> luminances;
      while (tally.count < settings.samples_per_pixel) {
         Random  random(settings.integrator->seed, index, tally.count + 1);
         Point   within = within_pixel(settings, tally.count, random.numbers().point);
         Ray     ray = camera_ray(camera, {(Real(x) + within.x) / Real(settings.width),
                                           1 - (Real(y) + within.y) / Real(settings.height)});
         Rgb radiance = trace(ray, *settings.integrator, random);
         sum = sum + radiance;
         tally.add(luminance(radiance)), luminances.push_back(double(luminance(radiance)));
         channels[0].add(radiance.r), channels[1].add(radiance.g), channels[2].add(radiance.b);
         if (settings.adaptive && may_stop(tally, *settings.adaptive, luminances)) break;
      }
      Rgb mean = sum / Real(tally.count);
      float *pixel = pixels + 3 * size_t(index);
      pixel[0] = float(mean.r), pixel[1] = float(mean.g), pixel[2] = float(mean.b);
      sample_counts[index] = tally.count;
      for (size_t c = 0; settings.variances && c < 3; ++c)
         settings.variances[3 * size_t(index) + c] =
             tally.count < 2 ? 0.0f : float(channels[c].variance_of_mean());
   };
   uint32_t wanted = settings.integrator->threads;
   uint32_t count = wanted ? wanted : std::max(1u, std::thread::hardware_concurrency());
   std::atomic<uint32_t>    next{0};
   std::vector<std::thread> threads;
   auto work = [&] {
      for (uint32_t row; (row = next++) < settings.height;)
         for (uint32_t x = 0; x < settings.width; ++x) render_pixel(row * settings.width + x);
   };
   for (uint32_t i = 1; i < count; ++i) threads.emplace_back(work);
   work();
   for (std::thread &thread : threads) thread.join();
}

// ---- what the bench talks to --------------------------------------------------------------------

struct PathTracer {
   // All but where random numbers come from.
   static constexpr uint32_t components =
       FURNACE_TAKES_CAMERA | FURNACE_TAKES_TRIANGLE_TEST | FURNACE_TAKES_SPHERE_TEST |
       FURNACE_TAKES_BOX_TEST | FURNACE_TAKES_TRAVERSAL | FURNACE_TAKES_DIRECTION_SAMPLING |
       FURNACE_TAKES_BSDF | FURNACE_TAKES_LIGHT_SAMPLING | FURNACE_TAKES_EMISSION |
       FURNACE_TAKES_DIRECT_LIGHTING | FURNACE_TAKES_PATH | FURNACE_TAKES_PIXEL;
   void take_components(const Bench &lent) { bench = lent; }

   Ray generate_ray(const furnace_camera &camera, furnace_vec2 film) {
      return camera_ray(camera, {Real(film.x), Real(film.y)});
   }

   Hit intersect_triangle(const furnace_vec3 *positions, const furnace_vec3 *normals,
                          const Ray &ray) {
      Vec p[]{positions[0], positions[1], positions[2]}, n[]{normals[0], normals[1], normals[2]};
      return alone(Triangle(p, n), ray);
   }
   Hit intersect_sphere(Vec centre, double radius, const Ray &ray) {
      return alone(Sphere{centre, Real(radius), false}, ray);
   }
   furnace_box_hit intersect_box(Vec min, Vec max, const Ray &ray) {
      Real enter = 0, exit = 0;
      bool met = Box{min, max}.meets(ray, enter, exit);
      return {double(enter), double(exit), met, 0};
   }

   DirectionSample sample_direction(uint32_t sampler, const Numbers &random) {
      return sample_hemisphere(sampler, random);
   }
   double direction_pdf(uint32_t sampler, Vec direction) {
      return double(hemisphere_pdf(sampler, direction));
   }

   BsdfValue eval_bsdf(const furnace_material &material, Vec wo, Vec wi) {
      return eval_surface(known(material), wo, wi);
   }
   BsdfSample sample_bsdf(const furnace_material &material, Vec wo, const Numbers &random) {
      return sample_surface(known(material), wo, random);
   }

   furnace_adaptive_mean adaptive_mean(const furnace_adaptive &rule, const double *luminances,
                                       size_t count) {
      if (bench.has(FURNACE_TAKES_PIXEL)) return bench.adaptive_mean(rule, luminances, count);
      Tally tally;
      while (tally.count < count) {
         tally.add(Real(luminances[tally.count]));
         if (tally.may_stop(rule)) break;
      }
      return {double(tally.mean), tally.count, 0};
   }

   std::unique_ptr<Scene> build(const furnace_scene &scene, const furnace_build &settings) {
      for (uint32_t i = 0; i < scene.material_count; ++i) known(scene.materials[i]);
      return std::make_unique<Scene>(scene, settings);
   }

 private:
   template <class Shape> static Hit alone(const Shape &shape, const Ray &ray) {
      Hit hit;
      hit.shape = hit.primitive = 0;
      return shape.hit(ray, hit) ? hit : Hit();
   }
   static const furnace_material &known(const furnace_material &material) {
      if (material.kind > FURNACE_CONDUCTOR) throw furnace::Unsupported("an unknown material");
      return material;
   }
};

} // namespace pathtracer

FURNACE_CORE(pathtracer::PathTracer, "pathtracer.cpp", "1.0",
             FURNACE_BRUTE_FORCE | FURNACE_SPLIT_RULES | FURNACE_HEMISPHERE_SAMPLING |
                 FURNACE_ISOLATED_BOUNCES | FURNACE_DEPTH_LIMIT | FURNACE_ROULETTE |
                 FURNACE_ADAPTIVE_SAMPLING |
                 FURNACE_REPORTED_VARIANCE | FURNACE_STRATIFIED_PIXELS | FURNACE_COUNTS_TRAVERSAL |
                 FURNACE_CALLERS_RANDOMNESS | FURNACE_DETERMINISTIC |
                 FURNACE_INDEPENDENT_PIXELS | FURNACE_INDEPENDENT_SAMPLES | FURNACE_PLAIN_ESTIMATORS |
                 (pathtracer::IS_SINGLE ? FURNACE_SINGLE_PRECISION : 0))
