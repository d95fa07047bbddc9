#include "server/import/luanti_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/os/text_file.hpp"
#include "server/import/foreign_place.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSettingsBytesMax = 1 << 20;
constexpr const char* kNoMap =
    "does not exist: the world has world.mt and no map. Start Luanti once with it, so that there is "
    "a map, or check whether the folder was copied in full";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Returns the lines `key = value` of world.mt. The last line of a key counts, as in Luanti.
std::map<std::string, std::string, std::less<>> settings_of(std::string_view text) {
  std::map<std::string, std::string, std::less<>> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t equals = line.find('=');
    if (line.empty() || line.front() == '#' || equals == std::string_view::npos) continue;
    out[std::string(trimmed(line.substr(0, equals)))] = trimmed(line.substr(equals + 1));
  }
  return out;
}

/// Returns where the map is if the backend is not SQLite, and what to do.
std::string words_of_backend(const std::string& backend, bool has_map) {
  std::string where;
  if (backend == "dummy")
    return "world.mt says backend = dummy: Luanti keeps such a map in memory only, so there is "
           "nothing to import";
  if (backend == "postgresql") where = "in a PostgreSQL database";
  if (backend == "redis") where = "in a Redis server";
  if (where.empty())
    return "world.mt says backend = " + backend +
           ", which this program does not know: an import reads the backends sqlite3 and leveldb";
  return "world.mt says backend = " + backend + ": the map is " + where +
         (has_map ? ", and map.sqlite is from before that" : "") +
         ". An import reads the backends sqlite3 and leveldb only. Stop the Luanti server, " +
         (has_map ? "move map.sqlite away, " : "") +
         "run \"luantiserver --world FOLDER --migrate sqlite3\", and import again";
}

Unexpected<ImportError> refused(const std::string& file, std::string what) {
  return {ImportError{file, std::move(what)}};
}

}  // namespace

Result<LuantiFolder, ImportError> find_luanti_map(const std::string& folder) {
  std::error_code error;
  LuantiFolder out;
  out.map = (fs::path(folder) / "map.sqlite").string();
  const bool has_map = fs::exists(out.map, error);
  const std::string settings_file = (fs::path(folder) / "world.mt").string();
  const bool has_settings = fs::exists(settings_file, error);
  if (!has_map && !has_settings) return refused(folder, words_of_foreign_place(folder));
  if (has_settings) {
    const auto text = read_text_file(settings_file, kSettingsBytesMax, FileKinds::regular);
    if (!text) return refused(folder, text.error());
    const auto settings = settings_of(*text);
    const auto backend = settings.find("backend");
    if (backend != settings.end() && backend->second == "leveldb") {
      out.backend = LuantiBackend::leveldb;
    } else if (backend != settings.end() && backend->second != "sqlite3") {
      return refused(folder, words_of_backend(backend->second, has_map));
    }
    const auto block_size = settings.find("blocksize");
    if (block_size != settings.end() && block_size->second != "16")
      return refused(folder, "world.mt says blocksize = " + block_size->second +
                                 ", and an import reads blocks of 16 nodes");
    const auto seed = settings.find("readonly_backend");
    out.has_seed_map = seed != settings.end() && seed->second != "dummy";
  }
  if (out.backend == LuantiBackend::leveldb) {
    out.map = (fs::path(folder) / "map.db").string();
    if (!fs::is_directory(out.map, error)) return refused(out.map, kNoMap);
    return out;
  }
  if (!has_map) return refused(out.map, kNoMap);
  if (fs::is_directory(out.map, error)) return refused(out.map, "is a folder, not a map");
  if (const auto kind = check_file_kind(out.map); !kind)
    return refused(out.map, kind.error().substr(out.map.size() + 2));
  if (fs::file_size(out.map, error) == 0 && !error)
    return refused(out.map, "has no bytes: copy the world again, or restore it from a backup");
  return out;
}

}  // namespace runstone
