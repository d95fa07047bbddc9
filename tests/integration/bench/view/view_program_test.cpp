// The split view as a program: its counts are right and its picture shows them. No test checks times.
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "bench/view/view_bench.hpp"
#include "bench/view/view_pane.hpp"
#include "bench/view/view_world.hpp"
#include "client/platform/gl_context.hpp"
#include "tests/integration/bench/bench_output.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::bench;

namespace {

bool has_gl() {
  try {
    make_headless_context();
    return true;
  } catch (const std::runtime_error& error) {
    WARN(error.what());
    return false;
  }
}

}  // namespace

TEST_CASE("the split view draws the same chunks in three meshes", "[view]") {
  if (!has_gl()) return;
  const test::TempFolder folder;
  ViewOptions options;
  options.repetitions = options.frames = 1;
  options.width = 600;
  options.height = 200;
  options.out = folder / "view.png";
  const auto result = run_view(options);
  REQUIRE(result);
  REQUIRE(result->rows.size() == 3);
  CHECK(result->chunks == 1);
  CHECK(result->rows[0].mesher == "culled faces");
  CHECK(result->rows[1].mesher == "binary greedy");
  CHECK(result->rows[2].mesher == "RDM");
  CHECK(result->rows[2].quads == 562);  // as in docs/meshing.md
  CHECK(result->rows[0].quads == 4610);
  for (const ViewRow& row : result->rows) {
    CHECK(row.gpu_bytes == 8 * row.quads);
    CHECK(row.mesh_us > 0);
    CHECK(row.draw_us > 0);
  }
  CHECK(std::filesystem::file_size(options.out) > 1000);
}

TEST_CASE("the view draws one mesh alone", "[view]") {
  if (!has_gl()) return;
  const test::TempFolder folder;
  ViewOptions options;
  options.repetitions = options.frames = 1;
  options.width = options.height = 96;
  options.mesher = "rdm";
  options.edges = options.captions = false;
  options.out = folder / "view.png";
  const auto result = run_view(options);
  REQUIRE(result);
  REQUIRE(result->rows.size() == 1);
  CHECK(result->rows[0].mesher == "RDM");
  CHECK(result->rows[0].quads == 562);
}

TEST_CASE("the meshers of the split view show the same faces", "[view]") {
  const auto world = view_world("town", "");
  REQUIRE(world);
  CHECK(materials_of(*world).size() > 5);
  const auto panes = view_panes(*world, 1);
  REQUIRE(panes.size() == 3);
  std::map<int, std::size_t> area;  // by direction
  for (const ViewPane& pane : panes) {
    std::map<int, std::size_t> of_pane;
    std::size_t quads = 0;
    for (const ViewChunk& chunk : pane.chunks) {
      for (const QuadLayers* layers : {&chunk.mesh.opaque, &chunk.mesh.transparent}) {
        quads += layers->quads.size();
        for (const Quad quad : layers->quads) {
          const QuadFields fields = unpack(quad);
          of_pane[static_cast<int>(fields.direction)] +=
              std::size_t{fields.width} * std::size_t{fields.height};
        }
      }
    }
    CAPTURE(pane.name);
    CHECK(quads == pane.quads);
    if (area.empty()) area = of_pane;
    CHECK(of_pane == area);
  }
  CHECK(panes[2].quads < panes[0].quads / 3);
}

TEST_CASE("runstone-bench view rejects options that it cannot satisfy", "[view]") {
  const auto refused = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "view");
    return run_bench(arguments).exit_code;
  };
  CHECK(refused({"--world", "nowhere"}) == 2);
  CHECK(refused({"--size", "5x5"}) == 2);
  CHECK(refused({"--mesher", "marching_cubes"}) == 2);
  CHECK(refused({"--pitch", "100"}) == 2);
  if (has_gl()) CHECK(refused({"--out", "/no/such/folder/view.png", "--frames", "1"}) == 1);
}
