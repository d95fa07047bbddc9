#include "common/mesh/rdm/touched_layers.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <initializer_list>

#include "common/core/ids.hpp"

namespace runstone::rdm {
namespace {

using Beyond = std::array<DirtyLayers, kDirectionCount>;

std::size_t place_of(Direction d) { return static_cast<std::size_t>(d); }

LayerSet layer_set(std::initializer_list<unsigned> layers) {
  LayerSet set;
  for (const unsigned layer : layers) set.set(layer);
  return set;
}

/// Returns the layers of one changed voxel.
DirtyLayers voxel_changed(unsigned x, unsigned y, unsigned z) {
  DirtyLayers dirty;
  dirty.layer[0].set(x);
  dirty.layer[1].set(y);
  dirty.layer[2].set(z);
  return dirty;
}

TEST_CASE("without a change no layer is touched", "[mesh]") {
  const RunChunk chunk = uniform_chunk(Extent::cube(8), 1);
  MeshNeighbours around;
  around.fill(&chunk);
  const TouchedLayers touched(chunk, around, {}, {});
  for (const LayerSet& faces : touched.faces) CHECK(faces.none());
  CHECK(touched.slow.none());
}

TEST_CASE("a changed layer touches itself and the layer whose faces point at it", "[mesh]") {
  for (const std::uint8_t side :
       {std::uint8_t{8}, std::uint8_t{32}, std::uint8_t{64}, std::uint8_t{128}}) {
    const RunChunk chunk = uniform_chunk(Extent::cube(side), 1);
    const unsigned last = side - 1u;
    CAPTURE(last);
    const TouchedLayers touched(chunk, {}, voxel_changed(0, 3, last), {});
    const auto faces = [&](Direction d) { return touched.faces.at(place_of(d)); };
    // Beyond the first and the last layer there is none.
    CHECK(faces(Direction::neg_x) == layer_set({0, 1}));
    CHECK(faces(Direction::pos_x) == layer_set({0}));
    CHECK(faces(Direction::neg_y) == layer_set({3, 4}));
    CHECK(faces(Direction::pos_y) == layer_set({2, 3}));
    CHECK(faces(Direction::neg_z) == layer_set({last}));
    CHECK(faces(Direction::pos_z) == layer_set({last - 1, last}));
    CHECK(touched.slow == layer_set({last}));
  }
}

TEST_CASE("the layers to sweep are those of the slowest axis", "[mesh]") {
  for (const AxisOrder order : kAxisOrders) {
    const RunChunk chunk = uniform_chunk(Extent{16, 32, 8}, 1, order);
    const TouchedLayers touched(chunk, {}, voxel_changed(15, 20, 2), {});
    const auto slow = static_cast<std::size_t>(axes_of(order)[2]);
    CHECK(touched.slow == layer_set({std::array{15u, 20u, 2u}.at(slow)}));
  }
}

TEST_CASE("a change of all voxels touches all layers", "[mesh]") {
  const RunChunk chunk = uniform_chunk(Extent{8, 128, 33}, 1);
  DirtyLayers dirty;
  const auto sides = chunk.extent.sides();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (unsigned layer = 0; layer < sides.at(axis); ++layer) dirty.layer.at(axis).set(layer);
  }
  const TouchedLayers touched(chunk, {}, dirty, {});
  for (std::size_t d = 0; d < kDirectionCount; ++d)
    CHECK(touched.faces.at(d) == dirty.layer.at(d / 2));
  CHECK(touched.slow == dirty.layer[2]);
}

TEST_CASE("a neighbour's change touches the layer at its side", "[mesh]") {
  const RunChunk chunk = uniform_chunk(Extent{8, 16, 32}, 1, AxisOrder::xyz);
  // The neighbours are deeper than the chunk, so that their last layers have other numbers.
  const RunChunk along_x = uniform_chunk(Extent{64, 16, 32}, 1);
  const RunChunk along_y = uniform_chunk(Extent{8, 64, 32}, 1);
  const RunChunk along_z = uniform_chunk(Extent{8, 16, 64}, 1);
  const MeshNeighbours around = {&along_x, &along_x, &along_y, &along_y, &along_z, &along_z};
  const auto touched_by = [&](Direction d, const DirtyLayers& changed) {
    Beyond beyond;
    beyond.at(place_of(d)) = changed;
    return TouchedLayers(chunk, around, {}, beyond);
  };
  const auto only = [](const TouchedLayers& touched, Direction d, unsigned layer) {
    for (std::size_t other = 0; other < kDirectionCount; ++other) {
      const LayerSet& faces = touched.faces.at(other);
      if (faces != (other == place_of(d) ? layer_set({layer}) : LayerSet())) return false;
    }
    return true;
  };

  // Beside the middle and the fastest axis, the layers of the change are swept.
  TouchedLayers touched = touched_by(Direction::neg_x, voxel_changed(63, 5, 9));
  CHECK(only(touched, Direction::neg_x, 0));
  CHECK(touched.slow == layer_set({9}));
  touched = touched_by(Direction::pos_x, voxel_changed(0, 5, 0));
  CHECK(only(touched, Direction::pos_x, 7));
  CHECK(touched.slow == layer_set({0}));
  touched = touched_by(Direction::neg_y, voxel_changed(7, 63, 31));
  CHECK(only(touched, Direction::neg_y, 0));
  CHECK(touched.slow == layer_set({31}));
  touched = touched_by(Direction::pos_y, voxel_changed(7, 0, 31));
  CHECK(only(touched, Direction::pos_y, 15));
  CHECK(touched.slow == layer_set({31}));
  // Beside the slowest axis, the chunk's own first or last layer is swept.
  touched = touched_by(Direction::neg_z, voxel_changed(1, 2, 63));
  CHECK(only(touched, Direction::neg_z, 0));
  CHECK(touched.slow == layer_set({0}));
  touched = touched_by(Direction::pos_z, voxel_changed(1, 2, 0));
  CHECK(only(touched, Direction::pos_z, 31));
  CHECK(touched.slow == layer_set({31}));

  // Changes in other layers of a neighbour do not touch the chunk.
  for (const auto& [direction, changed] : {std::pair{Direction::neg_x, voxel_changed(62, 5, 9)},
                                           std::pair{Direction::pos_x, voxel_changed(1, 5, 9)},
                                           std::pair{Direction::neg_z, voxel_changed(1, 2, 31)},
                                           std::pair{Direction::pos_z, voxel_changed(1, 2, 63)}}) {
    touched = touched_by(direction, changed);
    for (const LayerSet& faces : touched.faces) CHECK(faces.none());
    CHECK(touched.slow.none());
  }
}

TEST_CASE("changes of chunk and neighbours are joined, and a missing neighbour has none",
          "[mesh]") {
  const RunChunk chunk = uniform_chunk(Extent::cube(8), 1, AxisOrder::xyz);
  MeshNeighbours around{};
  around.at(place_of(Direction::pos_x)) = &chunk;
  Beyond beyond;
  beyond.fill(voxel_changed(0, 0, 6));
  const TouchedLayers touched(chunk, around, voxel_changed(2, 2, 2), beyond);
  CHECK(touched.faces.at(place_of(Direction::pos_x)) == layer_set({1, 2, 7}));
  CHECK(touched.faces.at(place_of(Direction::neg_x)) == layer_set({2, 3}));
  CHECK(touched.faces.at(place_of(Direction::neg_z)) == layer_set({2, 3}));
  CHECK(touched.slow == layer_set({2, 6}));
}

}  // namespace
}  // namespace runstone::rdm
