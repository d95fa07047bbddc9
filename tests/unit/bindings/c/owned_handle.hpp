// Handles of the C interface that free themselves, and the other holder of the same voxels.
#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "bindings/c/runstone.h"
#include "common/runs/run_chunk.hpp"

namespace runstone::test {

struct FreeHandle {
  void operator()(runstone_chunk* handle) const { runstone_chunk_free(handle); }
  void operator()(runstone_edits* handle) const { runstone_edits_free(handle); }
  void operator()(runstone_visibility* handle) const { runstone_visibility_free(handle); }
  void operator()(runstone_shapes* handle) const { runstone_shapes_free(handle); }
  void operator()(runstone_client* handle) const { runstone_client_free(handle); }
  void operator()(runstone_borders* handle) const { runstone_borders_free(handle); }
  void operator()(runstone_mesh* handle) const { runstone_mesh_free(handle); }
  void operator()(runstone_space* handle) const { runstone_space_free(handle); }
};

template <class T>
using Owned = std::unique_ptr<T, FreeHandle>;

/// Calls create(&handle), which has to succeed.
template <class T, class F>
Owned<T> owned(F&& create) {
  T* handle = nullptr;
  REQUIRE(create(&handle) == RUNSTONE_OK);
  REQUIRE(handle != nullptr);
  return Owned<T>(handle);
}

/// Asks for the number of elements and then for the elements, as programs in C do.
template <class T, class F>
std::vector<T> fetched(F&& call) {
  std::size_t count = 0;
  REQUIRE(call(static_cast<T*>(nullptr), std::size_t{0}, &count) == RUNSTONE_OK);
  std::vector<T> out(count);
  std::size_t again = 0;
  REQUIRE(call(out.data(), count, &again) == RUNSTONE_OK);
  REQUIRE(again == count);
  return out;
}

/// Gives the runs of a chunk of the C++ libraries to the C interface.
inline Owned<runstone_chunk> handle_of(const RunChunk& chunk) {
  std::vector<std::uint32_t> ends;
  std::vector<std::uint16_t> materials;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    ends.push_back(chunk.runs.end(i));
    materials.push_back(chunk.runs.material(i));
  }
  return owned<runstone_chunk>([&](runstone_chunk** out) {
    return runstone_chunk_create_from_runs(chunk.extent.x, chunk.extent.y, chunk.extent.z,
                                           static_cast<std::uint32_t>(chunk.order), ends.data(),
                                           materials.data(), ends.size(), out);
  });
}

/// Returns true if a handle has exactly the runs of a chunk of the C++ libraries.
inline bool same_runs(const runstone_chunk* handle, const RunChunk& chunk) {
  runstone_chunk_info info{};
  info.struct_size = sizeof info;
  REQUIRE(runstone_chunk_get_info(handle, &info) == RUNSTONE_OK);
  std::vector<std::uint32_t> ends(info.runs);
  std::vector<std::uint16_t> materials(info.runs);
  std::size_t count = 0;
  REQUIRE(runstone_chunk_runs(handle, ends.data(), materials.data(), info.runs, &count) ==
          RUNSTONE_OK);
  if (count != chunk.runs.size() || info.order != static_cast<std::uint32_t>(chunk.order) ||
      info.sides[0] != chunk.extent.x || info.sides[1] != chunk.extent.y ||
      info.sides[2] != chunk.extent.z) {
    return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (ends[i] != chunk.runs.end(i) || materials[i] != chunk.runs.material(i)) return false;
  }
  return true;
}

inline Owned<runstone_visibility> visibility_handle(const std::vector<std::uint8_t>& of) {
  return owned<runstone_visibility>([&](runstone_visibility** out) {
    return runstone_visibility_create(of.data(), of.size(), out);
  });
}

}  // namespace runstone::test
