#include "client/panels/library_file.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "client/panels/build_picture.hpp"
#include "common/core/text.hpp"
#include "common/formats/material_match.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {
namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

TimeUs utc_now() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count();
  return std::clamp<TimeUs>(us, 0, kBuildTimeMax);
}

}  // namespace

Result<LibraryBuild, std::string> read_library_file(const Bytes& file) {
  auto read = read_build(rsb_source(file));
  if (!read) return failure("the file of the build is damaged: " + read.error().message());
  LibraryBuild out;
  out.info = std::move(read->info);
  out.build = std::move(read->build);
  for (const BuildMaterial& material : read->materials) out.rows.push_back(world_row_of(material));
  out.picture = build_picture(*out.build, out.rows);
  return out;
}

Result<Bytes, std::string> write_library_file(const Build& build,
                                              const std::vector<MaterialRow>& rows, BuildInfo info,
                                              EmptyCells empty, std::uint64_t bytes_max) {
  info.created_us = utc_now();
  std::vector<BuildMaterial> materials;
  for (const MaterialRow& row : rows) materials.push_back({row, {}});
  Bytes out;
  bool fits = true;
  const RsbSink sink = [&](ByteView bytes) {
    fits = bytes.size() <= bytes_max - out.size();
    if (fits) out.insert(out.end(), bytes.begin(), bytes.end());
    return fits;
  };
  const auto written =
      write_build(build, materials, std::move(info), empty == EmptyCells::skipped, sink);
  if (!fits) {
    return failure("the file of the build would have more than " + std::to_string(bytes_max >> 20) +
                   " MiB: copy a smaller box");
  }
  if (!written) return failure("the build cannot be written: " + written.error().message());
  return out;
}

Result<BuildInfo, std::string> named_build(const std::string& name, const std::string& tags,
                                           const std::string& author) {
  BuildInfo info;
  info.name = without_blanks(name);
  if (info.name.empty()) return failure(std::string("give the build a name"));
  std::string_view left = tags;
  while (!left.empty()) {
    const std::size_t length = std::min(left.find(','), left.size());
    const std::string_view tag = without_blanks(left.substr(0, length));
    if (!tag.empty()) info.tags.emplace_back(tag);
    left.remove_prefix(std::min(length + 1, left.size()));
  }
  std::sort(info.tags.begin(), info.tags.end());
  info.tags.erase(std::unique(info.tags.begin(), info.tags.end()), info.tags.end());
  if (author.size() <= kBuildAuthorBytesMax && is_plain_name(author)) info.author = author;
  if (const auto sound = validate(info); !sound) return failure(std::string(sound.error().what));
  return info;
}

}  // namespace runstone
