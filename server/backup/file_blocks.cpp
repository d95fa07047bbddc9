#include "server/backup/file_blocks.hpp"

#include <fstream>
#include <string_view>

#include "common/os/folder_entries.hpp"

namespace runstone {
namespace {

constexpr std::string_view kCopyLock = "partial.lock";

}  // namespace

Result<BackedUpFile, std::string> cut_file(const std::filesystem::path& path,
                                           const TakeBlock& take) {
  BackedUpFile file;
  file.name = path.filename().string();
  std::ifstream in(path, std::ios::binary);
  Bytes block(kBlockBytes);
  while (in) {
    in.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(in.gcount());
    if (count == 0) break;
    const auto hash = take(ByteView(block).first(count));
    if (!hash) return failure(hash.error());
    file.blocks.push_back(*hash);
    file.bytes += count;
  }
  if (!in.eof()) return failure(path.string() + ": cannot be read");
  return file;
}

Result<std::vector<std::filesystem::path>, std::string> files_of_copy(const std::string& folder) {
  auto files = folder_entries(folder);
  if (files) std::erase_if(*files, [](const auto& file) { return file.filename() == kCopyLock; });
  return files;
}

}  // namespace runstone
