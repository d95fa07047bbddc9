#include "common/os/output_file.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace runstone {
namespace {

constexpr std::string_view kDatabaseBegins{"SQLite format 3\0", 16};
constexpr std::array<std::string_view, 7> kKeptNames = {
    ".sqlite", ".sqlite-wal", ".sqlite-shm", ".sqlite-journal", ".durable", ".lock", ".key"};

bool is_database(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, kDatabaseBegins.size()> begin{};
  in.read(begin.data(), begin.size());
  return in.gcount() == static_cast<std::streamsize>(begin.size()) &&
         std::string_view(begin.data(), begin.size()) == kDatabaseBegins;
}

std::string with_name(const std::string& file, const std::string& why) {
  return file + ": cannot be written: " + why;
}

}  // namespace

std::string output_refusal(const std::string& file) {
  const std::string target = without_links(file);
  for (const std::string_view name : kKeptNames) {
    if (target.ends_with(name)) {
      return "is not overwritten: files called *" + std::string(name) + " hold a world or a key";
    }
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(target, ignored)) return "is a folder";
  // Reading a pipe could wait for ever.
  if (std::filesystem::is_regular_file(target, ignored) && is_database(target))
    return "is not overwritten: it is a database";
  return "";
}

bool is_written_in_place(const std::string& file) {
  if (is_own_descriptor(file)) return true;
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

Result<FileWriter, std::string> open_output_file(const std::string& file, mode_t mode) {
  if (const std::string refusal = output_refusal(file); !refusal.empty())
    return failure(file + ": " + refusal);
  auto opened =
      is_written_in_place(file) ? FileWriter::in_place(file) : FileWriter::replace(file, mode);
  if (!opened) return failure(with_name(file, opened.error()));
  return opened;
}

Result<void, std::string> write_output_file(const std::string& file, std::string_view bytes) {
  auto out = open_output_file(file);
  if (!out) return failure(out.error());
  out->write(bytes);
  if (const auto done = out->finish(); !done) return failure(with_name(file, done.error()));
  return {};
}

Result<void, std::string> empty_output_file(const std::string& file) {
  if (is_written_in_place(file)) return {};
  return write_output_file(file, "");
}

}  // namespace runstone
