// The bounding volume hierarchy (BVH): construction and traversal.
#ifndef PATHTRACER_HIERARCHY_HPP
#define PATHTRACER_HIERARCHY_HPP

#include "shapes.hpp"

namespace pathtracer {

class Bvh {
 public:
   furnace_build_stats stats{};

   Bvh(const Geometry &geometry, const furnace_build &settings)
       : geometry(geometry), bench_built(settings.bench), split(settings.split),
         leaf_size(std::max(1u, settings.max_leaf_size)) {
      for (uint32_t i = 0; i < geometry.primitives.size(); ++i) order.push_back(i);
      if (!settings.accelerate) leaf_size = uint32_t(order.size());
      if (!order.empty()) build(0, order.size(), 1);
      stats.nodes = nodes.size();
      stats.bytes = nodes.size() * sizeof(Node) + order.size() * sizeof(uint32_t);
   }

   // The nearest hit, and which primitive it is on; -1 for none.
   int64_t closest(const Ray &ray, Hit &hit, Stats &stats) const {
      if (bench.has(FURNACE_TAKES_TRAVERSAL)) {
         hit = bench.intersect(bench_built, ray);
         return geometry.find(hit);
      }
      Search search = searched(ray, false, stats);
      hit = search.hit;
      return search.found;
   }
   bool any(const Ray &ray, Stats &stats) const {
      if (bench.has(FURNACE_TAKES_TRAVERSAL)) return bench.occluded(bench_built, ray);
      return searched(ray, true, stats).found >= 0;
   }

 private:
   struct Node {
      Box    bounds;
      size_t first = 0, count = 0; // of a leaf, in `order`
      size_t right = 0;            // of an inner node; its left child follows it
   };
   const Geometry       &geometry;
   furnace_built        *bench_built;
   uint32_t              split, leaf_size;
   std::vector<uint32_t> order;
   std::vector<Node>     nodes;

   Vec centroid(uint32_t primitive) const { return geometry.primitives[primitive].bounds.centre(); }

   size_t build(size_t first, size_t last, uint64_t depth) {
      size_t index = nodes.size();
      nodes.emplace_back();
      for (size_t i = first; i < last; ++i)
         nodes[index].bounds.add(geometry.primitives[order[i]].bounds);
      stats.max_depth = std::max(stats.max_depth, depth);
      if (last - first <= leaf_size) {
         nodes[index].first = first, nodes[index].count = last - first;
         ++stats.leaves;
         return index;
      }
      size_t middle = divide(first, last);
      build(first, middle, depth + 1);
      size_t right = build(middle, last, depth + 1); // `nodes` may move meanwhile
      nodes[index].right = right;
      return index;
   }

   // Reorders order[first..last) and answers where the right child begins. Where a rule separates
   // nothing, all centroids being in one place, the node is halved.
   size_t divide(size_t first, size_t last) {
      Box centroids;
      Vec mean{0, 0, 0};
      for (size_t i = first; i < last; ++i) {
         centroids.add(centroid(order[i]));
         mean = mean + centroid(order[i]) / Real(last - first);
      }
      int    axis = centroids.longest_axis();
      size_t middle = first;
      switch (split) {
      case FURNACE_SPLIT_MEDIAN: break;
      case FURNACE_SPLIT_MEAN_OF_CENTROIDS:
         middle = partition(first, last, [&](Vec c) { return at(c, axis) < at(mean, axis); });
         break;
      case FURNACE_SPLIT_MIDPOINT: {
         Real plane = at(centroids.centre(), axis);
         middle = partition(first, last, [&](Vec c) { return at(c, axis) < plane; });
         break;
      }
      default: middle = by_surface_area(first, last, centroids);
      }
      return middle == first || middle == last ? halve(first, last, axis) : middle;
   }

   template <class GoesLeft> size_t partition(size_t first, size_t last, GoesLeft goes_left) {
      auto left = [&](uint32_t primitive) { return goes_left(centroid(primitive)); };
      auto begin = order.begin();
      return size_t(std::partition(begin + first, begin + last, left) - begin);
   }

   size_t halve(size_t first, size_t last, int axis) {
      auto less = [&](uint32_t a, uint32_t b) {
         return at(centroid(a), axis) < at(centroid(b), axis);
      };
      size_t middle = (first + last) / 2;
      auto   begin = order.begin();
      std::nth_element(begin + first, begin + middle, begin + last, less);
      return middle;
   }

   // The plane between two of 16 equal bins for which count times area, summed over both sides, is
   // least (Wald 2007).
   size_t by_surface_area(size_t first, size_t last, const Box &centroids) {
      Real cheapest = INFINITE;
      Plane  best{};
      for (int axis = 0; axis < 3; ++axis) {
         Plane plane{axis, at(centroids.min, axis), at(centroids.max, axis), 0};
         if (!(plane.low < plane.high)) continue;
         std::array<Side, BINS> bins;
         for (size_t i = first; i < last; ++i)
            bins[plane.bin(centroid(order[i]))].add(geometry.primitives[order[i]].bounds);
         for (plane.first_right = 1; plane.first_right < BINS; ++plane.first_right) {
            Side left, right;
            for (int bin = 0; bin < BINS; ++bin)
               (bin < plane.first_right ? left : right).add(bins[bin]);
            if (left.count == 0 || right.count == 0 || !(left.cost() + right.cost() < cheapest))
               continue;
            cheapest = left.cost() + right.cost();
            best = plane;
         }
      }
      if (cheapest == INFINITE) return first;
      return partition(first, last, [&](Vec c) { return best.bin(c) < best.first_right; });
   }

   static constexpr int BINS = 16;
   struct Side {
      Box    bounds;
      size_t count = 0;
      void   add(const Box &box) { bounds.add(box), ++count; }
      void   add(const Side &other) { bounds.add(other.bounds), count += other.count; }
      Real cost() const { return Real(count) * bounds.half_area(); }
   };
   struct Plane {
      int    axis;
      Real low, high; // of the centroids
      int    first_right;
      int    bin(Vec c) const {
         return std::min(BINS - 1, int(BINS * ((at(c, axis) - low) / (high - low))));
      }
   };

   struct Search {
      Ray         ray; // shortened by what is found
      bool        any;
      Stats      &stats;
      int64_t     found = -1;
      Hit hit{};
      bool        is_over() const { return any && found >= 0; }
   };
   struct Child {
      size_t node;
      bool   is_met;
      Real enter;
   };

   Child look_at(size_t node, Search &search) const {
      Real enter, exit;
      ++search.stats.box_tests;
      bool is_met = nodes[node].bounds.meets(search.ray, enter, exit, 4 * EPSILON);
      return {node, is_met, enter};
   }

   Search searched(const Ray &ray, bool any, Stats &stats) const {
      Search search{ray, any, stats};
      if (nodes.size() == 1) test_leaf(nodes[0], search); // so is brute force
      else if (!nodes.empty() && look_at(0, search).is_met) walk(nodes[0], search);
      return search;
   }

   // The child that the ray enters first goes first; the other one only if nothing nearer is found.
   void walk(const Node &node, Search &search) const {
      if (node.right == 0) return test_leaf(node, search);
      size_t left = size_t(&node - nodes.data()) + 1;
      Child  near = look_at(left, search), far = look_at(node.right, search);
      if (!near.is_met || (far.is_met && far.enter < near.enter)) std::swap(near, far);
      if (near.is_met) walk(nodes[near.node], search);
      if (far.is_met && far.enter <= search.ray.t_max && !search.is_over())
         walk(nodes[far.node], search);
   }

   void test_leaf(const Node &leaf, Search &search) const {
      for (size_t i = leaf.first; i < leaf.first + leaf.count && !search.is_over(); ++i) {
         ++search.stats.primitive_tests;
         Hit hit;
         if (!geometry.hit(order[i], search.ray, hit)) continue;
         search.hit = hit, search.found = order[i];
         search.ray.t_max = hit.t;
      }
   }
};

} // namespace pathtracer

#endif
