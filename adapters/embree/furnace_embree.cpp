// Intel's Embree as a core: parts 1 and 2, its triangles, its spheres, its BVH.
//
//     apt install libembree-dev
//     c++ -std=c++17 -O2 -shared -fPIC -Iinclude adapters/embree/furnace_embree.cpp -lembree3 -o libfurnace_embree.so
//     cargo furnace 1 2 --core ./libfurnace_embree.so
//
// With Embree 4 (Debian 13, Homebrew) it is -lembree4. -DFURNACE_EMBREE_FAST leaves out RTC_SCENE_FLAG_ROBUST, as most
// renderers do. Embree computes in single precision, counts nothing and offers no box test. Its brute force is a scene
// for each primitive, so that every primitive is met by the same arithmetic as in a BVH, and without one.
// docs/book/src/trusted-renderers.md tells what comes of it.
#include "furnace_core.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#elif __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#error "Embree is not installed: `apt install libembree-dev` (Debian, Ubuntu), `brew install embree` (macOS)"
#endif

namespace {

// A scene for each primitive takes a few kilobytes.
constexpr size_t MOST_SCENES = 200000;

struct Release {
   void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
   void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
   void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Scene = std::unique_ptr<RTCSceneTy, Release>;
using Geometry = std::unique_ptr<RTCGeometryTy, Release>;

// One thread, as the cores that it is compared with build.
RTCDevice device() {
   static std::unique_ptr<RTCDeviceTy, Release> only(rtcNewDevice("threads=1,set_affinity=0"));
   if (!only) throw std::runtime_error("Embree gives no device");
   return only.get();
}

void put(float *to, furnace_vec3 v) {
   to[0] = float(v.x);
   to[1] = float(v.y);
   to[2] = float(v.z);
}

// Triangles `first` to `last` of a mesh, with the normals of its vertices as attribute 0 if it has any.
Geometry triangles(const furnace_mesh &mesh, uint32_t first, uint32_t last) {
   Geometry made(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE));
   auto     vertices = [&](RTCBufferType type, const furnace_vec3 *from) {
      auto to = static_cast<float *>(rtcSetNewGeometryBuffer(made.get(), type, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), mesh.vertex_count));
      for (uint32_t i = 0; i < mesh.vertex_count; ++i) put(to + 3 * i, from[i]);
   };
   vertices(RTC_BUFFER_TYPE_VERTEX, mesh.positions);
   if (mesh.normals) {
      rtcSetGeometryVertexAttributeCount(made.get(), 1);
      vertices(RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, mesh.normals);
   }
   auto indices = static_cast<uint32_t *>(rtcSetNewGeometryBuffer(
      made.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), last - first));
   std::copy(mesh.indices + 3 * first, mesh.indices + 3 * last, indices);
   rtcCommitGeometry(made.get());
   return made;
}

Geometry sphere_geometry(furnace_vec3 centre, double radius) {
   Geometry made(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_SPHERE_POINT));
   auto     to = static_cast<float *>(rtcSetNewGeometryBuffer(made.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                              RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
   put(to, centre);
   to[3] = float(radius);
   rtcCommitGeometry(made.get());
   return made;
}

Scene empty() {
   Scene made(rtcNewScene(device()));
#ifndef FURNACE_EMBREE_FAST
   rtcSetSceneFlags(made.get(), RTC_SCENE_FLAG_ROBUST);
#endif
   return made;
}

Scene of_one(const Geometry &geometry) {
   Scene made = empty();
   rtcAttachGeometryByID(made.get(), geometry.get(), 0);
   rtcCommitScene(made.get());
   return made;
}

// Embree's segments are closed, the contract's open: the next number inside.
float after(double t) {
   float next = float(t);
   return double(next) > t ? next : std::nextafter(next, std::numeric_limits<float>::infinity());
}

float before(double t) {
   float next = float(t);
   if (std::isinf(t) || double(next) < t) return next;
   return std::nextafter(next, -std::numeric_limits<float>::infinity());
}

RTCRay ray_of(const furnace_ray &ray) {
   RTCRay made{};
   put(&made.org_x, ray.origin);
   put(&made.dir_x, ray.direction);
   made.tnear = after(ray.t_min);
   made.tfar = before(ray.t_max);
   made.mask = ~0u;
   return made;
}

// Whether and where a ray meets a scene; `instID` is nothing to us.
bool meet(RTCScene scene, const furnace_ray &ray, RTCRayHit &found) {
   found.ray = ray_of(ray);
   found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
   found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
   rtcIntersect1(scene, &found);
#else
   RTCIntersectContext context;
   rtcInitIntersectContext(&context);
   rtcIntersect1(scene, &context, &found);
#endif
   return found.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

// What is told of a hit with `geometry`, which is a mesh, a smooth mesh or a sphere.
enum class Kind { flat, smooth, outward, inward };

furnace_hit told(const RTCRayHit &found, RTCGeometry geometry, Kind kind, uint32_t shape, uint32_t primitive) {
   furnace_hit  hit{};
   furnace_vec3 normal{found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z};
   hit.t = found.ray.tfar;
   hit.shape = shape;
   hit.primitive = primitive;
   hit.geometric_normal = hit.shading_normal = (kind == Kind::inward ? -1.0 : 1.0) * furnace::unit(normal);
   if (kind == Kind::outward || kind == Kind::inward) return hit;
   hit.uv = {found.hit.u, found.hit.v};
   if (kind == Kind::flat) return hit;
   float at[3];
   rtcInterpolate0(geometry, found.hit.primID, found.hit.u, found.hit.v, RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, at, 3);
   hit.shading_normal = furnace::unit({at[0], at[1], at[2]});
   return hit;
}

class Built {
 public:
   Built(const furnace_scene &scene, const furnace_build &settings) {
      for (uint32_t i = 0; i < scene.mesh_count; ++i) {
         const furnace_mesh &mesh = scene.meshes[i];
         shapes.push_back({mesh.normals ? Kind::smooth : Kind::flat, triangles(mesh, 0, mesh.triangle_count)});
      }
      for (uint32_t i = 0; i < scene.sphere_count; ++i) {
         const furnace_sphere &sphere = scene.spheres[i];
         shapes.push_back({sphere.inward ? Kind::inward : Kind::outward, sphere_geometry(sphere.centre, sphere.radius)});
      }
      if (settings.accelerate) {
         whole = empty();
         for (uint32_t i = 0; i < shapes.size(); ++i) rtcAttachGeometryByID(whole.get(), shapes[i].geometry.get(), i);
         rtcCommitScene(whole.get());
      } else {
         take_apart(scene);
      }
   }

   furnace_build_stats stats() const { return {}; }

   furnace_hit intersect(const furnace_ray &ray, furnace_traversal_stats &) const {
      RTCRayHit found;
      if (whole) {
         if (!meet(whole.get(), ray, found)) return furnace::miss();
         return of_shape(found, found.hit.geomID, found.hit.primID);
      }
      furnace_ray rest = ray;
      furnace_hit nearest = furnace::miss();
      for (const Part &part : parts)
         if (meet(part.scene.get(), rest, found)) {
            rest.t_max = found.ray.tfar;
            nearest = of_part(found, part);
         }
      return nearest;
   }

   bool occluded(const furnace_ray &ray, furnace_traversal_stats &stats) const {
      if (!whole) return intersect(ray, stats).primitive != FURNACE_NONE;
      RTCRay found = ray_of(ray);
#if RTC_VERSION_MAJOR >= 4
      rtcOccluded1(whole.get(), &found);
#else
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcOccluded1(whole.get(), &context, &found);
#endif
      return found.tfar < 0;
   }

 private:
   struct Shape {
      Kind     kind;
      Geometry geometry;
   };
   struct Part {
      uint32_t shape, primitive;
      Scene    scene;
   };
   std::vector<Shape> shapes;
   Scene              whole; // null: brute force
   std::vector<Part>  parts;

   furnace_hit of_shape(const RTCRayHit &found, uint32_t shape, uint32_t primitive) const {
      return told(found, shapes[shape].geometry.get(), shapes[shape].kind, shape, primitive);
   }
   // Embree numbers the one primitive of a part 0.
   furnace_hit of_part(RTCRayHit found, const Part &part) const {
      found.hit.primID = part.primitive;
      return of_shape(found, part.shape, part.primitive);
   }

   void take_apart(const furnace_scene &scene) {
      size_t count = scene.sphere_count;
      for (uint32_t i = 0; i < scene.mesh_count; ++i) count += scene.meshes[i].triangle_count;
      if (count > MOST_SCENES) throw furnace::Unsupported("brute force of Embree, a scene for each of so many primitives");
      for (uint32_t i = 0; i < scene.mesh_count; ++i)
         for (uint32_t j = 0; j < scene.meshes[i].triangle_count; ++j) {
            furnace_vec3 corners[3];
            for (int k = 0; k < 3; ++k) corners[k] = scene.meshes[i].positions[scene.meshes[i].indices[3 * j + k]];
            parts.push_back({i, j, of_triangle(corners)});
         }
      for (uint32_t i = 0; i < scene.sphere_count; ++i)
         parts.push_back({scene.mesh_count + i, 0, of_one(shapes[scene.mesh_count + i].geometry)});
   }

 public:
   static Scene of_triangle(const furnace_vec3 *corners) {
      static const uint32_t indices[] = {0, 1, 2};
      furnace_mesh          alone{};
      alone.positions = corners;
      alone.indices = indices;
      alone.vertex_count = 3;
      alone.triangle_count = 1;
      return of_one(triangles(alone, 0, 1));
   }
};

// One primitive by itself, kept from one ray of a batch to the next.
struct Alone {
   std::array<double, 18> made_of{};
   Geometry               geometry;
   Scene                  scene;

   template <typename Make> void of(const std::array<double, 18> &numbers, Make make) {
      if (scene && numbers == made_of) return;
      made_of = numbers;
      geometry = make();
      scene = of_one(geometry);
   }
};

struct Embree {
   Alone triangle, sphere;

   furnace_hit intersect_triangle(const furnace_vec3 *positions, const furnace_vec3 *normals, const furnace_ray &ray) {
      std::array<double, 18> numbers;
      std::memcpy(numbers.data(), positions, 9 * sizeof(double));
      std::memcpy(numbers.data() + 9, normals, 9 * sizeof(double));
      triangle.of(numbers, [&] {
         static const uint32_t indices[] = {0, 1, 2};
         furnace_mesh          mesh{};
         mesh.positions = positions;
         mesh.normals = normals;
         mesh.indices = indices;
         mesh.vertex_count = 3;
         mesh.triangle_count = 1;
         return triangles(mesh, 0, 1);
      });
      return answered(triangle, ray, Kind::smooth);
   }

   furnace_hit intersect_sphere(furnace_vec3 centre, double radius, const furnace_ray &ray) {
      sphere.of({centre.x, centre.y, centre.z, radius}, [&] { return sphere_geometry(centre, radius); });
      return answered(sphere, ray, Kind::outward);
   }

   std::unique_ptr<Built> build(const furnace_scene &scene, const furnace_build &settings) {
      return std::make_unique<Built>(scene, settings);
   }

 private:
   static furnace_hit answered(const Alone &alone, const furnace_ray &ray, Kind kind) {
      RTCRayHit found;
      return meet(alone.scene.get(), ray, found) ? told(found, alone.geometry.get(), kind, 0, 0) : furnace::miss();
   }
};

} // namespace

FURNACE_CORE(Embree, "embree", RTC_VERSION_STRING,
             FURNACE_BRUTE_FORCE | FURNACE_DETERMINISTIC | FURNACE_SINGLE_PRECISION)
