#include "server/admin/build_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "common/core/text.hpp"

namespace runstone {
namespace {

/// Builds of the library that are read at a time.
constexpr std::size_t kKnownBuildsPage = 1000;

bool ends_with_rsb(const std::string& name) {
  constexpr std::string_view kEnding = ".rsb";
  return name.size() > kEnding.size() &&
         std::equal(kEnding.rbegin(), kEnding.rend(), name.rbegin(), [](char wanted, char found) {
           return wanted == (found >= 'A' && found <= 'Z' ? static_cast<char>(found + 32) : found);
         });
}

Result<void, std::string> read_known(LibraryReader& library, const ShouldContinue& should_continue,
                                     BuildFolder& folder) {
  LibraryQuery page;
  page.count_max = kKnownBuildsPage;
  for (;;) {
    if (should_continue && !should_continue()) return failure("the server stops");
    const auto builds = library.builds(page);
    if (!builds) return failure(builds.error().message());
    for (const StoredBuild& build : *builds)
      folder.known.emplace_back(build.build().file_digest, build.build().file_bytes);
    if (builds->size() < kKnownBuildsPage) break;
    page.before = builds->back().number();
  }
  std::sort(folder.known.begin(), folder.known.end());
  return {};
}

bool is_known(const BuildFolder& folder, const AddBuild& build) {
  return std::binary_search(folder.known.begin(), folder.known.end(),
                            std::pair(build.file_digest, build.file_bytes));
}

}  // namespace

Result<BuildFolder, std::string> list_build_folder(LibraryReader& library, const std::string& path,
                                                   std::uint64_t files_max,
                                                   const ShouldContinue& should_continue) {
  BuildFolder out;
  out.path = path;
  std::error_code error;
  std::filesystem::directory_iterator entry(path, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (should_continue && !should_continue()) return failure("the server stops");
    std::string name = entry->path().filename().string();
    if (!ends_with_rsb(name)) {
      ++out.others;
      continue;
    }
    if (out.names.size() == files_max) {
      return failure(path + ": has more than " + std::to_string(files_max) +
                     " .rsb files, and the library of this world takes no more builds "
                     "(builds_max): divide it");
    }
    out.names.push_back(std::move(name));
  }
  if (error) return failure(path + ": cannot be read: " + error.message());
  if (out.names.empty()) return failure(path + ": has no .rsb file");
  std::sort(out.names.begin(), out.names.end());
  if (auto read = read_known(library, should_continue, out); !read) return failure(read.error());
  return out;
}

FolderBatch read_build_folder(const BuildFolder& folder, std::size_t first, std::uint64_t bytes_max,
                              const ShouldContinue& should_continue) {
  FolderBatch out;
  out.next = first;
  for (std::size_t bytes = 0; out.next < folder.names.size() && bytes < kFolderBatchBytes &&
                              out.next - first < kFolderBatchFiles;
       ++out.next) {
    if (should_continue && !should_continue()) return out;
    const std::string& name = folder.names[out.next];
    // The name would break the line of the answer.
    if (!is_printable_utf8(name)) {
      out.refusals.push_back("file " + std::to_string(out.next + 1) +
                             " of the folder: its name is no printable UTF-8 text");
      continue;
    }
    auto read = read_build_file((std::filesystem::path(folder.path) / name).string(), bytes_max);
    if (!read) {
      out.refusals.push_back(std::move(read).error());
    } else if (is_known(folder, read->build)) {
      ++out.known;
    } else {
      bytes += read->bytes->size();
      out.builds.push_back(*std::move(read));
    }
  }
  return out;
}

}  // namespace runstone
