#include "client/app/clipboard_file.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "common/build_files/build_files.hpp"
#include "common/formats/material_match.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/os/file_writer.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

/// The clipboard is written often and read once: fast rather than small.
constexpr int kClipboardLevel = 3;

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
  std::error_code unknown;
  if (std::filesystem::status(file_, unknown).type() == std::filesystem::file_type::not_found)
    return {};
  auto read = read_build_of_file(file_);
  if (!read) return failure(read.error());
  std::vector<MaterialRow> rows;
  for (BuildMaterial& material : read->materials) rows.push_back(std::move(material.row));
  static_cast<void>(
      tools.set_clipboard(std::move(read->build), EmptyCells::pasted, std::move(rows)));
  taken_ = tools.clipboard_changes();
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

std::string set_clipboard(FileBuild read, ToolBox& tools) {
  std::vector<MaterialRow> rows;
  for (const BuildMaterial& material : read.materials) rows.push_back(world_row_of(material));
  return tools.set_clipboard(std::move(read.build), EmptyCells::pasted, std::move(rows));
}

Result<FileBuild, std::string> build_of_clipboard(const std::string& file, const ToolBox& tools) {
  const ToolClipboard& clipboard = tools.clipboard();
  if (!clipboard.build)
    return failure(std::string("the clipboard is empty: copy a selection first"));
  FileBuild build;
  build.build = clipboard.build;
  for (const MaterialRow& row : tools.clipboard_rows()) build.materials.push_back({row, {}});
  const VoxelPos sides = build.build->sides();
  build.info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                      static_cast<std::uint32_t>(sides.z)};
  build.info.name = build_name_of_file(file);
  return build;
}

Result<std::string, std::string> read_clipboard(const std::string& file, ToolBox& tools,
                                                const ModelChoices& model) {
  BuildReading reading;
  static_cast<ModelChoices&>(reading.model) = model;
  auto read = read_build_of_file(file, std::move(reading));
  if (!read) return failure(read.error());
  return set_clipboard(*std::move(read), tools);
}

Result<void, std::string> write_clipboard(const std::string& file, const ToolBox& tools) {
  if (auto why = file_refusal(file, true); !why.empty()) return failure(std::move(why));
  const auto build = build_of_clipboard(file, tools);
  if (!build) return failure(build.error());
  if (const auto written = write_build_to_file(file, *build); !written)
    return failure(written.error());
  return {};
}

std::string default_clipboard_file() {
  const std::string folder = user_folder(UserFolder::data);
  return folder.empty() ? folder : folder + "/clipboard.rsb";
}

}  // namespace runstone
