#include "server/admin/build_file.hpp"

#include <xxhash.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "common/core/utc_text.hpp"
#include "common/formats/rsb_reader.hpp"
#include "common/os/output_file.hpp"
#include "common/os/private_file.hpp"
#include "server/map/build_picture.hpp"

namespace runstone {
namespace {

std::string file_size_text(std::uint64_t bytes) {
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  if (bytes < (1U << 20)) return std::to_string((bytes + 1023) >> 10) + " KiB";
  return std::to_string((bytes + (1U << 20) - 1) >> 20) + " MiB";
}

std::string sides_text(const BuildSides& sides) {
  return std::to_string(sides.x) + " x " + std::to_string(sides.y) + " x " +
         std::to_string(sides.z);
}

std::string tags_text(const BuildInfo& info) {
  std::string text;
  for (const std::string& tag : info.tags) text += (text.empty() ? "" : " ") + tag;
  return text;
}

/// Returns the file of a build of the library.
Result<Bytes, std::string> stored_bytes(LibraryReader& reader, const StoredBuild& build) {
  Bytes bytes;
  bytes.reserve(static_cast<std::size_t>(build.build().file_bytes));
  const auto read = reader.read_build(build, [&](ByteView part) {
    bytes.insert(bytes.end(), part.begin(), part.end());
    return true;
  });
  if (!read) return failure(read.error().message());
  return bytes;
}

}  // namespace

Result<AddBuild, std::string> verify_build(ByteView file, std::uint64_t runs_max,
                                           const std::function<bool()>& should_continue) {
  auto reader = RsbReader::open(rsb_source(file));
  if (!reader) return failure(reader.error().message());
  std::uint64_t runs = 0;
  while (true) {
    if (should_continue && !should_continue()) return failure("the server stops");
    const auto section = reader->next();
    if (!section) return failure(section.error().message());
    if (!section->has_value()) break;
    runs += kRunsOfSection + (*section)->cells.runs.size();
    if (runs > runs_max) return failure("the build is too finely divided: divide it into several");
  }
  AddBuild build;
  build.info = reader->info();
  build.touched = reader->touched();
  build.file_bytes = file.size();
  build.file_digest = XXH3_64bits(file.data(), file.size());
  return build;
}

Result<BuildFile, std::string> read_build_file(const std::string& file, std::uint64_t bytes_max) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  if (!unknown && size > bytes_max) {
    return failure(file + ": takes " + file_size_text(size) + ", and one of at most " +
                   file_size_text(bytes_max) + " is allowed (build_mib): divide it");
  }
  auto read = read_file_bytes(file, static_cast<std::size_t>(bytes_max), FileKinds::regular);
  if (!read) return failure(read.error());
  BuildFile out;
  out.bytes = std::make_shared<const Bytes>(*std::move(read));
  auto build = verify_build(*out.bytes);
  if (!build) return failure(file + ": " + build.error());
  out.build = *std::move(build);
  return out;
}

Result<void, std::string> write_build_file(LibraryReader& reader, const StoredBuild& build,
                                           const std::string& file) {
  auto out = open_output_file(file);
  if (!out) return failure(out.error());
  const auto read = reader.read_build(build, [&](ByteView part) { return out->write(part); });
  if (!read) return failure(read.error().message());
  if (const auto done = out->finish(); !done) return failure(file + ": " + done.error());
  return {};
}

Result<FileBuild, std::string> read_stored_build(LibraryReader& reader, const StoredBuild& build) {
  const auto bytes = stored_bytes(reader, build);
  if (!bytes) return failure(bytes.error());
  auto read = runstone::read_build(rsb_source(*bytes));
  if (!read) return failure(read.error().message());
  return *std::move(read);
}

Result<void, std::string> write_build_picture(LibraryReader& reader, const StoredBuild& build,
                                              const std::string& file) {
  const auto bytes = stored_bytes(reader, build);
  if (!bytes) return failure(bytes.error());
  auto sections = RsbReader::open(rsb_source(*bytes));
  if (!sections) return failure(sections.error().message());
  const auto png = build_picture(*sections);
  if (!png) return failure(png.error().message());
  return write_output_file(file, *png);
}

std::string build_line(Sequence number, const AddBuild& build) {
  const BuildInfo& info = build.info;
  std::string line = std::to_string(number) + " \"" + info.name + "\"";
  if (!info.author.empty()) line += " by " + info.author;
  line += ", " + sides_text(info.sides) + ", " + file_size_text(build.file_bytes);
  if (!info.tags.empty()) line += ", " + tags_text(info);
  return line;
}

std::string build_text(const StoredBuild& build, const std::string& added_by) {
  const AddBuild& added = build.build();
  const BuildInfo& info = added.info;
  std::string text = "number    " + std::to_string(build.number());
  text += "\nname      " + info.name;
  text += "\nauthor    " + (info.author.empty() ? std::string("not known") : info.author);
  if (!info.tags.empty()) text += "\ntags      " + tags_text(info);
  text += "\nsides     " + sides_text(info.sides) + " voxels";
  text += "\ncells     " + std::to_string(added.touched);
  text += "\norigin    " + std::to_string(info.origin.x) + " " + std::to_string(info.origin.y) +
          " " + std::to_string(info.origin.z);
  if (info.created_us != 0) text += "\ncreated   " + utc_text(info.created_us);
  text += "\nadded     " + utc_text(build.record.time_us) + " by " + added_by;
  text += "\nfile      " + file_size_text(added.file_bytes);
  return text;
}

std::string library_change_text(const LibraryChange& change) {
  if (const auto* remove = std::get_if<RemoveBuild>(&change))
    return "removed build " + std::to_string(remove->number);
  const AddBuild& build = *std::get_if<AddBuild>(&change);
  return "added the build \"" + build.info.name + "\", " + sides_text(build.info.sides) + ", " +
         file_size_text(build.file_bytes);
}

}  // namespace runstone
