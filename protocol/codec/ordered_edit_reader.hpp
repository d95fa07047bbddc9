// OrderedEditReader: reads the byte list of a Commit: ordered edits, each with the chunks that it
// touches. The list can be read without the geometry of an edit, because it counts the chunks.
// docs/protocol.md specifies the bytes; CommitEncoder writes them. Internal to the message codec.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Reads the edits of one list in order, and keeps none of them.
class OrderedEditReader {
 public:
  /// Requires `bytes` to outlive the reader. `chunk_edge` is 0 before Welcome: then the edit's
  /// geometry is not compared with the list of previous sequences.
  OrderedEditReader(ByteView bytes, std::int32_t chunk_edge)
      : in_(bytes), chunk_edge_(chunk_edge) {}

  bool at_end() const { return in_.at_end(); }
  /// Reads the next edit into `edit`, and the chunks that it touches into `touched`, which stays
  /// empty if the chunk edge is not known. The caller may move from both. Requires that the list
  /// has not ended.
  Result<void> next(OrderedEdit& edit, std::vector<ChunkCoord>& touched);
  /// Reads the next edit of a VeiledCommit, as next() above. Requires a chunk edge.
  Result<void> next(VeiledEdit& edit, std::vector<ChunkCoord>& touched);

 private:
  void take_fields(OrderedEdit& edit);
  Result<void> compare_with_geometry(const OrderedEdit& edit, std::vector<ChunkCoord>& touched);
  void take_sequence_and_time(OrderedEdit& edit);
  std::uint64_t take_descriptor_size();
  void take_descriptor(std::uint64_t size, OrderedEdit& edit);
  void take_previous(OrderedEdit& edit);

  ByteReader in_;
  Sequence seq_ = 0;       // of the edit before
  TimeUs ordered_us_ = 0;  // of the edit before
  std::int32_t chunk_edge_;
};

}  // namespace runstone
