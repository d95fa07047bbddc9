#include "server/app/server_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <string_view>

#include "common/command_line/help_options.hpp"
#include "common/core/coords_text.hpp"
#include "common/os/output_file.hpp"
#include "protocol/program_version.hpp"
#include "server/admin/server_config.hpp"
#include "server/app/backup_options.hpp"
#include "server/convert/model_options.hpp"
#include "server/store/place_rule.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

void add_flags(CLI::App& app, ServerOptions& out) {
  app.set_version_flag("--version",
                       program_version("runstone-server") + ", " + world_formats_text());
  app.add_option("--config", out.config_file,
                 "TOML file of settings; environment and flags win over it");
  app.add_flag("--print-config", out.print_config, "print all settings as TOML and exit");
  app.add_option("--port-file", out.port_file, "write the port here once the server listens")
      ->check(output_refusal);
  app.add_option("--digests", out.digests_file,
                 "write the digests of all edited chunks here on stop")
      ->check(output_refusal);
  CLI::Option* const console = app.add_flag(
      "--console", out.console, "read commands from standard input even if it is no terminal");
  app.add_flag("--stop-with-input", out.stop_with_input,
               "stop when standard input ends; for programs that start a server for themselves")
      ->excludes(console);
  app.add_flag("--create", out.create, "make a new world if the folder --world holds none");
  app.add_flag("--accept-losses", out.accept_losses,
               "start a world that has lost edits, players or watermarks, and log what is lost");
  app.add_option("--generator", out.creation.generator,
                 "new world: landscape (the default), terrain, flat, empty or scenario");
  app.add_option("--generator-parameters", out.creation.generator_parameters,
                 "new world: TOML text");
  app.add_option("--seed", out.creation.seed,
                 "new world: seed of the generator; default: a random one");
  app.add_option("--edge", out.creation.edge,
                 "new world: edge of a chunk, 16, 32, 64 or 128 voxels");
  app.add_option("--materials", out.creation.materials_file, "new world: TOML file of materials");
  add_setting_flags(app, config_fields(), out.settings);
}

void add_progress(CLI::App& app, bool& out) {
  app.add_flag("--progress", out, "print progress even if standard error is no terminal");
}

/// Adds an option that must be given. `refusal` returns what is wrong with a value, or nothing.
template <class Refusal>
void add_required(CLI::App& app, const char* name, std::string& out, const char* help,
                  Refusal refusal) {
  app.add_option(name, out, help)->required()->check(refusal);
}

CLI::App* add_import(CLI::App& app, ImportRequest& out) {
  CLI::App* const made = app.add_subcommand(
      "import", "make a new world from a Luanti or Minecraft world, or from a file with a build");
  const std::map<std::string, ImportKind> kinds = {{"luanti", ImportKind::luanti},
                                                   {"minecraft", ImportKind::minecraft},
                                                   {"file", ImportKind::file}};
  CLI::Option* const kind =
      made->add_option("KIND", out.kind, "luanti, minecraft, or file (docs/formats.md lists them)")
          ->transform(CLI::Transformer(kinds))
          ->option_text("luanti|minecraft|file");
  CLI::Option* const source = made->add_option(
      "SOURCE", out.source,
      "luanti: folder that holds world.mt and its map; minecraft: folder of the world, or a region file; "
      "file: such as castle.schem");
  kind->needs(source);
  CLI::Option* const luanti = made->add_option_function<std::string>(
                                      "--luanti",
                                      [&out](const std::string& text) {
                                        out.kind = ImportKind::luanti;
                                        out.source = text;
                                      },
                                      "the same as KIND luanti")
                                  ->excludes(kind);
  made->callback([kind, luanti] {
    if (kind->count() + luanti->count() == 0) throw CLI::RequiredError("KIND and SOURCE");
  });
  add_required(*made, "--world", out.world, "folder of the new world", folder_refusal);
  made->add_option_function<std::string>(
          "--at", [&out](const std::string& text) { out.at = *parse_voxel_pos(text); },
          "file: X,Y,Z of its lowest corner; default: 0,0,0")
      ->check([](const std::string& text) {
        return parse_voxel_pos(text) ? std::string() : "X,Y,Z: three whole numbers in the world";
      });
  made->add_option("--edge", out.edge, "edge of a chunk, 16, 32, 64 or 128 voxels");
  made->add_option_function<std::string>(
          "--palette", [&out](const std::string& text) { out.palette = text == "default"; },
          "default: add the built-in materials that the world lacks; none: add nothing")
      ->check(CLI::IsMember({"default", "none"}));
  made->add_option("--colours", out.colours,
                   "file: PNG with the colours of the columns, if SOURCE is a height map");
  add_model_options(*made, out.model);
  made->add_option("--map", out.map,
                   "TOML file that chooses materials: rows such as \"minecraft:oak_planks\" = "
                   "\"planks\" below [materials]");
  made->add_option(
      "--textures", out.textures,
      "folder of pictures for the materials: of PNGs, a game of Luanti, or a resource pack "
      "of Minecraft");
  made->add_flag(
      "--keep-all", out.keep_all,
      "keep blocks that are no whole cubes and have no shape, such as wires, as see-through "
      "cubes, and plants in water instead of the water");
  add_progress(*made, out.progress);
  return made;
}

CLI::App* add_compact(CLI::App& app, CompactRequest& out) {
  CLI::App* const compact =
      app.add_subcommand("compact", "move the oldest part of a world's log into its base");
  add_required(*compact, "--world", out.world,
               "folder of the world, or postgresql://...; no server may run it", place_refusal);
  compact->add_option("--keep", out.keep_days, "days of the past to keep")
      ->required()
      ->check(CLI::Range(0, 36'500));
  compact->add_flag("--anyway", out.is_confirmed,
                    "compact with --keep 0, which leaves no past to see, roll back or undo");
  compact->add_flag_callback(
      "--keep-size", [&out] { out.shrink = false; },
      "leave the free space in the file, for new edits");
  add_progress(*compact, out.progress);
  return compact;
}

CLI::App* add_copy(CLI::App& app, CopyRequest& out) {
  CLI::App* const copy = app.add_subcommand(
      "copy", "copy a world from a folder to a PostgreSQL database, or back, and verify it");
  add_required(*copy, "--from", out.from, "folder of the world, or postgresql://...",
               place_refusal);
  add_required(*copy, "--to", out.to, "the new folder, or postgresql://... without a world",
               place_refusal);
  add_progress(*copy, out.progress);
  return copy;
}

CLI::App* add_repair(CLI::App& app, RepairRequest& out) {
  CLI::App* const repair =
      app.add_subcommand("repair", "make a sound world of a damaged one, and say what is gone");
  // A world in a database has no pages that could be read.
  const auto refusal = [](const std::string& place) {
    return check_database_address(place)
               ? "is in a database: `runstone-server copy` it to a folder first, and back afterwards"
               : folder_refusal(place);
  };
  add_required(*repair, "--world", out.world, "folder of the damaged world; no server may run it",
               refusal);
  add_required(*repair, "--to", out.to, "the new folder; empty, or not there", folder_refusal);
  repair
      ->add_option("--from", out.from, "folder of an older backup, from which lost rows are taken")
      ->check(folder_refusal);
  repair->add_flag("--in-place", out.in_place,
                   "give the repaired world the name of the damaged one at the end; --to is then "
                   "the damaged one");
  add_progress(*repair, out.progress);
  return repair;
}

CLI::App* add_control(CLI::App& app, ControlRequest& out) {
  CLI::App* const control =
      app.add_subcommand("control", "give a running server a command, such as `control help`");
  control->add_option("--world", out.world, "folder of the server's world")->check(folder_refusal);
  control->prefix_command();  // the other arguments are the command, also words such as -4
  return control;
}

/// Returns the number of arguments up to the command behind `control`, or `argc` if there is no
/// command. The parser must not see the command: it takes the word `backup` for the subcommand.
int arguments_before_command(int argc, const char* const* argv) {
  if (argc < 2 || std::string_view(argv[1]) != "control") return argc;
  int next = 2;
  while (next < argc && std::string_view(argv[next]).starts_with('-')) {
    next += std::string_view(argv[next]) == "--world" ? 2 : 1;
  }
  return std::min(next, argc);
}

/// Prints the first argument that the parser did not understand. CLI11 lists all of them in reverse
/// order.
void print_unknown_argument(const CLI::App& app) {
  const CLI::App* innermost = &app;
  while (!innermost->get_subcommands().empty()) innermost = innermost->get_subcommands().front();
  const std::string argument = app.remaining(true).front();
  std::cerr
      << "runstone-server: \"" << argument
      << "\" is no subcommand (import, compact, copy, backup, pack, restore, repair, control) and no flag"
      << nearest_flag(*innermost, argument) << "; --help lists the flags\n";
}

}  // namespace

ParsedServerOptions parse_server_options(int argc, const char* const* argv) {
  ServerOptions out;
  ImportRequest import_request;
  CompactRequest compact_request;
  CopyRequest copy_request;
  BackupOptions backup_options;
  PackRequest pack_request;
  RestoreRequest restore_request;
  RepairRequest repair_request;
  ControlRequest control_request;
  CLI::App app{"Runstone world server"};
  // The last value wins, so that arguments appended to a fixed command line (a container's) change
  // it.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  add_flags(app, out);
  add_help_options(app, "runstone-server");
  const CLI::App* const import = add_import(app, import_request);
  const CLI::App* const compact = add_compact(app, compact_request);
  const CLI::App* const copy = add_copy(app, copy_request);
  const CLI::App* const backup = add_backup(app, backup_options);
  const CLI::App* const pack = add_pack(app, pack_request);
  const CLI::App* const restore = add_restore(app, restore_request);
  const CLI::App* const repair = add_repair(app, repair_request);
  const CLI::App* const control = add_control(app, control_request);
  const int parsed = arguments_before_command(argc, argv);
  try {
    app.parse(parsed, argv);
  } catch (const CLI::ExtrasError&) {
    print_unknown_argument(app);
    return {std::nullopt, 2};
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : 2};
  }
  if (import->parsed()) out.import = import_request;
  if (compact->parsed()) out.compact = compact_request;
  if (copy->parsed()) out.copy = copy_request;
  if (backup->parsed()) {
    out.backup = backup_options.copy;
    out.backup_folder = backup_options.folder;
  }
  if (pack->parsed()) out.pack = pack_request;
  if (restore->parsed()) out.restore = restore_request;
  if (repair->parsed()) out.repair = repair_request;
  if (control->parsed()) {
    control_request.words = control->remaining();
    control_request.words.insert(control_request.words.end(), argv + parsed, argv + argc);
    if (control_request.words.empty()) {
      std::cerr << "control: the command is missing, such as `control help`\n";
      return {std::nullopt, 2};
    }
    out.control = control_request;
  }
  return {out, 0};
}

}  // namespace runstone
