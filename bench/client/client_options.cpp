#include "bench/client/client_options.hpp"

#include <CLI/CLI.hpp>

#include "bench/frames/frames_options.hpp"

namespace runstone::bench {

CLI::App* add_client_command(CLI::App& app, ClientBenchOptions& options) {
  CLI::App* client = app.add_subcommand(
      "client", "frames of the client: bursts of edits, own edits, and what its effects cost");
  client->add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->capture_default_str()
      ->check(CLI::ExistingDirectory);
  client->add_option("--edits", options.edits, "edits of a burst, each in a chunk of its own")
      ->capture_default_str()
      ->check(CLI::Range(1, 200));
  client->add_option("--bursts", options.bursts, "bursts with a budget, and as many without")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  client->add_option("--own-edits", options.own_edits, "edits of this client, one after another")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  client->add_option("--frames", options.frames, "frames of each way to draw in each world")
      ->capture_default_str()
      ->check(CLI::Range(3, 10'000));
  client
      ->add_option_function<std::string>(
          "--size",
          [&options](const std::string& text) {
            if (!parse_size(text, options.width, options.height))
              throw CLI::ValidationError("--size",
                                         text + ": not a size like 1280x720, sides 16 .. 4096");
          },
          "pixels of a frame")
      ->default_str("1280x720");
  client->add_option("--json", options.json, "write all figures to this file");
  return client;
}

}  // namespace runstone::bench
