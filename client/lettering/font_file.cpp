#include "client/lettering/font_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "common/os/private_file.hpp"

namespace runstone {
namespace {

/// The bytes of a font, at most: fonts of all of Chinese have 30 MB.
constexpr std::size_t kFontBytesMax = std::size_t{64} << 20;
/// The files that a search looks at, at most.
constexpr std::size_t kFontFilesMax = 100'000;

std::vector<std::string> font_folders() {
  std::vector<std::string> out;
  if (const char* const home = std::getenv("HOME"); home != nullptr && *home == '/') {
    out.push_back(std::string(home) + "/.local/share/fonts");
    out.push_back(std::string(home) + "/.fonts");
  }
  out.emplace_back("/usr/local/share/fonts");
  out.emplace_back("/usr/share/fonts");
  return out;
}

bool is_font_ending(std::string_view ending) {
  constexpr std::array<std::string_view, 4> kEndings = {".ttf", ".otf", ".ttc", ".pfb"};
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// Returns the font of this name in a folder, or an empty path. Of several it is the first one in
/// the order of their paths.
std::filesystem::path find_font(const std::string& folder, const std::string& name) {
  std::filesystem::path found;
  std::error_code error;
  std::filesystem::recursive_directory_iterator at(
      folder, std::filesystem::directory_options::skip_permission_denied, error);
  const std::filesystem::recursive_directory_iterator end;
  for (std::size_t files = 0; !error && at != end && files < kFontFilesMax;
       at.increment(error), ++files) {
    const std::filesystem::path& path = at->path();
    if (!is_font_ending(path.extension().native())) continue;
    if (path.filename().native() != name && path.stem().native() != name) continue;
    if (found.empty() || path < found) found = path;
  }
  return found;
}

Result<FontPtr, std::string> read_path(const std::string& path) {
  auto bytes = read_file_bytes(path, kFontBytesMax);
  if (!bytes) return failure("cannot read the font: " + bytes.error());
  return std::make_shared<const Bytes>(*std::move(bytes));
}

}  // namespace

Result<FontPtr, std::string> read_font(const std::string& name) {
  if (name.find('/') != std::string::npos) return read_path(name);
  std::string searched;
  for (const std::string& folder : font_folders()) {
    const auto found = find_font(folder, name);
    if (!found.empty()) return read_path(found.native());
    searched += (searched.empty() ? "" : ", ") + folder;
  }
  return failure("there is no font " + name + ": looked for " + name +
                 ".ttf, .otf, .ttc and .pfb in " + searched);
}

}  // namespace runstone
