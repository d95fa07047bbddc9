#include "common/os/output_file.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace runstone {
namespace {

using Written = Result<void, std::string>;

constexpr std::string_view kDatabaseBegins{"SQLite format 3\0", 16};
constexpr std::array<std::string_view, 4> kKeptNames = {".sqlite", ".sqlite-wal", ".sqlite-shm",
                                                        ".key"};

bool is_database(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, kDatabaseBegins.size()> begin{};
  in.read(begin.data(), begin.size());
  return in.gcount() == static_cast<std::streamsize>(begin.size()) &&
         std::string_view(begin.data(), begin.size()) == kDatabaseBegins;
}

}  // namespace

std::string output_refusal(const std::string& file) {
  for (const std::string_view name : kKeptNames) {
    if (file.ends_with(name)) {
      return "is not overwritten: files called *" + std::string(name) + " hold a world or a key";
    }
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "is a folder";
  if (is_database(file)) return "is not overwritten: it is a database";
  return "";
}

Written write_output_file(const std::string& file, std::string_view bytes) {
  const auto fail = [&](const std::string& why) { return Written(failure(file + ": " + why)); };
  if (const std::string refusal = output_refusal(file); !refusal.empty()) return fail(refusal);
  // A device or a pipe is written in place.
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  const bool in_place =
      std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  const std::string fresh = in_place ? file : file + ".new";
  {
    std::ofstream out(fresh, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) return fail("cannot be written");
  }
  if (in_place) return {};
  std::filesystem::rename(fresh, file, error);
  if (error) return fail("cannot be written: " + error.message());
  return {};
}

}  // namespace runstone
