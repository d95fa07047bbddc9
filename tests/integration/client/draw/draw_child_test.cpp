// The draw child as servers use it, with the real client program, off screen. If there is no
// OpenGL, the cases say so with WARN and pass. Shell scripts act as faulty programs.
#include "server/draw/draw_child.hpp"

#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "tests/integration/client/draw/png_file.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"

namespace runstone {
namespace {

using test::contains;
using test::is_green;
using test::is_red;
using test::is_sky;
using test::PngFile;
using test::TempFolder;

constexpr std::int32_t kEdge = 32;
constexpr PictureSize kSize{160, 120};

MaterialTable red_and_green() {
  MaterialTable table;
  REQUIRE(table.add({"red", {220, 30, 30, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"green", {30, 200, 30, 255}, Visibility::opaque, {}}).has_value());
  return table;
}

std::optional<DrawChild> child_or_warn() {
  auto child = DrawChild::start({RUNSTONE_CLIENT_PROGRAM});
  if (!child) {
    INFO(child.error());
    REQUIRE(child.error().find("OpenGL") != std::string::npos);
    WARN("no context: " << child.error());
    return std::nullopt;
  }
  return *std::move(child);
}

/// A camera high above the corner of four chunks. North (-z) is up and +x is on the right.
DrawCamera above() {
  DrawCamera camera;
  camera.x = 32;
  camera.y = 110;
  camera.z = 32;
  camera.yaw = M_PI;
  camera.pitch = -M_PI / 2;
  return camera;
}

/// Writes an executable shell script and returns its path.
std::string script(const TempFolder& folder, const std::string& text) {
  std::string file = folder / "program";
  std::ofstream(file) << "#!/bin/sh\n" << text << "\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  return file;
}

std::string start_error(const DrawChildOptions& options) {
  const auto child = DrawChild::start(options);
  REQUIRE_FALSE(child.has_value());
  CHECK(child.error().find('\n') == std::string::npos);
  return child.error();
}

}  // namespace

TEST_CASE("a draw child draws the newest version of each chunk in its place",
          "[integration][draw]") {
  auto child = child_or_warn();
  if (!child) return;
  CHECK_FALSE(child->renderer().empty());
  const TempFolder folder;
  REQUIRE(child->world(kEdge, red_and_green()));
  const RunChunk red = uniform_chunk(Extent::cube(kEdge), 1),
                 green = uniform_chunk(Extent::cube(kEdge), 2);
  REQUIRE(child->chunk({0, {0, 0, 0}}, red));
  REQUIRE(child->chunk({0, {1, 0, 0}}, green));
  const auto drawn = child->draw(above(), kSize, folder / "one.png");
  REQUIRE(drawn.has_value());
  CHECK(drawn->quads > 0);
  CHECK(drawn->chunks == 2);
  const PngFile one(folder / "one.png");
  REQUIRE(one.width == kSize.width);
  REQUIRE(one.height == kSize.height);
  CHECK(is_red(one.mean(0.4, 0.4)));
  CHECK(is_green(one.mean(0.6, 0.4)));
  CHECK(is_sky(one.mean(0.4, 0.6)));  // no chunk was sent there
  CHECK(is_sky(one.mean(0.05, 0.05)));

  REQUIRE(child->chunk({0, {0, 0, 1}}, green));
  REQUIRE(child->chunk({0, {1, 0, 0}}, red));
  REQUIRE(child->forget({0, {0, 0, 0}}));
  REQUIRE(child->draw(above(), kSize, folder / "two.png"));
  const PngFile two(folder / "two.png");
  CHECK(is_sky(two.mean(0.4, 0.4)));
  CHECK(is_red(two.mean(0.6, 0.4)));
  CHECK(is_green(two.mean(0.4, 0.6)));
  CHECK(child->finish().has_value());
  CHECK(contains(child->draw(above(), kSize, "x.png").error(), "has finished"));
}

TEST_CASE("a draw child accepts more orders than the sockets hold, and other sizes and cameras",
          "[integration][draw]") {
  auto child = child_or_warn();
  if (!child) return;
  const TempFolder folder;
  REQUIRE(child->world(16, red_and_green()));
  // With a run for each voxel, 256 chunks are some megabytes.
  RunChunk speckled = uniform_chunk(Extent::cube(16), 1);
  for (VoxelIndex i = 0; i < speckled.volume(); i += 2) fill(speckled, i, 1, 2);
  for (int x = 0; x < 16; ++x) {
    for (int z = 0; z < 16; ++z) REQUIRE(child->chunk({0, {x, 0, z}}, speckled));
  }
  DrawCamera camera = above();
  camera.x = camera.z = 128;
  REQUIRE(child->draw(camera, {320, 200}, folder / "a.png"));
  CHECK(PngFile(folder / "a.png").width == 320);
  camera.near = 100;  // the ground is 94 voxels below
  REQUIRE(child->draw(camera, {64, 64}, folder / "b.png"));
  CHECK(is_sky(PngFile(folder / "b.png").mean(0.5, 0.5)));
}

TEST_CASE("a picture that cannot be written is an error with its name, and the child goes on",
          "[integration][draw]") {
  auto child = child_or_warn();
  if (!child) return;
  const TempFolder folder;
  REQUIRE(child->world(kEdge, red_and_green()));
  CHECK(contains(child->draw(above(), kSize, folder / "no/such/a.png").error(),
                 "no/such/a.png: cannot be written: No such file or directory"));
  CHECK(contains(child->draw(above(), {8, 8}, folder / "a.png").error(), "pixels"));
  CHECK(contains(child->draw(above(), kSize, "a\nb.png").error(), "file name"));
  CHECK(child->draw(above(), kSize, folder / "a.png").has_value());
  CHECK(contains(child->finish().error(), "ended with exit code 1"));  // a picture is missing
}

TEST_CASE("wrong orders end the child with its reason as the error", "[integration][draw]") {
  auto child = child_or_warn();
  if (!child) return;
  REQUIRE(child->world(kEdge, red_and_green()));
  REQUIRE(child->world(kEdge, red_and_green()));
  const auto drawn = child->draw(above(), kSize, "never.png");
  CHECK(contains(drawn.error(), "the world comes first, and once"));
  CHECK_FALSE(child->chunk({0, {0, 0, 0}}, uniform_chunk(Extent::cube(kEdge), 1)).has_value());
  CHECK_FALSE(child->finish().has_value());
}

TEST_CASE("the error of a missing program names it and the remedy", "[integration][draw]") {
  const TempFolder folder;
  const std::string error = start_error({folder / "nothing"});
  CHECK(contains(error, folder / "nothing" + ": cannot be started: No such file or directory"));
  CHECK(contains(error, "--client"));
  std::ofstream(folder / "text") << "no program";
  CHECK(contains(start_error({folder / "text"}), "Permission denied"));
  std::filesystem::permissions(folder / "text", std::filesystem::perms::owner_all);
  CHECK(contains(start_error({folder / "text"}), "Exec format error"));
  // The environment variable names the program.
  REQUIRE(::setenv("RUNSTONE_CLIENT", (folder / "elsewhere").c_str(), 1) == 0);
  CHECK(contains(start_error({}), folder / "elsewhere"));
  CHECK(contains(start_error({folder / "nothing"}), folder / "nothing"));
  REQUIRE(::unsetenv("RUNSTONE_CLIENT") == 0);
  CHECK(contains(
      start_error({}),
      "/runstone-client: cannot be started: "));  // there is none in the folder of this test
}

TEST_CASE("a child that ends, stays silent or answers nonsense is an error with that reason",
          "[integration][draw]") {
  const TempFolder folder;
  using namespace std::chrono_literals;
  CHECK(contains(start_error({script(folder, "exit 3")}), "ended with exit code 3"));
  CHECK(contains(start_error({script(folder, "kill -9 $$")}), "was ended by signal 9"));
  CHECK(contains(start_error({script(folder, "echo hello")}), "answered \"hello\""));
  CHECK(contains(start_error({script(folder, "echo ready 99 X; cat")}), "another version"));
  CHECK(
      contains(start_error({script(folder, "echo error no paint left; exit 2")}), "no paint left"));
  CHECK(contains(start_error({script(folder, "exec sleep 60"), 200ms}), "did nothing for 0 s"));
  CHECK(contains(start_error({.program = script(folder, "exec sleep 60"),
                              .answer_limit = 60s,
                              .should_continue = [] { return false; }}),
                 "is not wanted any more"));
  // The first script draws once and ends. The second one stays and gives a wrong answer.
  auto child = DrawChild::start({script(folder, "echo ready 2 X; head -c 20 >/dev/null; exit 5")});
  REQUIRE(child.has_value());
  CHECK(child->renderer() == "X");
  REQUIRE(child->world(kEdge, red_and_green()));
  CHECK(contains(child->draw(above(), kSize, "a.png").error(), "ended with exit code 5"));
  child = DrawChild::start(
      {script(folder, "echo ready 2 X; echo 'drawn quads=1 chunks=1 us=1 b.png'; cat >/dev/null")});
  REQUIRE(child.has_value());
  CHECK(contains(child->draw(above(), kSize, "a.png").error(), "sent an answer to another order"));
  // A child that does not read is killed when the sockets are full.
  child = DrawChild::start({script(folder, "echo ready 2 X; exec sleep 60"), 300ms});
  REQUIRE(child.has_value());
  RunChunk speckled = uniform_chunk(Extent::cube(kEdge), 1);
  for (VoxelIndex i = 0; i < speckled.volume(); i += 2)
    fill(speckled, i, 1, static_cast<Material>(2 + i % 999));
  bool refused = false;
  for (int i = 0; i < 1000 && !refused; ++i) refused = !child->chunk({0, {i, 0, 0}}, speckled);
  CHECK(refused);
}

TEST_CASE("the destructor ends the child", "[integration][draw]") {
  const TempFolder folder;
  const std::string mark = folder / "pid";
  pid_t pid = 0;
  {
    const auto child = DrawChild::start(
        {script(folder, "echo $$ > " + mark + "; echo ready 2 X; exec sleep 600")});
    REQUIRE(child.has_value());
    std::ifstream(mark) >> pid;
    REQUIRE(pid > 1);
    CHECK(::kill(pid, 0) == 0);
  }
  CHECK(::kill(pid, 0) != 0);
}

TEST_CASE("a child inherits no other descriptor", "[integration][draw]") {
  const TempFolder folder;
  const std::string list = folder / "list";
  std::ofstream held(folder / "held");  // std::ofstream opens without close-on-exec
  const auto child = DrawChild::start(
      {script(folder, "ls -l /proc/$$/fd > " + list + "; echo ready 2 X; cat >/dev/null")});
  REQUIRE(child.has_value());
  std::ifstream in(list);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  CHECK(contains(text, "0 -> socket"));
  CHECK_FALSE(contains(text, "held"));
}

}  // namespace runstone
