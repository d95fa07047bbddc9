// Joins a server, meshes the ground around the player, places a voxel and waits for the answer.
//   example-join-and-edit SERVER
#include <iostream>

#include "client/api/world_client.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/mesh/chunk_mesher.hpp"

using namespace runstone;

int main(int argc, char** argv) {
  const auto fail = [](const std::string& why) { return std::cerr << why << '\n', 1; };
  auto client = WorldClient::connect({.server = argc > 1 ? argv[1] : "", .view_radius = 2});
  if (!client) return fail(client.error());
  ChunkMeshScratch scratch;
  ChunkMesh mesh;
  for (bool has_edited = false;;) {
    client->wait(10);  // a program that draws calls step() once a frame
    client->step();
    for (const WorldEvent& event : client->drain(16)) {
      if (const auto* chunk = std::get_if<ChunkChanged>(&event)) {
        const MeshSource& source = chunk->source;
        mesh_chunk(*source.chunk, source.beside(), {}, *client->mesh_materials(), scratch, mesh);
        std::cout << source.at.y << ": " << mesh.quad_count() << " quads\n";
      } else if (const auto* done = std::get_if<EditConfirmed>(&event)) {
        std::cout << "the edit is number " << done->sequence << " of the world\n";
        return 0;
      } else if (const auto* rejected = std::get_if<EditRejected>(&event)) {
        return fail(rejected->text);
      } else if (const auto* lost = std::get_if<ConnectionLost>(&event)) {
        return fail(lost->headline + ": " + lost->detail);
      }
    }
    if (has_edited || !client->is_complete()) continue;
    const auto edit = client->submit({SetVoxel{{0, 20, 0}}, {}, *client->find_material("stone")});
    if (!edit) return fail(edit.error().text);
    has_edited = true;
  }
}
