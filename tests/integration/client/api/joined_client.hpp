// JoinedClient: a WorldClient whose program does what its events say: it meshes the chunks that are
// reported, and remembers the other events.
#pragma once
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/api/world_client.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone::test {

inline bool is_equal(const ChunkMesh& a, const ChunkMesh& b) {
  return a.opaque.quads == b.opaque.quads && a.transparent.quads == b.transparent.quads &&
         a.shapes.opaque == b.shapes.opaque && a.shapes.transparent == b.shapes.transparent;
}

class JoinedClient {
 public:
  explicit JoinedClient(WorldClientOptions options) : client_(connected(std::move(options))) {}

  WorldClient& operator*() { return client_; }
  WorldClient* operator->() { return &client_; }

  void pump(std::size_t chunks_max = 8) {
    client_.wait(2);
    client_.step();
    for (WorldEvent& event : client_.drain(chunks_max)) {
      if (const auto* changed = std::get_if<ChunkChanged>(&event)) {
        const ChunkCoord at = changed->source.at;
        meshes[at] = mesh_of(changed->source);
        if (++reports[at] > 1 && changed->cause == ChangeCause::terrain) ++terrain_again;
      } else if (const auto* removed = std::get_if<ChunkRemoved>(&event)) {
        CHECK(meshes.erase(removed->at) == 1);
        reports.erase(removed->at);
      } else {
        others.push_back(std::move(event));
      }
    }
  }
  /// Requires `reached` to come true within 20 seconds.
  void until(const std::function<bool()>& reached, std::size_t chunks_max = 8) {
    const TimeUs end_us = steady_now_us() + 20'000'000;
    while (!reached()) {
      pump(chunks_max);
      REQUIRE(steady_now_us() < end_us);
    }
  }
  /// Waits until all of the view is here and meshed.
  void catch_up() {
    until([&] { return client_.is_complete() && client_.outdated_count() == 0; });
  }
  /// Waits for an event of this kind and returns the first one, with those before it removed.
  template <class Event>
  Event await() {
    std::optional<Event> found;
    const auto look = [&] {
      for (std::size_t i = 0; i < others.size(); ++i) {
        const auto* event = std::get_if<Event>(&others[i]);
        if (event == nullptr) continue;
        found = *event;
        others.erase(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        return true;
      }
      return false;
    };
    until(look);
    return *std::move(found);
  }
  EditNumber edit(const EditDescriptor& edit) {
    const auto number = client_.submit(edit);
    INFO((number ? std::string() : number.error().text));
    REQUIRE(number.has_value());
    return *number;
  }
  /// Returns how many shown chunks have no mesh, or one that is out of date.
  std::size_t outdated_meshes() {
    std::size_t count = 0;
    const std::vector<ChunkCoord> shown = client_.chunks();
    for (const ChunkCoord& at : shown) {
      const auto kept = meshes.find(at);
      if (kept == meshes.end() || !is_equal(kept->second, mesh_of(*client_.mesh_source(at))))
        ++count;
    }
    return count + (meshes.size() > shown.size() ? meshes.size() - shown.size() : 0);
  }

  std::map<ChunkCoord, ChunkMesh> meshes;
  std::map<ChunkCoord, int> reports;
  std::size_t terrain_again = 0;  // reports of a chunk that had a mesh, because of terrain
  std::vector<WorldEvent> others;

 private:
  static WorldClient connected(WorldClientOptions options) {
    auto client = WorldClient::connect(std::move(options));
    INFO((client ? std::string() : client.error()));
    REQUIRE(client.has_value());
    return *std::move(client);
  }
  ChunkMesh mesh_of(const MeshSource& source) {
    ChunkMesh mesh;
    mesh_chunk(*source.chunk, source.beside(), {}, *client_.mesh_materials(), scratch_, mesh);
    return mesh;
  }

  WorldClient client_;
  ChunkMeshScratch scratch_;
};

}  // namespace runstone::test
