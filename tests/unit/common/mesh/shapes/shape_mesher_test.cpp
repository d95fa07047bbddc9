#include "common/mesh/shapes/shape_mesher.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

namespace runstone::test {
namespace {

constexpr Material kRock = 1, kSlab = 2, kPane = 3, kPlant = 4, kFull = 5, kUpper = 6;

Shape shape_of_boxes(std::vector<ShapeBox> boxes, ShapeForm form = ShapeForm::boxes) {
  return {form, std::move(boxes)};
}

const VisibilityTable& shape_visibility() {
  static const VisibilityTable table(std::vector<Visibility>{
      Visibility::empty, Visibility::opaque, Visibility::opaque, Visibility::transparent,
      Visibility::opaque, Visibility::opaque, Visibility::opaque});
  return table;
}

const ShapeTable& shape_table() {
  static const ShapeTable table(
      std::vector<Shape>{{},
                         {},
                         shape_of_boxes({{{0, 0, 0}, {16, 8, 16}}}),
                         shape_of_boxes({{{0, 0, 7}, {16, 16, 9}}}),
                         shape_of_boxes({{{2, 0, 2}, {14, 14, 14}}}, ShapeForm::crossed),
                         shape_of_boxes({{{0, 0, 0}, {16, 16, 16}}}),
                         shape_of_boxes({{{0, 8, 0}, {16, 16, 16}}})});
  return table;
}

RunChunk chunk_of(AxisOrder order, std::initializer_list<std::pair<VoxelBox, Material>> boxes) {
  RunChunk out = uniform_chunk(Extent::cube(16), kEmpty, order);
  for (const auto& [box, material] : boxes) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          const LocalPos at{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                            static_cast<std::uint8_t>(z)};
          fill(out, index_of(at, out.extent, order), 1, material);
        }
      }
    }
  }
  return out;
}

ShapeQuads shapes_in(const RunChunk& chunk, const MeshNeighbours& neighbours = {}) {
  ShapeScratch scratch;
  ShapeQuads out;
  mesh_shapes(chunk, neighbours, shape_visibility(), shape_table(), scratch, out);
  return out;
}

/// Returns the quads of a direction.
std::vector<QuadFields> facing(const std::vector<Quad>& quads, Direction d) {
  std::vector<QuadFields> out;
  for (const Quad quad : quads) {
    if (unpack(quad).direction == d) out.push_back(unpack(quad));
  }
  return out;
}

TEST_CASE("a row of slabs is one quad on top, along every axis", "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(order);
    const ShapeQuads along_x = shapes_in(chunk_of(order, {{{{2, 3, 4}, {12, 4, 5}}, kSlab}}));
    CHECK(along_x.opaque.size() == 6);
    CHECK(along_x.transparent.empty());
    const auto top = facing(along_x.opaque, Direction::pos_y);
    REQUIRE(top.size() == 1);
    // u is z and v is x.
    CHECK(top[0].x == 2);
    CHECK(top[0].y == 3);
    CHECK(top[0].z == 4);
    CHECK(top[0].width == 1);
    CHECK(top[0].height == 10);
    CHECK(top[0].material == kSlab);
    const ShapeFace face = shape_table()[kSlab].faces.faces()[top[0].face - 1U];
    CHECK(face.direction == Direction::pos_y);
    CHECK(face.depth == 8);
    const ShapeQuads along_z = shapes_in(chunk_of(order, {{{{2, 3, 4}, {3, 4, 14}}, kSlab}}));
    CHECK(facing(along_z.opaque, Direction::pos_y).size() == 1);
    // A floor of slabs has four sides of height 1, and one quad above and below.
    CHECK(shapes_in(chunk_of(order, {{{{0, 3, 0}, {16, 4, 16}}, kSlab}})).opaque.size() == 6);
  }
}

TEST_CASE("a tower of slabs does not join where slabs are half as high as a voxel",
          "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(order);
    const ShapeQuads tower = shapes_in(chunk_of(order, {{{{2, 3, 4}, {3, 13, 5}}, kSlab}}));
    CHECK(facing(tower.opaque, Direction::pos_x).size() == 10);
    CHECK(facing(tower.opaque, Direction::pos_y).size() == 10);
    CHECK(facing(tower.opaque, Direction::neg_y).size() == 10);
  }
}

TEST_CASE("panes join to a window in the transparent pass, without faces between them",
          "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(order);
    const ShapeQuads window = shapes_in(chunk_of(order, {{{{2, 3, 4}, {12, 9, 5}}, kPane}}));
    CHECK(window.opaque.empty());
    CHECK(window.transparent.size() == 6);
    for (const Direction d : {Direction::neg_z, Direction::pos_z}) {
      const auto wide = facing(window.transparent, d);
      REQUIRE(wide.size() == 1);
      CHECK(wide[0].width == 10);
      CHECK(wide[0].height == 6);
    }
  }
}

TEST_CASE("an opaque cube hides the border of a shape, and a shape hides what it fills",
          "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(order);
    const ShapeQuads on_rock = shapes_in(
        chunk_of(order, {{{{2, 3, 4}, {3, 4, 5}}, kRock}, {{{2, 4, 4}, {3, 5, 5}}, kSlab}}));
    CHECK(facing(on_rock.opaque, Direction::neg_y).empty());
    CHECK(on_rock.opaque.size() == 5);
    // A rock above a slab does not touch its upper face.
    const ShapeQuads below_rock = shapes_in(
        chunk_of(order, {{{{2, 4, 4}, {3, 5, 5}}, kRock}, {{{2, 3, 4}, {3, 4, 5}}, kSlab}}));
    CHECK(below_rock.opaque.size() == 6);
    // The side of a slab is hidden by a full shape, but not by an upper slab. That of the full
    // shape is not hidden by the slab.
    const ShapeQuads beside_full = shapes_in(
        chunk_of(order, {{{{2, 4, 4}, {3, 5, 5}}, kFull}, {{{3, 4, 4}, {4, 5, 5}}, kSlab}}));
    CHECK(beside_full.opaque.size() == 11);
    CHECK(facing(beside_full.opaque, Direction::neg_x).size() == 1);
    const ShapeQuads beside_upper = shapes_in(
        chunk_of(order, {{{{2, 4, 4}, {3, 5, 5}}, kUpper}, {{{3, 4, 4}, {4, 5, 5}}, kSlab}}));
    CHECK(beside_upper.opaque.size() == 12);
  }
}

TEST_CASE("neighbouring chunks hide and show the faces of shapes at the border", "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    for (const AxisOrder other : {AxisOrder::xyz, AxisOrder::zyx}) {
      CAPTURE(order, other);
      const RunChunk chunk = chunk_of(order, {{{{0, 0, 0}, {16, 1, 16}}, kSlab}});
      MeshNeighbours neighbours{};
      CHECK(shapes_in(chunk, neighbours).opaque.size() == 6);
      const RunChunk below = chunk_of(other, {{{{0, 15, 0}, {8, 16, 16}}, kRock}});
      const RunChunk same = chunk_of(other, {{{{0, 0, 0}, {16, 1, 16}}, kSlab}});
      neighbours[static_cast<std::size_t>(Direction::neg_y)] = &below;
      neighbours[static_cast<std::size_t>(Direction::pos_x)] = &same;
      const ShapeQuads quads = shapes_in(chunk, neighbours);
      CHECK(facing(quads.opaque, Direction::pos_x).empty());
      const auto bottom = facing(quads.opaque, Direction::neg_y);
      REQUIRE(bottom.size() == 1);
      CHECK(bottom[0].x == 8);
      CHECK(bottom[0].height == 8);  // v is x
      CHECK(bottom[0].width == 16);
    }
  }
}

TEST_CASE("plants are four quads each, and never join", "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    const ShapeQuads meadow = shapes_in(chunk_of(order, {{{{0, 3, 0}, {16, 4, 16}}, kPlant}}));
    CHECK(meadow.opaque.size() == 4 * 256);
  }
}

TEST_CASE("a cube beside a shape keeps its face, and cubes have no quads of shapes",
          "[mesh][shapes]") {
  const RunChunk chunk =
      chunk_of(AxisOrder::xyz, {{{{2, 3, 4}, {3, 4, 5}}, kRock}, {{{3, 3, 4}, {4, 4, 5}}, kFull}});
  const VisibilityTable cubes(std::vector<Visibility>{
      Visibility::empty, Visibility::opaque, Visibility::empty, Visibility::empty,
      Visibility::empty, Visibility::empty, Visibility::empty});
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(chunk, {}, cubes, scratch, mesh);
  CHECK(mesh.opaque.quads.size() == 6);
  const RunChunk rock = chunk_of(AxisOrder::xyz, {{{{2, 3, 4}, {9, 9, 9}}, kRock}});
  CHECK(shapes_in(rock).opaque.empty());
  ShapeScratch shape_scratch;
  ShapeQuads quads{{Quad{1}}, {Quad{2}}};
  mesh_shapes(chunk, {}, shape_visibility(), ShapeTable(), shape_scratch, quads);
  CHECK(quads.opaque.empty());
  CHECK(quads.transparent.empty());
}

TEST_CASE("a checkerboard of shapes shows every face of each", "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty, order);
    for (std::uint32_t i = 0; i < chunk.volume(); ++i) {
      const LocalPos p = pos_of(i, chunk.extent, order);
      if ((p.x + p.y + p.z) % 2 == 0) fill(chunk, i, 1, kSlab);
    }
    CHECK(shapes_in(chunk).opaque.size() == std::size_t{6} * 16 * 16 * 8);
  }
}

TEST_CASE("a chunk of more faces than a chunk may show has the first ones", "[mesh][shapes]") {
  Shape bars;
  for (std::uint8_t i = 0; i < 32; ++i) {
    const auto x = static_cast<std::uint8_t>(i % 8 * 2 + 1),
               z = static_cast<std::uint8_t>(i / 8 * 4 + 1);
    bars.boxes.push_back(
        {{x, 1, z}, {static_cast<std::uint8_t>(x + 1), 15, static_cast<std::uint8_t>(z + 1)}});
  }
  const ShapeTable shapes(std::vector<Shape>{{}, bars});
  const VisibilityTable visibility(std::vector<Visibility>{Visibility::empty, Visibility::opaque});
  const RunChunk chunk = uniform_chunk(Extent::cube(32), 1);
  ShapeScratch scratch;
  ShapeQuads quads;
  mesh_shapes(chunk, {}, visibility, shapes, scratch, quads);
  CHECK(quads.opaque.size() >= kShapeQuadsMax);
  CHECK(quads.opaque.size() < kShapeQuadsMax + kShapeQuadsMax / 16);
}

}  // namespace
}  // namespace runstone::test
