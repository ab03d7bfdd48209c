// How surfaces scatter. Directions are local (normal = +z), both away from the surface.
#ifndef PATHTRACER_SURFACES_HPP
#define PATHTRACER_SURFACES_HPP

#include "numbers.hpp"

namespace pathtracer {

inline const BsdfValue NOTHING{{0, 0, 0}, 0};
inline const BsdfSample FAILED{{0, 0, 1}, {0, 0, 0}, 0, 0, 0};

inline bool is_delta(const furnace_material &m) {
   return m.kind == FURNACE_MIRROR || m.kind == FURNACE_GLASS;
}
inline Vec mirrored(Vec w) { return {-w.x, -w.y, w.z}; }

// GGX microfacets with separable Smith masking-shadowing (Walter et al. 2007). Written with x^2 + y^2 in place of
// 1 - z^2: narrow lobes keep their digits.
inline Real ggx_density(Real alpha, Vec h) {
   Real a2 = alpha * alpha, s = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
   return a2 / (PI * s * s);
}

// G1(w) / cos(w)
inline Real masking_over_cosine(Real alpha, Vec w) {
   return 2 / (w.z + std::sqrt(w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y)));
}

// f, and the pdf of visible normals over the Jacobian of the reflection.
inline BsdfValue eval_conductor(const furnace_material &m, Vec wo, Vec wi) {
   Real alpha = Real(m.roughness);
   Real d = ggx_density(alpha, unit(wo + wi)), o = masking_over_cosine(alpha, wo);
   return {d * o * masking_over_cosine(alpha, wi) / 4 * Rgb(m.reflectance), d * o / 4};
}

// A visible microfacet is halfway between the view and a uniform point of a spherical cap, once the
// surface is stretched so that microfacets form a hemisphere (Dupuy and Benyoub 2023).
inline Vec sample_conductor(Real alpha, Vec wo, Point u) {
   Vec view = unit({alpha * wo.x, alpha * wo.y, wo.z});
   Vec stretched = view + below_pole(u.x * (1 + view.z), u.y);
   Vec h = unit({alpha * stretched.x, alpha * stretched.y, std::max(Real(0), stretched.z)});
   return 2 * dot(wo, h) * h - wo;
}

// Reflectance of light that arrives at `cosine`, by Fresnel's equations; `ratio` is the index of
// the far side over that of the near one, and `refracted` becomes the cosine there.
inline Real fresnel(Real cosine, Real ratio, Real &refracted) {
   Real sine2 = (1 - cosine * cosine) / (ratio * ratio);
   if (sine2 >= 1) return 1;
   refracted = std::sqrt(1 - sine2);
   Real s = (cosine - ratio * refracted) / (cosine + ratio * refracted);
   Real p = (ratio * cosine - refracted) / (ratio * cosine + refracted);
   return (s * s + p * p) / 2;
}

// A delta lobe: f such that f |cos| is the weight of the light along it.
inline BsdfSample only_way(Vec wi, Rgb weight, Real probability) {
   if (wi.z == 0 || !(probability > 0)) return FAILED;
   return {wi, weight / std::abs(wi.z), probability, 1, 1};
}

inline BsdfSample sample_glass(const furnace_material &m, Vec wo, Real lobe) {
   Real ratio = wo.z > 0 ? Real(m.index) : 1 / Real(m.index), cosine = 0;
   Real reflected = fresnel(std::abs(wo.z), ratio, cosine);
   if (lobe < reflected) return only_way(mirrored(wo), reflected * Rgb(m.reflectance), reflected);
   Vec wi = unit({-wo.x / ratio, -wo.y / ratio, -std::copysign(cosine, wo.z)});
   // Radiance over index squared is what crosses the surface unchanged.
   return only_way(wi, (1 - reflected) / (ratio * ratio) * Rgb(m.transmittance), 1 - reflected);
}

inline BsdfValue eval_surface(const furnace_material &m, Vec wo, Vec wi) {
   if (bench.has(FURNACE_TAKES_BSDF)) return bench.eval_bsdf(m, wo, wi);
   if (wo.z < 0) wo = -wo, wi = -wi; // all but glass scatter the same on both sides
   if (wo.z <= 0 || wi.z <= 0 || is_delta(m)) return NOTHING;
   if (m.kind == FURNACE_CONDUCTOR) return eval_conductor(m, wo, wi);
   return {Rgb(m.reflectance) / PI, wi.z / PI};
}

inline BsdfSample sample_surface(const furnace_material &m, Vec wo,
                                          const Numbers &random) {
   if (bench.has(FURNACE_TAKES_BSDF)) return bench.sample_bsdf(m, wo, random);
   if (m.kind == FURNACE_GLASS) return sample_glass(m, wo, random.lobe);
   if (m.kind == FURNACE_MIRROR) return only_way(mirrored(wo), m.reflectance, 1);
   Vec above = wo.z < 0 ? -wo : wo;
   Vec wi = m.kind == FURNACE_CONDUCTOR ? sample_conductor(Real(m.roughness), above, random.point)
                                        : sample_hemisphere(FURNACE_COSINE_HEMISPHERE, random).direction;
   auto [f, pdf] = eval_surface(m, above, wi);
   if (!(pdf > 0)) return FAILED;
   return {wo.z < 0 ? -wi : wi, f, pdf, 0, 1};
}

} // namespace pathtracer

#endif
