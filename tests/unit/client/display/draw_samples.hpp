// Changes and frames for a DrawQueue, and what a FakeScreen writes of them.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/display/draw_queue.hpp"

namespace runstone::test {

using Lines = std::vector<std::string>;

inline ChunkKey chunk(std::int32_t x) { return {0, {x, 0, 0}}; }

inline ChunkUpload mesh_of(std::uint64_t serial, std::size_t quads) {
  ChunkUpload upload;
  upload.serial = serial;
  upload.edge = 16;
  ChunkMesh mesh;
  mesh.opaque.quads.resize(quads);
  upload.mesh = std::make_shared<const ChunkMesh>(std::move(mesh));
  return upload;
}

inline FrameOrder small_frame() {
  FrameOrder order;
  order.width = 4;
  order.height = 2;
  return order;
}

}  // namespace runstone::test
