#include "server/convert/convert_program.hpp"

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>

#include "common/build_files/build_files.hpp"
#include "common/command_line/help_options.hpp"
#include "common/core/build_info.hpp"
#include "common/core/text.hpp"
#include "common/core/version.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/formats/file_build.hpp"
#include "common/formats/file_build_turn.hpp"
#include "common/formats/mapped_build.hpp"
#include "common/formats/turned_names.hpp"
#include "server/convert/model_options.hpp"
#include "server/mapping/material_map_file.hpp"

namespace runstone {
namespace {

constexpr std::size_t kFileBytesMax = std::size_t{4} << 30;

struct ConvertOptions {
  std::string in, out, name, map, colours;
  std::uint64_t memory_mib = 2048;
  bool only_cubes = false;
  bool lists = false;
  ModelReading read_model;
  FileWriting writing;
};

Result<FileBuild, std::string> read(const ConvertOptions& options, std::ostream& out) {
  BuildReading reading;
  reading.foreign.keep_all = !options.only_cubes;
  reading.foreign.only_cubes = options.only_cubes;
  reading.foreign.bytes_max = static_cast<std::size_t>(options.memory_mib) << 20;
  reading.foreign.colours_file = options.colours;
  reading.model = options.read_model;
  reading.model.file.memory_mib = options.memory_mib;
  reading.notice = [&out](const std::string& line) { out << line << '\n'; };
  auto build = read_build_of_file(options.in, std::move(reading), kFileBytesMax);
  if (build && !options.name.empty()) build->info.name = options.name;
  return build;
}

/// Replaces the materials of a build as the map says, and prints which of its rows applied to none.
Result<void, std::string> map_materials(const ConvertOptions& options, FileBuild& build,
                                        std::ostream& out) {
  if (options.map.empty()) return {};
  const auto map = read_material_map(options.map);
  if (!map) return failure(map.error());
  AppliedRows applied;
  auto mapped =
      mapped_build(build, *map, applied, static_cast<std::size_t>(options.memory_mib) << 20);
  if (!mapped) return failure(options.in + ": " + mapped.error().what);
  build = *std::move(mapped);
  const std::string notice = unused_rows_notice(options.map, *map, applied);
  if (!notice.empty()) out << notice << '\n';
  return {};
}

/// Turns a build. A model was turned when it was read.
Result<void, std::string> turn(const ConvertOptions& options, FileBuild& build, std::ostream& out) {
  if (options.read_model.quarters == 0 || is_model_file(options.in)) return {};
  auto done = turned_file_build(build, Orientation{}.rotated_about_y(options.read_model.quarters),
                                static_cast<std::size_t>(options.memory_mib) << 20);
  if (!done) return failure(options.in + ": it cannot be turned: " + done.error().what);
  build = std::move(done->build);
  if (const std::string notice = stuck_notice(done->stuck); !notice.empty()) out << notice << '\n';
  return {};
}

Result<void, std::string> convert(const ConvertOptions& options, std::ostream& out) {
  if (!options.out.empty()) {
    if (auto why = file_refusal(options.out, true); !why.empty()) return failure(std::move(why));
    if (auto why = choice_refusal(options.out, options.writing); !why.empty())
      return failure(std::move(why));
  }
  auto build = read(options, out);
  if (!build) return failure(build.error());
  if (auto mapped = map_materials(options, *build, out); !mapped) return mapped;
  if (auto done = turn(options, *build, out); !done) return done;
  if (!options.out.empty()) {
    const auto written = write_build_to_file(options.out, *build, options.writing);
    if (!written) return failure(written.error());
  }
  const BuildSides& sides = build->info.sides;
  out << (options.out.empty() ? options.in : options.out) << ": \"" << build->info.name << "\", "
      << sides.x << " x " << sides.y << " x " << sides.z << " voxels, " << solid_cells(*build)
      << " of them not empty, " << build->materials.size() << " materials, "
      << build->build->run_count() << " runs\n";
  if (!options.lists) return {};
  for (const BuildMaterial& material : build->materials) {
    out << material.row.name;
    if (!material.states.empty()) out << '[' << material.states << ']';
    out << '\n';
  }
  return {};
}

std::string name_refusal(const std::string& name) {
  return is_plain_name(name) && name.size() <= kBuildNameBytesMax
             ? ""
             : "1 to " + std::to_string(kBuildNameBytesMax) +
                   " bytes without quotes, backslashes, control characters and outer blanks";
}

}  // namespace

int convert_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  ConvertOptions options;
  CLI::App app("Reads a build from a file and writes it in the format of another ending.",
               "runstone-convert");
  app.set_version_flag("--version", "runstone-convert " + std::string(version()));
  add_help_options(app, "runstone-convert");
  app.add_option("IN", options.in, "the file to read, such as castle.schem")->required();
  app.add_option("OUT", options.out,
                 "the file to write, such as castle.vox; an old one is replaced. Without it, the "
                 "program only says what IN is");
  app.add_option("--name", options.name, "name of the build; default: that of IN")
      ->check(name_refusal);
  app.add_option("--colours", options.colours,
                 "PNG with the colours of the columns, if IN is a height map");
  app.add_option("--map", options.map,
                 "TOML file that chooses materials: rows such as \"minecraft:oak_planks\" = "
                 "\"planks\" below [materials]");
  app.add_option("--memory", options.memory_mib, "MiB that the build may take; default 2048")
      ->check(CLI::Range(1, 1 << 20));
  app.add_flag("--list", options.lists, "list the materials, as the rows of a map name them");
  app.add_flag(
      "--only-cubes", options.only_cubes,
      "leave out blocks that are no whole cubes, such as plants, torches and wires, but not "
      "shapes that fill at least half of their voxel, such as stairs; an .rsb stays as it is");
  add_model_options(app, options.read_model);
  app.add_flag("--close-t-junctions", options.writing.model.closes_t_junctions,
               "models: let each edge of a triangle end where an edge of its neighbour ends");
  app.add_flag_callback(
      "--split", [&options] { options.writing.model.is_welded = false; },
      "models: give each rectangle vertices of its own");
  app.add_flag("--quantise", options.writing.model.is_quantised,
               "models: write a .glb with small vertices, for readers of KHR_mesh_quantization");
  app.add_option("--metres-per-voxel", options.writing.model.metres_per_voxel,
                 "models: side of a voxel; default 1")
      ->check(CLI::Range(1e-6, 1e6));
  app.add_option("--levels", options.writing.model.levels,
                 "models: levels of detail besides the full one, 0..8, each with voxels twice as "
                 "wide; in a .glb or .gltf by MSFT_lod, otherwise as files such as castle.lod1.obj")
      ->check(CLI::Range(0U, kModelLevelsMax));
  app.add_option_function<std::string>(
         "--schem",
         [&options](const std::string& text) {
           if (const auto version = parse_schem_version(text)) options.writing.schem = *version;
         },
         "version of an OUT.schem, 2 or 3; default 3, which WorldEdit reads since 7.3")
      ->check(CLI::IsMember({"2", "3"}));
  app.footer("docs/formats.md lists the formats, and what each of them keeps.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, out, err);
  }
  const auto done = convert(options, out);
  if (!done) err << "runstone-convert: " << done.error() << '\n';
  return done ? 0 : 1;
}

}  // namespace runstone
