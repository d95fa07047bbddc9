#include "server/convert/model_options.hpp"

#include <string>

#include "common/build_files/model_words.hpp"

namespace runstone {
namespace {

/// Adds the option of a word, with two dashes before it.
CLI::Option* add_word(CLI::App& app, ModelChoices& choices, const ModelWord& word,
                      const std::string& what) {
  const std::string name = "--" + std::string(word.name);
  if (!word.has_value()) {
    return app.add_flag_callback(
        name, [&] { static_cast<void>(choose_by_word(word, "", choices)); }, what);
  }
  return app
      .add_option_function<std::string>(
          name,
          [&](const std::string& value) {
            static_cast<void>(choose_by_word(word, value, choices));
          },
          what)
      ->check([&](const std::string& value) {
        ModelChoices unused;
        const auto chosen = choose_by_word(word, value, unused);
        return chosen ? std::string() : "\"" + value + "\": " + chosen.error();
      });
}

}  // namespace

void add_model_options(CLI::App& app, ModelChoices& choices) {
  const auto add = [&](const ModelWord& word, const std::string& what) {
    return add_word(app, choices, word, "model: " + what);
  };
  CLI::Option* const voxels = add(kVoxelsWord, "voxels of its longest side, 1..4096; default 128");
  add(kVoxelsPerMetreWord, "voxels of a metre; without units in the file, a unit is a metre")
      ->excludes(voxels);
  add(kSurfaceWord,
      "what its surface sets besides the inside: none; thin, which keeps walls without the centre of "
      "a voxel; thick; or all voxels that it touches. Default: none, and thin if nothing lies inside "
      "or with --hollow");
  add(kHollowWord, "do not fill its inside");
  add(kFillOverlapsWord, "fill the inside also where closed parts of it overlap");
  add(kUpWord,
      "y or z, the axis of the file that points up; default: z for .stl and .ply, otherwise y");
  add(kTurnWord,
      "0, 90, 180 or 270 degrees to the left as seen from above, for builds as well; default 0");
}

}  // namespace runstone
