#include "client/display/mesh_pipeline.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "client/display/draw_thread.hpp"
#include "client/net/wake_up.hpp"
#include "common/os/steady_clock.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/runs/worst_chunk.hpp"
#include "tests/unit/client/display/fake_screen.hpp"

using namespace runstone;
using test::AuthorityModel;
using test::chunks_of;
using test::FakeScreenLog;

namespace {

constexpr std::int32_t kEdge = 16;

/// Returns the bytes of a chunk in the light field: runs of 4 bytes, and a byte for each column.
constexpr std::size_t light_bytes(std::size_t runs) { return 4 * runs + kEdge * kEdge; }

/// One chunk in view, meshed on this thread and drawn on a fake screen, as off screen.
struct Fixture {
  Fixture() {
    replica.set_view({1, {0, 0, 0}, 0, 0});
    static_cast<void>(replica.open({kEdge, 5, 77, 1, 0, 0, 0}));
    MaterialTable materials;
    REQUIRE(materials.add({"red", {220, 30, 30, 255}, Visibility::opaque, {}}).has_value());
    pipeline.set_materials(materials);
    replica.receive(chunks_of(world.snapshot({0, 0, 0})), {});
    turn();
    order();
    take_frames(1);
  }
  ~Fixture() { screen_log.release(); }
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

  /// Passes changes to the workers and their meshes to the draw thread.
  void turn() {
    pipeline.take(replica.drain_changes(), ClockOffset{}, steady_now_us());
    pipeline.mesh();  // meshes
    pipeline.mesh();  // queues the meshes for upload
  }
  void edit(VoxelPos at, Material material = 1) {
    const EditDescriptor set{SetVoxel{at}, {}, material};
    REQUIRE(replica.receive(world.commit({9, 1, ++edits}, set), {}).has_value());
    turn();
  }
  void order() { order_at(steady_now_us()); }
  /// Orders a frame if one is due at this time.
  void order_at(TimeUs now_us) {
    FrameOrder frame;
    frame.width = 8;
    frame.height = 4;
    if (pipeline.is_frame_due(now_us)) pipeline.draw(now_us, std::move(frame));
  }
  void take_frames(std::uint64_t presented) {
    while (pipeline.frames_presented() < presented) {
      wake.wait(std::chrono::seconds(1));
      pipeline.take_drawn();
    }
  }
  std::uint64_t edits_presented() const {
    const LatencyReport report = pipeline.recorder().report();
    return report[EditPath::remote].step[static_cast<std::size_t>(LatencyStage::presented)].count();
  }
  std::size_t draws() const {
    const auto lines = screen_log.lines();
    return static_cast<std::size_t>(std::count(lines.begin(), lines.end(), "draw"));
  }

  AuthorityModel world{kEdge, 1};
  Replica replica;
  FakeScreenLog screen_log;
  WakeUp wake;
  DrawThread draw_thread{test::fake_screen_on(screen_log), DrawPriority::normal,
                         [this] { wake.notify(); }, UploadBudget{3'600'000'000, SIZE_MAX}};
  MeshPipeline pipeline{replica, &draw_thread, false, 0, [this] { wake.notify(); }};
  ClientSequence edits = 0;
};

}  // namespace

TEST_CASE_METHOD(
    Fixture,
    "an edit meshed while a frame is under way is presented by the next frame, not by that one",
    "[client_app]") {
  screen_log.hold();
  edit({1, 1, 1});
  order();
  screen_log.wait_until_drawing();
  edit({5, 5, 5});
  order();  // a frame is in progress, so no frame is ordered
  CHECK_FALSE(pipeline.is_up_to_date());
  screen_log.release();
  take_frames(2);
  CHECK(edits_presented() == 1);
  CHECK(pipeline.recorder().open_edits() == 1);
  CHECK(draws() == 2);
  order();
  take_frames(3);
  CHECK(edits_presented() == 2);
  CHECK(pipeline.recorder().open_edits() == 0);
  CHECK(pipeline.is_up_to_date());
}

TEST_CASE_METHOD(Fixture, "off screen an edit is drawn at once and anything else after a pause",
                 "[client_app]") {
  pipeline.moved();
  order_at(0);  // before the pause ends
  CHECK(pipeline.screenshots_done());
  edit({5, 5, 5});
  order_at(0);
  take_frames(2);
  CHECK(draws() == 2);
  CHECK(edits_presented() == 1);
}

TEST_CASE_METHOD(Fixture,
                 "the pipeline is up to date only after a frame has shown all terrain and edits",
                 "[client_app]") {
  CHECK(pipeline.is_up_to_date());
  replica.set_view({1, {0, 0, 0}, 1, 0});
  pipeline.view_changed();
  replica.receive(chunks_of(world.snapshot({1, 0, 0})), {});
  pipeline.take(replica.drain_changes(), ClockOffset{}, steady_now_us());
  CHECK_FALSE(pipeline.is_up_to_date());  // not meshed
  for (const ChunkCoord at : {ChunkCoord{-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) {
    replica.receive(chunks_of(world.snapshot(at)), {});
  }
  for (int job = 0; job < 10; ++job)
    turn();  // one job each; the first of five chunks may be meshed twice
  CHECK(pipeline.recorder().open_edits() == 0);
  CHECK_FALSE(pipeline.is_up_to_date());  // queued for upload
  screen_log.hold();
  order_at(steady_now_us() + MeshPipeline::kFrameOffScreenUs);
  screen_log.wait_until_drawing();
  CHECK_FALSE(pipeline.is_up_to_date());  // being drawn
  screen_log.release();
  take_frames(2);
  CHECK(pipeline.is_up_to_date());
}

TEST_CASE_METHOD(Fixture, "a screenshot is done when its file is written", "[client_app]") {
  const test::TempFolder folder;
  pipeline.request_screenshot(folder / "a.png", steady_now_us());
  screen_log.hold();
  order();
  screen_log.wait_until_drawing();
  pipeline.take_drawn();
  CHECK_FALSE(pipeline.screenshots_done());
  screen_log.release();
  take_frames(2);
  CHECK(pipeline.screenshots_done());
  CHECK(pipeline.screenshots_written().has_value());
  CHECK(std::filesystem::file_size(folder / "a.png") > 0);
  pipeline.request_screenshot(folder / "nosuch/b.png", steady_now_us());
  order();
  take_frames(3);
  CHECK(pipeline.screenshots_done());
  const std::string why =
      folder / "nosuch/b.png" + ": cannot be written: No such file or directory";
  REQUIRE_FALSE(pipeline.screenshots_written().has_value());
  CHECK(pipeline.screenshots_written().error() == why);
  CHECK(pipeline.take_unwritten() == std::vector<std::string>{why});
  pipeline.moved();
  order_at(steady_now_us() + MeshPipeline::kFrameOffScreenUs);
  take_frames(4);
  // A frame without screenshots does not change the result.
  CHECK_FALSE(pipeline.screenshots_written().has_value());
}

TEST_CASE_METHOD(
    Fixture,
    "has_caught_up() waits for the meshes queued before its first call and for no later ones",
    "[client_app]") {
  edit({5, 5, 5});
  CHECK_FALSE(pipeline.has_caught_up());
  screen_log.hold();
  order();
  screen_log.wait_until_drawing();
  edit({6, 5, 5});
  screen_log.release();
  take_frames(2);
  CHECK(pipeline.recorder().open_edits() == 1);
  CHECK(pipeline.has_caught_up());
}

TEST_CASE_METHOD(Fixture,
                 "the report has whole meshes, meshes of layers, and the size of kept meshes",
                 "[client_app]") {
  const auto counts = [this] {
    ClientReport report;
    pipeline.add_to(report);
    const MeshStats& meshes = report.meshes;
    CHECK(meshes.jobs == meshes.whole_ns.count() + meshes.layers_ns.count());
    return std::array{meshes.whole_ns.count(), meshes.layers_ns.count(), meshes.kept_bytes};
  };
  CHECK(counts() == std::array<std::uint64_t, 3>{1, 0, 0});
  // Voxels that stand alone. With many of them, meshing a few layers costs less than meshing the
  // whole chunk.
  for (std::int32_t i = 0; i < 64; ++i)
    edit({2 * (i % 4) + 8, 2 * (i / 4 % 4) + 8, 2 * (i / 16) + 8});
  const auto before = counts();
  CHECK(before[0] + before[1] == 65);
  edit({5, 5, 5});
  const auto after = counts();
  CHECK(after[0] == before[0]);
  CHECK(after[1] == before[1] + 1);
  // A mesh of layers has room for some more quads.
  CHECK(after[2] >= sizeof(ChunkMesh) + 6 * 65 * sizeof(Quad));
  CHECK(after[2] <= sizeof(ChunkMesh) + (6 * 65 + 128) * sizeof(Quad));
}

TEST_CASE_METHOD(Fixture, "when materials change their look, all chunks are meshed again",
                 "[client_app]") {
  edit({5, 5, 5});
  edit({6, 5, 5});
  const auto quads_uploaded = [this] {
    order();
    take_frames(pipeline.frames_presented() + 1);
    const auto lines = screen_log.lines();
    const auto upload = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
      return line.starts_with("upload");
    });
    return *upload;
  };
  CHECK(quads_uploaded() == "upload 0 quads 6");
  MaterialTable invisible;
  REQUIRE(invisible.add({"gone", {}, Visibility::empty, {}}).has_value());
  pipeline.set_materials(invisible);
  turn();
  pipeline.moved();
  order_at(steady_now_us() + MeshPipeline::kFrameOffScreenUs);
  take_frames(pipeline.frames_presented() + 1);
  CHECK(screen_log.lines()[screen_log.lines().size() - 2] == "upload 0 quads 0");
}

TEST_CASE_METHOD(Fixture, "a chunk with a material that was unknown is meshed again when it comes",
                 "[client_app][materials]") {
  const auto meshes = [this] {
    ClientReport report;
    pipeline.add_to(report);
    return report.meshes.jobs;
  };
  edit({5, 5, 5});
  edit({6, 5, 5}, 2);  // beside it, of a material that the table lacks: taken for opaque
  CHECK(pipeline.gpu_bytes() == light_bytes(4) + 10 * sizeof(Quad));
  MaterialTable grown = pipeline.materials();
  REQUIRE(grown.append(2, std::vector<MaterialRow>{{"ice", {9, 9, 9, 90}, Visibility::transparent}})
              .has_value());
  const auto before = meshes();
  pipeline.set_materials(grown);
  CHECK(pipeline.materials().size() == 3);
  turn();
  CHECK(meshes() == before + 1);
  // The opaque voxel is seen through the other one.
  CHECK(pipeline.gpu_bytes() == light_bytes(4) + 11 * sizeof(Quad));
  edit({6, 5, 6}, 2);  // no face between the two of ice, whose other faces merge
  CHECK(pipeline.gpu_bytes() == light_bytes(6) + 12 * sizeof(Quad));
  REQUIRE(grown.append(3, std::vector<MaterialRow>{{"lime", {9, 9, 9, 255}, Visibility::opaque}})
              .has_value());
  const auto unused = meshes();
  pipeline.set_materials(grown);
  turn();
  CHECK(meshes() == unused);  // no chunk has it
}

TEST_CASE_METHOD(Fixture, "the bytes of meshes count while their chunk is in view",
                 "[client_app]") {
  CHECK(pipeline.mesh_bytes() == 0);
  CHECK(pipeline.gpu_bytes() == 0);
  edit({5, 5, 5});  // a single voxel: six quads of 8 bytes
  CHECK(pipeline.mesh_bytes() == sizeof(ChunkMesh) + 48);
  CHECK(pipeline.gpu_bytes() == light_bytes(3) + 48);
  edit({9, 5, 5});
  CHECK(pipeline.gpu_bytes() == light_bytes(5) + 96);
  replica.set_view({2, {9, 0, 0}, 0, 0});
  turn();
  CHECK(pipeline.mesh_bytes() == 0);
  CHECK(pipeline.gpu_bytes() == 0);
}

TEST_CASE("without room for meshes one job is made at a time", "[client_app]") {
  const bool has_room = GENERATE(true, false);
  CAPTURE(has_room);
  constexpr std::int32_t edge = 16;
  Replica replica;
  replica.set_view({1, {0, 0, 0}, 2, 0});
  static_cast<void>(replica.open({edge, 5, 77, 1, 0, 0, 0}));
  WakeUp wake;
  MeshPipeline pipeline(replica, nullptr, false, 1, [&wake] { wake.notify(); });
  MaterialTable materials;
  REQUIRE(materials.add({"red", {220, 30, 30, 255}, Visibility::opaque, {}}).has_value());
  pipeline.set_materials(materials);
  std::size_t chunks = 0;
  for (std::int32_t x = -2; x <= 2; ++x) {
    for (std::int32_t z = -2; z <= 2; ++z) {
      if (!replica.view()->contains({x, 0, z})) continue;
      replica.receive(chunks_of(ChunkSnapshot{{0, {x, 0, z}}, test::worst_chunk(edge)}), {});
      ++chunks;
    }
  }
  pipeline.take(replica.drain_changes(), ClockOffset{}, steady_now_us());
  if (!has_room) pipeline.set_mesh_bytes_max(0);
  const auto jobs = [&pipeline] {
    ClientReport report;
    pipeline.add_to(report);
    return report.meshes.jobs;
  };
  pipeline.mesh();
  CHECK(jobs() == (has_room ? 8 : 1));
  while (!pipeline.is_up_to_date()) {  // it goes on nevertheless
    wake.wait(std::chrono::seconds(1));
    pipeline.mesh();
  }
  CHECK(jobs() >= chunks);
  CHECK(pipeline.mesh_bytes() > chunks * 12'000 * sizeof(Quad));
}

TEST_CASE_METHOD(Fixture, "a tile is meshed, uploaded and drawn, and leaves with its view",
                 "[client_app]") {
  View view{2, {0, 0, 0}, 2, 0};
  view.levels = 1;
  replica.set_view(view);
  pipeline.view_changed();
  RunChunk ground = uniform_chunk(Extent::cube(kEdge), kEmpty);
  fill(ground, 0, 10, 1);
  Chunk chunk;
  chunk.voxels = ground;
  replica.receive(chunks_of(ChunkSnapshot{{1, {1, 0, 0}}, chunk}), {});
  replica.receive(UniformChunks{2, {{{1, {-1, 0, 0}}, kEmpty, {}}}}, {});
  pipeline.take(replica.drain_changes(), ClockOffset{}, steady_now_us());
  CHECK_FALSE(pipeline.is_far_meshed());
  pipeline.mesh();
  pipeline.mesh();
  CHECK(pipeline.is_far_meshed());
  CHECK_FALSE(pipeline.is_up_to_date());
  const std::size_t bytes = pipeline.far_bytes();
  CHECK(bytes > replica.far_tiles().bytes());
  order_at(steady_now_us() + MeshPipeline::kFrameOffScreenUs);
  take_frames(2);
  const auto has_line = [this](const std::string& line) {
    const auto lines = screen_log.lines();
    return std::count(lines.begin(), lines.end(), line) == 1;
  };
  CHECK(has_line("tile 1 1 quads 6"));
  CHECK(has_line("tile 1 -1 quads 0"));
  CHECK(pipeline.is_up_to_date());
  view.levels = 0;
  view.number = 3;
  replica.set_view(view);
  turn();
  CHECK(pipeline.far_bytes() == 0);
  order_at(steady_now_us() + MeshPipeline::kFrameOffScreenUs);
  take_frames(3);
  CHECK(has_line("remove 1"));
  CHECK(has_line("remove -1"));
}
