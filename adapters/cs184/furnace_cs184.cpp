// furnace_cs184.cpp: the course's path tracer (CS184, homework 3 / project 3-1, spring 2021 and later) as a core of
// furnace. CMakeLists.txt builds it with a submission that stays as it is, see README.md.
//
// What is judged are the seven files that students write: camera, bsdf, pathtracer, triangle, sphere, bbox, bvh. What the
// course gives is replaced where it would stand in the way:
//
// - samplers and coin flips: here and in course/, seeded by the bench. The course's sampler.cpp is left out.
// - lights: here, with the pdf with respect to solid angle; the course's own area light forgets one factor of distance.
// - primitives: wrapped, so that tests are counted, surfaces scatter on both sides and emitters are one-sided.
// - images: radiance as the sample buffer has it, before any tone curve.
// - whatever the bench asks to replace by its own, see "between the submission and its own functions".
//
// What the submission has not written yet answers as the skeleton does: it is found out once (`Written`), and not asked.
#include "furnace_core.hpp"

#include "CGL/CGL.h"
#include "pathtracer/bsdf.h"
#include "pathtracer/camera.h"
#include "pathtracer/pathtracer.h"
#include "pathtracer/sampler.h"
#include "scene/bvh.h"
#include "scene/object.h"
#include "scene/sphere.h"
#include "scene/triangle.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <csignal>
#include <deque>
#include <dlfcn.h>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <sys/time.h>
#include <tuple>
#include <vector>

// ---- random numbers -----------------------------------------------------------------------------

namespace {

// The bench's numbers: what it hands over comes first, then those of its seed.
struct Stream {
   std::mt19937_64    engine;
   std::deque<double> given;

   double next() {
      if (given.empty()) return std::generate_canonical<double, 53>(engine);
      const double number = given.front();
      given.pop_front();
      return number;
   }
};

Stream &stream() {
   static Stream stream;
   return stream;
}

constexpr double pi = 3.14159265358979323846;

} // namespace

namespace CGL {

double number_of_the_bench() { return stream().next(); }

Vector2D UniformGridSampler2D::get_sample() const {
   const double x = stream().next();
   return Vector2D(x, stream().next());
}

Vector3D UniformSphereSampler3D::get_sample() const {
   const double z = 2 * stream().next() - 1, phi = 2 * pi * stream().next();
   const double radius = std::sqrt(std::max(0.0, 1 - z * z));
   return Vector3D(radius * std::cos(phi), radius * std::sin(phi), z);
}

Vector3D UniformHemisphereSampler3D::get_sample() const {
   const double z = stream().next(), phi = 2 * pi * stream().next();
   const double radius = std::sqrt(std::max(0.0, 1 - z * z));
   return Vector3D(radius * std::cos(phi), radius * std::sin(phi), z);
}

Vector3D CosineWeightedHemisphereSampler3D::get_sample() const {
   double pdf;
   return get_sample(&pdf);
}

Vector3D CosineWeightedHemisphereSampler3D::get_sample(double *pdf) const {
   const double square = stream().next(), phi = 2 * pi * stream().next();
   const double radius = std::sqrt(square), z = std::sqrt(std::max(0.0, 1 - square));
   *pdf = z / pi;
   return Vector3D(radius * std::cos(phi), radius * std::sin(phi), z);
}

} // namespace CGL

namespace {

using CGL::BBox;
using CGL::BSDF;
using CGL::PathTracer;
using CGL::Ray;
using CGL::Vector3D;
using CGL::SceneObjects::BVHAccel;
using CGL::SceneObjects::BVHNode;
using CGL::SceneObjects::Intersection;
using CGL::SceneObjects::Primitive;
using CGL::SceneObjects::SceneLight;

constexpr double infinity = std::numeric_limits<double>::infinity();

// What of the homework is there. The rest answers as the skeleton does.
struct Written {
   bool camera = true, triangle = true, sphere = true, box = true; // parts 1 and 2
   bool hierarchy = true;                                          // more than one leaf
   bool pixels = true;                                             // the loop over a pixel's samples
   bool path = true; // est_radiance_global_illumination shows light, not normals
   bool f = true, sample_f = true;
   bool emission = true, direct = true, by_light = true, by_hemisphere = true; // part 3
   bool indirect = true, adaptive = true;                                      // parts 4 and 5
   bool in_float = false; // not in doubles, as the skeleton declares them
};

Written &written() {
   static Written written;
   return written;
}

void ask_for(bool written, const char *what) {
   if (!written) throw furnace::Unsupported(std::string("not written yet: ") + what);
}

// ---- the bench's components ---------------------------------------------------------------------

// What of the submission is replaced by the bench's own.
furnace::Bench &bench() {
   static furnace::Bench bench;
   return bench;
}

bool takes(uint32_t component) { return bench().has(component); }

// The submission's own function of that name. The submission is a library of its own, which this one needs: the loader
// looks for what the submission calls here first, and so finds the functions at the end of this file.
template <class Function> Function *submitted(const char *symbol) {
   void *found = dlsym(RTLD_NEXT, symbol);
   if (!found) throw std::runtime_error(std::string("the submission has no ") + symbol);
   return reinterpret_cast<Function *>(found);
}

// The functions of light along a ray, by the names that the loader knows.
#define LIGHT_OF(name) "_ZN3CGL10PathTracer" name "ERKNS_3RayERKNS_12SceneObjects12IntersectionE"
#define ZERO_BOUNCE LIGHT_OF("20zero_bounce_radiance")
#define ONE_BOUNCE LIGHT_OF("19one_bounce_radiance")
#define BY_HEMISPHERE LIGHT_OF("35estimate_direct_lighting_hemisphere")
#define BY_LIGHT LIGHT_OF("35estimate_direct_lighting_importance")

// What is put before the submission's own by the loader. A function that the submission has given more parameters has
// another name there.
uint32_t interposed() {
#ifdef __ELF__
   const auto has = [](const char *symbol) { return dlsym(RTLD_NEXT, symbol) != nullptr; };
   const bool emission = has(ZERO_BOUNCE);
   const bool direct = has(ONE_BOUNCE) && has(BY_HEMISPHERE) && has(BY_LIGHT);
   return FURNACE_TAKES_CAMERA | FURNACE_TAKES_BOX_TEST | (emission ? FURNACE_TAKES_EMISSION : 0) |
          (direct ? FURNACE_TAKES_DIRECT_LIGHTING : 0);
#else
   return 0;
#endif
}

// Light by a function of the submission. What it has been given to take beside, for fog say, is 0.
template <class... More>
Vector3D light(Vector3D (PathTracer::*along)(const Ray &, const Intersection &, More...),
               PathTracer &tracer, const Ray &ray, const Intersection &hit) {
   std::tuple<std::decay_t<More>...> none{};
   return std::apply([&](auto &...more) { return (tracer.*along)(ray, hit, more...); }, none);
}

// ---- from one side to the other -----------------------------------------------------------------

Vector3D    theirs(furnace_vec3 v) { return Vector3D(v.x, v.y, v.z); }
Vector3D    theirs(furnace_rgb c) { return Vector3D(c.r, c.g, c.b); }
furnace_vec3 ours(const Vector3D &v) { return {v.x, v.y, v.z}; }
furnace_rgb  our_colour(const Vector3D &v) { return {v.x, v.y, v.z}; }

// The course's constructors leave out what is not set here.
Ray theirs(const furnace_ray &ray) {
   Ray made(theirs(ray.origin), theirs(ray.direction));
   made.min_t = ray.t_min;
   made.max_t = ray.t_max;
   made.depth = 0;
   return made;
}

furnace_ray ours(const Ray &ray) { return {ours(ray.o), ray.min_t, ours(ray.d), ray.max_t}; }

// The camera's placement is private; naming a member in an explicit instantiation is allowed.
template <class Tag, typename Tag::type member> struct Open {
   friend typename Tag::type open(Tag) { return member; }
};
#define OPEN(Tag, Type, member)                                                                   \
   struct Tag {                                                                                   \
      typedef Type CGL::Camera::*type;                                                            \
      friend type open(Tag);                                                                      \
   };                                                                                             \
   template struct Open<Tag, &CGL::Camera::member>;
OPEN(HorizontalFov, double, hFov)
OPEN(VerticalFov, double, vFov)
OPEN(Near, double, nClip)
OPEN(Far, double, fClip)
OPEN(Position, Vector3D, pos)
OPEN(CameraToWorld, CGL::Matrix3x3, c2w)
#undef OPEN

CGL::Camera theirs(const furnace_camera &camera) {
   CGL::Camera made;
   made.*open(HorizontalFov()) = camera.horizontal_fov * 180 / pi;
   made.*open(VerticalFov()) = camera.vertical_fov * 180 / pi;
   made.*open(Near()) = camera.near_clip;
   made.*open(Far()) = camera.far_clip;
   made.*open(Position()) = theirs(camera.position);
   const furnace_vec3 axes[3] = {camera.right, camera.up, camera.backward};
   for (int column = 0; column < 3; ++column) {
      (made.*open(CameraToWorld()))(0, column) = axes[column].x;
      (made.*open(CameraToWorld()))(1, column) = axes[column].y;
      (made.*open(CameraToWorld()))(2, column) = axes[column].z;
   }
   // A pinhole, in focus where the course's program is: with a distance of 0 a right thin lens divides by it.
   made.lensRadius = 0;
   made.focalDistance = 4.7;
   return made;
}

// The camera that the submission looks through.
struct View {
   furnace_camera given;
   CGL::Camera    camera;

   explicit View(const furnace_camera &given)
       : given(given), camera(theirs(given)), before(last()) {
      last() = this;
   }
   ~View() { last() = before; }
   View(const View &) = delete;

   static const View *&last() {
      static const View *last = nullptr;
      return last;
   }

 private:
   const View *before;
};

// ---- materials ----------------------------------------------------------------------------------

// A diffuse surface by the student, which may also emit.
struct Surface : BSDF {
   CGL::DiffuseBSDF diffuse;
   furnace_material declared{};
   Vector3D         glow;

   // Images of bounce 0 alone are those of black surfaces: few submissions are right at a depth of 0.
   static bool &all_black() {
      static bool all_black = false;
      return all_black;
   }

   Surface(const Vector3D &reflectance, const Vector3D &glow) : diffuse(reflectance), glow(glow) {
      declared.kind = FURNACE_DIFFUSE;
      declared.reflectance = our_colour(reflectance);
   }
   Vector3D f(const Vector3D wo, const Vector3D wi) override {
      if (all_black()) return Vector3D();
      if (takes(FURNACE_TAKES_BSDF))
         return theirs(bench().eval_bsdf(declared, above(wo), above(wi)).f);
      return diffuse.f(wo, wi);
   }
   Vector3D sample_f(const Vector3D wo, Vector3D *wi, double *pdf) override {
      const Vector3D f = takes(FURNACE_TAKES_BSDF) ? sample_of_bench(wo, wi, pdf)
                                                   : diffuse.sample_f(wo, wi, pdf);
      return all_black() ? Vector3D() : f;
   }
   // A diffuse `f` need not know of sides, nor of the space of its directions: some hand it those of the world.
   static furnace_vec3 above(const Vector3D &w) { return {w.x, w.y, std::fabs(w.z)}; }
   Vector3D sample_of_bench(const Vector3D &wo, Vector3D *wi, double *pdf) const {
      furnace::Numbers numbers{};
      numbers.point.x = stream().next(), numbers.point.y = stream().next();
      const furnace_bsdf_sample sample = bench().sample_bsdf(declared, ours(wo), numbers);
      *wi = theirs(sample.wi), *pdf = sample.is_valid ? sample.pdf : 0;
      return theirs(sample.f);
   }
   Vector3D get_emission() const override { return glow; }
   bool     is_delta() const override { return false; }
};

struct Material {
   furnace_material declared;
   Surface          dark, lit;

   explicit Material(const furnace_material &material)
       : declared(material), dark(theirs(material.reflectance), Vector3D()),
         lit(theirs(material.reflectance),
             material.emits ? theirs(material.emission) : Vector3D()) {
      if (material.kind != FURNACE_DIFFUSE)
         throw furnace::Unsupported("mirrors, glass or metal: they are project 3-2");
   }

   // What is seen from the front at `outward` (unit) from the middle of a sphere.
   Surface &front(furnace_vec3 outward) {
      const double cosine = std::cos(declared.cap_half_angle);
      const bool   in_cap = declared.cap_half_angle == 0 ||
                          furnace::dot(outward, declared.cap_axis) >= cosine;
      return in_cap ? lit : dark;
   }
};

// ---- primitives ---------------------------------------------------------------------------------

struct Counts {
   uint64_t tests = 0;
   // Rays of this depth see no light: those of the camera, where single bounces are asked for. Whether a
   // submission adds directly visible emission to every single bounce is left open by the course.
   size_t blind_depth = SIZE_MAX;
   // Before part 3 a ray shows the normal that it meets: a normal that shows as the light there should.
   bool normals_show_light = false;
};

Vector3D normal_that_shows(const Vector3D &light) { return 2 * light - Vector3D(1); }

// A primitive of the scene around one of the student's.
struct Facet : Primitive {
   uint32_t  shape, number;
   Material *material;
   Counts   *counts;

   Facet(uint32_t shape, uint32_t number, Material *material, Counts *counts)
       : shape(shape), number(number), material(material), counts(counts) {}
   virtual const Primitive &inner() const = 0;
   virtual Vector3D         geometric_normal(const Vector3D &point) const = 0;
   // 1 where the course's normals point as the scene's do, -1 where they are the other way.
   virtual double orientation() const { return 1; }

   // The bench's test for it, and whether it stands in for the student's.
   virtual furnace_hit hit_of_bench(const furnace_ray &ray) const = 0;
   virtual bool        is_tested_by_bench() const = 0;

   BBox get_bbox() const override { return inner().get_bbox(); }
   bool has_intersection(const Ray &ray) const override {
      ++counts->tests;
      if (!is_tested_by_bench()) return inner().has_intersection(ray);
      const furnace_hit found = hit_of_bench(ours(ray));
      if (found.primitive == FURNACE_NONE) return false;
      // Many an any-hit ends the ray where it hits, and a BVH may go by that; what follows may find this hit again.
      ray.max_t = std::nextafter(found.t, INFINITY);
      return true;
   }
   bool intersect(const Ray &ray, Intersection *hit) const override {
      ++counts->tests;
      if (is_tested_by_bench()) {
         furnace_hit found = hit_of_bench(ours(ray));
         // Spheres alone have their normals outward.
         found.shading_normal = orientation() * found.shading_normal;
         return found.primitive != FURNACE_NONE && describe(ray, hit, found);
      }
      if (!inner().intersect(ray, hit)) return false;
      hit->n = orientation() * hit->n;
      return describe(ray, hit);
   }
   // A hit that the bench has found, its normal as the scene has it.
   bool describe(const Ray &ray, Intersection *hit, const furnace_hit &found) const {
      ray.max_t = hit->t = found.t;
      hit->n = theirs(found.shading_normal);
      return describe(ray, hit);
   }
   bool describe(const Ray &ray, Intersection *hit) const {
      const Vector3D geometric = geometric_normal(ray.o + hit->t * ray.d);
      const bool     from_front = CGL::dot(geometric, ray.d) < 0;
      hit->primitive = this;
      const bool sees = from_front && ray.depth != counts->blind_depth;
      hit->bsdf = sees ? &material->front(ours(orientation() * geometric)) : &material->dark;
      // The course shades one side; scenes here are seen from both.
      if (!from_front) hit->n = -hit->n;
      if (counts->normals_show_light) hit->n = normal_that_shows(hit->bsdf->get_emission());
      return true;
   }
   BSDF *get_bsdf() const override { return &material->dark; }
   void  draw(const CGL::Color &, float) const override {}
   void  drawOutline(const CGL::Color &, float) const override {}
};

// Whether a triangle is made of a mesh, as in the skeleton.
template <class Triangle, class Mesh, class = void> struct IsMadeOfMesh : std::false_type {};
template <class Triangle, class Mesh>
struct IsMadeOfMesh<
    Triangle, Mesh,
    std::void_t<decltype(Mesh(std::declval<const CGL::HalfedgeMesh &>(), std::declval<BSDF *>())),
                decltype(std::declval<Mesh &>().positions = std::declval<Vector3D *>()),
                decltype(std::declval<Mesh &>().normals = std::declval<Vector3D *>()),
                decltype(Triangle(std::declval<const Mesh *>(), size_t(), size_t(), size_t()))>>
    : std::true_type {};

// By the student's own constructor, which may keep more than the corners, such as edges.
template <class Triangle = CGL::SceneObjects::Triangle, class Mesh = CGL::SceneObjects::Mesh>
Triangle triangle_of(const furnace_vec3 *positions, const furnace_vec3 *normals, BSDF *bsdf) {
   thread_local Vector3D corners[3], directions[3];
   for (int i = 0; i < 3; ++i)
      corners[i] = theirs(positions[i]), directions[i] = theirs(normals[i]);
   if constexpr (IsMadeOfMesh<Triangle, Mesh>::value) {
      // Never deleted: what it points to is not its own.
      thread_local Mesh &mesh = *new Mesh(CGL::HalfedgeMesh(), nullptr);
      mesh.positions = corners, mesh.normals = directions;
      Triangle made(&mesh, 0, 1, 2);
      made.bsdf = bsdf;
      return made;
   } else {
      Triangle made;
      made.p1 = corners[0], made.p2 = corners[1], made.p3 = corners[2];
      made.n1 = directions[0], made.n2 = directions[1], made.n3 = directions[2];
      made.bsdf = bsdf;
      made.bbox = BBox(made.p1);
      made.bbox.expand(made.p2);
      made.bbox.expand(made.p3);
      return made;
   }
}

// Any, where the triangle has no area: what is to be told is the hit.
furnace_vec3 normal_of(const furnace_vec3 *positions) {
   const furnace_vec3 normal =
       furnace::cross(positions[1] - positions[0], positions[2] - positions[0]);
   const double length = furnace::length(normal);
   return length > 0 ? normal / length : furnace_vec3{0, 0, 1};
}

struct TriangleFacet : Facet {
   CGL::SceneObjects::Triangle triangle;
   furnace_vec3                corners[3], normal;

   TriangleFacet(const Facet &as, const furnace_vec3 *positions, const furnace_vec3 *normals)
       : Facet(as), triangle(triangle_of(positions, normals, &as.material->dark)),
         corners{positions[0], positions[1], positions[2]}, normal(normal_of(positions)),
         shading{normals[0], normals[1], normals[2]} {}
   furnace_vec3                shading[3];

   const Primitive &inner() const override { return triangle; }
   furnace_hit      hit_of_bench(const furnace_ray &ray) const override {
      return bench().intersect_triangle(corners, shading, ray);
   }
   bool is_tested_by_bench() const override { return takes(FURNACE_TAKES_TRIANGLE_TEST); }
   Vector3D         geometric_normal(const Vector3D &) const override { return theirs(normal); }
};

struct SphereFacet : Facet {
   CGL::SceneObjects::SphereObject object;
   CGL::SceneObjects::Sphere       sphere;
   bool                            inward;

   SphereFacet(const Facet &as, const furnace_sphere &given)
       : Facet(as), object(theirs(given.centre), given.radius, &as.material->dark),
         sphere(&object, theirs(given.centre), given.radius), inward(given.inward) {}
   const Primitive &inner() const override { return sphere; }
   furnace_hit      hit_of_bench(const furnace_ray &ray) const override {
      return bench().intersect_sphere(ours(sphere.o), sphere.r, ray);
   }
   bool             is_tested_by_bench() const override { return takes(FURNACE_TAKES_SPHERE_TEST); }
   double           orientation() const override { return inward ? -1 : 1; }
   Vector3D         geometric_normal(const Vector3D &point) const override {
      return orientation() * (point - sphere.o).unit();
   }
};

// Where `point` lies in a triangle: the weights of corners 1 and 2.
furnace_vec2 weights(const furnace_vec3 *corners, furnace_vec3 point) {
   const furnace_vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
   const furnace_vec3 n = furnace::cross(u, v), p = point - corners[0];
   const double       square = furnace::dot(n, n);
   return {furnace::dot(furnace::cross(p, v), n) / square,
           furnace::dot(furnace::cross(u, p), n) / square};
}

furnace_vec3 at(const furnace_ray &ray, double t) { return ray.origin + t * ray.direction; }

// A primitive of ours that is neither counted nor reported.
struct Stage : Primitive {
   BBox box;

   explicit Stage(double half) : box(Vector3D(-half), Vector3D(half)) {}
   BBox  get_bbox() const override { return box; }
   bool  has_intersection(const Ray &) const override { return false; }
   BSDF *get_bsdf() const override { return nullptr; }
   void  draw(const CGL::Color &, float) const override {}
   void  drawOutline(const CGL::Color &, float) const override {}
};

// Nothing at all, because a BVH over no primitives is not asked for by the course.
struct Nothing : Stage {
   Nothing() : Stage(0) {}
   bool intersect(const Ray &, Intersection *) const override { return false; }
};

// What every ray of the camera meets, since it starts above the box; rays that leave its surface do not meet it again.
// A traversal may ask for any hit first.
struct Met : Stage {
   using Stage::Stage;
   bool has_intersection(const Ray &ray) const override { return ray.o.z > box.max.z; }
};

// A constant environment light: an emissive sphere far away, which `SkyLamp` ends before.
struct Sky : Stage {
   static constexpr double radius = 1e4;
   mutable Surface         surface;

   explicit Sky(const Vector3D &radiance) : Stage(radius), surface(Vector3D(), radiance) {}
   bool intersect(const Ray &ray, Intersection *hit) const override {
      const double a = CGL::dot(ray.d, ray.d), b = CGL::dot(ray.o, ray.d);
      const double c = CGL::dot(ray.o, ray.o) - radius * radius;
      const double t = (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
      if (!(t > ray.min_t && t < ray.max_t)) return false;
      ray.max_t = hit->t = t;
      hit->n = -(ray.o + t * ray.d).unit();
      hit->primitive = this;
      hit->bsdf = &surface;
      return true;
   }
};

// ---- lights -------------------------------------------------------------------------------------

struct PointLamp : SceneLight {
   Vector3D position, intensity;

   PointLamp(Vector3D position, Vector3D intensity) : position(position), intensity(intensity) {}
   bool     is_delta_light() const override { return true; }
   Vector3D sample_L(const Vector3D p, Vector3D *wi, double *distance, double *pdf) const override {
      const Vector3D d = position - p;
      *distance = d.norm();
      *wi = d / *distance;
      *pdf = 1;
      return intensity / d.norm2();
   }
};

struct DirectionalLamp : SceneLight {
   Vector3D to_light, irradiance;

   DirectionalLamp(Vector3D to_light, Vector3D irradiance)
       : to_light(to_light), irradiance(irradiance) {}
   bool     is_delta_light() const override { return true; }
   Vector3D sample_L(const Vector3D, Vector3D *wi, double *distance, double *pdf) const override {
      *wi = to_light;
      *distance = INF_D;
      *pdf = 1;
      return irradiance;
   }
};

struct SkyLamp : SceneLight {
   Vector3D radiance;

   explicit SkyLamp(Vector3D radiance) : radiance(radiance) {}
   bool     is_delta_light() const override { return false; }
   Vector3D sample_L(const Vector3D, Vector3D *wi, double *distance, double *pdf) const override {
      *wi = CGL::UniformSphereSampler3D().get_sample();
      // Short of the emissive sphere: shadow rays that ask for the closest hit would hit it.
      *distance = 0.5 * Sky::radius;
      *pdf = 1 / (4 * pi);
      return radiance;
   }
};

// A point of an emitter, by area.
struct AreaLamp : SceneLight {
   Material *material;
   double    area = 0;
   double    orientation = 1; // -1 where normals point to the middle of a sphere

   explicit AreaLamp(Material *material) : material(material) {}
   // A point, and its unit normal.
   virtual std::pair<furnace_vec3, furnace_vec3> point() const = 0;
   bool     is_delta_light() const override { return false; }
   Vector3D sample_L(const Vector3D p, Vector3D *wi, double *distance, double *pdf) const override {
      const auto     sampled = point();
      const Vector3D d = theirs(sampled.first) - p, normal = theirs(sampled.second);
      *distance = d.norm();
      *wi = d / *distance;
      const double cosine = -CGL::dot(*wi, normal);
      *pdf = d.norm2() / (area * std::fabs(cosine));
      const furnace_vec3 outward = orientation * sampled.second;
      return cosine > 0 ? material->front(outward).glow : Vector3D();
   }
};

// As in the course's scenes, points of a light lie off its triangles: a file's triangles are read in single precision,
// its lights in double. Half of each triangle lies in front of them, half behind; rays that end `EPS_F` short reach both.
struct MeshLamp : AreaLamp {
   static constexpr double off = 5e-8;

   const std::vector<furnace_vec3> corners; // three a triangle
   std::vector<double>             up_to;

   MeshLamp(Material *material, std::vector<furnace_vec3> given)
       : AreaLamp(material), corners(std::move(given)) {
      for (size_t i = 0; i < corners.size(); i += 3) {
         const furnace_vec3 u = corners[i + 1] - corners[i], v = corners[i + 2] - corners[i];
         up_to.push_back(area += furnace::length(furnace::cross(u, v)) / 2);
      }
   }
   std::pair<furnace_vec3, furnace_vec3> point() const override {
      const double       where = stream().next() * area;
      const size_t       last = up_to.size() - 1;
      const size_t       found = std::upper_bound(up_to.begin(), up_to.end(), where) - up_to.begin();
      const furnace_vec3 *triangle = &corners[3 * std::min(found, last)];
      const double       root = std::sqrt(stream().next()), along = stream().next();
      const furnace_vec3 normal = normal_of(triangle);
      return {(1 - root) * triangle[0] + root * (1 - along) * triangle[1] +
                  root * along * triangle[2] + off * (2 * along - 1) * normal,
              normal};
   }
};

struct SphereLamp : AreaLamp {
   furnace_sphere sphere;

   SphereLamp(Material *material, const furnace_sphere &sphere)
       : AreaLamp(material), sphere(sphere) {
      area = 4 * pi * sphere.radius * sphere.radius;
      orientation = sphere.inward ? -1 : 1;
   }
   std::pair<furnace_vec3, furnace_vec3> point() const override {
      const furnace_vec3 outward = ours(CGL::UniformSphereSampler3D().get_sample());
      return {sphere.centre + sphere.radius * outward, orientation * outward};
   }

   // From outside, directions within the cone that the sphere fills: half of its area looks away.
   Vector3D sample_L(const Vector3D p, Vector3D *wi, double *distance, double *pdf) const override {
      const furnace_vec3 to_centre = sphere.centre - ours(p);
      const double       away = furnace::length(to_centre);
      if (away <= sphere.radius || sphere.inward || material->declared.cap_half_angle > 0)
         return AreaLamp::sample_L(p, wi, distance, pdf);
      const double     square = sphere.radius * sphere.radius / (away * away);
      const double     opening = square / (1 + std::sqrt(1 - square)); // 1 - cos of the half angle
      const double     below = opening * stream().next(), cosine = 1 - below;
      const double     sine = std::sqrt(below * (2 - below)), phi = 2 * pi * stream().next();
      CGL::Matrix3x3   to_world;
      CGL::make_coord_space(to_world, theirs(to_centre / away));
      *wi = to_world * Vector3D(sine * std::cos(phi), sine * std::sin(phi), cosine);
      const double chord = sphere.radius * sphere.radius - away * away * sine * sine;
      *distance = away * cosine - std::sqrt(std::max(0.0, chord));
      *pdf = 1 / (2 * pi * opening);
      return material->lit.glow;
   }
};

// ---- the integrator -----------------------------------------------------------------------------

// `isAccumBounces` is there since spring 2024.
template <class T> auto accumulate(T &tracer, bool all, int) -> decltype(tracer.isAccumBounces, true) {
   tracer.isAccumBounces = all;
   return true;
}
template <class T> bool accumulate(T &, bool, long) { return false; }

template <class T, class = void> struct HasAccumulate : std::false_type {};
template <class T>
struct HasAccumulate<T, std::void_t<decltype(std::declval<T &>().isAccumBounces)>>
    : std::true_type {};

// What a submission adds to its path tracer and sets from its command line alone is 0 and false here, not anything.
struct Tracer {
   alignas(PathTracer) unsigned char place[sizeof(PathTracer)] = {};
   PathTracer *const tracer = new (place) PathTracer;

   Tracer() = default;
   Tracer(const Tracer &) = delete;
   ~Tracer() { tracer->~PathTracer(); }
};

void prepare(PathTracer &tracer) {
   tracer.max_ray_depth = 1;
   tracer.ns_aa = tracer.ns_area_light = 1;
   tracer.ns_diff = tracer.ns_glsy = tracer.ns_refr = 1;
   tracer.samplesPerBatch = 32;
   tracer.maxTolerance = 0.05;
   tracer.direct_hemisphere_sample = false;
   tracer.bvh = nullptr;
   tracer.scene = nullptr;
   tracer.camera = nullptr;
   tracer.envLight = nullptr;
   accumulate(tracer, true, 0);
}

void set_adaptive(PathTracer &tracer, const furnace_adaptive *adaptive, size_t samples) {
   tracer.ns_aa = samples;
   // Without: a batch that is never full.
   tracer.samplesPerBatch = adaptive ? adaptive->samples_per_batch : 2 * samples + 1;
   tracer.maxTolerance = adaptive ? adaptive->max_tolerance : 0;
}

furnace_camera any_camera() {
   furnace_camera camera{};
   camera.struct_size = sizeof camera;
   camera.position = {0, 0, 5};
   camera.right = {1, 0, 0}, camera.up = {0, 1, 0}, camera.backward = {0, 0, 1};
   camera.horizontal_fov = camera.vertical_fov = 0.1;
   camera.far_clip = 1e6;
   return camera;
}

// A scene of one primitive, which needs no hierarchy: that of a submission may not be written yet, or crash. Its destructor
// never runs: the course's default constructor leaves the root open, and its destructor deletes it.
struct Alone : BVHAccel {
   const Primitive *met;

   explicit Alone(const Primitive *met) : met(met) { total_rays = total_isects = 0; }
   bool has_intersection(const Ray &ray) const { return met->has_intersection(ray); }
   bool intersect(const Ray &ray, Intersection *hit) const { return met->intersect(ray, hit); }
};

// A stage for one pixel: everything it needs but what the camera's rays meet.
struct OnePixel {
   View                         view{any_camera()};
   alignas(Alone) unsigned char place[sizeof(Alone)];
   // Dark: the course's scenes have lights, and right code may divide by their number.
   PointLamp                lamp{Vector3D(0, 0, 100), Vector3D()};
   CGL::SceneObjects::Scene scene{{}, {&lamp}};
   Tracer                   own_tracer;
   PathTracer              &tracer = *own_tracer.tracer;

   explicit OnePixel(const Primitive *met) {
      prepare(tracer);
      tracer.bvh = new (place) Alone(met);
      tracer.scene = &scene;
      tracer.camera = &view.camera;
      tracer.set_frame_size(1, 1);
   }
};

// Whether rays of the camera begin at the last bounce and count down, or at 0 and count up: a student's choice.
size_t depth_of_camera_rays(size_t last_bounce) {
   struct Probe : Met {
      mutable size_t depth = 7;

      Probe() : Met(1) {}
      bool intersect(const Ray &ray, Intersection *) const override {
         depth = ray.depth;
         return false;
      }
   };
   static const size_t at_seven = [] {
      const Stream before = stream();
      Probe        probe;
      OnePixel     stage(&probe);
      stage.tracer.max_ray_depth = 7;
      set_adaptive(stage.tracer, nullptr, 1);
      stage.tracer.raytrace_pixel(0, 0);
      stream() = before;
      return probe.depth;
   }();
   return at_seven == 7 ? last_bounce : at_seven;
}

// Every ray of the camera meets the next luminance of a stream, as light.
struct Luminances : Met {
   const double   *values;
   size_t          count;
   mutable size_t  next = 0;
   mutable bool    counted = false;
   mutable Surface surface{Vector3D(), Vector3D()};

   Luminances(const double *values, size_t count) : Met(1), values(values), count(count) {}
   bool intersect(const Ray &ray, Intersection *hit) const override {
      if (!has_intersection(ray)) return false;
      const size_t number = counted ? next - 1 : next++;
      surface.glow = Vector3D(number < count ? values[number] : 0);
      ray.max_t = hit->t = 4.5;
      hit->n = written().path ? -ray.d : normal_that_shows(surface.glow);
      hit->primitive = this;
      hit->bsdf = &surface;
      return true;
   }
};

// A sample begins where a point of the pixel is drawn.
struct Counter : CGL::Sampler2D {
   Luminances                      *met;
   std::unique_ptr<CGL::Sampler2D> inner;

   Counter(Luminances *met, CGL::Sampler2D *inner) : met(met), inner(inner) {}
   CGL::Vector2D get_sample() const override {
      met->counted = true;
      ++met->next;
      return inner->get_sample();
   }
};

furnace_adaptive_mean adaptive_mean_of(const furnace_adaptive &settings, const double *luminances,
                                       size_t count) {
   Luminances met(luminances, count);
   OnePixel   stage(&met);
   stage.tracer.gridSampler = new Counter(&met, stage.tracer.gridSampler);
   set_adaptive(stage.tracer, &settings, count);
   stage.tracer.raytrace_pixel(0, 0);
   return {stage.tracer.sampleBuffer.data[0].x,
           static_cast<uint32_t>(stage.tracer.sampleCountBuffer[0]), 0};
}

// The bench's traversal of the same scene. It is never deleted: the course's default constructor leaves the root open,
// its destructor deletes it.
struct Traversal : BVHAccel {
   furnace_built                                            *built;
   std::map<std::pair<uint32_t, uint32_t>, const Facet *> facets;
   const Sky                                                *sky = nullptr;

   explicit Traversal(furnace_built *built) : built(built) {}
   bool has_intersection(const Ray &ray) const { return bench().occluded(built, ours(ray)); }
   bool intersect(const Ray &ray, Intersection *hit) const {
      const furnace_hit found = bench().intersect(built, ours(ray));
      if (found.primitive == FURNACE_NONE) return sky && sky->intersect(ray, hit);
      return facets.at({found.shape, found.primitive})->describe(ray, hit, found);
   }
};

struct Built {
   static constexpr size_t few_without_hierarchy = 10000;

   std::vector<std::unique_ptr<Material>>   materials;
   std::vector<std::unique_ptr<Primitive>>  owned;
   std::vector<std::unique_ptr<SceneLight>> lamps;
   std::vector<Primitive *>                 primitives;
   std::vector<SceneLight *>                lights;
   // The skeleton's own line draws directions by the number of lights: without any, 0 are divided by 0.
   PointLamp                                 dark{Vector3D(0, 0, 1e6), Vector3D()};
   std::unique_ptr<CGL::SceneObjects::Scene> scene, scene_for_hemisphere, scene_without_lights;
   std::unique_ptr<BVHAccel>                own;
   BVHAccel                                *bvh;
   Tracer                                   own_tracer;
   PathTracer                              &tracer = *own_tracer.tracer;
   Counts                                   counts;
   bool                                     accelerated;
   furnace_built                           *in_bench;
   furnace_integrator                       settings{}; // the last that was asked for
   // Of images, where the skeleton adds all bounces up.
   bool hides_emission = false;
   // What keeps light from being asked for, if anything does; shapes can be met all the same.
   std::string unlit;

   Built(const furnace_scene &given, const furnace_build &settings)
       : accelerated(settings.accelerate), in_bench(settings.bench) {
      for (uint32_t i = 0; i < given.material_count; ++i)
         materials.emplace_back(material_or_black(given.materials[i]));
      for (uint32_t i = 0; i < given.mesh_count; ++i) add_mesh(given.meshes[i], i);
      if (given.sphere_count)
         ask_for(written().sphere || takes(FURNACE_TAKES_SPHERE_TEST),
                 "the intersection of spheres (part 1)");
      for (uint32_t i = 0; i < given.sphere_count; ++i)
         add(new SphereFacet(facet(given.mesh_count + i, 0, given.spheres[i].material),
                             given.spheres[i]));
      for (uint32_t i = 0; i < given.light_count; ++i) add_light(given, given.lights[i]);
      if (primitives.empty()) add(new Nothing);
      ask_for(written().hierarchy || takes(FURNACE_TAKES_TRAVERSAL) ||
                  primitives.size() <= few_without_hierarchy,
              "the BVH, without which so many shapes take too long (part 2)");
      scene.reset(new CGL::SceneObjects::Scene({}, lights));
      const std::vector<SceneLight *> none{&dark};
      scene_without_lights.reset(new CGL::SceneObjects::Scene({}, none));
      scene_for_hemisphere.reset(
          new CGL::SceneObjects::Scene({}, lights.empty() ? none : lights));
      bvh = takes(FURNACE_TAKES_TRAVERSAL) ? traversal_of_bench()
                                           : traversal(std::max(1u, settings.max_leaf_size));
      bvh->total_rays = bvh->total_isects = 0;
      prepare(tracer);
      tracer.bvh = bvh;
   }

   furnace_build_stats stats() {
      furnace_build_stats stats{};
      if (own && written().hierarchy) count_nodes(own->get_root(), 1, stats);
      return stats;
   }

   furnace_hit intersect(const furnace_ray &ray, furnace_traversal_stats &stats) {
      const Ray    asked = theirs(ray);
      Intersection hit;
      counts.tests = 0;
      const bool found = accelerated ? bvh->intersect(asked, &hit) : nearest(asked, &hit);
      stats.primitive_tests += counts.tests;
      const auto *facet = found ? dynamic_cast<const Facet *>(hit.primitive) : nullptr;
      if (!facet) return furnace::miss();
      furnace_hit        answer{};
      const Vector3D     point = asked.o + hit.t * asked.d;
      const Vector3D     geometric = facet->geometric_normal(point);
      const bool         from_front = CGL::dot(geometric, asked.d) < 0;
      answer.t = hit.t;
      answer.shape = facet->shape;
      answer.primitive = facet->number;
      answer.geometric_normal = ours(geometric);
      answer.shading_normal = ours(from_front ? hit.n : -hit.n);
      if (const auto *triangle = dynamic_cast<const TriangleFacet *>(facet))
         answer.uv = weights(triangle->corners, at(ray, hit.t));
      return answer;
   }

   bool occluded(const furnace_ray &ray, furnace_traversal_stats &stats) {
      const Ray asked = theirs(ray);
      counts.tests = 0;
      const auto hits = [&](const Primitive *p) { return p->has_intersection(asked); };
      const bool found = accelerated ? bvh->has_intersection(asked)
                                     : std::any_of(primitives.begin(), primitives.end(), hits);
      stats.primitive_tests += counts.tests;
      return found;
   }

   furnace_rgb radiance(const furnace_ray &ray, const furnace_integrator &settings, size_t) {
      configure(settings);
      const uint32_t first = settings.first_bounce, last = settings.last_bounce;
      const Ray      asked = theirs(ray);
      const AtHand   at_hand(this);
      if (takes(FURNACE_TAKES_PATH)) return light_of_bench(ray, first, last);
      if (settings.by_depth) {
         ask_for_paths(last);
         return our_colour(up_to(asked, last));
      }
      if (last == 0) return our_colour(emitted(asked));
      if (last == 1 && first == 1 && written().direct) return our_colour(direct(asked));
      ask_for_paths(last);
      if (first == 0) return our_colour(up_to(asked, last));
      if (first == 1) return our_colour(up_to(asked, last) - emitted(asked));
      if (!HasAccumulate<PathTracer>::value) return our_colour(more(asked, first - 1, last));
      Vector3D sum;
      for (uint32_t bounce = first; bounce <= last; ++bounce) sum += alone(asked, bounce);
      return our_colour(sum);
   }

   // Of the bench, along a ray that has arrived or begins.
   furnace_rgb light_of_bench(const furnace_ray &ray, uint32_t first, uint32_t last) {
      return bench().radiance(in_bench, ray, settings, first, last, stream().engine());
   }

   // What a ray of the camera shows without emission.
   template <class Own> Vector3D from_first_bounce(const Ray &ray, Own &&own) {
      hides_emission = false; // some come back for each bounce
      Intersection hit;
      const Ray    met = ray;
      Vector3D     seen;
      if (bvh->intersect(met, &hit))
         seen = settings.last_bounce == 1 ? one_bounce(met, hit) : own() - zero_bounce(met, hit);
      hides_emission = true;
      return seen;
   }

   // The scene that is asked about, for the submission's functions that the bench's stand in for.
   static Built *&at_hand() {
      static Built *at_hand = nullptr;
      return at_hand;
   }
   struct AtHand {
      explicit AtHand(Built *built) { at_hand() = built; }
      ~AtHand() { at_hand() = nullptr; }
   };

   void render(const furnace_camera &given, const furnace_render &settings, float *pixels,
               uint32_t *sample_counts) {
      View         view(given);
      const AtHand at_hand(this);
      configure(*settings.integrator);
      counts.normals_show_light = !written().path;
      tracer.camera = &view.camera;
      tracer.set_frame_size(settings.width, settings.height);
      set_adaptive(tracer, settings.adaptive, settings.samples_per_pixel);
      std::fill_n(pixels, 3 * size_t(settings.width) * settings.height, 0.0f);
      const uint32_t first = settings.integrator->first_bounce;
      const uint32_t last = settings.integrator->last_bounce;
      if (last > 0) ask_for_paths(last);
      const bool by_bench = takes(FURNACE_TAKES_PATH);
      const bool is_summed = first == 0 || by_bench || !HasAccumulate<PathTracer>::value;
      if (is_summed && !by_bench && first > (interposed() ? 1 : 0))
         throw furnace::Unsupported("images of later bounces alone: this skeleton adds them up");
      hides_emission = is_summed && first > 0;
      for (uint32_t bounce = is_summed ? last : first; bounce <= last; ++bounce) {
         isolate(!is_summed, bounce);
         tracer.max_ray_depth = std::max(1u, bounce);
         // Of emission alone, what black surfaces reflect of many lights is long to find out.
         Surface::all_black() = bounce == 0;
         tracer.scene = bounce == 0 ? scene_without_lights.get() : scene_of_lights();
         for (size_t y = 0; y < settings.height; ++y)
            for (size_t x = 0; x < settings.width; ++x) {
               if (takes(FURNACE_TAKES_PIXEL)) pixel_by_bench(settings, x, y);
               else tracer.raytrace_pixel(x, y);
            }
         Surface::all_black() = false;
         add_pixels(settings, pixels, sample_counts);
      }
      isolate(false, last);
      tracer.scene = scene_of_lights();
      hides_emission = false;
      tracer.camera = nullptr;
      counts.normals_show_light = false;
   }

 private:
   BVHAccel *traversal(size_t max_leaf_size) {
      own.reset(new BVHAccel(primitives, max_leaf_size));
      return own.get();
   }

   BVHAccel *traversal_of_bench() {
      auto *made = new Traversal(in_bench);
      for (const Primitive *primitive : primitives) {
         if (const auto *facet = dynamic_cast<const Facet *>(primitive))
            made->facets[{facet->shape, facet->number}] = facet;
         if (const auto *sky = dynamic_cast<const Sky *>(primitive)) made->sky = sky;
      }
      return made;
   }

   void pixel_by_bench(const furnace_render &settings, size_t x, size_t y) {
      std::vector<double>   luminances;
      std::vector<Vector3D> sums{Vector3D()};
      for (size_t i = 0; i < settings.samples_per_pixel; ++i) {
         const CGL::Vector2D at = tracer.gridSampler->get_sample();
         Ray                 ray = tracer.camera->generate_ray((x + at.x) / settings.width,
                                                               (y + at.y) / settings.height);
         ray.depth = depth_of_camera_rays(tracer.max_ray_depth);
         const Vector3D light = tracer.est_radiance_global_illumination(ray);
         luminances.push_back(light.illum());
         sums.push_back(sums.back() + light);
      }
      size_t used = luminances.size();
      if (settings.adaptive)
         used = bench().adaptive_mean(*settings.adaptive, luminances.data(), used).used;
      tracer.sampleBuffer.update_pixel(sums[used] / double(used), x, y);
      tracer.sampleCountBuffer[x + y * settings.width] = int(used);
   }

   Facet *add(Facet *facet) {
      add(static_cast<Primitive *>(facet));
      return facet;
   }
   void add(Primitive *primitive) {
      owned.emplace_back(primitive);
      primitives.push_back(primitive);
   }

   // What is common to all primitives; only for copying from.
   struct Common : Facet {
      using Facet::Facet;
      const Primitive &inner() const override { return *this; }
      Vector3D         geometric_normal(const Vector3D &) const override { return Vector3D(); }
      furnace_hit      hit_of_bench(const furnace_ray &) const override { return furnace::miss(); }
      bool             is_tested_by_bench() const override { return false; }
   };
   Common facet(uint32_t shape, uint32_t number, uint32_t material) {
      return Common(shape, number, materials[material].get(), &counts);
   }

   void add_mesh(const furnace_mesh &mesh, uint32_t shape) {
      ask_for(written().triangle || takes(FURNACE_TAKES_TRIANGLE_TEST),
              "the intersection of triangles (part 1)");
      for (uint32_t i = 0; i < mesh.triangle_count; ++i) {
         furnace_vec3 positions[3], normals[3];
         for (int corner = 0; corner < 3; ++corner)
            positions[corner] = mesh.positions[mesh.indices[3 * i + corner]];
         for (int corner = 0; corner < 3; ++corner)
            normals[corner] = mesh.normals ? mesh.normals[mesh.indices[3 * i + corner]]
                                           : normal_of(positions);
         add(new TriangleFacet(facet(shape, i, mesh.material), positions, normals));
      }
   }

   void add_light(const furnace_scene &given, const furnace_light &light) {
      const Vector3D place = theirs(light.place), radiance = theirs(light.radiance);
      switch (light.kind) {
      case FURNACE_POINT: lamps.emplace_back(new PointLamp(place, radiance)); break;
      case FURNACE_DIRECTIONAL: lamps.emplace_back(new DirectionalLamp(-place, radiance)); break;
      case FURNACE_CONSTANT_SKY:
         lamps.emplace_back(new SkyLamp(radiance));
         add(static_cast<Primitive *>(new Sky(radiance)));
         break;
      case FURNACE_AREA: lamps.emplace_back(area_lamp(given, light.shape)); break;
      default: unlit = "skies that are brighter above"; return;
      }
      lights.push_back(lamps.back().get());
   }

   Material *material_or_black(const furnace_material &material) {
      try {
         return new Material(material);
      } catch (const furnace::Unsupported &missing) {
         unlit = missing.what();
         furnace_material black = material;
         black.kind = FURNACE_DIFFUSE;
         black.reflectance = furnace_rgb{};
         return new Material(black);
      }
   }

   SceneLight *area_lamp(const furnace_scene &given, uint32_t shape) {
      if (shape >= given.mesh_count) {
         const furnace_sphere &sphere = given.spheres[shape - given.mesh_count];
         return new SphereLamp(materials[sphere.material].get(), sphere);
      }
      const furnace_mesh       &mesh = given.meshes[shape];
      std::vector<furnace_vec3> corners;
      for (uint32_t i = 0; i < 3 * mesh.triangle_count; ++i)
         corners.push_back(mesh.positions[mesh.indices[i]]);
      return new MeshLamp(materials[mesh.material].get(), std::move(corners));
   }

   bool nearest(const Ray &ray, Intersection *hit) const {
      bool found = false;
      for (const Primitive *primitive : primitives) found = primitive->intersect(ray, hit) || found;
      return found;
   }

   static void count_nodes(const BVHNode *node, uint64_t depth, furnace_build_stats &stats) {
      if (!node) return;
      ++stats.nodes;
      stats.leaves += node->isLeaf();
      stats.bytes += sizeof *node;
      stats.max_depth = std::max(stats.max_depth, depth);
      count_nodes(node->l, depth + 1, stats);
      count_nodes(node->r, depth + 1, stats);
   }

   void configure(const furnace_integrator &asked) {
      settings = asked;
      hides_emission = false;
      if (!unlit.empty()) throw furnace::Unsupported(unlit);
      const auto is_delta = [](const SceneLight *light) { return light->is_delta_light(); };
      if (settings.by_hemisphere && std::any_of(lights.begin(), lights.end(), is_delta))
         throw furnace::Unsupported("point lights with hemisphere sampling");
      if (settings.last_bounce > 0)
         settings.by_hemisphere ? ask_for(written().by_hemisphere, "hemisphere sampling (part 3)")
                                : ask_for(written().by_light, "light sampling (part 3)");
      tracer.ns_area_light = settings.samples_per_light;
      tracer.direct_hemisphere_sample = settings.by_hemisphere;
      tracer.scene = scene_of_lights();
   }

   CGL::SceneObjects::Scene *scene_of_lights() const {
      return (settings.by_hemisphere ? scene_for_hemisphere : scene).get();
   }

   // Only the light of the last bounce, where the skeleton can; camera rays are then blind to light.
   void isolate(bool alone, uint32_t last) {
      accumulate(tracer, !alone, 0);
      const size_t depth = depth_of_camera_rays(last);
      counts.blind_depth = alone && depth > 0 ? depth : SIZE_MAX;
   }

   void ask_for_paths(uint32_t last) const {
      ask_for(written().path, "light along paths: normals are shown (part 3)");
      if (last > 1) ask_for(written().indirect, "indirect light (part 4)");
   }

   Vector3D zero_bounce(const Ray &ray, const Intersection &hit) {
      return light(&PathTracer::zero_bounce_radiance, tracer, ray, hit);
   }
   Vector3D one_bounce(const Ray &ray, const Intersection &hit) {
      return light(&PathTracer::one_bounce_radiance, tracer, ray, hit);
   }

   // Bounce 0 alone. Few submissions are right at a depth of 0, and the course does not insist.
   // The ray is a copy: a hit ends it.
   Vector3D emitted(Ray ray) {
      ask_for(written().emission, "zero_bounce_radiance (part 3)");
      Intersection hit;
      return bvh->intersect(ray, &hit) ? zero_bounce(ray, hit) : Vector3D();
   }

   // Bounce 1 alone.
   Vector3D direct(Ray ray) {
      tracer.max_ray_depth = 1;
      ray.depth = depth_of_camera_rays(1);
      Intersection hit;
      return bvh->intersect(ray, &hit) ? one_bounce(ray, hit) : Vector3D();
   }

   Vector3D up_to(Ray ray, uint32_t last) {
      tracer.max_ray_depth = last;
      ray.depth = depth_of_camera_rays(last);
      return tracer.est_radiance_global_illumination(ray);
   }

   // A later bounce alone, where the skeleton can.
   Vector3D alone(const Ray &ray, uint32_t bounce) {
      isolate(true, bounce);
      const Vector3D light = up_to(ray, bounce);
      isolate(false, bounce);
      return light;
   }

   // What bounces after `known` add to those up to it. Equal random numbers make equal paths, if the numbers that go on
   // are drawn last.
   Vector3D more(const Ray &ray, uint32_t known, uint32_t last) {
      const Stream   before = stream();
      const Vector3D less = up_to(ray, known);
      stream() = before;
      const Vector3D all = up_to(ray, last), rest = all - less;
      if (std::min({rest.x, rest.y, rest.z}) < -1e-9 * all.norm())
         throw furnace::Unsupported("single bounces: they are added up, by other paths each time");
      return Vector3D(std::max(0.0, rest.x), std::max(0.0, rest.y), std::max(0.0, rest.z));
   }

   // The course's images are upside down.
   void add_pixels(const furnace_render &settings, float *pixels, uint32_t *sample_counts) const {
      for (size_t y = 0; y < settings.height; ++y)
         for (size_t x = 0; x < settings.width; ++x) {
            const size_t    theirs = x + y * settings.width;
            const size_t    here = x + (settings.height - 1 - y) * settings.width;
            const Vector3D &value = tracer.sampleBuffer.data[theirs];
            pixels[3 * here] += static_cast<float>(value.x);
            pixels[3 * here + 1] += static_cast<float>(value.y);
            pixels[3 * here + 2] += static_cast<float>(value.z);
            // A count below 0 is wrong, and not one that was never written, as its bits would say.
            if (sample_counts)
               sample_counts[here] = uint32_t(std::max(0, int(tracer.sampleCountBuffer[theirs])));
         }
   }
};

// ---- the core -----------------------------------------------------------------------------------

struct Course {
   static inline const uint32_t components =
       FURNACE_TAKES_TRIANGLE_TEST | FURNACE_TAKES_SPHERE_TEST | FURNACE_TAKES_TRAVERSAL |
       FURNACE_TAKES_BSDF | FURNACE_TAKES_PATH | FURNACE_TAKES_PIXEL | interposed();

   void take_components(const furnace::Bench &given) { bench() = given; }

   void seed(uint64_t seed) {
      stream().engine.seed(seed);
      stream().given.clear();
   }

   furnace_ray generate_ray(const furnace_camera &camera, furnace_vec2 film) {
      const View view(camera);
      return ours(view.camera.generate_ray(film.x, film.y));
   }

   furnace_hit intersect_triangle(const furnace_vec3 *positions, const furnace_vec3 *normals,
                                  const furnace_ray &ray) {
      if (takes(FURNACE_TAKES_TRIANGLE_TEST))
         return bench().intersect_triangle(positions, normals, ray);
      furnace_hit hit = one(triangle_of(positions, normals, nullptr), ray);
      hit.geometric_normal = normal_of(positions);
      if (hit.primitive != FURNACE_NONE) hit.uv = weights(positions, at(ray, hit.t));
      return hit;
   }

   furnace_hit intersect_sphere(furnace_vec3 centre, double radius, const furnace_ray &ray) {
      if (takes(FURNACE_TAKES_SPHERE_TEST)) return bench().intersect_sphere(centre, radius, ray);
      CGL::SceneObjects::SphereObject object(theirs(centre), radius, nullptr);
      furnace_hit hit = one(CGL::SceneObjects::Sphere(&object, theirs(centre), radius), ray);
      if (hit.primitive != FURNACE_NONE)
         hit.geometric_normal = furnace::unit(at(ray, hit.t) - centre);
      return hit;
   }

   // The bench asks where; students are asked whether. Some leave t0 and t1 alone.
   furnace_box_hit intersect_box(furnace_vec3 min, furnace_vec3 max, const furnace_ray &ray) {
      if (takes(FURNACE_TAKES_BOX_TEST)) return bench().intersect_box(min, max, ray);
      double t0 = ray.t_min, t1 = ray.t_max, enter = -infinity, leave = infinity;
      const bool   hit = BBox(theirs(min), theirs(max)).intersect(theirs(ray), t0, t1);
      const double low[3] = {min.x, min.y, min.z}, high[3] = {max.x, max.y, max.z};
      const double o[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
      const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
      for (int axis = 0; axis < 3; ++axis) {
         if (d[axis] == 0) continue;
         const double a = (low[axis] - o[axis]) / d[axis], b = (high[axis] - o[axis]) / d[axis];
         enter = std::max(enter, std::min(a, b));
         leave = std::min(leave, std::max(a, b));
      }
      return {enter, leave, hit ? 1u : 0u, 0};
   }

   furnace_bsdf_value eval_bsdf(const furnace_material &material, furnace_vec3 wo, furnace_vec3 wi) {
      Material made(material);
      if (takes(FURNACE_TAKES_BSDF)) return bench().eval_bsdf(material, wo, wi);
      // The course never asks for a pair across the surface, and `f` need not know of sides.
      if (!(wo.z * wi.z > 0)) return {};
      return {our_colour(made.lit.f(theirs(wo), theirs(wi))), density(made, wi.z)};
   }

   furnace_bsdf_sample sample_bsdf(const furnace_material &material, furnace_vec3 wo,
                                   const furnace::Numbers &numbers) {
      Material made(material);
      if (takes(FURNACE_TAKES_BSDF)) return bench().sample_bsdf(material, wo, numbers);
      stream().given = {numbers.point.x, numbers.point.y};
      // The course turns normals to the viewer before it asks; so does this file.
      const double side = wo.z < 0 ? -1 : 1;
      Vector3D     wi;
      double       pdf = 0;
      const Vector3D f = made.lit.sample_f(Vector3D(wo.x, wo.y, side * wo.z), &wi, &pdf);
      stream().given.clear();
      return {{wi.x, wi.y, side * wi.z}, our_colour(f), pdf, 0, pdf > 0 ? 1u : 0u};
   }

   furnace_adaptive_mean adaptive_mean(const furnace_adaptive &settings, const double *luminances,
                                       size_t count) {
      if (takes(FURNACE_TAKES_PIXEL)) return bench().adaptive_mean(settings, luminances, count);
      return adaptive_mean_of(settings, luminances, count);
   }

   std::unique_ptr<Built> build(const furnace_scene &scene, const furnace_build &settings) {
      return std::unique_ptr<Built>(new Built(scene, settings));
   }

 private:
   static furnace_hit one(const Primitive &primitive, const furnace_ray &ray) {
      const Ray    asked = theirs(ray);
      Intersection found;
      if (!primitive.intersect(asked, &found)) return furnace::miss();
      furnace_hit hit{};
      hit.t = found.t;
      hit.shading_normal = ours(found.n);
      return hit;
   }

   // `BSDF` has no function for the pdf: it is the one that the student's samples return.
   static double density(Material &material, double z) {
      Vector3D wi;
      double   pdf = 0;
      stream().given = {0.3, 0.7};
      material.lit.sample_f(Vector3D(0, 0, 1), &wi, &pdf);
      stream().given.clear();
      const bool is_uniform = std::fabs(pdf * 2 * pi - 1) < 1e-6;
      return is_uniform ? 1 / (2 * pi) : std::fabs(z) / pi;
   }
};

// ---- what is written ----------------------------------------------------------------------------

sigjmp_buf escape;
void       leave(int) { siglongjmp(escape, 1); }

// Whether the submission answers as the skeleton does. What dies or does not come to an end is written, and is judged
// where a case asks it.
template <class Ask> bool is_skeleton(Ask &&ask) {
   static char         room[1 << 16]; // an endless recursion leaves no room on the stack
   constexpr std::array signals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM};
   const itimerval     half_a_second{{0, 0}, {0, 500000}}, never{};
   struct sigaction    leaving{}, before[signals.size()];
   stack_t             apart{}, stack_before{};
   volatile bool       skeleton = false;
   apart.ss_sp = room, apart.ss_size = sizeof room;
   sigaltstack(&apart, &stack_before);
   leaving.sa_handler = leave, leaving.sa_flags = SA_ONSTACK;
   for (size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &leaving, &before[i]);
   if (sigsetjmp(escape, 1) == 0) {
      setitimer(ITIMER_REAL, &half_a_second, nullptr);
      try {
         skeleton = ask();
      } catch (...) {
      }
   } else {
      skeleton = false;
   }
   setitimer(ITIMER_REAL, &never, nullptr);
   for (size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before[i], nullptr);
   sigaltstack(&stack_before, nullptr);
   return skeleton;
}

bool is(const Vector3D &value, double x, double y, double z) {
   return value.x == x && value.y == y && value.z == z;
}

// A point of a grey floor, seen from above, under a coloured lamp and far inside a grey sphere that glows.
struct Probe {
   Sky                                       sphere{Vector3D(0.3)};
   OnePixel                                  stage{&sphere};
   PointLamp                                 lamp{Vector3D(0, 0, 1), Vector3D(0.3, 0.5, 0.7)};
   CGL::SceneObjects::Scene                  scene{{}, {&lamp}};
   Surface                                   floor{Vector3D(0.5), Vector3D(0.25, 0.5, 0.75)};
   Intersection                              hit;
   Ray                                       ray{Vector3D(0, 0, 1), Vector3D(0, 0, -1)};

   Probe() {
      sphere.surface.diffuse = CGL::DiffuseBSDF(Vector3D(0.5));
      hit.t = 1, hit.n = Vector3D(0, 0, 1), hit.primitive = &sphere, hit.bsdf = &floor;
      ray.min_t = 0, ray.max_t = INF_D;
      stage.tracer.scene = &scene;
   }

   // The skeleton answers 1 to everything about light, and black where light is to bounce again.
   template <class Ask> static bool is_white(Ask &&ask) {
      return is_skeleton([&] {
         Probe probe;
         return is(ask(probe, probe.stage.tracer), 1, 1, 1);
      });
   }
   bool is_black_after(size_t depth, bool by_hemisphere) {
      stage.tracer.direct_hemisphere_sample = by_hemisphere;
      stage.tracer.max_ray_depth = 3;
      ray.depth = depth;
      return is(light(&PathTracer::at_least_one_bounce_radiance, stage.tracer, ray, hit), 0, 0, 0);
   }
};

bool shows_normals() {
   struct Slanted : Met {
      mutable Surface surface{Vector3D(), Vector3D()};

      Slanted() : Met(1) {}
      bool intersect(const Ray &ray, Intersection *hit) const override {
         ray.max_t = hit->t = 4.5;
         hit->n = Vector3D(0.6, 0, 0.8);
         hit->primitive = this;
         hit->bsdf = &surface;
         return true;
      }
   } met;
   OnePixel stage(&met);
   Ray      ray(Vector3D(0, 0, 5), Vector3D(0, 0, -1));
   ray.min_t = 0, ray.max_t = INF_D, ray.depth = 1;
   const Vector3D shown = stage.tracer.est_radiance_global_illumination(ray);
   return (shown - Vector3D(0.8, 0.5, 0.9)).norm() < 1e-9;
}

// Rays whose whole lines pass the thing far away, none of them along an axis, and one through it.
template <class Hits> bool is_hit_by_all(Hits &&hits) {
   const Vector3D past[] = {Vector3D(1, 0.1, -0.1), Vector3D(0.1, 1, -0.1), Vector3D(-0.1, 0.1, 1)};
   const auto     along = [](const Vector3D &from, const Vector3D &direction) {
      Ray ray(from, direction.unit());
      ray.min_t = 0, ray.max_t = 1e9, ray.depth = 0;
      return ray;
   };
   for (const Vector3D &direction : past)
      if (!hits(along(Vector3D(100, 150, 200), direction))) return false;
   return hits(along(Vector3D(0.2, 0.2, 5), Vector3D(0.01, 0.01, -1)));
}

// The skeleton's `intersect` says yes to every ray, and writes nothing.
bool is_met_by_all(const Primitive &primitive) {
   return is_hit_by_all([&](const Ray &ray) {
      Intersection hit;
      return primitive.intersect(ray, &hit) && !hit.primitive;
   });
}

// Things that no axis has in one place: a split along the wrong one is a split.
bool keeps_all_in_one_leaf() {
   std::array<Nothing, 64>  things;
   std::vector<Primitive *> primitives;
   for (size_t i = 0; i < things.size(); ++i) {
      const Vector3D corner(double(i), double(7 * i % 64), double(23 * i % 64));
      things[i].box = BBox(corner, corner + Vector3D(0.5));
      primitives.push_back(&things[i]);
   }
   const BVHNode *root = BVHAccel(primitives, 4).get_root();
   return root && root->isLeaf();
}

bool leaves_the_pixel_alone() {
   Nothing  nothing;
   OnePixel stage(&nothing);
   set_adaptive(stage.tracer, nullptr, 1);
   stage.tracer.raytrace_pixel(0, 0);
   return is(stage.tracer.sampleBuffer.data[0], 0.2, 1.0, 0.8);
}

// A rule that is wrong may go on for ever where nothing varies; where anything is tolerated, any rule stops.
bool never_stops() {
   std::array<double, 512> constant, calm, wild;
   for (size_t i = 0; i < calm.size(); ++i)
      constant[i] = 0.5, calm[i] = i % 2 ? 0.5 : 0.501, wild[i] = i % 2;
   const furnace_adaptive usual{sizeof usual, 32, 0.05}, lenient{sizeof lenient, 32, 1e6};
   return adaptive_mean_of(usual, constant.data(), 512).used == 512 &&
          adaptive_mean_of(usual, calm.data(), 512).used == 512 &&
          adaptive_mean_of(lenient, wild.data(), 512).used == 512;
}

// Whether a distance that is about right has no more digits than a float has.
bool has_digits_of_a_float(const Primitive &primitive, const Vector3D &on_it) {
   const Vector3D from(3.1, -2.3, 4.7), way = on_it - from;
   Ray            ray(from, way.unit());
   ray.min_t = 0, ray.max_t = 1e9, ray.depth = 0;
   Intersection hit;
   if (!primitive.intersect(ray, &hit)) return false;
   const double error = std::fabs(hit.t / way.norm() - 1);
   return 1e-11 < error && error < 1e-5;
}

bool computes_in_float() {
   const furnace_vec3 corners[] = {{-0.7, -0.9, 0.1}, {1.1, -0.3, 0.2}, {-0.2, 1.3, 0.4}}, up{0, 0, 1};
   const furnace_vec3 normals[] = {up, up, up};
   const auto         triangle = triangle_of(corners, normals, nullptr);
   const Vector3D     centre(0.3, 0.1, -0.2);
   CGL::SceneObjects::SphereObject object(centre, 0.7, nullptr);
   const CGL::SceneObjects::Sphere sphere(&object, centre, 0.7);
   const Vector3D                  ahead = Vector3D(3.1, -2.3, 4.7) - centre;
   for (double weight : {0.13, 0.29, 0.41}) {
      const furnace_vec3 on_triangle =
          weight * corners[0] + 0.37 * corners[1] + (0.63 - weight) * corners[2];
      const Vector3D on_sphere = centre + 0.7 * (ahead + Vector3D(weight)).unit();
      if (has_digits_of_a_float(triangle, theirs(on_triangle)) ||
          has_digits_of_a_float(sphere, on_sphere))
         return true;
   }
   return false;
}

void find_written(Written &is) {
   // One direction for all of the film may be a mistake; the skeleton's is this one.
   const auto ahead = [](double x, double y) {
      return (theirs(any_camera()).generate_ray(x, y).d - Vector3D(0, 0, -1)).norm2() == 0;
   };
   is.in_float = is_skeleton(computes_in_float);
   is.camera = !is_skeleton([&] { return ahead(0.1, 0.2) && ahead(0.9, 0.7); });
   is.triangle = !is_skeleton([] {
      const furnace_vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up{0, 0, 1};
      const furnace_vec3 normals[] = {up, up, up};
      return is_met_by_all(triangle_of(corners, normals, nullptr));
   });
   is.sphere = !is_skeleton([] {
      CGL::SceneObjects::SphereObject object(Vector3D(), 1, nullptr);
      return is_met_by_all(CGL::SceneObjects::Sphere(&object, Vector3D(), 1));
   });
   is.box = !is_skeleton([] {
      return is_hit_by_all([](const Ray &ray) {
         double t0 = ray.min_t, t1 = ray.max_t;
         return BBox(Vector3D(0.0), Vector3D(1.0)).intersect(ray, t0, t1);
      });
   });
   is.hierarchy = !is_skeleton(keeps_all_in_one_leaf);
   is.pixels = !is_skeleton(leaves_the_pixel_alone);
   is.path = !is_skeleton(shows_normals);
   is.f = !Probe::is_white([](Probe &probe, PathTracer &) {
      return probe.floor.f(Vector3D(0, 0, 1), Vector3D(0, 0, 1));
   });
   is.sample_f = !is_skeleton([] {
      Vector3D wi;
      double   pdf = -7;
      Surface(Vector3D(0.5), Vector3D()).sample_f(Vector3D(0, 0, 1), &wi, &pdf);
      return pdf == -7;
   });
   is.emission = !Probe::is_white([](Probe &probe, PathTracer &tracer) {
      return light(&PathTracer::zero_bounce_radiance, tracer, probe.ray, probe.hit);
   });
   is.direct = !Probe::is_white([](Probe &probe, PathTracer &tracer) {
      return light(&PathTracer::one_bounce_radiance, tracer, probe.ray, probe.hit);
   });
   is.by_light = !Probe::is_white([](Probe &probe, PathTracer &tracer) {
      return light(&PathTracer::estimate_direct_lighting_importance, tracer, probe.ray, probe.hit);
   });
   is.by_hemisphere = !Probe::is_white([](Probe &probe, PathTracer &tracer) {
      return light(&PathTracer::estimate_direct_lighting_hemisphere, tracer, probe.ray, probe.hit);
   });
   is.indirect = !is_skeleton([] {
      Probe probe;
      for (int i = 0; i < 64; ++i)
         if (!probe.is_black_after(i & 1 ? 3 : 0, i & 2)) return false;
      return true;
   });
   is.adaptive = is.pixels && !is_skeleton(never_stops);
}

std::string version_of(const Written &is) {
   const std::pair<bool, const char *> parts[] = {
       {is.camera, "camera rays"},        {is.pixels, "pixels"},
       {is.triangle, "triangles"},        {is.sphere, "spheres"},
       {is.hierarchy, "the BVH"},   {is.box, "boxes"},
       {is.f, "f"},                       {is.sample_f, "sample_f"},
       {is.emission, "emission"},         {is.by_hemisphere, "hemisphere sampling"},
       {is.by_light, "light sampling"},   {is.direct, "one bounce"},
       {is.path, "light along paths"},    {is.indirect, "indirect light"},
       {is.adaptive, "adaptive sampling"}};
   std::string missing;
   for (const auto &part : parts)
      if (!part.first) missing += (missing.empty() ? "" : ", ") + std::string(part.second);
   return missing.empty() ? "homework 3" : "homework 3 (not written yet: " + missing + ")";
}

uint32_t traits_of(const Written &is) {
   // The course prescribes uniform directions, and who draws them by the cosine has the same mean with less noise: that is
   // nobody's mistake, so no plain estimators are promised for them.
   uint32_t traits = FURNACE_ISOLATED_BOUNCES | FURNACE_DEPTH_LIMIT | FURNACE_INDEPENDENT_PIXELS |
                     FURNACE_INDEPENDENT_SAMPLES;
   if (is.in_float) traits |= FURNACE_SINGLE_PRECISION;
   if (is.hierarchy) traits |= FURNACE_BRUTE_FORCE | FURNACE_COUNTS_TRAVERSAL;
   if (is.by_hemisphere) traits |= FURNACE_HEMISPHERE_SAMPLING;
   if (is.adaptive) traits |= FURNACE_ADAPTIVE_SAMPLING;
   return traits;
}

// The core without what is not written.
const furnace_core *core_of(const furnace_core &whole, const Written &is) {
   static furnace_core core;
   core = whole;
   if (!is.camera) core.generate_rays = nullptr;
   if (!is.triangle) core.intersect_triangle = nullptr;
   if (!is.sphere) core.intersect_sphere = nullptr;
   if (!is.box) core.intersect_box = nullptr;
   if (!is.f) core.eval_bsdf = nullptr;
   if (!is.sample_f) core.sample_bsdf = nullptr;
   if (!is.adaptive) core.adaptive_mean = nullptr;
   if (!is.emission && !is.direct && !is.path) core.radiance = nullptr;
   if (!is.camera || !is.pixels) core.render = nullptr;
   if (!is.triangle && !is.sphere) {
      core.build = nullptr, core.release = nullptr, core.intersect = nullptr;
      core.occluded = nullptr, core.radiance = nullptr, core.render = nullptr;
   }
   return &core;
}

} // namespace

// ---- between the submission and its own functions -----------------------------------------------

#define SUBMITTED(Function, symbol) static const auto own = submitted<Function>(symbol)

namespace CGL {

Ray Camera::generate_ray(double x, double y) const {
   if (takes(FURNACE_TAKES_CAMERA) && View::last())
      return theirs(bench().generate_ray(View::last()->given, {x, y}));
   SUBMITTED(Ray(const Camera *, double, double), "_ZNK3CGL6Camera12generate_rayEdd");
   return own(this, x, y);
}

bool BBox::intersect(const Ray &ray, double &t0, double &t1) const {
   typedef bool Test(const BBox *, const Ray &, double &, double &);
   SUBMITTED(Test, "_ZNK3CGL4BBox9intersectERKNS_3RayERdS4_");
   if (!takes(FURNACE_TAKES_BOX_TEST)) return own(this, ray, t0, t1);
   const furnace_box_hit hit = bench().intersect_box(ours(min), ours(max), ours(ray));
   // Some hand the ray's own interval over, which is not to end at the box.
   if (hit.hit && &t0 != &ray.min_t) t0 = hit.t_enter;
   if (hit.hit && &t1 != &ray.max_t) t1 = hit.t_exit;
   return hit.hit;
}

Vector3D PathTracer::est_radiance_global_illumination(const Ray &ray) {
   typedef Vector3D Along(PathTracer *, const Ray &);
   SUBMITTED(Along, "_ZN3CGL10PathTracer32est_radiance_global_illuminationERKNS_3RayE");
   Built *built = Built::at_hand();
   if (built && built->hides_emission && !takes(FURNACE_TAKES_PATH))
      return built->from_first_bounce(ray, [&] { return own(this, ray); });
   if (!takes(FURNACE_TAKES_PATH) || !built || Surface::all_black()) return own(this, ray);
   const furnace_integrator &asked = built->settings;
   return theirs(built->light_of_bench(ours(ray), asked.first_bounce, asked.last_bounce));
}

} // namespace CGL

#ifdef __ELF__

typedef Vector3D Light(PathTracer *, const Ray &, const Intersection &);

// Bounce 1 by the bench, at the end of a ray that the submission has traced.
static Vector3D direct_by_bench(const Ray &ray) {
   if (Surface::all_black()) return Vector3D();
   furnace_ray arrived = ours(ray);
   arrived.t_max = infinity;
   return theirs(Built::at_hand()->light_of_bench(arrived, 1, 1));
}
static bool is_direct_by_bench() {
   return takes(FURNACE_TAKES_DIRECT_LIGHTING) && Built::at_hand();
}

// Members by their names for the loader: a submission whose functions take more need not declare these.
#define BEFORE(name, symbol)                                                                       \
   Vector3D name(PathTracer *, const Ray &, const Intersection &) __asm__(symbol)
BEFORE(furnace_zero_bounce, ZERO_BOUNCE);
BEFORE(furnace_one_bounce, ONE_BOUNCE);
BEFORE(furnace_by_hemisphere, BY_HEMISPHERE);
BEFORE(furnace_by_light, BY_LIGHT);
#undef BEFORE

Vector3D furnace_zero_bounce(PathTracer *tracer, const Ray &ray, const Intersection &hit) {
   SUBMITTED(Light, ZERO_BOUNCE);
   return takes(FURNACE_TAKES_EMISSION) ? hit.bsdf->get_emission() : own(tracer, ray, hit);
}

Vector3D furnace_one_bounce(PathTracer *tracer, const Ray &ray, const Intersection &hit) {
   SUBMITTED(Light, ONE_BOUNCE);
   return is_direct_by_bench() ? direct_by_bench(ray) : own(tracer, ray, hit);
}

Vector3D furnace_by_hemisphere(PathTracer *tracer, const Ray &ray, const Intersection &hit) {
   SUBMITTED(Light, BY_HEMISPHERE);
   return is_direct_by_bench() ? direct_by_bench(ray) : own(tracer, ray, hit);
}

Vector3D furnace_by_light(PathTracer *tracer, const Ray &ray, const Intersection &hit) {
   SUBMITTED(Light, BY_LIGHT);
   return is_direct_by_bench() ? direct_by_bench(ray) : own(tracer, ray, hit);
}

#endif
#undef SUBMITTED

extern "C" FURNACE_EXPORT const furnace_core *furnace_core_entry(uint32_t bench_abi) {
   static bool              known = (find_written(written()), true);
   static const std::string version = version_of(written());
   const furnace_core      *whole =
       known ? furnace::detail::entry<Course>(bench_abi, "cs184", version.c_str(),
                                              traits_of(written()))
             : nullptr;
   return whole ? core_of(*whole, written()) : nullptr;
}
