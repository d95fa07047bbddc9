// An .rlog in memory, and damage to it that checksums cannot see.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "common/rlog/rlog_reader.hpp"
#include "common/rlog/rlog_writer.hpp"

namespace runstone::test {

/// A world that differs from the default in every field; its log begins at `first`.
RlogWorld sample_rlog_world(Sequence first = 1);
std::vector<RlogPlayer> sample_rlog_players();

/// The whole file. Fails an assertion if the records do not continue the world's head.
Bytes rlog_of(const RlogWorld& world, std::span<const RlogPlayer> players,
              std::span<const EditRecord> records, RlogOptions options);

/// The bytes must outlive the source.
RlogSource source_of(const Bytes& file);

/// What can be read of a file, and why no more.
struct RlogContents {
  RlogWorld world;
  std::vector<RlogPlayer> players;
  std::vector<EditRecord> records;
  std::optional<RlogError> error;
};
RlogContents read_rlog(const Bytes& file, const RlogFrom& from = {});

/// Where the blocks of a sound file begin, the end block included; behind them the length of the file.
std::vector<std::size_t> blocks_of(const Bytes& file);

/// Makes every checksum and position right again, as far as the headers' lengths lead.
void mend_rlog(Bytes& file);

}  // namespace runstone::test
