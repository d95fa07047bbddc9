#include "common/formats/file_build.hpp"

#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/grid_cells.hpp"
#include "common/formats/rsb_block.hpp"

namespace runstone {
namespace {

constexpr std::string_view kRsbEnding = ".rsb";
constexpr std::string_view kHeightMapEnding = ".png";
constexpr std::string_view kSchemEnding = ".schem";

bool is_rsb(std::string_view file) { return has_ending(file, kRsbEnding); }

/// Returns the format of a file that holds a build as a whole, or null.
const Format* file_format(std::string_view file) {
  const Format* format = format_of_file(file);
  return format != nullptr && format->is_file ? format : nullptr;
}

std::string error_text(const std::string& file, const Error& error) {
  std::string text = file + ": " + error.what;
  if (error.offset != 0) text += " (at byte " + std::to_string(error.offset) + ")";
  return text;
}

std::string without_folders(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

}  // namespace

Result<FileBuild, std::string> read_file_build(const std::string& file, ByteView bytes,
                                               const ForeignReading& reading) {
  if (auto why = ending_refusal(file, false); !why.empty()) return failure(std::move(why));
  if (!reading.colours.empty() && !has_ending(file, kHeightMapEnding)) {
    return failure(file + ": is no height map (" + std::string(kHeightMapEnding) +
                   "), and only these take colours from another file");
  }
  if (is_rsb(file)) {
    auto build = read_build(rsb_source(bytes), reading.bytes_max);
    if (!build) return failure(file + ": " + build.error().message());
    return *std::move(build);
  }
  auto build = read_foreign_build(*file_format(file), bytes, reading);
  if (!build && !reading.colours.empty())
    return failure(
        error_text(file + " with the colours of " + reading.colours_file, build.error()));
  if (!build) return failure(error_text(file, build.error()));
  return *std::move(build);
}

Result<void, std::string> write_file_build(const std::string& file, const FileBuild& build,
                                           const FormatSink& sink, FileWriting writing) {
  if (auto why = ending_refusal(file, true); !why.empty()) return failure(std::move(why));
  if (auto why = choice_refusal(file, writing); !why.empty()) return failure(std::move(why));
  bool is_written = true;
  const FormatSink noting = [&](ByteView bytes) { return is_written = sink(bytes); };
  if (is_rsb(file)) {
    const auto done = write_build(*build.build, build.materials, build.info, false, noting);
    if (!is_written) return failure(file + ": cannot be written");
    if (!done) return failure(file + ": " + done.error().message());
    return {};
  }
  const Format& format = *file_format(file);
  writing.model.material_file = without_folders(companion_file(file));
  const auto done = format.write_with != nullptr ? format.write_with(build, writing, noting)
                                                 : format.write(build, noting);
  if (!is_written) return failure(file + ": cannot be written");
  if (!done) return failure(file + ": " + done.error().what);
  return {};
}

std::string choice_refusal(std::string_view file, const FileWriting& writing) {
  if (writing.schem == SchemVersion::three || has_ending(file, kSchemEnding)) return "";
  return std::string(file) + ": is no " + std::string(kSchemEnding) +
         ", and only these have a version to choose";
}

std::string companion_file(const std::string& file) {
  const Format* format = file_format(file);
  if (format == nullptr || format->model == nullptr || format->model->companion_ending.empty())
    return "";
  return file.substr(0, file.size() - format->file_ending.size()) +
         std::string(format->model->companion_ending);
}

Result<void, std::string> write_companion(const std::string& file, const FileBuild& build,
                                          const FormatSink& sink) {
  const std::string companion = companion_file(file);
  RUNSTONE_ASSERT(!companion.empty());
  const auto done = file_format(file)->model->write_companion(build, sink);
  if (!done) return failure(companion + ": cannot be written");
  return {};
}

bool has_level_files(const std::string& file) {
  const Format* format = file_format(file);
  return format != nullptr && format->model != nullptr && !format->model->holds_levels;
}

std::string level_file(const std::string& file, unsigned level) {
  const std::size_t dot = file.size() - file_format(file)->file_ending.size();
  return file.substr(0, dot) + ".lod" + std::to_string(level) + file.substr(dot);
}

std::uint64_t solid_cells(const FileBuild& build) {
  const std::vector<std::uint64_t> counts = count_cells(*build.build);
  std::uint64_t sum = 0;
  for (std::size_t number = 1; number < counts.size(); ++number) {
    if (build.materials[number - 1].row.visibility != Visibility::empty) sum += counts[number];
  }
  return sum;
}

std::string ending_refusal(std::string_view file, bool is_written) {
  if (is_rsb(file)) return "";
  const Format* format = file_format(file);
  if (format != nullptr && (is_written ? format->write != nullptr : format->read != nullptr))
    return "";
  std::string text = std::string(file) + ": no format of this ending is " +
                     (is_written ? "written" : "read") + "; the endings are " +
                     std::string(kRsbEnding);
  for (const Format& each : formats()) {
    if (each.is_file && (is_written ? each.write != nullptr : each.read != nullptr))
      text += ", " + std::string(each.file_ending);
  }
  return text;
}

}  // namespace runstone
