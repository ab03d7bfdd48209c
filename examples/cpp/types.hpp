// What the renderer computes with, and how the contract's doubles become it and go back.
//
// `c++ -DREAL=float ...` makes the same renderer in single precision: no double takes part in it.
#ifndef PATHTRACER_TYPES_HPP
#define PATHTRACER_TYPES_HPP

#include "furnace_core.hpp"

#include <algorithm>

#ifndef REAL
#define REAL double
#endif

namespace pathtracer {

using Real = REAL;
constexpr bool IS_SINGLE = sizeof(Real) == sizeof(float);
constexpr Real EPSILON = std::numeric_limits<Real>::epsilon();
constexpr Real INFINITE = std::numeric_limits<Real>::infinity();
constexpr Real BELOW_ONE = 1 - EPSILON / 2;
constexpr Real PI = Real(3.14159265358979323846);

struct Vec {
   Real x = 0, y = 0, z = 0;

   constexpr Vec() = default;
   constexpr Vec(Real x, Real y, Real z) : x(x), y(y), z(z) {}
   Vec(furnace_vec3 v) : x(Real(v.x)), y(Real(v.y)), z(Real(v.z)) {}
   operator furnace_vec3() const { return {double(x), double(y), double(z)}; }
};

inline Vec  operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec  operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec  operator-(Vec a) { return {-a.x, -a.y, -a.z}; }
inline Vec  operator*(Real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec  operator/(Vec a, Real s) { return {a.x / s, a.y / s, a.z / s}; }
inline Real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Real length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec  unit(Vec a) { return a / length(a); }
inline Vec  cross(Vec a, Vec b) {
   return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Rgb {
   Real r = 0, g = 0, b = 0;

   constexpr Rgb() = default;
   constexpr Rgb(Real r, Real g, Real b) : r(r), g(g), b(b) {}
   Rgb(furnace_rgb c) : r(Real(c.r)), g(Real(c.g)), b(Real(c.b)) {}
   operator furnace_rgb() const { return {double(r), double(g), double(b)}; }
};

inline Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Rgb operator*(Real s, Rgb a) { return {s * a.r, s * a.g, s * a.b}; }
inline Rgb operator*(Rgb a, Real s) { return s * a; }
inline Rgb operator/(Rgb a, Real s) { return {a.r / s, a.g / s, a.b / s}; }

struct Point {
   Real x, y;
};

// The caller's random numbers. The largest double below 1 would round to 1.
struct Numbers {
   Point point;
   Real  lobe;

   Numbers(Point point, Real lobe) : point(point), lobe(lobe) {}
   Numbers(const furnace::Numbers &n)
       : point{below_one(n.point.x), below_one(n.point.y)}, lobe(below_one(n.lobe)) {}
   operator furnace::Numbers() const {
      return {{double(point.x), double(point.y)}, double(lobe)};
   }

 private:
   static Real below_one(double number) { return std::min(Real(number), BELOW_ONE); }
};

struct Ray {
   Vec  origin;
   Real t_min;
   Vec  direction;
   Real t_max;

   Ray(Vec origin, Real t_min, Vec direction, Real t_max)
       : origin(origin), t_min(t_min), direction(direction), t_max(t_max) {}
   Ray(const furnace_ray &r)
       : origin(r.origin), t_min(Real(r.t_min)), direction(r.direction), t_max(Real(r.t_max)) {}
   operator furnace_ray() const { return {origin, double(t_min), direction, double(t_max)}; }
};

struct Hit {
   Real     t = INFINITE;
   uint32_t shape = FURNACE_NONE, primitive = FURNACE_NONE;
   Vec      geometric_normal, shading_normal;
   Point    uv{0, 0};

   Hit() = default;
   Hit(const furnace_hit &h)
       : t(Real(h.t)), shape(h.shape), primitive(h.primitive),
         geometric_normal(h.geometric_normal), shading_normal(h.shading_normal),
         uv{Real(h.uv.x), Real(h.uv.y)} {}
   operator furnace_hit() const {
      return {double(t),        shape,          primitive,
              geometric_normal, shading_normal, {double(uv.x), double(uv.y)}};
   }
};

struct DirectionSample {
   Vec  direction;
   Real pdf;

   DirectionSample(Vec direction, Real pdf) : direction(direction), pdf(pdf) {}
   DirectionSample(const furnace_direction_sample &s) : direction(s.direction), pdf(Real(s.pdf)) {}
   operator furnace_direction_sample() const { return {direction, double(pdf)}; }
};

struct BsdfValue {
   Rgb  f;
   Real pdf;

   BsdfValue(Rgb f, Real pdf) : f(f), pdf(pdf) {}
   BsdfValue(const furnace_bsdf_value &v) : f(v.f), pdf(Real(v.pdf)) {}
   operator furnace_bsdf_value() const { return {f, double(pdf)}; }
};

struct BsdfSample {
   Vec      wi;
   Rgb      f;
   Real     pdf;
   uint32_t is_delta, is_valid;

   BsdfSample(Vec wi, Rgb f, Real pdf, uint32_t is_delta, uint32_t is_valid)
       : wi(wi), f(f), pdf(pdf), is_delta(is_delta), is_valid(is_valid) {}
   BsdfSample(const furnace_bsdf_sample &s)
       : wi(s.wi), f(s.f), pdf(Real(s.pdf)), is_delta(s.is_delta), is_valid(s.is_valid) {}
   operator furnace_bsdf_sample() const { return {wi, f, double(pdf), is_delta, is_valid}; }
};

struct LightSample {
   Vec      wi;
   Real     distance;
   Rgb      radiance;
   Real     pdf;
   uint32_t is_delta, is_valid;

   LightSample(Vec wi, Real distance, Rgb radiance, Real pdf, uint32_t is_delta, uint32_t is_valid)
       : wi(wi), distance(distance), radiance(radiance), pdf(pdf), is_delta(is_delta),
         is_valid(is_valid) {}
   LightSample(const furnace_light_sample &s)
       : wi(s.wi), distance(Real(s.distance)), radiance(s.radiance), pdf(Real(s.pdf)),
         is_delta(s.is_delta), is_valid(s.is_valid) {}
   operator furnace_light_sample() const {
      return {wi, double(distance), radiance, double(pdf), is_delta, is_valid};
   }
};

} // namespace pathtracer

#endif
