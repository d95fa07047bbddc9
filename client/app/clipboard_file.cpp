#include "client/app/clipboard_file.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "common/core/text.hpp"
#include "common/formats/file_build.hpp"
#include "common/formats/material_match.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/os/file_writer.hpp"
#include "common/os/private_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

/// The clipboard is written often and read once: fast rather than small.
constexpr int kClipboardLevel = 3;
constexpr std::size_t kClipboardFileBytesMax = std::size_t{256} << 20;

/// Returns a source over an open file, which must outlive it.
RsbSource source_of_file(std::ifstream& in) {
  return [&in](std::uint64_t position, std::span<std::uint8_t> out) -> std::optional<std::size_t> {
    in.clear();
    in.seekg(static_cast<std::streamoff>(position));
    if (!in) return std::nullopt;
    std::vector<char> bytes(out.size());
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (in.bad()) return std::nullopt;
    const auto count = static_cast<std::size_t>(in.gcount());
    std::memcpy(out.data(), bytes.data(), count);
    return count;
  };
}

}  // namespace

Result<void, std::string> ClipboardFile::write(const std::string& file, const Kept& kept) {
  std::error_code made;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), made);
  auto out = FileWriter::replace(file, 0600);
  if (!out) return failure(file + ": " + out.error());
  BuildInfo info;
  info.name = "clipboard";
  std::vector<BuildMaterial> materials;
  for (const MaterialRow& row : kept.rows) materials.push_back({row, {}});
  const auto written = write_build(
      *kept.build, materials, info, kept.empty == EmptyCells::skipped,
      [&](ByteView bytes) { return out->write(bytes); }, kClipboardLevel);
  if (!written) {
    return failure(file + ": " + (out->error().empty() ? written.error().message() : out->error()));
  }
  if (auto done = out->finish(); !done) return failure(file + ": " + done.error());
  return {};
}

ClipboardFile::~ClipboardFile() {
  const auto warn = [](const Result<void, std::string>& done) {
    if (!done) spdlog::warn("clipboard not kept: {}", done.error());
  };
  if (writing_.valid()) warn(writing_.get());
  if (waits_) warn(write(file_, *waits_));
}

Result<void, std::string> ClipboardFile::load(ToolBox& tools) {
  if (file_.empty()) return {};
  std::ifstream in(file_, std::ios::binary);
  if (!in) {
    std::error_code error;
    if (!std::filesystem::exists(file_, error)) return {};
    return failure(file_ + ": it cannot be opened");
  }
  auto read = read_build(source_of_file(in));
  if (!read) return failure(file_ + ": " + read.error().message());
  std::vector<MaterialRow> rows;
  for (BuildMaterial& material : read->materials) rows.push_back(std::move(material.row));
  static_cast<void>(
      tools.set_clipboard(std::move(read->build), EmptyCells::pasted, std::move(rows)));
  return {};
}

std::string ClipboardFile::step(const ToolBox& tools) {
  if (file_.empty()) return {};
  if (tools.clipboard_changes() != taken_ && tools.clipboard().build) {
    taken_ = tools.clipboard_changes();
    const auto rows = tools.clipboard_rows();
    waits_ = Kept{tools.clipboard().build, tools.clipboard().empty, {rows.begin(), rows.end()}};
  }
  std::string failed;
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    if (const auto done = writing_.get(); !done)
      failed = "the clipboard is not kept: " + done.error();
  }
  if (waits_) {
    writing_ = std::async(std::launch::async,
                          [file = file_, kept = *std::move(waits_)] { return write(file, kept); });
    waits_.reset();
  }
  return failed;
}

Result<std::string, std::string> read_clipboard(const std::string& file, ToolBox& tools) {
  if (auto why = ending_refusal(file, false); !why.empty()) return failure(std::move(why));
  const auto bytes = read_file(file, kClipboardFileBytesMax, FileKinds::regular);
  if (!bytes) return failure(bytes.error());
  ForeignReading reading;
  reading.name = std::filesystem::path(file).stem().string();
  auto read = read_file_build(
      file, {reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()}, reading);
  if (!read) return failure(read.error());
  std::vector<MaterialRow> rows;
  for (const BuildMaterial& material : read->materials) rows.push_back(world_row_of(material));
  return tools.set_clipboard(std::move(read->build), EmptyCells::pasted, std::move(rows));
}

Result<void, std::string> write_clipboard(const std::string& file, const ToolBox& tools) {
  if (auto why = ending_refusal(file, true); !why.empty()) return failure(std::move(why));
  const ToolClipboard& clipboard = tools.clipboard();
  if (!clipboard.build)
    return failure(std::string("the clipboard is empty: copy a selection first"));
  FileBuild build;
  build.build = clipboard.build;
  for (const MaterialRow& row : tools.clipboard_rows()) build.materials.push_back({row, {}});
  const VoxelPos sides = build.build->sides();
  build.info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                      static_cast<std::uint32_t>(sides.z)};
  const std::string stem = std::filesystem::path(file).stem().string();
  build.info.name = is_plain_name(stem) ? std::string(cut_utf8(stem, kBuildNameBytesMax)) : "build";
  auto out = FileWriter::replace(file, 0644);
  if (!out) return failure(file + ": " + out.error());
  const auto written =
      write_file_build(file, build, [&](ByteView bytes) { return out->write(bytes); });
  if (!written) return failure(out->error().empty() ? written.error() : file + ": " + out->error());
  if (auto done = out->finish(); !done) return failure(file + ": " + done.error());
  return {};
}

std::string default_clipboard_file() {
  const std::string folder = user_folder(UserFolder::data);
  return folder.empty() ? folder : folder + "/clipboard.rsb";
}

}  // namespace runstone
