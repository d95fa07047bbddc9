// ViewOptions: the command line of `runstone-bench view`.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace runstone::bench {

struct ViewOptions {
  std::string world = "hill";      // of view_world_names()
  std::string luanti;              // folder of a Luanti world
  unsigned repetitions = 15;       // of each mesher
  unsigned frames = 9;             // timed frames of each pane
  int width = 1740, height = 580;  // pixels of the picture, of all panes together
  double turn = 35;                // degrees of the camera around the chunks
  double pitch = 32;               // degrees below the horizon
  double time_of_day = 0.42;       // share of the day
  bool captions = true;
  bool edges = true;   // draw the edges of the quads
  std::string mesher;  // a name of view_mesher_names(); empty: all, side by side
  std::string out;     // PNG file; empty: a window
};

/// Adds the subcommand. `options` must outlive the parse.
CLI::App* add_view_command(CLI::App& app, ViewOptions& options);

}  // namespace runstone::bench
