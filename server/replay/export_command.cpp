#include "server/replay/replay_commands.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "common/build_files/build_files.hpp"
#include "common/core/coords_text.hpp"
#include "common/core/text.hpp"
#include "common/formats/file_build.hpp"
#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/history/build_at.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/export_luanti.hpp"
#include "server/replay/luanti_world_writer.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

Result<int, std::string> export_log(const ExportOptions& options, std::ostream& out) {
  const auto store = open_world(options.common.world, StoreAccess::read_only);
  if (!store) return failure(store.error().message());
  const auto at = end_of_replay(**store, options.at);
  if (!at) return failure(at.error());
  const auto done = export_rlog(**store, options.file, *at);
  if (!done) return failure(done.error());
  print_world(out, **store);
  row(out, "edits") << done->edits << ", sequences " << done->first << " to " << done->last << '\n';
  row(out, "written") << options.file << ", " << done->bytes << " bytes\n";
  const nlohmann::ordered_json json = {
      {"edits", done->edits},
      {"first", done->first},
      {"last", done->last},
      {"lost", (*store)->loss() ? (*store)->loss()->message() : ""},
      {"bytes", done->bytes}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return code_of_output(**store);
}

std::string name_of_build(const ExportOptions& options, const std::string& place) {
  return options.name.empty() ? build_name_of_file(place) : options.name;
}

Result<int, std::string> export_box(const ExportOptions& options, std::ostream& out) {
  if (auto why = file_refusal(options.file, true); !why.empty()) return failure(std::move(why));
  if (auto why = choice_refusal(options.file, options.writing); !why.empty())
    return failure(std::move(why));
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  const auto end = end_in_log(*world);
  if (!end) return failure(end.error());
  const Sequence at = *end;
  const auto then = WorldAt::open(store, *world->generator, at);
  if (!then) return failure(then.error().message());
  const auto materials = store.materials(at);
  if (!materials) return failure(materials.error().message());
  auto build = [&] {
    ProgressLine line("chunks read", options.common.progress);
    return build_at(*then, store, *materials, *options.box, store.meta().chunk_edge,
                    static_cast<std::size_t>(options.memory_mib) << 20,
                    [&](std::uint64_t done, std::uint64_t total) {
                      line.show(done, total);
                      return true;
                    });
  }();
  if (!build) return failure(options.common.world + ": " + build.error());
  build->info.name = name_of_build(options, options.file);
  const auto bytes = write_build_to_file(options.file, *build, options.writing);
  if (!bytes) return failure(bytes.error());
  const BuildSides& sides = build->info.sides;
  print_world(out, store);
  row(out, "moment") << "after sequence " << at << '\n';
  row(out, "box") << sides.x << " x " << sides.y << " x " << sides.z << " voxels, "
                  << build->build->solid() << " of them not empty\n";
  row(out, "materials") << build->materials.size() << '\n';
  row(out, "written") << options.file << ", " << *bytes << " bytes\n";
  const nlohmann::ordered_json json = {{"seq", at},
                                       {"sides", {sides.x, sides.y, sides.z}},
                                       {"solid", build->build->solid()},
                                       {"materials", build->materials.size()},
                                       {"lost", store.loss() ? store.loss()->message() : ""},
                                       {"bytes", *bytes}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return code_of_output(store);
}

Result<int, std::string> export_luanti_world(const ExportOptions& options, std::ostream& out) {
  if (!options.box) {
    return failure(
        "--luanti: --box is missing: X,Y,Z,X,Y,Z of the part of the world that becomes a Luanti "
        "world");
  }
  if (auto why = luanti_box_refusal(*options.box); !why.empty()) return failure(std::move(why));
  if (const auto free = NewFolder::check(options.luanti); !free) return failure(free.error());
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  const auto end = end_in_log(*world);
  if (!end) return failure(end.error());
  const Sequence at = *end;
  const auto then = WorldAt::open(store, *world->generator, at);
  if (!then) return failure(then.error().message());
  const auto materials = store.materials(at);
  if (!materials) return failure(materials.error().message());
  auto writer =
      LuantiWorldWriter::make(options.luanti, name_of_build(options, options.luanti), out);
  if (!writer) return failure(writer.error());
  const auto solid = [&] {
    ProgressLine line("chunks read", options.common.progress);
    return export_luanti(*then, store, *materials, *options.box, store.meta().chunk_edge, *writer,
                         [&](std::uint64_t done, std::uint64_t total) {
                           line.show(done, total);
                           return true;
                         });
  }();
  if (!solid) return failure(options.common.world + ": " + solid.error());
  const std::uint64_t blocks = writer->blocks();
  if (const auto done = writer->finish(); !done) return failure(done.error());
  const VoxelBox& box = *options.box;
  print_world(out, store);
  row(out, "moment") << "after sequence " << at << '\n';
  row(out, "box") << box.max.x - box.min.x << " x " << box.max.y - box.min.y << " x "
                  << box.max.z - box.min.z << " voxels, " << *solid << " of them not empty\n";
  row(out, "written") << options.luanti << ", " << blocks << " blocks of 16 x 16 x 16\n";
  const nlohmann::ordered_json json = {
      {"seq", at},
      {"sides", {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}},
      {"solid", *solid},
      {"lost", store.loss() ? store.loss()->message() : ""},
      {"blocks", blocks}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return code_of_output(store);
}

}  // namespace

void declare_export(SubcommandOptions& command_line, ExportOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.output_file("FILE", options.file,
                           "the .rlog file to write, or with --box a build such as town.schem; an "
                           "old one is replaced",
                           SubcommandOptions::Presence::may_be_missing);
  command_line.folder("--luanti", options.luanti,
                      "with --box and without FILE: folder of the Luanti world to make");
  command_line.moment("--at", options.at, "last edit to export");
  command_line.parsed(
      "--box",
      [&options](const std::string& text) -> std::string {
        options.box = parse_voxel_box(text);
        return options.box ? "" : "X,Y,Z,X,Y,Z: two opposite corners, both inside";
      },
      "X,Y,Z,X,Y,Z: export this box of the world as a build, in the format of the ending");
  command_line.text("--name", options.name, "name of the build; default: the name of the file");
  command_line.parsed(
      "--schem",
      [&options](const std::string& text) -> std::string {
        const auto version = parse_schem_version(text);
        if (!version) return "2 or 3";
        options.writing.schem = *version;
        return "";
      },
      "with --box: version of a FILE.schem, 2 or 3; default 3, which WorldEdit reads since 7.3");
  command_line.number("--memory", options.memory_mib, 1, 65'536,
                      "MiB that the runs of a box may take; default 1024");
}

Result<int, std::string> run_export(const ExportOptions& options, std::ostream& out) {
  if (!options.name.empty() &&
      (!is_plain_name(options.name) || options.name.size() > kBuildNameBytesMax)) {
    return failure("--name: 1 to " + std::to_string(kBuildNameBytesMax) +
                   " bytes without quotes, backslashes, control characters and outer blanks");
  }
  if (options.luanti.empty() == options.file.empty()) {
    return failure(options.file.empty() ? "FILE is missing: the file to write"
                                        : "FILE and --luanti: give one of them");
  }
  if (!options.luanti.empty()) return export_luanti_world(options, out);
  return options.box ? export_box(options, out) : export_log(options, out);
}

}  // namespace runstone
