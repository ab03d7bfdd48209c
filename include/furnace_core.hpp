// furnace_core.hpp: a renderer core in C++17, one ray at a time.
//
// Write a type with the methods you have, and name it:
//
//     #include "furnace_core.hpp"
//     struct Student {
//        furnace_ray generate_ray(const furnace_camera &camera, furnace_vec2 film) { ... }
//     };
//     FURNACE_CORE(Student, "student", "0.1", FURNACE_DETERMINISTIC)
//
// This header loops over the batches, stops exceptions (their what() reaches the report), and fills
// a function of furnace_core.h exactly where the type has the method. A method that is there but
// cannot be called as below is a compile-time error, never a silently missing one.
//
//     furnace_ray generate_ray(const furnace_camera &, furnace_vec2 film)
//     furnace_hit intersect_triangle(const furnace_vec3 *positions, const furnace_vec3 *normals,
//                                    const furnace_ray &)                             // 3 of each
//     furnace_hit intersect_sphere(furnace_vec3 centre, double radius, const furnace_ray &)
//     furnace_box_hit intersect_box(furnace_vec3 min, furnace_vec3 max, const furnace_ray &)
//     furnace_direction_sample sample_direction(uint32_t sampler, const furnace::Numbers &)
//     double direction_pdf(uint32_t sampler, furnace_vec3 direction)
//     furnace_bsdf_value eval_bsdf(const furnace_material &, furnace_vec3 wo, furnace_vec3 wi)
//     furnace_bsdf_sample sample_bsdf(const furnace_material &, furnace_vec3 wo,
//                                     const furnace::Numbers &)
//     furnace_adaptive_mean adaptive_mean(const furnace_adaptive &, const double *luminances,
//                                         size_t count)
//     std::unique_ptr<Built> build(const furnace_scene &, const furnace_build &)
//
// and of the type that `build` makes:
//
//     furnace_build_stats stats()
//     furnace_hit intersect(const furnace_ray &, furnace_traversal_stats &)
//     bool occluded(const furnace_ray &, furnace_traversal_stats &)
//     furnace_light_sample sample_light(uint32_t light, furnace_vec3 from,
//                                       const furnace::Numbers &)
//     furnace_rgb radiance(const furnace_ray &, const furnace_integrator &, size_t index)
//     void render(const furnace_camera &, const furnace_render &, float *pixels,
//                 uint32_t *sample_counts)  // and furnace_render::variances, if the core says so
//
// A core that can work with components of the bench in place of its own has
//
//     static constexpr uint32_t components = FURNACE_TAKES_BSDF | ...;
//     void take_components(const furnace::Bench &)
//
// keeps the furnace::Bench, and asks it wherever `has` says so.
//
// Two more, where they help: `static furnace_conventions conventions()` declares what the core has
// freely chosen, and `void seed(uint64_t)` is called before every batch that draws random numbers,
// for cores that have a generator of their own.
#ifndef FURNACE_CORE_HPP
#define FURNACE_CORE_HPP

#include "furnace_core.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <utility>

// ---- vectors and colours ------------------------------------------------------------------------

inline furnace_vec3 operator+(furnace_vec3 a, furnace_vec3 b) {
   return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline furnace_vec3 operator-(furnace_vec3 a, furnace_vec3 b) {
   return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline furnace_vec3 operator-(furnace_vec3 a) { return {-a.x, -a.y, -a.z}; }
inline furnace_vec3 operator*(double s, furnace_vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline furnace_vec3 operator*(furnace_vec3 a, double s) { return s * a; }
inline furnace_vec3 operator/(furnace_vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }

inline furnace_rgb operator+(furnace_rgb a, furnace_rgb b) {
   return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline furnace_rgb operator*(furnace_rgb a, furnace_rgb b) {
   return {a.r * b.r, a.g * b.g, a.b * b.b};
}
inline furnace_rgb operator*(double s, furnace_rgb a) { return {s * a.r, s * a.g, s * a.b}; }
inline furnace_rgb operator*(furnace_rgb a, double s) { return s * a; }
inline furnace_rgb operator/(furnace_rgb a, double s) { return {a.r / s, a.g / s, a.b / s}; }

namespace furnace {

inline double dot(furnace_vec3 a, furnace_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline furnace_vec3 cross(furnace_vec3 a, furnace_vec3 b) {
   return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(furnace_vec3 a) { return std::sqrt(dot(a, a)); }
inline furnace_vec3 unit(furnace_vec3 a) { return a / length(a); }

// The answer of a ray that meets nothing.
inline furnace_hit miss() {
   furnace_hit hit{};
   hit.t = std::numeric_limits<double>::infinity();
   hit.shape = hit.primitive = FURNACE_NONE;
   return hit;
}

// The caller's random numbers for one element, all in [0, 1).
struct Numbers {
   furnace_vec2 point; // the direction, or the point on the light
   double       lobe;  // which lobe, or which triangle of a mesh light
};

// The bench's own components, one element a call. `built` is furnace_build.bench of the scene at hand.
class Bench {
 public:
   Bench() = default;
   explicit Bench(const furnace_components &given) : core(given.bench), taken(given.taken) {}

   bool has(uint32_t component) const { return taken & component; }

   furnace_ray generate_ray(const furnace_camera &camera, furnace_vec2 film) const {
      return one<furnace_ray>(core->generate_rays, &camera, &film);
   }
   furnace_hit intersect_triangle(const furnace_vec3 *positions, const furnace_vec3 *normals,
                                  const furnace_ray &ray) const {
      return one<furnace_hit>(core->intersect_triangle, positions, normals, &ray);
   }
   furnace_hit intersect_sphere(furnace_vec3 centre, double radius, const furnace_ray &ray) const {
      return one<furnace_hit>(core->intersect_sphere, &centre, radius, &ray);
   }
   furnace_box_hit intersect_box(furnace_vec3 min, furnace_vec3 max, const furnace_ray &ray) const {
      return one<furnace_box_hit>(core->intersect_box, &min, &max, &ray);
   }
   furnace_direction_sample sample_direction(uint32_t sampler, const Numbers &numbers) const {
      furnace_randomness random{&numbers.point, &numbers.lobe, 0};
      return one<furnace_direction_sample>(core->sample_direction, sampler, &random);
   }
   double direction_pdf(uint32_t sampler, furnace_vec3 direction) const {
      return one<double>(core->direction_pdf, sampler, &direction);
   }
   furnace_bsdf_value eval_bsdf(const furnace_material &material, furnace_vec3 wo,
                                furnace_vec3 wi) const {
      furnace_bsdf_query query{wo, wi};
      return one<furnace_bsdf_value>(core->eval_bsdf, &material, &query);
   }
   furnace_bsdf_sample sample_bsdf(const furnace_material &material, furnace_vec3 wo,
                                   const Numbers &numbers) const {
      furnace_randomness random{&numbers.point, &numbers.lobe, 0};
      return one<furnace_bsdf_sample>(core->sample_bsdf, &material, &wo, &random);
   }
   furnace_hit intersect(furnace_built *built, const furnace_ray &ray) const {
      furnace_hit             hit{};
      furnace_traversal_stats unused{};
      good(core->intersect(core->self, built, &ray, &hit, 1, &unused));
      return hit;
   }
   bool occluded(furnace_built *built, const furnace_ray &ray) const {
      uint8_t                 is{};
      furnace_traversal_stats unused{};
      good(core->occluded(core->self, built, &ray, &is, 1, &unused));
      return is != 0;
   }
   furnace_light_sample sample_light(furnace_built *built, uint32_t light, furnace_vec3 from,
                                     const Numbers &numbers) const {
      furnace_randomness random{&numbers.point, &numbers.lobe, 0};
      return one<furnace_light_sample>(core->sample_light, built, light, &from, &random);
   }
   // Of these bounces, with random numbers of this seed; settings say the rest.
   furnace_rgb radiance(furnace_built *built, const furnace_ray &ray, furnace_integrator settings,
                        uint32_t first_bounce, uint32_t last_bounce, uint64_t seed) const {
      settings.first_bounce = first_bounce, settings.last_bounce = last_bounce;
      settings.seed = seed, settings.threads = 1;
      return one<furnace_rgb>(core->radiance, built, &ray, &settings);
   }
   furnace_adaptive_mean adaptive_mean(const furnace_adaptive &rule, const double *luminances,
                                       size_t count) const {
      furnace_stream stream{luminances, count};
      return one<furnace_adaptive_mean>(core->adaptive_mean, &rule, &stream);
   }

 private:
   const furnace_core *core = nullptr;
   uint32_t            taken = 0;

   static void good(furnace_status status) {
      if (status != FURNACE_OK) throw std::runtime_error("the bench cannot answer this");
   }
   template <class Answer, class Function, class... Arguments>
   Answer one(Function function, Arguments... arguments) const {
      Answer answer{};
      good(function(core->self, arguments..., &answer, 1));
      return answer;
   }
};

// Throw it for a request that is beyond the core: the trial is skipped, not failed.
struct Unsupported : std::runtime_error {
   using std::runtime_error::runtime_error;
};

namespace detail {

template <class T> T some();

// has_X<T>: T has a method X that can be called so. names_X<T>: T has a method of that name.
#define FURNACE_METHOD(method, arguments)                                                         \
   template <class T, class = void> struct has_##method : std::false_type {};                     \
   template <class T>                                                                             \
   struct has_##method<T, std::void_t<decltype(some<T &>().method arguments)>>                    \
       : std::true_type {};                                                                       \
   template <class T, class = void> struct names_##method : std::false_type {};                   \
   template <class T>                                                                             \
   struct names_##method<T, std::void_t<decltype(&T::method)>> : std::true_type {};

FURNACE_METHOD(conventions, ())
FURNACE_METHOD(seed, (uint64_t{}))
FURNACE_METHOD(generate_ray, (some<const furnace_camera &>(), furnace_vec2{}))
FURNACE_METHOD(intersect_triangle, (some<const furnace_vec3 *>(), some<const furnace_vec3 *>(),
                                    some<const furnace_ray &>()))
FURNACE_METHOD(intersect_sphere, (furnace_vec3{}, double{}, some<const furnace_ray &>()))
FURNACE_METHOD(intersect_box, (furnace_vec3{}, furnace_vec3{}, some<const furnace_ray &>()))
FURNACE_METHOD(sample_direction, (uint32_t{}, some<const Numbers &>()))
FURNACE_METHOD(direction_pdf, (uint32_t{}, furnace_vec3{}))
FURNACE_METHOD(eval_bsdf, (some<const furnace_material &>(), furnace_vec3{}, furnace_vec3{}))
FURNACE_METHOD(sample_bsdf, (some<const furnace_material &>(), furnace_vec3{},
                             some<const Numbers &>()))
FURNACE_METHOD(adaptive_mean, (some<const furnace_adaptive &>(), some<const double *>(), size_t{}))
FURNACE_METHOD(build, (some<const furnace_scene &>(), some<const furnace_build &>()))
FURNACE_METHOD(take_components, (some<const Bench &>()))
FURNACE_METHOD(stats, ())
FURNACE_METHOD(intersect, (some<const furnace_ray &>(), some<furnace_traversal_stats &>()))
FURNACE_METHOD(occluded, (some<const furnace_ray &>(), some<furnace_traversal_stats &>()))
FURNACE_METHOD(sample_light, (uint32_t{}, furnace_vec3{}, some<const Numbers &>()))
FURNACE_METHOD(radiance, (some<const furnace_ray &>(), some<const furnace_integrator &>(),
                          size_t{}))
FURNACE_METHOD(render, (some<const furnace_camera &>(), some<const furnace_render &>(),
                        some<float *>(), some<uint32_t *>()))
#undef FURNACE_METHOD

// What `Core::build` makes, behind its unique_ptr.
template <class Core> struct BuiltBy {
   using pointer =
       decltype(some<Core &>().build(some<const furnace_scene &>(), some<const furnace_build &>()));
   using type = typename pointer::element_type;
};

// The functions of furnace_core.h over the methods of a type.
template <class Core> class Table {
 public:
   static const furnace_core *make(const char *name, const char *version, uint32_t traits) {
      static State state;
      static furnace_core table = filled(state, name, version, traits);
      return &table;
   }

 private:
   struct State {
      Core core{};
      char error[1024] = "";

      void fail(const char *why) { std::snprintf(error, sizeof error, "%s", why); }
   };

   static Core &core(void *self) { return static_cast<State *>(self)->core; }

   // Runs a request; no exception leaves it.
   template <class Request> static furnace_status guarded(void *self, Request &&request) noexcept {
      auto &state = *static_cast<State *>(self);
      try {
         request();
         return FURNACE_OK;
      } catch (const Unsupported &error) {
         state.fail(error.what());
         return FURNACE_UNSUPPORTED;
      } catch (const std::bad_alloc &) {
         state.fail("out of memory (std::bad_alloc)");
      } catch (const std::exception &error) {
         state.fail(error.what());
      } catch (...) {
         state.fail("an exception that is no std::exception");
      }
      return FURNACE_FAILED;
   }

   template <class One> static furnace_status each(void *self, size_t count, One &&one) noexcept {
      return guarded(self, [&] {
         for (size_t i = 0; i < count; ++i) one(i);
      });
   }

   // As `each`, with random numbers; a core that has a generator of its own is told the seed.
   template <class One>
   static furnace_status draw(void *self, const furnace_randomness *random, size_t count,
                              One &&one) noexcept {
      return guarded(self, [&] {
         seed(self, random->seed);
         for (size_t i = 0; i < count; ++i) one(i, Numbers{random->points[i], random->lobes[i]});
      });
   }

   static void seed([[maybe_unused]] void *self, [[maybe_unused]] uint64_t seed) {
      if constexpr (has_seed<Core>::value) core(self).seed(seed);
   }

#define FURNACE_FILL(function, method, type, ...)                                                 \
   static_assert(has_##method<type>::value || !names_##method<type>::value,                       \
                 #method " is there, but cannot be called as furnace_core.hpp says");             \
   if constexpr (has_##method<type>::value) table.function = __VA_ARGS__;

   static furnace_core filled(State &state, const char *name, const char *version,
                              uint32_t traits) {
      furnace_core table{};
      table.abi = FURNACE_ABI;
      table.struct_size = sizeof table;
      table.traits = traits;
      table.name = name;
      table.version = version;
      table.self = &state;
      table.last_error = [](void *self) -> const char * {
         return static_cast<State *>(self)->error;
      };
      if constexpr (has_conventions<Core>::value) table.conventions = Core::conventions();
      fill_functions(table);
      FURNACE_FILL(take_components, take_components, Core, &take_components)
      if constexpr (has_take_components<Core>::value) table.components = Core::components;
      FURNACE_FILL(build, build, Core, &build)
      if constexpr (has_build<Core>::value) fill_built(table);
      return table;
   }

   static void fill_functions([[maybe_unused]] furnace_core &table) {
      FURNACE_FILL(generate_rays, generate_ray, Core,
                   [](void *self, const furnace_camera *camera, const furnace_vec2 *film,
                      furnace_ray *out, size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).generate_ray(*camera, film[i]);
                      });
                   })
      FURNACE_FILL(intersect_triangle, intersect_triangle, Core,
                   [](void *self, const furnace_vec3 *positions, const furnace_vec3 *normals,
                      const furnace_ray *rays, furnace_hit *out, size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).intersect_triangle(positions, normals, rays[i]);
                      });
                   })
      FURNACE_FILL(intersect_sphere, intersect_sphere, Core,
                   [](void *self, const furnace_vec3 *centre, double radius,
                      const furnace_ray *rays, furnace_hit *out, size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).intersect_sphere(*centre, radius, rays[i]);
                      });
                   })
      FURNACE_FILL(intersect_box, intersect_box, Core,
                   [](void *self, const furnace_vec3 *min, const furnace_vec3 *max,
                      const furnace_ray *rays, furnace_box_hit *out, size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).intersect_box(*min, *max, rays[i]);
                      });
                   })
      FURNACE_FILL(sample_direction, sample_direction, Core,
                   [](void *self, uint32_t sampler, const furnace_randomness *random,
                      furnace_direction_sample *out, size_t count) {
                      return draw(self, random, count, [=](size_t i, const Numbers &numbers) {
                         out[i] = core(self).sample_direction(sampler, numbers);
                      });
                   })
      FURNACE_FILL(direction_pdf, direction_pdf, Core,
                   [](void *self, uint32_t sampler, const furnace_vec3 *directions, double *out,
                      size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).direction_pdf(sampler, directions[i]);
                      });
                   })
      FURNACE_FILL(eval_bsdf, eval_bsdf, Core,
                   [](void *self, const furnace_material *material, const furnace_bsdf_query *in,
                      furnace_bsdf_value *out, size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).eval_bsdf(*material, in[i].wo, in[i].wi);
                      });
                   })
      FURNACE_FILL(sample_bsdf, sample_bsdf, Core,
                   [](void *self, const furnace_material *material, const furnace_vec3 *wo,
                      const furnace_randomness *random, furnace_bsdf_sample *out, size_t count) {
                      return draw(self, random, count, [=](size_t i, const Numbers &numbers) {
                         out[i] = core(self).sample_bsdf(*material, wo[i], numbers);
                      });
                   })
      FURNACE_FILL(adaptive_mean, adaptive_mean, Core,
                   [](void *self, const furnace_adaptive *settings, const furnace_stream *streams,
                      furnace_adaptive_mean *out, size_t count) {
                      return each(self, count, [=](size_t i) {
                         out[i] = core(self).adaptive_mean(*settings, streams[i].values,
                                                           streams[i].count);
                      });
                   })
   }

   static furnace_status take_components(void *self, const furnace_components *components) {
      return guarded(self, [=] { core(self).take_components(Bench(*components)); });
   }

   static furnace_status build(void *self, const furnace_scene *scene,
                               const furnace_build *settings, furnace_built **out,
                               furnace_build_stats *stats) {
      return guarded(self, [=] {
         auto built = core(self).build(*scene, *settings);
         if (!built) throw std::runtime_error("build answered no scene");
         if constexpr (has_stats<typename BuiltBy<Core>::type>::value) *stats = built->stats();
         *out = reinterpret_cast<furnace_built *>(built.release());
      });
   }

   static void fill_built(furnace_core &table) {
      using Built = typename BuiltBy<Core>::type;
      static_assert(std::is_same_v<typename BuiltBy<Core>::pointer, std::unique_ptr<Built>>,
                    "build is to answer a std::unique_ptr");
      static constexpr auto scene = [](furnace_built *built) -> Built & {
         return *reinterpret_cast<Built *>(built);
      };
      table.release = [](void *, furnace_built *built) { delete &scene(built); };
      FURNACE_FILL(intersect, intersect, Built,
                   [](void *self, furnace_built *built, const furnace_ray *rays, furnace_hit *out,
                      size_t count, furnace_traversal_stats *stats) {
                      stats->rays = count;
                      return each(self, count, [=](size_t i) {
                         out[i] = scene(built).intersect(rays[i], *stats);
                      });
                   })
      FURNACE_FILL(occluded, occluded, Built,
                   [](void *self, furnace_built *built, const furnace_ray *rays, uint8_t *out,
                      size_t count, furnace_traversal_stats *stats) {
                      stats->rays = count;
                      return each(self, count, [=](size_t i) {
                         out[i] = scene(built).occluded(rays[i], *stats) ? 1 : 0;
                      });
                   })
      FURNACE_FILL(sample_light, sample_light, Built,
                   [](void *self, furnace_built *built, uint32_t light, const furnace_vec3 *from,
                      const furnace_randomness *random, furnace_light_sample *out, size_t count) {
                      return draw(self, random, count, [=](size_t i, const Numbers &numbers) {
                         out[i] = scene(built).sample_light(light, from[i], numbers);
                      });
                   })
      FURNACE_FILL(radiance, radiance, Built,
                   [](void *self, furnace_built *built, const furnace_ray *rays,
                      const furnace_integrator *settings, furnace_rgb *out, size_t count) {
                      return guarded(self, [=] {
                         seed(self, settings->seed);
                         for (size_t i = 0; i < count; ++i)
                            out[i] = scene(built).radiance(rays[i], *settings, i);
                      });
                   })
      FURNACE_FILL(render, render, Built,
                   [](void *self, furnace_built *built, const furnace_camera *camera,
                      const furnace_render *settings, float *pixels, uint32_t *sample_counts) {
                      return guarded(self, [=] {
                         seed(self, settings->integrator->seed);
                         scene(built).render(*camera, *settings, pixels, sample_counts);
                      });
                   })
   }
#undef FURNACE_FILL
};

template <class Core>
const furnace_core *entry(uint32_t bench_abi, const char *name, const char *version,
                          uint32_t traits) noexcept {
   if (bench_abi != FURNACE_ABI) return nullptr;
   try {
      return Table<Core>::make(name, version, traits);
   } catch (const std::exception &error) {
      std::fprintf(stderr, "the core cannot be made: %s\n", error.what());
   } catch (...) {
      std::fprintf(stderr, "the core cannot be made: an exception that is no std::exception\n");
   }
   return nullptr;
}

} // namespace detail
} // namespace furnace

// Exports `Type` as the core of this library. Once a library, outside every namespace.
#define FURNACE_CORE(Type, name, version, traits)                                                 \
   extern "C" FURNACE_EXPORT const furnace_core *furnace_core_entry(uint32_t bench_abi) {         \
      return furnace::detail::entry<Type>(bench_abi, name, version, traits);                      \
   }

#endif // FURNACE_CORE_HPP
