// The copy of a world's database, of one moment, while a server may write the world.
//   - One read transaction is open from the first page to the last, so the copy never begins anew.
//     Meanwhile the server cannot reuse its WAL, which grows by what is written.
//   - After each part of the copy the thread rests as long as the part took. So the copy has half
//     of the disk at most.
// docs/server-reference.md, "Backup", says what this costs the players.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// How a backup spares the players. Tests change it.
struct BackupPace {
  int part_pages = 128;                     // copied between two rests
  int flush_parts = 32;                     // copied between two flushes to disk
  std::uint64_t spare_bytes = 64ULL << 20;  // of the target's disk that stay free
  /// Is called after each part with the time that the part took.
  std::function<void(std::chrono::nanoseconds)> rest;
};
/// Returns the pace of the program: rest() sleeps as long as the part took.
BackupPace gentle_pace();

/// Fails unless the disk of `folder` has room for `bytes` and `spare` more. The error is one line
/// that begins with `name`.
Result<void, std::string> check_room(const std::string& name, const std::string& folder,
                                     std::uint64_t bytes, std::uint64_t spare);

enum class SourceUse {
  live,  // a server may be writing the world
  still  // nobody writes it; no file is made beside it, so its folder may be read-only
};

/// Gets the copied pages and all pages.
using BackupProgress = std::function<void(std::uint64_t, std::uint64_t)>;

/// The moment that a copied database holds.
struct BackupMoment {
  Epoch epoch = 0;   // of the last start
  Sequence seq = 0;  // of the last edit
  std::uint64_t bytes = 0;
};

/// Copies the database `from` to the new file `to`, whose bytes are on disk on return.
/// Fails (full) if the disk of `to` has no room, and (exists) if `to` exists. After a failure `to`
/// may be there and incomplete.
StoreResult<BackupMoment> copy_database(const std::string& from, SourceUse use,
                                        const std::string& to, const BackupPace& pace,
                                        const BackupProgress& progress);

}  // namespace runstone
