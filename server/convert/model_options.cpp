#include "server/convert/model_options.hpp"

#include <string>

namespace runstone {

void add_model_options(CLI::App& app, ModelReading& reading) {
  const auto voxels = app.add_option("--voxels", reading.voxels,
                                     "model: voxels of its longest side, 1..4096; default 128")
                          ->check(CLI::Range(1, int{kVoxeliseSideMax}));
  app.add_option("--voxels-per-metre", reading.voxels_per_metre,
                 "model: voxels of a metre; without units in the file, a unit is a metre")
      ->check(CLI::Range(1e-6, 1e6))
      ->excludes(voxels);
  app.add_option_function<std::string>(
         "--surface",
         [&reading](const std::string& word) { reading.surface = surface_of_word(word); },
         "model: what its surface sets besides the inside: none; thin, which keeps walls without "
         "the centre of a voxel; thick; or all voxels that it touches. Default: none, and thin if "
         "nothing lies inside or with --hollow")
      ->check(CLI::IsMember({"none", "thin", "thick", "all"}));
  app.add_flag_callback(
      "--hollow", [&reading] { reading.is_solid = false; }, "model: do not fill its inside");
  app.add_flag("--fill-overlaps", reading.fills_overlaps,
               "model: fill the inside also where closed parts of it overlap");
  app.add_option_function<std::string>(
         "--up",
         [&reading](const std::string& axis) {
           reading.file.up = axis == "y" ? ModelUp::y : ModelUp::z;
         },
         "model: the axis of the file that points up; default: z for .stl and .ply, otherwise y")
      ->check(CLI::IsMember({"y", "z"}));
  app.add_option_function<int>(
         "--turn", [&reading](const int& degrees) { reading.quarters = degrees / 90; },
         "0, 90, 180 or 270 degrees to the left as seen from above, for builds and models; default "
         "0")
      ->check(CLI::IsMember({0, 90, 180, 270}));
}

}  // namespace runstone
