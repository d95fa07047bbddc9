#include "bench/view/view_options.hpp"

#include <CLI/CLI.hpp>
#include <set>

#include "bench/frames/frames_options.hpp"
#include "bench/view/view_pane.hpp"
#include "bench/view/view_world.hpp"

namespace runstone::bench {

CLI::App* add_view_command(CLI::App& app, ViewOptions& options) {
  CLI::App* view = app.add_subcommand(
      "view", "draws the same chunks as culled faces, binary greedy quads and RDM quads");
  const auto worlds = view_world_names();
  view->add_option("--world", options.world, "chunks to draw")
      ->capture_default_str()
      ->check(CLI::IsMember(std::set<std::string>(worlds.begin(), worlds.end())));
  view->add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->capture_default_str()
      ->check(CLI::ExistingDirectory);
  view->add_option("--repetitions", options.repetitions, "of each mesher; the median is shown")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  view->add_option("--frames", options.frames, "timed frames of each part; the median is shown")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  view->add_option_function<std::string>(
          "--size",
          [&options](const std::string& text) {
            if (!parse_size(text, options.width, options.height))
              throw CLI::ValidationError("--size",
                                         text + ": not a size like 1740x580, sides 16 .. 4096");
          },
          "pixels of the picture, all parts together")
      ->default_str("1740x580");
  view->add_option("--turn", options.turn, "degrees of the camera around the chunks")
      ->capture_default_str()
      ->check(CLI::Range(-360.0, 360.0));
  view->add_option("--pitch", options.pitch, "degrees of the camera above the chunks")
      ->capture_default_str()
      ->check(CLI::Range(-89.0, 89.0));
  view->add_option("--time", options.time_of_day, "time of day as a share of it: 0.5 is noon")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  const auto meshers = view_mesher_names();
  view->add_option("--mesher", options.mesher, "draw one mesh; all side by side by default")
      ->check(CLI::IsMember(std::set<std::string>(meshers.begin(), meshers.end())));
  view->add_flag("!--no-edges", options.edges, "without the edges of the quads");
  view->add_flag("!--no-captions", options.captions, "without the figures in the picture");
  view->add_option("--out", options.out, "write a PNG file; without it, show a window");
  return view;
}

}  // namespace runstone::bench
