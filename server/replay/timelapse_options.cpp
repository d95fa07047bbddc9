#include "server/replay/timelapse_options.hpp"

#include <CLI/CLI.hpp>

namespace runstone {
namespace {

/// What is wrong with the text, or nothing.
std::string take_size(const std::string& text, PictureSize& out) {
  const std::size_t cross = text.find('x');
  unsigned width = 0, height = 0;
  const auto fits = [](unsigned side) { return side >= kDrawSideMin && side <= kDrawSideMax; };
  if (cross == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, cross), width) ||
      !CLI::detail::lexical_cast(text.substr(cross + 1), height) || !fits(width) || !fits(height)) {
    return "expected WIDTHxHEIGHT, 16 to 8192 each";
  }
  out = {static_cast<std::uint16_t>(width), static_cast<std::uint16_t>(height)};
  return {};
}

}  // namespace

void add_timelapse_options(CLI::App& app, TimelapseOptions& out) {
  const auto number_from = [](Sequence low) { return CLI::Range(low, kSequenceMax); };
  CLI::Option* folder =
      app.add_option("--timelapse", out.folder,
                     "draw the world as it grew, edit by edit, into PNG files in this folder");
  app.add_option("--from", out.from,
                 "timelapse: begin after this sequence number; default: before the first edit")
      ->check(number_from(0))
      ->needs(folder);
  app.add_option("--every", out.every,
                 "timelapse: edits a frame; default: as many as make some 300 frames")
      ->check(number_from(1))
      ->needs(folder);
  app.add_option_function<std::string>(
         "--size",
         [&out](const std::string& text) {
           if (const std::string wrong = take_size(text, out.size); !wrong.empty()) {
             throw CLI::ValidationError("--size", wrong);
           }
         },
         "timelapse: frames of WIDTHxHEIGHT; default 1280x720")
      ->needs(folder);
  app.add_option("--camera", out.camera,
                 "timelapse: file with the camera's path; default: a view of all edits")
      ->check(CLI::ExistingFile)
      ->needs(folder);
  app.add_option("--radius", out.radius,
                 "timelapse: chunks of untouched world around the edits; default 3")
      ->check(CLI::Range(0U, 32U))
      ->needs(folder);
  app.add_option("--fps", out.fps, "timelapse: frames a second of the video; default 30")
      ->check(CLI::Range(1U, 120U))
      ->needs(folder);
  app.add_option("--client", out.client,
                 "timelapse: the program that draws; default: RUNSTONE_CLIENT, or runstone-client "
                 "beside this one")
      ->needs(folder);
}

}  // namespace runstone
