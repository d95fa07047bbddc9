// RegionModel: the triangles of one region, and RegionModelMaker, which makes them of quads.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/model_writers/corner_set.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// A vector of whole numbers that points away from a face. Its length is not 1, but for faces
/// across an axis.
using ModelNormal = std::array<std::int8_t, 3>;

/// Returns the vector of length 1.
std::array<double, 3> unit_normal(const ModelNormal& normal);

/// A vertex. Places are sixteenths of a voxel (kShapeUnits), 0 .. kModelRegionUnits along each axis
/// from the corner of its region.
struct ModelVertex {
  std::uint16_t x = 0, y = 0, z = 0;
  ModelNormal normal{};
  friend bool operator==(const ModelVertex&, const ModelVertex&) = default;
};

/// The triangles of one material in a region.
struct ModelPart {
  std::uint16_t number = 0;  // cell number of the build, at least 1
  std::size_t first_vertex = 0, vertex_count = 0;
  std::size_t first_index = 0, index_count = 0;
};

struct RegionModel {
  VoxelPos origin;  // of the lowest corner of the region in the build, in voxels
  /// True: a vertex lies between the corners of voxels.
  bool is_fine = false;
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

/// Returns the corners of a quad in the order of quad_corners(), in sixteenths of a voxel. `face`
/// is null for a quad of cubes, otherwise its face of the shape.
std::array<Corner, 4> quad_places(Quad quad, const ShapeFace* face);

/// Returns the face of a quad's shape, or null for a quad of cubes.
const ShapeFace* face_of(const QuadFields& q, const ShapeTable& shapes);

class RegionModelMaker {
 public:
  /// Keeps a reference to the shapes, which are those of the quads' materials.
  RegionModelMaker(bool is_welded, const ShapeTable& shapes)
      : is_welded_(is_welded), shapes_(shapes) {}

  /// Makes the triangles of quads in the order of RegionMesher::quads_of(). If `corners` is not
  /// null, the edges of faces across an axis are split at each place of the set that lies within
  /// them. The model is valid until the next call. Cost: O(quads); with `corners`, O(lengths of the
  /// edges), and what CornerSet names.
  const RegionModel& make(VoxelPos origin, std::span<const Quad> quads, const CornerSet* corners);

 private:
  /// A vertex on an edge of a quad, and its distance from the beginning of the edge.
  struct EdgePoint {
    std::uint32_t vertex = 0;
    int at = 0;
  };
  using Edge = std::vector<EdgePoint>;

  void begin_plane(const QuadFields& q, const ShapeFace* face);
  std::uint32_t vertex_at(const Corner& at);
  std::uint32_t new_vertex(const Corner& at);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void add_quad(Quad quad, const ShapeFace* face, const CornerSet* corners);
  void read_edge(const std::array<Corner, 4>& ring, std::size_t from, std::size_t to,
                 const CornerSet& corners, Edge& out);
  void fill_edges();

  bool is_welded_;
  const ShapeTable& shapes_;
  RegionModel model_;
  /// The plane of the current quads: one direction, layer and material.
  QuadFields plane_;
  Axis u_{}, v_{};
  ModelNormal normal_{};
  /// The vertices of a plane of cubes at the corners of voxels, by v and u. A slot counts if its
  /// stamp is the current one.
  struct Slot {
    std::uint32_t stamp = 0, vertex = 0;
  };
  std::vector<Slot> slots_ = std::vector<Slot>(kRegionPoints * kRegionPoints);
  std::uint32_t stamp_ = 0;
  /// The other vertices of the part, by place and normal.
  std::unordered_map<std::uint64_t, std::uint32_t> fine_;
  std::array<std::uint32_t, 4> ring_{};  // the vertices of the current quad
  Edge lower_, right_, upper_, left_;
  std::vector<int> distances_;
};

}  // namespace runstone
