#include "common/build_files/build_files.hpp"

#include <filesystem>
#include <utility>

#include "common/core/build_info.hpp"
#include "common/core/text.hpp"
#include "common/formats/model_formats.hpp"
#include "common/model_writers/coarser_build.hpp"
#include "common/os/output_file.hpp"
#include "common/os/private_file.hpp"

namespace runstone {
namespace {

std::string stem_of(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// Writes the levels of detail that are files of their own. Returns their bytes.
Result<std::uint64_t, std::string> write_level_files(const std::string& file,
                                                     const FileBuild& build, FileWriting writing) {
  const unsigned levels = std::exchange(writing.model.levels, 0U);
  std::uint64_t bytes = 0;
  FileBuild coarser;
  const FileBuild* finer = &build;
  for (unsigned level = 1; level <= levels && can_be_coarser(*finer->build); ++level) {
    auto made = coarser_level(*finer);
    if (!made && made.error().code == ErrorCode::bad_value) break;  // it shows nothing
    if (!made) return failure(level_file(file, level) + ": " + made.error().what);
    coarser = *std::move(made);
    finer = &coarser;
    writing.model.metres_per_voxel *= 2;
    const auto written = write_build_to_file(level_file(file, level), coarser, writing);
    if (!written) return written;
    bytes += *written;
  }
  return bytes;
}

}  // namespace

std::string file_refusal(const std::string& file, bool is_written) {
  if (!is_written && is_model_file(file)) return "";
  std::string why = ending_refusal(file, is_written);
  if (!why.empty() && !is_written) why += ", and of models " + model_endings();
  return why;
}

Result<FileBuild, std::string> read_build_of_file(const std::string& file, BuildReading reading,
                                                  std::size_t file_bytes_max) {
  if (auto why = file_refusal(file, false); !why.empty()) return failure(std::move(why));
  ForeignReading& foreign = reading.foreign;
  if (foreign.name.empty()) foreign.name = stem_of(file);
  if (is_model_file(file)) {
    if (!foreign.colours_file.empty())
      return failure(file + ": is no height map, and only these take colours from another file");
    auto build = read_model_build(file, reading.model, foreign.bytes_max, reading.notice);
    if (build) build->info.name = build_name_of_file(foreign.name);
    return build;
  }
  const auto bytes = read_file_bytes(file, file_bytes_max, FileKinds::regular);
  if (!bytes) return failure(bytes.error());
  Bytes colours;
  if (!foreign.colours_file.empty()) {
    auto picture = read_file_bytes(foreign.colours_file, file_bytes_max, FileKinds::regular);
    if (!picture) return failure(picture.error());
    if (picture->empty()) return failure(foreign.colours_file + ": has no bytes");
    colours = *std::move(picture);
    foreign.colours = colours;
  }
  return read_file_build(file, *bytes, foreign);
}

Result<std::uint64_t, std::string> write_build_to_file(const std::string& file,
                                                       const FileBuild& build,
                                                       const FileWriting& writing) {
  if (auto why = ending_refusal(file, true); !why.empty()) return failure(std::move(why));
  if (auto why = choice_refusal(file, writing); !why.empty()) return failure(std::move(why));
  auto out = open_output_file(file);
  if (!out) return failure(out.error());
  std::uint64_t bytes = 0;
  const auto to = [&bytes](FileWriter& writer) {
    return [&bytes, &writer](ByteView part) {
      bytes += part.size();
      return writer.write(part);
    };
  };
  const auto written = write_file_build(file, build, to(*out), writing);
  if (!written) return failure(out->error().empty() ? written.error() : file + ": " + out->error());
  if (has_level_files(file)) {
    const auto levels = write_level_files(file, build, writing);
    if (!levels) return levels;
    bytes += *levels;
  }
  // The first file names the second one, so it is finished last.
  if (const std::string companion = companion_file(file); !companion.empty()) {
    auto second = open_output_file(companion);
    if (!second) return failure(second.error());
    const auto done = write_companion(file, build, to(*second));
    if (!done) return failure(companion + ": " + second->error());
    if (const auto end = second->finish(); !end) return failure(companion + ": " + end.error());
  }
  if (const auto done = out->finish(); !done) return failure(file + ": " + done.error());
  return bytes;
}

std::string build_name_of_file(const std::string& file) {
  const std::string stem = stem_of(file);
  return is_plain_name(stem) ? std::string(cut_utf8(stem, kBuildNameBytesMax)) : "build";
}

}  // namespace runstone
