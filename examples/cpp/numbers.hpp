// Random numbers, and directions around an axis.
#ifndef PATHTRACER_NUMBERS_HPP
#define PATHTRACER_NUMBERS_HPP

#include "types.hpp"

#include <array>
#include <vector>

namespace pathtracer {

using furnace::Bench;
using Stats = furnace_traversal_stats;

inline bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }
inline Real luminance(Rgb c) { return Real(0.2126) * c.r + Real(0.7152) * c.g + Real(0.0722) * c.b; }
inline Real largest(Vec v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }
inline Real at(const Vec &v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
inline Vec  point_on(const Ray &ray, Real t) { return ray.origin + t * ray.direction; }

// Components that the bench lends in place of ours, to tell which of ours is broken.
inline Bench bench;

// SplitMix64 (Steele, Lea and Flood 2014). Every ray and every sample of a pixel has a stream of
// its own, so that no answer depends on threads.
class Random {
 public:
   Random(uint64_t seed, uint64_t stream, uint64_t sample)
       : state(mix(mix(mix(seed) + stream) + sample)) {}

   // As many bits as a Real holds: the largest number stays below 1.
   Real number() {
      return Real(mix(state += 0x9e3779b97f4a7c15) >> (64 - DIGITS)) * (EPSILON / 2);
   }
   uint64_t seed() { return mix(state += 0x9e3779b97f4a7c15); }
   Numbers  numbers() {
      Real x = number(), y = number();
      return Numbers({x, y}, number());
   }

 private:
   static constexpr int DIGITS = std::numeric_limits<Real>::digits;
   static uint64_t mix(uint64_t z) {
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
      z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
      return z ^ (z >> 31);
   }
   uint64_t state;
};


// An orthonormal frame around a unit vector (Duff et al. 2017).
struct Frame {
   Vec x, y, z;
   explicit Frame(Vec axis) : z(axis) {
      Real sign = std::copysign(Real(1), axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
      x = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
      y = {b, sign + axis.y * axis.y * a, -axis.y};
   }
   Vec to_world(Vec v) const { return v.x * x + v.y * y + v.z * z; }
   Vec to_local(Vec v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
};

// The unit vector whose z is 1 - depth, at `turn` of a full turn; exact for small depths.
inline Vec below_pole(Real depth, Real turn) {
   Real sine = std::sqrt(std::max(Real(0), depth * (2 - depth)));
   return {sine * std::cos(2 * PI * turn), sine * std::sin(2 * PI * turn), 1 - depth};
}

inline Vec uniform_hemisphere(Point u) { return below_pole(u.x, u.y); }
inline Vec cosine_hemisphere(Point u) {
   Real radius = std::sqrt(u.x);
   return {radius * std::cos(2 * PI * u.y), radius * std::sin(2 * PI * u.y), std::sqrt(1 - u.x)};
}

inline Real hemisphere_pdf(uint32_t sampler, Vec direction) {
   if (bench.has(FURNACE_TAKES_DIRECTION_SAMPLING)) return Real(bench.direction_pdf(sampler, direction));
   if (direction.z <= 0) return 0;
   return sampler == FURNACE_COSINE_HEMISPHERE ? direction.z / PI : 1 / (2 * PI);
}
inline DirectionSample sample_hemisphere(uint32_t sampler, const Numbers &random) {
   if (bench.has(FURNACE_TAKES_DIRECTION_SAMPLING)) return bench.sample_direction(sampler, random);
   Vec direction = sampler == FURNACE_COSINE_HEMISPHERE ? cosine_hemisphere(random.point)
                                                        : uniform_hemisphere(random.point);
   return {direction, hemisphere_pdf(sampler, direction)};
}

} // namespace pathtracer

#endif
