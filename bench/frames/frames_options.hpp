// FramesOptions: the command line of `runstone-bench frames`.
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
  // Names of mesher cases; empty: one for each different mesh, quads and product.
  std::vector<std::string> meshers;
  std::string luanti;     // folder of a Luanti world
  unsigned frames = 60;   // of each mesher in each world
  unsigned pictures = 3;  // frames of the orbit in which pixels and fragments are counted
  // Larger meshes are named and not drawn, except those of culled faces.
  std::size_t vertices_max = 100'000'000;
  int width = 1280, height = 720;  // pixels
  std::string csv, json;           // files to write; empty: none
};

/// Returns the names of the mesher cases, "quads" (rdm drawn from its packed quads) and "product"
/// (rdm drawn by the client's renderer).
std::vector<std::string> frames_mesher_names();
/// Returns the meshers that are measured by default: one of those that make the same mesh.
std::vector<std::string> frames_meshers_by_default();

/// Parses a size such as "1280x720" in pixels. Returns false and writes nothing if the text is no
/// such size or a side is not 16 .. 4096.
bool parse_size(const std::string& text, int& width, int& height);

/// Adds the subcommand. `options` must outlive the parse.
CLI::App* add_frames_command(CLI::App& app, FramesOptions& options);

}  // namespace runstone::bench
