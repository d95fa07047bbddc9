// Materials that are added while clients play, over real connections.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/integration/client/travel/live_session.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/mesh/face_oracle.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

constexpr View kWoolView{1, {0, 4, 0}, 1, 1};
const auto kLime = static_cast<Material>(default_material_table().size());
constexpr ChunkKey kWoolChunk{0, {0, 4, 0}};

/// Returns the faces of the chunk as a client with this session meshes it, without neighbours.
std::vector<UnitFace> faces_of(LiveSession& client) {
  const auto shown = client.replica().shown(kWoolChunk);
  REQUIRE(shown != nullptr);
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(*shown, {}, VisibilityTable(visibilities(client.session().welcome()->materials)),
           scratch, mesh);
  return unit_faces(mesh);
}

Material shown_at(LiveSession& client, VoxelPos at) {
  const auto shown = client.replica().shown({0, chunk_of(at, 16)});
  return shown == nullptr ? kEmpty : material_at(*shown, local_of(at, 16));
}

}  // namespace

TEST_CASE("one adds materials, two build with them, and nobody is disturbed",
          "[integration][materials]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "wool.toml";
  std::ofstream(file) << "[[material]]\nname = \"lime\"\ncolour = \"#80ff20\"\n"
                         "[[material]]\nname = \"ice\"\ncolour = \"#a0c0ff80\"\n"
                         "visibility = \"transparent\"\n"
                         "look = { roughness = 5, pattern = \"tiles\" }\n";
  auto server = start_server(quiet_config(world), flat_creation());
  LiveSession ann(server->port(), kWoolView), bob(server->port(), kWoolView);
  ann.catch_up();
  bob.catch_up();
  RawClient old(server->port());  // it does not offer the feature
  REQUIRE(old.join(9).has_value());
  const EditDescriptor of_lime{FillBox{{{2, 70, 2}, {6, 74, 6}}}, {}, kLime};
  CHECK_FALSE(ann.session().offer(of_lime, steady_now_us(), steady_now_us()).has_value());

  const Answer added = control(world, {"materials", "add", file});
  REQUIRE(added.is_ok);
  CHECK(added.text == "2 materials added (record 1)\n" + std::to_string(kLime) + " lime\n" +
                          std::to_string(kLime + 1) + " ice\n");
  CHECK(control(world, {"materials", "lime"}).text == "lime\n");
  const auto goodbye = old.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::closing);

  ann.until([&] { return ann.session().welcome()->materials.knows(kLime + 1); });
  ann.edit(of_lime);
  ann.edit({SetVoxel{{6, 70, 2}}, {}, static_cast<Material>(kLime + 1)});  // beside the lime
  ann.catch_up();
  bob.until([&] { return shown_at(bob, {6, 70, 2}) == kLime + 1; });
  CHECK(shown_at(bob, {2, 70, 2}) == kLime);
  CHECK(bob.session().welcome()->materials == ann.session().welcome()->materials);
  const MaterialLook ice{10, 8, 5, 0, MaterialPattern::tiles};
  CHECK(bob.session().welcome()->materials[kLime + 1].look == ice);
  const std::vector<UnitFace> faces = faces_of(bob);
  CHECK(faces.size() == 6 * 4 * 4 + 5);  // the cube of lime, seen through the ice, and the ice
  CHECK(faces == faces_of(ann));
  for (LiveSession* client : {&ann, &bob}) {
    CHECK(client->session().connect_count() == 1);
    CHECK_FALSE(client->session().end().has_value());
    CHECK(client->replica().local_edits().counters().rejected == 0);
  }
  LiveSession late(server->port(), kWoolView);
  late.catch_up();
  CHECK(faces_of(late) == faces);

  const Answer again = control(world, {"materials", "add", file});
  CHECK_FALSE(again.is_ok);
  CHECK(again.text == "materials add: " + file + ":1: material[0]: name is already taken\n");
  server.reset();  // the world is free for the next server
  server = start_server(quiet_config(world), flat_creation());  // the look is in the log
  LiveSession after(server->port(), kWoolView);
  after.catch_up();
  CHECK(after.session().welcome()->materials[kLime + 1].look == ice);
}

}  // namespace runstone::test
