#include "server/import/foreign_place.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "common/os/private_file.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConvert =
    ". An import reads Luanti worlds only. Convert it to a Luanti world with a program that reads "
    "this format, and import the folder of that world";

bool has(const std::string& folder, const char* name) {
  std::error_code error;
  return fs::exists(fs::path(folder) / name, error);
}

struct FileKind {
  std::string_view ending;
  const char* what;
};

constexpr std::array kKinds = {
    FileKind{".vox", "a model of MagicaVoxel"},
    FileKind{".mca", "a region of a Minecraft world"},
    FileKind{".mcr", "a region of an old Minecraft world"},
    FileKind{".schem", "a schematic of Minecraft"},
    FileKind{".schematic", "a schematic of Minecraft"},
    FileKind{".litematic", "a schematic of Minecraft (Litematica)"},
    FileKind{".nbt", "a structure of Minecraft"},
    FileKind{".mcworld", "a packed world of Minecraft Bedrock"},
    FileKind{".mts", "a schematic of Luanti"},
    FileKind{".we", "a schematic of Luanti's WorldEdit"},
    FileKind{".qb", "a model of Qubicle"},
    FileKind{".kv6", "a model of Slab6"},
    FileKind{".rlog", "a recording of Runstone"},
};

std::string words_of_file(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  if (name == "map.sqlite" || name == "world.mt")
    return "is a file of a Luanti world: give the folder that holds it";
  if (name == "level.dat") return std::string("is a file of a Minecraft world") + kConvert;
  // Opening a pipe waits for its other end.
  if (!check_file_kind(file))
    return "is a device, a pipe or a socket: give the folder of a Luanti world, which holds "
           "map.sqlite and world.mt";
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4> first{};
  in.read(first.data(), first.size());
  const std::string_view magic(first.data(), static_cast<std::size_t>(in.gcount()));
  if (magic == "VOX ") return std::string("is a model of MagicaVoxel") + kConvert;
  if (magic == "MTSM")
    return "is a schematic of Luanti, not a world: place it in a Luanti world, and import the "
           "folder of that world";
  for (const FileKind& kind : kKinds) {
    if (name.ends_with(kind.ending)) return std::string("is ") + kind.what + kConvert;
  }
  return "is a file, and an import reads the folder of a Luanti world, which holds map.sqlite and "
         "world.mt. Unpack it first if it is an archive";
}

/// Returns the name of a folder in this one that holds a Luanti world, or an empty text.
std::string world_within(const std::string& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string path = entry->path().string();
    if (has(path, "map.sqlite") || has(path, "world.mt")) return path;
  }
  return {};
}

}  // namespace

std::string words_of_foreign_place(const std::string& place) {
  std::error_code error;
  const fs::file_status status = fs::status(place, error);
  if (status.type() == fs::file_type::not_found)
    return "does not exist: give the folder of a Luanti world, which holds map.sqlite and world.mt";
  if (error) return "cannot be read: " + error.message();
  if (status.type() != fs::file_type::directory) return words_of_file(place);
  if (has(place, "world.sqlite"))
    return "is a world of Runstone already: start it with runstone-server --world";
  if (has(place, "level.dat") || has(place, "region"))
    return std::string(has(place, "db") ? "is a world of Minecraft Bedrock"
                                        : "is a Minecraft world") +
           kConvert;
  if (has(place, "sectors") || has(place, "sectors2"))
    return "is a Luanti world of before 2012, with its map in files (sectors): open a copy with "
           "Luanti 0.4, which converts it, and import the copy";
  if (has(place, "map.db"))
    return "has a map.db, the map of a Luanti world in LevelDB, and no world.mt: add world.mt with "
           "\"backend = leveldb\", and import again";
  if (const std::string world = world_within(place); !world.empty())
    return "holds folders of Luanti worlds, and an import reads one: give " + world;
  return "is no Luanti world: it holds neither map.sqlite nor world.mt";
}

}  // namespace runstone
