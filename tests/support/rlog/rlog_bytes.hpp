// An .rlog in memory, and damage to it that checksums cannot see.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "common/rlog/rlog_reader.hpp"
#include "common/rlog/rlog_writer.hpp"

namespace runstone::test {

/// Returns a world that differs from the default in every field. Its log begins at `first`.
RlogWorld sample_rlog_world(Sequence first = 1);
std::vector<RlogPlayer> sample_rlog_players();

/// Returns the whole file. Fails an assertion if the records do not continue the world's head.
Bytes rlog_of(const RlogWorld& world, std::span<const RlogPlayer> players,
              std::span<const EditRecord> records, RlogOptions options);

/// The bytes must outlive the source.
RlogSource source_of(const Bytes& file);

/// The readable part of a file, and the error that ends it.
struct RlogContents {
  RlogWorld world;
  std::vector<RlogPlayer> players;
  std::vector<EditRecord> records;
  std::optional<RlogError> error;
};
RlogContents read_rlog(const Bytes& file, Sequence from = 1);

/// Returns where the blocks of a valid file begin, the end block included, and last the length of
/// the file.
std::vector<std::size_t> blocks_of(const Bytes& file);

/// Corrects every checksum and position, as far as the headers' lengths lead.
void mend_rlog(Bytes& file);

}  // namespace runstone::test
