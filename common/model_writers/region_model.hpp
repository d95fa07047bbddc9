// RegionModel: the triangles of one region, and RegionModelMaker, which makes them of quads.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/model_writers/corner_grid.hpp"

namespace runstone {

/// A vertex, 0 .. kModelRegionEdge along each axis from the corner of its region. The normal is the
/// direction of its face.
struct ModelVertex {
  std::uint8_t x = 0, y = 0, z = 0;
  Direction direction = Direction::neg_x;
  friend bool operator==(const ModelVertex&, const ModelVertex&) = default;
};

/// The triangles of one material in a region.
struct ModelPart {
  std::uint16_t number = 0;  // cell number of the build, at least 1
  std::size_t first_vertex = 0, vertex_count = 0;
  std::size_t first_index = 0, index_count = 0;
};

struct RegionModel {
  VoxelPos origin;  // of the lowest corner of the region in the build
  /// Opaque materials first. No part is empty.
  std::vector<ModelPart> parts;
  std::vector<ModelVertex> vertices;
  /// Three a triangle, counter-clockwise from outside, from the first vertex of the part on.
  std::vector<std::uint32_t> indices;

  std::span<const ModelVertex> vertices_of(const ModelPart& part) const {
    return std::span(vertices).subspan(part.first_vertex, part.vertex_count);
  }
  std::span<const std::uint32_t> indices_of(const ModelPart& part) const {
    return std::span(indices).subspan(part.first_index, part.index_count);
  }
};

class RegionModelMaker {
 public:
  explicit RegionModelMaker(bool is_welded) : is_welded_(is_welded) {}

  /// Makes the triangles of quads in the order of RegionMesher::quads_of(). If `corners` is not
  /// null, edges are split at each point of the set that lies within them. The model is valid until
  /// the next call. Cost: O(quads); with `corners`, O(lengths of the edges).
  const RegionModel& make(VoxelPos origin, std::span<const Quad> quads, const CornerGrid* corners);

 private:
  /// A vertex on an edge of a quad, and its distance from the beginning of the edge.
  struct EdgePoint {
    std::uint32_t vertex = 0;
    int at = 0;
  };
  using Edge = std::vector<EdgePoint>;

  void begin_plane(const QuadFields& q);
  std::uint32_t vertex_at(const Corner& at);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void add_quad(Quad quad, const CornerGrid* corners);
  void read_edge(const std::array<Corner, 4>& ring, std::size_t from, std::size_t to,
                 const CornerGrid& corners, Edge& out);
  void fill_edges();

  bool is_welded_;
  RegionModel model_;
  /// The plane of the current quads: one direction, layer and material.
  QuadFields plane_;
  Axis u_{}, v_{};
  /// The vertices of the plane, by v and u. A slot counts if its stamp is the current one.
  struct Slot {
    std::uint32_t stamp = 0, vertex = 0;
  };
  std::vector<Slot> slots_ = std::vector<Slot>(kRegionPoints * kRegionPoints);
  std::uint32_t stamp_ = 0;
  std::array<std::uint32_t, 4> ring_{};  // the vertices of the current quad
  Edge lower_, right_, upper_, left_;
};

}  // namespace runstone
