#include "bench/frames/frames_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string_view>

#include "bench/frames/frames_world.hpp"
#include "bench/meshing/mesher_case.hpp"

namespace runstone::bench {
namespace {

constexpr std::array<std::string_view, 2> kWaysOfRdm = {"quads", "product"};
constexpr std::array<std::string_view, 5> kSameMesh = {"rdm_kept", "rdm_plain", "padded_binary",
                                                       "grid_binary", "mask_binary"};
constexpr int kSideMin = 16, kSideMaxPixels = 4096;

}  // namespace

std::vector<std::string> frames_mesher_names() {
  const auto mesher_cases = mesher_case_names();
  std::vector<std::string> out(mesher_cases.begin(), mesher_cases.end());
  out.insert(out.end(), kWaysOfRdm.begin(), kWaysOfRdm.end());
  return out;
}

std::vector<std::string> frames_meshers_by_default() {
  std::vector<std::string> out = frames_mesher_names();
  std::erase_if(out, [](const std::string& name) {
    return std::find(kSameMesh.begin(), kSameMesh.end(), name) != kSameMesh.end();
  });
  return out;
}

bool parse_size(const std::string& text, int& width, int& height) {
  const char* const end = text.data() + text.size();
  std::array<int, 2> sides{};
  const auto first = std::from_chars(text.data(), end, sides[0]);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != 'x') return false;
  const auto second = std::from_chars(first.ptr + 1, end, sides[1]);
  if (second.ec != std::errc{} || second.ptr != end) return false;
  if (std::any_of(sides.begin(), sides.end(),
                  [](int s) { return s < kSideMin || s > kSideMaxPixels; })) {
    return false;
  }
  width = sides[0];
  height = sides[1];
  return true;
}

CLI::App* add_frames_command(CLI::App& app, FramesOptions& options) {
  CLI::App* frames = app.add_subcommand(
      "frames", "frame times of every mesher's polygons, drawn off screen, and seams");
  const auto worlds = frames_world_names();
  std::set<std::string> world_names(worlds.begin(), worlds.end());
  world_names.emplace("scenarios");
  frames
      ->add_option("--worlds", options.worlds, "worlds to draw, scenarios: all 37; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(world_names));
  const auto meshers = frames_mesher_names();
  frames
      ->add_option("--meshers", options.meshers,
                   "meshers to draw; by default one of each different mesh, quads and product")
      ->delimiter(',')
      ->check(CLI::IsMember(std::set<std::string>(meshers.begin(), meshers.end())));
  frames->add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->capture_default_str()
      ->check(CLI::ExistingDirectory);
  frames
      ->add_option("--frames", options.frames, "frames of an orbit, for each mesher in each world")
      ->capture_default_str()
      ->check(CLI::Range(3, 10'000));
  frames
      ->add_option(
          "--pictures", options.pictures,
          "of these frames, how many to compare pixel by pixel and to count the fragments of")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  frames
      ->add_option("--vertices-max", options.vertices_max,
                   "of a mesh; larger ones are named and not drawn, but for culled faces")
      ->capture_default_str()
      ->check(CLI::Range(1'000, 1'000'000'000));
  frames
      ->add_option_function<std::string>(
          "--size",
          [&options](const std::string& text) {
            if (!parse_size(text, options.width, options.height)) {
              throw CLI::ValidationError("--size",
                                         text + ": not a size like 1280x720, sides 16 .. 4096");
            }
          },
          "pixels of the picture")
      ->default_str("1280x720");
  frames->add_option("--csv", options.csv, "write all rows to this file");
  frames->add_option("--json", options.json, "write all rows and the summary to this file");
  return frames;
}

}  // namespace runstone::bench
