#include "server/world/order/library.hpp"

namespace runstone {
namespace {

/// Returns text such as "64 MiB", rounded up.
std::string mib_text(std::uint64_t bytes) {
  return std::to_string((bytes + (1U << 20) - 1) >> 20) + " MiB";
}

std::string builds_text(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " build" : " builds");
}

}  // namespace

Library::Library(const LibraryLimits& limits, std::span<const LibraryRow> rows) : limits_(limits) {
  for (const LibraryRow& row : rows) add(row);
}

void Library::add(const LibraryRow& row) {
  if (!rows_.emplace(row.number, row).second) return;
  for (LibraryTotal* total : {&total_, &author_totals_[row.author]}) {
    ++total->builds;
    total->file_bytes += row.file_bytes;
  }
}

void Library::apply(std::span<const EditRecord> records) {
  for (const EditRecord& record : records) {
    const LibraryChange* change = library_change_of(record.edit);
    if (change == nullptr) continue;
    newest_ = record.version.seq;
    if (const auto* added = std::get_if<AddBuild>(change)) {
      add({record.version.seq, record.op.author, added->file_bytes});
      continue;
    }
    const auto found = rows_.find(std::get_if<RemoveBuild>(change)->number);
    if (found == rows_.end()) continue;
    const auto author = author_totals_.find(found->second.author);
    for (LibraryTotal* total : {&total_, &author->second}) {
      --total->builds;
      total->file_bytes -= found->second.file_bytes;
    }
    if (author->second.builds == 0) author_totals_.erase(author);
    rows_.erase(found);
  }
}

std::optional<std::string> Library::refusal(AuthorId author, std::uint64_t file_bytes) const {
  if (file_bytes > limits_.file_bytes_max) {
    return "the build takes " + mib_text(file_bytes) + ", and one of at most " +
           mib_text(limits_.file_bytes_max) + " is allowed (build_mib): divide it";
  }
  if (total_.builds >= limits_.builds_max) {
    return "the library of this world has " + builds_text(total_.builds) +
           ", and no more are allowed (builds_max): remove some";
  }
  if (total_.file_bytes + file_bytes > limits_.bytes_max) {
    return "the library of this world takes " + mib_text(total_.file_bytes) + ", and at most " +
           mib_text(limits_.bytes_max) + " are allowed (builds_mib): remove some builds";
  }
  if (author == 0) return std::nullopt;
  const LibraryTotal own = total_of(author);
  if (own.builds >= limits_.builds_per_player) {
    return "the player has " + builds_text(own.builds) +
           " in the library, and no more are allowed (builds_per_player): remove some";
  }
  if (own.file_bytes + file_bytes > limits_.bytes_per_player) {
    return "the builds of the player take " + mib_text(own.file_bytes) + ", and at most " +
           mib_text(limits_.bytes_per_player) + " are allowed (builds_mib_per_player): remove some";
  }
  return std::nullopt;
}

const LibraryRow* Library::find(Sequence number) const {
  const auto found = rows_.find(number);
  return found == rows_.end() ? nullptr : &found->second;
}

LibraryTotal Library::total_of(AuthorId author) const {
  const auto found = author_totals_.find(author);
  return found == author_totals_.end() ? LibraryTotal{} : found->second;
}

}  // namespace runstone
