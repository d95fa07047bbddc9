// FramesOptions: what the command line of `runstone-bench frames` says.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace runstone::bench {

struct FramesOptions {
  std::vector<std::string> worlds;  // of frames_world_names(); empty: all
  std::vector<std::string>
      meshers;            // mesher_cases; empty: one for each different mesh, quads and product
  std::string luanti;     // folder of a world
  unsigned frames = 60;   // of each mesher in each world
  unsigned pictures = 3;  // of the orbit, in which pixels and fragments are counted
  std::size_t vertices_max =
      100'000'000;  // of a mesh; larger ones are named and not drawn, but culled faces
  int width = 1280, height = 720;  // pixels
  std::string csv, json;           // files; empty: none
};

/// What a mesher can be called: the mesher_cases, "quads", which is rdm drawn from its packed quads, and
/// "product", which is rdm drawn by the client's renderer.
std::vector<std::string> frames_mesher_names();
/// Those that are measured by default. Contestants that make the same mesh as another in another way are left
/// out.
std::vector<std::string> frames_meshers_by_default();

/// "1280x720" in pixels. False, and nothing is written, if it is no such size or a side is not 16 .. 4096.
bool parse_size(const std::string& text, int& width, int& height);

/// Adds the subcommand. `options` must outlive the parsing.
CLI::App* add_frames_command(CLI::App& app, FramesOptions& options);

}  // namespace runstone::bench
