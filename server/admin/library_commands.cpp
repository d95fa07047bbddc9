#include "server/admin/library_commands.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "common/build_files/build_files.hpp"
#include "common/formats/mapped_build.hpp"
#include "server/admin/build_file.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/folder_import.hpp"
#include "server/admin/place_words.hpp"
#include "server/mapping/material_map_file.hpp"

namespace runstone {
namespace {

constexpr std::size_t kBuildsListed = 20, kBuildsListedMax = 50;

Result<LibraryQuery, std::string> parse_builds_list(WordReader& reader) {
  LibraryQuery query;
  query.count_max = kBuildsListed;
  while (!reader.at_end()) {
    if (reader.take_word("name")) {
      query.name = reader.take("name", "a part of a name");
    } else if (reader.take_word("author")) {
      query.author = reader.take("author", "a part of the name of an author");
    } else if (reader.take_word("tag")) {
      query.tag = reader.take("tag", "a tag");
    } else if (reader.take_word("before")) {
      query.before = static_cast<Sequence>(
          reader.number("before", 1, static_cast<std::int64_t>(kSequenceMax)));
    } else if (reader.take_word("count")) {
      query.count_max = static_cast<std::size_t>(
          reader.number("count", 1, static_cast<std::int64_t>(kBuildsListedMax)));
    } else {
      reader.wrong("builds list \"" + reader.peek() + "\": name, author, tag, before or count");
    }
  }
  return reader.result(query);
}

/// Returns the command that lists the builds of the query with lower numbers. Words of a command
/// have no quotes in them.
std::string next_page_command(const LibraryQuery& query, Sequence before) {
  std::string line = "builds list";
  for (const auto& [word, text] :
       {std::pair{" name ", &query.name}, {" author ", &query.author}, {" tag ", &query.tag}}) {
    if (text->empty()) continue;
    const bool has_blank = text->find(' ') != std::string::npos;
    line += word + (has_blank ? '"' + *text + '"' : *text);
  }
  line += " before " + std::to_string(before);
  if (query.count_max != kBuildsListed) line += " count " + std::to_string(query.count_max);
  return line;
}

/// Returns the lines of the builds that were found, one more of which was looked for than is listed.
std::string found_builds_text(const LibraryQuery& query, const std::vector<StoredBuild>& found,
                              const LibraryTotal& total) {
  const std::size_t listed = std::min(found.size(), query.count_max);
  std::string text;
  for (std::size_t i = 0; i < listed; ++i)
    text += build_line(found[i].number(), found[i].build()) + "\n";
  if (listed == 0) text += "no build fits\n";
  if (found.size() > listed)
    text += "more: " + next_page_command(query, found[listed - 1].number()) + "\n";
  return text + "the library has " + std::to_string(total.builds) +
         (total.builds == 1 ? " build" : " builds");
}

void list_builds(const CommandCall& call, const LibraryQuery& query) {
  LibraryQuery one_more = query;
  ++one_more.count_max;
  call.on_worker(
      "builds list: ", [one_more](WorldReader& reader) { return reader.builds(one_more); },
      [call, query](const std::vector<StoredBuild>& found) {
        call.answer(found_builds_text(query, found, call.world().order().library().total()));
      });
}

Sequence take_build_number(WordReader& reader, const std::string& command) {
  return static_cast<Sequence>(reader.number(command, 1, static_cast<std::int64_t>(kSequenceMax)));
}

Result<Sequence, std::string> parse_build_number(WordReader& reader) {
  const Sequence number = take_build_number(reader, reader.command());
  reader.expect_end(reader.command() + " NUMBER");
  return reader.result(number);
}

std::string no_build(Sequence number) {
  return "the library has no build " + std::to_string(number) + " (builds list has the numbers)";
}

/// Returns a build. The error is one line.
Result<StoredBuild, std::string> stored_build(WorldReader& reader, Sequence number) {
  auto build = reader.build(number);
  if (!build) return failure(build.error().message());
  if (!*build) return failure(no_build(number));
  return **std::move(build);
}

void show_build(const CommandCall& call, const Sequence& number) {
  call.on_worker(
      "builds show: ",
      [number](WorldReader& reader) -> Result<std::string, std::string> {
        const auto build = stored_build(reader, number);
        if (!build) return failure(build.error());
        const AuthorId author = build->record.op.author;
        std::string name = author == 0 ? "the console" : "#" + std::to_string(author);
        const auto players = reader.players();
        if (!players) return failure(players.error().message());
        const auto player =
            std::find_if(players->begin(), players->end(),
                         [author](const PlayerRow& row) { return row.author == author; });
        if (player != players->end()) name = player->name + " (" + name + ")";
        return build_text(*build, name);
      },
      [call](const std::string& text) { call.answer(text); });
}

Result<std::string, std::string> parse_build_file(WordReader& reader) {
  return reader.result(
      reader.take_only("one file or folder comes after it, in quotes if it has blanks"));
}

/// Orders the addition of a build whose file is in the store.
void add_saved_build(const CommandCall& call, const AddBuild& build, const std::string& error) {
  if (!error.empty()) return call.refuse("builds import: " + error);
  const auto added = call.world().changes().add_build(build, call.caller.author, call.now);
  if (!added) return call.refuse("builds import: " + added.error());
  call.answer_when_durable(*added, "added: " + build_line(*added, build));
}

void save_read_build(const CommandCall& call, const BuildFile& file) {
  AddBuild build = file.build;
  const Order& order = call.world().order();
  if (const auto why = order.library().refusal(call.caller.author, build.file_bytes))
    return call.refuse("builds import: " + *why);
  if (const auto why = call.world().cluster().library_refusal())
    return call.refuse("builds import: " + *why);
  build.content = call.world().changes().next_build_content();
  const auto& save = call.services.actions.save_build_file;
  const auto go_on = [call, build](const std::string& error) {
    add_saved_build(call, build, error);
  };
  if (!save || !save(build.content, file.bytes, go_on)) {
    call.refuse(
        "builds import: another file is being written, or the world cannot be written: try "
        "again");
  }
}

void begin_folder_import(const CommandCall& call,
                         const std::shared_ptr<const BuildFolder>& folder) {
  std::shared_ptr<FolderImport>& running = call.services.folder_import;
  if (running && !running->is_over()) {
    return call.refuse("builds import: " + running->path() +
                       " is being imported: wait, or end that with `builds cancel`");
  }
  running = std::make_shared<FolderImport>(call, folder);
}

void import_build(const CommandCall& call, const std::string& place) {
  using Found = std::variant<BuildFile, std::shared_ptr<const BuildFolder>>;
  const LibraryLimits& limits = call.world().order().library().limits();
  call.on_worker(
      "builds import: ",
      [place, bytes_max = limits.file_bytes_max, files_max = limits.builds_max,
       should_continue = call.services.rollback.should_continue()](
          WorldReader& reader) -> Result<Found, std::string> {
        std::error_code ignored;
        if (std::filesystem::is_directory(place, ignored)) {
          auto folder = list_build_folder(reader, place, files_max, should_continue);
          if (!folder) return failure(folder.error());
          return Found(std::make_shared<const BuildFolder>(*std::move(folder)));
        }
        auto file = read_build_file(place, bytes_max);
        if (!file) return failure(file.error());
        return Found(*std::move(file));
      },
      [call](const Found& found) {
        if (const auto* file = std::get_if<BuildFile>(&found)) return save_read_build(call, *file);
        begin_folder_import(call, *std::get_if<1>(&found));
      });
}

struct ExportedBuild {
  Sequence number = 0;
  std::string file;
};

Result<ExportedBuild, std::string> parse_export(WordReader& reader) {
  ExportedBuild out;
  out.number = take_build_number(reader, reader.command());
  out.file = reader.take_only("the number of a build and a file come after it");
  return reader.result(out);
}

void export_build(const CommandCall& call, const ExportedBuild& wanted) {
  call.on_worker(
      "builds export: ",
      [wanted](WorldReader& reader) -> Result<StoredBuild, std::string> {
        auto build = stored_build(reader, wanted.number);
        if (!build) return build;
        if (const auto written = write_build_file(reader, *build, wanted.file); !written)
          return failure(written.error());
        return build;
      },
      [call, wanted](const StoredBuild& build) {
        call.answer("written to " + wanted.file + ": " + build_line(build.number(), build.build()));
      });
}

void draw_build(const CommandCall& call, const ExportedBuild& wanted) {
  call.on_worker(
      "builds picture: ",
      [wanted](WorldReader& reader) -> Result<StoredBuild, std::string> {
        auto build = stored_build(reader, wanted.number);
        if (!build) return build;
        if (const auto drawn = write_build_picture(reader, *build, wanted.file); !drawn)
          return failure(drawn.error());
        return build;
      },
      [call, wanted](const StoredBuild& build) {
        call.answer("drawn to " + wanted.file + ": " + build_line(build.number(), build.build()));
      });
}

struct PlacedBuild {
  Sequence number = 0;
  PlaceWords words;
};

Result<PlacedBuild, std::string> parse_place(WordReader& reader) {
  PlacedBuild out;
  out.number = take_build_number(reader, reader.command());
  out.words = take_place_words(reader);
  return reader.result(out);
}

void place_stored_build(const CommandCall& call, const PlacedBuild& wanted) {
  call.on_worker(
      "builds place: ",
      [number = wanted.number](
          WorldReader& reader) -> Result<std::shared_ptr<const FileBuild>, std::string> {
        const auto stored = stored_build(reader, number);
        if (!stored) return failure(stored.error());
        auto build = read_stored_build(reader, *stored);
        if (!build) return failure(build.error());
        return std::make_shared<const FileBuild>(*std::move(build));
      },
      [call, wanted](const std::shared_ptr<const FileBuild>& build) {
        place_build(call, "builds place", '"' + build->info.name + '"', build, wanted.words);
      });
}

struct PlacedFile {
  std::string file;
  PlacedFileWords file_words;
  PlaceWords words;
};

Result<PlacedFile, std::string> parse_import_file(WordReader& reader) {
  PlacedFile out;
  out.file = reader.take("import", "a file, such as castle.schem");
  out.words = take_place_words(reader, &out.file_words);
  return reader.result(out);
}

/// A build from a file, and lines about what was read.
struct ReadFile {
  std::shared_ptr<const FileBuild> build;
  std::vector<std::string> notices;
};

/// The memory that a model may take, in MiB: in the process that reads it, and again in the server.
constexpr std::uint64_t kPlacedModelMib = 512;

Result<ReadFile, std::string> read_placed_file(const PlacedFile& wanted,
                                               const ShouldContinue& should_continue) {
  ReadFile out;
  BuildReading reading;
  reading.foreign.colours_file = wanted.file_words.colours;
  reading.model = wanted.file_words.model;
  reading.model.file.should_continue = should_continue;
  reading.model.file.memory_mib = kPlacedModelMib;
  reading.notice = [&out](const std::string& line) { out.notices.push_back(line); };
  auto build = read_build_of_file(wanted.file, std::move(reading));
  if (!build) return failure(build.error());
  if (const std::string& file = wanted.file_words.map; !file.empty()) {
    const auto map = read_material_map(file);
    if (!map) return failure(map.error());
    AppliedRows applied;
    auto mapped = mapped_build(*build, *map, applied, kBuildFileBytesMax);
    if (!mapped) return failure(wanted.file + ": " + mapped.error().what);
    build = std::move(mapped).value();
    if (auto unused = unused_rows_notice(file, *map, applied); !unused.empty())
      out.notices.push_back(std::move(unused));
  }
  out.build = std::make_shared<const FileBuild>(*std::move(build));
  return out;
}

void import_file(const CommandCall& call, const PlacedFile& wanted) {
  call.on_worker(
      "import: ",
      [wanted, should_continue = call.services.rollback.should_continue()](WorldReader&) {
        return read_placed_file(wanted, should_continue);
      },
      [call, wanted](const ReadFile& read) {
        for (const std::string& notice : read.notices) call.report(notice);
        place_build(call, "import", '"' + read.build->info.name + '"', read.build, wanted.words);
      });
}

/// Ends the import of a folder if the console gives the command, and what is being placed.
void cancel_placing(const CommandCall& call) {
  const auto& import = call.services.folder_import;
  if (call.caller.author == 0 && import && !import->is_over()) {
    import->cancel();
    const std::string text = "ended: the import of " + import->path() + "; what it added stays";
    if (call.services.placing.is_idle()) return call.answer(text);
    call.report(text);
  }
  call.services.placing.cancel(call.caller.author, call.now, call.reply);
}

void remove_build(const CommandCall& call, const Sequence& number) {
  const LibraryRow* row = call.world().order().library().find(number);
  if (row == nullptr) return call.refuse("builds remove: " + no_build(number));
  const bool is_own = call.caller.author != 0 && row->author == call.caller.author;
  if (!is_own && !has_right(call.caller, call.rights(), Right::administer, call.rights_time()))
    return call.refuse("builds remove: somebody else has added it, and you may not administer");
  if (const auto why = call.world().cluster().library_refusal())
    return call.refuse("builds remove: " + *why);
  const auto removed = call.world().changes().remove_build(number, call.caller.author, call.now);
  if (!removed) return call.refuse("builds remove: " + removed.error());
  call.answer_when_durable(*removed, "removed build " + std::to_string(number) + " (record " +
                                         std::to_string(*removed) + ")");
}

constexpr std::array<CommandRow, 9> kLibraryRows = {{
    {"builds list", needs(Right::see),
     "builds list [name PART] [author PART] [tag TAG] [before NUMBER] [count N]\n"
     "                          the builds of the library, newest first",
     parsed_by<parse_builds_list, list_builds>()},
    {"builds show", needs(Right::see),
     "builds show NUMBER        all that the library knows of a build",
     parsed_by<parse_build_number, show_build>()},
    {"builds import FILE", kLocal,
     "builds import FILE        add a build from an .rsb file to the library, or all builds of a\n"
     "                          folder of such files",
     parsed_by<parse_build_file, import_build>()},
    {"builds export NUMBER FILE", kLocal,
     "builds export NUMBER FILE write a build of the library to an .rsb file",
     parsed_by<parse_export, export_build>()},
    {"builds picture NUMBER FILE", kLocal,
     "builds picture NUMBER FILE\n"
     "                          draw a build of the library from above to a PNG file",
     parsed_by<parse_export, draw_build>()},
    {"builds place", needs(Right::administer),
     "builds place NUMBER at X Y Z [turn 90 | 180 | 270] [mirror x | z] [only-into empty]\n"
     "             [without air] [materials add | nearest]\n"
     "                          place a build as one action, with its lowest corner at X Y Z",
     parsed_by<parse_place, place_stored_build>()},
    {kImportFileWords, kLocal,
     "import FILE at X Y Z ...  place a build from a file (.rsb, .schem, .vox and others), with the\n"
     "                          words of builds place, [map FILE], which chooses materials, and\n"
     "                          [colours FILE], a PNG with the colours of a height map",
     parsed_by<parse_import_file, import_file>()},
    {"builds cancel", needs(Right::administer),
     "builds cancel             end what you place, and take it back; the console ends all, and the\n"
     "                          import of a folder, of which it keeps what was added",
     alone<cancel_placing>()},
    {"builds remove", needs(Right::build, Right::administer),
     "builds remove NUMBER      remove a build from the library: your own one, or any if you may\n"
     "                          administer",
     parsed_by<parse_build_number, remove_build>()},
}};

}  // namespace

std::span<const CommandRow> library_commands() { return kLibraryRows; }

}  // namespace runstone
